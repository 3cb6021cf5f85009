//! Two placed compounds, and lower bounds of the signed distance between boxes of theirs.
//!
//! With Δ = T_B − T_A, a point x of A and a point y of B are R_B·y + Δ − R_A·x apart. Along an axis a of A, which R_A takes to a
//! direction of the world, that is a·(M·y + R_AᵀΔ − R_AᵀR_A·x), where M = R_AᵀR_B. So the difference of the boxes' centres, less
//! the half sides that a box of A has along a and one of B along Mᵀa, is a gap between all that is in them, up to a slack. The
//! same holds the other way round. The signed distance of convex bodies is the largest of the gaps along unit directions: each of
//! them is a lower bound. Where gaps along three orthogonal axes are positive, so is their norm.
//!
//! The slack, with S = L_A + L_B + |Δ| for points no farther than L from their origins, and d = the largest entry of |RᵀR − I| as
//! measured, 8u added, for A and B together:
//!
//! | of | at most |
//! |---|---|
//! | R_AᵀR_A·x − x and R_BᵀR_B·y − y | 3d·S |
//! | products that take M for orthonormal: along crossed edges | 12d·S |
//! | a swept ball, which poses do not stretch: M's rows and R's columns are of length 1 ± 3d | 9d·S |
//! | M, R_AᵀΔ and R_BᵀΔ: three products each, 4u·√3·√3 of a centre or a half diagonal (≤ √3·L); Δ itself: u·|Δ| | 48u·S |
//! | sums and products with these, as many again | 48u·S |
//! | axes Q of a box with \|QᵀQ − I\| ≤ 16u an entry: 48u of a half diagonal, for both boxes | 192u·S |
//! | one axis, in place of crossed edges: its length, Mᵀa, both boxes along it, a dot product | 75u·S |
//! | crossed edges: products of two such numbers | 192u·S |
//! | pieces that are not at the identity: R·R_i is off by 12u·\|v\|, R·t_i + T by 8u·\|t_i\| + u·\|T\|, along an axis twice that | 32u·(K_A + K_B) + 4u·(\|T_A\| + \|T_B\|) |
//!
//! Below, 512u, 32d, 64u and 8u are taken. No number here exceeds S by more than a small factor, so nothing overflows where S is
//! below [`LARGEST`]; elsewhere the slack is infinite and nothing is ruled out. Products that underflow are off by 2⁻¹⁰⁷⁵ each.

use std::cell::Cell;

use super::body::CompoundReach;
use super::fit::{Fitted, Oriented};
use super::placed::PlacedPieces;
use super::tree::{PieceNode, TreeView};
use crate::base::error::Result;
use crate::base::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;

/// Squares of lengths below this are finite, and so are sums of some.
const LARGEST: f64 = 1e150;

/// Squares above this have lost nothing by underflow that counts.
const LEAST_SQUARE: f64 = 1e-290;

/// Two placed compounds, as bounds see them.
pub(super) struct Between {
    /// Columns of M, rows of M (lane 3 is 0).
    columns: [[f64; 4]; 3],
    rows: [[f64; 4]; 3],
    /// R_AᵀΔ and R_BᵀΔ.
    offsets: [[f64; 4]; 2],
    slack: f64,
    /// The lesser of L_A and L_B.
    lever: f64,
    /// Factors for gaps that are positive, and for those that are not: R changes lengths.
    shrink: f64,
    grow: f64,
    /// An axis a of A, of length 1 up to rounding, and Mᵀa.
    axis: Cell<Option<[[f64; 4]; 2]>>,
}

/// The same in lanes.
#[derive(Clone, Copy)]
pub(super) struct InLanes<L> {
    columns: [L; 3],
    rows: [L; 3],
    offsets: [L; 2],
    slack: L,
    shrink: f64,
    grow: f64,
    axis: Option<[L; 2]>,
}

/// What is known of two placed compounds before any box of theirs is looked at.
pub(super) struct Reaches {
    delta: [f64; 3],
    /// L_A + L_B.
    levers: f64,
    /// d of both together, 16u included.
    defect: f64,
    slack: f64,
}

impl Reaches {
    /// Checks both poses, and those of pieces where they may be refused.
    ///
    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose).
    #[inline]
    pub fn new(bodies: &[PlacedPieces; 2]) -> Result<Reaches> {
        let defects = [bodies[0].pose.checked_defect()?, bodies[1].pose.checked_defect()?];
        let [a, b] = [&bodies[0].pose.rows, &bodies[1].pose.rows];
        let delta = [b[0][3] - a[0][3], b[1][3] - a[1][3], b[2][3] - a[2][3]];
        let length = |v: [f64; 3]| v[0].abs() + v[1].abs() + v[2].abs();
        let levers = bodies[0].reach.lever + bodies[1].reach.lever;
        let size = levers + length(delta);
        let defect = defects[0] + defects[1] + 16.0 * U;
        let mut slack = (512.0 * U + 32.0 * defect) * size + f64::MIN_POSITIVE;
        for body in bodies {
            let (placing, [x, y, z]) = (body.reach.placing, body.pose.rows);
            if placing > 0.0 {
                slack += 64.0 * U * placing + 8.0 * U * length([x[3], y[3], z[3]]);
            }
        }
        // False for a NaN.
        let is_in_range = slack < LARGEST && size < LARGEST;
        if !is_in_range {
            slack = f64::INFINITY;
        }
        for (body, defect) in bodies.iter().zip(defects) {
            check_pieces(body, defect, is_in_range)?;
        }
        Ok(Reaches { delta, levers, defect, slack })
    }

    /// The compounds are at least so far apart, by balls about their origins, which R stretches by no more than the slack holds.
    /// The square is off by 5u of itself, its root by 4u.
    #[inline]
    pub fn between_balls(&self) -> f64 {
        let [x, y, z] = self.delta;
        let square = x * x + y * y + z * z;
        // No bound where squares underflow.
        let length = if square > LEAST_SQUARE { square.sqrt() } else { 0.0 };
        length * (1.0 - 8.0 * U) - self.levers * (1.0 + 4.0 * U) - self.slack
    }
}

impl Between {
    /// For poses that are checked.
    pub fn new(bodies: &[PlacedPieces; 2], reaches: &Reaches) -> Between {
        let &Reaches { delta, defect, slack, .. } = reaches;
        let [a, b] = [&bodies[0].pose.rows, &bodies[1].pose.rows];
        let product = |i: usize, j: usize| a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
        let turned = |r: &[[f64; 4]; 3], i: usize| r[0][i] * delta[0] + r[1][i] * delta[1] + r[2][i] * delta[2];
        Between {
            columns: [0, 1, 2].map(|j| [product(0, j), product(1, j), product(2, j), 0.0]),
            rows: [0, 1, 2].map(|i| [product(i, 0), product(i, 1), product(i, 2), 0.0]),
            offsets: [a, b].map(|r| [turned(r, 0), turned(r, 1), turned(r, 2), 0.0]),
            slack,
            lever: bodies[0].reach.lever.min(bodies[1].reach.lever),
            // |R·v| is at most (1 + 1.5d)·|v| and at least (1 − 3d)·|v|; an axis is of length 1 ± 16u.
            shrink: 1.0 - 2.0 * defect - 64.0 * U,
            grow: 1.0 + 4.0 * defect + 64.0 * U,
            axis: Cell::new(None),
        }
    }

    /// From now on boxes are parted along a direction of the world, too: a unit vector, or NaN, which parts nothing. `pose` is that
    /// of A. Of bodies that are far apart, the normal of the nearest pieces parts nearly all others.
    pub fn look_along(&self, normal: &[f64; 3], pose: &Pose) {
        debug_assert!(!((Vector::from(*normal).norm() - 1.0).abs() > 1e-6), "{normal:?}");
        let axis = pose.rotate_back(&Vector::from(*normal)).normalize();
        let [x, y, z] = self.columns.map(|m| m[0] * axis.x + m[1] * axis.y + m[2] * axis.z);
        self.axis.set(Some([[axis.x, axis.y, axis.z, 0.0], [x, y, z, 0.0]]));
    }

    /// M and R_AᵀΔ, the bits of single numbers.
    #[inline(always)]
    pub fn place(&self) -> [[u32; 4]; 4] {
        let [x, y, z] = self.columns;
        [x, y, z, self.offsets[0]].map(|column| column.map(|number| (number as f32).to_bits()))
    }

    /// About how far a point has moved against the other compound since it had a place.
    #[inline(always)]
    pub fn change_since(&self, place: &[[u32; 4]; 4]) -> f64 {
        let of = |column: usize, now: &[f64; 4]| -> f64 {
            (0..3).map(|k| (now[k] - f64::from(f32::from_bits(place[column][k]))).abs()).sum()
        };
        let turned: f64 = (0..3).map(|column| of(column, &self.columns[column])).sum();
        of(3, &self.offsets[0]) + turned * self.lever * (1.0 / 3.0)
    }

    /// The lesser lever.
    #[inline(always)]
    pub fn lever(&self) -> f64 {
        self.lever
    }

    #[inline(always)]
    pub fn in_lanes<L: Lanes>(&self) -> InLanes<L> {
        InLanes {
            columns: load(&self.columns),
            rows: load(&self.rows),
            offsets: [L::load(&self.offsets[0]), L::load(&self.offsets[1])],
            slack: L::splat(self.slack),
            shrink: self.shrink,
            grow: self.grow,
            axis: self.axis.get().map(|[a, b]| [L::load(&a), L::load(&b)]),
        }
    }
}

/// Refuses a pose at which that of a piece is refused.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose).
#[inline(always)]
pub(super) fn check_pieces(body: &PlacedPieces, defect: f64, is_in_range: bool) -> Result<()> {
    // No entry of the product's |RᵀR − I| is above the piece's own by more than 3·1.03 times that of the body.
    let CompoundReach { placing, skew, .. } = body.reach;
    let are_accepted = placing == 0.0 || (is_in_range && skew + 4.0 * defect + 64.0 * U <= ROTATION_LIMIT);
    if are_accepted { Ok(()) } else { check_each(body) }
}

/// Refuses a pose that is not accepted, or at which that of a piece is not.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose).
pub(crate) fn check_pose(body: &PlacedPieces) -> Result<()> {
    let defect = body.pose.checked_defect()?;
    let is_in_range = body.pose.translation().lp_norm(1) + body.reach.lever < LARGEST;
    check_pieces(body, defect, is_in_range)
}

#[cold]
fn check_each(body: &PlacedPieces) -> Result<()> {
    for (k, piece) in body.compound_pieces().iter().enumerate() {
        let placed = body.pose.after(&piece.pose);
        placed.check().map_err(|error| error.about(&format!("piece {k} at that pose")))?;
    }
    Ok(())
}

#[inline(always)]
fn load<L: Lanes>(vectors: &[[f64; 4]; 3]) -> [L; 3] {
    [L::load(&vectors[0]), L::load(&vectors[1]), L::load(&vectors[2])]
}

#[inline(always)]
fn absolute<L: Lanes>(x: L) -> L {
    x.max(x.negate())
}

#[inline(always)]
fn absolutes<L: Lanes>([x, y, z]: [L; 3]) -> [L; 3] {
    [absolute(x), absolute(y), absolute(z)]
}

#[inline(always)]
fn transposed<L: Lanes>(rows: &[L; 3]) -> [L; 3] {
    let [x, y, z, _] = L::transpose(rows);
    [x, y, z]
}

/// x₀·a + x₁·b + x₂·c.
#[inline(always)]
fn combined<L: Lanes>([a, b, c]: &[L; 3], x: L) -> L {
    c.mul_add(x.splat_z(), b.mul_add(x.splat_y(), a.mul(x.splat_x())))
}

/// The greatest of three gaps; a NaN is none.
#[inline(always)]
fn greatest(gaps: [f64; 4], mut most: f64) -> f64 {
    for gap in &gaps[..3] {
        if *gap > most {
            most = *gap;
        }
    }
    most
}

impl<L: Lanes> InLanes<L> {
    /// The signed distance of all that is in two nodes is at least this, by the boxes along the axes of the bodies.
    #[inline(always)]
    pub fn of_fitted(&self, a: &Fitted, b: &Fitted) -> f64 {
        let [centre_a, half_a] = [L::load(&a.centre), L::load(&a.half)];
        let [centre_b, half_b] = [L::load(&b.centre), L::load(&b.half)];
        let way_a = combined(&self.columns, centre_b).add(self.offsets[0].sub(centre_a));
        let way_b = centre_b.add(self.offsets[1]).sub(combined(&self.rows, centre_a));
        let reach_b = combined(&absolutes(self.columns), half_b).add(half_a).add(self.slack);
        let reach_a = combined(&absolutes(self.rows), half_a).add(half_b).add(self.slack);
        self.bound(absolute(way_a).sub(reach_b), absolute(way_b).sub(reach_a))
    }

    /// The same by the boxes along axes of their own; with `crosses` they are also parted along the cross products of edges,
    /// which tells only that they are apart.
    #[inline(always)]
    pub fn of_oriented(&self, a: &Oriented, b: &Oriented, crosses: bool) -> f64 {
        let [centre_a, half_a] = [L::load(&a.fitted.centre), L::load(&a.fitted.half)];
        let [centre_b, half_b] = [L::load(&b.fitted.centre), L::load(&b.fitted.half)];
        let [axes_a, axes_b] = [load(&a.axes), load(&b.axes)];
        let way_a = combined(&self.columns, centre_b).add(self.offsets[0].sub(centre_a));
        let way_b = centre_b.add(self.offsets[1]).sub(combined(&self.rows, centre_a));
        // Column j of N holds the products of A's axes with B's axis j, both in A's frame.
        let in_axes_a = transposed(&axes_a);
        let columns = [
            combined(&in_axes_a, combined(&self.columns, axes_b[0])),
            combined(&in_axes_a, combined(&self.columns, axes_b[1])),
            combined(&in_axes_a, combined(&self.columns, axes_b[2])),
        ];
        let sizes = [absolutes(columns), absolutes(transposed(&columns))];
        let along = [combined(&in_axes_a, way_a), combined(&transposed(&axes_b), way_b)];
        let reach_b = combined(&sizes[0], half_b).add(half_a).add(self.slack);
        let reach_a = combined(&sizes[1], half_a).add(half_b).add(self.slack);
        let bound = self.bound(absolute(along[0]).sub(reach_b), absolute(along[1]).sub(reach_a));
        if !crosses || bound > 0.0 {
            return bound;
        }
        // For B's axis j, lane i is for A's axis i: d = |t·(aᵢ × b_j)| = |t_{i+2}·N_{i+1,j} − t_{i+1}·N_{i+2,j}|. The half sides
        // along it are those of A times |N_{i+1,j}| and |N_{i+2,j}| crosswise, of B times |N_{i,j+1}| and |N_{i,j+2}|. The cross
        // product is no longer than 1 + 64u: the gap along its direction is no less.
        let halves_b = [half_b.splat_x(), half_b.splat_y(), half_b.splat_z()];
        let [half_1, half_2] = [half_a.rotate(), half_a.rotate().rotate()];
        let [way_1, way_2] = [along[0].rotate(), along[0].rotate().rotate()];
        let mut most = bound;
        for j in 0..3 {
            let [j1, j2] = [(j + 1) % 3, (j + 2) % 3];
            let [next, last] = [columns[j].rotate(), columns[j].rotate().rotate()];
            let [size_1, size_2] = [sizes[0][j].rotate(), sizes[0][j].rotate().rotate()];
            let way = absolute(way_2.mul(next).sub(way_1.mul(last)));
            let of_a = half_1.mul_add(size_2, half_2.mul(size_1));
            let of_b = halves_b[j1].mul_add(sizes[0][j2], halves_b[j2].mul(sizes[0][j1]));
            most = greatest(way.sub(of_a).sub(of_b).sub(self.slack).to_array(), most);
        }
        if most > 0.0 { most * self.shrink } else { bound }
    }

    /// The same by the gap along the axis that was given last; −∞ without.
    #[inline(always)]
    pub fn along_axis(&self, a: &Oriented, b: &Oriented) -> f64 {
        let Some([axis_a, axis_b]) = self.axis else { return f64::NEG_INFINITY };
        let way =
            combined(&self.columns, L::load(&b.fitted.centre)).add(self.offsets[0].sub(L::load(&a.fitted.centre)));
        let in_axes_a = absolute(combined(&transposed(&load(&a.axes)), axis_a));
        let in_axes_b = absolute(combined(&transposed(&load(&b.axes)), axis_b));
        let reach = in_axes_a.dot(L::load(&a.fitted.half)) + in_axes_b.dot(L::load(&b.fitted.half));
        let gap = axis_a.dot(way).abs() - reach - self.slack.to_array()[0];
        if gap > 0.0 { gap * self.shrink } else { gap * self.grow }
    }

    #[inline(always)]
    fn bound(&self, gaps_a: L, gaps_b: L) -> f64 {
        let most = greatest(gaps_b.to_array(), greatest(gaps_a.to_array(), f64::NEG_INFINITY));
        if !(most > 0.0) {
            return most * self.grow;
        }
        let zero = L::splat(0.0);
        let [positive_a, positive_b] = [gaps_a.max(zero), gaps_b.max(zero)];
        let [square_a, square_b] = [positive_a.dot(positive_a), positive_b.dot(positive_b)];
        let square = if square_a > square_b { square_a } else { square_b };
        let length = if square > LEAST_SQUARE { square.sqrt() } else { most };
        length * self.shrink
    }
}

/// The two pairs that come of two nodes by opening one: the larger, unless it is a leaf. `None` of two leaves.
#[inline(always)]
pub(super) fn opened(trees: [TreeView; 2], [a, b]: [u32; 2]) -> Option<[[u32; 2]; 2]> {
    let (node_a, node_b): (&PieceNode, &PieceNode) = (&trees[0].nodes[a as usize], &trees[1].nodes[b as usize]);
    match (node_a.piece(), node_b.piece()) {
        (Some(_), Some(_)) => None,
        (None, other) if other.is_some() || node_a.size >= node_b.size => {
            let [first, second] = node_a.children();
            Some([[first, b], [second, b]])
        }
        _ => {
            let [first, second] = node_b.children();
            Some([[a, first], [a, second]])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Matrix;
    use crate::base::simd::{self, Kernel};
    use crate::compound::placed::with_pieces;
    use crate::compound::tree::PieceTree;
    use crate::compound::{Compound, Piece};
    use crate::pair::{PairConfig, SignedDistance, SignedDistanceCache, signed_distance};
    use crate::shape::{InputPolicy, Shape, ShapeOptions};
    use std::sync::Arc;
    use swiftprox::random::Random;

    struct NodePair<'a> {
        between: &'a Between,
        trees: [&'a PieceTree; 2],
        nodes: [usize; 2],
    }

    impl Kernel for NodePair<'_> {
        type Output = [f64; 4];

        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> [f64; 4] {
            let between = self.between.in_lanes::<L>();
            let [tree_a, tree_b] = self.trees;
            let [a, b] = self.nodes;
            let oriented =
                [false, true].map(|crosses| between.of_oriented(&tree_a.oriented[a], &tree_b.oriented[b], crosses));
            let along = between.along_axis(&tree_a.oriented[a], &tree_b.oriented[b]);
            [between.of_fitted(&tree_a.nodes[a].fitted, &tree_b.nodes[b].fitted), oriented[0], oriented[1], along]
        }
    }

    fn compound(random: &mut Random, scale: f64) -> Compound {
        let piece = |random: &mut Random| {
            let middle = random.vector() * scale;
            let axes = Vector::new(1.0, random.uniform(0.0, 1.0), 0.3) * scale;
            let points: Vec<Vector> =
                (0..4 + random.below(5)).map(|_| random.direction().component_mul(&axes) + middle).collect();
            let swept_radius = if random.below(3) == 0 { 0.2 * scale } else { 0.0 };
            let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
            let pose = match random.below(2) {
                0 => Pose::IDENTITY,
                _ => Pose::new(&random.rotation(), &(random.vector() * scale)),
            };
            Piece { shape: Arc::new(Shape::from_points(&points, &options).unwrap()), pose }
        };
        Compound::new(&(0..5).map(|_| piece(random)).collect::<Vec<_>>()).unwrap()
    }

    fn pieces_below(tree: &PieceTree, node: usize) -> Vec<u32> {
        match tree.nodes[node].piece() {
            Some(piece) => vec![piece],
            None => tree.nodes[node].children().iter().flat_map(|child| pieces_below(tree, *child as usize)).collect(),
        }
    }

    /// Of all pairs of nodes, whatever is in them: rigid, skewed, stretched by as much as is accepted, far from the origin.
    #[test]
    fn no_bound_exceeds_a_signed_distance() {
        let mut random = Random::new(0xb0b);
        let mut tight = [0; 4];
        for round in 0..if cfg!(miri) { 1 } else { 75 } {
            // Squares of the smallest lengths underflow.
            let scale = [1.0, 1.0, 1e-30, 1e30, 1e-220][round % 5];
            let bodies = [compound(&mut random, scale), compound(&mut random, scale)];
            let skew = [0.0, 0.0, 1e-7, 2e-3][round / 5 % 4];
            let far = [0.0, 1e6][round % 2] * scale;
            let poses = [0, 1].map(|_| {
                let rotation =
                    random.rotation() * (Matrix::identity() + Matrix::from_diagonal(&(random.vector() * skew)));
                Pose::new(&rotation, &(random.vector() * (2.0 * scale) + Vector::repeat(far)))
            });
            let placed = [0, 1].map(|i| bodies[i].at(&poses[i]).placed_pieces());
            let reaches = Reaches::new(&placed).unwrap();
            let between = Between::new(&placed, &reaches);
            let trees = [&bodies[0].tree, &bodies[1].tree];
            let (mut truth, mut normals) = ([[0.0; 5]; 5], Vec::new());
            for (i, j) in (0..25).map(|n| (n / 5, n % 5)) {
                let mut found = SignedDistance::default();
                with_pieces(&placed, [i as u32, j as u32], |pieces| {
                    let mut cache = SignedDistanceCache::default();
                    signed_distance(pieces, &mut cache, &PairConfig::default(), &mut found).unwrap();
                });
                truth[i][j] = found.upper;
                normals.push(if random.below(3) > 0 { found.normal } else { random.direction().into() });
            }
            let nearest = truth.as_flattened().iter().copied().fold(f64::INFINITY, f64::min);
            assert!(reaches.between_balls() <= nearest, "{round}");
            for (a, b) in (0..81).map(|n| (n / 9, n % 9)) {
                let below = [pieces_below(trees[0], a), pieces_below(trees[1], b)];
                let pairs = below[0].iter().flat_map(|i| below[1].iter().map(|j| truth[*i as usize][*j as usize]));
                let least = pairs.fold(f64::INFINITY, f64::min);
                between.look_along(&random.pick(&normals), &poses[0]);
                let bounds = simd::dispatch(&mut NodePair { between: &between, trees, nodes: [a, b] });
                for (bound, tight) in bounds.into_iter().zip(&mut tight) {
                    assert!(bound <= least, "{round}: {bound:e} {least:e}");
                    *tight += usize::from(bound > 0.5 * least && least > 0.0);
                }
            }
        }
        assert!(cfg!(miri) || tight.iter().all(|tight| *tight > 500), "{tight:?}");
    }
}
