//! Places of a chain and its other forms, in memory that fits exactly: the kernel's bits.

use crate::memory::{Room, works};
use kernel::curve::{CurvePoint, Element, Joint, convert, measure};
use minvar_ffi::minvar_code::MINVAR_OK;
use minvar_ffi::*;
use std::ffi::CStr;
use std::ptr::null_mut;

/// Two elements, as C and the kernel have them: exactly as long as they are.
fn chain() -> (Box<[minvar_element]>, Vec<Element>) {
    let elements: Box<[minvar_element]> = [
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.2],
            [0.0, 1.0, 0.0],
            [0.0, 0.5, 0.0],
            [1.0, 1.0, 0.2],
            [1.0, 0.5, 0.2],
        ],
        [
            [1.0, 0.5, 0.2],
            [1.0, 1.0, 0.2],
            [0.0, 0.5, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [2.0, 1.7, 0.3],
        ],
    ]
    .map(|rows| minvar_element { rows })
    .into();
    let theirs = elements.iter().map(|element| Element { rows: element.rows }).collect();
    (elements, theirs)
}

fn place_bits(found: &minvar_point) -> (usize, [u64; 14]) {
    let [x, y, z] = found.point;
    let [tx, ty, tz] = found.tangent;
    let [kx, ky, kz] = found.curvature;
    let rest = [found.signed_curvature, found.curvature_derivative, found.torsion];
    let numbers =
        [found.parameter, found.arc_length, x, y, z, tx, ty, tz, kx, ky, kz, rest[0], rest[1], rest[2]];
    (found.element, numbers.map(f64::to_bits))
}

fn kernels_place_bits(found: &CurvePoint) -> (usize, [u64; 14]) {
    let [x, y, z] = found.point;
    let [tx, ty, tz] = found.tangent;
    let [kx, ky, kz] = found.curvature;
    let rest = [found.signed_curvature, found.curvature_derivative, found.torsion];
    let numbers =
        [found.parameter, found.arc_length, x, y, z, tx, ty, tz, kx, ky, kz, rest[0], rest[1], rest[2]];
    (found.element, numbers.map(f64::to_bits))
}

#[test]
fn places_are_the_kernels() {
    let (ours, theirs) = chain();
    let (start, count) = (ours.as_ptr(), ours.len());
    let mut place = Room::new(1);
    works(|error| unsafe { minvar_point_at(start, count, 1, 0.25, place.start(), error) });
    let at = measure::at(&theirs, 1, 0.25).expect("a place");
    assert_eq!(place_bits(&place.one()), kernels_place_bits(&at));

    works(|error| unsafe { minvar_point_at_length(start, count, 1.5, place.start(), error) });
    let at = measure::at_length(&theirs, 1.5).expect("a place");
    assert_eq!(place_bits(&place.one()), kernels_place_bits(&at));

    works(|error| unsafe { minvar_closest_point(start, count, 1.2, 0.4, 0.0, place.start(), error) });
    let at = measure::closest(&theirs, [1.2, 0.4, 0.0]).expect("a place");
    assert_eq!(place_bits(&place.one()), kernels_place_bits(&at));
    assert_eq!(
        unsafe { minvar_closest_point(start, count, 1.2, 0.4, 0.0, place.start(), null_mut()) },
        MINVAR_OK
    );
}

#[test]
fn a_joint_held_at_a_place_is_the_kernels() {
    let (ours, theirs) = chain();
    let mut place = Room::new(1);
    works(|error| unsafe { minvar_point_at(ours.as_ptr(), 2, 0, 1.0, place.start(), error) });
    let held = minvar_joint_held_at(place.one());
    let known = Joint::held_at(&measure::at(&theirs, 0, 1.0).expect("a place"));
    assert_eq!(held.continuity, known.continuity.0);
    assert_eq!(held.guide, known.guide);
    let quantities = [held.position, held.tangent[0], held.tangent[1], held.curvature[0], held.curvature[1]];
    let [t0, t1] = known.tangent;
    let [k0, k1] = known.curvature;
    for (ours, theirs) in quantities.iter().zip([known.position, t0, t1, k0, k1]) {
        assert_eq!(ours.given, theirs.given.0);
        assert_eq!(ours.value.map(f64::to_bits), theirs.value.map(f64::to_bits));
    }
    assert_eq!(held.position.value, [1.0, 0.5, 0.2]);
}

#[test]
fn the_figures_of_a_chain_are_the_kernels() {
    let (ours, theirs) = chain();
    let mut figures = Room::new(1);
    works(|error| unsafe { minvar_measure(ours.as_ptr(), ours.len(), figures.start(), error) });
    let found: minvar_figures = figures.one();
    let [least, largest] = measure::curvature_range(&theirs).expect("a chain");
    let [low, high] = measure::bounding_box(&theirs).expect("a chain");
    assert_eq!(place_bits(&found.least_curvature), kernels_place_bits(&least));
    assert_eq!(place_bits(&found.largest_curvature), kernels_place_bits(&largest));
    assert_eq!((found.box_low, found.box_high), (low, high));
    let known = [measure::length(&theirs), measure::variation(&theirs), measure::bending(&theirs)];
    assert_eq!([found.length, found.variation, found.bending].map(f64::to_bits), known.map(f64::to_bits));
}

#[test]
fn control_points_and_knots_fill_arrays_that_fit_exactly() {
    let (ours, theirs) = chain();
    let (start, count) = (ours.as_ptr(), ours.len());
    let mut bezier = Room::<[[f64; 3]; 6]>::new(1);
    works(|error| unsafe { minvar_element_bezier(start, bezier.start(), error) });
    assert_eq!(bezier.one(), theirs[0].bezier());
    // Six points of the caller's, as an array of numbers has them: they need no more alignment than numbers.
    let mut numbers = Room::<f64>::new(18);
    works(|error| unsafe { minvar_element_bezier(start, numbers.start().cast(), error) });
    assert_eq!(numbers.written(18), theirs[0].bezier().as_flattened());

    let (mut control_count, mut knot_count) = (Room::new(1), Room::new(1));
    works(|error| unsafe {
        minvar_bspline_len(start, count, control_count.start(), knot_count.start(), error)
    });
    assert_eq!((control_count.one(), knot_count.one()), convert::bspline_len(&theirs));
    let (mut controls, mut knots) = (Room::<[f64; 3]>::new(control_count.one()), Room::new(knot_count.one()));
    works(|error| unsafe {
        minvar_bspline(start, count, controls.start(), controls.len(), knots.start(), knots.len(), error)
    });
    let (mut known_controls, mut known_knots) = (vec![[0.0; 3]; controls.len()], vec![0.0; knots.len()]);
    convert::bspline(&theirs, &mut known_controls, &mut known_knots).expect("a chain");
    assert_eq!(controls.written(controls.len()), known_controls);
    assert_eq!(knots.written(knots.len()), known_knots);
}

#[test]
fn no_elements_have_no_control_points() {
    let (mut control_count, mut knot_count) = (Room::new(1), Room::new(1));
    works(|error| unsafe {
        minvar_bspline_len(null_mut(), 0, control_count.start(), knot_count.start(), error)
    });
    assert_eq!((control_count.one(), knot_count.one()), (0, 0));
}

#[test]
fn texts_end() {
    let version = unsafe { CStr::from_ptr(minvar_version()) };
    assert_eq!(version.to_bytes(), env!("CARGO_PKG_VERSION").as_bytes());
    assert_eq!((minvar_abi_check(MINVAR_ABI), minvar_abi_check(MINVAR_ABI + 1)), (1, 0));
    let sentences: Vec<_> =
        (0..7).map(|status| unsafe { CStr::from_ptr(minvar_status_sentence(status)) }).collect();
    assert_eq!(sentences[6].to_bytes(), b"unknown status");
    assert!((1..7).all(|k| !sentences[..k].contains(&sentences[k])), "{sentences:?}");
    let defaults = minvar_gcode_defaults(0.01, 100.0, 5.0);
    assert_eq!(
        (defaults.tolerance, defaults.feed, defaults.safe_height, defaults.decimals),
        (0.01, 100.0, 5.0, 6)
    );
}
