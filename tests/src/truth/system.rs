//! Unknowns, functional and conditions of a true curve, with exact first and second derivatives.
//!
//! The unknowns are the joints' points and, for each span, its length, its start angle and the coefficients of its turning
//! rate. Lengths are in a unit of the curve's own size.

use super::dense::{Matrix, dot};
use super::legendre::{Basis, sum};
use super::start::SpanStart;
use super::{Continuity, Functional, Point, Problem};
use crate::curves::gauss_legendre;
use std::f64::consts::TAU;

/// Where the unknowns of spans and joints are.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    joints: usize,
    spans: usize,
    degree: usize,
}

impl Layout {
    /// The number of unknowns.
    pub const fn unknowns(&self) -> usize {
        2 * self.joints + self.spans * (self.degree + 3)
    }

    /// A coordinate of a joint's point.
    pub const fn point(&self, joint: usize, axis: usize) -> usize {
        2 * joint + axis
    }

    /// The length of a span.
    pub const fn length(&self, span: usize) -> usize {
        2 * self.joints + span * (self.degree + 3)
    }

    /// The start angle of a span.
    pub const fn angle(&self, span: usize) -> usize {
        self.length(span) + 1
    }

    /// A coefficient of a span's turning rate.
    pub const fn coefficient(&self, span: usize, j: usize) -> usize {
        self.length(span) + 2 + j
    }

    /// All coefficients of a span's turning rate.
    pub fn coefficients<'a>(&self, x: &'a [f64], span: usize) -> &'a [f64] {
        &x[self.coefficient(span, 0)..][..=self.degree]
    }
}

enum Condition {
    /// The span ends at its joint: `L ∫ (cos θ, sin θ) = P₁ − P₀`, one coordinate.
    Closes { span: usize, end: usize, axis: usize },
    /// `k₁(1) L₂ = k₂(0) L₁`: both spans have the same curvature at their joint.
    SharesCurvature { arriving: usize, leaving: usize },
    /// `Σ factor · unknown = value`.
    Linear { terms: Vec<(usize, f64)>, value: f64 },
}

/// Values and derivatives at a point.
pub struct Linearised {
    /// The functional.
    pub value: f64,
    /// The functional's gradient.
    pub gradient: Vec<f64>,
    /// How far each condition is from zero.
    pub conditions: Vec<f64>,
    /// The conditions' gradients by rows.
    pub jacobian: Matrix,
    /// The second derivative of `functional + multipliers · conditions`.
    pub hessian: Matrix,
}

/// A curve's equations.
pub struct System {
    layout: Layout,
    functional: Functional,
    conditions: Vec<Condition>,
    /// Where the condition on the whole length is.
    length_condition: Option<usize>,
    /// Gauss nodes: weight and the polynomials there.
    rule: Vec<(f64, Basis)>,
    ends: [Basis; 2],
    /// `∫ p_i' p_j'`.
    variation: Matrix,
}

impl System {
    /// The equations of a problem whose lengths are already in units of its size, and the unknowns of a start.
    pub fn new(problem: &Problem, start: &[SpanStart], degree: usize) -> (Self, Vec<f64>) {
        let layout = Layout { joints: problem.joints.len(), spans: problem.spans(), degree };
        let mut x = vec![0.0; layout.unknowns()];
        for (i, joint) in problem.joints.iter().enumerate() {
            x[layout.point(i, 0)] = joint.position[0];
            x[layout.point(i, 1)] = joint.position[1];
        }
        for (i, span) in start.iter().enumerate() {
            x[layout.length(i)] = span.length;
            x[layout.angle(i)] = span.angle;
            for (j, c) in span.series(degree).into_iter().enumerate() {
                x[layout.coefficient(i, j)] = c;
            }
        }
        // Exact for ∫ p' p', and for the products of two integrals with the cosine of an angle of several turns.
        let rule: Vec<_> = gauss_legendre(degree + 30)
            .into_iter()
            .map(|(u, weight)| (weight, Basis::at(degree, u)))
            .collect();
        let mut variation = Matrix::zeros(degree + 1, degree + 1);
        for (weight, basis) in &rule {
            for i in 0..=degree {
                for j in 0..=degree {
                    variation[(i, j)] += weight * basis.slope[i] * basis.slope[j];
                }
            }
        }
        let ends = [Basis::at(degree, 0.0), Basis::at(degree, 1.0)];
        let mut system = Self {
            layout,
            functional: problem.functional,
            conditions: Vec::new(),
            length_condition: None,
            rule,
            ends,
            variation,
        };
        system.add_conditions(problem, &x);
        system.add_gauge(problem, &x);
        (system, x)
    }

    /// Where the unknowns are.
    pub const fn layout(&self) -> Layout {
        self.layout
    }

    /// The number of conditions.
    pub fn conditions(&self) -> usize {
        self.conditions.len()
    }

    /// Which condition fixes the whole length.
    pub const fn length_condition(&self) -> Option<usize> {
        self.length_condition
    }

    fn linear(&mut self, terms: Vec<(usize, f64)>, value: f64) {
        self.conditions.push(Condition::Linear { terms, value });
    }

    fn add_conditions(&mut self, problem: &Problem, x: &[f64]) {
        let at = self.layout;
        for span in 0..problem.spans() {
            let end = problem.end_joint(span);
            self.conditions.extend([0, 1].map(|axis| Condition::Closes { span, end, axis }));
        }
        for (i, joint) in problem.joints.iter().enumerate() {
            if joint.fixed {
                self.linear(vec![(at.point(i, 0), 1.0)], joint.position[0]);
                self.linear(vec![(at.point(i, 1), 1.0)], joint.position[1]);
            }
            let sides = problem.sides(i);
            // The angle at a side as a sum of unknowns: every polynomial but the first integrates to zero.
            let angle = |side: usize, span: usize| match side {
                0 => vec![(at.angle(span), 1.0), (at.coefficient(span, 0), 1.0)],
                _ => vec![(at.angle(span), 1.0)],
            };
            let angle_value = |side, span| angle(side, span).iter().map(|&(i, _)| x[i]).sum::<f64>();
            for (side, span) in sides.into_iter().enumerate() {
                let Some(span) = span else { continue };
                if let Some(wanted) = joint.angle[side] {
                    let turns = ((angle_value(side, span) - wanted) / TAU).round();
                    self.linear(angle(side, span), wanted + TAU * turns);
                }
                if let Some(curvature) = joint.curvature[side] {
                    let end = &self.ends[1 - side];
                    let mut terms: Vec<_> =
                        end.value.iter().enumerate().map(|(j, &p)| (at.coefficient(span, j), p)).collect();
                    terms.push((at.length(span), -curvature));
                    self.linear(terms, 0.0);
                }
            }
            let [Some(arriving), Some(leaving)] = sides else { continue };
            // Both sides fixed say the same or contradict each other on purpose: no condition is left between them.
            if joint.continuity != Continuity::G0 && joint.angle.iter().any(Option::is_none) {
                let turns = ((angle_value(0, arriving) - angle_value(1, leaving)) / TAU).round();
                let mut terms = angle(0, arriving);
                terms.push((at.angle(leaving), -1.0));
                self.linear(terms, TAU * turns);
            }
            if joint.continuity == Continuity::G2 && joint.curvature.iter().any(Option::is_none) {
                self.conditions.push(Condition::SharesCurvature { arriving, leaving });
            }
        }
        if let Some(length) = problem.length {
            self.length_condition = Some(self.conditions.len());
            self.linear((0..problem.spans()).map(|span| (at.length(span), 1.0)).collect(), length);
        }
    }

    /// Conditions that choose one of equally good curves: none of them bears a force.
    fn add_gauge(&mut self, problem: &Problem, x: &[f64]) {
        let at = self.layout;
        // A joint of which nothing is known may stand anywhere on the curve: let it halve its two spans.
        let all_idle = problem.joints.iter().all(super::Joint::is_idle);
        for (i, joint) in problem.joints.iter().enumerate().skip(usize::from(all_idle)) {
            if let ([Some(arriving), Some(leaving)], true) = (problem.sides(i), joint.is_idle()) {
                self.linear(vec![(at.length(arriving), 1.0), (at.length(leaving), -1.0)], 0.0);
            }
        }
        let mut motions = motions(problem, at, x);
        if all_idle && problem.closed {
            motions.push(self.slide(problem, x));
        }
        // Sliding along a circle is turning it: motions that the others contain add nothing.
        let mut kept: Vec<Vec<f64>> = Vec::new();
        for mut motion in motions {
            let size = dot(&motion, &motion).sqrt();
            for other in &kept {
                let by = dot(other, &motion);
                motion.iter_mut().zip(other).for_each(|(m, o)| *m -= by * o);
            }
            let rest = dot(&motion, &motion).sqrt();
            if rest > 1e-6 * size {
                motion.iter_mut().for_each(|m| *m /= rest);
                kept.push(motion);
            }
        }
        for motion in kept {
            let value = dot(&motion, x);
            let terms = motion.into_iter().enumerate().filter(|&(_, by)| by != 0.0).collect();
            self.linear(terms, value);
        }
    }

    /// All joints moved along the curve by the same length.
    fn slide(&self, problem: &Problem, x: &[f64]) -> Vec<f64> {
        let at = self.layout;
        let mut motion = vec![0.0; at.unknowns()];
        for span in 0..problem.spans() {
            let series = at.coefficients(x, span);
            let (length, angle) = (x[at.length(span)], x[at.angle(span)]);
            motion[at.point(span, 0)] = angle.cos();
            motion[at.point(span, 1)] = angle.sin();
            motion[at.angle(span)] = sum(series, &self.ends[0].value) / length;
            for (weight, basis) in &self.rule {
                let slope = sum(series, &basis.slope) / length;
                for (j, p) in basis.value.iter().enumerate() {
                    motion[at.coefficient(span, j)] += weight * slope * p;
                }
            }
        }
        motion
    }

    /// The functional and the conditions with their derivatives.
    pub fn linearise(&self, x: &[f64], multipliers: &[f64]) -> Linearised {
        let at = self.layout;
        let n = at.unknowns();
        let mut out = Linearised {
            value: 0.0,
            gradient: vec![0.0; n],
            conditions: Vec::with_capacity(self.conditions.len()),
            jacobian: Matrix::zeros(self.conditions.len(), n),
            hessian: Matrix::zeros(n, n),
        };
        self.functional(x, &mut out);
        for (i, condition) in self.conditions.iter().enumerate() {
            let row = out.jacobian.row_mut(i);
            let value = match condition {
                Condition::Linear { terms, value } => {
                    for &(index, by) in terms {
                        row[index] += by;
                    }
                    terms.iter().map(|&(index, by)| by * x[index]).sum::<f64>() - value
                }
                &Condition::SharesCurvature { arriving, leaving } => {
                    self.shared_curvature(x, arriving, leaving, multipliers[i], row, &mut out.hessian)
                }
                &Condition::Closes { span, end, axis } => {
                    row[at.point(end, axis)] -= 1.0;
                    row[at.point(span, axis)] += 1.0;
                    let chord = x[at.point(end, axis)] - x[at.point(span, axis)];
                    self.reach(x, span, axis, multipliers[i], row, &mut out.hessian) - chord
                }
            };
            out.conditions.push(value);
        }
        out
    }

    /// `Lᵖ G` with `G = v V + e E + t L`: the length couples all spans.
    fn functional(&self, x: &[f64], out: &mut Linearised) {
        let at = self.layout;
        let Functional { variation, bending, tension, power } = self.functional;
        let (mut total, mut sum) = (0.0, 0.0);
        let (g, h) = (&mut out.gradient, &mut out.hessian);
        for span in 0..at.spans {
            let series = at.coefficients(x, span);
            let (i, l) = (at.length(span), x[at.length(span)]);
            total += l;
            let (v, e) = (variation / (l * l * l), bending / l);
            let by_variation = self.variation.times(series);
            let (k2, d2) = (dot(series, series), dot(series, &by_variation));
            sum += v * d2 + e * k2 + tension * l;
            g[i] += (-3.0 * v * d2 - e * k2) / l + tension;
            h[(i, i)] += (12.0 * v * d2 + 2.0 * e * k2) / (l * l);
            for a in 0..=at.degree {
                let ia = at.coefficient(span, a);
                g[ia] += 2.0 * (v * by_variation[a] + e * series[a]);
                let mixed = -2.0 * (3.0 * v * by_variation[a] + e * series[a]) / l;
                h[(ia, i)] += mixed;
                h[(i, ia)] += mixed;
                h[(ia, ia)] += 2.0 * e;
                for b in 0..=at.degree {
                    h[(ia, at.coefficient(span, b))] += 2.0 * v * self.variation[(a, b)];
                }
            }
        }
        let p = f64::from(power);
        let scale = total.powi(power);
        let (first, second) = (p * scale / total, p * (p - 1.0) * scale / (total * total));
        let is_length: Vec<f64> = {
            let mut marks = vec![0.0; at.unknowns()];
            (0..at.spans).for_each(|span| marks[at.length(span)] = 1.0);
            marks
        };
        for a in 0..at.unknowns() {
            for b in 0..at.unknowns() {
                let (ea, eb) = (is_length[a], is_length[b]);
                h[(a, b)] = scale * h[(a, b)] + first * (g[a] * eb + ea * g[b]) + second * sum * ea * eb;
            }
        }
        for a in 0..at.unknowns() {
            g[a] = scale * g[a] + first * sum * is_length[a];
        }
        out.value = scale * sum;
    }

    fn shared_curvature(
        &self,
        x: &[f64],
        arriving: usize,
        leaving: usize,
        multiplier: f64,
        row: &mut [f64],
        hessian: &mut Matrix,
    ) -> f64 {
        let at = self.layout;
        let mut value = 0.0;
        for (span, other, end, sign) in
            [(arriving, leaving, &self.ends[1], 1.0), (leaving, arriving, &self.ends[0], -1.0)]
        {
            let rate = sign * sum(at.coefficients(x, span), &end.value);
            let i = at.length(other);
            value += rate * x[i];
            row[i] += rate;
            for (j, p) in end.value.iter().enumerate() {
                let ij = at.coefficient(span, j);
                row[ij] += sign * p * x[i];
                hessian[(ij, i)] += multiplier * sign * p;
                hessian[(i, ij)] += multiplier * sign * p;
            }
        }
        value
    }

    /// One coordinate of `L ∫ (cos θ, sin θ)`.
    fn reach(
        &self,
        x: &[f64],
        span: usize,
        axis: usize,
        multiplier: f64,
        row: &mut [f64],
        hessian: &mut Matrix,
    ) -> f64 {
        let at = self.layout;
        let (i, length) = (at.length(span), x[at.length(span)]);
        let mut mean = 0.0;
        for (weight, basis) in &self.rule {
            let angle = x[at.angle(span)] + sum(at.coefficients(x, span), &basis.integral);
            let (sin, cos) = angle.sin_cos();
            let (f, slope) = if axis == 0 { (cos, -sin) } else { (sin, cos) };
            mean += weight * f;
            // The angle's derivatives by its unknowns: the start angle, then the coefficients.
            let by = |a: usize| if a == 0 { 1.0 } else { basis.integral[a - 1] };
            for a in 0..at.degree + 2 {
                let ia = at.angle(span) + a;
                row[ia] += weight * length * slope * by(a);
                let mixed = multiplier * weight * slope * by(a);
                hessian[(ia, i)] += mixed;
                hessian[(i, ia)] += mixed;
                let second = -multiplier * weight * length * f * by(a);
                for b in 0..at.degree + 2 {
                    hessian[(ia, at.angle(span) + b)] += second * by(b);
                }
            }
        }
        row[i] += mean;
        length * mean
    }
}

/// Translations, turning and scaling, as far as the data admit them and the functional does not see them.
fn motions(problem: &Problem, at: Layout, x: &[f64]) -> Vec<Vec<f64>> {
    let fixed: Vec<Point> = problem.joints.iter().filter(|j| j.fixed).map(|j| j.position).collect();
    let pivot = fixed.first().copied().unwrap_or([0.0; 2]);
    let pinned = fixed.iter().any(|&point| point != pivot);
    let angles = problem.joints.iter().any(|j| j.angle.iter().any(Option::is_some));
    let radii = problem.joints.iter().flat_map(|j| j.curvature).flatten().any(|curvature| curvature != 0.0);
    let mut out = Vec::new();
    if fixed.is_empty() {
        for axis in 0..2 {
            let mut motion = vec![0.0; at.unknowns()];
            (0..at.joints).for_each(|i| motion[at.point(i, axis)] = 1.0);
            out.push(motion);
        }
    }
    if !pinned && !angles {
        let mut motion = vec![0.0; at.unknowns()];
        for i in 0..at.joints {
            motion[at.point(i, 0)] = pivot[1] - x[at.point(i, 1)];
            motion[at.point(i, 1)] = x[at.point(i, 0)] - pivot[0];
        }
        (0..at.spans).for_each(|span| motion[at.angle(span)] = 1.0);
        out.push(motion);
    }
    if !pinned && !radii && problem.functional.is_scale_invariant() && problem.length.is_none() {
        let mut motion = vec![0.0; at.unknowns()];
        for i in 0..at.joints {
            for axis in 0..2 {
                motion[at.point(i, axis)] = x[at.point(i, axis)] - pivot[axis];
            }
        }
        (0..at.spans).for_each(|span| motion[at.length(span)] = x[at.length(span)]);
        out.push(motion);
    }
    out
}
