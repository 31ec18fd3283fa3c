//! Keeping clear of obstacles: which contacts a curve needs.
//!
//! The curve is solved without contacts. While an obstacle's end, or a place on its segment, is too near to it or on
//! the wrong side, the worst such place becomes a contact, a node of the curve that touches it, and the curve is solved
//! again. A contact that pulls, where the functional would sink if the curve moved away from the obstacle, is given up
//! and stays an ordinary node. The sets never repeat in practice; their number is bounded all the same.

use super::end::{End, rows_between};
use super::fairness::{Density, Shape};
use super::model::{Contact, Model};
use super::passes::{Passes, weights_of_sums};
use super::start::{cut, refine};
use crate::solve::{BlockList, Outcome, Problem, Status, WorkspaceTooSmall};
use crate::total::Total;
use nalgebra::SVector;

mod worst;

use worst::{Foot, worst};

#[cfg(test)]
mod tests;

/// The least part of an element that is cut off.
const LEAST_PIECE: f64 = 0.05;

/// How often an obstacle may get a contact: as many elements may be added.
pub(super) const fn most_contacts(obstacles: usize) -> usize {
    4 * obstacles
}

/// A problem with so many more nodes and elements, for its memory alone.
pub(super) struct Extended<'m, 'a, const D: usize> {
    pub(super) model: &'m Model<'a, D>,
    pub(super) more: usize,
}

impl<const D: usize> Extended<'_, '_, D> {
    /// The most dofs of a node that is added (a point, its tangent and curvature), and of its element (speeds and
    /// stretches).
    const ADDED: usize = 2 * D;

    /// The most dofs of any block.
    fn widest(&self) -> usize
    where
        Shape<D>: Density<D>,
    {
        let dofs = (0..self.model.blocks()).map(|block| self.model.dofs(block));
        dofs.fold(Self::ADDED, usize::max)
    }
}

impl<const D: usize> Problem for Extended<'_, '_, D>
where
    Shape<D>: Density<D>,
{
    fn blocks(&self) -> usize {
        self.model.blocks() + 2 * self.more
    }

    fn dofs(&self, block: usize) -> usize {
        if block < self.model.blocks() { self.model.dofs(block) } else { Self::ADDED }
    }

    fn state_range(&self, block: usize) -> core::ops::Range<usize> {
        self.model.state_range(block)
    }

    fn state_len(&self) -> usize {
        self.model.state_len() + self.more * Model::<D>::state_a_piece()
    }

    fn elements(&self) -> usize {
        self.model.elements() + self.more
    }

    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        self.model.element_blocks(element.min(self.model.elements() - 1), blocks);
    }

    fn max_element_dofs(&self) -> usize {
        3 * self.widest()
    }

    fn most_loose_dofs(&self) -> usize {
        if self.model.most_loose_dofs() > 0 { 5 * self.widest() } else { 0 }
    }

    fn envelope_bound(&self) -> usize {
        let unknowns: usize = (0..self.blocks()).map(|block| self.dofs(block)).sum();
        // As in a chain without obstacles: over one element and one node at most, and in a ring back to the first node.
        let reach = if self.model.curve.closed { 4 } else { 3 } * self.widest();
        unknowns * reach.min(unknowns)
    }

    fn is_coupled(&self) -> bool {
        self.model.is_coupled()
    }

    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        self.model.cost(element, state)
    }

    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        self.model.linearise(element, state, gradient, matrix)
    }

    fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        self.model.retract(block, from, step, to);
    }

    fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
        self.model.natural_sizes(block, state, sizes);
    }

    fn natural_cost(&self) -> f64 {
        self.model.natural_cost()
    }
}

/// A curve with contacts on its way: marks of its nodes, contacts, state; `count` nodes and `used` contacts count.
pub(super) struct Touching<'w> {
    pub(super) marks: &'w mut [f64],
    /// Scratch of the marks' length.
    pub(super) old_marks: &'w mut [f64],
    pub(super) contacts: &'w mut [f64],
    pub(super) state: &'w mut [f64],
    /// Scratch of the state's length.
    pub(super) spare: &'w mut [f64],
    pub(super) nodes: usize,
    pub(super) used: usize,
    /// Whether elements were cut since the last solution.
    pub(super) divided: bool,
}

impl Touching<'_> {
    /// Cuts every element into equal parts.
    pub(super) fn divide<const D: usize>(&mut self, of: &Model<'_, D>, parts: usize)
    where
        Shape<D>: Density<D>,
    {
        self.divided = true;
        let Self { marks, old_marks, contacts, state, spare, nodes, .. } = self;
        let count = *nodes;
        let old_marks = old_marks.part_mut(..count);
        old_marks.copy(marks.part(..count));
        let old = of.touching(old_marks, contacts);
        *nodes = old.element_count() * parts + usize::from(!of.curve.closed);
        marks.part_mut(..*nodes).fill(0.0);
        for (mark, old) in marks.iter_mut().step_by(parts.max(1)).zip(&*old_marks) {
            *mark = *old;
        }
        let len = old.state_len();
        spare.part_mut(..len).copy(state.part(..len));
        let new = of.touching(marks.part(..*nodes), contacts);
        refine(&old, spare, |_| parts, &new, state.part_mut(..new.state_len()));
    }
}

/// By how much the functional sinks when the curve at a node moves by a unit to the left.
fn pull<const D: usize>(model: &Model<'_, D>, node: usize, first: [f64; 2], state: &[f64]) -> f64
where
    Shape<D>: Density<D>,
{
    let count = model.element_count();
    let mut normal = SVector::<f64, D>::zeros();
    let mut slope = SVector::<f64, D>::zeros();
    for (element, end) in [(node.checked_sub(1).unwrap_or(count - 1), 1), (node, 0)] {
        if element < count && model.node(element, end) == node {
            normal = model.end(element, end, state).frame[D - 1];
            let by_point = model.slope_by_chord(element, first, state);
            slope += if end == 1 { by_point } else { -by_point };
        }
    }
    -slope.dot(&normal)
}

/// Solves with as many contacts as the obstacles need, from a solution without.
pub(super) fn keep_clear<const D: usize>(
    passes: &mut Passes<'_>,
    of: &Model<'_, D>,
    relative_decrease: f64,
    first: Outcome,
    touching: &mut Touching<'_>,
    work: &mut [f64],
) -> Result<Outcome, WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    let mut outcome = first;
    let rounds = 2 * most_contacts(of.curve.obstacles.len()) + 8;
    for _ in 0..rounds {
        // Give up what pulls; then take up what is worst; what was divided is solved in any case.
        let mut changed = touching.divided;
        touching.divided = false;
        let nodes = touching.nodes;
        let mut strongest: Option<(f64, usize)> = None;
        if !changed {
            let model = of.touching(touching.marks.part(..nodes), touching.contacts);
            let first = weights_of_sums(&model, touching.state);
            for node in 0..nodes {
                let Some(code) = model.contact_code(node) else { continue };
                // Away from an obstacle on the left is to the right.
                let Some(obstacle) = model.curve.obstacles.get(code / 3) else { continue };
                let sinks = pull(&model, node, first, touching.state) * -obstacle.side.sign();
                if sinks > 0.0 && strongest.is_none_or(|(most, _)| sinks > most) {
                    strongest = Some((sinks, node));
                }
            }
        }
        if let Some((_, node)) = strongest {
            touching.marks.put(node, 0.0);
            changed = true;
        }
        if !changed {
            let found = {
                let model = of.touching(touching.marks.part(..nodes), touching.contacts);
                worst(&model, touching.state)
            };
            let Some((_, code, foot, point)) = found else { return Ok(outcome) };
            if touching.used == touching.contacts.len() || nodes == touching.marks.len() {
                return Ok(Outcome { status: Status::Stalled, ..outcome });
            }
            touching.contacts.put(touching.used, code as f64);
            touching.used += 1;
            insert(of, touching, &foot, &point);
        }
        let Touching { marks, contacts, state, nodes, .. } = &mut *touching;
        let mut model = of.touching(marks.part(..*nodes), contacts);
        let state = state.part_mut(..model.state_len());
        outcome = passes.finish(&mut model, relative_decrease, state, work)?;
        if outcome.status != Status::Converged {
            return Ok(outcome);
        }
    }
    Ok(Outcome { status: Status::Stalled, ..outcome })
}

/// Cuts an element at a foot and puts the newest contact there.
fn insert<const D: usize>(
    of: &Model<'_, D>,
    touching: &mut Touching<'_>,
    foot: &Foot<D>,
    point: &SVector<f64, D>,
) where
    Shape<D>: Density<D>,
{
    let Touching { marks, old_marks, contacts, state, spare, nodes, used, .. } = touching;
    let (count, place) = (*nodes, foot.element + 1);
    let old_marks = old_marks.part_mut(..count);
    let marks = marks.part_mut(..count + 1);
    old_marks.copy(marks.part(..count));
    marks.part_mut(place + 1..).copy(old_marks.part(place..));
    marks.put(place, -(*used as f64));
    *nodes = count + 1;
    let old = of.touching(old_marks, contacts);
    let new = of.touching(marks, contacts);
    let len = old.state_len();
    spare.part_mut(..len).copy(state.part(..len));
    // What a side shares with its node nobody writes, but a step reads it: this memory may never have been written.
    state.part_mut(..new.state_len()).fill(0.0);

    // Not at a node itself: a piece must be left on either side.
    let t = foot.t.clamp(LEAST_PIECE, 1.0 - LEAST_PIECE);
    let [before, after] = [0, 1].map(|end: usize| old.end(foot.element, end, spare));
    let mut middle = cut(&rows_between(&[before, after]), t, 1.0, &before);
    match new.contact(place) {
        Some(Contact::Around { point: centre, left }) => middle.point = centre - middle.frame[D - 1] * left,
        Some(Contact::Along { direction }) => {
            let forward = if middle.frame[0].dot(&direction) < 0.0 { -direction } else { direction };
            middle.frame[0] = forward;
            middle.frame[D - 1][0] = -forward[1];
            middle.frame[D - 1][1] = forward[0];
            let obstacle = new.curve.obstacles.get(contacts.at(*used - 1) as usize / 3);
            let left = obstacle.map_or(0.0, |o| o.side.sign() * new.place.local_length(o.clearance));
            middle.point = point - middle.frame[D - 1] * left;
        }
        None => {}
    }
    let piece = |end: &End<D>, share: f64| End {
        speed: end.speed * share,
        stretch: end.stretch * share * share,
        ..*end
    };
    for element in 0..old.element_count() {
        if element == foot.element {
            new.set_end(element, 0, &piece(&before, t), state);
            new.set_end(element, 1, &piece(&middle, t), state);
            new.set_end(element + 1, 0, &piece(&middle, 1.0 - t), state);
            new.set_end(element + 1, 1, &piece(&after, 1.0 - t), state);
        } else {
            let target = if element < foot.element { element } else { element + 1 };
            for end in 0..2 {
                new.set_end(target, end, &old.end(element, end, spare), state);
            }
        }
    }
}
