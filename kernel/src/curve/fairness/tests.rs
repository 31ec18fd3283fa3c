//! The densities against their own differences, and against the formulas in their plainest form.

use super::*;
use crate::order::Order;
use crate::root::sqrt;

const PLAIN: Weights = Weights { variation: 0.0, bending: 0.0, length: 0.0 };

fn sample<const D: usize>(seed: u64) -> [[Lanes; D]; 3] {
    let mut x = seed;
    let mut next = || {
        x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((x >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
    };
    core::array::from_fn(|_| core::array::from_fn(|_| Lanes([next(), next()])))
}

type Evaluate<'a, const D: usize> = &'a dyn Fn(&[[Lanes; D]; 3]) -> Local<D>;

/// Gradient and Hessian against central differences of value and gradient.
fn agrees<const D: usize>(value: &dyn Fn(&[[Lanes; D]; 3]) -> Lanes, derivatives: Evaluate<'_, D>) {
    for seed in 1..60 {
        let d = sample::<D>(seed);
        if (0..2).any(|lane| (0..D).map(|x| d[0][x].0[lane] * d[0][x].0[lane]).sum::<f64>() < 0.1) {
            continue;
        }
        let found = derivatives(&d);
        for lane in 0..2 {
            let scale = found
                .hessian
                .iter()
                .flatten()
                .flatten()
                .flatten()
                .fold(1.0f64, |m, x| m.larger(x.0[lane].abs()));
            assert!((found.value.0[lane] - value(&d).0[lane]).abs() <= 1e-13 * scale);
            let h = 1e-6;
            for k in 0..3 {
                for x in 0..D {
                    let (mut up, mut down) = (d, d);
                    up[k][x].0[lane] += h;
                    down[k][x].0[lane] -= h;
                    let slope = (value(&up).0[lane] - value(&down).0[lane]) / (2.0 * h);
                    assert!((slope - found.gradient[k][x].0[lane]).abs() < 1e-7 * scale, "gradient {k} {x}");
                    let (up, down) = (derivatives(&up), derivatives(&down));
                    for l in 0..3 {
                        for y in 0..D {
                            let second =
                                (up.gradient[l][y].0[lane] - down.gradient[l][y].0[lane]) / (2.0 * h);
                            let exact =
                                if k >= l { found.hessian[k][l][x][y] } else { found.hessian[l][k][y][x] };
                            let off = (second - exact.0[lane]).abs();
                            assert!(off < 1e-6 * scale, "hessian {k}{x} {l}{y}: {second} {}", exact.0[lane]);
                        }
                    }
                }
            }
        }
    }
}

fn all_agree<const D: usize>()
where
    Shape<D>: Density<D>,
{
    let target = [Lanes([0.3, -0.2]), Lanes([-0.5, 0.1]), Lanes([0.2, 0.7])];
    let zero = [Lanes::ZERO; 3];
    for (weights, target) in [
        (Weights::VARIATION, zero),
        (Weights::BENDING, zero),
        (Weights { length: 1.0, ..PLAIN }, zero),
        (Weights::VARIATION, target),
        (Weights { variation: 0.7, bending: 0.4, length: 0.9 }, target),
    ] {
        let weights = Weighted::by(&weights, Lanes::ONE);
        agrees::<D>(&|d| Shape::value(&weights, &target, d).value, &|d| {
            Shape::derivatives(&weights, &target, d)
        });
    }
    for of in [Lanes::ZERO, Lanes([0.4, -0.3])] {
        agrees::<D>(&|d| evenness(d, of) * 0.6, &|d| {
            let mut local = Local::ZERO;
            add_evenness(Lanes([0.6; 2]), d, of, &mut local);
            local
        });
    }
}

#[test]
fn derivatives_of_the_densities_agree_with_differences() {
    all_agree::<2>();
    all_agree::<3>();
}

/// What the thesis writes, in numbers one by one.
fn plain(d: &[[Lanes; 3]; 3], lane: usize) -> [f64; 3] {
    let [a, b, c] = d.map(|row| row.map(|x| x.0[lane]));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let v = sqrt(dot(a, a));
    let (u, du) = (cross(a, b), cross(a, c));
    let slope: [f64; 3] =
        core::array::from_fn(|k| (du[k] / (v * v * v) - 3.0 * dot(a, b) * u[k] / (v * v * v * v * v)) / v);
    [dot(slope, slope) * v, dot(u, u) / (v * v * v * v * v), v]
}

#[test]
fn the_densities_are_those_of_the_thesis_in_the_plane_and_in_space() {
    let zero = [Lanes::ZERO; 3];
    let [variation, bending] =
        [Weights::VARIATION, Weights::BENDING].map(|weights| Weighted::by(&weights, Lanes::ONE));
    for seed in 1..30 {
        let space = sample::<3>(seed);
        let flat = space.map(|row| [row[0], row[1], Lanes::ZERO]);
        let plane = space.map(|row| [row[0], row[1]]);
        for lane in 0..2 {
            for (found, expected) in [
                (Shape::value(&variation, &zero, &space).value, plain(&space, lane)[0]),
                (Shape::value(&bending, &zero, &space).value, plain(&space, lane)[1]),
                (Shape::value(&variation, &zero, &plane).value, plain(&flat, lane)[0]),
                (Shape::value(&bending, &zero, &plane).value, plain(&flat, lane)[1]),
                (Shape::value(&bending, &zero, &plane).length, plain(&flat, lane)[2]),
            ] {
                assert!((found.0[lane] - expected).abs() <= 1e-11 * expected, "{found:?} {expected}");
            }
        }
    }
}

#[test]
fn a_target_that_is_met_costs_nothing() {
    let weights = Weighted::by(&Weights::VARIATION, Lanes::ONE);
    for seed in 1..20 {
        let d = sample::<3>(seed);
        let target = Shape::<3>::slope(&d);
        let natural = Shape::value(&weights, &[Lanes::ZERO; 3], &d).value;
        let left = Shape::value(&weights, &target, &d).value;
        for lane in 0..2 {
            assert!(left.0[lane] <= 1e-28 * natural.0[lane]);
        }
    }
}
