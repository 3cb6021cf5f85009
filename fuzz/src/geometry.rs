//! Geometry from arbitrary bytes. Few bytes mean nothing hard: most numbers are small integers, powers of two and
//! neighbours of the number before, so that points coincide, faces line up and bodies touch, exactly or up to a few roundings.

use arbitrary::{Result, Unstructured};
use nalgebra::{Quaternion, UnitQuaternion};
use swiftprox::base::simd::environment::Environment;
use swiftprox::body::tables::{LookupKind, LookupOptions};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::PairCache;
use swiftprox::shape::{InputPolicy, ShapeOptions};

/// What doubles do badly.
const SPECIAL: [f64; 16] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    f64::EPSILON,
    1.0 - f64::EPSILON / 2.0,
    1.0 + f64::EPSILON,
    0.1,
    1e9,
    1e-9,
    1.0 / 3.0,
];

/// Where numbers come from.
struct Numbers {
    /// The number before.
    last: f64,
    /// Of any magnitude; else mostly between 2⁻⁶⁴ and 2⁶⁴, where floating point is at home.
    wild: bool,
}

impl Numbers {
    fn new(u: &mut Unstructured) -> Result<Numbers> {
        Ok(Numbers { last: 1.0, wild: u.ratio(1, 8)? })
    }

    /// A power of two, at most 1 if `small`.
    fn power(&self, u: &mut Unstructured, small: bool) -> Result<f64> {
        let [low, high] = if self.wild { [-1074, 1000] } else { [-64, 30] };
        Ok(power_of_two(u.int_in_range(low..=if small { 0 } else { high })?))
    }

    /// A finite double.
    fn number(&mut self, u: &mut Unstructured) -> Result<f64> {
        let number = any_number(u, &mut self.last)?;
        let magnitude = number.abs();
        let is_tame = magnitude == 0.0 || (power_of_two(-64)..=power_of_two(64)).contains(&magnitude);
        if number.is_finite() && (self.wild || is_tame) {
            return Ok(number);
        }
        self.last = 1.0;
        Ok(0.0)
    }

    /// A vector of finite numbers.
    fn vector(&mut self, u: &mut Unstructured) -> Result<Vector> {
        Ok(Vector::new(self.number(u)?, self.number(u)?, self.number(u)?))
    }
}

/// Any double at all, often one that has to do with the last one.
pub fn any_number(u: &mut Unstructured, last: &mut f64) -> Result<f64> {
    *last = match u.arbitrary::<u8>()? {
        // Small integers and eighths.
        tag @ 0..=63 => f64::from(tag) - 32.0,
        tag @ 64..=127 => (f64::from(tag) - 96.0) / 8.0,
        // The last number once more, or its neighbours, or its opposite.
        128..=143 => *last,
        tag @ 144..=175 => f64::from_bits(last.to_bits().wrapping_add_signed(i64::from(tag) - 160)),
        176..=191 => -*last,
        // A power of two times a small integer.
        192..=207 => f64::from(u.arbitrary::<i8>()?) * power_of_two(u.int_in_range(-1074..=1023)?),
        208..=223 => *last * power_of_two(i32::from(u.arbitrary::<i8>()?)),
        tag @ 224..=239 => SPECIAL[usize::from(tag - 224)],
        240..=247 => f64::from(u.arbitrary::<i16>()?) / 4096.0,
        248.. => f64::from_bits(u.arbitrary()?),
    };
    Ok(*last)
}

fn power_of_two(exponent: i32) -> f64 {
    // Not 2⁻¹⁰⁷⁴ at once: its reciprocal overflows on the way.
    2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

/// Points, `most` at most and one at least, of which any number may be NaN or infinite.
pub fn any_points(u: &mut Unstructured, most: usize) -> Result<Vec<Vector>> {
    let (mut points, mut last) = (points(u, most)?, 1.0);
    if u.ratio(1, 16)? {
        let at = u.choose_index(points.len())?;
        points[at][u.choose_index(3)?] = any_number(u, &mut last)?;
    }
    Ok(points)
}

/// Finite points, `most` at most and one at least.
pub fn points(u: &mut Unstructured, most: usize) -> Result<Vec<Vector>> {
    let mut numbers = Numbers::new(u)?;
    let mut points = match u.int_in_range(0..=5)? {
        0 => box_points(u, &mut numbers)?,
        1 => ring(u, most / 2)?,
        2 => sphere(u, most)?,
        _ => {
            let count = u.int_in_range(1..=most)?;
            let mut points = Vec::with_capacity(count);
            while points.len() < count && !u.is_empty() {
                points.push(numbers.vector(u)?);
            }
            points
        }
    };
    if points.is_empty() {
        points.push(Vector::zeros());
    }
    for _ in 0..u.int_in_range(0..=3)? {
        change(u, &mut points, most, &mut numbers)?;
    }
    points.iter_mut().flat_map(|p| p.iter_mut()).filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    Ok(points)
}

fn box_points(u: &mut Unstructured, numbers: &mut Numbers) -> Result<Vec<Vector>> {
    let half = numbers.vector(u)?;
    let side = |k: usize, bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
    Ok((0..8).map(|k| half.component_mul(&Vector::new(side(k, 0), side(k, 1), side(k, 2)))).collect())
}

/// A number of points or sides: few, or, where not only a few are asked for, about the 4,096 from which on the library puts
/// points in another order.
fn count(u: &mut Unstructured, least: usize, most: usize) -> Result<usize> {
    const NOT_ONLY_FEW: usize = 32;
    // The highest number: bytes that have ended are zeros.
    if most >= NOT_ONLY_FEW && u.int_in_range(0..=31_u8)? == 31 {
        u.int_in_range(4_090..=4_200)
    } else {
        u.int_in_range(least..=most.max(least))
    }
}

/// Two regular polygons, one above the other, or a polygon and an apex: caps and high valences.
fn ring(u: &mut Unstructured, most: usize) -> Result<Vec<Vector>> {
    let sides = count(u, 3, most)?;
    let corner = |k: usize, z: f64| {
        let angle = std::f64::consts::TAU * k as f64 / sides as f64;
        Vector::new(angle.cos(), angle.sin(), z)
    };
    let mut points: Vec<Vector> = (0..sides).map(|k| corner(k, 0.0)).collect();
    if u.arbitrary()? {
        points.push(Vector::new(0.0, 0.0, 1.0));
    } else {
        points.extend((0..sides).map(|k| corner(k, 1.0)));
    }
    Ok(points)
}

/// Spread over the unit sphere, along Fibonacci's spiral.
fn sphere(u: &mut Unstructured, most: usize) -> Result<Vec<Vector>> {
    Ok(testkit::models::spiral(count(u, 4, most)?))
}

/// A size from 10⁻³⁰⁰ to 10³⁰⁰.
fn any_size(u: &mut Unstructured) -> Result<f64> {
    Ok(power_of_two(u.int_in_range(-997..=997)?))
}

/// One change to points: flatter, larger, elsewhere, more of the same, turned, of any size, along all axes or along each.
fn change(u: &mut Unstructured, points: &mut Vec<Vector>, most: usize, numbers: &mut Numbers) -> Result<()> {
    match u.int_in_range(0..=8)? {
        0 => {
            let axis = u.choose_index(3)?;
            let (factor, offset) = (numbers.power(u, true)?, numbers.number(u)?);
            points.iter_mut().for_each(|p| p[axis] = p[axis] * factor + offset);
        }
        1 => {
            let factor = numbers.power(u, false)?;
            points.iter_mut().for_each(|p| *p *= factor);
        }
        2 => {
            let offset = numbers.vector(u)?;
            points.iter_mut().for_each(|p| *p += offset);
        }
        3 => {
            // Midpoints and duplicates.
            let (i, j) = (u.choose_index(points.len())?, u.choose_index(points.len())?);
            let middle = points[i] * 0.5 + points[j] * 0.5;
            if points.len() < most {
                points.push(middle);
            }
        }
        4 => {
            // A nudge of a few units in the last place.
            let (i, k) = (u.choose_index(points.len())?, u.choose_index(3)?);
            points[i][k] = nudged(points[i][k], u.arbitrary()?);
        }
        5 => {
            let turn = rotation(u)?;
            points.iter_mut().for_each(|p| *p = turn * *p);
        }
        6 => {
            let factor = any_size(u)?;
            points.iter_mut().for_each(|p| *p *= factor);
        }
        7 => {
            let factors = Vector::new(any_size(u)?, any_size(u)?, any_size(u)?);
            points.iter_mut().for_each(|p| *p = p.component_mul(&factors));
        }
        _ => {
            let by = u.choose_index(points.len())?;
            points.rotate_left(by);
        }
    }
    Ok(())
}

/// Some units in the last place away.
fn nudged(x: f64, units: i8) -> f64 {
    let moved = f64::from_bits(x.to_bits().wrapping_add_signed(i64::from(units)));
    if moved.is_finite() { moved } else { x }
}

/// A rotation: a quarter turn, any, or one that is as far off as rounding or a pose's limit allows.
pub fn rotation(u: &mut Unstructured) -> Result<Matrix> {
    let mut matrix = match u.int_in_range(0..=3)? {
        0 => Matrix::identity(),
        1 => {
            let x = Matrix::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
            let y = Matrix::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
            let turns = u.arbitrary::<u8>()?;
            (0..6).fold(Matrix::identity(), |m, bit| m * if turns >> bit & 1 == 0 { x } else { y })
        }
        2 => {
            // Integers: angles with exact tangents among them.
            let q: [i8; 4] = u.arbitrary()?;
            turn_of(q.map(f64::from))
        }
        _ => {
            // A turn by little, down to nothing.
            let angle = power_of_two(-u.int_in_range(0..=70)?);
            let axis: [i8; 3] = u.arbitrary()?;
            turn_of([1.0, angle * f64::from(axis[0]), angle * f64::from(axis[1]), angle * f64::from(axis[2])])
        }
    };
    if u.ratio(1, 4)? {
        let exponent = u.int_in_range(8..=60)?;
        let error = power_of_two(-exponent) * if exponent % 2 == 0 { 1.0 } else { -1.0 };
        let entry = (u.choose_index(3)?, u.choose_index(3)?);
        matrix[entry] += error;
    }
    Ok(matrix)
}

fn turn_of([w, x, y, z]: [f64; 4]) -> Matrix {
    let q = Quaternion::new(w, x, y, z);
    if q.norm_squared() > 0.0 {
        UnitQuaternion::new_normalize(q).to_rotation_matrix().into_inner()
    } else {
        Matrix::identity()
    }
}

/// A pose that queries accept, nearly always.
pub fn pose(u: &mut Unstructured) -> Result<Pose> {
    Ok(Pose::new(&rotation(u)?, &Numbers::new(u)?.vector(u)?))
}

/// How a shape of anything is made: with any levels of detail and look-up table.
pub fn hull_options(u: &mut Unstructured) -> Result<ShapeOptions> {
    use HierarchyKind::{Automatic, DobkinKirkpatrick, OuterCuts, Quadric};
    let kind = *u.choose(&[HierarchyKind::None, Automatic, Quadric, DobkinKirkpatrick, OuterCuts])?;
    let minimum_triangles = u.int_in_range(0..=20)?;
    let decimation = f64::from(u.int_in_range(1..=7_u8)?) / 8.0;
    let hierarchy = HierarchyOptions { kind, minimum_triangles, decimation, ..HierarchyOptions::default() };
    let lookup = *u.choose(&[LookupKind::Automatic, LookupKind::None, LookupKind::Shells, LookupKind::Spherical])?;
    let lookup = LookupOptions { kind: lookup, resolution: *u.choose(&[0, 4, 8])?, ..LookupOptions::DEFAULT };
    Ok(ShapeOptions { input: InputPolicy::Hull, hierarchy, lookup, ..ShapeOptions::default() })
}

/// Poses of two bodies: anywhere, or so that a point of one is a point of the other, or misses it by a little.
pub fn poses(u: &mut Unstructured, points: [&[Vector]; 2]) -> Result<[Pose; 2]> {
    let poses = [pose(u)?, pose(u)?];
    if u.ratio(1, 4)? {
        return Ok(poses);
    }
    let mut point = |i: usize| -> Result<Vector> {
        let own = points[i];
        let [a, b] = [own[u.choose_index(own.len())?], own[u.choose_index(own.len())?]];
        Ok(a * 0.5 + b * 0.5)
    };
    let (p, q) = (point(0)?, point(1)?);
    let turn = if u.arbitrary()? { poses[0].rotation() } else { poses[1].rotation() };
    let size = (q - points[1][0]).amax().max(points[1][0].amax()).min(1e300);
    let gap = match u.int_in_range(0..=3)? {
        0 => Vector::zeros(),
        1 => Vector::ith(u.choose_index(3)?, size * power_of_two(-u.int_in_range(0..=70)?)),
        2 => Numbers::new(u)?.vector(u)?,
        _ => poses[1].translation(),
    };
    let mut translation = poses[0].transform(&p) - turn * q + gap;
    let axis = u.choose_index(3)?;
    translation[axis] = nudged(translation[axis], u.arbitrary()?);
    translation.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    Ok([poses[0], Pose::new(&turn, &translation)])
}

/// A cache of any words, most of them small, as kinds and indices are.
pub fn any_cache(u: &mut Unstructured) -> Result<PairCache> {
    const WORDS: usize = size_of::<PairCache>() / 4;
    let mut words = [0_u32; WORDS];
    for word in &mut words {
        *word = match u.arbitrary::<u8>()? {
            255 => u.arbitrary()?,
            small => small.into(),
        };
    }
    // SAFETY: a `repr(C)` struct of 32-bit unsigned integers only, so of the same size and valid for any bits.
    Ok(unsafe { std::mem::transmute::<[u32; WORDS], PairCache>(words) })
}

/// The floating-point environment that the last byte chooses, and the bytes before it.
pub fn last_is_environment(bytes: &[u8]) -> (Environment, &[u8]) {
    let (chosen, rest) = bytes.split_last().unwrap_or((&0, &[]));
    let environments: Vec<Environment> = Environment::all().collect();
    (environments[usize::from(*chosen) % environments.len()], rest)
}

/// Runs `body` in an environment, which it leaves as it is.
pub fn inside<T>(environment: Environment, body: impl FnOnce() -> T) -> T {
    environment.run(|| {
        let made = body();
        assert!(environment.is_set(), "{environment:?} is not put back");
        made
    })
}
