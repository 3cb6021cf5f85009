//! Surfaces in convex pieces: what a piece is, where its hull lies, how far apart decomposed bodies are, and what is refused; solid
//! pieces.

mod bodies;
mod pieces;
mod distances;
mod refused;
mod solid;
