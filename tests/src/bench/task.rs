//! What is solved: joints and a functional, by minvar, and as text for its peers.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's functions")]

use super::ours::Solver;
use super::peer::Peer;
use crate::appendix::Figure;
use crate::ceres;
use crate::compare::kernel_joints;
use crate::curves::{
    cross, deviation, distance, dot, end_shape, gauss_legendre, norm, shape, sub, times, unit,
};
use minvar::basis::quadrature::lobatto;
use minvar::curve::{Continuity, Curve, Element, Functional, Given, Joint, Options, Report};
use std::fmt::Write;

/// The points of the rule that all minimise sums with: those that minvar's own choice does most of its work with.
const POINTS: usize = 16;

/// A curve to be found, in a unit of length near the data's: some peers know no other.
pub struct Task {
    /// What it is called in the results.
    pub name: String,
    /// The joints in order.
    pub joints: Vec<Joint>,
    /// Whether the curve returns to its first joint.
    pub closed: bool,
    /// What is minimised.
    pub functional: Functional,
    /// Whether all lies in the plane z = 0.
    pub planar: bool,
    /// The unit of length, in the caller's.
    pub unit: f64,
    /// How many elements minvar is to use between two joints.
    pub elements_per_span: u32,
}

impl Task {
    /// A task from joints, in a unit of length near their distances: a power of two, which costs no digits.
    pub fn new(name: impl Into<String>, joints: Vec<Joint>, closed: bool, functional: Functional) -> Self {
        let chords: f64 =
            joints.windows(2).map(|pair| distance(pair[0].position.value, pair[1].position.value)).sum();
        let unit = (chords / (joints.len() - 1) as f64).log2().round().exp2();
        Self::in_unit(unit, name, joints, closed, functional)
    }

    /// A task from joints, in a given unit of length.
    pub fn in_unit(
        unit: f64,
        name: impl Into<String>,
        mut joints: Vec<Joint>,
        closed: bool,
        functional: Functional,
    ) -> Self {
        for joint in &mut joints {
            joint.position.value = times(joint.position.value, 1.0 / unit);
            for curvature in &mut joint.curvature {
                curvature.value = times(curvature.value, unit);
            }
        }
        let planar = joints.iter().all(|joint| {
            let vectors = [joint.position.value, joint.tangent[0].value, joint.curvature[0].value];
            vectors.iter().all(|vector| vector[2] == 0.0)
        });
        Self { name: name.into(), joints, closed, functional, planar, unit, elements_per_span: 1 }
    }

    /// A set of Appendix A.
    pub fn of_set(name: impl Into<String>, figure: &Figure, functional: ceres::Functional) -> Self {
        let functional = match functional {
            ceres::Functional::Mvc => Functional::MVC,
            ceres::Functional::Mec => Functional::MEC,
            ceres::Functional::SiMvc => Functional::SI_MVC,
        };
        Self::new(name, kernel_joints(figure), figure.closed, functional)
    }

    /// The name of the functional.
    pub fn functional_name(&self) -> &'static str {
        if self.functional == Functional::MEC { "mec" } else { "mvc" }
    }

    /// The number of spans.
    pub fn spans(&self) -> usize {
        Curve::new(&self.joints, self.closed).spans()
    }

    /// minvar's defaults for this task.
    pub fn default_options(&self) -> Options {
        Options { functional: self.functional, elements_per_span: self.elements_per_span, ..Options::DEFAULT }
    }

    /// The same, with another `relative_decrease` and the rule that the peers get.
    pub fn options(&self, relative_decrease: f64) -> Options {
        Options { relative_decrease, quadrature_points: POINTS as u32, ..self.default_options() }
    }

    /// minvar's solution.
    ///
    /// # Panics
    ///
    /// If minvar refuses the data.
    pub fn solve(&self, options: &Options) -> (Report, Vec<Element>) {
        let mut solver = Solver::new(self, options);
        let report = solver.solve();
        (report, solver.into_elements())
    }

    /// A value of the functional in the caller's unit of length.
    pub fn in_caller_units(&self, value: f64) -> f64 {
        let unit = self.unit;
        if self.functional == Functional::MEC { value / unit } else { value / (unit * unit * unit) }
    }

    /// The functional of elements by the rule that is minimised with, evaluated apart from the kernel.
    ///
    /// # Panics
    ///
    /// Never: the kernel has the rule that it minimises with.
    pub fn value(&self, elements: &[Element]) -> f64 {
        let rule = lobatto(POINTS).expect("the kernel's own rule");
        elements
            .iter()
            .map(|element| rule.iter().map(|(t, w)| w * self.density(element, t)).sum::<f64>())
            .sum()
    }

    /// The functional of elements by a finer rule.
    pub fn fine_value(&self, elements: &[Element]) -> f64 {
        let rule = gauss_legendre(40);
        let parts = |element: &Element| -> f64 {
            (0..4)
                .flat_map(|k| rule.iter().map(move |&(t, w)| (0.25 * (f64::from(k) + t), 0.25 * w)))
                .map(|(t, w)| w * self.density(element, t))
                .sum()
        };
        elements.iter().map(parts).sum()
    }

    fn density(&self, element: &Element, t: f64) -> f64 {
        let [_, curvature, slope] = shape(element, t);
        let of = if self.functional == Functional::MEC { curvature } else { slope };
        dot(of, of) * norm(element.derivatives(t)[1])
    }

    /// Says so if two evaluations of the functional differ by more than rounding: a part of the value, and what it does to
    /// residuals that are small because their terms cancel.
    ///
    /// # Errors
    ///
    /// The two values.
    pub fn same_value(&self, what: &str, one: f64, other: f64) -> Result<(), String> {
        let natural = self.spans() as f64;
        let allowed = 1e-12 * other + 1e-13 * (other * natural).sqrt();
        if (one - other).abs() <= allowed {
            Ok(())
        } else {
            Err(format!("{} {}: {what} is {one:e}, not {other:e}", self.name, self.functional_name()))
        }
    }

    /// Whether elements are about the same curve as others: there are data with several minima.
    pub fn same_curve(&self, one: &[Element], other: &[Element]) -> bool {
        deviation(one, other, self.spans()) < 0.05
    }

    /// Whether the rule sees all of a curve: an optimiser may hide a cusp between its points.
    pub fn seen_by_the_rule(&self, elements: &[Element]) -> bool {
        let value = self.value(elements);
        (self.fine_value(elements) - value).abs() <= 1e-4 * value
    }

    /// The start values of minvar, before it has done anything: its tangents and shared curvatures, and speeds and
    /// stretches of the quintic that fits a circular arc best (`kernel/src/curve/start.rs`).
    ///
    /// Stopped before its first iteration minvar has explored what each element shares with no other. That is work that no
    /// peer should be given for nothing, so it is replaced by where it started from.
    pub fn start(&self) -> Vec<Element> {
        let (_, mut elements) = self.solve(&Options { max_iterations: 0, ..self.options(1e-12) });
        let count = self.joints.len();
        for (index, element) in elements.iter_mut().enumerate() {
            let ends: [(_, _); 2] = [0, 1].map(|end| {
                let (tangent, curvature, _) = end_shape(element, end);
                let joint = &self.joints[(index + end) % count];
                let shared = joint.continuity == Continuity::G2 || joint.curvature[0].given == Given::FIXED;
                (tangent, if shared { curvature } else { self.touching(index, end, tangent) })
            });
            *element = self.arc_like(element, ends);
        }
        elements
    }

    /// The curvature of the circle that touches a tangent and passes through the other end of a span.
    fn touching(&self, span: usize, end: usize, tangent: [f64; 3]) -> [f64; 3] {
        let at = |joint: usize| self.joints[joint % self.joints.len()].position.value;
        let chord = sub(at(span + 1 - end), at(span + end));
        times(sub(chord, times(tangent, dot(chord, tangent))), 2.0 / dot(chord, chord))
    }

    fn arc_like(&self, from: &Element, ends: [([f64; 3], [f64; 3]); 2]) -> Element {
        let (first, last) = (from.rows[0], from.rows[5]);
        let chord = sub(last, first);
        let angle = |t| norm(cross(chord, t)).atan2(dot(chord, t));
        let turn = (angle(ends[0].0) + angle(ends[1].0)).min(4.0);
        let half = 0.5 * turn;
        let arc = if half > 1e-4 { norm(chord) * half / half.sin() } else { norm(chord) };
        let with_speed = |speed: f64| {
            let stretch = 0.0377 * turn * turn * speed;
            let second = |end: usize, along: f64| {
                let (tangent, curvature) = ends[end];
                std::array::from_fn(|c| speed * speed * curvature[c] + along * tangent[c])
            };
            Element {
                rows: [
                    first,
                    times(ends[0].0, speed),
                    second(0, -stretch),
                    second(1, stretch),
                    times(ends[1].0, speed),
                    last,
                ],
            }
        };
        let mut best = (f64::INFINITY, *from);
        for factor in [1.0, 0.6, 1.6, 0.36, 2.5] {
            let element = with_speed(arc * (1.0 + 0.00613 * turn * turn) * factor);
            let value = self.value(&[element]);
            if value < 0.5 * best.0 {
                best = (value, element);
            }
        }
        best.1
    }

    /// Hands the task to a peer, with elements as the start, and returns its answer.
    ///
    /// # Errors
    ///
    /// Those of the peer.
    ///
    /// # Panics
    ///
    /// Never: the kernel has the rule that it minimises with.
    pub fn hand_to(&self, peer: &mut Peer, start: &[Element]) -> Result<String, String> {
        let rule = lobatto(POINTS).expect("the kernel's own rule");
        let mut text = format!(
            "case {} {} {} {} {} {}\n",
            self.functional_name(),
            if self.planar { 2 } else { 3 },
            if self.closed { "closed" } else { "open" },
            self.joints.len(),
            rule.len(),
            start.len()
        );
        let mut put = |numbers: &[f64]| {
            for number in numbers {
                // Displayed floats come back to the last bit, and whole ones look like integers.
                let _ = write!(text, "{number} ");
            }
            text.push('\n');
        };
        for joint in &self.joints {
            let continuity = [Continuity::G0, Continuity::G1, Continuity::G2]
                .iter()
                .position(|&known| known == joint.continuity)
                .unwrap_or(2);
            put(&[continuity as f64]);
            put(&joint.position.value);
            for quantity in [joint.tangent[0], joint.curvature[0]] {
                put(&[f64::from(quantity.given == Given::FIXED)]);
                put(&quantity.value);
            }
        }
        for (node, weight) in rule.iter() {
            put(&[node, weight]);
        }
        for row in start.iter().flat_map(|element| element.rows) {
            put(&row);
        }
        peer.ask(&text)
    }

    /// What is wrong with elements as a solution of this task: a constraint that is not kept, a break at a joint.
    pub fn defect(&self, elements: &[Element]) -> Option<String> {
        if elements.len() != self.spans() {
            return Some(format!("{} elements for {} spans", elements.len(), self.spans()));
        }
        let count = self.joints.len();
        for (index, element) in elements.iter().enumerate() {
            for end in 0..2 {
                let node = (index + end) % count;
                let joint = &self.joints[node];
                let (tangent, curvature, _) = end_shape(element, end);
                if !(distance(element.rows[5 * end], joint.position.value) < 1e-12) {
                    return Some(format!("element {index} misses joint {node}"));
                }
                if joint.tangent[0].given == Given::FIXED
                    && !(distance(tangent, unit(joint.tangent[0].value)) < 1e-10)
                {
                    return Some(format!("element {index} has another tangent at joint {node}"));
                }
                let size = norm(joint.curvature[0].value);
                if joint.curvature[0].given == Given::FIXED && !((norm(curvature) - size).abs() < 1e-8) {
                    return Some(format!("element {index} has another curvature at joint {node}"));
                }
            }
            let next = (index + 1) % count;
            if self.closed || next + 1 < count {
                let (before, after) = (end_shape(element, 1), end_shape(&elements[next], 0));
                if self.joints[next].continuity != Continuity::G0 && !(distance(before.0, after.0) < 1e-10) {
                    return Some(format!("the tangent breaks at joint {next}"));
                }
                if self.joints[next].continuity == Continuity::G2
                    && !(distance(before.1, after.1) < 1e-8 * (1.0 + norm(before.1)))
                {
                    return Some(format!("the curvature breaks at joint {next}"));
                }
            }
        }
        None
    }
}
