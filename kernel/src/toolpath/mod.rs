//! Paths for machines: a chain of elements as straight chords, as tangent-continuous arcs, and as G-code.
//!
//! A tolerance here is a length, and a promise: no point of the curve is farther than it from the path, and
//! no point of the path farther than it from the curve. It is not checked at samples. Polynomials in
//! Bernstein form bound the distance over whole intervals, and the bound is reported with every move. What is
//! not covered: the promise is about parts of the path and the parts of the curve that they replace, each
//! against each, so it is at least as strong as the Hausdorff distance; and rounding is allowed for by adding
//! `2^-44` of the largest coordinate to every bound.
//!
//! [`chords`] and [`arcs`] are iterators: a path of any length takes a fixed amount of memory, and a caller
//! stops when it likes. All input is checked before the first move.
//!
//! **Corners.** Where neighbouring elements meet at more than `1e-3` rad the joint is a corner: a move ends
//! there, exactly.

mod biarc;
mod figure;
mod flatten;
mod gcode;

pub use biarc::{Arc, Arcs, Move, Segment, arcs, biarc};
pub use flatten::{Chord, Chords, chords};
pub use gcode::{GcodeError, GcodeOptions, Motion, Plane, Summary, Units, write_gcode};

use core::fmt;

use figure::RoundedUp;

use crate::basis::bernstein::{Bernstein, Dyadic};
use crate::curve::Element;
use crate::order::Order;
use crate::root::sqrt;

/// Joints that turn by more than this angle (radians) are corners.
const CORNER: f64 = 1e-3;

/// Rounding of control points, restrictions and distances, relative to the largest coordinate. A restricted
/// quintic is within `2^-49` of that, so there is room for the few operations that follow.
const ROUNDING: f64 = 1.0 / (1_u64 << 44) as f64;

/// The smallest tolerance, relative to the largest coordinate: four times what rounding takes of it.
const FINEST: f64 = 4.0 * ROUNDING;

/// The part of a tolerance that a chain may spend on not being what it should: gaps, heights that differ.
const FLAWS: f64 = 1e-3;

/// Coordinates beyond this would overflow when multiplied.
const LARGEST: f64 = 1e100;

/// Why a path cannot be computed. Elements are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathError {
    /// The chain has no elements.
    NoElements,
    /// The tolerance is zero, negative or not finite.
    Tolerance,
    /// The tolerance is below what `f64` can promise for coordinates of this size.
    ToleranceTooFine {
        /// The smallest tolerance that can be asked for, a length.
        finest: f64,
    },
    /// A row is not finite, or is so large (1e100) that its square overflows.
    NotFinite {
        /// The element.
        element: usize,
    },
    /// The element does not begin where the one before ends, by more than a thousandth of the tolerance.
    Gap {
        /// The later element.
        element: usize,
    },
    /// The element leaves the plane `z` = constant of the curve's start by more than a thousandth of the
    /// tolerance.
    NotPlanar {
        /// The element.
        element: usize,
    },
    /// `|C'|` falls below a millionth of the element's greatest: the curve stops there and has no tangent.
    Irregular {
        /// The element.
        element: usize,
    },
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoElements => write!(f, "the curve has no elements"),
            Self::Tolerance => write!(f, "the tolerance must be a positive, finite length"),
            Self::ToleranceTooFine { finest } => {
                write!(
                    f,
                    "the tolerance is finer than numbers of this size allow: give at least {}",
                    RoundedUp(finest)
                )
            }
            Self::NotFinite { element } => {
                write!(f, "element {element} has a coordinate that is not finite or beyond 1e100")
            }
            Self::Gap { element } => {
                write!(f, "element {element} does not begin where the element before it ends")
            }
            Self::NotPlanar { element } => {
                write!(
                    f,
                    "element {element} leaves the plane z = constant: arcs need a planar curve, use chords"
                )
            }
            Self::Irregular { element } => {
                write!(f, "the derivative of element {element} vanishes, so it has no tangent: use chords")
            }
        }
    }
}

impl core::error::Error for PathError {}

/// The end of a chain is tried at once where it is within so many of the last move's parameters.
const NEAR_STOP: f64 = 8.0;

/// What a path is asked to be, which decides what its curve must be.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Any curve in space.
    Chords,
    /// A regular curve in a plane `z` = constant.
    Arcs,
}

/// A place on a chain: parameter `t` in [0, 1) of element `index`; the chain's end is 0 of the element after
/// the last.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Position {
    index: usize,
    t: f64,
}

/// A checked chain of elements.
#[derive(Clone, Copy, Debug)]
struct Chain<'a> {
    elements: &'a [Element],
    /// What the proven bounds may be, so that with `slack` the tolerance is kept.
    limit: f64,
    /// To be added to every bound: rounding, gaps and differences of height.
    slack: f64,
    /// How far a point of the curve may be behind an arc's start or beyond its end: rounding and gaps.
    /// `slack` holds twice as much.
    overlap: f64,
}

impl<'a> Chain<'a> {
    fn new(elements: &'a [Element], tolerance: f64, kind: Kind) -> Result<Self, PathError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(PathError::Tolerance);
        }
        let mut size = 0.0_f64;
        for (element, one) in elements.iter().enumerate() {
            // A sum, because a NaN would be lost in max().
            let own =
                one.rows.iter().chain(one.bezier().iter()).flatten().fold(0.0_f64, |sum, x| sum + x.abs());
            if own.is_nan() || own > LARGEST {
                return Err(PathError::NotFinite { element });
            }
            size = one.bezier().iter().flatten().fold(size, |size, x| size.larger(x.abs()));
        }
        let finest = FINEST * size;
        if tolerance < finest {
            return Err(PathError::ToleranceTooFine { finest });
        }

        let first = elements.first().ok_or(PathError::NoElements)?;
        let plane = first.rows[0][2];
        let allowed = FLAWS * tolerance;
        let (mut gap, mut height) = (0.0_f64, 0.0_f64);
        let mut end = first.rows[0];
        for (element, one) in elements.iter().enumerate() {
            gap = gap.larger(distance(end, one.rows[0]));
            if gap > allowed {
                return Err(PathError::Gap { element });
            }
            end = one.rows[5];
            if kind == Kind::Arcs {
                height = one.bezier().iter().fold(height, |height, p| height.larger((p[2] - plane).abs()));
                if height > allowed {
                    return Err(PathError::NotPlanar { element });
                }
                if !is_regular(one) {
                    return Err(PathError::Irregular { element });
                }
            }
        }
        let rounding = ROUNDING * size;
        let slack = rounding + 3.0 * gap + height;
        Ok(Self { elements, limit: tolerance - slack, slack, overlap: 0.25 * rounding + gap })
    }

    /// The coordinates of one element as polynomials; of the last one beyond the end.
    fn coordinates(&self, index: usize) -> [Bernstein; 3] {
        let element = self.elements.get(index).or(self.elements.last()).unwrap_or(&Element::ZERO);
        let b = element.bezier();
        [0, 1, 2].map(|d: usize| {
            Bernstein::new(b.map(|point| match d {
                0 => point[0],
                1 => point[1],
                _ => point[2],
            }))
        })
    }

    fn start(&self) -> Position {
        Position { index: 0, t: 0.0 }
    }

    fn end(&self) -> Position {
        Position { index: self.elements.len(), t: 0.0 }
    }

    fn point(&self, at: Position) -> [f64; 3] {
        let t = if at.index < self.elements.len() { at.t } else { 1.0 };
        self.coordinates(at.index).map(|x| x.value(t))
    }

    /// The position `step` parameters (elements and parts of one) further on, or the end.
    fn advance(&self, from: Position, step: f64) -> Position {
        let t = from.t + step;
        let whole = libm::floor(t);
        if whole >= (self.elements.len() - from.index.min(self.elements.len())) as f64 {
            return self.end();
        }
        Position { index: from.index + whole as usize, t: t - whole }
    }

    /// The elements, with their parameter intervals, between two positions.
    fn pieces(&self, from: Position, to: Position) -> impl Iterator<Item = (usize, f64, f64)> {
        let last = to.index.min(self.elements.len().saturating_sub(1));
        (from.index..=last).filter_map(move |index| {
            let a = if index == from.index { from.t } else { 0.0 };
            let b = if index == to.index { to.t } else { 1.0 };
            (a < b).then_some((index, a, b))
        })
    }

    /// The next corner after `from`, or the end.
    fn next_stop(&self, from: Position) -> Position {
        let joints = self.elements.windows(2).enumerate().skip(from.index);
        for (index, pair) in joints {
            if let [before, after] = pair
                && is_corner(before, after)
            {
                return Position { index: index + 1, t: 0.0 };
            }
        }
        self.end()
    }

    /// The farthest position up to `stop` that `attempt` accepts, and what it made of it.
    ///
    /// Greedy: `stop` itself, else doubling or halving from `step` parameters, then bisection to 1/256 of the
    /// found length. `attempt` need not be monotone; what is returned was accepted. `None` if not even 2^-80
    /// of the way was.
    fn farthest<T>(
        &self,
        from: Position,
        stop: Position,
        step: f64,
        mut attempt: impl FnMut(Position) -> Option<T>,
    ) -> Option<(Position, T)> {
        let whole = self.parameters_between(from, stop);
        // Far from the end, trying it would cost a walk over the whole chain for every move.
        let tried_stop = whole <= NEAR_STOP * step.larger(1.0);
        if tried_stop && let Some(made) = attempt(stop) {
            return Some((stop, made));
        }
        let mut bad = whole;
        let mut good = 0.0;
        let mut best = None;
        let mut trial = step.smaller(0.5 * bad);
        for _ in 0..80 {
            let to = self.advance(from, trial);
            if let Some(made) = attempt(to) {
                best = Some((to, made));
                good = trial;
                trial *= 2.0;
                if trial >= bad {
                    if !tried_stop
                        && bad == whole
                        && let Some(made) = attempt(stop)
                    {
                        return Some((stop, made));
                    }
                    break;
                }
            } else {
                bad = trial;
                if best.is_some() {
                    break;
                }
                trial *= 0.5;
            }
        }
        if best.is_some() {
            for _ in 0..8 {
                let middle = 0.5 * (good + bad);
                let to = self.advance(from, middle);
                match attempt(to) {
                    Some(made) => {
                        best = Some((to, made));
                        good = middle;
                    }
                    None => bad = middle,
                }
            }
        }
        best
    }

    /// The parameter length between two positions, the next search's first guess.
    fn parameters_between(&self, from: Position, to: Position) -> f64 {
        to.index.saturating_sub(from.index) as f64 + (to.t - from.t)
    }
}

/// Whether `|C'|²` stays above 1e-12 of its greatest coefficient on [0, 1].
fn is_regular(element: &Element) -> bool {
    let b = element.bezier();
    let dx = Bernstein::new(b.map(|p| p[0])).derivative();
    let dy = Bernstein::new(b.map(|p| p[1])).derivative();
    let square = dx * dx + dy * dy;
    let least = 1e-12 * square.range().1;
    if least <= 0.0 {
        return false;
    }
    let mut cell = Some(Dyadic::WHOLE);
    while let Some(here) = cell {
        let (a, b) = here.interval();
        let local = square.restricted(a, b);
        cell = if local.range().0 > least {
            here.next()
        } else if local.value(0.0) <= least || local.value(1.0) <= least || here.width < 1e-9 {
            return false;
        } else {
            Some(here.left_half())
        };
    }
    true
}

/// Whether the curve turns by more than [`CORNER`] where these two elements meet.
///
/// The directions are the control polygon's outermost legs that have a length, so that an element without a
/// derivative at its end still has one.
fn is_corner(before: &Element, after: &Element) -> bool {
    let mut end = before.bezier();
    end.reverse();
    let (u, v) = (first_leg(&end), first_leg(&after.bezier()));
    // `u` points backwards.
    let cosine = -(u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
    let sine = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let sine = sqrt(sine[0] * sine[0] + sine[1] * sine[1] + sine[2] * sine[2]);
    cosine < 0.0 || sine > CORNER * cosine
}

fn first_leg(points: &[[f64; 3]; 6]) -> [f64; 3] {
    let size = points.iter().fold(0.0_f64, |size, p| size.larger(distance(*p, points[0])));
    for p in points {
        if distance(*p, points[0]) > 1e-9 * size {
            return [p[0] - points[0][0], p[1] - points[0][1], p[2] - points[0][2]];
        }
    }
    [0.0; 3]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (x, y, z) = (b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    sqrt(x * x + y * y + z * z)
}
