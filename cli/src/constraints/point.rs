//! Points and numbers.

use super::Fault;
use super::fault::quote;
use super::parse::{Parsed, Parser};
use super::words::{Kind, Place, Word};

impl<'a> Parser<'a> {
    /// `(x,y,z)` whose first word has been read, and where it stands.
    pub(super) fn point(
        &mut self,
        open: Word<'a>,
        first: Word<'a>,
        what: &str,
        of: &str,
    ) -> Parsed<([f64; 3], Place)> {
        match first.kind {
            Kind::Open => {}
            Kind::End => return Err(self.unclosed(open, what)),
            _ => return Err(self.expected(&format!("{of} `(x,y,z)` of {what}"), first)),
        }
        let mut point = [0.0; 3];
        let mut count = 0;
        let close = loop {
            let word = self.words.next();
            match word.kind {
                Kind::Text => {
                    let value = self.number(word)?;
                    if let Some(slot) = point.get_mut(count) {
                        *slot = value;
                    }
                    count += 1;
                }
                Kind::Close if count == 0 => break word,
                Kind::End => return Err(self.unclosed(first, &format!("{of} of {what}"))),
                _ => return Err(self.expected("a coordinate", word)),
            }
            let word = self.words.next();
            match word.kind {
                Kind::Comma => {}
                Kind::Close => break word,
                Kind::End => return Err(self.unclosed(first, &format!("{of} of {what}"))),
                Kind::Text if count < 3 => return Err(self.expected("`,` before the next coordinate", word)),
                _ => return Err(self.expected(&format!("the `)` of {of} of {what}"), word)),
            }
        };
        let place = first.place.to(close.place);
        if count != 3 {
            let s = if count == 1 { "" } else { "s" };
            let message = format!("{of} of {what} has {count} coordinate{s} and not three");
            let fault = Fault::error(self.text, place, message);
            return Err(if count == 2 { fault.help("a planar curve has z = 0: `(x,y,0)`") } else { fault });
        }
        Ok((point, place))
    }

    pub(super) fn number(&self, word: Word<'_>) -> Parsed<f64> {
        match word.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.fault(word, format!("the number {} is not finite", quote(word.text)))),
            Err(_) => {
                let fault = self.fault(word, format!("{} is not a number", quote(word.text)));
                Err(match word.text.chars().next() {
                    Some('\u{2212}' | '\u{2013}' | '\u{2014}') => {
                        fault.help("this is a typographic minus sign: write the `-` of the keyboard")
                    }
                    _ => fault,
                })
            }
        }
    }
}
