//! One pair of placed polyhedra: floating point proposes nearest points or an overlap, a certificate accepts, integers decide the
//! rest. It keeps nothing from one query to the next.

#[doc(hidden)]
pub mod state;
pub(crate) mod side_search;
#[doc(hidden)]
pub mod voronoi;
#[doc(hidden)]
pub mod frame;
#[doc(hidden)]
pub mod certificate;
pub(crate) mod separating_axis;
#[doc(hidden)]
pub mod support_search;
#[doc(hidden)]
pub mod marching;
#[doc(hidden)]
pub mod exact;
#[doc(hidden)]
pub mod gjk;
#[doc(hidden)]
pub mod enclosure;
pub(crate) mod decide;
#[doc(hidden)]
pub mod facets;
#[doc(hidden)]
pub mod polytope;
