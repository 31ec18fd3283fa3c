//! Curves through the C boundary.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hostile::curve::run(bytes));
