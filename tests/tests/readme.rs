//! The README's C program is compiled and run as a stranger would.

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
