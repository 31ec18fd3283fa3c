//! What a curve must keep clear of.

use super::fault::{did_you_mean, quote};
use super::parse::{Parsed, Parser, describe, is_head, looks_like_number};
use super::words::{Kind, Place, Word};
use super::{Fault, PlacedObstacle};
use minvar::curve::{Obstacle, Side};

/// How an obstacle is written.
const FORM: &str =
    "`(Obstacle Left 0.25 (x,y,z))` is a point, `(Obstacle Left 0.25 (x,y,z) (x,y,z))` a segment";

const WHAT: &str = "this obstacle";

impl<'a> Parser<'a> {
    /// `Left | Right  clearance  (x,y,z) [(x,y,z)] )` after its keyword.
    pub(super) fn obstacle(&mut self, open: Word<'a>) -> Parsed<PlacedObstacle> {
        let side = self.side(open)?;
        let clearance = self.clearance(open)?;
        let from = self.corner(open)?.ok_or_else(|| {
            Fault::error(self.text, open.place, format!("{WHAT} has no point: it is nowhere")).help(FORM)
        })?;
        let to = self.corner(open)?;
        if to.is_some() {
            let word = self.words.next();
            match word.kind {
                Kind::Close => {}
                Kind::End => return Err(self.unclosed(open, WHAT)),
                Kind::Open if is_head(self.words.clone().next()) => {
                    return Err(self.still_open(open, word, WHAT));
                }
                Kind::Open => {
                    return Err(self
                        .fault(word, format!("{WHAT} has a third point"))
                        .help("an obstacle is a point or a segment: write a polygon as one for each side"));
                }
                _ => return Err(self.expected(&format!("the `)` of {WHAT}"), word)),
            }
        }
        let Place { line, column, .. } = open.place;
        let shape = Obstacle { from, to: to.unwrap_or(from), clearance, side };
        Ok(PlacedObstacle { shape, line, column })
    }

    fn side(&mut self, open: Word<'a>) -> Parsed<Side> {
        let word = self.words.next();
        match word.text.to_ascii_lowercase().as_str() {
            "left" => Ok(Side::LEFT),
            "right" => Ok(Side::RIGHT),
            _ if word.kind == Kind::End => Err(self.unclosed(open, WHAT)),
            _ => {
                let fault = self.expected("`Left` or `Right`, the side of the curve on which it stays", word);
                let near = did_you_mean(word.text, ["Left", "Right"]).filter(|_| word.kind == Kind::Text);
                Err(fault.help(near.unwrap_or(FORM.to_owned())))
            }
        }
    }

    fn clearance(&mut self, open: Word<'a>) -> Parsed<f64> {
        let word = self.words.next();
        match word.kind {
            Kind::End => Err(self.unclosed(open, WHAT)),
            Kind::Text if looks_like_number(word.text) || word.text.parse::<f64>().is_ok() => {
                let clearance = self.number(word)?;
                if clearance < 0.0 {
                    let fault = self.fault(word, format!("the clearance {} is negative", quote(word.text)));
                    return Err(fault.help("which side is said by `Left` or `Right`"));
                }
                Ok(clearance)
            }
            _ => {
                let found = describe(word);
                Err(self
                    .fault(word, format!("{WHAT} has no clearance: found {found} in its place"))
                    .help(FORM))
            }
        }
    }

    /// The next point, or `None` at the end of the obstacle.
    fn corner(&mut self, open: Word<'a>) -> Parsed<Option<[f64; 3]>> {
        let word = self.words.next();
        match word.kind {
            Kind::Close => Ok(None),
            Kind::Open if is_head(self.words.clone().next()) => Err(self.still_open(open, word, WHAT)),
            _ => Ok(Some(self.point(open, word, WHAT, "a point")?.0)),
        }
    }
}
