//! Relaxing a loose block together with the elements that touch it.
//!
//! A point that is free to slide along a curve has a valley of its own, long, curved and all but level: one trust
//! region for all would follow it in steps as short as the valley is bent. Held between its neighbours, a loose block
//! and what its elements share with no other block are few unknowns, and follow it by themselves.

use super::descent::{Derivatives, Descent, Varied};
use super::problem::{BlockList, Problem, packed_len};
use super::relax::{is_private, totals};
use super::workspace::{Indices, Workspace};
use core::ops::Range;

/// Takes up to `steps` steps in every patch of the trial state, one after the other, until a step promises to lower the
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
    for block in (0..problem.blocks()).filter(|&block| problem.is_loose(block)) {
        linearisations += relax_patch(problem, work, block, steps, &mut totals, enough);
    }
    linearisations
}

/// A loose block's elements, and the blocks that vary: the loose one and what those elements share with no other block.
struct Patch<'p, 'w, P: ?Sized> {
    problem: &'p P,
    dofs: &'p Indices<'w>,
    incident: &'p Indices<'w>,
    /// Where the elements stand among the incident ones.
    elements: Range<usize>,
    varied: Varied,
}

impl<'p, 'w, P: Problem + ?Sized> Patch<'p, 'w, P> {
    fn around(problem: &'p P, [dofs, starts, incident]: [&'p Indices<'w>; 3], loose: usize) -> Self {
        let elements = starts.get(loose)..starts.get(loose + 1);
        let mut varied = Varied::new();
        varied.push(loose, dofs.get(loose));
        for at in elements.clone() {
            let mut list = BlockList::new();
            problem.element_blocks(incident.get(at), &mut list);
            for &block in list.iter().filter(|&&block| block != loose && is_private(starts, block)) {
                varied.push(block, dofs.get(block));
            }
        }
        Self { problem, dofs, incident, elements, varied }
    }

    fn sums(&self, state: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for at in self.elements.clone() {
            let [own, second] = self.problem.sums(self.incident.get(at), state);
            sums[0] += own;
            sums[1] += second;
        }
        sums
    }

    /// Adds up the elements' derivatives with these weights of the sums, and returns the sums; `slots` is room for one
    /// element's.
    fn linearise(&self, state: &[f64], first: [f64; 2], slots: &mut [f64], to: Derivatives<'_>) -> [f64; 2] {
        let Self { problem, dofs, .. } = *self;
        let [gradient, second, matrix] = to;
        let mut sums = [0.0; 2];
        for at in self.elements.clone() {
            let element = self.incident.get(at);
            let mut list = BlockList::new();
            problem.element_blocks(element, &mut list);
            let size: usize = list.iter().map(|&block| dofs.get(block)).sum();
            let (all_gradient, rest) = slots.split_at_mut(size);
            let (all_second, rest) = rest.split_at_mut(if problem.is_coupled() { size } else { 0 });
            let all_matrix = &mut rest[..packed_len(size)];
            all_gradient.fill(0.0);
            all_second.fill(0.0);
            all_matrix.fill(0.0);
            let [own, other] =
                problem.linearise_sums(element, state, first, all_gradient, all_second, all_matrix);
            sums[0] += own;
            sums[1] += other;
            let to = [&mut *gradient, &mut *second, &mut *matrix];
            self.varied.add(problem, dofs, &list, [all_gradient, all_second, all_matrix], to);
        }
        sums
    }
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
    let patch = Patch::around(problem, [dofs, starts, incident], loose);
    let sums = patch.sums(trial);
    let others = [totals[0] - sums[0], totals[1] - sums[1]];
    if !(sums[0].is_finite() && sums[1].is_finite()) {
        return 0;
    }
    let descent = Descent { problem, varied: &patch.varied, others, steps, enough };
    let linearise =
        |state: &[f64], first: [f64; 2], to: Derivatives<'_>| patch.linearise(state, first, slots, to);
    let (sums, linearisations) =
        descent.run([trial, spare], local, sums, |state| patch.sums(state), linearise);
    *totals = [others[0] + sums[0], others[1] + sums[1]];
    linearisations * patch.elements.len()
}
