//! Slices by any index: nothing here can panic.
//!
//! The kernel promises that no path of it ends in a panic, and a compiler cannot see of most indices that they are in
//! range. One that is not would be a defect of ours. Where debug assertions are on, as in all tests, it stops the
//! program at once; elsewhere a read gives zero, a range that is not there is empty, and nothing is written.

use core::slice::SliceIndex;

/// What `slice[index]` is, for every index.
pub(crate) trait Total<T> {
    /// `self[index]`.
    fn at(&self, index: usize) -> T
    where
        T: Copy + Default;

    /// `self[index] = value`.
    fn put(&mut self, index: usize, value: T);

    /// `self[index] += value`.
    fn add(&mut self, index: usize, value: T)
    where
        T: core::ops::AddAssign;

    /// `&self[range]`.
    fn part<R: SliceIndex<[T], Output = [T]>>(&self, range: R) -> &[T];

    /// `&mut self[range]`.
    fn part_mut<R: SliceIndex<[T], Output = [T]>>(&mut self, range: R) -> &mut [T];

    /// `self.split_at(count)`.
    fn cut(&self, count: usize) -> (&[T], &[T]);

    /// `self.split_at_mut(count)`.
    fn cut_mut(&mut self, count: usize) -> (&mut [T], &mut [T]);

    /// `self.copy_from_slice(from)`.
    fn copy(&mut self, from: &[T])
    where
        T: Copy;
}

impl<T> Total<T> for [T] {
    #[inline(always)]
    #[track_caller]
    fn at(&self, index: usize) -> T
    where
        T: Copy + Default,
    {
        debug_assert!(index < self.len(), "no {index} of {}", self.len());
        self.get(index).copied().unwrap_or_default()
    }

    #[inline(always)]
    #[track_caller]
    fn put(&mut self, index: usize, value: T) {
        debug_assert!(index < self.len(), "no {index} of {}", self.len());
        if let Some(slot) = self.get_mut(index) {
            *slot = value;
        }
    }

    #[inline(always)]
    #[track_caller]
    fn add(&mut self, index: usize, value: T)
    where
        T: core::ops::AddAssign,
    {
        debug_assert!(index < self.len(), "no {index} of {}", self.len());
        if let Some(slot) = self.get_mut(index) {
            *slot += value;
        }
    }

    #[inline(always)]
    #[track_caller]
    fn part<R: SliceIndex<[T], Output = [T]>>(&self, range: R) -> &[T] {
        let found = self.get(range);
        debug_assert!(found.is_some(), "no such part of {}", self.len());
        found.unwrap_or(&[])
    }

    #[inline(always)]
    #[track_caller]
    fn part_mut<R: SliceIndex<[T], Output = [T]>>(&mut self, range: R) -> &mut [T] {
        let all = self.len();
        let found = self.get_mut(range);
        debug_assert!(found.is_some(), "no such part of {all}");
        found.unwrap_or(&mut [])
    }

    #[inline(always)]
    #[track_caller]
    fn cut(&self, count: usize) -> (&[T], &[T]) {
        debug_assert!(count <= self.len(), "{count} of {}", self.len());
        self.split_at(count.min(self.len()))
    }

    #[inline(always)]
    #[track_caller]
    fn cut_mut(&mut self, count: usize) -> (&mut [T], &mut [T]) {
        debug_assert!(count <= self.len(), "{count} of {}", self.len());
        self.split_at_mut(count.min(self.len()))
    }

    #[inline(always)]
    #[track_caller]
    fn copy(&mut self, from: &[T])
    where
        T: Copy,
    {
        debug_assert!(self.len() == from.len(), "{} into {}", from.len(), self.len());
        if self.len() == from.len() {
            self.copy_from_slice(from);
        }
    }
}
