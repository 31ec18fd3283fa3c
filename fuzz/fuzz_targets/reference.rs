//! minvar against Ceres.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hostile::reference::run(bytes));
