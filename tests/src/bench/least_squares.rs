//! Ceres on the same sums of squares, from the same start, to the same end: which of its ways is the fastest, and how fast.
//!
//! A way is a linear solver with derivatives by hand or by jets, in the linear or in the thesis's parametrisation, and a
//! strategy. For each the least number of iterations is found that is enough; with exactly that it is timed, from a problem
//! that is built already. To choose the best way case by case is more than a user can do.

use super::WITHIN;
use super::ours::loosest;
use super::peer::Peer;
use super::record::Record;
use super::rounds::race;
use super::task::Task;
use crate::appendix::figure;
use crate::compare::{SETS, reference};
use crate::curves::times;
use minvar::curve::Element;

/// The peer's name.
pub const NAME: &str = "ceres";
/// Iterations that are tried.
const MOST: usize = 2000;
/// A way that takes longer than the fastest by this factor is not timed in rounds.
const OUT_OF_THE_RACE: f64 = 3.0;
/// How far jets, derivatives by hand and differences may be apart. The differences' own error is counted by its millionth.
const SAME_JACOBIAN: f64 = 1e-12;

/// A way to use Ceres, and how far it comes.
struct Way {
    name: String,
    iterations: usize,
    value: f64,
    /// Microseconds: no more than it takes, as steps that are refused take less; once it is timed, what it took.
    estimate: f64,
    reached: bool,
    races: bool,
    note: String,
}

/// Every set of Appendix A that has a minimum.
///
/// # Errors
///
/// Those of the peer, and of a check that fails.
///
/// # Panics
///
/// If minvar or the reference refuses the data.
pub fn run(peer: &mut Peer, mut done: impl FnMut(Vec<Record>)) -> Result<(), String> {
    for (id, functional) in SETS {
        let figure = figure(id);
        let task = Task::of_set(short_name(id), &figure, functional);
        let polished = reference(&figure, functional, 1);
        let polished: Vec<Element> = polished
            .rows
            .iter()
            .map(|rows| Element { rows: rows.map(|row| times(row, 1.0 / task.unit)) })
            .collect();
        done(case(&task, &polished, peer)?);
    }
    Ok(())
}

fn short_name(id: &str) -> String {
    let name = match id {
        "4.2" => "wicket",
        "4.9-1" => "loop",
        "4.9-2" => "no loop",
        "4.10-1" => "G2 box",
        "4.10-2" => "G1 box",
        "4.11" => "Woodford",
        "4.13" => "S curve",
        "4.16" => "space curve",
        "4.21" => "Peters' helix",
        "4.22" => "coving",
        _ => "",
    };
    format!("{id} {name}")
}

fn case(task: &Task, polished: &[Element], peer: &mut Peer) -> Result<Vec<Record>, String> {
    let (report, best) = task.solve(&task.options(0.0));
    let sum = report.value;
    task.hand_to(peer, &best)?;
    for value in peer.numbers("value")? {
        task.same_value("the peer's sum of squares at minvar's curve", value, sum)?;
    }
    task.same_value("the functional of minvar's curve, evaluated apart,", task.value(&best), sum)?;

    let start = task.start();
    task.hand_to(peer, &start)?;
    for value in peer.numbers("value")? {
        task.same_value("the peer's sum of squares at the start", value, task.value(&start))?;
    }
    let apart = peer.numbers("check")?;
    if !(apart[0] < SAME_JACOBIAN) {
        return Err(format!("{}: the peer's Jacobians differ by {:e}", task.name, apart[0]));
    }

    let mut minimum = sum;
    let polished_value = task.value(polished);
    if task.same_curve(polished, &best) && polished_value < minimum {
        minimum = polished_value;
    }
    let names: Vec<String> = peer.ask("variants")?.split_whitespace().map(str::to_owned).collect();
    let mut histories = Vec::new();
    for name in names {
        let history = History::of(&name, peer)?;
        // Who comes lower on the same curve sets the mark for all.
        let (iterations, least) = history.last();
        if least < minimum * (1.0 - WITHIN) {
            let (value, elements) = solution(task, &name, iterations, peer)?;
            if task.same_curve(&elements, &best) && task.seen_by_the_rule(&elements) {
                minimum = minimum.min(value);
            }
        }
        histories.push((name, history));
    }
    let mut ways: Vec<Way> = histories.iter().map(|(name, history)| history.way(name, minimum)).collect();
    let racers = choose(task, &mut ways, &best, minimum, peer)?;

    let asked = loosest(task, minimum);
    let commands: Vec<String> =
        ways[..racers].iter().map(|way| format!("time {} {}", way.name, way.iterations)).collect();
    let timings = race(task, asked.relative_decrease, peer, &commands)?;
    let mut records: Vec<Record> = ways
        .iter()
        .enumerate()
        .map(|(k, way)| Record {
            peer_excess: Some(way.value / minimum - 1.0),
            reached: way.reached,
            iterations: Some(way.iterations),
            minimum: task.in_caller_units(minimum),
            note: way.note.clone(),
            ..match timings.get(k) {
                Some(timing) => Record::new(task, NAME, &way.name, &asked, timing),
                None => Record::untimed(task, NAME, &way.name, &asked, way.estimate),
            }
        })
        .collect();
    let fastest =
        (0..racers).min_by(|&a, &b| records[a].ratio.partial_cmp(&records[b].ratio).expect("times"));
    if let Some(fastest) = fastest {
        records[fastest].counts = true;
    }
    Ok(records)
}

/// The values on the way, as iterations and values that were lower than all before.
struct History {
    microseconds_an_iteration: f64,
    values: Vec<(usize, f64)>,
}

impl History {
    fn of(name: &str, peer: &mut Peer) -> Result<Self, String> {
        let answer = peer.numbers(&format!("history {name} {MOST}"))?;
        let [microseconds, iterations, rest @ ..] = &answer[..] else {
            return Err(format!("no history of {name}"));
        };
        let values: Vec<(usize, f64)> =
            rest.chunks_exact(2).map(|pair| (pair[0] as usize, pair[1])).collect();
        if values.is_empty() {
            return Err(format!("{name} has not even a start"));
        }
        Ok(Self { microseconds_an_iteration: microseconds / (iterations + 1.0), values })
    }

    fn last(&self) -> (usize, f64) {
        self.values[self.values.len() - 1]
    }

    /// As many iterations as are enough; if none are, as many as come as near to the end of the history.
    fn way(&self, name: &str, minimum: f64) -> Way {
        let within = |mark: f64| self.values.iter().find(|(_, value)| *value <= mark * (1.0 + WITHIN));
        let enough = within(minimum);
        let &(iterations, value) = enough.or_else(|| within(self.last().1)).unwrap_or(&self.values[0]);
        Way {
            name: name.into(),
            iterations,
            value,
            estimate: self.microseconds_an_iteration * (iterations as f64 + 1.0),
            reached: enough.is_some(),
            races: false,
            note: String::new(),
        }
    }
}

/// Solves, and checks that the sum is that of the rows, and that these are a solution.
fn solution(
    task: &Task,
    name: &str,
    iterations: usize,
    peer: &mut Peer,
) -> Result<(f64, Vec<Element>), String> {
    let answer = peer.numbers(&format!("solve {name} {iterations}"))?;
    let (value, rows) = answer.split_first().ok_or("an empty solution")?;
    let elements: Vec<Element> = rows
        .chunks_exact(18)
        .map(|rows| Element { rows: std::array::from_fn(|row| std::array::from_fn(|c| rows[3 * row + c])) })
        .collect();
    if let Some(defect) = task.defect(&elements) {
        return Err(format!("{} by {name}: {defect}", task.name));
    }
    task.same_value(&format!("the sum of squares of {name}"), *value, task.value(&elements))?;
    Ok((*value, elements))
}

/// Puts those first that take part in the race, and returns how many they are: who reached the minimum and is not much
/// slower than the fastest; if nobody did, who came nearest to it.
fn choose(
    task: &Task,
    ways: &mut [Way],
    best: &[Element],
    minimum: f64,
    peer: &mut Peer,
) -> Result<usize, String> {
    let mut racers = heat(task, ways, best, peer, |way| way.reached)?;
    if let Some(way) = ways[..racers].iter().find(|way| way.value > minimum * (1.0 + 1.01 * WITHIN)) {
        return Err(format!("{} by {}: not what its history says", task.name, way.name));
    }
    if racers == 0 {
        let honest = ways.iter().filter(|way| way.note.is_empty());
        let nearest = honest.map(|way| way.value).fold(f64::INFINITY, f64::min);
        // Each stopped within this of its own end.
        racers = heat(task, ways, best, peer, |way| way.value <= nearest * (1.0 + 2.0 * WITHIN))?;
    }
    Ok(racers)
}

/// Checks and times those that may take part, fastest first by what their history promises, until the rest is too slow;
/// puts the good ones first.
fn heat(
    task: &Task,
    ways: &mut [Way],
    best: &[Element],
    peer: &mut Peer,
    may: impl Fn(&Way) -> bool,
) -> Result<usize, String> {
    let mut limit = f64::INFINITY;
    ways.sort_by(|a, b| a.estimate.total_cmp(&b.estimate));
    for way in ways.iter_mut() {
        if way.estimate > limit {
            break;
        }
        if !(way.note.is_empty() && may(way)) {
            continue;
        }
        let (value, elements) = solution(task, &way.name, way.iterations, peer)?;
        way.value = value;
        if !task.same_curve(&elements, best) {
            way.note = "another curve".into();
        } else if !task.seen_by_the_rule(&elements) {
            way.note = "cheats the rule".into();
        }
        way.races = way.note.is_empty();
        way.reached &= way.races;
        if way.races {
            way.estimate = peer.numbers(&format!("time {} {} 0.001", way.name, way.iterations))?[0];
            limit = limit.min(OUT_OF_THE_RACE * way.estimate);
        }
    }
    for way in ways.iter_mut() {
        way.races &= way.estimate <= limit;
    }
    ways.sort_by_key(|way| !way.races);
    Ok(ways.iter().filter(|way| way.races).count())
}
