//! Thousands of random problems solved and judged: `make random`.
//!
//! `random [--count N] [--seed N] [--functional mvc,mec] [--only K] [--list] [--images none|one|all] [--examine N]
//! [--threads N] [--elements-per-span N] [--spiro PROGRAM] [--occt PROGRAM]`
//!
//! Every result is judged by itself. Besides, each problem is solved moved, scaled, turned, reversed or restarted:
//! once, by its number, or in all these ways, or not. Of each status but *converged*, `--examine` results are looked at
//! for a minimum that other ways find. The peers are built from `tests/peers`.
//!
//! With `--only K` the problem is solved, judged and written as a constraint file to the standard output, for
//! `minvar curve FILE --svg PICTURE`. Exit status 1: a promise was broken; 2: wrong arguments.

use minvar::curve::{Functional, Options};
use minvar::solve::Status;
use minvar_tests::curves::solve_curve;
use minvar_tests::random::finding::{Check, Findings};
use minvar_tests::random::invariance::{Comparison, Image, Solved};
use minvar_tests::random::measured::{FUNCTIONALS, measure, name};
use minvar_tests::random::problem::Problem;
use minvar_tests::random::run::{Images, Outcome, image_dice, run};
use minvar_tests::random::{mvc, peers, table, truth};
use std::cell::Cell;
use std::io::{IsTerminal, stderr};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{available_parallelism, scope};

struct Arguments {
    count: u64,
    seed: u64,
    only: Option<u64>,
    functionals: Vec<Functional>,
    list: bool,
    images: Images,
    examine: usize,
    threads: usize,
    elements_per_span: u32,
    spiro: Option<String>,
    occt: Option<String>,
}

impl Arguments {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut parsed = Self {
            count: 20_000,
            seed: 1,
            only: None,
            functionals: FUNCTIONALS.iter().map(|&(_, f)| f).filter(|f| f.is_known()).collect(),
            list: false,
            images: Images::One,
            examine: 50,
            threads: available_parallelism().map_or(1, Into::into),
            elements_per_span: 1,
            spiro: None,
            occt: None,
        };
        while let Some(word) = words.next() {
            match word.as_str() {
                "--list" => parsed.list = true,
                _ => {
                    let value = words.next().ok_or_else(|| format!("{word} wants a value"))?;
                    let number = || value.parse::<u64>().map_err(|_| format!("{word} {value}: no number"));
                    match word.as_str() {
                        "--count" => parsed.count = number()?,
                        "--seed" => parsed.seed = number()?,
                        "--only" => parsed.only = Some(number()?),
                        "--threads" => parsed.threads = number()?.max(1) as usize,
                        "--elements-per-span" => parsed.elements_per_span = number()? as u32,
                        "--spiro" => parsed.spiro = Some(value),
                        "--occt" => parsed.occt = Some(value),
                        "--examine" => parsed.examine = number()? as usize,
                        "--images" => {
                            parsed.images = match value.as_str() {
                                "none" => Images::None,
                                "one" => Images::One,
                                "all" => Images::All,
                                _ => return Err(format!("--images {value}: none, one or all")),
                            }
                        }
                        "--functional" => parsed.functionals = functionals(&value)?,
                        _ => return Err(format!("unknown option {word}")),
                    }
                }
            }
        }
        Ok(parsed)
    }

    fn options(&self, functional: Functional) -> Options {
        Options { functional, elements_per_span: self.elements_per_span, ..Options::DEFAULT }
    }
}

/// Names or codes, separated by commas.
fn functionals(words: &str) -> Result<Vec<Functional>, String> {
    words
        .split(',')
        .map(|word| {
            let named = FUNCTIONALS.iter().find(|(name, _)| *name == word).map(|&(_, functional)| functional);
            let coded = || word.parse().ok().map(Functional);
            named
                .or_else(coded)
                .filter(|functional| functional.is_known())
                .ok_or_else(|| format!("unknown functional {word}"))
        })
        .collect()
}

thread_local! {
    /// What this thread is at: a panic ends the program, and must say where.
    static AT: Cell<(u64, u64, u32)> = const { Cell::new((0, 0, 0)) };
}

fn main() -> ExitCode {
    let arguments = match Arguments::parse(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    std::panic::set_hook(Box::new(|panic| {
        let (seed, index, functional) = AT.get();
        eprintln!("{panic}");
        eprintln!("Panic: random --seed {seed} --only {index} --functional {functional}");
    }));
    match arguments.only {
        Some(index) => one(&arguments, index),
        None => many(&arguments),
    }
}

/// Solves one problem, prints what was found as comments, then its file.
fn one(arguments: &Arguments, index: u64) -> ExitCode {
    let problem = Problem::new(arguments.seed, index);
    let mut comment = format!(
        "random --seed {} --only {index}: {:?}, {}, placed {:?}\n",
        arguments.seed,
        problem.family,
        if problem.planar { "planar" } else { "space" },
        problem.place
    );
    let mut broken = false;
    for &functional in &arguments.functionals {
        let options = arguments.options(functional);
        let outcome = run(arguments.seed, index, &options, Images::All);
        comment += &format!("{}:\n", name(functional));
        match solve_curve(&problem.joints, problem.closed, &options) {
            Ok((report, elements)) => {
                let measured = measure(&elements);
                comment += &format!("{report:?}\nmeasured {:e} {measured:?}\n", measured.value(functional));
                let base = Solved { report, elements, measured };
                let comparison = Comparison::new(&problem, &options, &base);
                if let Some(near) = comparison.near() {
                    comment += &format!("near: {:?}\n", near.report);
                }
                for (i, image) in Image::ALL.into_iter().enumerate() {
                    let mut dice = image_dice(arguments.seed, index, i);
                    if let Some(report) = comparison.with(image, &mut dice, &mut Findings::default()) {
                        comment += &format!("{image:?}: {report:?}\n");
                    }
                }
                if base.report.status != Status::Converged {
                    comment += &format!("{:?}\n", truth::examine(&problem, &options));
                }
            }
            Err(error) => comment += &format!("refused: {error}\n"),
        }
        for check in Check::ALL {
            if let Some(size) = outcome.findings.of(check).filter(|size| *size > 0.0) {
                let verdict = if outcome.findings.beyond(check) { " beyond what is allowed" } else { "" };
                comment += &format!("{check:?} {size:.2e}{verdict}\n");
                broken |= check.is_promise() && outcome.findings.beyond(check);
            }
        }
    }
    print!("{}", mvc::write(&problem, &comment));
    if broken { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Calls `work` for every index below `count`, on several threads, and collects what it returns.
fn on_threads<T: Send>(threads: usize, count: u64, work: impl Fn(u64) -> Vec<T> + Sync) -> Vec<T> {
    let (found, next) = (Mutex::new(Vec::new()), AtomicU64::new(0));
    scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        return;
                    }
                    if index % 100 == 0 && stderr().is_terminal() {
                        eprint!("\r{index} of {count} ");
                    }
                    let more = work(index);
                    found.lock().expect("a panic ends the program").extend(more);
                }
            });
        }
    });
    found.into_inner().expect("a panic ends the program")
}

fn many(arguments: &Arguments) -> ExitCode {
    let seed = arguments.seed;
    let mut outcomes: Vec<Outcome> = on_threads(arguments.threads, arguments.count, |index| {
        let solved = |&functional: &Functional| {
            AT.set((seed, index, functional.0));
            run(seed, index, &arguments.options(functional), arguments.images)
        };
        arguments.functionals.iter().map(solved).collect()
    });
    outcomes.sort_by_key(|outcome| (outcome.index, outcome.functional.0));
    println!("{} problems of seed {seed}\n", arguments.count);
    table::families(&outcomes);
    println!();
    examine(arguments, &mut outcomes);
    println!();
    table::checks(&outcomes, seed);
    if arguments.list {
        println!();
        table::list(&outcomes, seed);
    }
    type Peer = fn(&str, u64, &[Outcome]) -> Result<(), String>;
    for (program, peer) in [(&arguments.spiro, peers::spiro as Peer), (&arguments.occt, peers::occt)] {
        if let Some(program) = program {
            println!();
            if let Err(message) = peer(program, seed, &outcomes) {
                eprintln!("{message}");
                return ExitCode::from(2);
            }
        }
    }
    let broken = table::broken(&outcomes);
    println!("\n{broken} results break a promise");
    if broken > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Looks for minima where none was found, and for lower ones where one was: at some results of each functional and status,
/// gentle data first.
fn examine(arguments: &Arguments, outcomes: &mut [Outcome]) {
    let mut chosen: Vec<usize> = Vec::new();
    for &functional in &arguments.functionals {
        for status in [Status::Converged, Status::Unbounded, Status::Stalled, Status::IterationLimit] {
            let of = |gentle: bool| {
                let outcomes = &*outcomes;
                (0..outcomes.len()).filter(move |&i| {
                    let o = &outcomes[i];
                    o.functional == functional && o.status == status && o.gentle == gentle && !o.infimum
                })
            };
            chosen.extend(of(true).chain(of(false)).take(arguments.examine));
        }
    }
    let found = on_threads(arguments.threads, chosen.len() as u64, |k| {
        let at = chosen[k as usize];
        let outcome = &outcomes[at];
        AT.set((arguments.seed, outcome.index, outcome.functional.0));
        let problem = Problem::new(arguments.seed, outcome.index);
        let options = arguments.options(outcome.functional);
        vec![if outcome.status == Status::Converged {
            (at, truth::excess(&problem, &options), None)
        } else {
            (at, None, Some(truth::examine(&problem, &options)))
        }]
    });
    let mut lost = Vec::new();
    for (at, excess, examined) in found {
        let outcome = &mut outcomes[at];
        if let Some(excess) = excess {
            outcome.findings.note(Check::Higher, excess);
        }
        if let Some(examined) = examined {
            let unbounded = outcome.status == Status::Unbounded;
            let check = if unbounded { Check::FalseUnbounded } else { Check::Missed };
            outcome.findings.must(check, !examined.has_minimum());
            lost.push((at, examined));
        }
    }
    lost.sort_by_key(|(at, _)| *at);
    table::examined(outcomes, &lost, arguments.seed);
}
