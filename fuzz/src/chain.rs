//! The functions of the C boundary that take a chain of elements: measuring, converting, paths. Any elements, of any numbers.

use crate::answer::{Answer, TURNS, ask};
use crate::coder::{Coder, Reading};
use crate::data;
use crate::memory::{Fault, Room};
use crate::result::elements_of;
use minvar::curve::Element;
use minvar_ffi::minvar_code::{self, *};
use minvar_ffi::*;
use minvar_tests::curves::{Vector, derivatives, distance};
use std::cell::RefCell;
use std::ffi::{c_char, c_void};

const MEASURE: [minvar_code; 3] = [MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR];
const PLACE: [minvar_code; 4] =
    [MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_IRREGULAR, MINVAR_OUT_OF_RANGE];
const BSPLINE: [minvar_code; 4] =
    [MINVAR_NO_ELEMENTS, MINVAR_ELEMENT_NOT_FINITE, MINVAR_RESULT_TOO_SHORT, MINVAR_IRREGULAR];
const CHORDS: [minvar_code; 6] = [
    MINVAR_BAD_TOLERANCE,
    MINVAR_TOLERANCE_TOO_FINE,
    MINVAR_NO_ELEMENTS,
    MINVAR_ELEMENT_NOT_FINITE,
    MINVAR_GAP,
    MINVAR_STOPPED,
];
const GCODE: [minvar_code; 15] = [
    MINVAR_BAD_TOLERANCE,
    MINVAR_TOLERANCE_TOO_FINE,
    MINVAR_NO_ELEMENTS,
    MINVAR_ELEMENT_NOT_FINITE,
    MINVAR_GAP,
    MINVAR_STOPPED,
    MINVAR_PATH_NOT_PLANAR,
    MINVAR_IRREGULAR,
    MINVAR_BAD_OPTION,
    MINVAR_BAD_DECIMALS,
    MINVAR_BAD_FEED,
    MINVAR_BAD_PLUNGE_FEED,
    MINVAR_BAD_DEPTH,
    MINVAR_BAD_SAFE_HEIGHT,
    MINVAR_COORDINATE_TOO_LARGE,
];

/// No path is followed for longer: an input has a second or two.
const MOST_MOVES: usize = 30;
/// No program is taken for longer.
const MOST_BYTES: usize = 1_500;

/// Everything that one input says.
#[derive(Clone)]
pub struct Case {
    /// The chain.
    pub chain: Vec<minvar_element>,
    /// An element's number.
    pub element: u32,
    /// A parameter.
    pub t: f64,
    /// An arc length, in lengths of the chain.
    pub s: f64,
    /// A point.
    pub point: [f64; 3],
    /// A path's tolerance.
    pub tolerance: f64,
    /// A program's options.
    pub gcode: minvar_gcode_options,
    /// Which pointer is wrong, if any.
    pub fault: u8,
    /// How much longer or shorter than needed memory is.
    pub room: u8,
    /// After how many moves or pieces of text the caller stops.
    pub stop: u8,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            chain: Vec::new(),
            element: 0,
            t: 0.0,
            s: 0.0,
            point: [0.0; 3],
            tolerance: 0.0,
            gcode: minvar_gcode_defaults(0.0, 0.0, 0.0),
            fault: 0,
            room: 0,
            stop: 0,
        }
    }
}

impl Case {
    /// The fields in order.
    pub fn code<C: Coder>(&mut self, c: &mut C) {
        data::elements(c, &mut self.chain, 5);
        c.byte(&mut self.fault);
        c.byte(&mut self.room);
        c.byte(&mut self.stop);
        c.one_of(&mut self.element, &[0, 1, 2, 3, 4, 5, u32::MAX]);
        c.number_of(&mut self.t, &[0.0, 1.0, 0.5, 0.25, 1.0 + f64::EPSILON, -5e-324, f64::NAN]);
        c.number_of(&mut self.s, &[0.0, 1.0, 0.5, 1.0 + 1e-10, -1e-10, 2.0, f64::NAN]);
        c.vector(&mut self.point);
        c.number_of(&mut self.tolerance, &[0.01, 1e-3, 1e-6, 1.0, 1e-12, 0.0]);
        let gcode = &mut self.gcode;
        c.number_of(&mut gcode.tolerance, &[0.01, 1e-3, 1e-4, 1.0, 1e-9, 0.0]);
        c.number_of(&mut gcode.feed, &[600.0, 1e-7, 0.0, -1.0, 1e9]);
        c.number_of(&mut gcode.plunge_feed, &[0.0, 0.0, 100.0, -1.0]);
        c.number_of(&mut gcode.safe_height, &[100.0, 1e6, 0.0, 1e-7]);
        c.number_of(&mut gcode.depth, &[0.0, -2.0, 1.0, 1e9]);
        c.one_of(&mut gcode.units, &[0, 0, 1, 2]);
        c.one_of(&mut gcode.plane, &[0, 0, 1, 2, 3]);
        c.one_of(&mut gcode.motion, &[0, 0, 1, 2]);
        c.one_of(&mut gcode.decimals, &[6, 6, 7, 8, 9, 5, 10, 262]);
        let mut comments = gcode.comments as u32;
        c.one_of(&mut comments, &[0, 1, 0x8000_0000]);
        gcode.comments = comments as i32;
    }
}

/// Runs an input.
pub fn run(bytes: &[u8]) {
    let mut case = Case::default();
    case.code(&mut Reading::new(bytes));
    if crate::shows() {
        case.chain.iter().for_each(|element| eprintln!("element {:?}", element.rows));
        let g = &case.gcode;
        eprintln!("element {}, t {:e}, s {:e}, point {:?}", case.element, case.t, case.s, case.point);
        eprintln!(
            "tolerance {:e}; program: tolerance {:e}, feed {:e}, plunge {:e}",
            case.tolerance, g.tolerance, g.feed, g.plunge_feed
        );
        eprintln!(
            "safe height {:e}, depth {:e}, {} {} {} {}",
            g.safe_height, g.depth, g.units, g.plane, g.motion, g.decimals
        );
        eprintln!("fault {}, room {}, stop {}", case.fault, case.room, case.stop);
    }
    case.check();
}

/// Calls twice what gives one result: the same bits, or untouched where there is an error.
fn output<T: Copy>(
    fault: &Fault,
    name: &'static str,
    listed: &[minvar_code],
    call: impl Fn(*mut T, *mut minvar_error) -> minvar_code,
) -> Result<T, Answer> {
    let mut before: Option<(Answer, Vec<u8>, Result<T, Answer>)> = None;
    for turn in TURNS {
        fault.begin();
        let mut room = Room::<T>::one(turn.fill);
        let at = fault.pointer(5, name, room.pointer());
        let answer = ask(turn, fault, listed, |error| call(at, error));
        let (found, written) = if answer.is_ok() {
            // SAFETY: the call wrote it.
            (Ok(unsafe { room.first(1)[0] }), room.bytes().to_vec())
        } else {
            assert!(room.is_untouched(), "{answer:?}, but {name} was written");
            (Err(answer.clone()), Vec::new())
        };
        if let Some((earlier, bits, _)) = &before {
            earlier.same(&answer);
            assert!(*bits == written, "the same call gave other bits");
        }
        before = Some((answer, written, found));
    }
    before.expect("there are two turns").2
}

/// Whether arithmetic with these numbers neither overflows nor vanishes.
fn is_tame(chain: &[minvar_element]) -> bool {
    chain.iter().flat_map(|e| e.rows).flatten().all(|x| x == 0.0 || (1e-40..=1e40).contains(&x.abs()))
}

/// The largest coordinate of control points.
fn size(chain: &[Element]) -> f64 {
    chain.iter().flat_map(|e| e.bezier()).flatten().fold(0.0, |most, x| x.abs().max(most))
}

fn is_number(point: &minvar_point) -> bool {
    let figures = [
        point.parameter,
        point.arc_length,
        point.signed_curvature,
        point.curvature_derivative,
        point.torsion,
    ];
    !figures.iter().chain(&point.point).chain(&point.tangent).chain(&point.curvature).any(|x| x.is_nan())
}

impl Case {
    /// Makes all calls and holds them to what is promised.
    pub fn check(&self) {
        let fault = &Fault::new(self.fault);
        self.measure(fault);
        self.convert(fault);
        self.paths(fault);
        self.program(fault);
    }

    /// The chain as an argument, in memory that lives as long as `room`.
    fn argument(&self, room: &mut Room<minvar_element>, fault: &Fault) -> (*mut minvar_element, usize) {
        fault.array(3, "elements", room.pointer(), room.len())
    }

    fn measure(&self, fault: &Fault) {
        let chain = elements_of(&self.chain);
        let tame = is_tame(&self.chain);
        let size = size(&chain);
        let room = &RefCell::new(Room::of(&self.chain));
        let argument = || self.argument(&mut room.borrow_mut(), fault);
        // SAFETY, here and below: every pointer is NULL, misaligned, or to room of just the length that is said.
        let figures = output(fault, "figures", &MEASURE, |out, error| {
            let (at, count) = argument();
            unsafe { minvar_measure(at, count, out, error) }
        });
        let length = figures.as_ref().map_or(f64::NAN, |figures| figures.length);
        if let Ok(figures) = &figures {
            let sums = [figures.length, figures.variation, figures.bending];
            assert!(sums.iter().all(|x| *x >= 0.0), "{sums:?}");
            assert!(!tame || figures.length.is_finite(), "{sums:?}");
            let range = [&figures.least_curvature, &figures.largest_curvature];
            assert!(range.iter().all(|place| is_number(place)), "a place of extreme curvature is NaN");
            assert!(range[0].signed_curvature <= range[1].signed_curvature);
            for (place, d) in samples(&chain).flat_map(|place| (0..3).map(move |d| (place, d))) {
                let slack = 1e-12 * size;
                let inside =
                    figures.box_low[d] - slack <= place[d] && place[d] <= figures.box_high[d] + slack;
                assert!(!tame || inside, "{place:?} is outside the box");
            }
        }
        let element = if self.element == u32::MAX { usize::MAX } else { self.element as usize };
        let place = output(fault, "point", &PLACE, |out, error| {
            let (at, count) = argument();
            unsafe { minvar_point_at(at, count, element, self.t, out, error) }
        });
        if let Ok(place) = &place {
            assert!(element < chain.len() && (0.0..=1.0).contains(&self.t));
            assert_eq!((place.element, place.parameter), (element, self.t));
            assert!(is_number(place), "a place is NaN");
            let tangent = place.tangent.iter().map(|x| x * x).sum::<f64>();
            assert!((tangent - 1.0).abs() < 1e-12, "a tangent of length² {tangent}");
            let there = derivatives(&chain[element], self.t)[0];
            assert!(!tame || distance(there, place.point) <= 1e-13 * size, "{there:?} {:?}", place.point);
            // Any place gives a joint; nothing is checked there.
            let joint = minvar_joint_held_at(*place);
            assert_eq!((joint.continuity, joint.position.given, joint.position.value), (2, 2, place.point));
        }
        let s = self.s * if length.is_finite() { length } else { 1.0 };
        let place = output(fault, "point", &PLACE, |out, error| {
            let (at, count) = argument();
            unsafe { minvar_point_at_length(at, count, s, out, error) }
        });
        if let Ok(place) = &place {
            assert!(
                place.element < chain.len() && (0.0..=1.0).contains(&place.parameter) && is_number(place)
            );
            // Not `clamp`: the length may be NaN.
            let off = (place.arc_length - s.max(0.0).min(length)).abs();
            assert!(
                !tame || length.is_nan() || off <= 1e-8 * length,
                "{off:e} from arc length {s:e} of {length:e}"
            );
        }
        let [x, y, z] = self.point;
        let place = output(fault, "point", &PLACE, |out, error| {
            let (at, count) = argument();
            unsafe { minvar_closest_point(at, count, x, y, z, out, error) }
        });
        if let Ok(place) = &place {
            assert!(
                place.element < chain.len() && (0.0..=1.0).contains(&place.parameter) && is_number(place)
            );
            let found = distance(place.point, self.point);
            let least =
                samples(&chain).map(|sample| distance(sample, self.point)).fold(f64::INFINITY, f64::min);
            let far = self.point.iter().fold(size, |most, x| x.abs().max(most));
            let fine = tame && far <= 1e40;
            assert!(
                !fine || found <= least + 1e-9 * far,
                "{found:e} is the closest, but {least:e} away is another"
            );
        }
    }

    fn convert(&self, fault: &Fault) {
        let room = &RefCell::new(Room::of(&self.chain));
        let argument = || self.argument(&mut room.borrow_mut(), fault);
        if let Some(first) = self.chain.first() {
            let one = &RefCell::new(Room::of(&[*first]));
            let points = output(fault, "points", &[], |out, error| {
                let one_at = fault.pointer(0, "element", one.borrow_mut().pointer());
                unsafe { minvar_element_bezier(one_at, out, error) }
            });
            if let Ok(points) = points {
                let bits = |x: [f64; 3]| x.map(f64::to_bits);
                assert!(bits(points[0]) == bits(first.rows[0]) && bits(points[5]) == bits(first.rows[5]));
            }
        }
        let lens = output::<[usize; 2]>(fault, "control_count", &[], |out, error| {
            let knots = out.cast::<usize>();
            let knots =
                if out.is_null() || !out.is_aligned() { std::ptr::null_mut() } else { knots.wrapping_add(1) };
            let (at, count) = argument();
            unsafe { minvar_bspline_len(at, count, out.cast(), knots, error) }
        });
        let Ok([controls_needed, knots_needed]) = lens else { return };
        let none = self.chain.is_empty();
        assert!(if none { knots_needed == 0 } else { knots_needed == controls_needed + 6 });
        assert!(controls_needed <= 5 * self.chain.len() + 1);
        let room_of = |needed: usize, choice: u8| match choice % 4 {
            1 => needed.saturating_sub(1),
            2 => needed + 2,
            _ => needed,
        };
        let given = [room_of(controls_needed, self.room), room_of(knots_needed, self.room / 4)];
        let mut before: Option<(Answer, Vec<u8>)> = None;
        for turn in TURNS {
            fault.begin();
            let (at, count) = argument();
            let mut controls = Room::<[f64; 3]>::new(given[0], turn.fill);
            let mut knots = Room::<f64>::new(given[1], turn.fill);
            let (controls_at, controls_len) = fault.array(1, "controls", controls.pointer(), controls.len());
            let (knots_at, knots_len) = fault.array(2, "knots", knots.pointer(), knots.len());
            let answer = ask(turn, fault, &BSPLINE, |error| unsafe {
                minvar_bspline(at, count, controls_at, controls_len, knots_at, knots_len, error)
            });
            let mut written = Vec::new();
            if answer.is_ok() {
                assert!(controls.is_untouched_from(controls_needed) && knots.is_untouched_from(knots_needed));
                // SAFETY: any bytes are numbers.
                let knots = unsafe { knots.first(knots_needed) };
                assert!(knots.is_sorted() && knots[0] == 0.0 && knots[knots_needed - 1] == 1.0, "{knots:?}");
                // SAFETY: as above.
                let points = unsafe { controls.first(controls_needed) };
                let finite = points.iter().flatten().all(|x| x.is_finite());
                assert!(finite || !is_tame(&self.chain), "{points:?}");
                written.extend(knots.iter().chain(points.iter().flatten()).flat_map(|x| x.to_le_bytes()));
            } else {
                assert!(
                    controls.is_untouched() && knots.is_untouched(),
                    "{answer:?}, but results were written"
                );
            }
            if let Some((earlier, bits)) = &before {
                earlier.same(&answer);
                assert!(*bits == written, "the same call gave other bits");
            }
            before = Some((answer, written));
        }
    }

    fn paths(&self, fault: &Fault) {
        let mut arcs_list = CHORDS.to_vec();
        arcs_list.extend([MINVAR_PATH_NOT_PLANAR, MINVAR_IRREGULAR]);
        type Function = unsafe extern "C" fn(
            *const minvar_element,
            usize,
            f64,
            minvar_visitor,
            *mut c_void,
            *mut minvar_error,
        ) -> minvar_code;
        let visit: unsafe extern "C" fn(*mut c_void, *const minvar_move) -> i32 = visit;
        for (function, listed) in
            [(minvar_chords as Function, &CHORDS[..]), (minvar_arcs as Function, &arcs_list)]
        {
            let mut before: Option<(Answer, Vec<u64>)> = None;
            for turn in TURNS {
                fault.begin();
                let visitor_of = fault.function(10, "visit", visit);
                let mut room = Room::of(&self.chain);
                let (at, count) = self.argument(&mut room, fault);
                let visitor = Visitor { stops_after: self.most(MOST_MOVES), moves: RefCell::default() };
                let context = (&raw const visitor).cast_mut().cast::<c_void>();
                let answer = ask(turn, fault, listed, |error| unsafe {
                    function(at, count, self.tolerance, visitor_of, context, error)
                });
                let moves = visitor.moves.take();
                let stopped = moves.len() > visitor.stops_after;
                assert_eq!(stopped, answer.code == MINVAR_STOPPED, "{answer:?} after {} moves", moves.len());
                assert!(answer.is_ok() || stopped || moves.is_empty(), "{answer:?} after the first move");
                self.moves(&moves, answer.is_ok());
                let bits: Vec<u64> = moves
                    .iter()
                    .flat_map(|m| m.end.into_iter().chain(m.centre).chain([m.deviation, m.turn.into()]))
                    .map(f64::to_bits)
                    .collect();
                if let Some((earlier, others)) = &before {
                    earlier.same(&answer);
                    assert!(*others == bits, "the same call gave other moves");
                }
                before = Some((answer, bits));
            }
        }
    }

    /// How much a caller takes: mostly all.
    fn most(&self, all: usize) -> usize {
        if self.stop >= 128 { usize::from(self.stop - 128) } else { all }
    }

    fn moves(&self, moves: &[minvar_move], all: bool) {
        for one in moves {
            let finite = one.end.iter().chain(&one.centre).all(|x| x.is_finite());
            assert!(finite, "a move is not finite");
            assert!(
                (0.0..=self.tolerance).contains(&one.deviation),
                "{} of {}",
                one.deviation,
                self.tolerance
            );
            assert!((-1..=1).contains(&one.turn));
            assert!(one.turn != 0 || one.centre == [0.0; 3], "a line with a centre");
        }
        if all && let (Some(last), Some(element)) = (moves.last(), self.chain.last()) {
            let off = distance(last.end, element.rows[5]);
            assert!(off <= self.tolerance, "the path ends {off:e} from the end of the chain");
        }
    }

    fn program(&self, fault: &Fault) {
        let mut before: Option<(Answer, Vec<u8>, Vec<u8>)> = None;
        for turn in TURNS {
            fault.begin();
            let mut room = Room::of(&self.chain);
            let (at, count) = self.argument(&mut room, fault);
            let mut options = Room::of(&[self.gcode]);
            let options_at = fault.pointer(1, "options", options.pointer());
            let paper = Paper {
                stops_after: self.most(usize::MAX),
                text: RefCell::default(),
                pieces: RefCell::new(0),
            };
            let context = (&raw const paper).cast_mut().cast::<c_void>();
            let write: unsafe extern "C" fn(*mut c_void, *const c_char, usize) -> i32 = write;
            let writer = fault.function(10, "write", write);
            let mut summary = Room::<minvar_gcode_summary>::one(turn.fill);
            let wanted = self.room < 128;
            let summary_at = match (wanted, fault.is_misaligned(5)) {
                (false, _) => std::ptr::null_mut(),
                (true, true) => fault.pointer(5, "summary", summary.pointer()),
                (true, false) => summary.pointer(),
            };
            let answer = ask(turn, fault, &GCODE, |error| unsafe {
                minvar_write_gcode(at, count, options_at, writer, context, summary_at, error)
            });
            let text = paper.text.take();
            let begun = *paper.pieces.borrow() > 0;
            let stopped = *paper.pieces.borrow() > paper.stops_after || text.len() > MOST_BYTES;
            assert_eq!(stopped, answer.code == MINVAR_STOPPED, "{answer:?}");
            assert!(answer.is_ok() || stopped || !begun, "{answer:?} after the first character");
            let printable = |byte: &u8| *byte == b'\n' || (b' '..=b'~').contains(byte);
            assert!(text.iter().all(printable), "text that is not ASCII");
            let mut written = Vec::new();
            if answer.is_ok() {
                assert!(text.ends_with(b"M2\n") || self.gcode.comments != 0);
                assert!(text.ends_with(b"\n"));
                if wanted {
                    // SAFETY: the call wrote it.
                    let found = unsafe { summary.first(1)[0] };
                    assert_eq!(found.lines, text.iter().filter(|byte| **byte == b'\n').count());
                    let figures = [found.length, found.minutes, found.deviation];
                    assert!(figures.iter().all(|x| x.is_finite() && *x >= 0.0), "{figures:?}");
                    assert!(found.deviation <= self.gcode.tolerance);
                    written = summary.bytes().to_vec();
                }
            } else {
                assert!(summary.is_untouched(), "{answer:?}, but a summary was written");
            }
            if let Some((earlier, bytes, others)) = &before {
                earlier.same(&answer);
                assert!(*bytes == text && *others == written, "the same call gave another program");
            }
            before = Some((answer, text, written));
        }
    }
}

/// Places of a chain, 17 an element.
fn samples(chain: &[Element]) -> impl Iterator<Item = Vector> + '_ {
    chain.iter().flat_map(|element| (0..=16).map(|k| derivatives(element, f64::from(k) / 16.0)[0]))
}

struct Visitor {
    stops_after: usize,
    moves: RefCell<Vec<minvar_move>>,
}

unsafe extern "C" fn visit(context: *mut c_void, step: *const minvar_move) -> i32 {
    // SAFETY: the context is the visitor, which outlives the call; the step is the library's.
    let (visitor, step) = unsafe { (&*context.cast::<Visitor>(), *step) };
    let mut moves = visitor.moves.borrow_mut();
    assert!(moves.len() <= visitor.stops_after, "called again after it said stop");
    moves.push(step);
    if moves.len() > visitor.stops_after { -1 } else { 0 }
}

struct Paper {
    stops_after: usize,
    text: RefCell<Vec<u8>>,
    pieces: RefCell<usize>,
}

unsafe extern "C" fn write(context: *mut c_void, text: *const c_char, length: usize) -> i32 {
    // SAFETY: the context is the paper, which outlives the call; the text is the library's, so many bytes.
    let (paper, piece) =
        unsafe { (&*context.cast::<Paper>(), std::slice::from_raw_parts(text.cast::<u8>(), length)) };
    *paper.pieces.borrow_mut() += 1;
    let pieces = *paper.pieces.borrow();
    let mut text = paper.text.borrow_mut();
    assert!(pieces <= paper.stops_after.saturating_add(1) && text.len() <= MOST_BYTES, "called after stop");
    text.extend(piece);
    i32::from(pieces > paper.stops_after || text.len() > MOST_BYTES)
}
