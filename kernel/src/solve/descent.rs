//! Descending in a few unknowns by themselves, everything else held: an element's own, or those around a loose block.

use super::envelope::Envelope;
use super::problem::{BlockList, Coupled, MAX_ELEMENT_BLOCKS, Problem, packed, packed_len};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::Indices;
use core::ops::Range;

/// The first radius of such a trust region, in natural sizes.
const FIRST_RADIUS: f64 = 0.5;

/// Gradient, the second sum's gradient (empty unless the problem is coupled) and packed Hessian.
pub(super) type Derivatives<'a> = [&'a mut [f64]; 3];

/// The blocks that vary, each with its unknowns among theirs.
pub(super) struct Varied {
    blocks: heapless::Vec<(usize, Range<usize>), MAX_ELEMENT_BLOCKS>,
    pub(super) unknowns: usize,
}

impl Varied {
    pub(super) fn new() -> Self {
        Self { blocks: heapless::Vec::new(), unknowns: 0 }
    }

    /// Adds a block with so many unknowns.
    pub(super) fn push(&mut self, block: usize, dofs: usize) {
        if self.blocks.push((block, self.unknowns..self.unknowns + dofs)).is_ok() {
            self.unknowns += dofs;
        }
    }

    /// Adds what an element's derivatives by all unknowns of its blocks are by those that vary.
    pub(super) fn add<P: Problem + ?Sized>(
        &self,
        problem: &P,
        dofs: &Indices<'_>,
        list: &BlockList,
        [all_gradient, all_second, all_matrix]: [&[f64]; 3],
        [gradient, second, matrix]: Derivatives<'_>,
    ) {
        // The element's unknowns one after the other, each with its place among those that vary, if it does.
        let places = || {
            list.iter().flat_map(|&block| {
                let found = self.blocks.iter().find(|varied| varied.0 == block).map(|varied| varied.1.start);
                (0..dofs.get(block)).map(move |k| found.map(|from| from + k))
            })
        };
        for (i, row) in places().enumerate() {
            let Some(row) = row else { continue };
            gradient[row] += all_gradient[i];
            if problem.is_coupled() {
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

/// A part of a problem that descends by itself.
pub(super) struct Descent<'a, P: ?Sized> {
    pub(super) problem: &'a P,
    pub(super) varied: &'a Varied,
    /// The sums over the other elements, if the problem is coupled.
    pub(super) others: [f64; 2],
    /// The most steps, and what is too little for another one.
    pub(super) steps: usize,
    pub(super) enough: f64,
}

impl<P: Problem + ?Sized> Descent<'_, P> {
    /// The objective with the part's sums beside those of the rest; of a problem that is not coupled the part's own cost.
    fn objective(&self, own: [f64; 2]) -> Coupled {
        if self.problem.is_coupled() {
            self.problem.couple([self.others[0] + own[0], self.others[1] + own[1]])
        } else {
            Coupled::plain(own)
        }
    }

    /// Takes steps from `trial`, which has these sums if the problem is coupled; `spare` is the same state, and scratch,
    /// `memory` is room for two packed matrices and six vectors. `sums_of` a state are the part's; `linearise` adds the
    /// derivatives, with such weights of the sums, to zeros and returns the sums. Returns the sums at the end, and how
    /// often it linearised.
    pub(super) fn run(
        &self,
        [trial, spare]: [&mut [f64]; 2],
        memory: &mut [f64],
        mut sums: [f64; 2],
        sums_of: impl Fn(&[f64]) -> [f64; 2],
        mut linearise: impl FnMut(&[f64], [f64; 2], Derivatives<'_>) -> [f64; 2],
    ) -> ([f64; 2], usize) {
        let Self { problem, varied, steps, enough, .. } = *self;
        let coupled = problem.is_coupled();
        let count = varied.unknowns;
        let envelope = Envelope::Full(count);
        let (matrix, rest) = memory.split_at_mut(packed_len(count));
        let (factor, rest) = rest.split_at_mut(packed_len(count));
        let (gradient, rest) = rest.split_at_mut(count);
        let (step, rest) = rest.split_at_mut(count);
        let (scratch, rest) = rest.split_at_mut(count);
        let (sizes, rest) = rest.split_at_mut(count);
        let (direction, rest) = rest.split_at_mut(count);
        let second = &mut rest[..if coupled { count } else { 0 }];

        let mut radius = Radius(FIRST_RADIUS);
        let (mut shift, mut moved, mut linearisations, mut value) = (0.0, true, 0, f64::INFINITY);
        for _ in 0..steps {
            if moved {
                for (block, unknowns) in &varied.blocks {
                    problem.natural_sizes(*block, trial, &mut sizes[unknowns.clone()]);
                }
                let first = self.objective(sums).first;
                gradient.fill(0.0);
                second.fill(0.0);
                matrix.fill(0.0);
                sums = linearise(trial, first, [&mut *gradient, &mut *second, &mut *matrix]);
                linearisations += 1;
                let Coupled { value: found, second: c, .. } = self.objective(sums);
                value = found;
                for row in 0..count {
                    for column in 0..=row {
                        let entry = &mut matrix[packed(row, column)];
                        if coupled {
                            // The coupling's part of rank two, small enough to be added as it is.
                            let of =
                                |at: usize| [(gradient[at] - first[1] * second[at]) / first[0], second[at]];
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
            for (block, unknowns) in &varied.blocks {
                let range = problem.state_range(*block);
                problem.retract(*block, &trial[range.clone()], &step[unknowns.clone()], &mut spare[range]);
            }
            let tried_sums = sums_of(spare);
            let tried = self.objective(tried_sums).value;
            let ratio = tried.is_finite().then(|| (value - tried) / found.predicted);
            moved = radius.judge(ratio, found.length);
            for &(block, _) in &varied.blocks {
                let range = problem.state_range(block);
                if moved {
                    trial[range.clone()].copy_from_slice(&spare[range]);
                } else {
                    spare[range.clone()].copy_from_slice(&trial[range]);
                }
            }
            if moved {
                sums = tried_sums;
            }
        }
        (sums, linearisations)
    }
}
