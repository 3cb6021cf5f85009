//! Mesh files, shapes, saved shapes, and the bodies that tests share.

mod mesh_io;
mod shape_file;
mod shapes;
mod shared_scenes;
