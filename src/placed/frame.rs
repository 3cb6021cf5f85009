//! A pair of placed polyhedra prepared for one query: everything is measured in world axes relative to the other body, from
//! R₁, R₂ and T₁ − T₂ as given.
//!
//! The translations are subtracted before anything is rotated, so that a pair 10⁹ from the origin loses no digits. A direction is
//! mapped *into* a body by the transpose, which is exact for support functions with any R; only where marching maps a *point*
//! into a body does the transpose stand for the inverse, and there it merely proposes.

use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::{LARGEST, Polyhedron, SMALLEST};
use crate::placed::Pair;

/// A rotation is taken for rigid when no entry of RᵀR − I exceeds this; the rounding of an orthonormal matrix to doubles leaves
/// a few u.
pub const RIGID: f64 = 7.0 * UNIT_ROUNDOFF;

/// As [`RIGID`], for the root of the sum of four entries' squares, which is quicker to look at.
pub const RIGID_TOGETHER: f64 = 10.0 * UNIT_ROUNDOFF;

/// ‖RᵀR − I‖₂ of a pose that counts as rigid, the rounding with which it was measured included.
///
/// By [`RIGID`]: entries up to 7u make 3·7u. By [`RIGID_TOGETHER`]: lane i holds the diagonal's entry sᵢ and pᵢ beside it, sᵢ² +
/// pᵢ² ≤ (10u)². So xᵀEx = Σ(sᵢxᵢ² + 2pᵢxᵢxᵢ₊₁) ≤ 10u·Σ|xᵢ|√(xᵢ² + 4xᵢ₊₁²) ≤ 10u·√5 for |x| = 1 (Cauchy and Schwarz, twice).
/// Measuring errs by up to 3.5u on the diagonal entry by entry, 2.5u in lanes, and 2u beside it: together 28.5u and 28.9u.
pub const RIGID_DEFECT: f64 = 29.0 * UNIT_ROUNDOFF;

/// The second body's position and its first two axes, as seen from the first body of a pair ([`Frame::mark`]), as the bits of
/// single-precision numbers; the last of each four carries no information.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct Marker([[u32; 4]; 3]);

/// One placed body.
#[derive(Clone, Copy)]
pub struct Body<'a, L> {
    /// Its geometry, in centred coordinates.
    pub polyhedron: &'a Polyhedron,
    /// Rows of R; lane 3 is unspecified.
    rows: [L; 3],
    /// Columns of R.
    columns: [L; 3],
    /// The world position of its centred origin: T + R·c.
    pub translation: L,
    /// Its centred origin minus that of the other body, in world axes.
    pub offset: L,
    /// Whether R is farther from orthonormal than rounding makes it.
    skewed: bool,
}

impl<L: Lanes> Body<'_, L> {
    /// R·p, for a point from memory.
    #[inline(always)]
    pub fn rotate(&self, p: &Vector) -> L {
        let [x, y, z] = self.columns;
        z.mul_add(L::splat(p.z), y.mul_add(L::splat(p.y), x.mul(L::splat(p.x))))
    }

    /// R·d.
    #[inline(always)]
    pub fn rotate_lanes(&self, d: L) -> L {
        let [x, y, z] = self.columns;
        z.mul_add(d.splat_z(), y.mul_add(d.splat_y(), x.mul(d.splat_x())))
    }

    /// Rᵀ·d.
    #[inline(always)]
    pub fn rotate_back(&self, d: L) -> L {
        let [x, y, z] = self.rows;
        z.mul_add(d.splat_z(), y.mul_add(d.splat_y(), x.mul(d.splat_x())))
    }

    /// Rᵀ·d, for a vector from memory: number by number, as it may just have been written (R1).
    #[inline(always)]
    pub fn rotate_vector_back(&self, d: &Vector) -> L {
        let [x, y, z] = self.rows;
        z.mul_add(L::splat(d.z), y.mul_add(L::splat(d.y), x.mul(L::splat(d.x))))
    }

    /// The rows of R; lane 3 is unspecified.
    #[inline(always)]
    pub fn rows(&self) -> [L; 3] {
        self.rows
    }

    /// The columns of R.
    #[inline(always)]
    pub fn columns(&self) -> [L; 3] {
        self.columns
    }

    /// A world direction U with RᵀU = n up to rounding: R·n, or where R is skewed R⁻ᵀ·n.
    #[inline(always)]
    pub fn lift(&self, n: L) -> L {
        if self.skewed {
            let ([x, y, z], inverse) = self.cofactors();
            return z.mul_add(n.splat_z(), y.mul_add(n.splat_y(), x.mul(n.splat_x()))).mul(L::splat(inverse));
        }
        self.rotate_lanes(n)
    }

    /// R⁻¹·d, by the transpose where that is the inverse up to rounding.
    #[inline(always)]
    pub fn turn_back(&self, d: L) -> L {
        if self.skewed { self.invert(d) } else { self.rotate_back(d) }
    }

    /// R⁻¹·d.
    #[inline(always)]
    pub fn invert(&self, d: L) -> L {
        let ([x, y, z], inverse) = self.cofactors();
        L::from_vector(&(Vector::new(x.dot(d), y.dot(d), z.dot(d)) * inverse))
    }

    /// The columns of det(R)·R⁻ᵀ, and 1/det(R).
    #[inline(always)]
    fn cofactors(&self) -> ([L; 3], f64) {
        let [x, y, z] = self.columns;
        let columns = [y.cross(z), z.cross(x), x.cross(y)];
        (columns, 1.0 / x.dot(columns[0]))
    }
}

/// Two placed bodies.
#[derive(Clone, Copy)]
pub struct Frame<'a, L> {
    /// Whether the poses are acceptable and the magnitudes such that double precision's error bounds cover them; a cold path
    /// finds out which is not.
    pub in_range: bool,
    /// Whether both rotations are orthonormal up to rounding, see [`RIGID_TOGETHER`].
    pub rigid: bool,
    /// Body 1 and body 2.
    pub bodies: [Body<'a, L>; 2],
    /// ρ₁ + ρ₂.
    pub size: f64,
    /// An upper bound of |Δ|, the distance of the centred origins, and so large that Δ as computed is off by at most 2u times it.
    pub separation: f64,
    /// The rounding error of a point of one body seen from the other: marching leaves a Voronoi region only when a plane is
    /// violated by more.
    pub tolerance: f64,
}

impl<'a, L: Lanes> Frame<'a, L> {
    /// Prepares a pair. The frame is useless unless it is `in_range`.
    #[inline(always)]
    pub fn new(pair: &Pair<'a>) -> Frame<'a, L> {
        let Pair { polyhedra, poses } = *pair;
        let placed = [PoseInLanes::<L>::new(poses[0]), PoseInLanes::<L>::new(poses[1])];
        let (mut in_range, mut skewed) = (true, [false; 2]);
        if !PoseInLanes::are_rigid(&placed) {
            (in_range, skewed) = look_closer(poses);
        }
        let [radius1, radius2] = [polyhedra[0].radius, polyhedra[1].radius];
        in_range &= (SMALLEST..=LARGEST).contains(&if radius1 > radius2 { radius1 } else { radius2 });
        let is_centred = polyhedra.iter().all(|polyhedron| polyhedron.centre == Vector::zeros());
        let origins = if is_centred { Origins::as_given(&placed) } else { Origins::with_centres(&placed, polyhedra) };
        Frame::assemble(polyhedra, &placed, &origins, in_range, skewed)
    }

    /// [`Frame::new`] for [simple](Polyhedron::simple) bodies: only `in_range` if both poses are rigid and within range, without a
    /// closer look.
    #[inline(always)]
    pub fn of_rigid(pair: &Pair<'a>) -> Frame<'a, L> {
        let Pair { polyhedra, poses } = *pair;
        let placed = [PoseInLanes::<L>::new(poses[0]), PoseInLanes::<L>::new(poses[1])];
        let origins = Origins::as_given(&placed);
        Frame::assemble(polyhedra, &placed, &origins, PoseInLanes::are_rigid(&placed), [false; 2])
    }

    #[inline(always)]
    fn assemble(
        polyhedra: [&'a Polyhedron; 2],
        placed: &[PoseInLanes<L>; 2],
        origins: &Origins<L>,
        in_range: bool,
        skewed: [bool; 2],
    ) -> Frame<'a, L> {
        let size = polyhedra[0].radius + polyhedra[1].radius;
        let offset = origins.offset;
        let separation = separation(offset.dot(offset), origins.cancelled);
        Frame {
            in_range,
            rigid: !(skewed[0] | skewed[1]),
            bodies: [
                placed[0].body(polyhedra[0], origins.translations[0], offset, skewed[0]),
                placed[1].body(polyhedra[1], origins.translations[1], offset.negate(), skewed[1]),
            ],
            size,
            separation,
            tolerance: tolerance(size, separation),
        }
    }

    /// The geometry of both.
    #[inline(always)]
    pub fn polyhedra(&self) -> [&'a Polyhedron; 2] {
        [self.bodies[0].polyhedron, self.bodies[1].polyhedron]
    }

    /// The centred origin of body 2 as seen by body 1, in its own axes.
    #[inline(always)]
    fn view(&self) -> L {
        self.bodies[0].rotate_back(self.bodies[1].offset)
    }

    /// How body 1 sees the first two axes of body 2.
    #[inline(always)]
    fn axes(&self) -> [L; 2] {
        let [body1, body2] = &self.bodies;
        let [first, second, ..] = body2.columns;
        [body1.rotate_back(first), body1.rotate_back(second)]
    }

    /// Writes down where the pair is, to tell later how far it has moved. In place (R1: 8 % of a query
    /// from the tables).
    #[inline(always)]
    pub fn mark(&self, marker: &mut Marker) {
        let [to_origin, to_first, to_second] = &mut marker.0;
        let [first, second] = self.axes();
        self.view().store_single(to_origin);
        first.store_single(to_first);
        second.store_single(to_second);
    }

    /// Whether the square of the angle by which the pair has moved since it had a marker is more than so much: the angle by which
    /// body 2 has moved around body 1 and that by which it has turned, both as body 1 sees it, taken together. So a turn of body 1
    /// counts as both, and one of body 2 about its own first axis is not seen. One point of body 2 instead would show their sum,
    /// which may be nothing.
    #[inline(always)]
    pub fn has_moved(&self, last: &Marker, square: f64) -> bool {
        let moved = self.view().sub(L::load_single(&last.0[0]));
        let [axis, _] = self.axes();
        let turned = axis.sub(L::load_single(&last.0[1]));
        let lever = if self.separation > self.size { self.separation } else { self.size };
        moved.dot(moved) > lever * lever * (square - turned.dot(turned))
    }

    /// Whether the square of the angle by which body 2 has turned, seen from body 1, is more than so much by its second axis: a
    /// turn about its own first axis, which [`Frame::has_moved`] does not see.
    #[inline(always)]
    pub fn has_rolled(&self, last: &Marker, square: f64) -> bool {
        let [_, axis] = self.axes();
        let rolled = axis.sub(L::load_single(&last.0[2]));
        rolled.dot(rolled) > square
    }

    /// The computed x − y for x = point `p` of body 1 and y = point `q` of body 2, both in centred local coordinates.
    #[inline(always)]
    pub fn difference(&self, p: &Vector, q: &Vector) -> L {
        self.bodies[0].rotate(p).add(self.bodies[0].offset).sub(self.bodies[1].rotate(q))
    }

    /// An upper bound of the rounding error of [`Frame::difference`], whose length is about `length`, for points within their
    /// bodies' radii. A foot found on a face's plane may lie beyond; a caller that uses it adds that error, as `of_face` does.
    ///
    /// R·p errs by at most γ₃·‖|R|‖·|p| ≤ 5.3u·ρ (‖|R|‖ ≤ √3·1.015), the sum with Δ by u(|D| + 1.02ρ₂), Δ itself by at most
    /// 2u|Δ|, the last difference by u|D|.
    #[inline(always)]
    pub fn difference_error(&self, length: f64) -> f64 {
        difference_error(self.size, self.separation, length)
    }
}

/// [`Frame::difference_error`].
#[inline(always)]
pub fn difference_error<S: Scalar>(size: S, separation: S, length: S) -> S {
    let [by_size, by_separation, by_length] = [constant::<S>(6.5), constant(2.0), constant(2.0)];
    constant::<S>(UNIT_ROUNDOFF) * (by_size * size + by_separation * separation + by_length * length)
}

/// [`Frame::separation`], from Δ² and the value of [`Origins::cancelled`].
#[inline(always)]
pub fn separation<S: Scalar>(square: S, cancelled: S) -> S {
    square.sqrt() * constant(1.0 + 8.0 * UNIT_ROUNDOFF) + constant::<S>(16.0 * UNIT_ROUNDOFF) * cancelled
}

/// [`Frame::tolerance`].
#[inline(always)]
pub fn tolerance<S: Scalar>(size: S, separation: S) -> S {
    constant::<S>(32.0 * UNIT_ROUNDOFF) * (size + separation)
}

/// A pose in lanes, and what has to be small for it to be acceptable.
struct PoseInLanes<L> {
    rows: [L; 3],
    /// The columns of R, and T.
    columns: [L; 4],
    /// The diagonal of RᵀR − I.
    squares: L,
    /// Its other entries.
    products: L,
    /// (first row) × (second row) − (third row): about 0 for a rotation, about −2·(third row) for a reflection.
    reflection: L,
}

impl<L: Lanes> PoseInLanes<L> {
    #[inline(always)]
    fn new(pose: &Pose) -> PoseInLanes<L> {
        let rows = [L::load(&pose.rows[0]), L::load(&pose.rows[1]), L::load(&pose.rows[2])];
        let [a, b, c] = rows;
        let [a_next, b_next, c_next] = [a.rotate(), b.rotate(), c.rotate()];
        PoseInLanes {
            rows,
            columns: L::transpose(&rows),
            squares: c.mul_add(c, b.mul_add(b, a.mul_add(a, L::splat(-1.0)))),
            products: c.mul_add(c_next, b.mul_add(b_next, a.mul(a_next))),
            reflection: a_next.negated_mul_add(b, a.mul(b_next)).rotate().sub(c),
        }
    }

    /// Whether |RᵀR − I| is no more than rounding in every entry, det R > 0 and T is finite and not too large, for both. The
    /// squares of four entries at a time are summed, one of each kind of each pose: a NaN passes no comparison.
    #[inline(always)]
    fn are_rigid(placed: &[PoseInLanes<L>; 2]) -> bool {
        let [first, second] = placed;
        let defect = first.squares.mul(first.squares);
        let defect = second.squares.mul_add(second.squares, defect);
        let defect = first.products.mul_add(first.products, defect);
        let defect = second.products.mul_add(second.products, defect);
        let improper = second.reflection.mul_add(second.reflection, first.reflection.mul(first.reflection));
        let [far1, far2] = [first.columns[3], second.columns[3]];
        let far = far2.mul_add(far2, far1.mul(far1));
        let limits = [L::splat(RIGID_TOGETHER * RIGID_TOGETHER), L::splat(0.25), L::splat(LARGEST * LARGEST)];
        let within = defect.at_most(limits[0]) & improper.at_most(limits[1]) & far.at_most(limits[2]);
        within & 0b111 == 0b111
    }

    /// The same of one pose.
    #[inline(always)]
    fn is_rigid(&self) -> bool {
        let defect = self.products.mul_add(self.products, self.squares.mul(self.squares));
        let far = self.columns[3];
        let limits = [L::splat(RIGID_TOGETHER * RIGID_TOGETHER), L::splat(0.25), L::splat(LARGEST * LARGEST)];
        let within = defect.at_most(limits[0])
            & self.reflection.mul(self.reflection).at_most(limits[1])
            & far.mul(far).at_most(limits[2]);
        within & 0b111 == 0b111
    }

    #[inline(always)]
    fn body<'a>(&self, polyhedron: &'a Polyhedron, translation: L, offset: L, skewed: bool) -> Body<'a, L> {
        let [x, y, z, _] = self.columns;
        Body { polyhedron, rows: self.rows, columns: [x, y, z], translation, offset, skewed }
    }
}

/// A look at one pose.
struct PoseLook<'a>(&'a Pose);

impl Kernel for PoseLook<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        PoseInLanes::<L>::new(self.0).is_rigid()
    }
}

/// Whether a pose is rigid up to rounding and within range, so that [`Pose::check`] accepts it; quicker than that.
#[inline(always)]
pub fn is_rigid_in_range(pose: &Pose) -> bool {
    let is_rigid = simd::dispatch(&mut PoseLook(pose));
    debug_assert!(!is_rigid || pose.check().is_ok());
    is_rigid
}

/// The positions of the bodies' centred origins.
struct Origins<L> {
    /// That of body 1 minus that of body 2: (T₁ + R₁c₁) − (T₂ + R₂c₂).
    offset: L,
    /// The sum M of the magnitudes of the terms that the offset is the sum of: far more than |Δ| where they cancel. 0 where
    /// centres are origins.
    cancelled: f64,
    /// T + R·c of both.
    translations: [L; 2],
}

impl<L: Lanes> Origins<L> {
    /// Of bodies whose centres are their origins.
    #[inline(always)]
    fn as_given([first, second]: &[PoseInLanes<L>; 2]) -> Origins<L> {
        let translations = [first.columns[3], second.columns[3]];
        Origins { offset: translations[0].sub(translations[1]), cancelled: 0.0, translations }
    }

    /// Of any bodies. T₁ + R₁c₁ and T₂ + R₂c₂ may agree in nearly all digits. So what rounding leaves off is summed, too (T. Ogita,
    /// S. M. Rump, S. Oishi, "Accurate Sum and Dot Product", SIAM Journal on Scientific Computing 26(6), 2005). No term is in more
    /// than three sums: what they and the products leave off is at most 4u·M together, and is rounded four times: 16u²·M. Then the
    /// offset is rounded once. M's weight in [`separation`] covers 2u·16u·M.
    #[inline(always)]
    fn with_centres(placed: &[PoseInLanes<L>; 2], polyhedra: [&Polyhedron; 2]) -> Origins<L> {
        let [[x1, y1, z1, t1], [x2, y2, z2, t2]] = [placed[0].columns, placed[1].columns];
        let [c1, c2] = [&polyhedra[0].centre, &polyhedra[1].centre];
        let [apart, apart_rest] = t1.two_sum(t2.negate());
        let [a, a_rest] = x1.two_product(L::splat(c1.x));
        let [b, b_rest] = y1.two_product(L::splat(c1.y));
        let [c, c_rest] = z1.two_product(L::splat(c1.z));
        let [d, d_rest] = x2.two_product(L::splat(-c2.x));
        let [e, e_rest] = y2.two_product(L::splat(-c2.y));
        let [f, f_rest] = z2.two_product(L::splat(-c2.z));
        let (offset, of_sums) = sum_of([apart, a, b, c, d, e, f]);
        let rest = rest_of([apart_rest, a_rest, b_rest, c_rest, d_rest, e_rest, f_rest], of_sums);
        let of_first = magnitude(a).add(magnitude(b)).add(magnitude(c));
        let of_second = magnitude(d).add(magnitude(e)).add(magnitude(f));
        Origins {
            offset: offset.add(rest),
            cancelled: magnitude(apart).add(of_first).add(of_second).norm1(),
            translations: [a.add(b).add(c).add(t1), t2.sub(d.add(e).add(f))],
        }
    }
}

#[inline(always)]
fn magnitude<L: Lanes>(x: L) -> L {
    x.max(x.negate())
}

/// The sum of seven terms, each of which is in at most three sums, and what they leave off.
#[inline(always)]
pub fn sum_of<L: Lanes>([a, b, c, d, e, f, g]: [L; 7]) -> (L, [L; 6]) {
    let ([ab, r0], [cd, r1], [ef, r2]) = (a.two_sum(b), c.two_sum(d), e.two_sum(f));
    let ([abcd, r3], [efg, r4]) = (ab.two_sum(cd), ef.two_sum(g));
    let [sum, r5] = abcd.two_sum(efg);
    (sum, [r0, r1, r2, r3, r4, r5])
}

/// The sum of what terms and sums leave off, each rounded at most four times.
#[inline(always)]
pub fn rest_of<L: Lanes>([a, b, c, d, e, f, g]: [L; 7], [r0, r1, r2, r3, r4, r5]: [L; 6]) -> L {
    let halves = [a.add(b).add(c.add(d)), e.add(f).add(g.add(r0))];
    let others = [r1.add(r2).add(r3.add(r4)), r5];
    halves[0].add(halves[1]).add(others[0].add(others[1]))
}

/// Whether poses are acceptable and within range.
pub fn are_acceptable(poses: [&Pose; 2]) -> bool {
    poses.iter().all(|pose| pose.check().is_ok() && pose.translation().amax() <= LARGEST)
}

/// For poses that are not both rigid and within range: whether they are acceptable and within range, and which are skewed.
#[cold]
fn look_closer(poses: [&Pose; 2]) -> (bool, [bool; 2]) {
    (are_acceptable(poses), poses.map(|pose| !(pose.rotation_defect() <= RIGID)))
}

/// The centred origin of body 1 minus that of body 2, and the value of [`Origins::cancelled`].
struct BetweenCentres<'a>(&'a Pair<'a>);

impl Kernel for BetweenCentres<'_> {
    type Output = (Vector, f64);

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> (Vector, f64) {
        let Pair { polyhedra, poses } = *self.0;
        let origins = Origins::with_centres(&poses.map(PoseInLanes::<L>::new), polyhedra);
        (origins.offset.to_vector(), origins.cancelled)
    }
}

/// (T₁ + R₁c₁) − (T₂ + R₂c₂), as in a [`Frame`], and the sum of the magnitudes of the terms that it is the sum of.
pub fn between_centres(pair: &Pair) -> (Vector, f64) {
    simd::dispatch(&mut BetweenCentres(pair))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::double_double::{two_product, two_sum};
    use crate::base::math::Matrix;
    use crate::base::simd::Portable;
    use swiftprox::random::Random;

    /// Bodies far from their own origins, whose middles are as near as rounding lets them be, or not so near.
    #[test]
    fn offsets_are_as_exact_as_is_said() {
        let mut random = Random::new(0x0ff5);
        let mut cancelled = 0;
        for round in 0..if cfg!(miri) { 5 } else { 2_000 } {
            let far = random.vector() * random.power(0, 30);
            let corners = [0, 1, 2, 3].map(|_| far + random.vector());
            let shape = crate::body::build::assembly::build(&corners, None).unwrap();
            let first = Pose::new(&random.rotation(), &(random.vector() * 1e3));
            let turn = random.rotation();
            let middle = first.transform(&shape.centre) + random.vector() * random.power(-50, 0);
            let second = Pose::new(&turn, &(middle - turn * shape.centre));
            let pair = Pair { polyhedra: [&shape; 2], poses: [&first, &second] };
            let sum = [0, 1, 2].map(|i| {
                let mut sum = two_sum(first.rows[i][3], -second.rows[i][3]);
                for k in 0..3 {
                    sum = sum + two_product(first.rows[i][k], shape.centre[k]);
                    sum = sum - two_product(second.rows[i][k], shape.centre[k]);
                }
                sum
            });
            for (offset, magnitude) in [between_centres(&pair), BetweenCentres(&pair).run::<Portable>()] {
                for (exact, x) in sum.iter().zip(offset.iter()) {
                    // Double-double sums are off by 18u²·M.
                    let error = (exact.hi - x + exact.lo).abs();
                    let allowed = x.abs() * UNIT_ROUNDOFF + 34.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * magnitude;
                    assert!(error <= allowed * 1.01, "{round}: {error:e} {allowed:e}");
                }
                cancelled += usize::from(offset.norm() < 1e-9 * magnitude);
            }
        }
        assert!(cfg!(miri) || cancelled > 300, "{cancelled}");
    }

    /// A quick look takes nothing that is refused, and nearly all rotations.
    #[test]
    fn a_look_at_one_pose_takes_rotations_and_nothing_that_is_refused() {
        let mut random = Random::new(0x0f4a);
        let mut taken = 0;
        for round in 0..if cfg!(miri) { 10 } else { 5_000 } {
            let pose = Pose::new(&random.rotation(), &(random.vector() * 1e3));
            taken += usize::from(is_rigid_in_range(&pose));
            let mut spoilt = pose;
            let entry = &mut spoilt.rows[random.below(3)][random.below(4)];
            *entry = [f64::NAN, f64::INFINITY, -f64::INFINITY, 2e300, *entry + 1e3 * LARGEST][round % 5];
            assert!(!is_rigid_in_range(&spoilt), "{spoilt:?}");
            let skewed = pose.rotation() * (1.0 + random.power(-48, -8));
            let skewed = Pose::new(&skewed, &pose.translation());
            assert!(!is_rigid_in_range(&skewed) || skewed.rotation_defect() <= 2.0 * RIGID_TOGETHER, "{skewed:?}");
            let mirrored = Pose::new(
                &(pose.rotation() * Matrix::from_diagonal(&Vector::new(1.0, 1.0, -1.0))),
                &pose.translation(),
            );
            assert!(!is_rigid_in_range(&mirrored), "{mirrored:?}");
        }
        assert!(taken > 4_000 || cfg!(miri), "{taken}");
    }
}
