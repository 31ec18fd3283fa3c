//! The order of the blocks: reverse Cuthill–McKee from a Gibbs pseudo-diameter (Fang 5.4).
//!
//! Two blocks are neighbours where an element touches both. Good starting blocks are the ends of a *pseudo-diameter*:
//! the longest of the shortest paths that repeated breadth-first searches find (Gibbs, Poole and Stockmeyer 1976).

use super::problem::{BlockList, Problem};
use super::workspace::{Indices, Workspace};

/// More than any level: seven arrays of so many indices are more than memory can hold. Less than all ones, which of 64 bits
/// would be a NaN among the doubles that indices are kept in.
const UNSEEN: usize = usize::MAX >> (usize::BITS / 8);

/// Which elements touch a block, as lists one behind another.
struct Graph<'a, 'w, P: ?Sized> {
    problem: &'a P,
    dofs: &'a Indices<'w>,
    starts: &'a Indices<'w>,
    incident: &'a Indices<'w>,
}

impl<P: Problem + ?Sized> Graph<'_, '_, P> {
    /// Calls `visit` with every neighbour of a block that has dofs; a neighbour may come more than once.
    fn neighbours(&self, block: usize, mut visit: impl FnMut(usize)) {
        for at in self.starts.get(block)..self.starts.get(block + 1) {
            let mut list = BlockList::new();
            self.problem.element_blocks(self.incident.get(at), &mut list);
            for &other in &list {
                if other != block && self.dofs.get(other) > 0 {
                    visit(other);
                }
            }
        }
    }
}

fn build_incidence<P: Problem + ?Sized>(problem: &P, work: &mut Workspace<'_>) {
    let blocks = problem.blocks();
    work.starts.fill(0);
    let each = |visit: &mut dyn FnMut(usize, usize)| {
        for element in 0..problem.elements() {
            let mut list = BlockList::new();
            problem.element_blocks(element, &mut list);
            for &block in &list {
                visit(element, block);
            }
        }
    };
    let starts = &mut work.starts;
    each(&mut |_, block| starts.set(block + 1, starts.get(block + 1) + 1));
    for block in 0..blocks {
        starts.set(block + 1, starts.get(block + 1) + starts.get(block));
    }
    // `level` counts how many of a block's elements were entered so far.
    work.level.fill(0);
    let (incident, level) = (&mut work.incident, &mut work.level);
    each(&mut |element, block| {
        incident.set(starts.get(block) + level.get(block), element);
        level.set(block, level.get(block) + 1);
    });
}

/// Numbers the blocks of one connected component by breadth-first search from `root`, neighbours of lower degree
/// first, into `order[from..]`. Returns the end of the component in `order` and the number of levels.
fn search<P: Problem + ?Sized>(
    graph: &Graph<'_, '_, P>,
    degree: &Indices<'_>,
    level: &mut Indices<'_>,
    order: &mut Indices<'_>,
    from: usize,
    root: usize,
) -> (usize, usize) {
    order.set(from, root);
    level.set(root, 0);
    let (mut head, mut tail) = (from, from + 1);
    let mut last = 0;
    while head < tail {
        let block = order.get(head);
        last = level.get(block);
        let first = tail;
        graph.neighbours(block, |other| {
            if level.get(other) == UNSEEN {
                level.set(other, last + 1);
                // Insertion by degree, then by number, so that the order does not depend on how elements are listed.
                let mut at = tail;
                while at > first {
                    let before = order.get(at - 1);
                    if (degree.get(before), before) <= (degree.get(other), other) {
                        break;
                    }
                    order.set(at, before);
                    at -= 1;
                }
                order.set(at, other);
                tail += 1;
            }
        });
        head += 1;
    }
    (tail, last + 1)
}

fn forget(level: &mut Indices<'_>, order: &Indices<'_>, from: usize, to: usize) {
    for at in from..to {
        level.set(order.get(at), UNSEEN);
    }
}

/// Takes the blocks in the order that the problem knows to be good. Returns how many have dofs.
fn take_known<P: Problem + ?Sized>(problem: &P, dofs: &Indices<'_>, order: &mut Indices<'_>) -> usize {
    let mut ordered = 0;
    for place in 0..problem.blocks() {
        let block = problem.block_at(place).unwrap_or(place);
        if dofs.get(block) > 0 {
            order.set(ordered, block);
            ordered += 1;
        }
    }
    ordered
}

/// Orders the blocks that have dofs, component by component, and returns how many there are.
fn reverse_cuthill_mckee<P: Problem + ?Sized>(
    graph: &Graph<'_, '_, P>,
    degree: &mut Indices<'_>,
    level: &mut Indices<'_>,
    order: &mut Indices<'_>,
) -> usize {
    let problem = graph.problem;
    let blocks = problem.blocks();
    level.fill(UNSEEN);
    for block in 0..blocks {
        let mut count = 0;
        graph.neighbours(block, |_| count += 1);
        degree.set(block, count);
    }
    let mut ordered = 0;
    loop {
        let root = (0..blocks)
            .filter(|&block| level.get(block) == UNSEEN && graph.dofs.get(block) > 0)
            .min_by_key(|&block| (degree.get(block), block));
        let Some(mut root) = root else { break };
        let (mut end, mut depth) = search(graph, degree, level, order, ordered, root);
        // Restart from a block of least degree in the last level as long as that makes the structure deeper.
        loop {
            let far = (ordered..end)
                .map(|at| order.get(at))
                .filter(|&block| level.get(block) + 1 == depth)
                .min_by_key(|&block| (degree.get(block), block))
                .unwrap_or(root);
            forget(level, order, ordered, end);
            let (far_end, far_depth) = search(graph, degree, level, order, ordered, far);
            end = far_end;
            if far_depth <= depth {
                break;
            }
            (root, depth) = (far, far_depth);
        }
        let _ = root;
        // Reversed: the envelope is never larger and usually smaller (Liu and Sherman 1976).
        let (mut low, mut high) = (ordered, end);
        while low + 1 < high {
            high -= 1;
            let (a, b) = (order.get(low), order.get(high));
            order.set(low, b);
            order.set(high, a);
            low += 1;
        }
        ordered = end;
    }
    ordered
}

/// Orders the blocks, numbers the unknowns and lays out the rows of the envelope. Returns the number of entries of
/// the envelope.
pub(super) fn order_blocks<P: Problem + ?Sized>(problem: &P, work: &mut Workspace<'_>) -> usize {
    let blocks = problem.blocks();
    build_incidence(problem, work);
    for block in 0..blocks {
        work.dofs.set(block, problem.dofs(block));
    }
    let Workspace { dofs, order, offset, starts, incident, degree, level, row_first, row_start, .. } = work;
    let (dofs, starts, incident) = (&*dofs, &*starts, &*incident);
    let graph = Graph { problem, dofs, starts, incident };
    let mut ordered = if problem.block_at(0).is_some() {
        take_known(problem, dofs, order)
    } else {
        reverse_cuthill_mckee(&graph, degree, level, order)
    };
    // Blocks without dofs come last: they have no rows.
    for block in 0..blocks {
        if dofs.get(block) == 0 {
            order.set(ordered, block);
            ordered += 1;
        }
    }

    let mut row = 0;
    for at in 0..blocks {
        let block = order.get(at);
        offset.set(block, row);
        row += dofs.get(block);
    }
    let mut entries = 0;
    for at in 0..blocks {
        let block = order.get(at);
        let mut first = offset.get(block);
        graph.neighbours(block, |other| first = first.min(offset.get(other)));
        for dof in 0..dofs.get(block) {
            let row = offset.get(block) + dof;
            row_first.set(row, first);
            row_start.set(row, entries);
            entries += row - first + 1;
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::workspace::Layout;
    use super::*;
    use core::ops::Range;
    use std::vec;
    use std::vec::Vec;

    /// Blocks of one unknown each, of which the elements join two; the last `fixed` ones are none.
    struct Joined<'a> {
        blocks: usize,
        fixed: usize,
        pairs: &'a [[usize; 2]],
    }

    impl Problem for Joined<'_> {
        fn blocks(&self) -> usize {
            self.blocks
        }
        fn dofs(&self, block: usize) -> usize {
            usize::from(block < self.blocks - self.fixed)
        }
        fn state_range(&self, block: usize) -> Range<usize> {
            block..block + 1
        }
        fn state_len(&self) -> usize {
            self.blocks
        }
        fn elements(&self) -> usize {
            self.pairs.len()
        }
        fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
            blocks.extend(self.pairs[element]);
        }
        fn max_element_dofs(&self) -> usize {
            2
        }
        fn cost(&self, _: usize, _: &[f64]) -> f64 {
            0.0
        }
        fn linearise(&self, _: usize, _: &[f64], _: &mut [f64], _: &mut [f64]) -> f64 {
            0.0
        }
        fn retract(&self, _: usize, _: &[f64], _: &[f64], _: &mut [f64]) {}
        fn natural_sizes(&self, _: usize, _: &[f64], _: &mut [f64]) {}
        fn natural_cost(&self) -> f64 {
            1.0
        }
    }

    fn order_of(blocks: usize, fixed: usize, pairs: &[[usize; 2]]) -> (Vec<usize>, usize) {
        let problem = Joined { blocks, fixed, pairs };
        let layout = Layout::of(&problem, 1);
        let mut memory = vec![f64::NAN; layout.len()];
        let mut work = layout.carve(&mut memory).expect("enough memory");
        let entries = order_blocks(&problem, &mut work);
        ((0..blocks).map(|at| work.order.get(at)).collect(), entries)
    }

    /// ```text
    /// 3 — 0 — 5 — 1 — 4
    ///         |
    ///         2
    /// ```
    ///
    /// The first search starts at 2, of the least number among those with one neighbour; from 3, the least in its last level,
    /// the structure is deeper, from 4 it is not any more. Of the neighbours of 5 then 2 comes before 0, having less of
    /// its own. Reversed.
    #[test]
    fn a_tree_is_ordered_from_the_end_of_its_longest_path() {
        let pairs = [[3, 0], [0, 5], [5, 1], [1, 4], [2, 5]];
        let (order, entries) = order_of(6, 0, &pairs);
        assert_eq!(order, [3, 0, 2, 5, 1, 4]);
        // 5 reaches back to 0, over 2; every other one but 2 to its neighbour.
        assert_eq!(entries, 1 + 2 + 1 + 3 + 2 + 2);
        // However the elements are listed.
        let backwards = pairs.map(|[a, b]| [b, a]);
        assert_eq!(order_of(6, 0, &backwards).0, order);
        let mut shuffled = pairs;
        shuffled.reverse();
        assert_eq!(order_of(6, 0, &shuffled).0, order);
    }

    #[test]
    fn parts_that_nothing_joins_come_one_after_the_other_and_what_is_fixed_last() {
        // A path 4 — 0 — 2, a pair 1 — 3, and 5, which is fixed, between them.
        let (order, entries) = order_of(6, 1, &[[0, 4], [2, 0], [3, 1], [5, 4], [1, 5]]);
        assert_eq!(order, [1, 3, 2, 0, 4, 5]);
        assert_eq!(entries, 1 + 2 + 1 + 2 + 2);
    }
}
