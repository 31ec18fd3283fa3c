//! The functionals of space curves that know torsion, over one element: by its Hermite rows, point by point.
//!
//! What they need of an element beyond the plain functionals is the fourth derivative, and at joints one thing more: the
//! space MVC asks for continuous torsion, without which its minimum is a row of helices that do not fit. A *tie* holds
//! the torsion at an end of an element to a number that its node has for an unknown (see [`super::model`]).

use super::functional::Functional;
use super::rows::RowDerivatives;
use super::torsion::{
    SpaceFunctional, space_density, space_density_derivatives, torsion, torsion_and_slope,
    torsion_derivatives,
};
use crate::basis::hermite;
use crate::basis::mirrored::COORDINATES;
use crate::basis::quadrature::{FINEST, Rule, lobatto};
use crate::root::sqrt;
use nalgebra::SVector;

type Vector = SVector<f64, 3>;

/// The softening as a fraction of the typical curvature of the start.
const SOFTENING: f64 = 0.1;
/// A curvature below this fraction of the softening is an inflection.
const INFLECTION: f64 = 0.1;

/// A functional that knows torsion.
#[derive(Clone, Copy)]
pub(super) struct Space {
    pub(super) functional: SpaceFunctional,
    /// The curvature by which torsion is softened near inflections.
    softening: f64,
    /// Whether it is.
    pub(super) softens: bool,
    /// Whether the torsion at joints counts.
    pub(super) tied: bool,
    /// Whether other starts of the elements' own unknowns are tried.
    pub(super) explores: bool,
}

/// How an element's derivatives grow with the chord and the derivatives at its ends: order `k + 1`, coordinate `a`.
type Growth = [[f64; COORDINATES]; 4];

fn growth(t: f64) -> Growth {
    let [_, first, second, third] = hermite::basis(t);
    [first, second, third, hermite::fourth(t)].map(|[_, v0, a0, a1, v1, p1]| [p1, v0, a0, a1, v1])
}

/// The chord and the derivatives at the ends.
fn coordinates<const D: usize>(rows: &[SVector<f64, D>; 6]) -> [Vector; COORDINATES] {
    let lift = |row: &SVector<f64, D>| Vector::from_fn(|d, _| row.get(d).copied().unwrap_or(0.0));
    [lift(&(rows[5] - rows[0])), lift(&rows[1]), lift(&rows[2]), lift(&rows[3]), lift(&rows[4])]
}

/// `C' … C''''`.
fn derivatives(of: &[Vector; COORDINATES], by: &Growth) -> [Vector; 4] {
    by.map(|by| {
        let mut sum = Vector::zeros();
        for a in 0..COORDINATES {
            sum += of[a] * by[a];
        }
        sum
    })
}

/// How the torsion at an end of an element differs from what it is held to, with derivatives.
#[derive(Clone, Copy)]
pub(super) struct Tie<const D: usize> {
    /// The derivative of the cost by the node's torsion, and its second.
    pub(super) slope: f64,
    pub(super) second: f64,
    /// The derivative of the cost by the node's torsion and by the rows.
    pub(super) mixed: [[f64; D]; COORDINATES],
}

impl<const D: usize> Tie<D> {
    pub(super) const NONE: Self = Self { slope: 0.0, second: 0.0, mixed: [[0.0; D]; COORDINATES] };
}

impl Space {
    pub(super) fn of(functional: Functional) -> Option<Self> {
        let functional = functional.of_space()?;
        Some(Self { functional, softening: 1.0, softens: true, tied: true, explores: true })
    }

    /// The functional alone, whatever torsion does at joints.
    pub(super) fn untied(self) -> Self {
        Self { tied: false, ..self }
    }

    /// Takes the typical curvature from a start with this bending energy and length.
    pub(super) fn take_scale(&mut self, bending: f64, length: f64) {
        let mean = sqrt(bending / length);
        let least = 1.0 / length;
        self.softening = SOFTENING * if mean > least { mean } else { least };
    }

    /// The typical curvature.
    pub(super) fn scale(&self) -> f64 {
        self.softening / SOFTENING
    }

    /// Whether a curve of this least curvature is without inflection.
    pub(super) fn bends(&self, least: f64) -> bool {
        least >= INFLECTION * self.softening
    }

    fn softness(&self) -> f64 {
        if self.softens { self.softening } else { 0.0 }
    }

    /// How much of `∫ |db/ds|² ds` belongs to the functional beside what is computed here.
    pub(super) fn plain_variation(&self) -> f64 {
        if self.softens && self.functional == SpaceFunctional::Mvc { 1.0 } else { 0.0 }
    }

    fn rule(points: usize) -> Rule {
        lobatto(points).unwrap_or(FINEST)
    }

    /// The functional of an element by a Gauss–Lobatto rule, without its plain variation; infinite outside the domain.
    pub(super) fn value<const D: usize>(&self, rows: &[SVector<f64, D>; 6], points: usize) -> f64 {
        let of = coordinates(rows);
        let mut sum = 0.0;
        for (t, weight) in Self::rule(points).iter() {
            sum += weight * space_density(self.functional, self.softness(), &derivatives(&of, &growth(t)));
        }
        sum
    }

    /// The least curvature at the points of the finest rule.
    pub(super) fn least_curvature<const D: usize>(&self, rows: &[SVector<f64, D>; 6]) -> f64 {
        let of = coordinates(rows);
        let mut least = f64::INFINITY;
        for (t, _) in FINEST.iter() {
            let [first, second, ..] = derivatives(&of, &growth(t));
            let (normal, p) = (first.cross(&second), first.dot(&first));
            let square = normal.dot(&normal) / (p * p * p);
            // Not a number counts as none.
            least = if square >= least { least } else { square };
        }
        sqrt(least)
    }

    /// Adds `factor` times the functional of an element with gradient and Hessian.
    pub(super) fn add<const D: usize>(
        &self,
        rows: &[SVector<f64, D>; 6],
        points: usize,
        factor: f64,
        to: &mut RowDerivatives<D>,
    ) {
        let of = coordinates(rows);
        for (t, weight) in Self::rule(points).iter() {
            let by = growth(t);
            let found = space_density_derivatives(self.functional, self.softness(), &derivatives(&of, &by));
            let weight = weight * factor;
            to.cost += weight * found.value;
            // The Hessian's blocks times the motion of each coordinate.
            let mut column = [[[[0.0; 3]; 3]; COORDINATES]; 4];
            for k in 0..4 {
                for l in 0..4 {
                    let (row, at) = if k >= l { (k, l) } else { (l, k) };
                    let block = &found.hessian[row][at];
                    for x in 0..D.min(3) {
                        for y in 0..D.min(3) {
                            let entry = weight * if k >= l { block[(x, y)] } else { block[(y, x)] };
                            for b in 0..COORDINATES {
                                column[k][b][x][y] += entry * by[l][b];
                            }
                        }
                    }
                }
            }
            for a in 0..COORDINATES {
                for k in 0..4 {
                    for x in 0..D.min(3) {
                        to.gradient[a][x] += weight * by[k][a] * found.gradient[k][x];
                        for b in 0..COORDINATES {
                            for y in 0..D.min(3) {
                                to.hessian[a][b][x][y] += by[k][a] * column[k][b][x][y];
                            }
                        }
                    }
                }
            }
        }
    }

    /// The torsion at an end of an element.
    pub(super) fn torsion<const D: usize>(&self, rows: &[SVector<f64, D>; 6], end: usize) -> f64 {
        let [first, second, third, _] = derivatives(&coordinates(rows), &growth(end as f64));
        torsion(self.softness(), &[first, second, third])
    }

    /// The torsion at an end of an element and its rate of change along the curve; 0 where they are undefined.
    pub(super) fn torsion_and_slope<const D: usize>(
        &self,
        rows: &[SVector<f64, D>; 6],
        end: usize,
    ) -> [f64; 2] {
        let found = torsion_and_slope(self.softness(), &derivatives(&coordinates(rows), &growth(end as f64)));
        found.map(|x| if x.is_finite() { x } else { 0.0 })
    }

    /// Adds `weight (τ − target)²` at an end of an element.
    pub(super) fn add_tie<const D: usize>(
        &self,
        rows: &[SVector<f64, D>; 6],
        end: usize,
        weight: f64,
        target: f64,
        to: &mut RowDerivatives<D>,
    ) {
        let by = growth(end as f64);
        let [first, second, third, _] = derivatives(&coordinates(rows), &by);
        let found = torsion_derivatives(self.softness(), &[first, second, third]);
        let off = found.value - target;
        to.cost += weight * off * off;
        let twice = 2.0 * weight;
        let mut slope = [[0.0; D]; COORDINATES];
        for a in 0..COORDINATES {
            for x in 0..D.min(3) {
                for k in 0..3 {
                    slope[a][x] += by[k][a] * found.gradient[k][x];
                }
            }
        }
        for a in 0..COORDINATES {
            for x in 0..D.min(3) {
                to.gradient[a][x] += twice * off * slope[a][x];
                for b in 0..COORDINATES {
                    for y in 0..D.min(3) {
                        let mut bend = 0.0;
                        for k in 0..3 {
                            for l in 0..3 {
                                let entry = if k >= l {
                                    found.hessian[k][l][(x, y)]
                                } else {
                                    found.hessian[l][k][(y, x)]
                                };
                                bend += by[k][a] * by[l][b] * entry;
                            }
                        }
                        to.hessian[a][b][x][y] += twice * (slope[a][x] * slope[b][y] + off * bend);
                    }
                }
            }
        }
        to.ties[end] =
            Tie { slope: -twice * off, second: twice, mixed: slope.map(|row| row.map(|x| -twice * x)) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_typical_curvature_is_the_mean_one_and_at_least_one_over_the_length() {
        let Some(mut space) = Space::of(Functional::SPACE_MVC) else { panic!("a functional with torsion") };
        for (bending, length, wanted) in [(8.0, 2.0, 2.0), (1e-6, 4.0, 0.25), (0.0, 0.5, 2.0)] {
            space.take_scale(bending, length);
            assert!((space.scale() - wanted).abs() < 1e-15, "{bending} {length}: {}", space.scale());
            assert!(space.bends(INFLECTION * SOFTENING * wanted * 1.001));
            assert!(!space.bends(INFLECTION * SOFTENING * wanted * 0.999));
        }
    }

    /// Of `(t, t², 0)`, which bends least at its end, at any size.
    #[test]
    fn the_least_curvature_is_found_at_any_size() {
        let Some(space) = Space::of(Functional::SPACE_MEC) else { panic!("a functional with torsion") };
        for size in [1.0, 1e-3, 1e6] {
            let row = |x: f64, y: f64| SVector::from([size * x, size * y, 0.0]);
            let rows =
                [row(0.0, 0.0), row(1.0, 0.0), row(0.0, 2.0), row(0.0, 2.0), row(1.0, 2.0), row(1.0, 1.0)];
            let found = space.least_curvature(&rows) * size;
            let wanted = 2.0 / (5.0 * sqrt(5.0));
            assert!((found - wanted).abs() < 1e-14, "{size}: {found} {wanted}");
        }
    }
}
