//! Points and support vertices: known answers, exact integers on lattices and anywhere, refused input.

mod known;
mod refused;
mod truth;
