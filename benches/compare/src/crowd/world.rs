//! Many bodies that move: their meshes, and their poses step by step, each a function of the seed alone.

use std::f64::consts::TAU;

use swiftprox::math::{Matrix, Vector};
use swiftprox::mesh::PolygonMesh;
use testkit::models::{ELLIPSOIDS, cuboid, ellipsoid, random_hull};
use testkit::random::{Random, rotation};

/// What the bodies are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bodies {
    /// Hulls of 102 points on one of the benchmark's ellipsoids.
    Alike(&'static str),
    /// Hulls of 8 to 1,002 vertices: all the benchmark's ellipsoids and random points, half axes 0.3 to 1.
    Mixed,
    /// Spheres of radius 1.
    Spheres,
    /// Cubes of the spheres' volume.
    Cubes,
}

impl Bodies {
    /// Whether parry has a shape and queries of its own for them.
    pub fn are_primitives(self) -> bool {
        matches!(self, Bodies::Spheres | Bodies::Cubes)
    }

    /// Of the ball that is swept over each mesh.
    pub fn radius(self) -> f64 {
        if self == Bodies::Spheres { 1.0 } else { 0.0 }
    }
}

/// How they move from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// All by up to 2 % of the radius and 1°.
    All,
    /// All by normal deviates of 2 % of the radius along each axis, and by 2°, closer together: little of what one step says is
    /// good for the next.
    Brisk,
    /// The same, but only one body in 20, others in each step.
    Some,
    /// One body in 100.
    Few,
    /// None, after the first step: a pile of layers that touch.
    Rest,
    /// All, to anywhere.
    Teleport,
}

pub const MOTIONS: [Motion; 6] =
    [Motion::All, Motion::Brisk, Motion::Some, Motion::Few, Motion::Rest, Motion::Teleport];

impl Motion {
    pub fn name(self) -> &'static str {
        match self {
            Motion::All => "all",
            Motion::Brisk => "brisk",
            Motion::Some => "5%",
            Motion::Few => "1%",
            Motion::Rest => "rest",
            Motion::Teleport => "teleport",
        }
    }
}

/// One step: the bodies that move, and the poses of all of them, row-major `[R|T]`.
pub struct Step {
    pub moved: Vec<u32>,
    pub poses: Vec<[f64; 12]>,
}

/// Bodies of radius 1 and less to so many cubes of side 1: about 1.7 pairs of boxes a body overlap.
const DENSITY: f64 = 0.053;

/// The same where they move briskly.
const BRISK_DENSITY: f64 = 0.065;

/// How far they move along an axis in a step.
const WAY: f64 = 0.02;

const DEGREE: f64 = TAU / 360.0;

pub struct World {
    pub kind: Bodies,
    pub meshes: Vec<PolygonMesh>,
    /// The mesh of each body.
    pub mesh_of: Vec<u32>,
    motion: Motion,
    side: f64,
    bodies: Vec<Body>,
    random: Random,
    steps: u32,
}

struct Body {
    at: Vector,
    turn: Matrix,
    velocity: Vector,
    spin: Matrix,
}

impl World {
    pub fn new(kind: Bodies, motion: Motion, count: usize) -> Result<World, String> {
        let mut random = Random::new(0x5ce7e + count as u64);
        let meshes = meshes(kind).map_err(|e| e.to_string())?;
        let mesh_of = (0..count).map(|_| random.below(meshes.len()) as u32).collect();
        let density = if motion == Motion::Brisk { BRISK_DENSITY } else { DENSITY };
        let side = (count as f64 / density).cbrt();
        let bodies = (0..count).map(|_| Body::new(side, motion, &mut random)).collect();
        let mut world = World { kind, meshes, mesh_of, motion, side, bodies, random, steps: 0 };
        if motion == Motion::Rest {
            world.pile_up();
        }
        Ok(world)
    }

    /// Layers of bodies that stand side by side, their boxes touching and a little more.
    fn pile_up(&mut self) {
        let row = (self.bodies.len() as f64).cbrt().ceil() as usize;
        for (i, body) in self.bodies.iter_mut().enumerate() {
            let cell = [i % row, i / row % row, i / (row * row)].map(|k| k as f64);
            body.at = Vector::from(cell) * 1.9;
            body.turn = Matrix::identity();
        }
    }

    /// The next steps.
    pub fn steps(&mut self, count: usize) -> Vec<Step> {
        (0..count).map(|_| self.step()).collect()
    }

    fn step(&mut self) -> Step {
        let is_first = self.steps == 0;
        self.steps += 1;
        let mut moved = Vec::new();
        for (i, body) in (0..).zip(&mut self.bodies) {
            let moves = match self.motion {
                Motion::All | Motion::Brisk | Motion::Teleport => true,
                Motion::Some => self.random.below(20) == 0,
                Motion::Few => self.random.below(100) == 0,
                Motion::Rest => false,
            };
            if moves {
                if self.motion == Motion::Teleport {
                    *body = Body::new(self.side, self.motion, &mut self.random);
                } else {
                    body.go_on(self.side);
                }
            }
            if moves || is_first {
                moved.push(i);
            }
        }
        Step { moved, poses: self.bodies.iter().map(Body::pose).collect() }
    }
}

impl Body {
    fn new(side: f64, motion: Motion, random: &mut Random) -> Body {
        let at = Vector::from_fn(|_, _| random.uniform(0.0, side));
        let axis = random.direction();
        let is_brisk = motion == Motion::Brisk;
        let spin = rotation(&axis, if is_brisk { 2.0 * DEGREE } else { random.uniform(0.0, DEGREE) });
        let turn = random.rotation();
        let velocity = if is_brisk { Vector::from_fn(|_, _| normal_deviate(random)) } else { random.vector() };
        Body { at, turn, velocity: velocity * WAY, spin }
    }

    /// Bounces off the walls.
    fn go_on(&mut self, side: f64) {
        self.at += self.velocity;
        for k in 0..3 {
            if !(0.0..=side).contains(&self.at[k]) {
                self.velocity[k] = if self.at[k] < 0.0 { self.velocity[k].abs() } else { -self.velocity[k].abs() };
            }
        }
        // Products drift off rotations; one step of Newton's method towards the nearest one undoes that, as simulators do.
        let turn = self.spin * self.turn;
        self.turn = turn * (1.5 * Matrix::identity() - 0.5 * turn.transpose() * turn);
    }

    fn pose(&self) -> [f64; 12] {
        std::array::from_fn(|k| if k % 4 == 3 { self.at[k / 4] } else { self.turn[(k / 4, k % 4)] })
    }
}

/// By Box and Muller.
fn normal_deviate(random: &mut Random) -> f64 {
    let radius = (-2.0 * random.uniform(f64::MIN_POSITIVE, 1.0).ln()).sqrt();
    radius * random.uniform(0.0, TAU).cos()
}

fn meshes(bodies: Bodies) -> swiftprox::error::Result<Vec<PolygonMesh>> {
    match bodies {
        Bodies::Alike(name) => {
            let (_, half_axes) = ELLIPSOIDS.iter().find(|(known, _)| *known == name).expect("a model of the benchmark");
            Ok(vec![ellipsoid(*half_axes, 102)?])
        }
        Bodies::Mixed => {
            let mut meshes = Vec::new();
            for (k, n) in [8, 30, 102, 300, 1002].into_iter().enumerate() {
                let scale = [0.3, 1.0, 0.6, 0.8, 0.45][k];
                for (_, half_axes) in ELLIPSOIDS {
                    meshes.push(ellipsoid(half_axes.map(|a| a * scale), n)?);
                }
                meshes.push(random_hull(n / 2 + 8, n as u64)?);
            }
            Ok(meshes)
        }
        Bodies::Spheres => Ok(vec![PolygonMesh::new(vec![Vector::zeros()], Vec::new(), None)?]),
        Bodies::Cubes => Ok(vec![cuboid([0.5 * (2.0 * TAU / 3.0).cbrt(); 3])?]),
    }
}
