//! What the command takes.

use crate::output::Target;
use crate::solve::Functional;
use clap::builder::TypedValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};

/// Fair curves: from a file of constraints to pictures, tables and NC paths.
#[derive(Debug, Parser)]
#[command(name = "minvar", version, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The things to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Computes the fairest curve through joints
    #[command(after_long_help = CURVE_HELP, after_help = "`minvar curve --help` describes the input file, with examples.")]
    Curve(Box<CurveArguments>),
}

const CURVE_HELP: &str = "\
Input:
  Joints and one curve, in any order; `;` or `#` begins a comment. A joint has a name, a position, and where wanted a
  tangent (a direction) and a curvature vector (to the centre of curvature, 1/radius long). Fixed values are kept, Initial
  values are where the search starts; all else is found. G2 joints have a common curvature on both sides, G1 joints a
  common tangent only, G0 joints are corners.

    (G2Joint a (0.5,-12,0) (Fixed Tangent (0,1,0)) (Fixed Curvature (0.27,0,0)))
    (G2Joint b (20,-0.5,0) (Fixed Tangent (1,0,0)))
    (G2Curve coving Open (a,b))

  A joint may slide on a line or in a plane: after the word stand the point where it starts and the line's direction or
  the plane's normal.

    (G2Joint a Line (0.5,-12,0) (0,1,0) (Fixed Tangent (0,1,0)))
    (G2Joint b Plane (1,0.5,0.3) (1,0,0))

  Of a curvature the size alone may be kept. Its direction starts at that of the vector; with a number in its place, at that
  of the start curve, and the joint needs a tangent.

    (G2Joint c (0,0,0) (Size Curvature (0.3,0,0)))
    (G2Joint d (2,1,0) (Initial Tangent (1,0,0)) (Size Curvature 0.27))

  Where tangent or curvature are not common to both sides, Arriving or Leaving gives one: (Fixed Tangent Leaving (1,0,0)).

  A planar curve keeps clear of points and segments: it leaves them to its left or right, in the direction in which it runs,
  at this distance or more. The plane is seen from +z, +x or +y, whichever its normal is nearest to. Each place where the
  curve touches an obstacle adds as many elements as a span has. Not with --tolerance, --length, --reference or --dimension 3.

    (Obstacle Left 0.25 (6,-6,0))
    (Obstacle Right 0.25 (0,1,0) (3,1,0))

Examples:
  minvar curve coving.mvc --svg coving.svg
  minvar curve coving.mvc --tolerance 1e-6 --json - --quiet
  minvar curve coving.mvc --nc coving.ngc --feed 600 --safe-height 5 --depth -2 --path-tolerance 0.005
  minvar curve antipodal.mvc --functional si-mvc
  minvar curve loop.mvc --minima 5 --minimum 2 --svg loop.svg
  minvar curve moved.mvc --reference coving.json --reference-weight 0.8
  minvar curve - --csv samples.csv --samples 101 < coving.mvc

Outputs:
  A file is complete or as it was, whatever happens: it is written beside its place and put there by renaming, with the
  permissions of the file that it replaces. If one output cannot be written, no file is changed. A link stays; what it
  points to is replaced. Pipes and devices get theirs before the files change; what they have taken they keep.
  A call that is killed changes some files or none, each as a whole, and may leave .minvar-*.part behind, which the next
  call that writes there clears away.

Exit codes:
  0  the curve was computed and all was written
  1  the curve did not converge; figures and files are those of the last shape, but no NC path is written
  2  the input or the command line is wrong
  3  an output could not be written; no file was changed, unless the message says so
  Ctrl-C ends the command by its signal, which a shell shows as 130.";

/// `minvar curve`
#[derive(Debug, Args)]
pub struct CurveArguments {
    /// The constraints; `-` reads the standard input
    pub(crate) file: PathBuf,

    /// What the curve minimises
    #[arg(long, value_enum, ignore_case = true, default_value_t = Functional::Mvc, value_name = "NAME")]
    pub(crate) functional: Functional,

    /// What is added to the functional, and what is asked of the shape.
    #[command(flatten)]
    pub(crate) shape: ShapeArguments,

    /// Quintic elements between two joints: more come nearer to the true minimum. With --tolerance the most that a span
    /// may get [default: 1, with --tolerance 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) elements_per_span: Option<u32>,

    /// How far the curve may be from the true minimum, by an estimate: spans get as many elements as that needs
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,

    /// 2 for a planar curve, 3 for one that may leave the plane of its data [default: planar data give a planar curve]
    #[arg(long, value_name = "2|3", value_parser = clap::value_parser!(u32).range(2..=3))]
    pub(crate) dimension: Option<u32>,

    /// Stop after so many iterations
    #[arg(long, default_value_t = 500, value_name = "N")]
    pub(crate) max_iterations: u32,

    /// Begin under tension and release it in so many stages: leads to the shortest curve where start values lead to a
    /// longer one
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=16))]
    pub(crate) continuation: u32,

    /// Look for up to N local minima and list them, the lowest first; the lowest is written
    #[arg(long, value_name = "N", value_parser = minima(), conflicts_with = "reference")]
    pub(crate) minima: Option<usize>,

    /// Which of the listed minima is written: 1 is the lowest
    #[arg(long, default_value_t = 1, value_name = "K", value_parser = minima(), requires = "minima")]
    pub(crate) minimum: usize,

    /// Print no figures
    #[arg(long, short)]
    pub(crate) quiet: bool,

    /// Write a picture: the curve, its curvature comb and its curvature against the arc length
    #[arg(long, value_name = "OUT", help_heading = "Outputs (`-` is the standard output)")]
    pub(crate) svg: Option<PathBuf>,

    /// Write an NC path (G-code)
    #[arg(long, value_name = "OUT", help_heading = "Outputs (`-` is the standard output)")]
    pub(crate) nc: Option<PathBuf>,

    /// Write samples: position, tangent, curvature vector, curvature, torsion and change of curvature
    #[arg(long, value_name = "OUT", help_heading = "Outputs (`-` is the standard output)")]
    pub(crate) csv: Option<PathBuf>,

    /// Write the figures and the elements' rows C(0), C'(0), C''(0), C''(1), C'(1), C(1)
    #[arg(long, value_name = "OUT", help_heading = "Outputs (`-` is the standard output)")]
    pub(crate) json: Option<PathBuf>,

    /// Draw a polygon beneath the curve; it does not change the curve; may be given several times
    #[arg(
        long,
        value_name = "X,Y X,Y …",
        requires = "svg",
        allow_hyphen_values = true,
        value_parser = polygon,
        help_heading = "Outputs (`-` is the standard output)"
    )]
    pub(crate) polygon: Vec<Polygon>,

    /// Samples an element in the CSV file, both ends among them
    #[arg(
        long,
        default_value_t = 21,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(2..=100_000),
        help_heading = "Outputs (`-` is the standard output)"
    )]
    pub(crate) samples: u32,

    /// The NC path.
    #[command(flatten)]
    pub(crate) path: PathArguments,
}

/// What is added to the functional, and what is asked of the shape.
#[derive(Debug, Args)]
pub(crate) struct ShapeArguments {
    /// Add W times the length to the functional: a tension (not with si-mvc and si-mec)
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "W",
        allow_negative_numbers = true,
        hide_default_value = true
    )]
    pub(crate) tension: f64,

    /// Add W times the bending energy ∫ κ² ds to the functional (not with si-mvc and si-mec)
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "W",
        allow_negative_numbers = true,
        hide_default_value = true
    )]
    pub(crate) bending: f64,

    /// Give the curve this length
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "L",
        allow_negative_numbers = true,
        hide_default_value = true
    )]
    pub(crate) length: f64,

    /// A shape to keep to as far as the joints allow: a file that --json wrote, of as many elements (mvc only)
    #[arg(long, value_name = "FILE", conflicts_with = "tolerance")]
    pub(crate) reference: Option<PathBuf>,

    /// How much of the reference shape's change of curvature is the aim: 1 keeps the shape, 0 smooths it away
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "A",
        requires = "reference",
        allow_negative_numbers = true
    )]
    pub(crate) reference_weight: f64,
}

/// How many minima may be asked for.
fn minima() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u32).range(1..=100).map(|count| count as usize)
}

/// A polygon of a picture, in the curve's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polygon(pub(crate) Vec<[f64; 3]>);

/// `--polygon "0,0 6,0 6,-6 0,-6"`
fn polygon(text: &str) -> Result<Polygon, String> {
    let number = |word: &str| {
        let value: f64 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
        if value.is_finite() { Ok(value) } else { Err(format!("`{word}` is not finite")) }
    };
    let point = |word: &str| match word.split(',').collect::<Vec<_>>()[..] {
        [x, y] => Ok([number(x)?, number(y)?, 0.0]),
        [x, y, z] => Ok([number(x)?, number(y)?, number(z)?]),
        _ => Err(format!("`{word}` is not a point `x,y`")),
    };
    let corners = text.split_whitespace().map(point).collect::<Result<Vec<_>, String>>()?;
    if corners.len() < 2 { Err("a polygon needs two points or more".into()) } else { Ok(Polygon(corners)) }
}

/// The NC path's options; lengths in the curve's own unit.
#[derive(Debug, Args)]
#[command(next_help_heading = "NC path (lengths in the curve's unit)")]
pub(crate) struct PathArguments {
    /// The greatest distance between path and curve
    #[arg(
        long,
        default_value_t = 0.01,
        value_name = "LENGTH",
        requires = "nc",
        allow_negative_numbers = true
    )]
    pub(crate) path_tolerance: f64,

    /// The cutting feed, length a minute [default: 600 mm or 24 inches]
    #[arg(long, value_name = "FEED", requires = "nc", allow_negative_numbers = true)]
    pub(crate) feed: Option<f64>,

    /// The feed while plunging; without it the cutting feed
    #[arg(long, value_name = "FEED", requires = "nc", allow_negative_numbers = true)]
    pub(crate) plunge_feed: Option<f64>,

    /// The height of rapid moves: above the cut and everything else [default: 5 mm or 0.2 inches above the cut]
    #[arg(long, value_name = "LENGTH", requires = "nc", allow_negative_numbers = true)]
    pub(crate) safe_height: Option<f64>,

    /// What is added to the curve's height while cutting: negative goes into the material
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "LENGTH",
        requires = "nc",
        allow_negative_numbers = true
    )]
    pub(crate) depth: f64,

    /// The unit that the program declares
    #[arg(long, value_enum, default_value_t = Units::Mm, value_name = "UNIT", requires = "nc")]
    pub(crate) units: Units,

    /// The machine's plane that the curve's x and y become
    #[arg(long, value_enum, default_value_t = MachinePlane::Xy, value_name = "PLANE", requires = "nc")]
    pub(crate) plane: MachinePlane,

    /// Straight moves (G1) only: also for space curves
    #[arg(long, requires = "nc")]
    pub(crate) chords: bool,

    /// Decimals of the coordinates
    #[arg(long, default_value_t = 6, value_name = "N", requires = "nc", value_parser = clap::value_parser!(u8).range(6..=9))]
    pub(crate) decimals: u8,

    /// Explain the program's lines in comments
    #[arg(long, requires = "nc")]
    pub(crate) comments: bool,
}

/// `--units`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Units {
    /// Millimetres (G21)
    Mm,
    /// Inches (G20)
    Inch,
}

/// `--plane`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MachinePlane {
    /// G17
    Xy,
    /// G18
    Zx,
    /// G19
    Yz,
}

impl CurveArguments {
    /// Where each output goes that was asked for, by its option.
    pub(crate) fn targets(&self) -> Vec<(&'static str, Target)> {
        let all = [("--svg", &self.svg), ("--nc", &self.nc), ("--csv", &self.csv), ("--json", &self.json)];
        all.into_iter().filter_map(|(option, path)| Some((option, Target::new(path.as_deref()?)))).collect()
    }
}

/// Whether an input comes from the standard input.
pub(crate) fn is_stdin(file: &Path) -> bool {
    file == Path::new("-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, error::ErrorKind};

    fn parse(line: &str) -> Result<CurveArguments, clap::Error> {
        let Command::Curve(arguments) = Arguments::try_parse_from(line.split_whitespace())?.command;
        Ok(*arguments)
    }

    #[test]
    fn the_definition_is_sound_and_the_helps_examples_parse() {
        Arguments::command().debug_assert();
        let examples: Vec<_> = CURVE_HELP.lines().filter(|line| line.starts_with("  minvar ")).collect();
        assert_eq!(examples.len(), 7);
        for example in examples {
            let line = example.split(" < ").next().unwrap_or_default();
            parse(line).unwrap_or_else(|error| panic!("{line}: {error}"));
        }
    }

    #[test]
    fn a_path_takes_its_options_and_has_defaults() {
        let path = parse("minvar curve a --nc b").expect("complete").path;
        assert_eq!((path.feed, path.safe_height, path.depth, path.path_tolerance), (None, None, 0.0, 0.01));
        let path =
            parse("minvar curve a --nc b --feed 100 --safe-height 5 --depth -1.5").expect("complete").path;
        assert_eq!(
            (path.feed, path.safe_height, path.depth, path.path_tolerance),
            (Some(100.0), Some(5.0), -1.5, 0.01)
        );
    }

    #[test]
    fn a_polygon_is_read_point_by_point() {
        let found = parse("minvar curve a --svg b").expect("complete");
        assert!(found.polygon.is_empty());
        assert_eq!(polygon("0,0 6,-6"), Ok(Polygon(vec![[0.0; 3], [6.0, -6.0, 0.0]])));
        assert_eq!(polygon("0,0 6,x"), Err("`x` is not a number".into()));
        assert_eq!(polygon("0,0 6"), Err("`6` is not a point `x,y`".into()));
        assert!(polygon("1,1").is_err() && polygon("0,0 inf,1").is_err());
    }

    #[test]
    fn path_options_without_a_path_are_refused() {
        for option in [
            "--feed 1",
            "--depth 1",
            "--path-tolerance 1",
            "--reference-weight 1",
            "--units inch",
            "--plane yz",
            "--chords",
            "--decimals 7",
        ] {
            let error = parse(&format!("minvar curve a {option}")).expect_err(option);
            assert_eq!(error.kind(), ErrorKind::MissingRequiredArgument, "{option}");
        }
        assert!(parse("minvar curve a").is_ok(), "defaults do not count");
    }

    #[test]
    fn a_tolerance_is_the_curves_and_a_path_has_its_own() {
        let found = parse("minvar curve a --tolerance 1e-6 --nc b --path-tolerance 0.5").expect("complete");
        assert_eq!((found.tolerance, found.path.path_tolerance), (Some(1e-6), 0.5));
        assert_eq!(found.elements_per_span, None);
        let found = parse("minvar curve a --tension 1 --bending 2 --length 3").expect("complete").shape;
        assert_eq!((found.tension, found.bending, found.length), (1.0, 2.0, 3.0));
        let found = parse("minvar curve a --reference r.json").expect("complete").shape;
        assert_eq!((found.reference.as_deref(), found.reference_weight), (Some(Path::new("r.json")), 1.0));
        let error = parse("minvar curve a --reference r --tolerance 1").expect_err("both");
        assert_eq!(error.kind(), ErrorKind::ArgumentConflict);
    }

    #[test]
    fn functionals_take_any_case() {
        for (name, functional) in [
            ("mvc", Functional::Mvc),
            ("MEC", Functional::Mec),
            ("si-mvc", Functional::SiMvc),
            ("SI-Mec", Functional::SiMec),
            ("space-mvc", Functional::SpaceMvc),
            ("Space-MEC", Functional::SpaceMec),
        ] {
            let found = parse(&format!("minvar curve a --functional {name}")).expect(name).functional;
            assert_eq!((found, found.name()), (functional, name.to_lowercase().as_str()));
        }
        assert!(parse("minvar curve a --functional simvc").is_err());
    }

    #[test]
    fn counts_out_of_range_are_refused() {
        for option in
            ["--elements-per-span 0", "--elements-per-span 1025", "--samples 1", "--nc b --decimals 5"]
        {
            assert!(parse(&format!("minvar curve a {option}")).is_err(), "{option}");
        }
    }
}
