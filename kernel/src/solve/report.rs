//! How a minimisation went: status, record an iteration, observer.

/// How a computation ended. A status is not an error: figures were computed, and the status says what they are worth.
///
/// The numbers are fixed for good.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Nothing was computed yet.
    Unsolved = 0,
    /// A minimum was reached: the functional cannot be lowered beyond rounding.
    Converged = 1,
    /// No further progress is possible though the tolerances are not met, or what was reached is no true minimum: a cusp, a
    /// functional that a finer quadrature does not confirm, an element that would rather stop at its end. More elements may
    /// help.
    Stalled = 2,
    /// The allowed number of iterations was used up, all of them.
    IterationLimit = 3,
    /// The shape grows without limit while the functional sinks: these data have no minimum in reach. A curve is then five
    /// times as long as the polygon through its data or longer, and any that is fifty times as long counts as unbounded,
    /// unless its length is given. Add a constraint, or choose a functional that has a minimum.
    Unbounded = 4,
    /// The observer asked to stop.
    Cancelled = 5,
}

impl Status {
    /// One sentence that a user can act on.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Unsolved => "nothing was computed",
            Self::Converged => "converged: the functional cannot be lowered beyond rounding",
            Self::Stalled => {
                "stalled: no further progress is possible, or the elements are too coarse for the curve; take more elements a span"
            }
            Self::IterationLimit => {
                "stopped at the iteration limit: allow more iterations, or give better start values"
            }
            Self::Unbounded => {
                "unbounded: the curve grows without limit while the functional sinks; a scale-invariant functional, \
                 a tension or a given length has a minimum, and so have more constraints"
            }
            Self::Cancelled => "cancelled by the observer",
        }
    }

    /// A short lower-case name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unsolved => "unsolved",
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::IterationLimit => "iteration-limit",
            Self::Unbounded => "unbounded",
            Self::Cancelled => "cancelled",
        }
    }
}

/// What one iteration did. An iteration is one trial step, accepted or not; one on a curve's directions alone, which come
/// first where a curve is planar, has only a value and a step.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// The functional after the iteration.
    pub value: f64,
    /// The decrease that the quadratic model promised for this step.
    pub predicted: f64,
    /// The decrease that the step brought; negative where it was refused for raising the functional.
    pub actual: f64,
    /// The largest gradient component before the step, each times its unknown's natural size.
    pub gradient: f64,
    /// The length of the step in natural sizes.
    pub step: f64,
    /// The shift that was added to the scaled Hessian; 0 is a pure Newton step.
    pub shift: f64,
}

impl Record {
    /// A record of zeros: what record slices are filled with before a solve.
    pub const ZERO: Self =
        Self { value: 0.0, predicted: 0.0, actual: 0.0, gradient: 0.0, step: 0.0, shift: 0.0 };
}

/// What an observer wants next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop with [`Status::Cancelled`] and the best state so far.
    Cancel,
}

/// Watches a solve.
pub trait Observer {
    /// Called after every iteration with its number, from 1, and its record. Not called again in a computation that it
    /// asked to stop, whose result is then the best so far, as a whole. Elements are written after the last call.
    fn iteration(&mut self, number: usize, record: &Record) -> Control;
}

/// The observer that does not watch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn iteration(&mut self, _: usize, _: &Record) -> Control {
        Control::Continue
    }
}

/// How a minimisation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Why it ended.
    pub status: Status,
    /// The number of trial steps.
    pub iterations: usize,
    /// How often an element was linearised, relaxation included.
    pub linearisations: usize,
    /// The value of the sum at the final state.
    pub value: f64,
    /// The largest component of the final gradient, each times its unknown's natural size.
    pub gradient: f64,
    /// The decrease that one more Newton step promises at the final state; infinite where the final Hessian is
    /// not positive definite.
    pub decrement: f64,
}
