//! A problem for the solver that has nothing to do with curves.

use minvar::solve::{BlockList, Problem, packed};
use std::ops::Range;

/// `Σ 100 (x_{i+1} − x_i²)² + (1 − x_i)²`: a curved valley to (1, …, 1). One number a block.
#[derive(Clone, Copy, Debug)]
pub struct Rosenbrock {
    /// How many numbers, two or more.
    pub count: usize,
}

impl Problem for Rosenbrock {
    fn blocks(&self) -> usize {
        self.count
    }
    fn dofs(&self, _: usize) -> usize {
        1
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        self.count
    }
    fn elements(&self) -> usize {
        self.count - 1
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend([element, element + 1]);
    }
    fn max_element_dofs(&self) -> usize {
        2
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let (x, y) = (state[element], state[element + 1]);
        100.0 * (y - x * x) * (y - x * x) + (1.0 - x) * (1.0 - x)
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let (x, y) = (state[element], state[element + 1]);
        let r = y - x * x;
        gradient[0] = -400.0 * x * r - 2.0 * (1.0 - x);
        gradient[1] = 200.0 * r;
        matrix[packed(0, 0)] = -400.0 * r + 800.0 * x * x + 2.0;
        matrix[packed(1, 0)] = -400.0 * x;
        matrix[packed(1, 1)] = 200.0;
        self.cost(element, state)
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to[0] = from[0] + step[0];
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.count as f64
    }
}

/// The usual start.
pub fn rosenbrock_start(count: usize) -> Vec<f64> {
    (0..count).map(|i| if i % 2 == 0 { -1.2 } else { 1.0 }).collect()
}
