//! A status is true: what is called converged is a regular curve whose functional a finer quadrature confirms, and what
//! has no minimum is not called converged.

use minvar::curve::{Element, Functional, Joint, Options, Quantity, measure};
use minvar::solve::Status;
use minvar_tests::appendix::figure;
use minvar_tests::ceres;
use minvar_tests::compare::ours;
use minvar_tests::curves::solve_curve;

/// Seven points of a gentle walk.
const CASE: [[f64; 2]; 7] = [
    [0.0, 0.0],
    [1.1982621158953246, 0.1216238509801326],
    [2.397445714719558, 0.16236723098342054],
    [3.5227889661992897, 0.4102663879546233],
    [4.025473473184383, 1.2261369154516812],
    [4.762683872527625, 2.237685658232108],
    [5.081508768106451, 3.503210630250191],
];

fn points(points: &[[f64; 2]]) -> Vec<Joint> {
    points.iter().map(|&[x, y]| Joint::at([x, y, 0.0])).collect()
}

/// The least cosine between the directions of a chain at neighbouring places, 200 an element.
fn sharpest_turn(elements: &[Element]) -> f64 {
    let mut least = 1.0f64;
    for (index, _) in elements.iter().enumerate() {
        let mut before: Option<[f64; 3]> = None;
        for k in 0..=200 {
            let tangent =
                measure::at(elements, index, f64::from(k) / 200.0).expect("a tangent everywhere").tangent;
            if let Some(before) = before {
                least = least.min((0..3).map(|d| before[d] * tangent[d]).sum());
            }
            before = Some(tangent);
        }
    }
    least
}

#[test]
fn data_that_double_back_on_a_line_are_never_converged_to_a_folded_line() {
    let back = |x| Joint::at([x, 0.0, 0.0]).with_tangent(Quantity::fixed([-1.0, 0.0, 0.0]));
    let sets = [
        (vec![back(0.0), back(1.0)], false),
        (points(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]), false),
        (points(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [3.0, 0.0]]), false),
        (points(&[[0.0, 0.0], [3.0, 0.0], [1.0, 0.0]]), true),
        (points(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]), true),
    ];
    for (joints, closed) in sets {
        for elements_per_span in [1, 2, 3] {
            let options = Options { elements_per_span, ..Options::DEFAULT };
            let (report, elements) = solve_curve(&joints, closed, &options).expect("good data");
            if report.status == Status::Converged {
                assert!(sharpest_turn(&elements) > 0.9, "a cusp called converged");
                assert!(report.fine_value <= report.value * 1.001 + 1e-9, "{report:?}");
            }
        }
    }
}

#[test]
fn antisymmetric_s_curves_converge_up_to_their_limit_and_not_beyond() {
    let solve = |degrees: f64, elements_per_span| {
        let angle = degrees.to_radians();
        let tangent = Quantity::fixed([libm::cos(angle), libm::sin(angle), 0.0]);
        let joints = [-2.0, 2.0].map(|x| Joint::at([x, 0.0, 0.0]).with_tangent(tangent));
        solve_curve(&joints, false, &Options { elements_per_span, ..Options::DEFAULT }).expect("good data").0
    };
    for degrees in [30.0, 60.0, 90.0] {
        for elements_per_span in [1, 2, 4] {
            assert_eq!(solve(degrees, elements_per_span).status, Status::Converged, "{degrees}");
        }
    }
    let steep = solve(110.0, 8);
    assert_eq!(steep.status, Status::Converged);
    assert!(
        (steep.variation / 1.5961 - 1.0).abs() < 1e-4 && (steep.length / 6.833 - 1.0).abs() < 1e-3,
        "{steep:?}"
    );
    for degrees in [120.0, 150.0, 170.0, 180.0] {
        for elements_per_span in [1, 2, 4] {
            let status = solve(degrees, elements_per_span).status;
            assert!(status != Status::Converged, "{degrees}° with {elements_per_span}: {status:?}");
        }
    }
}

#[test]
fn many_elements_reach_the_true_curve_too() {
    for (id, elements_per_span, truth) in [
        ("4.11", 16, 1.15372084),
        ("4.11", 64, 1.15372084),
        ("4.22", 64, 0.0083516963),
        ("4.16", 64, 4.4864395),
    ] {
        let (report, _) = ours(&figure(id), ceres::Functional::Mvc, elements_per_span);
        assert_eq!(report.status, Status::Converged, "{id} with {elements_per_span}");
        assert!((report.variation / truth - 1.0).abs() < 1e-8, "{id}: {}", report.variation);
    }
}

#[test]
fn an_energy_does_not_hide_in_an_element_that_nearly_stops() {
    // A walk for which one element once stopped at a joint and kept a curvature of 44 there out of sight.
    let joints = points(&CASE);
    for elements_per_span in [1, 2] {
        let options = Options { functional: Functional::MEC, elements_per_span, ..Options::DEFAULT };
        let (report, elements) = solve_curve(&joints, false, &options).expect("good data");
        assert_eq!(report.status, Status::Converged);
        let [least, largest] = measure::curvature_range(&elements).expect("a regular curve");
        assert!(least.signed_curvature > -0.6 && largest.signed_curvature < 1.3, "{largest:?}");
    }
}

/// Nearly a whole turn around, with an end that looks a little aside: such data grow at first, and get few iterations then.
#[test]
fn what_the_least_speed_keeps_from_its_minimum_is_not_converged() {
    // The short span is all but straight, and one element of it would rather stop at its end.
    let joints = [
        Joint::at([-9.75, -10.0, 0.0])
            .with_tangent(Quantity::initial([-7.0, -10.0, 0.0]))
            .with_curvature(Quantity::initial([1.638463841038081, -1.1469246887266566, 0.0])),
        Joint::at([-9.75, 0.0, 0.0]),
        Joint::at([-10.0, 0.0, 0.0]),
        Joint::at([-9.0, -10.0, -10.0]),
    ];
    let solved = |elements_per_span| {
        let options = Options { functional: Functional::MEC, elements_per_span, ..Options::DEFAULT };
        solve_curve(&joints, false, &options).expect("good data").0
    };
    let (one, two) = (solved(1), solved(2));
    assert_eq!((one.status, two.status), (Status::Stalled, Status::Converged));
    assert!(one.fine_value > two.fine_value * (1.0 + 5e-6), "{one:?}\n{two:?}");
}

#[test]
fn the_iteration_limit_is_named_only_where_it_was_reached() {
    for gap in [0.05f64, 0.02, 0.01] {
        let end = |at: f64, towards: f64| {
            Joint::at([libm::cos(at), libm::sin(at), 0.0]).with_tangent(Quantity::fixed([
                -libm::sin(towards),
                libm::cos(towards),
                0.0,
            ]))
        };
        let last = std::f64::consts::TAU - 0.5 * gap;
        let joints = [end(0.5 * gap, 0.5 * gap), end(last, last + 0.02)];
        for elements_per_span in [1, 2, 4, 8] {
            let options = Options { elements_per_span, ..Options::DEFAULT };
            let (report, _) = solve_curve(&joints, false, &options).expect("good data");
            let named = report.status == Status::IterationLimit;
            assert!(!named || report.iterations == 500, "{gap}, {elements_per_span}: {report:?}");
        }
    }
}

#[test]
fn a_limit_on_the_way_to_many_elements_loses_nothing() {
    let joints = points(&CASE);
    let solve = |elements_per_span, max_iterations| {
        let options = Options { elements_per_span, max_iterations, ..Options::DEFAULT };
        solve_curve(&joints, false, &options).expect("good data").0
    };
    for max_iterations in [1, 2, 3] {
        let (one, four) = (solve(1, max_iterations), solve(4, max_iterations));
        assert_eq!(four.status, Status::IterationLimit);
        assert_eq!(four.iterations, max_iterations as usize);
        assert!(four.fine_value <= one.fine_value * (1.0 + 1e-6), "{} {}", four.fine_value, one.fine_value);
    }
}
