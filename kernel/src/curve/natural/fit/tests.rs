//! The fit against residuals by plain formulas.

extern crate std;

use super::super::functions::functions;
use super::*;
use nalgebra::{SMatrix, SVector};
use std::vec::Vec;

/// Directions of spans: an arc of a circle, a clothoid, and one that bends to either side.
const DIRECTIONS: [[f64; 6]; 3] =
    [[-0.4, 0.8, 0.4, 0.8, 0.0, 0.0], [-0.3, 0.2, 0.5, 1.4, 0.0, 0.0], [0.5, -1.1, 0.2, 0.9, 0.6, -0.4]];
const LENGTH: f64 = 1.3;

/// The direction and its first two derivatives by `u`.
fn direction(q: &[f64; 6], u: f64) -> [f64; 3] {
    functions::<6>(u).map(|row| row.iter().zip(q).map(|(f, q)| f * q).sum())
}

/// The ends that a part of a span has, speeds and stretches as of a straight line, and its chord.
fn ends(known: &Known<'_, 6>) -> [End<2>; 2] {
    let rule = legendre(32).expect("a rule");
    let part = known.to - known.from;
    let mut point = SVector::from([0.0; 2]);
    for (node, weight) in rule.iter() {
        let [theta, ..] = direction(known.direction, known.from + part * node);
        point += SVector::from([libm::cos(theta), libm::sin(theta)]) * (weight * part * known.length);
    }
    [(known.from, SVector::from([0.0; 2])), (known.to, point)].map(|(u, point)| {
        let [theta, slope, _] = direction(known.direction, u);
        let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
        End {
            point,
            frame: [SVector::from([cosine, sine]), SVector::from([-sine, cosine])],
            curvature: [slope / known.length, 0.0],
            speed: part * known.length,
            stretch: 0.0,
        }
    })
}

/// The first three derivatives of the quintic with these speeds and stretches.
fn derivatives(ends: &[End<2>; 2], now: &[f64; 4], t: f64) -> [[f64; 2]; 3] {
    let mut ends = *ends;
    for end in 0..2 {
        (ends[end].speed, ends[end].stretch) = (now[2 * end], now[2 * end + 1]);
    }
    let rows = crate::curve::end::rows_between(&ends);
    let basis = hermite::basis(t);
    [1, 2, 3].map(|order: usize| [0, 1].map(|x: usize| (0..6).map(|a| basis[order][a] * rows[a][x]).sum()))
}

/// What differs at the points of the rule, with the weights of its squares, by plain formulas and a fine rule for the arc
/// length.
fn residuals(ends: &[End<2>; 2], now: &[f64; 4], known: &Known<'_, 6>, varies: bool) -> Vec<[f64; 3]> {
    let (rule, fine) = (legendre(POINTS).expect("a rule"), legendre(32).expect("a rule"));
    let speed = |t: f64| {
        let [[x, y], ..] = derivatives(ends, now, t);
        sqrt(x * x + y * y)
    };
    let until = |t: f64| fine.iter().map(|(node, weight)| t * weight * speed(t * node)).sum::<f64>();
    let whole = until(1.0);
    let one = |(t, weight): (f64, f64)| {
        let [[a, b], [c, d], [e, f]] = derivatives(ends, now, t);
        let (square, cross) = (a * a + b * b, a * d - b * c);
        let bends = cross / (square * sqrt(square));
        let changes = (square * (a * f - b * e) - 3.0 * (a * c + b * d) * cross) / (square * square * square);
        let u = known.from + (known.to - known.from) * until(t) / whole;
        let [_, first, second] = direction(known.direction, u);
        let (value, wanted) = if varies {
            (changes, second / (known.length * known.length))
        } else {
            (bends, first / known.length)
        };
        [value - wanted, weight * speed(t), wanted]
    };
    rule.iter().map(one).collect()
}

fn misfit(ends: &[End<2>; 2], now: &[f64; 4], known: &Known<'_, 6>, varies: bool) -> f64 {
    residuals(ends, now, known, varies).iter().map(|[off, weight, _]| weight * off * off).sum()
}

fn each(work: impl Fn(&Known<'_, 6>, bool)) {
    for direction in &DIRECTIONS {
        for (from, to) in [(0.0, 1.0), (0.25, 0.75)] {
            for varies in [true, false] {
                work(&Known { direction, length: LENGTH, from, to }, varies);
            }
        }
    }
}

#[test]
fn a_comparison_has_the_normal_equations_of_what_differs() {
    each(|known, varies| {
        let ends = ends(known);
        let shape = Shape {
            chord: [0, 1].map(|x: usize| ends[1].point[x]),
            tangents: [0, 1].map(|end: usize| [ends[end].frame[0][0], ends[end].frame[0][1]]),
            curvatures: [ends[0].curvature[0], ends[1].curvature[0]],
        };
        let v = ends[0].speed;
        for now in
            [[v, 0.0, v, 0.0], [1.02 * v, -0.1 * v, 0.97 * v, 0.05 * v], [0.95 * v, 0.12 * v, v, 0.1 * v]]
        {
            let found = compare(&shape, &now, known, varies);
            let off = residuals(&ends, &now, known, varies);
            let h = 1e-5 * v;
            let by: Vec<Vec<f64>> = (0..4)
                .map(|i| {
                    let moved = |step: f64| {
                        let mut now = now;
                        now[i] += step;
                        residuals(&ends, &now, known, varies)
                    };
                    moved(h).iter().zip(moved(-h)).map(|(up, down)| (up[0] - down[0]) / (2.0 * h)).collect()
                })
                .collect();
            let near = |found: f64, wanted: f64, size: f64, what: &str| {
                assert!((found - wanted).abs() < 2e-3 * size, "{what}: {found}, not {wanted} ({varies})");
            };
            let sum = |of: &dyn Fn(usize) -> f64| (0..POINTS).map(|k| off[k][1] * of(k)).sum::<f64>();
            let natural = known.natural(varies);
            let wanted = sum(&|k| off[k][0] * off[k][0]);
            near(found.misfit, wanted, wanted + 1e-3 * natural, "misfit");
            near(found.size, sum(&|k| off[k][2] * off[k][2]), found.size + 1e-3 * natural, "size");
            for i in 0..4 {
                let own = sum(&|k| by[i][k] * by[i][k]);
                near(found.slope[i], sum(&|k| by[i][k] * off[k][0]), sqrt(own * wanted), "slope");
                for j in 0..=i {
                    let size = sqrt(own * sum(&|k| by[j][k] * by[j][k]));
                    near(found.matrix[i][j], sum(&|k| by[i][k] * by[j][k]), size, "matrix");
                }
            }
        }
    });
}

/// What an arc's functional is where it turns by a radian or so: of such an arc, by plain formulas.
#[test]
fn a_natural_size_is_that_of_a_turn_by_a_radian() {
    let known = Known { direction: &DIRECTIONS[0], length: 4.0, from: 0.25, to: 0.75 };
    // Curvature that falls from 1/2 to 0 over a length of 2; that is 1/2.
    assert!((known.natural(true) - 0.125).abs() < 1e-15 && (known.natural(false) - 0.5).abs() < 1e-15);
}

#[test]
fn a_step_goes_to_the_least_of_its_normal_equations_but_not_too_far() {
    let half = [[2.0, 0.0, 0.0, 0.0], [0.3, 1.5, 0.0, 0.0], [-0.4, 0.2, 1.0, 0.0], [0.5, -0.7, 0.1, 0.8]];
    let half = SMatrix::<f64, 4, 4>::from_fn(|i, j| half[i][j]);
    let whole = half * half.transpose();
    // Only the lower half is read.
    let matrix =
        core::array::from_fn(|i| core::array::from_fn(|j| if j <= i { whole[(i, j)] } else { f64::NAN }));
    let slope = [0.1, -0.2, 0.05, 0.3];
    let compared =
        |factor: f64| Compared { misfit: 1.0, size: 1.0, slope: slope.map(|g| g * factor), matrix };
    let right = SMatrix::<f64, 4, 1>::from_fn(|i, _| -slope[i]);
    let wanted = whole.try_inverse().expect("it is definite") * right;
    let gain = right.dot(&wanted);
    let now = [1.0, 0.5, 2.0, -0.5];
    let Some((step, promised)) = compared(1.0).step(&now) else { panic!("a step") };
    let far = (wanted[0] / now[0]).abs().larger((wanted[2] / now[2]).abs());
    assert!(far < LONGEST, "{far}");
    for i in 0..4 {
        assert!((step[i] - wanted[i]).abs() < 1e-9, "{step:?} {wanted}");
    }
    assert!((promised - gain).abs() < 1e-9, "{promised} {gain}");
    // Either speed limits how far it goes, and the gain with it.
    for (factor, now) in
        [(10.0, now), (-10.0, now), (1.0, [-far, 1.0, 100.0, 1.0]), (1.0, [100.0, 1.0, 0.1 * far, 1.0])]
    {
        let far = (factor * wanted[0] / now[0]).abs().larger((factor * wanted[2] / now[2]).abs());
        if far <= LONGEST {
            continue;
        }
        let by = LONGEST / far;
        let Some((step, promised)) = compared(factor).step(&now) else { panic!("a step") };
        for i in 0..4 {
            assert!((step[i] - by * factor * wanted[i]).abs() < 1e-9 * factor.abs(), "{step:?}");
        }
        // Of a quadratic, at a part of the way to its least.
        let wanted = factor * factor * gain * (1.0 - (1.0 - by) * (1.0 - by));
        assert!((promised - wanted).abs() < 1e-9 * wanted, "{promised} {wanted}");
    }
    let mut bad = compared(1.0);
    bad.matrix[2][2] = -1.0;
    assert!(bad.step(&now).is_none());
    let mut bad = compared(1.0);
    bad.slope[1] = f64::NAN;
    assert!(bad.step(&now).is_none());
    assert!(compared(1.0).step(&[0.0, 1.0, 0.0, 1.0]).is_none());
}

/// From even speeds and from those of a last solution, no quintic with other speeds and stretches runs nearer.
#[test]
fn a_fitted_quintic_runs_along_its_curve_as_no_other_does() {
    each(|known, varies| {
        let start = ends(known);
        let v = start[0].speed;
        let plain = misfit(&start, &[v, 0.0, v, 0.0], known, varies);
        for warm in [false, true] {
            let mut fitted = start;
            let claimed = fit(&mut fitted, known, varies, warm, 0.0);
            let now = [fitted[0].speed, fitted[0].stretch, fitted[1].speed, fitted[1].stretch];
            let least = misfit(&start, &now, known, varies);
            let nothing = 1e-9 * known.natural(varies);
            assert!((claimed - least).abs() < 0.03 * least + nothing, "{varies} {warm}: {claimed} {least}");
            assert!(least < 0.1 * plain + nothing, "{least} {plain}");
            for i in 0..4 {
                for step in [0.02 * v, -0.02 * v] {
                    let mut moved = now;
                    moved[i] += step;
                    assert!(misfit(&start, &moved, known, varies) > least, "{varies} {warm} {i}");
                }
            }
            // All else stands.
            for (one, other) in fitted.iter().zip(&start) {
                assert!(
                    one.point == other.point && one.frame == other.frame && one.curvature == other.curvature
                );
            }
        }
        // What is asked for loosely is not looked for any longer, unless there is nothing that it could be a part of.
        let arc = varies && known.direction == &DIRECTIONS[0];
        let mut loose = start;
        fit(&mut loose, known, varies, true, 1e9);
        assert_eq!((loose[0].speed, loose[1].stretch) == (v, 0.0), !arc);
    });
}
