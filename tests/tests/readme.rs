//! The README's C program is compiled and run as a stranger would; its figures for a controller are those of docs/bounds.md.

use minvar_tests::toolchain::{compile, library, must, root, scratch};
use std::fs;
use std::process::Command;

#[test]
fn the_c_program_of_the_readme_makes_a_half_circle() {
    let readme = fs::read_to_string(root().join("README.md")).expect("the README is there");
    let code = readme.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a C program");
    let source = scratch().join("half_circle.c");
    fs::write(&source, code).expect("the target directory can be written");
    let program = scratch().join("half_circle");
    let mut command = compile("half_circle.c");
    command.arg(&source).arg(library().join("libminvar.a")).arg("-lm").arg("-o").arg(&program);
    must(&mut command, "compiling the README's program");
    let text = must(&mut Command::new(&program), "the README's program");
    assert!(text.starts_with("converged") && text.ends_with("length 3.14159\n"), "{text}");
}

/// The cells of a table's rows, where a row's first cells are these.
fn rows<'a>(text: &'a str, first: &[&str]) -> Vec<Vec<&'a str>> {
    let cells = |line: &'a str| line.split('|').skip(1).map(str::trim).collect::<Vec<_>>();
    text.lines()
        .filter(|line| line.starts_with('|'))
        .map(cells)
        .filter(|row| row.starts_with(first))
        .collect()
}

#[test]
fn the_figures_for_a_controller_are_those_of_the_bounds() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("the file is there");
    let (readme, bounds) = (read("README.md"), read("docs/bounds.md"));
    let million = |text: &str| text.parse::<f64>().expect("a number") / 1e6;
    for (column, joints, decrease) in
        [(1, "2 joints", "1e-12"), (2, "2 joints", "1e-6"), (3, "7 joints", "1e-12"), (4, "7 joints", "1e-6")]
    {
        let told = &rows(&readme, &[joints, decrease])[0];
        let loosely = if decrease == "1e-6" { ", to 1e-6" } else { "" };
        let solve = &rows(&bounds, &[&format!("{joints}, planar{loosely}"), "MVC"])[0];
        let header = &rows(&bounds, &["curve", "functional"])[0];
        let figure = |name: &str| solve[header.iter().position(|cell| *cell == name).expect(name)];
        assert_eq!(told[2].replace(',', ""), figure("stack, bytes, cortex-m7"), "{joints} {decrease}");
        assert_eq!(told[3].replace(',', ""), figure("workspace, bytes"), "{joints} {decrease}");
        let near = |told: &str, found: f64| {
            let told: f64 = told.split(' ').next().unwrap_or("").parse().expect("a number");
            assert!((told - found).abs() <= 0.05 * found, "{joints} {decrease}: {told}, found {found}");
        };
        near(told[4], million(figure("instructions, cortex-m7")));
        let cycles = million(rows(&bounds, &["cycles, at most"])[0][column]);
        near(told[5], cycles);
        near(told[6], cycles / 0.4);
    }
    let hashes = read("tests/cross/hashes.txt").lines().count();
    assert!(readme.contains(&format!("{},{:03} outputs", hashes / 1000, hashes % 1000)), "{hashes} outputs");
    for (function, kilobytes) in [("minvar_curve_solve", ["36 KB", "32.5 KB"])] {
        let row = &rows(&bounds, &[function])[0];
        for (told, column) in kilobytes.into_iter().zip([1, 2]) {
            assert!(readme.contains(told));
            let told: f64 = told.split(' ').next().unwrap_or("").parse().expect("a number");
            let found: f64 = row[column].parse().expect("a number of bytes");
            assert!((told - found / 1000.0).abs() <= 0.2, "{told}, found {found}");
        }
    }
}
