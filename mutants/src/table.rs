//! The outcome: a table by layer, and the list of what survived.

use crate::judged::{Judged, Labels};
use crate::list::Mutant;
use crate::problem::Problem;
use crate::run::{Outcome, Results};
use crate::tree::Tree;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

#[derive(Clone, Copy, Default)]
struct Row {
    mutants: usize,
    refused: usize,
    elsewhere: usize,
    caught: usize,
    timed_out: usize,
    survived: usize,
    unreached: usize,
    /// Of those two, the ones that were judged.
    judged: usize,
}

impl Row {
    fn run(&self) -> usize {
        self.caught + self.timed_out + self.survived + self.unreached
    }

    fn line(&self, name: &str) -> String {
        let Row { mutants, refused, elsewhere, caught, timed_out, survived, unreached, judged } = *self;
        let share = |run: usize| match run {
            0 => "–".to_owned(),
            run => {
                // What a sample tells of the whole: within twice the standard deviation.
                let part = (caught + timed_out) as f64 / run as f64;
                let all = mutants - refused - elsewhere;
                let unseen = (all - self.run().min(all)) as f64 / all.max(1) as f64;
                let spread = 200.0 * (part * (1.0 - part) / run as f64 * unseen).sqrt();
                if unseen > 0.0 {
                    format!("{:.1} ± {spread:.1}", 100.0 * part)
                } else {
                    format!("{:.1}", 100.0 * part)
                }
            }
        };
        let run = self.run();
        format!(
            "| {name} | {mutants} | {refused} | {elsewhere} | {run} | {caught} | {timed_out} | {survived} | {unreached} | {} \
             | {judged} | {} |",
            share(run),
            share(run - judged)
        )
    }
}

/// The table in Markdown.
pub fn table(
    mutants: &[Mutant],
    tree: &Tree,
    results: &Results,
    labels: &Labels<'_>,
    judged: &Judged,
) -> String {
    let mut rows: BTreeMap<&str, Row> = BTreeMap::new();
    let mut total = Row::default();
    for mutant in mutants {
        let outcome = results.by_mutant.get(&mutant.name).map(|result| result.outcome);
        let is_judged = usize::from(judged.has(&labels.of(mutant)));
        for row in [rows.entry(mutant.layer()).or_default(), &mut total] {
            row.mutants += 1;
            match outcome {
                _ if tree.refused.contains(&mutant.id) => row.refused += 1,
                _ if tree.elsewhere.contains(&mutant.id) => row.elsewhere += 1,
                Some(Outcome::Refused) => row.refused += 1,
                Some(Outcome::Caught) => row.caught += 1,
                Some(Outcome::TimedOut) => row.timed_out += 1,
                Some(Outcome::Survived) => {
                    row.survived += 1;
                    row.judged += is_judged;
                }
                Some(Outcome::Unreached) => {
                    row.unreached += 1;
                    row.judged += is_judged;
                }
                None => {}
            }
        }
    }
    let mut out = String::from(
        "| layer | mutants | do not compile | not on this machine | run | caught | never end | survived | not reached \
         | noticed, of a hundred | judged | noticed of the others |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (layer, row) in &rows {
        let _ = writeln!(out, "{}", row.line(layer));
    }
    let _ = writeln!(out, "{}", total.line("all"));
    out
}

/// Writes what survived and is not judged, with the line of the source.
pub fn write_survivors(
    path: &Path,
    mutants: &[Mutant],
    results: &Results,
    labels: &Labels<'_>,
    judged: &Judged,
) -> Result<(), Problem> {
    let mut out = String::new();
    for mutant in mutants {
        let Some(result) = results.by_mutant.get(&mutant.name) else { continue };
        let how = match result.outcome {
            Outcome::Survived => "survived",
            Outcome::Unreached => "not reached",
            _ => continue,
        };
        let label = labels.of(mutant);
        if !judged.has(&label) {
            let _ = writeln!(out, "{how}, line {}:\n{label}", mutant.span.start.line);
        }
    }
    fs::write(path, out).map_err(Problem::with(path))
}
