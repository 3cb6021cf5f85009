//! Scenes, alone and from several threads.

mod contacts;
mod events;
mod motions;
mod record;
mod scenes;
mod soak;
mod threads;
