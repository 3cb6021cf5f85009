//! Scenes, alone and from several threads.

mod casts;
mod contacts;
mod counts;
mod events;
mod motions;
mod placed;
mod record;
mod scenes;
mod sets;
mod soak;
mod threads;
