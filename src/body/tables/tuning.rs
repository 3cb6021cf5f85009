//! The numbers that say where a search starts. They change how fast an answer comes, never the answer. Each is chosen by time, on
//! pairs of like bodies of 1,002 and 10,002 vertices on three orbits.
//!
//! A *jump* is an angle times √n: the angle between neighbours among n vertices spread over a sphere is 3.8/√n. A pair that has
//! moved and turned by more than that (taken together, as body 1 sees body 2) starts from the tables; else at its last features.
//!
//! | rule | what it buys |
//! |---|---|
//! | jump of round and of thin bodies | thin ones need more look-ups; not measured apart from the turn below |
//! | jump of the spherical table | it is looked up once, to a start that may be far from the nearest features |
//! | jump of few vertices | boxes begin anew beyond 100°, bodies of 31 vertices beyond 50°: a fifth of a random query; 4 or 3 save no more |
//! | one or two rounds from the last vertices | up to a fifth of a query of long bodies and plates after steps of 7° to 15° |
//! | a jump that bodies in each other may have come apart by | from the least jump on, verdicts on plates take 69 % longer at 5° |
//! | a turn that makes the last enclosure no hint | without it, and with jumps of 3.5, verdicts on plates take 24 % longer at 10° |
//! | a far jump of bodies in each other | round ones at 5° to 45° save 15 to 5 of 100 instructions by the last enclosure |
//! | maps of support functions | see `benches/NOTEBOOK.md`: which errors they answer sooner than marching does |
//! | rounds of look-ups | plates and needles of 1:10 save four and seven steps of eight and eleven; round bodies none |

/// How far a pair of round bodies with shells may have moved before it starts from them.
pub const JUMP_OF_ROUND: f64 = 3.1;

/// The same of thin bodies.
pub const JUMP_OF_THIN: f64 = 4.0;

/// The same with the table of Ehmann & Lin (2000).
pub const JUMP_OF_SPHERICAL: f64 = 5.7;

/// The same of bodies of few vertices, which need no table.
pub const JUMP_OF_FEW: f64 = 5.0;

/// Up to the root of this times the jump one round of look-ups from the last vertices is enough.
pub const ONE_ROUND: f64 = 5.0;

/// Up to the root of this times the jump two rounds are; beyond that the centres of mass are the better beginning.
pub const TWO_ROUNDS: f64 = 16.0;

/// From the root of this times the jump on, bodies that intersected may have come apart, and are for marching.
pub const COME_APART: f64 = 3.0;

/// The square of half a radian: bodies that have moved by more and may have come apart begin at the pair from the tables, also
/// where that is for the fallback.
pub const TURNED_AWAY: f64 = 0.25;

/// The square of an angle of about 72°: after a longer jump bodies that intersected are for marching in any case.
pub const FAR: f64 = 1.6;

/// Fewest corners of a body that is given a table on its own account; with twice as many vertices it is given one, too, as it would
/// take long to look at all of them.
pub const LEAST_VERTICES_FOR_TABLE: usize = 32;

/// Bodies with no spread of less than this are round. For ellipsoids of (1, 0.8, 0.8) one look-up is still better than three, for
/// (1, 1, 0.6) it is worse by more than a step.
pub const ROUND: f64 = 0.75;

/// Bodies with two spreads of less than this are needles. Those of 1:10 gain a tenth of the steps, which does not pay.
pub const NEEDLE: f64 = 1.0 / 30.0;

/// Beyond so many vertices thin bodies are looked up in [`ROUNDS_OF_FINE`] rounds.
pub const FINE: usize = 4_000;

/// Rounds of look-ups on round bodies: the vertex that another body's centre of mass sees is the nearest.
pub const ROUNDS_OF_ROUND: u32 = 1;

/// On bodies thin in two directions.
pub const ROUNDS_OF_LONG: u32 = 3;

/// On bodies thin in one direction; the fourth saves half a step.
pub const ROUNDS_OF_PLATES: u32 = 4;

/// On thin bodies of many vertices, where plates need eight steps after three rounds and six after five, and on needles.
pub const ROUNDS_OF_FINE: u32 = 5;

/// Fewest vertices, of each body of a pair, for which a map of its support function answers approximate distances.
pub const LEAST_VERTICES_FOR_SUPPORT_MAP: usize = 500;

/// From so many vertices on a body may have the finest grid of its support function.
pub const LEAST_VERTICES_FOR_FINEST_GRID: usize = 5_000;

/// The least error of a distance that grids but the finest are used for, as a multiple of the radius.
pub const LEAST_ERROR_OF_GRIDS: f64 = 0.008;

/// The same with the finest grid.
pub const LEAST_ERROR_OF_FINEST_GRID: f64 = 0.0025;

/// A grid is fine enough if its gap is at most this part of the error in the mean of all cells, and nowhere more than the error:
/// the rest of it pays for a direction that is not quite the best.
pub const MEAN_GAP: f64 = 0.175;

/// The same of the largest gap of the finest grid.
pub const LARGEST_GAP_OF_FINEST: f64 = 0.5;

/// No direction is stretched by less than this part of the most: beyond, the rounding of directions counts.
pub const LEAST_STRETCH: f64 = 1.0 / 64.0;
