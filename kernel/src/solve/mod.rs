//! Minimising a sum of elements: the one solver of curves, networks, surfaces and fits.
//!
//! A [`Problem`] names its *blocks* of unknowns (each living on a manifold: a point, a unit tangent with its
//! frame, a handful of scalars), says which blocks each *element* touches, and gives an element's cost, gradient
//! and second-derivative matrix. The solver orders the blocks (reverse Cuthill–McKee from a Gibbs
//! pseudo-diameter, Fang 5.4), assembles the sum into an envelope, factors it by Cholesky (shifted where it is
//! indefinite) and steps by a trust region. For a chain of elements the cost is linear in its length. An objective that
//! couples all elements through a second sum, as a product with the length does, adds a matrix of rank two, which is
//! treated exactly (Sherman, Morrison and Woodbury).
//!
//! Nothing here knows what a curve is, and nothing is allocated: all memory is the caller's, in the length that
//! [`workspace_len`] gives. Sums are taken in element order, whatever [`Executor`] computes the elements, so the
//! bits of the result do not depend on it.

mod descent;
mod envelope;
mod executor;
mod minimise;
mod ordering;
mod patch;
mod problem;
mod rank_two;
mod relax;
mod report;
mod trust_region;
mod workspace;

pub(crate) use envelope::{Allow, Envelope, dot};
pub use executor::{Executor, InOrder, Task};
pub use minimise::{Settings, minimise};
pub use problem::{BlockList, Coupled, MAX_ELEMENT_BLOCKS, Problem, packed, packed_len};
pub use report::{Control, Observer, Outcome, Record, Silent, Status};
pub(crate) use workspace::Indices;
pub use workspace::{WorkspaceTooSmall, workspace_len};

#[cfg(test)]
mod tests;
