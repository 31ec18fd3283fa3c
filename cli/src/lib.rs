//! The command `minvar`: files in; figures, pictures, tables and NC paths out.
//!
//! [`arguments`] says what it takes, [`constraints`] reads the input, `solve` calls the kernel, and `picture`, `tables` and `nc`
//! make what `output` writes. Nothing is written before everything is made, and then all or nothing: [`make`] is all of the
//! command but its files.

pub mod arguments;
pub mod constraints;
mod nc;
mod output;
mod picture;
mod solve;
mod tables;
mod trace;

use arguments::{Arguments, Command, CurveArguments, is_stdin};
use clap::Parser;
use constraints::{Fault, Reading, Specification};
use minvar::curve::TRUSTED;
use minvar::solve::Status;
use output::{Outputs, Target};
use picture::{Mark, Picture, figure};
use solve::{Options, Solution};
use std::fmt::Write as _;
use std::io::{self, Read as _, Write as _};
use std::path::Path;
use std::process::ExitCode;
use trace::Trace;

/// Why the command ends early, and what is to be said about it.
#[derive(Debug)]
pub enum Failure {
    /// The input or the command line is wrong.
    Input(String),
    /// An output could not be written.
    Output(String),
}

/// The whole command with the arguments of this process.
pub fn command() -> ExitCode {
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

    let made = make(arguments, &mut read, &mut complain)?;
    let mut outputs = Outputs::default();
    for (option, text) in made.texts {
        let target = targets.iter().find_map(|(name, target)| (*name == option).then_some(target));
        let target = target.expect("texts are made of what was asked for");
        outputs
            .add(target, text.into_bytes())
            .map_err(|message| Failure::Output(format!("error: {message}")))?;
    }
    // A file on the standard output must not be mixed with figures.
    let apart = targets.iter().any(|(_, target)| *target == Target::Stdout);
    let figures = Some(made.figures).filter(|_| !arguments.quiet);
    let (beside, figures) = if apart { (figures, None) } else { (None, figures) };
    figures.into_iter().for_each(|figures| outputs.print(figures));
    outputs.commit().map_err(|message| Failure::Output(format!("error: {message}")))?;
    if let Some(figures) = beside {
        complain(figures.trim_end());
    }
    made.remarks.iter().for_each(|remark| complain(remark));
    Ok(made.status)
}

/// Texts by the options that ask for them.
type Texts = Vec<(&'static str, String)>;

/// All that the command makes of its input.
#[derive(Debug)]
pub struct Made {
    /// How the computation of the curve that is written ended.
    pub status: Status,
    /// The texts that were asked for, by the option that asks for each.
    pub texts: Texts,
    /// The figures to print.
    pub figures: String,
    /// What to say after all is written.
    pub remarks: Vec<String>,
}

/// All of `minvar curve` but its files: `read` gives the bytes of the input and of a reference shape, `say` hears what is odd
/// about them. Nothing else is read, and nothing is written.
///
/// # Errors
///
/// [`Failure`], `read`'s among them.
pub fn make(
    arguments: &CurveArguments,
    read: &mut dyn FnMut(&Path) -> Result<Vec<u8>, Failure>,
    say: &mut dyn FnMut(&str),
) -> Result<Made, Failure> {
    let bytes = read(&arguments.file)?;
    let file = if is_stdin(&arguments.file) { "<stdin>".into() } else { arguments.file.to_string_lossy() };
    let show = |fault: &Fault| fault.render(&file, true);
    let Reading { specification, warnings } =
        constraints::read(&bytes).map_err(|fault| Failure::Input(show(&fault)))?;
    warnings.iter().for_each(|warning| say(&show(warning)));

    let options = options(arguments, read)?;
    let solutions = solve::solve(&specification, &options).map_err(|error| {
        Failure::Input(match error.place {
            Some(place) => show(&constraints::fault_at(&bytes, place, error.message)),
            None => format!("error: {}", error.message),
        })
    })?;
    let chosen = chosen(arguments.minimum, &solutions)?;
    let solution = &solutions[chosen];

    let (texts, mut figures) = texts(arguments, &specification, &options, solution, say)?;
    if options.minima > 0 && solution.status == Status::Converged {
        figures += &table(&solutions, chosen);
    }
    let mut remarks = Vec::new();
    if solution.status != Status::Converged {
        remarks.push(format!("warning: {}", advice(&options, solution)));
    }
    let off = (solution.fine_value - solution.value).abs();
    let nothing = NOTHING / (0..solution.functional.scale_power()).map(|_| solution.length).product::<f64>();
    if off > TRUSTED * solution.value.abs() + nothing {
        remarks.push(format!(
            "warning: a finer quadrature gives {} for the functional: the curve is too wild for its elements, try more \
             of them (--elements-per-span)",
            rounded(solution.fine_value, 10)
        ));
    }
    Ok(Made { status: solution.status, texts, figures, remarks })
}

/// A functional below this, in the curve's length, is nothing.
const NOTHING: f64 = 1e-12;

/// The index of the minimum that is asked for by its number, from 1. What has not converged is no minimum, but all
/// there is.
fn chosen(number: usize, solutions: &[Solution]) -> Result<usize, Failure> {
    if number <= solutions.len() || solutions[0].status != Status::Converged {
        return Ok(number.min(solutions.len()) - 1);
    }
    let found = if solutions.len() == 1 {
        "1 minimum was found".to_owned()
    } else {
        format!("{} minima were found", solutions.len())
    };
    Err(Failure::Input(format!("error: --minimum {number}: {found}")))
}

/// No two outputs in one place, and none in an input's: neither would be what it is to be.
fn check_targets(arguments: &CurveArguments, targets: &[(&'static str, Target)]) -> Result<(), Failure> {
    let inputs = [("FILE", Some(&arguments.file)), ("--reference", arguments.shape.reference.as_ref())];
    let inputs: Vec<_> = inputs.into_iter().filter_map(|(name, path)| Some((name, path?))).collect();
    if inputs.len() == 2 && inputs.iter().all(|(_, path)| is_stdin(path)) {
        return Err(Failure::Input("error: FILE and --reference are both the standard input".into()));
    }
    let place = |path: &Path| if is_stdin(path) { output::standard_input() } else { Some(Target::new(path)) };
    let mut all: Vec<_> = inputs.into_iter().filter_map(|(name, path)| Some((name, place(path)?))).collect();
    all.extend(targets.iter().cloned());
    // Where the standard output runs into a file, an output in its place would be lost.
    let prints = !arguments.quiet || targets.iter().any(|(_, target)| *target == Target::Stdout);
    all.extend(output::standard_output().filter(|_| prints).map(|file| ("the standard output", file)));
    match output::same_twice(&all) {
        Some((a, b)) => Err(Failure::Input(format!("error: {a} and {b} are the same file"))),
        None => Ok(()),
    }
}

/// More than a million joints; what is larger is a device or a mistake.
const LARGEST_INPUT: u64 = 256 << 20;

/// All of a file, or of the standard input.
fn read(file: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let (name, result) = if is_stdin(file) {
        ("the standard input".into(), io::stdin().lock().take(LARGEST_INPUT + 1).read_to_end(&mut bytes))
    } else {
        (
            file.to_string_lossy(),
            std::fs::File::open(file).and_then(|file| file.take(LARGEST_INPUT + 1).read_to_end(&mut bytes)),
        )
    };
    match result {
        Ok(_) if bytes.len() as u64 > LARGEST_INPUT => {
            Err(Failure::Input(format!("error: {name} is larger than 256 MiB: too large for an input")))
        }
        Ok(_) => Ok(bytes),
        Err(error) => Err(Failure::Input(format!("error: cannot read {name}: {}", output::reason(&error)))),
    }
}

/// How to solve, the reference shape read.
fn options(
    arguments: &CurveArguments,
    read: &mut dyn FnMut(&Path) -> Result<Vec<u8>, Failure>,
) -> Result<Options, Failure> {
    let shape = &arguments.shape;
    let reference = match &shape.reference {
        None => None,
        Some(file) => {
            if arguments.functional != solve::Functional::Mvc {
                return Err(Failure::Input("error: --reference is for --functional mvc alone".into()));
            }
            let name = if is_stdin(file) { "<stdin>".into() } else { file.to_string_lossy().into_owned() };
            let elements = tables::elements(&read(file)?).map_err(|error| {
                Failure::Input(format!("error: --reference {name} is no file that --json wrote: {error}"))
            })?;
            Some(solve::Shape { name, elements, weight: shape.reference_weight })
        }
    };
    let tolerance = arguments.tolerance.unwrap_or(0.0);
    Ok(Options {
        functional: arguments.functional,
        tension: shape.tension,
        bending: shape.bending,
        length: shape.length,
        tolerance,
        elements_per_span: arguments.elements_per_span.unwrap_or(if tolerance > 0.0 {
            MOST_ELEMENTS
        } else {
            1
        }),
        max_iterations: arguments.max_iterations,
        continuation: arguments.continuation,
        minima: arguments.minima.unwrap_or(0),
        dimension: arguments.dimension.unwrap_or(0),
        reference,
    })
}

/// With a tolerance a span has no more elements than this, if nothing else is said.
const MOST_ELEMENTS: u32 = 64;

/// What to do about a curve that has not converged.
fn advice(options: &Options, solution: &Solution) -> String {
    match solution.status {
        Status::Unbounded => {
            let growth = "unbounded: the curve grows without limit while the functional sinks";
            let weights = match (options.length > 0.0, options.tension > 0.0) {
                (false, false) => "add a constraint, a --tension or a --length",
                (false, true) => "add a constraint or a --length",
                _ => "add a constraint",
            };
            match solution.functional.scale_invariant() {
                Some(other) => format!(
                    "{growth}; the scale-invariant functional {0} has a minimum: --functional {0}; or {weights}",
                    other.name()
                ),
                None => format!("{growth}; {weights}"),
            }
        }
        Status::Stalled if options.has_tolerance() => {
            let more = "allow more (--elements-per-span)";
            match (options.elements_per_span, solution.error) {
                (count, Some(error)) if error > options.tolerance => {
                    let elements = if count == 1 {
                        "one element a span does"
                    } else {
                        &format!("{count} elements a span do")
                    };
                    format!("stalled: {elements} not reach the tolerance; {more} or a larger one")
                }
                (1, None) => format!(
                    "stalled: one element a span has nothing to be compared with, so its distance from the true curve is not known; {more}"
                ),
                _ => Status::Stalled.sentence().to_owned(),
            }
        }
        status => status.sentence().to_owned(),
    }
}

/// Everything that is to be written, and the figures to print.
fn texts(
    arguments: &CurveArguments,
    specification: &Specification,
    options: &Options,
    solution: &Solution,
    say: &mut dyn FnMut(&str),
) -> Result<(Texts, String), Failure> {
    let mut figures = figures(specification, options, solution);
    let mut texts = Vec::new();
    for (option, _) in arguments.targets() {
        let text = match option {
            "--svg" => svg(arguments, specification, options, solution),
            "--csv" => tables::csv(&Trace::new(&solution.elements, arguments.samples as usize)),
            "--json" => tables::json(specification, options, solution)
                .map_err(|message| Failure::Output(format!("error: {message}")))?,
            _ if solution.status != Status::Converged => {
                say("warning: no NC path is written of a curve that has not converged");
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
        texts.push((option, text));
    }
    Ok((texts, figures))
}

/// The figures as text, a line each.
fn figures(specification: &Specification, options: &Options, solution: &Solution) -> String {
    let closed = if specification.closed { "closed" } else { "open" };
    let joints = counted(specification.joints.len(), "joint");
    let elements = counted(solution.elements.len(), "element");
    let mut out = format!("curve       {}, {closed}, {joints}, {elements}\n", specification.name);
    let iterations = counted(solution.iterations, "iteration");
    let _ = writeln!(out, "status      {} after {iterations}", solution.status.name());
    let _ = writeln!(out, "functional  {} = {}", functional(options), rounded(solution.value, 10));
    if let Some(shape) = &options.reference {
        let _ = writeln!(out, "reference   {}, weight {:?}", shape.name, shape.weight);
    }
    if options.has_tolerance() {
        let error =
            solution.error.map_or("not known".into(), |error| format!("{} (estimated)", rounded(error, 3)));
        let _ = writeln!(out, "error       {error}, tolerance {:?}", options.tolerance);
    }
    let asked = if options.length > 0.0 { format!(" (given: {:?})", options.length) } else { String::new() };
    let _ = writeln!(out, "length      {}{asked}", rounded(solution.length, 10));
    let _ = writeln!(out, "variation   {}", rounded(solution.variation, 10));
    let _ = writeln!(out, "bending     {}", rounded(solution.bending, 10));
    let [low, high] = [solution.curvature_min, solution.curvature_max].map(|kappa| rounded(kappa, 10));
    let _ = writeln!(out, "curvature   {low} to {high}");
    out
}

/// The minima, a line each, the lowest first; an arrow points to the one that is written.
fn table(minima: &[Solution], written: usize) -> String {
    let mut out = format!(
        "\n  {:7}{:>17}{:>17}{:>17}{:>17}  status\n",
        "minimum", "value", "variation", "bending", "length"
    );
    for (index, minimum) in minima.iter().enumerate() {
        let arrow = if index == written { '>' } else { ' ' };
        let _ = write!(out, "{arrow} {:<7}", index + 1);
        for figure in [minimum.value, minimum.variation, minimum.bending, minimum.length] {
            let _ = write!(out, "{:>17}", rounded(figure, 10));
        }
        let _ = writeln!(out, "  {}", minimum.status.name());
    }
    out
}

/// `mvc + 0.5 length`
fn functional(options: &Options) -> String {
    let mut out = options.functional.name().to_owned();
    for (weight, of) in [(options.bending, "bending"), (options.tension, "length")] {
        if weight > 0.0 {
            let _ = write!(out, " + {weight:?} {of}");
        }
    }
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
    let title = stem.filter(|_| !is_stdin(&arguments.file)).unwrap_or_else(|| specification.name.clone());
    let polygons: Vec<_> = arguments.polygon.iter().map(|polygon| polygon.0.clone()).collect();
    let mut functional = solution.functional.formula().to_owned();
    for (weight, of) in [(options.bending, "∫ κ² ds"), (options.tension, "L")] {
        if weight > 0.0 {
            let _ = write!(functional, " + {} {of}", figure(weight, 4));
        }
    }
    let mut lines = vec![format!(
        "{functional} = {}  ·  length {}  ·  curvature {} … {}",
        figure(solution.value, 7),
        figure(solution.length, 7),
        figure(solution.curvature_min, 5),
        figure(solution.curvature_max, 5)
    )];
    if let Some(error) = solution.error {
        let elements = counted(solution.elements.len(), "element");
        lines.push(format!("{elements}, about {} from the true minimum", figure(error, 2)));
    }
    if let Some(shape) = &options.reference {
        lines.push(format!("reference shape {}, weight {}", shape.name, figure(shape.weight, 4)));
    }
    if solution.status != Status::Converged {
        lines.push(format!("Not converged: {}", solution.status.name()));
    }
    picture::svg(&Picture {
        title: &title,
        figures: &lines,
        elements: &solution.elements,
        closed: specification.closed,
        joints: &Mark::of(specification, &solution.starts),
        polygons: &polygons,
        obstacles: &specification.obstacles,
    })
}
