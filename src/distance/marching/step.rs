//! The results of one state's tests.

use crate::placed::state::State;

/// The results of one state's tests. No enum that holds the state (R5).
pub struct Step {
    /// How to go on.
    pub transition: Transition,
    /// From which state.
    pub at: State,
}

/// How marching goes on from a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transition {
    /// To another state.
    Move,
    /// Not at all: a minimum; the certifier has seen it.
    Minimum,
    /// A vertex lies over the face and behind it: a penetration, or the wrong side of the other body. Elsewhere.
    Behind,
    /// An edge of one body crosses a face of the other.
    Crossing,
    /// Not at all: the bodies have no such features.
    Nowhere,
}

impl Step {
    #[inline(always)]
    pub(super) fn to(at: State) -> Step {
        Step { transition: Transition::Move, at }
    }

    #[inline(always)]
    pub(super) fn minimum(at: State) -> Step {
        Step { transition: Transition::Minimum, at }
    }

    #[inline(always)]
    pub(super) fn crossing(at: State) -> Step {
        Step { transition: Transition::Crossing, at }
    }

    #[inline(always)]
    pub(super) fn nowhere() -> Step {
        Step { transition: Transition::Nowhere, at: State::vertex_vertex([0, 0]) }
    }
}
