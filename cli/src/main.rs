//! The command `minvar`: files in; figures, pictures, tables and NC paths out.
//!
//! `arguments` says what it takes, `constraints` reads the input, `solve` calls the kernel, and `picture`, `tables` and `nc` make
//! what `output` writes. Nothing is written before everything is made.

mod arguments;
mod constraints;
mod nc;
mod output;
mod picture;
mod solve;
mod tables;
mod trace;

use arguments::{Arguments, Command, CurveArguments};
use clap::Parser;
use constraints::{Fault, Reading, Specification};
use minvar::solve::Status;
use output::Target;
use picture::{Mark, Picture, figure};
use solve::{Options, Solution};
use std::fmt::Write as _;
use std::io::{self, Read as _, Write as _};
use std::process::ExitCode;
use trace::Trace;

/// Why the command ends early, and what has been said about it.
enum Failure {
    /// The input or the command line is wrong.
    Input(String),
    /// An output could not be written.
    Output(String),
}

fn main() -> ExitCode {
    let Command::Curve(arguments) = Arguments::parse().command;
    match curve(&arguments) {
        Ok(Status::Converged) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::from(1),
        Err(Failure::Input(message)) => {
            complain(&message);
            ExitCode::from(2)
        }
        Err(Failure::Output(message)) => {
            complain(&message);
            ExitCode::from(3)
        }
    }
}

/// Writes to the standard error, in colours only where they are seen. If nobody can be told, nobody is.
fn complain(message: &str) {
    let _ = writeln!(anstream::stderr(), "{message}");
}

/// `minvar curve`
fn curve(arguments: &CurveArguments) -> Result<Status, Failure> {
    let targets = arguments.targets();
    check_targets(arguments, &targets)?;

    let bytes = read(arguments)?;
    let file = if arguments.reads_stdin() { "<stdin>".into() } else { arguments.file.to_string_lossy() };
    let show = |fault: &Fault| fault.render(&file, true);
    let Reading { specification, warnings } =
        constraints::read(&bytes).map_err(|fault| Failure::Input(show(&fault)))?;
    warnings.iter().for_each(|warning| complain(&show(warning)));

    let options = Options {
        functional: arguments.functional,
        elements_per_span: arguments.elements_per_span,
        max_iterations: arguments.max_iterations,
        dimension: arguments.dimension.unwrap_or(0),
    };
    let solution = solve::solve(&specification, &options).map_err(|error| {
        Failure::Input(match error.joint.and_then(|joint| specification.joints.get(joint)) {
            Some(joint) => show(&constraints::fault_at(&bytes, joint, error.message)),
            None => format!("error: {}", error.message),
        })
    })?;

    let (prepared, figures) = outputs(arguments, &targets, &specification, &options, &solution)?;
    for output in prepared {
        output.commit().map_err(|message| Failure::Output(format!("error: {message}")))?;
    }
    if !arguments.quiet {
        // A file on the standard output must not be mixed with figures.
        if targets.iter().any(|(_, target)| *target == Target::Stdout) {
            complain(figures.trim_end());
        } else {
            output::print(figures.as_bytes())
                .map_err(|message| Failure::Output(format!("error: {message}")))?;
        }
    }
    if solution.status != Status::Converged {
        complain(&format!("warning: {}", solution.status.sentence()));
    }
    let off = (solution.fine_value - solution.value).abs();
    let power = if solution.functional == solve::Functional::Mec { 1 } else { 3 };
    let nothing = NOTHING / (0..power).map(|_| solution.length).product::<f64>();
    if off > TRUSTED * solution.value.abs() + nothing {
        complain(&format!(
            "warning: a finer quadrature gives {} for the functional: the curve is too wild for its elements, try more \
             of them (--elements-per-span)",
            rounded(solution.fine_value, 10)
        ));
    }
    Ok(solution.status)
}

/// The functional is trusted if a finer quadrature confirms it to this fraction.
const TRUSTED: f64 = 1e-4;
/// A functional below this, in the curve's length, is nothing.
const NOTHING: f64 = 1e-12;

/// No two outputs in one place, and none in the input's.
fn check_targets(arguments: &CurveArguments, targets: &[(&'static str, Target)]) -> Result<(), Failure> {
    let mut all = targets.to_vec();
    if !arguments.reads_stdin() {
        all.insert(0, ("FILE", Target::new(&arguments.file)));
    }
    match output::same_twice(&all) {
        Some((a, b)) => Err(Failure::Input(format!("error: {a} and {b} are the same file"))),
        None => Ok(()),
    }
}

/// More than a million joints; what is larger is a device or a mistake.
const LARGEST_INPUT: u64 = 256 << 20;

fn read(arguments: &CurveArguments) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let (name, result) = if arguments.reads_stdin() {
        ("the standard input".into(), io::stdin().lock().take(LARGEST_INPUT + 1).read_to_end(&mut bytes))
    } else {
        let file = &arguments.file;
        (
            file.to_string_lossy(),
            std::fs::File::open(file).and_then(|file| file.take(LARGEST_INPUT + 1).read_to_end(&mut bytes)),
        )
    };
    match result {
        Ok(_) if bytes.len() as u64 > LARGEST_INPUT => {
            Err(Failure::Input(format!("error: {name} is larger than 256 MiB: that is no constraint file")))
        }
        Ok(_) => Ok(bytes),
        Err(error) => Err(Failure::Input(format!("error: cannot read {name}: {}", output::reason(&error)))),
    }
}

/// Everything that is to be written, and the figures to print.
fn outputs(
    arguments: &CurveArguments,
    targets: &[(&'static str, Target)],
    specification: &Specification,
    options: &Options,
    solution: &Solution,
) -> Result<(Vec<output::Prepared>, String), Failure> {
    let mut figures = figures(specification, solution);
    let mut prepared = Vec::new();
    for (option, target) in targets {
        let content = match *option {
            "--svg" => svg(arguments, specification, options, solution),
            "--csv" => tables::csv(&Trace::new(&solution.elements, arguments.samples as usize)),
            "--json" => tables::json(specification, options, solution)
                .map_err(|message| Failure::Output(format!("error: {message}")))?,
            _ if solution.status != Status::Converged => {
                complain("warning: no NC path is written of a curve that has not converged");
                continue;
            }
            _ => {
                let (text, summary) = nc::program(&solution.elements, &arguments.path)
                    .map_err(|message| Failure::Input(format!("error: {message}")))?;
                let _ = writeln!(
                    figures,
                    "path        {}, {}, within {} of the curve, {} minutes",
                    counted(summary.arcs, "arc"),
                    counted(summary.chords, "line"),
                    rounded(summary.deviation, 3),
                    rounded(summary.minutes, 3)
                );
                text
            }
        };
        let output = output::prepare(target, content.into_bytes());
        prepared.push(output.map_err(|message| Failure::Output(format!("error: {message}")))?);
    }
    Ok((prepared, figures))
}

/// The figures as text, a line each.
fn figures(specification: &Specification, solution: &Solution) -> String {
    let closed = if specification.closed { "closed" } else { "open" };
    let joints = counted(specification.joints.len(), "joint");
    let elements = counted(solution.elements.len(), "element");
    let mut out = format!("curve       {}, {closed}, {joints}, {elements}\n", specification.name);
    let iterations = counted(solution.iterations, "iteration");
    let _ = writeln!(out, "status      {} after {iterations}", solution.status.name());
    let _ = writeln!(out, "functional  {} = {}", solution.functional.name(), rounded(solution.value, 10));
    let _ = writeln!(out, "length      {}", rounded(solution.length, 10));
    let _ = writeln!(out, "variation   {}", rounded(solution.variation, 10));
    let _ = writeln!(out, "bending     {}", rounded(solution.bending, 10));
    let [low, high] = [solution.curvature_min, solution.curvature_max].map(|kappa| rounded(kappa, 10));
    let _ = writeln!(out, "curvature   {low} to {high}");
    out
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// So many significant digits, in a form that programs read.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse::<f64>().map_or(text, |value| format!("{value:?}"))
}

fn svg(
    arguments: &CurveArguments,
    specification: &Specification,
    options: &Options,
    solution: &Solution,
) -> String {
    // A file is usually named after its curve, and the curve `test`.
    let stem = arguments.file.file_stem().map(|stem| stem.to_string_lossy().replace('_', " "));
    let title = stem.filter(|_| !arguments.reads_stdin()).unwrap_or_else(|| specification.name.clone());
    let obstacles: Vec<_> = arguments.polygon.iter().map(|polygon| polygon.0.clone()).collect();
    let functional = match solution.functional {
        solve::Functional::Mvc => "MVC  ∫ (dκ/ds)² ds",
        solve::Functional::Mec => "MEC  ∫ κ² ds",
    };
    let mut lines = vec![format!(
        "{functional} = {}  ·  length {}  ·  curvature {} … {}",
        figure(solution.value, 7),
        figure(solution.length, 7),
        figure(solution.curvature_min, 5),
        figure(solution.curvature_max, 5)
    )];
    if solution.status != Status::Converged {
        lines.push(format!("Not converged: {}", solution.status.name()));
    }
    picture::svg(&Picture {
        title: &title,
        figures: &lines,
        elements: &solution.elements,
        closed: specification.closed,
        joints: &Mark::of(specification, options.elements_per_span as usize),
        obstacles: &obstacles,
    })
}
