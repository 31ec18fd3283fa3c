//! Memory as C hands it over, and calls that must work or must be refused.

use minvar_ffi::minvar_code::{MINVAR_MISALIGNED, MINVAR_OK};
use minvar_ffi::{minvar_code, minvar_element, minvar_error, minvar_report};
use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

/// Room for exactly `len` `T`s, not written yet.
pub(crate) struct Room<T>(Box<[MaybeUninit<T>]>);

impl<T: Copy> Room<T> {
    pub(crate) fn new(len: usize) -> Self {
        Self(Box::new_uninit_slice(len))
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn start(&mut self) -> *mut T {
        self.0.as_mut_ptr().cast()
    }

    /// The first `count`, which somebody has written: Miri objects if nobody has.
    pub(crate) fn written(&self, count: usize) -> &[T] {
        let written: *const [MaybeUninit<T>] = &raw const self.0[..count];
        // SAFETY: tests ask for what the interface says that it writes.
        unsafe { &*(written as *const [T]) }
    }

    /// The only one.
    pub(crate) fn one(&self) -> T {
        assert_eq!(self.len(), 1);
        self.written(1)[0]
    }

    /// Every byte `pattern`.
    pub(crate) fn fill(&mut self, pattern: u8) {
        let start = self.start().cast::<u8>();
        // SAFETY: all of it is this room's own.
        unsafe { start.write_bytes(pattern, size_of::<T>() * self.len()) };
    }

    /// Whether every byte is still `pattern`.
    pub(crate) fn is_all(&self, pattern: u8) -> bool {
        let start = self.0.as_ptr().cast::<u8>();
        // SAFETY: within the room; `fill` wrote all bytes.
        (0..size_of::<T>() * self.len()).all(|k| unsafe { start.add(k).read() } == pattern)
    }
}

/// The sentence of an error.
pub(crate) fn sentence(error: &minvar_error) -> &str {
    let bytes: &[u8; 192] = &error.message.map(|byte| byte as u8);
    assert!(bytes.contains(&0), "the sentence has no end");
    // SAFETY: it has an end within the message.
    unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().expect("ASCII")
}

/// Makes a call that must work, with an error to fill which nobody has written.
pub(crate) fn works(call: impl FnOnce(*mut minvar_error) -> minvar_code) {
    let mut error = Box::<minvar_error>::new_uninit();
    let code = call(error.as_mut_ptr());
    // SAFETY: every call fills the error.
    let error = unsafe { error.assume_init() };
    assert_eq!((code, error.code), (MINVAR_OK, MINVAR_OK), "{}", sentence(&error));
    assert_eq!((sentence(&error), error.index, error.needed, error.given), ("no error", 0, 0, 0));
}

/// Makes a call that must be refused, with `word` in the sentence: once with an error to fill, once without, once with
/// one that is misaligned. The error's index, needed and given.
pub(crate) fn refused(
    wanted: minvar_code,
    word: &str,
    mut call: impl FnMut(*mut minvar_error) -> minvar_code,
) -> (usize, usize, usize) {
    let mut error = Box::<minvar_error>::new_uninit();
    let code = call(error.as_mut_ptr());
    assert_eq!(call(null_mut()), wanted);
    assert_eq!(call(misaligned(error.as_mut_ptr())), MINVAR_MISALIGNED);
    // SAFETY: the first call filled the error, the last one did not touch it.
    let error = unsafe { error.assume_init() };
    assert_eq!((code, error.code), (wanted, wanted), "{}", sentence(&error));
    assert!(sentence(&error).contains(word), "{:?} names no {word:?}", sentence(&error));
    (error.index, error.needed, error.given)
}

/// A pointer that is not aligned for its type.
pub(crate) fn misaligned<T>(pointer: *mut T) -> *mut T {
    pointer.cast::<u8>().wrapping_add(1).cast()
}

/// The bits of elements.
pub(crate) fn bits(elements: &[minvar_element]) -> Vec<[[u64; 3]; 6]> {
    elements.iter().map(|element| element.rows.map(|row| row.map(f64::to_bits))).collect()
}

/// The bits of the figures of a report, and its counts.
pub(crate) fn figures(report: &minvar_report) -> ([usize; 4], [u64; 8]) {
    let counts = [report.elements, report.iterations, report.linearisations, report.unknowns];
    let numbers = [
        report.value,
        report.fine_value,
        report.length,
        report.variation,
        report.bending,
        report.error,
        report.gradient,
        report.decrement,
    ];
    (counts, numbers.map(f64::to_bits))
}
