//! The command's readers: a constraint file of any bytes, and what the command makes of those that can be read. A line that
//! begins with `;!` is a comment to the reader; here its letters choose the command's options. What follows a line `#json` is
//! the file that `--reference` names.

use crate::result::direction;
use clap::Parser;
use minvar::solve::Status;
use minvar::toolpath::Plane;
use minvar_cli::arguments::{Arguments, Command};
use minvar_cli::constraints::{Given, Reading, Specification, read};
use minvar_cli::{Failure, Made, make};
use minvar_tests::curves::{Vector, sub, times};
use minvar_tests::paths::interpret;
use std::collections::HashSet;
use std::fmt::Write;

/// Longer files are read but not computed.
const MOST_JOINTS: usize = 6;

/// The options that the letters from `a` on choose.
const OPTIONS: [&[&str]; 24] = [
    &["--functional", "mec"],
    &["--functional", "si-mvc"],
    &["--functional", "si-mec"],
    &["--functional", "space-mvc"],
    &["--functional", "space-mec"],
    &["--elements-per-span", "2"],
    &["--elements-per-span", "5"],
    &["--tolerance", "0.001", "--elements-per-span", "4"],
    &["--tension", "0.5"],
    &["--bending", "0.25"],
    &["--length", "12"],
    &["--minima", "3"],
    &["--minima", "4", "--minimum", "2"],
    &["--continuation", "2"],
    &["--dimension", "2"],
    &["--dimension", "3"],
    &["--reference", "shape.json"],
    &["--reference", "shape.json", "--reference-weight", "0.5"],
    &["--chords"],
    &["--plane", "zx"],
    &["--units", "inch", "--comments"],
    &["--depth", "-1", "--decimals", "9"],
    &["--polygon", "0,0 6,0 6,-6 0,-6"],
    &["--path-tolerance", "0.00001"],
];

/// Runs an input.
pub fn run(bytes: &[u8]) {
    let parted = b"\n#json\n";
    let at = bytes.windows(parted.len()).position(|window| window == parted);
    let (file, shape) = at.map_or((bytes, &[][..]), |at| (&bytes[..at], &bytes[at + parted.len()..]));
    match read(file) {
        Err(fault) => {
            let again = read(file).expect_err("the same file is read");
            assert_eq!(*fault, *again);
            let text = String::from_utf8_lossy(file);
            let ends = text.matches(['\n', '\r']).count();
            assert!((1..=ends + 1).contains(&fault.line) && fault.column >= 1, "{fault:?}");
            assert!(!fault.message.is_empty());
            let shown = fault.render("a.mvc", false);
            assert!(shown.contains(&format!("a.mvc:{}:{}", fault.line, fault.column)), "{shown}");
            assert!(!shown.contains('\u{1b}'), "an escape in {shown:?}");
            let _ = fault.render("a.mvc", true);
        }
        Ok(Reading { specification, warnings }) => {
            warnings.iter().for_each(|warning| drop(warning.render("a.mvc", false)));
            sensible(&specification, file);
            rewritten(&specification);
            if specification.joints.len() <= MOST_JOINTS && specification.obstacles.len() <= 2 {
                computed(file, shape);
            }
        }
    }
}

/// What the reader promises of what it lets through: among it that every number is one of the file's.
fn sensible(specification: &Specification, file: &[u8]) {
    let text = String::from_utf8_lossy(file);
    let words = text.split(|c: char| c.is_whitespace() || "(),;\u{feff}".contains(c));
    let numbers: HashSet<u64> = words.filter_map(|word| word.parse().ok()).map(f64::to_bits).collect();
    let is_there = |x: &f64| numbers.contains(&x.to_bits());
    // A curvature may be given by its size alone: the reader lays it along the tangent.
    let is_sized = |value: Vector, tangent: Given| {
        let (Given::Fixed(tangent) | Given::Initial(tangent)) = tangent else { return false };
        let towards = direction(tangent);
        numbers.iter().map(|bits| f64::from_bits(*bits)).any(|size| {
            let off = sub(value, times(towards, size));
            size >= 0.0 && off.iter().all(|off| off.abs() <= 1e-14 * size + f64::MIN_POSITIVE)
        })
    };
    let least = if specification.closed { 3 } else { 2 };
    assert!(specification.joints.len() >= least && !specification.name.is_empty());
    for (index, joint) in specification.joints.iter().enumerate() {
        assert!(specification.joints[..index].iter().all(|other| other.name != joint.name), "a name twice");
        let givens =
            [joint.position, joint.tangent[0], joint.tangent[1], joint.curvature[0], joint.curvature[1]];
        for (place, given) in givens.into_iter().enumerate() {
            let (value, guide) = match given {
                Given::Free => continue,
                Given::Initial(value) | Given::Fixed(value) | Given::Size(value) => (value, [1.0; 3]),
                Given::OnLine(value, guide) | Given::OnPlane(value, guide) => (value, guide),
            };
            assert!(value.iter().chain(&guide).all(|x| x.is_finite()) && guide != [0.0; 3], "{given:?}");
            let sized = matches!(given, Given::Size(_)) && is_sized(value, givens[place - 2]);
            assert!(value.iter().all(is_there) || sized, "{given:?} is not in the file");
        }
        assert_ne!(joint.position, Given::Free);
    }
    for obstacle in &specification.obstacles {
        let shape = &obstacle.shape;
        assert!(shape.clearance >= 0.0 && shape.from.iter().chain(&shape.to).all(|x| x.is_finite()));
        let numbers = [shape.clearance].into_iter().chain(shape.from).chain(shape.to);
        assert!(numbers.into_iter().all(|x| is_there(&x)), "{shape:?} is not in the file");
    }
}

/// Written anew from what was understood, the file says the same.
fn rewritten(specification: &Specification) {
    let triple = |[x, y, z]: [f64; 3]| format!("({x:?},{y:?},{z:?})");
    let mut text = String::new();
    for joint in &specification.joints {
        let position = match joint.position {
            Given::Initial(value) => format!("Initial {}", triple(value)),
            Given::OnLine(value, guide) => format!("Line {} {}", triple(value), triple(guide)),
            Given::OnPlane(value, guide) => format!("Plane {} {}", triple(value), triple(guide)),
            Given::Fixed(value) | Given::Size(value) => triple(value),
            Given::Free => String::new(),
        };
        let _ = write!(text, "({:?}Joint {} 1 {position}", joint.continuity, joint.name);
        for (word, sides) in [("Tangent", joint.tangent), ("Curvature", joint.curvature)] {
            for (side, given) in ["Arriving", "Leaving"].into_iter().zip(sides) {
                let side = if sides[0] == sides[1] { "" } else { side };
                let _ = match given {
                    Given::Initial(value) => write!(text, "(Initial {word} {side} {})", triple(value)),
                    Given::Fixed(value) => write!(text, "(Fixed {word} {side} {})", triple(value)),
                    Given::Size(value) => write!(text, "(Size {word} {side} {})", triple(value)),
                    _ => Ok(()),
                };
                if side.is_empty() {
                    break;
                }
            }
        }
        text += ")\n";
    }
    for obstacle in &specification.obstacles {
        let shape = &obstacle.shape;
        let side = if shape.side.0 == 0 { "Left" } else { "Right" };
        let _ = writeln!(
            text,
            "(Obstacle {side} {:?} {} {})",
            shape.clearance,
            triple(shape.from),
            triple(shape.to)
        );
    }
    let names: Vec<_> = specification.joints.iter().map(|joint| joint.name.as_str()).collect();
    let kind = if specification.closed { "Closed" } else { "Open" };
    let _ = writeln!(text, "(G2Curve {} {kind} ({}))", specification.name, names.join(","));
    let again =
        read(text.as_bytes()).unwrap_or_else(|fault| panic!("{}\n{text}", fault.render("again", false)));
    let mut again = again.specification;
    for (joint, from) in again.joints.iter_mut().zip(&specification.joints) {
        (joint.line, joint.column) = (from.line, from.column);
    }
    for (obstacle, from) in again.obstacles.iter_mut().zip(&specification.obstacles) {
        (obstacle.line, obstacle.column) = (from.line, from.column);
    }
    assert_eq!(again, *specification, "written as\n{text}");
}

/// The whole command but its files, with all outputs.
fn computed(file: &[u8], shape: &[u8]) {
    let mut words = vec!["minvar", "curve", "a.mvc", "--svg", "a", "--csv", "b", "--json", "c", "--nc", "d"];
    words.extend(["--samples", "5", "--max-iterations", "15"]);
    let letters = file.split(|byte| *byte == b'\n').filter_map(|line| line.strip_prefix(b";!")).flatten();
    for letter in letters.take(5).filter_map(|letter| letter.checked_sub(b'a')) {
        words.extend(*OPTIONS.get(usize::from(letter)).unwrap_or(&&[][..]));
    }
    let arcs = !words.contains(&"--chords");
    let plane = if words.contains(&"--plane") { Plane::Zx } else { Plane::Xy };
    // Options that exclude each other.
    let Ok(Arguments { command: Command::Curve(arguments) }) = Arguments::try_parse_from(words) else {
        return;
    };
    let made = || {
        let mut said = String::new();
        let made = make(
            &arguments,
            &mut |path| Ok(if path.ends_with("a.mvc") { file } else { shape }.to_vec()),
            &mut |text| said += text,
        );
        (made, said)
    };
    let ((one, said), (other, said_again)) = (made(), made());
    assert_eq!(said, said_again);
    match (one, other) {
        (Ok(one), Ok(other)) => {
            assert_eq!(
                (&one.texts, &one.figures, &one.remarks),
                (&other.texts, &other.figures, &other.remarks)
            );
            texts(&one, plane, arcs);
        }
        (Err(Failure::Input(one)), Err(Failure::Input(other))) => {
            assert!(one == other && !one.is_empty());
        }
        (one, other) => panic!("{one:?} and {other:?}"),
    }
}

/// The texts can be read by those that they are for.
fn texts(made: &Made, plane: Plane, arcs: bool) {
    for (option, text) in &made.texts {
        match *option {
            "--svg" => {
                let picture = roxmltree::Document::parse(text).expect("a picture that is XML");
                let mut values = picture.descendants().flat_map(|node| node.attributes()).map(|a| a.value());
                assert!(!values.any(|value| value.contains("NaN") || value.contains("inf")), "{text}");
            }
            "--json" => {
                let value: serde_json::Value = serde_json::from_str(text).expect("figures that are JSON");
                assert!(value.is_object());
            }
            "--csv" => {
                let numbers = text.lines().skip(1).flat_map(|line| line.split(','));
                let finite = numbers.filter(|word| !word.is_empty()).all(|word| {
                    word.parse::<f64>().is_ok_and(|x| x.is_finite() || made.status != Status::Converged)
                });
                assert!(finite, "{text}");
            }
            _ => {
                let plain: String = text
                    .lines()
                    .map(|line| line.split(" (").next().unwrap_or_default().to_owned() + "\n")
                    .collect();
                let _ = interpret(&plain, plane);
                assert!(arcs || !text.contains("\nG2 ") && !text.contains("\nG3 "));
            }
        }
    }
}
