//! Relaxing elements one by one in the unknowns that they share with no other.
//!
//! Such unknowns (the parametrisation of a curve's element, the inside of a patch) often lie in narrow curved valleys
//! of their own: one trust region for all would shrink for the sake of any of them. Every element gets its own, of a
//! few dozen unknowns at most, while everything shared is held. What the whole then sees is the functional minimised
//! over them (variable projection), which is far nearer to a quadratic.

use super::descent::{Derivatives, Descent, Part, Varied};
use super::minimise::NO_COST;
use super::problem::{BlockList, Problem};
use super::workspace::{Indices, Workspace};
use crate::total::Total;

/// Takes up to `steps` steps in every element of the trial state, one after the other, until a step promises to lower the
/// objective by less than `enough`. `work.spare` is scratch. Returns how often an element was linearised.
pub(super) fn relax<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    steps: usize,
    enough: f64,
) -> usize {
    work.spare.copy(work.trial);
    let mut totals = totals(problem, work.trial);
    let mut linearisations = 0;
    for element in 0..problem.elements() {
        linearisations += relax_element(problem, work, element, steps, &mut totals, enough);
    }
    linearisations
}

/// The sums over all elements, of a coupled problem: an element by itself is judged by the objective as a whole.
pub(super) fn totals<P: Problem + ?Sized>(problem: &P, state: &[f64]) -> [f64; 2] {
    let mut totals = [0.0; 2];
    if problem.is_coupled() {
        for element in 0..problem.elements() {
            let [own, second] = problem.sums(element, state);
            totals[0] += own;
            totals[1] += second;
        }
    }
    totals
}

/// Relaxes every element of a state, with this objective, from each of its starts, and keeps the best for each in
/// `work.best`. Returns how often an element was linearised.
pub(super) fn explore<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    steps: usize,
    value: f64,
    state: &[f64],
) -> usize {
    // What is not enough to be preferred need not be found to more digits.
    let enough = 0.1 * BETTER * value.abs() / problem.elements().max(1) as f64;
    work.trial.copy(state);
    let mut linearisations = relax(problem, work, steps, enough);
    work.best.copy(work.trial);
    for variant in 0..problem.variants() {
        work.trial.copy(state);
        for element in 0..problem.elements() {
            problem.vary(element, variant, work.trial);
        }
        linearisations += relax(problem, work, steps, enough);
        let weights = problem.couple(totals(problem, work.best)).first;
        for element in 0..problem.elements() {
            // Elements share none of what was changed: each is chosen by itself.
            let best = weigh(problem.sums(element, work.best), weights);
            let least_gain = BETTER * best.abs() + NO_COST * problem.natural_cost();
            if weigh(problem.sums(element, work.trial), weights) < best - least_gain {
                let mut list = BlockList::new();
                problem.element_blocks(element, &mut list);
                for &block in list.iter().filter(|&&block| is_private(&work.starts, block)) {
                    let range = problem.state_range(block);
                    work.best.part_mut(range.clone()).copy(work.trial.part(range));
                }
            }
        }
    }
    linearisations
}

/// By how much, relatively, another start must be better to be preferred: rounding must not choose.
pub(super) const BETTER: f64 = 1e-9;

/// An element's share of the objective, to first order in its sums.
fn weigh(sums: [f64; 2], weights: [f64; 2]) -> f64 {
    if weights[1] == 0.0 { sums[0] * weights[0] } else { sums[0] * weights[0] + sums[1] * weights[1] }
}

/// Whether a block belongs to one element alone.
pub(super) fn is_private(starts: &Indices<'_>, block: usize) -> bool {
    starts.get(block + 1) - starts.get(block) == 1
}

fn relax_element<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    element: usize,
    steps: usize,
    totals: &mut [f64; 2],
    enough: f64,
) -> usize {
    let Workspace { dofs, starts, trial, spare, slots, local, .. } = work;
    let mut list = BlockList::new();
    problem.element_blocks(element, &mut list);
    let mut varied = Varied::new();
    for &block in list.iter().filter(|&&block| is_private(starts, block)) {
        varied.push(block, dofs.get(block));
    }
    if varied.unknowns == 0 {
        return 0;
    }
    let part = Part { problem, dofs, elements: core::iter::once(element), varied };
    let sums = if problem.is_coupled() { part.sums(trial) } else { [0.0; 2] };
    let others = [totals[0] - sums[0], totals[1] - sums[1]];
    let descent = Descent { problem, varied: &part.varied, others, steps, enough };
    let linearise = |state: &[f64], first: [f64; 2], [gradient, second, matrix]: Derivatives<'_>| {
        let own = problem.linearise_own(element, state, first, gradient, second, matrix);
        own.unwrap_or_else(|| part.linearise(state, first, slots, [gradient, second, matrix]))
    };
    let (sums, linearisations) =
        descent.run([trial, spare], local, sums, |state| part.sums(state), linearise);
    if problem.is_coupled() {
        *totals = [others[0] + sums[0], others[1] + sums[1]];
    }
    linearisations
}

#[cfg(test)]
mod tests {
    use super::weigh;

    #[test]
    fn a_sum_without_weight_counts_nothing_whatever_it_is() {
        assert_eq!(weigh([2.0, 3.0], [5.0, 7.0]), 31.0);
        assert_eq!(weigh([2.0, f64::INFINITY], [5.0, 0.0]), 10.0);
    }
}
