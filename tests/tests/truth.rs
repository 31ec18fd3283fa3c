//! True planar curves (`minvar_tests::truth`): their figures to twelve digits (`tests/data/truth.csv`), and that they are
//! what they claim to be: solutions of the Euler–Lagrange equations, minima, and what minvar's elements approach.
//!
//! In the table `mvc+0.5l` means `V + 0.5 L`, `mec at l=8.4` means `E` of all curves of that length, `si-mvc` `L³ V` and
//! `si-mec` `L E`. Curvature is positive to the left. `s_110` is the S of chord 4 with both end tangents at 110°.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's cosine and powers")]

#[path = "truth/cases.rs"]
mod cases;

use cases::{Case, DEGREE, case, cases, figure_eight, s_curve};
use minvar_tests::appendix::figure;
use minvar_tests::ceres;
use minvar_tests::compare::{ours, rows};
use minvar_tests::curves::gauss_legendre;
use minvar_tests::truth::legendre::{self, Basis};
use minvar_tests::truth::system::System;
use minvar_tests::truth::{Continuity, Functional, Joint, Problem, Span, SpanStart, TrueCurve, solve, start};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::PathBuf;

/// A row of the table: name, functional and [`figures`].
type Row = (String, String, [f64; 6]);

fn table() -> Vec<Row> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/truth.csv");
    let text = fs::read_to_string(path).expect("the table is there");
    text.lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let mut figures = [f64::NAN; 6];
            for (figure, cell) in figures.iter_mut().zip(&cells[2..]) {
                *figure = cell.parse().expect("a number");
            }
            (cells[0].to_owned(), cells[1].to_owned(), figures)
        })
        .collect()
}

/// Variation, bending, length, least and largest curvature, value.
fn figures(curve: &TrueCurve) -> [f64; 6] {
    let [least, largest] = curve.curvature_range();
    [curve.variation, curve.bending, curve.length, least, largest, curve.value]
}

/// Twelve digits, or nothing where the figure is zero.
fn agrees(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() <= 2e-12 * wanted.abs() + 1e-14
}

/// With `--nocapture` it prints the rows as the table has them.
#[test]
fn the_table_has_every_true_curve_to_twelve_digits() {
    let mut wrong = Vec::new();
    let table = table();
    for Case { name, functional, curve, .. } in cases() {
        let found = figures(curve);
        let text = found.map(|x| format!("{:.12e}", if x.abs() < 1e-14 { 0.0 } else { x })).join(",");
        println!("{name},{functional},{text}");
        let row = table.iter().find(|row| row.0 == *name && row.1 == *functional);
        if !row.is_some_and(|row| found.iter().zip(row.2).all(|(&a, b)| agrees(a, b))) {
            wrong.push(format!("{name},{functional},{text}"));
        }
    }
    assert!(wrong.is_empty(), "the table lacks\n{}", wrong.join("\n"));
    assert_eq!(table.len(), cases().len(), "rows without a curve");
}

#[test]
fn ten_degrees_more_change_no_digit() {
    for Case { name, functional, problem, curve, .. } in cases() {
        let finer = solve(problem, &curve.as_start(), DEGREE + 10).expect("solvable");
        let (a, b) = (figures(curve), figures(&finer));
        let same = a.iter().zip(b).all(|(&a, b)| agrees(a, b));
        assert!(same, "{name} {functional}: {a:?}, then {b:?}");
    }
}

#[test]
fn every_curve_is_a_minimum_found_to_rounding() {
    for Case { name, functional, curve, .. } in cases() {
        assert!(curve.is_minimum(), "{name} {functional}: stiffness {:e}", curve.stiffness);
        assert!(curve.residual < 1e-14, "{name} {functional}: residual {:e}", curve.residual);
    }
}

#[test]
fn figures_known_from_elsewhere_are_met() {
    // In the order of the table's columns, as many digits as were known.
    for (name, functional, known) in [
        ("coving", "mvc", ["0.0083516963", "0.189328", "23.9393", "-0.27", "", ""]),
        ("woodford", "mvc", ["1.15372084", "2.55078446", "8.25888442", "-0.770202", "0.961727", ""]),
        ("woodford", "mec", ["", "2.247664001", "", "", "", ""]),
        ("woodford", "si-mvc", ["1.15377437", "2.54786", "8.258628", "", "", ""]),
        ("s_110", "mvc", ["1.5961", "", "6.833", "", "", ""]),
        ("antipodal_s", "si-mvc", ["0.65827", "8.29157", "11.1547", "-1.21789", "1.21789", ""]),
        ("wicket", "si-mec", ["", "3.14159265359", "3.14159265359", "-1", "-1", "9.8696044011"]),
    ] {
        for (found, text) in figures(&case(name, functional).curve).into_iter().zip(known) {
            let Ok(wanted) = text.parse::<f64>() else { continue };
            let digits = text.split_once('.').map_or(0, |(_, digits)| digits.len());
            let last = 10f64.powi(-i32::try_from(digits).expect("few digits"));
            assert!((found - wanted).abs() <= 0.6 * last, "{name} {functional}: {found}, known {text}");
        }
    }
    let [start, end] = case("coving", "mvc").curve.end_curvatures();
    assert!((start + 0.27).abs() < 1e-14 && (end + 0.06540).abs() < 5e-6, "{start}, {end}");
}

/// The elastic figure-8 by Jacobi's functions: `κ = 2 a k cn(a s)` closes where `2 E(k) = K(k)`, and there
/// `L ∫ κ² ds = 64 K² (k² − ½)`.
#[test]
fn the_elastic_figure_eight_is_that_of_euler() {
    // K and E by the arithmetic–geometric mean.
    let complete = |m: f64| {
        let (mut a, mut b, mut power, mut loss) = (1.0, (1.0 - m).sqrt(), 0.5, 0.5 * m);
        for _ in 0..8 {
            let half = 0.5 * (a - b);
            (a, b, power) = (0.5 * (a + b), (a * b).sqrt(), 2.0 * power);
            loss += power * half * half;
        }
        let k = FRAC_PI_2 / a;
        (k, k * (1.0 - loss))
    };
    let (mut low, mut high) = (0.7, 0.9);
    for _ in 0..60 {
        let m = 0.5 * (low + high);
        let (k, e) = complete(m);
        if 2.0 * e > k { low = m } else { high = m }
    }
    let (k, _) = complete(low);
    let found = case("figure_eight", "si-mec at l=10").curve.value;
    let wanted = 64.0 * k * k * (low - 0.5);
    assert!((found / wanted - 1.0).abs() < 1e-13, "{found}, by elliptic integrals {wanted}");
}

#[test]
fn a_figure_eight_of_free_size_is_that_of_a_fixed_length() {
    let (problem, start) = figure_eight(Functional::SI_MVC);
    let free = solve(&problem, &start, 24).expect("solvable");
    let fixed = &case("figure_eight", "si-mvc at l=10").curve;
    assert!(free.is_minimum() && (free.length - 10.0).abs() > 0.1);
    assert!(agrees(free.value, fixed.value), "{} and {}", free.value, fixed.value);
    assert!(fixed.length_force.abs() < 1e-10 * fixed.value, "a force {:e}", fixed.length_force);
}

/// With `f = v κ'² + e κ² + t` and forces that are constant along a span,
/// `2 v κ'''' = 2 e κ'' + κ (v κ'² − 2 v κ κ'' + e κ² − t)`; integrated from the middle of each span to its ends.
#[test]
fn every_span_solves_its_euler_lagrange_equation() {
    for Case { name, functional, problem, curve, .. } in cases() {
        let of = problem.functional;
        let scale = curve.length.powi(of.power);
        // What a longer curve costs besides: the factor of a scale-invariant functional, or the force of a fixed length.
        let tension = of.tension
            + f64::from(of.power) * curve.value / scale / curve.length
            + curve.length_force / scale;
        let (v, e) = (of.variation, of.bending);
        // x, y, θ, κ and its first three derivatives, of which an elastica has but one of its own.
        let flow = |[_, _, angle, k0, k1, k2, k3]: [f64; 7]| {
            let rest = 0.5 * k0 * (v * k1 * k1 - 2.0 * v * k0 * k2 + e * k0 * k0 - tension);
            let [k2, k3, k4] = if v == 0.0 { [-rest / e, 0.0, 0.0] } else { [k2, k3, (e * k2 + rest) / v] };
            [angle.cos(), angle.sin(), k0, k1, k2, k3, k4]
        };
        for (number, span) in curve.spans.iter().enumerate() {
            let [x, y] = span.point(0.5);
            let [k2, k3] = higher_slopes(span);
            let middle = [x, y, span.angle(0.5), span.curvature(0.5), span.curvature_slope(0.5), k2, k3];
            for end in [0.0, 1.0] {
                let reached = integrate(flow, middle, (end - 0.5) * span.length);
                let [x, y] = span.point(end);
                for (found, wanted) in reached.into_iter().zip([x, y, span.angle(end), span.curvature(end)]) {
                    assert!(
                        (found - wanted).abs() < 1e-9 * (1.0 + wanted.abs()),
                        "{name} {functional}, span {number}, towards {end}: {found}, not {wanted}"
                    );
                }
            }
        }
    }
}

/// The second and third derivative of the curvature by arc length in the middle of a span, by series of the slopes.
fn higher_slopes(span: &Span) -> [f64; 2] {
    let degree = span.series.len() - 1;
    let rule = gauss_legendre(degree + 1);
    let slope = |series: &[f64]| {
        let samples: Vec<f64> = rule
            .iter()
            .map(|&(u, _)| legendre::sum(series, &Basis::at(degree, u).slope) / span.length)
            .collect();
        legendre::project(degree, &samples)
    };
    let second = slope(&slope(&span.series));
    let middle = Basis::at(degree, 0.5);
    [&second, &slope(&second)].map(|series| legendre::sum(series, &middle.value) / span.length)
}

/// Runge and Kutta's method of order four.
fn integrate(flow: impl Fn([f64; 7]) -> [f64; 7], from: [f64; 7], over: f64) -> [f64; 7] {
    const STEPS: usize = 2000;
    let h = over / STEPS as f64;
    let moved = |state: [f64; 7], by: f64, along: [f64; 7]| -> [f64; 7] {
        std::array::from_fn(|i| state[i] + by * along[i])
    };
    let mut state = from;
    for _ in 0..STEPS {
        let a = flow(state);
        let b = flow(moved(state, 0.5 * h, a));
        let c = flow(moved(state, 0.5 * h, b));
        let d = flow(moved(state, h, c));
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    state
}

#[test]
fn derivatives_agree_with_differences() {
    const STEP: f64 = 1e-5;
    // Every term of the functional and every kind of condition.
    let functional = Functional { variation: 0.7, bending: 1.3, tension: 0.4, power: 2 };
    let mut joints =
        [[0.0, 0.0], [1.0, 0.8], [2.1, 0.3], [1.2, -0.9]].map(|at| Joint::at(at).with_curvature(0.2));
    joints[1] = Joint { fixed: false, ..Joint::at(joints[1].position) };
    joints[2] = Joint { continuity: Continuity::G1, ..Joint::at(joints[2].position) };
    let problem = Problem { length: Some(7.0), ..Problem::new(joints, true, functional) };
    let (system, x) = System::new(&problem, &start::from_circles(&problem), 5);
    let multipliers: Vec<f64> = (0..system.conditions()).map(|i| (1.7 * i as f64).sin()).collect();
    let lagrangian = |x: &[f64]| {
        let here = system.linearise(x, &multipliers);
        here.value + here.conditions.iter().zip(&multipliers).map(|(c, l)| c * l).sum::<f64>()
    };
    let gradient = |x: &[f64]| -> Vec<f64> {
        let here = system.linearise(x, &multipliers);
        let forces = here.jacobian.transposed_times(&multipliers);
        here.gradient.iter().zip(forces).map(|(g, f)| g + f).collect()
    };
    let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * (1.0 + a.abs());
    let (slopes, hessian) = (gradient(&x), system.linearise(&x, &multipliers).hessian);
    for i in 0..x.len() {
        let moved = |by: f64| {
            let mut x = x.clone();
            x[i] += by;
            x
        };
        let (above, below) = (moved(STEP), moved(-STEP));
        let slope = (lagrangian(&above) - lagrangian(&below)) / (2.0 * STEP);
        assert!(close(slope, slopes[i]), "unknown {i}: {slope}, {}", slopes[i]);
        for (j, (a, b)) in gradient(&above).into_iter().zip(gradient(&below)).enumerate() {
            let second = (a - b) / (2.0 * STEP);
            assert!(close(second, hessian[(i, j)]), "unknowns {i}, {j}: {second}, {}", hessian[(i, j)]);
        }
    }
}

#[test]
fn arcs_through_three_points_lead_to_the_same_curves_as_elements() {
    for name in ["coving", "woodford", "g2_box", "s_curve"] {
        let Case { problem, curve, .. } = case(name, "mvc");
        let found = solve(problem, &start::from_circles(problem), 24).expect("solvable");
        assert!(agrees(found.value, curve.value), "{name}: {}, {}", found.value, curve.value);
    }
}

/// The angle in degrees at which the S of a given length bears no force and so is the MVC, and that S.
fn angle_of_length(length: f64, start: &mut Vec<SpanStart>) -> (f64, TrueCurve) {
    let mut curve_at = |degrees: f64| {
        let problem = Problem { length: Some(length), ..s_curve(degrees, Functional::MVC) };
        let curve = solve(&problem, start, 24).expect("an S of this length");
        *start = curve.as_start();
        curve
    };
    let (mut before, mut angle) = (111.9, 112.0);
    let mut force = curve_at(before).length_force;
    for _ in 0..30 {
        let curve = curve_at(angle);
        if curve.length_force.abs() < 1e-12 {
            return (angle, curve);
        }
        let next = angle - curve.length_force * (angle - before) / (curve.length_force - force);
        (before, angle, force) = (angle, next, curve.length_force);
    }
    panic!("no angle for the length {length}");
}

/// Longer S curves are MVCs of larger angles up to a largest angle (thesis 4.10).
#[test]
fn an_s_curve_has_an_mvc_up_to_112_163671542_degrees() {
    const STEP: f64 = 1e-3;
    let shorter = case("s_110", "mvc").curve.as_start();
    let mut start = shorter.clone();
    let mut length = 7.338;
    let mut largest = 0.0;
    for _ in 0..3 {
        let [a, b, c] =
            [length - STEP, length, length + STEP].map(|length| angle_of_length(length, &mut start).0);
        // The top of the parabola through three angles.
        length -= 0.5 * STEP * (c - a) / (a - 2.0 * b + c);
        largest = b;
    }
    println!("the largest angle {largest:.13}°, length there {length:.9}");
    assert!((largest - 112.163_671_542_17).abs() < 5e-11, "{largest:.13}");

    let short =
        solve(&s_curve(112.16, Functional::MVC), &shorter, 24).expect("an S short of the largest angle");
    assert!(short.is_minimum(), "stiffness {:e}", short.stiffness);
    let beyond = solve(&s_curve(112.17, Functional::MVC), &short.as_start(), 24);
    assert!(beyond.is_err(), "beyond the largest angle: {beyond:?}");
}

#[test]
fn a_stationary_curve_that_is_no_minimum_is_told_from_one() {
    let mut start = case("s_110", "mvc").curve.as_start();
    // Short of the largest angle there is a second, longer S, the pass over which curves grow without limit.
    let (angle, long) = angle_of_length(7.6, &mut start);
    assert!(long.is_minimum(), "of its length it is the best: {:e}", long.stiffness);
    let free = solve(&s_curve(angle, Functional::MVC), &long.as_start(), 24).expect("stationary");
    assert!((free.length - 7.6).abs() < 1e-8, "{}", free.length);
    assert!(!free.is_minimum() && free.stiffness < -0.1, "stiffness {:e}", free.stiffness);
}

#[test]
fn a_chord_is_as_far_from_its_half_circle_as_the_radius() {
    let half_circle = &case("wicket", "mvc").curve;
    for (height, off) in [(0.0, 1.0), (0.3, 0.7)] {
        let [left, right, along, zero] = [[-1.0, height, 0.0], [1.0, height, 0.0], [2.0, 0.0, 0.0], [0.0; 3]];
        let found = half_circle.distance(&[[left, along, zero, zero, along, right]], 10);
        assert!((found - off).abs() < 1e-14, "{found}, not {off}");
    }
}

#[test]
fn more_elements_come_nearer_to_the_true_curve() {
    for (name, id, of, functional, allowed) in [
        ("coving", "4.22", ceres::Functional::Mvc, "mvc", &[4e-4, 3e-5, 4e-7, 5e-9][..]),
        ("woodford", "4.11", ceres::Functional::Mvc, "mvc", &[3e-7, 1e-9, 3e-10]),
        ("woodford", "4.11", ceres::Functional::Mec, "mec", &[4e-7, 4e-8, 4e-9]),
    ] {
        for (elements_per_span, &allowed) in [1, 2, 4, 8].into_iter().zip(allowed) {
            let elements = rows(&ours(&figure(id), of, elements_per_span).1);
            let off = case(name, functional).curve.distance(&elements, 40);
            println!(
                "{name} {functional}, {elements_per_span} elements a span: {off:.1e} off the true curve"
            );
            assert!(off < allowed, "{name} {functional}, {elements_per_span} elements a span: {off:e}");
        }
    }
}
