//! The stack that a function of the C library takes at most, from the machine code alone: a bound, where a painted stack only
//! shows what was seen.

pub mod bound;
pub mod program;
pub mod thumb;
