//! What a problem tells the solver.

use core::ops::Range;

/// The largest number of blocks that one element may touch.
pub const MAX_ELEMENT_BLOCKS: usize = 32;

/// The blocks that an element touches, in the order in which its local unknowns are numbered.
pub type BlockList = heapless::Vec<usize, MAX_ELEMENT_BLOCKS>;

/// The place of entry (`row`, `column`), `column <= row`, in a packed lower triangle.
#[inline]
pub const fn packed(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// The length of a packed lower triangle of `n` rows.
pub const fn packed_len(n: usize) -> usize {
    n * (n + 1) / 2
}

/// How the objective follows from two sums over the elements, with its first and second derivatives by them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupled {
    /// The objective.
    pub value: f64,
    /// Its derivatives by the first and the second sum.
    pub first: [f64; 2],
    /// Its second derivatives, symmetric.
    pub second: [[f64; 2]; 2],
}

impl Coupled {
    /// The first sum alone: what a problem that is not coupled minimises.
    pub const fn plain(sums: [f64; 2]) -> Self {
        Self { value: sums[0], first: [1.0, 0.0], second: [[0.0; 2]; 2] }
    }
}

/// A sum of elements to be minimised over blocks of unknowns that live on manifolds.
///
/// The *state* is one slice of numbers in which every block owns a range, in whatever redundant form suits it (a
/// unit vector, a frame). Steps are taken in each block's tangent space, whose dimension is its number of *dofs*;
/// a block without dofs is fixed. An element's *local unknowns* are the dofs of the blocks it touches, in the
/// order of [`Problem::element_blocks`].
///
/// The counts must not change during a solve.
pub trait Problem: Sync {
    /// The number of blocks.
    fn blocks(&self) -> usize;

    /// The number of dofs of a block; 0 where it is fixed.
    fn dofs(&self, block: usize) -> usize;

    /// Where a block's numbers stand in the state.
    fn state_range(&self, block: usize) -> Range<usize>;

    /// The length of the state.
    fn state_len(&self) -> usize;

    /// The number of elements.
    fn elements(&self) -> usize;

    /// Appends the blocks that an element touches, each once.
    fn element_blocks(&self, element: usize, blocks: &mut BlockList);

    /// The largest number of local unknowns of any element.
    fn max_element_dofs(&self) -> usize;

    /// A bound on the number of entries of the ordered matrix's envelope, known before any ordering: the caller
    /// sizes memory with it. The default holds for every problem.
    fn envelope_bound(&self) -> usize {
        let n: usize = (0..self.blocks()).map(|block| self.dofs(block)).sum();
        packed_len(n)
    }

    /// The cost of an element. A value that is not finite means that the state is outside the problem's domain:
    /// the solver then shortens its step.
    fn cost(&self, element: usize, state: &[f64]) -> f64;

    /// The cost of an element with its derivatives in the tangent spaces of its blocks: `gradient[i]` by the
    /// local unknown `i`, and the second derivatives into the packed lower triangle `matrix` (see [`packed`]).
    ///
    /// The matrix is the exact Hessian of the cost along [`Problem::retract`], or a positive semidefinite part
    /// of it where residuals are small. Both slices come filled with zeros and have exactly the element's size.
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64;

    /// Whether the objective couples all elements through a second sum, as a product with the length does. If so, the
    /// four methods below that speak of sums must be given too.
    fn is_coupled(&self) -> bool {
        false
    }

    /// Whether a coupled problem is far from what it is to become: the sparse matrix by itself must be positive definite
    /// then, which makes for smaller steps. Otherwise what the coupling adds may make up for a negative eigenvalue.
    fn is_cautious(&self) -> bool {
        false
    }

    /// The objective from the two sums. The matrix of all elements together is then the sparse one that
    /// [`Problem::linearise_sums`] gives plus one of rank two, which the solver treats exactly.
    fn couple(&self, sums: [f64; 2]) -> Coupled {
        Coupled::plain(sums)
    }

    /// What an element adds to the two sums.
    fn sums(&self, element: usize, state: &[f64]) -> [f64; 2] {
        [self.cost(element, state), 0.0]
    }

    /// As [`Problem::linearise`] for the combination `first[0] · sum 0 + first[1] · sum 1`; the gradient of sum 1 by
    /// itself goes to `second`, which has the gradient's length where the problem is coupled and is empty where not.
    fn linearise_sums(
        &self,
        element: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> [f64; 2] {
        let _ = (first, second);
        [self.linearise(element, state, gradient, matrix), 0.0]
    }

    /// As [`Problem::linearise_sums`] by those unknowns alone that the element shares with no other, in their order.
    /// `None` where the problem has no faster way than leaving out the rest.
    fn linearise_own(
        &self,
        element: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> Option<[f64; 2]> {
        let _ = (element, state, first, gradient, second, matrix);
        None
    }

    /// The block at a place of a known good order, in which neighbours stand near each other; `None` lets the solver find
    /// one. Either for all places or for none.
    fn block_at(&self, place: usize) -> Option<usize> {
        let _ = place;
        None
    }

    /// Moves a block from `from` by `step` in its tangent space. `from` and `to` are the block's own ranges.
    fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]);

    /// Whether a block may move far along a curved valley at hardly any cost, as a point does that slides along a
    /// curve: it is relaxed together with what its elements share with no other block.
    fn is_loose(&self, block: usize) -> bool {
        let _ = block;
        false
    }

    /// A bound on the number of unknowns of a loose block together with all that its elements share with no other block; 0
    /// where nothing is loose.
    fn most_loose_dofs(&self) -> usize {
        0
    }

    /// How many of a block's first unknowns no step of the whole moves, though its own relaxation does: those that hold
    /// a shape in its place of which nothing is fixed.
    fn held(&self, block: usize) -> usize {
        let _ = block;
        0
    }

    /// How many other starts an element has for the unknowns that it shares with none, beside the one it stands at.
    /// Where those have several minima, the solver tries all once and goes on from the best.
    fn variants(&self) -> usize {
        0
    }

    /// Changes an element's own unknowns in the state to its start `variant` (0 …), seen from where they stand.
    fn vary(&self, element: usize, variant: usize, state: &mut [f64]) {
        let _ = (element, variant, state);
    }

    /// The natural size of each dof of a block at a state, all positive: a step of this size changes the shape
    /// noticeably. They make the unknowns comparable (lengths, angles, curvatures) and the solver indifferent to
    /// the caller's unit.
    fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]);

    /// A cost that is natural for this problem's size (one length unit's worth of everything): costs are known no
    /// better than rounding times this.
    fn natural_cost(&self) -> f64;

    /// Whether a state shows that the minimum runs away to infinity.
    fn runs_away(&self, state: &[f64]) -> bool {
        let _ = state;
        false
    }
}
