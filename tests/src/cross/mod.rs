//! The corpus of `tests/cross`: its data as C, and its lines.

pub mod data;
pub mod form;
pub mod lines;
