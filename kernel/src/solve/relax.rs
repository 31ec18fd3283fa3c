//! Relaxing elements one by one in the unknowns that they share with no other.
//!
//! Such unknowns (the parametrisation of a curve's element, the inside of a patch) often lie in narrow curved valleys
//! of their own: one trust region for all would shrink for the sake of any of them. Every element gets its own, of a
//! few dozen unknowns at most, while everything shared is held. What the whole then sees is the functional minimised
//! over them (variable projection), which is far nearer to a quadratic.

use super::envelope::Envelope;
use super::minimise::NO_COST;
use super::problem::{BlockList, Coupled, MAX_ELEMENT_BLOCKS, Problem, packed, packed_len};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::{Indices, Workspace};

/// The first radius of an element's own trust region, in natural sizes.
pub(super) const FIRST_RADIUS: f64 = 0.5;

/// Takes up to `steps` steps in every element of the trial state, one after the other, until a step promises to lower the
/// objective by less than `enough`. `work.spare` is scratch. Returns how often an element was linearised.
pub(super) fn relax<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    steps: usize,
    enough: f64,
) -> usize {
    work.spare.copy_from_slice(work.trial);
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
    work.trial.copy_from_slice(state);
    let mut linearisations = relax(problem, work, steps, enough);
    work.best.copy_from_slice(work.trial);
    for variant in 0..problem.variants() {
        work.trial.copy_from_slice(state);
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

/// The objective with an element's sums beside those of the rest; of a problem that is not coupled the element's own cost.
fn objective<P: Problem + ?Sized>(problem: &P, rest: [f64; 2], own: [f64; 2]) -> Coupled {
    if problem.is_coupled() {
        problem.couple([rest[0] + own[0], rest[1] + own[1]])
    } else {
        Coupled::plain(own)
    }
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
    let coupled = problem.is_coupled();
    let Workspace { starts, trial, spare, slots, local, .. } = work;
    let mut list = BlockList::new();
    problem.element_blocks(element, &mut list);
    // Its own blocks, and how many unknowns they have.
    let mut blocks = heapless::Vec::<(usize, usize), MAX_ELEMENT_BLOCKS>::new();
    let (mut size, mut own) = (0, 0);
    for &block in &list {
        let dofs = problem.dofs(block);
        size += dofs;
        if is_private(starts, block) {
            own += dofs;
            let _ = blocks.push((block, dofs));
        }
    }
    if own == 0 {
        return 0;
    }
    let private = |block: usize| blocks.iter().any(|&(one, _)| one == block);
    let envelope = Envelope::Full(own);
    let (matrix, rest) = local.split_at_mut(packed_len(own));
    let (factor, rest) = rest.split_at_mut(packed_len(own));
    let (gradient, rest) = rest.split_at_mut(own);
    let (step, rest) = rest.split_at_mut(own);
    let (scratch, rest) = rest.split_at_mut(own);
    let (sizes, rest) = rest.split_at_mut(own);
    let (direction, rest) = rest.split_at_mut(own);
    let second_own = &mut rest[..own];
    let (all_gradient, rest) = slots.split_at_mut(size);
    let (all_second, all_matrix) = rest.split_at_mut(if coupled { size } else { 0 });
    let all_matrix = &mut all_matrix[..packed_len(size)];

    let mut radius = Radius(FIRST_RADIUS);
    let mut shift = 0.0;
    let mut moved = true;
    let mut linearisations = 0;
    let mut value = f64::INFINITY;
    let mut sums = if coupled { problem.sums(element, trial) } else { [0.0; 2] };
    let rest = [totals[0] - sums[0], totals[1] - sums[1]];
    for _ in 0..steps {
        if moved {
            let mut at = 0;
            for &(block, dofs) in &blocks {
                problem.natural_sizes(block, trial, &mut sizes[at..at + dofs]);
                at += dofs;
            }
            let first = objective(problem, rest, sums).first;
            let second = if coupled { &mut second_own[..own] } else { &mut [][..] };
            second.fill(0.0);
            if let Some(found) =
                problem.linearise_own(element, trial, first, gradient, second, &mut matrix[..packed_len(own)])
            {
                sums = found;
            } else {
                all_gradient.fill(0.0);
                all_second.fill(0.0);
                all_matrix.fill(0.0);
                sums = problem.linearise_sums(element, trial, first, all_gradient, all_second, all_matrix);
                // The rows and columns of the private unknowns.
                let (mut row, mut i) = (0, 0);
                for &block in &list {
                    for _ in 0..problem.dofs(block) {
                        if private(block) {
                            gradient[row] = all_gradient[i];
                            if coupled {
                                second[row] = all_second[i];
                            }
                            let (mut column, mut j) = (0, 0);
                            for &other in &list {
                                for _ in 0..problem.dofs(other) {
                                    if private(other) {
                                        if j <= i {
                                            matrix[packed(row, column)] = all_matrix[packed(i, j)];
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
            let Coupled { value: found, second: c, .. } = objective(problem, rest, sums);
            value = found;
            for row in 0..own {
                for column in 0..=row {
                    let entry = &mut matrix[packed(row, column)];
                    if coupled {
                        // The coupling's part of rank two, small enough to be added as it is.
                        let of = |at: usize| [(gradient[at] - first[1] * second[at]) / first[0], second[at]];
                        let (a, b) = (of(row), of(column));
                        *entry += a[0] * (c[0][0] * b[0] + c[0][1] * b[1])
                            + a[1] * (c[1][0] * b[0] + c[1][1] * b[1]);
                    }
                    *entry *= sizes[row] * sizes[column];
                }
            }
            for (g, size) in gradient.iter_mut().zip(sizes.iter()) {
                *g *= size;
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
        for &(block, dofs) in &blocks {
            let range = problem.state_range(block);
            problem.retract(block, &trial[range.clone()], &step[at..at + dofs], &mut spare[range]);
            at += dofs;
        }
        let tried_sums = problem.sums(element, spare);
        let tried = objective(problem, rest, tried_sums).value;
        let ratio = tried.is_finite().then(|| (value - tried) / found.predicted);
        let accepted = radius.judge(ratio, found.length);
        for &(block, _) in &blocks {
            let range = problem.state_range(block);
            if accepted {
                trial[range.clone()].copy_from_slice(&spare[range]);
            } else {
                spare[range.clone()].copy_from_slice(&trial[range]);
            }
        }
        if accepted {
            sums = tried_sums;
        }
        moved = accepted;
    }
    if coupled {
        *totals = [rest[0] + sums[0], rest[1] + sums[1]];
    }
    linearisations
}
