//! Prints Appendix A solved: the published coefficients, minvar's and the reference's, all measured by the same
//! independent quadrature, with as many elements a span as the published curve; then the iterations from the data
//! alone. `make table`.

use minvar_tests::appendix::figures;
use minvar_tests::ceres::{Functional, Measure, evaluate};
use minvar_tests::compare::{SETS, ours, reference, rows};
use minvar_tests::iterations;

fn print(name: &str, who: &str, work: &str, value: f64, found: &Measure) {
    println!(
        "| {name} | {who} | {work} | {value:.10e} | {:.6e} | {:.7} | {:.6} | {:.5} … {:.5} |",
        found.v, found.e, found.l, found.kappa_min, found.kappa_max
    );
}

fn main() {
    println!("| set | by | work | value | V | E | L | curvature |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for figure in figures() {
        for functional in [Functional::Mvc, Functional::Mec] {
            let name = format!("{} {functional:?}", figure.id);
            let value = |found: &Measure| if functional == Functional::Mvc { found.v } else { found.e };
            let measure = |rows: &[_]| evaluate(rows, figure.planar(), 60).expect("rows are finite");
            let mut per_span = 1;
            if let Some(published) = figure.published(functional) {
                per_span = published.elements_per_span;
                let found = measure(&published.rows);
                print(&name, "published", "", value(&found), &found);
            }
            let (report, elements) = ours(&figure, functional, per_span);
            let found = measure(&rows(&elements));
            let work = format!(
                "{} iterations, {:.0} linearisations an element, {}",
                report.iterations,
                report.linearisations as f64 / elements.len() as f64,
                report.status.name()
            );
            print(&name, "minvar", &work, report.value, &found);
            if SETS.contains(&(figure.id.as_str(), functional)) {
                let theirs = reference(&figure, functional, per_span);
                let work =
                    format!("{} iterations, {} to polish", theirs.ceres_iterations, theirs.newton_iterations);
                print(&name, "Ceres", &work, theirs.value, &theirs.measure);
            }
        }
    }
    print!("\n{}", iterations::table());
}
