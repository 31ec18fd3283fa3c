//! The same problem in other clothes: what a status and a value must not depend on.

use super::dice::Dice;
use super::finding::{Check, Findings};
use super::judge::{MEANINGLESS, apart, natural};
use super::measured::{Measured, measure, power};
use super::problem::Problem;
use super::similarity::{Similarity, reversed};
use crate::curves::{end_shape, solve_curve, times};
use minvar::curve::{Continuity, Curve, Element, Given, Joint, Options, Quantity, Report};
use minvar::solve::Status;
use std::cell::OnceCell;

/// A result with what it measures.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The kernel's report.
    pub report: Report,
    /// The elements.
    pub elements: Vec<Element>,
    /// What they measure.
    pub measured: Measured,
}

/// What is done to a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Image {
    /// Scaled by a power of two: nothing is rounded, every digit must be the same.
    PowerOfTwo,
    /// Scaled by a power of two and moved on the grid: what the solver sees is the same to the last digit.
    ExactMove,
    /// Scaled by any factor, moved and turned, as the problem's place is.
    Place,
    /// Turned.
    Turn,
    /// Gone through in the other direction.
    Reverse,
    /// Started from its own result.
    Restart,
}

impl Image {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::PowerOfTwo, Self::ExactMove, Self::Place, Self::Turn, Self::Reverse, Self::Restart];

    /// Whether the solver must see the same numbers to the last digit.
    pub const fn is_exact(self) -> bool {
        matches!(self, Self::PowerOfTwo | Self::ExactMove)
    }
}

/// A solved problem that its images are compared with.
pub struct Comparison<'a> {
    problem: &'a Problem,
    options: &'a Options,
    /// The result in the problem's own place.
    base: &'a Solved,
    /// The result near the origin.
    near: OnceCell<Option<Solved>>,
}

/// What lengths to some power are multiplied by.
fn to_power(scale: f64, power: i32) -> f64 {
    (0..power).fold(1.0, |product, _| product * scale)
}

impl<'a> Comparison<'a> {
    /// Compares with this result.
    pub const fn new(problem: &'a Problem, options: &'a Options, base: &'a Solved) -> Self {
        Self { problem, options, base, near: OnceCell::new() }
    }

    fn solved(&self, joints: &[Joint]) -> Option<Solved> {
        let (report, elements) = solve_curve(joints, self.problem.closed, self.options).ok()?;
        let measured = measure(&elements);
        Some(Solved { report, elements, measured })
    }

    /// The result of the problem near the origin.
    pub fn near(&self) -> Option<&Solved> {
        let plain = self.problem.place == Similarity::IDENTITY;
        let solve = || if plain { Some(self.base.clone()) } else { self.solved(&self.problem.plain) };
        self.near.get_or_init(solve).as_ref()
    }

    /// Solves an image, notes how its result differs, and returns its report; `None` where there is nothing to compare
    /// or the data are refused, which is noted.
    pub fn with(&self, image: Image, dice: &mut Dice, findings: &mut Findings) -> Option<Report> {
        let (problem, power) = (self.problem, power(self.options.functional));
        let two = libm::exp2(dice.count(0, 40) as f64 - 20.0);
        let found = match image {
            Image::PowerOfTwo => {
                let scaled = Similarity { scale: two, ..Similarity::IDENTITY };
                let found = self.solved(&scaled.joints(&problem.joints))?;
                let back = |element: &Element| element.rows.map(|row| times(row, 1.0 / two));
                let base = self.base;
                let same = found.report.status == base.report.status
                    && found.report.iterations == base.report.iterations
                    && found.report.value * to_power(two, power) == base.report.value
                    && found.elements.iter().zip(&base.elements).all(|(one, other)| back(one) == other.rows);
                findings.must(Check::PowerOfTwo, same);
                found
            }
            Image::ExactMove => {
                let near = self.near()?;
                // On the grid a move by whole numbers rounds nothing, and a power of two neither.
                let far = [(); 3].map(|()| libm::rint(dice.within(5e5)));
                let moved = Similarity { scale: two, shift: times(far, two), ..Similarity::IDENTITY };
                let found = self.solved(&moved.joints(&problem.plain))?;
                let same = found.report.value * to_power(two, power) == near.report.value
                    && found.report.iterations == near.report.iterations;
                findings.must(Check::ExactMove, same);
                findings.must(Check::MoveStatus, found.report.status == near.report.status);
                found
            }
            Image::Place => {
                // What is far from the origin is known to fewer digits.
                let scale = problem.place.scale;
                let rounding =
                    4.0 * self.base.measured.rounding(self.options.functional) * to_power(scale, power);
                let near = self.near().filter(|_| problem.place != Similarity::IDENTITY)?;
                let checks = [Check::PlaceStatus, Check::Place];
                self.differ(checks, near, self.base, scale, rounding, findings);
                self.base.clone()
            }
            Image::Turn => {
                let near = self.near()?;
                let found = self.solved(&Similarity::any_turn(dice).joints(&problem.plain))?;
                self.differ([Check::TurnStatus, Check::Turn], near, &found, 1.0, 0.0, findings);
                found
            }
            Image::Reverse => {
                let near = self.near()?;
                let found = self.solved(&reversed(&problem.plain))?;
                self.differ([Check::ReverseStatus, Check::Reverse], near, &found, 1.0, 0.0, findings);
                found
            }
            Image::Restart => {
                let near = self.near().filter(|near| near.report.status == Status::Converged)?;
                let found = self.solved(&resumed(&problem.plain, &near.elements, problem.closed))?;
                if found.report.status == Status::Converged {
                    let lower = (near.report.value - found.report.value - self.floor()).max(0.0);
                    findings.note(Check::Restart, lower / near.report.value.max(f64::MIN_POSITIVE));
                }
                found
            }
        };
        Some(found.report)
    }

    /// Below this, near the origin, values mean nothing.
    fn floor(&self) -> f64 {
        let curve = Curve::new(&self.problem.plain, self.problem.closed);
        MEANINGLESS * natural(&curve, self.options.functional)
    }

    /// Compares reported values, in the units of the problem near the origin, where both converged.
    fn differ(
        &self,
        [status, value]: [Check; 2],
        near: &Solved,
        other: &Solved,
        scale: f64,
        rounding: f64,
        findings: &mut Findings,
    ) {
        let [one, other] = [&near.report, &other.report];
        findings.must(status, other.status == one.status);
        if other.status == Status::Converged && one.status == Status::Converged {
            let other = other.value * to_power(scale, power(self.options.functional));
            findings.note(value, apart(other, one.value, self.floor() + rounding));
        }
    }
}

/// Joints whose free and initial quantities start from a result.
pub fn resumed(joints: &[Joint], elements: &[Element], closed: bool) -> Vec<Joint> {
    let count = joints.len();
    let spans = if closed { count } else { count - 1 };
    let per_span = elements.len() / spans;
    let start = |quantity: Quantity, value: [f64; 3]| match quantity.given {
        Given::FIXED => quantity,
        _ => Quantity::initial(value),
    };
    let mut out = joints.to_vec();
    for (i, joint) in out.iter_mut().enumerate() {
        let arriving = if i > 0 { Some(i * per_span - 1) } else { closed.then(|| elements.len() - 1) };
        let leaving = Some(i * per_span).filter(|_| closed || i + 1 < count);
        let mut shapes = [arriving.map(|e| (e, 1)), leaving.map(|e| (e, 0))]
            .map(|place| place.map(|(element, end)| (end_shape(&elements[element], end), element, end)));
        // An end has one side only, and sides that share a quantity must have the same bits.
        for side in 0..2 {
            if shapes[side].is_none() {
                shapes[side] = shapes[1 - side];
            }
        }
        let [Some(before), Some(after)] = shapes else { continue };
        let shapes = match joint.continuity {
            Continuity::G0 => [before, after],
            _ => {
                let mut shapes = [before, after];
                shapes[0].0.0 = shapes[1].0.0;
                if joint.continuity == Continuity::G2 {
                    shapes[0].0.1 = shapes[1].0.1;
                }
                shapes
            }
        };
        let (_, element, end) = after;
        joint.position = start(joint.position, elements[element].rows[if end == 0 { 0 } else { 5 }]);
        for side in 0..2 {
            let ((tangent, curvature, _), ..) = shapes[side];
            let keeps_tangent = joint.tangent[side].given == Given::FIXED;
            joint.tangent[side] = start(joint.tangent[side], tangent);
            let given = joint.curvature[side].given;
            joint.curvature[side] = if given == Given::FIXED && !keeps_tangent {
                // It keeps its size; its direction goes with the tangent.
                Quantity::fixed(curvature)
            } else {
                start(joint.curvature[side], curvature)
            };
        }
    }
    out
}
