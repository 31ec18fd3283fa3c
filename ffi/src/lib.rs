//! The C boundary: builds `libminvar`.
//!
//! One file a layer, mirroring the kernel. Structs here have the C names and the C documentation, from which
//! cbindgen writes `include/minvar.h`; those that cross in arrays have the very layout of the kernel's, which is
//! asserted when this is compiled. Every function checks its pointers; numbers are the kernel's to check.

#![no_std]
#![allow(non_camel_case_types, reason = "C names")]
// The functions' documentation is the header's: their one safety rule stands in the header's conventions.
#![allow(clippy::missing_safety_doc, reason = "in the header's conventions")]

mod code;
mod convert;
mod curve;
mod layout;
mod measure;
#[cfg(not(any(test, feature = "std")))]
mod panic;
mod raw;
mod region;
mod toolpath;

pub use code::{minvar_code, minvar_error, minvar_status, minvar_status_sentence};
pub use convert::*;
pub use curve::*;
pub use measure::*;
pub use region::*;
pub use toolpath::*;

use core::ffi::c_char;

/// The number of this interface. It grows when something changes that compiled programs would notice.
pub const MINVAR_ABI: u32 = 2;

/// The version of the library as `"MAJOR.MINOR.PATCH"`; static: not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// 1 if the library has the interface that the caller was compiled with, else 0: call
/// `minvar_abi_check(MINVAR_ABI)` once where the library is loaded dynamically.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_abi_check(abi: u32) -> i32 {
    i32::from(abi == MINVAR_ABI)
}

// As a crate of a Rust program, which tests need, this has that program's panic handler.
#[cfg(feature = "std")]
extern crate std;

/// What the proof must find: a function that panics.
///
/// cbindgen:ignore
#[cfg(minvar_planted_panic)]
#[unsafe(no_mangle)]
pub extern "C" fn minvar_planted(index: usize) -> u8 {
    [1, 2, 3][index]
}
