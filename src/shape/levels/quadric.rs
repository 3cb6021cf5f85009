//! Simplification by edge collapse under quadric errors (M. Garland, P. S. Heckbert, "Surface Simplification Using Quadric
//! Error Metrics", SIGGRAPH 1997): step C1 of the quadric levels of Ehmann & Lin 2000, §4.5.
//!
//! Each vertex carries the sum of the squared distances from the planes of the triangles that went into it, each weighted by
//! its area. The edge whose collapse adds least goes first, into the point where the sum is least. So flat regions go first,
//! and the tessellation that is left has about the same density everywhere on the sphere of normals.
//!
//! A quadric is kept about its own vertex, not about the origin: its rounding error is then relative to the length of edges
//! and not to the size of the body, and 200,000 triangles are as good as 200.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::base::error::Result;
use crate::base::math::{Vector, binary_order, power_of_two};
use crate::base::memory::{collected, copied, filled, push, push_to_heap};
use crate::base::progress::Progress;
use crate::body::polyhedron::triangulation::{Triangulation, next, previous};

/// A simplified surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    /// Its vertices: each one of the given ones, or a point that replaces several. In order of the given ones.
    pub points: Vec<Vector>,
    /// A closed surface of the same topology over `points`, oriented as before; in general not convex.
    pub triangles: Vec<[u32; 3]>,
}

/// Edges flatter than 1e-5 of their length are ordered by length: their costs are equal up to rounding.
const FLATNESS: f64 = 1e-10;

/// An optimal place is computed only where the quadric's matrix has no pivot below this fraction of its trace: then rounding
/// moves the place by less than 1e-5 of the edge.
const LEAST_PIVOT: f64 = 1e-10;

/// Neighbours looked at between two reports of progress.
const REPORT_INTERVAL: usize = 1 << 14;

/// Collapses edges until at most `target` triangles are left, four at least. More are left only where every further collapse
/// would turn a triangle over or change the topology; for a flat body, which has two triangles over every edge, nothing is
/// collapsed. The result depends on the arguments alone.
///
/// The triangles are a closed surface over all of `positions`, counter-clockwise from outside, as those of an exact hull.
/// Time O(n log n) as long as valences are bounded.
///
/// # Errors
/// [`Error::Cancelled`](crate::base::error::Error::Cancelled); [`Error::Memory`](crate::base::error::Error::Memory);
/// [`Error::Bug`](crate::base::error::Error::Bug) if the triangles are no closed surface.
pub fn simplify(
    positions: &[Vector],
    triangles: &[[u32; 3]],
    target: usize,
    progress: &mut Progress,
) -> Result<Simplified> {
    // A power of two takes the body to size 1 and back without rounding, so that no product can overflow.
    let size = positions.iter().map(|p| p.amax()).fold(0.0, f64::max);
    let factor = if size > 0.0 { power_of_two(-binary_order(size).clamp(-1000, 1000)) } else { 1.0 };
    let mut collapse = Collapse::new(collected(positions.iter().map(|p| p * factor))?, triangles)?;
    collapse.run(target.max(4), progress)?;
    let mut simplified = collapse.finish()?;
    for point in &mut simplified.points {
        *point /= factor;
    }
    Ok(simplified)
}

// ---------------------------------------------------------------------------------------------------------------------
// Quadrics
// ---------------------------------------------------------------------------------------------------------------------

/// xᵀAx + 2b·x + c for x relative to a vertex.
#[derive(Debug, Clone, Copy, Default)]
struct Quadric {
    /// The upper half of A: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: Vector,
    c: f64,
}

impl Quadric {
    /// Adds `weight` times the squared distance from the plane through the vertex with the given unit normal.
    fn add_plane(&mut self, normal: &Vector, weight: f64) {
        debug_assert!(weight >= 0.0);
        let [x, y, z] = [normal.x, normal.y, normal.z];
        for (sum, term) in self.a.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z]) {
            *sum += weight * term;
        }
    }

    fn times(&self, x: &Vector) -> Vector {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        Vector::new(xx * x.x + xy * x.y + xz * x.z, xy * x.x + yy * x.y + yz * x.z, xz * x.x + yz * x.y + zz * x.z)
    }

    /// At least 0, which it is up to rounding.
    fn value(&self, x: &Vector) -> f64 {
        (x.dot(&(self.times(x) + self.b * 2.0)) + self.c).max(0.0)
    }

    /// The same function, relative to the point x.
    fn about(&self, x: &Vector) -> Quadric {
        Quadric { a: self.a, b: self.b + self.times(x), c: self.value(x) }
    }

    fn sum(&self, other: &Quadric) -> Quadric {
        let mut a = self.a;
        for (sum, term) in a.iter_mut().zip(other.a) {
            *sum += term;
        }
        Quadric { a, b: self.b + other.b, c: self.c + other.c }
    }

    fn trace(&self) -> f64 {
        self.a[0] + self.a[3] + self.a[5]
    }

    /// The x of least value, by A = L·D·Lᵀ, where A is well conditioned.
    fn minimum(&self) -> Option<Vector> {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let least = LEAST_PIVOT * self.trace();
        let (l10, l20) = (xy / xx, xz / xx);
        let d1 = yy - l10 * xy;
        let l21 = (yz - l20 * xy) / d1;
        let d2 = zz - l20 * xz - l21 * l21 * d1;
        // A NaN is no pivot either.
        if !(xx > least && d1 > least && d2 > least) {
            return None;
        }
        let y0 = -self.b.x;
        let y1 = -self.b.y - l10 * y0;
        let y2 = -self.b.z - l20 * y0 - l21 * y1;
        let z = y2 / d2;
        let y = y1 / d1 - l21 * z;
        Some(Vector::new(y0 / xx - l10 * y - l20 * z, y, z))
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Collapsing
// ---------------------------------------------------------------------------------------------------------------------

/// A half-edge waiting for its turn; the least key first, among equal ones the lowest index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct WaitingEdge {
    /// The bits of a number ≥ 0, which are ordered as the numbers are.
    key: u64,
    half_edge: u32,
    /// The sum of its ends' versions; another one now means that the entry is out of date.
    stamp: u32,
}

/// Half-edges in order. A heap of all would be larger than the caches, and every step through it a wait for memory; so only those
/// of about the least key are in one.
struct Queue {
    /// By the key's exponent and first bits of its mantissa: all keys in one are below those in the next.
    buckets: Vec<Vec<Reverse<WaitingEdge>>>,
    /// Index of the next bucket; all of those before are in the heap.
    next: usize,
    heap: BinaryHeap<Reverse<WaitingEdge>>,
}

impl Queue {
    /// Bits of a key that do not count for its bucket: an eighth of an octave goes into one.
    const SHIFT: u32 = 49;

    /// Keys of a body of size 1 are below 16; all from there on share the last bucket.
    const BUCKETS: usize = (16.0_f64.to_bits() >> Queue::SHIFT) as usize + 1;

    fn new() -> Result<Queue> {
        Ok(Queue { buckets: filled(Vec::new(), Queue::BUCKETS)?, next: 0, heap: BinaryHeap::new() })
    }

    fn push(&mut self, waiting: WaitingEdge) -> Result<()> {
        let bucket = ((waiting.key >> Queue::SHIFT) as usize).min(Queue::BUCKETS - 1);
        if bucket < self.next {
            push_to_heap(&mut self.heap, Reverse(waiting))
        } else {
            push(&mut self.buckets[bucket], Reverse(waiting))
        }
    }

    /// The first, taken out.
    fn pop(&mut self) -> Option<WaitingEdge> {
        while self.heap.is_empty() && self.next < self.buckets.len() {
            let bucket = std::mem::take(&mut self.buckets[self.next]);
            self.heap = BinaryHeap::from(bucket);
            self.next += 1;
        }
        self.heap.pop().map(|Reverse(waiting)| waiting)
    }
}

/// A place for the vertex that replaces an edge.
#[derive(Debug, Clone, Copy)]
struct CollapseTarget {
    key: f64,
    /// Relative to the tail.
    at: Vector,
}

/// No vertex: the corners of a triangle that is gone.
const GONE: u32 = u32::MAX;

/// The surface while it shrinks, as half-edges: half-edge 3t + k runs from corner k of triangle t to the next one.
struct Collapse {
    positions: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
    twins: Vec<u32>,
    /// One half-edge out of each vertex.
    outgoing: Vec<u32>,
    quadrics: Vec<Quadric>,
    versions: Vec<u32>,
    queue: Queue,
    /// Triangles that are left.
    count: usize,
    /// Marks of vertices that need no clearing.
    marks: Vec<u32>,
    mark: u32,
    /// Neighbours looked at: in proportion to the work, high valences included.
    looked_at: usize,
}

impl Collapse {
    fn new(positions: Vec<Vector>, triangles: &[[u32; 3]]) -> Result<Collapse> {
        let area = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|v| positions[v as usize]);
            (q - p).cross(&(r - p))
        };
        // Twice the triangles' area vectors.
        let areas: Vec<Vector> = collected(triangles.iter().map(area))?;
        let mut quadrics = filled(Quadric::default(), positions.len())?;
        for (triangle, area) in triangles.iter().zip(&areas) {
            let length = area.norm();
            if length > 0.0 {
                for &corner in triangle {
                    quadrics[corner as usize].add_plane(&(area / length), length / 6.0);
                }
            }
        }
        let surface = Triangulation::new(copied(triangles)?, &areas, positions.len())?;
        let count = positions.len();
        Ok(Collapse {
            outgoing: collected((0..count as u32).map(|v| surface.around(v)[0]))?,
            count: surface.triangles.len(),
            triangles: surface.triangles,
            twins: surface.twins,
            positions,
            quadrics,
            versions: filled(0, count)?,
            queue: Queue::new()?,
            marks: filled(0, count)?,
            mark: 0,
            looked_at: 0,
        })
    }

    fn run(&mut self, target: usize, progress: &mut Progress) -> Result<()> {
        let start = self.count;
        let mut next_report = 0;
        // An edge that was refused waits for its own vertices to change. When none is left the changes around them may have freed
        // some: all are asked again, as long as that gets on by a fixed fraction, so that the rounds are few.
        loop {
            let before = self.count;
            self.fill_queue()?;
            while self.count > target
                && let Some(waiting) = self.queue.pop()
            {
                if !self.is_current(&waiting) {
                    continue;
                }
                if self.looked_at >= next_report {
                    next_report = self.looked_at + REPORT_INTERVAL;
                    progress.report((start - self.count) as f64 / (start - target) as f64)?;
                }
                let h = waiting.half_edge;
                if !self.keeps_topology(h) {
                    continue;
                }
                match self.best_place(h) {
                    // Its better places turn triangles over; its turn comes later.
                    Some(place) if place.key.to_bits() > waiting.key => {
                        self.queue.push(WaitingEdge { key: place.key.to_bits(), ..waiting })?;
                    }
                    Some(place) => self.collapse(h, &place.at)?,
                    None => {}
                }
            }
            if self.count <= target || before - self.count < before / 16 + 1 {
                return Ok(());
            }
        }
    }

    fn fill_queue(&mut self) -> Result<()> {
        self.queue = Queue::new()?;
        for h in 0..self.twins.len() as u32 {
            if self.tail(h) != GONE && h < self.twins[h as usize] {
                self.enqueue(h)?;
            }
        }
        Ok(())
    }

    fn enqueue(&mut self, h: u32) -> Result<()> {
        let (_, places) = self.places(h);
        let key = places.iter().map(|place| place.key).fold(f64::INFINITY, f64::min).to_bits();
        self.queue.push(WaitingEdge { key, half_edge: h, stamp: self.stamp(h) })
    }

    fn is_current(&self, waiting: &WaitingEdge) -> bool {
        self.tail(waiting.half_edge) != GONE && self.stamp(waiting.half_edge) == waiting.stamp
    }

    fn stamp(&self, h: u32) -> u32 {
        self.versions[self.tail(h) as usize].wrapping_add(self.versions[self.head(h) as usize])
    }

    fn tail(&self, h: u32) -> u32 {
        self.triangles[h as usize / 3][h as usize % 3]
    }

    fn head(&self, h: u32) -> u32 {
        self.tail(next(h))
    }

    /// The half-edges out of a vertex.
    fn around(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let first = self.outgoing[vertex as usize];
        let following = move |h: &u32| {
            let h = self.twins[previous(*h) as usize];
            (h != first).then_some(h)
        };
        std::iter::successors(Some(first), following)
    }

    /// The quadric of an edge about its tail, and where its vertex could go: to the minimum, to the middle, to an end.
    fn places(&self, h: u32) -> (Quadric, [CollapseTarget; 4]) {
        let [tail, head] = [self.tail(h), self.head(h)].map(|v| v as usize);
        let along = self.positions[head] - self.positions[tail];
        let quadric = self.quadrics[tail].sum(&self.quadrics[head].about(&-along));
        let square = along.norm_squared();
        let flat = FLATNESS * quadric.trace() * square;
        let place = |at: Vector| CollapseTarget { key: quadric.value(&at) + flat, at };
        let middle = along / 2.0;
        // In a region that is flat in one direction the minimum may be anywhere along it.
        let near = |at: &Vector| (at - middle).norm_squared() <= square;
        let best = quadric.minimum().filter(near).map_or(CollapseTarget { key: f64::INFINITY, at: middle }, place);
        (quadric, [best, place(middle), place(Vector::zeros()), place(along)])
    }

    /// The cheapest place that turns no triangle over.
    fn best_place(&self, h: u32) -> Option<CollapseTarget> {
        let (_, mut places) = self.places(h);
        places.sort_by(|p, q| p.key.total_cmp(&q.key));
        places.into_iter().find(|place| place.key < f64::INFINITY && self.turns_nothing_over(h, &place.at))
    }

    /// The link condition: the ends have no common neighbours but the two across the edge's triangles, and no second edge joins
    /// them, as it does in flat bodies. (On a closed surface with more than four triangles that is all of it.)
    fn keeps_topology(&mut self, h: u32) -> bool {
        let (tail, head) = (self.tail(h), self.head(h));
        if self.count <= 4 || self.tail(previous(h)) == self.tail(previous(self.twins[h as usize])) {
            return false;
        }
        self.mark += 1;
        let first = self.outgoing[tail as usize];
        let mut around = first;
        loop {
            let neighbour = self.head(around);
            self.marks[neighbour as usize] = self.mark;
            self.looked_at += 1;
            around = self.twins[previous(around) as usize];
            if around == first {
                break;
            }
        }
        // The tail marks itself, so that an edge to it counts, too.
        self.marks[tail as usize] = self.mark;
        let mut common = 0;
        let mut visited = 0;
        for g in self.around(head) {
            common += usize::from(self.marks[self.head(g) as usize] == self.mark);
            visited += 1;
        }
        self.looked_at += visited;
        common == 3
    }

    /// Whether all triangles that stay keep facing the same way, to less than a right angle, and keep an area.
    fn turns_nothing_over(&self, h: u32, at: &Vector) -> bool {
        let ends = [self.tail(h), self.head(h)];
        let place = self.positions[ends[0] as usize] + at;
        ends.iter().all(|&end| {
            let own = self.positions[end as usize];
            self.around(end).all(|g| {
                let [p, q] = [self.head(g), self.tail(previous(g))];
                if ends.contains(&p) || ends.contains(&q) {
                    return true;
                }
                let [p, q] = [p, q].map(|v| self.positions[v as usize]);
                let side = q - p;
                (p - own).cross(&side).dot(&(p - place).cross(&side)) > 0.0
            })
        })
    }

    /// Replaces the edge by one vertex, `at` relative to its tail.
    fn collapse(&mut self, h: u32, at: &Vector) -> Result<()> {
        debug_assert!(self.tail(h) != GONE);
        let (quadric, _) = self.places(h);
        let twin = self.twins[h as usize];
        let (dropped, kept) = (self.tail(h), self.head(h));
        let (left, right) = (self.tail(previous(h)), self.tail(previous(twin)));
        let place = self.positions[dropped as usize] + at;

        let mut retargeted = self.outgoing[dropped as usize];
        let first = retargeted;
        loop {
            let following = self.twins[previous(retargeted) as usize];
            self.triangles[retargeted as usize / 3][retargeted as usize % 3] = kept;
            retargeted = following;
            if retargeted == first {
                break;
            }
        }
        // The two other sides of either triangle become one edge: from the kept vertex, to it.
        let glued = [
            [self.twins[previous(h) as usize], self.twins[next(h) as usize]],
            [self.twins[previous(twin) as usize], self.twins[next(twin) as usize]],
        ];
        for [one, other] in glued {
            self.twins[one as usize] = other;
            self.twins[other as usize] = one;
        }
        self.triangles[h as usize / 3] = [GONE; 3];
        self.triangles[twin as usize / 3] = [GONE; 3];
        self.count -= 2;
        self.outgoing[kept as usize] = glued[0][0];
        self.outgoing[left as usize] = glued[0][1];
        self.outgoing[right as usize] = glued[1][1];
        self.outgoing[dropped as usize] = GONE;

        self.positions[kept as usize] = place;
        self.quadrics[kept as usize] = quadric.about(at);
        // Later than either end: no entry of an edge that was at one of them can pass for current.
        let latest = self.versions[kept as usize].max(self.versions[dropped as usize]);
        self.versions[kept as usize] = latest + 1;
        let mut around = self.outgoing[kept as usize];
        let first = around;
        loop {
            self.enqueue(around)?;
            self.looked_at += 1;
            around = self.twins[previous(around) as usize];
            if around == first {
                break;
            }
        }
        Ok(())
    }

    fn finish(self) -> Result<Simplified> {
        let mut index = filled(GONE, self.positions.len())?;
        let mut points = Vec::new();
        for (v, position) in self.positions.into_iter().enumerate() {
            if self.outgoing[v] != GONE {
                index[v] = points.len() as u32;
                push(&mut points, position)?;
            }
        }
        let is_left = |t: &&[u32; 3]| t[0] != GONE;
        let renumbered = |t: &[u32; 3]| t.map(|v| index[v as usize]);
        let triangles = collected(self.triangles.iter().filter(is_left).map(renumbered))?;
        Ok(Simplified { points, triangles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    /// As a heap of all, whatever comes in while it is emptied.
    #[test]
    fn the_queue_is_in_order() {
        let mut random = Random::new(8);
        let (mut queue, mut heap) = (Queue::new().unwrap(), BinaryHeap::new());
        for half_edge in 0..2000 {
            let key = match half_edge % 100 {
                0 => f64::INFINITY,
                1 => 0.0,
                2 => 100.0,
                _ => random.uniform(0.0, 1.0).powi(9),
            };
            let waiting = WaitingEdge { key: key.to_bits(), half_edge, stamp: half_edge % 7 };
            queue.push(waiting).unwrap();
            heap.push(Reverse(waiting));
            if half_edge % 3 == 0 {
                assert_eq!(queue.pop(), heap.pop().map(|Reverse(waiting)| waiting));
            }
        }
        while let Some(Reverse(waiting)) = heap.pop() {
            assert_eq!(queue.pop(), Some(waiting));
        }
        assert_eq!(queue.pop(), None);
    }
}
