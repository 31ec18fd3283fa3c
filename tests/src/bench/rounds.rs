//! Rounds: contenders take turns, minvar before each of them.

use super::ours::Solver;
use super::peer::Peer;
use super::task::Task;

/// How many rounds there are.
pub const ROUNDS: usize = 15;
/// The least time that a contender repeats its work for in a round.
const SECONDS: f64 = 0.005;

/// Medians over the rounds.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    /// Microseconds of minvar, asked for no more than is compared.
    pub minvar: f64,
    /// Microseconds of minvar at its defaults.
    pub minvar_default: f64,
    /// Microseconds of the peer, at its best.
    pub peer: f64,
    /// Microseconds of the peer with what a user has to do besides, where it was measured apart.
    pub peer_whole: Option<f64>,
    /// The median of the ratios of the peer to minvar within a round.
    pub ratio: f64,
}

/// Times a peer's ways to do a task: `commands` are completed by the seconds and answered by microseconds.
///
/// # Errors
///
/// Those of the peer.
pub fn race(
    task: &Task,
    relative_decrease: f64,
    peer: &mut Peer,
    commands: &[String],
) -> Result<Vec<Timing>, String> {
    let mut ours = Solver::new(task, &task.options(relative_decrease));
    let mut ours_default = Solver::new(task, &task.default_options());
    let mut defaults = Vec::new();
    let mut samples = vec![Vec::new(); commands.len()];
    for _ in 0..ROUNDS {
        defaults.push(ours_default.time(SECONDS));
        for (command, samples) in commands.iter().zip(&mut samples) {
            let minvar = ours.time(SECONDS);
            let answer = peer.numbers(&format!("{command} {SECONDS}"))?;
            let solving = *answer.first().ok_or_else(|| format!("no time for {command}"))?;
            samples.push((minvar, solving, answer.get(1).copied()));
        }
    }
    let minvar_default = median(defaults);
    Ok(samples
        .into_iter()
        .map(|samples| Timing {
            minvar: median(samples.iter().map(|s| s.0).collect()),
            minvar_default,
            peer: median(samples.iter().map(|s| s.1).collect()),
            peer_whole: samples[0].2.map(|_| median(samples.iter().filter_map(|s| s.2).collect())),
            ratio: median(samples.iter().map(|s| s.1 / s.0).collect()),
        })
        .collect())
}

/// The median.
pub(super) fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    let middle = of.len() / 2;
    if of.len() % 2 == 1 { of[middle] } else { 0.5 * (of[middle - 1] + of[middle]) }
}
