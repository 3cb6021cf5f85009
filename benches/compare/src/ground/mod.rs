//! Contacts of bodies with a ground of 20,000 triangles: this library's beside parry3d-f64's contact manifolds and Jolt's, body by
//! body. Then rays at grounds of more triangles, beside parry's.

mod jolt;
mod ours;
mod parry;
mod rays;
mod scenes;

use std::fmt::Write;
use std::ops::Range;

use swiftprox::shape::{Shape, ShapeOptions};

use crate::options::Options;
use crate::report;
use crate::timing::{Time, Timed, time_methods};
use scenes::{BODIES, Hills, KINDS, MOTIONS, SURFACES};

/// What a method has found of a body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Counted {
    pub normals: usize,
    pub points: usize,
    /// Normals that are more than 45° off the vertical, on ground that is nowhere steeper than 16°.
    pub ghosts: usize,
}

/// Whether a unit normal with this height is more than 45° off the vertical.
pub fn is_ghost(z: f64) -> bool {
    z < std::f64::consts::FRAC_1_SQRT_2
}

/// Contacts of one scene's bodies, step by step.
pub trait Grounded {
    fn name(&self) -> &'static str;

    /// Drops all coherence, but for what the first step leaves.
    fn forget(&mut self);

    /// Asks of body i mod [`BODIES`] at step i / [`BODIES`].
    fn ask(&mut self, i: usize);

    /// What the last answer says.
    fn counted(&self) -> Counted;
}

impl Timed for Box<dyn Grounded + '_> {
    fn forget(&mut self) {
        (**self).forget();
    }

    fn run_backwards(&mut self, count: usize) {
        (0..count).rev().for_each(|i| self.ask(i));
    }

    fn run(&mut self, queries: Range<usize>) {
        for i in queries {
            self.ask(i);
            std::hint::black_box(&mut *self);
        }
    }
}

/// A method on a scene.
struct Row {
    surface: &'static str,
    body: &'static str,
    motion: &'static str,
    method: &'static str,
    count: usize,
    time: Time,
    all: Counted,
}

pub fn run(options: &Options) -> Result<(), String> {
    let steps = options.count.div_ceil(BODIES);
    let mut rows = Vec::new();
    for (surface, kind_of_surface) in SURFACES {
        let hills = Hills::new(kind_of_surface);
        eprintln!(
            "{surface}: {} triangles, at most {:.1}° steep",
            hills.triangles.len(),
            hills.steepest().to_degrees()
        );
        for (body, kind) in KINDS {
            for (motion, slide) in MOTIONS {
                let scene = Scene { surface, body, motion, hills: &hills, kind, slide, steps };
                rows.extend(scene.measure(options).map_err(|e| format!("{surface}, {body}, {motion}: {e}"))?);
            }
        }
    }
    print(&rows);
    let rays = rays::measure(options)?;
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        report::write(&path.with_file_name(format!("{stem}-rays.csv")), options.passes, &rays)?;
    }
    Ok(())
}

struct Scene<'a> {
    surface: &'static str,
    body: &'static str,
    motion: &'static str,
    hills: &'a Hills,
    kind: scenes::Kind,
    slide: f64,
    steps: usize,
}

impl Scene<'_> {
    fn measure(&self, options: &Options) -> Result<Vec<Row>, String> {
        let told = |error: swiftprox::error::Error| error.to_string();
        let ground = self.hills.ground().map_err(told)?;
        let poses = scenes::poses(self.hills, self.kind, self.slide, self.steps).map_err(told)?;
        let mesh = self.kind.mesh().map_err(told)?;
        let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).map_err(told)?;
        let mut methods: Vec<Box<dyn Grounded + '_>> = vec![
            Box::new(ours::Ours::new(ground, &shape, &poses)),
            Box::new(parry::Parry::new(self.hills, self.kind, &poses, parry::Edges::Bare)?),
            Box::new(parry::Parry::new(self.hills, self.kind, &poses, parry::Edges::Fixed)?),
        ];
        for removes_edges in [false, true] {
            if let Some(method) = jolt::Jolt::new(self.hills, self.kind, &poses, removes_edges)? {
                methods.push(Box::new(method));
            }
        }
        methods.retain(|method| options.methods.is_empty() || options.methods.iter().any(|name| name == method.name()));
        let all: Vec<Counted> = methods.iter_mut().map(|method| counted(method.as_mut(), poses.len())).collect();
        let times = time_methods(&mut methods, poses.len(), options.passes);
        let found = methods.iter().zip(times).zip(all);
        Ok(found
            .map(|((method, time), all)| Row {
                surface: self.surface,
                body: self.body,
                motion: self.motion,
                method: method.name(),
                count: poses.len(),
                time,
                all,
            })
            .collect())
    }
}

/// All that a method finds in a pass.
fn counted(method: &mut dyn Grounded, count: usize) -> Counted {
    method.forget();
    let mut all = Counted::default();
    for i in 0..count {
        method.ask(i);
        let Counted { normals, points, ghosts } = method.counted();
        all = Counted { normals: all.normals + normals, points: all.points + points, ghosts: all.ghosts + ghosts };
    }
    all
}

fn csv(rows: &[Row]) -> String {
    let mut text = "surface,body,motion,method,count,best_ns,median_ns,normals,points,ghosts\n".to_string();
    for Row { surface, body, motion, method, count, time: Time { best, median }, all } in rows {
        let Counted { normals, points, ghosts } = all;
        let _ = writeln!(
            text,
            "{surface},{body},{motion},{method},{count},{best:.1},{median:.1},{normals},{points},{ghosts}"
        );
    }
    text
}

/// A row for each scene: of each method ns a body, of peers how many times as long as ours, and ghosts of all normals.
fn print(rows: &[Row]) {
    let methods = report::in_order(rows.iter().map(|row| row.method));
    println!("| ground | body | motion | {} |\n|---|---|---|{}", methods.join(" | "), "--:|".repeat(methods.len()));
    for scene in rows.chunks(methods.len().max(1)) {
        let own = scene.iter().find(|row| row.method == ours::NAME).map_or(f64::NAN, |row| row.time.best);
        let cell = |row: &Row| {
            let (time, Counted { normals, points, ghosts }) = (row.time.best, row.all);
            format!("{time:.0} ({:.2}), {ghosts} of {normals}, {points} points", time / own)
        };
        let cells: Vec<String> = scene.iter().map(cell).collect();
        println!("| {} | {} | {} | {} |", scene[0].surface, scene[0].body, scene[0].motion, cells.join(" | "));
    }
}
