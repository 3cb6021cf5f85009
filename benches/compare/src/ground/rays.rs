//! Rays at height fields of up to a million triangles, beside parry's at its field and at its mesh: across the ground, half of them
//! nearly along it. Entries are compared ray by ray.

use std::fmt::Write;
use std::hint::black_box;
use std::ops::Range;

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::{Ray as ParryRay, RayCast};
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use swiftprox::ground::{Ground, HeightGrid};
use swiftprox::math::{Pose, Vector};
use swiftprox::ray::{Ray, RayOutcome};
use testkit::random::Random;

use super::scenes::SPACING;
use crate::options::Options;
use crate::timing::{Timed, time_methods};

/// Vertices along a side: 20,000 and a million triangles.
const SIDES: [usize; 2] = [101, 708];
const RAYS: usize = 2_000;
const LONG: f64 = 1e3;

pub fn measure(options: &Options) -> Result<String, String> {
    let mut text = "triangles,method,count,hits,best_ns,median_ns,off\n".to_string();
    for side in SIDES {
        let mut random = Random::new(0x6a7);
        let heights: Vec<f64> = (0..side * side).map(|_| random.uniform(-0.2, 0.2)).collect();
        let extent = (side - 1) as f64 * SPACING;
        let rays: Vec<Ray> = (0..RAYS).map(|i| ray(&mut random, extent, i % 2 == 0)).collect();
        let told = |error: swiftprox::error::Error| error.to_string();
        let field =
            Ground::from_heights(&HeightGrid { rows: side, columns: side, spacing: [SPACING; 2], heights: &heights })
                .map_err(told)?;
        let (vertices, triangles) = mesh(&heights, side);
        let soup = Ground::from_triangles(&vertices, &triangles).map_err(told)?;
        let points = vertices.iter().map(|v| ParryVector::new(v.x, v.y, v.z)).collect();
        let theirs =
            TriMesh::with_flags(points, triangles, TriMeshFlags::empty()).map_err(|error| error.to_string())?;
        let mut methods = [
            RayMethod { name: "swiftprox heights", surface: RaySurface::Ours(&field), rays: &rays },
            RayMethod { name: "swiftprox soup", surface: RaySurface::Ours(&soup), rays: &rays },
            RayMethod { name: "parry mesh", surface: RaySurface::Parry(&theirs), rays: &rays },
        ];
        let times = time_methods(&mut methods, RAYS, options.passes);
        let entries: Vec<Option<f64>> = (0..RAYS).map(|i| methods[0].entry(i)).collect();
        for (method, time) in methods.iter().zip(times) {
            let off = (0..RAYS).filter(|i| !agree(method.entry(*i), entries[*i])).count();
            let hits = (0..RAYS).filter(|i| method.entry(*i).is_some()).count();
            let count = 2 * (side - 1) * (side - 1);
            let row = format!("{count},{},{RAYS},{hits},{:.1},{:.1},{off}", method.name, time.best, time.median);
            eprintln!("{row}");
            let _ = writeln!(text, "{row}");
        }
    }
    Ok(text)
}

fn agree(one: Option<f64>, other: Option<f64>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => (one - other).abs() <= 1e-9 * (1.0 + other),
        (one, other) => one.is_none() == other.is_none(),
    }
}

/// From above the ground down to it, or nearly along it.
fn ray(random: &mut Random, extent: f64, is_flat: bool) -> Ray {
    let [x, y] = [random.uniform(0.1, 0.9) * extent, random.uniform(0.1, 0.9) * extent];
    let fall = if is_flat { random.uniform(0.01, 0.1) } else { random.uniform(0.3, 3.0) };
    let direction = Vector::new(random.signed(), random.signed(), -fall);
    Ray { origin: [x, y, random.uniform(0.3, 2.0)], direction: direction.normalize().into(), t_max: LONG }
}

fn mesh(heights: &[f64], side: usize) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let place = |at: usize| Vector::new((at % side) as f64 * SPACING, (at / side) as f64 * SPACING, heights[at]);
    let cells = (0..side - 1).flat_map(|i| (0..side - 1).map(move |j| (i * side + j) as u32));
    let wide = side as u32;
    let triangles = cells.flat_map(|at| [[at, at + 1, at + wide + 1], [at, at + wide + 1, at + wide]]);
    ((0..heights.len()).map(place).collect(), triangles.collect())
}

enum RaySurface<'a> {
    Ours(&'a Ground),
    Parry(&'a TriMesh),
}

struct RayMethod<'a> {
    name: &'static str,
    surface: RaySurface<'a>,
    rays: &'a [Ray],
}

impl RayMethod<'_> {
    fn entry(&self, i: usize) -> Option<f64> {
        let ray = &self.rays[i];
        match self.surface {
            RaySurface::Ours(ground) => {
                let found = ground.at(&Pose::IDENTITY).cast_ray(ray).expect("a ray in range");
                (found.answer.outcome == RayOutcome::Hit).then_some(found.answer.entry[0])
            }
            RaySurface::Parry(mesh) => {
                let theirs = ParryRay::new(ParryVector::from(ray.origin), ParryVector::from(ray.direction));
                let hit = mesh.cast_ray_and_get_normal(&ParryPose::IDENTITY, &theirs, ray.t_max, false);
                hit.map(|hit| hit.time_of_impact)
            }
        }
    }
}

impl Timed for RayMethod<'_> {
    fn forget(&mut self) {}

    fn run_backwards(&mut self, count: usize) {
        (0..count).rev().for_each(|i| _ = black_box(self.entry(i)));
    }

    fn run(&mut self, queries: Range<usize>) {
        queries.for_each(|i| _ = black_box(self.entry(i)));
    }
}
