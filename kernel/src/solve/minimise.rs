//! The iteration: linearise, step, try, accept or refuse, until nothing can be gained.

use super::envelope::{Allow, Envelope};
use super::executor::Executor;
use super::ordering::order_blocks;
use super::problem::{BlockList, Coupled, Problem, packed, packed_len};
use super::rank_two::RankTwo;
use super::report::{Control, Observer, Outcome, Record, Status};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::{Indices, Layout, Workspace, WorkspaceTooSmall};
use super::{patch, relax};
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;

/// How to iterate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The largest number of trial steps.
    pub max_iterations: usize,
    /// Converged when a step promises to lower the functional by less than this fraction of it, or when 20 iterations
    /// together lowered it by less than a thousand times that. Rounding is the floor: a smaller tolerance, 0
    /// included, asks for as much as the arithmetic gives.
    pub relative_decrease: f64,
    /// How many steps each element may take in the blocks that it shares with none, after every step of the whole; 0
    /// for none.
    pub relaxation: usize,
    /// Whether a step of the whole that keeps its promise as it is goes without.
    pub spares_relaxation: bool,
    /// How many such steps each element takes before the first step.
    pub first_relaxation: usize,
    /// Whether other minima of the elements' own unknowns are looked for, see [`Problem::variants`].
    pub explores: bool,
    /// The first radius of the trust region, in natural sizes an element.
    pub first_radius: f64,
}

impl Settings {
    /// 200 iterations, to rounding.
    pub const DEFAULT: Self = Self {
        max_iterations: 200,
        relative_decrease: 0.0,
        relaxation: 0,
        spares_relaxation: false,
        first_relaxation: 0,
        explores: true,
        first_radius: 1.0,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// How well costs are known, in units of rounding.
const ROUNDING_SAFETY: f64 = 16.0;

/// The smallest decrease of a cost that means anything: the cost is a sum of squares of residuals that carry
/// rounding errors proportional to their natural size.
fn noise(value: f64, natural: f64) -> f64 {
    let unit = ROUNDING_SAFETY * f64::EPSILON;
    unit * sqrt(value * natural) + unit * unit * natural + f64::EPSILON * value
}

/// Minimises a problem from `state`, which holds the best state found when this returns. Memory: at least
/// [`super::workspace_len`] numbers, in any condition. `records` receives one record an iteration as far as it
/// reaches.
///
/// # Errors
/// [`WorkspaceTooSmall`] before any work.
pub fn minimise<P: Problem + ?Sized>(
    problem: &P,
    settings: &Settings,
    executor: &dyn Executor,
    state: &mut [f64],
    workspace: &mut [f64],
    records: &mut [Record],
    observer: &mut dyn Observer,
) -> Result<Outcome, WorkspaceTooSmall> {
    let width = executor.width().max(1);
    let layout = Layout::of(problem, width);
    let given = workspace.len();
    let mut work = layout.carve(workspace)?;
    let entries = order_blocks(problem, &mut work);
    if entries > layout.envelope {
        return Err(WorkspaceTooSmall { needed: layout.len() + 2 * (entries - layout.envelope), given });
    }
    let coupled = Coupled::plain([f64::INFINITY; 2]);
    let loosens = settings.relaxation > 0 && layout.loosens;
    let relaxation = settings.relaxation;
    let mut run = Run { problem, executor, width, work, relaxation, loosens, linearisations: 0, coupled };
    Ok(run.iterate(settings, state, records, observer))
}

/// Steps that are taken after the tolerance was met while Newton's method converges quadratically: they cost little and
/// bring the gradient down to rounding.
const POLISH: usize = 2;
/// Below this part of what can be told by costs a step is not worth taking.
const POLISH_FLOOR: f64 = 1e-6;
/// Looser tolerances than this want no polish.
const LOOSE: f64 = 1e-9;
/// Converged as well when this many iterations together lowered the functional by less than so many tolerances.
const WINDOW: usize = 20;
const WINDOW_DECREASE: f64 = 1e3;
/// Costs below this part of what is natural for the problem's size count as zero.
const ZERO_COST: f64 = 1e-3;
/// A cost below this part of what is natural is rounding: no step can be judged any more.
pub(super) const NO_COST: f64 = 1e-20;

/// A step that brings this part of what it promised need not be helped.
const KEPT: f64 = 0.9;
/// Before the first step elements are relaxed until one promises less than this part of the tolerance.
const ENOUGH: f64 = 0.1;
/// Before the first step loose blocks are relaxed one after the other, so many times at most, until once all round
/// lowers the objective by less than so many tolerances.
const MOST_SWEEPS: usize = 8;
const SWEPT: f64 = 1e3;
/// How often other starts of the elements' own unknowns may lead to a better minimum.
const MOST_EXPLORATIONS: usize = 3;
/// How many steps every element takes from each of its starts.
const EXPLORATION: usize = 15;

/// The blocks of an element and the number of its local unknowns.
fn local_unknowns<P: Problem + ?Sized>(
    problem: &P,
    dofs: &Indices<'_>,
    element: usize,
) -> (BlockList, usize) {
    let mut list = BlockList::new();
    problem.element_blocks(element, &mut list);
    let local = list.iter().map(|&block| dofs.get(block)).sum();
    (list, local)
}

/// Marks slots as empty: those that an executor leaves out stay so, and their sum is no number.
fn vacate(slots: &mut [f64], slot_len: usize) {
    for slot in slots.chunks_exact_mut(slot_len.max(1)) {
        slot.put(0, f64::NAN);
    }
}

struct Run<'a, P: ?Sized> {
    problem: &'a P,
    executor: &'a dyn Executor,
    /// How many slots there are.
    width: usize,
    work: Workspace<'a>,
    relaxation: usize,
    /// Whether loose blocks are relaxed too.
    loosens: bool,
    linearisations: usize,
    /// The objective at the state last linearised.
    coupled: Coupled,
}

impl<P: Problem + ?Sized> Run<'_, P> {
    fn iterate(
        &mut self,
        settings: &Settings,
        state: &mut [f64],
        records: &mut [Record],
        observer: &mut dyn Observer,
    ) -> Outcome {
        let natural = self.problem.natural_cost();
        let explores = settings.explores && self.relaxation > 0 && self.problem.variants() > 0;
        self.work.trial.copy(state);
        self.coupled = self.cost();
        if settings.first_relaxation > 0 {
            let enough = ENOUGH * settings.relative_decrease * self.coupled.value.abs()
                / self.problem.elements().max(1) as f64;
            self.linearisations +=
                relax::relax(self.problem, &mut self.work, settings.first_relaxation, enough);
            self.coupled = self.cost();
            let mut sweeps = if self.loosens { MOST_SWEEPS } else { 0 };
            while sweeps > 0 {
                sweeps -= 1;
                let before = self.coupled.value;
                self.linearisations +=
                    patch::relax(self.problem, &mut self.work, settings.first_relaxation, enough);
                self.coupled = self.cost();
                if before - self.coupled.value <= SWEPT * settings.relative_decrease * before {
                    sweeps = 0;
                }
            }
            state.copy(self.work.trial);
        }
        let mut value = self.linearise(state);
        let mut outcome = Outcome {
            status: Status::Stalled,
            iterations: 0,
            linearisations: 0,
            value,
            gradient: f64::INFINITY,
            decrement: f64::INFINITY,
        };
        if !value.is_finite() {
            return outcome;
        }
        let root = sqrt(self.problem.elements().max(1) as f64);
        let mut radius = Radius(settings.first_radius * root);
        let least_radius = 1e-9 * root;
        let mut shift = 0.0;
        let tight = settings.relative_decrease <= LOOSE;
        let most_polish = if tight { POLISH } else { 0 };
        let mut polish = most_polish;
        // The objective where other minima were looked for in vain.
        let mut explored = f64::INFINITY;
        let mut explorations = if explores { MOST_EXPLORATIONS } else { 0 };
        let mut past = [f64::INFINITY; WINDOW];
        loop {
            if !value.is_finite() {
                // An executor left an element out.
                outcome.status = Status::Stalled;
                return outcome;
            }
            let gradient = self.work.gradient.iter().fold(0.0f64, |most, g| most.larger(g.abs()));
            let floor = noise(value, natural);
            outcome = Outcome { value, gradient, linearisations: self.linearisations, ..outcome };
            let step = {
                let Workspace {
                    row_first,
                    row_start,
                    matrix,
                    factor,
                    gradient,
                    step,
                    scratch,
                    direction,
                    sum_gradients: [first, second],
                    solved: [one, other],
                    ..
                } = &mut self.work;
                let envelope = Envelope::Rows { first: row_first, start: row_start };
                let allow = if self.problem.is_cautious() { Allow::Definite } else { Allow::OneNegative };
                let coupling = self
                    .problem
                    .is_coupled()
                    .then(|| RankTwo::new([first, second], self.coupled.second, [one, other], allow));
                let mut vectors = Vectors { gradient, step, scratch, direction, factor, coupling };
                trust_region::solve(&envelope, matrix, &mut vectors, radius.0, shift)
            };
            let Some(step) = step else {
                outcome.status = Status::Stalled;
                return outcome;
            };
            if step.shift == 0.0 {
                outcome.decrement = step.predicted;
            } else {
                outcome.decrement = f64::INFINITY;
            }
            // A cost far below what is natural for the size is zero to the user, however it goes on relatively. Only a
            // Newton step tells how far the minimum is: one that ends at the radius says no more than that. Who asks for
            // little is content if one as long as a natural size an element would gain as little, curved as it is.
            let little = settings.relative_decrease * (value + ZERO_COST * natural);
            let stretch = root / step.length;
            let near = step.predicted <= floor
                || if step.shift == 0.0 {
                    step.predicted <= little
                } else {
                    !tight && step.predicted * (stretch * stretch) <= little
                };
            let last = near && (step.predicted <= POLISH_FLOOR * floor || polish == 0 || step.shift > 0.0);
            // A ball that shrank to nothing proves nothing; otherwise there is nothing left to gain.
            let whole = step.shift == 0.0 || radius.0 > 1e3 * least_radius;
            // Other minima of the elements are looked for as soon as a step promises less than they must gain: digits
            // that were found before would be found in vain.
            let settled = step.shift == 0.0 && step.predicted <= relax::BETTER * value;
            let moved = explored - value > relax::BETTER * value;
            if explorations > 0 && moved && (settled || (last && whole)) {
                explored = value;
                if self.hop(state, value) {
                    explorations -= 1;
                    explored = f64::INFINITY;
                    polish = most_polish;
                    radius = Radius(settings.first_radius * root);
                    shift = 0.0;
                    value = self.linearise(state);
                    continue;
                }
            }
            if near {
                if last {
                    outcome.status = if whole { Status::Converged } else { Status::Stalled };
                    outcome.linearisations = self.linearisations;
                    return outcome;
                }
                polish -= 1;
            }
            // The bottom of a valley that falls ever so slightly: nothing that a user could see goes on changing.
            let slot = outcome.iterations % WINDOW;
            if past[slot] - value <= WINDOW_DECREASE * settings.relative_decrease * value {
                outcome.status = Status::Converged;
                return outcome;
            }
            past[slot] = value;
            if outcome.iterations >= settings.max_iterations {
                outcome.status = Status::IterationLimit;
                return outcome;
            }
            shift = step.shift;

            let promise = settings.spares_relaxation.then_some(value - KEPT * step.predicted);
            let tried = self.try_step(state, promise, step.predicted);
            let actual = value - tried.value;
            let slack = if step.predicted <= 1e3 * floor { floor } else { 0.0 };
            let ratio = tried.value.is_finite().then(|| (actual + slack) / (step.predicted + slack));
            let before = radius;
            let accepted = radius.judge(ratio, step.length);
            if near {
                // Below what costs can tell, a ratio says nothing of the radius; a step that is refused is the last one.
                radius = before;
                polish = if accepted { polish } else { 0 };
            }
            outcome.iterations += 1;
            let record = Record {
                value: if accepted { tried.value } else { value },
                predicted: step.predicted,
                actual,
                gradient,
                step: step.length,
                shift: step.shift,
            };
            if let Some(slot) = records.get_mut(outcome.iterations - 1) {
                *slot = record;
            }
            let control = observer.iteration(outcome.iterations, &record);
            if accepted {
                state.copy(self.work.trial);
                self.coupled = tried;
                value = self.linearise(state);
                outcome.value = if value.is_finite() { value } else { tried.value };
            }
            if control == Control::Cancel {
                outcome.status = Status::Cancelled;
                return outcome;
            }
            if accepted && self.problem.runs_away(state) {
                outcome.status = Status::Unbounded;
                return outcome;
            }
            if radius.0 < least_radius {
                outcome.status = if value <= NO_COST * natural { Status::Converged } else { Status::Stalled };
                return outcome;
            }
        }
    }

    /// Looks for better minima of the elements' own unknowns beside the present ones; moves there if that lowers the
    /// cost.
    fn hop(&mut self, state: &mut [f64], value: f64) -> bool {
        self.linearisations += relax::explore(self.problem, &mut self.work, EXPLORATION, value, state);
        let Workspace { trial, best, .. } = &mut self.work;
        trial.copy(best);
        let found = self.cost();
        let better = found.value < value * (1.0 - relax::BETTER);
        if better {
            state.copy(self.work.best);
            self.coupled = found;
        }
        better
    }

    /// Takes the step into the trial state, and relaxes it there unless it keeps a promise as it is; returns the objective.
    fn try_step(&mut self, state: &[f64], promise: Option<f64>, predicted: f64) -> Coupled {
        self.move_by_step(state);
        if self.relaxation == 0 {
            return self.cost();
        }
        if let Some(promise) = promise {
            let tried = self.cost();
            if tried.value <= promise {
                return tried;
            }
        }
        let enough = 1e-3 * predicted / self.problem.elements() as f64;
        self.linearisations += relax::relax(self.problem, &mut self.work, self.relaxation, enough);
        if self.loosens {
            self.linearisations += patch::relax(self.problem, &mut self.work, self.relaxation, enough);
        }
        self.cost()
    }

    /// Moves a state by the scaled step into the trial state.
    fn move_by_step(&mut self, state: &[f64]) {
        let Workspace { dofs, trial, step, sizes, offset, scratch, .. } = &mut self.work;
        for ((out, s), size) in scratch.iter_mut().zip(step.iter()).zip(sizes.iter()) {
            *out = s * size;
        }
        trial.copy(state);
        for block in 0..self.problem.blocks() {
            let dofs = dofs.get(block);
            if dofs > 0 {
                let (range, at) = (self.problem.state_range(block), offset.get(block));
                let step = scratch.part(at..at + dofs);
                self.problem.retract(block, state.part(range.clone()), step, trial.part_mut(range));
            }
        }
    }

    /// The objective at the trial state; infinite outside the domain.
    fn cost(&mut self) -> Coupled {
        let (problem, elements, width) = (self.problem, self.problem.elements(), self.width);
        let Workspace { trial, slots, .. } = &mut self.work;
        let trial = &**trial;
        let mut sums = [0.0; 2];
        let mut at = 0;
        while at < elements {
            let count = width.min(elements - at);
            let slots = slots.part_mut(..2 * count);
            vacate(slots, 2);
            self.executor.run(slots, 2, &|index, slot| {
                if index < count && slot.len() == 2 {
                    slot.copy(&problem.sums(at + index, trial));
                }
            });
            for &[own, second] in slots.as_chunks().0 {
                if !(own.is_finite() && second.is_finite()) {
                    return Coupled::plain([f64::INFINITY; 2]);
                }
                sums[0] += own;
                sums[1] += second;
            }
            at += count;
        }
        problem.couple(sums)
    }

    /// Assembles gradient and Hessian at a state, scaled by natural sizes; returns the cost.
    fn linearise(&mut self, state: &[f64]) -> f64 {
        let (problem, elements, width) = (self.problem, self.problem.elements(), self.width);
        let Workspace {
            row_first,
            row_start,
            matrix,
            gradient,
            sizes,
            dofs,
            offset,
            slots,
            slot_len,
            sum_gradients: [first_gradient, second_gradient],
            ..
        } = &mut self.work;
        let (coupled, first) = (problem.is_coupled(), self.coupled.first);
        let dofs = &*dofs;
        let envelope = Envelope::Rows { first: row_first, start: row_start };
        for block in 0..problem.blocks() {
            let (from, dofs) = (offset.get(block), dofs.get(block));
            if dofs > 0 {
                problem.natural_sizes(block, state, sizes.part_mut(from..from + dofs));
            }
        }
        gradient.fill(0.0);
        matrix.fill(0.0);
        self.linearisations += elements;
        second_gradient.fill(0.0);
        let mut sums = [0.0; 2];
        let mut at = 0;
        while at < elements {
            let count = width.min(elements - at);
            let slots = slots.part_mut(..count * *slot_len);
            vacate(slots, *slot_len);
            self.executor.run(slots, *slot_len, &|index, slot| {
                if index >= count || slot.len() != *slot_len {
                    return;
                }
                let (_, local) = local_unknowns(problem, dofs, at + index);
                slot.fill(0.0);
                let (own, rest) = slot.cut_mut(2);
                let (gradient, rest) = rest.cut_mut(local);
                let (second, rest) = rest.cut_mut(if coupled { local } else { 0 });
                let matrix = rest.part_mut(..packed_len(local));
                let sums = problem.linearise_sums(at + index, state, first, gradient, second, matrix);
                own.copy(&sums);
            });
            for (index, slot) in slots.chunks_exact((*slot_len).max(1)).enumerate() {
                let (list, local) = local_unknowns(problem, dofs, at + index);
                let (own, rest) = slot.cut(2);
                let (local_gradient, rest) = rest.cut(local);
                let (local_second, local_matrix) = rest.cut(if coupled { local } else { 0 });
                sums[0] += own.at(0);
                sums[1] += own.at(1);
                let mut i = 0;
                for &row_block in &list {
                    let row_from = offset.get(row_block);
                    for row in row_from..row_from + dofs.get(row_block) {
                        let size = sizes.at(row);
                        gradient.add(row, local_gradient.at(i) * size);
                        if coupled {
                            second_gradient.add(row, local_second.at(i) * size);
                        }
                        let mut j = 0;
                        'columns: for &column_block in &list {
                            let column_from = offset.get(column_block);
                            for column in column_from..column_from + dofs.get(column_block) {
                                if j > i {
                                    break 'columns;
                                }
                                let entry = local_matrix.at(packed(i, j)) * size * sizes.at(column);
                                envelope.add(matrix, row.max(column), row.min(column), entry);
                                j += 1;
                            }
                        }
                        i += 1;
                    }
                }
            }
            at += count;
        }
        // What the whole leaves in its place stands alone.
        for block in 0..problem.blocks() {
            for row in offset.get(block)..offset.get(block) + problem.held(block) {
                envelope.isolate(matrix, row);
                gradient.put(row, 0.0);
                if coupled {
                    second_gradient.put(row, 0.0);
                }
            }
        }
        for (own, (all, second)) in first_gradient.iter_mut().zip(gradient.iter().zip(second_gradient.iter()))
        {
            *own = (all - first[1] * second) / first[0];
        }
        self.coupled = problem.couple(sums);
        self.coupled.value
    }
}

#[cfg(test)]
mod tests {
    use super::{ROUNDING_SAFETY, noise};
    use crate::root::sqrt;

    /// The square of a residual that is wrong by so many units of its natural size, and that of its own last digit.
    #[test]
    fn what_counts_as_noise_is_what_rounding_of_residuals_does_to_the_cost() {
        let unit = ROUNDING_SAFETY * f64::EPSILON;
        for (value, natural) in [(1.0, 1.0), (1e-6, 4.0), (1e-29, 1.0), (0.0, 9.0), (1e4, 1e-8), (2.0, 0.0)] {
            let wrong = sqrt(value) + unit * sqrt(natural);
            // Written out, so that nothing cancels.
            let risen = unit * sqrt(natural) * (wrong + sqrt(value)) + f64::EPSILON * value;
            let found = noise(value, natural);
            assert!(found <= risen && found >= 0.5 * risen, "{value} {natural}: {found} {risen}");
        }
    }
}
