//! The project itself: the order of its code, its exports, its links.

mod architecture;
mod cpp;
mod links;
mod symbols;
