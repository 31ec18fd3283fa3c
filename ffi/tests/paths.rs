//! Chords, arcs and G-code, handed to functions of the caller's: the kernel's, move by move and byte by byte.

use crate::memory::{Room, works};
use kernel::curve::Element;
use kernel::toolpath::{self, GcodeOptions, Motion, Move, Plane, Units};
use minvar_ffi::*;
use std::ffi::{c_char, c_void};
use std::ptr::null_mut;

/// A quarter turn in a plane z = constant, as C and the kernel have it.
pub(crate) fn bend() -> (minvar_element, Element) {
    let rows = [
        [0.0, 0.0, 1.0],
        [1.6, 0.0, 0.0],
        [0.0, 2.4, 0.0],
        [-2.4, 0.0, 0.0],
        [0.0, 1.6, 0.0],
        [1.0, 1.0, 1.0],
    ];
    (minvar_element { rows }, Element { rows })
}

/// A move's turn, end and centre, and its deviation.
type Step = (i32, [[f64; 3]; 2], f64);

/// Keeps the moves that it gets in a `Vec<Step>`.
unsafe extern "C" fn keep(context: *mut c_void, step: *const minvar_move) -> i32 {
    // SAFETY: the tests give a vector as the context; the library a move that lives as long as this call.
    let (steps, step) = unsafe { (&mut *context.cast::<Vec<Step>>(), &*step) };
    steps.push((step.turn, [step.end, step.centre], step.deviation));
    0
}

#[test]
fn chords_are_the_kernels() {
    let (ours, theirs) = bend();
    let mut steps: Vec<Step> = Vec::new();
    let context: *mut c_void = (&raw mut steps).cast();
    works(|error| unsafe { minvar_chords(&ours, 1, 0.02, Some(keep), context, error) });
    let known = toolpath::chords(std::slice::from_ref(&theirs), 0.02).expect("a chain");
    let known: Vec<_> = known.map(|chord| (0, [chord.end, [0.0; 3]], chord.deviation)).collect();
    assert!(known.len() > 1);
    assert_eq!(steps, known);
}

#[test]
fn arcs_are_the_kernels() {
    let (ours, theirs) = bend();
    let mut steps: Vec<Step> = Vec::new();
    let context: *mut c_void = (&raw mut steps).cast();
    works(|error| unsafe { minvar_arcs(&ours, 1, 0.02, Some(keep), context, error) });
    let known = toolpath::arcs(std::slice::from_ref(&theirs), 0.02).expect("a chain").map(|segment| {
        let (turn, [x, y], centre) = match segment.motion {
            Move::Line { end } => (0, end, [0.0; 3]),
            Move::Arc { end, centre: [x, y], clockwise } => {
                (if clockwise { -1 } else { 1 }, end, [x, y, 1.0])
            }
        };
        (turn, [[x, y, 1.0], centre], segment.deviation)
    });
    assert_eq!(steps, known.collect::<Vec<_>>());
    assert!(steps.iter().any(|step| step.0 == 1));
}

/// Appends to a `String`.
unsafe extern "C" fn write(context: *mut c_void, text: *const c_char, length: usize) -> i32 {
    // SAFETY: the tests give a string as the context; the library that many bytes.
    let (all, piece) =
        unsafe { (&mut *context.cast::<String>(), std::slice::from_raw_parts(text.cast(), length)) };
    all.push_str(std::str::from_utf8(piece).expect("ASCII"));
    0
}

#[test]
fn gcode_is_the_kernels() {
    let (ours, theirs) = bend();
    let options = minvar_gcode_options {
        plane: minvar_plane::MINVAR_ZX as u32,
        units: minvar_units::MINVAR_INCHES as u32,
        plunge_feed: 10.0,
        comments: 1,
        ..minvar_gcode_defaults(0.02, 40.0, 3.0)
    };
    let mut text = String::new();
    let mut summary = Room::new(1);
    works(|error| unsafe {
        let context = (&raw mut text).cast();
        minvar_write_gcode(&ours, 1, &options, Some(write), context, summary.start(), error)
    });
    let kernels = GcodeOptions {
        plane: Plane::Zx,
        units: Units::Inches,
        plunge_feed: Some(10.0),
        comments: true,
        ..GcodeOptions::new(0.02, 40.0, 3.0)
    };
    let mut known = String::new();
    let found = toolpath::write_gcode(std::slice::from_ref(&theirs), &kernels, &mut known).expect("a chain");
    assert_eq!(text, known);
    let summary: minvar_gcode_summary = summary.one();
    assert_eq!((summary.lines, summary.arcs, summary.chords), (found.lines, found.arcs, found.chords));
    assert_eq!((summary.length, summary.minutes), (found.length, found.minutes));
    assert_eq!(summary.deviation, found.deviation);
    assert_eq!(summary.lines, text.lines().count());

    // By chords, to a caller that does not want the summary.
    let options = minvar_gcode_options { motion: minvar_motion::MINVAR_CHORDS as u32, ..options };
    let kernels = GcodeOptions { motion: Motion::Chords, ..kernels };
    (text, known) = (String::new(), String::new());
    works(|error| unsafe {
        let context = (&raw mut text).cast();
        minvar_write_gcode(&ours, 1, &options, Some(write), context, null_mut(), error)
    });
    toolpath::write_gcode(std::slice::from_ref(&theirs), &kernels, &mut known).expect("a chain");
    assert_eq!(text, known);
}
