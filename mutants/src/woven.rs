//! Which mutant runs: this file stands in the woven kernel as its module `mutant`.
//!
//! `MINVAR_MUTANT` is the active mutant's number, read before `main`. With it a panic ends the program at once, so that
//! the first failed assertion is the last. Where [`COVER`] holds, the places that ran are written as a byte each to a
//! file in the folder `MINVAR_MUTANT_COVER`.

extern crate std;

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};
use std::io::Write as _;
use std::{env, format, fs, panic, process, string::String};

/// Whether places are recorded.
pub(crate) const COVER: bool = option_env!("MINVAR_MUTANT_COVERS").is_some();
const COUNT: usize = 0;

static ACTIVE: AtomicU32 = AtomicU32::new(0);
static RAN: [AtomicU8; COUNT + 1] = [const { AtomicU8::new(0) }; COUNT + 1];

/// The active mutant's number, at the place of the mutants from `first` on.
#[inline(always)]
pub(crate) fn at(first: u32) -> u32 {
    mark(first, true);
    active()
}

#[inline(always)]
pub(crate) fn active() -> u32 {
    ACTIVE.load(Relaxed)
}

/// Whether this mutant is active.
#[inline(always)]
pub(crate) fn on(mutant: u32) -> bool {
    at(mutant) == mutant
}

/// Records that a mutant would have made a difference here.
#[inline(always)]
pub(crate) fn mark(mutant: u32, differs: bool) {
    if COVER && differs {
        RAN[mutant as usize].store(1, Relaxed);
    }
}

extern "C" fn begin() {
    let Ok(number) = env::var("MINVAR_MUTANT") else { return };
    ACTIVE.store(number.parse().expect("a mutant's number"), Relaxed);
    panic::set_hook(std::boxed::Box::new(|info| {
        let place = info.location().map_or_else(String::new, |place| format!("{}:{}", place.file(), place.line()));
        let _ = std::io::stderr().write_all(format!("panic at {place}\n").as_bytes());
        let _ = std::io::stdout().flush();
        process::exit(101);
    }));
}

extern "C" fn end() {
    if let (true, Ok(folder)) = (COVER, env::var("MINVAR_MUTANT_COVER")) {
        let ran: std::vec::Vec<u8> = RAN.iter().map(|ran| ran.load(Relaxed)).collect();
        fs::write(format!("{folder}/{}", process::id()), ran).expect("the folder can be written");
    }
}

#[used]
#[unsafe(link_section = ".init_array")]
static BEGIN: extern "C" fn() = begin;
#[used]
#[unsafe(link_section = ".fini_array")]
static END: extern "C" fn() = end;
