//! The options of a pair query.

use crate::base::error::{Error, Result, check_range};

/// A kind of query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Query {
    /// The verdict alone.
    Intersection = 0,
    /// The distance.
    Distance = 1,
    /// The distance, and of intersecting bodies a common point and a normal.
    Contact = 2,
    /// The distance as narrow as asked for.
    Approximate = 3,
}

/// Where marching starts. It changes how fast an answer comes, never the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum Start {
    /// At the features of the last query while the pair moves little, else where the look-up tables of the shapes say.
    #[default]
    Automatic = 0,
    /// At the features of the last query whenever there are any.
    Cache = 1,
    /// Where the look-up tables say (Ehmann & Lin 2000, section 4.6); afresh unless both shapes have tables of one kind, or one
    /// has shells and the other so few vertices that it needs none.
    Table = 2,
    /// Afresh: at the vertices farthest along the line between the bodies.
    Cold = 3,
}

/// Which levels of detail a query goes through, of those that the shapes have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum Levels {
    /// Those that save time: of large bodies, for approximate queries that they may answer (60,000 vertices, both together) and
    /// for intersection (200,000). Smaller bodies themselves answer about as quickly, from their look-up tables. The first such
    /// query of a shape with automatic levels makes them, which takes about twice as long as making the shape did.
    /// Before that, approximate queries about bodies of 500 vertices and more look up maps of their support functions, where the
    /// error is one in a hundred of the radius or more (one in four hundred from 5,000 vertices on).
    #[default]
    Automatic = 0,
    /// None.
    None = 1,
    /// All, whatever is asked (Ehmann & Lin 2000).
    All = 2,
}

/// Which object goes to a finer level, and by how many, when a pair of levels is too coarse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum Refinement {
    /// The object whose level has the larger deviation, by one.
    #[default]
    Adaptive = 0,
    /// One object by one: that at the coarser level, object 1 where both are at the same.
    Single = 1,
    /// Both by one.
    SingleSingle = 2,
    /// Both by two.
    DoubleDouble = 3,
}

/// How much a query wants to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// `upper − lower` may be as large as this …
    pub absolute: f64,
    /// … or as this times `lower`.
    pub relative: f64,
    /// A distance beyond this need not be known.
    pub beyond: f64,
}

impl Accuracy {
    /// Whether an interval proves that the bodies are disjoint and is narrow enough, or beyond what has to be known. A narrow one
    /// must be wholly on this side of that: another start would not change the answer.
    #[inline(always)]
    pub fn is_met_by(&self, lower: f64, upper: f64) -> bool {
        let width = upper - lower;
        let is_narrow = (width <= self.absolute) | (width <= self.relative * lower);
        lower > 0.0 && ((is_narrow & (upper <= self.beyond)) | (lower > self.beyond))
    }
}

/// The options of a pair query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairConfig {
    /// Pairs farther apart than this are [`Outcome::Beyond`](crate::answer::Outcome::Beyond); from 0 to +∞ (the default: none is).
    pub max_distance: f64,
    /// The starting point of marching.
    pub start: Start,
    /// For an approximate query, `upper − lower` may be as large as this … Other queries ignore this field and the two that
    /// follow, even when they are out of range: from 0 to +∞, and 1 or more for the budget.
    pub absolute_error: f64,
    /// … or as this times `lower`. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// For an approximate query: steps of marching after which it stops with what it has, 1 or more; UINT32_MAX (the default): no
    /// limit. Cases that marching leaves open are still decided, however long it takes. For intersecting bodies marching may
    /// leave a case open only after as many steps as a query without a budget may make. The next query with the same cache goes
    /// on where this one stopped, unless `start` requires a new beginning, at the tables or afresh: it may then stop there every
    /// time.
    pub step_budget: u32,
    /// Which levels of detail a query goes through.
    pub levels: Levels,
    /// How it goes from level to level.
    pub refinement: Refinement,
}

impl Default for PairConfig {
    fn default() -> Self {
        PairConfig {
            max_distance: f64::INFINITY,
            start: Start::Automatic,
            absolute_error: 0.0,
            relative_error: 0.0,
            step_budget: u32::MAX,
            levels: Levels::Automatic,
            refinement: Refinement::Adaptive,
        }
    }
}

impl PairConfig {
    /// Refuses a configuration with a member out of its range, among those that the query looks at.
    ///
    /// # Errors
    /// [`Error::Argument`], naming the first such member.
    pub(crate) fn check(&self, query: Query) -> Result<()> {
        if self.is_in_range(query) { Ok(()) } else { Err(self.first_fault()) }
    }

    /// Whether every member that the query looks at is in its range.
    #[inline(always)]
    pub(crate) fn is_in_range(&self, query: Query) -> bool {
        let is_accurate = (self.absolute_error >= 0.0) & (self.relative_error >= 0.0) & (self.step_budget > 0);
        (self.max_distance >= 0.0) & (is_accurate | (query != Query::Approximate))
    }

    /// Which member is the first out of its range. The errors come last: only approximate queries look at them.
    #[cold]
    #[inline(never)]
    pub(crate) fn first_fault(&self) -> Error {
        check_range("max_distance", self.max_distance, 0.0..=f64::INFINITY)
            .and_then(|()| check_accuracy(self.absolute_error, self.relative_error, self.step_budget))
            .err()
            .unwrap_or_else(|| Error::Bug("a configuration is refused of which all is in range".into()))
    }
}

/// Refuses error tolerances and step budgets that are out of range.
///
/// # Errors
/// [`Error::Argument`], naming the first.
#[inline]
pub(crate) fn check_accuracy(absolute_error: f64, relative_error: f64, step_budget: u32) -> Result<()> {
    check_range("absolute_error", absolute_error, 0.0..=f64::INFINITY)?;
    check_range("relative_error", relative_error, 0.0..=f64::INFINITY)?;
    if step_budget == 0 {
        return Err(Error::Argument("step_budget is 0, it must be at least 1".into()));
    }
    Ok(())
}
