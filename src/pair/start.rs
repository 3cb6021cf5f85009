//! Where marching starts: from the look-up tables when the last query tells little or nothing.

use crate::base::math::{Pose, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::polyhedron::Polyhedron;
use crate::polyhedron::lookup::{Plan, Table};
use crate::solve::voronoi::climb;
use crate::tables::nearest_vertex::{AllVertices, NearestVertex};
use crate::tables::{table, tables};

/// Where to start.
// Handed back in memory, written number by number: two of them side by side would be read as one, which stalls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Beginning {
    /// A vertex of body 1.
    pub first: u32,
    /// Whether the bodies seem to intersect.
    pub guess: Guess,
    /// A vertex of body 2.
    pub second: u32,
}

impl Beginning {
    #[inline(always)]
    fn new([first, second]: [u32; 2], guess: Guess) -> Beginning {
        Beginning { first, guess, second }
    }

    /// A vertex of each body.
    #[inline(always)]
    pub fn vertices(&self) -> [u32; 2] {
        [self.first, self.second]
    }
}

/// What a look into the tables makes one expect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum Guess {
    /// Each of the two vertices is on the side of its body that faces the other vertex, or they are farthest along a line along
    /// which the bodies are apart: most such pairs are disjoint.
    Apart,
    /// Only one is, they are not apart along that line, or nobody looked.
    Unclear,
    /// Neither is: most such pairs intersect.
    Overlapping,
}

/// So many rounds of look-ups from the last vertices that those from the centres of mass are never more.
pub const FROM_CENTRES: u32 = u32::MAX;

/// Where to start if not where the last query ended: at the vertices that the tables say, if they are to be asked and both bodies
/// have one, or one of them has and the other needs none; or else at those farthest along the line of the bodies' origins.
#[inline(always)]
pub fn anew(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], ask_tables: bool) -> Beginning {
    anew_after(polyhedra, poses, ask_tables, [0; 2], FROM_CENTRES)
}

/// As [`anew`] when the last query ended at or beside these vertices: that many rounds of look-ups from them take the place of
/// those from the bodies' centres of mass where these would be more.
#[inline(never)]
pub fn anew_after(
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    ask_tables: bool,
    last: [u32; 2],
    rounds_from_last: u32,
) -> Beginning {
    if ask_tables {
        // Returned from where it is found: put together elsewhere it would be copied, which stalls.
        match tables(polyhedra) {
            Some([Table::Shells(first), Table::Shells(second)]) => {
                let alternate = Alternate::new(first, second, &polyhedra, &poses);
                return simd::dispatch(&mut Alternate { last, rounds_from_last, ..alternate });
            }
            Some([Table::Spherical(first), Table::Spherical(second)]) => {
                let between = centre_of_mass(polyhedra[1], poses[1]) - centre_of_mass(polyhedra[0], poses[0]);
                let vertices =
                    [first.towards(&poses[0].rotate_back(&between)), second.towards(&poses[1].rotate_back(&-between))];
                return Beginning::new(vertices, Guess::Unclear);
            }
            _ => return beside_few_vertices(polyhedra, poses),
        }
    }
    farthest(polyhedra, poses)
}

/// Where only one body has a table, and the other few vertices, as from two tables; else as without tables. (Of two bodies of few
/// vertices those farthest along a line are found sooner.)
#[inline(never)]
fn beside_few_vertices([body1, body2]: [&Polyhedron; 2], poses: [&Pose; 2]) -> Beginning {
    let polyhedra = [body1, body2];
    match [body1.lookup.plan, body2.lookup.plan] {
        [Plan::AllVertices { rounds }, Plan::Shells { .. }] => {
            if let Table::Shells(second) = table(body2) {
                let first = &AllVertices { polyhedron: body1, rounds };
                return simd::dispatch(&mut Alternate::new(first, second, &polyhedra, &poses));
            }
        }
        [Plan::Shells { .. }, Plan::AllVertices { rounds }] => {
            if let Table::Shells(first) = table(body1) {
                let second = &AllVertices { polyhedron: body2, rounds };
                return simd::dispatch(&mut Alternate::new(first, second, &polyhedra, &poses));
            }
        }
        _ => {}
    }
    farthest(polyhedra, poses)
}

/// Whether spheres inside two bodies overlap, as far as their tables know any; beside a body that needs no table they may.
pub fn may_cores_overlap(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> bool {
    let Some([Table::Shells(first), Table::Shells(second)]) = tables(polyhedra) else {
        return polyhedra.iter().any(|polyhedron| matches!(polyhedron.lookup.plan, Plan::AllVertices { .. }));
    };
    let between = centre_of_mass(polyhedra[0], poses[0]) - centre_of_mass(polyhedra[1], poses[1]);
    let reach = first.core * polyhedra[0].mass.radius + second.core * polyhedra[1].mass.radius;
    between.norm_squared() < reach * reach
}

/// The support vertices along the line of the bodies' origins, and whether the bodies are apart along it.
#[inline(never)]
fn farthest(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> Beginning {
    let origin = |i: usize| poses[i].transform(&polyhedra[i].centre);
    let between = origin(1) - origin(0);
    let towards = [poses[0].rotate_back(&between), poses[1].rotate_back(&-between)];
    let vertices = [0, 1].map(|i| simd::dispatch(&mut Climb { polyhedron: polyhedra[i], direction: towards[i] }));
    let reach = |i: usize| polyhedra[i].vertices[vertices[i] as usize].position.dot(&towards[i]);
    let are_apart = reach(0) + reach(1) < between.norm_squared();
    Beginning::new(vertices, if are_apart { Guess::Apart } else { Guess::Unclear })
}

/// A hill climb for a support vertex.
struct Climb<'a> {
    polyhedron: &'a Polyhedron,
    direction: Vector,
}

impl Kernel for Climb<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> u32 {
        climb(self.polyhedron, L::from_vector(&self.direction), 0)
    }
}

/// In the world, in plain rounding.
#[inline(always)]
fn centre_of_mass(polyhedron: &Polyhedron, pose: &Pose) -> Vector {
    pose.transform(&polyhedron.mass.centre_of_mass)
}

/// Projects on both bodies the other's centre of mass or last vertex, then the vertices that were found there, and so on, by the
/// tables. Both at once: two chains of look-ups take the time of one, and three rounds lead to as good a start as one chain of four
/// look-ups.
struct Alternate<'a, F, S> {
    first: &'a F,
    second: &'a S,
    // Lent, not copied: pairs of pointers just written one by one would be read as one, which stalls.
    polyhedra: &'a [&'a Polyhedron; 2],
    poses: &'a [&'a Pose; 2],
    last: [u32; 2],
    rounds_from_last: u32,
}

impl<F: NearestVertex, S: NearestVertex> Kernel for Alternate<'_, F, S> {
    type Output = Beginning;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Beginning {
        let &mut Alternate { first, second, .. } = self;
        let [there, back] = self.maps::<L>();
        let mut rounds = first.rounds().max(second.rounds());
        let (mut seen1, mut seen2) = (back.offset, there.offset);
        if self.rounds_from_last < rounds {
            rounds = self.rounds_from_last;
            seen1 = back.apply(second.position(self.last[1]));
            seen2 = there.apply(first.position(self.last[0]));
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
        Beginning::new(vertices, guess)
    }
}

impl<'a, F: NearestVertex, S: NearestVertex> Alternate<'a, F, S> {
    /// From the centres of mass.
    #[inline(always)]
    fn new(first: &'a F, second: &'a S, polyhedra: &'a [&'a Polyhedron; 2], poses: &'a [&'a Pose; 2]) -> Self {
        Alternate { first, second, polyhedra, poses, last: [0; 2], rounds_from_last: FROM_CENTRES }
    }

    #[inline(always)]
    fn prefetch<L: Lanes>(&self, vertices: [u32; 2]) {
        for (polyhedron, vertex) in self.polyhedra.iter().zip(vertices) {
            L::prefetch(&polyhedron.vertices, vertex);
        }
    }

    /// From body 1's frame and unit to body 2's, and back.
    #[inline(always)]
    fn maps<L: Lanes>(&self) -> [Map; 2] {
        let placed = [LanePose::<L>::new(self.poses[0]), LanePose::<L>::new(self.poses[1])];
        let [mass1, mass2] = self.polyhedra.map(|polyhedron| &polyhedron.mass);
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
    /// What the first, second and third coordinate are multiplied by.
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
