//! Levels of detail of a pair: which exist, the bounds that a pair of levels gives for its bodies, and marching from coarse to
//! fine.

mod leveled;
mod descent;

pub use descent::{Descended, LevelBounds, LevelDescent, TRIAL_STEPS, try_first};
pub use leveled::{LevelState, Leveled};
