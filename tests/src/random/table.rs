//! What thousands of outcomes add up to.

use super::finding::Check;
use super::measured::name;
use super::run::Outcome;
use super::samples::Family;
use super::truth::Examined;
use minvar::solve::Status;

/// The value below which this share of the numbers lies.
fn quantile(mut numbers: Vec<f64>, share: f64) -> f64 {
    if numbers.is_empty() {
        return f64::NAN;
    }
    numbers.sort_by(f64::total_cmp);
    numbers[((numbers.len() - 1) as f64 * share).round() as usize]
}

fn row(title: &str, of: &[&Outcome]) {
    if of.is_empty() {
        return;
    }
    let count = of.len() as f64;
    let percent =
        |status: Status| 100.0 * of.iter().filter(|outcome| outcome.status == status).count() as f64 / count;
    let broken = of.iter().filter(|o| !keeps(o)).count();
    let numbers = |number: &dyn Fn(&Outcome) -> f64| of.iter().map(|o| number(o)).collect::<Vec<_>>();
    let iterations = numbers(&|o| o.iterations as f64);
    let work = numbers(&|o| o.linearisations as f64 / o.elements as f64);
    let time = numbers(&|o| 1e6 * o.seconds / o.joints as f64);
    println!(
        "| {title} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {broken} | {:.0} / {:.0} | {:.0} / {:.0} | {:.0} / {:.0} |",
        of.len(),
        percent(Status::Converged),
        percent(Status::Unbounded),
        percent(Status::Stalled),
        percent(Status::IterationLimit),
        quantile(iterations.clone(), 0.5),
        quantile(iterations, 0.99),
        quantile(work.clone(), 0.5),
        quantile(work, 0.99),
        quantile(time.clone(), 0.5),
        quantile(time, 0.99),
    );
}

/// Prints the outcomes by family and functional.
pub fn families(outcomes: &[Outcome]) {
    println!(
        "| family | count | converged % | unbounded % | stalled % | limit % | broken promises | iterations, median / 99 % | \
         linearisations an element | µs a joint |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut functionals: Vec<_> = outcomes.iter().map(|o| o.functional).collect();
    functionals.sort_by_key(|functional| functional.0);
    functionals.dedup();
    for functional in functionals {
        let of: Vec<&Outcome> = outcomes.iter().filter(|o| o.functional == functional).collect();
        for family in Family::ALL {
            let of: Vec<&Outcome> = of.iter().copied().filter(|o| o.family == family).collect();
            row(&format!("{family:?} {}", name(functional)), &of);
        }
        for (title, gentle) in [("gentle data", true), ("wild data", false)] {
            let of: Vec<&Outcome> = of.iter().copied().filter(|o| o.gentle == gentle && !o.infimum).collect();
            row(&format!("{}, {title}", name(functional)), &of);
        }
        let infimum: Vec<&Outcome> = of.iter().copied().filter(|o| o.infimum).collect();
        row(&format!("{}, data without a minimum", name(functional)), &infimum);
        row(&format!("all {}", name(functional)), &of);
    }
}

/// Prints what became of results that did not converge, and the minima that were found after all.
pub fn examined(outcomes: &[Outcome], found: &[(usize, Examined)], seed: u64) {
    println!(
        "| functional | status | looked at | minimum by minvar otherwise | by the reference | of them gentle data |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    let mut kinds: Vec<_> =
        found.iter().map(|&(at, _)| (outcomes[at].functional.0, outcomes[at].status)).collect();
    kinds.sort_by_key(|&(functional, status)| (functional, status as i32));
    kinds.dedup();
    for (functional, status) in kinds {
        let of: Vec<&(usize, Examined)> = found
            .iter()
            .filter(|&&(at, _)| (outcomes[at].functional.0, outcomes[at].status) == (functional, status))
            .collect();
        let count = |which: &dyn Fn(&Outcome, &Examined) -> bool| {
            of.iter().filter(|(at, examined)| which(&outcomes[*at], examined)).count()
        };
        println!(
            "| {} | {} | {} | {} | {} | {} |",
            name(outcomes[of[0].0].functional),
            status.name(),
            of.len(),
            count(&|_, examined| examined.own.is_some()),
            count(&|_, examined| matches!(examined.reference, Some(Ok(_)))),
            count(&|outcome, examined| outcome.gentle && examined.has_minimum()),
        );
    }
    println!();
    for (at, examined) in found {
        let outcome = &outcomes[*at];
        for minimum in examined.own.iter().chain(examined.reference.iter().flatten()) {
            println!(
                "{}, but {} finds {:.4e}, length {:.4}: random --seed {seed} --only {} --functional {}{}",
                outcome.status.name(),
                minimum.way,
                minimum.value,
                minimum.length,
                outcome.index,
                name(outcome.functional),
                if outcome.gentle { " (gentle data)" } else { "" },
            );
        }
    }
}

/// Prints what each check found.
pub fn checks(outcomes: &[Outcome], seed: u64) {
    println!("| check | kind | made | allowed | beyond | worst | where |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for check in Check::ALL {
        let made: Vec<(f64, &Outcome)> =
            outcomes.iter().filter_map(|o| Some((o.findings.of(check)?, o))).collect();
        let beyond = made.iter().filter(|(size, _)| *size > check.allowed()).count();
        let worst = made.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (size, place) = worst.filter(|worst| worst.0 > 0.0).map_or((0.0, String::new()), |&(size, o)| {
            (size, format!("--seed {seed} --only {} --functional {}", o.index, name(o.functional)))
        });
        println!(
            "| {check:?} | {} | {} | {:.0e} | {beyond} | {size:.1e} | {place} |",
            if check.is_promise() { "promise" } else { "counted" },
            made.len(),
            check.allowed(),
        );
    }
}

/// Prints a line for every finding beyond what is allowed: its size, then how to see it again.
pub fn list(outcomes: &[Outcome], seed: u64) {
    for check in Check::ALL {
        for outcome in outcomes.iter().filter(|outcome| outcome.findings.beyond(check)) {
            println!(
                "{check:?} {:.2e}: {} of {} joints, {}: random --seed {seed} --only {} --functional {}",
                outcome.findings.of(check).unwrap_or_default(),
                format!("{:?}", outcome.family).to_lowercase(),
                outcome.joints,
                outcome.status.name(),
                outcome.index,
                name(outcome.functional),
            );
        }
    }
    for outcome in outcomes.iter().filter(|o| matches!(o.status, Status::Stalled | Status::IterationLimit)) {
        println!(
            "{}: {} of {} joints: random --seed {seed} --only {} --functional {}",
            outcome.status.name(),
            format!("{:?}", outcome.family).to_lowercase(),
            outcome.joints,
            outcome.index,
            name(outcome.functional),
        );
    }
}

/// Whether a result keeps all promises.
pub fn keeps(outcome: &Outcome) -> bool {
    !Check::ALL.iter().any(|&check| check.is_promise() && outcome.findings.beyond(check))
}

/// How many outcomes break a promise.
pub fn broken(outcomes: &[Outcome]) -> usize {
    outcomes.iter().filter(|outcome| !keeps(outcome)).count()
}
