//! A curve as the solver's problem: nodes and elements as blocks of unknowns (thesis 4.5, Fig. 4.4).
//!
//! A *node* is a joint, or one of the free G2 points between joints that more than one element a span brings
//! (4.6). Its block holds position, frame (unit tangent and normals) and curvature components in the frame; an
//! *element*'s block holds the scalars of its two ends, and what a G1 or G0 joint does not share. What an end is made
//! of, and how it moves, [`super::end`] knows; what an element costs, [`super::rows`].

use super::end::{Coordinate, End, SideStep, row_of, rows_between};
use super::fairness::{Density, Shape};
use super::functional::{Functional, Weights};
use super::guard::Guard;
use super::joint::{Continuity, Curve, Given, Joint};
use super::placement::Placement;
use super::rows::{Integrand, Mirrored, RowDerivatives};
use super::space::Space;
use super::torsion::SpaceFunctional;
use crate::basis::mirrored::{pair_count, pairs};
use crate::order::Order;
use crate::root::sqrt;
use crate::solve::{BlockList, Coupled, Problem, packed};
use crate::total::Total;
use core::ops::Range;
use nalgebra::SVector;

/// Numbers of the state that describe a frame and curvature components.
const fn side_len(d: usize) -> usize {
    d * d + d
}

/// Numbers of the state that a node of a space curve has for its torsion: the torsion, the multiplier that makes the
/// elements agree in it, and the weight with which they are held to it.
const fn torsion_len(d: usize) -> usize {
    if d == 3 { 3 } else { 0 }
}

/// The weight with which the torsion of an element's end is held to its node's, times the speed there. What is left of
/// a jump after one minimisation falls by about such a factor with every correction of the multipliers.
const TIE: f64 = 200.0;
/// The same where a solution with fewer elements is known: a stiff tie keeps to it.
const STIFF_TIE: f64 = 1000.0;

/// The most local unknowns of an element in space, 10 an end.
const MOST_LOCAL: usize = 20;

type Coordinates = heapless::Vec<(usize, Coordinate), MOST_LOCAL>;

/// A node's or a side's freedoms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Freedom {
    point: PointFreedom,
    tangent: bool,
    curvature: CurvatureFreedom,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CurvatureFreedom {
    Fixed,
    Turns,
    Free,
}

/// A length that the curve is to have: `multiplier (L − target) + ½ penalty (L − target)²` is added to the functional.
#[derive(Clone, Copy)]
pub(super) struct Goal {
    pub(super) target: f64,
    pub(super) multiplier: f64,
    pub(super) penalty: f64,
}

/// Where the joints stand among the nodes.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Division<'a> {
    /// So many elements a span.
    Even(usize),
    /// A number a node: that of its joint, from 1, 0 for a node between joints, or minus that of its contact, from 1.
    Marked(&'a [f64]),
}

/// The length of a vector of any size.
pub(super) fn extent<const D: usize>(vector: &SVector<f64, D>) -> f64 {
    let most = vector.amax();
    let scaled = vector / most;
    if most > 0.0 { most * sqrt(scaled.dot(&scaled)) } else { 0.0 }
}

/// The direction of a vector of any size; not a number of none.
pub(super) fn heading<const D: usize>(vector: &SVector<f64, D>) -> SVector<f64, D> {
    let scaled = vector / vector.amax();
    scaled / sqrt(scaled.dot(&scaled))
}

/// How a node touches an obstacle.
#[derive(Clone, Copy)]
pub(super) enum Contact<const D: usize> {
    /// Around a point at a distance to the left; to the right if that is negative.
    Around { point: SVector<f64, D>, left: f64 },
    /// Along a segment of this direction.
    Along { direction: SVector<f64, D> },
}

/// What of a point is free.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PointFreedom {
    Fixed,
    Free,
    Line,
    Plane,
    /// Free but for the motion along the curve.
    Across,
}

/// A curve in its local system.
#[derive(Clone, Copy)]
pub(super) struct Model<'a, const D: usize> {
    pub(super) curve: Curve<'a>,
    pub(super) place: Placement<D>,
    pub(super) division: Division<'a>,
    pub(super) functional: Functional,
    pub(super) weights: Weights,
    /// What of it knows torsion, beside the weights; space curves only.
    pub(super) space: Option<Space>,
    /// A length that is approached.
    pub(super) goal: Option<Goal>,
    /// The contacts: three times the obstacle's number, plus 0 for its first end, 1 for its other, 2 for between.
    pub(super) contacts: &'a [f64],
    /// Gauss–Lobatto points an element.
    pub(super) points: usize,
    /// Whether more points are taken where they tell a difference.
    pub(super) chooses_points: bool,
    /// Weight of the evenness of the parametrisation.
    pub(super) gauge: f64,
    /// Whether a curve that turns by more than a right angle between two points of the rule is outside the domain:
    /// it would have a cusp there that the rule does not see.
    pub(super) guarded: bool,
    /// The two joints that hold a curve of which nothing is fixed, see [`super::anchors`].
    pub(super) anchors: Option<[usize; 2]>,
    /// Whether that curve's joints slide along it.
    pub(super) slides: bool,
    /// Whether the elements have been laid along a curve that is known: no others are much better.
    pub(super) fitted: bool,
    /// The natural size of the integral, see [`Problem::natural_cost`].
    pub(super) natural_cost: f64,
    /// Half the sum of all speeds at the start: about the curve's length.
    pub(super) start_length: f64,
}

impl<const D: usize> Model<'_, D> {
    pub(super) fn element_count(&self) -> usize {
        match self.division {
            Division::Even(parts) => self.curve.spans() * parts,
            Division::Marked(nodes) => nodes.len() - usize::from(!self.curve.closed),
        }
    }

    pub(super) fn node_count(&self) -> usize {
        self.element_count() + usize::from(!self.curve.closed)
    }

    /// The node at an end of an element.
    pub(super) fn node(&self, element: usize, end: usize) -> usize {
        let node = element + end;
        if node == self.node_count() { 0 } else { node }
    }

    /// The joint at a node, if there is one.
    pub(super) fn joint(&self, node: usize) -> Option<&Joint> {
        self.curve.joints.get(self.joint_number(node)?)
    }

    /// The natural size of an element of this length: what each integral is on an arc that turns by one radian or so.
    pub(super) fn natural_of(&self, length: f64) -> f64 {
        let Weights { variation, bending, length: tension } = self.weights;
        // The space functionals are natural like those of the plane.
        let own = match (self.space.is_some(), self.functional.bends()) {
            (false, _) => 0.0,
            (true, true) => 1.0 / length,
            (true, false) => 1.0 / (length * length * length),
        };
        own + variation / (length * length * length) + bending / length + tension * length
    }

    /// The functional by its integrals: variation, bending and length.
    pub(super) fn value_of(&self, [variation, bending, length]: &[f64; 3]) -> f64 {
        let weights = &self.weights;
        let own = weights.variation * variation + weights.bending * bending + weights.length * length;
        match self.functional.length_power() {
            0 => own,
            1 => own * length,
            _ => own * length * length * length,
        }
    }

    fn joint_number(&self, node: usize) -> Option<usize> {
        match self.division {
            Division::Even(parts) => node.is_multiple_of(parts).then(|| node / parts.max(1)),
            Division::Marked(nodes) => nodes.get(node).and_then(|&mark| (mark as usize).checked_sub(1)),
        }
    }

    /// A node's mark, see [`Division::Marked`].
    pub(super) fn joint_mark(&self, node: usize) -> f64 {
        self.joint_number(node).map_or(0.0, |joint| (joint + 1) as f64)
    }

    /// The code of the contact at a node, if there is one, see [`Model::contacts`].
    pub(super) fn contact_code(&self, node: usize) -> Option<usize> {
        let Division::Marked(nodes) = self.division else { return None };
        let number = Some(-*nodes.get(node)?).filter(|number| *number > 0.0)?;
        self.contacts.get(number as usize - 1).map(|&code| code as usize)
    }

    /// The contact at a node, if there is one.
    pub(super) fn contact(&self, node: usize) -> Option<Contact<D>> {
        let code = self.contact_code(node)?;
        let obstacle = self.curve.obstacles.get(code / 3)?;
        let [from, to] = [&obstacle.from, &obstacle.to].map(|point| self.place.local_point(point));
        let left = obstacle.side.sign();
        Some(match code % 3 {
            0 => Contact::Around { point: from, left: left * self.place.local_length(obstacle.clearance) },
            1 => Contact::Around { point: to, left: left * self.place.local_length(obstacle.clearance) },
            _ => Contact::Along { direction: heading(&(to - from)) },
        })
    }

    fn node_start(node: usize) -> usize {
        node * (D + side_len(D) + torsion_len(D))
    }

    /// Where in the state a node's point stands.
    pub(super) fn point_place(node: usize) -> usize {
        Self::node_start(node)
    }

    /// The numbers that a node and an element add to the state.
    pub(super) const fn state_a_piece() -> usize {
        D + side_len(D) + 4 + 2 * side_len(D)
    }

    fn element_start(&self, element: usize) -> usize {
        Self::node_start(self.node_count()) + element * (4 + 2 * side_len(D))
    }

    fn continuity(&self, node: usize) -> Continuity {
        self.joint(node).map_or(Continuity::G2, |joint| joint.continuity)
    }

    /// Where in the state the frame and the curvature components of an end stand.
    fn side_places(&self, element: usize, end: usize) -> (usize, usize) {
        let node = self.node(element, end);
        let shared = Self::node_start(node) + D;
        let own = self.element_start(element) + 4 + end * side_len(D);
        match self.continuity(node) {
            Continuity::G0 => (own, own + D * D),
            Continuity::G1 => (shared, own + D * D),
            _ => (shared, shared + D * D),
        }
    }

    fn is_anchor(&self, node: usize) -> bool {
        self.anchors
            .is_some_and(|anchors| self.joint_number(node).is_some_and(|joint| anchors.contains(&joint)))
    }

    /// Whether a node has an element on either side and shares all with both, so that it may slide along the curve.
    fn is_inside(&self, node: usize) -> bool {
        let inside = self.curve.closed || (node > 0 && node < self.element_count());
        inside && self.continuity(node) == Continuity::G2
    }

    /// What is free at a side of a node; side 0 arrives, side 1 leaves.
    fn freedom(&self, node: usize, side: usize) -> Freedom {
        let Some(joint) = self.joint(node) else {
            // Where a node stands along the curve hardly matters, but its torsion would have to follow.
            let point = if self.space.is_some() { PointFreedom::Across } else { PointFreedom::Free };
            return Freedom { point, tangent: true, curvature: CurvatureFreedom::Free };
        };
        let point = match joint.position.given {
            Given::FIXED => PointFreedom::Fixed,
            Given::ON_LINE => PointFreedom::Line,
            // A plane that holds the plane of a planar curve leaves it free.
            Given::ON_PLANE if D == 3 => PointFreedom::Plane,
            Given::ON_PLANE if self.place.slide(joint, 0).is_some() => PointFreedom::Line,
            _ if !self.slides && self.is_anchor(node) => PointFreedom::Fixed,
            _ if !self.slides && self.is_inside(node) => PointFreedom::Across,
            _ => PointFreedom::Free,
        };
        let stands = !self.slides && self.is_anchor(node);
        let tangent = joint.tangent[side].given != Given::FIXED && !stands;
        let fixed = &joint.curvature[side];
        let kept = fixed.given == Given::FIXED;
        let curvature = if !kept && fixed.given != Given::SIZE {
            CurvatureFreedom::Free
        } else if (tangent || !kept) && D == 3 && fixed.value != [0.0; 3] {
            CurvatureFreedom::Turns
        } else {
            CurvatureFreedom::Fixed
        };
        Freedom { point, tangent, curvature }
    }

    /// Whether the elements at a node share its tangent, and its curvature.
    pub(super) fn shares(&self, node: usize) -> (bool, bool) {
        let continuity = self.continuity(node);
        (continuity != Continuity::G0, continuity == Continuity::G2)
    }

    /// Whether the size of the curvature at a side of a node is free, and its tangent.
    pub(super) fn bends_and_turns(&self, node: usize, side: usize) -> (bool, bool) {
        let freedom = self.freedom(node, side);
        (freedom.curvature == CurvatureFreedom::Free, freedom.tangent)
    }

    /// Calls `visit` with the coordinates that are unknowns of a node, in the order of its dofs.
    fn node_coordinates(&self, node: usize, mut visit: impl FnMut(Coordinate)) {
        match self.contact(node) {
            Some(Contact::Around { left, .. }) => {
                visit(Coordinate::Roll(left));
                visit(Coordinate::Curvature(0));
                return;
            }
            Some(Contact::Along { .. }) => {
                visit(Coordinate::Along(0));
                visit(Coordinate::Curvature(0));
                return;
            }
            None => {}
        }
        let freedom = self.freedom(node, 0);
        let continuity = self.continuity(node);
        match freedom.point {
            PointFreedom::Fixed => {}
            PointFreedom::Free => (0..D).for_each(|d| visit(Coordinate::Point(d))),
            PointFreedom::Across => (0..D - 1).for_each(|j| visit(Coordinate::Across(j))),
            PointFreedom::Line => visit(Coordinate::Along(0)),
            PointFreedom::Plane => (0..D - 1).for_each(|k| visit(Coordinate::Along(k))),
        }
        if continuity != Continuity::G0 && freedom.tangent {
            (0..D - 1).for_each(|j| visit(Coordinate::Tangent(j)));
        }
        if continuity == Continuity::G2 {
            Self::curvature_coordinates(freedom.curvature, &mut visit);
        }
        if self.is_tied(node) {
            visit(Coordinate::Torsion);
        }
    }

    /// Calls `visit` with the coordinates that belong to an element: four scalars, and what its ends do not share.
    fn element_coordinates(&self, element: usize, mut visit: impl FnMut(usize, Coordinate)) {
        for end in 0..2 {
            visit(end, Coordinate::Speed);
            visit(end, Coordinate::Stretch);
        }
        for end in 0..2 {
            let node = self.node(element, end);
            let freedom = self.freedom(node, 1 - end);
            let continuity = self.continuity(node);
            if continuity == Continuity::G0 && freedom.tangent {
                (0..D - 1).for_each(|j| visit(end, Coordinate::Tangent(j)));
            }
            if continuity != Continuity::G2 {
                Self::curvature_coordinates(freedom.curvature, |coordinate| visit(end, coordinate));
            }
        }
    }

    fn curvature_coordinates(freedom: CurvatureFreedom, mut visit: impl FnMut(Coordinate)) {
        match freedom {
            CurvatureFreedom::Fixed => {}
            CurvatureFreedom::Turns => visit(Coordinate::Turn),
            CurvatureFreedom::Free => (0..D - 1).for_each(|j| visit(Coordinate::Curvature(j))),
        }
    }

    /// All local unknowns of an element, in the order of its blocks: first node, element, last node.
    fn local_coordinates(&self, element: usize) -> Coordinates {
        let mut list = Coordinates::new();
        self.node_coordinates(self.node(element, 0), |coordinate| {
            let _ = list.push((0, coordinate));
        });
        self.element_coordinates(element, |end, coordinate| {
            let _ = list.push((end, coordinate));
        });
        self.node_coordinates(self.node(element, 1), |coordinate| {
            let _ = list.push((1, coordinate));
        });
        list
    }

    /// Reads an end of an element out of the state.
    pub(super) fn end(&self, element: usize, end: usize, state: &[f64]) -> End<D> {
        let node = Self::node_start(self.node(element, end));
        let (frame, curvature) = self.side_places(element, end);
        let scalars = self.element_start(element) + 2 * end;
        End {
            point: SVector::from_fn(|d, _| state.at(node + d)),
            frame: core::array::from_fn(|j| SVector::from_fn(|d, _| state.at(frame + D * j + d))),
            curvature: core::array::from_fn(|j| state.at(curvature + j)),
            speed: state.at(scalars),
            stretch: state.at(scalars + 1),
        }
    }

    /// Writes an end of an element into the state. What both elements at a node share is the same in both calls.
    pub(super) fn set_end(&self, element: usize, end: usize, value: &End<D>, state: &mut [f64]) {
        let node = Self::node_start(self.node(element, end));
        let (frame, curvature) = self.side_places(element, end);
        let scalars = self.element_start(element) + 2 * end;
        for d in 0..D {
            state.put(node + d, value.point[d]);
            for j in 0..D {
                state.put(frame + D * j + d, value.frame[j][d]);
            }
            state.put(curvature + d, value.curvature[d]);
        }
        state.put(scalars, value.speed);
        state.put(scalars + 1, value.stretch);
    }

    /// The six Hermite rows of an element in the local system.
    pub(super) fn rows(&self, element: usize, state: &[f64]) -> [SVector<f64, D>; 6] {
        rows_between(&[self.end(element, 0, state), self.end(element, 1, state)])
    }

    /// Whether the elements at a node have a torsion in common.
    fn is_tied(&self, node: usize) -> bool {
        let inside = self.curve.closed || (node > 0 && node < self.element_count());
        inside
            && D == 3
            && self.space.is_some_and(|space| space.functional == SpaceFunctional::Mvc)
            && self.continuity(node) == Continuity::G2
    }

    /// Where in the state a tied node's torsion, multiplier and weight stand.
    fn torsion_place(&self, node: usize) -> Option<usize> {
        self.is_tied(node).then(|| Self::node_start(node) + D + side_len(D))
    }

    /// The weight with which an end's torsion is held, and what it is held to.
    fn tie(&self, element: usize, end: usize, state: &[f64]) -> Option<[f64; 2]> {
        self.space.filter(|space| space.tied)?;
        let at = self.torsion_place(self.node(element, end))?;
        // The first end leaves its node, the second arrives.
        let multiplier = if end == 0 { state.at(at + 1) } else { -state.at(at + 1) };
        Some([state.at(at + 2), state.at(at) + multiplier])
    }

    /// The torsions of the two elements that meet at a tied node, and their rates of change: of the arriving one and of
    /// the leaving one.
    fn torsions_at(&self, node: usize, state: &[f64]) -> [[f64; 2]; 2] {
        let Some(space) = self.space else { return [[0.0; 2]; 2] };
        let count = self.element_count();
        let before = (node + count - 1) % count.max(1);
        let at = |element: usize, end: usize| space.torsion_and_slope(&self.rows(element, state), end);
        [at(before, 1), at(node, 0)]
    }

    /// Gives every tied node the mean torsion of its elements, and the weight that belongs to their speeds.
    pub(super) fn begin_ties(&self, state: &mut [f64]) {
        let count = self.element_count();
        let tie = if self.division == Division::Even(1) { TIE } else { STIFF_TIE };
        for node in 0..self.node_count() {
            let Some(at) = self.torsion_place(node) else { continue };
            let [[one, one_slope], [other, other_slope]] = self.torsions_at(node, state);
            let before = (node + count - 1) % count.max(1);
            let speed = state.at(self.element_start(before) + 2).smaller(state.at(self.element_start(node)));
            let weight = tie / speed;
            state.put(at, 0.5 * (one + other));
            state.put(at + 1, -0.5 * (one_slope + other_slope) / weight);
            state.put(at + 2, weight);
        }
    }

    /// Corrects the multipliers of all ties by what the torsions jump, and returns the largest jump as a fraction of the
    /// torsion or of the typical curvature, whichever is larger; 0 where nothing is tied.
    pub(super) fn correct_ties(&self, state: &mut [f64]) -> f64 {
        let scale = self.space.map_or(1.0, |space| space.scale());
        let mut most = 0.0;
        for node in 0..self.node_count() {
            let Some(at) = self.torsion_place(node) else { continue };
            let [[one, _], [other, _]] = self.torsions_at(node, state);
            state.add(at + 1, 0.5 * (one - other));
            let jump = (one - other).abs() / scale.larger(one.abs());
            most = if jump > most { jump } else { most };
        }
        most
    }

    /// Whether the curve ends without curvature, as one of least energy does where its end may turn.
    pub(super) fn ends_straight(&self) -> bool {
        let free = |node: usize, side: usize| self.bends_and_turns(node, side) == (true, true);
        !self.curve.closed
            && self.space.is_some_and(|space| space.functional == SpaceFunctional::Mec)
            && (free(0, 1) || free(self.element_count(), 0))
    }

    /// The least curvature of a space curve.
    pub(super) fn least_curvature(&self, state: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        if let Some(space) = &self.space {
            for element in 0..self.element_count() {
                least = least.smaller(space.least_curvature(&self.rows(element, state)));
            }
        }
        least
    }

    /// Whether an element is as slow at an end as any may be.
    pub(super) fn all_but_stops(&self, state: &[f64]) -> bool {
        (0..self.element_count())
            .any(|element| !is_faster(&[0, 1].map(|end| self.end(element, end, state)), SLOW * LEAST_SPEED))
    }

    /// Half the sum of the speeds: about the length, and cheap.
    pub(super) fn rough_length(&self, state: &[f64]) -> f64 {
        let mut sum = 0.0;
        for element in 0..self.element_count() {
            let at = self.element_start(element);
            sum += 0.5 * (state.at(at) + state.at(at + 2));
        }
        sum
    }
}

impl<const D: usize> Model<'_, D>
where
    Shape<D>: Density<D>,
{
    fn integrand(&self, element: usize) -> Integrand<D> {
        let reference = self.curve.reference.and_then(|reference| {
            let rows = reference.elements.get(element)?.rows.map(|row| self.place.local_vector(&row));
            Some((Mirrored::of(&rows), reference.weight))
        });
        let mut weights = self.weights;
        weights.variation += self.space.as_ref().map_or(0.0, Space::plain_variation);
        Integrand { weights, gauge: self.gauge, rule: pairs(self.points), reference }
    }

    /// What is summed when the two sums count by these weights.
    fn combined(&self, element: usize, [own, length]: [f64; 2]) -> Integrand<D> {
        let plain = self.integrand(element);
        let mut weights = plain.weights.times(own);
        weights.length += length;
        Integrand { weights, gauge: self.gauge * own, ..plain }
    }

    /// The direction in which a node slides.
    fn guide(&self, node: usize, k: usize) -> SVector<f64, D> {
        if let Some(Contact::Along { direction }) = self.contact(node) {
            return direction;
        }
        self.joint(node).and_then(|joint| self.place.slide(joint, k)).unwrap_or_else(SVector::zeros)
    }

    /// The same curve with other nodes and contacts.
    pub(super) fn touching<'m>(&self, marks: &'m [f64], contacts: &'m [f64]) -> Model<'m, D>
    where
        Self: 'm,
    {
        Model { division: Division::Marked(marks), contacts, ..*self }
    }

    /// The functional's derivative by an element's chord.
    pub(super) fn slope_by_chord(&self, element: usize, first: [f64; 2], state: &[f64]) -> SVector<f64, D> {
        self.combined(element, first).derivatives(&self.rows(element, state)).gradient[0].into()
    }

    /// Gradient and Hessian by some of an element's local unknowns from those by its rows; the length's gradient goes to
    /// `second` as far as that reaches.
    #[expect(clippy::too_many_arguments, reason = "an element, what is known of it, and three results")]
    fn by_unknowns(
        &self,
        element: usize,
        ends: &[End<D>; 2],
        list: &Coordinates,
        by_rows: &RowDerivatives<D>,
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) {
        let mut maps = [[SVector::<f64, D>::zeros(); 3]; MOST_LOCAL];
        // By the points at the two ends the chord's derivatives count, with opposite signs.
        let side = |end: usize| if end == 0 { -1.0 } else { 1.0 };
        let [first_end, last_end] = ends;
        let of = |end: usize| if end == 0 { first_end } else { last_end };
        for (map, &(end, one)) in maps.iter_mut().zip(list) {
            *map = match one {
                Coordinate::Along(k) => {
                    [self.guide(self.node(element, end), k), SVector::zeros(), SVector::zeros()]
                }
                _ => of(end).tangent_map(one),
            };
            map[0] *= side(end);
        }
        let [first_tie, last_tie] = &by_rows.ties;
        let tie_at = |end: usize| if end == 0 { first_tie } else { last_tie };
        for (i, (&(end, one), map)) in list.iter().zip(&maps).enumerate() {
            let mut slope = 0.0;
            // The Hessian times this direction, by rows.
            let mut along = [SVector::<f64, D>::zeros(); 5];
            for order in one.orders() {
                let (row, direction) = (row_of(end, order), &map[order]);
                for d in 0..D {
                    slope += direction[d] * by_rows.gradient[row][d];
                    for a in 0..5 {
                        for x in 0..D {
                            along[a][x] += by_rows.hessian[a][row][x][d] * direction[d];
                        }
                    }
                }
            }
            if one == Coordinate::Torsion {
                let tie = tie_at(end);
                slope = tie.slope;
                along = tie.mixed.map(SVector::from);
            }
            gradient.put(i, slope);
            if let Some(second) = second.get_mut(i) {
                for order in one.orders() {
                    let length = SVector::from(by_rows.length_gradient[row_of(end, order)]);
                    *second += map[order].dot(&length);
                }
            }
            for (j, (&(other_end, other), other_map)) in list.iter().zip(&maps).enumerate().take(i + 1) {
                let mut sum = 0.0;
                for order in other.orders() {
                    sum += other_map[order].dot(&along[row_of(other_end, order)]);
                }
                if other == Coordinate::Torsion {
                    let tie = tie_at(other_end);
                    for order in one.orders() {
                        sum += map[order].dot(&SVector::from(tie.mixed[row_of(end, order)]));
                    }
                    if one == Coordinate::Torsion && end == other_end {
                        sum += tie.second;
                    }
                }
                if end == other_end {
                    let [point, first, second] =
                        [0, 1, 2].map(|order| SVector::<f64, D>::from(by_rows.gradient[row_of(end, order)]));
                    sum += of(end).second_map(one, other, &(point * side(end)), &first, &second);
                }
                matrix.put(packed(i, j), sum);
            }
        }
    }

    /// What an element costs by its rows, and its length; infinite outside the domain.
    pub(super) fn sums_of_rows(&self, element: usize, rows: &[SVector<f64, D>; 6]) -> [f64; 2] {
        let mut guard = Guard::of(if self.guarded { pair_count(self.points) } else { 0 });
        let [own, length] = self.integrand(element).value(rows, |first| guard.pass(first));
        if !guard.ends_well() {
            return [f64::INFINITY; 2];
        }
        [own + self.space.as_ref().map_or(0.0, |space| space.value(rows, self.points)), length]
    }

    /// What an element costs by its rows; infinite outside the domain. A start is judged without torsion.
    pub(super) fn cost_of_rows(&self, element: usize, rows: &[SVector<f64, D>; 6]) -> f64 {
        if self.space.is_some() {
            return Model { space: None, weights: Weights::VARIATION, ..*self }.sums_of_rows(element, rows)
                [0];
        }
        self.sums_of_rows(element, rows)[0]
    }

    /// The combination of an element's two sums by these weights, with derivatives.
    fn linearised(
        &self,
        element: usize,
        ends: &[End<D>; 2],
        state: &[f64],
        first: [f64; 2],
    ) -> RowDerivatives<D> {
        let rows = rows_between(ends);
        let mut by_rows = self.combined(element, first).derivatives(&rows);
        if let Some(space) = &self.space {
            space.add(&rows, self.points, first[0], &mut by_rows);
            for end in 0..2 {
                if let Some([weight, target]) = self.tie(element, end, state) {
                    space.add_tie(&rows, end, weight * first[0], target, &mut by_rows);
                }
            }
        }
        by_rows
    }
}

impl<const D: usize> Problem for Model<'_, D>
where
    Shape<D>: Density<D>,
{
    fn blocks(&self) -> usize {
        self.node_count() + self.element_count()
    }

    fn dofs(&self, block: usize) -> usize {
        let mut count = 0;
        if block < self.node_count() {
            self.node_coordinates(block, |_| count += 1);
        } else {
            self.element_coordinates(block - self.node_count(), |_, _| count += 1);
        }
        count
    }

    fn state_range(&self, block: usize) -> Range<usize> {
        let nodes = self.node_count();
        if block < nodes {
            Self::node_start(block)..Self::node_start(block + 1)
        } else {
            self.element_start(block - nodes)..self.element_start(block - nodes + 1)
        }
    }

    fn state_len(&self) -> usize {
        self.element_start(self.element_count())
    }

    fn elements(&self) -> usize {
        self.element_count()
    }

    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        for block in [self.node(element, 0), self.node_count() + element, self.node(element, 1)] {
            let _ = blocks.push(block);
        }
    }

    fn max_element_dofs(&self) -> usize {
        (0..self.element_count()).map(|element| self.local_coordinates(element).len()).max().unwrap_or(0)
    }

    fn envelope_bound(&self) -> usize {
        // A row reaches back over one element and one node at most; in a ring the last node's reach back to the first.
        let (mut widest_node, mut widest_element, mut unknowns) = (0, 0, 0);
        for block in 0..self.blocks() {
            let dofs = self.dofs(block);
            unknowns += dofs;
            let widest = if block < self.node_count() { &mut widest_node } else { &mut widest_element };
            *widest = dofs.max(*widest);
        }
        let reach = widest_node + widest_element + widest_node.max(widest_element);
        let across = if self.curve.closed { widest_node } else { 0 };
        unknowns * (reach + across).min(unknowns)
    }

    fn block_at(&self, place: usize) -> Option<usize> {
        let nodes = self.node_count();
        Some(if self.curve.closed {
            // Cut open at the first node, which comes last: its rows alone are long then.
            let element = place / 2;
            if place.is_multiple_of(2) {
                nodes + element
            } else if element + 1 == nodes {
                0
            } else {
                element + 1
            }
        } else if place.is_multiple_of(2) {
            place / 2
        } else {
            nodes + place / 2
        })
    }

    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        self.sums(element, state)[0]
    }

    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        self.linearise_sums(element, state, [1.0, 0.0], gradient, &mut [], matrix)[0]
    }

    fn is_coupled(&self) -> bool {
        self.functional.length_power() != 0 || self.goal.is_some()
    }

    fn is_cautious(&self) -> bool {
        self.goal.is_some_and(|goal| goal.multiplier == 0.0)
    }

    fn couple(&self, sums: [f64; 2]) -> Coupled {
        let [own, length] = sums;
        if let Some(Goal { target, multiplier, penalty }) = self.goal {
            // At a given length the scale-invariant functionals are a constant times the plain ones.
            let off = length - target;
            return Coupled {
                value: own + off * (multiplier + 0.5 * penalty * off),
                first: [1.0, multiplier + penalty * off],
                second: [[0.0, 0.0], [0.0, penalty]],
            };
        }
        match self.functional.length_power() {
            0 => Coupled::plain(sums),
            1 => Coupled { value: own * length, first: [length, own], second: [[0.0, 1.0], [1.0, 0.0]] },
            _ => {
                let (square, mixed) = (length * length, 3.0 * length * length);
                Coupled {
                    value: own * square * length,
                    first: [square * length, own * mixed],
                    second: [[0.0, mixed], [mixed, 6.0 * own * length]],
                }
            }
        }
    }

    fn sums(&self, element: usize, state: &[f64]) -> [f64; 2] {
        let ends = [self.end(element, 0, state), self.end(element, 1, state)];
        if !is_faster(&ends, LEAST_SPEED) {
            return [f64::INFINITY; 2];
        }
        let rows = rows_between(&ends);
        let mut sums = self.sums_of_rows(element, &rows);
        if let Some(space) = &self.space {
            for end in 0..2 {
                if let Some([weight, target]) = self.tie(element, end, state) {
                    let off = space.torsion(&rows, end) - target;
                    sums[0] += weight * off * off;
                }
            }
        }
        sums
    }

    fn linearise_sums(
        &self,
        element: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> [f64; 2] {
        let ends = [self.end(element, 0, state), self.end(element, 1, state)];
        let by_rows = self.linearised(element, &ends, state, first);
        let list = self.local_coordinates(element);
        self.by_unknowns(element, &ends, &list, &by_rows, gradient, second, matrix);
        plain_sums(&by_rows, first)
    }

    fn linearise_own(
        &self,
        element: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> Option<[f64; 2]> {
        let ends = [self.end(element, 0, state), self.end(element, 1, state)];
        let by_rows = self.linearised(element, &ends, state, first);
        // The ends of an open curve belong to one element too.
        let mut list = Coordinates::new();
        if !self.curve.closed && element == 0 {
            self.node_coordinates(0, |coordinate| {
                let _ = list.push((0, coordinate));
            });
        }
        self.element_coordinates(element, |end, coordinate| {
            let _ = list.push((end, coordinate));
        });
        if !self.curve.closed && element + 1 == self.element_count() {
            self.node_coordinates(element + 1, |coordinate| {
                let _ = list.push((1, coordinate));
            });
        }
        self.by_unknowns(element, &ends, &list, &by_rows, gradient, second, matrix);
        Some(plain_sums(&by_rows, first))
    }

    fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to.copy(from);
        let mut steps = step.iter();
        let mut next = || steps.next().copied().unwrap_or(0.0);
        let nodes = self.node_count();
        if block < nodes {
            let (point, side) = to.cut_mut(D);
            let mut turn = SideStep::<D>::default();
            let mut slide = 0.0;
            self.node_coordinates(block, |coordinate| match coordinate {
                Coordinate::Point(d) => {
                    let step = next();
                    point.add(d, step);
                    slide += step * side.at(d);
                }
                Coordinate::Along(k) => {
                    let (step, guide) = (next(), self.guide(block, k));
                    for d in 0..D {
                        point.add(d, step * guide[d]);
                    }
                }
                Coordinate::Across(j) => {
                    let step = next();
                    for d in 0..D {
                        point.add(d, step * side.at(D * (j + 1) + d));
                    }
                }
                Coordinate::Torsion => side.add(side_len(D), next()),
                _ => turn.note(coordinate, next()),
            });
            if slide != 0.0 {
                for d in 0..D {
                    for j in 1..D {
                        let curvature = side.at(D * D + j - 1) * side.at(D * j + d);
                        point.add(d, 0.5 * slide * slide * curvature);
                    }
                }
            }
            turn.apply(side);
            if let Some(Contact::Around { point: centre, left }) = self.contact(block) {
                for d in 0..D {
                    point.put(d, centre[d] - left * side.at(D + d));
                }
            }
        } else {
            let (scalars, sides) = to.cut_mut(4);
            let (first, second) = sides.cut_mut(side_len(D));
            let mut turns = [SideStep::<D>::default(); 2];
            self.element_coordinates(block - nodes, |end, coordinate| match coordinate {
                Coordinate::Speed => scalars.add(2 * end, next()),
                Coordinate::Stretch => scalars.add(2 * end + 1, next()),
                _ => turns[end].note(coordinate, next()),
            });
            turns[0].apply(first);
            turns[1].apply(second);
        }
    }

    fn is_loose(&self, block: usize) -> bool {
        if block >= self.node_count() || self.joint(block).is_none() || !self.is_inside(block) {
            return false;
        }
        // What torsion asks of a joint its own elements cannot tell.
        let Freedom { point, tangent, curvature } = self.freedom(block, 0);
        let free = point == PointFreedom::Free && tangent && curvature == CurvatureFreedom::Free;
        free && self.space.is_none()
    }

    fn most_loose_dofs(&self) -> usize {
        let nodes = self.node_count();
        let mut most = 0;
        for node in (0..nodes).filter(|&node| self.is_loose(node)) {
            // The elements on either side, and the end of an open curve behind one of them.
            let before = if node > 0 { node - 1 } else { self.element_count() - 1 };
            let around = [node, nodes + before, nodes + node, before, self.node(node, 1)];
            most = most.max(around.into_iter().map(|block| self.dofs(block)).sum());
        }
        most
    }

    fn held(&self, block: usize) -> usize {
        if self.slides && block < self.node_count() && self.is_anchor(block) { D } else { 0 }
    }

    fn variants(&self) -> usize {
        let few = matches!(self.division, Division::Even(1..=3));
        let explores = self.space.is_none_or(|space| space.explores);
        if self.gauge == 0.0 && few && explores && !self.fitted { SKEWS.len() } else { 0 }
    }

    fn vary(&self, element: usize, variant: usize, state: &mut [f64]) {
        // A quintic fits most shapes about as well when it runs through them faster at one end or at the other: its
        // minima differ in this skew. They are looked for from either side of an even speed.
        let skew = SKEWS.at(variant);
        let at = self.element_start(element);
        let faster = libm::exp(skew);
        let even = 0.5 * (state.at(at) + state.at(at + 2));
        let scalars =
            [even * faster, -2.0 * skew * even * faster, even / faster, -2.0 * skew * even / faster];
        state.part_mut(at..at + 4).copy(&scalars);
    }

    fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
        let nodes = self.node_count();
        let mut sizes = sizes.iter_mut();
        let mut put = |coordinate: Coordinate, length: f64| {
            if let Some(size) = sizes.next() {
                *size = match coordinate {
                    Coordinate::Point(_)
                    | Coordinate::Along(_)
                    | Coordinate::Across(_)
                    | Coordinate::Speed
                    | Coordinate::Stretch => length,
                    Coordinate::Tangent(_) | Coordinate::Roll(_) | Coordinate::Turn => 1.0,
                    Coordinate::Curvature(_) | Coordinate::Torsion => 1.0 / length,
                };
            }
        };
        let speed = |element: usize, end: usize| state.at(self.element_start(element) + 2 * end);
        if block < nodes {
            let before = if block > 0 { Some(block - 1) } else { self.element_count().checked_sub(1) };
            let before = before.filter(|_| block > 0 || self.curve.closed);
            let after = Some(block).filter(|&element| element < self.element_count());
            let length = match (before, after) {
                (Some(before), Some(after)) => speed(before, 1).smaller(speed(after, 0)),
                (Some(before), None) => speed(before, 1),
                (None, Some(after)) => speed(after, 0),
                (None, None) => 1.0,
            };
            self.node_coordinates(block, |coordinate| put(coordinate, length));
        } else {
            let element = block - nodes;
            self.element_coordinates(element, |end, coordinate| put(coordinate, speed(element, end)));
        }
    }

    fn natural_cost(&self) -> f64 {
        // With a given length the plain integral is minimised.
        if self.goal.is_some() {
            return self.natural_cost;
        }
        self.couple([self.natural_cost, self.start_length]).value
    }

    fn runs_away(&self, state: &[f64]) -> bool {
        self.rough_length(state) > RUNAWAY * self.start_length
    }
}

/// The two sums of an element from their combination.
fn plain_sums<const D: usize>(by_rows: &RowDerivatives<D>, first: [f64; 2]) -> [f64; 2] {
    let own = if first[1] == 0.0 { by_rows.cost } else { by_rows.cost - first[1] * by_rows.length };
    [if first[0] == 1.0 { own } else { own / first[0] }, by_rows.length]
}

/// Whether both ends of an element are faster than this fraction of its chord.
fn is_faster<const D: usize>(ends: &[End<D>; 2], fraction: f64) -> bool {
    let chord = ends[1].point - ends[0].point;
    let least = fraction * sqrt(chord.dot(&chord));
    ends.iter().all(|end| end.speed > least)
}

/// The logarithms of the speed ratio between an element's first end and its middle in the starts that are tried.
const SKEWS: [f64; 3] = [0.15, -0.15, 0.0];
/// The least speed at an end of an element, as a fraction of its chord: a quintic that nearly stops there is a bend of the
/// parametrisation, not of the curve.
const LEAST_SPEED: f64 = 0.02;
/// Speeds up to so many times the least are kept by that bound.
const SLOW: f64 = 1.01;
/// A curve that became longer than its start by this factor grows without limit.
const RUNAWAY: f64 = 100.0;

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::curve::functional::Functional;
    use crate::curve::joint::Quantity;
    use crate::curve::options::Options;
    use crate::curve::tests::{planar, spatial, started};
    use std::vec;

    /// A free point that slides along its curve follows the osculating parabola; beside the curve it goes straight.
    fn slides<const D: usize>(model: &Model<'_, D>)
    where
        Shape<D>: Density<D>,
    {
        let state = started(model);
        for node in 0..model.node_count() {
            let (element, end) = if node == model.element_count() { (node - 1, 1) } else { (node, 0) };
            let was = model.end(element, end, &state);
            let curvature = was.curvature_vector();
            assert!(node == 0 || node == model.element_count() || curvature.amax() > 0.1, "{node}");
            let range = model.state_range(node);
            let step: SVector<f64, D> = SVector::from_fn(|d, _| 0.3 - 0.2 * d as f64);
            let mut all = vec![0.0; model.dofs(node)];
            all[..D].copy_from_slice(step.as_slice());
            let mut moved = state.clone();
            model.retract(node, &state[range.clone()], &all, &mut moved[range]);
            let is = model.end(element, end, &moved);
            let slide = step.dot(&was.frame[0]);
            let wanted = was.point + step + curvature * (0.5 * slide * slide);
            assert!((is.point - wanted).amax() < 1e-14, "{node}: {} {wanted}", is.point);
            assert!(is.frame == was.frame && is.curvature == was.curvature);
        }
    }

    const POINTS: [[f64; 3]; 5] =
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.5, 0.0], [2.5, -1.0, 0.0], [1.0, -2.0, 0.0]];

    /// Each kind of position at each node of an open and a closed curve, while joints stay and while they slide.
    #[test]
    fn a_point_is_free_as_its_joint_says_and_slides_only_inside_a_smooth_curve() {
        use PointFreedom::{Across, Fixed, Free, Line, Plane};
        let along = [1.0, 2.0, 0.0];
        let options = Options { functional: Functional::SI_MVC, ..Options::DEFAULT };
        let initial = POINTS.map(|point| Joint::at(point).with_position(Quantity::initial(point)));
        for closed in [false, true] {
            for at in 0..5 {
                let inside = closed || (1..4).contains(&at);
                let loose = initial[at];
                for (joint, stays, slides) in [
                    (Joint::at(POINTS[at]), Fixed, Fixed),
                    (loose.on_line(POINTS[at], along), Line, Line),
                    // The plane of the curve leaves it to itself, another one cuts it in a line.
                    (loose.on_plane(POINTS[at], along), Line, Line),
                    (loose.on_plane(POINTS[at], [0.0, 0.0, 1.0]), if inside { Across } else { Free }, Free),
                    (loose, if inside { Across } else { Free }, Free),
                    (loose.with_position(Quantity::FREE), if inside { Across } else { Free }, Free),
                    (loose.with_continuity(Continuity::G1), Free, Free),
                    (loose.with_continuity(Continuity::G0), Free, Free),
                ] {
                    let mut joints = initial;
                    joints[at] = joint;
                    let curve = Curve::new(&joints, closed);
                    let plane = planar(&curve, &options);
                    let of = |model: &Model<'_, 2>| model.freedom(at, 0).point;
                    let case = (closed, at, joint);
                    assert_eq!(of(&Model { slides: false, ..plane }), stays, "{case:?}");
                    assert_eq!(of(&Model { slides: true, ..plane }), slides, "{case:?}");
                    // What stands for the whole curve stands, unless it slides.
                    let other = (at + 1) % 5;
                    let held = Model { slides: false, anchors: Some([other, at]), ..plane };
                    let kept = if matches!(stays, Line) { Line } else { Fixed };
                    assert_eq!(
                        held.freedom(at, 1),
                        Freedom { point: kept, tangent: false, ..held.freedom(at, 1) }
                    );
                    let held = Model { slides: true, ..held };
                    assert_eq!((of(&held), held.freedom(at, 1).tangent), (slides, true), "{case:?}");
                    let beside = Model { slides: false, anchors: Some([other; 2]), ..plane };
                    assert_eq!((of(&beside), beside.freedom(at, 1).tangent), (stays, true), "{case:?}");
                }
            }
        }
        let mut deep = initial;
        deep[1] = deep[1].on_plane(POINTS[1], along);
        deep[2].position.value[2] = 0.8;
        let curve = Curve::open(&deep);
        assert_eq!(spatial(&curve, &options).freedom(1, 0).point, Plane);
        // A node between two joints is free, and across the curve alone where torsion is known.
        let two = Options { elements_per_span: 2, ..options };
        let whole = Freedom { point: Free, tangent: true, curvature: CurvatureFreedom::Free };
        assert_eq!(spatial(&curve, &two).freedom(3, 1), whole);
        let two = Options { functional: Functional::SPACE_MVC, ..two };
        assert_eq!(spatial(&curve, &two).freedom(3, 1), Freedom { point: Across, ..whole });
    }

    /// The kinds of tangent and curvature, on either side.
    #[test]
    fn a_curvature_is_free_fixed_or_turns_about_its_tangent() {
        use CurvatureFreedom::{Fixed, Free, Turns};
        let (along, bend) = ([1.0, 2.0, 0.0], [0.2, -0.1, 0.0]);
        let (fixed, of_size) = (Quantity::fixed, Quantity::of_size);
        for (given, tangent, flat, deep) in [
            (Quantity::FREE, Quantity::FREE, Free, Free),
            (Quantity::initial(bend), Quantity::FREE, Free, Free),
            (Quantity::initial(bend), fixed(along), Free, Free),
            // A vector that is given with its tangent stands; with a free one it turns with it.
            (fixed(bend), fixed(along), Fixed, Fixed),
            (fixed(bend), Quantity::FREE, Fixed, Turns),
            (of_size(bend), fixed(along), Fixed, Turns),
            (of_size(bend), Quantity::initial(along), Fixed, Turns),
            // What is straight has no direction to turn.
            (fixed([0.0; 3]), Quantity::FREE, Fixed, Fixed),
            (of_size([0.0; 3]), fixed(along), Fixed, Fixed),
        ] {
            for side in 0..2 {
                let mut joints = POINTS.map(Joint::at);
                joints[2] = joints[2].with_continuity(Continuity::G0);
                joints[2].tangent[side] = tangent;
                joints[2].curvature[side] = given;
                let wanted = tangent.given != Given::FIXED;
                let of = |freedom: Freedom| (freedom.tangent, freedom.curvature);
                let curve = Curve::open(&joints);
                let plane = planar(&curve, &Options::DEFAULT);
                assert_eq!(of(plane.freedom(2, side)), (wanted, flat), "{given:?} {tangent:?}");
                assert_eq!(of(plane.freedom(2, 1 - side)), (true, Free), "{given:?} {tangent:?}");
                joints[4].position.value[2] = 0.8;
                let curve = Curve::open(&joints);
                let space = spatial(&curve, &Options::DEFAULT);
                assert_eq!(of(space.freedom(2, side)), (wanted, deep), "{given:?} {tangent:?}");
            }
        }
    }

    #[test]
    fn a_curve_runs_away_that_is_a_hundred_times_as_long_as_at_its_start() {
        let joints = POINTS.map(Joint::at);
        let mut model = planar(&Curve::open(&joints), &Options::DEFAULT);
        let state = started(&model);
        let length = model.rough_length(&state);
        for (times, away) in [(1.0, false), (99.0, false), (101.0, true)] {
            model.start_length = length / times;
            assert_eq!(model.runs_away(&state), away, "{times}");
        }
    }

    #[test]
    fn a_free_point_slides_along_its_osculating_parabola() {
        let joints = POINTS.map(|point| Joint::at(point).with_position(Quantity::initial(point)));
        let curve = Curve::open(&joints);
        slides(&planar(&curve, &Options::DEFAULT));
        let mut deep = joints;
        deep[2].position.value[2] = 0.8;
        let curve = Curve::open(&deep);
        slides(&spatial(&curve, &Options::DEFAULT));
    }
}
