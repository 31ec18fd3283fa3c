//! Figures for other programs: samples as CSV, the curve as JSON.

use crate::constraints::Specification;
use crate::solve::{Options, Solution};
use crate::trace::Trace;
use minvar::curve::Element;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// The first line of the CSV file: `t…` unit tangent, `k…` curvature vector.
const HEAD: &str = "element,t,s,x,y,z,tx,ty,tz,kx,ky,kz,kappa,torsion,dkappa_ds\n";

/// The samples of a trace, a line each. Elements count from 0; a figure that does not exist is an empty cell.
pub(crate) fn csv(trace: &Trace) -> String {
    let mut out = HEAD.to_owned();
    for sample in &trace.samples {
        out += &sample.element.to_string();
        let vectors = [sample.point, sample.tangent, sample.curvature];
        let numbers = [Some(sample.t), Some(sample.s)]
            .into_iter()
            .chain(vectors.into_iter().flatten().map(Some))
            .chain([Some(sample.kappa), sample.torsion, sample.dkappa_ds]);
        for number in numbers {
            out.push(',');
            if let Some(number) = number {
                // The shortest digits that read back as the same number; `+ 0.0` turns -0 into 0.
                let _ = write!(out, "{:?}", number + 0.0);
            }
        }
        out.push('\n');
    }
    out
}

/// The curve and its figures as one JSON object.
#[derive(Serialize)]
struct Report<'a> {
    status: &'static str,
    iterations: usize,
    functional: &'static str,
    value: f64,
    length: f64,
    variation: f64,
    bending: f64,
    curvature_min: f64,
    curvature_max: f64,
    /// Rows `C(0), C'(0), C''(0), C''(1), C'(1), C(1)`.
    elements: Vec<[[f64; 3]; 6]>,
    name: &'a str,
    closed: bool,
    joints: Vec<&'a str>,
    elements_per_span: u32,
    fine_value: f64,
    gradient: f64,
    linearisations: usize,
    /// The estimated distance from the true minimum, where a tolerance was asked for.
    error: Option<f64>,
    options: Asked<'a>,
}

/// What was asked for beyond the functional; 0 where it was not.
#[derive(Serialize)]
struct Asked<'a> {
    tension: f64,
    bending: f64,
    length: f64,
    tolerance: f64,
    reference: Option<&'a str>,
    reference_weight: Option<f64>,
}

/// What a reference shape needs of such a file.
#[derive(Deserialize)]
struct Shape {
    elements: Vec<[[f64; 3]; 6]>,
}

/// The elements of a file that `--json` wrote, or why they cannot be read.
pub(crate) fn elements(bytes: &[u8]) -> Result<Vec<Element>, String> {
    let shape: Shape = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    Ok(shape.elements.into_iter().map(|rows| Element { rows }).collect())
}

/// The solution as JSON, every number with the digits that read back as the same number.
pub(crate) fn json(
    specification: &Specification,
    options: &Options,
    solution: &Solution,
) -> Result<String, String> {
    let report = Report {
        status: solution.status.name(),
        iterations: solution.iterations,
        functional: solution.functional.name(),
        value: solution.value,
        length: solution.length,
        variation: solution.variation,
        bending: solution.bending,
        curvature_min: solution.curvature_min,
        curvature_max: solution.curvature_max,
        elements: solution.elements.iter().map(|element| element.rows).collect(),
        name: &specification.name,
        closed: specification.closed,
        joints: specification.joints.iter().map(|joint| joint.name.as_str()).collect(),
        elements_per_span: options.elements_per_span,
        fine_value: solution.fine_value,
        gradient: solution.gradient,
        linearisations: solution.linearisations,
        error: solution.error,
        options: Asked {
            tension: options.tension,
            bending: options.bending,
            length: options.length,
            tolerance: options.tolerance,
            reference: options.reference.as_ref().map(|shape| shape.name.as_str()),
            reference_weight: options.reference.as_ref().map(|shape| shape.weight),
        },
    };
    let text = serde_json::to_string(&report).map_err(|error| format!("cannot write JSON: {error}"))?;
    Ok(text + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints;
    use crate::solve::Functional;
    use crate::trace::shapes;
    use minvar::solve::Status;
    use serde_json::Value;

    fn solution(elements: Vec<Element>) -> Solution {
        Solution {
            status: Status::Converged,
            iterations: 7,
            linearisations: 8,
            functional: Functional::Mvc,
            error: None,
            value: 0.1,
            fine_value: 0.1,
            gradient: 0.0,
            length: 1.0 / 3.0,
            variation: 1e-300,
            bending: 4.0,
            curvature_min: -5.0,
            curvature_max: 6.0,
            starts: vec![0, elements.len()],
            elements,
        }
    }

    #[test]
    fn csv_has_a_line_a_sample_and_every_digit() {
        let elements =
            [shapes::quarter(1.0), shapes::polynomial([[0.0; 3], [1.0, 2.0, 3.0], [0.0; 3], [0.0; 3]])];
        let trace = Trace::new(&elements, 4);
        let text = csv(&trace);
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!((lines.len(), lines[0].len()), (9, 15));
        assert!(lines.iter().all(|line| line.len() == 15));
        for (line, sample) in lines[1..].iter().zip(&trace.samples) {
            let number = |column: usize| line[column].parse::<f64>().expect("a number");
            assert_eq!(line[0], sample.element.to_string());
            assert_eq!([number(1), number(2)], [sample.t, sample.s]);
            assert_eq!([number(3), number(4), number(5)], sample.point);
            assert_eq!([number(9), number(10), number(11)], sample.curvature);
            assert_eq!(number(12), sample.kappa);
        }
        assert_eq!(lines[8][13], "", "a straight element in space has no torsion");
    }

    #[test]
    fn json_has_the_promised_fields_first_and_every_digit() {
        let text = "(G2Joint a (0,0,0)) (G2Joint \"b\" (1,0,0)) (G2Curve c Open (a,\"b\"))";
        let specification = constraints::read(text.as_bytes()).expect("a curve").specification;
        let options = Options { tension: 0.1, bending: 0.2, ..Options::PLAIN };
        let solution = solution(vec![shapes::quarter(1.0 / 3.0)]);
        let text = json(&specification, &options, &solution).expect("JSON");
        let promised = [
            "status",
            "iterations",
            "functional",
            "value",
            "length",
            "variation",
            "bending",
            "curvature_min",
            "curvature_max",
            "elements",
        ];
        let places: Vec<_> =
            promised.iter().map(|field| text.find(&format!("\"{field}\":")).expect(field)).collect();
        assert!(
            places.is_sorted() && text.starts_with("{\"status\":\"converged\",\"iterations\":7,"),
            "{text}"
        );
        let value: Value = serde_json::from_str(&text).expect("valid JSON");
        assert_eq!(value["length"].as_f64(), Some(1.0 / 3.0));
        assert_eq!(value["variation"].as_f64(), Some(1e-300));
        assert_eq!(value["joints"][1], "\"b\"");
        assert_eq!(
            (value["options"]["tension"].as_f64(), value["options"]["bending"].as_f64()),
            (Some(0.1), Some(0.2))
        );
        assert!(value["error"].is_null() && value["options"]["reference"].is_null());
        for (row, expected) in solution.elements[0].rows.iter().enumerate() {
            for d in 0..3 {
                assert_eq!(value["elements"][0][row][d].as_f64(), Some(expected[d]));
            }
        }
        assert_eq!(elements(text.as_bytes()), Ok(solution.elements), "what was written is read again");
    }

    #[test]
    fn what_is_no_chain_of_elements_is_refused_in_words() {
        for (text, words) in [
            ("", "EOF"),
            ("[1]", "expected"),
            ("{}", "missing field `elements`"),
            ("{\"elements\":[[[0,0,0]]]}", "expected an array of length 6"),
            ("{\"elements\":[[[0,0,null],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]]}", "expected f64"),
        ] {
            let error = elements(text.as_bytes()).expect_err(text);
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
