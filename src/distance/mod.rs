//! How far two placed polyhedra are apart, or that they overlap: floating point proposes, a certificate accepts, integers decide
//! the rest. It keeps nothing from one query to the next.

pub mod certificate;
pub(crate) mod separating_axis;
pub mod support_search;
pub mod marching;
pub mod gjk;
pub mod enclosure;
pub(crate) mod decide;
