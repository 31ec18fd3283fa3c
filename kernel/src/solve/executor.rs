//! Who computes the elements: in order on the caller's thread, or many at a time.

/// Fills the slot of one element of a batch: called with the element's place in the batch and its slot. A place beyond
/// the batch and a slot of another length are left alone.
pub type Task<'a> = dyn Fn(usize, &mut [f64]) + Sync + 'a;

/// Computes a batch of independent elements.
///
/// The solver cuts `slots` into chunks, one an element, and wants `task` called for each before [`Executor::run`]
/// returns. The order, the threads and how often are the executor's affair: the solver adds the slots up in element
/// order afterwards, so that none of them changes a bit.
///
/// An executor cannot make the solver panic or go on for ever. An element that it leaves out is noticed: the state
/// counts as one outside the problem's domain, and the solver ends [`super::Status::Stalled`] if that goes on. What
/// cannot be noticed is a slot that got another element's numbers, or that the executor wrote into: the figures mean
/// nothing then.
pub trait Executor {
    /// How many elements to hand over at once; 0 is 1. The workspace holds that many slots. Asked once a minimisation.
    fn width(&self) -> usize;

    /// Calls `task(i, chunk i of slots)` for every chunk of `slot_len` numbers.
    fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>);
}

/// The executor that computes the elements in order on the caller's thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct InOrder;

impl Executor for InOrder {
    fn width(&self) -> usize {
        1
    }

    fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
        for (index, slot) in slots.chunks_exact_mut(slot_len.max(1)).enumerate() {
            task(index, slot);
        }
    }
}
