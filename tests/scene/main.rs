//! Scenes, alone and from several threads.

mod motions;
mod scenes;
mod soak;
mod threads;
