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
