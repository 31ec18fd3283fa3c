//! What every answer of the library must be, whatever was asked.

use crate::memory::{Fault, Room};
use minvar_ffi::minvar_code::{self, *};
use minvar_ffi::minvar_error;

/// A call is made twice, with as much as possible different that must make no difference.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// What memory holds before the call, byte by byte.
    pub fill: u8,
    /// Whether the caller wants to know about errors.
    pub wants_error: bool,
}

/// The two turns of every call. The bytes make NaN, and numbers that are next to nothing.
pub const TURNS: [Turn; 2] =
    [Turn { fill: 0xff, wants_error: true }, Turn { fill: 0x25, wants_error: false }];

/// A code and what came with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The code.
    pub code: minvar_code,
    /// The error's figures: index, needed, given; `None` where nobody asked.
    pub figures: Option<[usize; 3]>,
}

impl Answer {
    /// Whether the call did what it says.
    pub fn is_ok(&self) -> bool {
        self.code == MINVAR_OK
    }

    /// Whether a pointer is to blame.
    pub fn is_by_pointer(&self) -> bool {
        ALWAYS[1..].contains(&self.code)
    }

    /// That two turns gave the same.
    pub fn same(&self, other: &Self) {
        assert_eq!(self.code, other.code, "the same call gave another code");
        if let (Some(a), Some(b)) = (self.figures, other.figures) {
            assert_eq!(a, b, "the same call gave other figures");
        }
    }
}

/// Any function may answer with these.
const ALWAYS: [minvar_code; 4] = [MINVAR_OK, MINVAR_NULL_POINTER, MINVAR_MISALIGNED, MINVAR_TOO_LONG];

/// The number of the last argument, as faults count.
const ERROR: u8 = 15;

/// Makes a call and looks at its answer: a code that the function's documentation lists, the one that a wrong pointer must
/// give, an error struct that says the same in a whole sentence.
pub fn ask(
    turn: Turn,
    fault: &Fault,
    listed: &[minvar_code],
    call: impl FnOnce(*mut minvar_error) -> minvar_code,
) -> Answer {
    let mut room = Room::<minvar_error>::one(turn.fill);
    let misplaced = fault.is_misaligned(ERROR);
    let error = match (misplaced, turn.wants_error) {
        (true, _) => room.pointer().wrapping_byte_add(1),
        (false, true) => room.pointer(),
        (false, false) => std::ptr::null_mut(),
    };
    let code = call(error);
    if misplaced {
        assert_eq!(code, MINVAR_MISALIGNED, "an error struct that is not aligned");
        assert!(room.is_untouched(), "an error struct that is not aligned was written");
        return Answer { code, figures: None };
    }
    let expected = fault.expected();
    if let Some((expected, name)) = expected {
        assert_eq!(code, expected, "argument {name}");
    } else {
        let known = code == MINVAR_OK || listed.contains(&code);
        assert!(known && !ALWAYS[1..].contains(&code), "{code:?} is none of {listed:?}");
    }
    if !turn.wants_error {
        return Answer { code, figures: None };
    }
    assert!(!room.is_untouched(), "the error was not filled");
    // SAFETY: the call filled it.
    let error = unsafe { &room.first(1)[0] };
    assert_eq!(error.code, code, "the error's code is not what was returned");
    let text: Vec<u8> = error.message.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect();
    assert!(text.len() < error.message.len(), "the message does not end");
    let text = std::str::from_utf8(&text).expect("the message is ASCII");
    assert!(!text.is_empty() && text.chars().all(|c| (' '..='~').contains(&c)), "message {text:?}");
    assert_eq!(code == MINVAR_OK, text == "no error", "{code:?}: {text}");
    if let Some((_, name)) = expected {
        assert!(text.contains(name), "{text} does not name {name}");
    }
    let figures = [error.index, error.needed, error.given];
    assert!(code != MINVAR_OK || figures == [0; 3], "figures {figures:?} of no error");
    if matches!(code, MINVAR_WORKSPACE_TOO_SMALL | MINVAR_RESULT_TOO_SHORT | MINVAR_TOO_FEW_JOINTS) {
        assert!(error.needed > error.given, "{text}");
    }
    Answer { code, figures: Some(figures) }
}
