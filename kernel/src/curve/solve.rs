//! From a designer's data to elements: the three calls *how much*, *here it is*, *solve*.

use super::check::check;
use super::element::Element;
use super::error::CurveError;
use super::fairness::{Dimension, Exterior};
use super::joint::{Curve, Given};
use super::measure;
use super::model::Model;
use super::options::Options;
use super::placement::{Place, Placement};
use super::rows::derivatives;
use super::start::{Start, refine};
use crate::basis::hermite;
use crate::basis::quadrature;
use crate::solve::{
    self, Control, InOrder, Observer, Outcome, Problem, Record, Settings, Status, WorkspaceTooSmall,
};
use nalgebra::SVector;

/// How a curve came out. All figures in the caller's units.
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
    /// The functional's value by the rule that was minimised with.
    pub value: f64,
    /// The functional's value of the resulting elements by a finer rule, 32 points on each half. Where it differs from
    /// `value` by more than rounding, the curve is too wild for its elements: take more of them.
    pub fine_value: f64,
    /// The length `L`.
    pub length: f64,
    /// The variation of curvature `V = ∫ (dκ/ds)² ds`.
    pub variation: f64,
    /// The bending energy `E = ∫ κ² ds`.
    pub bending: f64,
    /// The largest component of the functional's gradient by the unknowns, each times the unknown's natural size,
    /// as a fraction of the functional.
    pub gradient: f64,
    /// The decrease of the functional that another Newton step would promise; infinite where the Hessian is not
    /// positive definite.
    pub decrement: f64,
}

/// The number of elements that a curve has: `spans × elements_per_span`.
pub const fn elements_len(curve: &Curve<'_>, options: &Options) -> usize {
    curve.spans().saturating_mul(options.elements_per_span as usize)
}

/// The workspace, in `f64`s, that [`solve()`] needs for these data. It depends on the number of joints, on what is
/// fixed at them and on whether they lie in a plane, not on the numbers otherwise.
///
/// # Errors
/// Everything that [`solve()`] would find wrong with the data and options, but for
/// [`CurveError::CurvatureNeedsTangent`], which shows with the start values.
pub fn workspace_len(curve: &Curve<'_>, options: &Options) -> Result<usize, CurveError> {
    options.check()?;
    let unit = check(curve)?;
    Ok(match Place::of(curve, unit, options.dimension)? {
        Place::Plane(_) => lens(&model::<2>(curve, options)).1,
        Place::Space(_) => lens(&model::<3>(curve, options)).1,
    })
}

/// Computes a curve (thesis chapter 4).
///
/// `workspace` needs [`workspace_len`] numbers in any condition, `elements` receives [`elements_len`] elements in
/// order along the curve; more room is left untouched. `records` receives one record an iteration as far as it
/// reaches. Fixed positions and tangent directions are kept exactly; planar data give elements exactly in their
/// plane where that is parallel to a coordinate plane, else to rounding.
///
/// # Errors
/// Whatever is wrong with data, options or memory, found before any work; `elements` is untouched then.
pub fn solve(
    curve: &Curve<'_>,
    options: &Options,
    workspace: &mut [f64],
    elements: &mut [Element],
    records: &mut [Record],
    observer: &mut dyn Observer,
) -> Result<Report, CurveError> {
    options.check()?;
    let unit = check(curve)?;
    match Place::of(curve, unit, options.dimension)? {
        Place::Plane(place) => run(curve, options, &place, workspace, elements, records, observer),
        Place::Space(place) => run(curve, options, &place, workspace, elements, records, observer),
    }
}

fn model<'a, const D: usize>(curve: &Curve<'a>, options: &Options) -> Model<'a, D> {
    let points = options.quadrature_points as usize;
    Model {
        curve: *curve,
        per_span: options.elements_per_span as usize,
        functional: options.functional,
        rule: quadrature::lobatto(points).unwrap_or(quadrature::FINEST),
        gauge: 0.0,
        guarded: true,
        natural_cost: 0.0,
        start_length: 0.0,
    }
}

/// The lengths of the state and of the whole workspace.
fn lens<const D: usize>(model: &Model<'_, D>) -> (usize, usize)
where
    Dimension<D>: Exterior<D>,
{
    let state = model.state_len();
    (state, state + solve::workspace_len(model, 1))
}

fn run<const D: usize>(
    curve: &Curve<'_>,
    options: &Options,
    place: &Placement<D>,
    workspace: &mut [f64],
    elements: &mut [Element],
    records: &mut [Record],
    observer: &mut dyn Observer,
) -> Result<Report, CurveError>
where
    Dimension<D>: Exterior<D>,
{
    let mut model = model::<D>(curve, options);
    let count = model.element_count();
    let too_short = CurveError::ElementsTooShort { needed: count, given: elements.len() };
    let elements = elements.get_mut(..count).ok_or(too_short)?;
    let (state_len, needed) = lens(&model);
    let given = workspace.len();
    if given < needed {
        return Err(CurveError::WorkspaceTooSmall { needed, given });
    }
    let (state, work) = workspace.split_at_mut(state_len);
    let wrong =
        |short: WorkspaceTooSmall| CurveError::WorkspaceTooSmall { needed: state_len + short.needed, given };
    let scale = functional_scale(options, place.unit);
    let mut passes = Passes {
        observer,
        records,
        scale,
        most: options.max_iterations as usize,
        iterations: 0,
        linearisations: 0,
    };

    // One element a span first: its solution, cut into parts, is within some millionths of what more elements reach.
    let mut coarse = Model { per_span: 1, ..model };
    let coarse_state = &mut state[..coarse.state_len()];
    coarse.natural_cost = Start { model: &coarse, place }.fill(coarse_state)?;
    coarse.start_length = coarse.rough_length(coarse_state);
    let last = model.per_span == 1;
    let tolerance =
        if last { options.relative_decrease } else { COARSE_DECREASE.max(options.relative_decrease) };
    let mut outcome = passes.shape_and_finish(&mut coarse, tolerance, coarse_state, work).map_err(wrong)?;
    model.start_length = coarse.start_length;
    model.natural_cost = coarse.natural_cost;
    if !last {
        let stopped = matches!(outcome.status, Status::Cancelled | Status::IterationLimit);
        let found = (stopped || outcome.status == Status::Converged)
            && is_regular((0..coarse.element_count()).map(|element| coarse.rows(element, coarse_state)));
        if found {
            let kept = &mut work[..coarse_state.len()];
            kept.copy_from_slice(coarse_state);
            model.natural_cost = refine(&coarse, kept, &model, state);
            if !stopped {
                outcome = passes
                    .minimise(&model, options.relative_decrease, RELAXATION, state, work)
                    .map_err(wrong)?;
            }
        } else {
            model.natural_cost = Start { model: &model, place }.fill(state)?;
            outcome =
                passes.shape_and_finish(&mut model, options.relative_decrease, state, work).map_err(wrong)?;
        }
    }
    outcome.iterations = passes.iterations;
    outcome.linearisations = passes.linearisations;

    for (index, element) in elements.iter_mut().enumerate() {
        *element = world_element(&model, place, index, state);
    }
    let mut report = report(&model, place, &outcome, elements, options);
    if report.status == Status::Converged {
        let regular = is_regular((0..count).map(|element| model.rows(element, state)));
        let natural = model.natural_cost * scale;
        let trusted =
            (report.fine_value - report.value).abs() <= TRUSTED * (report.value + NOTHING * natural);
        if !(regular && trusted) {
            // What was minimised is not what the elements are: no minimum was found.
            let grown = model.rough_length(state) > SUSPECT_GROWTH * model.start_length;
            report.status = if grown { Status::Unbounded } else { Status::Stalled };
        }
    }
    Ok(report)
}

/// Whether no element has a cusp or stops: its direction changes by less than a right angle, and its speed by less than
/// a factor of a hundred, between 65 places.
fn is_regular<const D: usize>(elements: impl Iterator<Item = [SVector<f64, D>; 6]>) -> bool {
    for rows in elements {
        let mut before: Option<SVector<f64, D>> = None;
        for k in 0..=64 {
            let [first, _, _] = derivatives(&rows, &hermite::basis(f64::from(k) / 64.0));
            let square = first.dot(&first);
            if !(square > 0.0) {
                return false;
            }
            if let Some(last) = before {
                let last_square = last.dot(&last);
                let (least, most) = (square.min(last_square), square.max(last_square));
                if !(last.dot(&first) > 0.0) || least < 1e-4 * most {
                    return false;
                }
            }
            before = Some(first);
        }
    }
    true
}

/// What a functional's value in the local system is multiplied by to be in the caller's.
fn functional_scale(options: &Options, unit: f64) -> f64 {
    if options.functional.scale_power() == 1 { 1.0 / unit } else { 1.0 / unit / unit / unit }
}

/// The first pass ends when a step promises to lower the functional by less than this fraction.
const SHAPING_DECREASE: f64 = 1e-1;
/// Steps of each element by itself between two of the whole curve.
const RELAXATION: usize = 10;
/// With one element a span on the way to more, a functional to this fraction is enough.
const COARSE_DECREASE: f64 = 1e-7;
/// How far a finer quadrature may be off, as a fraction of the functional.
const TRUSTED: f64 = 1e-4;
/// A functional below this part of what is natural for the size is nothing.
const NOTHING: f64 = 1e-9;
/// A curve that is wrong, and grew by more than this from its start, was on its way to infinity.
const SUSPECT_GROWTH: f64 = 10.0;

/// Runs one minimisation after the other as one to the caller: iterations numbered through, values in the caller's
/// units.
struct Passes<'a> {
    observer: &'a mut dyn Observer,
    records: &'a mut [Record],
    scale: f64,
    /// The most iterations of all together.
    most: usize,
    iterations: usize,
    linearisations: usize,
}

impl Passes<'_> {
    /// Two passes. First the shape, with a parametrisation that is kept even: only the shape decides how far a step goes
    /// then, and what is left to the second pass lies in the right one of many shallow valleys.
    fn shape_and_finish<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Dimension<D>: Exterior<D>,
    {
        let count = model.element_count();
        let total = |model: &Model<'_, D>, state: &[f64]| -> f64 {
            (0..count).map(|element| model.cost(element, state)).sum()
        };
        let mut start_cost = total(model, state);
        if !start_cost.is_finite() {
            model.guarded = false;
            start_cost = total(model, state);
        }
        let natural = if start_cost > 0.0 { model.natural_cost.min(start_cost) } else { model.natural_cost };
        model.gauge = natural / count as f64;
        let outcome = self.minimise(model, SHAPING_DECREASE, 0, state, work)?;
        model.gauge = 0.0;
        if matches!(outcome.status, Status::Cancelled | Status::Unbounded) {
            return Ok(outcome);
        }
        self.minimise(model, relative_decrease, RELAXATION, state, work)
    }

    /// One pass, with what is left of the iterations.
    fn minimise<const D: usize>(
        &mut self,
        model: &Model<'_, D>,
        relative_decrease: f64,
        relaxation: usize,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Dimension<D>: Exterior<D>,
    {
        let settings = Settings {
            max_iterations: self.most - self.iterations.min(self.most),
            relative_decrease,
            relaxation,
            ..Settings::DEFAULT
        };
        let outcome = solve::minimise(model, &settings, &InOrder, state, work, &mut [], self)?;
        self.iterations += outcome.iterations;
        self.linearisations += outcome.linearisations;
        Ok(outcome)
    }
}

impl Observer for Passes<'_> {
    fn iteration(&mut self, number: usize, record: &Record) -> Control {
        let record = Record {
            value: record.value * self.scale,
            predicted: record.predicted * self.scale,
            actual: record.actual * self.scale,
            gradient: record.gradient * self.scale,
            ..*record
        };
        let number = self.iterations + number;
        if let Some(slot) = self.records.get_mut(number - 1) {
            *slot = record;
        }
        self.observer.iteration(number, &record)
    }
}

/// An element in the caller's system, fixed positions to the last bit.
fn world_element<const D: usize>(
    model: &Model<'_, D>,
    place: &Placement<D>,
    index: usize,
    state: &[f64],
) -> Element
where
    Dimension<D>: Exterior<D>,
{
    let local = model.rows(index, state);
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
    place: &Placement<D>,
    outcome: &Outcome,
    elements: &[Element],
    options: &Options,
) -> Report
where
    Dimension<D>: Exterior<D>,
{
    let scale = functional_scale(options, place.unit);
    let (variation, bending) = (measure::variation(elements), measure::bending(elements));
    Report {
        status: outcome.status,
        iterations: outcome.iterations,
        linearisations: outcome.linearisations,
        unknowns: (0..model.blocks()).map(|block| model.dofs(block)).sum(),
        planar: D == 2,
        value: outcome.value * scale,
        fine_value: if options.functional.scale_power() == 1 { bending } else { variation },
        length: measure::length(elements),
        variation,
        bending,
        gradient: outcome.gradient / outcome.value.max(f64::MIN_POSITIVE),
        decrement: outcome.decrement * scale,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::joint::{Joint, Quantity};

    fn row(x: f64, y: f64) -> SVector<f64, 2> {
        SVector::from([x, y])
    }

    /// From the origin to (1, 0) with these speeds and no bend at the ends.
    fn straight(first: f64, last: f64) -> [SVector<f64, 2>; 6] {
        [row(0.0, 0.0), row(first, 0.0), row(0.0, 0.0), row(0.0, 0.0), row(last, 0.0), row(1.0, 0.0)]
    }

    #[test]
    fn folds_and_stops_are_irregular() {
        assert!(is_regular([straight(1.0, 1.0), straight(0.5, 1.2)].into_iter()));
        assert!(!is_regular([straight(1.0, 1.0), straight(-1.0, -1.0)].into_iter()), "a fold");
        assert!(!is_regular([straight(0.0, 1.0)].into_iter()), "a start without speed");
        assert!(!is_regular([straight(f64::NAN, 1.0)].into_iter()), "no number");
        let mut sharp = straight(1.0, 1.0);
        sharp[4] = row(1e-6, 0.0);
        sharp[3] = row(0.0, 1.0);
        assert!(!is_regular([sharp].into_iter()), "an end that nearly stops");
    }

    #[test]
    fn refining_keeps_the_curve() {
        let joints = [
            Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.3, 1.0, 0.0])),
            Joint::at([1.0, 0.4, 0.0]),
            Joint::at([1.5, -0.4, 0.0]),
        ];
        let curve = Curve { joints: &joints, closed: false };
        let Ok(Place::Plane(place)) = Place::of(&curve, 1.0, 0) else { panic!("planar data") };
        let fine = model::<2>(&curve, &Options { elements_per_span: 3, ..Options::DEFAULT });
        let coarse = Model { per_span: 1, ..fine };
        let (mut coarse_state, mut state) = ([0.0; 100], [0.0; 300]);
        assert!(
            Start { model: &coarse, place: &place }.fill(&mut coarse_state[..coarse.state_len()]).is_ok()
        );
        refine(&coarse, &coarse_state, &fine, &mut state[..fine.state_len()]);
        let at = |rows: &[SVector<f64, 2>; 6], t: f64, order: usize| {
            let basis = hermite::basis(t);
            (0..6).fold(row(0.0, 0.0), |sum, a| sum + rows[a] * basis[order][a])
        };
        for span in 0..2 {
            let whole = coarse.rows(span, &coarse_state);
            for part in 0..3 {
                let piece = fine.rows(3 * span + part, &state);
                for k in 0..=4 {
                    let t = f64::from(k) / 4.0;
                    let there = (part as f64 + t) / 3.0;
                    let scales = [1.0, 1.0 / 3.0, 1.0 / 9.0];
                    for (order, scale) in scales.into_iter().enumerate() {
                        let off = at(&piece, t, order) - at(&whole, there, order) * scale;
                        assert!(off.amax() < 1e-13, "span {span} part {part} order {order}: {off}");
                    }
                }
            }
        }
    }
}
