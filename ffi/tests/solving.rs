//! Curves solved, updated and searched for minima, in memory that fits exactly: the kernel's bits.

use crate::memory::{Room, bits, figures, works};
use kernel::curve::{
    self as kernels, Continuity, Curve, Element, Joint, Obstacle, Options, Quantity, Reference,
};
use kernel::curve::{Functional, Region, Side};
use kernel::solve::{Record, Silent, Status};
use minvar_ffi::minvar_code::MINVAR_OK;
use minvar_ffi::minvar_given::{MINVAR_FIXED, MINVAR_SIZE};
use minvar_ffi::minvar_status::{MINVAR_CONVERGED, MINVAR_ITERATION_LIMIT};
use minvar_ffi::*;
use std::ptr::{null, null_mut};

/// Options that keep a solve short.
pub(crate) fn options() -> minvar_options {
    minvar_options { quadrature_points: 12, relative_decrease: 1e-7, ..minvar_options_defaults() }
}

fn kernels_options() -> Options {
    Options { quadrature_points: 12, relative_decrease: 1e-7, ..Options::DEFAULT }
}

/// The coving of thesis section 4.11.5: from the wall, straight up, to the ceiling.
pub(crate) fn coving() -> [minvar_joint; 2] {
    let wall =
        minvar_joint_with_tangent(minvar_joint_at(0.5, -12.0, 0.0), MINVAR_FIXED as u32, 0.0, 1.0, 0.0);
    let ceiling = minvar_joint_at(20.0, -0.5, 0.0);
    [
        minvar_joint_with_curvature(wall, MINVAR_FIXED as u32, 0.27, 0.0, 0.0),
        minvar_joint_with_tangent(ceiling, MINVAR_FIXED as u32, 1.0, 0.0, 0.0),
    ]
}

fn kernels_coving() -> [Joint; 2] {
    let wall = Joint::at([0.5, -12.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0]));
    let ceiling = Joint::at([20.0, -0.5, 0.0]);
    [
        wall.with_curvature(Quantity::fixed([0.27, 0.0, 0.0])),
        ceiling.with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ]
}

/// What a solve wrote.
pub(crate) struct Solved {
    pub(crate) elements: Vec<minvar_element>,
    records: Vec<minvar_record>,
    report: minvar_report,
}

/// How many records are asked for: fewer than there are iterations.
const RECORDS: usize = 3;

/// Solves in memory of just the length that the library asks for, none of it written.
pub(crate) fn solved(curve: &minvar_curve, options: &minvar_options) -> Solved {
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(curve, options, len.start(), error) });
    let mut workspace = Room::<f64>::new(len.one());
    let most = unsafe { minvar_curve_elements_len(curve, options) };
    let (mut elements, mut records, mut report) = (Room::new(most), Room::new(RECORDS), Room::new(1));
    works(|error| unsafe {
        minvar_curve_solve(
            curve,
            options,
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            elements.start(),
            elements.len(),
            records.start(),
            records.len(),
            report.start(),
            error,
        )
    });
    let report = report.one();
    Solved {
        elements: elements.written(report.elements).to_vec(),
        records: records.written(report.iterations.min(RECORDS)).to_vec(),
        report,
    }
}

fn solved_by_kernel(curve: &Curve<'_>, options: &Options) -> (Vec<Element>, Vec<Record>, kernels::Report) {
    let mut workspace = vec![0.0; kernels::workspace_len(curve, options).expect("good data")];
    let mut elements = vec![Element::ZERO; kernels::elements_len(curve, options)];
    let mut records = vec![Record::ZERO; RECORDS];
    let report = kernels::solve(curve, options, &mut workspace, &mut elements, &mut records, &mut Silent)
        .expect("good data");
    elements.truncate(report.elements);
    records.truncate(report.iterations.min(RECORDS));
    (elements, records, report)
}

fn element_bits(elements: &[Element]) -> Vec<[[u64; 3]; 6]> {
    elements.iter().map(|element| element.rows.map(|row| row.map(f64::to_bits))).collect()
}

fn report_bits(report: &kernels::Report) -> ([usize; 4], [u64; 8]) {
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

/// Solves on either side of the boundary: both end as expected, with the same bits.
fn same(
    ours: (&minvar_curve, &minvar_options),
    theirs: (&Curve<'_>, &Options),
    ends: (minvar_status, Status),
) -> Solved {
    let found = solved(ours.0, ours.1);
    let (elements, records, report) = solved_by_kernel(theirs.0, theirs.1);
    assert_eq!((found.report.status, report.status), ends);
    assert_eq!(bits(&found.elements), element_bits(&elements));
    assert_eq!(figures(&found.report), report_bits(&report));
    assert_eq!(found.report.planar, i32::from(report.planar));
    let ours = found.records.iter().map(|r| [r.value, r.predicted, r.actual, r.gradient, r.step, r.shift]);
    let theirs = records.iter().map(|r| [r.value, r.predicted, r.actual, r.gradient, r.step, r.shift]);
    assert_eq!(ours.map(|r| r.map(f64::to_bits)).collect::<Vec<_>>(), {
        theirs.map(|r| r.map(f64::to_bits)).collect::<Vec<_>>()
    });
    found
}

const CONVERGED: (minvar_status, Status) = (MINVAR_CONVERGED, Status::Converged);
const LIMITED: (minvar_status, Status) = (MINVAR_ITERATION_LIMIT, Status::IterationLimit);

#[test]
fn a_planar_curve_has_the_kernels_bits() {
    let (joints, theirs) = (coving(), kernels_coving());
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let found = same((&curve, &options()), (&Curve::open(&theirs), &kernels_options()), CONVERGED);
    assert_eq!(found.elements[0].rows[0], [0.5, -12.0, 0.0]);
    assert_eq!(found.elements[0].rows[5], [20.0, -0.5, 0.0]);
    assert_eq!(found.report.planar, 1);
}

#[test]
fn a_space_curve_has_the_kernels_bits() {
    let start = minvar_joint_with_tangent(minvar_joint_at(1.0, 0.0, 0.0), MINVAR_FIXED as u32, 0.0, 1.0, 0.4);
    let end = minvar_joint_with_tangent(minvar_joint_at(0.0, 1.0, 0.8), MINVAR_FIXED as u32, -1.0, 0.0, 0.1);
    let end = minvar_joint_with_curvature(end, MINVAR_SIZE as u32, 0.0, -0.9, 0.0);
    let joints = [start, end];
    let theirs = [
        Joint::at([1.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.4])),
        Joint::at([0.0, 1.0, 0.8])
            .with_tangent(Quantity::fixed([-1.0, 0.0, 0.1]))
            .with_curvature(Quantity::of_size([0.0, -0.9, 0.0])),
    ];
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let options = minvar_options { functional: minvar_functional::MINVAR_MEC as u32, ..options() };
    let kernels_options = Options { functional: Functional::MEC, ..kernels_options() };
    let found = same((&curve, &options), (&Curve::open(&theirs), &kernels_options), CONVERGED);
    assert_eq!(found.report.planar, 0);
}

#[test]
fn a_closed_curve_with_sliding_joints_has_the_kernels_bits() {
    let joints = [
        minvar_joint_on_line(minvar_joint_at(0.0, 0.0, 0.0), 1.0, 0.1, 0.0, 1.0, 0.0, 0.0),
        minvar_joint_on_plane(minvar_joint_at(0.0, 0.0, 0.0), -0.5, 0.8, 0.0, 1.0, 1.0, 0.0),
        minvar_joint_with_continuity(minvar_joint_at(-0.4, -0.9, 0.0), minvar_continuity::MINVAR_G1 as u32),
    ];
    let theirs = [
        Joint::at([0.0; 3]).on_line([1.0, 0.1, 0.0], [1.0, 0.0, 0.0]),
        Joint::at([0.0; 3]).on_plane([-0.5, 0.8, 0.0], [1.0, 1.0, 0.0]),
        Joint::at([-0.4, -0.9, 0.0]).with_continuity(Continuity::G1),
    ];
    let curve = minvar_curve_through(joints.as_ptr(), 3, 1);
    // Few iterations: Miri is slow.
    let options = minvar_options { max_iterations: 5, ..options() };
    let kernels_options = Options { max_iterations: 5, ..kernels_options() };
    same((&curve, &options), (&Curve::new(&theirs, true), &kernels_options), LIMITED);
}

#[test]
fn a_reference_shape_is_read_as_the_kernel_reads_it() {
    let (mut joints, mut theirs) = (coving(), kernels_coving());
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let reference = solved(&curve, &options()).elements;
    let elements = reference.iter().map(|element| Element { rows: element.rows }).collect::<Vec<_>>();
    joints[1].position.value[0] = 19.0;
    theirs[1].position.value[0] = 19.0;
    let curve = minvar_curve {
        reference: reference.as_ptr(),
        reference_count: reference.len(),
        reference_weight: 0.5,
        ..minvar_curve_through(joints.as_ptr(), 2, 0)
    };
    let theirs = Curve::open(&theirs).with_reference(Reference { elements: &elements, weight: 0.5 });
    let options = minvar_options { quadrature_points: 0, relative_decrease: 1e-12, ..options() };
    let kernels_options = Options { quadrature_points: 0, relative_decrease: 1e-12, ..kernels_options() };
    let found = same((&curve, &options), (&theirs, &kernels_options), CONVERGED);
    assert!(found.report.iterations > 0, "the reference is no curve through the joints");
}

#[test]
fn obstacles_are_read_as_the_kernel_reads_them() {
    let (joints, theirs) = (coving(), kernels_coving());
    let side = minvar_side::MINVAR_RIGHT as u32;
    let duct = [minvar_obstacle { from: [6.0, -6.0, 0.0], to: [6.0, -6.0, 0.0], clearance: 0.5, side }];
    let theirs_duct = [Obstacle::point([6.0, -6.0, 0.0], 0.5, Side::RIGHT)];
    let curve = minvar_curve {
        obstacles: duct.as_ptr(),
        obstacle_count: 1,
        ..minvar_curve_through(joints.as_ptr(), 2, 0)
    };
    let theirs = Curve::open(&theirs).with_obstacles(&theirs_duct);
    let found = same((&curve, &options()), (&theirs, &kernels_options()), CONVERGED);
    assert!(found.elements.len() > 1, "no contact");
}

#[test]
fn what_lies_beyond_the_results_is_left_alone() {
    let joints = coving();
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let options = minvar_options { elements_per_span: 4, tolerance: 0.5, ..options() };
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(&curve, &options, len.start(), error) });
    let most = unsafe { minvar_curve_elements_len(&curve, &options) };
    assert_eq!(most, 4);
    let mut workspace = Room::<f64>::new(len.one());
    let (mut elements, mut records) = (Room::<minvar_element>::new(most), Room::<minvar_record>::new(40));
    let mut report = Room::<minvar_report>::new(1);
    elements.fill(0xa5);
    records.fill(0xa5);
    workspace.fill(0xff);
    works(|error| unsafe {
        minvar_curve_solve(
            &curve,
            &options,
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            elements.start(),
            elements.len(),
            records.start(),
            records.len(),
            report.start(),
            error,
        )
    });
    let report = report.one();
    assert_eq!(report.status, MINVAR_CONVERGED);
    assert!(report.elements < most && report.iterations < 40, "nothing lies beyond");
    let untouched = u64::from_ne_bytes([0xa5; 8]);
    assert!(
        bits(&elements.written(most)[report.elements..]).iter().flatten().flatten().all(|b| *b == untouched)
    );
    let beyond = &records.written(40)[report.iterations..];
    assert!(
        beyond
            .iter()
            .all(|record| record.value.to_bits() == untouched && record.shift.to_bits() == untouched)
    );
}

#[test]
fn a_solve_without_records_observer_and_error_works() {
    let joints = coving();
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let mut len = Room::new(1);
    let options = options();
    assert_eq!(unsafe { minvar_curve_workspace_len(&curve, &options, len.start(), null_mut()) }, MINVAR_OK);
    let (mut workspace, mut elements) = (Room::<f64>::new(len.one()), Room::<minvar_element>::new(1));
    let mut report = Room::new(1);
    let code = unsafe {
        minvar_curve_solve(
            &curve,
            &options,
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            elements.start(),
            1,
            null_mut(),
            0,
            report.start(),
            null_mut(),
        )
    };
    assert_eq!((code, report.one().status), (MINVAR_OK, MINVAR_CONVERGED));
    let status = report.one().status as u32;
    let sentence = unsafe { std::ffi::CStr::from_ptr(minvar_status_sentence(status)) };
    assert!(sentence.to_bytes().starts_with(b"converged"), "{sentence:?}");
}

/// A wave of three elements, and its joints.
fn wave() -> ([minvar_joint; 4], Vec<minvar_element>) {
    let joints = [[0.0, 0.0], [1.0, 0.8], [2.0, 0.7], [3.0, 0.0]].map(|[x, y]| minvar_joint_at(x, y, 0.0));
    let curve = minvar_curve_through(joints.as_ptr(), 4, 0);
    let found = solved(&curve, &options());
    (joints, found.elements)
}

#[test]
fn a_region_is_updated_in_place_and_the_rest_stays() {
    let (joints, mut elements) = wave();
    let before = bits(&elements);
    let mut inner = [joints[0], joints[1], joints[2]];
    let start = elements.as_mut_ptr();
    works(|error| unsafe { minvar_region_hold(start, 3, 0, 0, 2, inner.as_mut_ptr(), 3, error) });
    let kept = elements.iter().map(|element| Element { rows: element.rows }).collect::<Vec<_>>();
    let theirs = [[0.0, 0.0], [1.0, 0.8], [2.0, 0.7]].map(|[x, y]| Joint::at([x, y, 0.0]));
    let mut held = theirs;
    Region { elements: &kept, closed: false, first: 0, count: 2 }.hold(&mut held).expect("a region");
    for (ours, theirs) in inner.iter().zip(&held) {
        assert_eq!(ours.continuity, theirs.continuity.0);
        assert_eq!(ours.position.value.map(f64::to_bits), theirs.position.value.map(f64::to_bits));
        assert_eq!(ours.curvature[1].value.map(f64::to_bits), theirs.curvature[1].value.map(f64::to_bits));
    }

    inner[1].position.value[1] = 0.9;
    let region = minvar_curve_through(inner.as_ptr(), 3, 0);
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(&region, &options(), len.start(), error) });
    let (mut workspace, mut report) = (Room::<f64>::new(len.one()), Room::<minvar_report>::new(1));
    // Elements 0 and 1 of three: the third is the library's neither to read nor to write.
    let [first, second, third] = &mut elements[..] else { panic!("a wave has three elements") };
    let third_before = *third;
    let mut pair = [*first, *second];
    works(|error| unsafe {
        minvar_curve_update(
            &region,
            &options(),
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            pair.as_mut_ptr(),
            2,
            report.start(),
            error,
        )
    });
    assert_eq!(report.one().status, MINVAR_CONVERGED);
    // The same in the middle of the array.
    let start = elements.as_mut_ptr();
    works(|error| unsafe {
        minvar_curve_update(
            &region,
            &options(),
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            start,
            2,
            report.start(),
            error,
        )
    });
    assert_eq!(bits(&pair), bits(&elements[..2]));
    assert_ne!(bits(&elements)[..2], before[..2]);
    assert_eq!(bits(&elements[2..]), bits(&[third_before]));
}

#[test]
fn minima_are_the_kernels_in_memory_that_nobody_has_written() {
    const MOST: usize = 2;
    let (joints, theirs) = (coving(), kernels_coving());
    let (options, kernels_options) = (options(), kernels_options());
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let mut len = Room::new(1);
    works(|error| unsafe { minvar_curve_workspace_len(&curve, &options, len.start(), error) });
    let mut workspace = Room::<f64>::new(len.one());
    let mut elements = Room::<minvar_element>::new(MOST + 1);
    let (mut reports, mut count) = (Room::<minvar_report>::new(MOST), Room::<usize>::new(1));
    works(|error| unsafe {
        minvar_curve_minima(
            &curve,
            &options,
            workspace.start(),
            workspace.len(),
            None,
            null_mut(),
            elements.start(),
            elements.len(),
            reports.start(),
            MOST,
            count.start(),
            error,
        )
    });
    let found = count.one();
    let curve = Curve::open(&theirs);
    let mut kernels_elements = [Element::ZERO; MOST + 1];
    let mut kernels_workspace = vec![0.0; workspace.len()];
    let (_, _, any) = solved_by_kernel(&curve, &kernels_options);
    let mut kernels_reports = [any; MOST];
    let known = kernels::minima(
        &curve,
        &kernels_options,
        &mut kernels_workspace,
        &mut kernels_elements,
        &mut kernels_reports,
        &mut Silent,
    );
    assert_eq!(Ok(found), known);
    assert!(found >= 1);
    assert_eq!(bits(elements.written(found)), element_bits(&kernels_elements[..found]));
    for (ours, theirs) in reports.written(found).iter().zip(&kernels_reports) {
        assert_eq!((ours.status, figures(ours)), (MINVAR_CONVERGED, report_bits(theirs)));
    }
}

#[test]
fn counting_elements_takes_any_pointer() {
    let joints = coving();
    let (curve, options) = (minvar_curve_through(joints.as_ptr(), 2, 0), options());
    let count = |curve: *const minvar_curve, options: *const minvar_options| unsafe {
        minvar_curve_elements_len(curve, options)
    };
    assert_eq!(count(&curve, &options), 1);
    assert_eq!(count(null(), &options), 0);
    assert_eq!(count(&curve, null()), 0);
    let odd = (&raw const curve).cast::<u8>().wrapping_add(1).cast();
    assert_eq!(count(odd, &options), 0);
    let none = minvar_curve_through(null(), 0, 1);
    assert_eq!(count(&none, &options), 0);
}
