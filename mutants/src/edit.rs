//! A source text with parts rewritten, each part around parts of itself, and where in the result each came to stand.

use std::cmp::Reverse;
use std::ops::Range;

/// Whose a piece of the result is.
#[derive(Clone, Debug, PartialEq)]
pub enum Owner {
    /// This mutant's alone.
    Mutant(u32),
    /// That of all mutants of one place.
    Place(Vec<u32>),
}

/// What a part is rewritten to.
pub enum Piece {
    Text(String),
    /// Text that stands for one mutant.
    Of(u32, String),
    /// A part of the source, itself rewritten.
    Inner(Range<usize>),
}

struct Rewrite {
    range: Range<usize>,
    pieces: Vec<Piece>,
    mutants: Vec<u32>,
}

/// Rewrites of one text. They nest or lie apart; of two of the same range the one that was given first is outside.
#[derive(Default)]
pub struct Edits {
    rewrites: Vec<Rewrite>,
}

/// The result: its text, and whose which bytes are.
#[derive(Default)]
pub struct Edited {
    pub text: String,
    pub owners: Vec<(Range<usize>, Owner)>,
}

impl Edits {
    pub fn add(&mut self, range: Range<usize>, mutants: Vec<u32>, pieces: Vec<Piece>) {
        self.rewrites.push(Rewrite { range, pieces, mutants });
    }

    pub fn insert(&mut self, at: usize, mutants: Vec<u32>, pieces: Vec<Piece>) {
        self.add(at..at, mutants, pieces);
    }

    pub fn replace(&mut self, range: Range<usize>, text: &str) {
        self.add(range, Vec::new(), vec![Piece::Text(text.into())]);
    }

    /// The mutants that the rewrites carry.
    pub fn mutants(&self) -> impl Iterator<Item = u32> + '_ {
        self.rewrites.iter().flat_map(|rewrite| rewrite.mutants.iter().copied())
    }

    pub fn apply(mut self, source: &str) -> Edited {
        // What is inserted at a place comes before what is rewritten from there on.
        self.rewrites.sort_by_key(|rewrite| {
            let Range { start, end } = rewrite.range;
            (start, start != end, Reverse(end))
        });
        let mut edited = Edited::default();
        self.render(source, 0..source.len(), 0, &mut edited);
        edited
    }

    /// Writes a part of the source, with the rewrites from the one of this number on that lie in it.
    fn render(&self, source: &str, range: Range<usize>, from: usize, out: &mut Edited) {
        let mut at = range.start;
        let mut next =
            from + self.rewrites[from..].partition_point(|rewrite| rewrite.range.start < range.start);
        while let Some(rewrite) = self.rewrites.get(next).filter(|rewrite| rewrite.range.start < range.end) {
            if rewrite.range.end > range.end {
                next += 1;
                continue;
            }
            out.text.push_str(&source[at..rewrite.range.start]);
            let start = out.text.len();
            for piece in &rewrite.pieces {
                let start = out.text.len();
                match piece {
                    Piece::Text(text) => out.text.push_str(text),
                    Piece::Of(mutant, text) => {
                        out.text.push_str(text);
                        out.owners.push((start..out.text.len(), Owner::Mutant(*mutant)));
                    }
                    Piece::Inner(inner) => self.render(source, inner.clone(), next + 1, out),
                }
            }
            if !rewrite.mutants.is_empty() {
                out.owners.push((start..out.text.len(), Owner::Place(rewrite.mutants.clone())));
            }
            at = rewrite.range.end;
            next += 1;
            while self.rewrites.get(next).is_some_and(|inner| inner.range.start < at) {
                next += 1;
            }
        }
        out.text.push_str(&source[at..range.end]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rewrites_nest_and_move_what_is_inside() {
        let mut edits = Edits::default();
        let inner = |range| Piece::Inner(range);
        let text = |text: &str| Piece::Text(text.into());
        edits.add(
            0..9,
            vec![1],
            vec![text("<"), inner(8..9), text("|"), inner(0..5), Piece::Of(1, "!".into())],
        );
        edits.add(0..5, vec![], vec![inner(4..5), inner(0..1)]);
        edits.replace(8..9, "C");
        edits.insert(0, vec![], vec![text("^")]);
        let edited = edits.apply("a + b + c;");
        assert_eq!(edited.text, "^<C|ba!;");
        let whose =
            |owner: &Owner| edited.owners.iter().find(|(_, o)| o == owner).map(|(range, _)| range.clone());
        assert_eq!(whose(&Owner::Mutant(1)), Some(6..7));
        assert_eq!(whose(&Owner::Place(vec![1])), Some(1..7));
    }

    #[test]
    fn of_the_same_range_the_first_is_outside() {
        let mut edits = Edits::default();
        for mark in ["x", "y"] {
            edits.add(0..1, vec![], vec![Piece::Text(mark.into()), Piece::Inner(0..1)]);
        }
        assert_eq!(edits.apply("a").text, "xya");
    }
}
