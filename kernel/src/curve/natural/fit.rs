//! The quintic that runs along a known curve: its speeds and stretches, by least squares.
//!
//! Positions, tangents and curvatures at the ends are the known curve's; of a quintic's freedoms that leaves `v` and
//! `β` at either end. They are chosen so that `dκ/ds` (for an energy: `κ`) differs least from the known curve's at the
//! same fraction of the arc length, in the mean square. A curve that is a minimum has no slope, so this difference is,
//! to first order, by what the quintic's functional exceeds the known curve's: no other quintic with these ends has
//! much less. What is left over is small, so that two steps by Gauss and Newton are mostly enough.

use super::functions::slopes;
use crate::basis::hermite;
use crate::basis::lanes::{Lanes, WIDTH};
use crate::basis::quadrature::legendre;
use crate::curve::end::End;
use crate::curve::fairness::{curvature_with_derivatives, slope_with_derivatives};
use crate::order::Order;
use crate::root::sqrt;

#[cfg(test)]
mod tests;

/// Points of the rule by which curves are compared.
const POINTS: usize = 8;
const PAIRS: usize = POINTS / WIDTH;
/// The rows that count: `C'(0), C''(0), C''(1), C'(1)` and the chord.
const ROWS: usize = 5;
/// More steps than are mostly needed.
const MOST_STEPS: usize = 8;
/// Settled when a step promises less than this part of what is left.
const SETTLED: f64 = 1e-2;
/// A difference that is this part of what is compared is none.
const NOTHING: f64 = 1e-10;
/// Where more than this part of what is compared is left over, other starts are tried: the logarithms of the ratio
/// between the speed at the first end and that in the middle.
const TELLING: f64 = 1e-6;
const SKEWS: [f64; 2] = [0.3, -0.3];
/// The same from the last solution's speeds, times this.
const WARM: f64 = 1e3;
/// The longest step, as a part of the speed.
const LONGEST: f64 = 0.4;
/// What the matrix is raised by where the data do not tell a direction, as a part of its diagonal.
const DAMPING: f64 = 1e-12;

struct Tables {
    weight: [Lanes; PAIRS],
    /// `by[k][a]`: derivative `k + 1` of row `a`'s function.
    by: [[[Lanes; PAIRS]; ROWS]; 3],
    /// `integral[j]`: what a value at point `j` adds to the integrals up to the points.
    integral: [[Lanes; PAIRS]; POINTS],
}

const fn tables() -> Tables {
    let mut out = Tables {
        weight: [Lanes::ZERO; PAIRS],
        by: [[[Lanes::ZERO; PAIRS]; ROWS]; 3],
        integral: [[Lanes::ZERO; PAIRS]; POINTS],
    };
    if let Some(rule) = legendre(POINTS) {
        let mut i = 0;
        while i < POINTS {
            let (pair, lane) = (i / WIDTH, i % WIDTH);
            out.weight[pair].0[lane] = rule.weights[i];
            let basis = hermite::basis(rule.nodes[i]);
            let mut k = 0;
            while k < 3 {
                let mut a = 0;
                while a < ROWS {
                    out.by[k][a][pair].0[lane] = basis[k + 1][a + 1];
                    a += 1;
                }
                k += 1;
            }
            // The polynomial that is 1 at this point and 0 at the others, and its integrals.
            let mut polynomial = [0.0; POINTS];
            polynomial[0] = 1.0;
            let mut degree = 0;
            let mut j = 0;
            while j < POINTS {
                if j != i {
                    let by = 1.0 / (rule.nodes[i] - rule.nodes[j]);
                    let mut at = degree + 1;
                    while at > 0 {
                        polynomial[at] = (polynomial[at - 1] - rule.nodes[j] * polynomial[at]) * by;
                        at -= 1;
                    }
                    polynomial[0] *= -rule.nodes[j] * by;
                    degree += 1;
                }
                j += 1;
            }
            let mut j = 0;
            while j < POINTS {
                let t = rule.nodes[j];
                let mut sum = 0.0;
                let mut at = POINTS;
                while at > 0 {
                    sum = sum * t + polynomial[at - 1] / at as f64;
                    at -= 1;
                }
                out.integral[i][j / WIDTH].0[j % WIDTH] = sum * t;
                j += 1;
            }
            i += 1;
        }
    }
    out
}

static TABLES: Tables = tables();

/// A part of a span whose direction is known: from where to where, as fractions of the span.
pub(super) struct Known<'a, const N: usize> {
    /// The direction's coefficients.
    pub(super) direction: &'a [f64; N],
    /// The span's length.
    pub(super) length: f64,
    pub(super) from: f64,
    pub(super) to: f64,
}

impl<const N: usize> Known<'_, N> {
    /// What the square of what is compared is, integrated, on an arc of this length that turns by a radian or so.
    fn natural(&self, varies: bool) -> f64 {
        let length = self.length * (self.to - self.from);
        if varies { 1.0 / (length * length * length) } else { 1.0 / length }
    }

    /// What is compared, at a fraction of the part, and its derivative by that fraction.
    #[inline(always)]
    fn at(&self, varies: bool, fraction: Lanes) -> [Lanes; 2] {
        let part = self.to - self.from;
        let [first, second, third] = slopes(self.direction, fraction * part + Lanes::ONE * self.from);
        let by = 1.0 / self.length;
        if varies {
            [second * (by * by), third * (part * by * by)]
        } else {
            [first * by, second * (part * by)]
        }
    }
}

/// Gives the ends of a planar element the speeds and stretches with which it runs along a known curve, from those that
/// they have. `varies` tells whether `dκ/ds` is compared, or `κ`; a misfit that is the part `enough` of what is
/// compared will do; a `warm` start is followed alone unless it leads to much. Returns the integral of the squared
/// difference.
pub(super) fn fit<const D: usize, const N: usize>(
    ends: &mut [End<D>; 2],
    known: &Known<'_, N>,
    varies: bool,
    warm: bool,
    enough: f64,
) -> f64 {
    let enough = enough.larger(NOTHING);
    let shape = Shape {
        chord: core::array::from_fn(|x| ends[1].point[x] - ends[0].point[x]),
        tangents: [0, 1].map(|end: usize| [ends[end].frame[0][0], ends[end].frame[0][1]]),
        curvatures: [ends[0].curvature[0], ends[1].curvature[0]],
    };
    // Speed and stretch at the first end, then at the last.
    let start = [ends[0].speed, ends[0].stretch, ends[1].speed, ends[1].stretch];
    let (mut best, telling) = settle(&shape, start, known, varies, enough);
    if best.1 > if warm { WARM * telling } else { telling } {
        for skew in SKEWS {
            let even = 0.5 * (start[0] + start[2]);
            let [one, other] = [even * libm::exp(skew), even * libm::exp(-skew)];
            let (found, _) =
                settle(&shape, [one, -2.0 * skew * one, other, -2.0 * skew * other], known, varies, enough);
            if found.1 < best.1 {
                best = found;
            }
        }
    }
    let (values, misfit) = best;
    for (end, value) in ends.iter_mut().zip(values.chunks_exact(2)) {
        (end.speed, end.stretch) = (value[0], value[1]);
    }
    misfit
}

/// What does not change while a quintic is fitted.
struct Shape {
    chord: [f64; 2],
    tangents: [[f64; 2]; 2],
    curvatures: [f64; 2],
}

/// Follows Gauss's and Newton's steps from a start. Returns the best values with their misfit, and what would be a telling
/// misfit: there may be a better quintic that runs faster at one end.
fn settle<const N: usize>(
    shape: &Shape,
    start: [f64; 4],
    known: &Known<'_, N>,
    varies: bool,
    enough: f64,
) -> (([f64; 4], f64), f64) {
    let mut now = start;
    let mut best = (now, f64::INFINITY);
    let mut telling = 0.0;
    for _ in 0..MOST_STEPS {
        let found = compare(shape, &now, known, varies);
        telling = TELLING * (found.size + known.natural(varies));
        // A step along a curved valley may climb: the next one goes down into it.
        if found.misfit < best.1 {
            best = (now, found.misfit);
        }
        if found.misfit <= enough * found.size {
            break;
        }
        let Some((step, gain)) = found.step(&now) else { break };
        for i in 0..4 {
            now[i] += step[i];
        }
        if gain <= SETTLED * best.1 {
            best = (now, found.misfit - gain);
            break;
        }
    }
    (best, telling)
}

/// A comparison: the normal equations of the difference.
struct Compared {
    misfit: f64,
    /// The integral of the known curve's square.
    size: f64,
    slope: [f64; 4],
    matrix: [[f64; 4]; 4],
}

fn compare<const N: usize>(
    Shape { chord, tangents, curvatures }: &Shape,
    now: &[f64; 4],
    known: &Known<'_, N>,
    varies: bool,
) -> Compared {
    let tables = &TABLES;
    let mut rows = [[0.0; 2]; ROWS];
    // How fast C'' turns with a speed: 2 v κ n.
    let mut turning = [0.0; 2];
    for end in 0..2 {
        let (speed, stretch, [x, y]) = (now[2 * end], now[2 * end + 1], tangents[end]);
        let bend = speed * speed * curvatures[end];
        turning[end] = 2.0 * speed * curvatures[end];
        let (first, second) = if end == 0 { (0, 1) } else { (3, 2) };
        rows[first] = [speed * x, speed * y];
        rows[second] = [stretch * x - bend * y, stretch * y + bend * x];
    }
    rows[4] = *chord;

    let zero = [Lanes::ZERO; PAIRS];
    let (mut speeds, mut values) = (zero, zero);
    // The derivatives of the value and of the speed by the four unknowns.
    let (mut by_unknowns, mut paces) = ([zero; 4], [zero; 4]);
    for k in 0..PAIRS {
        let d: [[Lanes; 2]; 3] = core::array::from_fn(|order| {
            core::array::from_fn(|x| {
                let mut sum = tables.by[order][0][k] * rows[0][x];
                for a in 1..ROWS {
                    sum += tables.by[order][a][k] * rows[a][x];
                }
                sum
            })
        });
        let [a, b] = d[0];
        let p = a * a + b * b;
        let speed = p.sqrt();
        let pace = speed * (Lanes::ONE / p);
        speeds[k] = speed;
        // The value's derivatives by C', C'', C'''.
        let (value, slopes) =
            if varies { slope_with_derivatives(&d) } else { curvature_with_derivatives(&d) };
        values[k] = value;
        for end in 0..2 {
            let [x, y] = tangents[end];
            let (first, second) = if end == 0 { (0, 1) } else { (3, 2) };
            let mut along = [Lanes::ZERO; 2];
            for order in 0..3 {
                let forward = slopes[order][0] * x + slopes[order][1] * y;
                let aside = slopes[order][1] * x - slopes[order][0] * y;
                let by = &tables.by[order];
                along[0] += forward * by[first][k] + aside * by[second][k] * turning[end];
                along[1] += forward * by[second][k];
            }
            let forward = (a * x + b * y) * pace;
            let aside = (b * x - a * y) * pace;
            let by = &tables.by[0];
            paces[2 * end][k] = forward * by[first][k] + aside * by[second][k] * turning[end];
            paces[2 * end + 1][k] = forward * by[second][k];
            by_unknowns[2 * end][k] = along[0];
            by_unknowns[2 * end + 1][k] = along[1];
        }
    }

    let (length, places) = integrals(&speeds);
    let inverse = 1.0 / length;
    let (mut wanted, mut off) = (zero, zero);
    let mut slope = zero;
    let mut fractions = zero;
    for k in 0..PAIRS {
        fractions[k] = places[k] * inverse;
        let [value, by_fraction] = known.at(varies, fractions[k]);
        wanted[k] = value;
        off[k] = values[k] - value;
        slope[k] = by_fraction * inverse;
    }
    for i in 0..4 {
        let (whole, moved) = integrals(&paces[i]);
        for k in 0..PAIRS {
            by_unknowns[i][k] = by_unknowns[i][k] - slope[k] * (moved[k] - fractions[k] * whole);
        }
    }
    let mut out = Compared { misfit: 0.0, size: 0.0, slope: [0.0; 4], matrix: [[0.0; 4]; 4] };
    let weights: [Lanes; PAIRS] = core::array::from_fn(|k| tables.weight[k] * speeds[k]);
    let sum = |one: &[Lanes; PAIRS], other: &[Lanes; PAIRS]| {
        let mut sum = Lanes::ZERO;
        for k in 0..PAIRS {
            sum += weights[k] * one[k] * other[k];
        }
        sum.total()
    };
    out.misfit = sum(&off, &off);
    out.size = sum(&wanted, &wanted);
    for i in 0..4 {
        out.slope[i] = sum(&by_unknowns[i], &off);
        for j in 0..=i {
            out.matrix[i][j] = sum(&by_unknowns[i], &by_unknowns[j]);
        }
    }
    out
}

/// The integral over the whole, and those up to the points.
#[inline(always)]
fn integrals(of: &[Lanes; PAIRS]) -> (f64, [Lanes; PAIRS]) {
    let mut whole = Lanes::ZERO;
    let mut out = [Lanes::ZERO; PAIRS];
    for j in 0..PAIRS {
        whole += TABLES.weight[j] * of[j];
        for lane in 0..WIDTH {
            let (value, by) = (of[j].0[lane], &TABLES.integral[WIDTH * j + lane]);
            for k in 0..PAIRS {
                out[k] += by[k] * value;
            }
        }
    }
    (whole.total(), out)
}

impl Compared {
    /// The step to the least misfit, not too far, and by how much it promises to lower it.
    fn step(&self, now: &[f64; 4]) -> Option<([f64; 4], f64)> {
        let mut factor = self.matrix;
        let mut step = self.slope.map(|slope| -slope);
        for i in 0..4 {
            for j in 0..i {
                let mut sum = factor[i][j];
                for k in 0..j {
                    sum -= factor[i][k] * factor[j][k];
                }
                factor[i][j] = sum / factor[j][j];
            }
            let mut pivot = factor[i][i] * (1.0 + DAMPING);
            for k in 0..i {
                pivot -= factor[i][k] * factor[i][k];
            }
            if !(pivot > 0.0) {
                return None;
            }
            factor[i][i] = sqrt(pivot);
            for k in 0..i {
                step[i] -= factor[i][k] * step[k];
            }
            step[i] /= factor[i][i];
        }
        let gain = step.iter().fold(0.0, |sum, y| sum + y * y);
        for i in (0..4).rev() {
            for k in i + 1..4 {
                step[i] -= factor[k][i] * step[k];
            }
            step[i] /= factor[i][i];
        }
        let far = (step[0] / now[0]).abs().larger((step[2] / now[2]).abs());
        if !far.is_finite() {
            return None;
        }
        let by = if far > LONGEST { LONGEST / far } else { 1.0 };
        Some((step.map(|step| step * by), gain * by * (2.0 - by)))
    }
}
