//! Table 4.1 computed anew.

use super::solved::significant;
use crate::appendix::figure;
use crate::ceres::{Functional, Measure, evaluate};
use crate::compare::{SETS, ours, reference, rows};

/// Name, set, functional, and what the thesis's table prints: iterations, `E`, `V`.
const PRINTED: [(&str, &str, Functional, [&str; 3]); 12] = {
    use Functional::{Mec, Mvc};
    [
        ("Wicket", "4.2", Mvc, ["15", "3.141", "2.176·10<sup>−6</sup>"]),
        ("Wicket", "4.2", Mec, ["6", "2.871", "1.596"]),
        ("G2 box", "4.10-1", Mvc, ["6", "7.247", "26.15"]),
        ("G2 box", "4.10-1", Mec, ["13", "6.291", "718.6"]),
        ("G1 box", "4.10-2", Mvc, ["7", "6.283", "7.09·10<sup>−6</sup>"]),
        ("G1 box", "4.10-2", Mec, ["24", "6.268", "1.027"]),
        ("Woodford", "4.11", Mvc, ["137", "2.551", "1.951"]),
        ("Woodford", "4.11", Mec, ["31", "2.248", "2.714"]),
        ("Space curve", "4.16", Mvc, ["90", "5.098", "4.597"]),
        ("Space curve", "4.16", Mec, ["29", "5.074", "5.270"]),
        ("Peters' helix", "4.21", Mvc, ["27", "4.913", "0.089"]),
        ("Peters' helix", "4.21", Mec, ["15", "4.658", "0.156"]),
    ]
};

/// Table 4.1 as Markdown: published, minvar's and Ceres's. It takes Ceres some seconds.
///
/// # Panics
///
/// If the reference refuses the data.
pub fn table() -> String {
    let mut lines = vec![
        "## Table 4.1 computed anew\n".to_owned(),
        "Each curve with as many elements as the printed one. *Printed* is Table 4.1; *its coefficients* are those of \
         Appendix A, measured. Ceres does Levenberg–Marquardt (at most 2000 iterations), then Newton's method. All but the \
         first are measured by the same independent quadrature. The functional that was minimised is in bold.\n"
            .to_owned(),
        "| curve | functional | by | iterations | E | V |".to_owned(),
        "| --- | --- | --- | --- | --- | --- |".to_owned(),
    ];
    for (name, id, functional, [iterations, e, v]) in PRINTED {
        assert!(SETS.contains(&(id, functional)), "a minimum to compare with");
        let row = |by: &str, work: &str, e: &str, v: &str| match functional {
            Functional::Mec => format!("| {name} | MEC | {by} | {work} | **{e}** | {v} |"),
            _ => format!("| {name} | MVC | {by} | {work} | {e} | **{v}** |"),
        };
        let measured = |by: &str, work: &str, found: &Measure| {
            row(by, work, &significant(found.e, 8), &significant(found.v, 8))
        };
        let figure = figure(id);
        let measure = |rows: &[_]| evaluate(rows, figure.planar(), 60).expect("rows are finite");
        let published = figure.published(functional).expect("Appendix A has coefficients");
        let (report, elements) = ours(&figure, functional, published.elements_per_span);
        let theirs = reference(&figure, functional, published.elements_per_span);
        let work = format!("{}, {}", report.iterations, report.status.name());
        let their_work = format!("{} + {}", theirs.ceres_iterations, theirs.newton_iterations);
        lines.extend([
            row("printed", iterations, e, v),
            measured("its coefficients", "", &measure(&published.rows)),
            measured("minvar", &work, &measure(&rows(&elements))),
            measured("Ceres", &their_work, &theirs.measure),
        ]);
    }
    lines.join("\n") + "\n"
}
