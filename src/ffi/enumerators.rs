//! Enumerators, as C hands them over and as they are read.

use super::failure::{Checked, Failure, StatusCode};
use crate::base::enumerator::{Enumerator, enumerator};
use crate::motion::CastOutcome;
use crate::pair::{DecidedBy, DepthEnding, FeatureKind, Levels, Outcome, Query, Refinement, Start};
use crate::point::PointLocation;
use crate::ray::RayOutcome;
use crate::scene::{ContactDetail, PiecePairs, PoseOrder, RayHits};
use crate::shape::InputPolicy;
use std::fmt::Display;

/// An enumerator, as C passes it in `member`, one of the C type `kind`. The member's name is put together for a refusal only.
#[inline(always)]
pub(super) fn read_enumerator<T: Enumerator>(number: i32, member: impl Display, kind: &str) -> Checked<T> {
    T::from_number(number).ok_or_else(|| unknown(number, member, kind))
}

#[cold]
pub(super) fn unknown(number: i32, member: impl Display, kind: &str) -> Failure {
    Failure::new(StatusCode::ErrorInvalidArgument, format!("{member} is {number}, which is no {kind}"))
}

enumerator!(InputPolicy { Strict, Flat, Hull, NearlyConvex, Patch });
enumerator!(Start { Automatic, Cache, Table, Cold });
enumerator!(Levels { Automatic, None, All });
enumerator!(Refinement { Adaptive, Single, SingleSingle, DoubleDouble });
enumerator!(Query { Intersection, Distance, Contact, Approximate });
enumerator!(Outcome { None, Separated, Beyond, Intersecting, Undecided });
enumerator!(DecidedBy {
    None,
    Marching,
    Coherence,
    Fallback,
    Integers,
    Tolerance,
    Budget,
    BoundingSpheres,
    InscribedSpheres
});
enumerator!(FeatureKind { None, Vertex, Edge, Face });
enumerator!(ContactDetail { None, Depth, Manifold, ReducedManifold });
enumerator!(PiecePairs { Every, First, Nearest });
enumerator!(DepthEnding { None, Narrow, Separated, Integers, Budget, Stalled });
enumerator!(RayOutcome { None, Miss, Hit, Inside, Undecided });
enumerator!(PointLocation { None, Inside, On, Outside, Undecided });
enumerator!(PoseOrder { Bisection, InOrder });
enumerator!(RayHits { First, All, Any });
enumerator!(CastOutcome { None, Free, Hit, Near, Budget });

// Enumerators as C hands them over. In the header they bear the names of the enums, so that compilers of C and C++ see them mixed
// up; here they are numbers, as a program may hand over any.

/// A [`StatusCode`].
pub type StatusNumber = i32;
/// A [`Query`].
pub type QueryNumber = i32;
/// An [`Outcome`].
pub type OutcomeNumber = i32;
/// A [`DecidedBy`].
pub type DecidedByNumber = i32;
/// A [`FeatureKind`].
pub type FeatureKindNumber = i32;
/// A [`ContactDetail`].
pub type ContactDetailNumber = i32;
/// A [`PiecePairs`].
pub type PiecePairsNumber = i32;
/// A [`DepthEnding`].
pub type DepthEndingNumber = i32;
/// A [`CastOutcome`].
pub type CastOutcomeNumber = i32;
/// A [`RayOutcome`].
pub type RayOutcomeNumber = i32;
/// A [`PoseOrder`].
pub type PoseOrderNumber = i32;
/// A [`RayHits`].
pub type RayHitsNumber = i32;
/// A [`PointLocation`].
pub type PointLocationNumber = i32;
/// An [`InputPolicy`].
pub type InputNumber = i32;
/// A [`HierarchyKind`](crate::shape::levels::hierarchy::HierarchyKind).
pub type HierarchyNumber = i32;
/// A [`LookupKind`](crate::body::tables::LookupKind).
pub type LookupNumber = i32;
/// A [`Start`].
pub type StartNumber = i32;
/// A [`Levels`].
pub type LevelsNumber = i32;
/// A [`Refinement`].
pub type RefinementNumber = i32;
