//! Scenes, alone and from several threads.

mod motions;
mod record;
mod scenes;
mod soak;
mod threads;
