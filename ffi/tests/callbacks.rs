//! The caller's functions: what they get lives while they run, their context comes back untouched, they may call the
//! library again, and what they answer stops the work.

use crate::memory::{Room, refused, works};
use crate::paths::bend;
use crate::solving::{coving, options, solved};
use minvar_ffi::minvar_code::{MINVAR_OK, MINVAR_STOPPED};
use minvar_ffi::minvar_status::{MINVAR_CANCELLED, MINVAR_CONVERGED};
use minvar_ffi::*;
use std::ffi::{c_char, c_void};
use std::ptr::null_mut;

/// What an observer knows.
struct Watcher {
    stop_at: usize,
    seen: Vec<f64>,
    /// Measured anew at every iteration, in other memory than the solve's.
    beside: [minvar_element; 1],
    lengths: Vec<f64>,
}

impl Watcher {
    fn new(stop_at: usize) -> Self {
        Self { stop_at, seen: Vec::new(), beside: [bend().0], lengths: Vec::new() }
    }
}

unsafe extern "C" fn observe(context: *mut c_void, iteration: usize, record: *const minvar_record) -> i32 {
    // SAFETY: the tests give a watcher as the context; the library a record that lives as long as this call.
    let (watcher, record) = unsafe { (&mut *context.cast::<Watcher>(), *record) };
    watcher.seen.push(record.value);
    assert_eq!(iteration, watcher.seen.len());
    let mut figures = Room::<minvar_figures>::new(1);
    works(|error| unsafe { minvar_measure(watcher.beside.as_ptr(), 1, figures.start(), error) });
    watcher.lengths.push(figures.one().length);
    i32::from(iteration == watcher.stop_at)
}

/// Solves the coving under observation; the elements, the records and the report.
fn watched(watcher: &mut Watcher) -> (minvar_element, Vec<f64>, minvar_report) {
    let joints = coving();
    let (curve, options) = (minvar_curve_through(joints.as_ptr(), 2, 0), options());
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(&curve, &options, len.start(), error) });
    let (mut workspace, mut elements) = (Room::<f64>::new(len.one()), Room::new(1));
    let (mut records, mut report) = (Room::<minvar_record>::new(60), Room::<minvar_report>::new(1));
    works(|error| unsafe {
        minvar_curve_solve(
            &curve,
            &options,
            workspace.start(),
            workspace.len(),
            Some(observe),
            (&raw mut *watcher).cast(),
            elements.start(),
            1,
            records.start(),
            records.len(),
            report.start(),
            error,
        )
    });
    let report = report.one();
    let values = records.written(report.iterations).iter().map(|record| record.value).collect();
    (elements.one(), values, report)
}

#[test]
fn an_observer_sees_every_record_and_may_call_the_library() {
    let mut watcher = Watcher::new(0);
    let (_, values, report) = watched(&mut watcher);
    assert_eq!(report.status, MINVAR_CONVERGED);
    assert_eq!(watcher.seen, values);
    assert_eq!(watcher.lengths.len(), values.len());
    assert!(watcher.lengths.windows(2).all(|pair| pair[0] == pair[1]) && watcher.lengths[0] > 1.4);
}

#[test]
fn an_observer_that_stops_leaves_a_curve_through_the_joints() {
    let mut watcher = Watcher::new(2);
    let (element, _, report) = watched(&mut watcher);
    assert_eq!((report.status, report.iterations, watcher.seen.len()), (MINVAR_CANCELLED, 2, 2));
    assert_eq!((element.rows[0], element.rows[5]), ([0.5, -12.0, 0.0], [20.0, -0.5, 0.0]));
}

#[test]
fn updates_and_minima_are_observed() {
    let joints = coving();
    let (curve, options) = (minvar_curve_through(joints.as_ptr(), 2, 0), options());
    let mut elements: Box<[minvar_element]> = solved(&curve, &options).elements.into();
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(&curve, &options, len.start(), error) });
    let (mut workspace, mut report) = (Room::<f64>::new(len.one()), Room::<minvar_report>::new(1));
    let mut watcher = Watcher::new(1);
    let context: *mut c_void = (&raw mut watcher).cast();
    works(|error| unsafe {
        let (elements, report) = (elements.as_mut_ptr(), report.start());
        let (workspace, len) = (workspace.start(), workspace.len());
        minvar_curve_update(
            &curve,
            &options,
            workspace,
            len,
            Some(observe),
            context,
            elements,
            1,
            report,
            error,
        )
    });
    assert_eq!((report.one().status, watcher.seen.len()), (MINVAR_CANCELLED, 1));

    let mut watcher = Watcher::new(1);
    let context: *mut c_void = (&raw mut watcher).cast();
    let (mut elements, mut reports, mut count) = (Room::new(2), Room::<minvar_report>::new(1), Room::new(1));
    works(|error| unsafe {
        let (elements, reports, count) = (elements.start(), reports.start(), count.start());
        let (work, len) = (workspace.start(), workspace.len());
        minvar_curve_minima(
            &curve,
            &options,
            work,
            len,
            Some(observe),
            context,
            elements,
            2,
            reports,
            1,
            count,
            error,
        )
    });
    assert_eq!((count.one(), watcher.seen.len()), (0, 1));
}

/// How many calls are answered with 0, and how many came.
struct Patience {
    left: usize,
    calls: usize,
}

impl Patience {
    /// # Safety
    /// The context is one of these.
    unsafe fn spend(context: *mut c_void) -> i32 {
        // SAFETY: promised by the caller.
        let patience = unsafe { &mut *context.cast::<Self>() };
        patience.calls += 1;
        i32::from(patience.calls > patience.left)
    }
}

unsafe extern "C" fn visit(context: *mut c_void, step: *const minvar_move) -> i32 {
    // SAFETY: the library gives a move.
    assert!(unsafe { (*step).deviation } <= 0.02);
    // SAFETY: the tests give a patience.
    unsafe { Patience::spend(context) }
}

unsafe extern "C" fn print(context: *mut c_void, text: *const c_char, length: usize) -> i32 {
    // SAFETY: the library gives that many bytes.
    assert!(unsafe { std::slice::from_raw_parts(text.cast::<u8>(), length) }.is_ascii());
    // SAFETY: the tests give a patience.
    unsafe { Patience::spend(context) }
}

#[test]
fn visitors_and_writers_stop_the_work() {
    let (bend, options) = (bend().0, minvar_gcode_defaults(0.02, 40.0, 3.0));
    let mut summary = Room::<minvar_gcode_summary>::new(1);
    for left in [0, 1, 5] {
        let mut patience = Patience { left, calls: 0 };
        let context: *mut c_void = (&raw mut patience).cast();
        let code = unsafe { minvar_chords(&bend, 1, 0.001, Some(visit), context, null_mut()) };
        assert_eq!((code, patience.calls), (MINVAR_STOPPED, left + 1));

        let mut patience = Patience { left: left.min(1), calls: 0 };
        let context: *mut c_void = (&raw mut patience).cast();
        let code = unsafe { minvar_arcs(&bend, 1, 0.001, Some(visit), context, null_mut()) };
        assert_eq!((code, patience.calls), (MINVAR_STOPPED, left.min(1) + 1));

        summary.fill(0xa5);
        let mut patience = Patience { left, calls: 0 };
        let context: *mut c_void = (&raw mut patience).cast();
        let code = unsafe {
            minvar_write_gcode(&bend, 1, &options, Some(print), context, summary.start(), null_mut())
        };
        assert_eq!((code, patience.calls), (MINVAR_STOPPED, left + 1));
        assert!(summary.is_all(0xa5));
    }
}

#[test]
fn a_context_is_never_looked_at() {
    unsafe extern "C" fn same(context: *mut c_void, _: *const minvar_move) -> i32 {
        i32::from(context.addr() != 17)
    }
    let bend = bend().0;
    let nowhere: *mut c_void = std::ptr::without_provenance_mut(17);
    assert_eq!(unsafe { minvar_chords(&bend, 1, 0.1, Some(same), nowhere, null_mut()) }, MINVAR_OK);
    assert_eq!(unsafe { minvar_arcs(&bend, 1, 0.1, Some(same), nowhere, null_mut()) }, MINVAR_OK);
    let stopped = refused(MINVAR_STOPPED, "visitor", |error| unsafe {
        minvar_chords(&bend, 1, 0.1, Some(same), null_mut(), error)
    });
    assert_eq!(stopped, (0, 0, 0));
}
