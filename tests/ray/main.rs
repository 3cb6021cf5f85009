//! Rays: known answers, exact rationals on lattices and anywhere, larger bodies, bodies with a swept
//! radius, refused rays.

mod known;
mod larger;
mod refused;
mod swept;
mod truth;
