//! One mutant after the other under the tests that reach it, until one fails: first those that noticed its neighbours,
//! then the quick ones.

use crate::list::Mutant;
use crate::problem::Problem;
use crate::tests::{Ended, Test, Tests, run};
use crate::tree::Tree;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

/// Tests that take so many seconds (or less) together are run in one program each; then the next.
const TIERS: [f64; 5] = [0.05, 0.3, 1.0, 4.0, f64::INFINITY];
/// So many tests that noticed others of the file are run first, each by itself, if they take so many seconds at most.
const FAVOURITES: usize = 4;
const QUICK_FAVOURITE: f64 = 4.0;
/// A test that takes so many times longer than without the mutant, and this many seconds more, never ends.
const PATIENCE: f64 = 5.0;
const LEAST_PATIENCE: f64 = 3.0;

/// What the tests made of a mutant.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Outcome {
    Caught,
    /// A test did not end.
    TimedOut,
    Survived,
    /// No test reaches it, or none in a way that makes a difference.
    Unreached,
    /// It does not compile.
    Refused,
}

/// A line of the results.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Judged {
    pub kernel: String,
    pub mutant: String,
    pub outcome: Outcome,
    /// The program and the test that noticed.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub by: String,
    pub seconds: f64,
    /// The programs that did not notice, as they were, and how many seconds their longest test may have taken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passed: Vec<u64>,
    #[serde(default)]
    pub quick: Option<f64>,
}

impl Judged {
    /// What building anew found.
    pub fn rebuilt(kernel: &str, mutant: String, outcome: Outcome) -> Self {
        let by = "building anew".into();
        Self { kernel: kernel.into(), mutant, outcome, by, seconds: 0.0, passed: Vec::new(), quick: None }
    }
}

/// The results so far, in a file to which each is appended.
pub struct Results {
    path: PathBuf,
    kernel: String,
    pub by_mutant: BTreeMap<String, Judged>,
}

impl Results {
    /// Those of this kernel that a file has.
    pub fn read(path: PathBuf, kernel: &str) -> Self {
        let text = fs::read_to_string(&path).unwrap_or_default();
        let lines = text.lines().filter_map(|line| serde_json::from_str::<Judged>(line).ok());
        let ours = lines.filter(|result| result.kernel == kernel);
        let by_mutant = ours.map(|result| (result.mutant.clone(), result)).collect();
        Self { path, kernel: kernel.to_owned(), by_mutant }
    }

    /// Keeps one more.
    pub fn add(&mut self, result: Judged) -> Result<(), Problem> {
        let line = serde_json::to_string(&result).expect("plain data");
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .map_err(Problem::with(&self.path))?;
        writeln!(file, "{line}").map_err(Problem::with(&self.path))?;
        self.by_mutant.insert(result.mutant.clone(), result);
        Ok(())
    }

    /// The tests that a mutant has still to be run under; none if its outcome is known.
    fn open<'a>(&self, mutant: &Mutant, reaching: Vec<&'a Test>, tests: &Tests) -> Option<Vec<&'a Test>> {
        let Some(known) = self.by_mutant.get(&mutant.name) else { return Some(reaching) };
        if matches!(known.outcome, Outcome::Caught | Outcome::TimedOut | Outcome::Refused) {
            return None;
        }
        let passed = |test: &&Test| {
            known.passed.contains(&tests.programs[test.program].key)
                && known.quick.is_none_or(|most| test.cost() <= most)
        };
        let left: Vec<&Test> = reaching.into_iter().filter(|test| !passed(test)).collect();
        (!left.is_empty()).then_some(left)
    }
}

/// Which tests noticed how many mutants, by the function and by the file of the mutants.
#[derive(Default)]
struct Noticed(BTreeMap<String, BTreeMap<String, usize>>);

impl Noticed {
    /// From the results so far.
    fn of(results: &Results) -> Self {
        let mut noticed = Self::default();
        for result in results.by_mutant.values().filter(|result| result.outcome == Outcome::Caught) {
            noticed.add(&result.mutant, &result.by);
        }
        noticed
    }

    /// A mutant's function in its file, and its file.
    fn places(mutant: &str) -> [String; 2] {
        let file = mutant.split(':').next().unwrap_or_default();
        let function = mutant.rsplit(' ').next().unwrap_or_default();
        [format!("{file} {function}"), file.to_owned()]
    }

    fn add(&mut self, mutant: &str, by: &str) {
        for place in Self::places(mutant) {
            *self.0.entry(place).or_default().entry(by.to_owned()).or_default() += 1;
        }
    }

    /// The tests to begin with.
    fn favourites<'a>(&self, mutant: &str, reaching: &[&'a Test], tests: &Tests) -> Vec<&'a Test> {
        let counts = Self::places(mutant).map(|place| self.0.get(&place));
        let mut known: Vec<([usize; 2], &Test)> = reaching
            .iter()
            .filter(|test| test.cost() <= QUICK_FAVOURITE)
            .map(|test| {
                let name = tests.full_name(test);
                (counts.map(|counts| counts.and_then(|by| by.get(&name)).copied().unwrap_or(0)), *test)
            })
            .filter(|(counts, _)| counts[1] > 0)
            .collect();
        known.sort_by(|(a, one), (b, other)| b.cmp(a).then(one.cost().total_cmp(&other.cost())));
        known.into_iter().take(FAVOURITES).map(|(_, test)| test).collect()
    }
}

/// How to run.
pub struct Way<'a> {
    pub jobs: usize,
    /// Only tests that take so many seconds at most.
    pub quick: Option<f64>,
    /// The folder for what programs say.
    pub work: &'a Path,
}

/// Runs mutants in this order.
pub fn run_all(
    mutants: &[&Mutant],
    tree: &Tree,
    tests: &Tests,
    results: &mut Results,
    way: &Way<'_>,
) -> Result<(), Problem> {
    let Way { jobs, quick, work } = *way;
    let mut reaching: BTreeMap<u32, Vec<&Test>> = BTreeMap::new();
    for test in tests.tests.iter().filter(|test| quick.is_none_or(|most| test.cost() <= most)) {
        for place in &test.reaches {
            reaching.entry(*place).or_default().push(test);
        }
    }
    for tests in reaching.values_mut() {
        tests.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    }
    let open: Vec<(&Mutant, Vec<&Test>)> = mutants
        .iter()
        .filter_map(|mutant| {
            let mark = tree.woven.get(&mutant.id)?;
            let reaching = reaching.get(mark).cloned().unwrap_or_default();
            Some((*mutant, results.open(mutant, reaching, tests)?))
        })
        .collect();
    eprintln!("{} mutants to run, {jobs} at a time; stop whenever you like and start again", open.len());

    let next = AtomicUsize::new(0);
    let began = Instant::now();
    let kernel = results.kernel.clone();
    let noticed = Mutex::new(Noticed::of(results));
    let kept = Mutex::new((results, 0_usize));
    let work_off = |job: usize| -> Result<(), Problem> {
        let said = work.join(format!("job{job}"));
        while let Some((mutant, reaching)) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
            let start = Instant::now();
            let favourites =
                noticed.lock().expect("no other thread panics").favourites(&mutant.name, reaching, tests);
            let (outcome, by) = judge(mutant, &favourites, reaching, tests, &said)?;
            if outcome == Outcome::Caught {
                noticed.lock().expect("no other thread panics").add(&mutant.name, &by);
            }
            let seconds = start.elapsed().as_secs_f64();
            let mut passed = Vec::new();
            if matches!(outcome, Outcome::Survived | Outcome::Unreached) {
                passed = tests.programs.iter().map(|program| program.key).collect();
            }
            let result = Judged {
                kernel: kernel.clone(),
                mutant: mutant.name.clone(),
                outcome,
                by,
                seconds,
                passed,
                quick,
            };
            let mut kept = kept.lock().expect("no other thread panics");
            kept.0.add(result)?;
            kept.1 += 1;
            if kept.1 % 100 == 0 || kept.1 == open.len() {
                eprintln!("  {} of {} after {:.0} s", kept.1, open.len(), began.elapsed().as_secs_f64());
            }
        }
        Ok(())
    };
    thread::scope(|scope| {
        let threads: Vec<_> = (0..jobs).map(|job| scope.spawn(move || work_off(job))).collect();
        threads.into_iter().try_for_each(|thread| thread.join().expect("no thread panics"))
    })
}

/// Runs a mutant under the favourites, then under the others of these tests, which stand in the order of their cost.
fn judge(
    mutant: &Mutant,
    favourites: &[&Test],
    reaching: &[&Test],
    tests: &Tests,
    said: &Path,
) -> Result<(Outcome, String), Problem> {
    if reaching.is_empty() {
        return Ok((Outcome::Unreached, String::new()));
    }
    let is_favourite = |test: &Test| favourites.iter().any(|one| std::ptr::eq(*one, test));
    let others: Vec<&Test> = reaching.iter().copied().filter(|test| !is_favourite(test)).collect();
    let mut batches: Vec<Vec<&Test>> = favourites.iter().map(|test| vec![*test]).collect();
    let cost = |tests: &[&Test]| tests.iter().map(|test| test.cost()).sum::<f64>();
    let mut rest = others.as_slice();
    for tier in TIERS {
        let (now, later) = rest.split_at(rest.partition_point(|test| test.cost() <= tier));
        rest = later;
        let mut by_program: BTreeMap<usize, Vec<&Test>> = BTreeMap::new();
        for test in now {
            by_program.entry(test.program).or_default().push(test);
        }
        let mut of_tier: Vec<_> = by_program.into_values().collect();
        of_tier.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        batches.extend(of_tier);
    }
    for batch in batches {
        let limit = (PATIENCE * cost(&batch) + LEAST_PATIENCE).ceil() as u64;
        let names: Vec<&str> = batch.iter().map(|test| test.name.as_str()).collect();
        let program = &tests.programs[batch[0].program];
        let by = |test: String| format!("{} {test}", program.name);
        match run(program, &names, mutant.id, limit, said)? {
            Ended::Passed => {}
            Ended::Failed(test) => return Ok((Outcome::Caught, by(test))),
            Ended::TimedOut(test) => return Ok((Outcome::TimedOut, by(test))),
        }
    }
    Ok((Outcome::Survived, String::new()))
}
