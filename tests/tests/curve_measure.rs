//! Measuring and converting against closed forms, brute force and an independent de Boor.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's sines")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use minvar::curve::convert::{bspline, bspline_len};
use minvar::curve::measure::{
    at, at_length, bending, bounding_box, closest, curvature_range, length, plane_normal, variation,
};
use minvar::curve::{Continuity, Element, Functional, Joint, MeasureError, Options, Quantity};
use minvar_tests::curves::{
    Vector, add, cross, derivatives, distance, dot, functional_value, norm, shape, solve_curve, sub, times,
    unit,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: count,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x006d_6561_7375_7265),
        max_shrink_iters: 500,
        ..ProptestConfig::default()
    }
}

/// Elements that agree with a curve to second order at even parameters from `from` to `to`.
fn sampled(count: usize, from: f64, to: f64, curve: impl Fn(f64) -> [Vector; 3]) -> Vec<Element> {
    let h = (to - from) / count as f64;
    let element = |i: usize| {
        let [p0, v0, a0] = curve(from + h * i as f64);
        let [p1, v1, a1] = curve(from + h * (i + 1) as f64);
        Element { rows: [p0, times(v0, h), times(a0, h * h), times(a1, h * h), times(v1, h), p1] }
    };
    (0..count).map(element).collect()
}

fn circle(count: usize, radius: f64) -> Vec<Element> {
    sampled(count, 0.0, TAU, |u| {
        let (sin, cos) = u.sin_cos();
        [[cos, sin, 0.0], [-sin, cos, 0.0], [-cos, -sin, 0.0]].map(|v| times(v, radius))
    })
}

fn helix(count: usize, radius: f64, rise: f64) -> Vec<Element> {
    sampled(count, 0.0, 2.0 * TAU, |u| {
        let (sin, cos) = (u.sin() * radius, u.cos() * radius);
        [[cos, sin, rise * u], [-sin, cos, rise], [-cos, -sin, 0.0]]
    })
}

/// `(t, t²/2, 0)` for t from -1 to 2 in three elements: a quintic holds it exactly.
fn parabola() -> Vec<Element> {
    sampled(3, -1.0, 2.0, |t| [[t, 0.5 * t * t, 0.0], [1.0, t, 0.0], [0.0, 1.0, 0.0]])
}

/// `(t, t², t³)` for t from -0.5 to 1.5 in two elements.
fn twisted_cubic() -> Vec<Element> {
    sampled(2, -0.5, 1.5, |t| [[t, t * t, t * t * t], [1.0, 2.0 * t, 3.0 * t * t], [0.0, 2.0, 6.0 * t]])
}

/// A curve with a smooth part, a tangent joint and a corner.
fn solved(closed: bool, space: bool) -> Vec<Element> {
    let z = if space { 0.4 } else { 0.0 };
    let joints = [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([1.0, 0.8, 0.0])),
        Joint::at([1.0, 0.9, z]),
        Joint::at([2.0, 0.7, -z])
            .with_continuity(Continuity::G1)
            .with_tangent(Quantity::fixed([1.0, -0.9, 0.0])),
        Joint::at([2.5, -0.4, 0.0]),
        Joint {
            tangent: [Quantity::fixed([-1.0, -0.5, 0.0]), Quantity::fixed([-1.0, 0.6, 0.0])],
            ..Joint::at([1.2, -0.9, z]).with_continuity(Continuity::G0)
        },
        Joint::at([-0.2, -0.8, 0.0]).with_tangent(Quantity::fixed([-0.5, 1.0, 0.0])),
    ];
    let options = Options { elements_per_span: 2, ..Options::DEFAULT };
    solve_curve(&joints, closed, &options).expect("good data").1
}

fn chains() -> Vec<Vec<Element>> {
    vec![
        solved(false, false),
        solved(true, false),
        solved(false, true),
        solved(true, true),
        circle(7, 2.0),
        helix(9, 1.5, 0.3),
        parabola(),
        twisted_cubic(),
    ]
}

/// Elements one behind the other, common tangents and curvatures where they meet, without near cusps: all go on along x.
fn chain() -> impl Strategy<Value = Vec<Element>> {
    let vector = |along: f64, across: f64| (-along..along, -across..across, -across..across);
    let joint = (vector(0.15, 0.5), vector(0.2, 1.0), vector(1.0, 4.0));
    (prop::collection::vec(joint, 2..6), any::<bool>()).prop_map(|(raw, flat)| {
        let end = |i: usize| {
            let (p, v, a) = raw[i];
            [(i as f64, p), (1.0, v), (0.0, a)].map(|(x, v)| [x + v.0, v.1, if flat { 0.0 } else { v.2 }])
        };
        (0..raw.len() - 1)
            .map(|i| {
                let ([p0, v0, a0], [p1, v1, a1]) = (end(i), end(i + 1));
                Element { rows: [p0, v0, a0, a1, v1, p1] }
            })
            .collect()
    })
}

#[test]
fn a_finely_sampled_circle_has_the_figures_of_the_circle() {
    for radius in [1e-3, 1.0, 250.0] {
        let elements = circle(96, radius);
        assert_relative_eq!(length(&elements), TAU * radius, max_relative = 1e-10);
        assert_relative_eq!(bending(&elements), TAU / radius, max_relative = 1e-8);
        assert!(variation(&elements) * radius.powi(3) < 1e-6);
        assert_eq!(plane_normal(&elements), Some([0.0, 0.0, 1.0]));
        for (k, t) in [(0, 0.0), (7, 0.3), (50, 0.5), (95, 1.0)] {
            let angle = (k as f64 + t) / 96.0 * TAU;
            let found = at(&elements, k, t).expect("on the curve");
            assert_eq!((found.element, found.parameter), (k, t));
            assert_relative_eq!(found.signed_curvature, 1.0 / radius, max_relative = 1e-6);
            assert_relative_eq!(found.arc_length, angle * radius, epsilon = 1e-9 * radius);
            assert!(distance(found.tangent, [-angle.sin(), angle.cos(), 0.0]) < 1e-7);
            assert!(distance(times(found.curvature, radius), [-angle.cos(), -angle.sin(), 0.0]) < 1e-6);
            assert!(distance(found.point, times([angle.cos(), angle.sin(), 0.0], radius)) < 1e-10 * radius);
            assert_eq!(found.torsion, 0.0);
        }
        let [low, high] = bounding_box(&elements).expect("finite");
        for (found, want) in low.iter().zip([-1.0, -1.0, 0.0]).chain(high.iter().zip([1.0, 1.0, 0.0])) {
            assert_abs_diff_eq!(*found, want * radius, epsilon = 1e-10 * radius);
        }
    }
}

#[test]
fn curvature_is_positive_to_the_left_and_vectors_point_to_the_centre() {
    let left = circle(12, 2.0);
    let right: Vec<Element> =
        left.iter().map(|element| Element { rows: element.rows.map(|[x, y, z]| [x, -y, z]) }).collect();
    for (elements, sign) in [(&left, 1.0), (&right, -1.0)] {
        let found = at(elements, 3, 0.5).expect("on the curve");
        assert_relative_eq!(found.signed_curvature, 0.5 * sign, max_relative = 1e-3);
        assert!(dot(found.curvature, found.point) < 0.0);
        assert_abs_diff_eq!(dot(found.curvature, found.tangent), 0.0, epsilon = 1e-15);
        assert_relative_eq!(norm(found.curvature), 0.5, max_relative = 1e-3);
    }
}

#[test]
fn a_right_handed_helix_has_positive_torsion() {
    for (radius, rise) in [(1.0, 0.5), (3.0, 0.2), (0.5, 2.0)] {
        let square: f64 = radius * radius + rise * rise;
        for (hand, rise) in [(1.0, rise), (-1.0, -rise)] {
            let elements = helix(128, radius, rise);
            for (k, t) in [(0, 0.0), (40, 0.7), (127, 1.0)] {
                let found = at(&elements, k, t).expect("on the curve");
                assert_relative_eq!(found.torsion, hand * rise.abs() / square, max_relative = 1e-3);
                assert_relative_eq!(found.signed_curvature, radius / square, max_relative = 1e-5);
            }
            assert_eq!(plane_normal(&elements), None);
            assert_relative_eq!(length(&elements), 2.0 * TAU * square.sqrt(), max_relative = 1e-9);
            // |dκ/ds| = κ τ for the binormal, which turns at the rate of the torsion.
            let v = 2.0 * TAU * square.sqrt() * (radius * rise / square / square).powi(2);
            assert_relative_eq!(variation(&elements), v, max_relative = 1e-3);
        }
    }
}

#[test]
fn a_parabola_has_its_closed_forms() {
    let elements = parabola();
    let arc = |x: f64| 0.5 * (x * (1.0 + x * x).sqrt() + x.asinh());
    for k in 0..3 {
        for t in [0.0, 0.25, 0.5, 1.0] {
            let x = k as f64 - 1.0 + t;
            let w = 1.0 + x * x;
            let found = at(&elements, k, t).expect("on the curve");
            assert!(distance(found.point, [x, 0.5 * x * x, 0.0]) < 1e-14);
            assert!(distance(found.tangent, times([1.0, x, 0.0], 1.0 / w.sqrt())) < 1e-14);
            assert_relative_eq!(found.signed_curvature, w.powf(-1.5), max_relative = 1e-12);
            assert!(distance(found.curvature, times([-x, 1.0, 0.0], 1.0 / (w * w))) < 1e-13);
            assert_abs_diff_eq!(found.curvature_derivative, -3.0 * x / w.powi(3), epsilon = 1e-12);
            assert_abs_diff_eq!(found.arc_length, arc(x) - arc(-1.0), epsilon = 1e-13);
            assert_eq!(found.torsion, 0.0);
        }
    }
    assert_relative_eq!(length(&elements), arc(2.0) - arc(-1.0), max_relative = 1e-14);
    // ∫ κ² ds = ∫ w^(-5/2) dx, ∫ (dκ/ds)² ds = ∫ 9 x² w^(-11/2) dx.
    let energy = |x: f64| x / (1.0 + x * x).sqrt() - (x / (1.0 + x * x).sqrt()).powi(3) / 3.0;
    assert_relative_eq!(bending(&elements), energy(2.0) - energy(-1.0), max_relative = 1e-12);
    let v = |x: f64| {
        let s = x / (1.0 + x * x).sqrt();
        9.0 * (s.powi(3) / 3.0 - 3.0 * s.powi(5) / 5.0 + 3.0 * s.powi(7) / 7.0 - s.powi(9) / 9.0)
    };
    assert_relative_eq!(variation(&elements), v(2.0) - v(-1.0), max_relative = 1e-11);
    let [least, most] = curvature_range(&elements).expect("regular");
    assert_relative_eq!(least.signed_curvature, 5.0f64.powf(-1.5), max_relative = 1e-12);
    assert_relative_eq!(most.signed_curvature, 1.0, max_relative = 1e-12);
    assert!(most.point[0].abs() < 1e-6 && (most.arc_length - arc(0.0) + arc(-1.0)).abs() < 1e-6);
    assert_eq!((least.element, least.parameter), (2, 1.0));
    // The point (0, 1 + h) sees the vertex until h = 0, then two feet at x² = 2 h.
    assert!(distance(closest(&elements, [0.0, 0.9, 0.0]).expect("regular").point, [0.0; 3]) < 1e-7);
    let foot = closest(&elements, [0.01, 1.125, 0.0]).expect("regular").point;
    assert!(foot[0] > 0.4 && foot[0] < 0.6, "{foot:?}");
    let foot = closest(&elements, [-0.01, 1.125, 0.0]).expect("regular").point;
    assert!(foot[0] < -0.4 && foot[0] > -0.6, "{foot:?}");
}

#[test]
fn a_twisted_cubic_has_its_closed_forms() {
    let elements = twisted_cubic();
    let curvature = |t: f64| {
        let (a, b) = (9.0 * t.powi(4) + 9.0 * t * t + 1.0, 9.0 * t.powi(4) + 4.0 * t * t + 1.0);
        2.0 * a.sqrt() / b.powf(1.5)
    };
    for k in 0..2 {
        for t in [0.0, 0.3, 0.9, 1.0] {
            let u = k as f64 - 0.5 + t;
            let found = at(&elements, k, t).expect("on the curve");
            let a = 9.0 * u.powi(4) + 9.0 * u * u + 1.0;
            let speed = (1.0 + 4.0 * u * u + 9.0 * u.powi(4)).sqrt();
            assert_relative_eq!(found.torsion, 3.0 / a, max_relative = 1e-11);
            assert_relative_eq!(found.signed_curvature, curvature(u), max_relative = 1e-12);
            assert_relative_eq!(norm(found.curvature), curvature(u), max_relative = 1e-12);
            let slope = (curvature(u + 1e-5) - curvature(u - 1e-5)) / 2e-5 / speed;
            assert_abs_diff_eq!(found.curvature_derivative, slope, epsilon = 1e-8);
        }
    }
}

#[test]
fn values_of_functionals_agree_with_an_independent_quadrature() {
    for elements in chains() {
        assert_relative_eq!(length(&elements), minvar_tests::curves::length(&elements), max_relative = 1e-10);
        let v = functional_value(Functional::MVC, &elements);
        assert_relative_eq!(variation(&elements), v, max_relative = 1e-8, epsilon = 1e-12);
        let e = functional_value(Functional::MEC, &elements);
        assert_relative_eq!(bending(&elements), e, max_relative = 1e-8);
    }
}

#[test]
fn the_plane_of_a_planar_chain_is_found_and_a_space_curve_has_none() {
    let flat = solved(false, false);
    let exchanged = |by: usize| -> Vec<Element> {
        let row = |row: Vector| std::array::from_fn(|d| row[(d + 3 - by) % 3]);
        flat.iter().map(|element| Element { rows: element.rows.map(row) }).collect()
    };
    assert_eq!(plane_normal(&exchanged(0)), Some([0.0, 0.0, 1.0]));
    assert_eq!(plane_normal(&exchanged(1)), Some([1.0, 0.0, 0.0]));
    assert_eq!(plane_normal(&exchanged(2)), Some([0.0, 1.0, 0.0]));
    assert_eq!(plane_normal(&solved(false, true)), None);
    assert_eq!(plane_normal(&[]), None);
    let axes = [[2.0, 3.0, 6.0], [3.0, -6.0, 2.0]].map(unit);
    let normal = times([6.0, 2.0, -3.0], 1.0 / 7.0);
    let tilted: Vec<Element> = flat
        .iter()
        .map(|element| Element {
            rows: element.rows.map(|[x, y, _]| add(times(axes[0], x), times(axes[1], y))),
        })
        .collect();
    let found = plane_normal(&tilted).expect("planar");
    assert!(distance(found, normal) < 1e-12, "{found:?} {normal:?}");
    // A straight chain has a normal, perpendicular to it.
    let straight = sampled(3, 0.0, 3.0, |t| [[t, t, t], [1.0, 1.0, 1.0], [0.0; 3]]);
    let found = plane_normal(&straight).expect("planar");
    assert_abs_diff_eq!(dot(found, [1.0, 1.0, 1.0]), 0.0, epsilon = 1e-14);
    assert_abs_diff_eq!(norm(found), 1.0, epsilon = 1e-14);
}

/// A chain that is turned has its extremes of curvature at the same places, signed by a normal of which the largest
/// coordinate is positive.
#[test]
fn a_tilted_plane_has_the_extremes_of_curvature_of_a_level_one() {
    let level = solved(false, false);
    let wanted = curvature_range(&level).expect("a regular chain");
    for normal in [[0.3, -0.4, 0.9], [0.8, 0.3, -0.2], [-0.3, 0.7, 0.5], [0.6, 0.59, 0.58], [0.9, -0.1, 0.3]]
    {
        let normal = unit(normal);
        let first = unit(cross(normal, [0.6, -0.64, 0.48]));
        let second = cross(normal, first);
        let turned: Vec<Element> = level
            .iter()
            .map(|element| Element {
                rows: element
                    .rows
                    .map(|[x, y, z]| std::array::from_fn(|d| x * first[d] + y * second[d] + z * normal[d])),
            })
            .collect();
        let found = curvature_range(&turned).expect("a regular chain");
        for (found, wanted) in found.iter().zip(&wanted) {
            assert_eq!(found.element, wanted.element, "{normal:?}");
            assert!((found.parameter - wanted.parameter).abs() < 1e-6, "{normal:?}: {}", found.parameter);
            let [x, y, _] = wanted.curvature;
            let bend = add(times(first, x), times(second, y));
            assert!(distance(found.curvature, bend) < 1e-7, "{normal:?}: {:?} {bend:?}", found.curvature);
        }
    }
}

#[test]
fn a_power_of_two_changes_no_digit_of_any_figure() {
    for elements in chains() {
        for power in [-280, -40, 35, 280] {
            let scale = 2.0f64.powi(power);
            let scaled: Vec<Element> = elements
                .iter()
                .map(|element| Element { rows: element.rows.map(|row| times(row, scale)) })
                .collect();
            assert_eq!(length(&scaled), length(&elements) * scale);
            assert_eq!(bending(&scaled), bending(&elements) / scale);
            assert_eq!(variation(&scaled), variation(&elements) / scale / scale / scale);
            let (one, other) =
                (at(&elements, 1, 0.3).expect("regular"), at(&scaled, 1, 0.3).expect("regular"));
            assert_eq!(one.tangent, other.tangent);
            assert_eq!(times(one.point, scale), other.point);
            assert_eq!(one.arc_length * scale, other.arc_length);
            assert_eq!(times(one.curvature, 1.0 / scale), other.curvature);
            assert_eq!(one.signed_curvature / scale, other.signed_curvature);
            assert_eq!(one.torsion / scale, other.torsion);
            assert_eq!(one.curvature_derivative / scale / scale, other.curvature_derivative);
            let [[low, high], [small, large]] =
                [&elements, &scaled].map(|elements| curvature_range(elements).expect("regular"));
            assert_eq!(low.signed_curvature / scale, small.signed_curvature);
            assert_eq!((high.element, high.parameter), (large.element, large.parameter));
            let [one, other] = [(&elements, 1.0), (&scaled, scale)]
                .map(|(elements, scale)| closest(elements, times([0.7, 1.3, 0.2], scale)).expect("regular"));
            assert_eq!((one.element, one.parameter), (other.element, other.parameter));
        }
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn arc_lengths_and_places_convert_both_ways(elements in chain(), share in 0.0..1.0f64, t in 0.001..0.999f64) {
        let total = length(&elements);
        let found = at_length(&elements, share * total).expect("on the curve");
        prop_assert!((found.arc_length - share * total).abs() <= 1e-13 * total);
        let again = at(&elements, found.element, found.parameter).expect("on the curve");
        prop_assert!((again.arc_length - share * total).abs() <= 1e-13 * total);
        prop_assert_eq!(again.point, found.point);
        for element in 0..elements.len() {
            let place = at(&elements, element, t).expect("on the curve");
            let back = at_length(&elements, place.arc_length).expect("on the curve");
            prop_assert_eq!(back.element, element);
            // The parameter is known as well as the arc length over the speed.
            let speed = norm(derivatives(&elements[element], t)[1]);
            prop_assert!((back.parameter - t).abs() * speed <= 1e-13 * total, "{} {t}", back.parameter);
        }
        // By brute force.
        let place = at(&elements, 0, t).expect("on the curve");
        let steps = 4000;
        let polygon: f64 = (0..steps)
            .map(|k| {
                let at = |k: i32| derivatives(&elements[0], t * f64::from(k) / f64::from(steps))[0];
                distance(at(k), at(k + 1))
            })
            .sum();
        prop_assert!((polygon - place.arc_length).abs() < 1e-5 * total);
    }

    #[test]
    fn the_figures_at_a_place_are_those_of_independent_formulas(elements in chain(), t in 0.0..=1.0f64) {
        let planar = plane_normal(&elements).is_some();
        for (k, element) in elements.iter().enumerate() {
            let found = at(&elements, k, t).expect("regular");
            let [point, d1, d2, d3] = derivatives(element, t);
            let [tangent, curvature, slope] = shape(element, t);
            prop_assert!(distance(found.point, point) < 1e-13);
            prop_assert!(distance(found.tangent, tangent) < 1e-12);
            prop_assert!(distance(found.curvature, curvature) < 1e-10 * (1.0 + norm(curvature)));
            let u = cross(d1, d2);
            let torsion = dot(u, d3) / dot(u, u);
            prop_assert!((found.torsion - torsion).abs() <= 1e-9 * torsion.abs() + 1e-12);
            if planar {
                prop_assert!((found.signed_curvature - cross(d1, d2)[2] / norm(d1).powi(3)).abs() < 1e-10 * (1.0 + norm(curvature)));
                prop_assert!((found.curvature_derivative - slope[2]).abs() < 1e-9 * (1.0 + norm(slope)));
            } else {
                prop_assert!((found.signed_curvature - norm(curvature)).abs() < 1e-10 * (1.0 + norm(curvature)));
                let along = dot(slope, unit(u));
                prop_assert!((found.curvature_derivative - along).abs() < 1e-9 * (1.0 + norm(slope)));
            }
        }
    }

    #[test]
    fn the_closest_point_is_that_of_brute_force(elements in chain(), point in prop::array::uniform3(-2.0..5.0f64)) {
        let mut best = f64::INFINITY;
        for element in &elements {
            for k in 0..=2000 {
                best = best.min(distance(derivatives(element, f64::from(k) / 2000.0)[0], point));
            }
        }
        let found = closest(&elements, point).expect("regular");
        let reached = distance(found.point, point);
        prop_assert!(reached <= best + 1e-12, "{reached} {best}");
        prop_assert!(reached >= best - 1e-5, "{reached} {best}");
        prop_assert_eq!(at(&elements, found.element, found.parameter).expect("regular"), found);
        if found.parameter > 0.0 && found.parameter < 1.0 {
            prop_assert!(dot(sub(found.point, point), found.tangent).abs() < 1e-8 * (1.0 + reached));
        }
        // A point on the curve is its own foot.
        let own = closest(&elements, found.point).expect("regular");
        prop_assert!(distance(own.point, found.point) < 1e-7);
    }

    #[test]
    fn the_bounding_box_holds_the_curve_and_is_touched_on_every_side(elements in chain()) {
        let [low, high] = bounding_box(&elements).expect("finite");
        let mut reached = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for element in &elements {
            for k in 0..=2000 {
                let point = derivatives(element, f64::from(k) / 2000.0)[0];
                for d in 0..3 {
                    prop_assert!(point[d] >= low[d] - 1e-13 && point[d] <= high[d] + 1e-13);
                    reached[0][d] = reached[0][d].min(point[d]);
                    reached[1][d] = reached[1][d].max(point[d]);
                }
            }
        }
        for d in 0..3 {
            prop_assert!(reached[0][d] - low[d] < 1e-5 && high[d] - reached[1][d] < 1e-5);
        }
    }

    #[test]
    fn the_range_of_curvature_is_that_of_dense_sampling(elements in chain()) {
        let planar = plane_normal(&elements).is_some();
        let [least, most] = curvature_range(&elements).expect("regular");
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for element in &elements {
            for k in 0..=2000 {
                let t = f64::from(k) / 2000.0;
                let [_, d1, d2, _] = derivatives(element, t);
                let b = times(cross(d1, d2), 1.0 / norm(d1).powi(3));
                let curvature = if planar { b[2] } else { norm(b) };
                low = low.min(curvature);
                high = high.max(curvature);
            }
        }
        let size = low.abs().max(high.abs());
        for found in [least, most] {
            prop_assert_eq!(at(&elements, found.element, found.parameter).expect("regular"), found);
        }
        prop_assert!(least.signed_curvature <= low + 1e-9 * size, "{} {low}", least.signed_curvature);
        prop_assert!(most.signed_curvature >= high - 1e-9 * size, "{} {high}", most.signed_curvature);
    }

    #[test]
    fn no_element_of_any_numbers_makes_measuring_panic(
        rows in prop::array::uniform6(prop::array::uniform3(prop_oneof![
            any::<f64>(), Just(0.0), Just(1.0), Just(1e90), -1.0..1.0f64
        ])),
        t in any::<f64>(),
    ) {
        let one = Element { rows };
        for elements in [&[one][..], &[Element::ZERO, one], &parabola()] {
            for t in [t, 0.0, 0.5, 1.0] {
                if let Ok(found) = at(elements, 0, t) {
                    prop_assert!(found.tangent.iter().all(|x| x.is_finite()));
                }
                let _ = at_length(elements, t);
                let _ = closest(elements, [t, 0.0, -t]);
            }
            let _ = (length(elements), bending(elements), variation(elements), plane_normal(elements));
            let _ = (curvature_range(elements), bounding_box(elements));
            let mut controls = vec![[0.0; 3]; 20];
            let mut knots = vec![0.0; 30];
            let _ = bspline(elements, &mut controls, &mut knots);
        }
    }
}

/// De Boor's algorithm on the knot interval `[knots[k], knots[k + 1])`.
fn de_boor(controls: &[Vector], knots: &[f64], degree: usize, k: usize, u: f64) -> Vector {
    let mut d: Vec<Vector> = controls[k - degree..=k].to_vec();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let (low, high) = (knots[j + k - degree], knots[j + 1 + k - r]);
            let share = (u - low) / (high - low);
            d[j] = add(times(d[j - 1], 1.0 - share), times(d[j], share));
        }
    }
    d[degree]
}

/// De Casteljau's algorithm.
fn de_casteljau(points: &[Vector], t: f64) -> Vector {
    let mut points = points.to_vec();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| add(times(pair[0], 1.0 - t), times(pair[1], t))).collect();
    }
    points[0]
}

#[test]
fn bezier_points_give_the_element() {
    for element in chains().iter().flatten() {
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let want = derivatives(element, t)[0];
            assert!(distance(de_casteljau(&element.bezier(), t), want) < 1e-13);
            assert!(distance(element.point(t), want) < 1e-13);
        }
    }
}

fn spline(elements: &[Element]) -> (Vec<Vector>, Vec<f64>) {
    let (control_count, knot_count) = bspline_len(elements);
    let mut controls = vec![[f64::NAN; 3]; control_count];
    let mut knots = vec![f64::NAN; knot_count];
    bspline(elements, &mut controls, &mut knots).expect("good elements");
    (controls, knots)
}

/// The places where the knots go up: the interval of each element.
fn intervals(knots: &[f64]) -> Vec<usize> {
    (0..knots.len() - 1).filter(|&k| knots[k] < knots[k + 1]).collect()
}

#[test]
fn the_spline_evaluated_by_de_boor_is_the_chain_point_by_point() {
    for elements in chains() {
        let (controls, knots) = spline(&elements);
        assert_eq!(knots.len(), controls.len() + 6);
        let intervals = intervals(&knots);
        assert_eq!(intervals.len(), elements.len());
        for (element, &k) in elements.iter().zip(&intervals) {
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let u = knots[k] + t * (knots[k + 1] - knots[k]);
                let off = distance(de_boor(&controls, &knots, 5, k, u), derivatives(element, t)[0]);
                assert!(off < 1e-12, "{off:e}");
            }
        }
    }
}

#[test]
fn the_knots_tell_smooth_joints_from_corners() {
    let elements = solved(false, false);
    let (controls, knots) = spline(&elements);
    assert_eq!(knots[..6], [0.0; 6]);
    assert_eq!(knots[knots.len() - 6..], [1.0; 6]);
    assert!(knots.windows(2).all(|pair| pair[0] <= pair[1]));
    // Ten elements, nine joints, one of them a corner: joint 4, between the elements 7 and 8.
    let mut folds = Vec::new();
    for &k in &intervals(&knots)[1..] {
        folds.push(knots.iter().filter(|&&knot| knot == knots[k]).count());
    }
    assert_eq!(folds, [4, 4, 4, 4, 4, 4, 4, 5, 4]);
    assert_eq!(controls.len(), 5 * 10 + 1 - 8);
    assert_eq!(controls[0], elements[0].rows[0]);
    assert_eq!(*controls.last().expect("controls"), elements[9].rows[5]);
}

#[test]
fn the_spline_is_c1_across_smooth_joints() {
    for elements in chains() {
        let (controls, knots) = spline(&elements);
        // The derivative is a spline of degree 4 on the same knots without the outer two.
        let slopes: Vec<Vector> = (0..controls.len() - 1)
            .map(|i| {
                let span = knots[i + 6] - knots[i + 1];
                times(sub(controls[i + 1], controls[i]), 5.0 / span)
            })
            .collect();
        let inner = &knots[1..knots.len() - 1];
        let intervals = intervals(inner);
        for (i, pair) in intervals.windows(2).enumerate() {
            let u = inner[pair[1]];
            let before = de_boor(&slopes, inner, 4, pair[0], u);
            let after = de_boor(&slopes, inner, 4, pair[1], u);
            let smooth = distance(unit(elements[i].rows[4]), unit(elements[i + 1].rows[1])) < 1e-10;
            let jump = distance(before, after) / norm(before);
            assert_eq!(smooth, jump < 1e-9, "joint {i}: {jump:e}");
            // Even at a corner the speed is the same on both sides.
            assert_relative_eq!(norm(before), norm(after), max_relative = 1e-9);
            // And the derivative is that of the element, by the parameter of the spline.
            let h = inner[pair[0] + 1] - inner[pair[0]];
            assert!(distance(before, times(elements[i].rows[4], 1.0 / h)) < 1e-9 * norm(before));
        }
    }
}

#[test]
fn a_single_element_gives_a_bezier_curve_as_spline() {
    let element = parabola()[1];
    let (controls, knots) = spline(&[element]);
    assert_eq!(controls, element.bezier());
    assert_eq!(knots, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
}

#[test]
fn what_cannot_be_measured_is_refused_by_name() {
    let good = parabola();
    let mut bad = good.clone();
    bad[2].rows[3][1] = f64::NAN;
    let stopped = {
        let mut elements = good.clone();
        elements[1].rows[1] = [0.0; 3];
        elements
    };
    let refused = |result: Result<(), MeasureError>, error: MeasureError, words: &str| {
        assert_eq!(result, Err(error));
        assert!(error.to_string().contains(words), "“{error}” does not say “{words}”");
    };
    let none = MeasureError::NoElements;
    refused(at_length(&[], 0.0).map(drop), none, "no elements");
    refused(closest(&[], [0.0; 3]).map(drop), none, "no elements");
    refused(curvature_range(&[]).map(drop), none, "no elements");
    refused(bounding_box(&[]).map(drop), none, "no elements");
    refused(at(&[], 0, 0.0).map(drop), none, "no elements");
    refused(bspline(&[], &mut [], &mut []), none, "no elements");

    let nan = MeasureError::NotFinite { element: 2 };
    refused(at(&bad, 0, 0.5).map(drop), nan, "element 2");
    refused(at_length(&bad, 0.1).map(drop), nan, "element 2");
    refused(closest(&bad, [0.0; 3]).map(drop), nan, "element 2");
    refused(curvature_range(&bad).map(drop), nan, "element 2");
    refused(bounding_box(&bad).map(drop), nan, "element 2");
    refused(bspline(&bad, &mut [[0.0; 3]; 30], &mut [0.0; 40]), nan, "element 2");

    let irregular = MeasureError::Irregular { element: 1 };
    refused(at(&stopped, 1, 0.0).map(drop), irregular, "element 1");
    refused(curvature_range(&stopped).map(drop), irregular, "element 1");
    refused(bspline(&stopped, &mut [[0.0; 3]; 30], &mut [0.0; 40]), irregular, "element 1");

    let outside = MeasureError::OutOfRange;
    for t in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
        refused(at(&good, 0, t).map(drop), outside, "not on the curve");
    }
    refused(at(&good, 3, 0.5).map(drop), outside, "not on the curve");
    let total = length(&good);
    for s in [-0.1, total + 0.1, f64::NAN, f64::INFINITY] {
        refused(at_length(&good, s).map(drop), outside, "not on the curve");
    }
    refused(closest(&good, [0.0, f64::NAN, 0.0]).map(drop), outside, "not on the curve");
    assert_eq!(at_length(&good, total * (1.0 + 1e-12)).expect("the end").parameter, 1.0);

    let (controls, knots) = bspline_len(&good);
    let mut room = (vec![[7.0; 3]; controls], vec![7.0; knots]);
    let short = MeasureError::TooShort { needed: controls, given: controls - 1 };
    refused(bspline(&good, &mut room.0[1..], &mut room.1), short, &controls.to_string());
    let short = MeasureError::TooShort { needed: knots, given: knots - 1 };
    refused(bspline(&good, &mut room.0, &mut room.1[1..]), short, &knots.to_string());
    assert!(room.0.iter().all(|point| *point == [7.0; 3]) && room.1.iter().all(|&knot| knot == 7.0));
    assert_eq!(bspline(&good, &mut room.0, &mut room.1), Ok(()));
}

#[test]
fn a_straight_element_has_neither_curvature_nor_torsion() {
    let straight = |direction: [f64; 3]| {
        let row = |by: f64| direction.map(|x| x * by);
        // Faster and slower along the way, on a line all the same.
        Element { rows: [row(0.0), row(1.0), row(0.5), row(-0.25), row(1.5), row(1.0)] }
    };
    for direction in [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, -2.0, 2.0]] {
        let elements = [straight(direction)];
        for t in [0.0, 0.3, 1.0] {
            let found = at(&elements, 0, t).expect("on the line");
            assert!(distance(found.tangent, unit(direction)) < 1e-14);
            assert!(norm(found.curvature) < 1e-14 && found.signed_curvature.abs() < 1e-14, "{found:?}");
            assert!(found.torsion.is_finite() && found.curvature_derivative.is_finite(), "{found:?}");
            if direction[0] * direction[1] == 0.0 {
                assert_eq!((found.torsion, found.curvature_derivative), (0.0, 0.0));
            }
        }
    }
}
