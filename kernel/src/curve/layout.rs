//! The memory of a curve.

use super::contacts::{Extended, most_contacts};
use super::error::CurveError;
use super::fairness::{Density, Shape};
use super::model::{Goal, Model};
use super::natural;
use super::options::Options;
use crate::solve::{self, Problem};
use crate::total::Total;

/// The memory of a curve, in `f64`s: one function that sizes it and carves it.
pub(super) struct Layout {
    state: usize,
    /// What a tolerance needs: nodes and spans.
    division: [usize; 2],
    /// The true curve's.
    trace: usize,
    pub(super) work: usize,
}

impl Layout {
    pub(super) fn of<const D: usize>(model: &Model<'_, D>, options: &Options) -> Self
    where
        Shape<D>: Density<D>,
    {
        let spans = model.curve.spans();
        // A given length couples all elements.
        let goal = (options.length > 0.0).then_some(Goal { target: 1.0, multiplier: 0.0, penalty: 1.0 });
        let model = &Model { goal, ..*model };
        let natural = natural::memory_len(model.curve.joints.len(), spans, model.curve.closed);
        let contacts = most_contacts(model.curve.obstacles.len());
        let more = contacts * options.elements_per_span as usize;
        let extended = Extended { model, more };
        let (state, work) = if more > 0 {
            (extended.state_len(), solve::workspace_len(&extended, 1))
        } else {
            (model.state_len(), solve::workspace_len(model, 1))
        };
        let divides = options.tolerance > 0.0 || more > 0;
        Self {
            state,
            division: if divides { [model.node_count() + more, spans.max(contacts)] } else { [0; 2] },
            trace: if (options.elements_per_span > 1 || options.tolerance > 0.0) && D == 2 {
                natural::trace_len(model.curve.joints.len(), spans, model.curve.closed)
            } else {
                0
            },
            work: work.max(natural),
        }
    }

    /// State, next state, marks, next marks, counts, next counts, errors, true curve, work.
    fn parts(&self) -> [usize; 9] {
        let [nodes, spans] = self.division;
        let next = if nodes > 0 { self.state } else { 0 };
        [self.state, next, nodes, nodes, spans, spans, spans, self.trace, self.work]
    }

    pub(super) fn len(&self) -> usize {
        self.parts().iter().sum()
    }

    pub(super) fn carve<'w>(&self, memory: &'w mut [f64]) -> Result<[&'w mut [f64]; 9], CurveError> {
        let (needed, given) = (self.len(), memory.len());
        if given < needed {
            return Err(CurveError::WorkspaceTooSmall { needed, given });
        }
        let mut rest = memory;
        Ok(self.parts().map(|len| {
            let (part, tail) = core::mem::take(&mut rest).cut_mut(len);
            rest = tail;
            part
        }))
    }
}
