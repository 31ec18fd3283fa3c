//! Bad input: an error that names the culprit, found before any work; or a status. Never a panic, never a number that
//! is none.

use minvar::curve::{
    Continuity, Curve, CurveError, Element, Functional, Given, Joint, OptionName, Options, Part, Quantity,
    Report, elements_len, solve, workspace_len,
};
use minvar::solve::{Control, Observer, Record, Silent, Status};
use minvar_tests::curves::{MARKER, add, deviation, distance, end_shape, norm, solve_curve, times};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::time::Instant;

/// Three joints to which nothing can be objected.
fn good() -> Vec<Joint> {
    vec![
        Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0])),
        Joint::at([1.0, 0.5, 0.0]),
        Joint::at([2.0, 0.0, 0.0])
            .with_tangent(Quantity::fixed([0.0, -1.0, 0.0]))
            .with_continuity(Continuity::G1),
    ]
}

/// Solves with elements of markers; they must be left alone by an error.
fn attempt(joints: &[Joint], closed: bool, options: &Options) -> (Result<Report, CurveError>, Vec<Element>) {
    let curve = Curve::new(joints, closed);
    let asked = workspace_len(&curve, options);
    let mut workspace = vec![f64::NAN; asked.unwrap_or(100_000)];
    let mut elements = vec![MARKER; elements_len(&curve, options).min(100_000)];
    let result = solve(&curve, options, &mut workspace, &mut elements, &mut [], &mut Silent);
    if let Err(error) = result {
        // What only the start values show, the first call cannot find.
        let late = matches!(error, CurveError::CurvatureNeedsTangent { .. });
        assert!(asked == Err(error) || (late && asked.is_ok()), "both calls find the same error: {asked:?}");
        assert!(elements.iter().all(|element| *element == MARKER), "an error writes nothing");
    } else {
        assert!(asked.is_ok());
    }
    (result, elements)
}

#[track_caller]
fn refused(joints: &[Joint], closed: bool, options: &Options, error: CurveError, words: &[&str]) {
    assert_eq!(attempt(joints, closed, options).0, Err(error));
    let message = error.to_string();
    for word in words {
        assert!(message.contains(word), "“{message}” does not say “{word}”");
    }
}

#[track_caller]
fn refuses(joints: &[Joint], error: CurveError, words: &[&str]) {
    refused(joints, false, &Options::DEFAULT, error, words);
}

#[test]
fn good_data_are_not_refused() {
    let (result, elements) = attempt(&good(), false, &Options::DEFAULT);
    assert_eq!(result.map(|report| report.status), Ok(Status::Converged));
    assert!(elements.iter().all(|element| *element != MARKER));
    assert_eq!(
        attempt(&good(), true, &Options::DEFAULT).0.map(|report| report.status),
        Ok(Status::Converged)
    );
}

#[test]
fn fewer_than_two_joints_are_refused() {
    refuses(&[], CurveError::TooFewJoints { given: 0 }, &["two", "0 given"]);
    refuses(&good()[..1], CurveError::TooFewJoints { given: 1 }, &["two", "1 given"]);
}

#[test]
fn a_closed_curve_of_two_joints_or_fewer_is_refused() {
    for given in 0..=2 {
        let error = CurveError::ClosedTooFewJoints { given };
        let words = ["closed", "three", &format!("{given} given")];
        refused(&good()[..given], true, &Options::DEFAULT, error, &words);
    }
}

#[test]
fn numbers_that_are_none_are_refused_wherever_they_are_read() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for d in 0..3 {
            let mut vector = [0.5, 0.25, 0.125];
            vector[d] = bad;
            for quantity in [Quantity::fixed(vector), Quantity::initial(vector)] {
                let mut joints = good();
                joints[1].position = quantity;
                let error = |part| CurveError::NotFinite { joint: 1, part };
                refuses(&joints, error(Part::Position), &["position", "joint 1", "NaN"]);
                for side in 0..2 {
                    let mut joints = good();
                    joints[1].tangent[side] = quantity;
                    refuses(&joints, error(Part::Tangent), &["tangent", "joint 1"]);
                    let mut joints = good();
                    joints[1].curvature[side] = quantity;
                    refuses(&joints, error(Part::Curvature), &["curvature", "joint 1"]);
                }
            }
        }
    }
}

#[test]
fn the_value_of_a_free_quantity_is_not_read() {
    let (_, want) = solve_curve(&good(), false, &Options::DEFAULT).expect("good data");
    let mut joints = good();
    let nothing = Quantity { given: Given::FREE, value: [f64::NAN, 1e300, f64::INFINITY] };
    joints[1].tangent = [nothing, Quantity::FREE];
    joints[1].curvature = [nothing; 2];
    joints[0].curvature[1] = nothing;
    let (_, found) = solve_curve(&joints, false, &Options::DEFAULT).expect("nothing bad is read");
    assert_eq!(found, want);
}

#[test]
fn codes_of_other_quantities_are_refused() {
    let with = |given| Quantity { given, value: [1.0, 0.0, 0.0] };
    for (given, part) in [
        (Given::SIZE, Part::Position),
        (Given::SIZE, Part::Tangent),
        (Given::ON_LINE, Part::Tangent),
        (Given::ON_PLANE, Part::Curvature),
    ] {
        let mut joints = good();
        match part {
            Part::Position => joints[2].position = with(given),
            Part::Tangent => joints[2].tangent = [with(given); 2],
            _ => joints[2].curvature = [with(given); 2],
        }
        refuses(&joints, CurveError::UnknownCode { joint: 2, part }, &["joint 2"]);
    }
}

#[test]
fn unknown_codes_are_refused() {
    for code in [6, 7, 1000, u32::MAX] {
        let unknown = Quantity { given: Given(code), value: [1.0, 0.0, 0.0] };
        let error = |part| CurveError::UnknownCode { joint: 2, part };
        let mut joints = good();
        joints[2].continuity = Continuity(code);
        refuses(&joints, error(Part::Continuity), &["continuity", "joint 2"]);
        let mut joints = good();
        joints[2].position = unknown;
        refuses(&joints, error(Part::Position), &["position", "joint 2"]);
        for side in 0..2 {
            let mut joints = good();
            joints[2].tangent[side] = unknown;
            refuses(&joints, error(Part::Tangent), &["tangent", "joint 2"]);
            let mut joints = good();
            joints[2].curvature[side] = unknown;
            refuses(&joints, error(Part::Curvature), &["curvature", "joint 2"]);
        }
    }
}

#[test]
fn coincident_neighbours_are_refused() {
    let error = |joint, next| CurveError::CoincidentJoints { joint, next };
    let mut joints = good();
    joints[1].position = joints[0].position;
    refuses(&joints, error(0, 1), &["joints 0 and 1", "same point"]);
    joints[1].position.value[0] += 1e-14;
    refuses(&joints, error(0, 1), &[]);
    let all = [joints[0]; 3];
    refuses(&all, error(0, 1), &[]);
    // The last and the first of a closed curve are neighbours; of an open one they are not.
    let mut ring = good();
    ring.push(ring[0]);
    refused(&ring, true, &Options::DEFAULT, error(3, 0), &["joints 3 and 0"]);
    assert!(attempt(&ring, false, &Options::DEFAULT).0.is_ok());
    // A free joint between them does not set them apart.
    let free = Joint::at([0.0; 3]).with_position(Quantity::FREE);
    refuses(&[joints[0], free, joints[0], joints[2]], error(0, 2), &[]);
    // Far from the origin two points may be near each other.
    let far =
        [Joint::at([1e6, 1e6, 0.0]), Joint::at([1e6 + 1e-3, 1e6, 0.0]), Joint::at([1e6, 1e6 + 1e-3, 0.0])];
    assert_eq!(attempt(&far, false, &Options::DEFAULT).0.map(|report| report.status), Ok(Status::Converged));
}

#[test]
fn a_tangent_without_direction_is_refused() {
    for quantity in [Quantity::fixed([0.0; 3]), Quantity::initial([0.0, -0.0, 0.0])] {
        let mut joints = good();
        joints[1] = joints[1].with_tangent(quantity);
        refuses(&joints, CurveError::ZeroTangent { joint: 1 }, &["tangent", "joint 1", "zero"]);
        let mut joints = good();
        joints[0].tangent[0] = quantity;
        refuses(&joints, CurveError::ZeroTangent { joint: 0 }, &["joint 0"]);
    }
    // Any other size has one.
    let (_, want) = solve_curve(&good(), false, &Options::DEFAULT).expect("good data");
    for size in [5e-324, 1e-300, 1e300, f64::MAX] {
        let mut joints = good();
        joints[0] = joints[0].with_tangent(Quantity::fixed([0.0, size, 0.0]));
        assert_eq!(solve_curve(&joints, false, &Options::DEFAULT).expect("a direction").1, want);
    }
}

#[test]
fn a_curvature_that_is_not_perpendicular_is_refused() {
    let error = CurveError::CurvatureNotPerpendicular { joint: 0 };
    for curvature in [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1e-5, 0.0], [1e300, 1e300, 0.0]] {
        for quantity in [Quantity::fixed(curvature), Quantity::initial(curvature)] {
            let mut joints = good();
            joints[0] = joints[0].with_curvature(quantity);
            refuses(&joints, error, &["curvature", "joint 0", "perpendicular"]);
        }
    }
    // No curvature is perpendicular to everything, and so is one that leans by rounding.
    for curvature in [[0.0; 3], [1.0, 1e-8, 0.0]] {
        let mut joints = good();
        joints[0] = joints[0].with_curvature(Quantity::fixed(curvature));
        assert!(attempt(&joints, false, &Options::DEFAULT).0.is_ok());
    }
    // The limit is a millionth of its length, however the tangent lies and however long it is.
    for (tangent, across) in [([1.0, 1.0, 1.0], [1.0, -1.0, 0.0]), ([3e9, 0.0, 4e9], [0.0, 1e-3, 0.0])] {
        for (leans, is_refused) in [(0.9e-6, false), (1.1e-6, true)] {
            let curvature = add(across, times(tangent, leans * norm(across) / norm(tangent)));
            let mut joints = good();
            joints[0] = Joint::at(joints[0].position.value)
                .with_tangent(Quantity::fixed(tangent))
                .with_curvature(Quantity::fixed(curvature));
            assert_eq!(
                attempt(&joints, false, &Options::DEFAULT).0.err() == Some(error),
                is_refused,
                "{leans}"
            );
        }
    }
}

#[test]
fn a_curvature_along_a_curve_of_unknown_direction_is_refused() {
    // The chord is all that tells the direction, and the curvature is along it.
    let bent = Joint::at([0.0; 3]).with_curvature(Quantity::fixed([0.5, 0.0, 0.0]));
    let error = CurveError::CurvatureNeedsTangent { joint: 0 };
    refuses(&[bent, Joint::at([2.0, 0.0, 0.0])], error, &["joint 0", "tangent"]);
}

#[test]
fn a_fixed_curvature_is_kept_or_refused_where_the_start_tangent_runs_along_it() {
    // A circle through the three points: its tangents at the first two are along y, and so are the given curvatures; the
    // chords are not.
    let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    for (which, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let mut joints = points.map(Joint::at);
        joints[which] = joints[which].with_curvature(Quantity::fixed([0.0, 0.5 * sign, 0.0]));
        match attempt(&joints, false, &Options { max_iterations: 30, ..Options::DEFAULT }) {
            (Err(error), _) => assert_eq!(error, CurveError::CurvatureNeedsTangent { joint: which }),
            (Ok(_), elements) => {
                let (_, curvature, rounding) = end_shape(&elements[which], 0);
                let size = norm(curvature);
                assert!((size - 0.5).abs() <= 1e-14 + 10.0 * rounding, "joint {which} has curvature {size}");
            }
        }
    }
}

#[test]
fn sides_that_differ_where_they_are_common_are_refused() {
    let one = Quantity::fixed([1.0, 0.0, 0.0]);
    let other = Quantity::fixed([1.0, 0.5, 0.0]);
    let error = |part| CurveError::SidesDiffer { joint: 1, part };
    for (continuity, sides) in [
        (Continuity::G1, [one, other]),
        (Continuity::G2, [one, other]),
        (Continuity::G2, [one, Quantity::FREE]),
        (Continuity::G2, [one, Quantity::initial(one.value)]),
    ] {
        let mut joints = good();
        joints[1] = joints[1].with_continuity(continuity);
        joints[1].tangent = sides;
        refuses(&joints, error(Part::Tangent), &["sides", "joint 1", "tangent"]);
        joints[1].continuity = Continuity::G0;
        assert!(attempt(&joints, false, &Options::DEFAULT).0.is_ok());
    }
    let mut joints = good();
    joints[1] = joints[1].with_tangent(one);
    joints[1].curvature = [Quantity::fixed([0.0, 1.0, 0.0]), Quantity::fixed([0.0, -1.0, 0.0])];
    refuses(&joints, error(Part::Curvature), &["sides", "joint 1", "curvature"]);
    joints[1].continuity = Continuity::G1;
    assert!(attempt(&joints, false, &Options::DEFAULT).0.is_ok());
}

#[test]
fn a_curve_without_two_positions_is_refused() {
    let free = Joint::at([0.0; 3]).with_position(Quantity::FREE);
    refuses(&[free; 4], CurveError::NoPosition, &["position", "two"]);
    refuses(&[free, Joint::at([1.0, 0.0, 0.0]), free], CurveError::NoPosition, &[]);
    let two = [Joint::at([1.0, 0.0, 0.0]), free, Joint::at([2.0, 0.0, 0.0])];
    assert!(attempt(&two, false, &Options::DEFAULT).0.is_ok());
}

#[test]
fn sizes_that_the_arithmetic_cannot_hold_are_refused() {
    let pair = |size: f64| {
        [Joint::at([0.0; 3]), Joint::at([size, 0.0, 0.0]).with_tangent(Quantity::fixed([1.0, 1.0, 0.0]))]
    };
    for size in [1e-91, 1e-300, 1e91, 1e300, f64::MAX] {
        refuses(&pair(size), CurveError::SizeOutOfRange, &["1e-90", "1e90"]);
    }
    for size in [1.1e-90, 0.9e90] {
        let (result, _) = attempt(&pair(size), false, &Options::DEFAULT);
        let report = result.expect("just within");
        assert_eq!(report.status, Status::Converged);
        assert!((report.length / size - 1.0).abs() < 1.0);
    }
}

#[test]
fn points_whose_distance_overflows_are_too_far_apart_and_not_coincident() {
    let far = [Joint::at([-1e308, 0.0, 0.0]), Joint::at([1e308, 0.0, 0.0])];
    refuses(&far, CurveError::SizeOutOfRange, &[]);
}

#[test]
fn a_planar_curve_of_data_in_space_is_refused() {
    let mut joints = good();
    joints.push(Joint::at([3.0, 1.0, 1.0]));
    let options = Options { dimension: 2, ..Options::DEFAULT };
    refused(&joints, false, &options, CurveError::NotPlanar, &["plane"]);
    assert!(attempt(&good(), false, &options).0.is_ok());
}

#[test]
fn options_out_of_range_are_refused_and_those_in_range_are_not() {
    let base = Options::DEFAULT;
    let bad = |options: Options, name, word| {
        refused(&good(), false, &options, CurveError::BadOption(name), &[word]);
        // Options are looked at before the joints.
        refused(&[], false, &options, CurveError::BadOption(name), &[]);
    };
    for code in [6, 7, 99, u32::MAX] {
        bad(Options { functional: Functional(code), ..base }, OptionName::Functional, "functional");
    }
    for elements_per_span in [0, 1025, u32::MAX] {
        bad(Options { elements_per_span, ..base }, OptionName::ElementsPerSpan, "elements_per_span");
    }
    for quadrature_points in [1, 2, 11, 33, u32::MAX] {
        bad(Options { quadrature_points, ..base }, OptionName::QuadraturePoints, "quadrature_points");
    }
    for dimension in [1, 4, u32::MAX] {
        bad(Options { dimension, ..base }, OptionName::Dimension, "dimension");
    }
    for relative_decrease in [-1e-9, 1.0, 2.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        bad(Options { relative_decrease, ..base }, OptionName::RelativeDecrease, "relative_decrease");
    }
    for options in [
        Options { quadrature_points: 0, ..base },
        Options { quadrature_points: 12, ..base },
        Options { quadrature_points: 32, ..base },
        Options { relative_decrease: 0.0, ..base },
        Options { relative_decrease: 0.999, ..base },
        Options { elements_per_span: 1024, max_iterations: 1, ..base },
        Options { dimension: 3, ..base },
        Options { max_iterations: u32::MAX, ..base },
        Options { max_iterations: 0, ..base },
    ] {
        let (result, elements) = attempt(&good(), false, &options);
        assert!(result.is_ok(), "{options:?}: {result:?}");
        assert!(finite(&elements));
    }
}

#[test]
fn no_iterations_give_the_start_curve_and_say_so() {
    let options = Options { max_iterations: 0, ..Options::DEFAULT };
    let (report, elements) = solve_curve(&good(), false, &options).expect("good data");
    assert_eq!((report.status, report.iterations), (Status::IterationLimit, 0));
    assert_eq!(elements[0].rows[5], [1.0, 0.5, 0.0]);
    let one = Options { max_iterations: 1, ..Options::DEFAULT };
    let (report, _) = solve_curve(&good(), false, &one).expect("good data");
    assert_eq!((report.status, report.iterations), (Status::IterationLimit, 1));
}

fn finite(elements: &[Element]) -> bool {
    elements.iter().flat_map(|element| element.rows).flatten().all(f64::is_finite)
}

#[test]
fn a_workspace_one_too_short_is_refused_with_the_length_that_works() {
    let space = {
        let mut joints = good();
        joints[1].position.value[2] = 0.5;
        joints
    };
    for joints in [good(), space, good()[..2].to_vec()] {
        for closed in [false, true] {
            for elements_per_span in [1, 2, 7] {
                let (curve, options) =
                    (Curve::new(&joints, closed), Options { elements_per_span, ..Options::DEFAULT });
                let Ok(right) = workspace_len(&curve, &options) else { continue };
                let mut elements = vec![MARKER; elements_len(&curve, &options)];
                for given in [right - 1, right / 2, 1, 0] {
                    let mut workspace = vec![0.0; given];
                    let result = solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
                    let error = CurveError::WorkspaceTooSmall { needed: right, given };
                    assert_eq!(result, Err(error));
                    assert!(elements.iter().all(|element| *element == MARKER));
                    let message = error.to_string();
                    assert!(
                        message.contains(&right.to_string()) && message.contains(&given.to_string()),
                        "{message}"
                    );
                }
                let mut workspace = vec![0.0; right];
                let result = solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
                assert!(result.is_ok() && finite(&elements) && !elements.contains(&MARKER));
            }
        }
    }
}

#[test]
fn room_for_one_element_too_few_is_refused_with_the_number_that_works() {
    let joints = good();
    for (closed, elements_per_span) in [(false, 1), (false, 5), (true, 1), (true, 3)] {
        let (curve, options) =
            (Curve::new(&joints, closed), Options { elements_per_span, ..Options::DEFAULT });
        let needed = elements_len(&curve, &options);
        assert_eq!(needed, if closed { 3 } else { 2 } * elements_per_span as usize);
        let mut workspace = vec![0.0; workspace_len(&curve, &options).expect("good data")];
        for given in [needed - 1, 0] {
            let mut elements = vec![MARKER; given];
            let result = solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
            let error = CurveError::ElementsTooShort { needed, given };
            assert_eq!(result, Err(error));
            assert!(elements.iter().all(|element| *element == MARKER));
            let message = error.to_string();
            assert!(
                message.contains(&needed.to_string()) && message.contains(&given.to_string()),
                "{message}"
            );
        }
        // More room is left untouched.
        let mut elements = vec![MARKER; needed + 2];
        solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
        assert_eq!(elements[needed..], [MARKER; 2]);
    }
}

#[test]
fn huge_and_tiny_data_give_the_same_curve() {
    let scaled = |scale: f64| -> Vec<Joint> {
        let mut joints = vec![
            Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([1.0, 0.2, 0.0])),
            Joint::at([1.0, 0.5, 0.1]),
            Joint::at([2.0, 0.3, 0.3]),
            Joint::at([3.0, 0.9, 0.2]).with_curvature(Quantity::initial([0.0, -0.5, 0.0])),
        ];
        for joint in &mut joints {
            joint.position.value = joint.position.value.map(|x| x * scale);
            for curvature in &mut joint.curvature {
                curvature.value = curvature.value.map(|x| x / scale);
            }
        }
        joints
    };
    let (report, want) = solve_curve(&scaled(1.0), false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    for scale in [1e-80, 1e-40, 1e40, 1e80] {
        let (other, mut found) = solve_curve(&scaled(scale), false, &Options::DEFAULT).expect("good data");
        assert_eq!(other.status, Status::Converged);
        found.iter_mut().for_each(|element| element.rows = element.rows.map(|row| row.map(|x| x / scale)));
        assert!(deviation(&want, &found, 3) < 1e-9);
        assert!((other.value * scale * scale * scale / report.value - 1.0).abs() < 1e-9);
        assert!((other.variation * scale * scale * scale / report.variation - 1.0).abs() < 1e-9);
        assert!((other.length / scale / report.length - 1.0).abs() < 1e-9);
        assert!((other.gradient - report.gradient).abs() < 1e-6);
    }
}

/// Cancels at an iteration, and remembers what it saw.
struct Canceller {
    at: usize,
    seen: Vec<(usize, Record)>,
}

impl Observer for Canceller {
    fn iteration(&mut self, number: usize, record: &Record) -> Control {
        self.seen.push((number, *record));
        if number == self.at { Control::Cancel } else { Control::Continue }
    }
}

#[test]
fn a_curve_cancelled_at_any_iteration_is_a_curve() {
    let joints = [
        Joint::at([0.0, 0.0, 0.0]),
        Joint::at([1.0, 1.9, 0.0]),
        Joint::at([2.0, 2.7, 0.3]),
        Joint::at([3.0, 2.6, 0.0]),
        Joint::at([4.0, 1.6, 0.0]),
    ];
    for functional in [Functional::MVC, Functional::MEC] {
        let (curve, options) = (Curve::open(&joints), Options { functional, ..Options::DEFAULT });
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut run = |at: usize| {
            let mut elements = vec![MARKER; 4];
            let mut records = vec![Record::ZERO; 300];
            let mut observer = Canceller { at, seen: Vec::new() };
            let report = solve(&curve, &options, &mut workspace, &mut elements, &mut records, &mut observer);
            let report = report.expect("good data");
            // The records are what the observer saw, numbered from 1.
            assert_eq!(observer.seen.len(), report.iterations);
            for (i, (number, record)) in observer.seen.iter().enumerate() {
                assert_eq!((*number, *record), (i + 1, records[i]));
            }
            assert_eq!(records[report.iterations], Record::ZERO);
            (report, elements)
        };
        let (whole, _) = run(0);
        assert_eq!(whole.status, Status::Converged);
        assert!(whole.iterations > 3);
        for at in 1..=whole.iterations {
            let (report, elements) = run(at);
            assert_eq!((report.status, report.iterations), (Status::Cancelled, at));
            assert!(finite(&elements));
            for (element, pair) in elements.iter().zip(joints.windows(2)) {
                assert_eq!(element.rows[0], pair[0].position.value);
                assert_eq!(element.rows[5], pair[1].position.value);
            }
            assert!(report.value.is_finite() && report.value >= whole.value * (1.0 - 1e-9));
        }
    }
}

fn wave(count: usize, closed: bool) -> Vec<Joint> {
    (0..count)
        .map(|i| {
            // A polygon of bounded steps without any trigonometry: a zigzag, or a many-cornered ring of it.
            let x = i as f64;
            let wobble = 0.2 * f64::from((i * 7 % 5) as u8) - 0.4;
            if closed {
                let quarter = count as f64 / 4.0;
                let (side, along) = ((x / quarter) as usize, x % quarter);
                let (a, b) = (along - 0.5 * quarter, 0.5 * quarter + 0.5 * wobble);
                match side {
                    0 => Joint::at([a, -b, 0.0]),
                    1 => Joint::at([b, a, 0.0]),
                    2 => Joint::at([-a, b, 0.0]),
                    _ => Joint::at([-b, -a, 0.0]),
                }
            } else {
                Joint::at([x, wobble, 0.0])
            }
        })
        .collect()
}

#[test]
fn a_thousand_joints_converge_in_time_and_memory_proportional_to_their_number() {
    for closed in [false, true] {
        for functional in [Functional::MVC, Functional::MEC] {
            let mut costs = Vec::new();
            for count in [100, 1000] {
                let joints = wave(count, closed);
                let options = Options { functional, ..Options::DEFAULT };
                let len = workspace_len(&Curve::new(&joints, closed), &options).expect("good data");
                let start = Instant::now();
                let (report, _) = solve_curve(&joints, closed, &options).expect("good data");
                let each = start.elapsed().as_secs_f64() / count as f64;
                println!(
                    "{count} joints, closed {closed}, {functional:?}: {:?} after {} iterations, {:.1} µs a joint and iteration, {} doubles a joint",
                    report.status,
                    report.iterations,
                    1e6 * each / report.iterations as f64,
                    len / count
                );
                assert_eq!(report.status, Status::Converged);
                costs.push(len as f64 / count as f64);
            }
            assert!((costs[1] / costs[0] - 1.0).abs() < 0.05, "memory a joint: {costs:?}");
        }
    }
}

/// What is done to good data.
#[derive(Clone, Copy, Debug)]
struct Poison {
    joint: usize,
    field: usize,
    component: usize,
    number: f64,
    code: u32,
}

fn poison() -> impl Strategy<Value = Poison> {
    let number = prop_oneof![
        prop::sample::select(vec![
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -0.0,
            1.0,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            1e300,
            -1e154,
            1e100,
            1e-100,
            1e-160,
            1e16,
            1e-16,
        ]),
        -2.0..2.0f64,
        any::<f64>(),
    ];
    let code = prop_oneof![0u32..=3, Just(u32::MAX)];
    (0usize..5, 0usize..11, 0usize..3, number, code)
        .prop_map(|(joint, field, component, number, code)| Poison { joint, field, component, number, code })
}

fn poisoned(joints: &mut [Joint], poison: &Poison) {
    let joint = &mut joints[poison.joint];
    let quantity = match poison.field {
        0 | 1 => &mut joint.position,
        2 | 3 => &mut joint.tangent[0],
        4 | 5 => &mut joint.tangent[1],
        6 | 7 => &mut joint.curvature[0],
        8 | 9 => &mut joint.curvature[1],
        _ => {
            joint.continuity = Continuity(poison.code);
            return;
        }
    };
    if poison.field.is_multiple_of(2) {
        quantity.value[poison.component] = poison.number;
    } else {
        quantity.given = Given(poison.code);
    }
    // Mostly both sides at once: else nearly all would be refused for sides that differ.
    if !poison.number.to_bits().is_multiple_of(4) {
        match poison.field {
            2 | 3 => joint.tangent[1] = joint.tangent[0],
            4 | 5 => joint.tangent[0] = joint.tangent[1],
            6 | 7 => joint.curvature[1] = joint.curvature[0],
            8 | 9 => joint.curvature[0] = joint.curvature[1],
            _ => {}
        }
    }
}

fn options() -> impl Strategy<Value = Options> {
    let odd = |range: std::ops::Range<u32>, odd: u32| prop_oneof![30 => range, 1 => Just(odd)];
    (
        odd(0..2, 2),
        odd(1..4, 0),
        odd(12..33, 33),
        prop_oneof![Just(0u32), Just(1), 2u32..60],
        prop_oneof![20 => Just(0u32), 2 => Just(2), 10 => Just(3), 1 => Just(1)],
        prop_oneof![5 => Just(1e-12), 5 => Just(0.0), 5 => 0.0..1.0f64, 1 => any::<f64>()],
    )
        .prop_map(
            |(
                functional,
                elements_per_span,
                quadrature_points,
                max_iterations,
                dimension,
                relative_decrease,
            )| Options {
                functional: Functional(functional),
                elements_per_span,
                quadrature_points,
                max_iterations,
                dimension,
                relative_decrease,
                ..Options::DEFAULT
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2),
        max_shrink_iters: 2000,
        ..ProptestConfig::default()
    })]

    #[test]
    fn poisoned_data_give_an_error_or_finite_elements(
        points in prop::array::uniform5(prop::array::uniform3(-1.0..1.0f64)),
        flat in any::<bool>(),
        closed in any::<bool>(),
        poisons in prop::collection::vec(poison(), 0..5),
        options in options(),
    ) {
        let mut joints: Vec<Joint> = points
            .iter()
            .map(|&[x, y, z]| Joint::at([x, y, if flat { 0.0 } else { z }]))
            .collect();
        joints[0] = joints[0].with_tangent(Quantity::fixed([1.0, 0.5, 0.0]));
        joints[3] = joints[3].with_tangent(Quantity::initial([0.0, 1.0, 0.0])).with_continuity(Continuity::G1);
        for poison in &poisons {
            poisoned(&mut joints, poison);
        }
        let (result, elements) = attempt(&joints, closed, &options);
        match result {
            Err(error) => prop_assert!(!error.to_string().is_empty()),
            Ok(report) => {
                prop_assert!(finite(&elements), "{report:?}");
                prop_assert!(report.length > 0.0, "{report:?}");
                if report.status == Status::Converged {
                    prop_assert!(report.value.is_finite() && report.fine_value.is_finite(), "{report:?}");
                }
                let per_span = options.elements_per_span as usize;
                for (i, joint) in joints.iter().enumerate().take(elements.len() / per_span) {
                    if joint.position.given == Given::FIXED {
                        prop_assert_eq!(distance(elements[i * per_span].rows[0], joint.position.value), 0.0);
                    }
                }
            }
        }
    }
}
