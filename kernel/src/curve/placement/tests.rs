//! Where data lie in a plane and where not, and what becomes of every kind of vector there.

extern crate std;

use super::*;
use crate::curve::joint::Quantity;
use crate::curve::obstacle::{Obstacle, Side};
use std::vec::Vec;

/// Systems that are turned against the coordinates': two axes of a plane and its normal, whose largest coordinate is
/// positive and one time each of them.
fn systems() -> Vec<[Vector3<f64>; 3]> {
    [
        [0.3, -0.4, 0.9],
        [0.8, 0.3, -0.2],
        [-0.3, 0.7, 0.5],
        [0.1, 0.1, 0.1001],
        [1e-5, 1.0, 1e-7],
        [-0.7, -0.1, 0.71],
    ]
    .into_iter()
    .map(|normal| {
        let normal = Vector3::from(normal);
        let normal = normal / sqrt(normal.dot(&normal));
        let across = normal.cross(&Vector3::new(0.6, -0.64, 0.48));
        let first = across / sqrt(across.dot(&across));
        [first, normal.cross(&first), normal]
    })
    .collect()
}

fn planar(curve: &Curve<'_>) -> Option<Placement<2>> {
    match Place::of(curve, 1.0, 0) {
        Ok(Place::Plane(place)) => Some(place),
        _ => None,
    }
}

/// Three joints with all kinds of data that lie in a plane through the origin, each but for what it is raised by; and an
/// obstacle.
fn data(
    [x, y, z]: &[Vector3<f64>; 3],
    origin: Vector3<f64>,
    raised: [f64; 8],
) -> ([Joint; 4], [Obstacle; 1]) {
    let vector = |a: f64, b: f64, up: f64| x * a + y * b + z * up;
    let direction = |a: f64, b: f64, up: f64| -> [f64; 3] { vector(a, b, up).into() };
    let point = |a: f64, b: f64, up: f64| -> [f64; 3] { (origin + vector(a, b, up)).into() };
    let joints = [
        Joint::at(point(0.0, 0.0, 0.0)).with_tangent(Quantity::fixed(direction(3.0, 4.0, raised[0]))),
        Joint::at(point(2.0, 1.0, raised[1]))
            .with_curvature(Quantity::initial(direction(0.3, -0.1, raised[2]))),
        Joint::at([0.0; 3]).on_line(point(4.0, -1.0, raised[3]), direction(1.0, 2.0, raised[4])),
        Joint::at([0.0; 3])
            .with_position(Quantity::initial(point(5.0, 2.0, raised[5])))
            // Nothing to go by: what is free, and what may turn.
            .with_tangent(Quantity { given: Given::FREE, value: [f64::NAN, 1.0, 2.0] })
            .with_curvature(Quantity::of_size([1.0, 2.0, 3.0])),
    ];
    let obstacle = Obstacle::segment(point(1.0, 1.0, raised[6]), point(3.0, 1.0, raised[7]), 0.1, Side::LEFT);
    (joints, [obstacle])
}

#[test]
fn data_in_any_plane_are_planar_and_none_that_leave_it() {
    let origin = Vector3::new(1.0, -2.0, 0.5);
    for system in systems() {
        let normal = system[2];
        let (joints, obstacles) = data(&system, origin, [0.0; 8]);
        let Some(place) = planar(&Curve::open(&joints).with_obstacles(&obstacles)) else {
            panic!("{system:?}")
        };
        let [first, second] = place.axes;
        assert!((first.dot(&first) - 1.0).abs() < 1e-15 && (second.dot(&second) - 1.0).abs() < 1e-15);
        assert!(first.dot(&second).abs() < 1e-15, "{}", first.dot(&second));
        // Right-handed about the normal whose largest coordinate is positive.
        let largest = if normal[normal.iamax()] > 0.0 { normal } else { -normal };
        assert!((first.cross(&second) - largest).amax() < 1e-12, "{system:?}");
        // There and back.
        for joint in &joints {
            let there = place.local_point(&joint.position.value);
            let back = Vector3::from(place.world_point(&there)) - Vector3::from(joint.position.value);
            assert!(back.amax() < 1e-14, "{back}");
            let offset = Vector3::from(joint.position.value) - origin;
            assert!((there.dot(&there) - offset.dot(&offset)).abs() < 1e-13);
        }
        // Each of the data, raised by next to nothing and by a little.
        for which in 0..8 {
            for up in [1e-14, -1e-14, 1e-9, -1e-9] {
                let mut raised = [0.0; 8];
                raised[which] = up;
                let (joints, obstacles) = data(&system, origin, raised);
                let found = planar(&Curve::open(&joints).with_obstacles(&obstacles)).is_some();
                assert_eq!(found, up.abs() < 1e-12, "{system:?} {which} {up}");
            }
        }
    }
}

/// A curvature that bends next to nothing over the data's extent has a direction that is rounding, and so have coordinates
/// far from the origin. A tangent is exact wherever it is: where it leaves the plane that rounded points tell, space keeps
/// it as it was given.
#[test]
fn what_is_rounding_does_not_leave_a_plane() {
    for system in systems() {
        let (mut joints, _) = data(&system, Vector3::zeros(), [0.0; 8]);
        for (size, flat) in [(1e-14, true), (1e-9, false)] {
            let curvature: [f64; 3] = (system[2] * size).into();
            joints[1] = joints[1].with_curvature(Quantity::fixed(curvature));
            assert_eq!(planar(&Curve::open(&joints)).is_some(), flat, "{system:?} {size}");
        }
        let far = Vector3::new(1e6, -3e6, 2e6);
        let points = |up: f64| -> [Joint; 4] {
            let (joints, _) = data(&system, far, [0.0, up, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            joints.map(|joint| Joint::at(joint.position.value))
        };
        let rounded = points(0.0);
        assert!(planar(&Curve::open(&rounded)).is_some(), "{system:?}");
        assert!(planar(&Curve::open(&points(1e-7))).is_none(), "{system:?}");
        let mut directed = rounded;
        directed[2] = directed[2].with_tangent(Quantity::fixed(system[0].into()));
        directed[3] = directed[3].with_tangent(Quantity::fixed(system[1].into()));
        if let Some(place) = planar(&Curve::open(&directed)) {
            let normal = place.axes[0].cross(&place.axes[1]);
            assert!(normal.dot(&system[0]).abs() < 2e-12 && normal.dot(&system[1]).abs() < 2e-12);
        }
    }
}

#[test]
fn a_coordinate_plane_keeps_its_axes() {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    for system in [[x, y, z], [y, z, x], [z, x, y]] {
        let (joints, _) = data(&system, Vector3::new(1.0, 2.0, 3.0), [0.0; 8]);
        let Some(place) = planar(&Curve::open(&joints)) else { panic!("{system:?}") };
        assert_eq!(place.axes, [system[0], system[1]]);
        let [a, b] = [place.local_point(&joints[1].position.value), place.local_direction(&[2.0, 2.0, 2.0])];
        assert!([a[0], a[1]] == [2.0, 1.0] && (b[0] - sqrt(0.5)).abs() < 1e-15, "{a} {b}");
    }
}

#[test]
fn data_on_a_line_lie_in_some_plane_through_it() {
    for system in systems() {
        for along in system {
            let joints = [0.0, 1.0, -2.5].map(|step| Joint::at((along * step).into()));
            let Some(place) = planar(&Curve::open(&joints)) else { panic!("{along}") };
            let [first, second] = place.axes;
            assert!((first.dot(&along).abs() - 1.0).abs() < 1e-14, "{first} {along}");
            assert!(first.dot(&second).abs() < 1e-15 && (second.dot(&second) - 1.0).abs() < 1e-15);
            let normal = first.cross(&second);
            assert!(normal[normal.iamax()] > 0.0, "{normal}");
        }
    }
}

#[test]
fn a_place_is_the_caller_s_choice_where_the_data_allow_it() {
    let flat = [[0.0; 3], [1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [3.0, 3.0, 0.0]].map(Joint::at);
    let mut bent = flat;
    bent[3] = Joint::at([3.0, 3.0, 0.1]);
    let of = |joints: &[Joint], dimension: u32| Place::of(&Curve::open(joints), 1.0, dimension);
    assert!(matches!(of(&flat, 0), Ok(Place::Plane(_))) && matches!(of(&flat, 2), Ok(Place::Plane(_))));
    assert!(matches!(of(&bent, 0), Ok(Place::Space(_))) && matches!(of(&bent, 3), Ok(Place::Space(_))));
    let Ok(Place::Space(place)) = of(&flat, 3) else { panic!("space was asked for") };
    assert_eq!(place.axes, [Vector3::x(), Vector3::y(), Vector3::z()]);
    assert!(matches!(of(&bent, 2), Err(CurveError::NotPlanar)));
}

/// The origin is the first joint that is given, and lengths, vectors and curvatures scale each in its way.
#[test]
fn a_local_system_has_its_unit_and_its_origin() {
    let joints = [
        Joint::at([9.0; 3]).with_position(Quantity { given: Given::FREE, value: [9.0; 3] }),
        Joint::at([1.0, 2.0, 3.0]),
        Joint::at([5.0, 2.0, 3.0]),
        Joint::at([5.0, 6.0, 3.5]),
        Joint::at([0.0, 6.0, 7.0]),
    ];
    let Ok(Place::Space(place)) = Place::of(&Curve::open(&joints), 4.0, 0) else { panic!("space") };
    let numbers = |v: SVector<f64, 3>| [v[0], v[1], v[2]];
    assert_eq!(numbers(place.local_point(&[5.0, 2.0, 5.0])), [1.0, 0.0, 0.5]);
    assert_eq!(numbers(place.local_vector(&[4.0, -8.0, 2.0])), [1.0, -2.0, 0.5]);
    assert_eq!(numbers(place.local_curvature(&[0.5, 0.25, -1.0])), [2.0, 1.0, -4.0]);
    assert_eq!(numbers(place.local_direction(&[0.0, -3.0, 4.0])), [0.0, -0.6, 0.8]);
    assert!(place.local_length(6.0) == 1.5 && place.local_size(&[3.0, 0.0, 4.0]) == 20.0);
    assert_eq!(place.world_point(&SVector::from([1.0, 0.0, 0.5])), [5.0, 2.0, 5.0]);
    assert_eq!(place.world_vector(&SVector::from([1.0, -2.0, 0.5])), [4.0, -8.0, 2.0]);
    let element =
        Element { rows: [[5.0, 2.0, 3.0], [4.0; 3], [8.0; 3], [12.0; 3], [16.0; 3], [1.0, 2.0, 7.0]] };
    let rows = place.local_rows(&element).map(numbers);
    assert_eq!(rows, [[1.0, 0.0, 0.0], [1.0; 3], [2.0; 3], [3.0; 3], [4.0; 3], [0.0, 0.0, 1.0]]);
}

#[test]
fn a_joint_slides_along_its_line_and_across_its_plane_s_normal() {
    for system in systems() {
        let (joints, _) = data(&system, Vector3::zeros(), [0.0; 8]);
        let Some(place) = planar(&Curve::open(&joints)) else { panic!("{system:?}") };
        let Ok(Place::Space(space)) = Place::of(&Curve::open(&joints), 1.0, 3) else { panic!("space") };
        let guide = system[0] * 3.0 + system[1];
        let tilted = guide + system[2] * 2.0;
        let world = |v: Option<SVector<f64, 2>>| v.map(|v| Vector3::from(place.world_vector(&v)));
        let unit = |v: Vector3<f64>| v / sqrt(v.dot(&v));

        let line = Joint::at([0.0; 3]).on_line([0.0; 3], guide.into());
        let Some(along) = world(place.slide(&line, 0)) else { panic!("a line") };
        assert!((along - unit(guide)).amax() < 1e-14, "{along}");
        assert!(place.slide(&line, 1).is_none() && space.slide(&line, 1).is_none());
        let Some(along) = space.slide(&line, 0) else { panic!("a line") };
        assert!((along - unit(guide)).amax() < 1e-15, "{along}");

        // In the plane: along the line in which its plane and the curve's meet.
        let plane = Joint::at([0.0; 3]).on_plane([0.0; 3], tilted.into());
        let Some(along) = world(place.slide(&plane, 0)) else { panic!("a plane") };
        assert!(along.dot(&tilted).abs() < 1e-14 && (along.dot(&along) - 1.0).abs() < 1e-14, "{along}");
        assert!(along.dot(&system[2]).abs() < 1e-14);
        assert!(place.slide(&plane, 1).is_none());
        // A joint whose plane is the curve's is free.
        let whole = Joint::at([0.0; 3]).on_plane([0.0; 3], (system[2] * 2.0).into());
        assert!(place.slide(&whole, 0).is_none());
        for joint in [plane, whole] {
            let (Some(first), Some(second)) = (space.slide(&joint, 0), space.slide(&joint, 1)) else {
                panic!("two")
            };
            let normal = unit(Vector3::from(joint.guide));
            assert!((first.dot(&first) - 1.0).abs() < 1e-14 && (second.dot(&second) - 1.0).abs() < 1e-14);
            assert!(first.dot(&second).abs() < 1e-15, "{first} {second}");
            assert!(first.dot(&normal).abs() < 1e-15 && second.dot(&normal).abs() < 1e-15);
        }
    }
}
