//! Mesh files, shapes, saved shapes, and the bodies that tests share.

mod mesh_dialects;
mod mesh_io;
mod nearly_convex;
mod scaled;
mod shape_file;
mod faces;
mod inertia;
mod shapes;
mod shared_scenes;
