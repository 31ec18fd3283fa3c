//! As many elements as a tolerance asks for.
//!
//! A curve's distance from the true minimum is estimated from how far it moves when its spans are divided further. The
//! error of a minimum variation curve falls by a factor of 15 to 250 when all elements are halved, that of a minimum
//! energy curve by 10 (measured against true curves); counted is a factor of [`HALVING`]. So if a span moves by `d`,
//! its error was at most `d · HALVING/(HALVING − 1)` and is at most `d / (HALVING − 1)` afterwards. This is an
//! estimate, not a bound. Only spans that are too far off are divided.
//!
//! Of a planar curve through fixed joints the true curve itself is known (see [`super::natural`]): then spans are
//! divided until the elements along it are as near as they are to be, and their distance is measured.

use super::fairness::{Density, Shape};
use super::model::{Division, Model};
use super::natural::TrueCurve;
use super::passes::{Passes, total};
use super::rows::place;
use super::start::refine;
use crate::order::Order;
use crate::root::sqrt;
use crate::solve::{Outcome, Problem, Status, WorkspaceTooSmall};
use crate::total::Total;
use nalgebra::SVector;

/// By what factor at least the error falls when elements are halved.
const HALVING: f64 = 5.0;
/// Places an element at which two curves are compared.
const SAMPLES: usize = 8;

/// A curve on its way: how many elements each span has, where the joints stand among the nodes, the state.
pub(super) struct Level<'w> {
    pub(super) counts: &'w mut [f64],
    pub(super) marks: &'w mut [f64],
    pub(super) state: &'w mut [f64],
}

impl Level<'_> {
    fn elements(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).sum()
    }

    fn nodes(&self, closed: bool) -> usize {
        self.elements() + usize::from(!closed)
    }

    /// Writes the marks from the counts.
    pub(super) fn mark(&mut self, closed: bool) {
        self.marks.fill(0.0);
        let mut node = 0;
        for (span, &count) in self.counts.iter().enumerate() {
            if let Some(mark) = self.marks.get_mut(node) {
                *mark = (span + 1) as f64;
            }
            node += count as usize;
        }
        if !closed && let Some(mark) = self.marks.get_mut(node) {
            *mark = (self.counts.len() + 1) as f64;
        }
    }

    /// The curve divided like this.
    pub(super) fn model<'m, const D: usize>(&'m self, of: &Model<'m, D>) -> Model<'m, D> {
        let nodes = self.nodes(of.curve.closed);
        Model { division: Division::Marked(self.marks.part(..nodes)), ..*of }
    }

    fn copy_from(&mut self, other: &Level<'_>) {
        self.counts.copy(other.counts);
        self.marks.copy(other.marks);
        self.state.copy(other.state);
    }
}

/// How the division ended.
pub(super) struct Divided {
    pub(super) outcome: Outcome,
    /// The estimated distance from the true minimum, in the local unit.
    pub(super) error: f64,
}

/// What a division is to reach.
pub(super) struct Aim {
    /// In the local unit.
    pub(super) tolerance: f64,
    pub(super) most_per_span: usize,
    pub(super) relative_decrease: f64,
}

/// Divides spans until the estimated error is below the tolerance. `current` holds a solution and receives the result;
/// `next` and `errors`, one number a span, are scratch.
pub(super) fn divide<const D: usize>(
    passes: &mut Passes<'_>,
    of: &Model<'_, D>,
    aim: &Aim,
    first: Outcome,
    [current, next]: [&mut Level<'_>; 2],
    errors: &mut [f64],
    work: &mut [f64],
) -> Result<Divided, WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    let closed = of.curve.closed;
    let mut outcome = first;
    errors.fill(f64::INFINITY);
    loop {
        let mut divided = false;
        for ((count, &old), &error) in next.counts.iter_mut().zip(current.counts.iter()).zip(errors.iter()) {
            *count = old;
            if error > aim.tolerance && 2.0 * old <= aim.most_per_span as f64 {
                *count = 2.0 * old;
                divided = true;
            }
        }
        if !divided {
            let error = errors.iter().fold(0.0f64, |most, &error| most.larger(error));
            if error > aim.tolerance {
                outcome.status = Status::Stalled;
            }
            return Ok(Divided { outcome, error });
        }
        next.mark(closed);
        let nodes = next.nodes(closed);
        let found = {
            let coarse = current.model(of);
            let Level { counts, marks, state } = &mut *next;
            let mut fine = Model { division: Division::Marked(marks.part(..nodes)), ..*of };
            let state = state.part_mut(..fine.state_len());
            let (mut span, mut left) = (0, current.counts.first().map_or(0, |&count| count as usize));
            fine.natural_cost = refine(
                &coarse,
                current.state,
                |_| {
                    while left == 0 {
                        span += 1;
                        left = current.counts.get(span).map_or(1, |&count| count as usize);
                    }
                    left -= 1;
                    (counts.at(span) / current.counts.at(span)) as usize
                },
                &fine,
                state,
            );
            let found = passes.finish(&mut fine, aim.relative_decrease, state, work)?;
            if found.status == Status::Converged {
                compare(&coarse, current.counts, current.state, &fine, counts, state, errors);
            }
            found
        };
        if found.status != Status::Converged {
            current.copy_from(next);
            return Ok(Divided { outcome: found, error: f64::INFINITY });
        }
        // `errors` holds how far each span moved.
        let moved = errors.iter().fold(0.0f64, |most, &moved| most.larger(moved));
        let before = moved * (HALVING / (HALVING - 1.0));
        if before <= aim.tolerance {
            return Ok(Divided { outcome, error: before });
        }
        outcome = found;
        current.copy_from(next);
        for error in errors.iter_mut() {
            *error /= HALVING - 1.0;
        }
        let error = moved / (HALVING - 1.0);
        if error <= aim.tolerance {
            return Ok(Divided { outcome, error });
        }
    }
}

/// Divides spans until elements along the true curve are nearer to it than the tolerance, and as long as they are to be.
#[expect(clippy::too_many_arguments, reason = "a curve, its true form, what it is to become, and memory")]
pub(super) fn divide_true<const D: usize>(
    passes: &mut Passes<'_>,
    of: &Model<'_, D>,
    curve: &TrueCurve<'_>,
    coarse: &Model<'_, D>,
    coarse_state: &[f64],
    aim: &Aim,
    level: &mut Level<'_>,
    errors: &mut [f64],
    work: &mut [f64],
) -> Result<Divided, WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    let closed = of.curve.closed;
    level.counts.fill(1.0);
    loop {
        level.mark(closed);
        let nodes = level.nodes(closed);
        let Level { counts, marks, state } = &mut *level;
        let mut fine = Model { division: Division::Marked(marks.part(..nodes)), ..*of };
        let state = state.part_mut(..fine.state_len());
        fine.natural_cost =
            curve.write(coarse, coarse_state, &fine, counts.iter().map(|&count| count as usize), state);
        fine.guarded = false;
        let mut outcome = passes.look(&fine, state, work)?;
        curve.distances(coarse, coarse_state, &fine, counts, state, errors);
        let most = errors.iter().fold(0.0f64, |most, &error| if error > most { error } else { most });
        // Where a given length is not met, the worst spans are not near enough either.
        let met = passes.length_is_met(|| total(&fine, state)[1]);
        let enough = if met { aim.tolerance } else { aim.tolerance.smaller(most / HALVING) };
        let mut divided = false;
        for (count, &error) in counts.iter_mut().zip(errors.iter()) {
            if !(error <= enough) && 2.0 * *count <= aim.most_per_span as f64 {
                *count *= 2.0;
                divided = true;
            }
        }
        if !divided {
            outcome.status = if met && most <= aim.tolerance { Status::Converged } else { Status::Stalled };
            return Ok(Divided { outcome, error: most });
        }
    }
}

/// How far each span moved from one solution to a finer one.
fn compare<const D: usize>(
    coarse: &Model<'_, D>,
    coarse_counts: &[f64],
    coarse_state: &[f64],
    fine: &Model<'_, D>,
    fine_counts: &[f64],
    fine_state: &[f64],
    errors: &mut [f64],
) where
    Shape<D>: Density<D>,
{
    let (mut coarse_first, mut fine_first) = (0, 0);
    for ((error, &count), &fine_count) in errors.iter_mut().zip(coarse_counts).zip(fine_counts) {
        let mut most = 0.0f64;
        for element in 0..count as usize {
            let rows = coarse.rows(coarse_first + element, coarse_state);
            for sample in 0..SAMPLES {
                let t = (sample as f64 + 0.5) / SAMPLES as f64;
                let [point, ..] = place(&rows, t);
                let place = (element as f64 + t) / count * fine_count;
                let part = libm::floor(place).smaller(fine_count - 1.0);
                let rows = fine.rows(fine_first + part as usize, fine_state);
                most = most.larger(distance(&point, &rows, place - part));
            }
        }
        *error = most;
        coarse_first += count as usize;
        fine_first += fine_count as usize;
    }
}

/// The distance of a point from an element near a parameter, beyond its ends too.
pub(super) fn distance<const D: usize>(
    point: &SVector<f64, D>,
    rows: &[SVector<f64, D>; 6],
    near: f64,
) -> f64 {
    let mut t = near;
    let mut best = f64::INFINITY;
    for _ in 0..4 {
        let [here, first, second] = place(rows, t);
        let off = here - point;
        let square = off.dot(&off);
        if !(square < best) {
            break;
        }
        best = square;
        let slope = first.dot(&first) + off.dot(&second);
        let slope = if slope > 0.0 { slope } else { first.dot(&first) };
        t -= off.dot(&first) / slope;
    }
    sqrt(best)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::curve::joint::{Curve, Joint};
    use crate::curve::options::Options;
    use crate::curve::tests::{planar, started};
    use std::vec;
    use std::vec::Vec;

    const POINTS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [4.0, -0.5, 0.0], [6.0, 1.5, 0.0]];

    /// A curve's start with so many elements in each span, for open and closed curves.
    fn with(counts: &[&[f64]], work: impl Fn(&Model<'_, 2>, &[Level<'_>])) {
        let joints = POINTS.map(Joint::at);
        for closed in [false, true] {
            let curve = Curve { closed, ..Curve::open(&joints) };
            let plain = planar(&curve, &Options::DEFAULT);
            let first = started(&plain);
            let mut memory: Vec<[Vec<f64>; 3]> = Vec::new();
            for counts in counts {
                let counts = counts.get(..curve.spans()).unwrap_or(counts);
                let nodes = counts.iter().sum::<f64>() as usize + usize::from(!closed);
                let mut marks = vec![f64::NAN; nodes + 3];
                let mut own = counts.to_vec();
                Level { counts: &mut own, marks: &mut marks, state: &mut [] }.mark(closed);
                let fine = Model { division: Division::Marked(marks.part(..nodes)), ..plain };
                let mut state = vec![f64::NAN; fine.state_len()];
                refine(&plain, &first, |span| counts.at(span) as usize, &fine, &mut state);
                memory.push([own, marks, state]);
            }
            let levels: Vec<Level<'_>> =
                memory.iter_mut().map(|[counts, marks, state]| Level { counts, marks, state }).collect();
            work(&plain, &levels);
        }
    }

    #[test]
    fn marks_say_where_the_joints_stand() {
        with(&[&[1.0, 2.0, 4.0, 3.0]], |model, levels| {
            let closed = model.curve.closed;
            let wanted: &[f64] = if closed {
                &[1.0, 2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]
            } else {
                &[1.0, 2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0]
            };
            assert_eq!(levels[0].marks, wanted);
            assert_eq!(levels[0].elements(), if closed { 10 } else { 7 });
            assert_eq!(levels[0].nodes(closed), if closed { 10 } else { 8 });
            let of = levels[0].model(model);
            assert_eq!(
                (of.element_count(), of.node_count()),
                (levels[0].elements(), levels[0].nodes(closed))
            );
        });
    }

    /// A node between two joints is moved: its span has moved by so much, and no other.
    #[test]
    fn a_span_that_moved_is_seen_and_by_how_much() {
        let coarse: &[f64] = &[1.0, 2.0, 1.0, 2.0];
        for fine in [&[2.0, 4.0, 2.0, 2.0], &[2.0, 4.0, 1.0, 4.0], &[4.0, 2.0, 2.0, 4.0]] {
            with(&[coarse, fine], |model, levels| {
                let [before, after] = levels else { panic!("two levels") };
                let (old, new) = (before.model(model), after.model(model));
                let mut errors = vec![f64::NAN; before.counts.len()];
                compare(&old, before.counts, before.state, &new, after.counts, after.state, &mut errors);
                assert!(errors.iter().all(|&error| error < 1e-14), "{errors:?}");
                let mut node = 0;
                for (moved, &count) in after.counts.iter().enumerate() {
                    for inner in 1..count as usize {
                        let element = node + inner;
                        let mut state = after.state.to_vec();
                        let normal = new.end(element, 0, &state).frame[1];
                        let step = 1e-4;
                        for d in 0..2 {
                            state[Model::<2>::point_place(element) + d] += step * normal[d];
                        }
                        compare(&old, before.counts, before.state, &new, after.counts, &state, &mut errors);
                        for (span, &error) in errors.iter().enumerate() {
                            if span == moved {
                                // Samples stand beside the node.
                                assert!(
                                    (0.85 * step..1.01 * step).contains(&error),
                                    "{span} {inner}: {error}"
                                );
                            } else {
                                assert!(error < 1e-14, "{span} beside {moved}: {error}");
                            }
                        }
                    }
                    node += count as usize;
                }
            });
        }
    }

    #[test]
    fn the_distance_from_an_element_is_that_of_the_nearest_place_beyond_its_ends_too() {
        with(&[&[1.0; 4]], |model, levels| {
            let rows = levels[0].model(model).rows(1, levels[0].state);
            for t in [-0.02, 0.0, 0.3, 0.5, 0.94, 1.0, 1.03] {
                let [here, first, _] = place(&rows, t);
                let tangent = first / sqrt(first.dot(&first));
                let normal = SVector::from([-tangent[1], tangent[0]]);
                for off in [-0.1, 0.0, 1e-5, 0.2] {
                    for near in [t - 0.06, t, t + 0.05] {
                        let found = distance(&(here + normal * off), &rows, near);
                        assert!((found - off.abs()).abs() < 1e-9, "{t} {off} {near}: {found}");
                    }
                }
            }
            // However far off: no farther than where it was first looked for.
            let point = SVector::from([3.0, 40.0]);
            let there = place(&rows, 0.5)[0] - point;
            assert!(distance(&point, &rows, 0.5) <= sqrt(there.dot(&there)));
        });
    }
}
