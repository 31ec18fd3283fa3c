//! Minimisations one after the other, as one to the caller: iterations numbered through, values in the caller's units.

use super::fairness::{Density, Shape};
use super::model::{Goal, Model};
use super::natural::{self, Improved, TrueCurve, Wish};
use super::space::Space;
use super::torsion::SpaceFunctional;
use crate::basis::quadrature::MAX_POINTS;
use crate::order::Order;
use crate::solve::{
    self, Control, InOrder, Observer, Outcome, Problem, Record, Settings, Status, WorkspaceTooSmall,
};

/// The first pass ends when a step promises to lower the functional by less than this fraction.
const SHAPING_DECREASE: f64 = 1e-1;
/// The first steps from elements that run along a known curve, or have its shape already, may be so long, in natural sizes.
const NEAR: f64 = 0.1;
/// Elements that exceed the least integral by more than this part of it do not run along their curve: the way may be far.
const LAID: f64 = 1e-2;
/// Elements that exceed the least integral by less than this part of it have no better ones beside them.
const FITTED: f64 = 1e-6;
/// How many iterations a curve gets that grows already when its directions alone are solved for.
const MOST_GROWING: usize = 60;
/// An estimate of what is left to gain is trusted to this factor (`curve_properties.rs` looks for data where it is wrong by
/// more).
const SURE: f64 = 3.0;
/// Steps of each element by itself between two of the whole curve.
const RELAXATION: usize = 10;

/// Points of the rule that most of the work is done with.
pub(super) const WORKING_POINTS: usize = 16;
/// A functional that is wanted no better than to this fraction is not minimised with a finer rule if that agrees.
pub(super) const LOOSE: f64 = 1e-9;
/// With few points a functional is minimised to this fraction before it is with many.
const WORKING_DECREASE: f64 = 1e-7;

/// The penalties, in units of the functional, with which a given length is approached, one after the other.
const PENALTIES: [f64; 3] = [1e2, 1e4, 1e6];
/// With a given length the functional is minimised to this fraction: what is left lies along the length.
const LENGTH_DECREASE: f64 = 1e-10;
const ROUGH_LENGTH_DECREASE: f64 = 1e-6;
/// How many times further than by its penalty a tension is changed at once.
const MOST_FURTHER: f64 = 1e3;
/// A curve whose length will not be met, because it has shallow valleys to follow, gets few and short steps under a stiffer
/// penalty; the tension is corrected after them.
const FEW: usize = 4;
const SHORT: f64 = 1e-4;
const STIFF_PENALTY: f64 = 1e8;
/// A length is met to this fraction.
const LENGTH_MET: f64 = 1e-10;
/// How far the length of a converged curve may be from the one that was asked for, as a fraction of that.
pub const LENGTH_TRUSTED: f64 = 1e-6;
/// Torsion is continuous to this fraction.
const TORSION_MET: f64 = 1e-9;
/// More corrections of the torsions' multipliers than are needed: each makes the jumps a hundred times smaller.
const MOST_TORSION_CORRECTIONS: usize = 6;
/// More corrections of a length's multiplier than are ever needed.
const MOST_CORRECTIONS: usize = 12;

pub(super) struct Passes<'a> {
    observer: &'a mut dyn Observer,
    records: &'a mut [Record],
    scale: f64,
    /// The most iterations of all together.
    most: usize,
    pub(super) iterations: usize,
    pub(super) linearisations: usize,
    /// The length that is asked for, in the local unit.
    length: Option<f64>,
    /// The tension that belongs to that length, as far as it is known.
    multiplier: f64,
    /// Whether the observer asked to stop: it is not asked again.
    cancelled: bool,
    hurries: bool,
    /// Whether elements run along a known curve.
    laid: bool,
    /// Whether such elements are taken as they are as far as possible.
    hastens: bool,
}

impl<'a> Passes<'a> {
    pub(super) fn new(
        observer: &'a mut dyn Observer,
        records: &'a mut [Record],
        scale: f64,
        most: usize,
        length: Option<f64>,
    ) -> Self {
        Self {
            observer,
            records,
            scale,
            most,
            iterations: 0,
            linearisations: 0,
            length,
            multiplier: 0.0,
            cancelled: false,
            hurries: false,
            laid: false,
            hastens: false,
        }
    }

    /// Notes an iteration of the curve's directions: the functional, in the local unit, and how far it went. Returns
    /// whether to go on.
    fn note(&mut self, value: f64, step: f64) -> bool {
        if self.cancelled || self.iterations >= self.most {
            return false;
        }
        self.iteration(1, &Record { value, step, ..Record::ZERO });
        self.iterations += 1;
        !self.cancelled && self.iterations < self.most
    }

    /// Leaves only so many iterations.
    pub(super) fn hurry(&mut self, iterations: usize) {
        self.hurries = true;
        self.most = self.most.min(self.iterations + iterations);
    }

    /// Whether only few iterations were left.
    pub(super) fn hurries(&self) -> bool {
        self.hurries
    }

    /// Two passes. First the shape, with a parametrisation that is kept even: only the shape decides how far a step goes
    /// then, and what is left to the second pass lies in the right one of many shallow valleys.
    pub(super) fn shape_and_finish<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        // Softened, an energy would rather turn its normal round where the curvature can be made small.
        let gentle = soften_where_straight(model, state) || model.ends_straight();
        let varies = model.space.is_some_and(|space| space.functional == SpaceFunctional::Mvc);
        set_softness(model, varies || gentle);
        model.begin_ties(state);
        let [start_cost, _] = guard(model, state);
        let natural =
            if start_cost > 0.0 { model.natural_cost.smaller(start_cost) } else { model.natural_cost };
        model.gauge = natural / model.element_count() as f64;
        model.slides = model.anchors.is_none();
        let outcome = self.minimise(model, SHAPING_DECREASE, [0, 0], 1.0, state, work)?;
        (model.gauge, model.slides) = (0.0, true);
        if matches!(outcome.status, Status::Cancelled | Status::Unbounded) {
            return Ok(outcome);
        }
        self.finish(model, relative_decrease, state, work)
    }

    /// The last pass, from a state that has the right shape already. A given length is met here. A curve that two
    /// joints hold first gets its shape, then its joints slide along it.
    pub(super) fn finish<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        if model.space.is_some() {
            return self.finish_in_space(model, relative_decrease, state, work);
        }
        guard(model, state);
        let holds = model.anchors.is_some();
        if !model.chooses_points && !holds {
            return self.finish_with(model, relative_decrease, state, work);
        }
        let points = if model.chooses_points { MAX_POINTS } else { model.points };
        model.points = points.min(WORKING_POINTS);
        model.slides = !holds;
        let outcome = self.finish_with(model, relative_decrease.larger(WORKING_DECREASE), state, work)?;
        model.slides = true;
        model.points = points;
        let sums = guard(model, state);
        let value = model.couple(sums).value;
        let agrees = (value - outcome.value).abs()
            <= relative_decrease * (value + 1e-9 * model.natural_cost())
            && self.length_is_met(|| sums[1]);
        let stopped = matches!(outcome.status, Status::Cancelled | Status::Unbounded);
        if stopped || (relative_decrease > LOOSE && agrees && !holds) {
            return Ok(Outcome { value, ..outcome });
        }
        self.finish_with(model, relative_decrease, state, work)
    }

    /// The last pass of a functional that knows torsion: softened as long as the curve has an inflection, and exactly
    /// where it has none.
    fn finish_in_space<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        let stops = |outcome: &Outcome| {
            matches!(outcome.status, Status::Cancelled | Status::Unbounded | Status::IterationLimit)
        };
        if model.ends_straight() || soften_where_straight(model, state) {
            set_softness(model, true);
            let outcome = self.finish_tied(model, relative_decrease, state, work)?;
            if stops(&outcome) || soften_where_straight(model, state) {
                return Ok(outcome);
            }
        }
        let outcome = self.finish_tied(model, relative_decrease, state, work)?;
        if outcome.status == Status::Converged || stops(&outcome) {
            return Ok(outcome);
        }
        set_softness(model, true);
        self.finish_tied(model, relative_decrease, state, work)
    }

    /// The last pass, with torsion that is made continuous by the method of multipliers.
    fn finish_tied<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        guard(model, state);
        model.begin_ties(state);
        let mut corrections = 0;
        loop {
            let outcome = self.finish_with(model, relative_decrease, state, work)?;
            if let Some(space) = &mut model.space {
                space.explores = false;
            }
            let stopped = !matches!(outcome.status, Status::Converged | Status::Stalled);
            let jump = model.correct_ties(state);
            let most = if relative_decrease > LOOSE { 1 } else { MOST_TORSION_CORRECTIONS };
            if stopped || jump <= TORSION_MET || corrections >= most {
                return Ok(Outcome { value: value_of(model, state), ..outcome });
            }
            corrections += 1;
        }
    }

    /// The last pass with the model's rule.
    fn finish_with<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        let Some(target) = self.length else {
            let first = if self.hastens { 0 } else { RELAXATION };
            let near = self.laid || (model.slides && model.anchors.is_some());
            let longest = if near { NEAR } else { 1.0 };
            return self.minimise(model, relative_decrease, [first, RELAXATION], longest, state, work);
        };
        // The method of multipliers: value + multiplier (L − target) + ½ penalty (L − target)².
        let mut corrections = 0;
        let mut stage = usize::from(self.multiplier != 0.0);
        let mut last: Option<[f64; 2]> = None;
        let mut stubborn = false;
        let mut sums = total(model, state);
        loop {
            let unit = (sums[0] + 1e-3 * model.natural_cost) / (target * target);
            let penalty = unit * if stubborn { STIFF_PENALTY } else { PENALTIES[stage] };
            model.goal = Some(Goal { target, multiplier: self.multiplier, penalty });
            let is_last = stage + 1 == PENALTIES.len();
            let decrease = if stage > 0 { LENGTH_DECREASE } else { ROUGH_LENGTH_DECREASE };
            let (most, longest) = (self.most, if stubborn { SHORT } else { 1.0 });
            if stubborn {
                self.most = most.min(self.iterations + FEW);
            }
            let mut outcome = self.minimise(
                model,
                decrease.larger(relative_decrease),
                [RELAXATION; 2],
                longest,
                state,
                work,
            )?;
            self.most = most;
            model.goal = None;
            if stubborn && outcome.status == Status::IterationLimit && self.iterations < most {
                outcome.status = Status::Converged;
            }
            sums = total(model, state);
            let length = sums[1];
            let off = length - target;
            corrections += 1;
            let stopped = !matches!(outcome.status, Status::Converged | Status::Stalled);
            let met = off.abs() <= LENGTH_MET * target;
            // The tension under which the curve has the length that it has.
            let tension = self.multiplier + penalty * off;
            self.multiplier = tension;
            if let Some([last_tension, last_length]) = last {
                // The longer, the less tension: where two of them tell how much less, by that.
                let change = off * (last_tension - tension) / (length - last_length);
                if (0.0..=MOST_FURTHER).contains(&(change / (penalty * off))) {
                    self.multiplier += change;
                }
                stubborn |= is_last && off.abs() > 0.1 * (last_length - target).abs();
            }
            last = Some([tension, length]);
            if stopped || (is_last && (met || corrections >= MOST_CORRECTIONS)) {
                let status = if stopped || met { outcome.status } else { Status::Stalled };
                return Ok(Outcome { value: model.couple(sums).value, status, ..outcome });
            }
            stage = (stage + 1).min(PENALTIES.len() - 1);
        }
    }

    /// Lays the elements along the curve's direction as a function of arc length, where that can be; a span may be `bent`
    /// another way than the nearest, and the elements may be those of the last solution (`warm`).
    pub(super) fn lay<const D: usize>(
        &mut self,
        model: &mut Model<'_, D>,
        bent: Option<usize>,
        warm: bool,
        relative_decrease: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Option<Improved>
    where
        Shape<D>: Density<D>,
    {
        let wish = Wish { length: self.length, bent, warm, enough: relative_decrease };
        let improved = natural::improve(model, &wish, state, work, &mut |sums, step| {
            self.note(model.value_of(sums), step)
        })?;
        self.multiplier = improved.tension;
        self.laid = improved.left_out + improved.misfit <= LAID * improved.integral;
        self.hastens = relative_decrease > LOOSE;
        model.fitted = self.hastens && improved.left_out + improved.misfit <= FITTED * improved.integral;
        if improved.grows {
            // Only whether it goes on growing is left to find out.
            self.hurry(MOST_GROWING);
        }
        Some(improved)
    }

    /// Finds the true curve from elements that were laid along it, see [`natural::trace`].
    pub(super) fn trace<'w, const D: usize>(
        &mut self,
        model: &Model<'_, D>,
        bent: Option<usize>,
        state: &[f64],
        memory: &'w mut [f64],
    ) -> Option<TrueCurve<'w>>
    where
        Shape<D>: Density<D>,
    {
        natural::trace(model, self.length, state, bent, memory, &mut |sums, step| {
            self.note(model.value_of(sums), step)
        })
    }

    /// Takes elements that run along a known curve as they are, if what they exceed the least integral by is no more
    /// than is asked for: what the curve does, and what they exceed it by, as measured and as estimated.
    pub(super) fn accept<const D: usize>(
        &self,
        model: &Model<'_, D>,
        improved: &Improved,
        relative_decrease: f64,
        state: &[f64],
    ) -> Option<Outcome>
    where
        Shape<D>: Density<D>,
    {
        if relative_decrease <= LOOSE || self.length.is_some() {
            return None;
        }
        let sums = total(model, state);
        let value = model.couple(sums).value;
        let excess = improved.left_out + improved.misfit.larger(sums[0] - improved.integral);
        (sums[0].is_finite() && SURE * excess <= relative_decrease * sums[0]).then_some(Outcome {
            status: Status::Converged,
            iterations: 0,
            linearisations: 0,
            value,
            gradient: f64::INFINITY,
            // Of a line that exceeds nothing there is no share.
            decrement: if sums[0] > 0.0 { excess / sums[0] * value } else { 0.0 },
        })
    }

    /// Relaxes every element by itself and looks at what there is, without a step of the whole.
    pub(super) fn look<const D: usize>(
        &mut self,
        model: &Model<'_, D>,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        let model = &Model { points: if model.chooses_points { MAX_POINTS } else { model.points }, ..*model };
        let settings = Settings {
            max_iterations: 0,
            first_relaxation: RELAXATION,
            relaxation: RELAXATION,
            ..Settings::DEFAULT
        };
        let outcome = solve::minimise(model, &settings, &InOrder, state, work, &mut [], self)?;
        self.linearisations += outcome.linearisations;
        Ok(outcome)
    }

    /// Whether a length is the one that is asked for; it is not looked at if none is.
    pub(super) fn length_is_met(&self, length: impl FnOnce() -> f64) -> bool {
        self.length.is_none_or(|target| (length() - target).abs() <= LENGTH_TRUSTED * target)
    }

    /// One pass, with what is left of the iterations and so many relaxations at first and between steps.
    fn minimise<const D: usize>(
        &mut self,
        model: &Model<'_, D>,
        relative_decrease: f64,
        [first_relaxation, relaxation]: [usize; 2],
        first_radius: f64,
        state: &mut [f64],
        work: &mut [f64],
    ) -> Result<Outcome, WorkspaceTooSmall>
    where
        Shape<D>: Density<D>,
    {
        let settings = Settings {
            max_iterations: if self.cancelled { 0 } else { self.most - self.iterations.min(self.most) },
            relative_decrease,
            relaxation,
            spares_relaxation: self.hastens,
            first_relaxation,
            explores: relative_decrease <= LOOSE || !model.slides,
            first_radius,
        };
        let outcome = solve::minimise(model, &settings, &InOrder, state, work, &mut [], self)?;
        self.iterations += outcome.iterations;
        self.linearisations += outcome.linearisations;
        let status = if self.cancelled { Status::Cancelled } else { outcome.status };
        Ok(Outcome { status, ..outcome })
    }
}

fn set_softness<const D: usize>(model: &mut Model<'_, D>, softens: bool) {
    if let Some(space) = &mut model.space {
        space.softens = softens;
    }
}

/// Softens torsion where the curve has an inflection, and leaves it exact where not. Returns whether it has one.
pub(super) fn soften_where_straight<const D: usize>(model: &mut Model<'_, D>, state: &[f64]) -> bool {
    let least = model.least_curvature(state);
    let straight = model.space.is_some_and(|space| !space.bends(least));
    set_softness(model, straight);
    straight
}

/// The functional without multipliers of a length or of torsions, by the model's rule.
pub(super) fn value_of<const D: usize>(model: &Model<'_, D>, state: &[f64]) -> f64
where
    Shape<D>: Density<D>,
{
    model.couple(total(model, state)).value
}

/// How much the integral and the length count in the functional, to first order.
pub(super) fn weights_of_sums<const D: usize>(model: &Model<'_, D>, state: &[f64]) -> [f64; 2]
where
    Shape<D>: Density<D>,
{
    model.couple(total(model, state)).first
}

/// The integral of which the functional is made, without multipliers, and the length.
pub(super) fn total<const D: usize>(model: &Model<'_, D>, state: &[f64]) -> [f64; 2]
where
    Shape<D>: Density<D>,
{
    let mut sums = [0.0; 2];
    let model = &Model { space: model.space.map(Space::untied), ..*model };
    for element in 0..model.element_count() {
        let [own, length] = model.sums(element, state);
        sums[0] += own;
        sums[1] += length;
    }
    sums
}

/// Lets the start be outside the guarded domain if it is: then a cusp is refused at the end, not on the way. Returns the
/// start's sums, see [`total`].
fn guard<const D: usize>(model: &mut Model<'_, D>, state: &[f64]) -> [f64; 2]
where
    Shape<D>: Density<D>,
{
    model.guarded = true;
    let sums = total(model, state);
    if sums[0].is_finite() {
        return sums;
    }
    model.guarded = false;
    total(model, state)
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
        let control = self.observer.iteration(number, &record);
        self.cancelled |= control == Control::Cancel;
        control
    }
}
