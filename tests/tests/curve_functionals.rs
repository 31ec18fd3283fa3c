//! The functionals and constraints beyond MVC and MEC, against true curves in arc length (`data/truth.csv`) and against
//! what must hold of them.

use minvar::curve::{
    Curve, CurveError, Element, Functional, Given, Joint, LENGTH_TRUSTED, Obstacle, OptionName, Options,
    Quantity, Reference, Report, Side, elements_len, measure, minima, solve, update, workspace_len,
};
use minvar::solve::{Record, Silent, Status};
use minvar_tests::curves::{add, cross, deviation, distance, solve_curve, times, unit};
use std::collections::BTreeMap;

const WOODFORD: [[f64; 2]; 7] =
    [[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.89], [6.0, 1.2]];

fn woodford() -> Vec<Joint> {
    WOODFORD.iter().map(|&[x, y]| Joint::at([x, y, 0.0])).collect()
}

/// An S between points 4 apart whose tangents lean by so many degrees at either end.
fn s_curve(degrees: f64) -> Vec<Joint> {
    let angle = degrees.to_radians();
    let along = [libm::cos(angle), libm::sin(angle), 0.0];
    let end = |x| Joint::at([x, 0.0, 0.0]).with_tangent(Quantity::fixed(along));
    vec![end(-2.0), end(2.0)]
}

/// The true curves: V, E and L by name and functional.
fn truth() -> BTreeMap<(String, String), [f64; 3]> {
    include_str!("../data/truth.csv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').map(str::trim).collect();
            let number = |i: usize| fields[i].parse().expect("a number");
            ((fields[0].to_owned(), fields[1].to_owned()), [number(2), number(3), number(4)])
        })
        .collect()
}

fn close(found: f64, wanted: f64, allowed: f64, what: &str) {
    assert!((found - wanted).abs() <= allowed * wanted.abs(), "{what}: {found}, not {wanted}");
}

#[test]
fn every_functional_reaches_its_true_curve() {
    let truth = truth();
    let options = Options { elements_per_span: 4, ..Options::DEFAULT };
    for (functional, tension, bending, name) in [
        (Functional::MVC, 0.0, 0.0, "mvc"),
        (Functional::MEC, 0.0, 0.0, "mec"),
        (Functional::SI_MVC, 0.0, 0.0, "si-mvc"),
        (Functional::SI_MEC, 0.0, 0.0, "si-mec"),
        (Functional::MVC, 0.5, 0.0, "mvc+0.5l"),
        (Functional::MVC, 0.0, 0.5, "mvc+0.5e"),
        (Functional::MEC, 0.5, 0.0, "mec+0.5l"),
    ] {
        let [v, e, l] = truth[&("woodford".to_owned(), name.to_owned())];
        let options = Options { functional, tension, bending, ..options };
        let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged, "{name}");
        // What is not minimised itself is known to the square root of what is.
        let bends = functional == Functional::MEC || functional == Functional::SI_MEC;
        close(report.variation, v, if bends { 1e-4 } else { 1e-8 }, name);
        close(report.bending, e, 1e-8, name);
        close(report.length, l, 1e-8, name);
        let plain = if bends { e } else { v + bending * e } + tension * l;
        let value = match functional {
            Functional::SI_MVC => plain * l * l * l,
            Functional::SI_MEC => plain * l,
            _ => plain,
        };
        close(report.value, value, 1e-9, name);
    }
}

/// Elements that are laid along the curve's direction as a function of arc length need no step of their own.
#[test]
fn points_asked_for_loosely_take_a_few_iterations_and_no_linearisation() {
    for functional in [Functional::MVC, Functional::MEC, Functional::SI_MVC, Functional::SI_MEC] {
        let solve = |relative_decrease| {
            let options = Options { functional, relative_decrease, ..Options::DEFAULT };
            let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
            assert_eq!(report.status, Status::Converged, "{functional:?}");
            report
        };
        let (loose, tight) = (solve(3e-6), solve(1e-12));
        assert_eq!(loose.linearisations, 0, "{functional:?}");
        assert!(loose.iterations <= 5, "{functional:?}: {}", loose.iterations);
        assert!(loose.gradient == f64::INFINITY && loose.decrement <= 3e-6 * loose.value);
        close(loose.value, tight.value, 3e-6, "functional");
        assert!(loose.value >= tight.value);
    }
}

#[test]
fn a_scale_invariant_value_is_the_same_at_any_size() {
    let (unit, _) =
        solve_curve(&woodford(), false, &Options { functional: Functional::SI_MVC, ..Options::DEFAULT })
            .expect("good data");
    for size in [1e-6, 3.7, 1e6] {
        let joints: Vec<Joint> =
            WOODFORD.iter().map(|&[x, y]| Joint::at([x * size, y * size, 0.0])).collect();
        for functional in [Functional::SI_MVC, Functional::SI_MEC] {
            let options = Options { functional, ..Options::DEFAULT };
            let (report, _) = solve_curve(&joints, false, &options).expect("good data");
            assert_eq!(report.status, Status::Converged);
            if functional == Functional::SI_MVC {
                close(report.value, unit.value, 1e-9, "L³V");
            }
        }
    }
}

#[test]
fn weights_scale_with_the_data() {
    let at = |size: f64, tension: f64, bending: f64| {
        let joints: Vec<Joint> =
            WOODFORD.iter().map(|&[x, y]| Joint::at([x * size, y * size, 0.0])).collect();
        let options = Options { tension, bending, ..Options::DEFAULT };
        solve_curve(&joints, false, &options).expect("good data").0.length / size
    };
    let (one, free) = (at(1.0, 0.5, 0.25), at(1.0, 0.0, 0.0));
    close(at(3.0, 0.5 / 81.0, 0.25 / 9.0), one, 1e-9, "scaled weights");
    assert!(one < free - 1e-3);
}

#[test]
fn a_scale_invariant_curve_exists_where_the_mvc_does_not() {
    let truth = truth();
    let options = Options { elements_per_span: 64, tolerance: 1e-6, ..Options::DEFAULT };
    for (degrees, name) in [(90.0, "s_curve"), (110.0, "s_110")] {
        let (report, _) = solve_curve(&s_curve(degrees), false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged, "{degrees}");
        let [v, e, l] = truth[&(name.to_owned(), "mvc".to_owned())];
        close(report.variation, v, 1e-6, "S");
        close(report.bending, e, 1e-6, "S");
        close(report.length, l, 1e-6, "S");
    }
    let options = Options { functional: Functional::SI_MVC, ..options };
    for degrees in [90.0, 120.0] {
        let (report, _) = solve_curve(&s_curve(degrees), false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged, "{degrees}");
    }
}

#[test]
fn a_tolerance_is_kept_by_as_few_elements_as_it_needs() {
    let mut before = 0;
    let joints = woodford();
    for tolerance in [1e-3, 1e-7, 1e-9] {
        let options = Options { tolerance, elements_per_span: 64, ..Options::DEFAULT };
        let curve = Curve::open(&joints);
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut elements = vec![Element::ZERO; elements_len(&curve, &options)];
        let report =
            solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
        assert_eq!(report.status, Status::Converged);
        assert!(report.error <= tolerance);
        assert!(report.elements >= before && report.elements <= 6 * 64);
        assert!(elements[report.elements..].iter().all(|element| *element == Element::ZERO));
        before = report.elements;
    }
    assert!(before > 6);
    // One element a span is a fifth of a millionth off (`truth.rs`): measured, too much for one tolerance and enough
    // for another.
    for (tolerance, status) in [(1e-9, Status::Stalled), (1e-5, Status::Converged)] {
        let options = Options { tolerance, elements_per_span: 1, ..Options::DEFAULT };
        let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
        assert_eq!(report.status, status);
        assert!(report.error > 1e-8 && report.error < 1e-5, "{:e}", report.error);
    }
    // Of a space curve nothing is known without a second division.
    let winding: Vec<Joint> =
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 1.0], [3.0, 0.0, 1.0]].map(Joint::at).to_vec();
    let options = Options { tolerance: 1e-3, elements_per_span: 1, ..Options::DEFAULT };
    let (report, _) = solve_curve(&winding, false, &options).expect("good data");
    assert_eq!((report.status, report.error), (Status::Stalled, f64::INFINITY));
}

#[test]
fn a_converged_curve_has_its_given_length_whatever_else_was_asked_for() {
    let upright = |end: Joint| end.with_tangent(Quantity::fixed([0.0, 1.0, 0.0]));
    let hook = vec![upright(Joint::at([0.0, 0.0, 0.0])), upright(Joint::at([6.0, 1.2, 0.0]))];
    let mut converged = [0, 0];
    for joints in [woodford(), hook] {
        for (length, tolerance, elements_per_span) in [8.3, 9.5, 14.0]
            .into_iter()
            .flat_map(|length| [(length, 1.0, 1), (length, 1.0, 64), (length, 1e-5, 64), (length, 0.0, 2)])
        {
            for relative_decrease in [1e-12, 0.5] {
                for functional in [Functional::MVC, Functional::MEC] {
                    let options = Options {
                        functional,
                        tolerance,
                        elements_per_span,
                        relative_decrease,
                        length,
                        ..Options::DEFAULT
                    };
                    let (report, elements) = solve_curve(&joints, false, &options).expect("good data");
                    if report.status != Status::Converged {
                        continue;
                    }
                    close(
                        measure::length(&elements[..report.elements]),
                        length,
                        1.001 * LENGTH_TRUSTED,
                        "the length",
                    );
                    converged[usize::from(tolerance > 0.0)] += 1;
                }
            }
        }
    }
    assert!(converged[0] >= 12 && converged[1] >= 32, "few converged: {converged:?}");
}

#[test]
fn a_sliding_joint_stays_on_its_line_or_plane_and_lowers_the_functional() {
    let fixed = [
        Joint::at([0.5, -12.0, 0.0])
            .with_tangent(Quantity::fixed([0.0, 1.0, 0.0]))
            .with_curvature(Quantity::fixed([0.27, 0.0, 0.0])),
        Joint::at([20.0, -0.5, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ];
    let (before, _) = solve_curve(&fixed, false, &Options::DEFAULT).expect("good data");
    let mut slides = fixed;
    slides[0] = slides[0].on_line([0.5, -12.0, 0.0], [0.0, 3.0, 0.0]);
    let (report, elements) = solve_curve(&slides, false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    assert!(report.planar && report.unknowns == before.unknowns + 1);
    let start = elements[0].rows[0];
    assert!((start[0] - 0.5).abs() < 1e-14 && start[2] == 0.0 && start[1] > -11.0, "{start:?}");
    assert!(report.value < 0.9 * before.value);
    // The minimum over the line: fixed there or a little aside, it is no better.
    for off in [0.0, 1e-2, -1e-2] {
        let mut aside = fixed;
        aside[0].position.value = [start[0], start[1] + off, 0.0];
        let (other, _) = solve_curve(&aside, false, &Options::DEFAULT).expect("good data");
        assert!(other.value >= report.value * (1.0 - 1e-9), "{off}");
        assert!(off == 0.0 || other.value > report.value * (1.0 + 1e-8), "{off}");
    }

    let normal = [1.0, 0.2, -0.1];
    let in_plane = [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
        Joint::at([0.0; 3]).on_plane([1.0, 0.5, 0.3], normal),
        Joint::at([2.0, 0.0, 1.0]),
        Joint::at([2.0, 1.0, 2.0]).with_tangent(Quantity::fixed([0.0, 0.3, 1.0])),
    ];
    let (report, elements) = solve_curve(&in_plane, false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let met = elements[1].rows[0];
    let off: f64 = (0..3).map(|d| normal[d] * (met[d] - [1.0, 0.5, 0.3][d])).sum();
    assert!(off.abs() < 1e-14, "{off}");
    let without = [in_plane[0], in_plane[2], in_plane[3]];
    let (fewer, _) = solve_curve(&without, false, &Options::DEFAULT).expect("good data");
    assert!(report.value <= fewer.value * (1.0 + 1e-6), "{} {}", report.value, fewer.value);
}

#[test]
fn a_curvature_of_given_size_keeps_it_and_finds_its_direction() {
    let joints = |curvature| {
        [
            Joint::at([0.0, 0.0, 0.0])
                .with_tangent(Quantity::fixed([0.0, 0.0, 1.0]))
                .with_curvature(curvature),
            Joint::at([1.0, 0.0, 1.0]),
            Joint::at([2.0, 2.0, 1.0]),
        ]
    };
    let mut values = Vec::new();
    for start in [[0.3, 0.0, 0.0], [0.0, -0.3, 0.0], [0.0, 0.0, 0.3]] {
        let (report, elements) =
            solve_curve(&joints(Quantity::of_size(start)), false, &Options::DEFAULT).expect("good data");
        assert_eq!(report.status, Status::Converged);
        let found = measure::at(&elements, 0, 0.0).expect("a point").curvature;
        let size = found.iter().map(|x| x * x).sum::<f64>().sqrt();
        close(size, 0.3, 1e-13, "size");
        values.push(report.value);
    }
    // It is at least as good as any direction that is fixed.
    let best = values.iter().fold(f64::INFINITY, |best, &value| best.min(value));
    for step in 0..12 {
        let angle = f64::from(step) * std::f64::consts::FRAC_PI_6;
        let vector = [0.3 * libm::cos(angle), 0.3 * libm::sin(angle), 0.0];
        let (report, _) =
            solve_curve(&joints(Quantity::fixed(vector)), false, &Options::DEFAULT).expect("good data");
        if report.status == Status::Converged {
            assert!(best <= report.value * (1.0 + 1e-6), "{angle}: {best} {}", report.value);
        }
    }
}

#[test]
fn a_size_along_an_oblique_tangent_is_kept() {
    // What rounding leaves across the tangent must not be taken for a direction.
    for tangent in [[0.6, 0.8, 0.0], [1.0, 2.0, 0.0], [0.1, 0.3, 0.0], [0.3, 0.7, 0.2]] {
        let length = tangent.iter().map(|x| x * x).sum::<f64>().sqrt();
        let joints = [
            Joint::at([0.0; 3])
                .with_tangent(Quantity::fixed(tangent))
                .with_curvature(Quantity::of_size(tangent.map(|x| 0.3 * (x / length)))),
            Joint::at([2.0, 2.0, 0.0]),
            Joint::at([4.0, 1.0, 0.0]),
        ];
        let (report, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
        assert_eq!(report.status, Status::Converged, "{tangent:?}");
        let found = measure::at(&elements, 0, 0.0).expect("a point").curvature;
        close(found.iter().map(|x| x * x).sum::<f64>().sqrt(), 0.3, 1e-12, "size");
    }
}

#[test]
fn a_reference_shape_is_kept_deformed_and_smoothed_away() {
    // A wavy shape: the MEC of these points.
    let joints = woodford();
    let (_, shape) =
        solve_curve(&joints, false, &Options { functional: Functional::MEC, ..Options::DEFAULT })
            .expect("good data");
    let with = |joints: &[Joint], weight: f64| {
        let curve = Curve::open(joints).with_reference(Reference { elements: &shape, weight });
        let options = Options::DEFAULT;
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut elements = vec![Element::ZERO; elements_len(&curve, &options)];
        let report =
            solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
        assert_eq!(report.status, Status::Converged, "{weight}");
        (report, elements)
    };
    let apart = |a: &[Element], b: &[Element]| deviation(a, b, a.len());
    let (report, same) = with(&joints, 1.0);
    assert!(report.value < 1e-12 && apart(&same, &shape) < 1e-9);
    // Between all and nothing of the reference, the shape goes over into the MVC.
    let (_, fair) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    let mut last = 0.0;
    for weight in [0.75, 0.5, 0.25, 0.0] {
        let (_, found) = with(&joints, weight);
        let off = apart(&found, &shape);
        assert!(off > last, "{weight}: {off}");
        last = off;
    }
    let (report, found) = with(&joints, 0.0);
    assert!(apart(&found, &fair) < 1e-4);
    close(report.value, report.variation, 1e-12, "V");
    // Dragged at one end only, with what was known there held, the rest stays what it was without any joint between.
    let ends = [shape[0].rows[0], shape[5].rows[5]].map(Joint::at);
    let (report, alone) = {
        let one = [shape[0]];
        let joints = [
            ends[0].with_tangent(Quantity::fixed(shape[0].rows[1])),
            Joint::at(shape[0].rows[5]).with_tangent(Quantity::fixed(shape[0].rows[4])),
        ];
        let curve = Curve::open(&joints).with_reference(Reference { elements: &one, weight: 1.0 });
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &Options::DEFAULT).expect("good data")];
        let mut elements = [Element::ZERO];
        let report = solve(&curve, &Options::DEFAULT, &mut workspace, &mut elements, &mut [], &mut Silent)
            .expect("good data");
        (report, elements)
    };
    assert!(report.value < 1e-12 && apart(&alone, &shape[..1]) < 1e-9, "{}", report.value);
}

#[test]
fn a_reference_that_cannot_be_is_refused() {
    let joints = woodford();
    let element = Element { rows: [[0.0; 3], [1.0; 3], [0.0; 3], [0.0; 3], [1.0; 3], [1.0; 3]] };
    let refuse = |elements: &[Element], weight: f64, options: &Options| {
        let curve = Curve::open(&joints).with_reference(Reference { elements, weight });
        workspace_len(&curve, options).expect_err("refused")
    };
    let six = [element; 6];
    assert_eq!(
        refuse(&six[..5], 1.0, &Options::DEFAULT),
        CurveError::WrongElementCount { needed: 6, given: 5 }
    );
    for weight in [-0.1, 1.1, f64::NAN] {
        let error = CurveError::BadOption(OptionName::ReferenceWeight);
        assert_eq!(refuse(&six, weight, &Options::DEFAULT), error);
    }
    let mec = Options { functional: Functional::MEC, ..Options::DEFAULT };
    assert_eq!(refuse(&six, 1.0, &mec), CurveError::BadOption(OptionName::ReferenceWeight));
    let mut bad = six;
    bad[4].rows[2][1] = f64::NAN;
    assert_eq!(refuse(&bad, 1.0, &Options::DEFAULT), CurveError::BadElement { element: 4 });
    bad[4].rows[2][1] = 0.0;
    bad[3].rows[4] = [0.0; 3];
    assert_eq!(refuse(&bad, 1.0, &Options::DEFAULT), CurveError::BadElement { element: 3 });
}

#[test]
fn options_of_functionals_are_checked() {
    let refuse = |options: Options| workspace_len(&Curve::open(&woodford()), &options).expect_err("refused");
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let base = Options::DEFAULT;
        let error = |name| CurveError::BadOption(name);
        assert_eq!(refuse(Options { tension: bad, ..base }), error(OptionName::Tension));
        assert_eq!(refuse(Options { bending: bad, ..base }), error(OptionName::Bending));
        assert_eq!(refuse(Options { length: bad, ..base }), error(OptionName::Length));
        assert_eq!(refuse(Options { tolerance: bad, ..base }), error(OptionName::Tolerance));
    }
    let scaled = Options { functional: Functional::SI_MVC, ..Options::DEFAULT };
    let error = CurveError::BadOption(OptionName::Tension);
    assert_eq!(refuse(Options { tension: 1.0, ..scaled }), error);
    assert_eq!(refuse(Options { length: 8.0, ..Options::DEFAULT }), CurveError::LengthTooShort);
    let mut joints = woodford();
    joints[2] = joints[2].on_line([2.0, 2.7, 0.0], [0.0; 3]);
    let error = workspace_len(&Curve::open(&joints), &Options::DEFAULT).expect_err("refused");
    assert_eq!(error, CurveError::ZeroGuide { joint: 2 });
}

#[test]
fn a_warm_start_finds_what_a_cold_one_does() {
    let joints = woodford();
    for elements_per_span in [1, 3] {
        let options = Options { elements_per_span, ..Options::DEFAULT };
        let (_, mut elements) = solve_curve(&joints, false, &options).expect("good data");
        let mut moved = joints.clone();
        for step in 0..10 {
            moved[3].position.value[1] += 0.02;
            let curve = Curve::open(&moved);
            let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
            let report = update(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent)
                .expect("good data");
            assert_eq!(report.status, Status::Converged);
            let (cold, _) = solve_curve(&moved, false, &options).expect("good data");
            let what = format!("{elements_per_span} a span, step {step}");
            close(report.value, cold.value, if elements_per_span == 1 { 2e-6 } else { 1e-7 }, &what);
            for (joint, element) in moved.iter().zip(elements.iter().step_by(elements_per_span as usize)) {
                assert_eq!(joint.position.value, element.rows[0], "{what}");
            }
        }
    }
    let options = Options::DEFAULT;
    let curve = Curve::open(&joints);
    let mut workspace = vec![0.0; workspace_len(&curve, &options).expect("good data")];
    let mut elements = [Element::ZERO; 6];
    let error = update(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
    assert_eq!(error.expect_err("no start"), CurveError::BadElement { element: 0 });
    assert_eq!(elements, [Element::ZERO; 6]);
}

fn solved(curve: &Curve<'_>, options: &Options) -> (Report, Vec<Element>) {
    let mut workspace = vec![f64::NAN; workspace_len(curve, options).expect("good data")];
    let mut elements = vec![Element::ZERO; elements_len(curve, options)];
    let report =
        solve(curve, options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
    elements.truncate(report.elements);
    (report, elements)
}

/// How far a point lies to the left of a planar chain.
fn to_the_left(elements: &[Element], point: [f64; 3]) -> f64 {
    let found = measure::closest(elements, point).expect("a place");
    let (t, off) = (found.tangent, [point[0] - found.point[0], point[1] - found.point[1]]);
    (t[0] * off[1] - t[1] * off[0]).signum() * distance(found.point, point)
}

fn coving() -> [Joint; 2] {
    [
        Joint::at([0.5, -12.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0])),
        Joint::at([20.0, -0.5, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ]
}

#[test]
fn a_curve_keeps_clear_of_its_obstacles_and_touches_only_what_pushes() {
    let joints = coving();
    let corner = [6.0, -6.0, 0.0];
    let (free, _) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    for elements_per_span in [1, 4] {
        let options = Options { elements_per_span, ..Options::DEFAULT };
        let mut last = free.value;
        for clearance in [0.0, 0.25, 1.0] {
            let obstacles = [Obstacle::point(corner, clearance, Side::LEFT)];
            let curve = Curve::open(&joints).with_obstacles(&obstacles);
            let (report, elements) = solved(&curve, &options);
            assert_eq!(report.status, Status::Converged);
            assert!((to_the_left(&elements, corner) - clearance).abs() < 1e-9, "{clearance}");
            assert!(report.value > last, "more clearance costs more");
            last = report.value;
            assert_eq!(report.elements, 2 * elements_per_span as usize);
            // G2 at the contact.
            let (one, other) = (elements_per_span as usize - 1, elements_per_span as usize);
            let [a, b] = [(one, 1.0), (other, 0.0)]
                .map(|(element, t)| measure::at(&elements, element, t).expect("a place"));
            assert!((a.signed_curvature - b.signed_curvature).abs() < 1e-12);
            assert!(distance(a.tangent, b.tangent) < 1e-14);
        }
    }
    // The same place given as a joint: its tangent is what the contact has found.
    let obstacles = [Obstacle::point(corner, 0.25, Side::LEFT)];
    let (touching, elements) = solved(&Curve::open(&joints).with_obstacles(&obstacles), &Options::DEFAULT);
    let through = [joints[0], Joint::at(elements[0].rows[5]), joints[1]];
    let (fixed, _) = solve_curve(&through, false, &Options::DEFAULT).expect("good data");
    close(fixed.value, touching.value, 1e-7, "through the contact");

    // What lies far off, or on the right side already, changes nothing.
    for obstacles in
        [[Obstacle::point([6.0, 5.0, 0.0], 0.5, Side::LEFT)], [Obstacle::point(corner, 0.1, Side::RIGHT)]]
    {
        let (report, _) = solved(&Curve::open(&joints).with_obstacles(&obstacles), &Options::DEFAULT);
        assert_eq!(report.elements, 1);
        assert_eq!(report.value, free.value);
    }
}

/// Random waves past random obstacles, some of them within reach of a joint: where a minimum is claimed, a look at many
/// places finds none too near. Not all have one.
#[test]
fn no_obstacle_is_too_near_to_a_curve_that_converged() {
    let mut seed = 11u64;
    let mut random = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut converged, mut touching) = (0, 0);
    for case in 0..300 {
        let joints: Vec<Joint> =
            (0..4).map(|i| Joint::at([f64::from(i) + 0.2 * random(), 0.6 * random(), 0.0])).collect();
        let mut point = || [0.3 + 2.4 * random(), 0.8 * random() - 0.1, 0.0];
        let (from, to) = (point(), point());
        let clearance = 0.12 * random();
        let side = if random() < 0.5 { Side::LEFT } else { Side::RIGHT };
        let obstacles = if random() < 0.5 {
            [Obstacle::point(from, clearance, side)]
        } else {
            [Obstacle::segment(from, to, clearance, side)]
        };
        let (report, elements) = solved(
            &Curve::open(&joints).with_obstacles(&obstacles),
            &Options { max_iterations: 100, ..Options::DEFAULT },
        );
        if report.status != Status::Converged {
            continue;
        }
        converged += 1;
        touching += usize::from(report.elements > 3);
        let sign = if side == Side::LEFT { 1.0 } else { -1.0 };
        for step in 0..=200 {
            let share = f64::from(step) / 200.0;
            let [a, b] = [obstacles[0].from, obstacles[0].to];
            let place: [f64; 3] = std::array::from_fn(|d| a[d] + share * (b[d] - a[d]));
            let found = measure::closest(&elements, place).expect("a place");
            let ends = (found.element == 0 && found.parameter == 0.0)
                || (found.element + 1 == elements.len() && found.parameter == 1.0);
            if !ends {
                let left = to_the_left(&elements, place);
                assert!(sign * left > clearance - 1e-6, "case {case}, at {share}: {left}, not {clearance}");
            }
        }
    }
    assert!(converged > 140 && touching > 40, "{converged} of 300 converged, {touching} touch");
}

#[test]
fn a_curve_passes_under_a_ceiling() {
    let joints = [Joint::at([0.0, 0.0, 0.0]), Joint::at([2.0, 2.7, 0.0]), Joint::at([6.0, 1.2, 0.0])];
    let obstacles = [Obstacle::segment([1.0, 2.9, 0.0], [4.0, 2.9, 0.0], 0.05, Side::LEFT)];
    let options = Options { elements_per_span: 2, ..Options::DEFAULT };
    let (report, elements) = solved(&Curve::open(&joints).with_obstacles(&obstacles), &options);
    assert_eq!(report.status, Status::Converged);
    let [_, high] = measure::bounding_box(&elements).expect("a box");
    assert!((high[1] - 2.85).abs() < 1e-8, "{}", high[1]);
    for step in 0..=30 {
        let x = 1.0 + 0.1 * f64::from(step);
        assert!(to_the_left(&elements, [x, 2.9, 0.0]) > 0.05 - 1e-8, "{x}");
    }
}

#[test]
fn obstacles_that_cannot_be_are_refused() {
    let joints = coving();
    let refuse = |obstacle: Obstacle, options: &Options| {
        workspace_len(&Curve::open(&joints).with_obstacles(&[obstacle]), options).expect_err("refused")
    };
    let good = Obstacle::point([6.0, -6.0, 0.0], 0.25, Side::LEFT);
    let bad = CurveError::BadObstacle { obstacle: 0 };
    for clearance in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refuse(Obstacle { clearance, ..good }, &Options::DEFAULT), bad);
    }
    assert_eq!(refuse(Obstacle { from: [f64::NAN, 0.0, 0.0], ..good }, &Options::DEFAULT), bad);
    assert_eq!(refuse(Obstacle { side: Side(2), ..good }, &Options::DEFAULT), bad);
    let not = CurveError::ObstaclesNotPossible;
    assert_eq!(refuse(good, &Options { tolerance: 1e-3, ..Options::DEFAULT }), not);
    assert_eq!(refuse(good, &Options { length: 30.0, ..Options::DEFAULT }), not);
    assert_eq!(refuse(good, &Options { dimension: 3, ..Options::DEFAULT }), not);
    let above = Obstacle::point([6.0, -6.0, 1.0], 0.25, Side::LEFT);
    assert_eq!(refuse(above, &Options::DEFAULT), not);
}

/// At a given length the scale-invariant functionals are a constant times the plain ones, and so are their minima. A curve
/// that is shorter than its minimum is under tension; one that is longer is under negative tension, which alone has no
/// minimum.
#[test]
fn every_functional_meets_a_given_length_with_one_minimum() {
    for elements_per_span in [1, 4] {
        for length in [8.2, 9.0] {
            let solve = |functional| {
                let options = Options { functional, length, elements_per_span, ..Options::DEFAULT };
                let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
                let what = format!("{functional:?}, {elements_per_span} elements a span, length {length}");
                assert_eq!(report.status, Status::Converged, "{what}");
                assert!(report.iterations <= 150, "{what}: {} iterations", report.iterations);
                close(report.length, length, 1e-10, &what);
                close(report.value, report.fine_value, 1e-6, &what);
                report
            };
            let cube = length * length * length;
            for (plain, invariant, factor) in
                [(Functional::MVC, Functional::SI_MVC, cube), (Functional::MEC, Functional::SI_MEC, length)]
            {
                let [plain, invariant] = [plain, invariant].map(solve);
                close(invariant.value, plain.value * factor, 1e-8, "scale-invariant");
            }
        }
    }
}

#[test]
fn a_given_length_is_met_and_costs_what_the_truth_says() {
    let truth = truth();
    let [v, e, _] = truth[&("woodford".to_owned(), "mvc at l=8.4".to_owned())];
    // E, which is not minimised, is known to the square root of what V is.
    for (elements_per_span, allowed_v, allowed_e) in [(1, 1e-4, 1e-4), (2, 1e-8, 5e-7), (4, 1e-8, 1e-8)] {
        let options = Options { length: 8.4, elements_per_span, ..Options::DEFAULT };
        let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged, "{elements_per_span}");
        close(report.length, 8.4, 1e-10, "length");
        close(report.variation, v, allowed_v, "V");
        close(report.bending, e, allowed_e, "E");
    }
}

#[test]
fn the_curves_with_and_without_a_loop_are_both_listed() {
    use minvar_tests::appendix::figure;
    use minvar_tests::compare::kernel_joints;
    let truth = truth();
    let figure = figure("4.9-1");
    let joints = kernel_joints(&figure);
    let curve = Curve::new(&joints, figure.closed);
    let options = Options { elements_per_span: 2, ..Options::DEFAULT };
    let len = elements_len(&curve, &options);
    let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
    let (usual, _) = solved(&curve, &options);
    for room in [1, 2, 8] {
        let mut elements = vec![Element::ZERO; (room + 1) * len];
        let mut reports = vec![usual; room];
        let found = minima(&curve, &options, &mut workspace, &mut elements, &mut reports, &mut Silent)
            .expect("good data");
        assert!(found <= room && found >= room.min(2), "{found}");
        assert!(reports[..found].windows(2).all(|pair| pair[0].value < pair[1].value), "the lowest first");
        for (index, report) in reports[..found].iter().enumerate() {
            let chain = &elements[index * len..(index + 1) * len];
            close(measure::variation(chain), report.variation, 1e-9, "its own elements");
        }
        if room == 8 {
            for name in ["loop", "no_loop"] {
                let [v, _, l] = truth[&(name.to_owned(), "mvc".to_owned())];
                let listed = reports[..found].iter().any(|report| {
                    (report.variation - v).abs() < 1e-4 * v && (report.length - l).abs() < 1e-4 * l
                });
                assert!(listed, "{name}");
            }
        }
    }
    let error = minima(&curve, &options, &mut workspace, &mut [Element::ZERO; 3], &mut [usual], &mut Silent);
    assert_eq!(error, Err(CurveError::ElementsTooShort { needed: 2 * len, given: 3 }));
}

#[test]
fn a_continuation_under_tension_leads_to_the_short_curve() {
    use minvar_tests::appendix::figure;
    use minvar_tests::compare::kernel_joints;
    let truth = truth();
    // The start tangents of the figure with the loop.
    let figure = figure("4.9-1");
    let joints = kernel_joints(&figure);
    let [looped, _, _] = truth[&("loop".to_owned(), "mvc".to_owned())];
    let (usual, _) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    close(usual.value, looped, 1e-2, "with the loop");
    // Where there is one minimum, the way to it makes no difference.
    for continuation in [1, 4, 8] {
        let options = Options { continuation, ..Options::DEFAULT };
        let (report, _) = solve_curve(&woodford(), false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged, "{continuation}");
        close(report.value, 1.153720856, 2e-5, "Woodford");
    }
    let of =
        |continuation| workspace_len(&Curve::open(&joints), &Options { continuation, ..Options::DEFAULT });
    assert!(of(16).is_ok());
    let error = of(17);
    assert_eq!(error, Err(CurveError::BadOption(OptionName::Continuation)));
    // Data without a minimum have none on this way either.
    let options = Options { continuation: 6, ..Options::DEFAULT };
    for degrees in [120.0, 150.0, -150.0] {
        let (report, _) = solve_curve(&s_curve(degrees), false, &options).expect("good data");
        assert_ne!(report.status, Status::Converged, "{degrees}");
    }
}

/// An antisymmetric S has a minimum up to 112.16 degrees (`truth.rs`): beyond, at every whole degree and to either
/// side, the curve grows without limit.
#[test]
fn every_s_beyond_its_last_minimum_is_unbounded() {
    for degrees in (113..=180).flat_map(|degrees| [f64::from(degrees), -f64::from(degrees)]) {
        let (report, _) = solve_curve(&s_curve(degrees), false, &Options::DEFAULT).expect("good data");
        assert_eq!(report.status, Status::Unbounded, "{degrees} degrees");
    }
}

#[test]
fn what_grows_without_limit_is_said_to_within_few_iterations() {
    for degrees in [120.0, 150.0, 180.0] {
        for sign in [1.0, -1.0] {
            let (report, _) =
                solve_curve(&s_curve(sign * degrees), false, &Options::DEFAULT).expect("good data");
            assert_eq!(report.status, Status::Unbounded, "{degrees}");
            assert!(report.iterations <= 150, "{degrees}: {}", report.iterations);
            let options =
                Options { functional: Functional::SI_MVC, elements_per_span: 4, ..Options::DEFAULT };
            let (report, _) = solve_curve(&s_curve(sign * degrees), false, &options).expect("good data");
            assert_eq!(report.status, Status::Converged, "{degrees}: the advice is good");
        }
    }
}

#[test]
fn points_on_a_line_in_space_are_in_a_plane_wherever_the_line_points() {
    for direction in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 3.0, 4.0], [1.0, -2.0, 2.0]] {
        let points = [0.0, 1.0, 2.5].map(|t| Joint::at(direction.map(|x: f64| x * t)));
        let (report, _) = solve_curve(&points, false, &Options::DEFAULT).expect("good data");
        assert!(report.planar && report.status == Status::Converged, "{direction:?}: {report:?}");
        let size = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        close(report.length, 2.5 * size, 1e-9, "length");
        assert!(report.value < 1e-12, "{report:?}");
    }
}

#[test]
fn bending_beside_an_energy_weighs_the_energy_and_changes_no_curve() {
    let options = Options { functional: Functional::MEC, ..Options::DEFAULT };
    let (plain, elements) = solve_curve(&woodford(), false, &options).expect("good data");
    let (more, same) =
        solve_curve(&woodford(), false, &Options { bending: 0.5, ..options }).expect("good data");
    assert_eq!((plain.status, more.status), (Status::Converged, Status::Converged));
    close(more.value, 1.5 * plain.value, 1e-9, "value");
    close(more.fine_value, 1.5 * plain.fine_value, 1e-9, "fine value");
    close(more.fine_value, 1.5 * more.bending, 1e-12, "of its integral");
    assert!(deviation(&elements, &same, 6) < 1e-6);
}

#[test]
fn iterations_tell_the_functional_in_the_callers_unit() {
    for scale in [1.0_f64, 1e-3, 1e4] {
        let joints = WOODFORD.map(|[x, y]| Joint::at([scale * x, scale * y, 0.0]));
        // With the power of length that makes it free of a scale, and that by which it sinks with one.
        for (functional, lengths, power, tension, bending) in [
            (Functional::MVC, 0, 3, 0.0, 0.0),
            (Functional::MVC, 0, 3, 0.3, 0.0),
            (Functional::MVC, 0, 3, 0.0, 0.7),
            (Functional::MEC, 0, 1, 0.0, 0.0),
            (Functional::MEC, 0, 1, 0.2, 0.0),
            (Functional::SI_MVC, 3, 0, 0.0, 0.0),
            (Functional::SI_MEC, 1, 0, 0.0, 0.0),
        ] {
            let options = Options {
                functional,
                tension: tension / scale.powi(power + 1),
                bending: bending / (scale * scale),
                relative_decrease: 1e-3,
                ..Options::DEFAULT
            };
            let curve = Curve::open(&joints);
            let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
            let mut elements = vec![Element::ZERO; elements_len(&curve, &options)];
            let mut records = vec![Record::ZERO; 50];
            let report = solve(&curve, &options, &mut workspace, &mut elements, &mut records, &mut Silent)
                .expect("good data");
            assert_eq!(report.status, Status::Converged);
            // Nothing but the directions in arc length moved: what they tell is the true curve's.
            assert!(report.linearisations == 0 && report.iterations > 1, "{functional:?}: {report:?}");
            let Report { variation, bending: energy, length, .. } = report;
            let own =
                if [Functional::MVC, Functional::SI_MVC].contains(&functional) { variation } else { energy };
            let whole = own * length.powi(lengths) + options.tension * length + options.bending * energy;
            let told = records[report.iterations - 1].value;
            close(told, whole, 2e-3, &format!("{functional:?} with {tension} and {bending} at {scale:e}"));
        }
    }
}

#[test]
fn a_closed_curve_with_obstacles_does_not_know_where_it_begins() {
    let points = [[0.0, 0.0], [3.0, -0.5], [4.0, 2.0], [2.0, 4.0], [-0.5, 2.5]];
    let given: Vec<Joint> = points.map(|[x, y]| Joint::at([x, y, 0.0])).to_vec();
    let (_, free) = solve_curve(&given, true, &Options::DEFAULT).expect("good data");
    // A little too near to a foot beside a joint: from there it lies in the last span, or in the first.
    let beside = |element: usize, t: f64| {
        let at = measure::at(&free, element, t).expect("a place");
        [at.point[0] - 0.12 * at.tangent[1], at.point[1] + 0.12 * at.tangent[0], 0.0]
    };
    for place in [[1.2, -0.9, 0.0], [-0.4, 0.15, 0.0], [-0.75, 1.0, 0.0], beside(4, 0.97), beside(0, 0.03)] {
        let mut first_value = None;
        for first in 0..points.len() {
            for backwards in [false, true] {
                let mut joints = given.clone();
                joints.rotate_left(first);
                if backwards {
                    joints.reverse();
                }
                let (side, sign) = if backwards { (Side::RIGHT, -1.0) } else { (Side::LEFT, 1.0) };
                let obstacles = [Obstacle::point(place, 0.125, side)];
                let curve = Curve::new(&joints, true).with_obstacles(&obstacles);
                let (report, elements) = solved(&curve, &Options::DEFAULT);
                assert_eq!(report.status, Status::Converged, "{place:?} from {first}");
                assert!(
                    (sign * to_the_left(&elements, place) - 0.125).abs() < 1e-9,
                    "{place:?} from {first}"
                );
                // One element a span has several minima next to each other.
                close(report.value, *first_value.get_or_insert(report.value), 3e-4, "the functional");
            }
        }
    }
}

/// A joint that is free to slide along the curve goes down with its elements; with contacts it has as much room for that.
#[test]
fn a_curve_with_free_joints_keeps_clear_of_its_obstacles() {
    for closed in [false, true] {
        for given in [2, 3] {
            let mut joints = even_joints(6);
            for joint in joints.iter_mut().skip(1).step_by(given) {
                joint.position.given = Given::INITIAL;
            }
            let (_, free) = solve_curve(&joints, closed, &Options::DEFAULT).expect("good data");
            let place = measure::at(&free, 2, 0.4).expect("a place");
            for side in [Side::LEFT, Side::RIGHT] {
                let obstacles = [Obstacle::point(place.point, 0.03, side)];
                let curve = Curve::new(&joints, closed).with_obstacles(&obstacles);
                let (report, elements) = solved(&curve, &Options::DEFAULT);
                assert_eq!(report.status, Status::Converged, "{closed} {given} {side:?}");
                let left = to_the_left(&elements, place.point);
                let clear = if side == Side::LEFT { left } else { -left };
                assert!(clear > 0.03 - 1e-7, "{closed} {given} {side:?}: {clear}");
            }
        }
    }
}

/// Joints around an oval.
fn even_joints(count: usize) -> Vec<Joint> {
    (0..count)
        .map(|k| {
            let angle = k as f64 * std::f64::consts::TAU / count as f64;
            Joint::at([2.0 * angle.cos(), 1.5 * angle.sin(), 0.0])
        })
        .collect()
}

#[test]
fn what_lies_beyond_the_ends_of_an_open_curve_is_no_obstacle() {
    let joints = woodford();
    let (free, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    for (element, t, ahead) in [(5, 1.0, 0.1), (0, 0.0, -0.1)] {
        let end = measure::at(&elements, element, t).expect("a place");
        let place = add(end.point, times(end.tangent, ahead));
        for side in [Side::LEFT, Side::RIGHT] {
            let obstacles = [Obstacle::point(place, 0.5, side)];
            let (report, _) = solved(&Curve::open(&joints).with_obstacles(&obstacles), &Options::DEFAULT);
            assert_eq!((report.status, report.elements), (Status::Converged, 6), "{element} {side:?}");
            assert_eq!(report.value, free.value);
        }
    }
}

#[test]
fn left_of_a_curve_is_about_the_normal_whose_largest_coordinate_is_positive() {
    let corner = [6.0, -6.0, 0.0];
    let flat = [Obstacle::point(corner, 0.25, Side::LEFT)];
    let (wanted, _) = solved(&Curve::open(&coving()).with_obstacles(&flat), &Options::DEFAULT);
    for towards in [
        [0.3, -0.4, 1.0],
        [1.0, -0.6, 0.5],
        [-0.7, 1.0, -0.2],
        [0.3, 0.4, -1.0],
        [-1.0, 0.6, 0.5],
        [0.7, -1.0, 0.2],
    ] {
        let normal = unit(towards);
        let first = unit(cross([0.1, 0.2, 1.0], normal));
        let axes = [first, cross(normal, first)];
        let turned = |[x, y, _]: [f64; 3]| add(times(axes[0], x), times(axes[1], y));
        // About `normal` it lies to the left; where that points the other way, to the right.
        let largest = normal.into_iter().fold(0.0_f64, |most, x| if x.abs() > most.abs() { x } else { most });
        let side = if largest > 0.0 { Side::LEFT } else { Side::RIGHT };
        let joints = coving().map(|joint| {
            let tangent = turned(joint.tangent[0].value);
            Joint::at(turned(joint.position.value)).with_tangent(Quantity::fixed(tangent))
        });
        let obstacles = [Obstacle::point(turned(corner), 0.25, side)];
        let (report, elements) = solved(&Curve::open(&joints).with_obstacles(&obstacles), &Options::DEFAULT);
        assert_eq!((report.status, report.elements), (wanted.status, wanted.elements), "{towards:?}");
        close(report.value, wanted.value, 1e-9, "the functional");
        let found = measure::plane_normal(&elements).expect("planar");
        assert!(distance(found, times(normal, largest.signum())) < 1e-12, "{towards:?}: {found:?}");
    }
}

#[test]
fn a_curvature_of_given_size_bends_the_way_of_the_curve_to_either_side() {
    // The value runs along the tangent: it says nothing of the side.
    let size = Quantity::of_size([0.0, 0.25, 0.0]);
    let mut values = Vec::new();
    for side in [1.0, -1.0] {
        let joints = [
            Joint::at([0.0; 3]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0])).with_curvature(size),
            Joint::at([side, 2.0, 0.0]),
            Joint::at([side * 2.5, 3.0, 0.0]),
        ];
        let (report, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
        assert_eq!(report.status, Status::Converged);
        let bend = measure::at(&elements, 0, 0.0).expect("a place").curvature;
        assert!(distance(bend, [side * 0.25, 0.0, 0.0]) < 1e-12, "{bend:?}");
        values.push(report.value);
    }
    close(values[0], values[1], 1e-12, "mirrored");
}

#[test]
fn what_an_observer_is_told_is_in_the_callers_unit() {
    let run = |scale: f64, functional| {
        let joints = woodford().into_iter().map(|joint| Joint::at(joint.position.value.map(|x| scale * x)));
        let joints: Vec<Joint> = joints.collect();
        let curve = Curve::open(&joints);
        // Two elements a span: after the directions in arc length, steps of the elements are needed.
        let options = Options { functional, elements_per_span: 2, ..Options::DEFAULT };
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut elements = vec![Element::ZERO; elements_len(&curve, &options)];
        let mut records = vec![Record::ZERO; 60];
        let report = solve(&curve, &options, &mut workspace, &mut elements, &mut records, &mut Silent);
        records.truncate(report.expect("good data").iterations);
        records
    };
    // Units are powers of two: the same bits.
    for (functional, power) in [(Functional::MVC, 3), (Functional::MEC, 1), (Functional::SI_MVC, 0)] {
        let plain = run(1.0, functional);
        assert!(plain.iter().any(|record| record.predicted > 0.0 && record.gradient > 0.0));
        for scale in [8.0_f64, 1.0 / 64.0] {
            let unit = scale.powi(-power);
            let scaled = run(scale, functional);
            assert_eq!(scaled.len(), plain.len());
            for (a, b) in plain.iter().zip(&scaled) {
                let told = [a.value, a.predicted, a.actual, a.gradient].map(|x| x * unit);
                assert_eq!([b.value, b.predicted, b.actual, b.gradient], told, "{functional:?} {scale}");
                assert_eq!([b.step, b.shift], [a.step, a.shift], "{functional:?} {scale}");
            }
        }
    }
}

#[test]
fn an_update_does_not_look_at_a_tolerance() {
    let joints = woodford();
    let options = Options { elements_per_span: 4, ..Options::DEFAULT };
    let (_, start) = solve_curve(&joints, false, &options).expect("good data");
    let mut moved = joints;
    moved[3].position.value[1] += 0.05;
    let curve = Curve::open(&moved);
    let [plain, tolerant] = [0.0, 1e-2].map(|tolerance| {
        let options = Options { tolerance, ..options };
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut elements = start.clone();
        let report = update(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
        (report.expect("good data"), elements)
    });
    assert_eq!(plain, tolerant);
}
