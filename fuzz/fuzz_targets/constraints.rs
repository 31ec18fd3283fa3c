//! The command's readers, and the command on what they read.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hostile::reader::run(bytes));
