//! The mutants that no test can notice, or none need notice: `mutants/judged.md` says which, and why.
//!
//! A mutant stands there by its file, what it changes in which function, and the line with the change between « and »,
//! so that lines may move. What the tests do notice, or what is not there any more, must be struck out.

use crate::list::Mutant;
use crate::problem::Problem;
use crate::run::{Outcome, Results};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The names of mutants that do not change when lines move.
pub struct Labels<'a> {
    sources: BTreeMap<&'a str, Vec<String>>,
}

impl<'a> Labels<'a> {
    /// Reads the files that have mutants.
    pub fn read(repository: &Path, mutants: &'a [Mutant]) -> Result<Self, Problem> {
        let mut sources = BTreeMap::new();
        for mutant in mutants {
            if !sources.contains_key(mutant.file.as_str()) {
                let path = repository.join(&mutant.file);
                let text = fs::read_to_string(&path).map_err(Problem::with(&path))?;
                sources.insert(mutant.file.as_str(), text.lines().map(str::to_owned).collect());
            }
        }
        Ok(Self { sources })
    }

    /// Two lines: the change, and where.
    pub fn of(&self, mutant: &Mutant) -> String {
        let change = mutant.name.splitn(4, ':').nth(3).unwrap_or(&mutant.name);
        let line =
            self.sources.get(mutant.file.as_str()).and_then(|lines| lines.get(mutant.span.start.line - 1));
        let line = line.map_or("", |line| line.as_str());
        let ends_here = mutant.span.end.line == mutant.span.start.line;
        let end = if ends_here { mutant.span.end.column - 1 } else { usize::MAX };
        let mut marked = String::new();
        for (at, c) in line.chars().chain([' ']).enumerate() {
            if at == mutant.span.start.column - 1 {
                marked.push('«');
            }
            if at == end {
                marked.push('»');
            }
            marked.push(c);
        }
        format!("{}:{change}\n    {}", mutant.file, marked.trim())
    }
}

/// What stands in the list.
pub struct Judged(BTreeSet<String>);

impl Judged {
    pub fn read(path: &Path) -> Result<Self, Problem> {
        Ok(Self::of(&fs::read_to_string(path).map_err(Problem::with(path))?))
    }

    fn of(text: &str) -> Self {
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        let pairs =
            lines.windows(2).filter(|pair| pair[0].starts_with("kernel/") && pair[1].starts_with("    "));
        Self(pairs.map(|pair| pair.join("\n")).collect())
    }

    pub fn has(&self, label: &str) -> bool {
        self.0.contains(label)
    }

    /// Those that are wrongly in the list, with the reason.
    pub fn wrong(&self, mutants: &[Mutant], labels: &Labels<'_>, results: &Results) -> Vec<String> {
        let mut there: BTreeMap<String, Vec<&Mutant>> = BTreeMap::new();
        for mutant in mutants {
            there.entry(labels.of(mutant)).or_default().push(mutant);
        }
        let outcome = |mutant: &&Mutant| results.by_mutant.get(&mutant.name).map(|result| result.outcome);
        let noticed = |mutant: &&Mutant| matches!(outcome(mutant), Some(Outcome::Caught | Outcome::TimedOut));
        let of = |label: &String| match there.get(label) {
            None => Some(format!("there is no such mutant: {label}")),
            Some(mutants) if mutants.iter().all(noticed) => Some(format!("it is noticed: {label}")),
            Some(_) => None,
        };
        self.0.iter().filter_map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::{Genre, Place, Span};

    #[test]
    fn a_label_marks_the_change_and_not_the_line() {
        let place = |line, column| Place { line, column };
        let mutant = Mutant {
            id: 1,
            name: "kernel/src/a.rs:2:10: replace < with <= in f".into(),
            file: "kernel/src/a.rs".into(),
            genre: Genre::BinaryOperator,
            replacement: "<=".into(),
            span: Span { start: place(2, 10), end: place(2, 11) },
        };
        let lines = ["fn f() {", "    if a < b {"].map(str::to_owned).to_vec();
        let labels = Labels { sources: BTreeMap::from([("kernel/src/a.rs", lines)]) };
        let label = labels.of(&mutant);
        assert_eq!(label, "kernel/src/a.rs: replace < with <= in f\n    if a «<» b {");
        let judged = Judged::of(&format!("# Why\n\n```\n{label}\n```\n"));
        assert!(judged.has(&label) && judged.0.len() == 1);
    }
}
