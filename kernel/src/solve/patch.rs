//! Relaxing a loose block together with the elements that touch it.
//!
//! A point that is free to slide along a curve has a valley of its own, long, curved and all but level: one trust region for
//! all would follow it in steps as short as the valley is bent. Held between its neighbours, a loose block and what its
//! elements share with no other block are few unknowns, and follow it by themselves.

use super::envelope::Envelope;
use super::problem::{BlockList, Coupled, MAX_ELEMENT_BLOCKS, Problem, packed, packed_len};
use super::relax::{FIRST_RADIUS, is_private, totals};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::{Indices, Workspace};
use core::ops::Range;

/// The blocks that vary, with the first of their unknowns.
type Varied = heapless::Vec<(usize, usize), MAX_ELEMENT_BLOCKS>;

/// Takes up to `steps` steps in every patch of the trial state, one after the other, until a step promises to lower the objective
/// by less than `enough`. `work.spare` is scratch. Returns how often an element was linearised.
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
    incident: &'p Indices<'w>,
    /// Where the elements stand among the incident ones.
    elements: Range<usize>,
    varied: Varied,
    unknowns: usize,
}

impl<'p, 'w, P: Problem + ?Sized> Patch<'p, 'w, P> {
    fn around(problem: &'p P, starts: &Indices<'w>, incident: &'p Indices<'w>, loose: usize) -> Self {
        let elements = starts.get(loose)..starts.get(loose + 1);
        let mut varied = Varied::new();
        let _ = varied.push((loose, 0));
        let mut unknowns = problem.dofs(loose);
        for at in elements.clone() {
            let mut list = BlockList::new();
            problem.element_blocks(incident.get(at), &mut list);
            for &block in list.iter().filter(|&&block| block != loose && is_private(starts, block)) {
                let _ = varied.push((block, unknowns));
                unknowns += problem.dofs(block);
            }
        }
        Self { problem, incident, elements, varied, unknowns }
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

    /// The first of a block's unknowns, if it varies.
    fn place(&self, block: usize) -> Option<usize> {
        self.varied.iter().find(|varied| varied.0 == block).map(|varied| varied.1)
    }

    /// Adds up gradient, the second sum's gradient and Hessian for these weights of the sums; `slots` is room for one
    /// element's.
    fn linearise(
        &self,
        state: &[f64],
        first: [f64; 2],
        slots: &mut [f64],
        [gradient, second, matrix]: [&mut [f64]; 3],
    ) {
        let problem = self.problem;
        let coupled = problem.is_coupled();
        gradient.fill(0.0);
        second.fill(0.0);
        matrix.fill(0.0);
        for at in self.elements.clone() {
            let element = self.incident.get(at);
            let mut list = BlockList::new();
            problem.element_blocks(element, &mut list);
            let size: usize = list.iter().map(|&block| problem.dofs(block)).sum();
            let (all_gradient, rest) = slots.split_at_mut(size);
            let (all_second, rest) = rest.split_at_mut(if coupled { size } else { 0 });
            let all_matrix = &mut rest[..packed_len(size)];
            all_gradient.fill(0.0);
            all_second.fill(0.0);
            all_matrix.fill(0.0);
            let _ = problem.linearise_sums(element, state, first, all_gradient, all_second, all_matrix);
            // The local unknowns one after the other, each with its place in the patch, if it varies.
            let places = || {
                list.iter().flat_map(|&block| {
                    let from = self.place(block);
                    (0..problem.dofs(block)).map(move |k| from.map(|from| from + k))
                })
            };
            for (i, row) in places().enumerate() {
                let Some(row) = row else { continue };
                gradient[row] += all_gradient[i];
                if coupled {
                    second[row] += all_second[i];
                }
                for (j, column) in places().enumerate().take(i + 1) {
                    if let Some(column) = column {
                        matrix[packed(row.max(column), row.min(column))] += all_matrix[packed(i, j)];
                    }
                }
            }
        }
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
    let coupled = problem.is_coupled();
    let Workspace { starts, incident, trial, spare, slots, local, .. } = work;
    let patch = Patch::around(problem, starts, incident, loose);
    let own = patch.unknowns;
    let envelope = Envelope::Full(own);
    let (matrix, rest) = local.split_at_mut(packed_len(own));
    let (factor, rest) = rest.split_at_mut(packed_len(own));
    let (gradient, rest) = rest.split_at_mut(own);
    let (step, rest) = rest.split_at_mut(own);
    let (scratch, rest) = rest.split_at_mut(own);
    let (sizes, rest) = rest.split_at_mut(own);
    let (direction, rest) = rest.split_at_mut(own);
    let second = &mut rest[..own];

    let mut sums = patch.sums(trial);
    let others = [totals[0] - sums[0], totals[1] - sums[1]];
    let objective = |own: [f64; 2]| {
        if coupled { problem.couple([others[0] + own[0], others[1] + own[1]]) } else { Coupled::plain(own) }
    };
    let mut value = objective(sums).value;
    if !value.is_finite() {
        return 0;
    }
    let mut radius = Radius(FIRST_RADIUS);
    let (mut shift, mut moved, mut linearisations) = (0.0, true, 0);
    for _ in 0..steps {
        if moved {
            for &(block, from) in &patch.varied {
                problem.natural_sizes(block, trial, &mut sizes[from..from + problem.dofs(block)]);
            }
            let Coupled { first, second: c, .. } = objective(sums);
            patch.linearise(trial, first, slots, [&mut *gradient, &mut *second, &mut *matrix]);
            linearisations += patch.elements.len();
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
        for &(block, from) in &patch.varied {
            let (range, unknowns) = (problem.state_range(block), from..from + problem.dofs(block));
            problem.retract(block, &trial[range.clone()], &step[unknowns], &mut spare[range]);
        }
        let tried_sums = patch.sums(spare);
        let tried = objective(tried_sums).value;
        let ratio = tried.is_finite().then(|| (value - tried) / found.predicted);
        moved = radius.judge(ratio, found.length);
        for &(block, _) in &patch.varied {
            let range = problem.state_range(block);
            if moved {
                trial[range.clone()].copy_from_slice(&spare[range]);
            } else {
                spare[range.clone()].copy_from_slice(&trial[range]);
            }
        }
        if moved {
            (sums, value) = (tried_sums, tried);
        }
    }
    *totals = [others[0] + sums[0], others[1] + sums[1]];
    linearisations
}
