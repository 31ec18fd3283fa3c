//! Paths and programs, read back and measured.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hostile::path::run(bytes));
