//! The command as a user runs it: exit codes, messages, files.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};

const WICKET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/wicket.mvc");
const WOODFORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/woodford.mvc");
const SPACE_CURVE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/space_curve.mvc");
const COVING_SLIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/coving_slide.mvc");
const COVING_CLEAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/coving_clear.mvc");
const PETERS_HELIX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/peters_helix.mvc");
const LOOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/loop.mvc");
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
    let words = [
        "si-mvc:",
        "si-mec:",
        "space-mvc:",
        "space-mec:",
        "--minima <N>",
        "--minimum <K>",
        "(Obstacle Left 0.25 (6,-6,0))",
        "(Obstacle Right 0.25 (0,1,0) (3,1,0))",
        "--tension <W>",
        "--bending <W>",
        "--length <L>",
        "--tolerance <LENGTH>",
        "--path-tolerance <LENGTH>",
        "--reference <FILE>",
        "--reference-weight <A>",
        "a Line (0.5,-12,0) (0,1,0)",
        "b Plane (1,0.5,0.3) (1,0,0)",
        "(Size Curvature 0.27)",
    ];
    for word in words {
        assert!(out.contains(word), "{word} in {out}");
    }
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

/// The JSON of a curve.
fn json(command: &mut Command) -> serde_json::Value {
    let (code, out, error) = run(command.args(["--json", "-", "--quiet"]));
    assert_eq!((code, error.as_str()), (0, ""));
    serde_json::from_str(&out).expect("JSON")
}

fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn an_unbounded_curve_is_told_which_functional_has_a_minimum() {
    let folder = tempfile::tempdir().expect("a folder");
    for (functional, other) in [("mvc", "si-mvc"), ("MEC", "si-mec")] {
        let (code, _, error) = run(minvar(folder.path()).args([ANTIPODAL, "--functional", functional]));
        let words = format!(
            "warning: unbounded: the curve grows without limit while the functional sinks; the scale-invariant functional \
             {other} has a minimum: --functional {other}; or add a constraint, a --tension or a --length\n"
        );
        assert!(code == 1 && error.starts_with(&words), "{code} {error}");
        let (code, out, error) = run(minvar(folder.path()).args([ANTIPODAL, "--functional", other]));
        assert_eq!((code, error.as_str()), (0, ""));
        assert!(out.contains(&format!("\nfunctional  {other} = ")), "{out}");
    }
    for remedy in [["--tension", "0.1"], ["--length", "12"]] {
        assert_eq!(run(minvar(folder.path()).arg(ANTIPODAL).args(remedy)).0, 0, "{remedy:?}");
    }
}

#[test]
fn a_tension_a_bending_term_and_a_length_are_minimised_with_and_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let weights = ["--tension", "0.5", "--bending", "0.25", "--svg", "a.svg"];
    let (code, out, error) = run(minvar(folder.path()).arg(WOODFORD).args(weights));
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(out.contains("\nfunctional  mvc + 0.25 bending + 0.5 length = "), "{out}");
    let svg = fs::read_to_string(folder.path().join("a.svg")).expect("a picture");
    assert!(svg.contains("MVC  ∫ (dκ/ds)² ds + 0.25 ∫ κ² ds + 0.5 L = "), "{svg}");
    let value = json(minvar(folder.path()).arg(WOODFORD).args(&weights[..4]));
    let sum = number(&value["variation"]) + 0.25 * number(&value["bending"]) + 0.5 * number(&value["length"]);
    assert!((number(&value["value"]) - sum).abs() < 1e-6, "{value}");
    assert_eq!((number(&value["options"]["tension"]), number(&value["options"]["bending"])), (0.5, 0.25));

    let (code, out, _) = run(minvar(folder.path()).args([WOODFORD, "--length", "9"]));
    assert!(code == 0 && out.contains(" (given: 9.0)\n"), "{out}");
    let value = json(minvar(folder.path()).args([WOODFORD, "--length", "9"]));
    assert!((number(&value["length"]) - 9.0).abs() < 1e-9 && number(&value["options"]["length"]) == 9.0);
}

#[test]
fn a_tolerance_gives_as_many_elements_as_it_needs() {
    let folder = tempfile::tempdir().expect("a folder");
    let tolerance = ["--tolerance", "1e-8", "--svg", "a.svg"];
    let (code, out, error) = run(minvar(folder.path()).arg(WOODFORD).args(tolerance));
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(out.contains(" (estimated), tolerance 1e-8\n"), "{out}");
    let value = json(minvar(folder.path()).arg(WOODFORD).args(tolerance));
    let count = value["elements"].as_array().map_or(0, Vec::len);
    assert!(count > 6 && count < 6 * 64 && number(&value["elements_per_span"]) == 64.0, "{count}");
    let error = number(&value["error"]);
    assert!(error > 0.0 && error <= 1e-8, "{error}");
    assert!((number(&value["variation"]) - 1.153_720_84).abs() < 2e-8);
    let svg = fs::read_to_string(folder.path().join("a.svg")).expect("a picture");
    assert!(svg.contains(&format!("{count} elements, about ")), "{svg}");
    // The joints are marked where they are: those of the plot at the lengths that the plain curve has there.
    let mut plain = minvar(folder.path());
    run(plain.args([WOODFORD, "--elements-per-span", "8", "--svg", "b.svg"]));
    let stations = |name: &str| -> Vec<f64> {
        let text = fs::read_to_string(folder.path().join(name)).expect(name);
        let document = roxmltree::Document::parse(&text).expect("XML");
        let lines = document.descendants().filter(|node| node.attribute("class") == Some("station"));
        lines.map(|line| line.attribute("x1").and_then(|x| x.parse().ok()).expect("x1")).collect()
    };
    let (found, wanted) = (stations("a.svg"), stations("b.svg"));
    assert_eq!((found.len(), wanted.len()), (7, 7));
    assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 0.1), "{found:?} {wanted:?}");

    let few = ["--tolerance", "1e-10", "--elements-per-span", "2"];
    let (code, out, error) = run(minvar(folder.path()).arg(WOODFORD).args(few));
    assert!(code == 1 && out.contains("\nstatus      stalled after"), "{code} {out}");
    assert!(error.starts_with("warning: stalled: 2 elements a span do not reach the tolerance"), "{error}");
    // A planar curve with one element a span is measured against the true one; in space there is nothing to measure by.
    let one = ["--tolerance", "1e-3", "--elements-per-span", "1"];
    let (code, out, error) = run(minvar(folder.path()).arg(WOODFORD).args(one));
    assert!(
        code == 0 && error.is_empty() && out.contains(" (estimated), tolerance 0.001\n"),
        "{out} {error}"
    );
    let fine = ["--tolerance", "1e-9", "--elements-per-span", "1"];
    let (code, _, error) = run(minvar(folder.path()).arg(WOODFORD).args(fine));
    assert!(code == 1 && error.starts_with("warning: stalled: one element a span does not reach"), "{error}");
    let (code, out, error) = run(minvar(folder.path()).arg(SPACE_CURVE).args(one));
    assert!(code == 1 && out.contains("\nerror       not known, tolerance 0.001\n"), "{out}");
    assert!(
        error.starts_with("warning: stalled: one element a span has nothing to be compared with"),
        "{error}"
    );
}

#[test]
fn a_reference_shape_is_kept_and_smoothed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, ..) =
        run(minvar(folder.path()).args([WOODFORD, "--functional", "mec", "--json", "r.json", "--quiet"]));
    assert_eq!(code, 0);
    let reference = ["--reference", "r.json"];
    let same = json(minvar(folder.path()).arg(WOODFORD).args(reference));
    assert!(number(&same["value"]) < 1e-12 && number(&same["options"]["reference_weight"]) == 1.0);
    let half = json(minvar(folder.path()).arg(WOODFORD).args(reference).args(["--reference-weight", "0.5"]));
    assert!(number(&half["variation"]) < number(&same["variation"]) - 1e-3);
    let (_, out, _) =
        run(minvar(folder.path()).arg(WOODFORD).args(reference).args(["--reference-weight", "0.5"]));
    assert!(out.contains("\nreference   r.json, weight 0.5\n"), "{out}");

    let refused = |arguments: &[&str]| {
        let (code, out, error) = run(minvar(folder.path()).args(arguments));
        assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}");
        error
    };
    assert_eq!(
        refused(&[WOODFORD, "--reference", "r.json", "--elements-per-span", "2"]),
        "error: --reference r.json: it has 6 elements and this curve 12; compute both with the same joints and \
         --elements-per-span\n"
    );
    let weight = refused(&[WOODFORD, "--reference", "r.json", "--reference-weight", "nan"]);
    assert!(weight.starts_with("error: --reference-weight: must be a number from 0 to 1"), "{weight}");
    assert_eq!(
        refused(&[WOODFORD, "--reference", "r.json", "--functional", "si-mvc"]),
        "error: --reference is for --functional mvc alone\n"
    );
    let other = refused(&[WOODFORD, "--reference", WICKET]);
    assert!(other.contains("is no file that --json wrote: expected"), "{other}");
    assert!(refused(&[WOODFORD, "--reference", "none.json"]).contains("cannot read none.json: no such file"));
    assert!(
        refused(&[WOODFORD, "--reference", "r.json", "--json", "./r.json"]).contains("are the same file")
    );
    assert!(refused(&["-", "--reference", "-"]).contains("are both the standard input"));
    let text = fs::read_to_string(folder.path().join("r.json")).expect("the reference");
    let mut value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    value["elements"][3][1] = serde_json::json!([0.0, 0.0, 0.0]);
    fs::write(folder.path().join("bad.json"), value.to_string()).expect("a file");
    let bad = refused(&[WOODFORD, "--reference", "bad.json"]);
    assert!(bad.starts_with("error: --reference bad.json: element 3 has "), "{bad}");
}

#[test]
fn an_option_out_of_range_is_named_as_the_user_wrote_it() {
    let folder = tempfile::tempdir().expect("a folder");
    for option in ["--tension", "--bending", "--length", "--tolerance"] {
        for value in ["-1", "nan", "inf"] {
            let (code, _, error) = run(minvar(folder.path()).args([WOODFORD, option, value]));
            assert!(
                code == 2 && error.starts_with(&format!("error: {option}: must be ")),
                "{option} {value}: {code} {error}"
            );
        }
    }
    let (code, _, error) =
        run(minvar(folder.path()).args([WOODFORD, "--functional", "si-mvc", "--tension", "1"]));
    assert!(
        code == 2 && error.starts_with("error: --tension: ") && error.contains("scale-invariant"),
        "{error}"
    );
    let (code, _, error) = run(minvar(folder.path()).args([WOODFORD, "--length", "6"]));
    assert!(code == 2 && error.starts_with("error: --length 6: the length that was asked for is no greater"));
}

#[test]
fn a_joint_slides_to_where_the_curve_is_fairest() {
    let folder = tempfile::tempdir().expect("a folder");
    let slides = json(minvar(folder.path()).arg(COVING_SLIDE));
    let start: Vec<f64> = (0..3).map(|d| number(&slides["elements"][0][0][d])).collect();
    assert!((start[0] - 0.5).abs() < 1e-12 && start[1] > -11.0 && start[2] == 0.0, "{start:?}");
    let text = fs::read_to_string(COVING_SLIDE).expect("the file");
    fs::write(folder.path().join("fixed.mvc"), text.replace("Line (0.5,-12,0) (0,1,0)", "(0.5,-12,0)"))
        .expect("a file");
    let fixed = json(minvar(folder.path()).arg("fixed.mvc"));
    assert!(number(&slides["value"]) < 0.9 * number(&fixed["value"]));

    // In a plane, in space, with a tolerance too.
    let rail = Path::new(COVING_SLIDE).with_file_name("rail_slide.mvc");
    for more in [[].as_slice(), &["--tolerance", "1e-4", "--svg", "a.svg"]] {
        let value = json(minvar(folder.path()).arg(&rail).args(more));
        let rows = value["elements"].as_array().expect("elements");
        let off = |row: &serde_json::Value| {
            let d = |i: usize, from: f64| number(&row[0][i]) - from;
            (d(0, 1.0) + 0.2 * d(1, 0.5) - 0.1 * d(2, 0.3)).abs()
        };
        assert!(rows.iter().any(|row| off(row) < 1e-12), "{value}");
    }
}

#[test]
fn a_curvature_of_given_size_keeps_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = Path::new(COVING_SLIDE).with_file_name("size_curvature.mvc");
    let text = fs::read_to_string(&file).expect("the file");
    for value in ["0.3", "(0,0.3,0)", "(-0.3,0,0)"] {
        fs::write(folder.path().join("a.mvc"), text.replace("Curvature 0.3", &format!("Curvature {value}")))
            .expect("a file");
        let (code, out, error) = run(minvar(folder.path()).args(["a.mvc", "--csv", "-"]));
        assert!(code == 0 && error.contains("converged"), "{code} {error}");
        let kappa: f64 = out
            .lines()
            .nth(1)
            .and_then(|line| line.split(',').nth(12))
            .and_then(|x| x.parse().ok())
            .expect("kappa");
        assert!((kappa - 0.3).abs() < 1e-12, "{value}: {kappa}");
    }
}

/// How far a curve's samples lie from the duct, `x` 0 to 6 and `y` 0 to -6; negative inside.
fn from_the_duct(csv: &str) -> f64 {
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    let distance = |line: &str| {
        let cells: Vec<_> = line.split(',').collect();
        let (right, below) = (number(cells[3]) - 6.0, -6.0 - number(cells[4]));
        if right > 0.0 || below > 0.0 { right.max(0.0).hypot(below.max(0.0)) } else { right.max(below) }
    };
    csv.lines().skip(1).map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_curve_keeps_clear_of_the_files_obstacles() {
    let folder = tempfile::tempdir().expect("a folder");
    for per_span in ["1", "8"] {
        let outputs = ["--csv", "a.csv", "--svg", "a.svg", "--samples", "201"];
        let mut command = minvar(folder.path());
        let (code, out, error) =
            run(command.args([COVING_CLEAR, "--elements-per-span", per_span]).args(outputs));
        assert_eq!((code, error.as_str()), (0, ""), "{out}");
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
        let clearance = from_the_duct(&read("a.csv"));
        assert!((clearance - 0.25).abs() < 1e-9, "{clearance}");
        assert!(read("a.svg").contains("class=\"clearance\""));
    }
    // On the other side there is nothing to keep clear of, and without obstacles the corner is cut off.
    let text = fs::read_to_string(COVING_CLEAR).expect("the coving");
    let free = text.lines().filter(|line| !line.starts_with("(Obstacle")).collect::<Vec<_>>().join("\n");
    let plain: String = free.clone() + "\n";
    fs::write(folder.path().join("plain.mvc"), plain).expect("a file");
    let (code, out, _) = run(minvar(folder.path()).args(["plain.mvc", "--quiet", "--csv", "-"]));
    assert!(code == 0 && from_the_duct(&out) < -1.0, "{}", from_the_duct(&out));
    fs::write(folder.path().join("right.mvc"), free + "(Obstacle Right 0.25 (6,-6,0))").expect("a file");
    let (code, right, _) = run(minvar(folder.path()).args(["right.mvc", "--quiet", "--csv", "-"]));
    assert!(code == 0 && right == out, "a duct to the right is clear already");
}

#[test]
fn joints_are_marked_where_they_are_among_contacts() {
    let folder = tempfile::tempdir().expect("a folder");
    let woodford = fs::read_to_string(WOODFORD).expect("Woodford's points");
    fs::write(folder.path().join("a.mvc"), woodford + "(Obstacle Right 0.1 (0.3,0.8,0))").expect("a file");
    let options = ["--elements-per-span", "3", "--svg", "a.svg", "--json", "a.json"];
    let (code, out, error) = run(minvar(folder.path()).arg("a.mvc").args(options));
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(out.contains(" 7 joints, 21 elements\n"), "one contact in the first span: {out}");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    let (svg, json) = (read("a.svg"), read("a.json"));
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let picture = roxmltree::Document::parse(&svg).expect("XML");
    let stations: Vec<f64> = picture
        .descendants()
        .filter(|node| node.attribute("class") == Some("station"))
        .map(|line| line.attribute("x1").and_then(|x| x.parse().ok()).expect("x1"))
        .collect();
    // The chords of the elements tell about where along the curve joint b is: at the end of six of them.
    let chord = |element: &serde_json::Value| -> f64 {
        let [x, y] = [0, 1].map(|d| number(&element[5][d]) - number(&element[0][d]));
        x.hypot(y)
    };
    let elements = json["elements"].as_array().expect("elements");
    assert_eq!(elements[6][0], serde_json::json!([1.0, 1.9, 0.0]));
    let part = elements[..6].iter().map(chord).sum::<f64>() / elements.iter().map(chord).sum::<f64>();
    let shown = (stations[1] - stations[0]) / (stations[6] - stations[0]);
    assert!((part - shown).abs() < 0.01, "{part} {shown}");
}

#[test]
fn obstacles_that_are_not_possible_are_shown_where_they_stand() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |arguments: &[&str]| {
        let (code, out, error) = run(minvar(folder.path()).args(arguments));
        assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}");
        error
    };
    let write = |name: &str, to: &str| {
        let text = fs::read_to_string(COVING_CLEAR).expect("the coving").replace("(6,0,0)", to);
        fs::write(folder.path().join(name), text).expect("a file");
    };
    write("clear.mvc", "(6,0,0)");
    run(minvar(folder.path()).args(["clear.mvc", "--quiet", "--json", "r.json"]));
    for (option, value) in [("--tolerance", "1e-3"), ("--length", "30"), ("--reference", "r.json")] {
        let error = refused(&["clear.mvc", option, value]);
        let words = format!("error: obstacles cannot be combined with {option}\n --> clear.mvc:5:1\n");
        assert!(error.starts_with(&words), "{error}");
    }
    let error = refused(&["clear.mvc", "--dimension", "3"]);
    assert!(
        error.starts_with("error: obstacles cannot be combined with --dimension 3\n --> clear.mvc:5:1\n")
    );
    write("apart.mvc", "(6,0,1)");
    for options in [&["apart.mvc"][..], &["apart.mvc", "--dimension", "2"]] {
        let error = refused(options);
        let words = "error: this obstacle does not lie in one plane with the joints: ";
        assert!(error.starts_with(words) && error.contains(" --> apart.mvc:6:1\n"), "{error}");
    }
    write("far.mvc", "(6,1e150,0)");
    let error = refused(&["far.mvc"]);
    assert!(
        error.starts_with("error: this obstacle has a number that is not finite or beyond 1e100")
            && error.contains(" --> far.mvc:6:1\n"),
        "{error}"
    );
    let space = "(G2Joint a (0,0,0))(G2Joint b (1,1,0))(G2Joint c (2,0,1))(G2Joint d (3,1,0))(G2Curve c Open (a,b,c,d))";
    fs::write(folder.path().join("space.mvc"), format!("{space}\n(Obstacle Left 1 (0,5,0))"))
        .expect("a file");
    let error = refused(&["space.mvc", "--dimension", "2"]);
    assert!(error.starts_with("error: a planar curve was asked for but the data do not lie"), "{error}");
}

#[test]
fn minima_are_listed_the_lowest_first_and_one_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let listed = |arguments: &[&str]| {
        let (code, out, error) =
            run(minvar(folder.path()).args([LOOP, "--elements-per-span", "2"]).args(arguments));
        assert_eq!((code, error.as_str()), (0, ""), "{arguments:?}");
        let table: Vec<Vec<String>> = out
            .lines()
            .skip_while(|line| !line.starts_with("  minimum"))
            .skip(1)
            .map(|line| line.split_whitespace().map(str::to_owned).collect())
            .collect();
        let written = out.lines().find_map(|line| line.strip_prefix("variation   ")).map(str::to_owned);
        (table, written.expect("the figures"))
    };
    assert_eq!(listed(&[]).0, Vec::<Vec<String>>::new());
    let (table, written) = listed(&["--minima", "8"]);
    assert!(table.len() >= 2, "with and without a loop: {table:?}");
    assert!(table[0][0] == ">" && table[0][1] == "1" && table[0][3] == written, "{table:?} {written}");
    let value = |row: &[String]| row[row.len() - 5].parse::<f64>().expect("a value");
    assert!(table.windows(2).all(|pair| value(&pair[0]) < value(&pair[1])), "{table:?}");
    assert!(table.iter().all(|row| row[row.len() - 1] == "converged"), "{table:?}");

    let one = listed(&["--minima", "1"]).0;
    assert!(one.len() == 1 && value(&one[0]) == value(&table[0]), "{one:?}");
    let (second, written) = listed(&["--minima", "8", "--minimum", "2", "--json", "a.json"]);
    assert!(second[0][0] == "1" && second[1][0] == ">" && second[1][3] == written, "{second:?} {written}");
    let json = fs::read_to_string(folder.path().join("a.json")).expect("JSON");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!((number(&json["value"]) / value(&table[1]) - 1.0).abs() < 1e-8, "the second is written");

    let mut command = minvar(folder.path());
    let (code, out, error) =
        run(command.args([WOODFORD, "--minima", "3", "--minimum", "2", "--json", "b.json"]));
    assert_eq!((code, out.as_str(), error.as_str()), (2, "", "error: --minimum 2: 1 minimum was found\n"));
    assert_eq!(names(folder.path()), ["a.json"]);
    for wrong in [&["--minimum", "1"][..], &["--minima", "0"], &["--minima", "2", "--minimum", "0"]] {
        assert_eq!(run(minvar(folder.path()).arg(WOODFORD).args(wrong)).0, 2, "{wrong:?}");
    }
    // Where nothing converges there is no minimum to list, whichever is asked for.
    let (code, out, error) = run(minvar(folder.path()).args([ANTIPODAL, "--minima", "3", "--minimum", "2"]));
    assert!(code == 1 && out.contains("\nstatus      unbounded") && !out.contains("minimum"), "{out}");
    assert!(error.starts_with("warning: unbounded:"), "{error}");
}

#[test]
fn space_functionals_count_torsion_and_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let formulas = [("space-mvc", "∫ (dκ/ds)² + (dτ/ds)² ds"), ("Space-MEC", "∫ κ² + τ² ds")];
    for (functional, formula) in formulas {
        let mut command = minvar(folder.path());
        let (code, out, error) = run(command.args([
            PETERS_HELIX,
            "--functional",
            functional,
            "--svg",
            "a.svg",
            "--json",
            "a.json",
        ]));
        assert_eq!((code, error.as_str()), (0, ""));
        let name = functional.to_lowercase();
        assert!(out.contains(&format!("\nfunctional  {name} = ")), "{out}");
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
        assert!(read("a.svg").contains(formula), "{functional}");
        let json: serde_json::Value = serde_json::from_str(&read("a.json")).expect("JSON");
        assert_eq!(json["functional"], serde_json::json!(name));
        let plain = number(&json[if name == "space-mvc" { "variation" } else { "bending" }]);
        assert!((number(&json["value"]) - plain).abs() > 1e-3, "torsion counts: {json}");
    }
    // In a plane there is no torsion.
    let of = |functional: &str| {
        number(&json(minvar(folder.path()).args([WOODFORD, "--functional", functional]))["value"])
    };
    assert_eq!((of("space-mvc"), of("space-mec")), (of("mvc"), of("mec")));
}
