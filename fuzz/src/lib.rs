//! Hostile input for minvar, and the promises that it is held to. Each target in `fuzz_targets/` is a few lines over this.
//!
//! ```text
//! bytes → coder → a case (any struct, count, pointer, bit pattern) → calls, each made twice in memory that differs
//!                                                                    in what it held before → promises
//! ```
//!
//! [`coder`] turns bytes into cases and cases into bytes, so that the seeds are the curves of `tests/data/curves`. [`memory`]
//! has buffers of exactly the length that is declared, which AddressSanitizer guards. [`answer`] says what every answer
//! must be. [`curve`], [`chain`], [`path`], [`reader`] and [`reference`] are the targets; what they promise of a result is in
//! [`result`]. A promise that is broken is a panic.

pub mod answer;
pub mod chain;
pub mod coder;
pub mod curve;
pub mod data;
pub mod memory;
pub mod path;
pub mod reader;
pub mod reference;
pub mod result;
pub mod seeds;

/// Whether an input is to be shown before it is run, to make a test of it: `HOSTILE_SHOW=1 TARGET INPUT`.
pub fn shows() -> bool {
    std::env::var_os("HOSTILE_SHOW").is_some()
}
