//! Relaxing a loose block together with the elements that touch it.
//!
//! A point that is free to slide along a curve has a valley of its own, long, curved and all but level: one trust
//! region for all would follow it in steps as short as the valley is bent. Held between its neighbours, a loose block
//! and what its elements share with no other block are few unknowns, and follow it by themselves.

use super::descent::{Derivatives, Descent, Part, Varied};
use super::problem::{BlockList, Problem};
use super::relax::{is_private, totals};
use super::workspace::Workspace;
use crate::total::Total;

/// Takes up to `steps` steps in every patch of the trial state, one after the other, until a step promises to lower the
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
    for block in (0..problem.blocks()).filter(|&block| problem.is_loose(block)) {
        linearisations += relax_patch(problem, work, block, steps, &mut totals, enough);
    }
    linearisations
}

fn relax_patch<P: Problem + ?Sized>(
    problem: &P,
    work: &mut Workspace<'_>,
    loose: usize,
    steps: usize,
    totals: &mut [f64; 2],
    enough: f64,
) -> usize {
    let Workspace { dofs, starts, incident, trial, spare, slots, local, .. } = work;
    let (dofs, incident) = (&*dofs, &*incident);
    let elements = (starts.get(loose)..starts.get(loose + 1)).map(|at| incident.get(at));
    // The loose block, and what its elements share with no other.
    let mut varied = Varied::new();
    varied.push(loose, dofs.get(loose));
    for element in elements.clone() {
        let mut list = BlockList::new();
        problem.element_blocks(element, &mut list);
        for &block in list.iter().filter(|&&block| block != loose && is_private(starts, block)) {
            varied.push(block, dofs.get(block));
        }
    }
    let count = elements.len();
    let part = Part { problem, dofs, elements, varied };
    let sums = part.sums(trial);
    if !(sums[0].is_finite() && sums[1].is_finite()) {
        return 0;
    }
    let others = [totals[0] - sums[0], totals[1] - sums[1]];
    let descent = Descent { problem, varied: &part.varied, others, steps, enough };
    let linearise =
        |state: &[f64], first: [f64; 2], to: Derivatives<'_>| part.linearise(state, first, slots, to);
    let (sums, linearisations) =
        descent.run([trial, spare], local, sums, |state| part.sums(state), linearise);
    *totals = [others[0] + sums[0], others[1] + sums[1]];
    linearisations * count
}
