//! The point nearest to the origin in a simplex with integer corners, exactly.

use dashu_int::IBig;

use super::dyadic::{DyadicVector, IntVector, cross, dot};
use crate::base::memory::listed;

/// A pair of vertices, one of each polyhedron (indices into `vertices`): a vertex of the Minkowski difference A − B.
pub type VertexPair = [u32; 2];

/// The difference of a vertex of A and one of B: a corner of a simplex.
#[derive(Debug, Clone)]
pub(crate) struct DifferenceVertex {
    pub pair: VertexPair,
    pub position: DyadicVector,
}

/// One to four affinely independent corners with P, the point of their hull nearest to the origin, strictly inside: all
/// weights are positive. (Corners that do not carry P are dropped as soon as that is known.)
#[derive(Debug)]
pub(crate) struct ExactSimplex {
    /// All over the same power of two, the latest first.
    pub corners: Vec<DifferenceVertex>,
    /// P = Σ weightₖ·cornerₖ / Σ weightₖ, all positive.
    pub weights: Vec<IBig>,
    /// A positive multiple of P, over no particular power of two; not used when P = 0.
    pub direction: IntVector,
    /// direction·corner, the same for every corner (the affine hull of the corners is perpendicular to P), over the corners'
    /// power of two; 0 exactly when P = 0.
    pub height: IBig,
}

impl ExactSimplex {
    /// The simplex of a single corner.
    pub fn new(corner: DifferenceVertex) -> ExactSimplex {
        let direction = corner.position.components.clone();
        let height = dot(&direction, &direction);
        ExactSimplex { corners: listed([corner]), weights: listed([IBig::ONE]), direction, height }
    }

    /// The same simplex again, its lists asked for like all lists here.
    pub fn copied(&self) -> ExactSimplex {
        ExactSimplex {
            corners: listed(self.corners.iter().cloned()),
            weights: listed(self.weights.iter().cloned()),
            direction: self.direction.clone(),
            height: self.height.clone(),
        }
    }

    /// Whether P is the origin.
    pub fn holds_origin(&self) -> bool {
        self.height.is_zero()
    }

    /// The corners' common power of two.
    pub fn exponent(&self) -> i32 {
        self.corners[0].position.exponent
    }

    /// Adds `corner` when it lies strictly on the origin's side of the plane through P perpendicular to P (P·w < P·P), and takes
    /// the nearest point anew; returns whether it did. |P| falls strictly if it did: the segment from P to the corner starts
    /// towards the origin. Otherwise the corner brings nothing: P·w ≥ P·P.
    pub fn improve(&mut self, corner: &DifferenceVertex) -> bool {
        if self.holds_origin() {
            return false;
        }
        let mut corner = corner.clone();
        self.align(&mut corner);
        if dot(&self.direction, &corner.position.components) >= self.height {
            return false;
        }
        // The other corners all lie in the plane that the new one lies in front of: affine independence is kept. There are never
        // five: four that all carry P enclose the origin. There is room for them.
        self.corners.push(corner);
        self.reduce();
        true
    }

    /// Brings a new corner and the present ones to the finer of their powers of two.
    fn align(&mut self, corner: &mut DifferenceVertex) {
        let (own, exponent) = (self.exponent(), self.exponent().min(corner.position.exponent));
        corner.position.refine(exponent);
        if exponent < own {
            self.corners.iter_mut().for_each(|c| c.position.refine(exponent));
            self.height <<= (own - exponent) as usize;
        }
    }

    /// Keeps the corners that carry the nearest point: the one subset S such that the point P_S of its affine hull that is
    /// nearest to the origin has positive weights, and no corner q lies below it, P_S·q ≥ P_S·P_S (the optimality conditions of
    /// a convex programme). S holds the corner that was added last, since that made |P| fall.
    /// With n that corner and a, b two of the others, all as vectors from the origin:
    ///
    /// | S | weights | P_S is a positive multiple of |
    /// |---|---|---|
    /// | {n} | 1 | n |
    /// | {n, a} | a·a − n·a, n·n − n·a | their weighted sum |
    /// | {n, a, b} | m·(a×b), m·(b×n), m·(n×a) with the normal m = a×b + b×n + n×a | (m·n)·m |
    /// | all four | the four determinants | 0 |
    fn reduce(&mut self) {
        let newest = self.corners.len() - 1;
        let found = self.supporting_vertex(newest).or_else(|| {
            (0..newest).find_map(|a| self.supporting_edge(newest, a)).or_else(|| {
                (0..newest)
                    .flat_map(|b| (0..b).map(move |a| (a, b)))
                    .find_map(|(a, b)| self.supporting_triangle(newest, a, b))
            })
        });
        // Some subset is optimal; if none of those with up to three corners, then all four.
        let face = found.unwrap_or_else(|| self.whole());
        let kept = listed(face.members.iter().map(|&i| self.corners[i].clone()));
        self.corners = kept;
        self.weights = face.weights;
        self.direction = face.direction;
        self.height = face.height;
    }

    fn position(&self, i: usize) -> &IntVector {
        &self.corners[i].position.components
    }

    /// The corners that are not `members`.
    fn others(&self, members: &[usize]) -> impl Iterator<Item = &IntVector> {
        let used: u8 = members.iter().map(|&i| 1 << i).sum();
        (0..self.corners.len()).filter(move |i| used >> i & 1 == 0).map(|i| self.position(i))
    }

    fn supporting_vertex(&self, n: usize) -> Option<SimplexFace> {
        let direction = self.position(n).clone();
        self.supporting(SimplexFace {
            members: listed([n]),
            weights: listed([IBig::ONE]),
            height: dot(&direction, &direction),
            direction,
        })
    }

    fn supporting_edge(&self, n: usize, a: usize) -> Option<SimplexFace> {
        let (pn, pa) = (self.position(n), self.position(a));
        let mixed = dot(pn, pa);
        let (weight_n, weight_a) = (dot(pa, pa) - &mixed, dot(pn, pn) - &mixed);
        if weight_n <= IBig::ZERO || weight_a <= IBig::ZERO {
            return None;
        }
        let direction = [0, 1, 2].map(|k| &weight_n * &pn[k] + &weight_a * &pa[k]);
        let height = dot(&direction, pn);
        self.supporting(SimplexFace {
            members: listed([n, a]),
            weights: listed([weight_n, weight_a]),
            direction,
            height,
        })
    }

    fn supporting_triangle(&self, n: usize, a: usize, b: usize) -> Option<SimplexFace> {
        let (pn, pa, pb) = (self.position(n), self.position(a), self.position(b));
        let sides = [cross(pa, pb), cross(pb, pn), cross(pn, pa)];
        let normal = [0, 1, 2].map(|k| &sides[0][k] + &sides[1][k] + &sides[2][k]);
        let weights = listed(sides.iter().map(|side| dot(&normal, side)));
        if weights.iter().any(|w| *w <= IBig::ZERO) {
            return None;
        }
        let height = dot(&normal, pn);
        let (direction, height) = if height < IBig::ZERO { (normal.map(|c| -c), -height) } else { (normal, height) };
        self.supporting(SimplexFace { members: listed([n, a, b]), weights, direction, height })
    }

    /// `face` if no corner lies below it. With P_S = 0 (height 0) there is no below.
    fn supporting(&self, face: SimplexFace) -> Option<SimplexFace> {
        let supports =
            face.height.is_zero() || self.others(&face.members).all(|q| dot(&face.direction, q) >= face.height);
        supports.then_some(face)
    }

    /// All four corners, the origin strictly inside: each weight is the volume of the origin with the three others.
    fn whole(&self) -> SimplexFace {
        let volume = |i: usize, j: usize, k: usize| {
            let v = dot(self.position(i), &cross(self.position(j), self.position(k)));
            if v < IBig::ZERO { -v } else { v }
        };
        let weights = listed([volume(1, 2, 3), volume(0, 2, 3), volume(0, 1, 3), volume(0, 1, 2)]);
        SimplexFace { members: listed([0, 1, 2, 3]), weights, direction: [IBig::ZERO; 3], height: IBig::ZERO }
    }
}

/// A subset of the corners with the nearest point of its affine hull.
struct SimplexFace {
    members: Vec<usize>,
    weights: Vec<IBig>,
    direction: IntVector,
    height: IBig,
}

/// The nearest point of the hull of a few corners: the same descent, with the corners themselves as the support. They may
/// coincide or be coplanar; a corner that brings nothing is never added.
pub(super) fn nearest_of_hull(first: DifferenceVertex, corners: &[DifferenceVertex]) -> ExactSimplex {
    let mut simplex = ExactSimplex::new(first);
    while corners.iter().any(|corner| simplex.improve(corner)) {}
    simplex
}
