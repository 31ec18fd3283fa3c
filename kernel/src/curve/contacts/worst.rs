//! Where a curve is too near to an obstacle.
//!
//! A segment's inner places matter where the curve comes nearest to its line, or reaches farthest across it: there the
//! curve runs along the line. These places are found on the curve, so that they are found however long the segment is and
//! however often the curve comes near it. Where a curve crosses a segment the places about the crossing are tried as well.

use super::super::fairness::{Density, Shape};
use super::super::model::{Model, extent, heading};
use super::super::rows::place;
use crate::order::Order;
use crate::root::sqrt;
use nalgebra::SVector;

/// A violation below this part of the curve's size is none.
const TOUCHES: f64 = 1e-9;

/// Places an element, and on the part of a segment beside the curve, between which a sign may change.
const SAMPLES: usize = 16;

/// Steps to where a sign changes.
const MOST_STEPS: usize = 60;

/// An open curve's end is passed by what lies so nearly beside it: the cosine at the end.
const BESIDE: f64 = 0.1;

/// Where something that is measured along a curve changes its sign: the element, the parameter, and whether it rises there.
/// `measure` has its value and slope from `C, C', C''`. At a node the place is the beginning of the element behind it.
fn sign_changes<const D: usize>(
    model: &Model<'_, D>,
    state: &[f64],
    mut measure: impl FnMut([SVector<f64, D>; 3]) -> [f64; 2],
    mut visit: impl FnMut(usize, f64, bool),
) where
    Shape<D>: Density<D>,
{
    let (mut first, mut before) = (0.0, 0.0);
    for element in 0..model.element_count() {
        let rows = model.rows(element, state);
        for sample in 0..=SAMPLES {
            let t = |sample: usize| sample as f64 / SAMPLES as f64;
            let [here, _] = measure(place(&rows, t(sample)));
            if before * here < 0.0 {
                // Newton's steps within what still has the change; at a node both ends are the same place.
                let (mut low, mut high) = (t(sample.saturating_sub(1)), t(sample));
                let mut at = 0.5 * (low + high);
                for _ in 0..MOST_STEPS {
                    let [value, slope] = measure(place(&rows, at));
                    if (value > 0.0) == (before > 0.0) {
                        low = at
                    } else {
                        high = at
                    }
                    let newton = at - value / slope;
                    let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
                    let step = (next - at).abs();
                    at = next;
                    if step <= f64::EPSILON {
                        break;
                    }
                }
                visit(element, at, here > 0.0);
            }
            if here != 0.0 {
                first = if before == 0.0 { here } else { first };
                before = here;
            }
        }
    }
    if model.curve.closed && before * first < 0.0 {
        visit(0, 0.0, first > 0.0);
    }
}

/// A place of a curve near a point.
#[derive(Clone, Copy)]
pub(super) struct Foot<const D: usize> {
    pub(super) element: usize,
    pub(super) t: f64,
    /// How far the point lies to the left of the curve.
    pub(super) left: f64,
}

impl<const D: usize> Foot<D> {
    /// The foot of a point on a chain of elements: the nearest place that the point passes. Where an open curve's end that
    /// it does not pass is nearer, only a foot within a distance counts.
    pub(super) fn of(
        model: &Model<'_, D>,
        state: &[f64],
        point: &SVector<f64, D>,
        within: f64,
    ) -> Option<Self>
    where
        Shape<D>: Density<D>,
    {
        let start = place(&model.rows(0, state), 0.0)[0];
        let towards = point - start;
        // Squares of distances less that of the curve's beginning: of a point far away the others would not differ.
        let square = |here: &SVector<f64, D>| {
            let off = here - start;
            off.dot(&(off - towards * 2.0))
        };
        let mut best: Option<(f64, usize, f64)> = None;
        let mut consider = |square: f64, element: usize, t: f64| {
            if best.is_none_or(|(least, ..)| square < least) {
                best = Some((square, element, t));
            }
        };
        sign_changes(
            model,
            state,
            |[here, first, second]| {
                let off = here - point;
                [off.dot(&first), first.dot(&first) + off.dot(&second)]
            },
            |element, t, rises| {
                if rises {
                    consider(square(&place(&model.rows(element, state), t)[0]), element, t);
                }
            },
        );
        let mut nearer_end = f64::INFINITY;
        if !model.curve.closed {
            for (element, t) in [(0, 0.0), (model.element_count() - 1, 1.0)] {
                let [here, first, _] = place(&model.rows(element, state), t);
                let off = point - here;
                if off.dot(&first).abs() > BESIDE * extent(&off) * sqrt(first.dot(&first)) {
                    nearer_end = nearer_end.smaller(square(&here));
                } else {
                    consider(square(&here), element, t);
                }
            }
        }
        let (least, element, t) = best?;
        let [here, first, _] = place(&model.rows(element, state), t);
        let off = point - here;
        let distance = extent(&off);
        if nearer_end < least && distance >= within {
            return None;
        }
        let mut tangent = first / sqrt(first.dot(&first));
        // A corner's sides are those of what halves it.
        let count = model.element_count();
        let other = if t == 0.0 {
            element.checked_sub(1).or(model.curve.closed.then_some(count - 1))
        } else {
            Some(element + 1).filter(|next| t == 1.0 && *next < count)
        };
        if let Some(other) = other {
            tangent += model.end(other, usize::from(t == 0.0), state).frame[0];
        }
        let across = tangent[0] * off[1] - tangent[1] * off[0];
        let left = if across >= 0.0 { distance } else { -distance };
        Some(Self { element, t, left })
    }
}

/// How a contact is needed: how much too near, its code, the foot and the place.
pub(super) type Violation<const D: usize> = (f64, usize, Foot<D>, SVector<f64, D>);

/// The line of a segment, by distances along it from its place nearest to the curve's beginning.
struct Line<const D: usize> {
    near: SVector<f64, D>,
    along: SVector<f64, D>,
    across: SVector<f64, D>,
    /// Where the segment begins and ends.
    from: f64,
    to: f64,
}

impl<const D: usize> Line<D> {
    fn of(from: &SVector<f64, D>, to: &SVector<f64, D>, start: &SVector<f64, D>) -> Self {
        let along = heading(&(to - from));
        let mut across = SVector::<f64, D>::zeros();
        across[0] = -along[1];
        across[1] = along[0];
        let offsets = [from - start, to - start];
        // By the end that says best where the line is: the other may be far away.
        let [of_from, of_to] = offsets.map(|offset| offset.amax());
        let [by_from, by_to] = offsets.map(|offset| across.dot(&offset));
        let near = start + across * if of_from <= of_to { by_from } else { by_to };
        Self { near, along, across, from: along.dot(&(from - near)), to: along.dot(&(to - near)) }
    }

    fn at(&self, way: f64) -> SVector<f64, D> {
        self.near + self.along * way
    }
}

/// The worst violation, if there is any.
pub(super) fn worst<const D: usize>(model: &Model<'_, D>, state: &[f64]) -> Option<Violation<D>>
where
    Shape<D>: Density<D>,
{
    let size = model.rough_length(state);
    let least = TOUCHES * size;
    let mut worst: Option<Violation<D>> = None;
    for (index, obstacle) in model.curve.obstacles.iter().enumerate() {
        let [from, to] = [&obstacle.from, &obstacle.to].map(|point| model.place.local_point(point));
        let clearance = model.place.local_length(obstacle.clearance);
        let sign = obstacle.side.sign();
        let mut note = |which: usize, point: SVector<f64, D>| {
            if let Some(foot) = Foot::of(model, state, &point, clearance) {
                let lack = clearance - sign * foot.left;
                if lack > worst.as_ref().map_or(least, |(most, ..)| *most) {
                    worst = Some((lack, 3 * index + which, foot, point));
                }
            }
        };
        for (which, end) in [(0, from), (1, to)] {
            if from != to || which == 0 {
                note(which, end);
            }
        }
        if from == to {
            continue;
        }
        let start = place(&model.rows(0, state), 0.0)[0];
        let line = Line::of(&from, &to, &start);
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        let mut last: Option<f64> = None;
        sign_changes(
            model,
            state,
            |[here, first, second]| {
                let way = line.along.dot(&(here - line.near));
                reach = [reach[0].smaller(way), reach[1].larger(way)];
                [first.dot(&line.across), second.dot(&line.across)]
            },
            |element, t, _| {
                let off = place(&model.rows(element, state), t)[0] - line.near;
                let [way, height] = [line.along.dot(&off), line.across.dot(&off)];
                // A straight piece along the line need be looked at once only.
                let again = last.is_some_and(|last| (height - last).abs() <= least);
                if way > line.from && way < line.to && !again {
                    last = Some(height);
                    note(2, line.at(way));
                }
            },
        );
        // Places beyond may have their feet here too.
        let [low, high] = [line.from.larger(reach[0] - size), line.to.smaller(reach[1] + size)];
        let step = (high - low) / SAMPLES as f64;
        if step > 0.0 {
            for sample in 1..SAMPLES {
                note(2, line.at(low + step * sample as f64));
            }
        }
    }
    worst
}
