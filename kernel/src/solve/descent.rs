//! Descending in a few unknowns by themselves, everything else held: an element's own, or those around a loose block.

use super::envelope::Envelope;
use super::problem::{BlockList, Coupled, MAX_ELEMENT_BLOCKS, Problem, packed, packed_len};
use super::trust_region::{self, Radius, Vectors};
use super::workspace::Indices;
use crate::total::Total;
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
}

/// Some elements of a problem, and which blocks vary.
pub(super) struct Part<'a, 'w, P: ?Sized, I> {
    pub(super) problem: &'a P,
    /// How many unknowns each block has.
    pub(super) dofs: &'a Indices<'w>,
    pub(super) elements: I,
    pub(super) varied: Varied,
}

impl<P: Problem + ?Sized, I: Iterator<Item = usize> + Clone> Part<'_, '_, P, I> {
    pub(super) fn sums(&self, state: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for element in self.elements.clone() {
            let [own, second] = self.problem.sums(element, state);
            sums[0] += own;
            sums[1] += second;
        }
        sums
    }

    /// Adds up the elements' derivatives with these weights of the sums, and returns the sums; `slots` is room for one
    /// element's.
    pub(super) fn linearise(
        &self,
        state: &[f64],
        first: [f64; 2],
        slots: &mut [f64],
        [gradient, second, matrix]: Derivatives<'_>,
    ) -> [f64; 2] {
        let Self { problem, dofs, varied, .. } = self;
        let coupled = problem.is_coupled();
        let mut sums = [0.0; 2];
        for element in self.elements.clone() {
            let mut list = BlockList::new();
            problem.element_blocks(element, &mut list);
            let size: usize = list.iter().map(|&block| dofs.get(block)).sum();
            let (all_gradient, rest) = slots.cut_mut(size);
            let (all_second, rest) = rest.cut_mut(if coupled { size } else { 0 });
            let all_matrix = rest.part_mut(..packed_len(size));
            all_gradient.fill(0.0);
            all_second.fill(0.0);
            all_matrix.fill(0.0);
            let [own, other] =
                problem.linearise_sums(element, state, first, all_gradient, all_second, all_matrix);
            sums[0] += own;
            sums[1] += other;
            // The element's unknowns one after the other, each with its place among those that vary, if it does.
            let places = || {
                list.iter().flat_map(|&block| {
                    let found = varied.blocks.iter().find(|varied| varied.0 == block);
                    (0..dofs.get(block)).map(move |k| found.map(|(_, unknowns)| unknowns.start + k))
                })
            };
            for (i, row) in places().enumerate() {
                let Some(row) = row else { continue };
                gradient.add(row, all_gradient.at(i));
                if coupled {
                    second.add(row, all_second.at(i));
                }
                for (j, column) in places().enumerate().take(i + 1) {
                    if let Some(column) = column {
                        let place = packed(row.max(column), row.min(column));
                        matrix.add(place, all_matrix.at(packed(i, j)));
                    }
                }
            }
        }
        sums
    }
}

/// How a part descends by itself.
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
        let (matrix, rest) = memory.cut_mut(packed_len(count));
        let (factor, rest) = rest.cut_mut(packed_len(count));
        let (gradient, rest) = rest.cut_mut(count);
        let (step, rest) = rest.cut_mut(count);
        let (scratch, rest) = rest.cut_mut(count);
        let (sizes, rest) = rest.cut_mut(count);
        let (direction, rest) = rest.cut_mut(count);
        let second = rest.part_mut(..if coupled { count } else { 0 });

        let mut radius = Radius(FIRST_RADIUS);
        let (mut shift, mut moved, mut linearisations, mut value) = (0.0, true, 0, f64::INFINITY);
        for _ in 0..steps {
            if moved {
                for (block, unknowns) in &varied.blocks {
                    problem.natural_sizes(*block, trial, sizes.part_mut(unknowns.clone()));
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
                    let (entries, size) = (matrix.part_mut(packed(row, 0)..=packed(row, row)), sizes.at(row));
                    for (column, (entry, other_size)) in entries.iter_mut().zip(sizes.iter()).enumerate() {
                        if coupled {
                            // The coupling's part of rank two, small enough to be added as it is.
                            let of = |at: usize| {
                                [(gradient.at(at) - first[1] * second.at(at)) / first[0], second.at(at)]
                            };
                            let (a, b) = (of(row), of(column));
                            *entry += a[0] * (c[0][0] * b[0] + c[0][1] * b[1])
                                + a[1] * (c[1][0] * b[0] + c[1][1] * b[1]);
                        }
                        *entry *= size * other_size;
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
                let (from, to) = (trial.part(range.clone()), spare.part_mut(range));
                problem.retract(*block, from, step.part(unknowns.clone()), to);
            }
            let tried_sums = sums_of(spare);
            let tried = self.objective(tried_sums).value;
            let ratio = tried.is_finite().then(|| (value - tried) / found.predicted);
            moved = radius.judge(ratio, found.length);
            for &(block, _) in &varied.blocks {
                let range = problem.state_range(block);
                if moved {
                    trial.part_mut(range.clone()).copy(spare.part(range));
                } else {
                    spare.part_mut(range.clone()).copy(trial.part(range));
                }
            }
            if moved {
                sums = tried_sums;
            }
        }
        (sums, linearisations)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One element with two unknowns of its own; the objective is the product of two sums, and so many halves of the squares
    /// of both.
    struct Product {
        squares: f64,
    }

    impl Problem for Product {
        fn blocks(&self) -> usize {
            1
        }
        fn dofs(&self, _: usize) -> usize {
            2
        }
        fn state_range(&self, _: usize) -> Range<usize> {
            0..2
        }
        fn state_len(&self) -> usize {
            2
        }
        fn elements(&self) -> usize {
            1
        }
        fn element_blocks(&self, _: usize, blocks: &mut BlockList) {
            let _ = blocks.push(0);
        }
        fn max_element_dofs(&self) -> usize {
            2
        }
        fn cost(&self, _: usize, state: &[f64]) -> f64 {
            self.couple(self.sums(0, state)).value
        }
        fn linearise(&self, _: usize, _: &[f64], _: &mut [f64], _: &mut [f64]) -> f64 {
            f64::NAN
        }
        fn is_coupled(&self) -> bool {
            true
        }
        fn couple(&self, [one, other]: [f64; 2]) -> Coupled {
            let squares = self.squares;
            Coupled {
                value: one * other + 0.5 * squares * (one * one + other * other),
                first: [other + squares * one, one + squares * other],
                second: [[squares, 1.0], [1.0, squares]],
            }
        }
        fn sums(&self, _: usize, state: &[f64]) -> [f64; 2] {
            let (x, y) = (state[0], state[1]);
            [2.0 + (x - 1.0) * (x - 1.0) + y * y, 2.0 + x * x + (y - 1.0) * (y - 1.0)]
        }
        fn linearise_own(
            &self,
            _: usize,
            state: &[f64],
            first: [f64; 2],
            gradient: &mut [f64],
            second: &mut [f64],
            matrix: &mut [f64],
        ) -> Option<[f64; 2]> {
            let (x, y) = (state[0], state[1]);
            second.copy_from_slice(&[2.0 * x, 2.0 * (y - 1.0)]);
            let one = [2.0 * (x - 1.0), 2.0 * y];
            for k in 0..2 {
                gradient[k] = first[0] * one[k] + first[1] * second[k];
                matrix[packed(k, k)] = 2.0 * (first[0] + first[1]);
            }
            Some(self.sums(0, state))
        }
        fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
            (to[0], to[1]) = (from[0] + step[0], from[1] + step[1]);
        }
        fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
            sizes.fill(1.0);
        }
        fn natural_cost(&self) -> f64 {
            1.0
        }
    }

    /// By symmetry the minimum is at a half each. With the whole Hessian an error is squared in every step, and more: without
    /// the part through the sums, or with another sign, it shrinks by a factor.
    #[test]
    fn what_sums_do_to_each_other_belongs_to_the_hessian() {
        let mut varied = Varied::new();
        varied.push(0, 2);
        for squares in [0.0, 1.0, 3.0] {
            let product = Product { squares };
            let (mut trial, mut spare, mut memory) = ([0.7, 0.4], [0.7, 0.4], [f64::NAN; 18]);
            let descent =
                Descent { problem: &product, varied: &varied, others: [0.0; 2], steps: 4, enough: 0.0 };
            let sums = product.sums(0, &trial);
            let (found, steps) = descent.run(
                [&mut trial, &mut spare],
                &mut memory,
                sums,
                |state| product.sums(0, state),
                |state, first, [gradient, second, matrix]| {
                    let own = product.linearise_own(0, state, first, gradient, second, matrix);
                    own.unwrap_or([f64::NAN; 2])
                },
            );
            assert!(steps <= 4 && found == product.sums(0, &trial), "{squares} {steps} {found:?}");
            assert!(trial.iter().all(|x| (x - 0.5).abs() < 1e-10), "{squares} {trial:?}");
        }
    }
}
