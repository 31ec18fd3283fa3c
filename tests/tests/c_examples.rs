//! The C examples, built as a user builds them: their figures, their files, their refusals.

use minvar::curve::{self, Curve, Element, Joint, Options, Quantity, measure};
use minvar::solve::Silent;
use minvar::toolpath::Plane;
use minvar_tests::paths::{assert_within, interpret};
use minvar_tests::toolchain::{compile, library, must, root, scratch};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

fn coving() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let program = scratch().join("01_coving");
        let mut command = compile("01_coving.c");
        command.arg(root().join("c_examples/01_coving.c")).arg(library().join("libminvar.a"));
        must(command.arg("-lm").arg("-o").arg(&program), "compiling the coving example");
        program
    })
}

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let place = scratch().join(name);
    let _ = fs::remove_dir_all(&place);
    fs::create_dir_all(&place).expect("the target directory can be written");
    place
}

/// The numbers of the table's row that starts with `name`.
fn row(text: &str, name: &str) -> Vec<f64> {
    let line = text
        .lines()
        .find(|line| line.starts_with(name))
        .unwrap_or_else(|| panic!("no row `{name}`:\n{text}"));
    line[name.len()..].split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

fn close(found: f64, wanted: f64, relative: f64) {
    assert!((found / wanted - 1.0).abs() <= relative, "{found} is not {wanted}");
}

#[test]
fn the_coving_has_the_figures_of_the_true_curve_and_clears_the_duct() {
    let place = folder("coving");
    let text = must(Command::new(coving()).arg("c.ngc").arg("0.25").current_dir(&place), "the example");
    // curvature at the wall, length, V, E, curvature at the end, clearance, iterations
    let one = row(&text, "Fig. 4.22, one element");
    close(one[2], 0.00835186064, 1e-7);
    let fine = row(&text, "Fig. 4.22, 8 elements");
    close(fine[0], -0.27, 1e-9);
    close(fine[1], 23.939306, 5e-8);
    close(fine[2], 0.0083516963, 1e-7);
    close(fine[3], 0.189328, 1e-5);
    close(fine[4], -0.06540, 1e-4);
    assert!(fine[5] < -0.45, "the published curve cuts off the corner of a square duct: {}", fine[5]);
    let clear = row(&text, "clear of the duct");
    close(clear[5], 0.25, 1e-6);
    // The curvature at the wall that clears the duct without obstacles (`coving_clear` in tests/data/truth.csv).
    assert!(clear[2] < 0.55 * 1.662764e-2, "{}", clear[2]);
    // The same curve in another way: through the place where it touches, as a joint at which nothing else is given.
    let ends = [
        Joint::at([0.5, -12.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0])),
        Joint::at([20.0, -0.5, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ];
    let options = Options { elements_per_span: 8, ..Options::DEFAULT };
    let mut workspace = vec![0.0; 20_000];
    let mut elements = [Element::ZERO; 16];
    // The curve through a place of the circle around the corner: how steeply it enters the circle there, and V.
    let mut through = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let joints = [ends[0], Joint::at([6.0 + 0.25 * cos, -6.0 + 0.25 * sin, 0.0]), ends[1]];
        let curve = Curve::open(&joints);
        let report = curve::solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent);
        let [tx, ty, _] = measure::at(&elements, 7, 1.0).expect("a place").tangent;
        (tx * cos + ty * sin, report.expect("good data").variation)
    };
    // It touches where it does not enter.
    let (mut low, mut high) = (-90.0, 0.0);
    while high - low > 1e-7 {
        let middle = 0.5 * (low + high);
        if through(middle).0 < 0.0 { low = middle } else { high = middle }
    }
    close(clear[2], through(low).1, 1e-8);

    // The printed program against that curve, measured densely and independently.
    let program = fs::read_to_string(place.join("c.ngc")).expect("the program was written");
    let (start, pieces) = interpret(&program, Plane::Xy);
    assert_eq!(start, [0.5, -12.0, 0.0]);
    assert!(program.starts_with("G20\n") && program.ends_with("M2\n"));
    let found = assert_within(&elements, &pieces, 0.001 + 1e-6, 400);
    assert!(found > 0.0005, "arcs should use their tolerance: {found}");

    // No sampled point of the path is in the duct or nearer to it than was asked for.
    for piece in &pieces {
        for k in 0..=100 {
            let [x, y, _] = piece.point(f64::from(k) / 100.0);
            let (dx, dy) = ((x - 6.0).max(0.0), (-6.0 - y).max(0.0));
            assert!(dx.hypot(dy) > 0.25 - 0.0011, "({x}, {y}) is too near to the duct");
        }
    }
    assert_eq!(fs::read_dir(&place).expect("the folder").count(), 1, "nothing but the program is left");
}

fn refused(arguments: &[&str], code: i32, says: &str) {
    let output: Output = Command::new(coving()).args(arguments).output().expect("the example runs");
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(error.contains(says), "{arguments:?}: {error}");
}

#[test]
fn an_output_that_cannot_be_written_is_said_and_leaves_nothing() {
    let place = folder("refused");
    let inside = place.join("missing/c.ngc");
    refused(&[&inside.to_string_lossy()], 3, "No such file");
    refused(&["/dev/null/c.ngc"], 3, "Not a directory");
    assert_eq!(fs::read_dir(&place).expect("the folder").count(), 0);
}

#[test]
fn a_clearance_out_of_range_is_refused() {
    for wrong in ["-1", "nan", "4", "abc", "0.5x", ""] {
        refused(&["never.ngc", wrong], 2, "clearance");
    }
    refused(&["/dev/full"], 2, "must end in .ngc");
}
