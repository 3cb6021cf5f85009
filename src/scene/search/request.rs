//! The request to pairs: a query, checked once.

use crate::base::error::{Result, check_range};
use crate::pair::{self, PairAnswer, PairCache, PairConfig, Placed, Query};
#[cfg(doc)]
use crate::scene::near::near_pairs::NearPair;
use crate::scene::search::contacts::Details;
use crate::scene::search::query::{ContactDetail, PiecePairs, SceneQuery};

/// One of the pair queries of [`pair`](crate::pair).
pub(crate) type Solver = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

/// Refuses a query of which a member is out of range.
#[cold]
fn check(query: &SceneQuery) -> Result<()> {
    check_range("max_distance", query.max_distance, 0.0..=f64::INFINITY)?;
    crate::answer::check_accuracy(query.absolute_error, query.relative_error, query.step_budget)?;
    check_range("error_budget", query.error_budget, 0.0..=f64::INFINITY)
}

/// The request to each pair, and to all together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    pub kind: Query,
    pub config: PairConfig,
    /// Pairs farther apart are not listed.
    pub tolerance: f64,
    /// Stop behind the first intersecting pair.
    pub early_exit: bool,
    /// The upper limit on the sum of `upper − lower` over all listed pairs, if that is asked for.
    pub error_budget: Option<f64>,
    /// The part of that budget that each pair may take that [has a share](NearPair::takes_share); the others are asked for exact
    /// distances.
    pub share: Option<f64>,
    /// The details asked of listed pairs beside their answers.
    pub details: Option<Details>,
    /// Which of two objects' pairs are listed.
    pub piece_pairs: PiecePairs,
    /// Neither verdicts nor details nor shares of a budget nor a choice among pairs are asked for.
    is_of_distances: bool,
}

impl Request {
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument) for a member of the query that is out of range.
    #[inline]
    pub fn new(kind: Query, query: &SceneQuery) -> Result<Request> {
        // NaNs pass no comparison.
        let is_sound = (query.max_distance >= 0.0)
            & (query.absolute_error >= 0.0)
            & (query.relative_error >= 0.0)
            & (query.step_budget > 0)
            & (query.error_budget >= 0.0);
        if !is_sound {
            check(query)?;
        }
        // A verdict is asked for at any distance, and lists what intersects.
        let (reach, tolerance) = match kind {
            Query::Intersection => (f64::INFINITY, 0.0),
            Query::Distance | Query::Contact | Query::Approximate => (query.max_distance, query.max_distance),
        };
        let config = PairConfig {
            max_distance: reach,
            absolute_error: query.absolute_error,
            relative_error: query.relative_error,
            step_budget: query.step_budget,
            levels: query.levels,
            refinement: query.refinement,
            start: query.start,
        };
        let is_shared = kind == Query::Approximate && query.error_budget < f64::INFINITY;
        let details = Details::new(kind, query)?;
        Ok(Request {
            is_of_distances: kind != Query::Intersection
                && details.is_none()
                && !is_shared
                && query.piece_pairs == PiecePairs::Every,
            kind,
            config,
            tolerance,
            early_exit: query.early_exit,
            error_budget: is_shared.then_some(query.error_budget),
            share: None,
            details,
            piece_pairs: query.piece_pairs,
        })
    }

    /// The same where pairs have shares of the error budget.
    pub fn with_share(&self, share: Option<f64>) -> Request {
        Request { config: PairConfig { absolute_error: 0.0, relative_error: 0.0, ..self.config }, share, ..*self }
    }

    /// The query for pairs that have a share.
    pub fn of_share(&self) -> Option<PairConfig> {
        self.share.map(|share| PairConfig { absolute_error: share, ..self.config })
    }

    /// Whether pairs are asked the same.
    pub fn is_same(&self, other: &Request) -> bool {
        (self.kind, self.share, self.piece_pairs) == (other.kind, other.share, other.piece_pairs)
            && self.config == other.config
            && self.details == other.details
    }

    /// Whether it asks what a query asks, and that for nothing but distances, exact or approximate. By their bits, which sound
    /// requests have no NaNs among.
    #[inline(always)]
    pub fn is_plain(&self, query: &SceneQuery) -> bool {
        let config = &self.config;
        let numbers = (self.tolerance.to_bits() ^ query.max_distance.to_bits())
            | (config.absolute_error.to_bits() ^ query.absolute_error.to_bits())
            | (config.relative_error.to_bits() ^ query.relative_error.to_bits())
            | (f64::INFINITY.to_bits() ^ query.error_budget.to_bits());
        let is_same = (numbers == 0)
            & (config.step_budget == query.step_budget)
            & (self.early_exit == query.early_exit)
            & (config.levels as i32 == query.levels as i32)
            & (config.refinement as i32 == query.refinement as i32)
            & (config.start as i32 == query.start as i32)
            & (query.detail as i32 == ContactDetail::None as i32)
            & (query.piece_pairs as i32 == PiecePairs::Every as i32);
        self.is_of_distances & is_same
    }

    /// Whether the verdict alone is asked for, and only intersecting pairs are listed.
    pub fn is_verdict(&self) -> bool {
        self.kind == Query::Intersection
    }

    /// What a pair with a ground is asked.
    pub fn of_ground(&self) -> Query {
        if self.details.is_some() { Query::Distance } else { self.kind }
    }

    /// The solver that answers for one pair.
    pub fn solver(&self) -> Solver {
        match self.kind {
            Query::Intersection => pair::intersection,
            Query::Distance => pair::distance,
            // The depth gives the rest.
            Query::Contact if self.details.is_some() => pair::distance,
            Query::Contact => pair::contact,
            Query::Approximate => pair::approximate,
        }
    }
}
