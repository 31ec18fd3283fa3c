//! From a designer's data to elements: the three calls *how much*, *here it is*, *solve*.

use super::accuracy::{Aim, Level, divide, divide_true};
use super::anchors::anchors;
use super::check::{check, check_elements, check_length, check_obstacles};
use super::contacts::{Touching, keep_clear, most_contacts};
use super::element::Element;
use super::error::{CurveError, OptionName};
use super::fairness::{Density, Shape};
use super::functional::{Functional, Weights};
use super::joint::Curve;
use super::layout::Layout;
use super::model::{Division, Model};
use super::options::Options;
use super::passes::{self, Passes};
use super::placement::{Place, Placement};
use super::report::{Report, figures_of, functional_scale, hand_over};
use super::space::Space;
use super::start::{Start, adopt, refine};
use crate::basis::quadrature::MAX_POINTS;
use crate::order::Order;
use crate::solve::{Observer, Outcome, Problem, Record, Status, WorkspaceTooSmall};
use crate::total::Total;

/// The number of elements that a curve has, `spans × elements_per_span`; with a tolerance or obstacles the most that it may
/// have: an obstacle counts as four spans then.
pub const fn elements_len(curve: &Curve<'_>, options: &Options) -> usize {
    let pieces = curve.spans().saturating_add(most_contacts(curve.obstacles.len()));
    pieces.saturating_mul(options.elements_per_span as usize)
}

/// The workspace, in `f64`s, that [`solve()`] needs for these data. It depends on the number of joints, on what is
/// fixed at them and on whether they lie in a plane, not on the numbers otherwise.
///
/// # Errors
/// Everything that [`solve()`] would find wrong with the data and options, but for
/// [`CurveError::CurvatureNeedsTangent`], which shows with the start values.
pub fn workspace_len(curve: &Curve<'_>, options: &Options) -> Result<usize, CurveError> {
    Ok(match look_over(curve, options)? {
        Place::Plane(place) => Layout::of(&model(curve, options, &place), options).len(),
        Place::Space(place) => Layout::of(&model(curve, options, &place), options).len(),
    })
}

/// Everything that can be wrong with the data and options but for memory. Returns where the curve lies.
fn look_over(curve: &Curve<'_>, options: &Options) -> Result<Place, CurveError> {
    options.check()?;
    let unit = check(curve)?;
    check_length(curve, options.length)?;
    check_obstacles(curve, options)?;
    if let Some(reference) = &curve.reference {
        let (needed, given) = (elements_len(curve, options), reference.elements.len());
        let plain = options.functional == Functional::MVC && options.tolerance == 0.0;
        if !(plain && (0.0..=1.0).contains(&reference.weight)) {
            return Err(CurveError::BadOption(OptionName::ReferenceWeight));
        }
        if needed != given {
            return Err(CurveError::WrongElementCount { needed, given });
        }
        check_elements(reference.elements)?;
    }
    match Place::of(curve, unit, options.dimension)? {
        Place::Space(_) if !curve.obstacles.is_empty() => Err(CurveError::ObstaclesNotPossible),
        place => Ok(place),
    }
}

/// Computes a curve (thesis chapter 4).
///
/// `workspace` needs [`workspace_len`] numbers in any condition, also as a computation left it that was refused or
/// cancelled. `elements` receives [`elements_len`] elements in order along the curve, or fewer with a tolerance; more
/// room is left untouched. `records` receives one record an iteration as far as it reaches. Fixed positions and tangent
/// directions are kept exactly; planar data give elements exactly in their plane where that is parallel to a coordinate
/// plane, else to rounding.
///
/// With a reference shape the search starts from that shape. A curve of which nothing is fixed, and whose functional
/// does not look at size, stays about where its start values are.
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
    begin(curve, options, workspace, elements, records, observer, Begin::Data(0))
}

/// Computes a curve anew from its last solution: a *warm start* for data that changed a little, as when a joint is
/// dragged.
///
/// As [`solve()`], but `elements` holds the last solution, [`elements_len`] elements, from which the search starts;
/// what the joints fix is taken from the joints. The search ends in the minimum that belongs to the last solution, so
/// that a curve does not jump while it is dragged. A tolerance is not looked at: the number of elements stays. If
/// nothing is found, the status says so and the elements are the last shape.
///
/// # Errors
/// As [`solve()`], [`CurveError::ElementsTooShort`] and [`CurveError::BadElement`].
pub fn update(
    curve: &Curve<'_>,
    options: &Options,
    workspace: &mut [f64],
    elements: &mut [Element],
    records: &mut [Record],
    observer: &mut dyn Observer,
) -> Result<Report, CurveError> {
    begin(
        curve,
        &Options { tolerance: 0.0, ..*options },
        workspace,
        elements,
        records,
        observer,
        Begin::Elements,
    )
}

/// What a search starts from.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Begin {
    /// The data, by one of [`starts`] rules.
    Data(usize),
    /// The elements.
    Elements,
}

/// How many starts a curve's data offer: the usual one, one with each joint's start tangent turned round, one with each
/// span bent the other way or further.
pub(super) const fn starts(curve: &Curve<'_>) -> usize {
    1 + curve.joints.len() + curve.spans()
}

impl Begin {
    /// The joint whose start tangent is turned round.
    fn turned(self, curve: &Curve<'_>) -> Option<usize> {
        match self {
            Self::Data(start) if start <= curve.joints.len() => start.checked_sub(1),
            _ => None,
        }
    }

    /// The span that is bent another way.
    fn bent(self, curve: &Curve<'_>) -> Option<usize> {
        match self {
            Self::Data(start) => start.checked_sub(1 + curve.joints.len()),
            Self::Elements => None,
        }
    }
}

pub(super) fn begin(
    curve: &Curve<'_>,
    options: &Options,
    workspace: &mut [f64],
    elements: &mut [Element],
    records: &mut [Record],
    observer: &mut dyn Observer,
    from: Begin,
) -> Result<Report, CurveError> {
    let found = look_over(curve, options)?;
    if from == Begin::Elements && !curve.obstacles.is_empty() {
        return Err(CurveError::ObstaclesNotPossible);
    }
    match found {
        Place::Plane(place) => run(curve, options, &place, workspace, elements, records, observer, from),
        Place::Space(place) => run(curve, options, &place, workspace, elements, records, observer, from),
    }
}

pub(super) fn model<'a, const D: usize>(
    curve: &Curve<'a>,
    options: &Options,
    place: &Placement<D>,
) -> Model<'a, D> {
    // The functional is brought to the local unit as a whole: its terms scale with different powers of the length.
    let square = place.unit * place.unit;
    let space = if D == 3 { Space::of(options.functional) } else { None };
    let own = match (space, options.functional.bends()) {
        (Some(_), _) => Weights::NONE,
        (None, true) => Weights::BENDING,
        (None, false) => Weights::VARIATION,
    };
    let (bending, length) = if options.functional.bends() {
        (options.bending, options.tension * square)
    } else {
        (options.bending * square, options.tension * square * square)
    };
    Model {
        curve: *curve,
        place: *place,
        division: Division::Even(options.elements_per_span as usize),
        functional: options.functional,
        points: match options.quadrature_points {
            0 if space.is_some() => MAX_POINTS,
            0 => passes::WORKING_POINTS,
            points => points as usize,
        },
        chooses_points: options.quadrature_points == 0 && space.is_none(),
        weights: Weights { bending: own.bending + bending, length, ..own },
        space,
        goal: None,
        contacts: &[],
        gauge: 0.0,
        guarded: true,
        anchors: None,
        slides: true,
        fitted: false,
        natural_cost: 0.0,
        start_length: 0.0,
    }
}

#[expect(clippy::too_many_arguments, reason = "the caller's, and where the curve lies")]
fn run<const D: usize>(
    curve: &Curve<'_>,
    options: &Options,
    place: &Placement<D>,
    workspace: &mut [f64],
    elements: &mut [Element],
    records: &mut [Record],
    observer: &mut dyn Observer,
    from: Begin,
) -> Result<Report, CurveError>
where
    Shape<D>: Density<D>,
{
    let mut model = model::<D>(curve, options, place);
    let count = elements_len(curve, options);
    let too_short = CurveError::ElementsTooShort { needed: count, given: elements.len() };
    let elements = elements.get_mut(..count).ok_or(too_short)?;
    let layout = Layout::of(&model, options);
    let given = workspace.len();
    let [state, next_state, marks, next_marks, counts, next_counts, errors, traced, work] =
        layout.carve(workspace)?;
    let around = layout.len() - layout.work;
    let wrong =
        |short: WorkspaceTooSmall| CurveError::WorkspaceTooSmall { needed: around + short.needed, given };
    let scale = functional_scale(options, place.unit);
    let length = (options.length > 0.0).then(|| options.length / place.unit);
    let mut passes = Passes::new(observer, records, scale, options.max_iterations as usize, length);
    let decrease = options.relative_decrease;

    let (begin, warm) = (from, from == Begin::Elements);
    let shape = if warm { Some(&*elements) } else { curve.reference.map(|reference| reference.elements) };
    if let Some(shape) = shape {
        check_elements(shape)?;
        let outcome =
            from_shape(&mut passes, &mut model, place, shape, warm, decrease, state, work).map_err(wrong)?;
        return Ok(hand_over(&model, &outcome, &passes, state, elements, options));
    }

    // One element a span first: its solution, cut into parts, is within some millionths of what more elements reach.
    let mut coarse = Model { division: Division::Even(1), ..model };
    let coarse_state = state.part_mut(..coarse.state_len());
    coarse.natural_cost =
        Start { model: &coarse, place, parts: 1, turned: begin.turned(curve) }.fill(coarse_state)?;
    take_scale(&mut coarse, coarse_state);
    coarse.anchors = anchors(&coarse, options, coarse_state);
    (model.space, model.anchors) = (coarse.space, coarse.anchors);
    coarse.start_length = coarse.rough_length(coarse_state);
    if options.continuation > 0 {
        under_tension(&mut passes, &mut coarse, options.continuation, coarse_state, work).map_err(wrong)?;
    }
    let improved = if options.continuation > 0 {
        None
    } else {
        passes.lay(&mut coarse, begin.bent(curve), false, decrease, coarse_state, work)
    };
    if let Some(improved) = &improved
        && options.elements_per_span == 1
        && options.tolerance == 0.0
        && curve.obstacles.is_empty()
        && let Some(outcome) = passes.accept(&coarse, improved, decrease, coarse_state)
    {
        return Ok(hand_over(&coarse, &outcome, &passes, coarse_state, elements, options));
    }
    let parts = options.elements_per_span as usize;
    let aim =
        Aim { tolerance: options.tolerance / place.unit, most_per_span: parts, relative_decrease: decrease };
    model.start_length = coarse.start_length;
    if (parts > 1 || options.tolerance > 0.0)
        && curve.obstacles.is_empty()
        && improved.is_some()
        && let Some(found) = passes.trace(&coarse, begin.bent(curve), coarse_state, traced)
    {
        if options.tolerance == 0.0 {
            // The elements' minimum is next to the true one.
            let kept = work.part_mut(..coarse_state.len());
            kept.copy(coarse_state);
            let whole = state.part_mut(..model.state_len());
            model.natural_cost =
                found.write(&coarse, kept, &model, core::iter::repeat_n(parts, curve.spans()), whole);
            let outcome = passes.finish(&mut model, decrease, whole, work).map_err(wrong)?;
            return Ok(hand_over(&model, &outcome, &passes, whole, elements, options));
        }
        let mut level = Level { counts, marks, state: next_state };
        let divided =
            divide_true(&mut passes, &model, &found, &coarse, coarse_state, &aim, &mut level, errors, work)
                .map_err(wrong)?;
        let mut model = level.model(&model);
        model.natural_cost = coarse.natural_cost;
        let mut report = hand_over(&model, &divided.outcome, &passes, level.state, elements, options);
        report.error = divided.error * place.unit;
        return Ok(report);
    }
    let tolerance =
        if parts == 1 || options.tolerance > 0.0 { decrease } else { COARSE_DECREASE.larger(decrease) };
    let mut outcome = if improved.is_some() || options.continuation > 0 {
        passes.finish(&mut coarse, tolerance, coarse_state, work)
    } else {
        passes.shape_and_finish(&mut coarse, tolerance, coarse_state, work)
    }
    .map_err(wrong)?;
    model.natural_cost = coarse.natural_cost;
    if (parts == 1 && options.tolerance == 0.0) || !curve.obstacles.is_empty() {
        let memory = [state, next_state, marks, next_marks, counts];
        return clear(&mut passes, &coarse, outcome, memory, work, elements, options).map_err(wrong);
    }
    let stopped = matches!(outcome.status, Status::Cancelled | Status::IterationLimit);
    let found =
        (stopped || outcome.status == Status::Converged) && figures_of(&coarse, coarse_state).irregular == 0;

    if options.tolerance > 0.0 {
        let mut base = 1;
        if !found && !stopped {
            // Too few elements to have a minimum at all.
            base = parts.min(LEAST_PARTS);
            let mut divided = Model { division: Division::Even(base), ..model };
            let divided_state = state.part_mut(..divided.state_len());
            divided.natural_cost = Start { model: &divided, place, parts: base, turned: begin.turned(curve) }
                .fill(divided_state)?;
            outcome = passes.shape_and_finish(&mut divided, decrease, divided_state, work).map_err(wrong)?;
        }
        counts.fill(base as f64);
        let mut current = Level { counts, marks, state };
        let mut next = Level { counts: next_counts, marks: next_marks, state: next_state };
        current.mark(curve.closed);
        let mut error = f64::INFINITY;
        if outcome.status == Status::Converged {
            let divided = divide(&mut passes, &model, &aim, outcome, [&mut current, &mut next], errors, work)
                .map_err(wrong)?;
            (outcome, error) = (divided.outcome, divided.error);
        }
        let model = current.model(&model);
        let mut report = hand_over(&model, &outcome, &passes, current.state, elements, options);
        report.error = error * place.unit;
        return Ok(report);
    }

    if found {
        let kept = work.part_mut(..coarse_state.len());
        kept.copy(coarse_state);
        let state = state.part_mut(..model.state_len());
        model.natural_cost = refine(&coarse, kept, |_| parts, &model, state);
        if !stopped {
            outcome = passes.finish(&mut model, decrease, state, work).map_err(wrong)?;
        }
    } else {
        let state = state.part_mut(..model.state_len());
        model.natural_cost =
            Start { model: &model, place, parts, turned: begin.turned(curve) }.fill(state)?;
        outcome = passes.shape_and_finish(&mut model, decrease, state, work).map_err(wrong)?;
    }
    Ok(hand_over(&model, &outcome, &passes, state, elements, options))
}

/// Minimises from a shape: the last solution (`warm`), or a reference.
#[expect(clippy::too_many_arguments, reason = "a curve, where it lies, where it starts, and memory")]
fn from_shape<const D: usize>(
    passes: &mut Passes<'_>,
    model: &mut Model<'_, D>,
    place: &Placement<D>,
    shape: &[Element],
    warm: bool,
    relative_decrease: f64,
    state: &mut [f64],
    work: &mut [f64],
) -> Result<Outcome, WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    model.natural_cost = adopt(model, place, shape, state);
    model.start_length = model.rough_length(state);
    take_scale(model, state);
    if warm
        && let Some(improved) = passes.lay(model, None, true, relative_decrease, state, work)
        && let Some(outcome) = passes.accept(model, &improved, relative_decrease, state)
    {
        return Ok(outcome);
    }
    let count = model.element_count();
    if let Some(reference) = &model.curve.reference {
        model.gauge = reference.weight * model.natural_cost / count as f64;
    }
    let mut outcome = passes.finish(model, relative_decrease, state, work)?;
    if model.gauge > 0.0 {
        model.gauge = 0.0;
        outcome.value = (0..count).map(|element| model.cost(element, state)).sum();
    }
    Ok(outcome)
}

/// Minimises under a strong tension first, which has a minimum whatever the data, and under less and less in so many stages
/// (thesis 4.10).
fn under_tension<const D: usize>(
    passes: &mut Passes<'_>,
    model: &mut Model<'_, D>,
    stages: u32,
    state: &mut [f64],
    work: &mut [f64],
) -> Result<(), WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    let own = model.weights.length;
    let mut pull = STRONG_PULL * model.natural_cost / model.start_length;
    for _ in 0..stages {
        model.weights.length = own + pull;
        let outcome = passes.shape_and_finish(model, CONTINUATION_DECREASE, state, work)?;
        if matches!(outcome.status, Status::Cancelled | Status::IterationLimit) {
            break;
        }
        pull *= 0.1;
    }
    model.weights.length = own;
    Ok(())
}

/// Keeps a solution with one element a span clear of its obstacles, if there are any, divides it and hands it over.
/// `memory` is state, next state, marks, next marks and contacts.
fn clear<const D: usize>(
    passes: &mut Passes<'_>,
    model: &Model<'_, D>,
    mut outcome: Outcome,
    [state, spare, marks, old_marks, contacts]: [&mut [f64]; 5],
    work: &mut [f64],
    elements: &mut [Element],
    options: &Options,
) -> Result<Report, WorkspaceTooSmall>
where
    Shape<D>: Density<D>,
{
    if model.curve.obstacles.is_empty() || outcome.status != Status::Converged {
        return Ok(hand_over(model, &outcome, passes, state, elements, options));
    }
    let nodes = model.node_count();
    for (node, mark) in marks.iter_mut().take(nodes).enumerate() {
        *mark = model.joint_mark(node);
    }
    let most = most_contacts(model.curve.obstacles.len());
    let contacts = contacts.part_mut(..most);
    let mut touching = Touching { marks, old_marks, contacts, state, spare, nodes, used: 0, divided: false };
    let decrease = options.relative_decrease;
    outcome = keep_clear(passes, model, decrease, outcome, &mut touching, work)?;
    let parts = options.elements_per_span as usize;
    if parts > 1 && outcome.status == Status::Converged {
        touching.divide(model, parts);
        outcome = keep_clear(passes, model, decrease, outcome, &mut touching, work)?;
    }
    let Touching { marks, contacts, state, nodes, .. } = touching;
    let model = model.touching(marks.part(..nodes), contacts);
    Ok(hand_over(&model, &outcome, passes, state, elements, options))
}

/// Takes the typical curvature from the start.
fn take_scale<const D: usize>(model: &mut Model<'_, D>, state: &[f64])
where
    Shape<D>: Density<D>,
{
    if model.space.is_some() {
        let figures = figures_of(model, state);
        if let Some(space) = &mut model.space {
            space.take_scale(figures.bending, figures.length);
        }
    }
}

/// With one element a span on the way to more, a functional to this fraction is enough.
const COARSE_DECREASE: f64 = 1e-7;
/// By how much the first tension of a continuation outweighs the functional.
const STRONG_PULL: f64 = 10.0;
/// How well the stages of a continuation are solved.
const CONTINUATION_DECREASE: f64 = 1e-4;
/// Where one element a span has no minimum, a tolerance begins with so many.
const LEAST_PARTS: usize = 4;
#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::basis::hermite;
    use crate::curve::joint::{Joint, Quantity};
    use crate::curve::tests::{planar, spatial, started};
    use crate::solve as solver;
    use nalgebra::SVector;
    use std::vec;

    fn row(x: f64, y: f64) -> SVector<f64, 2> {
        SVector::from([x, y])
    }

    #[test]
    fn refining_keeps_the_curve() {
        let joints = [
            Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.3, 1.0, 0.0])),
            Joint::at([1.0, 0.4, 0.0]),
            Joint::at([1.5, -0.4, 0.0]),
        ];
        let curve = Curve::open(&joints);
        let fine = planar(&curve, &Options { elements_per_span: 3, ..Options::DEFAULT });
        let coarse = Model { division: Division::Even(1), ..fine };
        let coarse_state = started(&coarse);
        let mut state = vec![f64::NAN; fine.state_len()];
        refine(&coarse, &coarse_state, |_| 3, &fine, &mut state);
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

    /// A continuation is one minimisation after the other, under a tension that outweighs the functional ten times, once,
    /// and by a tenth; then the tension is what it was.
    #[test]
    fn a_continuation_lets_go_by_tens() {
        let joints = [
            Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([-0.5, 1.0, 0.0])),
            Joint::at([1.0, 0.4, 0.0]),
            Joint::at([1.5, -0.4, 0.0]).with_tangent(Quantity::fixed([-1.0, -1.0, 0.0])),
        ];
        let curve = Curve::open(&joints);
        let options = Options { tension: 0.25, ..Options::DEFAULT };
        let begin = || {
            let mut model = planar(&curve, &options);
            let mut state = vec![f64::NAN; model.state_len()];
            let start = Start { model: &model, place: &model.place, parts: 1, turned: None };
            model.natural_cost = start.fill(&mut state).unwrap_or(f64::NAN);
            model.start_length = model.rough_length(&state);
            (model, state)
        };
        let mut work = [0.0; 4000];
        let mut few = Few(usize::MAX);
        for (stages, most) in [(0, usize::MAX), (1, usize::MAX), (3, usize::MAX), (3, 2)] {
            let (mut model, mut state) = begin();
            few.0 = most;
            let mut passes = Passes::new(&mut few, &mut [], 1.0, 500, None);
            assert!(under_tension(&mut passes, &mut model, stages, &mut state, &mut work).is_ok());
            let taken = passes.iterations;
            assert_eq!(model.weights.length, 0.25);

            let (mut model, mut wanted) = begin();
            few.0 = most;
            let mut passes = Passes::new(&mut few, &mut [], 1.0, 500, None);
            for pull in [10.0, 1.0, 0.1].into_iter().take(if most == 2 { 1 } else { stages as usize }) {
                model.weights.length = 0.25 + pull * model.natural_cost / model.start_length;
                assert!(passes.shape_and_finish(&mut model, 1e-4, &mut wanted, &mut work).is_ok());
            }
            assert_eq!(taken, passes.iterations);
            assert!(stages == 0 || (taken > 2) == (most > 2), "{stages}: {taken}");
            for (number, wanted) in state.iter().zip(&wanted) {
                assert!((number - wanted).abs() < 1e-9, "{stages} {most}: {number} {wanted}");
            }
        }
    }

    /// Asks to stop after so many iterations.
    struct Few(usize);

    impl Observer for Few {
        fn iteration(&mut self, _: usize, _: &Record) -> crate::solve::Control {
            self.0 -= 1;
            if self.0 == 0 { crate::solve::Control::Cancel } else { crate::solve::Control::Continue }
        }
    }

    #[test]
    fn an_element_that_knows_torsion_has_the_derivatives_of_its_cost() {
        let joints = [
            Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.3, 1.0, 0.2])),
            Joint::at([1.0, 0.4, 0.3]),
            Joint::at([1.5, -0.4, 0.9]),
            Joint::at([1.2, -1.0, 1.8]),
        ];
        let curve = Curve::open(&joints);
        for (functional, softens) in [
            (Functional::SPACE_MVC, false),
            (Functional::SPACE_MVC, true),
            (Functional::SPACE_MEC, false),
            (Functional::SPACE_MEC, true),
        ] {
            let options = Options { functional, elements_per_span: 2, ..Options::DEFAULT };
            let mut model = spatial(&curve, &options);
            let mut memory = started(&model);
            let mut moved = memory.clone();
            let state = memory.as_mut_slice();
            take_scale(&mut model, state);
            if let Some(space) = &mut model.space {
                space.softens = softens;
            }
            model.begin_ties(state);
            // From the node between the elements of a span to a joint: both ends are tied.
            let element = 3;
            let mut list = solver::BlockList::new();
            model.element_blocks(element, &mut list);
            let dofs: [usize; 3] = core::array::from_fn(|k| model.dofs(list[k]));
            let count: usize = dofs.iter().sum();
            let mut sizes = [1.0; 20];
            let mut cost = |steps: &[(usize, f64)]| {
                moved.copy_from_slice(state);
                let mut first = 0;
                for (k, &block) in list.iter().enumerate() {
                    let mut step = [0.0; 20];
                    for &(i, by) in steps {
                        if (first..first + dofs[k]).contains(&i) {
                            step[i - first] += by;
                        }
                    }
                    let range = model.state_range(block);
                    model.retract(block, &state[range.clone()], &step[..dofs[k]], &mut moved[range]);
                    first += dofs[k];
                }
                model.cost(element, &moved)
            };
            let mut first = 0;
            for (k, &block) in list.iter().enumerate() {
                model.natural_sizes(block, state, &mut sizes[first..first + dofs[k]]);
                first += dofs[k];
            }
            let (mut gradient, mut matrix) = ([0.0; 20], [0.0; 210]);
            let value = model.linearise(
                element,
                state,
                &mut gradient[..count],
                &mut matrix[..solver::packed(count, 0)],
            );
            assert!((value - cost(&[])).abs() <= 1e-12 * value.abs());
            let most = (0..count).fold(0.0f64, |most, i| {
                most.larger((matrix[solver::packed(i, i)] * sizes[i] * sizes[i]).abs())
            });
            let h = 1e-4;
            for i in 0..count {
                let slope = (cost(&[(i, h * sizes[i])]) - cost(&[(i, -h * sizes[i])])) / (2.0 * h);
                assert!((slope - gradient[i] * sizes[i]).abs() < 1e-6 * most, "{i}: {slope}");
                for j in 0..=i {
                    let mut at = |a: f64, b: f64| cost(&[(i, a * h * sizes[i]), (j, b * h * sizes[j])]);
                    let bend =
                        (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * h);
                    let found = matrix[solver::packed(i, j)] * sizes[i] * sizes[j];
                    assert!((bend - found).abs() < 1e-5 * most, "{i} {j}: {bend} {found}");
                }
            }
        }
    }
}
