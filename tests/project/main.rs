//! The project itself: the order of its code, its exports, the layout of its structs, its README.

mod architecture;
mod cpp;
mod layout;
mod readme;
mod symbols;
mod workflow;
