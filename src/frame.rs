//! A pair of placed polyhedra prepared for one query: everything is measured in world axes relative to the other body, from
//! R₁, R₂ and T₁ − T₂ as given.
//!
//! The translations are subtracted before anything is rotated, so that a pair 10⁹ from the origin loses no digits. A direction
//! is mapped *into* a body by the transpose, which is exact for support functions whatever R; only where marching maps a
//! *point* into a body does the transpose stand for the inverse, and there it merely proposes.

use crate::double_double::{two_product, two_sum};
use crate::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::polyhedron::Polyhedron;
use crate::simd::Lanes;

/// Magnitudes outside [2⁻²⁰⁰, 2²⁰⁰] are left to integers: the rounding-error bounds ignore underflow and overflow.
const LARGEST: f64 = f64::from_bits((1023 + 200) << 52);
const SMALLEST: f64 = f64::from_bits((1023 - 200) << 52);

/// A rotation is taken for rigid when no entry of RᵀR − I exceeds this; the rounding of an orthonormal matrix to doubles leaves
/// a few u.
pub const RIGID: f64 = 8.0 * UNIT_ROUNDOFF;

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

    /// A world direction U with RᵀU = n up to rounding: R·n, corrected where R is skewed; each correction squares the defect.
    #[inline(always)]
    pub fn lift(&self, n: L) -> L {
        let mut lifted = self.rotate_lanes(n);
        if self.skewed {
            for _ in 0..3 {
                lifted = lifted.add(self.rotate_lanes(n.sub(self.rotate_back(lifted))));
            }
        }
        lifted
    }
}

/// Two placed bodies.
#[derive(Clone, Copy)]
pub struct Frame<'a, L> {
    /// Whether the poses are acceptable and the magnitudes such that double precision's error bounds cover them; a cold path
    /// finds out which is not.
    pub usual: bool,
    /// Whether both rotations are orthonormal up to rounding: |RᵀR − I| ≤ 8u in every entry, as computed.
    pub rigid: bool,
    /// Body 1 and body 2.
    pub bodies: [Body<'a, L>; 2],
    /// ρ₁ + ρ₂.
    pub size: f64,
    /// An upper bound of |Δ|, the distance of the centred origins, and so large that Δ as computed is off by at most 2u times it.
    pub separation: f64,
    /// What rounding may make of a point of one body seen from the other: marching leaves a Voronoi region only when a plane is
    /// violated by more.
    pub tolerance: f64,
}

impl<'a, L: Lanes> Frame<'a, L> {
    /// Prepares a pair, `rotation_limit` as in [`Pose::check`]. The frame is good for nothing unless it is `usual`.
    #[inline(always)]
    pub fn new(polyhedra: [&'a Polyhedron; 2], poses: [&Pose; 2], rotation_limit: f64) -> Frame<'a, L> {
        let [polyhedron1, polyhedron2] = polyhedra;
        let placed1 = Placed::<L>::new(poses[0]);
        let placed2 = Placed::<L>::new(poses[1]);
        let (mut usual, mut skewed) = (true, [false; 2]);
        // A limit below what counts as rigid is the caller's to set.
        if rotation_limit < RIGID || !Placed::are_rigid(&placed1, &placed2) {
            (usual, skewed) = look_closer(poses, rotation_limit);
        }
        let [radius1, radius2] = [polyhedron1.radius, polyhedron2.radius];
        let larger = if radius1 > radius2 { radius1 } else { radius2 };
        usual &= (SMALLEST..=LARGEST).contains(&larger);
        let [columns1, columns2] = [placed1.columns, placed2.columns];
        let mut offset = columns1[3].sub(columns2[3]);
        let [mut translation1, mut translation2] = [columns1[3], columns2[3]];
        let mut cancelled = 0.0;
        let zero = L::splat(0.0);
        let [centre1, centre2] = [L::from_vector(&polyhedron1.centre), L::from_vector(&polyhedron2.centre)];
        if !L::all_within([(centre1, zero), (centre2, zero)]) {
            let centred = centred(polyhedra, poses);
            offset = L::load(&centred.offset);
            cancelled = centred.cancelled;
            translation1 = L::load(&centred.translations[0]);
            translation2 = L::load(&centred.translations[1]);
        }
        let size = radius1 + radius2;
        let separation = offset.dot(offset).sqrt() * (1.0 + 8.0 * UNIT_ROUNDOFF) + 16.0 * UNIT_ROUNDOFF * cancelled;
        Frame {
            usual,
            rigid: !(skewed[0] | skewed[1]),
            bodies: [
                Body {
                    polyhedron: polyhedron1,
                    rows: placed1.rows,
                    columns: [columns1[0], columns1[1], columns1[2]],
                    translation: translation1,
                    offset,
                    skewed: skewed[0],
                },
                Body {
                    polyhedron: polyhedron2,
                    rows: placed2.rows,
                    columns: [columns2[0], columns2[1], columns2[2]],
                    translation: translation2,
                    offset: offset.negate(),
                    skewed: skewed[1],
                },
            ],
            size,
            separation,
            tolerance: 32.0 * UNIT_ROUNDOFF * (size + separation),
        }
    }

    /// The geometry of both.
    #[inline(always)]
    pub fn polyhedra(&self) -> [&'a Polyhedron; 2] {
        [self.bodies[0].polyhedron, self.bodies[1].polyhedron]
    }

    /// The computed x − y for x = point `p` of body 1 and y = point `q` of body 2, both in centred local coordinates.
    #[inline(always)]
    pub fn difference(&self, p: &Vector, q: &Vector) -> L {
        self.bodies[0].rotate(p).add(self.bodies[0].offset).sub(self.bodies[1].rotate(q))
    }

    /// An upper bound of the rounding error of [`Frame::difference`], whose length is about `length`.
    ///
    /// R·p errs by at most γ₃·‖|R|‖·|p| ≤ 5.3u·ρ (‖|R|‖ ≤ √3·1.015), the sum with Δ by u(|D| + 1.02ρ₂), Δ itself by at most
    /// 2u|Δ|, the last difference by u|D|.
    #[inline(always)]
    pub fn difference_error(&self, length: f64) -> f64 {
        UNIT_ROUNDOFF * (8.0 * self.size + 2.0 * self.separation + 2.0 * length)
    }
}

/// A pose in lanes, and what has to be small for it to be acceptable.
struct Placed<L> {
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

impl<L: Lanes> Placed<L> {
    #[inline(always)]
    fn new(pose: &Pose) -> Placed<L> {
        let rows = [L::load(&pose.rows[0]), L::load(&pose.rows[1]), L::load(&pose.rows[2])];
        let [a, b, c] = rows;
        let [a_next, b_next, c_next] = [a.rotate(), b.rotate(), c.rotate()];
        Placed {
            rows,
            columns: L::transpose(&rows),
            squares: c.mul_add(c, b.mul_add(b, a.mul_add(a, L::splat(-1.0)))),
            products: c.mul_add(c_next, b.mul_add(b_next, a.mul(a_next))),
            reflection: a_next.negated_mul_add(b, a.mul(b_next)).rotate().sub(c),
        }
    }

    /// Whether |RᵀR − I| is no more than rounding in every entry, det R > 0 and T is finite and not too large, for both.
    #[inline(always)]
    fn are_rigid(first: &Placed<L>, second: &Placed<L>) -> bool {
        let (limit, proper, far) = (L::splat(RIGID), L::splat(0.5), L::splat(LARGEST));
        L::all_within([
            (first.squares, limit),
            (first.products, limit),
            (first.reflection, proper),
            (first.columns[3], far),
            (second.squares, limit),
            (second.products, limit),
            (second.reflection, proper),
            (second.columns[3], far),
        ])
    }
}

/// For poses that are not both rigid and of ordinary size: whether they are acceptable and of ordinary size, and which are skewed.
#[cold]
fn look_closer(poses: [&Pose; 2], limit: f64) -> (bool, [bool; 2]) {
    let usual = poses.iter().all(|pose| pose.check(limit).is_ok() && pose.translation().amax() <= LARGEST);
    (usual, poses.map(|pose| !(pose.rotation_defect() <= RIGID)))
}

/// What differs for bodies whose centres are not their origins.
struct Centred {
    /// (T₁ + R₁c₁) − (T₂ + R₂c₂).
    offset: [f64; 4],
    /// The sum M of the magnitudes of the terms that the offset is the sum of: far more than |Δ| where they cancel.
    cancelled: f64,
    /// T + R·c of both.
    translations: [[f64; 4]; 2],
}

/// The offset is summed in double-double arithmetic and rounded once: the two sums may agree in nearly all digits. Each of the
/// six sums errs by at most 3u² of a partial sum, all by 18u²·M, which M's weight in `separation` covers: 2u·16u·M.
#[cold]
fn centred(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> Centred {
    let mut offset = [0.0; 4];
    let mut cancelled = 0.0;
    for (i, out) in offset.iter_mut().take(3).enumerate() {
        let mut sum = two_sum(poses[0].rows[i][3], -poses[1].rows[i][3]);
        cancelled += sum.hi.abs();
        for (polyhedron, pose, sign) in [(polyhedra[0], poses[0], 1.0), (polyhedra[1], poses[1], -1.0)] {
            for k in 0..3 {
                let product = two_product(pose.rows[i][k], sign * polyhedron.centre[k]);
                sum = sum + product;
                cancelled += product.hi.abs();
            }
        }
        *out = sum.hi;
    }
    let translations = [0, 1].map(|i| {
        let world = poses[i].transform(&polyhedra[i].centre);
        [world.x, world.y, world.z, 0.0]
    });
    Centred { offset, cancelled, translations }
}
