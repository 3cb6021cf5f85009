//! Motions of the comparison, and the truth about them: answers that are proved anew, and looked at by the judge of the tests.

use std::sync::Arc;

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Screw, cast, verify_cast};
use swiftprox::pair::PairCache;
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::casts::Case;
use testkit::casts::judge::by_samples;
use testkit::models::{cuboid, ellipsoid, random_hull};
use testkit::random::Random;

/// Two bodies, and how they move.
pub struct Scene {
    pub name: String,
    pub meshes: [PolygonMesh; 2],
    pub cases: Vec<Case>,
    /// Radians that a body turns by, at most.
    pub turn: f64,
}

/// What is true of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Truth {
    Free,
    /// The first contact is between these times.
    Hit([f64; 2]),
    /// They come nearer than rounding tells, first at about this time.
    Near(f64),
}

/// What scenes are made of.
struct Recipe {
    name: &'static str,
    meshes: fn() -> swiftprox::error::Result<[PolygonMesh; 2]>,
    motions: fn(&mut Random, f64) -> [Motion<'static>; 2],
    /// What `motions` is given: a turn in radians or a clearance.
    number: f64,
    turn: f64,
    /// Of the count that is asked for one in so many: the others take too long with some method.
    rarity: usize,
}

const GRAZING_TURN: f64 = 1.5;

const RECIPES: [Recipe; 14] = [
    Recipe { name: "bullet, plate 1e-3", meshes: bullet, motions: shot, number: 0.0, turn: 0.0, rarity: 1 },
    Recipe { name: "bullet, spin 5", meshes: bullet, motions: shot, number: 5.0, turn: 5.0, rarity: 1 },
    Recipe { name: "hulls 20, spin 2", meshes: || hulls(20), motions: passing, number: 2.0, turn: 2.0, rarity: 1 },
    Recipe { name: "hulls 200, spin 2", meshes: || hulls(200), motions: passing, number: 2.0, turn: 2.0, rarity: 1 },
    Recipe { name: "hulls 1000, spin 2", meshes: || hulls(1000), motions: passing, number: 2.0, turn: 2.0, rarity: 2 },
    Recipe { name: "hulls 200, no spin", meshes: || hulls(200), motions: passing, number: 0.0, turn: 0.0, rarity: 1 },
    Recipe { name: "hulls 200, spin 20", meshes: || hulls(200), motions: passing, number: 20.0, turn: 20.0, rarity: 1 },
    Recipe { name: "needles, 6 rad", meshes: needles, motions: passing, number: 6.0, turn: 6.0, rarity: 1 },
    Recipe { name: "hull by box, 0.3 rad", meshes: hull_and_box, motions: passing, number: 0.3, turn: 0.3, rarity: 1 },
    Recipe { name: "graze 1e-6", meshes: squares, motions: grazing, number: 1e-6, turn: GRAZING_TURN, rarity: 12 },
    Recipe { name: "graze 1e-12", meshes: squares, motions: grazing, number: 1e-12, turn: GRAZING_TURN, rarity: 12 },
    Recipe { name: "graze 0", meshes: squares, motions: grazing, number: 0.0, turn: GRAZING_TURN, rarity: 12 },
    Recipe {
        name: "graze, overlap 1e-6",
        meshes: squares,
        motions: grazing,
        number: -1e-6,
        turn: GRAZING_TURN,
        rarity: 12,
    },
    Recipe { name: "slide at 1e-12", meshes: squares, motions: sliding, number: 1e-12, turn: 0.0, rarity: 12 },
];

/// All scenes whose names begin so; empty: all.
pub fn scenes(count: usize, wanted: &[String]) -> Result<Vec<Scene>, String> {
    let chosen =
        |recipe: &&Recipe| wanted.is_empty() || wanted.iter().any(|name| recipe.name.starts_with(name.as_str()));
    RECIPES.iter().filter(chosen).map(|recipe| scene(recipe, count.div_ceil(recipe.rarity))).collect()
}

fn scene(recipe: &Recipe, count: usize) -> Result<Scene, String> {
    let meshes = (recipe.meshes)().map_err(|error| error.to_string())?;
    let shape =
        |mesh| Shape::from_mesh(mesh, &ShapeOptions::default()).map(Arc::new).map_err(|error| error.to_string());
    let shapes = [shape(&meshes[0])?, shape(&meshes[1])?];
    let mut random = Random::new(0xca57);
    let case = |_| Case {
        shapes: shapes.clone(),
        motions: (recipe.motions)(&mut random, recipe.number),
        config: CastConfig::default(),
        is_exact: false,
    };
    let cases = (0..count).map(case).collect();
    Ok(Scene { name: recipe.name.into(), meshes, cases, turn: recipe.turn })
}

impl Scene {
    /// The truth about each motion.
    ///
    /// # Errors
    /// An answer that is not proved, or that the judge refutes.
    pub fn truths(&self) -> Result<Vec<Truth>, String> {
        const SAMPLES: u32 = 200;
        let truth = |case: &Case| {
            let mut answer = CastAnswer::default();
            let told = |error: swiftprox::error::Error| format!("{}: {error}", self.name);
            cast(case.bodies(), &mut PairCache::default(), &case.config, &mut answer).map_err(told)?;
            verify_cast(case.bodies(), &case.config, &answer).map_err(told)?;
            by_samples(case, &answer, SAMPLES).map_err(|why| format!("{}: {why}", self.name))?;
            match answer.outcome {
                CastOutcome::Free => Ok(Truth::Free),
                CastOutcome::Hit => Ok(Truth::Hit([answer.time_lower, answer.time_upper])),
                CastOutcome::Near => Ok(Truth::Near(answer.time_lower)),
                outcome => Err(format!("{}: {outcome:?}", self.name)),
            }
        };
        self.cases.iter().map(truth).collect()
    }
}

type Meshes = swiftprox::error::Result<[PolygonMesh; 2]>;

fn bullet() -> Meshes {
    Ok([cuboid([0.01; 3])?, cuboid([1.0, 1.0, 5e-4])?])
}

fn hulls(n: usize) -> Meshes {
    Ok([random_hull(n, 1)?, random_hull(n, 2)?])
}

fn needles() -> Meshes {
    Ok([ellipsoid([1.0, 1e-3, 1e-3], 20)?, ellipsoid([1.0, 1e-3, 1e-3], 20)?])
}

fn hull_and_box() -> Meshes {
    Ok([random_hull(20, 1)?, cuboid([0.5, 0.5, 0.5])?])
}

/// A prism whose corners pass at a distance of 1, and a wall.
fn squares() -> Meshes {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    Ok([cuboid([half, half, 0.3])?, cuboid([0.5, 5.0, 5.0])?])
}

fn screw(start: Pose, velocity: Vector, rotation: Vector) -> Motion<'static> {
    Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation })
}

/// A bullet at 40 to 100 plates' widths a unit of time, three in four through the plate.
fn shot(random: &mut Random, turn: f64) -> [Motion<'static>; 2] {
    let aim = Vector::new(random.uniform(-1.15, 1.15), random.uniform(-1.15, 1.15), 0.0);
    let along = Vector::new(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1.0);
    let velocity = along * random.uniform(40.0, 100.0);
    let start = Pose::new(&random.rotation(), &(aim - velocity * random.uniform(0.2, 0.8)));
    [screw(start, velocity, random.direction() * turn), Motion::Fixed(Pose::IDENTITY)]
}

/// Both turn, one flies by or into the other.
fn passing(random: &mut Random, turn: f64) -> [Motion<'static>; 2] {
    let velocity = random.direction() * random.uniform(4.0, 8.0);
    let aside = velocity.cross(&random.direction()).normalize() * random.uniform(0.0, 1.6);
    let start = Pose::new(&random.rotation(), &(aside - velocity * random.uniform(0.4, 0.6)));
    let other = Pose::new(&random.rotation(), &Vector::zeros());
    let spins = [0, 1].map(|_| random.direction() * turn);
    [screw(start, velocity, spins[0]), screw(other, Vector::zeros(), spins[1])]
}

/// A corner passes a wall at a clearance.
fn grazing(random: &mut Random, clearance: f64) -> [Motion<'static>; 2] {
    let world = Pose::new(&random.rotation(), &random.vector());
    let wall = Pose::new(&world.rotation(), &world.transform(&Vector::new(1.5 + clearance, 0.0, 0.0)));
    [screw(world, Vector::zeros(), world.rotate(&Vector::z()) * GRAZING_TURN), Motion::Fixed(wall)]
}

/// A box slides along a wall at a clearance.
fn sliding(random: &mut Random, clearance: f64) -> [Motion<'static>; 2] {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let world = Pose::new(&random.rotation(), &random.vector());
    let wall = Pose::new(&world.rotation(), &world.transform(&Vector::new(half + 0.5 + clearance, 0.0, 0.0)));
    let velocity = world.rotate(&Vector::new(0.0, random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)));
    [screw(world, velocity, Vector::zeros()), Motion::Fixed(wall)]
}
