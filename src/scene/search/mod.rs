//! Queries over the near pairs: ask → look → decide → list.
//!
//! | verb | what | where |
//! |---|---|---|
//! | ask | the question is checked, and the list of near pairs brought up to date | `request.rs`, `ask.rs`, `straight.rs` |
//! | share | an error budget is dealt out to pairs that levels may answer | `shares.rs` |
//! | look | what rows of numbers settle of each pair | `narrow_phase.rs` |
//! | decide | the pair layer answers for what is left | `narrow_phase.rs`, `contacts.rs` |
//! | select | of two objects one pair is listed, where that is asked for | `selection.rs` |
//! | list | answers are put in order, new ones between those given again | `findings.rs`, `slots.rs` |

pub(crate) mod query;
pub(crate) mod statistics;
mod slots;
mod contacts;
pub(crate) mod request;
mod findings;
mod narrow_phase;
mod selection;
mod parts;
mod shares;
mod gathering;
mod all_pairs;
pub(crate) mod events;
pub(crate) mod listener;
pub(crate) mod ask;
mod straight;
