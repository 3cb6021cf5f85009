//! The truth about a pair of small convex polytopes, in exact rational arithmetic, by another algorithm than the library's:
//! all supporting planes by brute force, all edge–face and edge–edge crossings, all pairs of features.
//!
//! To be trusted without reserve for verdict and squared distance of any point sets (of any dimension, touching and coplanar
//! ones included) under any invertible matrix; O(n⁴) to build and O(features²) a query, so for a dozen vertices.

use dashu_int::IBig;
use dashu_int::ops::Abs;
use dashu_ratio::RBig;

/// A point or a vector with integer components, over a denominator that is common to all of a query.
pub type Integers = [IBig; 3];

/// A row-major 3x4 matrix [R|T].
pub type Matrix3x4 = [f64; 12];

/// A convex polytope as its extreme points with the edges and faces of their hull.
#[derive(Debug, Clone)]
pub struct Polytope {
    dimension: usize,
    vertices: Vec<[RBig; 3]>,
    edges: Vec<[usize; 2]>,
    /// Corners in cyclic order, either way round. A polytope of dimension 2 has one face.
    faces: Vec<Vec<usize>>,
}

/// Verdict and squared distance of two closed polytopes.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// 0 exactly when they have a common point.
    pub squared_distance: RBig,
}

impl Truth {
    pub fn intersecting(&self) -> bool {
        self.squared_distance.is_zero()
    }

    /// Whether lower ≤ distance ≤ upper; both are ≥ 0, upper may be +∞.
    pub fn lies_between(&self, lower: f64, upper: f64) -> bool {
        let square = |x: f64| rational(x) * rational(x);
        lower >= 0.0
            && square(lower) <= self.squared_distance
            && (upper == f64::INFINITY || (upper >= 0.0 && self.squared_distance <= square(upper)))
    }
}

/// Exactly the finite double.
pub fn rational(x: f64) -> RBig {
    RBig::try_from(x).expect("oracle: coordinates, poses and bounds are finite")
}

/// R·v + T exactly.
pub fn transform(pose: &Matrix3x4, v: &[RBig; 3]) -> [RBig; 3] {
    [0, 1, 2].map(|row| {
        let entry = |column: usize| rational(pose[4 * row + column]);
        entry(0) * &v[0] + entry(1) * &v[1] + entry(2) * &v[2] + entry(3)
    })
}

/// The truth about `a` and `b` at two poses with invertible matrices.
pub fn truth(a: &Polytope, pose_a: &Matrix3x4, b: &Polytope, pose_b: &Matrix3x4) -> Truth {
    let world = |p: &Polytope, pose| p.vertices.iter().map(|v| transform(pose, v)).collect::<Vec<_>>();
    let (world_a, world_b) = (world(a, pose_a), world(b, pose_b));
    let denominator = common_denominator(world_a.iter().chain(&world_b));
    let a = PlacedPolytope::new(a, integers(&world_a, &denominator));
    let b = PlacedPolytope::new(b, integers(&world_b, &denominator));
    let squared_distance = if intersect(&a, &b) {
        RBig::ZERO
    } else {
        let Fraction { numerator, denominator: scale } = squared_distance(&a, &b);
        RBig::from(numerator) / RBig::from(scale * &denominator * &denominator)
    };
    Truth { squared_distance }
}

impl Polytope {
    /// The convex hull of finite points.
    pub fn new(points: &[[f64; 3]]) -> Polytope {
        let points = points.iter().map(|p| p.map(rational)).collect::<Vec<_>>();
        Polytope::from_rationals(points)
    }

    /// The convex hull of rational points, at least one.
    pub fn from_rationals(mut points: Vec<[RBig; 3]>) -> Polytope {
        points.sort();
        points.dedup();
        let p = integers(&points, &common_denominator(points.iter()));
        let (dimension, edges, faces) = match first_triangle(&p) {
            Some(_) => {
                let faces = supporting_planes(&p);
                // Dimension 2: the only plane holds every point.
                let flat = faces.len() == 1;
                let faces = faces.iter().map(|(n, on)| polygon(&p, n, on)).collect::<Vec<_>>();
                (if flat { 2 } else { 3 }, sides(&faces), faces)
            }
            // Sorted points on a line: the extreme ones come first and last.
            None if p.len() > 1 => (1, vec![[0, p.len() - 1]], vec![]),
            None => (0, vec![], vec![]),
        };
        keep_extreme(Polytope { dimension, vertices: points, edges, faces })
    }
}

/// The least common multiple of all denominators, which are powers of two when doubles were given.
fn common_denominator<'a>(points: impl Iterator<Item = &'a [RBig; 3]>) -> IBig {
    use dashu_int::ops::Gcd;
    points.flatten().fold(IBig::ONE, |lcm, x| {
        let own = IBig::from(x.denominator().clone());
        let gcd = IBig::from((&lcm).gcd(&own));
        lcm / gcd * own
    })
}

/// The numerators over `denominator`.
fn integers(points: &[[RBig; 3]], denominator: &IBig) -> Vec<Integers> {
    let scaled = |x: &RBig| x.numerator() * (denominator / IBig::from(x.denominator().clone()));
    points.iter().map(|p| [scaled(&p[0]), scaled(&p[1]), scaled(&p[2])]).collect()
}

fn minus(a: &Integers, b: &Integers) -> Integers {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn dot(a: &Integers, b: &Integers) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Integers, b: &Integers) -> Integers {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn is_zero(v: &Integers) -> bool {
    v.iter().all(IBig::is_zero)
}

fn normal(p: &[Integers], [i, j, k]: [usize; 3]) -> Integers {
    cross(&minus(&p[j], &p[i]), &minus(&p[k], &p[i]))
}

fn first_triangle(p: &[Integers]) -> Option<[usize; 3]> {
    (2..p.len()).map(|k| [0, 1, k]).find(|t| !is_zero(&normal(p, *t)))
}

/// Every plane through three points that has all points on one side: a normal of it and the points on it.
fn supporting_planes(p: &[Integers]) -> Vec<(Integers, Vec<usize>)> {
    let mut planes: Vec<(Integers, Vec<usize>)> = Vec::new();
    for k in 2..p.len() {
        for j in 1..k {
            for i in 0..j {
                let n = normal(p, [i, j, k]);
                if is_zero(&n) || planes.iter().any(|(_, on)| [i, j, k].iter().all(|x| on.contains(x))) {
                    continue;
                }
                let heights = p.iter().map(|q| dot(&n, &minus(q, &p[i]))).collect::<Vec<_>>();
                let above = heights.iter().any(|h| *h > IBig::ZERO);
                let below = heights.iter().any(|h| *h < IBig::ZERO);
                if !(above && below) {
                    planes.push((n, (0..p.len()).filter(|&q| heights[q].is_zero()).collect()));
                }
            }
        }
    }
    planes
}

/// The extreme points among the coplanar points `on`, in cyclic order: q follows p when all others lie to the left of the line
/// from p to q, or on it between the two.
fn polygon(p: &[Integers], n: &Integers, on: &[usize]) -> Vec<usize> {
    let follows = |&from: &usize, &to: &usize| {
        let side = minus(&p[to], &p[from]);
        to != from
            && on.iter().all(|&r| {
                let other = minus(&p[r], &p[from]);
                let left = dot(n, &cross(&side, &other));
                let along = dot(&side, &other);
                left > IBig::ZERO || (left.is_zero() && along >= IBig::ZERO && along <= dot(&side, &side))
            })
    };
    // The lexicographically first point is extreme, and `on` is sorted.
    let mut corners = vec![on[0]];
    loop {
        let last = corners[corners.len() - 1];
        let next = *on.iter().find(|to| follows(&last, to)).expect("a polygon closes");
        if next == corners[0] {
            return corners;
        }
        corners.push(next);
    }
}

fn sides(faces: &[Vec<usize>]) -> Vec<[usize; 2]> {
    let mut edges = faces
        .iter()
        .flat_map(|face| (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]]))
        .map(|[i, j]| [i.min(j), i.max(j)])
        .collect::<Vec<_>>();
    edges.sort();
    edges.dedup();
    edges
}

/// Drops the points that are no corner of anything.
fn keep_extreme(p: Polytope) -> Polytope {
    let used = |v: usize| p.dimension == 0 || p.edges.iter().any(|e| e.contains(&v));
    let kept = (0..p.vertices.len()).filter(|&v| used(v)).collect::<Vec<_>>();
    let renumber = |v: &usize| kept.binary_search(v).expect("a corner is kept");
    Polytope {
        dimension: p.dimension,
        vertices: kept.iter().map(|&v| p.vertices[v].clone()).collect(),
        edges: p.edges.iter().map(|[i, j]| [renumber(i), renumber(j)]).collect(),
        faces: p.faces.iter().map(|f| f.iter().map(renumber).collect()).collect(),
    }
}

/// A plane: normal·x = offset.
struct Plane {
    normal: Integers,
    offset: IBig,
}

impl Plane {
    fn through(normal: Integers, point: &Integers) -> Plane {
        let offset = dot(&normal, point);
        Plane { normal, offset }
    }

    fn height(&self, x: &Integers) -> IBig {
        dot(&self.normal, x) - &self.offset
    }
}

struct PlacedFace {
    /// In dimension 3 the normal points outward.
    plane: Plane,
    /// Planes through the sides, perpendicular to the face, ≥ 0 inside.
    sides: Vec<Plane>,
}

/// A polytope at a pose, over the query's common denominator.
struct PlacedPolytope {
    dimension: usize,
    vertices: Vec<Integers>,
    edges: Vec<[usize; 2]>,
    faces: Vec<PlacedFace>,
}

impl PlacedPolytope {
    fn new(p: &Polytope, vertices: Vec<Integers>) -> PlacedPolytope {
        let face = |corners: &Vec<usize>| {
            let n = normal(&vertices, [corners[0], corners[1], corners[2]]);
            let mut plane = Plane::through(n, &vertices[corners[0]]);
            let side = |i: usize| {
                let (from, to) = (&vertices[corners[i]], &vertices[corners[(i + 1) % corners.len()]]);
                Plane::through(cross(&plane.normal, &minus(to, from)), from)
            };
            let sides = (0..corners.len()).map(side).collect();
            if vertices.iter().any(|v| plane.height(v) > IBig::ZERO) {
                plane = Plane { normal: plane.normal.map(|c| -c), offset: -plane.offset };
            }
            PlacedFace { plane, sides }
        };
        let faces = p.faces.iter().map(face).collect();
        PlacedPolytope { dimension: p.dimension, vertices, edges: p.edges.clone(), faces }
    }

    fn segment(&self, [i, j]: [usize; 2]) -> [&Integers; 2] {
        [&self.vertices[i], &self.vertices[j]]
    }

    fn contains(&self, x: &Integers) -> bool {
        match self.dimension {
            3 => self.faces.iter().all(|f| f.plane.height(x) <= IBig::ZERO),
            2 => self.faces[0].plane.height(x).is_zero() && self.faces[0].is_above(x),
            1 => {
                let [from, to] = self.segment(self.edges[0]);
                let (u, r) = (minus(to, from), minus(x, from));
                let along = dot(&u, &r);
                is_zero(&cross(&u, &r)) && along >= IBig::ZERO && along <= dot(&u, &u)
            }
            _ => self.vertices[0] == *x,
        }
    }
}

impl PlacedFace {
    /// Whether x projects into the face.
    fn is_above(&self, x: &Integers) -> bool {
        self.sides.iter().all(|s| s.height(x) >= IBig::ZERO)
    }

    /// Whether the segment crosses the plane of the face, not parallel to it, within the face.
    fn is_crossed(&self, [p, q]: [&Integers; 2]) -> bool {
        let (hp, hq) = (self.plane.height(p), self.plane.height(q));
        if hp == hq || &hp * &hq > IBig::ZERO {
            return false;
        }
        // The crossing point is (|hq|·p + |hp|·q) / (|hp| + |hq|).
        let (hp, hq) = (hp.abs(), hq.abs());
        self.sides.iter().all(|s| &hq * s.height(p) + &hp * s.height(q) >= IBig::ZERO)
    }
}

/// Closed polytopes meet exactly if a vertex of one lies in the other, or two edges cross, or an edge of one crosses a face of
/// the other: an extreme point of the intersection is the only common point of two features, whose dimensions then add up to
/// at most three, and of which neither is parallel to the other.
fn intersect(a: &PlacedPolytope, b: &PlacedPolytope) -> bool {
    a.vertices.iter().any(|v| b.contains(v))
        || b.vertices.iter().any(|v| a.contains(v))
        || a.edges.iter().any(|&e| b.faces.iter().any(|f| f.is_crossed(a.segment(e))))
        || b.edges.iter().any(|&e| a.faces.iter().any(|f| f.is_crossed(b.segment(e))))
        || a.edges.iter().any(|&e| {
            b.edges.iter().any(|&f| edge_edge(a.segment(e), b.segment(f)).is_some_and(|d| d.numerator.is_zero()))
        })
}

/// A non-negative fraction with a positive denominator.
struct Fraction {
    numerator: IBig,
    denominator: IBig,
}

impl Fraction {
    fn least(self, other: Fraction) -> Fraction {
        if &self.numerator * &other.denominator <= &other.numerator * &self.denominator { self } else { other }
    }
}

/// The least of the squared distances of all pairs of features whose nearest points lie in both of them. Every one belongs to
/// a point of A and one of B, and the nearest points of disjoint polytopes lie inside some such pair (a face and an edge, or
/// two faces, only if parallel: then their borders are as near).
fn squared_distance(a: &PlacedPolytope, b: &PlacedPolytope) -> Fraction {
    let mut candidates = Vec::new();
    for (one, other) in [(a, b), (b, a)] {
        for v in &one.vertices {
            candidates.extend(other.edges.iter().filter_map(|&e| vertex_edge(v, other.segment(e))));
            candidates.extend(other.faces.iter().filter_map(|f| vertex_face(v, f)));
        }
    }
    for v in &a.vertices {
        candidates.extend(b.vertices.iter().map(|w| vertex_vertex(v, w)));
    }
    for &e in &a.edges {
        candidates.extend(b.edges.iter().filter_map(|&f| edge_edge(a.segment(e), b.segment(f))));
    }
    candidates.into_iter().reduce(Fraction::least).expect("a polytope has a vertex")
}

fn vertex_vertex(v: &Integers, w: &Integers) -> Fraction {
    let d = minus(v, w);
    Fraction { numerator: dot(&d, &d), denominator: IBig::ONE }
}

fn vertex_edge(v: &Integers, [from, to]: [&Integers; 2]) -> Option<Fraction> {
    let (u, r) = (minus(to, from), minus(v, from));
    let (along, length) = (dot(&u, &r), dot(&u, &u));
    (along >= IBig::ZERO && along <= length)
        .then(|| Fraction { numerator: dot(&r, &r) * &length - &along * &along, denominator: length })
}

fn vertex_face(v: &Integers, face: &PlacedFace) -> Option<Fraction> {
    face.is_above(v).then(|| {
        let h = face.plane.height(v);
        Fraction { numerator: &h * &h, denominator: dot(&face.plane.normal, &face.plane.normal) }
    })
}

/// The lines' nearest points if the edges are not parallel and both points lie in them.
fn edge_edge([a, to_a]: [&Integers; 2], [b, to_b]: [&Integers; 2]) -> Option<Fraction> {
    let (u, v, r) = (minus(to_a, a), minus(to_b, b), minus(b, a));
    let n = cross(&u, &v);
    let square = dot(&n, &n);
    let inside = |t: IBig| t >= IBig::ZERO && t <= square;
    if square.is_zero() || !inside(dot(&cross(&r, &v), &n)) || !inside(dot(&cross(&r, &u), &n)) {
        return None;
    }
    let h = dot(&r, &n);
    Some(Fraction { numerator: &h * &h, denominator: square })
}
