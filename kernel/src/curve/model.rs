//! A curve as the solver's problem: nodes and elements as blocks of unknowns (thesis 4.5, Fig. 4.4).
//!
//! A *node* is a joint, or one of the free G2 points between joints that more than one element a span brings
//! (4.6). Its block holds position, frame (unit tangent and normals) and curvature components in the frame; an
//! *element*'s block holds the scalars of its two ends, and what a G1 or G0 joint does not share. What an end is made
//! of, and how it moves, [`super::end`] knows; what an element costs, [`super::rows`].

use super::end::{Coordinate, End, SideStep, row_of, rows_between};
use super::fairness::{Dimension, Exterior, Functional, density, evenness};
use super::joint::{Continuity, Curve, Given, Joint};
use super::rows::{derivatives, row_derivatives};
use crate::basis::hermite;
use crate::basis::quadrature::Rule;
use crate::solve::{BlockList, Problem, packed};
use core::ops::Range;
use nalgebra::SVector;

/// Numbers of the state that describe a frame and curvature components.
const fn side_len(d: usize) -> usize {
    d * d + d
}

/// The most local unknowns of an element in space, 9 an end.
const MOST_LOCAL: usize = 18;

type Coordinates = heapless::Vec<(usize, Coordinate), MOST_LOCAL>;

/// A node's or a side's freedoms.
#[derive(Clone, Copy)]
struct Freedom {
    point: bool,
    tangent: bool,
    curvature: CurvatureFreedom,
}

#[derive(Clone, Copy, PartialEq)]
enum CurvatureFreedom {
    Fixed,
    Turns,
    Free,
}

/// A curve in its local system.
#[derive(Clone, Copy)]
pub(super) struct Model<'a, const D: usize> {
    pub(super) curve: Curve<'a>,
    pub(super) per_span: usize,
    pub(super) functional: Functional,
    pub(super) rule: Rule,
    /// Weight of the evenness of the parametrisation.
    pub(super) gauge: f64,
    /// Whether a curve that turns by more than a right angle between two points of the rule is outside the domain:
    /// it would have a cusp there that the rule does not see.
    pub(super) guarded: bool,
    /// See [`Problem::natural_cost`].
    pub(super) natural_cost: f64,
    /// Half the sum of all speeds at the start: about the curve's length.
    pub(super) start_length: f64,
}

impl<const D: usize> Model<'_, D> {
    pub(super) fn element_count(&self) -> usize {
        self.curve.spans() * self.per_span
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
        if node.is_multiple_of(self.per_span) { self.curve.joints.get(node / self.per_span) } else { None }
    }

    fn node_start(node: usize) -> usize {
        node * (D + side_len(D))
    }

    /// Where in the state a node's point stands.
    pub(super) fn point_place(node: usize) -> usize {
        Self::node_start(node)
    }

    fn element_start(&self, element: usize) -> usize {
        self.node_count() * (D + side_len(D)) + element * (4 + 2 * side_len(D))
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

    /// What is free at a side of a node; side 0 arrives, side 1 leaves.
    fn freedom(&self, node: usize, side: usize) -> Freedom {
        let Some(joint) = self.joint(node) else {
            return Freedom { point: true, tangent: true, curvature: CurvatureFreedom::Free };
        };
        let tangent = joint.tangent[side].given != Given::FIXED;
        let fixed = &joint.curvature[side];
        let curvature = if fixed.given != Given::FIXED {
            CurvatureFreedom::Free
        } else if tangent && D == 3 && fixed.value != [0.0; 3] {
            CurvatureFreedom::Turns
        } else {
            CurvatureFreedom::Fixed
        };
        Freedom { point: joint.position.given != Given::FIXED, tangent, curvature }
    }

    /// Calls `visit` with the coordinates that are unknowns of a node, in the order of its dofs.
    fn node_coordinates(&self, node: usize, mut visit: impl FnMut(Coordinate)) {
        let freedom = self.freedom(node, 0);
        let continuity = self.continuity(node);
        if freedom.point {
            (0..D).for_each(|d| visit(Coordinate::Point(d)));
        }
        if continuity != Continuity::G0 && freedom.tangent {
            (0..D - 1).for_each(|j| visit(Coordinate::Tangent(j)));
        }
        if continuity == Continuity::G2 {
            Self::curvature_coordinates(freedom.curvature, &mut visit);
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
            point: SVector::from_fn(|d, _| state[node + d]),
            frame: core::array::from_fn(|j| SVector::from_fn(|d, _| state[frame + D * j + d])),
            curvature: core::array::from_fn(|j| state[curvature + j]),
            speed: state[scalars],
            stretch: state[scalars + 1],
        }
    }

    /// Writes an end of an element into the state. What both elements at a node share is the same in both calls.
    pub(super) fn set_end(&self, element: usize, end: usize, value: &End<D>, state: &mut [f64]) {
        let node = Self::node_start(self.node(element, end));
        let (frame, curvature) = self.side_places(element, end);
        let scalars = self.element_start(element) + 2 * end;
        for d in 0..D {
            state[node + d] = value.point[d];
            for j in 0..D {
                state[frame + D * j + d] = value.frame[j][d];
            }
            state[curvature + d] = value.curvature[d];
        }
        state[scalars] = value.speed;
        state[scalars + 1] = value.stretch;
    }

    /// The six Hermite rows of an element in the local system.
    pub(super) fn rows(&self, element: usize, state: &[f64]) -> [SVector<f64, D>; 6] {
        rows_between(&[self.end(element, 0, state), self.end(element, 1, state)])
    }

    /// Half the sum of the speeds: about the length, and cheap.
    pub(super) fn rough_length(&self, state: &[f64]) -> f64 {
        let mut sum = 0.0;
        for element in 0..self.element_count() {
            let at = self.element_start(element);
            sum += 0.5 * (state[at] + state[at + 2]);
        }
        sum
    }
}

impl<const D: usize> Model<'_, D>
where
    Dimension<D>: Exterior<D>,
{
    /// What an element costs by its rows; infinite outside the domain.
    pub(super) fn cost_of_rows(&self, rows: &[SVector<f64, D>; 6]) -> f64 {
        let mut sum = 0.0;
        let mut before: Option<SVector<f64, D>> = None;
        for (t, weight) in self.rule.iter() {
            let d = derivatives(rows, &hermite::basis(t));
            if self.guarded && before.is_some_and(|before| !(before.dot(&d[0]) > 0.0)) {
                return f64::INFINITY;
            }
            before = Some(d[0]);
            sum += weight * density(self.functional, &d);
            if self.gauge > 0.0 {
                sum += weight * self.gauge * evenness(&d);
            }
        }
        sum
    }
}

impl<const D: usize> Problem for Model<'_, D>
where
    Dimension<D>: Exterior<D>,
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
        // In a chain a row reaches back over one element and one node at most, in a ring over two of each.
        let (mut widest_node, mut widest_element, mut unknowns) = (0, 0, 0);
        for block in 0..self.blocks() {
            let dofs = self.dofs(block);
            unknowns += dofs;
            let widest = if block < self.node_count() { &mut widest_node } else { &mut widest_element };
            *widest = dofs.max(*widest);
        }
        let ways = if self.curve.closed { 2 } else { 1 };
        let reach = ways * (widest_node + widest_element) + widest_node.max(widest_element);
        unknowns * reach.min(unknowns)
    }

    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let ends = [self.end(element, 0, state), self.end(element, 1, state)];
        let chord = ends[1].point - ends[0].point;
        let least = LEAST_SPEED * libm::sqrt(chord.dot(&chord));
        if !ends.iter().all(|end| end.speed > least) {
            return f64::INFINITY;
        }
        self.cost_of_rows(&self.rows(element, state))
    }

    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let ends = [self.end(element, 0, state), self.end(element, 1, state)];
        let by_rows = row_derivatives(self.functional, self.gauge, &self.rule, &self.rows(element, state));
        let list = self.local_coordinates(element);
        let block = |a: usize, b: usize| {
            if a >= b { by_rows.hessian[a][b] } else { by_rows.hessian[b][a].transpose() }
        };
        for (i, &(end, one)) in list.iter().enumerate() {
            let map = ends[end].tangent_map(one);
            let mut slope = 0.0;
            for order in 0..3 {
                slope += map[order].dot(&by_rows.gradient[row_of(end, order)]);
            }
            gradient[i] = slope;
            // The Hessian times this direction, by rows.
            let along: [SVector<f64, D>; 6] = core::array::from_fn(|a| {
                let mut sum = SVector::zeros();
                for order in 0..3 {
                    sum += block(a, row_of(end, order)) * map[order];
                }
                sum
            });
            for (j, &(other_end, other)) in list.iter().enumerate().take(i + 1) {
                let other_map = ends[other_end].tangent_map(other);
                let mut sum = 0.0;
                for order in 0..3 {
                    sum += other_map[order].dot(&along[row_of(other_end, order)]);
                }
                if end == other_end {
                    let point = by_rows.gradient[row_of(end, 0)];
                    let first = by_rows.gradient[row_of(end, 1)];
                    let second = by_rows.gradient[row_of(end, 2)];
                    sum += ends[end].second_map(one, other, &point, &first, &second);
                }
                matrix[packed(i, j)] = sum;
            }
        }
        by_rows.cost
    }

    fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to.copy_from_slice(from);
        let mut steps = step.iter();
        let mut next = || steps.next().copied().unwrap_or(0.0);
        let nodes = self.node_count();
        if block < nodes {
            let (point, side) = to.split_at_mut(D);
            let mut turn = SideStep::<D>::default();
            let mut slide = 0.0;
            self.node_coordinates(block, |coordinate| match coordinate {
                Coordinate::Point(d) => {
                    let step = next();
                    point[d] += step;
                    slide += step * side[d];
                }
                _ => turn.note(coordinate, next()),
            });
            if slide != 0.0 {
                for d in 0..D {
                    for j in 1..D {
                        let curvature = side[D * D + j - 1] * side[D * j + d];
                        point[d] += 0.5 * slide * slide * curvature;
                    }
                }
            }
            turn.apply(side);
        } else {
            let (scalars, sides) = to.split_at_mut(4);
            let (first, second) = sides.split_at_mut(side_len(D));
            let mut turns = [SideStep::<D>::default(); 2];
            self.element_coordinates(block - nodes, |end, coordinate| match coordinate {
                Coordinate::Speed => scalars[2 * end] += next(),
                Coordinate::Stretch => scalars[2 * end + 1] += next(),
                _ => turns[end].note(coordinate, next()),
            });
            turns[0].apply(first);
            turns[1].apply(second);
        }
    }

    fn variants(&self) -> usize {
        if self.gauge > 0.0 || self.per_span > 3 { 0 } else { SKEWS.len() }
    }

    fn vary(&self, element: usize, variant: usize, state: &mut [f64]) {
        // A quintic fits most shapes about as well when it runs through them faster at one end or at the other: its
        // minima differ in this skew. They are looked for from either side of an even speed.
        let skew = SKEWS[variant];
        let at = self.element_start(element);
        let faster = libm::exp(skew);
        let even = 0.5 * (state[at] + state[at + 2]);
        state[at] = even * faster;
        state[at + 1] = -2.0 * skew * even * faster;
        state[at + 2] = even / faster;
        state[at + 3] = -2.0 * skew * even / faster;
    }

    fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
        let nodes = self.node_count();
        let mut sizes = sizes.iter_mut();
        let mut put = |coordinate: Coordinate, length: f64| {
            if let Some(size) = sizes.next() {
                *size = match coordinate {
                    Coordinate::Point(_) | Coordinate::Speed | Coordinate::Stretch => length,
                    Coordinate::Tangent(_) | Coordinate::Turn => 1.0,
                    Coordinate::Curvature(_) => 1.0 / length,
                };
            }
        };
        let speed = |element: usize, end: usize| state[self.element_start(element) + 2 * end];
        if block < nodes {
            let before = if block > 0 { Some(block - 1) } else { self.element_count().checked_sub(1) };
            let before = before.filter(|_| block > 0 || self.curve.closed);
            let after = Some(block).filter(|&element| element < self.element_count());
            let length = match (before, after) {
                (Some(before), Some(after)) => speed(before, 1).min(speed(after, 0)),
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
        self.natural_cost
    }

    fn runs_away(&self, state: &[f64]) -> bool {
        self.rough_length(state) > RUNAWAY * self.start_length
    }
}

/// The logarithms of the speed ratio between an element's first end and its middle in the starts that are tried.
const SKEWS: [f64; 2] = [0.15, -0.15];
/// The least speed at an end of an element, as a fraction of its chord: a quintic that nearly stops there is a bend of the
/// parametrisation, not of the curve.
const LEAST_SPEED: f64 = 0.02;
/// A curve that became longer than its start by this factor grows without limit.
const RUNAWAY: f64 = 100.0;
