//! Motions: a pair that moves is proved free for all of a time, or its first contact is enclosed in an interval of time.
//!
//! A motion is many certified queries of [`crate::pair`]; there is no second solver. `bound.rs` carries a proof from one moment
//! to the next: how far the gap along a fixed direction can sag between two moments, and the rounding error of a pose.

#[doc(hidden)]
pub mod turn;
mod kinds;
mod path;
mod carried;
#[doc(hidden)]
pub mod bound;
mod between;
mod answer;
mod config;
mod gap;
mod enclosed_ball;
mod moving;
mod facet;
mod swept;
mod frame;
mod forecast;
mod sweep;
mod looks;
mod cast;
mod clearance;
mod verify;

pub use answer::{CastAnswer, CastOutcome};
pub use between::motion_between;
pub(crate) use carried::Carried;
pub use carried::Moving;
pub use cast::cast;
pub(crate) use cast::{cast_carried, distance_at};
pub use clearance::{Clearance, ClearanceConfig, clearance};
pub use config::CastConfig;
pub(crate) use frame::{MovingFrame, Stop};
pub use kinds::{Callback, Motion, Screw};
pub(crate) use swept::{PartEnd, Swept};
pub(crate) use verify::verify_carried;
pub use verify::verify_cast;
