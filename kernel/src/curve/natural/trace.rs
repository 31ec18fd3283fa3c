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

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::{Wish, improve};
    use super::*;
    use crate::curve::functional::Functional;
    use crate::curve::joint::{Curve, Joint};
    use crate::curve::model::Division;
    use crate::curve::options::Options;
    use crate::curve::tests::{planar, started};
    use crate::solve::Problem;
    use nalgebra::SVector;
    use std::vec;
    use std::vec::Vec;

    const POINTS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.2, 2.4, 0.0], [4.0, 0.2, 0.0]];
    const COUNTS: [f64; 4] = [2.0, 1.0, 4.0, 3.0];

    /// The way along a true curve to a place of a span, by many small steps.
    fn walked(q: &[f64; FINE_FUNCTIONS], u: f64, length: f64) -> [f64; 2] {
        const STEPS: usize = 4000;
        let mut sums = [0.0; 2];
        for k in 0..STEPS {
            let [theta, _] = direction(q, u * (k as f64 + 0.5) / STEPS as f64);
            sums[0] += libm::cos(theta);
            sums[1] += libm::sin(theta);
        }
        sums.map(|sum| sum * u * length / STEPS as f64)
    }

    /// The start values that a true curve is found from.
    fn begin(model: &Model<'_, 2>) -> Vec<f64> {
        let mut state = started(model);
        let (joints, spans) = (model.curve.joints.len(), model.curve.spans());
        let mut memory = vec![f64::NAN; memory_len(6, joints, spans, model.curve.closed)];
        let wish = Wish { length: None, bent: None, warm: false, enough: 1e-9 };
        improve(model, &wish, &mut state, &mut memory, &mut |_, _| true);
        state
    }

    #[test]
    fn elements_along_a_true_curve_have_its_places_directions_and_curvatures() {
        let joints = POINTS.map(Joint::at);
        for (closed, functional) in [
            (false, Functional::MVC),
            (true, Functional::MVC),
            (false, Functional::MEC),
            (true, Functional::SI_MVC),
        ] {
            let curve = Curve { closed, ..Curve::open(&joints) };
            let coarse = planar(&curve, &Options { functional, ..Options::DEFAULT });
            let coarse_state = begin(&coarse);
            let mut memory = vec![f64::NAN; trace_len(4, curve.spans(), closed)];
            let found = trace(&coarse, None, &coarse_state, None, &mut memory, &mut |_, _| true);
            let Some(found) = found else { panic!("it settles") };

            let counts = &COUNTS[..curve.spans()];
            let mut marks: Vec<f64> = Vec::new();
            for (span, &count) in counts.iter().enumerate() {
                marks.push((span + 1) as f64);
                marks.extend(vec![0.0; count as usize - 1]);
            }
            if !closed {
                marks.push((counts.len() + 1) as f64);
            }
            let fine = Model { division: Division::Marked(&marks), ..coarse };
            let mut state = vec![f64::NAN; fine.state_len()];
            let parts = counts.iter().map(|&count| count as usize);
            let natural = found.write(&coarse, &coarse_state, &fine, parts, &mut state);

            let (mut element, mut costs) = (0, 0.0);
            let mut farthest = Vec::new();
            for (index, &count) in counts.iter().enumerate() {
                let span = found.chain.span(index);
                let (q, length) = (span.coefficients(), span.length());
                let from = SVector::<f64, 2>::from([POINTS[index][0], POINTS[index][1]]);
                let to = POINTS[(index + 1) % 4];
                let along = (SVector::from([to[0], to[1]]) - from) / span.chord;
                let at = |u: f64| from + turned(&along, walked(&q, u, length));
                for part in 0..count as usize {
                    for end in 0..2 {
                        let u = (part + end) as f64 / count;
                        let this = fine.end(element, end, &state);
                        assert!((this.point - at(u)).amax() < 1e-6, "{index} {part} {end}");
                        let [theta, slope] = direction(&q, u);
                        let tangent = turned(&along, [libm::cos(theta), libm::sin(theta)]);
                        assert!((this.frame[0] - tangent).amax() < 1e-9, "{index} {part} {end}");
                        assert!((this.frame[1] - SVector::from([-tangent[1], tangent[0]])).amax() < 1e-9);
                        assert!((this.curvature[0] - slope / length).abs() < 1e-8, "{index} {part} {end}");
                    }
                    costs += fine.natural_of(length / count);
                    element += 1;
                }
                farthest.push((0..40).map(|k| at((f64::from(k) + 0.5) / 40.0)).collect::<Vec<_>>());
            }
            assert!((natural - costs).abs() < 1e-12 * costs, "{natural} {costs}");

            // How far the elements are: as far as what is drawn in small steps, and as a node that is moved.
            let mut errors = vec![f64::NAN; counts.len()];
            found.distances(&coarse, &coarse_state, &fine, counts, &state, &mut errors);
            let mut first = 0;
            for (index, &count) in counts.iter().enumerate() {
                let mut most = 0.0f64;
                for (k, point) in farthest[index].iter().enumerate() {
                    let place = (k as f64 + 0.5) / 40.0 * count;
                    let part = libm::floor(place);
                    let rows = fine.rows(first + part as usize, &state);
                    most = most.larger(distance(point, &rows, place - part));
                }
                // Small steps are right to some 1e-8; samples are not the farthest places.
                let found = errors[index];
                assert!(found < 1.6 * most + 1e-7 && found > 0.6 * most - 1e-7, "{index}: {found} {most}");
                first += count as usize;
            }
            let mut node = 0;
            for (moved, &count) in counts.iter().enumerate() {
                for inner in node + 1..node + count as usize {
                    let mut state = state.clone();
                    let normal = fine.end(inner, 0, &state).frame[1];
                    (0..2).for_each(|d| state[Model::<2>::point_place(inner) + d] += 0.01 * normal[d]);
                    let mut now = errors.clone();
                    found.distances(&coarse, &coarse_state, &fine, counts, &state, &mut now);
                    for (span, (now, before)) in now.iter().zip(&errors).enumerate() {
                        let wanted = if span == moved { 0.0085..0.0125 } else { 0.0..1e-9 };
                        let off = if span == moved { *now } else { (now - before).abs() };
                        assert!(wanted.contains(&off), "{span} beside {moved}: {now} {before}");
                    }
                }
                node += count as usize;
            }
        }
    }

    #[test]
    fn what_is_not_planar_through_fixed_joints_has_no_true_curve() {
        let joints = POINTS.map(Joint::at);
        let mut slides = joints;
        slides[1] = slides[1].on_line(POINTS[1], [0.0, 1.0, 0.0]);
        for (joints, division, traced) in [(joints, 1, true), (joints, 2, false), (slides, 1, false)] {
            let curve = Curve::open(&joints);
            let plain = planar(&curve, &Options::DEFAULT);
            let model = Model { division: Division::Even(division), ..plain };
            let state = begin(&model);
            let mut memory = vec![f64::NAN; trace_len(4, 3, false)];
            let of = |memory: &mut [f64], goes_on: bool| {
                trace(&model, None, &state, None, memory, &mut |_, _| goes_on).is_some()
            };
            assert_eq!(of(&mut memory, true), traced);
            assert!(!of(&mut memory, false));
            let short = memory.len() - 1;
            assert!(!of(&mut memory[..short], true));
        }
    }
}
