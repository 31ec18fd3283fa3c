//! Memory as C hands it over: exactly as long as is declared, in any condition, and pointers that cannot be used.

use minvar_ffi::minvar_code;
use std::cell::Cell;
use std::mem::{MaybeUninit, size_of};

/// Room for so many `T`s and not one byte more: AddressSanitizer guards both ends.
pub struct Room<T> {
    room: Box<[MaybeUninit<T>]>,
    fill: u8,
}

impl<T> Room<T> {
    /// Room in which every byte is `fill`.
    pub fn new(len: usize, fill: u8) -> Self {
        let mut room = Box::new_uninit_slice(len);
        // SAFETY: any bytes may stand in a `MaybeUninit`, and the room is `len` entries long.
        unsafe { room.as_mut_ptr().write_bytes(fill, len) };
        Self { room, fill }
    }

    /// Room for one.
    pub fn one(fill: u8) -> Self {
        Self::new(1, fill)
    }

    /// A copy of `data` with no room besides.
    pub fn of(data: &[T]) -> Self
    where
        T: Copy,
    {
        let mut room = Self::new(data.len(), 0);
        for (place, one) in room.room.iter_mut().zip(data) {
            place.write(*one);
        }
        room
    }

    /// How many entries there is room for.
    pub fn len(&self) -> usize {
        self.room.len()
    }

    /// Whether there is no room at all.
    pub fn is_empty(&self) -> bool {
        self.room.is_empty()
    }

    /// Where it begins.
    pub fn pointer(&mut self) -> *mut T {
        self.room.as_mut_ptr().cast()
    }

    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        // SAFETY: every byte was written, by `new` or by what was called with the pointer, which writes whole values of types
        // without padding or leaves the bytes alone.
        unsafe { std::slice::from_raw_parts(self.room.as_ptr().cast(), size_of::<T>() * self.room.len()) }
    }

    /// Whether nothing was written to the entries from `first` on.
    pub fn is_untouched_from(&self, first: usize) -> bool {
        self.bytes()[first * size_of::<T>()..].iter().all(|&byte| byte == self.fill)
    }

    /// Whether nothing was written to any.
    pub fn is_untouched(&self) -> bool {
        self.is_untouched_from(0)
    }

    /// Its first entries.
    ///
    /// # Safety
    /// So many were written, or any bytes are a `T`.
    pub unsafe fn first(&self, count: usize) -> &[T] {
        // SAFETY: promised by the caller; there are so many, or this panics.
        unsafe { &*(std::ptr::from_ref(&self.room[..count]) as *const [T]) }
    }
}

/// What is wrong with one pointer argument of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrong {
    /// NULL.
    Null,
    /// Not aligned.
    Misaligned,
    /// An array of more entries than memory can have.
    TooLong,
}

/// One argument of a call made wrong, or none.
#[derive(Debug)]
pub struct Fault {
    at: Option<(u8, Wrong)>,
    /// What the call must answer, and the name that its message must hold.
    found: Cell<Option<(minvar_code, &'static str)>>,
}

impl Fault {
    /// The fault of a byte: one in eight calls has one.
    pub fn new(choice: u8) -> Self {
        let wrong = match choice % 8 {
            1 => Some(Wrong::Null),
            2 => Some(Wrong::Misaligned),
            3 => Some(Wrong::TooLong),
            _ => None,
        };
        Self {
            at: wrong.filter(|_| choice >= 128).map(|wrong| (choice / 8 % 16, wrong)),
            found: Cell::new(None),
        }
    }

    /// No fault.
    pub const fn none() -> Self {
        Self { at: None, found: Cell::new(None) }
    }

    /// Before every call.
    pub fn begin(&self) {
        self.found.set(None);
    }

    /// What a call must answer whose arguments came through this.
    pub fn expected(&self) -> Option<(minvar_code, &'static str)> {
        self.found.get()
    }

    /// Whether argument number `argument` is not aligned.
    pub fn is_misaligned(&self, argument: u8) -> bool {
        self.wrong(argument) == Some(Wrong::Misaligned)
    }

    fn wrong(&self, argument: u8) -> Option<Wrong> {
        self.at.and_then(|(at, wrong)| (at == argument).then_some(wrong))
    }

    /// The pointer to one value that is argument number `argument`.
    pub fn pointer<T>(&self, argument: u8, name: &'static str, pointer: *mut T) -> *mut T {
        self.array(argument, name, pointer, 1).0
    }

    /// The pointer and the length of an array.
    pub fn array<T>(&self, argument: u8, name: &'static str, pointer: *mut T, len: usize) -> (*mut T, usize) {
        match self.wrong(argument) {
            // Of an array of no entries the pointer is not looked at.
            Some(Wrong::Null) => {
                if len > 0 {
                    self.found.set(Some((minvar_code::MINVAR_NULL_POINTER, name)));
                }
                (std::ptr::null_mut(), len)
            }
            Some(Wrong::Misaligned) if align_of::<T>() > 1 => {
                if len > 0 {
                    self.found.set(Some((minvar_code::MINVAR_MISALIGNED, name)));
                }
                (pointer.wrapping_byte_add(1), len)
            }
            Some(Wrong::TooLong) if len != 1 => {
                self.found.set(Some((minvar_code::MINVAR_TOO_LONG, name)));
                (pointer, isize::MAX as usize / size_of::<T>() + 1)
            }
            _ => (pointer, len),
        }
    }

    /// A callback.
    pub fn function<F>(&self, argument: u8, name: &'static str, function: F) -> Option<F> {
        if self.wrong(argument) != Some(Wrong::Null) {
            return Some(function);
        }
        self.found.set(Some((minvar_code::MINVAR_NULL_POINTER, name)));
        None
    }
}
