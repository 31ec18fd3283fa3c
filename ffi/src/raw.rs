//! From C's pointers to slices and back.

use crate::code::{Failure, minvar_code};
use core::slice;

fn usable<T>(pointer: *const T, len: usize) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::new(minvar_code::MINVAR_NULL_POINTER));
    }
    if !pointer.is_aligned() {
        return Err(Failure::new(minvar_code::MINVAR_MISALIGNED));
    }
    if len > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Failure::new(minvar_code::MINVAR_TOO_LONG));
    }
    Ok(())
}

/// What a pointer refers to.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to a `T` that nobody changes while the reference lives.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T) -> Result<&'a T, Failure> {
    usable(pointer, 1)?;
    // SAFETY: not NULL, aligned, and the caller promises the rest.
    Ok(unsafe { &*pointer })
}

/// An array as a slice; NULL is an empty array of length 0.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to `len` initialised `T`s that nobody changes while the slice lives.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, len: usize) -> Result<&'a [T], Failure> {
    if len == 0 {
        return Ok(&[]);
    }
    usable(pointer, len)?;
    // SAFETY: not NULL, aligned, not too long, and the caller promises the rest.
    Ok(unsafe { slice::from_raw_parts(pointer, len) })
}

/// An array to write to; NULL is an empty array of length 0.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to `len` `T`s, of a type without invalid values, that nobody else uses
/// while the slice lives.
pub(crate) unsafe fn array_mut<'a, T>(pointer: *mut T, len: usize) -> Result<&'a mut [T], Failure> {
    if len == 0 {
        return Ok(&mut []);
    }
    usable(pointer, len)?;
    // SAFETY: not NULL, aligned, not too long, and the caller promises the rest.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, len) })
}

/// Writes a result.
///
/// # Safety
/// If not NULL and aligned, the pointer is valid for writing.
pub(crate) unsafe fn put<T>(pointer: *mut T, value: T) -> Result<(), Failure> {
    usable(pointer, 1)?;
    // SAFETY: not NULL, aligned, and the caller promises the rest.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Checks a pointer for a result before the work whose result it takes.
pub(crate) fn writable<T>(pointer: *mut T) -> Result<(), Failure> {
    usable(pointer, 1)
}
