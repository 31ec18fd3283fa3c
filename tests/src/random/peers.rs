//! The same problems for other programs: libspiro takes points in the plane, OpenCASCADE's `FairCurve_MinimalVariation`
//! two points with end tangents. Each reads problems as lines and answers in lines (`tests/peers`); all are given the
//! problem near the origin, where they do best.

use super::judge::polygon;
use super::problem::Problem;
use super::run::Outcome;
use super::samples::Family;
use crate::curves::{Vector, cross, distance, dot, gauss_legendre, norm, solve_curve, sub, times, unit};
use minvar::curve::{Curve, Functional, Given, Options};
use minvar::solve::Status;
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// What a peer answered to a problem.
struct Answer {
    index: u64,
    /// libspiro: 1 is success. OpenCASCADE: 0 is.
    code: i64,
    microseconds: f64,
    points: Vec<Vector>,
}

/// Runs a peer on lines of text.
fn ask(program: &str, lines: String) -> Result<Vec<Answer>, String> {
    let wrong = |error: std::io::Error| format!("{program}: {error}");
    let mut child =
        Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(wrong)?;
    let mut stdin = child.stdin.take().ok_or("no standard input")?;
    // Both pipes are finite: one thread writes while this one reads.
    let writer = std::thread::spawn(move || stdin.write_all(lines.as_bytes()));
    let output = child.wait_with_output().map_err(wrong)?;
    writer.join().map_err(|_| "the writer panicked")?.map_err(wrong)?;
    if !output.status.success() {
        return Err(format!("{program}: {}", output.status));
    }
    let text = String::from_utf8(output.stdout).map_err(|error| error.to_string())?;
    text.lines().map(|line| answer(line).ok_or_else(|| format!("{program} answered {line}"))).collect()
}

fn answer(line: &str) -> Option<Answer> {
    let mut words = line.split_whitespace();
    let index = words.next()?.parse().ok()?;
    let code = words.next()?.parse().ok()?;
    let microseconds = words.next()?.parse().ok()?;
    let count: usize = words.next()?.parse().ok()?;
    let numbers: Vec<f64> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let points: Vec<Vector> = numbers.chunks_exact(2).map(|p| [p[0], p[1], 0.0]).collect();
    (points.len() == count).then_some(Answer { index, code, microseconds, points })
}

/// The point and three derivatives of a Bézier curve at `t`, by de Casteljau on the differences.
fn bezier(poles: &[Vector], t: f64) -> [Vector; 4] {
    let mut differences = poles.to_vec();
    let mut factor = 1.0;
    let mut out = [[0.0; 3]; 4];
    for row in &mut out {
        let mut work = differences.clone();
        while work.len() > 1 {
            work =
                work.windows(2).map(|w| std::array::from_fn(|d| w[0][d] + (w[1][d] - w[0][d]) * t)).collect();
        }
        *row = work.first().map_or([0.0; 3], |&p| times(p, factor));
        factor *= differences.len().saturating_sub(1) as f64;
        differences = differences.windows(2).map(|w| sub(w[1], w[0])).collect();
    }
    out
}

/// The variation of curvature of a Bézier curve, by 64 points on each quarter.
fn variation(poles: &[Vector]) -> f64 {
    let rule = gauss_legendre(64);
    let mut sum = 0.0;
    for quarter in 0..4 {
        for &(t, weight) in &rule {
            let [_, d1, d2, d3] = bezier(poles, 0.25 * (f64::from(quarter) + t));
            let speed = norm(d1);
            let cube = speed * speed * speed;
            let by_parameter = sub(
                times(cross(d1, d3), 1.0 / cube),
                times(cross(d1, d2), 3.0 * dot(d1, d2) / (cube * speed * speed)),
            );
            sum += 0.25 * weight * dot(by_parameter, by_parameter) / speed;
        }
    }
    sum
}

fn length(poles: &[Vector]) -> f64 {
    let points: Vec<Vector> = (0..=200).map(|k| bezier(poles, f64::from(k) / 200.0)[0]).collect();
    points.windows(2).map(|w| distance(w[0], w[1])).sum()
}

/// The median.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A curve as long as this many polygons is none.
const WILD: f64 = 50.0;

fn line(who: &str, count: usize, numbers: [usize; 4], time: f64) {
    let share = |n: usize| 100.0 * n as f64 / count.max(1) as f64;
    let [said, true_, gentle, of_gentle] = numbers;
    println!(
        "| {who} | {count} | {:.2} | {:.2} | {:.2} | {time:.0} |",
        share(said),
        share(true_),
        100.0 * gentle as f64 / of_gentle.max(1) as f64,
    );
}

/// How minvar did on the same problems; converged and no broken promise counts as true.
fn ours(outcomes: &[&Outcome]) {
    let converged = |o: &&&Outcome| o.status == Status::Converged;
    let kept = |o: &&&Outcome| super::table::keeps(o);
    let said = outcomes.iter().filter(converged).count();
    let true_ = outcomes.iter().filter(converged).filter(kept).count();
    let gentle = outcomes.iter().filter(|o| o.gentle).filter(converged).filter(kept).count();
    let of_gentle = outcomes.iter().filter(|o| o.gentle).count();
    let time = median(outcomes.iter().map(|o| 1e6 * o.seconds).collect());
    line("minvar", outcomes.len(), [said, true_, gentle, of_gentle], time);
}

/// libspiro on the planar problems of points alone. True is what passes all points to 1e-6 of the size, is finite and
/// is not fifty times as long as the polygon.
///
/// # Errors
/// The program cannot be run or answers nonsense.
pub fn spiro(program: &str, seed: u64, outcomes: &[Outcome]) -> Result<(), String> {
    let mut lines = String::new();
    let mut asked: Vec<(&Outcome, Problem)> = Vec::new();
    for outcome in outcomes.iter().filter(|o| o.functional == Functional::MVC) {
        let problem = Problem::new(seed, outcome.index);
        if !(problem.planar && problem.points_only()) {
            continue;
        }
        let _ = write!(lines, "{} {} {}", outcome.index, i32::from(problem.closed), problem.plain.len());
        for joint in &problem.plain {
            let _ = write!(lines, " {:?} {:?}", joint.position.value[0], joint.position.value[1]);
        }
        lines.push('\n');
        asked.push((outcome, problem));
    }
    let answers = ask(program, lines)?;
    println!(
        "| points in the plane | problems | says it converged % | true % | true % of gentle data | µs, median |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    ours(&asked.iter().map(|(outcome, _)| *outcome).collect::<Vec<_>>());
    let [mut said, mut true_, mut gentle] = [0; 3];
    for (answer, (outcome, problem)) in answers.iter().zip(&asked) {
        if answer.index != outcome.index {
            return Err(format!("{program} answered out of order"));
        }
        if answer.code != 1 {
            continue;
        }
        said += 1;
        let curve = Curve::new(&problem.plain, problem.closed);
        let size = polygon(&curve);
        let finite = answer.points.iter().flatten().all(|x| x.is_finite());
        let knots: Vec<Vector> = answer.points.iter().copied().step_by(3).collect();
        let passes = problem
            .plain
            .iter()
            .all(|joint| knots.iter().any(|&knot| distance(knot, joint.position.value) <= 1e-6 * size));
        let long: f64 = (0..answer.points.len() / 3).map(|k| length(&answer.points[3 * k..3 * k + 4])).sum();
        if finite && passes && long <= WILD * size {
            true_ += 1;
            gentle += usize::from(outcome.gentle);
        }
    }
    let of_gentle = asked.iter().filter(|(outcome, _)| outcome.gentle).count();
    let time = median(answers.iter().map(|answer| answer.microseconds).collect());
    line("libspiro", asked.len(), [said, true_, gentle, of_gentle], time);
    Ok(())
}

/// OpenCASCADE on the planar problems of two points with end tangents. True is what keeps the constraints to 1e-6 and has a
/// lower variation than the cubic with the same tangents and the chord's speed.
///
/// # Errors
/// The program cannot be run or answers nonsense.
pub fn occt(program: &str, seed: u64, outcomes: &[Outcome]) -> Result<(), String> {
    let mut lines = String::new();
    let mut asked: Vec<(&Outcome, Problem)> = Vec::new();
    for outcome in
        outcomes.iter().filter(|o| o.functional == Functional::MVC && o.family == Family::TwoPoints)
    {
        let problem = Problem::new(seed, outcome.index);
        if !problem.planar || problem.plain.iter().any(|joint| joint.curvature[0].given == Given::FIXED) {
            continue;
        }
        let _ = write!(lines, "{}", outcome.index);
        for joint in &problem.plain {
            let ([x, y, _], [dx, dy, _]) = (joint.position.value, joint.tangent[0].value);
            let _ = write!(lines, " {x:?} {y:?} {:?}", libm::atan2(dy, dx));
        }
        lines.push('\n');
        asked.push((outcome, problem));
    }
    let answers = ask(program, lines)?;
    println!(
        "| two points, end tangents | problems | says it converged % | true % | true % of gentle data | µs, median |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    ours(&asked.iter().map(|(outcome, _)| *outcome).collect::<Vec<_>>());
    let [mut said, mut true_, mut gentle, mut both, mut higher] = [0; 5];
    let mut ratios = Vec::new();
    for (answer, (outcome, problem)) in answers.iter().zip(&asked) {
        if answer.index != outcome.index {
            return Err(format!("{program} answered out of order"));
        }
        if answer.code != 0 {
            continue;
        }
        said += 1;
        if !keeps_ends(&answer.points, problem) || !(variation(&answer.points) < variation(&cubic(problem))) {
            continue;
        }
        true_ += 1;
        gentle += usize::from(outcome.gentle);
        if outcome.status == Status::Converged {
            let (report, _) =
                solve_curve(&problem.plain, false, &Options::DEFAULT).map_err(|error| error.to_string())?;
            let ratio = variation(&answer.points) / report.variation;
            both += 1;
            higher += usize::from(ratio > 1.0);
            ratios.push(ratio);
        }
    }
    let of_gentle = asked.iter().filter(|(outcome, _)| outcome.gentle).count();
    let time = median(answers.iter().map(|answer| answer.microseconds).collect());
    line("OpenCASCADE", asked.len(), [said, true_, gentle, of_gentle], time);
    println!(
        "\nOf {both} that both solve, OpenCASCADE's variation is the higher one in {higher}; its median is {:.6} of minvar's.",
        median(ratios)
    );
    Ok(())
}

/// Whether a Bézier curve begins and ends where and as it should.
fn keeps_ends(poles: &[Vector], problem: &Problem) -> bool {
    let [first, last] = [&problem.plain[0], &problem.plain[1]];
    let chord = distance(first.position.value, last.position.value);
    if poles.len() < 2 {
        return false;
    }
    [(first, 0.0), (last, 1.0)].into_iter().all(|(joint, t)| {
        let [point, along, ..] = bezier(poles, t);
        distance(point, joint.position.value) <= 1e-6 * chord
            && distance(unit(along), unit(joint.tangent[0].value)) <= 1e-6
    })
}

/// The cubic with the problem's tangents and the chord's speed: what any solver must beat.
fn cubic(problem: &Problem) -> [Vector; 4] {
    let [first, last] = [&problem.plain[0], &problem.plain[1]];
    let (a, b) = (first.position.value, last.position.value);
    let third = distance(a, b) / 3.0;
    let (from, to) = (unit(first.tangent[0].value), unit(last.tangent[0].value));
    [a, std::array::from_fn(|d| a[d] + third * from[d]), std::array::from_fn(|d| b[d] - third * to[d]), b]
}
