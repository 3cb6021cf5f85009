//! Look-ups on both bodies by turns, each for what was found on the other.

use super::start_pair::{Guess, StartPair};
use crate::base::math::{Pose, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::tables::nearest_vertex::NearestVertex;
use crate::placed::Pair;

/// Projects on both bodies the other's centre of mass or last vertex, then the vertices that were found there, and so on, by the
/// tables. Both at once: two chains of look-ups take the time of one, and three rounds lead to as good a start as one chain of four
/// look-ups.
struct Alternate<'a, F, S> {
    first: &'a F,
    second: &'a S,
    // Lent, not copied (R1).
    from: &'a LookUps<'a>,
}

/// A pair, and from where its look-ups begin.
pub(super) struct LookUps<'a> {
    pub(super) pair: Pair<'a>,
    /// Vertices to begin from, if rounds from there are fewer than from the centres of mass.
    pub(super) last: [u32; 2],
    pub(super) most_rounds: u32,
}

impl LookUps<'_> {
    /// Look-ups on both bodies by turns.
    #[inline(always)]
    pub(super) fn alternate<F: NearestVertex, S: NearestVertex>(&self, first: &F, second: &S) -> StartPair {
        simd::dispatch(&mut Alternate { first, second, from: self })
    }
}

impl<F: NearestVertex, S: NearestVertex> Kernel for Alternate<'_, F, S> {
    type Output = StartPair;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> StartPair {
        let &mut Alternate { first, second, from } = self;
        let [there, back] = self.maps::<L>();
        let mut rounds = first.rounds().max(second.rounds());
        let (mut seen1, mut seen2) = (back.offset, there.offset);
        if from.most_rounds < rounds {
            rounds = from.most_rounds;
            seen1 = back.apply(second.position(from.last[1]));
            seen2 = there.apply(first.position(from.last[0]));
        }
        let mut vertices = [first.nearest(seen1), second.nearest(seen2)];
        self.prefetch::<L>(vertices);
        for _ in 1..rounds {
            let [point1, point2] = [first.position(vertices[0]), second.position(vertices[1])];
            vertices = [first.nearest(back.apply(point2)), second.nearest(there.apply(point1))];
            // The last ones are where marching begins; those before are often the same, or neighbours.
            self.prefetch::<L>(vertices);
        }
        let mut guess = self.guess([&there, &back], vertices);
        if guess == Guess::Overlapping {
            // Each was looked up for the vertex before the other, so thin bodies that are apart often look as if they overlapped. A
            // pair of which one was looked up for the other does so less often.
            vertices[0] = first.nearest(back.apply(second.position(vertices[1])));
            vertices[1] = second.nearest(there.apply(first.position(vertices[0])));
            guess = self.guess([&there, &back], vertices);
        }
        StartPair::new(vertices, guess)
    }
}

impl<'a, F: NearestVertex, S: NearestVertex> Alternate<'a, F, S> {
    #[inline(always)]
    fn prefetch<L: Lanes>(&self, vertices: [u32; 2]) {
        for (polyhedron, vertex) in self.from.pair.polyhedra.iter().zip(vertices) {
            L::prefetch(&polyhedron.vertices, vertex);
        }
    }

    /// From body 1's frame and unit to body 2's, and back.
    #[inline(always)]
    fn maps<L: Lanes>(&self) -> [Map; 2] {
        let placed = [LanePose::<L>::new(self.from.pair.poses[0]), LanePose::<L>::new(self.from.pair.poses[1])];
        let [mass1, mass2] = self.from.pair.polyhedra.map(|polyhedron| &polyhedron.mass);
        let between = placed[0].transform(&mass1.centre_of_mass).sub(placed[1].transform(&mass2.centre_of_mass));
        [
            Map::new([&placed[0], &placed[1]], between, [mass1.radius, mass2.radius]),
            Map::new([&placed[1], &placed[0]], between.negate(), [mass2.radius, mass1.radius]),
        ]
    }

    #[inline(always)]
    fn guess(&self, [there, back]: [&Map; 2], vertices: [u32; 2]) -> Guess {
        let &Alternate { first, second, .. } = self;
        let (Some(outward1), Some(outward2)) = (first.outward(), second.outward()) else {
            return self.guess_along_centres(there, back);
        };
        let [point1, point2] = [first.position(vertices[0]), second.position(vertices[1])];
        let faces1 = is_facing(outward1, point1, back.apply(point2));
        let faces2 = is_facing(outward2, point2, there.apply(point1));
        match (faces1, faces2) {
            (true, true) => Guess::Apart,
            (false, false) => Guess::Overlapping,
            _ => Guess::Unclear,
        }
    }

    /// Whether the bodies are apart along the line of their centres of mass.
    #[inline(always)]
    fn guess_along_centres(&self, there: &Map, back: &Map) -> Guess {
        // How far the body reaches towards the other's centre of mass, which is at this point, as a fraction of the way.
        let part = |point: [f32; 3], [x, y, z, _]: [f32; 4]| {
            let [a, b, c] = point;
            let square = a * a + b * b + c * c;
            if square > 0.0 { (a * x + b * y + c * z) / square } else { f32::INFINITY }
        };
        let part1 = part(back.offset, self.first.position(self.first.farthest(back.offset)));
        let part2 = part(there.offset, self.second.position(self.second.farthest(there.offset)));
        if part1 + part2 < 1.0 { Guess::Apart } else { Guess::Unclear }
    }
}

/// Whether a vertex looks out of its body when it looks at a point.
#[inline(always)]
fn is_facing(outward: &[[f32; 3]; 3], vertex: [f32; 4], point: [f32; 3]) -> bool {
    let [a, b, c] = outward;
    let mut sum = 0.0;
    for i in 0..3 {
        sum += (point[i] - vertex[i]) * (a[i] * vertex[0] + (b[i] * vertex[1] + c[i] * vertex[2]));
    }
    sum > 0.0
}

/// A pose in lanes.
struct LanePose<L> {
    rows: [L; 3],
    /// The columns of R, and T.
    columns: [L; 4],
}

impl<L: Lanes> LanePose<L> {
    #[inline(always)]
    fn new(pose: &Pose) -> LanePose<L> {
        let rows = [L::load(&pose.rows[0]), L::load(&pose.rows[1]), L::load(&pose.rows[2])];
        LanePose { rows, columns: L::transpose(&rows) }
    }

    #[inline(always)]
    fn transform(&self, p: &Vector) -> L {
        let [x, y, z, translation] = self.columns;
        x.mul_add(L::splat(p.x), y.mul_add(L::splat(p.y), z.mul_add(L::splat(p.z), translation)))
    }

    #[inline(always)]
    fn rotate_back(&self, d: L) -> L {
        let [x, y, z] = self.rows;
        z.mul_add(d.splat_z(), y.mul_add(d.splat_y(), x.mul(d.splat_x())))
    }
}

/// Points relative to one body's centre of mass, in units of its radius, seen from another body in the same way.
#[derive(Clone, Copy)]
struct Map {
    /// The factors of the first, second and third coordinate.
    columns: [[f32; 3]; 3],
    offset: [f32; 3],
}

impl Map {
    /// From one body to another; `between` is the way from the latter's centre of mass to the former's in the world. A transpose
    /// stands in for an inverse: it is all about a good guess.
    #[inline(always)]
    fn new<L: Lanes>([from, to]: [&LanePose<L>; 2], between: L, [radius, to_radius]: [f64; 2]) -> Map {
        let unit = 1.0 / to_radius;
        let (length, [x, y, z, _]) = (L::splat(radius * unit), from.columns);
        let columns = [
            single(to.rotate_back(x).mul(length)),
            single(to.rotate_back(y).mul(length)),
            single(to.rotate_back(z).mul(length)),
        ];
        Map { columns, offset: single(to.rotate_back(between).mul(L::splat(unit))) }
    }

    #[inline(always)]
    fn apply(&self, [x, y, z, _]: [f32; 4]) -> [f32; 3] {
        let [a, b, c] = &self.columns;
        let mut point = self.offset;
        for i in 0..3 {
            point[i] += a[i] * x + (b[i] * y + c[i] * z);
        }
        point
    }
}

/// In single precision.
#[inline(always)]
fn single<L: Lanes>(v: L) -> [f32; 3] {
    let [x, y, z, _] = v.to_array();
    [x as f32, y as f32, z as f32]
}
