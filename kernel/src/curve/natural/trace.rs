//! The true curve, and elements along it.
//!
//! With [`FINE_FUNCTIONS`] functions a span the direction converges faster than any power of their number, so that where
//! the last coefficients are nothing the curve is the true minimum variation curve. Elements then take their ends from it:
//! positions, directions and curvatures are true, and only the quintics between them are not.

use super::chain::{Chain, Effort, Ended, Watch, memory_len, turn, turned};
use super::fit::{Known, fit};
use super::functions::{FINE, FINE_FUNCTIONS, FINE_PAIRS, functions};
use super::span::Span;
use super::{applies, task};
use crate::basis::quadrature::legendre;
use crate::curve::accuracy::distance;
use crate::curve::end::End;
use crate::curve::fairness::{Density, Shape};
use crate::curve::model::Model;
use crate::curve::start::give_speeds;
use crate::order::Order;
use crate::root::sqrt;

/// To rounding.
const WHOLE: Effort = Effort { settled: 1e-10, iterations: 40, exact: true };
/// Elements that differ from the curve by less than this part of what is compared are laid well.
const ENOUGH: f64 = 1e-9;
/// Points with which a part of a curve is integrated.
const POINTS: usize = 8;
/// How large the integrals of the last functions are at most.
const LAST_INTEGRAL: f64 = 1e-4;
/// Places an element at which it is compared with the true curve.
const SAMPLES: usize = 8;

/// A true curve.
pub(in crate::curve) struct TrueCurve<'w> {
    chain: Chain<'w, FINE_FUNCTIONS, FINE_PAIRS>,
}

/// The memory that a true curve needs.
pub(in crate::curve) const fn trace_len(joints: usize, spans: usize, closed: bool) -> usize {
    memory_len(FINE_FUNCTIONS, joints, spans, closed)
}

/// Finds the true curve from good start values. `None` where it does not apply or does not settle.
pub(in crate::curve) fn trace<'w, const D: usize>(
    model: &Model<'_, D>,
    length: Option<f64>,
    state: &[f64],
    bent: Option<usize>,
    memory: &'w mut [f64],
    watch: &mut Watch<'_>,
) -> Option<TrueCurve<'w>>
where
    Shape<D>: Density<D>,
{
    if !applies(model) {
        return None;
    }
    let mut chain = Chain::of(&FINE, model, state, bent, memory)?;
    let (mut weigh, law) = task(model, length);
    (chain.settle(&mut weigh, law, &WHOLE, watch) == Ended::Settled).then_some(TrueCurve { chain })
}

/// The direction and its derivative by `u`.
fn direction(q: &[f64; FINE_FUNCTIONS], u: f64) -> [f64; 2] {
    let [values, slopes, _] = functions::<FINE_FUNCTIONS>(u);
    let mut sums = [0.0; 2];
    for i in 0..FINE_FUNCTIONS {
        sums[0] += q[i] * values[i];
        sums[1] += q[i] * slopes[i];
    }
    sums
}

/// `∫ (cos θ, sin θ) du` between two places.
fn way(q: &[f64; FINE_FUNCTIONS], from: f64, to: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    if let Some(rule) = legendre(POINTS) {
        for (node, weight) in rule.iter() {
            let [theta, _] = direction(q, from + (to - from) * node);
            sums[0] += weight * libm::cos(theta);
            sums[1] += weight * libm::sin(theta);
        }
    }
    sums.map(|sum| sum * (to - from))
}

impl TrueCurve<'_> {
    /// How far the curve may be off for want of functions.
    fn truncation(span: &Span<FINE_FUNCTIONS>) -> f64 {
        let last = span.own[FINE_FUNCTIONS - 4].abs() + span.own[FINE_FUNCTIONS - 5].abs();
        LAST_INTEGRAL * last * span.length()
    }

    /// Writes elements along the curve, so many equal parts a span as `counts` says, into the state of `fine`, the same
    /// curve with so many elements. Returns their natural cost.
    pub(in crate::curve) fn write<const D: usize>(
        &self,
        coarse: &Model<'_, D>,
        coarse_state: &[f64],
        fine: &Model<'_, D>,
        counts: impl Iterator<Item = usize>,
        state: &mut [f64],
    ) -> f64
    where
        Shape<D>: Density<D>,
    {
        state.fill(0.0);
        let (mut natural, mut first) = (0.0, 0);
        for (index, parts) in counts.enumerate() {
            let count = parts as f64;
            let span = self.chain.span(index);
            let (q, length) = (span.coefficients(), span.length());
            let joints = [coarse.end(index, 0, coarse_state), coarse.end(index, 1, coarse_state)];
            let along = (joints[1].point - joints[0].point) / span.chord;
            let joint_end = |end: usize| self.chain.joint_end(index, end, &span, &along, &joints[end]);
            let mut before = joint_end(0);
            let mut point = before.point;
            for part in 0..parts {
                let (from, to) = (part as f64 / count, (part + 1) as f64 / count);
                point += turned(&along, way(&q, from, to)) * length;
                let after = if part + 1 == parts {
                    joint_end(1)
                } else {
                    let [theta, slope] = direction(&q, to);
                    let mut inner = End { point, ..before };
                    turn(&mut inner, &along, theta);
                    inner.curvature[0] = slope / length;
                    inner
                };
                let piece = length / count;
                let [a, b] = [before.curvature[0], after.curvature[0]];
                let mut ends = [before, after];
                give_speeds(&mut ends, piece, piece * sqrt(0.5 * (a * a + b * b)));
                let known = Known { direction: &q, length, from, to };
                fit(&mut ends, &known, fine.weights.variation > 0.0, false, ENOUGH);
                for (end, value) in ends.iter().enumerate() {
                    fine.set_end(first + part, end, value, state);
                }
                natural += fine.natural_of(piece);
                before = after;
            }
            first += parts;
        }
        natural
    }

    /// How far the elements of each span are from the curve.
    pub(in crate::curve) fn distances<const D: usize>(
        &self,
        coarse: &Model<'_, D>,
        coarse_state: &[f64],
        fine: &Model<'_, D>,
        counts: &[f64],
        state: &[f64],
        errors: &mut [f64],
    ) where
        Shape<D>: Density<D>,
    {
        let mut first = 0;
        for (index, (&count, error)) in counts.iter().zip(errors).enumerate() {
            let span = self.chain.span(index);
            let (q, length) = (span.coefficients(), span.length());
            let joints = [coarse.end(index, 0, coarse_state), coarse.end(index, 1, coarse_state)];
            let along = (joints[1].point - joints[0].point) / span.chord;
            let mut point = joints[0].point;
            let mut at = 0.0;
            let mut most = 0.0f64;
            for part in 0..count as usize {
                let rows = fine.rows(first + part, state);
                for sample in 0..SAMPLES {
                    let t = (sample as f64 + 0.5) / SAMPLES as f64;
                    let next = (part as f64 + t) / count;
                    point += turned(&along, way(&q, at, next)) * length;
                    at = next;
                    most = most.larger(distance(&point, &rows, t));
                }
            }
            *error = most + Self::truncation(&span);
            first += count as usize;
        }
    }
}
