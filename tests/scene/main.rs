//! Scenes, alone and from several threads.

mod contacts;
mod motions;
mod scenes;
mod soak;
mod threads;
