//! Rays: known answers, exact rationals on lattices and anywhere, larger bodies, refused rays.

mod known;
mod larger;
mod refused;
mod truth;
