//! Planar curves in their natural parameter: the direction as a function of arc length.
//!
//! Written by the direction `θ(s)`, the functionals are quadratic: `∫ θ''² ds`, `∫ θ'² ds`, `L`. All that is nonlinear is
//! that every span must end at its joint. With `u = s/L`, a span's direction is
//!
//! ```text
//! θ(u) = φ₀ h₀₀ + λa h₁₀ + φ₁ h₀₁ + λb h₁₁ + x ψ₄ + Σ yₖ ψₖ
//! ```
//!
//! with `φ₀, φ₁` the directions at its ends against the chord of length `c`, `a, b` the curvatures there times `c`,
//! `λ = L/c`, cubic Hermite functions `h`, and functions `ψ` that vanish at the ends with their slopes. The span closes if
//! `∫ sin θ du = 0` and `∫ cos θ du = 1/λ`, which determine `x` and `λ`; the `yₖ` are free. Directions and curvatures at
//! the joints are what spans share: two unknowns a joint. Newton's method on the Lagrangian, every span condensed to its
//! four shared values, takes a handful of iterations.
//!
//! With two functions beyond the cubics this costs a fraction of a microsecond a span and gives start values nearer to the
//! true minimum variation curve than quintics in Hermite form can be. With many it *is* the true curve, to rounding where
//! it is smooth. A power of the length that multiplies the integral, and a length that is given, are met by the
//! tension that belongs to them, which is an unknown more.

mod chain;
mod fit;
mod functions;
mod span;
mod trace;

pub(super) use chain::angle;
pub(super) use trace::{TrueCurve, trace, trace_len};

use super::fairness::{Density, Shape};
use super::joint::Given;
use super::model::{Division, Model};
use super::report::NOTHING;
use crate::solve::Problem;
use chain::{Chain, Effort, Ended, Law};
use fit::{Known, fit};
use functions::COARSE;
use span::Weigh;

/// For start values.
const ROUGH: Effort = Effort { settled: 3e-3, iterations: 12, exact: false };
/// A curve that settles where it costs by this factor more than it did to start with has gone astray.
const RISES: f64 = 10.0;
/// The elements' part of what is left over may be this share of all.
const SHARE: f64 = 0.03;
/// The memory that [`improve`] needs for so many joints and spans.
pub(super) const fn memory_len(joints: usize, spans: usize, closed: bool) -> usize {
    chain::memory_len(6, joints, spans, closed)
}

/// Whether a curve can be treated by its directions: planar, all joints fixed, no reference, one element a span.
fn applies<const D: usize>(model: &Model<'_, D>) -> bool {
    D == 2
        && model.division == Division::Even(1)
        && model.curve.reference.is_none()
        && model.curve.joints.iter().all(|joint| joint.position.given == Given::FIXED)
}

fn task<const D: usize>(model: &Model<'_, D>, length: Option<f64>) -> (Weigh, Law) {
    let weigh =
        Weigh { bend: model.weights.variation, slope: model.weights.bending, length: model.weights.length };
    let law = match (length, model.functional.length_power()) {
        (Some(length), _) => Law::Length(length),
        (None, 0) => Law::Plain,
        (None, power) => Law::Power(f64::from(power)),
    };
    (weigh, law)
}

/// What became of start values.
#[derive(Clone, Copy)]
pub(super) struct Improved {
    /// The tension that meets a given length; 0 without one.
    pub(super) tension: f64,
    /// The weighed integrals of the curve that the elements run along, and by how much, about, they exceed the least
    /// there is.
    pub(super) integral: f64,
    pub(super) left_out: f64,
    /// By how much those of the elements exceed the curve's, about.
    pub(super) misfit: f64,
    /// Whether the curve grew on and on: it may have no minimum.
    pub(super) grows: bool,
}

/// What is wanted of start values.
#[derive(Clone, Copy)]
pub(super) struct Wish {
    /// The length that is asked for.
    pub(super) length: Option<f64>,
    /// A span that is closed the second-nearest way.
    pub(super) bent: Option<usize>,
    /// Whether the elements' speeds are near those that are looked for, as those of the last solution are.
    pub(super) warm: bool,
    /// The fraction of the functional by which it may exceed its minimum.
    pub(super) enough: f64,
}

/// Improves the start values of a planar curve with one element a span whose joints all stand fixed: directions and
/// curvatures at the joints, and the speeds. Returns nothing, and leaves the state untouched, where it does not apply
/// or does not settle.
///
/// `memory` holds [`memory_len`] numbers.
pub(super) fn improve<const D: usize>(
    model: &Model<'_, D>,
    wish: &Wish,
    state: &mut [f64],
    memory: &mut [f64],
    watch: &mut chain::Watch<'_>,
) -> Option<Improved>
where
    Shape<D>: Density<D>,
{
    if !applies(model) {
        return None;
    }
    let mut chain = Chain::of(&COARSE, model, state, wish.bent, memory)?;
    let (asked, law) = task(model, wish.length);
    let mut weigh = asked;
    // A curve that grows may have no minimum: what follows goes on from here, and finds out.
    let mut began = None;
    let ended = chain.settle(&mut weigh, law, &ROUGH, &mut |sums, step| {
        began.get_or_insert(model.value_of(sums));
        watch(sums, step)
    });
    if matches!(ended, Ended::Failed | Ended::Stopped) {
        return None;
    }
    let most = RISES * began.unwrap_or(f64::INFINITY) + NOTHING * model.natural_cost();
    if wish.length.is_none() && !(model.value_of(&chain.sums()) <= most) {
        // A span was closed another way than it started.
        return None;
    }
    let mut misfit = 0.0;
    let (varies, enough) = (weigh.bend > 0.0, SHARE * wish.enough);
    for index in 0..model.element_count() {
        let span = chain.span(index);
        let mut ends = [model.end(index, 0, state), model.end(index, 1, state)];
        let along = (ends[1].point - ends[0].point) / span.chord;
        for (end, this) in ends.iter_mut().enumerate() {
            *this = chain.joint_end(index, end, &span, &along, this);
        }
        let direction = span.coefficients();
        let known = Known { direction: &direction, length: span.length(), from: 0.0, to: 1.0 };
        let weight = if varies { weigh.bend } else { weigh.slope };
        // Along a straight line speeds of a last solution that all but stop fit as well as any.
        let mut warm = wish.warm;
        loop {
            if !warm {
                super::start::give_speeds(&mut ends, span.length(), span.turning(&COARSE));
            }
            let missed = weight * fit(&mut ends, &known, varies, warm, enough);
            for (end, value) in ends.iter().enumerate() {
                model.set_end(index, end, value, state);
            }
            if !warm || model.cost(index, state).is_finite() {
                misfit += missed;
                break;
            }
            warm = false;
        }
    }
    let tension = if wish.length.is_some() { weigh.length } else { 0.0 };
    let (integral, left_out) = (chain.integral(&asked), chain.left_out());
    Some(Improved { tension, grows: ended == Ended::Grown, integral, left_out, misfit })
}
