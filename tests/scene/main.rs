//! Scenes, alone and from several threads.

mod bulk;
mod casts;
mod compound_objects;
mod contacts;
mod counts;
mod drawing;
mod events;
mod few;
mod ground_objects;
mod grounds;
mod listener;
mod motions;
mod piece_pairs;
mod placed;
mod record;
mod remembered;
mod scenes;
mod sets;
mod soak;
mod threads;
