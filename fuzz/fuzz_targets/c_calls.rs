#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| swiftprox_fuzz::targets::c_calls::run(bytes));
