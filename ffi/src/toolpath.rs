//! Paths for machines.

use crate::code::{Failure, answer, minvar_code, minvar_error};
use crate::curve::minvar_element;
use crate::measure::elements_of;
use crate::raw::{Output, null, reference};
use core::ffi::{c_char, c_void};
use core::fmt;
use kernel::toolpath::{self, GcodeError, GcodeOptions, Motion, Move, PathError, Plane, Units};

/// The unit of all lengths of a program: the curve's, the tolerance's and the feed's.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_units {
    /// G21.
    MINVAR_MILLIMETRES = 0,
    /// G20.
    MINVAR_INCHES = 1,
}

/// The machine's plane in which the curve's x and y lie.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_plane {
    /// G17: x, y, z are the machine's X, Y, Z.
    MINVAR_XY = 0,
    /// G18: x, y, z are the machine's Z, X, Y.
    MINVAR_ZX = 1,
    /// G19: x, y, z are the machine's Y, Z, X.
    MINVAR_YZ = 2,
}

/// How a path is cut.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum minvar_motion {
    /// G2/G3 arcs and G1 lines of a curve in a plane z = constant.
    MINVAR_ARCS = 0,
    /// G1 only, for any curve.
    MINVAR_CHORDS = 1,
}

/// One move of a path, from where the last one ended.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_move {
    /// 0: a line; 1: an arc to the left; -1: an arc to the right (clockwise).
    pub turn: i32,
    /// The end point x, y, z.
    pub end: [f64; 3],
    /// The centre of an arc x, y, z; zeros of a line.
    pub centre: [f64; 3],
    /// Proven: neither this move from its part of the curve nor that part from the move is farther than this length.
    pub deviation: f64,
}

/// Receives the moves of a path in order, with the caller's context; `step` lives until the function returns. Return 0
/// to go on, anything else to stop with MINVAR_STOPPED. It must return, not leave by longjmp() or an exception.
pub type minvar_visitor = Option<unsafe extern "C" fn(context: *mut c_void, step: *const minvar_move) -> i32>;

/// Receives text, with the caller's context: `length` bytes of ASCII that are not NUL-terminated and live until the
/// function returns. They come in pieces of any size, often of a few bytes: gather them in a buffer. Return 0 if all
/// was taken, anything else to stop with MINVAR_STOPPED. It must return, not leave by longjmp() or an exception.
pub type minvar_writer =
    Option<unsafe extern "C" fn(context: *mut c_void, text: *const c_char, length: usize) -> i32>;

/// What a program is to be: start from minvar_gcode_defaults(). Lengths are in the program's unit.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_gcode_options {
    /// The greatest distance between the printed path and the curve, positive. No default.
    pub tolerance: f64,
    /// The cutting feed, length/minute, positive. No default.
    pub feed: f64,
    /// The feed while plunging, length/minute; 0 for the cutting feed. Default 0.
    pub plunge_feed: f64,
    /// The third axis while moving to the start and after the end; above the cut. No default.
    pub safe_height: f64,
    /// What is added to the curve's z while cutting: negative goes into the material. Default 0.
    pub depth: f64,
    /// One of enum minvar_units. Default MINVAR_MILLIMETRES.
    pub units: u32,
    /// One of enum minvar_plane. Default MINVAR_XY.
    pub plane: u32,
    /// One of enum minvar_motion. Default MINVAR_ARCS.
    pub motion: u32,
    /// Decimals printed, 6 to 9. Default 6.
    pub decimals: u32,
    /// Not 0: explain the lines by comments in parentheses. Default 0.
    pub comments: i32,
}

/// What was written.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct minvar_gcode_summary {
    /// The number of lines of text.
    pub lines: usize,
    /// The number of G2 and G3 moves.
    pub arcs: usize,
    /// The number of G1 moves that cut; the plunge is not counted.
    pub chords: usize,
    /// The length of the cut, in the program's unit.
    pub length: f64,
    /// The time of the cut at the programmed feed in minutes, without acceleration, plunge and rapids.
    pub minutes: f64,
    /// Proven: no point of the printed cut is farther than this length from the curve (raised by `depth`), nor the
    /// curve from the cut.
    pub deviation: f64,
}

/// Calls `visit` with the chords of a chain, each within `tolerance` (a length) of its part: as few as a greedy choice
/// makes. The first one begins where the chain does, at C(0) of element 0; every corner of the chain is the end of one.
///
/// Errors: MINVAR_BAD_TOLERANCE, MINVAR_TOLERANCE_TOO_FINE, MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_GAP,
/// all before the first move; MINVAR_STOPPED if the visitor stopped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_chords(
    elements: *const minvar_element,
    count: usize,
    tolerance: f64,
    visit: minvar_visitor,
    context: *mut c_void,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<PathError>(error, || {
            let visit = visit.ok_or(null("visit"))?;
            for chord in toolpath::chords(elements_of(elements, count)?, tolerance)? {
                let mut found =
                    minvar_move { turn: 0, end: chord.end, centre: [0.0; 3], deviation: chord.deviation };
                if visit(context, &raw mut found) != 0 {
                    return Err(Failure::Stopped.into());
                }
            }
            Ok(())
        })
    }
}

/// Calls `visit` with arcs and lines within `tolerance` (a length) of a chain in a plane z = constant: each biarc the
/// longest that can be proven. They continue each other's tangent but for the corners of the chain. The first one begins
/// where the chain does, at C(0) of element 0.
///
/// Errors: as minvar_chords(), and MINVAR_PATH_NOT_PLANAR, MINVAR_IRREGULAR.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_arcs(
    elements: *const minvar_element,
    count: usize,
    tolerance: f64,
    visit: minvar_visitor,
    context: *mut c_void,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<PathError>(error, || {
            let visit = visit.ok_or(null("visit"))?;
            let arcs = toolpath::arcs(elements_of(elements, count)?, tolerance)?;
            let z = arcs.height();
            for segment in arcs {
                let (turn, end, centre) = match segment.motion {
                    Move::Line { end } => (0, end, None),
                    Move::Arc { end, centre, clockwise } => {
                        (if clockwise { -1 } else { 1 }, end, Some(centre))
                    }
                };
                let mut found = minvar_move {
                    turn,
                    end: [end[0], end[1], z],
                    centre: centre.map_or([0.0; 3], |centre| [centre[0], centre[1], z]),
                    deviation: segment.deviation,
                };
                if visit(context, &raw mut found) != 0 {
                    return Err(Failure::Stopped.into());
                }
            }
            Ok(())
        })
    }
}

/// The defaults named at each field, with the three that have none: tolerance and safe height are lengths, the feed is
/// length/minute. Only fills in a struct: minvar_write_gcode() checks it.
#[unsafe(no_mangle)]
pub extern "C" fn minvar_gcode_defaults(tolerance: f64, feed: f64, safe_height: f64) -> minvar_gcode_options {
    let defaults = GcodeOptions::new(tolerance, feed, safe_height);
    minvar_gcode_options {
        tolerance,
        feed,
        plunge_feed: 0.0,
        safe_height,
        depth: defaults.depth,
        units: minvar_units::MINVAR_MILLIMETRES as u32,
        plane: minvar_plane::MINVAR_XY as u32,
        motion: minvar_motion::MINVAR_ARCS as u32,
        decimals: u32::from(defaults.decimals),
        comments: 0,
    }
}

/// The caller's writer as the kernel's.
struct Text {
    write: unsafe extern "C" fn(*mut c_void, *const c_char, usize) -> i32,
    context: *mut c_void,
}

impl fmt::Write for Text {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        // SAFETY: the caller gave this function for this call.
        let answer = unsafe { (self.write)(self.context, s.as_ptr().cast(), s.len()) };
        if answer == 0 { Ok(()) } else { Err(fmt::Error) }
    }
}

/// Writes a chain as one complete G-code program through `write`. The same input gives the same bytes on every machine.
///
/// The lines: unit, plane, G90, G91.1, G94, G40, G80; rapid to the safe height and to the start; plunge; the cut at the
/// feed; rapid to the safe height; M2. Each ends with `\n`. `summary` may be NULL.
///
/// Errors: those of minvar_arcs() or, with MINVAR_CHORDS, of minvar_chords(); MINVAR_BAD_OPTION for an unknown unit,
/// plane or motion; MINVAR_BAD_DECIMALS to MINVAR_COORDINATE_TOO_LARGE. All are found before the first character;
/// only MINVAR_STOPPED, where `write` stopped, leaves part of a program behind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn minvar_write_gcode(
    elements: *const minvar_element,
    count: usize,
    options: *const minvar_gcode_options,
    write: minvar_writer,
    context: *mut c_void,
    summary: *mut minvar_gcode_summary,
    error: *mut minvar_error,
) -> minvar_code {
    // SAFETY: promised by the caller.
    unsafe {
        answer::<GcodeError>(error, || {
            let given = reference(options, "options")?;
            let write = write.ok_or(null("write"))?;
            let summary = Output::optional(summary, "summary")?;
            let elements = elements_of(elements, count)?;
            let options = GcodeOptions {
                tolerance: given.tolerance,
                units: match given.units {
                    0 => Units::Millimetres,
                    1 => Units::Inches,
                    _ => {
                        return Err(Failure::Option {
                            field: 5,
                            rule: "units: must be millimetres (0) or inches (1)",
                        }
                        .into());
                    }
                },
                plane: match given.plane {
                    0 => Plane::Xy,
                    1 => Plane::Zx,
                    2 => Plane::Yz,
                    _ => {
                        return Err(Failure::Option {
                            field: 6,
                            rule: "plane: must be XY (0), ZX (1) or YZ (2)",
                        }
                        .into());
                    }
                },
                motion: match given.motion {
                    0 => Motion::Arcs,
                    1 => Motion::Chords,
                    _ => {
                        return Err(Failure::Option {
                            field: 7,
                            rule: "motion: must be arcs (0) or chords (1)",
                        }
                        .into());
                    }
                },
                feed: given.feed,
                plunge_feed: (given.plunge_feed != 0.0).then_some(given.plunge_feed),
                safe_height: given.safe_height,
                depth: given.depth,
                decimals: u8::try_from(given.decimals).unwrap_or(u8::MAX),
                comments: given.comments != 0,
            };
            let mut text = Text { write, context };
            let found = toolpath::write_gcode(elements, &options, &mut text)?;
            if let Some(summary) = summary {
                summary.put(minvar_gcode_summary {
                    lines: found.lines,
                    arcs: found.arcs,
                    chords: found.chords,
                    length: found.length,
                    minutes: found.minutes,
                    deviation: found.deviation,
                });
            }
            Ok(())
        })
    }
}
