//! Relaxing elements one by one in the unknowns that they share with no other.
//!
//! Such unknowns (the parametrisation of a curve's element, the inside of a patch) often lie in narrow curved valleys
//! of their own: one trust region for all would shrink for the sake of any of them. Every element gets its own, of a
//! few dozen unknowns at most, while everything shared is held. What the whole then sees is the functional minimised
//! over them (variable projection), which is far nearer to a quadratic.

use super::envelope::Envelope;
use super::minimise::NO_COST;
use super::problem::{BlockList, Problem, packed, packed_len};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::{Indices, Workspace};

/// The first radius of an element's own trust region, in natural sizes.
const FIRST_RADIUS: f64 = 0.5;

/// Takes up to `steps` steps in every element of the trial state, until a step promises to lower the cost by less
/// than `enough`. `work.spare` is scratch. Returns how often an element was linearised.
pub(super) fn relax<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    steps: usize,
    weights: [f64; 2],
    enough: f64,
) -> usize {
    work.spare.copy_from_slice(work.trial);
    (0..problem.elements()).map(|element| relax_element(problem, work, element, steps, weights, enough)).sum()
}

/// Relaxes every element of a state from each of its starts, and keeps the best for each in `work.best`. Returns how
/// often an element was linearised.
pub(super) fn explore<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    steps: usize,
    weights: [f64; 2],
    state: &[f64],
) -> usize {
    work.trial.copy_from_slice(state);
    let mut linearisations = relax(problem, work, steps, weights, 0.0);
    work.best.copy_from_slice(work.trial);
    for variant in 0..problem.variants() {
        work.trial.copy_from_slice(state);
        for element in 0..problem.elements() {
            problem.vary(element, variant, work.trial);
        }
        linearisations += relax(problem, work, steps, weights, 0.0);
        for element in 0..problem.elements() {
            // Elements share none of what was changed: each is chosen by itself.
            let best = weigh(problem.sums(element, work.best), weights);
            let least_gain = BETTER * best + NO_COST * problem.natural_cost();
            if weigh(problem.sums(element, work.trial), weights) < best - least_gain {
                let mut list = BlockList::new();
                problem.element_blocks(element, &mut list);
                for &block in list.iter().filter(|&&block| is_private(&work.starts, block)) {
                    let range = problem.state_range(block);
                    work.best[range.clone()].copy_from_slice(&work.trial[range]);
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
fn is_private(starts: &Indices<'_>, block: usize) -> bool {
    starts.get(block + 1) - starts.get(block) == 1
}

fn relax_element<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    element: usize,
    steps: usize,
    weights: [f64; 2],
    enough: f64,
) -> usize {
    let coupled = problem.is_coupled();
    let Workspace { starts, trial, spare, slots, local_first, local_start, local, .. } = work;
    let mut list = BlockList::new();
    problem.element_blocks(element, &mut list);
    let private = |block: usize| is_private(starts, block);
    let size: usize = list.iter().map(|&block| problem.dofs(block)).sum();
    let own: usize = list.iter().filter(|&&block| private(block)).map(|&block| problem.dofs(block)).sum();
    if own == 0 {
        return 0;
    }
    for row in 0..own {
        local_first.set(row, 0);
        local_start.set(row, packed(row, 0));
    }
    let (first, start) = (local_first.head(own), local_start.head(own));
    let envelope = Envelope { first: &first, start: &start };
    let (matrix, rest) = local.split_at_mut(packed_len(own));
    let (factor, rest) = rest.split_at_mut(packed_len(own));
    let (gradient, rest) = rest.split_at_mut(own);
    let (step, rest) = rest.split_at_mut(own);
    let (scratch, rest) = rest.split_at_mut(own);
    let (sizes, rest) = rest.split_at_mut(own);
    let direction = &mut rest[..own];
    let (all_gradient, rest) = slots.split_at_mut(size);
    let (all_second, all_matrix) = rest.split_at_mut(if coupled { size } else { 0 });
    let all_matrix = &mut all_matrix[..packed_len(size)];

    let mut radius = Radius(FIRST_RADIUS);
    let mut shift = 0.0;
    let mut moved = true;
    let mut linearisations = 0;
    let mut value = f64::INFINITY;
    for _ in 0..steps {
        if moved {
            let mut at = 0;
            for &block in &list {
                if private(block) {
                    let dofs = problem.dofs(block);
                    problem.natural_sizes(block, trial, &mut sizes[at..at + dofs]);
                    at += dofs;
                }
            }
            if let Some(found) = problem.linearise_own(element, trial, weights, gradient, matrix) {
                value = found;
                for row in 0..own {
                    gradient[row] *= sizes[row];
                    for column in 0..=row {
                        matrix[packed(row, column)] *= sizes[row] * sizes[column];
                    }
                }
            } else {
                all_gradient.fill(0.0);
                all_second.fill(0.0);
                all_matrix.fill(0.0);
                let sums =
                    problem.linearise_sums(element, trial, weights, all_gradient, all_second, all_matrix);
                value = weigh(sums, weights);
                // The rows and columns of the private unknowns, scaled.
                let (mut row, mut i) = (0, 0);
                for &block in &list {
                    for _ in 0..problem.dofs(block) {
                        if private(block) {
                            gradient[row] = all_gradient[i] * sizes[row];
                            let (mut column, mut j) = (0, 0);
                            for &other in &list {
                                for _ in 0..problem.dofs(other) {
                                    if private(other) {
                                        if j <= i {
                                            matrix[packed(row, column)] =
                                                all_matrix[packed(i, j)] * sizes[row] * sizes[column];
                                        }
                                        column += 1;
                                    }
                                    j += 1;
                                }
                            }
                            row += 1;
                        }
                        i += 1;
                    }
                }
            }
            linearisations += 1;
            if !value.is_finite() {
                break;
            }
        }
        let mut vectors = Vectors { gradient, step, scratch, direction, factor, coupling: None };
        let Some(found) = trust_region::solve(&envelope, matrix, &mut vectors, radius.0, shift) else {
            break;
        };
        shift = found.shift;
        if found.predicted <= enough {
            break;
        }
        for (s, size) in step.iter_mut().zip(sizes.iter()) {
            *s *= size;
        }
        let mut at = 0;
        for &block in &list {
            if private(block) {
                let (dofs, range) = (problem.dofs(block), problem.state_range(block));
                problem.retract(block, &trial[range.clone()], &step[at..at + dofs], &mut spare[range]);
                at += dofs;
            }
        }
        let tried = weigh(problem.sums(element, spare), weights);
        let ratio = tried.is_finite().then(|| (value - tried) / found.predicted);
        let accepted = radius.judge(ratio, found.length);
        for &block in list.iter().filter(|&&block| private(block)) {
            let range = problem.state_range(block);
            if accepted {
                trial[range.clone()].copy_from_slice(&spare[range]);
            } else {
                spare[range.clone()].copy_from_slice(&trial[range]);
            }
        }
        moved = accepted;
    }
    linearisations
}
