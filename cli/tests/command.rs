//! The command as a user runs it: exit codes, messages, files.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};

const WICKET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/wicket.mvc");
const WOODFORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/woodford.mvc");
const ANTIPODAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/antipodal_s.mvc");

fn minvar(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_minvar"));
    command.current_dir(folder).stdin(Stdio::null()).arg("curve");
    command
}

fn run(command: &mut Command) -> (i32, String, String) {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (status.code().expect("an exit code"), text(stdout), text(stderr))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

#[test]
fn wrong_input_is_exit_code_2_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("bad.mvc"), "(G2Joint a (0,0,0))\n(G2Joint b (1,x,0))\n").expect("a file");
    let (code, out, error) = run(minvar(folder.path()).args(["bad.mvc", "--svg", "a.svg"]));
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(error.starts_with("error: `x` is not a number\n --> bad.mvc:2:15\n"), "{error}");
    assert_eq!(names(folder.path()), ["bad.mvc"]);
}

#[test]
fn a_missing_file_a_folder_and_a_wrong_option_are_exit_code_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, _, error) = run(minvar(folder.path()).arg("none.mvc"));
    assert_eq!((code, error.as_str()), (2, "error: cannot read none.mvc: no such file or directory\n"));
    assert_eq!(run(minvar(folder.path()).arg(".")).0, 2);
    assert_eq!(run(minvar(folder.path()).args([WICKET, "--frobnicate"])).0, 2);
    for option in [["--path-tolerance", "0"], ["--feed", "0"], ["--safe-height", "-1"]] {
        let (code, _, error) = run(minvar(folder.path()).args([WICKET, "--nc", "a.ngc"]).args(option));
        assert!(code == 2 && error.starts_with("error: no NC path: the "), "{option:?}: {code} {error}");
    }
    assert!(names(folder.path()).is_empty(), "nothing is written");
    let (code, _, error) = run(minvar(folder.path()).arg("/dev/zero"));
    assert!(code == 2 && error.contains("larger than 256 MiB"), "{code} {error}");
}

#[test]
fn a_planar_curve_may_be_asked_for_by_dimension() {
    let folder = tempfile::tempdir().expect("a folder");
    let space = "(G2Joint a (0,0,0))(G2Joint b (1,1,0))(G2Joint c (2,0,1))(G2Joint d (3,1,0))(G2Curve c Open (a,b,c,d))";
    fs::write(folder.path().join("s.mvc"), space).expect("a file");
    let (code, _, error) = run(minvar(folder.path()).args(["s.mvc", "--dimension", "2"]));
    assert!(code == 2 && error.contains("do not lie in a plane"), "{code} {error}");
    assert_eq!(run(minvar(folder.path()).args(["s.mvc", "--dimension", "3"])).0, 0);
    assert_eq!(run(minvar(folder.path()).args([WICKET, "--dimension", "3", "--functional", "MVC"])).0, 0);
}

#[test]
fn two_outputs_in_one_place_and_an_output_over_the_input_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(WICKET, folder.path().join("w.mvc")).expect("a copy");
    let (code, _, error) = run(minvar(folder.path()).args(["w.mvc", "--svg", "a", "--csv", "./a"]));
    assert_eq!((code, error.as_str()), (2, "error: --svg and --csv are the same file\n"));
    let (code, _, error) = run(minvar(folder.path()).args(["w.mvc", "--json", "./w.mvc"]));
    assert_eq!((code, error.as_str()), (2, "error: FILE and --json are the same file\n"));
    assert_eq!(names(folder.path()), ["w.mvc"]);
}

#[test]
fn help_goes_to_the_standard_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, error) = run(minvar(folder.path()).arg("--help"));
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(out.contains("Examples:") && out.contains("Exit codes:"));
}

#[test]
fn a_curve_gives_figures_and_all_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let outputs = ["--svg", "a.svg", "--csv", "a.csv", "--json", "a.json", "--nc", "a.ngc"];
    let (code, out, error) =
        run(minvar(folder.path()).arg(WOODFORD).args(outputs).args(["--feed", "600", "--safe-height", "5"]));
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(
        out.starts_with("curve       test, open, 7 joints, 6 elements\nstatus      converged after "),
        "{out}"
    );
    assert!(out.contains("\nfunctional  mvc = 1.1537208"), "{out}");
    assert_eq!(names(folder.path()), ["a.csv", "a.json", "a.ngc", "a.svg"]);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    assert_eq!(read("a.csv").lines().count(), 1 + 6 * 21);
    assert!(read("a.ngc").ends_with("M2\n"));
    let json: serde_json::Value = serde_json::from_str(&read("a.json")).expect("JSON");
    assert_eq!(json["elements"].as_array().map(Vec::len), Some(6));
    assert!((json["value"].as_f64().expect("a number") - 1.153_720_856).abs() < 1e-8);
    assert_eq!(json["elements"][2][5], json["elements"][3][0], "neighbours share their joint");
}

#[test]
fn a_file_on_the_standard_output_is_alone_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = minvar(folder.path())
        .args(["-", "--json", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let text = fs::read(WICKET).expect("the wicket");
    child.stdin.take().expect("a pipe").write_all(&text).expect("written");
    let Output { status, stdout, stderr } = child.wait_with_output().expect("it ends");
    assert_eq!(status.code(), Some(0));
    assert!(serde_json::from_slice::<serde_json::Value>(&stdout).is_ok());
    assert!(stderr.starts_with(b"curve       test, open, 2 joints, 1 element\n"));
    let quiet = run(minvar(folder.path()).args([WICKET, "--json", "-", "--quiet"]));
    assert_eq!((quiet.1.into_bytes(), quiet.2.as_str()), (stdout, ""));
}

#[test]
fn a_curve_that_does_not_converge_is_exit_code_1_and_gets_no_path() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = ["--nc", "a.ngc", "--feed", "600", "--safe-height", "5"];
    let (code, out, error) = run(minvar(folder.path()).arg(ANTIPODAL).args(path).args(["--json", "a.json"]));
    assert_eq!(code, 1);
    assert!(out.contains("\nstatus      unbounded after"), "{out}");
    assert!(
        error.contains("warning: no NC path is written") && error.contains("warning: unbounded:"),
        "{error}"
    );
    assert_eq!(names(folder.path()), ["a.json"]);
}

#[test]
fn an_output_that_cannot_be_written_is_exit_code_3() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, out, error) = run(minvar(folder.path()).args([WICKET, "--csv", "a.csv", "--svg", "no/a.svg"]));
    assert_eq!((code, out.as_str()), (3, ""));
    assert_eq!(error, "error: cannot write no/a.svg: there is no folder no\n");
    assert_eq!(names(folder.path()), [""; 0], "nor was the other output");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = minvar(folder.path())
        .args([WICKET, "--csv", "-", "--samples", "50000", "--quiet"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut first = [0; 7];
    child.stdout.take().expect("a pipe").read_exact(&mut first).expect("the first bytes");
    assert_eq!(&first, b"element");
    let Output { status, stderr, .. } = child.wait_with_output().expect("it ends");
    assert_eq!((status.code(), stderr.as_slice()), (Some(0), b"".as_slice()));
}
