//! From C's pointers to slices and back.

use crate::code::{Failure, minvar_code};
use core::slice;

/// The failure of an argument that is NULL.
pub(crate) const fn null(name: &'static str) -> Failure {
    Failure::Argument { code: minvar_code::MINVAR_NULL_POINTER, name }
}

/// Checks what can be known of a pointer to `len` `T`s. `name`: the argument, as the header spells it.
fn check<T>(pointer: *const T, len: usize, name: &'static str) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(null(name));
    }
    if !pointer.is_aligned() {
        return Err(Failure::Argument { code: minvar_code::MINVAR_MISALIGNED, name });
    }
    if len > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Failure::Argument { code: minvar_code::MINVAR_TOO_LONG, name });
    }
    Ok(())
}

/// What a pointer refers to.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to a `T` that nobody changes while the reference lives.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, name: &'static str) -> Result<&'a T, Failure> {
    check(pointer, 1, name)?;
    // SAFETY: not NULL, aligned, and the caller promises the rest.
    Ok(unsafe { &*pointer })
}

/// An array as a slice; a length of 0 is an empty one, whatever the pointer.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to `len` initialised `T`s that nobody changes while the slice lives.
pub(crate) unsafe fn array<'a, T>(
    pointer: *const T,
    len: usize,
    name: &'static str,
) -> Result<&'a [T], Failure> {
    if len == 0 {
        return Ok(&[]);
    }
    check(pointer, len, name)?;
    // SAFETY: not NULL, aligned, not too long, and the caller promises the rest.
    Ok(unsafe { slice::from_raw_parts(pointer, len) })
}

/// An array to write to; a length of 0 is an empty one, whatever the pointer.
///
/// # Safety
/// If not NULL and aligned, the pointer refers to `len` `T`s, of a type without invalid values, that nobody else uses
/// while the slice lives.
pub(crate) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    len: usize,
    name: &'static str,
) -> Result<&'a mut [T], Failure> {
    if len == 0 {
        return Ok(&mut []);
    }
    check(pointer, len, name)?;
    // SAFETY: not NULL, aligned, not too long, and the caller promises the rest.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, len) })
}

/// Where one result goes: checked before the work, written after it.
pub(crate) struct Output<T>(*mut T);

impl<T> Output<T> {
    /// # Safety
    /// If not NULL and aligned, the pointer is valid for writing a `T` until the result is put.
    pub(crate) unsafe fn new(pointer: *mut T, name: &'static str) -> Result<Self, Failure> {
        check(pointer, 1, name)?;
        Ok(Self(pointer))
    }

    /// As [`Output::new`]; NULL is nobody who wants to know.
    ///
    /// # Safety
    /// As [`Output::new`].
    pub(crate) unsafe fn optional(pointer: *mut T, name: &'static str) -> Result<Option<Self>, Failure> {
        // SAFETY: promised by the caller.
        if pointer.is_null() { Ok(None) } else { unsafe { Self::new(pointer, name).map(Some) } }
    }

    pub(crate) fn put(self, value: T) {
        // SAFETY: not NULL and aligned as `new` found; the rest its caller promised.
        unsafe { self.0.write(value) };
    }
}
