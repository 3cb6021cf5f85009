//! A three-axis sweep and prune as Ehmann & Lin had it (Baraff 1992; Cohen, Lin, Manocha & Ponamgi 1995): the ends of all boxes
//! are kept sorted on each axis by insertion, overlapping pairs in a table. The pairs go to this library's pair layer.

use std::collections::HashMap;

use swiftprox::math::Pose;
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};

#[derive(Debug, Clone, Copy)]
struct End {
    at: f64,
    body: u32,
    is_upper: bool,
}

pub struct Sweep {
    question: Question,
    shapes: Vec<Shape>,
    shape_of: Vec<u32>,
    poses: Vec<Pose>,
    boxes: Vec<[[f64; 3]; 2]>,
    axes: [Vec<End>; 3],
    pairs: HashMap<(u32, u32), PairCache>,
    steps: Vec<Vec<(u32, Pose)>>,
}

impl Sweep {
    pub fn new(world: &World, question: Question) -> Result<Sweep, String> {
        let shapes = world.meshes.iter().map(|mesh| Shape::from_mesh(mesh, &ShapeOptions::default()));
        let shapes = shapes.collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        let count = world.mesh_of.len();
        Ok(Sweep {
            question,
            shapes,
            shape_of: world.mesh_of.clone(),
            poses: vec![Pose::IDENTITY; count],
            boxes: vec![[[0.0; 3]; 2]; count],
            axes: Default::default(),
            pairs: HashMap::new(),
            steps: Vec::new(),
        })
    }

    fn update_box(&mut self, i: u32) {
        let polyhedron = self.shapes[self.shape_of[i as usize] as usize].polyhedron();
        let margin = if self.question == Question::Distance { 0.5 * TOLERANCE } else { 0.0 };
        let mut tight = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for v in 0..polyhedron.vertices.len() as u32 {
            let p = self.poses[i as usize].transform(&polyhedron.local_position(v));
            for axis in 0..3 {
                tight[0][axis] = tight[0][axis].min(p[axis] - margin);
                tight[1][axis] = tight[1][axis].max(p[axis] + margin);
            }
        }
        self.boxes[i as usize] = tight;
    }

    fn overlap(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|i| &self.boxes[i as usize]);
        (0..3).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
    }

    /// All from nothing: sorted, and swept along the first axis.
    fn begin(&mut self) {
        for axis in 0..3 {
            self.axes[axis] = (0..self.boxes.len() as u32)
                .flat_map(|body| [false, true].map(|is_upper| End { at: 0.0, body, is_upper }))
                .collect();
        }
        self.read_ends();
        self.axes
            .iter_mut()
            .for_each(|ends| ends.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.is_upper.cmp(&b.is_upper))));
        let mut open: Vec<u32> = Vec::new();
        for end in self.axes[0].clone() {
            if end.is_upper {
                open.retain(|body| *body != end.body);
                continue;
            }
            for &other in &open {
                if self.overlap(end.body, other) {
                    self.pairs.insert(ordered(end.body, other), PairCache::default());
                }
            }
            open.push(end.body);
        }
    }

    fn read_ends(&mut self) {
        for (axis, ends) in self.axes.iter_mut().enumerate() {
            ends.iter_mut().for_each(|end| end.at = self.boxes[end.body as usize][usize::from(end.is_upper)][axis]);
        }
    }

    fn sort(&mut self) {
        self.read_ends();
        for axis in 0..3 {
            let mut ends = std::mem::take(&mut self.axes[axis]);
            for i in 1..ends.len() {
                let end = ends[i];
                let mut j = i;
                while j > 0 && ends[j - 1].at > end.at {
                    let other = ends[j - 1];
                    match (end.is_upper, other.is_upper) {
                        (false, true) if self.overlap(end.body, other.body) => {
                            self.pairs.entry(ordered(end.body, other.body)).or_default();
                        }
                        (true, false) => {
                            self.pairs.remove(&ordered(end.body, other.body));
                        }
                        _ => {}
                    }
                    ends[j] = other;
                    j -= 1;
                }
                ends[j] = end;
            }
            self.axes[axis] = ends;
        }
    }
}

fn ordered(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Crowd for Sweep {
    fn name(&self) -> &'static str {
        "sweep-and-prune"
    }

    fn load(&mut self, steps: &[Step]) {
        let pose = |step: &Step, i: u32| (i, Pose::from_row_major(&step.poses[i as usize]));
        self.steps = steps.iter().map(|step| step.moved.iter().map(|&i| pose(step, i)).collect()).collect();
    }

    fn step(&mut self, k: usize) -> Found {
        for (i, pose) in std::mem::take(&mut self.steps[k]) {
            self.poses[i as usize] = pose;
            self.update_box(i);
        }
        if self.axes[0].is_empty() {
            self.begin();
        } else {
            self.sort();
        }
        let config = PairConfig { max_distance: TOLERANCE, ..PairConfig::default() };
        let (mut found, mut answer) = (Found::default(), PairAnswer::default());
        for (&(a, b), cache) in &mut self.pairs {
            let [first, second] =
                [a, b].map(|i| self.shapes[self.shape_of[i as usize] as usize].at(&self.poses[i as usize]));
            let ask = match self.question {
                Question::Intersection => pair::intersection,
                Question::Distance => pair::distance,
                Question::Contact => pair::contact,
            };
            ask([first, second], cache, &config, &mut answer).expect("rigid poses");
            let is_listed = match self.question {
                Question::Intersection | Question::Contact => answer.outcome == Outcome::Intersecting,
                Question::Distance => answer.outcome != Outcome::Beyond,
            };
            if is_listed {
                found.pairs += 1;
                found.sum += answer.distance;
            }
        }
        found
    }
}
