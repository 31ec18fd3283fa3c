//! The bases as their users have them: changes between forms, degrees, what errors say.

use minvar::basis::bernstein::{Bernstein, MAX_DEGREE, RootsError};
use minvar::basis::hermite;

/// Six points of which no formula is the sum of others.
const POINTS: [[f64; 2]; 6] =
    [[0.25, -1.0], [1.5, 2.0], [-0.75, 3.5], [4.0, 0.125], [2.5, -3.0], [-1.25, 1.75]];

#[test]
fn bezier_points_give_the_derivatives_of_their_polynomial_at_both_ends() {
    let rows = hermite::from_bezier(&POINTS);
    for d in 0..2 {
        let curve = Bernstein::new(POINTS.map(|point| point[d]));
        let first = curve.derivative();
        let second = first.derivative();
        let wanted = [
            curve.value(0.0),
            first.value(0.0),
            second.value(0.0),
            second.value(1.0),
            first.value(1.0),
            curve.value(1.0),
        ];
        for (row, wanted) in rows.iter().zip(wanted) {
            assert!((row[d] - wanted).abs() < 1e-12, "{rows:?}: {wanted} in coordinate {d}");
        }
    }
}

#[test]
fn hermite_rows_and_bezier_points_are_two_forms_of_one_curve() {
    let there_and_back = hermite::to_bezier(&hermite::from_bezier(&POINTS));
    for (found, wanted) in there_and_back.iter().zip(&POINTS) {
        for d in 0..2 {
            assert!((found[d] - wanted[d]).abs() < 1e-13, "{there_and_back:?}");
        }
    }
}

#[test]
fn the_fourth_derivative_is_the_slope_of_the_third() {
    for step in 0..=8 {
        let (t, h) = (f64::from(step) / 8.0, 1.0 / 1024.0);
        // Of a quadratic a symmetric difference is exact.
        let [before, after] = [t - h, t + h].map(|t| hermite::basis(t)[3]);
        for (a, fourth) in hermite::fourth(t).into_iter().enumerate() {
            let slope = (after[a] - before[a]) / (2.0 * h);
            assert!((fourth - slope).abs() < 1e-9, "function {a} at {t}: {fourth}, not {slope}");
        }
    }
}

#[test]
fn a_polynomial_has_the_degree_of_its_form_up_to_the_greatest() {
    assert_eq!(Bernstein::constant(3.0).degree(), 0);
    assert_eq!(Bernstein::new([1.0, 2.0, 4.0]).degree(), 2);
    assert_eq!(Bernstein::new([1.0, 2.0, 4.0]).elevated(7).degree(), 7);
    assert_eq!(Bernstein::new([1.0, 2.0, 4.0]).elevated(MAX_DEGREE).degree(), MAX_DEGREE);
    assert_eq!(Bernstein::new([1.0, 2.0, 4.0]).elevated(MAX_DEGREE + 1), Bernstein::new([1.0, 2.0, 4.0]));
    assert_eq!(Bernstein::new([1.0, 2.0, 4.0]).derivative().degree(), 1);

    let full: Vec<f64> = (0..=MAX_DEGREE).map(|k| k as f64).collect();
    let highest = Bernstein::from_slice(&full).expect("as many coefficients as there is room for");
    assert_eq!((highest.degree(), highest.coefficients()), (MAX_DEGREE, &full[..]));
    // k / 31 are the coefficients of t itself.
    assert!((highest.value(0.3) - 0.3 * MAX_DEGREE as f64).abs() < 1e-12);
    assert!(Bernstein::from_slice(&[0.0; MAX_DEGREE + 2]).is_none());
}

#[test]
fn why_there_are_no_roots_is_said_in_a_sentence() {
    let zero = Bernstein::constant(0.0).roots().expect_err("zero everywhere");
    assert_eq!(zero, RootsError::Zero);
    assert!(zero.to_string().contains("every parameter is a root"), "{zero}");
    let infinite = Bernstein::new([1.0, f64::INFINITY]).roots().expect_err("not finite");
    assert_eq!(infinite, RootsError::NotFinite);
    assert!(infinite.to_string().contains("not finite"), "{infinite}");
}

#[test]
fn a_part_is_the_polynomial_over_its_interval_however_short() {
    let whole = Bernstein::new([1.0, -2.0, 0.5, 4.0, 3.0]);
    let near = f64::EPSILON;
    let ends = [0.0, near, 0.2, 0.5, 0.5 + near, 0.8, 1.0 - 2.0 * near, 1.0 - near, 1.0];
    for (k, &a) in ends.iter().enumerate() {
        for &b in &ends[k..] {
            let part = whole.restricted(a, b);
            assert_eq!(part.degree(), whole.degree());
            for s in [0.0, 0.25, 0.5, 1.0] {
                let (found, wanted) = (part.value(s), whole.value(a + (b - a) * s));
                assert!((found - wanted).abs() < 1e-13, "[{a}, {b}] at {s}: {found}, not {wanted}");
            }
        }
    }
}

#[test]
fn a_polynomial_that_comes_within_noise_of_zero_has_a_root_there_and_one_that_stays_away_has_none() {
    for size in [1.0, 1024.0] {
        for side in [1.0, -1.0] {
            // 4 (t − ½)² beside a multiple of rounding: noise is twelve of these, for a degree of two.
            let touching = |above: f64| {
                let above = above * f64::EPSILON;
                (Bernstein::new([1.0 + above, -1.0 + above, 1.0 + above]) * (side * size))
                    .roots()
                    .expect("roots")
            };
            assert_eq!(touching(11.0).as_slice(), [0.5]);
            assert_eq!(touching(14.0).as_slice(), [0.0; 0]);
        }
    }
}
