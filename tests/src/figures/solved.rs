//! A curve to be drawn: solved, sampled, and its figures.

use crate::appendix;
use crate::compare::kernel_joints;
use minvar::curve::{
    Curve, CurvePoint, Element, Functional, Joint, Options, Report, elements_len, measure, solve,
    workspace_len,
};
use minvar::solve::Silent;

/// A curve and how it came to be.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    /// What the legend calls it.
    pub(super) name: String,
    /// What it was to meet.
    pub(super) joints: Vec<Joint>,
    pub(super) closed: bool,
    pub(super) elements: Vec<Element>,
    /// The solver's report; none of a curve that was not solved for.
    pub(super) report: Option<Report>,
}

impl Solved {
    /// The curve of a specification.
    pub(super) fn of(name: &str, curve: &Curve<'_>, options: &Options) -> Self {
        let mut workspace = vec![0.0; workspace_len(curve, options).expect("the data are good")];
        let mut elements = vec![Element::ZERO; elements_len(curve, options)];
        let report = solve(curve, options, &mut workspace, &mut elements, &mut [], &mut Silent)
            .expect("the data are good");
        elements.truncate(report.elements);
        Self {
            name: name.into(),
            joints: curve.joints.to_vec(),
            closed: curve.closed,
            elements,
            report: Some(report),
        }
    }

    /// A set of Appendix A solved.
    pub(super) fn appendix(name: &str, id: &str, functional: Functional, elements_per_span: u32) -> Self {
        let figure = appendix::figure(id);
        let joints = kernel_joints(&figure);
        let options = Options { functional, elements_per_span, ..Options::DEFAULT };
        Self::of(name, &Curve::new(&joints, figure.closed), &options)
    }

    /// A chain of elements that was not solved for.
    pub(super) fn given(name: &str, joints: Vec<Joint>, elements: Vec<Element>) -> Self {
        Self { name: name.into(), joints, closed: false, elements, report: None }
    }

    pub(super) fn per_span(&self) -> usize {
        self.elements.len() / Curve::new(&self.joints, self.closed).spans()
    }

    /// Places along the curve, closer than the eye can tell, both sides of every joint among them.
    pub(super) fn samples(&self) -> Vec<CurvePoint> {
        let steps = (480 / self.elements.len()).max(20);
        let at = |element, step: usize| {
            measure::at(&self.elements, element, step as f64 / steps as f64)
                .expect("fair curves have no cusp")
        };
        (0..self.elements.len()).flat_map(|element| (0..=steps).map(move |step| at(element, step))).collect()
    }

    /// Places at equal distances along the arc.
    pub(super) fn evenly(&self, count: usize) -> Vec<CurvePoint> {
        let length = measure::length(&self.elements);
        let at = |k| measure::at_length(&self.elements, length * k as f64 / count as f64);
        (0..=count).map(|k| at(k).expect("fair curves have no cusp")).collect()
    }

    /// The joints' places, in order; a closed curve's first comes again at the end.
    pub(super) fn joint_places(&self) -> Vec<CurvePoint> {
        let at = |element, t| measure::at(&self.elements, element, t).expect("fair curves have no cusp");
        let starts = (0..self.elements.len()).step_by(self.per_span()).map(|element| at(element, 0.0));
        starts.chain([at(self.elements.len() - 1, 1.0)]).collect()
    }

    /// The largest curvature.
    pub(super) fn steepest(&self) -> f64 {
        self.samples().iter().map(|place| place.signed_curvature.abs()).fold(0.0, f64::max)
    }

    /// A row of the table below a figure.
    pub(super) fn row(&self) -> String {
        let [low, high] = measure::curvature_range(&self.elements)
            .expect("fair curves have no cusp")
            .map(|place| place.signed_curvature);
        let (status, iterations) = match &self.report {
            Some(report) => (report.status.name(), report.iterations.to_string()),
            None => ("–", "–".into()),
        };
        format!(
            "| {} | {} | {status} | {iterations} | {} | {} | {} | {} … {} |",
            self.name,
            self.per_span(),
            significant(measure::variation(&self.elements), 6),
            significant(measure::bending(&self.elements), 6),
            significant(measure::length(&self.elements), 6),
            significant(low, 5),
            significant(high, 5),
        )
    }
}

/// The head of the table below a figure.
pub(super) const HEAD: &str = "\
| curve | elements a span | status | iterations | V | E | L | curvature |
| --- | --- | --- | --- | --- | --- | --- | --- |";

/// A number with so many significant digits; what is below 1e-11, which is rounding here, is zero.
pub(super) fn significant(x: f64, digits: usize) -> String {
    let size = x.abs();
    if size < 1e-11 {
        return "0".into();
    }
    let text = if size < 1e-3 {
        format!("{x:.*e}", digits - 1).replace('e', "·10^") + "^"
    } else {
        let before = libm::floor(libm::log10(size)) as i32 + 1;
        let decimals = usize::try_from(digits as i32 - before).unwrap_or(0);
        format!("{x:.decimals$}")
    };
    let text = match text.strip_suffix('^') {
        Some(power) => power.replacen("^", "<sup>", 1) + "</sup>",
        None => text,
    };
    text.replace('-', "\u{2212}")
}
