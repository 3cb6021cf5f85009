//! The first polytope, grown in single precision, eight triangles at a time.
//!
//! It proposes vertices and triangles, and nothing rests on it: planes and the degree are computed anew in double precision, and
//! the search goes on there where rounding hides something. So no climb settles ties, no distance is a bound, and all that a
//! vertex sees gives way, whether it hangs together or not. The surface stays a cycle for the reason that [`super::cycle`] gives.

use super::cycle::Edges;
use super::storage::Polytope;
use super::support::rough_support;
use crate::base::math::power_of_two;
use crate::base::simd::{Lanes, Twins};
use crate::placed::frame::Frame;

/// The most vertices of a polytope for which there are proposals: a bit for each in a word.
pub const MOST_PROPOSED: usize = 64;

/// Room for triangles, of which the last eight are scratch.
const ROOM: usize = 128;

/// The most triangles that are proposed.
const MOST_TRIANGLES: usize = ROOM - 8;

/// What single precision tells apart, over the longest difference: of a height, the corners, the normal and the product err by
/// 2⁻²⁴ each, the plane's own by more where a triangle is thin.
const RESOLUTION: f64 = 1e-6;

/// The planes and corners of a polytope in single precision. Lengths are over a power of two, so that no square overflows or
/// underflows.
struct Draft<const V: usize> {
    positions: [[f32; 4]; V],
    normals: [[f32; ROOM]; 3],
    /// Infinite beyond the last.
    distances: [f32; ROOM],
}

/// The nearest of the triangles looked at so far, eight times over: place by place.
#[derive(Clone, Copy)]
struct NearestProposal<T> {
    distances: T,
    triangles: T,
}

impl<T: Twins> NearestProposal<T> {
    #[inline(always)]
    fn none() -> Self {
        NearestProposal { distances: all(f32::INFINITY), triangles: all(0.0) }
    }

    /// With eight triangles more.
    #[inline(always)]
    fn and(self, distances: T, triangles: T) -> Self {
        NearestProposal {
            distances: self.distances.min(distances),
            triangles: triangles.where_greater(self.distances, distances, self.triangles),
        }
    }

    /// Which is the nearest, and its distance.
    #[inline(always)]
    fn least(self) -> (usize, f32) {
        let (distance, place) = self.distances.least();
        (self.triangles.to_array()[place % 8] as usize, distance)
    }
}

/// A number eight times.
#[inline(always)]
fn all<T: Twins>(number: f32) -> T {
    T::splat(number, number)
}

/// Eight numbers from a place on.
#[inline(always)]
fn eight<T: Twins>(numbers: &[f32; ROOM], first: usize) -> T {
    T::load_eight(numbers[first..].first_chunk().unwrap_or(&[f32::INFINITY; 8]))
}

/// The goal of a proposal.
#[derive(Debug, Clone, Copy)]
pub struct Goal {
    /// How wide the interval may be, at least what single precision tells apart counts …
    pub width: f64,
    /// … or as a share of its upper end.
    pub share: f64,
    /// How many vertices may be added.
    pub steps: u32,
}

/// Grows a polytope as far as single precision tells. Of its planes nothing is known then. Returns how many vertices were
/// added, and how many supports asked for.
#[inline(always)]
pub fn propose<L: Lanes, const V: usize, const T: usize, const W: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    goal: &Goal,
) -> [u32; 2] {
    const { assert!(V > MOST_PROPOSED || (W == 1 && T >= ROOM), "room for what is proposed") };
    let longest = frame.size + frame.separation;
    debug_assert!(V <= MOST_PROPOSED && polytope.triangle_count >= 4, "a first polytope");
    let unit = power_of_two(-exponent(longest));
    let scale = L::splat(unit);
    let mut draft =
        Draft::<V> { positions: [[0.0; 4]; V], normals: [[0.0; ROOM]; 3], distances: [f32::INFINITY; ROOM] };
    for vertex in 0..polytope.vertex_count {
        draft.positions[vertex] = rounded(L::load(&polytope.positions[vertex]).mul(scale));
    }
    let resolution = RESOLUTION * longest * unit;
    let width = if goal.width * unit > resolution { goal.width * unit } else { resolution };
    let (resolution, width, share) = (resolution as f32, width as f32, goal.share as f32);
    let (mut nearest, mut distance) = draft
        .evaluate::<L, T>(&mut polytope.corners, 0, polytope.triangle_count, None, NearestProposal::none())
        .least();
    let (mut best, mut steps, mut supports) = (f32::INFINITY, 0, 0);
    while steps < goal.steps {
        let normal = draft.normal::<L>(nearest);
        let (pair, difference) = rough_support(frame, normal, None);
        supports += 1;
        let position = difference.mul(scale);
        let value = normal.dot(position) as f32;
        best = if value < best { value } else { best };
        let allowed = if share * best > width { share * best } else { width };
        // If the bodies are apart, double precision finds it.
        let goes_on = (distance < best - allowed) & (value - distance > resolution) & (value > 0.0);
        if !goes_on || polytope.find(pair).is_some() {
            break;
        }
        let Some(vertex) = polytope.add_vertex(pair, difference.to_array()) else { break };
        steps += 1;
        draft.positions[usize::from(vertex)] = rounded(position);
        match draft.insert::<L, T, W>(polytope, edges, vertex, 0.5 * resolution) {
            Some(found) => (nearest, distance) = found,
            None => break,
        }
    }
    [steps, supports]
}

/// The exponent of a positive number; of one that is next to none or to infinity, or no number, one that does not overflow.
#[inline(always)]
fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) as i32 - 1023).clamp(-1000, 1000)
}

/// A vector rounded to single precision.
#[inline(always)]
fn rounded<L: Lanes>(v: L) -> [f32; 4] {
    let mut bits = [0; 4];
    v.store_single(&mut bits);
    bits.map(f32::from_bits)
}

impl<const V: usize> Draft<V> {
    #[inline(always)]
    fn normal<L: Lanes>(&self, triangle: usize) -> L {
        let [x, y, z] = &self.normals;
        let [x, y, z] = [x, y, z].map(|axis| f64::from(axis[triangle % ROOM]));
        L::load(&[x, y, z, 0.0])
    }

    /// The corners of eight triangles, the first, the second or the third of each.
    #[inline(always)]
    fn corners<L: Lanes>(&self, triangles: &[[u8; 4]; 8], which: usize) -> [L::Twins; 3] {
        let [a, b, c, d, e, f, g, h] = triangles;
        let two = |first: &[u8; 4], second: &[u8; 4]| {
            L::Twins::load(
                &self.positions[usize::from(first[which]) % V],
                &self.positions[usize::from(second[which]) % V],
            )
        };
        L::Twins::components(&[two(a, e), two(b, f), two(c, g), two(d, h)])
    }

    /// Computes the planes of triangles `from..to`, which are not none, all with an apex as their third corner if there is one; the
    /// nearest of them and of those before.
    #[inline(always)]
    fn evaluate<L: Lanes, const T: usize>(
        &mut self,
        corners: &mut [[u8; 4]; T],
        from: usize,
        to: usize,
        apex: Option<[L::Twins; 3]>,
        mut nearest: NearestProposal<L::Twins>,
    ) -> NearestProposal<L::Twins> {
        // Eight at a time: the last stands in for missing ones.
        let last = corners[to - 1];
        corners[to..to + 7].fill(last);
        let (end, infinite) = (all::<L::Twins>(to as f32), all::<L::Twins>(f32::INFINITY));
        let mut places =
            all::<L::Twins>(from as f32).add(L::Twins::load_eight(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]));
        let mut first = from;
        while first < to {
            let Some(triangles) = corners[first..].first_chunk() else { break };
            let p = self.corners::<L>(triangles, 0);
            let q = self.corners::<L>(triangles, 1);
            let r = if let Some(apex) = apex { apex } else { self.corners::<L>(triangles, 2) };
            let [ex, ey, ez] = [q[0].sub(p[0]), q[1].sub(p[1]), q[2].sub(p[2])];
            let [gx, gy, gz] = [r[0].sub(p[0]), r[1].sub(p[1]), r[2].sub(p[2])];
            let nx = ez.negated_mul_add(gy, ey.mul(gz));
            let ny = ex.negated_mul_add(gz, ez.mul(gx));
            let nz = ey.negated_mul_add(gx, ex.mul(gy));
            let square = nx.mul_add(nx, ny.mul_add(ny, nz.mul(nz)));
            let inverse = all::<L::Twins>(1.0).div(square.max(all(f32::MIN_POSITIVE)).sqrt());
            let [ux, uy, uz] = [nx.mul(inverse), ny.mul(inverse), nz.mul(inverse)];
            let distance = ux.mul_add(p[0], uy.mul_add(p[1], uz.mul(p[2]))).where_greater(end, places, infinite);
            // Those written beyond the last are infinitely far.
            let [along_x, along_y, along_z] = &mut self.normals;
            for (numbers, eight) in [(along_x, ux), (along_y, uy), (along_z, uz), (&mut self.distances, distance)] {
                numbers[first..first + 8].copy_from_slice(&eight.to_array());
            }
            nearest = nearest.and(distance, places);
            places = places.add(all(8.0));
            first += 8;
        }
        nearest
    }

    /// Puts the cone from a vertex in the place of what it sees, by more than a tolerance, whether that hangs together or not; the
    /// nearest triangle of all then. `None` where there is no room or an edge would be there twice, and nothing has changed.
    #[inline(always)]
    fn insert<L: Lanes, const T: usize, const W: usize>(
        &mut self,
        polytope: &mut Polytope<V, T>,
        edges: &mut Edges<V, W>,
        apex: u8,
        tolerance: f32,
    ) -> Option<(usize, f32)> {
        let count = polytope.triangle_count;
        let [x, y, z, _] = self.positions[usize::from(apex) % V].map(all::<L::Twins>);
        let (tolerance, infinite) = (all::<L::Twins>(tolerance), all::<L::Twins>(f32::INFINITY));
        let (mut nearest, mut seen) = (NearestProposal::none(), [0_u64; ROOM / 64]);
        let mut places = L::Twins::load_eight(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        // Beyond the last there is none that a vertex sees.
        let mut first = 0;
        for word in &mut seen {
            let (mut bits, end) = (0, count.min(first + 64));
            while first < end {
                let [along_x, along_y, along_z] = &self.normals;
                let distance = eight::<L::Twins>(&self.distances, first);
                let [along_x, along_y, along_z] = [eight(along_x, first), eight(along_y, first), eight(along_z, first)];
                let height = x.mul_add(along_x, y.mul_add(along_y, z.mul(along_z)));
                let limit = distance.add(tolerance);
                nearest = nearest.and(infinite.where_greater(height, limit, distance), places);
                bits |= u64::from(height.greater(limit)) << (first % 64);
                places = places.add(all(8.0));
                first += 8;
            }
            *word = bits;
        }
        let to = lay_cone(polytope, edges, &seen, apex)?;
        let (mut triangle, distance) =
            self.evaluate::<L, T>(&mut polytope.corners, count, to, Some([x, y, z]), nearest).least();
        polytope.triangle_count = to;
        for (word, mut triangles) in seen.into_iter().enumerate().rev() {
            while triangles != 0 {
                let bit = 63 - triangles.leading_zeros() as usize;
                triangles ^= 1 << bit;
                let (hole, last) = ((64 * word + bit) % ROOM, (polytope.triangle_count - 1) % ROOM);
                polytope.triangle_count = last;
                polytope.corners[hole] = polytope.corners[last];
                self.distances[hole] = self.distances[last];
                self.distances[last] = f32::INFINITY;
                for axis in &mut self.normals {
                    axis[hole] = axis[last];
                }
                triangle = if triangle == last { hole } else { triangle };
            }
        }
        Some((triangle, distance))
    }
}

/// Lays out the cone from a vertex over the rim of what it sees, behind all triangles, and says where it ends.
#[inline(always)]
fn lay_cone<const V: usize, const T: usize, const W: usize>(
    polytope: &mut Polytope<V, T>,
    edges: &mut Edges<V, W>,
    seen: &[u64; ROOM / 64],
    apex: u8,
) -> Option<usize> {
    let from = polytope.triangle_count;
    for (word, mut triangles) in seen.iter().copied().enumerate() {
        while triangles != 0 {
            let [a, b, c, _] = polytope.corners[(64 * word + triangles.trailing_zeros() as usize) % ROOM];
            edges.add([a, b, c]);
            triangles &= triangles - 1;
        }
    }
    let (mut to, mut doubled) = (from, 0);
    for (word, mut triangles) in seen.iter().copied().enumerate() {
        while triangles != 0 {
            let [a, b, c, _] = polytope.corners[(64 * word + triangles.trailing_zeros() as usize) % ROOM];
            triangles &= triangles - 1;
            for tail in [a, b, c] {
                let heads = edges.take(tail)[0];
                let head = heads.trailing_zeros() & 63;
                // (One number is stored, as it will be read.)
                polytope.corners[to % ROOM] = (u32::from(tail) | head << 8 | u32::from(apex) << 16).to_le_bytes();
                to += usize::from((heads != 0) & (to < MOST_TRIANGLES));
                // The edge from the apex to the tail would be there twice.
                doubled |= heads & heads.wrapping_sub(1);
            }
        }
    }
    // (Where there is no room the last place is written again and again.)
    (doubled == 0 && to > from && to < MOST_TRIANGLES).then_some(to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{Pose, Vector};
    use crate::base::simd::Portable;
    use crate::body::build::assembly::build;
    use crate::depth::polytope::planes::{evaluate, nearest};
    use crate::depth::polytope::{PairRounding, first};
    use crate::placed::Pair;
    use crate::random::Random;

    /// What is proposed is a cycle around the centre of the difference, and no pair of vertices, of all that there are, is beyond
    /// the nearest plane by more than single precision hides. Of units as small or large as are taken as they are, the same.
    #[test]
    fn no_pair_is_beyond_the_nearest_plane_of_a_proposal() {
        let mut random = Random::new(45);
        for (count, unit) in [(8, 1.0), (24, 1e-29), (60, 1e29), (120, 1.0), (300, 1e-3)] {
            let points: Vec<Vector> =
                (0..count).map(|_| random.direction().component_mul(&Vector::new(1.0, 0.7, 0.5)) * unit).collect();
            let body = build(&points, None).unwrap();
            for _ in 0..20 {
                let poses = [Vector::zeros(), random.direction() * (0.5 * unit)]
                    .map(|translation| Pose::new(&random.rotation(), &translation));
                let frame = Frame::<Portable>::new(&Pair { polyhedra: [&body; 2], poses: [&poses[0], &poses[1]] });
                let rounding = PairRounding::of(&frame);
                let (mut polytope, mut edges) = (Polytope::<64, ROOM>::EMPTY, Edges::<64, 1>::EMPTY);
                let centre = first::make(&frame, &mut polytope, &rounding, None, &mut 0).unwrap();
                let goal = Goal { width: 0.0, share: 0.0, steps: u32::MAX };
                let [added, _] = propose::<Portable, 64, ROOM, 1>(&frame, &mut polytope, &mut edges, &goal);
                let triangles = polytope.triangle_count;
                assert!(added as usize + 4 <= polytope.vertex_count);
                assert!(edges.are_cycle(&polytope.corners[..triangles], polytope.vertex_count));
                let least = evaluate::<Portable, 64, ROOM>(&mut polytope, &rounding, &centre, 0, triangles);
                assert!(least.height > 0.0, "{count} {unit:e}");
                let (triangle, distance) = nearest::<Portable, 64, ROOM>(&polytope);
                let normal = polytope.normal(triangle);
                let reach = |pose: &Pose, towards: &Vector| {
                    let heights = points.iter().map(|point| towards.dot(&pose.transform(point)));
                    heights.fold(f64::NEG_INFINITY, f64::max)
                };
                let reached = reach(&poses[0], &normal) + reach(&poses[1], &-normal);
                let beyond = (reached - distance) / (frame.size + frame.separation);
                assert!(beyond < 4.0 * RESOLUTION, "{count} {unit:e}: {beyond:e}");
            }
        }
    }
}
