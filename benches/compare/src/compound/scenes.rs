//! Bodies of many pieces, and how they move past each other.

use swiftprox::compound::{Compound, CompoundAnswer, CompoundCache, distance};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::PairConfig;
use testkit::PosePair;
use testkit::orbits::pose_pair;
use testkit::random::{Random, rotation};

pub const MOTIONS: [&str; 6] = ["random", "near", "orbit", "slow", "far", "linked"];

/// The corners of each piece.
pub type Pieces = Vec<Vec<Vector>>;

/// No body reaches farther from its origin.
const RADIUS: f64 = 1.4;

/// Each of them is asked against itself.
pub fn bodies() -> [(&'static str, Pieces); 5] {
    [
        ("gear", gear(40)),
        ("torus-16", torus(16)),
        ("torus-64", torus(64)),
        ("torus-180", torus(180)),
        ("torus-500", torus(500)),
    ]
}

/// Only rings can be linked.
pub fn has(name: &str, motion: &str) -> bool {
    motion != "linked" || name.starts_with("torus")
}

/// A sector of a ring between two angles and two radii.
fn sector([from, to]: [f64; 2], radii: [f64; 2], half_height: f64) -> Vec<Vector> {
    let corner = |angle: f64, radius: f64, z: f64| Vector::new(radius * angle.cos(), radius * angle.sin(), z);
    let at = |angle: f64| radii.map(|radius| [-half_height, half_height].map(|z| corner(angle, radius, z)));
    [at(from), at(to)].as_flattened().as_flattened().to_vec()
}

pub fn torus(count: usize) -> Pieces {
    let turn = std::f64::consts::TAU / count as f64;
    (0..count).map(|k| sector([k as f64 * turn, (k + 1) as f64 * turn], [0.7, 1.3], 0.3)).collect()
}

/// Sectors of a hub, a tooth on each.
pub fn gear(teeth: usize) -> Pieces {
    let turn = std::f64::consts::TAU / teeth as f64;
    let at = |k: usize, step: f64| (k as f64 + step) * turn;
    let of_tooth = |k: usize| {
        [sector([at(k, 0.0), at(k, 1.0)], [0.5, 1.2], 0.15), sector([at(k, 0.25), at(k, 0.75)], [1.15, 1.38], 0.15)]
    };
    (0..teeth).flat_map(of_tooth).collect()
}

/// A seat on four legs, and a back, 1 wide and deep; its feet are 0.5 below the origin.
pub fn chair() -> Pieces {
    let cuboid = |low: [f64; 3], high: [f64; 3]| -> Vec<Vector> {
        (0..8usize).map(|corner| Vector::from_fn(|k, _| if corner >> k & 1 == 0 { low[k] } else { high[k] })).collect()
    };
    let leg = |x: f64, y: f64| cuboid([x - 0.05, y - 0.05, -0.5], [x + 0.05, y + 0.05, 0.0]);
    vec![
        cuboid([-0.6, -0.6, 0.0], [0.6, 0.6, 0.08]),
        cuboid([-0.6, 0.5, 0.08], [0.6, 0.6, 1.0]),
        leg(-0.55, -0.55),
        leg(0.55, -0.55),
        leg(-0.55, 0.55),
        leg(0.55, 0.55),
    ]
}

/// A hollow link of 20 pieces along z, its foot at the origin.
pub fn tube(radius: f64, bore: f64, length: f64) -> Pieces {
    const SIDES: usize = 10;
    let turn = std::f64::consts::TAU / SIDES as f64;
    let half = |middle: f64| {
        (0..SIDES).map(move |k| {
            let piece = sector([k as f64 * turn, (k + 1) as f64 * turn], [bore, radius], 0.25 * length);
            piece.into_iter().map(|point| point + Vector::z() * middle).collect()
        })
    };
    half(0.25 * length).chain(half(0.75 * length)).collect()
}

pub fn scaled(pieces: &Pieces, factor: f64) -> Pieces {
    pieces.iter().map(|points| points.iter().map(|point| point * factor).collect()).collect()
}

/// Body 2 stays at the origin, turned; body 1 moves.
pub fn poses(motion: &str, body: &Compound, count: usize) -> Result<Vec<PosePair>, String> {
    let mut random = Random::new(0xc0de);
    let still = random.rotation();
    let mut place = |k: usize| -> Result<[(Matrix, Vector); 2], String> {
        let second = (if motion == "random" || motion == "near" { random.rotation() } else { still }, Vector::zeros());
        let first = match motion {
            "random" => (random.rotation(), random.direction() * random.uniform(0.5 * RADIUS, 2.0 * RADIUS)),
            "far" => (random.rotation(), random.direction() * (5.0 * RADIUS)),
            "near" => {
                return near(body, [random.rotation(), second.0], random.direction()).map(|first| [first, second]);
            }
            "linked" => {
                let tilt = rotation(&random.direction(), 0.15 * random.signed());
                let upright = rotation(&Vector::x(), std::f64::consts::FRAC_PI_2);
                let offset = Vector::x() + random.vector() * 0.1;
                (still * tilt * upright, still * offset)
            }
            _ => {
                let degrees = if motion == "orbit" { 1.0 } else { 0.1 };
                let angle = (degrees * k as f64).to_radians();
                // Half of the poses intersect. In and out in 50 steps of 1°; or slowly apart.
                let way =
                    if motion == "orbit" { 0.5 * (7.2 * angle).sin() } else { 0.45 + 0.5 * k as f64 / count as f64 };
                let away = (1.15 + way) * RADIUS;
                let turn = rotation(&Vector::new(1.0, 2.0, 3.0).normalize(), angle);
                (turn, rotation(&Vector::new(2.0, -1.0, 2.0).normalize(), 0.5 * angle) * Vector::new(away, 0.0, 0.0))
            }
        };
        Ok([first, second])
    };
    (0..count).map(|k| place(k).map(|[(r1, t1), (r2, t2)]| pose_pair(&r1, &t1, &r2, &t2))).collect()
}

/// The bodies come along a direction until 1e-3 is between them.
fn near(body: &Compound, turns: [Matrix; 2], way: Vector) -> Result<(Matrix, Vector), String> {
    const GAP: f64 = 1e-3;
    let second = Pose::new(&turns[1], &Vector::zeros());
    let (mut cache, mut answer) = (CompoundCache::default(), CompoundAnswer::default());
    let mut away = 3.0 * RADIUS;
    for _ in 0..200 {
        let first = Pose::new(&turns[0], &(way * away));
        distance([body.at(&first), body.at(&second)], &mut cache, &PairConfig::default(), &mut answer)
            .map_err(|error| error.to_string())?;
        let between = answer.answer.distance;
        if between <= 1.01 * GAP {
            break;
        }
        away -= between - GAP;
    }
    Ok((turns[0], way * away))
}
