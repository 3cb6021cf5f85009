//! The project itself: the order of its code, its exports, its README.

mod architecture;
mod cpp;
mod readme;
mod symbols;
