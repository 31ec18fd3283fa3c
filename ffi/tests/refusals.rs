//! Every pointer of every function NULL, misaligned, or of a length that no memory has: refused by its name, whatever
//! else is given, and nothing written.

use crate::memory::{Room, misaligned, refused};
use crate::paths::bend;
use crate::solving::{coving, options};
use minvar_ffi::minvar_code::*;
use minvar_ffi::*;
use std::ffi::{c_char, c_void};
use std::ptr::{null, null_mut};

/// The way in which one pointer is wrong; the other pointers stay as they are.
#[derive(Clone, Copy)]
enum Fault {
    Null,
    Misaligned,
    TooLong,
}

impl Fault {
    fn code(self) -> minvar_code {
        match self {
            Self::Null => MINVAR_NULL_POINTER,
            Self::Misaligned => MINVAR_MISALIGNED,
            Self::TooLong => MINVAR_TOO_LONG,
        }
    }

    /// The pointer, and its length.
    fn of<T>(self, pointer: *mut T, len: usize) -> (*mut T, usize) {
        match self {
            Self::Null => (null_mut(), len),
            Self::Misaligned => (misaligned(pointer), len),
            Self::TooLong => (pointer, isize::MAX as usize / size_of::<T>() + 1),
        }
    }

    fn of_const<T>(self, pointer: *const T, len: usize) -> (*const T, usize) {
        let (pointer, len) = self.of(pointer.cast_mut(), len);
        (pointer, len)
    }
}

const ARRAY: [Fault; 3] = [Fault::Null, Fault::Misaligned, Fault::TooLong];
const ONE: [Fault; 2] = [Fault::Null, Fault::Misaligned];

/// What the functions of a curve take, all good.
#[derive(Clone, Copy)]
struct Arguments {
    curve: *const minvar_curve,
    options: *const minvar_options,
    workspace: (*mut f64, usize),
    elements: (*mut minvar_element, usize),
    records: (*mut minvar_record, usize),
    reports: (*mut minvar_report, usize),
    count: *mut usize,
}

impl Arguments {
    fn solve(self, error: *mut minvar_error) -> minvar_code {
        let Self { curve, options, workspace, elements, records, reports, .. } = self;
        // SAFETY: every pointer is good or known to be bad.
        unsafe {
            minvar_curve_solve(
                curve,
                options,
                workspace.0,
                workspace.1,
                None,
                null_mut(),
                elements.0,
                elements.1,
                records.0,
                records.1,
                reports.0,
                error,
            )
        }
    }

    fn update(self, error: *mut minvar_error) -> minvar_code {
        let Self { curve, options, workspace: (work, len), elements, reports, .. } = self;
        // SAFETY: every pointer is good or known to be bad.
        unsafe {
            minvar_curve_update(
                curve,
                options,
                work,
                len,
                None,
                null_mut(),
                elements.0,
                elements.1,
                reports.0,
                error,
            )
        }
    }

    fn minima(self, error: *mut minvar_error) -> minvar_code {
        let Self { curve, options, workspace, elements, reports, count, .. } = self;
        // SAFETY: every pointer is good or known to be bad.
        unsafe {
            minvar_curve_minima(
                curve,
                options,
                workspace.0,
                workspace.1,
                None,
                null_mut(),
                elements.0,
                elements.1,
                reports.0,
                reports.1,
                count,
                error,
            )
        }
    }

    fn workspace_len(self, error: *mut minvar_error) -> minvar_code {
        // SAFETY: every pointer is good or known to be bad.
        unsafe { minvar_curve_workspace_len(self.curve, self.options, self.count, error) }
    }
}

/// The results of the functions of a curve, which nobody may touch.
struct Results {
    workspace: Room<f64>,
    elements: Room<minvar_element>,
    records: Room<minvar_record>,
    reports: Room<minvar_report>,
    count: Room<usize>,
}

const PATTERN: u8 = 0xa5;

impl Results {
    fn new() -> Self {
        let mut results = Self {
            workspace: Room::new(8),
            elements: Room::new(2),
            records: Room::new(1),
            reports: Room::new(1),
            count: Room::new(1),
        };
        results.elements.fill(PATTERN);
        results.records.fill(PATTERN);
        results.reports.fill(PATTERN);
        results.count.fill(PATTERN);
        results
    }

    fn arguments(&mut self, curve: &minvar_curve, options: &minvar_options) -> Arguments {
        Arguments {
            curve,
            options,
            workspace: (self.workspace.start(), self.workspace.len()),
            elements: (self.elements.start(), self.elements.len()),
            records: (self.records.start(), self.records.len()),
            reports: (self.reports.start(), self.reports.len()),
            count: self.count.start(),
        }
    }

    fn untouched(&self) -> bool {
        let results = self.elements.is_all(PATTERN) && self.records.is_all(PATTERN);
        results && self.reports.is_all(PATTERN) && self.count.is_all(PATTERN)
    }
}

type Call = fn(Arguments, *mut minvar_error) -> minvar_code;
const CALLS: [Call; 4] = [Arguments::solve, Arguments::update, Arguments::minima, Arguments::workspace_len];
const SOLVES: [Call; 3] = [Arguments::solve, Arguments::update, Arguments::minima];

#[test]
fn wrong_pointers_of_a_curve_are_refused_by_name() {
    let joints = coving();
    let reference = [bend().0];
    let obstacles =
        [minvar_obstacle { from: [6.0, -6.0, 0.0], to: [6.0, -6.0, 0.0], clearance: 0.5, side: 0 }];
    let (curve, options) = (minvar_curve_through(joints.as_ptr(), 2, 0), options());
    let mut results = Results::new();
    let good = results.arguments(&curve, &options);
    for fault in ONE {
        for call in CALLS {
            let bad = Arguments { curve: fault.of_const(&curve, 1).0, ..good };
            refused(fault.code(), "argument curve ", |error| call(bad, error));
            let bad = Arguments { options: fault.of_const(&options, 1).0, ..good };
            refused(fault.code(), "argument options ", |error| call(bad, error));
        }
        let bad = Arguments { reports: (fault.of(good.reports.0, 1).0, 1), ..good };
        refused(fault.code(), "argument report ", |error| bad.solve(error));
        refused(fault.code(), "argument report ", |error| bad.update(error));
        let bad = Arguments { count: fault.of(good.count, 1).0, ..good };
        refused(fault.code(), "argument count ", |error| bad.minima(error));
        refused(fault.code(), "argument len ", |error| bad.workspace_len(error));
    }
    for fault in ARRAY {
        for call in CALLS {
            let (joints, joint_count) = fault.of_const(joints.as_ptr(), 2);
            let bad = minvar_curve { joints, joint_count, ..curve };
            let bad = Arguments { curve: &bad, ..good };
            refused(fault.code(), "argument curve->joints ", |error| call(bad, error));
            let (reference, reference_count) = fault.of_const(reference.as_ptr(), 1);
            let bad = minvar_curve { reference, reference_count, ..curve };
            let bad = Arguments { curve: &bad, ..good };
            refused(fault.code(), "argument curve->reference ", |error| call(bad, error));
            let (obstacles, obstacle_count) = fault.of_const(obstacles.as_ptr(), 1);
            let bad = minvar_curve { obstacles, obstacle_count, ..curve };
            let bad = Arguments { curve: &bad, ..good };
            refused(fault.code(), "argument curve->obstacles ", |error| call(bad, error));
        }
        for call in SOLVES {
            let bad = Arguments { workspace: fault.of(good.workspace.0, good.workspace.1), ..good };
            refused(fault.code(), "argument workspace ", |error| call(bad, error));
            let bad = Arguments { elements: fault.of(good.elements.0, good.elements.1), ..good };
            refused(fault.code(), "argument elements ", |error| call(bad, error));
        }
        let bad = Arguments { records: fault.of(good.records.0, good.records.1), ..good };
        refused(fault.code(), "argument records ", |error| bad.solve(error));
        let bad = Arguments { reports: fault.of(good.reports.0, good.reports.1), ..good };
        refused(fault.code(), "argument reports ", |error| bad.minima(error));
    }
    assert!(results.untouched());
}

#[test]
fn arrays_of_no_entries_may_be_anywhere() {
    let joints = coving();
    let (curve, options) = (minvar_curve_through(joints.as_ptr(), 2, 0), options());
    let mut results = Results::new();
    let good = results.arguments(&curve, &options);
    for fault in ONE {
        let workspace = (fault.of(good.workspace.0, 0).0, 0);
        for call in SOLVES {
            let (_, needed, given) = refused(MINVAR_WORKSPACE_TOO_SMALL, "workspace", |error| {
                call(Arguments { workspace, ..good }, error)
            });
            assert!(needed > 100 && given == 0);
        }
        let elements = (fault.of(good.elements.0, 0).0, 0);
        for call in SOLVES {
            let short = refused(MINVAR_RESULT_TOO_SHORT, "elements", |error| {
                call(Arguments { elements, ..good }, error)
            });
            assert!(short.1 >= 1 && short.2 == 0, "{short:?}");
        }
        let none = minvar_curve { joints: fault.of_const(joints.as_ptr(), 0).0, joint_count: 0, ..curve };
        for call in CALLS {
            let few = refused(MINVAR_TOO_FEW_JOINTS, "two joints", |error| {
                call(Arguments { curve: &none, ..good }, error)
            });
            assert_eq!(few, (0, 2, 0));
        }
    }
    assert!(results.untouched());
}

#[test]
fn wrong_pointers_to_a_chain_are_refused_by_name() {
    type Call = fn((*const minvar_element, usize), *mut minvar_error) -> minvar_code;
    unsafe extern "C" fn visit(_: *mut c_void, _: *const minvar_move) -> i32 {
        unreachable!("nothing to visit")
    }
    unsafe extern "C" fn write(_: *mut c_void, _: *const c_char, _: usize) -> i32 {
        unreachable!("nothing to write")
    }
    // All else is good; a result that is written would be out of a variable's life, which Miri sees.
    let calls: [Call; 9] = [
        |(start, count), error| unsafe { minvar_measure(start, count, Room::new(1).start(), error) },
        |(start, count), error| unsafe { minvar_point_at(start, count, 0, 0.5, Room::new(1).start(), error) },
        |(start, count), error| unsafe {
            minvar_point_at_length(start, count, 0.5, Room::new(1).start(), error)
        },
        |(start, count), error| unsafe {
            minvar_closest_point(start, count, 0.0, 0.0, 0.0, Room::new(1).start(), error)
        },
        |(start, count), error| unsafe {
            let (mut controls, mut knots) = (Room::new(6), Room::new(12));
            minvar_bspline(start, count, controls.start(), 6, knots.start(), 12, error)
        },
        |(start, count), error| unsafe { minvar_chords(start, count, 0.1, Some(visit), null_mut(), error) },
        |(start, count), error| unsafe { minvar_arcs(start, count, 0.1, Some(visit), null_mut(), error) },
        |(start, count), error| unsafe {
            let options = minvar_gcode_defaults(0.1, 1.0, 3.0);
            minvar_write_gcode(start, count, &options, Some(write), null_mut(), null_mut(), error)
        },
        |(start, count), error| unsafe {
            let mut joints = coving();
            minvar_region_hold(start, count, 0, 0, 1, joints.as_mut_ptr(), 2, error)
        },
    ];
    let bend = bend().0;
    for (k, call) in calls.into_iter().enumerate() {
        for fault in ARRAY {
            refused(fault.code(), "argument elements ", |error| call(fault.of_const(&bend, 1), error));
        }
        for fault in ONE {
            let (nobody, _) = fault.of_const(&bend, 0);
            let (wanted, word) = match k {
                8 => (MINVAR_BAD_REGION, "region"),
                _ => (MINVAR_NO_ELEMENTS, "no elements"),
            };
            refused(wanted, word, |error| call((nobody, 0), error));
        }
    }
    for fault in ARRAY {
        refused(fault.code(), "argument elements ", |error| unsafe {
            let (start, count) = fault.of_const(&bend, 1);
            let (mut controls, mut knots) = (Room::new(1), Room::new(1));
            minvar_bspline_len(start, count, controls.start(), knots.start(), error)
        });
    }
    for fault in ONE {
        refused(fault.code(), "argument element ", |error| unsafe {
            minvar_element_bezier(fault.of_const(&bend, 1).0, Room::new(1).start(), error)
        });
    }
}

#[test]
fn wrong_pointers_to_results_are_refused_by_name() {
    let bend = bend().0;
    let start: *const minvar_element = &bend;
    let mut place = Room::<minvar_point>::new(1);
    let mut figures = Room::<minvar_figures>::new(1);
    let mut bezier = Room::<[[f64; 3]; 6]>::new(1);
    let (mut controls, mut knots) = (Room::<[f64; 3]>::new(6), Room::<f64>::new(12));
    let (mut control_count, mut knot_count) = (Room::<usize>::new(1), Room::<usize>::new(1));
    let mut joints = coving();
    place.fill(PATTERN);
    controls.fill(PATTERN);
    knots.fill(PATTERN);
    control_count.fill(PATTERN);
    for fault in ONE {
        let (wrong, _) = fault.of(place.start(), 1);
        refused(fault.code(), "argument point ", |error| unsafe {
            minvar_point_at(start, 1, 0, 0.5, wrong, error)
        });
        refused(fault.code(), "argument point ", |error| unsafe {
            minvar_point_at_length(start, 1, 0.5, wrong, error)
        });
        refused(fault.code(), "argument point ", |error| unsafe {
            minvar_closest_point(start, 1, 0.0, 0.0, 0.0, wrong, error)
        });
        let (wrong, _) = fault.of(figures.start(), 1);
        refused(fault.code(), "argument figures ", |error| unsafe { minvar_measure(start, 1, wrong, error) });
        let (wrong, _) = fault.of(bezier.start(), 1);
        refused(fault.code(), "argument points ", |error| unsafe {
            minvar_element_bezier(start, wrong, error)
        });
        let (wrong, _) = fault.of(control_count.start(), 1);
        refused(fault.code(), "argument control_count ", |error| unsafe {
            minvar_bspline_len(start, 1, wrong, knot_count.start(), error)
        });
        let (wrong, _) = fault.of(knot_count.start(), 1);
        refused(fault.code(), "argument knot_count ", |error| unsafe {
            minvar_bspline_len(start, 1, control_count.start(), wrong, error)
        });
    }
    for fault in ARRAY {
        let (wrong, len) = fault.of(controls.start(), 6);
        refused(fault.code(), "argument controls ", |error| unsafe {
            minvar_bspline(start, 1, wrong, len, knots.start(), 12, error)
        });
        let (wrong, len) = fault.of(knots.start(), 12);
        refused(fault.code(), "argument knots ", |error| unsafe {
            minvar_bspline(start, 1, controls.start(), 6, wrong, len, error)
        });
        let (wrong, len) = fault.of(joints.as_mut_ptr(), 2);
        refused(fault.code(), "argument joints ", |error| unsafe {
            minvar_region_hold(start, 1, 0, 0, 1, wrong, len, error)
        });
    }
    // One entry too few.
    let short = refused(MINVAR_RESULT_TOO_SHORT, "controls", |error| unsafe {
        minvar_bspline(start, 1, controls.start(), 5, knots.start(), 12, error)
    });
    assert_eq!(short, (0, 6, 5));
    let short = refused(MINVAR_RESULT_TOO_SHORT, "knots", |error| unsafe {
        minvar_bspline(start, 1, controls.start(), 6, knots.start(), 11, error)
    });
    assert_eq!(short, (0, 12, 11));
    assert!(place.is_all(PATTERN) && controls.is_all(PATTERN) && knots.is_all(PATTERN));
    assert!(control_count.is_all(PATTERN));
}

#[test]
fn missing_functions_and_options_are_refused_by_name() {
    unsafe extern "C" fn write(_: *mut c_void, _: *const c_char, _: usize) -> i32 {
        unreachable!("nothing to write")
    }
    let bend = bend().0;
    let options = minvar_gcode_defaults(0.1, 1.0, 3.0);
    refused(MINVAR_NULL_POINTER, "argument visit ", |error| unsafe {
        minvar_chords(&bend, 1, 0.1, None, null_mut(), error)
    });
    refused(MINVAR_NULL_POINTER, "argument visit ", |error| unsafe {
        minvar_arcs(&bend, 1, 0.1, None, null_mut(), error)
    });
    refused(MINVAR_NULL_POINTER, "argument write ", |error| unsafe {
        minvar_write_gcode(&bend, 1, &options, None, null_mut(), null_mut(), error)
    });
    refused(MINVAR_NULL_POINTER, "argument options ", |error| unsafe {
        minvar_write_gcode(&bend, 1, null(), Some(write), null_mut(), null_mut(), error)
    });
    let mut summary = Room::new(1);
    refused(MINVAR_MISALIGNED, "argument summary ", |error| unsafe {
        let summary = misaligned(summary.start());
        minvar_write_gcode(&bend, 1, &options, Some(write), null_mut(), summary, error)
    });
    let unknown = minvar_gcode_options { plane: 3, ..options };
    let (index, ..) = refused(MINVAR_BAD_OPTION, "plane", |error| unsafe {
        minvar_write_gcode(&bend, 1, &unknown, Some(write), null_mut(), null_mut(), error)
    });
    assert_eq!(index, 6);
    refused(MINVAR_NULL_POINTER, "argument elements ", |error| unsafe {
        minvar_write_gcode(null(), 1, &unknown, Some(write), null_mut(), null_mut(), error)
    });
}
