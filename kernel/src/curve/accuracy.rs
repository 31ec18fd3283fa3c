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
