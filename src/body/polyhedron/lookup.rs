//! Look-up tables of vertices: which vertex is nearest to a point around the body. They say where marching starts when the last
//! query tells little or nothing; no answer depends on them.
//!
//! *Shells*: for every direction (the cells of a square grid, folded into an octahedron) and every one of a few distances from
//! the centre of mass the vertex nearest to the point there (of needles one of the nearest feature's). Looked up on both bodies
//! for what was found on the other they project points alternately on the two, which from the centres of mass is near the nearest
//! vertices after one round of round bodies, after three to five of others.
//!
//! *Spherical*: the table of Ehmann & Lin (2000), §4.6: one vertex for every increment of altitude and azimuth and two for the
//! poles, nearest to the points of one sphere; looked up once, in the direction of the other body's centre of mass.

use std::f64::consts::PI;

use crate::base::angles::{around, sin_cos};
use crate::base::error::Result;
use crate::base::math::{Vector, divisor};
use crate::base::memory::{OnNeed, collected, copied};

/// A vertex for each cell, as narrow as the number of vertices allows.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// For bodies of up to 65,536 vertices.
    Narrow(Vec<u16>),
    /// For larger bodies.
    Wide(Vec<u32>),
}

impl Cells {
    /// From vertex numbers less than `vertex_count`.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(cells: &[u32], vertex_count: usize) -> Result<Cells> {
        debug_assert!(cells.iter().all(|v| (*v as usize) < vertex_count));
        if vertex_count <= 1 << 16 {
            Ok(Cells::Narrow(collected(cells.iter().map(|v| *v as u16))?))
        } else {
            Ok(Cells::Wide(copied(cells)?))
        }
    }

    /// The vertex of a cell.
    #[inline(always)]
    pub fn get(&self, cell: usize) -> u32 {
        match self {
            Cells::Narrow(cells) => u32::from(cells[cell]),
            Cells::Wide(cells) => cells[cell],
        }
    }

    /// How many cells.
    pub fn len(&self) -> usize {
        match self {
            Cells::Narrow(cells) => cells.len(),
            Cells::Wide(cells) => cells.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn bytes(&self) -> usize {
        match self {
            Cells::Narrow(cells) => size_of_val(&cells[..]),
            Cells::Wide(cells) => size_of_val(&cells[..]),
        }
    }
}

/// Eight vertices side by side, as multiples of the body's radius. Those that a body does not have repeat its last one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct VertexBlock {
    /// First components.
    pub x: [f32; 8],
    /// Second components.
    pub y: [f32; 8],
    /// Third components.
    pub z: [f32; 8],
}

/// Vertices near points on several spheres.
#[derive(Debug, Clone, PartialEq)]
pub struct Shells {
    /// Cells along a side of the square; a power of two.
    pub resolution: usize,
    /// The radii of the spheres, ascending, as multiples of the body's radius.
    pub radii: Vec<f64>,
    /// Shell by shell, row by row.
    pub cells: Cells,
    /// The vertices relative to the centre of mass, as multiples of the body's radius; the fourth number is 0.
    pub positions: Vec<[f32; 4]>,
    /// The radius of a sphere about the centre of mass inside the body, as a multiple of its radius; may be too small.
    pub core: f64,
    /// Turns a vertex, seen from the centre of mass, outwards where the body is thin.
    pub outward: [[f32; 3]; 3],
    /// How often to look up before marching when it begins where the other body's centre of mass is; then where the vertex found on
    /// it is.
    pub rounds: u32,
    grid: LookupGrid,
    /// Start of the cells that serve points of a squared distance whose exponent and leading bits are the index.
    first_cells: [u32; DISTANCES],
}

/// The input that [`Shells`] are made from; see its members.
pub struct ShellSamples {
    /// Same as the shells'.
    pub resolution: usize,
    /// Same as the shells'.
    pub radii: Vec<f64>,
    /// Same as the shells'.
    pub positions: Vec<[f32; 4]>,
    /// The vertex of each cell.
    pub cells: Vec<u32>,
}

/// Squared distances are told apart by two bits of the mantissa, from 2⁻⁸ to 2⁸; beyond that the outermost shells serve.
const DISTANCES: usize = 64;
const MANTISSA_BITS: u32 = 2;
const LEAST: i32 = (127 - 8) << MANTISSA_BITS;

impl Shells {
    /// From what was sampled, the core's radius and what turns outwards.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(samples: ShellSamples, core: f64, outward: [[f32; 3]; 3], rounds: u32) -> Result<Shells> {
        debug_assert!(samples.resolution.is_power_of_two() && samples.radii.is_sorted_by(|a, b| a < b));
        debug_assert_eq!(samples.cells.len(), samples.radii.len() * samples.resolution * samples.resolution);
        let ShellSamples { resolution, radii, positions, cells } = samples;
        // Between two shells the nearer one on a scale of reciprocal distances serves: the squared distance of a vertex v from a
        // point r·d is r² + |v|² − 2r·d·v, so the nearest one is that with the greatest d·v − |v|²/2r, which is linear in 1/r.
        let mut first_cells = [0; DISTANCES];
        for (index, first) in first_cells.iter_mut().enumerate() {
            let middle = (2 * (index as u32 + LEAST as u32) + 1) << (23 - MANTISSA_BITS - 1);
            let reciprocal = 1.0 / f64::from(f32::from_bits(middle)).sqrt();
            let shell = radii.windows(2).take_while(|pair| 0.5 / pair[0] + 0.5 / pair[1] > reciprocal).count();
            *first = (shell * resolution * resolution) as u32;
        }
        let cells = Cells::new(&cells, positions.len())?;
        let grid = LookupGrid::new(resolution);
        Ok(Shells { resolution, radii, cells, positions, core, outward, rounds, grid, first_cells })
    }

    /// The position of a vertex.
    #[inline(always)]
    pub fn position(&self, vertex: u32) -> [f32; 4] {
        self.positions[vertex as usize]
    }

    /// A vertex near a point, given as [`Shells::positions`] are.
    #[inline(always)]
    pub fn nearest(&self, point: [f32; 3]) -> u32 {
        let [x, y, z] = point;
        let square = x * x + y * y + z * z;
        let distance = (square.to_bits() as i32 >> (23 - MANTISSA_BITS)) - LEAST;
        let first = self.first_cells[distance.clamp(0, DISTANCES as i32 - 1) as usize];
        self.cells.get(first as usize + self.grid.cell(point))
    }

    /// A vertex nearly farthest in a direction: from far away nearest is farthest along the view.
    #[inline(always)]
    pub fn farthest(&self, direction: [f32; 3]) -> u32 {
        self.cells.get(self.first_cells[DISTANCES - 1] as usize + self.grid.cell(direction))
    }

    /// The direction of a cell's middle, a unit vector.
    pub fn direction(resolution: usize, row: usize, column: usize) -> Vector {
        debug_assert!(row < resolution && column < resolution);
        let coordinate = |i: usize| (2 * i + 1) as f64 / resolution as f64 - 1.0;
        let (u, v) = (coordinate(column), coordinate(row));
        let z = 1.0 - u.abs() - v.abs();
        let (x, y) = if z < 0.0 { ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v)) } else { (u, v) };
        Vector::new(x, y, z).normalize()
    }
}

/// The square grid of a shell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LookupGrid {
    /// The factor that takes a coordinate from −1 to 1 to its row or column, in the eighths that [`MAGIC`] leaves in the lower
    /// bits.
    scale: f32,
    shift: f32,
    mask: u32,
    /// The resolution's logarithm.
    bits: u32,
}

impl LookupGrid {
    fn new(resolution: usize) -> LookupGrid {
        debug_assert!(resolution.is_power_of_two());
        let half = 0.5 * resolution as f32;
        LookupGrid {
            scale: half * GRID_SCALE,
            shift: half + MAGIC,
            mask: resolution as u32 - 1,
            bits: resolution.ilog2(),
        }
    }

    /// The cell in which a point is seen from the centre.
    #[inline(always)]
    fn cell(&self, [x, y, z]: [f32; 3]) -> usize {
        // The octahedron |x| + |y| + |z| = 1 seen from above; its lower half is folded out to the corners of the square, where
        // 1 − |v| = |u| + |w|. Without a branch (R4).
        let scale = 1.0 / (x.abs() + y.abs() + z.abs()).max(f32::MIN_POSITIVE);
        let (u, v, w) = (x * scale, y * scale, z * scale);
        let fold = if w < 0.0 { -w } else { 0.0 };
        let (u, v) = (u + fold.copysign(u), v + fold.copysign(v));
        // Adding 2²⁰ leaves the number, in eighths, in the lower bits. They are masked: points without direction do no harm.
        let place = |coordinate: f32| ((coordinate * self.scale + self.shift).to_bits() >> 3) & self.mask;
        ((place(v) << self.bits) + place(u)) as usize
    }
}

/// 2²⁰: from here to 2²¹ the single-precision numbers are the multiples of 1/8.
const MAGIC: f32 = 1_048_576.0;

/// Keeps u = 1 in the last cell.
const GRID_SCALE: f32 = 0.999_99;

/// Nearest vertices to points on one sphere, in the directions of a grid of altitude and azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct Spherical {
    /// Increments from pole to pole; the increment is 180° divided by this.
    pub resolution: usize,
    /// Radius of the sphere as a multiple of the body's.
    pub radius_factor: f64,
    /// The north pole, the rings from north to south with 2·resolution entries each from azimuth 0 on, the south pole.
    pub cells: Cells,
    /// −cos|cos| of the polar angles halfway between rings, ascending.
    altitudes: Vec<f64>,
    /// [`around`] at the azimuths halfway between entries, ascending from half an increment on.
    azimuths: Vec<f64>,
}

impl Spherical {
    /// From the cells' vertices.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(resolution: usize, radius_factor: f64, cells: &[u32], vertex_count: usize) -> Result<Spherical> {
        debug_assert_eq!(cells.len(), Spherical::cell_count(resolution));
        let halfway = |i: usize| (i as f64 + 0.5) * PI / resolution as f64;
        let altitude = |i| {
            let (_, cosine) = sin_cos(halfway(i));
            -cosine * cosine.abs()
        };
        let azimuth = |j| {
            let (sine, cosine) = sin_cos(halfway(j));
            around(cosine, sine)
        };
        Ok(Spherical {
            resolution,
            radius_factor,
            cells: Cells::new(cells, vertex_count)?,
            altitudes: collected((0..resolution).map(altitude))?,
            azimuths: collected((0..2 * resolution).map(azimuth))?,
        })
    }

    /// The vertex of the entry nearest to a direction in altitude and in azimuth.
    pub fn towards(&self, direction: &Vector) -> u32 {
        self.cells.get(self.cell(direction))
    }

    /// The entry nearest to a direction. No angle is computed: the steps of functions that rise with the angles are searched.
    pub fn cell(&self, direction: &Vector) -> usize {
        let around_length = 2 * self.resolution;
        let [x, y, z] = [direction.x, direction.y, direction.z];
        let altitude = -z * z.abs() / divisor(x * x + y * y + z * z);
        match self.altitudes.partition_point(|step| *step < altitude) {
            0 => 0,
            ring if ring == self.resolution => self.cells.len() - 1,
            ring => {
                let azimuth = around(x, y);
                // Within half an increment of a full turn is the first entry again.
                let entry = self.azimuths.partition_point(|step| *step < azimuth) % around_length;
                1 + (ring - 1) * around_length + entry
            }
        }
    }

    /// The direction of an entry.
    pub fn direction(resolution: usize, cell: usize) -> Vector {
        debug_assert!(cell < Spherical::cell_count(resolution));
        let last = (resolution - 1) * 2 * resolution + 1;
        let increment = PI / resolution as f64;
        match cell {
            0 => Vector::z(),
            _ if cell == last => -Vector::z(),
            _ => {
                let (ring, entry) = ((cell - 1) / (2 * resolution) + 1, (cell - 1) % (2 * resolution));
                let [(sine, cosine), (y, x)] = [ring, entry].map(|steps| sin_cos(steps as f64 * increment));
                Vector::new(sine * x, sine * y, cosine)
            }
        }
    }

    /// How many entries a table has: one for each increment in altitude and azimuth without the poles, and two for the poles.
    pub fn cell_count(resolution: usize) -> usize {
        debug_assert!(resolution > 0);
        (resolution - 1) * 2 * resolution + 2
    }
}

/// The table of a body, made when a query first looks into it, and when it pays.
#[derive(Debug, Clone)]
pub struct Lookup {
    /// Which table.
    pub plan: Plan,
    /// How far, in radians, a pair of bodies like this one may have moved and turned before a start from the tables, or without any
    /// one afresh, leads to the nearest features sooner than the last features do; +∞ without a plan.
    pub jump: f64,
    /// The table, once made.
    pub made: OnNeed<Table>,
}

/// The table of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plan {
    /// None.
    None,
    /// The vertices themselves: so few that all are looked at.
    AllVertices {
        /// How often, see [`Shells::rounds`].
        rounds: u32,
    },
    /// Vertices near points on several spheres.
    Shells {
        /// [`Shells::resolution`].
        resolution: usize,
    },
    /// That of Ehmann & Lin (2000).
    Spherical {
        /// [`Spherical::resolution`].
        resolution: usize,
        /// [`Spherical::radius_factor`].
        radius_factor: f64,
    },
}

/// For one body, equal plans make equal tables, whether they are made yet or not.
impl PartialEq for Lookup {
    fn eq(&self, other: &Lookup) -> bool {
        (self.plan, self.jump) == (other.plan, other.jump)
    }
}

impl Lookup {
    /// No table.
    pub fn none() -> Lookup {
        Lookup::with_table(Plan::None, f64::INFINITY, Table::None)
    }

    /// A plan with its table.
    pub fn with_table(plan: Plan, jump: f64, table: Table) -> Lookup {
        debug_assert!(jump >= 0.0);
        // Made, so that no query has to: small bodies are shared without a lock.
        Lookup { plan, jump, made: OnNeed::from(table) }
    }

    /// The same plan without the table.
    pub(crate) fn not_made(&self) -> Lookup {
        Lookup { made: OnNeed::new(), ..*self }
    }

    /// Whether marching may start where tables say: those of both, of one kind, or shells beside a body that needs none.
    #[inline(always)]
    pub fn serves_with(&self, other: &Lookup) -> bool {
        use Plan::{AllVertices, Shells, Spherical};
        matches!(
            (self.plan, other.plan),
            (Shells { .. }, Shells { .. } | AllVertices { .. })
                | (AllVertices { .. }, Shells { .. })
                | (Spherical { .. }, Spherical { .. })
        )
    }

    /// The square of how far a pair of bodies may have moved and turned, see [`Lookup::jump`].
    #[inline(always)]
    pub fn square_jump(&self, other: &Lookup) -> f64 {
        self.jump * other.jump
    }

    /// Memory that it holds beyond its own size: none until the table is made.
    pub fn heap_bytes(&self) -> usize {
        match self.made.get() {
            None | Some(Table::None) => 0,
            Some(Table::AllVertices(blocks)) => size_of_val(&blocks[..]),
            Some(Table::Shells(shells)) => {
                shells.cells.bytes() + size_of_val(&shells.positions[..]) + size_of_val(&shells.radii[..])
            }
            Some(Table::Spherical(table)) => {
                table.cells.bytes() + size_of_val(&table.altitudes[..]) + size_of_val(&table.azimuths[..])
            }
        }
    }
}

/// A table as a [`Plan`] says.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "one for a body, and a look-up should not begin with a further pointer")]
pub enum Table {
    /// [`Plan::None`].
    None,
    /// [`Plan::AllVertices`].
    AllVertices(Vec<VertexBlock>),
    /// [`Plan::Shells`].
    Shells(Shells),
    /// [`Plan::Spherical`].
    Spherical(Spherical),
}
