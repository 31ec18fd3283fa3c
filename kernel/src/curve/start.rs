//! Start values (thesis 4.9): whatever the designer left free gets a value near the solution.
//!
//! Tangents and curvatures at joints between two others are those of the circle through the three points: with
//! `A = a/|a|²` and `B = b/|b|²` the inverted steps to the neighbours, its tangent is along `B − A`, which is (4.10),
//! and its curvature vector is twice the foot of the perpendicular on the line from `A` to `B`. Free ends mirror
//! their neighbour. Speeds and stretches are those of the quintic that fits a circular arc best; the thesis starts
//! with the chord and 0, from where twice as many iterations are needed.

use super::element::Element;
use super::end::{End, orthonormalise, rows_between};
use super::error::CurveError;
use super::fairness::{Density, Shape};
use super::joint::{Continuity, Given, Joint};
use super::model::Model;
use super::placement::Placement;
use super::rows::place;
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;
use nalgebra::SVector;

/// The speed at the ends of the quintic of least variation on an arc of turning `θ` is the arc's length times
/// `1 + 0.00613 θ²`, and its stretch is `∓ 0.0377 θ²` times the speed (fitted to `θ = π/2` and `π`).
const SPEED_BY_TURN: f64 = 0.00613;
const STRETCH_BY_TURN: f64 = 0.0377;
/// The speeds that are tried, the preferred first; another must be twice as fair.
const SPEED_FACTORS: [f64; 5] = [1.0, 0.6, 1.6, 0.36, 2.5];
/// A start tangent that leans from a given curvature by less than this (radians) does not tell on which side the curve
/// goes.
const UNDECIDED: f64 = 1e-6;
/// The cosine of an angle that counts as none is within this of 1; its square, of a sine that counts as none, below it.
const STRAIGHT: f64 = 1e-6;
/// Turnings are not trusted beyond this.
const MOST_TURN: f64 = 4.0;

/// Any unit vector perpendicular to a unit vector: in the plane the one to the left.
fn perpendicular<const D: usize>(t: &SVector<f64, D>) -> SVector<f64, D> {
    let mut out = SVector::<f64, D>::zeros();
    if D == 2 {
        out[0] = -t[1];
        out[1] = t[0];
        return out;
    }
    let least = (0..D).fold(0, |least, d| if t[d].abs() < t[least].abs() { d } else { least });
    out[least] = 1.0;
    unit(&(out - t * t[least])).unwrap_or(out)
}

fn unit<const D: usize>(v: &SVector<f64, D>) -> Option<SVector<f64, D>> {
    let square = v.dot(v);
    (square > 0.0).then(|| v / sqrt(square))
}

/// Turns a vector perpendicular to the unit vector `from` as `from` turns into `to` on the shortest way.
fn carry<const D: usize>(
    x: &SVector<f64, D>,
    from: &SVector<f64, D>,
    to: &SVector<f64, D>,
) -> SVector<f64, D> {
    let cosine = from.dot(to);
    if cosine < -1.0 + 1e-9 {
        // Half a turn: in the plane the normal goes over into its opposite; in space the way is arbitrary.
        return -x;
    }
    x - (from + to) * (x.dot(to) / (1.0 + cosine))
}

/// The direction of what of a vector lies across a unit vector, where that is longer than the root of `least`.
fn direction_across<const D: usize>(
    vector: &SVector<f64, D>,
    along: &SVector<f64, D>,
    least: f64,
) -> Option<SVector<f64, D>> {
    let beside = vector - along * vector.dot(along);
    unit(&beside).filter(|_| beside.dot(&beside) > least)
}

/// A frame whose first row is the tangent; in space the second is along the curvature, if there is any.
fn frame_of<const D: usize>(tangent: &SVector<f64, D>, curvature: &SVector<f64, D>) -> [SVector<f64, D>; D] {
    let mut frame = [*tangent; D];
    // Of a curvature that is next to nothing rounding may leave a vector along the tangent.
    let across = |normal: &SVector<f64, D>| (normal - tangent * normal.dot(tangent)).amax() > UNDECIDED;
    let normal = if D == 2 { None } else { unit(curvature).filter(across) };
    frame[1] = normal.unwrap_or_else(|| perpendicular(tangent));
    if D == 3 {
        let [t, n] = [*tangent, frame[1]];
        frame[2] = SVector::from_fn(|d, _| t[(d + 1) % D] * n[(d + 2) % D] - t[(d + 2) % D] * n[(d + 1) % D]);
    }
    orthonormalise(&mut frame);
    frame
}

/// A span whose tangents turn by less than this together against the chord, and whose curvatures are less than this
/// over it, has neither cusp nor loop.
const GENTLE_TURN: f64 = 1.5;
const GENTLE_BEND: f64 = 4.0;

pub(super) struct Start<'m, 'a, const D: usize> {
    pub(super) model: &'m Model<'a, D>,
    pub(super) place: &'m Placement<D>,
    /// Elements a span.
    pub(super) parts: usize,
    /// Whose start tangent looks the other way, if anybody's.
    pub(super) turned: Option<usize>,
}

/// How a tangent gets its start value.
#[derive(PartialEq)]
enum Rule {
    Given,
    /// The circle through three joints.
    Circle,
    /// Mirrored from the other end of the span.
    Mirror,
}

impl<const D: usize> Start<'_, '_, D>
where
    Shape<D>: Density<D>,
{
    fn joints(&self) -> &[Joint] {
        self.model.curve.joints
    }

    fn data(&self, joint: usize) -> &Joint {
        const NONE: Joint = Joint::at([0.0; 3]);
        self.joints().get(joint).unwrap_or(&NONE)
    }

    /// The next joint (`side` 1) or the one before (`side` 0), if there is one.
    fn neighbour(&self, joint: usize, side: usize) -> Option<usize> {
        let count = self.joints().len();
        match side {
            1 if joint + 1 < count => Some(joint + 1),
            1 if self.model.curve.closed => Some(0),
            0 if joint > 0 => Some(joint - 1),
            0 if self.model.curve.closed => Some(count - 1),
            _ => None,
        }
    }

    fn point_place(&self, joint: usize) -> usize {
        Model::<D>::point_place(joint * self.parts)
    }

    fn point(&self, joint: usize, state: &[f64]) -> SVector<f64, D> {
        let at = self.point_place(joint);
        SVector::from_fn(|d, _| state.at(at + d))
    }

    /// The inverted steps `A`, `B` to the two neighbours.
    fn inverted(&self, joint: usize, state: &[f64]) -> Option<[SVector<f64, D>; 2]> {
        let here = self.point(joint, state);
        let step = |side| {
            let step = self.point(self.neighbour(joint, side)?, state) - here;
            Some(step / step.dot(&step))
        };
        Some([step(0)?, step(1)?])
    }

    /// The tangent and the curvature vector of the circle through a joint and its neighbours. Where both neighbours lie in
    /// the same direction there is none: then half a circle across, for the curve must turn back somehow.
    fn circle(&self, joint: usize, state: &[f64]) -> Option<[SVector<f64, D>; 2]> {
        let [a, b] = self.inverted(joint, state)?;
        let (a_unit, b_unit) = (unit(&a)?, unit(&b)?);
        if a_unit.dot(&b_unit) > 1.0 - STRAIGHT {
            let farther = a.dot(&a).smaller(b.dot(&b));
            return Some([perpendicular(&a_unit), a_unit * (2.0 * sqrt(farther))]);
        }
        let along = unit(&(b - a))?;
        Some([along, (a - along * a.dot(&along)) * 2.0])
    }

    fn rule(&self, joint: usize, side: usize) -> Rule {
        let data = self.data(joint);
        if data.tangent[side].given != Given::FREE {
            Rule::Given
        } else if data.continuity != Continuity::G0
            && self.neighbour(joint, 0).is_some()
            && self.neighbour(joint, 1).is_some()
        {
            Rule::Circle
        } else {
            Rule::Mirror
        }
    }

    /// Positions: given ones, and free ones evenly between the given neighbours.
    fn points(&self, state: &mut [f64]) {
        let count = self.joints().len();
        let given = |joint: usize| self.data(joint).position.given != Given::FREE;
        let put = |state: &mut [f64], joint: usize, point: &SVector<f64, D>| {
            let at = self.point_place(joint);
            state.part_mut(at..at + D).copy(point.as_slice());
        };
        for (joint, data) in self.joints().iter().enumerate() {
            if given(joint) {
                put(state, joint, &self.place.local_point(&data.position.value));
            }
        }
        // Runs of free joints between given ones, around the ring where the curve is closed.
        let Some(first) = (0..count).find(|&joint| given(joint)) else { return };
        let last = (0..count).rev().find(|&joint| given(joint)).unwrap_or(first);
        let mut before = first;
        let laps = if self.model.curve.closed { first + count } else { last };
        for at in first + 1..=laps {
            if !given(at % count) {
                continue;
            }
            let (a, b) = (self.point(before % count, state), self.point(at % count, state));
            for between in before + 1..at {
                let share = (between - before) as f64 / (at - before) as f64;
                put(state, between % count, &(a + (b - a) * share));
            }
            before = at;
        }
        if !self.model.curve.closed {
            // Free ends go on straight in even steps.
            if let Some(second) = (first + 1..count).find(|&joint| given(joint)) {
                let step = (self.point(first, state) - self.point(second, state)) / (second - first) as f64;
                for joint in 0..first {
                    put(state, joint, &(self.point(first, state) + step * (first - joint) as f64));
                }
            }
            if let Some(second) = (0..last).rev().find(|&joint| given(joint)) {
                let step = (self.point(last, state) - self.point(second, state)) / (last - second) as f64;
                for joint in last + 1..count {
                    put(state, joint, &(self.point(last, state) + step * (joint - last) as f64));
                }
            }
        }
    }

    fn tangent(&self, joint: usize, side: usize, state: &[f64]) -> SVector<f64, D> {
        if self.rule(joint, side) != Rule::Mirror {
            return self.settled_tangent(joint, side, state);
        }
        let mirrored = self.neighbour(joint, side).map(|other| {
            let step = self.point(other, state) - self.point(joint, state);
            let chord = unit(&if side == 1 { step } else { -step }).unwrap_or_else(SVector::zeros);
            if self.rule(other, 1 - side) == Rule::Mirror {
                chord
            } else {
                let there = self.settled_tangent(other, 1 - side, state);
                chord * (2.0 * there.dot(&chord)) - there
            }
        });
        self.turned(joint, side, self.beside_curvature(joint, side, mirrored))
    }

    /// The tangent of a joint that mirrors no other: nothing here calls itself, so that the stack has a bound.
    fn settled_tangent(&self, joint: usize, side: usize, state: &[f64]) -> SVector<f64, D> {
        let found = if self.rule(joint, side) == Rule::Given {
            self.place.local_direction(&self.data(joint).tangent[side].value)
        } else {
            self.beside_curvature(joint, side, self.circle(joint, state).map(|[tangent, _]| tangent))
        };
        self.turned(joint, side, found)
    }

    fn turned(&self, joint: usize, side: usize, found: SVector<f64, D>) -> SVector<f64, D> {
        let kept = self.data(joint).tangent[side].given == Given::FIXED;
        if self.turned == Some(joint) && !kept { -found } else { found }
    }

    /// A given curvature without a tangent: the tangent is perpendicular to it, if that leaves anything.
    fn beside_curvature(&self, joint: usize, side: usize, found: Option<SVector<f64, D>>) -> SVector<f64, D> {
        let found = found.unwrap_or_else(SVector::zeros);
        let curvature = &self.data(joint).curvature[side];
        if matches!(curvature.given, Given::INITIAL | Given::FIXED) {
            let given = unit(&self.place.local_curvature(&curvature.value));
            return given
                .and_then(|given| direction_across(&found, &given, UNDECIDED * UNDECIDED))
                .unwrap_or(found);
        }
        found
    }

    fn curvature(
        &self,
        joint: usize,
        side: usize,
        tangent: &SVector<f64, D>,
        state: &[f64],
    ) -> SVector<f64, D> {
        let data = self.data(joint);
        let given = &data.curvature[side];
        if given.given == Given::FREE {
            return self.free_curvature(joint, side, tangent, state);
        }
        let vector = self.place.local_curvature(&given.value);
        // What rounding leaves of a vector along the tangent has no direction, and not even to the side.
        let towards = direction_across(&vector, tangent, UNDECIDED * UNDECIDED * vector.dot(&vector));
        if given.given != Given::SIZE {
            let size = sqrt(vector.dot(&vector));
            return towards.map_or(vector, |towards| towards * size);
        }
        // A value that runs along the tangent says nothing of the direction.
        let size = self.place.local_size(&given.value);
        let towards = towards.or_else(|| {
            let free = self.free_curvature(joint, side, tangent, state);
            let other = self.neighbour(joint, side).or(self.neighbour(joint, 1 - side))?;
            let chord = self.point(other, state) - self.point(joint, state);
            // Where the start runs straight on, what bends is rounding.
            direction_across(&free, tangent, UNDECIDED * UNDECIDED / chord.dot(&chord))
        });
        towards.unwrap_or_else(|| perpendicular(tangent)) * size
    }

    /// The curvature at a joint where none is given.
    fn free_curvature(
        &self,
        joint: usize,
        side: usize,
        tangent: &SVector<f64, D>,
        state: &[f64],
    ) -> SVector<f64, D> {
        let data = self.data(joint);
        if data.continuity == Continuity::G2
            && let Some([along, curvature]) = self.circle(joint, state)
        {
            return carry(&curvature, &along, tangent);
        }
        let side = if self.neighbour(joint, side).is_some() { side } else { 1 - side };
        let Some(other) = self.neighbour(joint, side) else { return SVector::zeros() };
        if self.data(joint).continuity == Continuity::G2
            && self.data(other).continuity == Continuity::G2
            && let Some([along, curvature]) = self.circle(other, state)
        {
            // The thesis's end rule: the neighbour's curvature.
            return carry(&curvature, &along, tangent);
        }
        // The circle that touches the tangent here and passes through the other joint; a tangent that looks straight away
        // from it must turn round, to the left as well as to any side.
        let chord = self.point(other, state) - self.point(joint, state);
        let forward = if side == 1 { *tangent } else { -tangent };
        let square = chord.dot(&chord);
        let across = chord - tangent * chord.dot(tangent);
        if chord.dot(&forward) < 0.0 && across.dot(&across) < STRAIGHT * square {
            return perpendicular(tangent) * (2.0 / sqrt(square));
        }
        across * (2.0 / square)
    }

    fn end(&self, joint: usize, side: usize, state: &[f64]) -> End<D> {
        let tangent = self.tangent(joint, side, state);
        let curvature = self.curvature(joint, side, &tangent, state);
        // At a G1 joint both sides share the frame: it must not depend on the side's curvature.
        let shared = self.data(joint).continuity == Continuity::G1;
        let frame = frame_of(&tangent, &if shared { SVector::zeros() } else { curvature });
        let mut components = [0.0; D];
        for j in 1..D {
            components[j - 1] = frame[j].dot(&curvature);
        }
        End { point: self.point(joint, state), frame, curvature: components, speed: 1.0, stretch: 0.0 }
    }

    /// Speeds and stretches of a span from the turning of its tangents against the chord.
    ///
    /// Where the tangents look away from the chord, a quintic with these speeds may have a cusp or a loop: other speeds
    /// are tried too, and the fairest curve is taken.
    fn set_speeds(&self, ends: &mut [End<D>; 2]) {
        let chord = ends[1].point - ends[0].point;
        let size = sqrt(chord.dot(&chord));
        let angle = |t: &SVector<f64, D>| {
            let along = chord.dot(t);
            let across = chord - t * along;
            libm::atan2(sqrt(across.dot(&across)), along)
        };
        let turn = (angle(&ends[0].frame[0]) + angle(&ends[1].frame[0])).smaller(MOST_TURN);
        let half = 0.5 * turn;
        let length = if half > 1e-4 { size * half / libm::sin(half) } else { size };
        let bend =
            sqrt(ends.iter().map(|end| end.curvature_vector().norm_squared()).fold(0.0, Order::larger));
        if turn < GENTLE_TURN && bend * size < GENTLE_BEND {
            give_speeds(ends, length, turn);
            return;
        }
        let mut best = (f64::INFINITY, 1.0);
        for factor in SPEED_FACTORS {
            give_speeds(ends, length * factor, turn);
            let cost = self.model.cost_of_rows(usize::MAX, &rows_between(ends));
            if cost < 0.5 * best.0 {
                best = (cost, factor);
            }
        }
        give_speeds(ends, length * best.1, turn);
    }

    /// The first joint at which a curvature is given but the start tangent runs along it: then nothing tells to which side
    /// the curve goes.
    fn undecided(&self, state: &[f64]) -> Option<usize> {
        (0..self.joints().len()).find(|&joint| {
            (0..2).any(|side| {
                let data = self.data(joint);
                let given = matches!(data.curvature[side].given, Given::INITIAL | Given::FIXED)
                    && data.tangent[side].given == Given::FREE;
                given
                    && self.neighbour(joint, side).or(self.neighbour(joint, 1 - side)).is_some()
                    && unit(&self.place.local_curvature(&data.curvature[side].value))
                        .is_some_and(|across| across.dot(&self.tangent(joint, side, state)).abs() > UNDECIDED)
            })
        })
    }

    /// Fills the state, and returns the natural cost.
    ///
    /// # Errors
    /// [`CurveError::CurvatureNeedsTangent`].
    pub(super) fn fill(&self, state: &mut [f64]) -> Result<f64, CurveError> {
        state.fill(0.0);
        self.points(state);
        if let Some(joint) = self.undecided(state) {
            return Err(CurveError::CurvatureNeedsTangent { joint });
        }
        let (spans, count) = (self.model.curve.spans(), self.joints().len());
        let mut natural = 0.0;
        for span in 0..spans {
            let mut ends =
                [self.end(span, 1, state), self.end(if span + 1 == count { 0 } else { span + 1 }, 0, state)];
            self.set_speeds(&mut ends);
            natural += subdivide(self.model, span * self.parts, self.parts, &ends, state);
        }
        Ok(natural)
    }
}

/// Fills the state of a model from that of the same curve with fewer elements, each of which is cut into equal parts of its
/// parameter: as many as `parts` says. Returns the natural cost.
pub(super) fn refine<const D: usize>(
    coarse: &Model<'_, D>,
    coarse_state: &[f64],
    mut parts: impl FnMut(usize) -> usize,
    fine: &Model<'_, D>,
    state: &mut [f64],
) -> f64
where
    Shape<D>: Density<D>,
{
    state.fill(0.0);
    let (mut natural, mut first) = (0.0, 0);
    for element in 0..coarse.element_count() {
        let ends = [coarse.end(element, 0, coarse_state), coarse.end(element, 1, coarse_state)];
        let count = parts(element);
        natural += subdivide(fine, first, count, &ends, state);
        first += count;
    }
    natural
}

/// Writes `parts` elements from `first` on: equal parts of the quintic between two ends. Returns their natural cost.
fn subdivide<const D: usize>(
    model: &Model<'_, D>,
    first: usize,
    parts: usize,
    ends: &[End<D>; 2],
    state: &mut [f64],
) -> f64
where
    Shape<D>: Density<D>,
{
    let rows = rows_between(ends);
    let count = parts as f64;
    let [mut before, last] =
        ends.map(|end| End { speed: end.speed / count, stretch: end.stretch / (count * count), ..end });
    let mut natural = 0.0;
    for part in 0..parts {
        let after =
            if part + 1 == parts { last } else { cut(&rows, (part + 1) as f64 / count, count, &before) };
        model.set_end(first + part, 0, &before, state);
        model.set_end(first + part, 1, &after, state);
        natural += model.natural_of(0.5 * (before.speed + after.speed));
        before = after;
    }
    natural
}

/// Fills the state from elements, a chain of as many as the model has: the end of each element's first end and the start
/// of the next are taken from the next. What is fixed at the joints overrides. Returns the natural cost.
pub(super) fn adopt<const D: usize>(
    model: &Model<'_, D>,
    place: &Placement<D>,
    elements: &[Element],
    state: &mut [f64],
) -> f64
where
    Shape<D>: Density<D>,
{
    state.fill(0.0);
    let mut natural = 0.0;
    for (index, element) in elements.iter().enumerate() {
        let r = &element.rows;
        let mut ends = [[0, 1, 2], [5, 4, 3]].map(|[point, first, second]: [usize; 3]| {
            let (first, second) = (place.local_vector(&r[first]), place.local_vector(&r[second]));
            end_of(&place.local_point(&r[point]), &first, &second, None)
        });
        let old_chord = ends[1].point - ends[0].point;
        for (side, end) in ends.iter_mut().enumerate() {
            let Some(joint) = model.joint(model.node(index, side)) else { continue };
            let side = 1 - side;
            if !matches!(joint.position.given, Given::FREE | Given::INITIAL) {
                end.point = place.local_point(&joint.position.value);
            }
            let mut curvature = end.curvature_vector();
            if joint.tangent[side].given == Given::FIXED {
                let tangent = place.local_direction(&joint.tangent[side].value);
                curvature = carry(&curvature, &end.frame[0], &tangent);
                end.frame[0] = tangent;
            }
            let given = &joint.curvature[side];
            if matches!(given.given, Given::FIXED | Given::SIZE) {
                let wanted = place.local_curvature(&given.value);
                let towards = if given.given == Given::SIZE { curvature } else { wanted };
                // What rounding leaves of a vector along the tangent has no direction.
                let least = UNDECIDED * UNDECIDED * towards.dot(&towards);
                let beside = direction_across(&towards, &end.frame[0], least);
                let beside = beside.unwrap_or_else(|| perpendicular(&end.frame[0]));
                curvature = beside * place.local_size(&given.value);
            }
            // At a G1 joint both sides share the frame: it must not depend on the side's curvature.
            let shared = joint.continuity == Continuity::G1;
            end.frame = frame_of(&end.frame[0], &if shared { SVector::zeros() } else { curvature });
            for j in 1..D {
                end.curvature[j - 1] = end.frame[j].dot(&curvature);
            }
        }
        // An element whose joints moved apart is run through as much faster.
        let chord = ends[1].point - ends[0].point;
        let grown = sqrt(chord.dot(&chord) / old_chord.dot(&old_chord));
        if grown.is_finite() && grown > 0.0 {
            for end in &mut ends {
                end.speed *= grown;
                end.stretch *= grown;
            }
        }
        for (side, end) in ends.iter().enumerate() {
            model.set_end(index, side, end, state);
        }
        natural += model.natural_of(0.5 * (ends[0].speed + ends[1].speed));
    }
    natural
}

/// The end with a point and derivatives. Without a direction of its own it takes that of `before`.
fn end_of<const D: usize>(
    point: &SVector<f64, D>,
    first: &SVector<f64, D>,
    second: &SVector<f64, D>,
    before: Option<&End<D>>,
) -> End<D> {
    let speed = sqrt(first.dot(first));
    let tangent = unit(first).or(before.map(|end| end.frame[0])).unwrap_or_else(SVector::zeros);
    let along = second.dot(&tangent);
    let curvature = (second - tangent * along) / (speed * speed).larger(f64::MIN_POSITIVE);
    let frame = frame_of(&tangent, &curvature);
    let mut components = [0.0; D];
    for j in 1..D {
        components[j - 1] = frame[j].dot(&curvature);
    }
    End { point: *point, frame, curvature: components, speed, stretch: along }
}

/// The end that a span's start curve has at an interior parameter, for elements that are `1/parts` of it.
pub(super) fn cut<const D: usize>(
    rows: &[SVector<f64, D>; 6],
    t: f64,
    parts: f64,
    before: &End<D>,
) -> End<D> {
    let [point, first, second] = place(rows, t);
    let end = end_of(&point, &first, &second, Some(before));
    End { speed: end.speed / parts, stretch: end.stretch / (parts * parts), ..end }
}

/// Gives a span of this length and turning the speeds and the stretches of the quintic that fits an arc best.
pub(super) fn give_speeds<const D: usize>(ends: &mut [End<D>; 2], length: f64, turn: f64) {
    let square = turn * turn;
    let speed = length * (1.0 + SPEED_BY_TURN * square);
    for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
        end.speed = speed;
        end.stretch = sign * STRETCH_BY_TURN * square * speed;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::curve::joint::{Curve, Given, Quantity};
    use crate::curve::options::Options;
    use crate::curve::tests::planar;
    use crate::solve::Problem;
    use std::vec;

    /// The start of a planar curve, and a state in which its points stand.
    fn with<T>(curve: &Curve<'_>, turned: Option<usize>, work: impl Fn(&Start<'_, '_, 2>, &[f64]) -> T) -> T {
        let model = planar(curve, &Options::DEFAULT);
        let mut state = vec![f64::NAN; model.state_len()];
        let start = Start { model: &model, place: &model.place, parts: 1, turned };
        start.points(&mut state);
        work(&start, &state)
    }

    const FREE: Joint = Joint::at([0.0; 3]).with_position(Quantity::FREE);

    /// Of ten joints three are given: between them even steps, beyond an open curve's ends the next steps again, and around
    /// a closed one's seam the steps between its last and its first.
    #[test]
    fn free_points_start_evenly_between_given_ones() {
        let mut joints = [FREE; 10];
        joints[2] = Joint::at([0.0, 0.0, 0.0]);
        joints[5] = Joint::at([3.0, 6.0, 0.0]);
        joints[7] = Joint::at([5.0, 0.0, 0.0]);
        let inside = [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0], [3.0, 6.0], [4.0, 3.0], [5.0, 0.0]];
        let before_open = [[-2.0, -4.0], [-1.0, -2.0]];
        let after_open = [[6.0, -3.0], [7.0, -6.0]];
        let (before_closed, after_closed) = ([[2.0, 0.0], [1.0, 0.0]], [[4.0, 0.0], [3.0, 0.0]]);
        for (curve, before, after) in [
            (Curve::open(&joints), before_open, after_open),
            (Curve { closed: true, ..Curve::open(&joints) }, before_closed, after_closed),
        ] {
            with(&curve, None, |start, state| {
                for (joint, [x, y]) in before.into_iter().chain(inside).chain(after).enumerate() {
                    let off = start.point(joint, state) - start.place.local_point(&[x, y, 0.0]);
                    assert!(off.amax() < 1e-14, "{} {joint}: {off}", curve.closed);
                }
            });
        }
    }

    /// At an end with a tangent: the circle that touches it and passes through the other joint, whichever end it is.
    #[test]
    fn a_lone_end_starts_on_the_circle_through_the_other() {
        let joints = [Joint::at([0.0; 3]), Joint::at([4.0, 0.0, 0.0])];
        with(&Curve::open(&joints), None, |start, state| {
            let chord = start.point(1, state) - start.point(0, state);
            let size = sqrt(chord.dot(&chord));
            let curvature = |joint: usize, side: usize, tangent: [f64; 2]| {
                let found = start.free_curvature(joint, side, &SVector::from(tangent), state) * size;
                [found[0], found[1]]
            };
            let near = |found: [f64; 2], wanted: [f64; 2]| {
                let off = SVector::from(found) - SVector::from(wanted);
                assert!(off.amax() < 1e-12, "{found:?} {wanted:?}");
            };
            // Across the chord it is half a circle over it, here as there.
            near(curvature(0, 1, [0.0, 1.0]), [2.0, 0.0]);
            near(curvature(1, 0, [0.0, -1.0]), [-2.0, 0.0]);
            let half = sqrt(0.5);
            near(curvature(0, 1, [half, half]), [1.0, -1.0]);
            near(curvature(0, 1, [-half, half]), [1.0, 1.0]);
            near(curvature(1, 0, [half, -half]), [-1.0, -1.0]);
            // Straight to the other joint there is none; straight away from it, half a circle over the chord, to the left.
            near(curvature(0, 1, [1.0, 0.0]), [0.0, 0.0]);
            near(curvature(1, 0, [1.0, 0.0]), [0.0, 0.0]);
            near(curvature(0, 1, [-1.0, 0.0]), [0.0, -2.0]);
            near(curvature(1, 0, [-1.0, 0.0]), [0.0, -2.0]);
            // Only where it is straight away.
            near(curvature(0, 1, [-0.8, 0.6]), [2.0 * 0.36, 2.0 * 0.48]);
            // On the side without a neighbour it is that of the other side.
            near(curvature(0, 0, [0.0, 1.0]), [2.0, 0.0]);
            near(curvature(1, 1, [0.0, -1.0]), [-2.0, 0.0]);
        });
    }

    #[test]
    fn a_joint_that_the_data_turn_back_at_starts_on_half_a_circle() {
        let joints = [Joint::at([0.0; 3]), Joint::at([4.0, 0.0, 0.0]), Joint::at([2.0, 0.0, 0.0])];
        with(&Curve::open(&joints), None, |start, state| {
            let Some([tangent, curvature]) = start.circle(1, state) else { panic!("a circle") };
            let chord = start.point(0, state) - start.point(1, state);
            assert!(tangent.dot(&chord).abs() < 1e-14 && (tangent.dot(&tangent) - 1.0).abs() < 1e-14);
            // Over the longer of the two.
            assert!((curvature * chord.dot(&chord) - chord * 2.0).amax() < 1e-12, "{curvature} {chord}");
        });
    }

    /// However small it is.
    #[test]
    fn a_given_curvature_is_laid_across_the_tangent_and_keeps_its_size() {
        let along = SVector::from([0.6, 0.8]);
        let across = SVector::from([-0.8, 0.6]);
        for size in [1e-9, 1e-3, 1.0, 1e5] {
            for lean in [0.0, 0.1, -3.0] {
                let given = across * -size + along * (lean * size);
                let value = [given[0], given[1], 0.0];
                for quantity in [Quantity::fixed(value), Quantity::initial(value), Quantity::of_size(value)] {
                    let joints = [Joint::at([0.0; 3]).with_curvature(quantity), Joint::at([1.0, 1.0, 0.0])];
                    with(&Curve::open(&joints), None, |start, state| {
                        let found = start.curvature(0, 1, &along, state);
                        let wanted = start.place.local_size(&value);
                        assert!(found.dot(&along).abs() < 1e-12 * wanted);
                        assert!(
                            (found.dot(&across) + wanted).abs() < 1e-12 * wanted,
                            "{size} {lean} {found}"
                        );
                    });
                }
            }
        }
    }

    #[test]
    fn a_turned_tangent_looks_the_other_way_unless_it_is_fixed() {
        for (given, turns) in [(Given::FREE, true), (Given::INITIAL, true), (Given::FIXED, false)] {
            let tangent = Quantity { given, value: [1.0, 2.0, 0.0] };
            let joints = [
                Joint::at([0.0; 3]),
                Joint::at([1.0, 1.0, 0.0]).with_tangent(tangent),
                Joint::at([2.0, 0.5, 0.0]),
            ];
            let curve = Curve::open(&joints);
            let of = |turned: Option<usize>, joint: usize| {
                with(&curve, turned, |start, state| start.tangent(joint, 1, state))
            };
            let wanted = if turns { -of(None, 1) } else { of(None, 1) };
            assert_eq!(of(Some(1), 1), wanted);
            assert_eq!(of(Some(0), 1), of(None, 1));
        }
    }

    #[test]
    fn some_direction_lies_across_any_other_and_a_normal_is_carried_along() {
        let directions =
            [[1.0, 2.0, -3.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [-5.0, 0.1, 0.2], [0.3, -4.0, 1.0]];
        for from in directions.map(SVector::<f64, 3>::from) {
            let from = from / sqrt(from.dot(&from));
            let across = perpendicular(&from);
            assert!(across.dot(&from).abs() < 1e-15 && (across.dot(&across) - 1.0).abs() < 1e-15);
            for to in directions.map(SVector::<f64, 3>::from) {
                let to = to / sqrt(to.dot(&to));
                // A turn about `from × to` changes neither sizes nor angles, nor what lies along that axis.
                let there = carry(&across, &from, &to);
                let axis = from.cross(&to);
                assert!(there.dot(&to).abs() < 1e-14, "{there}");
                assert!((there.dot(&there) - 1.0).abs() < 1e-14);
                assert!((there - across).dot(&axis).abs() < 1e-14);
            }
        }
    }
}
