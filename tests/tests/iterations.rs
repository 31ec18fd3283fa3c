//! Iterations from the data alone, on every set of Appendix A with every functional.

use minvar::curve::Functional;
use minvar::solve::Status;
use minvar_tests::appendix::figures;
use minvar_tests::iterations::{FUNCTIONALS, has_minimum, way_of};

#[test]
fn every_minimum_of_appendix_a_is_reached_within_few_iterations() {
    let mut wrong = Vec::new();
    for figure in figures() {
        for (name, functional) in FUNCTIONALS {
            if !has_minimum(&figure.id, functional) {
                continue;
            }
            let way = way_of(&figure, functional);
            let line = format!("{} {name}: {way:?}", figure.id);
            println!("{line}");
            let woodford = figure.id == "4.11" && functional == Functional::SI_MVC;
            let most = if woodford { 25 } else { 15 };
            if way.status != Status::Converged || way.needed > most {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "too many iterations:\n{}", wrong.join("\n"));
}
