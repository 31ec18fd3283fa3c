//! The accuracy table: `tests/data/accuracy.csv` says which quantity of which curve is known how well, the README prints
//! it, and this reads both.

use minvar::curve::measure;
use minvar_tests::appendix::figure;
use minvar_tests::ceres::Functional;
use minvar_tests::compare::ours;
use std::fs;
use std::path::PathBuf;

fn data_file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

/// The figure of Appendix A that a curve's name in the table means.
fn id(name: &str) -> &'static str {
    match name {
        "wicket" => "4.2",
        "g2_box" => "4.10-1",
        "g1_box" => "4.10-2",
        "woodford" => "4.11",
        "coving" => "4.22",
        other => panic!("no such curve: {other}"),
    }
}

struct Row {
    text: Vec<String>,
}

impl Row {
    fn number(&self, column: usize) -> f64 {
        self.text[column].parse().expect("a number")
    }
}

fn rows() -> Vec<Row> {
    let text = fs::read_to_string(data_file("accuracy.csv")).expect("the table is there");
    text.lines().skip(1).map(|line| Row { text: line.split(',').map(str::to_owned).collect() }).collect()
}

#[test]
fn every_quantity_is_as_accurate_as_the_table_says() {
    let mut wrong = Vec::new();
    for row in rows() {
        let functional = if row.text[1] == "mec" { Functional::Mec } else { Functional::Mvc };
        let (report, elements) =
            ours(&figure(id(&row.text[0])), functional, row.text[2].parse().expect("a count"));
        let [least, largest] = measure::curvature_range(&elements).expect("measurable");
        let end = measure::at(&elements, elements.len() - 1, 1.0).expect("measurable");
        let found = match row.text[3].as_str() {
            "variation" => report.variation,
            "bending" => report.bending,
            "length" => report.length,
            "curvature_min" => least.signed_curvature,
            "curvature_max" => largest.signed_curvature,
            "end_curvature" => end.signed_curvature,
            other => panic!("no such quantity: {other}"),
        };
        let (reference, allowed) = (row.number(4), row.number(5));
        let off = (found / reference - 1.0).abs();
        println!("{:60} found {found:.12e}, off by {off:.1e}", row.text[..5].join(" "));
        if !(off <= allowed) {
            wrong.push(format!("{}: {found:e} is off by {off:.2e}", row.text.join(",")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_readme_prints_the_table() {
    let readme = fs::read_to_string(data_file("../../README.md")).expect("the README is there");
    for row in rows() {
        let line = format!("| {} |", row.text.join(" | "));
        assert!(readme.contains(&line), "the README lacks the row\n{line}");
    }
}
