//! The lines of the corpus: a name, a hash and how it ended.

/// One part of a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The case and its part.
    pub name: String,
    /// The hash of all its numbers, as it is printed.
    pub hash: String,
    /// The status or the error.
    pub outcome: String,
}

/// The lines of a text.
///
/// # Panics
///
/// If a line has not three words.
pub fn lines(text: &str) -> Vec<Line> {
    text.lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            [name, hash, outcome] => {
                Line { name: name.to_owned(), hash: hash.to_owned(), outcome: outcome.to_owned() }
            }
            _ => panic!("not `name hash outcome`: {line}"),
        })
        .collect()
}

/// The names of the parts that differ or are missing on either side, in order.
pub fn differing(expected: &[Line], found: &[Line]) -> Vec<String> {
    let missing = |lines: &[Line], others: &[Line]| -> Vec<String> {
        lines.iter().filter(|line| !others.contains(line)).map(|line| line.name.clone()).collect()
    };
    let mut names = missing(expected, found);
    for name in missing(found, expected) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}
