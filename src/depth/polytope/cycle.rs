//! The one way in which a polytope changes: triangles give way to the cone from a vertex over their rim.
//!
//! The polytope is an oriented cycle: each directed edge is there once, and so is its opposite, or neither is. The rim of any
//! triangles is the boundary of their sum, and the cone over it has the same one; so the rest with the cone is a cycle again,
//! whichever triangles go, connected or not.
//!
//! Edges are bits: row a of `out` has bit b where there is an edge from a to b, and row b of `into` has bit a. So the rim's edges
//! from a vertex are those of `out` that `into` has not. No neighbours are kept, and none are walked to.

use super::PairRounding;
use super::planes::evaluate;
use super::storage::{NO_PLANE, Polytope};
use crate::base::math::Vector;
use crate::base::simd::Lanes;

/// The directed edges of some triangles over V ≤ 64·W vertices, all zero but while they are in use.
pub struct Edges<const V: usize, const W: usize> {
    out: [[u64; W]; V],
    into: [[u64; W]; V],
}

impl<const V: usize, const W: usize> Edges<V, W> {
    /// No edges.
    pub const EMPTY: Edges<V, W> = {
        assert!(V <= 64 * W, "a bit for each vertex");
        Edges { out: [[0; W]; V], into: [[0; W]; V] }
    };

    /// Adds the edges of a triangle; whether one of them was there already.
    #[inline(always)]
    pub fn add(&mut self, [a, b, c]: [u8; 3]) -> bool {
        let mut doubled = 0;
        for (tail, head) in [(a, b), (b, c), (c, a)] {
            let (tail, head) = (usize::from(tail), usize::from(head));
            // (Remainders that change nothing spare checks of bounds.)
            let out = &mut self.out[tail % V][head / 64 % W];
            let into = &mut self.into[head % V][tail / 64 % W];
            doubled |= *out & 1 << (head % 64);
            *out |= 1 << (head % 64);
            *into |= 1 << (tail % 64);
        }
        doubled != 0
    }

    /// Whether a triangle has the opposite of one of the edges.
    #[inline(always)]
    fn touch(&self, [a, b, c]: [u8; 3]) -> bool {
        let mut found = 0;
        for (tail, head) in [(b, a), (c, b), (a, c)] {
            found |= self.out[usize::from(tail) % V][usize::from(head) / 64 % W] >> (head % 64);
        }
        found & 1 != 0
    }

    /// The heads of the rim's edges from a vertex, which are taken out.
    #[inline(always)]
    pub fn take(&mut self, tail: u8) -> [u64; W] {
        let tail = usize::from(tail) % V;
        let mut heads = [0; W];
        for (word, head) in heads.iter_mut().enumerate() {
            *head = self.out[tail][word] & !self.into[tail][word];
        }
        (self.out[tail], self.into[tail]) = ([0; W], [0; W]);
        heads
    }

    /// Whether triangles are a cycle whose edges are there once each. For corners nothing is known but that they are vertices.
    #[inline(always)]
    pub fn are_cycle(&mut self, triangles: &[[u8; 4]], vertices: usize) -> bool {
        let mut is_doubled = false;
        for &[a, b, c, _] in triangles {
            is_doubled |= self.add([a, b, c]);
        }
        let mut differing = 0;
        for (out, into) in self.out[..vertices].iter_mut().zip(&mut self.into[..vertices]) {
            for word in 0..W {
                differing |= out[word] ^ into[word];
            }
            (*out, *into) = ([0; W], [0; W]);
        }
        !is_doubled && differing == 0
    }
}

/// The requirements on new triangles.
#[derive(Debug, Clone, Copy)]
pub struct Demand {
    /// The point inside from which the polytope is looked at.
    pub centre: Vector,
    /// Whether they are to look away from the origin instead of from the centre.
    pub about_origin: bool,
    /// No plane may be nearer to the origin than this, …
    pub least: f64,
    /// … by more than rounding.
    pub rounding: PairRounding,
}

/// Triangles beyond which no more are taken in that are not as demanded.
const MOST_TAKEN: usize = 60;

/// Puts the cone from a vertex over the rim of the triangles that it is beyond, by more than rounding, in their place; `beyond` is
/// one of them. Triangles of the cone that are not as demanded take in what is behind them. Whether all are; else nothing changes.
#[inline(always)]
pub fn insert<L: Lanes, const V: usize, const T: usize, const W: usize>(
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    beyond: usize,
    apex: Apex,
    demand: &Demand,
) -> bool {
    let mut region = visible::<L, V, T>(polytope, beyond, apex.vertex, &demand.rounding);
    replace::<L, V, T, W>(polytope, edges, &mut region, apex, demand)
}

/// Takes a corner of a triangle out: what is around it gives way to the cone from another corner of the triangle.
#[inline(always)]
pub fn take_out<L: Lanes, const V: usize, const T: usize, const W: usize>(
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    triangle: usize,
    demand: &Demand,
) -> bool {
    let corners = polytope.corners_of(triangle);
    for (k, vertex) in [(1, 0), (2, 0), (2, 1), (0, 1), (0, 2), (1, 2)] {
        let mut region = around(polytope, triangle, corners[vertex]);
        let apex = Apex { vertex: corners[k], is_known: true };
        if replace::<L, V, T, W>(polytope, edges, &mut region, apex, demand) {
            return true;
        }
    }
    false
}

/// The triangles that have a vertex, which the root has.
fn around<const V: usize, const T: usize>(polytope: &Polytope<V, T>, root: usize, vertex: u8) -> Region {
    let mut region = Region { words: [0; MOST_WORDS], count: polytope.triangle_count.div_ceil(64), root };
    for triangle in 0..polytope.triangle_count {
        if polytope.corners_of(triangle).contains(&vertex) {
            region.add(triangle);
        }
    }
    region
}

/// Puts the cone from a vertex over the rim of a region in its place, see [`insert`].
#[inline(always)]
fn replace<L: Lanes, const V: usize, const T: usize, const W: usize>(
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    region: &mut Region,
    apex: Apex,
    demand: &Demand,
) -> bool {
    for _ in 0..MOST_TAKEN {
        let from = polytope.triangle_count;
        let Some(to) = lay_cone(polytope, edges, region, apex.vertex) else { return false };
        let folded = if apex.is_known { folded(polytope, region, apex.vertex, from, to) } else { Folded::Nowhere };
        let wrong = match folded {
            Folded::Nowhere => match judge::<L, V, T>(polytope, from, to, demand) {
                Verdict::AsDemanded => {
                    polytope.triangle_count = to;
                    remove(polytope, region);
                    return true;
                }
                Verdict::Wrong(triangle) => triangle,
                Verdict::Refused => return false,
            },
            Folded::At(triangle) => triangle,
            Folded::Apart => return false,
        };
        let [tail, head, _] = polytope.corners_of(wrong);
        let Some(behind) = with_edge(&polytope.corners[..from], head, tail) else { return false };
        region.add(behind);
    }
    false
}

/// The vertex of a cone.
#[derive(Debug, Clone, Copy)]
pub struct Apex {
    /// Which.
    pub vertex: u8,
    /// Whether it was a vertex of the polytope before.
    pub is_known: bool,
}

/// Triangles, a bit for each.
struct Region {
    words: [u64; MOST_WORDS],
    /// Words in use.
    count: usize,
    /// The triangle with which the others must hang together; it is one of them.
    root: usize,
}

/// Words for as many triangles as there are in any polytope.
const MOST_WORDS: usize = 8;

// (A remainder that changes nothing spares a check of bounds.)
impl Region {
    #[inline(always)]
    fn add(&mut self, triangle: usize) {
        self.words[triangle / 64 % MOST_WORDS] |= 1 << (triangle % 64);
    }

    #[inline(always)]
    fn contains(&self, triangle: usize) -> bool {
        self.words[triangle / 64 % MOST_WORDS] >> (triangle % 64) & 1 != 0
    }
}

/// The root, and the triangles whose planes a vertex is beyond, by more than rounding. Those without a plane are none of them.
#[inline(always)]
fn visible<L: Lanes, const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    root: usize,
    apex: u8,
    rounding: &PairRounding,
) -> Region {
    const { assert!(T <= 64 * MOST_WORDS, "a bit for each triangle") };
    let target = L::load(&polytope.positions[usize::from(apex)]);
    let [x, y, z] = [target.splat_x(), target.splat_y(), target.splat_z()];
    // The distance was lessened by the rounding of a plane, which may be as much in each of both heights.
    let [error, none] = [L::splat(2.0 * rounding.plane), L::splat(NO_PLANE)];
    let count = polytope.triangle_count;
    // Triangles are looked at in fours.
    polytope.distances[count..count + 3].fill(f64::INFINITY);
    let mut region = Region { words: [0; MOST_WORDS], count: count.div_ceil(64), root };
    region.add(root);
    let mut first = 0;
    while first < count {
        let [along_x, along_y, along_z] = &polytope.normals;
        let height = x.mul_add(four(along_x, first), y.mul_add(four(along_y, first), z.mul(four(along_z, first))));
        let distance: L = four(&polytope.distances, first);
        let seen = height.greater(distance.add(error)) & distance.greater(none);
        region.words[first / 64 % MOST_WORDS] |= u64::from(seen) << (first % 64);
        first += 4;
    }
    region
}

/// Four numbers from a place on.
#[inline(always)]
fn four<L: Lanes, const T: usize>(numbers: &[f64; T], first: usize) -> L {
    let &[a, b, c, d] = &numbers[first..first + 4] else { return L::splat(f64::INFINITY) };
    L::load(&[a, b, c, d])
}

/// Lays out the cone from a vertex over the rim of some triangles behind all others, and says where it ends. `None` where there is
/// no room, or an edge would be there twice.
#[inline(always)]
fn lay_cone<const V: usize, const T: usize, const W: usize>(
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    region: &mut Region,
    apex: u8,
) -> Option<usize> {
    let from = polytope.triangle_count;
    connect(polytope, edges, region);
    let (mut to, mut is_refused) = (from, false);
    for (word, mut triangles) in region.words[..region.count].iter().copied().enumerate() {
        while triangles != 0 {
            let corners = polytope.corners_of(64 * word + triangles.trailing_zeros() as usize);
            triangles &= triangles - 1;
            for tail in corners {
                let mut count = 0;
                for (word, mut heads) in edges.take(tail).into_iter().enumerate() {
                    while heads != 0 {
                        let head = (64 * word) as u8 + heads.trailing_zeros() as u8;
                        heads &= heads - 1;
                        count += 1;
                        // Over its own edges a cone is nothing.
                        if tail != apex && head != apex {
                            is_refused |= to == Polytope::<V, T>::TRIANGLE_ROOM;
                            polytope.corners[to] = [tail, head, apex, 0];
                            to += usize::from(to < Polytope::<V, T>::TRIANGLE_ROOM);
                        }
                    }
                }
                // The edge from the apex to the tail would be there twice.
                is_refused |= count > 1 && tail != apex;
            }
        }
    }
    (!is_refused && to > from).then_some(to)
}

/// Leaves in a region what hangs together with its root over edges, and adds its edges. (Of a polytope that bodies have
/// moved a vertex may be beyond others, too.)
#[inline(always)]
fn connect<const V: usize, const T: usize, const W: usize>(
    polytope: &Polytope<V, T>,
    edges: &mut Edges<V, W>,
    region: &mut Region,
) {
    let from = region.root;
    let mut open = region.words;
    region.words = [0; MOST_WORDS];
    region.add(from);
    open[from / 64 % MOST_WORDS] &= !(1 << (from % 64));
    // No edge of the polytope is there twice.
    edges.add(polytope.corners_of(from));
    let mut has_grown = true;
    while has_grown {
        has_grown = false;
        for (word, open) in open[..region.count].iter_mut().enumerate() {
            let mut triangles = *open;
            while triangles != 0 {
                let triangle = 64 * word + triangles.trailing_zeros() as usize;
                triangles &= triangles - 1;
                let corners = polytope.corners_of(triangle);
                if edges.touch(corners) {
                    edges.add(corners);
                    region.add(triangle);
                    *open &= !(1 << (triangle % 64));
                    has_grown = true;
                }
            }
        }
    }
}

/// How the cone from a vertex of the polytope lies on triangles outside the region, so that an edge would be there twice.
enum Folded {
    Nowhere,
    /// This triangle of the cone lies on the one behind it.
    At(usize),
    /// They have an edge of the apex in common.
    Apart,
}

#[cold]
#[inline(never)]
fn folded<const V: usize, const T: usize>(
    polytope: &Polytope<V, T>,
    region: &Region,
    apex: u8,
    from: usize,
    to: usize,
) -> Folded {
    let mut folded = Folded::Nowhere;
    for triangle in (0..from).filter(|triangle| !region.contains(*triangle)) {
        let [following, preceding] = match polytope.corners_of(triangle) {
            [a, b, c] if a == apex => [b, c],
            [a, b, c] if b == apex => [c, a],
            [a, b, c] if c == apex => [a, b],
            _ => continue,
        };
        for new in from..to {
            let [tail, head, _] = polytope.corners_of(new);
            if tail == preceding && head == following {
                return Folded::At(new);
            }
            if tail == following || head == preceding {
                folded = Folded::Apart;
            }
        }
    }
    folded
}

/// The verdict on the new triangles.
enum Verdict {
    AsDemanded,
    /// Without what is behind this triangle they may be.
    Wrong(usize),
    Refused,
}

/// Evaluates the new triangles.
#[inline(always)]
fn judge<L: Lanes, const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    from: usize,
    to: usize,
    demand: &Demand,
) -> Verdict {
    let least = evaluate::<L, V, T>(polytope, &demand.rounding, &demand.centre, from, to);
    let side = if demand.about_origin { least.distance } else { least.height };
    if side > 0.0 && least.distance + demand.rounding.plane > demand.least {
        return Verdict::AsDemanded;
    }
    find_wrong(polytope, from, to, demand)
}

/// The first triangle that looks the wrong way, before any that is too near.
#[cold]
#[inline(never)]
fn find_wrong<const V: usize, const T: usize>(
    polytope: &Polytope<V, T>,
    from: usize,
    to: usize,
    demand: &Demand,
) -> Verdict {
    for triangle in from..to {
        let distance = polytope.distances[triangle];
        let corner = polytope.position(polytope.corners[triangle][0]);
        let height = polytope.normal(triangle).dot(&(corner - demand.centre));
        let side = if demand.about_origin { distance } else { height };
        if distance == NO_PLANE || !(side > 0.0) {
            return Verdict::Wrong(triangle);
        }
        if !(distance + demand.rounding.plane > demand.least) {
            break;
        }
    }
    Verdict::Refused
}

/// The triangle that has an edge.
#[cold]
fn with_edge(triangles: &[[u8; 4]], tail: u8, head: u8) -> Option<usize> {
    triangles.iter().position(|&[a, b, c, _]| [(a, b), (b, c), (c, a)].contains(&(tail, head)))
}

/// Takes triangles out, the last first, and moves the last of all to the place of each.
#[inline(always)]
fn remove<const V: usize, const T: usize>(polytope: &mut Polytope<V, T>, region: &Region) {
    for (word, mut triangles) in region.words[..region.count].iter().copied().enumerate().rev() {
        while triangles != 0 {
            let bit = 63 - triangles.leading_zeros() as usize;
            triangles ^= 1 << bit;
            let (hole, last) = (64 * word + bit, polytope.triangle_count - 1);
            polytope.triangle_count = last;
            polytope.corners[hole] = polytope.corners[last];
            polytope.distances[hole] = polytope.distances[last];
            polytope.certain[hole] = polytope.certain[last];
            for axis in &mut polytope.normals {
                axis[hole] = axis[last];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::simd::Portable;
    use crate::random::Random;

    const ROUNDING: PairRounding =
        PairRounding { difference: 1e-15, plane: 1e-14, determinant: 1e-14, provable: 1e-13 };

    fn tetrahedron() -> Polytope<64, 128> {
        let mut polytope = Polytope::EMPTY;
        for (i, [x, y, z]) in
            [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].into_iter().enumerate()
        {
            polytope.add_vertex([i as u32, 0], [x, y, z, 0.0]);
        }
        polytope.corners[..4].copy_from_slice(&[[0, 1, 2, 0], [0, 2, 3, 0], [0, 3, 1, 0], [3, 2, 1, 0]]);
        polytope.triangle_count = 4;
        evaluate::<Portable, 64, 128>(&mut polytope, &ROUNDING, &Vector::zeros(), 0, 4);
        polytope
    }

    /// Points of a sphere come in one by one, and each time what is left is a closed surface with all of them around the centre. Of
    /// a known vertex the same triangles come again, or nothing changes; and no cycle is left where a corner is another one.
    #[test]
    fn what_is_inserted_leaves_a_cycle_around_the_centre() {
        let mut random = Random::new(5);
        let (mut polytope, mut edges) = (tetrahedron(), Edges::<64, 1>::EMPTY);
        let demand = Demand { centre: Vector::zeros(), about_origin: false, least: NO_PLANE, rounding: ROUNDING };
        for count in 5..60 {
            let point = random.direction() * 3_f64.sqrt();
            let vertex = polytope.add_vertex([count, 0], [point.x, point.y, point.z, 0.0]).unwrap();
            let farthest = (0..polytope.triangle_count).map(|t| polytope.normal(t).dot(&point) - polytope.distances[t]);
            let (beyond, _) = farthest.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            let apex = Apex { vertex, is_known: false };
            assert!(insert::<Portable, 64, 128, 1>(&mut polytope, &mut edges, beyond, apex, &demand));
            assert_eq!(polytope.triangle_count, 2 * count as usize - 4);
            assert!(edges.are_cycle(&polytope.corners[..polytope.triangle_count], polytope.vertex_count));
            assert!(polytope.distances[..polytope.triangle_count].iter().all(|distance| *distance > 0.1));
        }
        let triangles = polytope.corners[..polytope.triangle_count].to_vec();
        for place in 0..triangles.len() {
            let mut damaged = triangles.clone();
            damaged[place][place % 3] = (damaged[place][place % 3] + 1) % 59;
            assert!(!edges.are_cycle(&damaged, polytope.vertex_count), "{place}");
            assert!(!edges.are_cycle(&[&triangles[..], &triangles[place..=place]].concat(), polytope.vertex_count));
        }
        // Nor is a surface that is there twice, though it is closed.
        assert!(!edges.are_cycle(&triangles.repeat(2), polytope.vertex_count));
        assert!(edges.are_cycle(&triangles, polytope.vertex_count));
    }

    /// Four sides of a ring of vertices stand on a fifth; above, the ring is closed along the lower diagonal. A vertex beyond fills
    /// the dent, and the triangle that its cone would lie on gives way, too.
    #[test]
    fn a_known_vertex_fills_a_dent() {
        let (mut polytope, mut edges) = (Polytope::<64, 128>::EMPTY, Edges::<64, 1>::EMPTY);
        let ring = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, -1.0]];
        for (i, [x, y, z]) in (0..).zip(ring) {
            polytope.add_vertex([i, 0], [x, y, z, 0.0]);
        }
        let triangles = [[0, 1, 2, 0], [0, 2, 3, 0], [4, 1, 0, 0], [4, 2, 1, 0], [4, 3, 2, 0], [4, 0, 3, 0]];
        polytope.corners[..6].copy_from_slice(&triangles);
        polytope.triangle_count = 6;
        let centre = Vector::new(0.0, 0.0, -0.4);
        evaluate::<Portable, 64, 128>(&mut polytope, &ROUNDING, &centre, 0, 6);
        let demand = Demand { centre, about_origin: false, least: NO_PLANE, rounding: ROUNDING };
        let apex = Apex { vertex: 3, is_known: true };
        assert!(insert::<Portable, 64, 128, 1>(&mut polytope, &mut edges, 0, apex, &demand));
        assert_eq!(polytope.triangle_count, 6);
        assert!(edges.are_cycle(&polytope.corners[..6], 5));
        assert!(
            (0..5)
                .all(|v| (0..6).all(|t| polytope.normal(t).dot(&polytope.position(v)) < polytope.distances[t] + 1e-12))
        );
    }
}
