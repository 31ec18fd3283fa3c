//! What came out: a line of JSON a case and contender, a table, and means.

#![allow(clippy::disallowed_methods, reason = "a mean may use the platform's logarithm")]

use super::ours::Asked;
use super::rounds::Timing;
use super::task::Task;
use serde::Serialize;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// A contender in a case.
#[derive(Clone, Debug, Serialize)]
pub struct Record {
    /// The case.
    pub case: String,
    /// `mvc` or `mec`.
    pub functional: &'static str,
    /// The peer.
    pub peer: &'static str,
    /// The way it was used.
    pub variant: String,
    /// Microseconds of minvar, asked for no more than is compared.
    pub minvar_us: Option<f64>,
    /// Microseconds of the peer.
    pub peer_us: f64,
    /// Peer to minvar: above one, minvar is faster. None where the contender was too slow to be timed in rounds.
    pub ratio: Option<f64>,
    /// By how much minvar's functional exceeds the minimum, as a fraction of it.
    pub minvar_excess: f64,
    /// The same of the peer; none if it gave nothing.
    pub peer_excess: Option<f64>,
    /// Whether the peer did what is compared. If not, its time is that of its best effort, and the ratio a lower bound.
    pub reached: bool,
    /// Whether minvar did.
    pub minvar_reached: bool,
    /// Whether this is the variant that counts for its peer in this case.
    pub counts: bool,
    /// The `relative_decrease` that minvar was asked for.
    pub minvar_relative_decrease: f64,
    /// Microseconds of minvar at its defaults.
    pub minvar_default_us: Option<f64>,
    /// Microseconds of the peer with what a user has to do besides (building the problem, writing curves).
    pub peer_whole_us: Option<f64>,
    /// The peer's iterations.
    pub iterations: Option<usize>,
    /// The functional's least known value.
    pub minimum: f64,
    /// What is to be said about it.
    pub note: String,
}

impl Record {
    /// A record of what the peer was measured to do.
    pub fn new(task: &Task, peer: &'static str, variant: &str, asked: &Asked, timing: &Timing) -> Self {
        Self {
            minvar_us: Some(timing.minvar),
            ratio: Some(timing.ratio),
            minvar_default_us: Some(timing.minvar_default),
            peer_whole_us: timing.peer_whole,
            ..Self::untimed(task, peer, variant, asked, timing.peer)
        }
    }

    /// A record of a contender that did not take part in the rounds.
    pub fn untimed(task: &Task, peer: &'static str, variant: &str, asked: &Asked, peer_us: f64) -> Self {
        Self {
            case: task.name.clone(),
            functional: task.functional_name(),
            peer,
            variant: variant.into(),
            minvar_us: None,
            peer_us,
            ratio: None,
            minvar_excess: asked.excess,
            peer_excess: None,
            reached: false,
            minvar_reached: asked.reached,
            counts: false,
            minvar_relative_decrease: asked.relative_decrease,
            minvar_default_us: None,
            peer_whole_us: None,
            iterations: None,
            minimum: f64::NAN,
            note: String::new(),
        }
    }

    /// The record as a row of the table.
    pub fn row(&self) -> String {
        let us = |x: Option<f64>| x.map_or_else(|| "–".into(), |x| format!("{x:.1}"));
        format!(
            "| {:24} | {:3} | {:11} | {:34} | {:>5} | {:>9} | {:>9} | {:>9} | {:>9} | {:>8} | {:>9} | {:>9} | {}",
            self.case,
            self.functional,
            self.peer,
            self.variant,
            self.iterations.map_or_else(|| "–".into(), |k| k.to_string()),
            us(Some(self.peer_us)),
            us(self.peer_whole_us),
            us(self.minvar_us),
            us(self.minvar_default_us),
            self.ratio.map_or_else(
                || "–".into(),
                |r| if self.reached { format!("{r:.3}") } else { format!("≥ {r:.3}") }
            ),
            self.peer_excess.map_or_else(|| "–".into(), |x| format!("{x:.1e}")),
            format!("{:.1e}", self.minvar_excess),
            self.note
        )
    }
}

/// The head of the table.
pub fn head() -> String {
    format!(
        "| {:24} | {:3} | {:11} | {:34} | {:>5} | {:>9} | {:>9} | {:>9} | {:>9} | {:>8} | {:>9} | {:>9} |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
        "case",
        "",
        "peer",
        "variant",
        "iter.",
        "peer µs",
        "whole µs",
        "minvar µs",
        "default",
        "ratio",
        "peer exc.",
        "our exc."
    )
}

/// Writes all records, a line each.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write(records: &[Record], to: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", to.display());
    let mut file = File::create(to).map_err(failed)?;
    for record in records {
        let line = serde_json::to_string(record).map_err(|error| error.to_string())?;
        writeln!(file, "{line}").map_err(failed)?;
    }
    Ok(())
}

/// The geometric mean of the ratios, and of how many.
pub fn mean<'a>(records: impl Iterator<Item = &'a Record>) -> (f64, usize) {
    let logarithms: Vec<f64> = records.filter_map(|record| record.ratio).map(f64::ln).collect();
    ((logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp(), logarithms.len())
}
