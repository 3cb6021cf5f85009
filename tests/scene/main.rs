//! Scenes, alone and from several threads.

mod bulk;
mod contacts;
mod events;
mod listener;
mod motions;
mod placed;
mod record;
mod scenes;
mod sets;
mod soak;
mod threads;
