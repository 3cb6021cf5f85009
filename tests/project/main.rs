//! The project itself: the order of its code, its exports, the layout of its structs, its links.

mod architecture;
mod cpp;
mod headers;
mod layout;
mod links;
mod names;
mod parameters;
mod symbols;
mod workflow;
