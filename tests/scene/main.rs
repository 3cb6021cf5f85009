//! Scenes, alone and from several threads.

mod scenes;
mod threads;
