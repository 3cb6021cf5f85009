//! One convex body and all that is computed once for it: from a mesh by its hull to the polyhedron that queries run on, with its
//! look-up tables; and a surface, or a body, cut into convex pieces.

pub mod mesh;
pub mod polyhedron;
pub mod build;
pub mod decomposition;
pub mod tables;
