//! Who computes the elements: in order on the caller's thread, or many at a time.

/// Fills the slot of one element of a batch: called with the element's place in the batch and its slot.
pub type Task<'a> = dyn Fn(usize, &mut [f64]) + Sync + 'a;

/// Computes a batch of independent elements.
///
/// The solver cuts `slots` into chunks, one an element, and wants `task` called once for each. The order and the
/// threads are the executor's affair: the solver adds the slots up in element order afterwards.
pub trait Executor {
    /// How many elements to hand over at once. The workspace holds that many slots.
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
