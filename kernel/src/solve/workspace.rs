//! The memory of a solve: one layout function that sizes it and carves it.

use super::problem::{Problem, packed_len};
use crate::total::Total;

/// The workspace was shorter than the solve needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkspaceTooSmall {
    /// The length that is needed.
    pub needed: usize,
    /// The length that was given.
    pub given: usize,
}

/// Where everything stands; all lengths in `f64`s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) unknowns: usize,
    pub(super) blocks: usize,
    pub(super) incidences: usize,
    pub(super) envelope: usize,
    pub(super) state: usize,
    pub(super) slot: usize,
    pub(super) slots: usize,
    pub(super) local: usize,
    pub(super) coupled: usize,
    /// Whether any block is loose.
    pub(super) loosens: bool,
}

impl Layout {
    pub(super) fn of<P: Problem + ?Sized>(problem: &P, width: usize) -> Self {
        let blocks = problem.blocks();
        let mut incidences = 0;
        for element in 0..problem.elements() {
            let mut list = super::BlockList::new();
            problem.element_blocks(element, &mut list);
            incidences += list.len();
        }
        let local = problem.max_element_dofs();
        let loose = problem.most_loose_dofs();
        let unknowns = (0..blocks).map(|block| problem.dofs(block)).sum();
        let coupled = problem.is_coupled();
        Self {
            unknowns,
            blocks,
            incidences,
            envelope: problem.envelope_bound(),
            state: problem.state_len(),
            slot: 2 + (1 + usize::from(coupled)) * local + packed_len(local),
            slots: width.max(1),
            local: local.max(loose),
            coupled: if coupled { unknowns } else { 0 },
            loosens: loose > 0,
        }
    }

    /// The lengths of the parts, in the order in which [`Layout::carve`] hands them out.
    fn parts(&self) -> [usize; 25] {
        let Self { unknowns: n, blocks, incidences, envelope, state, slot, slots, local, coupled, .. } =
            *self;
        [
            blocks,     // dofs
            blocks,     // order
            blocks,     // offset
            blocks + 1, // incidence starts
            incidences, // incident elements
            blocks,     // degree
            blocks,     // level or scratch
            n,          // row first
            n,          // row start
            envelope,   // matrix
            envelope,   // factor
            n,          // gradient
            n,          // step
            n,          // scratch vector
            n,          // natural sizes
            n,          // direction of negative curvature
            state,      // trial state
            state,      // scratch state
            state,      // best state of several
            slot.saturating_mul(slots),
            packed_len(local) * 2 + 6 * local,
            coupled, // gradient of the first sum
            coupled, // gradient of the second sum
            coupled, // both divided by the matrix
            coupled,
        ]
    }

    pub(super) fn len(&self) -> usize {
        self.parts().iter().fold(0, |sum, part| sum.saturating_add(*part))
    }

    pub(super) fn carve<'a>(&self, memory: &'a mut [f64]) -> Result<Workspace<'a>, WorkspaceTooSmall> {
        let (needed, given) = (self.len(), memory.len());
        if given < needed {
            return Err(WorkspaceTooSmall { needed, given });
        }
        let mut rest = memory;
        let parts = self.parts().map(|len| {
            let (part, tail) = core::mem::take(&mut rest).cut_mut(len);
            rest = tail;
            part
        });
        let [
            dofs,
            order,
            offset,
            starts,
            incident,
            degree,
            level,
            row_first,
            row_start,
            matrix,
            factor,
            gradient,
            step,
            scratch,
            sizes,
            direction,
            trial,
            spare,
            best,
            slots,
            local,
            first_gradient,
            second_gradient,
            first_solved,
            second_solved,
        ] = parts;
        Ok(Workspace {
            dofs: Indices(dofs),
            order: Indices(order),
            offset: Indices(offset),
            starts: Indices(starts),
            incident: Indices(incident),
            degree: Indices(degree),
            level: Indices(level),
            row_first: Indices(row_first),
            row_start: Indices(row_start),
            matrix,
            factor,
            gradient,
            step,
            scratch,
            sizes,
            direction,
            trial,
            spare,
            best,
            slots,
            local,
            sum_gradients: [first_gradient, second_gradient],
            solved: [first_solved, second_solved],
            slot_len: self.slot,
        })
    }
}

/// The parts of a carved workspace.
pub(super) struct Workspace<'a> {
    /// How many unknowns each block has.
    pub(super) dofs: Indices<'a>,
    pub(super) order: Indices<'a>,
    pub(super) offset: Indices<'a>,
    pub(super) starts: Indices<'a>,
    pub(super) incident: Indices<'a>,
    pub(super) degree: Indices<'a>,
    pub(super) level: Indices<'a>,
    pub(super) row_first: Indices<'a>,
    pub(super) row_start: Indices<'a>,
    pub(super) matrix: &'a mut [f64],
    pub(super) factor: &'a mut [f64],
    pub(super) gradient: &'a mut [f64],
    pub(super) step: &'a mut [f64],
    pub(super) scratch: &'a mut [f64],
    pub(super) sizes: &'a mut [f64],
    pub(super) direction: &'a mut [f64],
    pub(super) trial: &'a mut [f64],
    pub(super) spare: &'a mut [f64],
    pub(super) best: &'a mut [f64],
    pub(super) slots: &'a mut [f64],
    pub(super) local: &'a mut [f64],
    pub(super) sum_gradients: [&'a mut [f64]; 2],
    pub(super) solved: [&'a mut [f64]; 2],
    pub(super) slot_len: usize,
}

/// Whole numbers kept as the bits of a slice of `f64`, so that a caller hands over one kind of memory: nothing is
/// converted.
pub(crate) struct Indices<'a>(&'a mut [f64]);

impl<'a> Indices<'a> {
    pub(crate) fn new(memory: &'a mut [f64]) -> Self {
        Self(memory)
    }

    #[inline]
    pub(crate) fn get(&self, at: usize) -> usize {
        self.0.at(at).to_bits() as usize
    }

    #[inline]
    pub(crate) fn set(&mut self, at: usize, value: usize) {
        self.0.put(at, f64::from_bits(value as u64));
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn fill(&mut self, value: usize) {
        self.0.fill(f64::from_bits(value as u64));
    }
}

/// The length of the workspace, in `f64`s, that [`super::minimise`] needs for a problem with an executor of the
/// given width (1 for [`super::InOrder`]); `usize::MAX` where no memory is long enough.
pub fn workspace_len<P: Problem + ?Sized>(problem: &P, width: usize) -> usize {
    Layout::of(problem, width).len()
}
