//! Levels of detail of a pair: which there are, what a pair of levels says of its bodies, and marching from coarse to fine.

mod leveled;
mod descent;

pub use descent::{Descended, Descent, LevelBounds, TRIAL_STEPS, try_first};
pub use leveled::{LevelState, Leveled};
