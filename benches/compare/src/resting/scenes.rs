//! Bodies that rest on each other as a simulator sees them: a little in each other, they creep and turn a little from step to step.

use parry3d_f64::shape::{Cuboid, Shape as ParryShape};
use swiftprox::error::Result;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{PairConfig, SignedDistance, SignedDistanceCache, signed_distance};
use swiftprox::shape::Shape;

use crate::bodies::manifold::parry_polyhedron;
use testkit::PosePair;
use testkit::models::{cuboid, ellipsoid};
use testkit::orbits::pose_pair;
use testkit::random::{Random, rotation};

/// A body of a scene.
#[derive(Clone, Copy)]
pub enum Kind {
    /// A cube of half extents 1.
    Cube,
    /// A plate 40 long and wide and 2 thick.
    Plate,
    /// The hull of so many points on the unit sphere.
    Hull(usize),
}

impl Kind {
    pub fn mesh(self) -> Result<PolygonMesh> {
        match self {
            Kind::Cube | Kind::Plate => cuboid(self.half_extents()),
            Kind::Hull(n) => ellipsoid([1.0; 3], n),
        }
    }

    /// As parry has it: boxes are no polyhedra there.
    pub fn of_parry(self, triangles: &PolygonMesh) -> Option<Box<dyn ParryShape>> {
        match self {
            Kind::Cube | Kind::Plate => Some(Box::new(Cuboid::new(self.half_extents().into()))),
            Kind::Hull(_) => parry_polyhedron(triangles),
        }
    }

    fn half_extents(self) -> [f64; 3] {
        if let Kind::Plate = self { [20.0, 20.0, 1.0] } else { [1.0; 3] }
    }
}

/// How the bodies stand when they begin to rest.
#[derive(Clone, Copy, PartialEq)]
enum Stand {
    /// Face on face, the upper body turned by so many degrees about the vertical, and nothing moves.
    Still(f64),
    /// Face on face, the upper body turned anyhow about the vertical.
    Flat,
    /// The upper body stands on an edge.
    Edge,
    /// Both lie edge across edge.
    Edges,
    /// The upper body anyhow, and the lower one unless it is a plate.
    Anyhow,
}

/// A scene: the lower body, the upper body, how far aside its centre is, and how they stand.
pub struct Scene {
    pub name: &'static str,
    pub bodies: [Kind; 2],
    aside: [f64; 2],
    stand: Stand,
}

const fn scene(name: &'static str, bodies: [Kind; 2], aside: [f64; 2], stand: Stand) -> Scene {
    Scene { name, bodies, aside, stand }
}

use Kind::{Cube, Hull, Plate};

pub const SCENES: [Scene; 15] = [
    scene("box on box, still", [Cube, Cube], [0.1, 0.07], Stand::Still(0.0)),
    scene("box on box, still, turned", [Cube, Cube], [0.1, 0.07], Stand::Still(30.0)),
    scene("box on box, wobbling", [Cube, Cube], [0.1, 0.07], Stand::Flat),
    scene("box on box, overhanging", [Cube, Cube], [1.2, 0.1], Stand::Flat),
    scene("box on plate", [Plate, Cube], [3.1, 2.2], Stand::Flat),
    scene("box over a plate's rim", [Plate, Cube], [20.2, 2.2], Stand::Flat),
    scene("box on an edge on plate", [Plate, Cube], [3.1, 2.2], Stand::Edge),
    scene("box edge on box edge", [Cube, Cube], [0.1, 0.05], Stand::Edges),
    scene("box on box, piled", [Cube, Cube], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 20 on plate", [Plate, Hull(20)], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 20 on box", [Cube, Hull(20)], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 102 on box", [Cube, Hull(102)], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 20 on hull of 20", [Hull(20), Hull(20)], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 102 on hull of 102", [Hull(102), Hull(102)], [0.0, 0.0], Stand::Anyhow),
    scene("hull of 1002 on hull of 1002", [Hull(1002), Hull(1002)], [0.0, 0.0], Stand::Anyhow),
];

/// Steps that a pair rests before another begins to.
const REST: usize = 150;

/// How deep the bodies are in each other: drawn so that all orders of magnitude are alike, and growing or shrinking by up to 5 % a
/// step.
const DEPTHS: [f64; 2] = [1e-4, 1e-2];
const SINKING: f64 = 0.05;

/// By how much the upper body turns a step at most, in radians, and moves along each axis.
const TURN: f64 = 0.1 * DEGREE;
const MOVE: f64 = 1e-3;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// How far what lies flat leans at most, and how far anything wanders.
const LEAN: f64 = 0.3 * DEGREE;
const WANDERING: f64 = 0.1;

impl Scene {
    /// The poses of both bodies, step by step.
    pub fn poses(&self, shapes: [&Shape; 2], count: usize) -> Result<Vec<PosePair>> {
        let mut random = Random::new(29);
        let mut poses = Vec::with_capacity(count);
        while poses.len() < count {
            let mut rest = Rest::begin(self, &mut random);
            for _ in 0..REST.min(count - poses.len()) {
                rest.sink(shapes)?;
                poses.push(pose_pair(&rest.lower, &Vector::zeros(), &rest.upper, &rest.at));
                if !matches!(self.stand, Stand::Still(_)) {
                    rest.advance(&mut random);
                }
            }
        }
        Ok(poses)
    }
}

/// Two bodies at rest.
struct Rest {
    lower: Matrix,
    upper: Matrix,
    /// Where the upper body is, and where it began to rest.
    at: Vector,
    origin: [f64; 2],
    depth: f64,
    is_flat: bool,
}

impl Rest {
    fn begin(scene: &Scene, random: &mut Random) -> Rest {
        let [mut x, mut y] = scene.aside;
        let yaw = rotation(&Vector::z(), random.signed() * std::f64::consts::PI);
        let on_edge = |axis: Vector| rotation(&axis, 45.0 * DEGREE);
        let mut lower = Matrix::identity();
        let upper = match scene.stand {
            Stand::Still(degrees) => rotation(&Vector::z(), degrees * DEGREE),
            Stand::Flat => lean(random) * yaw,
            Stand::Edge => lean(random) * yaw * on_edge(Vector::x()),
            Stand::Edges => {
                lower = on_edge(Vector::y());
                lean(random) * rotation(&Vector::z(), 0.3 * random.signed()) * on_edge(Vector::x())
            }
            Stand::Anyhow => {
                (x, y) = (0.3 * random.signed(), 0.3 * random.signed());
                if !matches!(scene.bodies[0], Plate) {
                    lower = random.rotation();
                }
                random.rotation()
            }
        };
        let [low, high] = DEPTHS.map(f64::ln);
        let depth = random.uniform(low, high).exp();
        Rest { lower, upper, at: Vector::new(x, y, 4.0), origin: [x, y], depth, is_flat: scene.stand == Stand::Flat }
    }

    fn advance(&mut self, random: &mut Random) {
        let turned = rotation(&random.direction(), TURN * random.signed()) * self.upper;
        let tilt = turned.column(2).xy().norm();
        if !self.is_flat || tilt <= LEAN.sin() {
            self.upper = orthonormal(&turned);
        }
        for (axis, origin) in self.origin.iter().enumerate() {
            let moved = self.at[axis] + MOVE * random.signed();
            if (moved - origin).abs() <= WANDERING {
                self.at[axis] = moved;
            }
        }
        self.depth = (self.depth * (1.0 + SINKING * random.signed())).clamp(DEPTHS[0], DEPTHS[1]);
    }

    /// Moves the upper body up or down until it is as deep as it should be, up to 0.1 %.
    fn sink(&mut self, [shape1, shape2]: [&Shape; 2]) -> Result<()> {
        let pose1 = Pose::new(&self.lower, &Vector::zeros());
        for _ in 0..20 {
            let pose2 = Pose::new(&self.upper, &self.at);
            let (mut cache, mut answer) = (SignedDistanceCache::default(), SignedDistance::default());
            let bodies = [shape1.at(&pose1), shape2.at(&pose2)];
            signed_distance(bodies, &mut cache, &PairConfig::default(), &mut answer)?;
            let missing = answer.distance + self.depth;
            if missing.abs() <= 1e-3 * self.depth {
                break;
            }
            // The normal is from the upper body to the lower one.
            let slope = answer.normal[2].abs();
            self.at.z -= missing / if slope > 0.2 { slope } else { 1.0 };
        }
        Ok(())
    }
}

fn lean(random: &mut Random) -> Matrix {
    let axis = Vector::new(random.signed(), random.signed(), 0.0);
    if axis.norm() > 1e-3 { rotation(&axis.normalize(), LEAN * random.uniform(0.0, 1.0)) } else { Matrix::identity() }
}

/// The rotation next to a matrix that is nearly one.
fn orthonormal(m: &Matrix) -> Matrix {
    let x = m.column(0).normalize();
    let y = (m.column(1) - x * x.dot(&m.column(1))).normalize();
    Matrix::from_columns(&[x, y, x.cross(&y)])
}
