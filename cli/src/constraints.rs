//! Reading a curve's constraints in the format of the thesis (Appendix A).
//!
//! A file holds joints and exactly one curve, in any order:
//!
//! ```text
//! ; from here to the end of the line is a comment, and so it is after `#`
//! (G2Joint a 1 Fixed (-2,0,0) (Fixed Tangent (0,1,0)) (Fixed Curvature (0.27,0,0)))
//! (G2Joint b (0,0,0) (Initial Tangent (1,-1,0)))
//! (G2Curve test Open (a,b))
//! ```
//!
//! A position is fixed unless `Initial` stands before it; the number before it is ignored. Keywords may be written in any
//! case, names may not. Where a joint splits a tangent (`G0Joint`) or a curvature (`G0Joint`, `G1Joint`), a constraint
//! holds for both sides; our extension `(Fixed Tangent Arriving (0,1,0))` or `Leaving` gives it for one.
//!
//! Two more extensions: a joint slides from a point on a line with a direction or in a plane with a normal,
//!
//! ```text
//! (G2Joint a Line (0.5,-12,0) (0,1,0))
//! (G2Joint b Plane (1,0,0) (0,0,1))
//! ```
//!
//! and `(Size Curvature (0.27,0,0))` keeps a curvature's size, its direction being where the search starts;
//! `(Size Curvature 0.27)` leaves that to the start curve and needs a tangent.
//!
//! A planar curve keeps clear of points and segments: it leaves them to the left or to the right, seen in the direction in
//! which it runs, at a distance or more.
//!
//! ```text
//! (Obstacle Left 0.25 (6,-6,0))
//! (Obstacle Right 0.25 (0,1,0) (3,1,0))
//! ```
//!
//! Whether the numbers make sense as a curve is for the kernel to say: [`NamedJoint`] and [`PlacedObstacle`] keep the place
//! for its answer.

mod fault;
mod obstacle;
mod parse;
mod point;
mod position;
mod resolve;
#[cfg(test)]
mod tests;
mod words;

pub use fault::Fault;

use minvar::curve::Obstacle;
use words::Place;

/// A curve to compute, as the file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Specification {
    /// The curve's name.
    pub name: String,
    /// Whether the last joint is joined to the first.
    pub closed: bool,
    /// The joints in the curve's order: at least two, three of a closed curve.
    pub joints: Vec<NamedJoint>,
    /// What the curve keeps clear of, in the file's order.
    pub obstacles: Vec<PlacedObstacle>,
}

/// An obstacle and where the file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedObstacle {
    /// The point or segment with its clearance and side.
    pub shape: Obstacle,
    /// The line of its opening parenthesis, from 1.
    pub line: usize,
    /// The column of its opening parenthesis in characters, from 1.
    pub column: usize,
}

/// One joint of the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedJoint {
    /// Its name, unique in the file.
    pub name: String,
    /// What is continuous here.
    pub continuity: Continuity,
    /// The position: fixed, a start value, or sliding.
    pub position: Given,
    /// The tangent arriving and leaving: the same unless the joint is [`Continuity::G0`]. Any length but zero.
    pub tangent: [Given; 2],
    /// The curvature vector arriving and leaving: the same if the joint is [`Continuity::G2`].
    pub curvature: [Given; 2],
    /// The line of its opening parenthesis, from 1.
    pub line: usize,
    /// The column of its opening parenthesis in characters, from 1.
    pub column: usize,
}

/// How smoothly a curve passes a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuity {
    /// Position only: a corner.
    G0,
    /// Position and tangent.
    G1,
    /// Position, tangent and curvature.
    G2,
}

/// What is known of a vector beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Nothing.
    Free,
    /// A value to start from.
    Initial([f64; 3]),
    /// A value to keep.
    Fixed([f64; 3]),
    /// Of a curvature: its size is kept; a value along the tangent says nothing of the direction.
    Size([f64; 3]),
    /// Of a position: it slides from a point on the line along a direction, which is not zero.
    OnLine([f64; 3], [f64; 3]),
    /// Of a position: it slides from a point in the plane across a normal, which is not zero.
    OnPlane([f64; 3], [f64; 3]),
}

impl Given {
    /// Whether the value must be kept.
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::Fixed(_))
    }
}

/// A file that could be read, and what is odd about it.
#[derive(Debug)]
pub struct Reading {
    /// The curve.
    pub specification: Specification,
    /// What the user may not have meant.
    pub warnings: Vec<Fault>,
}

/// Reads the bytes of a file. Linear in their number.
pub fn read(bytes: &[u8]) -> Result<Reading, Box<Fault>> {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.strip_prefix('\u{feff}').unwrap_or(text),
        Err(error) => return Err(not_text(bytes, error.valid_up_to())),
    };
    resolve::resolve(text, parse::forms(text)?)
}

/// What the kernel says of a joint or an obstacle, at its line and column in the file that was read.
pub fn fault_at(bytes: &[u8], [line, column]: [usize; 2], message: impl Into<String>) -> Box<Fault> {
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    Fault::error(text, words::place_at(text, line, column), message)
}

/// Why bytes that are not UTF-8 cannot be read, and where they begin to be wrong.
fn not_text(bytes: &[u8], valid: usize) -> Box<Fault> {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(valid + 80)]);
    let place = words::place_of(&text, valid);
    let fault = Fault::error(&text, place, format!("byte {} of this file is not UTF-8 text", valid + 1));
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        fault.help("it looks like UTF-16: save it as UTF-8")
    } else {
        fault.help("a constraint file is plain text saved as UTF-8")
    }
}
