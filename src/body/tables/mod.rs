//! Says which look-up table a body gets, and builds it.

mod options;
pub mod tuning;
pub mod nearest_vertex;
pub mod support_map;

use nalgebra::SymmetricEigen;

pub use options::{LookupKind, LookupOptions};

use crate::base::error::{Error, Result};
use crate::base::math::{Matrix, Vector, is_unit};
use crate::base::memory::{OnNeed, collected, filled, found, push};
use crate::body::polyhedron::lookup::{Lookup, Plan, ShellSamples, Shells, Spherical, Table, VertexBlock};
use crate::body::polyhedron::surface_walk::{Surface, nearest_of};
use crate::body::polyhedron::{LARGEST, Polyhedron, SMALLEST, Vertex};

/// The radii of the shells as multiples of the body's. Points of another body come nearer to the centre of mass than the
/// bounding sphere only where this body is thin.
const RADII: [f64; 8] = [0.3, 0.5, 0.8, 1.15, 1.5, 2.0, 3.0, 6.0];

/// The table that a body gets, by the options.
///
/// # Errors
/// [`Error::Argument`] for a resolution or radius factor out of range.
pub fn plan_lookup(polyhedron: &Polyhedron, options: &LookupOptions) -> Result<Lookup> {
    let LookupOptions { kind, resolution, radius_factor } = *options;
    if !(radius_factor >= 1.0 && radius_factor.is_finite()) {
        return Err(Error::Argument(format!("the look-up table's radius factor {radius_factor:e} is not at least 1")));
    }
    // Vertices inside merged faces or edges are no features.
    let vertex_count = polyhedron.corner_count();
    let resolution = resolution as usize;
    let plan = match kind {
        LookupKind::None => Plan::None,
        LookupKind::Automatic | LookupKind::Shells => {
            let resolution = if resolution == 0 { resolution_for(vertex_count) } else { resolution };
            if !(4..=512).contains(&resolution) || !resolution.is_power_of_two() {
                return Err(Error::Argument(format!(
                    "the look-up table's resolution {resolution} is not a power of two from 4 to 512"
                )));
            }
            Plan::Shells { resolution }
        }
        LookupKind::Spherical => {
            let resolution = if resolution == 0 { 32 } else { resolution };
            if !(2..=512).contains(&resolution) {
                return Err(Error::Argument(format!(
                    "the look-up table's resolution {resolution} is not from 2 to 512"
                )));
            }
            Plan::Spherical { resolution, radius_factor }
        }
    };
    // Squares of distances over- or underflow in bodies of other sizes. Points are among the small ones.
    if plan == Plan::None || !(SMALLEST..=LARGEST).contains(&polyhedron.radius) {
        return Ok(Lookup::none());
    }
    // Neighbours are that far apart up to a factor.
    let spacing = 1.0 / (vertex_count as f64).sqrt();
    if kind == LookupKind::Automatic
        && vertex_count < tuning::LEAST_VERTICES_FOR_TABLE
        && polyhedron.vertices.len() < 2 * tuning::LEAST_VERTICES_FOR_TABLE
    {
        if polyhedron.faces.is_empty() {
            return Ok(Lookup::none());
        }
        let rounds = rounds(&Thickness::of(polyhedron), vertex_count);
        let table = Table::AllVertices(all_vertices(polyhedron)?);
        return Ok(Lookup::with_table(Plan::AllVertices { rounds }, tuning::JUMP_OF_FEW * spacing, table));
    }
    let jump = match plan {
        Plan::Spherical { .. } => tuning::JUMP_OF_SPHERICAL,
        _ if rounds(&Thickness::of(polyhedron), vertex_count) == tuning::ROUNDS_OF_ROUND => tuning::JUMP_OF_ROUND,
        _ => tuning::JUMP_OF_THIN,
    };
    Ok(Lookup { plan, jump: jump * spacing, made: OnNeed::new() })
}

/// The table that a level of a body gets: of the body's kind, chosen for the level's number of vertices.
pub fn plan_for_level(level: &Polyhedron, body: &Polyhedron) -> Lookup {
    let (kind, radius_factor) = match body.lookup.plan {
        Plan::None => (LookupKind::None, LookupOptions::DEFAULT.radius_factor),
        Plan::Shells { .. } | Plan::AllVertices { .. } => (LookupKind::Automatic, LookupOptions::DEFAULT.radius_factor),
        Plan::Spherical { radius_factor, .. } => (LookupKind::Spherical, radius_factor),
    };
    // The options are in range.
    plan_lookup(level, &LookupOptions { kind, resolution: 0, radius_factor }).unwrap_or_else(|_| Lookup::none())
}

/// The table of a body. The first thread to look makes it; others that come meanwhile wait. Where memory is lacking none gets
/// one.
#[inline(always)]
pub fn table(polyhedron: &Polyhedron) -> &Table {
    match polyhedron.lookup.made.get() {
        Some(table) => table,
        None => make_table(polyhedron),
    }
}

/// A vertex nearly farthest in a direction, by the table of a body that has one.
#[inline(always)]
pub fn farthest(polyhedron: &Polyhedron, towards: &Vector) -> Option<u32> {
    match table(polyhedron) {
        Table::Shells(table) => Some(table.farthest([towards.x as f32, towards.y as f32, towards.z as f32])),
        Table::Spherical(table) => Some(table.towards(towards)),
        Table::AllVertices(_) | Table::None => None,
    }
}

/// The tables of two bodies if they are of one kind; else none is made.
#[inline(always)]
pub fn tables(polyhedra: [&Polyhedron; 2]) -> Option<[&Table; 2]> {
    match polyhedra.map(|polyhedron| polyhedron.lookup.plan) {
        [Plan::Shells { .. }, Plan::Shells { .. }] | [Plan::Spherical { .. }, Plan::Spherical { .. }] => {
            Some([table(polyhedra[0]), table(polyhedra[1])])
        }
        _ => None,
    }
}

#[cold]
#[inline(never)]
fn make_table(polyhedron: &Polyhedron) -> &Table {
    static NO_TABLE: Table = Table::None;
    polyhedron.lookup.made.make(|| build_table(polyhedron)).unwrap_or(&NO_TABLE)
}

/// Makes the table of a body if it is not made, also where memory was lacking before.
///
/// # Errors
/// [`Error::Memory`].
pub fn insist_on_table(polyhedron: &Polyhedron) -> Result<()> {
    polyhedron.lookup.made.insist(|| build_table(polyhedron))
}

/// The table of a body, made anew.
///
/// # Errors
/// [`Error::Memory`].
pub fn build_table(polyhedron: &Polyhedron) -> Result<Table> {
    Ok(match polyhedron.lookup.plan {
        Plan::None => Table::None,
        Plan::AllVertices { .. } => Table::AllVertices(all_vertices(polyhedron)?),
        Plan::Shells { resolution } => Table::Shells(shells(polyhedron, resolution)?),
        Plan::Spherical { resolution, radius_factor } => {
            Table::Spherical(spherical(polyhedron, resolution, radius_factor)?)
        }
    })
}

/// The vertices of a body, eight at a time.
fn all_vertices(polyhedron: &Polyhedron) -> Result<Vec<VertexBlock>> {
    let block = |vertices: &[Vertex]| {
        let component = |axis: usize| {
            std::array::from_fn(|lane| {
                let vertex = &vertices[lane.min(vertices.len() - 1)];
                (vertex.position[axis] / polyhedron.radius) as f32
            })
        };
        VertexBlock { x: component(0), y: component(1), z: component(2) }
    };
    collected(polyhedron.vertices.chunks(8).map(block))
}

/// Cells along a side such that a shell has a few for every vertex.
fn resolution_for(vertex_count: usize) -> usize {
    debug_assert!(vertex_count > 0);
    ((4 * vertex_count).isqrt().next_power_of_two()).clamp(16, 128)
}

/// Smaller than the real radius if the centre of mass is no inner point, and then 0; 0 of bodies without faces.
fn inner_radius(polyhedron: &Polyhedron, centre: &Vector) -> f64 {
    let depths = polyhedron.faces.iter().map(|face| -face.planes.value(0, centre));
    depths.reduce(f64::min).map_or(0.0, |least| least.max(0.0))
}

fn shells(polyhedron: &Polyhedron, resolution: usize) -> Result<Shells> {
    let search = NearestVertices::new(polyhedron)?;
    let thickness = Thickness::of(polyhedron);
    let surface = if thickness.is_needle() { found(Surface::new(polyhedron))? } else { None };
    let inner = inner_radius(polyhedron, &search.centre) / search.radius;
    let radii: Vec<f64> = collected(RADII.into_iter().filter(|r| *r > 1.0 || *r > inner))?;
    let direction = |cell: usize| Shells::direction(resolution, cell / resolution, cell % resolution);
    let directions: Vec<Vector> = collected((0..resolution * resolution).map(direction))?;
    let mut cells = filled(0, radii.len() * directions.len())?;
    // From the outermost shell inwards: far away nearest is farthest along a direction, which walking finds without fail.
    let mut outer: Vec<u32> = filled(0, directions.len())?;
    for (shell, factor) in cells.chunks_exact_mut(directions.len()).zip(&radii).rev() {
        for (cell, direction) in directions.iter().enumerate() {
            let left = if cell % resolution > 0 { shell[cell - 1] } else { outer[cell] };
            let above = if cell >= resolution { shell[cell - resolution] } else { outer[cell] };
            let sample = search.sample(*factor, direction);
            shell[cell] = search.near(&sample, [outer[cell], left, above]);
            // A walk from a vertex with very many neighbours looks at all of them, in every cell.
            if let Some(surface) = &surface
                && !search.has_many_neighbours(shell[cell])
            {
                let corners = surface.corners(surface.nearest(&sample, shell[cell]).feature);
                shell[cell] = nearest_of(polyhedron, &sample, &corners);
            }
        }
        outer.copy_from_slice(shell);
    }
    let position = |v: &Vector| {
        let p = (v - search.centre) / search.radius;
        [p.x as f32, p.y as f32, p.z as f32, 0.0]
    };
    let positions = collected(search.positions.iter().map(position))?;
    let rounds = rounds(&thickness, polyhedron.corner_count());
    let samples = ShellSamples { resolution, radii, positions, cells };
    Shells::new(samples, inner, thickness.outward(), rounds)
}

/// How often to look up, see [`Shells::rounds`].
fn rounds(thickness: &Thickness, vertex_count: usize) -> u32 {
    match thickness.thin_directions() {
        0 => tuning::ROUNDS_OF_ROUND,
        _ if vertex_count > tuning::FINE || thickness.spreads.min() < tuning::NEEDLE => tuning::ROUNDS_OF_FINE,
        1 => tuning::ROUNDS_OF_PLATES,
        _ => tuning::ROUNDS_OF_LONG,
    }
}

/// How the vertices spread around the centre of mass.
struct Thickness {
    /// The axes of the covariance, in columns.
    axes: Matrix,
    /// The standard deviations along them, as multiples of the largest.
    spreads: Vector,
}

impl Thickness {
    fn of(polyhedron: &Polyhedron) -> Thickness {
        let centre = polyhedron.mass.centre_of_mass - polyhedron.centre;
        let square = |vertex: &Vertex| {
            let relative = (vertex.position - centre) / polyhedron.mass.radius;
            relative * relative.transpose()
        };
        let covariance = polyhedron.vertices.iter().map(square).sum::<Matrix>();
        // Eight iterations are the most that was seen; without a result the body counts as round.
        match SymmetricEigen::try_new(covariance, f64::EPSILON, 64) {
            Some(SymmetricEigen { eigenvectors, eigenvalues }) => {
                let largest = eigenvalues.amax();
                Thickness { axes: eigenvectors, spreads: eigenvalues.map(|value| (value.max(0.0) / largest).sqrt()) }
            }
            None => Thickness { axes: Matrix::identity(), spreads: Vector::repeat(1.0) },
        }
    }

    /// Whether the body is thin in two directions. The vertices nearest to a point are then those next to it along the needle, on
    /// whatever side, while the nearest feature, which reaches farther along it, is on the near side. A vertex of that is the
    /// better start: for needles of 1:100, 1:1,000 and 1:10,000 with 1,002 vertices it leaves 18, 22 and 23 steps of 31,
    /// 56 and 61. Finding it takes thirty times as long (12 ms), with 10,002 vertices twenty times (55 ms), with 100,002 ten
    /// times (180 ms).
    fn is_needle(&self) -> bool {
        self.spreads.iter().filter(|spread| **spread < tuning::NEEDLE).count() == 2
    }

    /// In how many directions the body is thinner than round: in one like a plate, in two like a needle.
    fn thin_directions(&self) -> usize {
        self.spreads.iter().filter(|spread| **spread < tuning::ROUND).count()
    }

    /// The inverse root of the covariance, which turns a vertex half-way from the direction away from the centre of mass to the
    /// normal of an ellipsoid so thick. Among both, and all between, it mistakes the fewest disjoint pairs for overlapping: for
    /// needles a third of those that the former does, for wafers half of those that the latter does.
    fn outward(&self) -> [[f32; 3]; 3] {
        let reciprocals = self.spreads.map(|spread| LEAST_SPREAD / spread.max(LEAST_SPREAD));
        let matrix = self.axes * Matrix::from_diagonal(&reciprocals) * self.axes.transpose();
        [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)] as f32))
    }
}

/// Positions are not rounder than this in single precision.
const LEAST_SPREAD: f64 = 1e-6;

fn spherical(polyhedron: &Polyhedron, resolution: usize, radius_factor: f64) -> Result<Spherical> {
    let search = NearestVertices::new(polyhedron)?;
    let mut cells = filled(0, Spherical::cell_count(resolution))?;
    let mut vertex = 0;
    for (cell, entry) in cells.iter_mut().enumerate() {
        vertex = search.nearest(&search.sample(radius_factor, &Spherical::direction(resolution, cell)), vertex);
        *entry = vertex;
    }
    Spherical::new(resolution, radius_factor, &cells, search.positions.len())
}

/// Finds nearest vertices of a body.
struct NearestVertices<'a> {
    polyhedron: &'a Polyhedron,
    /// The centre of mass, in centred coordinates as the positions.
    centre: Vector,
    radius: f64,
    positions: Vec<Vector>,
    tree: BoxTree,
}

impl NearestVertices<'_> {
    fn new(polyhedron: &Polyhedron) -> Result<NearestVertices<'_>> {
        let positions: Vec<Vector> = collected(polyhedron.vertices.iter().map(|v| v.position))?;
        Ok(NearestVertices {
            polyhedron,
            centre: polyhedron.mass.centre_of_mass - polyhedron.centre,
            radius: polyhedron.mass.radius,
            tree: BoxTree::new(&positions)?,
            positions,
        })
    }

    fn sample(&self, factor: f64, direction: &Vector) -> Vector {
        debug_assert!(is_unit(direction));
        debug_assert!(is_unit(direction) && factor > 0.0);
        self.centre + direction * (factor * self.radius)
    }

    /// A vertex that no neighbour of it is nearer than, by walking from the best of some vertices to nearer and nearer ones. Mostly
    /// it is the nearest of all; the nearest of all everywhere would save 0.1 steps of marching from 4 and take twenty times as
    /// long. Where a vertex has very many neighbours the nearest of all is searched.
    fn near(&self, point: &Vector, from: [u32; 3]) -> u32 {
        let square = |v: u32| (self.positions[v as usize] - point).norm_squared();
        let (mut vertex, mut least) = (from[0], square(from[0]));
        for &other in &from[1..] {
            if other != vertex && square(other) < least {
                (vertex, least) = (other, square(other));
            }
        }
        loop {
            let before = vertex;
            if self.has_many_neighbours(before) {
                return self.nearest(point, before);
            }
            for block in self.polyhedron.neighbour_blocks(before) {
                for &head in &block.head {
                    let other = square(head);
                    if other < least {
                        (vertex, least) = (head, other);
                    }
                }
            }
            if vertex == before {
                return vertex;
            }
        }
    }

    fn has_many_neighbours(&self, vertex: u32) -> bool {
        self.polyhedron.vertices[vertex as usize].more > MANY_BLOCKS
    }

    /// The nearest vertex, found by walking from another one and then excluding the rest; among several, the one that the walk
    /// met, else the lowest.
    fn nearest(&self, point: &Vector, from: u32) -> u32 {
        let mut best = (from, (self.positions[from as usize] - point).norm_squared());
        self.tree.nearest(&self.positions, point, &mut best);
        best.0
    }
}

/// A vertex with more blocks of neighbours than this beyond the first is not walked from.
const MANY_BLOCKS: u32 = 3;

/// Boxes around runs of eight vertices, eight such boxes, and so on: consecutive vertices are near one another.
struct BoxTree {
    /// Lower and upper corners; the first level holds runs of vertices, the last one box.
    levels: Vec<Vec<[Vector; 2]>>,
}

impl BoxTree {
    fn new(positions: &[Vector]) -> Result<BoxTree> {
        let around = |boxes: &[[Vector; 2]]| {
            let join = |a: [Vector; 2], b: &[Vector; 2]| [a[0].inf(&b[0]), a[1].sup(&b[1])];
            boxes.iter().fold([Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)], join)
        };
        let points: Vec<[Vector; 2]> = collected(positions.iter().map(|p| [*p, *p]))?;
        let mut levels: Vec<Vec<[Vector; 2]>> = Vec::new();
        push(&mut levels, collected(points.chunks(8).map(around))?)?;
        while let Some(last) = levels.last()
            && last.len() > 1
        {
            let next = collected(last.chunks(8).map(around))?;
            push(&mut levels, next)?;
        }
        Ok(BoxTree { levels })
    }

    /// Puts a vertex nearer than `best` there, if there is one, with its squared distance.
    fn nearest(&self, positions: &[Vector], point: &Vector, best: &mut (u32, f64)) {
        // Depth first; at each level at most seven boxes wait.
        let mut waiting = [(0, 0); 8 * 12];
        let mut count = 1;
        waiting[0] = (self.levels.len() - 1, 0);
        while count > 0 {
            count -= 1;
            let (level, index) = waiting[count];
            let [low, high] = &self.levels[level][index];
            let outside = (low - point).sup(&(point - high)).sup(&Vector::zeros());
            if outside.norm_squared() >= best.1 {
                continue;
            }
            if level == 0 {
                for (v, position) in positions.iter().enumerate().skip(8 * index).take(8) {
                    let square = (position - point).norm_squared();
                    if square < best.1 {
                        *best = (v as u32, square);
                    }
                }
            } else {
                let children = 8 * index..self.levels[level - 1].len().min(8 * index + 8);
                for child in children.rev() {
                    waiting[count] = (level - 1, child);
                    count += 1;
                }
            }
        }
    }
}
