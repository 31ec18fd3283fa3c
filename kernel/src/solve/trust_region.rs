//! The step of a trust region: the minimum of the quadratic model in a ball (Moré and Sorensen 1983).
//!
//! Unknowns are scaled to natural sizes, so the ball is round. The minimum solves `(H + shift·I) s = −g` with the
//! least `shift ≥ 0` that makes the matrix positive definite and the step no longer than the radius; `shift` is
//! found by Newton's method on `1/radius − 1/|s|`, safeguarded by bounds.

use super::envelope::{Allow, Envelope, Factored, Indefinite, dot};
use super::rank_two::RankTwo;
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;

/// The radius of a trust region, and how it learns from steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius(pub(super) f64);

impl Radius {
    /// Judges a step of the given length by the part of the promised decrease that it brought; `None` where the cost is
    /// not finite. Returns whether to take it.
    pub(super) fn judge(&mut self, ratio: Option<f64>, length: f64) -> bool {
        match ratio {
            Some(ratio) if ratio >= 0.25 => {
                if ratio > 0.75 && length > 0.8 * self.0 {
                    self.0 = 2.5 * length;
                }
                true
            }
            other => {
                self.0 = 0.25 * length;
                other.is_some_and(|ratio| ratio > LEAST_RATIO)
            }
        }
    }
}

/// A step that brings less than this part of what it promised is refused.
const LEAST_RATIO: f64 = 1e-4;

/// The step that was found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// The shift of the Hessian; 0 for a pure Newton step inside the ball.
    pub(super) shift: f64,
    /// The step's length.
    pub(super) length: f64,
    /// The decrease that the model promises.
    pub(super) predicted: f64,
}

/// The vectors that a step needs.
pub(super) struct Vectors<'a> {
    pub(super) gradient: &'a [f64],
    /// Where the step goes.
    pub(super) step: &'a mut [f64],
    pub(super) scratch: &'a mut [f64],
    pub(super) direction: &'a mut [f64],
    pub(super) factor: &'a mut [f64],
    /// What is added to the sparse matrix.
    pub(super) coupling: Option<RankTwo<'a>>,
}

impl Vectors<'_> {
    /// The Newton step of the factored matrix.
    fn newton(&mut self, envelope: &Envelope<'_, '_>, factored: Factored) {
        for (s, g) in self.step.iter_mut().zip(self.gradient.iter()) {
            *s = -g;
        }
        envelope.solve(self.factor, factored, self.step);
        if let Some(coupling) = &self.coupling {
            coupling.correct(self.step);
        }
    }

    /// `stepᵀ (matrix + shift)⁻¹ step` of the factored matrix.
    fn steepness(&mut self, envelope: &Envelope<'_, '_>, factored: Factored) -> f64 {
        self.scratch.copy(self.step);
        if let Some(coupling) = &self.coupling {
            envelope.solve(self.factor, factored, self.scratch);
            coupling.correct(self.scratch);
            return dot(self.scratch, self.step);
        }
        envelope.forward(self.factor, self.scratch);
        dot(self.scratch, self.scratch)
    }

    /// Factors the matrix with this shift, to nothing where the coupling leaves it indefinite.
    fn factor(
        &mut self,
        envelope: &Envelope<'_, '_>,
        matrix: &[f64],
        norm: f64,
        shift: f64,
    ) -> Result<Option<Factored>, Indefinite> {
        let allow = self.allow();
        let factored = envelope.factor(matrix, norm, shift, allow, self.factor)?;
        Ok(match &mut self.coupling {
            Some(coupling) => coupling.take(envelope, self.factor, factored).then_some(factored),
            None => Some(factored),
        })
    }

    fn allow(&self) -> Allow {
        self.coupling.as_ref().map_or(Allow::Definite, |coupling| coupling.allow)
    }

    /// Into `direction`: that of the least eigenvalue, of the factored matrix, which is nearly singular (inverse iteration).
    fn ridge(&mut self, envelope: &Envelope<'_, '_>, factored: Factored) {
        // Golden shares of a turn: no symmetry that a direction may have is theirs.
        let mut share = 0u32;
        for z in self.direction.iter_mut() {
            share = share.wrapping_add(0x9e37_79b9);
            *z = f64::from(share);
        }
        for _ in 0..RIDGE_ITERATIONS {
            let size = sqrt(dot(self.direction, self.direction));
            self.direction.iter_mut().for_each(|z| *z /= size);
            envelope.solve(self.factor, factored, self.direction);
            if let Some(coupling) = &self.coupling {
                coupling.correct(self.direction);
            }
        }
    }

    /// The decrease that the model promises for the step.
    fn promise(&mut self, envelope: &Envelope<'_, '_>, matrix: &[f64]) -> f64 {
        envelope.multiply(matrix, self.step, self.scratch);
        if let Some(coupling) = &self.coupling {
            coupling.add_product(self.step, self.scratch);
        }
        -dot(self.gradient, self.step) - 0.5 * dot(self.step, self.scratch)
    }
}

/// How near to the radius a step on the boundary must be.
const RADIUS_TOLERANCE: f64 = 0.1;
/// A negative curvature of less than this part of the matrix is rounding.
const RIDGE: f64 = 1e-10;
/// The shift is within a thousandth of the least eigenvalue: every turn leaves about as much of the others.
const RIDGE_ITERATIONS: usize = 3;
/// More factorisations than the safeguarded iteration ever needs.
const MOST_FACTORISATIONS: usize = 100;

pub(super) fn solve(
    envelope: &Envelope<'_, '_>,
    matrix: &[f64],
    vectors: &mut Vectors<'_>,
    radius: f64,
    last_shift: f64,
) -> Option<Step> {
    let mut norm = envelope.norm(matrix, vectors.scratch);
    let sparse_norm = norm;
    if let Some(coupling) = &vectors.coupling {
        norm += coupling.norm();
    }
    let gradient_length = sqrt(dot(vectors.gradient, vectors.gradient));
    let allow = vectors.allow();
    let (mut low, mut high) = (0.0f64, gradient_length / radius + norm);
    if !high.is_finite() {
        return None;
    }
    let mut shift = 0.0;
    let (mut is_indefinite, mut have_direction) = (false, false);
    let mut best: Option<Step> = None;
    for _ in 0..MOST_FACTORISATIONS {
        let definite = match vectors.factor(envelope, matrix, sparse_norm, shift) {
            Ok(definite) => definite,
            Err(failure) => {
                if allow == Allow::Definite {
                    envelope.negative_direction(vectors.factor, &failure, vectors.direction);
                    let square = dot(vectors.direction, vectors.direction);
                    if failure.pivot.is_finite() && square.is_finite() {
                        low = low.larger(shift - failure.pivot / square);
                        have_direction = vectors.coupling.is_none();
                    }
                }
                None
            }
        };
        let Some(factored) = definite else {
            is_indefinite = true;
            low = low.larger(shift);
            high = high.larger(low * 1.01 + 1e-300);
            shift = between(low, high, last_shift);
            continue;
        };
        vectors.newton(envelope, factored);
        let square = dot(vectors.step, vectors.step);
        let length = sqrt(square);
        let predicted = 0.5 * (shift * square - dot(vectors.gradient, vectors.step));
        let found = Step { shift, length, predicted };
        if (shift == 0.0 && length <= radius) || (length - radius).abs() <= RADIUS_TOLERANCE * radius {
            return Some(found);
        }
        if length < radius {
            high = shift;
            if is_indefinite && high - low <= 1e-3 * high.larger(f64::MIN_POSITIVE) {
                // A little above: where the shift itself is the eigenvalue, rounding hides the direction.
                if allow == Allow::OneNegative
                    && high > RIDGE * norm
                    && let Ok(Some(factored)) = vectors.factor(envelope, matrix, sparse_norm, 1.001 * high)
                {
                    vectors.ridge(envelope, factored);
                    have_direction = true;
                }
                if have_direction {
                    return Some(to_boundary(envelope, matrix, vectors, radius, found));
                }
            }
        } else {
            low = low.larger(shift);
        }
        best = Some(found);
        let newton = shift + (square / vectors.steepness(envelope, factored)) * ((length - radius) / radius);
        shift = if newton > low && newton < high { newton } else { between(low, high, 0.0) };
        if !(high - low > 1e-14 * high) {
            break;
        }
    }
    // The interval closed: the last step that a factorisation gave is shortened to the ball where it is too long.
    let found = best?;
    let factored = vectors.factor(envelope, matrix, sparse_norm, found.shift).ok()??;
    vectors.newton(envelope, factored);
    if found.length > radius {
        let shrink = radius / found.length;
        vectors.step.iter_mut().for_each(|s| *s *= shrink);
        let predicted = vectors.promise(envelope, matrix);
        return Some(Step { length: radius, predicted, ..found });
    }
    Some(found)
}

/// A shift strictly inside the interval: the last iteration's where that lies inside, else the geometric mean,
/// kept off the lower end.
fn between(low: f64, high: f64, wanted: f64) -> f64 {
    if wanted > low && wanted < high {
        return wanted;
    }
    sqrt(low * high).larger(low + 0.01 * (high - low))
}

/// The hard case: the gradient has no part along the direction of negative curvature, so the shifted step stays
/// inside the ball. Goes on along that direction to the boundary.
fn to_boundary(
    envelope: &Envelope<'_, '_>,
    matrix: &[f64],
    vectors: &mut Vectors<'_>,
    radius: f64,
    found: Step,
) -> Step {
    let Vectors { gradient, step, direction, .. } = vectors;
    let size = sqrt(dot(direction, direction));
    let downhill = if dot(gradient, direction) > 0.0 { -1.0 } else { 1.0 };
    direction.iter_mut().for_each(|z| *z *= downhill / size);
    let along = dot(step, direction);
    let missing = radius * radius - found.length * found.length;
    let reach = -along + sqrt(along * along + missing);
    for (s, z) in step.iter_mut().zip(direction.iter()) {
        *s += reach * z;
    }
    let predicted = vectors.promise(envelope, matrix);
    Step { length: radius, predicted, ..found }
}
