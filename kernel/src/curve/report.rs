//! What came out: elements in the caller's system, figures, and whether they can be believed.

use super::element::Element;
use super::fairness::{Density, Shape};
use super::figures::Figures;
use super::joint::{Continuity, Curve, Given, Quantity};
use super::model::Model;
use super::options::Options;
use super::passes::{self, Passes};
use crate::basis::quadrature::MAX_POINTS;
use crate::order::Order;
use crate::root::sqrt;
use crate::solve::{Outcome, Problem, Status};
use crate::total::Total;

#[cfg(test)]
mod tests;

/// How a curve came out. All figures in the caller's units; of a shape that has grown beyond the arithmetic they are
/// infinite, none is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// How the computation ended.
    pub status: Status,
    /// The number of iterations: trial steps, accepted or not.
    pub iterations: usize,
    /// How often an element was linearised (cost, gradient and Hessian), over all elements: the work that was done.
    pub linearisations: usize,
    /// The number of unknowns that the solver varied.
    pub unknowns: usize,
    /// Whether the curve was computed in a plane.
    pub planar: bool,
    /// How many elements the curve has: as many as [`super::elements_len`] says, or fewer with a tolerance.
    pub elements: usize,
    /// The estimated distance from the true minimum, where a tolerance was asked for; infinite where there is no estimate.
    pub error: f64,
    /// The functional's value by the rule that was minimised with.
    pub value: f64,
    /// The functional's value of the resulting elements by a finer rule: 32 points on each half, and on the halves of
    /// that wherever they do not settle it; to 1e-6. A converged curve's differs from `value` by no more than [`TRUSTED`]
    /// of it; where by much more than rounding, the curve is wild for its elements: take more of them.
    pub fine_value: f64,
    /// The length `L`. A converged curve's is the one that was asked for, to [`super::LENGTH_TRUSTED`].
    pub length: f64,
    /// The variation of curvature `V = ∫ (dκ/ds)² ds`.
    pub variation: f64,
    /// The bending energy `E = ∫ κ² ds`.
    pub bending: f64,
    /// The largest component of the functional's gradient by the unknowns, each times the unknown's natural size, as a
    /// fraction of the functional; infinite where little was asked for (a `relative_decrease` above 1e-9) and no step
    /// of the elements was needed for it.
    pub gradient: f64,
    /// The decrease of the functional that another Newton step would promise; infinite where the Hessian is not
    /// positive definite. Where no step was needed: an estimate of what the functional exceeds the true curve's by.
    pub decrement: f64,
}

/// The figures of a model's elements.
pub(super) fn figures_of<const D: usize>(model: &Model<'_, D>, state: &[f64]) -> Figures
where
    Shape<D>: Density<D>,
{
    let mut figures = Figures::default();
    (0..model.element_count()).for_each(|element| {
        figures.add(&model.rows(element, state), |piece| match &model.space {
            // No planar curve knows torsion.
            Some(space) if D == 3 => space.value(piece, MAX_POINTS),
            _ => 0.0,
        });
    });
    figures
}

/// Writes the elements, and says what they are worth.
pub(super) fn hand_over<const D: usize>(
    model: &Model<'_, D>,
    outcome: &Outcome,
    passes: &Passes<'_>,
    state: &[f64],
    elements: &mut [Element],
    options: &Options,
) -> Report
where
    Shape<D>: Density<D>,
{
    let count = model.element_count();
    let elements = elements.part_mut(..count);
    for (index, element) in elements.iter_mut().enumerate() {
        *element = world_element(model, index, state);
    }
    let mut model = *model;
    passes::soften_where_straight(&mut model, state);
    let model = &model;
    let outcome = Outcome {
        iterations: passes.iterations,
        linearisations: passes.linearisations,
        value: if model.space.is_some() { passes::value_of(model, state) } else { outcome.value },
        ..*outcome
    };
    let figures = figures_of(model, state);
    let mut report = report(model, &outcome, elements, &figures, options);
    // Speeds alone tell little where a curve went wrong.
    let growth = model.rough_length(state).larger(figures.length) / model.start_length;
    // Speeds grow, and so does a curve whose start was short: only its own length shows that a curve goes far.
    let reach = figures.length / data_length(model);
    let lost = if reach >= SHOWN_GROWTH { Status::Unbounded } else { Status::Stalled };
    let gave_up = matches!(report.status, Status::IterationLimit | Status::Stalled);
    let grows = growth > if passes.hurries() { GROWS } else { LONG_GROWTH };
    if report.status == Status::Unbounded || (gave_up && reach >= SHOWN_GROWTH && grows) {
        report.status = lost;
    }
    if report.status == Status::Converged {
        // Where no Newton step tells how far the minimum is, an element at the least speed is kept from it by that bound. An
        // energy that has no minimum is meant to be.
        let lacks = options.functional.bends() && !has_least_energy(&model.curve);
        let kept = !lacks && !outcome.decrement.is_finite() && model.all_but_stops(state);
        let regular = figures.irregular == 0 && !kept;
        let natural = model.natural_cost() * functional_scale(options, model.place.unit);
        let trusted = report.value.is_finite()
            && (report.fine_value - report.value).abs() <= TRUSTED * (report.value + NOTHING * natural);
        let long = passes.length_is_met(|| figures.length);
        let grown = growth > SUSPECT_GROWTH;
        if !(regular && trusted && long) {
            // What was minimised is not what the elements are: no minimum was found.
            report.status = if grown { lost } else { Status::Stalled };
        } else if growth > FARTHEST
            || (grown && !outcome.decrement.is_finite())
            || (reach > FARTHEST && options.length == 0.0)
        {
            // A loop on its way to infinity costs next to nothing beside the rest of the curve.
            report.status = lost;
        }
    }
    if report.status == Status::IterationLimit && report.iterations < options.max_iterations as usize {
        // A curve that seemed to grow was given fewer iterations than the caller allows.
        report.status = Status::Stalled;
    }
    report
}

/// What a functional's value in the local system is multiplied by to be in the caller's.
pub(super) fn functional_scale(options: &Options, unit: f64) -> f64 {
    match options.functional.scale_power() {
        0 => 1.0,
        1 => 1.0 / unit,
        _ => 1.0 / unit / unit / unit,
    }
}

/// How far `value` and `fine_value` of a converged curve may be apart, as a fraction of the functional. With one element a
/// span the elements themselves exceed the true minimum by more than that wherever a quadrature is off by so much.
pub const TRUSTED: f64 = 1e-4;
/// No curve is called converged that is so many times as long as the polygon through its given positions, unless its
/// length is given: by then a loop is on its way to infinity, and what stops it are its elements.
pub const FARTHEST: f64 = 50.0;
/// No curve is called unbounded before it is so many times as long as that polygon.
pub const SHOWN_GROWTH: f64 = 5.0;
/// A functional below this part of what is natural for the size is nothing.
pub(super) const NOTHING: f64 = 1e-9;
/// A curve that is wrong, and grew by more than this from its start, was on its way to infinity.
const SUSPECT_GROWTH: f64 = 10.0;
/// The same of one that was given up.
const LONG_GROWTH: f64 = 5.0;
/// How much a curve must have grown that grew already when its directions alone were solved for, and ends in no minimum.
const GROWS: f64 = 2.0;

/// Whether an energy has a minimum and not only an infimum. A curvature that is given costs an energy nothing if the curve
/// leaves it at once, ever more sharply; so does the common curvature of a G2 joint whose tangent is fixed.
fn has_least_energy(curve: &Curve<'_>) -> bool {
    let last = curve.joints.len().saturating_sub(1);
    curve.joints.iter().enumerate().all(|(index, joint)| {
        let inner = curve.closed || (index > 0 && index < last);
        let [tangent, _] = joint.tangent.map(|tangent| tangent.given == Given::FIXED);
        let split = inner && joint.continuity == Continuity::G2 && tangent;
        let bent = |curvature: &Quantity| matches!(curvature.given, Given::FIXED | Given::SIZE);
        !split && !joint.curvature.iter().any(bent)
    })
}

/// The length of the polygon through the given positions, in the local unit; the start's where there is none.
fn data_length<const D: usize>(model: &Model<'_, D>) -> f64 {
    let mut points = model
        .curve
        .joints
        .iter()
        .filter(|joint| joint.position.given != Given::FREE)
        .map(|joint| model.place.local_point(&joint.position.value));
    let Some(first) = points.next() else { return model.start_length };
    let (mut last, mut sum) = (first, 0.0);
    for point in points.chain(model.curve.closed.then_some(first)) {
        let chord = point - last;
        sum += sqrt(chord.dot(&chord));
        last = point;
    }
    if sum > 0.0 { sum } else { model.start_length }
}

/// An element in the caller's system, fixed positions to the last bit.
fn world_element<const D: usize>(model: &Model<'_, D>, index: usize, state: &[f64]) -> Element
where
    Shape<D>: Density<D>,
{
    let (place, local) = (&model.place, model.rows(index, state));
    let mut rows = [[0.0; 3]; 6];
    for (a, row) in rows.iter_mut().enumerate() {
        *row = if a == 0 || a == 5 { place.world_point(&local[a]) } else { place.world_vector(&local[a]) };
    }
    for (end, row) in [0, 5].into_iter().enumerate() {
        if let Some(joint) = model.joint(model.node(index, end))
            && joint.position.given == Given::FIXED
        {
            rows[row] = joint.position.value;
        }
    }
    Element { rows }
}

fn report<const D: usize>(
    model: &Model<'_, D>,
    outcome: &Outcome,
    elements: &[Element],
    figures: &Figures,
    options: &Options,
) -> Report
where
    Shape<D>: Density<D>,
{
    let scale = functional_scale(options, model.place.unit);
    // Of the local elements: the caller's are rounded where they lie far from the origin.
    let unit = model.place.unit;
    let (variation, bending, length) =
        (figures.variation / unit / unit / unit, figures.bending / unit, figures.length * unit);
    let plain = if let Some(space) = &model.space {
        figures.space * scale + space.plain_variation() * variation + options.bending * bending
    } else if options.functional.bends() {
        bending * (1.0 + options.bending)
    } else {
        variation + options.bending * bending
    } + options.tension * length;
    let fine_value = match options.functional.length_power() {
        0 => plain,
        1 => plain * length,
        _ => plain * length * length * length,
    };
    // A reference is no property of the elements: its part is measured by the finest rule there is.
    let fine_value = if model.curve.reference.is_some() {
        let fine = Model { points: MAX_POINTS, guarded: false, gauge: 0.0, ..*model };
        let value =
            |element: usize| fine.sums_of_rows(element, &model.place.local_rows(&elements[element]))[0];
        (0..elements.len()).map(value).sum::<f64>() * scale
    } else {
        fine_value
    };
    let known = |figure: f64| if figure.is_nan() { f64::INFINITY } else { figure };
    Report {
        status: outcome.status,
        iterations: outcome.iterations,
        linearisations: outcome.linearisations,
        unknowns: (0..model.blocks()).map(|block| model.dofs(block)).sum(),
        planar: D == 2,
        elements: elements.len(),
        error: 0.0,
        value: known(outcome.value * scale),
        fine_value: known(fine_value),
        length: known(length),
        variation: known(variation),
        bending: known(bending),
        gradient: known(outcome.gradient / outcome.value.larger(f64::MIN_POSITIVE)),
        decrement: known(outcome.decrement * scale),
    }
}
