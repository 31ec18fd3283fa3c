//! A chain of spans by their directions: what neighbours share, and Newton's method on it.

use super::functions::Tables;
use super::span::{COLUMNS, Condensed, Span, Weigh, condense};
use crate::curve::end::End;
use crate::curve::fairness::{Density, Shape};
use crate::curve::model::Model;
use crate::order::Order;
use crate::root::sqrt;
use crate::solve::{Allow, Envelope, Indices, dot};
use crate::total::Total;
use nalgebra::SVector;

#[cfg(test)]
mod tests;

/// The most unknowns of a joint: direction and curvature on either side.
const MOST_A_JOINT: usize = 4;
/// The longest row of the matrix that an open chain needs.
const REACH: usize = 3 * MOST_A_JOINT;
/// A value that is no unknown.
const FIXED: f64 = -1.0;
/// The longest step of a direction (radians).
const LONGEST_STEP: f64 = 0.5;
/// The longest step of a curvature times its chord.
const LONGEST_BEND: f64 = 2.0;
/// The least part of a tension's own change by which one step is divided.
const LEAST_HOLD: f64 = 0.2;
/// A curve that grows by this factor may grow without limit.
const GROWN: f64 = 4.0;

/// The memory that a chain of spans with `n` functions needs.
pub(super) const fn memory_len(functions: usize, joints: usize, spans: usize, closed: bool) -> usize {
    let unknowns = MOST_A_JOINT * joints;
    let across = if closed { MOST_A_JOINT } else { 0 };
    spans * stride(functions) + joints + 6 * unknowns + 2 * unknowns * (REACH + across)
}

const fn stride(functions: usize) -> usize {
    4 + (5 + functions - 3) + COLUMNS * (functions - 3)
}

/// How Newton's method ended.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ended {
    /// Nothing changes any more.
    Settled,
    /// The curve grows: it may have no minimum.
    Grown,
    /// It does not settle, or a span has no regular solution nearby.
    Failed,
    /// Who watches asked to stop.
    Stopped,
}

/// Watches: called after every iteration with `∫ θ''² ds`, `∫ θ'² ds` and the length before it, and how far it went (the
/// largest change of a direction, or of a curvature times its chord). Returns whether to go on.
pub(super) type Watch<'a> = dyn FnMut(&[f64; 3], f64) -> bool + 'a;

/// How far to go.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// Settled when no direction changes by more than this (radians), nor a curvature by this over the chord.
    pub(super) settled: f64,
    pub(super) iterations: usize,
    /// Sines to rounding.
    pub(super) exact: bool,
}

pub(super) struct Chain<'w, const N: usize, const C: usize> {
    tables: &'static Tables<N, C>,
    /// A span after the other: the places of its unknowns, its values, how its own values follow.
    spans: &'w mut [f64],
    row_first: Indices<'w>,
    row_start: Indices<'w>,
    gradient: &'w mut [f64],
    step: &'w mut [f64],
    length_gradient: &'w mut [f64],
    /// The step by the tension.
    pulled: &'w mut [f64],
    matrix: &'w mut [f64],
    factor: &'w mut [f64],
    /// `∫ θ''² ds`, `∫ θ'² ds` and the length at the last linearisation.
    sums: [f64; 3],
    /// By how much the functional would sink, about, with more functions.
    left_out: f64,
}

/// What of a side of a joint is an unknown: its place among the joint's unknowns.
fn rank<const D: usize>(model: &Model<'_, D>, joint: usize, side: usize, bends: bool) -> Option<usize>
where
    Shape<D>: Density<D>,
{
    let mut count = 0;
    let mut found = None;
    let mut offer = |owner: Option<usize>, is_curvature: bool, free: bool| {
        if free {
            if is_curvature == bends && owner.is_none_or(|owner| owner == side) {
                found = Some(count);
            }
            count += 1;
        }
    };
    let (shares_tangent, shares_curvature) = model.shares(joint);
    let [arriving, leaving] = [0, 1].map(|side| model.bends_and_turns(joint, side));
    if !shares_curvature {
        offer(Some(0), true, arriving.0);
    }
    if shares_tangent {
        offer(None, false, arriving.1);
    } else {
        offer(Some(0), false, arriving.1);
        offer(Some(1), false, leaving.1);
    }
    if shares_curvature {
        offer(None, true, arriving.0);
    } else {
        offer(Some(1), true, leaving.0);
    }
    found
}

/// How many unknowns a joint has.
fn joint_unknowns<const D: usize>(model: &Model<'_, D>, joint: usize) -> usize
where
    Shape<D>: Density<D>,
{
    let last = |side, bends| rank(model, joint, side, bends).map_or(0, |rank| rank + 1);
    last(0, true).max(last(0, false)).max(last(1, true)).max(last(1, false))
}

/// The direction of `b` against `a`.
pub(in crate::curve) fn angle<const D: usize>(a: &SVector<f64, D>, b: &SVector<f64, D>) -> f64 {
    libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
}

impl<'w, const N: usize, const C: usize> Chain<'w, N, C> {
    /// The chain of a curve with one element a span, from its state; the span `bent`, if any, closed the second-nearest
    /// way. `None` where a span cannot be closed. `memory` holds [`memory_len`] numbers.
    pub(super) fn of<const D: usize>(
        tables: &'static Tables<N, C>,
        model: &Model<'_, D>,
        state: &[f64],
        bent: Option<usize>,
        memory: &'w mut [f64],
    ) -> Option<Self>
    where
        Shape<D>: Density<D>,
    {
        let chain = Self::laid_out(tables, model, memory)?;
        let (joints, closed) = (model.node_count(), model.curve.closed);
        for (index, memory) in chain.spans.chunks_exact_mut(stride(N)).enumerate() {
            let ends = [model.end(index, 0, state), model.end(index, 1, state)];
            let chord = ends[1].point - ends[0].point;
            let phi = [0, 1].map(|end: usize| angle(&chord, &ends[end].frame[0]));
            let half = 0.5 * (phi[1] - phi[0]);
            let stretched = if half.abs() > 1e-3 { half / libm::sin(half) } else { 1.0 };
            let mut own = [0.0; N];
            own[0] = if stretched > 0.0 { stretched.smaller(4.0) } else { 4.0 };
            let mut span = Span {
                chord: sqrt(chord.dot(&chord)),
                shared: [phi[0], ends[0].curvature[0], phi[1], ends[1].curvature[0]],
                own,
            };
            let alone = [0, 1].map(|end: usize| {
                let joint = model.node(index, end);
                let (bends, _) = model.bends_and_turns(joint, 1 - end);
                let (_, shared) = model.shares(joint);
                bends && (!shared || (!closed && (joint == 0 || joint + 1 == joints)))
            });
            if !span.close(tables, alone, usize::from(bent == Some(index))) {
                return None;
            }
            span.store(memory.part_mut(4..));
        }
        Some(chain)
    }

    fn laid_out<const D: usize>(
        tables: &'static Tables<N, C>,
        model: &Model<'_, D>,
        memory: &'w mut [f64],
    ) -> Option<Self>
    where
        Shape<D>: Density<D>,
    {
        let (joints, count, closed) = (model.node_count(), model.element_count(), model.curve.closed);
        if memory.len() < memory_len(N, joints, count, closed) {
            return None;
        }
        let (spans, rest) = memory.cut_mut(count * stride(N));
        let (offset, rest) = rest.cut_mut(joints);
        // A ring is cut open at its first joint, whose unknowns come last.
        let mut offsets = Indices::new(offset);
        let mut unknowns = 0;
        for at in 0..joints {
            let joint = if closed { (at + 1) % joints } else { at };
            offsets.set(joint, unknowns);
            unknowns += joint_unknowns(model, joint);
        }
        for (index, memory) in spans.chunks_exact_mut(stride(N)).enumerate() {
            for (kind, place) in memory.iter_mut().take(4).enumerate() {
                let (end, bends) = (kind / 2, kind % 2 == 1);
                let joint = model.node(index, end);
                *place = rank(model, joint, 1 - end, bends)
                    .map_or(FIXED, |rank| (offsets.get(joint) + rank) as f64);
            }
        }
        let (first, rest) = rest.cut_mut(unknowns);
        let (start, rest) = rest.cut_mut(unknowns);
        let (gradient, rest) = rest.cut_mut(unknowns);
        let (step, rest) = rest.cut_mut(unknowns);
        let (length_gradient, rest) = rest.cut_mut(unknowns);
        let (pulled, rest) = rest.cut_mut(unknowns);
        let (mut row_first, mut row_start) = (Indices::new(first), Indices::new(start));
        for row in 0..unknowns {
            row_first.set(row, row);
        }
        for memory in spans.chunks_exact(stride(N)) {
            let (places, _) = memory.cut(4);
            let free = || places.iter().filter(|&&place| place >= 0.0);
            let low = free().fold(f64::INFINITY, |low, &place| low.smaller(place));
            for &place in free() {
                let row = place as usize;
                row_first.set(row, row_first.get(row).min(low as usize));
            }
        }
        let mut entries = 0;
        for row in 0..unknowns {
            row_start.set(row, entries);
            entries += row - row_first.get(row) + 1;
        }
        let (matrix, rest) = rest.split_at_mut_checked(entries)?;
        let factor = rest.get_mut(..entries)?;
        let sums = [0.0; 3];
        Some(Self {
            tables,
            spans,
            row_first,
            row_start,
            gradient,
            step,
            length_gradient,
            pulled,
            matrix,
            factor,
            sums,
            left_out: 0.0,
        })
    }

    pub(super) fn span(&self, index: usize) -> Span<N> {
        Span::load(self.spans.part(index * stride(N) + 4..))
    }

    /// A joint's end of a span, from what it was: its point stands, and its tangent where that is given. `along` is the
    /// chord's direction.
    pub(super) fn joint_end<const D: usize>(
        &self,
        index: usize,
        end: usize,
        span: &Span<N>,
        along: &SVector<f64, D>,
        was: &End<D>,
    ) -> End<D> {
        let mut this = *was;
        // Whether its direction is an unknown.
        if self.spans.at(index * stride(N) + 2 * end) >= 0.0 {
            turn(&mut this, along, span.shared.at(2 * end));
        }
        this.curvature.put(0, span.shared.at(2 * end + 1));
        this
    }

    /// The weighed integrals.
    pub(super) fn integral(&self, weigh: &Weigh) -> f64 {
        let spans = self.spans.chunks_exact(stride(N));
        spans.map(|memory| Span::<N>::load(memory.part(4..)).integral(self.tables, weigh)).sum()
    }

    /// `∫ θ''² ds`, `∫ θ'² ds` and the length.
    pub(super) fn sums(&self) -> [f64; 3] {
        let one = |bend, slope| self.integral(&Weigh { bend, slope, length: 0.0 });
        [one(1.0, 0.0), one(0.0, 1.0), self.length()]
    }

    /// By how much the functional would sink, about, with more functions.
    pub(super) fn left_out(&self) -> f64 {
        self.left_out
    }

    pub(super) fn length(&self) -> f64 {
        self.spans.chunks_exact(stride(N)).map(|memory| Span::<N>::load(memory.part(4..)).length()).sum()
    }

    /// Gradient and Hessian; returns how far the spans are from closing.
    fn linearise(&mut self, weigh: &Weigh, curvature: f64, exact: bool) -> Option<f64> {
        self.gradient.fill(0.0);
        self.length_gradient.fill(0.0);
        self.matrix.fill(0.0);
        self.sums = [0.0; 3];
        self.left_out = 0.0;
        let envelope = Envelope::Rows { first: &self.row_first, start: &self.row_start };
        let mut gap = 0.0f64;
        for memory in self.spans.chunks_exact_mut(stride(N)) {
            let (places, rest) = memory.cut_mut(4);
            let (values, follow) = rest.cut_mut(Span::<N>::LEN);
            let Condensed { gradient, length_gradient, hessian, follow: found, gap: own_gap, sums, left_out } =
                condense(self.tables, &Span::load(values), weigh, curvature, exact)?;
            for (to, row) in follow.chunks_exact_mut(COLUMNS).zip(&found) {
                to.copy(row);
            }
            gap = gap.larger(own_gap);
            self.left_out += left_out;
            for k in 0..3 {
                self.sums[k] += sums[k];
            }
            for (f, &place) in places.iter().enumerate().take(4) {
                if place < 0.0 {
                    continue;
                }
                let row = place as usize;
                self.gradient.add(row, gradient[f]);
                self.length_gradient.add(row, length_gradient[f]);
                for (e, &other) in places.iter().enumerate().take(4) {
                    if other >= 0.0 && other <= place {
                        envelope.add(self.matrix, row, other as usize, hessian[f][e]);
                    }
                }
            }
        }
        Some(gap)
    }

    /// Newton's method on directions, curvatures and the tension, which `law` determines. Where the matrix is indefinite,
    /// the curvature of the closing conditions is left out. Returns the tension in `weigh.length`.
    pub(super) fn settle(
        &mut self,
        weigh: &mut Weigh,
        law: Law,
        effort: &Effort,
        watch: &mut Watch<'_>,
    ) -> Ended {
        let unknowns = self.gradient.len();
        let start_length = self.length();
        for _ in 0..effort.iterations {
            if let Law::Power(power) = law {
                // The tension that belongs to the curve as it stands: one that lags behind pulls now too much, now too
                // little.
                let own = self.integral(&Weigh { length: 0.0, ..*weigh });
                weigh.length = power * own / self.length();
            }
            let mut gap = None;
            for curvature in [1.0, 0.0] {
                let Some(found) = self.linearise(weigh, curvature, effort.exact) else { continue };
                let envelope = Envelope::Rows { first: &self.row_first, start: &self.row_start };
                let norm = envelope.norm(self.matrix, self.factor.part_mut(..unknowns));
                // Longer than it would like to be, a curve is under negative tension: it is held by its length.
                let allow = if matches!(law, Law::Length(_)) { Allow::OneNegative } else { Allow::Definite };
                let Ok(factored) = envelope.factor(self.matrix, norm, 0.0, allow, self.factor) else {
                    continue;
                };
                let solve = |step: &mut [f64], gradient: &[f64]| {
                    for (s, g) in step.iter_mut().zip(gradient) {
                        *s = -g;
                    }
                    envelope.solve(self.factor, factored, step);
                };
                if !matches!(law, Law::Plain) {
                    solve(self.pulled, self.length_gradient);
                    let along = dot(self.pulled, self.length_gradient);
                    if factored.negative.is_some() && !(along > 0.0) {
                        continue;
                    }
                }
                solve(self.step, self.gradient);
                gap = Some(found);
                break;
            }
            let Some(gap) = gap else { return Ended::Failed };
            let change = self.tension_change(weigh, law);
            if !matches!(law, Law::Plain) {
                for (s, p) in self.step.iter_mut().zip(self.pulled.iter()) {
                    *s += change * p;
                }
            }
            let (mut largest, mut turn) = (gap, 0.0f64);
            for memory in self.spans.chunks_exact(stride(N)) {
                let [t0, k0, t1, k1] = own_step(memory, self.step);
                turn = turn.larger(t0.abs()).larger(t1.abs());
                largest = largest.larger(k0.abs().larger(k1.abs()) * memory[4]);
            }
            largest = largest.larger(turn);
            if !largest.is_finite() {
                return Ended::Failed;
            }
            let by = (LONGEST_STEP / turn).smaller(LONGEST_BEND / largest).smaller(1.0);
            weigh.length += by * change;
            let mut length = 0.0;
            for memory in self.spans.chunks_exact_mut(stride(N)) {
                let step = own_step(memory, self.step);
                let (values, follow) = memory.part_mut(4..).cut_mut(Span::<N>::LEN);
                let mut span = Span::<N>::load(values);
                let before = span.own[0];
                span.advance(&step, change, follow, by);
                span.own[0] = span.own[0].larger(0.5 * before).smaller(2.0 * before);
                length += span.length();
                span.store(values);
            }
            if !watch(&self.sums, by * largest) {
                return Ended::Stopped;
            }
            let met = match law {
                Law::Length(target) => (length - target).abs() <= effort.settled * target,
                _ => true,
            };
            if largest < effort.settled && met {
                return Ended::Settled;
            }
            if length > GROWN * start_length {
                return Ended::Grown;
            }
        }
        Ended::Failed
    }

    /// By how much the tension must change, to first order.
    fn tension_change(&self, weigh: &Weigh, law: Law) -> f64 {
        // The length changes by `change[0]` with the step and by `change[1]` times the tension's change.
        let mut change = [0.0; 2];
        if matches!(law, Law::Plain) {
            return 0.0;
        }
        for memory in self.spans.chunks_exact(stride(N)) {
            let chord = memory[4];
            let row = &memory[4 + Span::<N>::LEN..4 + Span::<N>::LEN + COLUMNS];
            let (one, other) = (own_step(memory, self.step), own_step(memory, self.pulled));
            let (mut plain, mut pulled) = (row[0], row[5]);
            for f in 0..4 {
                plain += row[1 + f] * one[f];
                pulled += row[1 + f] * other[f];
            }
            change[0] += chord * plain;
            change[1] += chord * pulled;
        }
        let length = self.sums[2];
        let found = match law {
            Law::Plain => 0.0,
            Law::Length(target) => {
                // Not more than a tenth at a time.
                let next = target.larger(0.9 * length).smaller(1.1 * length);
                (next - length - change[0]) / change[1]
            }
            Law::Power(power) => {
                let value = weigh.bend * self.sums[0] + weigh.slope * self.sums[1];
                let along =
                    |step: &[f64]| self.gradient.iter().zip(step).fold(0.0, |sum, (g, s)| sum + g * s);
                // With F = power · value / L: the tension plus its change is F plus F's change.
                let (of_value, of_length) = (power / length, -power * value / (length * length));
                let with = |step: &[f64], change: f64| {
                    of_value * (along(step) - weigh.length * change) + of_length * change
                };
                let (plain, pulled) = (with(self.step, change[0]), with(self.pulled, change[1]));
                // The denominator is positive where the whole is positive definite. Under a tension that stands a step
                // always goes down, for the logarithm is concave: a tension that moves hastens it, and only so much.
                (power * value / length - weigh.length + plain) / (1.0 - pulled).larger(LEAST_HOLD)
            }
        };
        if found.is_finite() { found } else { 0.0 }
    }
}

/// What of a step belongs to a span.
fn own_step(places: &[f64], step: &[f64]) -> [f64; 4] {
    core::array::from_fn(|f| {
        let place = places.at(f);
        if place >= 0.0 { step.at(place as usize) } else { 0.0 }
    })
}

/// What the tension is to be.
#[derive(Clone, Copy)]
pub(super) enum Law {
    /// The one that is given.
    Plain,
    /// That under which a power of the length times the integral is stationary: `power · integral / L`.
    Power(f64),
    /// That under which the curve has this length.
    Length(f64),
}

/// Turns a vector of the chord's system into the curve's; `along` is the chord's direction.
pub(super) fn turned<const D: usize>(along: &SVector<f64, D>, [x, y]: [f64; 2]) -> SVector<f64, D> {
    let mut out = SVector::zeros();
    out[0] = along[0] * x - along[1] * y;
    out[1] = along[1] * x + along[0] * y;
    out
}

/// Turns an end's frame to a direction against the chord.
pub(super) fn turn<const D: usize>(end: &mut End<D>, along: &SVector<f64, D>, theta: f64) {
    let tangent = turned(along, [libm::cos(theta), libm::sin(theta)]);
    end.frame[0] = tangent;
    end.frame[1][0] = -tangent[1];
    end.frame[1][1] = tangent[0];
}
