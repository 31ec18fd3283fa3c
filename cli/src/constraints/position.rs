//! Where a joint stands, or on what it slides.

use super::fault::{did_you_mean, quote};
use super::parse::{Parsed, Parser, looks_like_number};
use super::words::{Kind, Word};
use super::{Fault, Given};

/// How a joint that slides is written.
pub(super) const SLIDING: &str =
    "(G2Joint name Line (x,y,z) (dx,dy,dz))` or `(G2Joint name Plane (x,y,z) (nx,ny,nz))";

impl<'a> Parser<'a> {
    /// `[index] [Fixed | Initial | Line | Plane] (x,y,z)`, and after `Line` and `Plane` a direction.
    pub(super) fn position(&mut self, open: Word<'a>, what: &str) -> Parsed<Given> {
        let mut word = self.words.next();
        if word.kind == Kind::Text && word.text.bytes().all(|b| b.is_ascii_digit()) {
            word = self.words.next();
        }
        let mut keyword = String::new();
        if word.kind == Kind::Text {
            keyword = word.text.to_ascii_lowercase();
            match keyword.as_str() {
                "fixed" | "initial" | "line" | "plane" => {}
                _ if looks_like_number(word.text) => {
                    let message =
                        format!("the index of {what} must be a whole number, not {}", quote(word.text));
                    return Err(self
                        .fault(word, message)
                        .help("a position stands in parentheses: `(x,y,z)`"));
                }
                _ => {
                    let fault = self.expected(&format!("the position of {what}"), word);
                    return Err(match did_you_mean(word.text, ["Fixed", "Initial", "Line", "Plane"]) {
                        Some(help) => fault.help(help),
                        None => fault,
                    });
                }
            }
            word = self.words.next();
        }
        match word.kind {
            Kind::Close => return Err(self.fault(word, format!("{what} has no position"))),
            Kind::End => return Err(self.unclosed(open, what)),
            _ => {}
        }
        let (point, _) = self.point(open, word, what, "the position")?;
        Ok(match keyword.as_str() {
            "initial" => Given::Initial(point),
            "line" => Given::OnLine(point, self.guide(open, what, "line", "the direction of the line")?),
            "plane" => Given::OnPlane(point, self.guide(open, what, "plane", "the normal of the plane")?),
            _ => Given::Fixed(point),
        })
    }

    /// The direction `(x,y,z)` of the line or plane on which a joint slides.
    fn guide(&mut self, open: Word<'a>, what: &str, on: &str, of: &str) -> Parsed<[f64; 3]> {
        let word = self.words.next();
        // A condition in its place, or nothing at all.
        let next = self.words.clone().next();
        let missing = match word.kind {
            Kind::Close => true,
            Kind::Open => next.kind == Kind::Text && next.text.starts_with(|c: char| c.is_ascii_alphabetic()),
            _ => false,
        };
        if missing && next.text.parse::<f64>().is_err() {
            let message = format!("the {on} of {what} has no direction: a second point is missing");
            return Err(self
                .fault(word, message)
                .help(format!("a joint that slides is written `{SLIDING}`")));
        }
        let (direction, place) = self.point(open, word, what, of)?;
        if direction == [0.0; 3] {
            let message = format!("{of} of {what} has no direction: all coordinates are zero");
            return Err(Fault::error(self.text, place, message));
        }
        Ok(direction)
    }
}
