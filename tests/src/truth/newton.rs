//! Newton's method on the stationarity of the Lagrangian.

use super::dense::{Matrix, dot, null_space, smallest_eigenvalue, solve as solve_dense};
use super::legendre::{Basis, sum};
use super::shape::Span;
use super::start::SpanStart;
use super::system::{Linearised, System};
use super::{Functional, Problem};
use crate::curves::gauss_legendre;

/// The stiffness below which a variation counts as indifferent.
const NO_STIFFNESS: f64 = 1e-9;
/// A residual that may be all rounding.
const ROUNDING: f64 = 1e-13;
/// Newton steps after which the search is given up.
const MAX_ITERATIONS: usize = 300;
/// Residual that a solution may keep, against the largest force.
const TOLERANCE: f64 = 1e-11;

/// A stationary curve and its figures.
#[derive(Clone, Debug)]
pub struct TrueCurve {
    /// The spans in order.
    pub spans: Vec<Span>,
    /// The functional.
    pub value: f64,
    /// `V = ∫ (dκ/ds)² ds`.
    pub variation: f64,
    /// `E = ∫ κ² ds`.
    pub bending: f64,
    /// The length `L`.
    pub length: f64,
    /// What the functional would lose by a unit more of length, where the length is fixed; else 0.
    pub length_force: f64,
    /// How far the equations are from zero, against the largest force.
    pub residual: f64,
    /// Newton steps taken.
    pub iterations: usize,
    /// The smallest eigenvalue of the Lagrangian's second derivative along what the conditions leave free, in units of the
    /// curve's size.
    pub stiffness: f64,
}

impl TrueCurve {
    /// Whether every admissible variation that is no mere motion raises the functional.
    pub fn is_minimum(&self) -> bool {
        self.stiffness > NO_STIFFNESS
    }

    /// The curve as a start for another problem with as many spans.
    pub fn as_start(&self) -> Vec<SpanStart> {
        self.spans
            .iter()
            .map(|span| SpanStart {
                length: span.length,
                angle: span.angle,
                curvature: gauss_legendre(span.series.len())
                    .iter()
                    .map(|&(u, _)| span.curvature(u))
                    .collect(),
            })
            .collect()
    }
}

/// No solution was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stalled {
    /// How far the equations were from zero, against the largest force.
    pub residual: f64,
    /// Newton steps taken.
    pub iterations: usize,
}

/// The stationary curve next to a start, its spans' turning rates of a given degree.
///
/// # Errors
///
/// If the iteration does not end at rounding.
///
/// # Panics
///
/// If the start has not one entry a span.
pub fn solve(problem: &Problem, start: &[SpanStart], degree: usize) -> Result<TrueCurve, Stalled> {
    assert_eq!(start.len(), problem.spans(), "one start a span");
    // Lengths in units of a span: unknowns, equations and multipliers are then of the order of one.
    let unit = start.iter().map(|span| span.length).sum::<f64>() / start.len() as f64;
    let (scaled, factor) = in_units(problem, unit);
    let scaled_start: Vec<SpanStart> = start
        .iter()
        .map(|span| SpanStart {
            length: span.length / unit,
            curvature: span.curvature.iter().map(|kappa| kappa * unit).collect(),
            ..*span
        })
        .collect();
    let (system, mut x) = System::new(&scaled, &scaled_start, degree);
    let mut multipliers = vec![0.0; system.conditions()];
    let mut here = system.linearise(&x, &multipliers);
    multipliers = balancing(&here).unwrap_or(multipliers);
    here = system.linearise(&x, &multipliers);
    let mut residual = relative_residual(&here, &multipliers);
    let mut iterations = 0;
    while iterations < MAX_ITERATIONS {
        let Some(next) = step(&system, &x, &multipliers, &here) else { break };
        (x, multipliers, here) = next;
        iterations += 1;
        let before = residual;
        residual = relative_residual(&here, &multipliers);
        // Rounding lowers the residual by chance for ever.
        if before < ROUNDING && residual > 0.25 * before {
            break;
        }
    }
    if !(residual < TOLERANCE) {
        return Err(Stalled { residual, iterations });
    }
    let at = system.layout();
    let spans = (0..problem.spans())
        .map(|i| Span {
            start: [0, 1].map(|axis| unit * x[at.point(i, axis)]),
            length: unit * x[at.length(i)],
            angle: x[at.angle(i)],
            series: at.coefficients(&x, i).to_vec(),
        })
        .collect();
    let force = system.length_condition().map_or(0.0, |i| multipliers[i] * factor / unit);
    Ok(measured(problem, spans, &here, residual, iterations, force))
}

/// The problem with lengths in a unit, and what its functional is to be multiplied by to be that of the given one.
fn in_units(problem: &Problem, unit: f64) -> (Problem, f64) {
    let mut scaled = problem.clone();
    for joint in &mut scaled.joints {
        joint.position = joint.position.map(|x| x / unit);
        joint.curvature = joint.curvature.map(|side| side.map(|kappa| kappa * unit));
    }
    scaled.length = problem.length.map(|length| length / unit);
    let f = problem.functional;
    let (variation, bending, tension) =
        (f.variation / (unit * unit * unit), f.bending / unit, f.tension * unit);
    let largest = variation.abs().max(bending.abs()).max(tension.abs());
    scaled.functional = Functional {
        variation: variation / largest,
        bending: bending / largest,
        tension: tension / largest,
        ..f
    };
    (scaled, largest * unit.powi(f.power))
}

/// The multipliers that come nearest to balancing the functional's gradient.
fn balancing(here: &Linearised) -> Option<Vec<f64>> {
    let m = here.jacobian.rows();
    let mut normal = Matrix::zeros(m, m);
    for i in 0..m {
        for j in 0..m {
            normal[(i, j)] = dot(here.jacobian.row(i), here.jacobian.row(j));
        }
    }
    let right: Vec<f64> = here.jacobian.times(&here.gradient).into_iter().map(|x| -x).collect();
    solve_dense(&normal, &right)
}

/// The Lagrangian's gradient, then the conditions.
fn residuals(here: &Linearised, multipliers: &[f64]) -> Vec<f64> {
    let forces = here.jacobian.transposed_times(multipliers);
    here.gradient.iter().zip(forces).map(|(g, f)| g + f).chain(here.conditions.iter().copied()).collect()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

fn relative_residual(here: &Linearised, multipliers: &[f64]) -> f64 {
    norm(&residuals(here, multipliers)) / (1.0 + norm(&here.gradient))
}

/// A Newton step, shortened until the equations are nearer to zero; `None` where none brings them nearer.
fn step(
    system: &System,
    x: &[f64],
    multipliers: &[f64],
    here: &Linearised,
) -> Option<(Vec<f64>, Vec<f64>, Linearised)> {
    let (n, m) = (x.len(), multipliers.len());
    let mut kkt = Matrix::zeros(n + m, n + m);
    for i in 0..n {
        kkt.row_mut(i)[..n].copy_from_slice(here.hessian.row(i));
    }
    for i in 0..m {
        for j in 0..n {
            kkt[(n + i, j)] = here.jacobian[(i, j)];
            kkt[(j, n + i)] = here.jacobian[(i, j)];
        }
    }
    let residual = residuals(here, multipliers);
    let before = norm(&residual);
    let direction = solve_dense(&kkt, &residual)?;
    let at = system.layout();
    let spans = (n - at.length(0)) / (at.length(1) - at.length(0));
    let mut fraction = 1.0;
    while fraction > 1e-8 {
        let moved = |from: &[f64], by: &[f64]| -> Vec<f64> {
            from.iter().zip(by).map(|(x, d)| x - fraction * d).collect()
        };
        let (trial, forces) = (moved(x, &direction[..n]), moved(multipliers, &direction[n..]));
        if (0..spans).all(|span| trial[at.length(span)] > 0.3 * x[at.length(span)]) {
            let there = system.linearise(&trial, &forces);
            if norm(&residuals(&there, &forces)) < (1.0 - 1e-4 * fraction) * before {
                return Some((trial, forces, there));
            }
        }
        fraction *= 0.5;
    }
    None
}

fn measured(
    problem: &Problem,
    spans: Vec<Span>,
    here: &Linearised,
    residual: f64,
    iterations: usize,
    length_force: f64,
) -> TrueCurve {
    let free = null_space(&here.jacobian);
    let mut reduced = Matrix::zeros(free.rows(), free.rows());
    for i in 0..free.rows() {
        let row = free.times(&here.hessian.times(free.row(i)));
        reduced.row_mut(i).copy_from_slice(&row);
    }
    let length = spans.iter().map(|span| span.length).sum::<f64>();
    let bending = spans.iter().map(|span| dot(&span.series, &span.series) / span.length).sum::<f64>();
    let variation = spans
        .iter()
        .map(|span| {
            let degree = span.series.len() - 1;
            gauss_legendre(degree + 1)
                .iter()
                .map(|&(u, weight)| weight * sum(&span.series, &Basis::at(degree, u).slope).powi(2))
                .sum::<f64>()
                / span.length.powi(3)
        })
        .sum::<f64>();
    let f = problem.functional;
    TrueCurve {
        value: length.powi(f.power) * (f.variation * variation + f.bending * bending + f.tension * length),
        spans,
        variation,
        bending,
        length,
        length_force,
        residual,
        iterations,
        stiffness: smallest_eigenvalue(&reduced),
    }
}
