//! How many iterations a curve takes from its data alone until its functional is its minimum to nine digits.

use crate::appendix::{Figure, figures};
use crate::compare::kernel_joints;
use minvar::curve::{self, Curve, Element, Functional, Joint, Options};
use minvar::solve::{Record, Silent, Status};

/// The functionals by name.
pub const FUNCTIONALS: [(&str, Functional); 4] = [
    ("MVC", Functional::MVC),
    ("MEC", Functional::MEC),
    ("SI-MVC", Functional::SI_MVC),
    ("SI-MEC", Functional::SI_MEC),
];

/// The functional is there when it is within this part of its minimum.
const THERE: f64 = 1e-9;

/// How a minimum was reached.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// How it ended.
    pub status: Status,
    /// The functional at the end.
    pub value: f64,
    /// The iterations until the functional was there for good.
    pub needed: usize,
    /// All iterations, with those that only show that no more is to be gained.
    pub iterations: usize,
    /// How often an element was linearised, on the average.
    pub work: f64,
}

/// Solves with the default options and looks back at the way.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn way(joints: &[Joint], closed: bool, functional: Functional) -> Way {
    let curve = Curve::new(joints, closed);
    let options = Options { functional, ..Options::DEFAULT };
    let mut workspace = vec![f64::NAN; curve::workspace_len(&curve, &options).expect("the data are good")];
    let mut elements = vec![Element::ZERO; curve::elements_len(&curve, &options)];
    let mut records = vec![Record::ZERO; options.max_iterations as usize];
    let report = curve::solve(&curve, &options, &mut workspace, &mut elements, &mut records, &mut Silent)
        .expect("the data are good");
    records.truncate(report.iterations);
    let off = |record: &Record| (record.value - report.value).abs() > THERE * report.value;
    // The record after the last that was off; where none was, the first.
    let needed = records.iter().rposition(off).map_or(1, |last| last + 2).min(report.iterations);
    Way {
        status: report.status,
        value: report.value,
        needed,
        iterations: report.iterations,
        work: report.linearisations as f64 / elements.len() as f64,
    }
}

/// The way of a set of Appendix A.
pub fn way_of(figure: &Figure, functional: Functional) -> Way {
    way(&kernel_joints(figure), figure.closed, functional)
}

/// Whether a set has a minimum: an energy with a fixed curvature beside free tangents (Fig. 4.9) only has an infimum,
/// and the antipodal S and the free figure-8 grow without limit unless size does not count.
pub fn has_minimum(id: &str, functional: Functional) -> bool {
    match id {
        "4.9-1" | "4.9-2" => matches!(functional, Functional::MVC | Functional::SI_MVC),
        "4.14" | "4.15" => matches!(functional, Functional::SI_MVC | Functional::SI_MEC),
        _ => true,
    }
}

/// The table of all sets and functionals, as Markdown.
pub fn table() -> String {
    let mut lines = vec![
        "## Iterations from the data alone\n".to_owned(),
        "Every set of Appendix A with every functional, one element a span and the default options: the iterations until the \
         functional is within 1e-9 of its minimum for good, in brackets those until that is proved to rounding, with the work \
         in element linearisations an element. A dash stands where there is no minimum. (The thesis took up to 137 iterations \
         for an MVC or MEC and 3921 for the SI-MVC of Woodford's data.)\n"
            .to_owned(),
        "| set | MVC | MEC | SI-MVC | SI-MEC |".to_owned(),
        "| --- | --- | --- | --- | --- |".to_owned(),
    ];
    for figure in figures() {
        let cells = FUNCTIONALS.map(|(_, functional)| {
            let Way { needed, iterations, work, .. } = way_of(&figure, functional);
            if has_minimum(&figure.id, functional) {
                format!("{needed} ({iterations}, {work:.0})")
            } else {
                "–".to_owned()
            }
        });
        lines.push(format!(
            "| {} {} | {} |",
            figure.id,
            figure.title.trim_end_matches('.'),
            cells.join(" | ")
        ));
    }
    lines.push(String::new());
    lines.push(WHY.to_owned());
    lines.join("\n") + "\n"
}

/// What brings the iterations down.
const WHY: &str = "\
What keeps them few:

- *Start.* A planar curve through fixed joints is solved first by its direction as a function of arc length, where only the \
closing of the spans is nonlinear; that takes three to six of the iterations that are counted, and the quintics that are laid \
along it begin near their minimum. Other curves begin with an even parametrisation, for which only the shape decides.
- *Coupling.* A scale-invariant functional is the plain one under the tension that belongs to the curve as it stands. In arc \
length every iteration takes that tension, by the concavity of the logarithm a step that goes down, and how it changes with the \
step; in the quintics' Hessian it is the part of rank two, which is exact. (With a tension that lagged behind, the antipodal S \
took 21 iterations by SI-MEC.)
- *Gauge.* What an element shares with no other, its parametrisation, is minimised over after every step; so is a joint that is \
free to slide, together with its two elements. A curve of which nothing is fixed, the figure-8, is held at two of its joints: \
moving, turning and scaling it has no effect, but in bent coordinates looks like a negative curvature. (Without both it took 55 \
and 144 iterations by SI-MVC and SI-MEC.)
- *Several minima.* One element a span has minima of its parametrisation that differ in the seventh digit or later. They are \
compared as soon as a Newton step promises less than a difference that counts, not when all digits of the first one are known. \
(Peters' helix by MEC took 16.)
- *Step control.* From elements that run along a known curve the first steps are short, for the valleys of an energy's \
parametrisation are bent; everywhere else a step may be as long as a turn by one radian.
";
