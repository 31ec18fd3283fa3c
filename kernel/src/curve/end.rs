//! An end of an element: what its rows are made of, how they change with each unknown, and how a step moves it.
//!
//! ```text
//! P = p      P' = v t      P'' = v² κ + β t      κ = k₁ n₁ + k₂ n₂
//! ```
//!
//! which is the thesis's (4.7) and (4.8) with `v` for `m²` and `β` for `α m²`: the same curves, but linear in `v`
//! and `β`, which lets Newton's method take far longer steps. `v > 0` is the domain. The frame turns with its
//! tangent without twist, so the components `k` go on meaning the same while the tangent moves. A point that moves
//! along its tangent follows the osculating parabola `p + s t + ½ s² κ`: a free node may slide along the curve without
//! changing it, and a straight step would leave it.

use crate::root::sqrt;
use crate::total::Total;
use core::ops::Range;
use nalgebra::SVector;

/// One end of an element: what the rows `P, P', P''` are made of.
#[derive(Clone, Copy)]
pub(super) struct End<const D: usize> {
    pub(super) point: SVector<f64, D>,
    /// Row 0 is the tangent, the others are normals.
    pub(super) frame: [SVector<f64, D>; D],
    /// Curvature components along the normals; the last entry is unused.
    pub(super) curvature: [f64; D],
    /// `|C'|`.
    pub(super) speed: f64,
    /// The tangential part `β` of `C''`.
    pub(super) stretch: f64,
}

impl<const D: usize> End<D> {
    pub(super) fn curvature_vector(&self) -> SVector<f64, D> {
        let mut sum = SVector::zeros();
        for j in 1..D {
            sum += self.frame[j] * self.curvature[j - 1];
        }
        sum
    }

    /// The normal `j`, from 0.
    fn normal(&self, j: usize) -> SVector<f64, D> {
        self.frame.get(j + 1).copied().unwrap_or_else(SVector::zeros)
    }

    /// `P, P', P''`.
    pub(super) fn rows(&self) -> [SVector<f64, D>; 3] {
        let tangent = self.frame[0];
        [
            self.point,
            tangent * self.speed,
            self.curvature_vector() * (self.speed * self.speed) + tangent * self.stretch,
        ]
    }
}

/// The six Hermite rows of an element between two ends.
pub(super) fn rows_between<const D: usize>(ends: &[End<D>; 2]) -> [SVector<f64, D>; 6] {
    let [p0, v0, a0] = ends[0].rows();
    let [p1, v1, a1] = ends[1].rows();
    [p0, v0, a0, a1, v1, p1]
}

/// Where among `chord, C'(0), C''(0), C''(1), C'(1)` the `order`-th derivative at an end stands.
#[inline]
pub(super) const fn row_of(end: usize, order: usize) -> usize {
    if end == 0 || order == 0 { order } else { 5 - order }
}

impl Coordinate {
    /// The derivatives `P, P', P''` that a coordinate moves, by order.
    #[inline]
    pub(super) const fn orders(self) -> Range<usize> {
        match self {
            Self::Point(_) | Self::Along(_) | Self::Across(_) => 0..1,
            Self::Roll(_) => 0..3,
            Self::Tangent(_) | Self::Speed => 1..3,
            Self::Curvature(_) | Self::Turn | Self::Stretch => 2..3,
            Self::Torsion => 0..0,
        }
    }
}

/// A coordinate of an end in the order `p (D), tangent (D − 1), curvature (D − 1), v, β`; or the turn of a
/// curvature of fixed size about its tangent.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Coordinate {
    Point(usize),
    /// The motion along the `k`-th direction in which a joint slides, which the end does not know.
    Along(usize),
    /// The turn of a tangent whose point rolls along with it around a centre that lies at this distance to the left (to the
    /// right if it is negative); the plane only.
    Roll(f64),
    /// The motion along a normal: of a point that does not slide along its curve.
    Across(usize),
    Tangent(usize),
    Curvature(usize),
    Turn,
    /// The torsion of a node, which the end does not know.
    Torsion,
    Speed,
    Stretch,
}

impl<const D: usize> End<D> {
    /// The derivative of the curvature vector by its turn about the tangent; space only.
    fn turned(&self) -> SVector<f64, D> {
        self.frame[D - 1] * self.curvature[0] - self.frame[1] * self.curvature[1]
    }

    /// The derivatives of `P, P', P''` by a coordinate.
    pub(super) fn tangent_map(&self, coordinate: Coordinate) -> [SVector<f64, D>; 3] {
        let zero = SVector::zeros();
        let (tangent, speed) = (self.frame[0], self.speed);
        match coordinate {
            Coordinate::Point(d) => [SVector::from_fn(|x, _| if x == d { 1.0 } else { 0.0 }), zero, zero],
            Coordinate::Along(_) | Coordinate::Torsion => [zero; 3],
            Coordinate::Across(j) => [self.normal(j), zero, zero],
            Coordinate::Roll(centre) => {
                let [_, first, second] = self.turn_map(0);
                [tangent * centre, first, second]
            }
            Coordinate::Tangent(j) => self.turn_map(j),
            Coordinate::Curvature(j) => [zero, zero, self.normal(j) * (speed * speed)],
            Coordinate::Turn => [zero, zero, self.turned() * (speed * speed)],
            Coordinate::Speed => [zero, tangent, self.curvature_vector() * (2.0 * speed)],
            Coordinate::Stretch => [zero, zero, tangent],
        }
    }

    /// The derivatives by the tangent's turn towards a normal.
    fn turn_map(&self, j: usize) -> [SVector<f64, D>; 3] {
        let (normal, speed) = (self.normal(j), self.speed);
        let bend = normal * self.stretch - self.frame[0] * (speed * speed * self.curvature.at(j));
        [SVector::zeros(), normal * speed, bend]
    }

    /// The second derivative by two coordinates of `point·P + first·P' + second·P''`.
    ///
    /// A tangent turns by `t(ω) = t cos|ω| + (ω/|ω|) sin|ω|`, its normals with it without twist.
    pub(super) fn second_map(
        &self,
        one: Coordinate,
        other: Coordinate,
        point: &SVector<f64, D>,
        first: &SVector<f64, D>,
        second: &SVector<f64, D>,
    ) -> f64 {
        use Coordinate::{Curvature, Point, Roll, Speed, Stretch, Tangent, Turn};
        // Rolling turns the tangent, while the point runs on a circle about the centre.
        let rolls = if let (Roll(centre), Roll(_)) = (one, other) { Some(centre) } else { None };
        let turns = |coordinate| if let Roll(_) = coordinate { Tangent(0) } else { coordinate };
        let (one, other) = (turns(one), turns(other));
        let (tangent, speed) = (self.frame[0], self.speed);
        let (normal, curvature) = (|j: usize| self.normal(j), |j: usize| self.curvature.at(j));
        let derivative = match (one, other) {
            (Point(i), Point(j)) => {
                let along = |d: usize| tangent.as_slice().at(d);
                along(i) * along(j) * point.dot(&self.curvature_vector())
            }
            (Speed, Speed) => 2.0 * second.dot(&self.curvature_vector()),
            (Speed, Tangent(j)) | (Tangent(j), Speed) => {
                first.dot(&normal(j)) - 2.0 * speed * curvature(j) * second.dot(&tangent)
            }
            (Speed, Curvature(j)) | (Curvature(j), Speed) => 2.0 * speed * second.dot(&normal(j)),
            (Speed, Turn) | (Turn, Speed) => 2.0 * speed * second.dot(&self.turned()),
            (Stretch, Tangent(j)) | (Tangent(j), Stretch) => second.dot(&normal(j)),
            (Tangent(i), Tangent(j)) => {
                let bend = normal(j) * curvature(i) + normal(i) * curvature(j);
                let mut sum = -0.5 * speed * speed * second.dot(&bend);
                if i == j {
                    sum -= speed * first.dot(&tangent) + self.stretch * second.dot(&tangent);
                }
                sum
            }
            (Curvature(i), Tangent(j)) | (Tangent(j), Curvature(i)) if i == j => {
                -speed * speed * second.dot(&tangent)
            }
            (Turn, Tangent(j)) | (Tangent(j), Turn) => {
                let turned = if j == 0 { -self.curvature[1] } else { self.curvature[0] };
                -speed * speed * turned * second.dot(&tangent)
            }
            (Turn, Turn) => -speed * speed * second.dot(&self.curvature_vector()),
            _ => 0.0,
        };
        rolls.map_or(derivative, |centre| derivative + centre * point.dot(&self.frame[D - 1]))
    }
}

/// A step of what a side holds: its tangent and its curvature components.
#[derive(Clone, Copy)]
pub(super) struct SideStep<const D: usize> {
    turn: [f64; D],
    bend: [f64; D],
    twist: f64,
}

impl<const D: usize> Default for SideStep<D> {
    fn default() -> Self {
        Self { turn: [0.0; D], bend: [0.0; D], twist: 0.0 }
    }
}

impl<const D: usize> SideStep<D> {
    pub(super) fn note(&mut self, coordinate: Coordinate, step: f64) {
        match coordinate {
            Coordinate::Tangent(j) => self.turn.put(j, step),
            Coordinate::Roll(_) => self.turn[0] = step,
            Coordinate::Curvature(j) => self.bend.put(j, step),
            Coordinate::Turn => self.twist = step,
            _ => {}
        }
    }

    /// Turns the frame of a side, and adds to its curvature components.
    pub(super) fn apply(&self, side: &mut [f64]) {
        let (frame, curvature) = side.cut_mut(D * D);
        for (component, bend) in curvature.iter_mut().zip(self.bend) {
            *component += bend;
        }
        if self.twist != 0.0 {
            let (sin, cos) = (libm::sin(self.twist), libm::cos(self.twist));
            let (one, two) = (curvature.at(0), curvature.at(1));
            curvature.put(0, cos * one - sin * two);
            curvature.put(1, sin * one + cos * two);
        }
        let mut square = 0.0;
        for turn in self.turn {
            square += turn * turn;
        }
        if square == 0.0 {
            return;
        }
        let angle = sqrt(square);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let rows: [SVector<f64, D>; D] =
            core::array::from_fn(|j| SVector::from_fn(|d, _| frame.at(D * j + d)));
        // The unit normal towards which the tangent turns.
        let mut towards = SVector::<f64, D>::zeros();
        for j in 1..D {
            towards += rows[j] * (self.turn[j - 1] / angle);
        }
        let mut turned = rows;
        turned[0] = rows[0] * cos + towards * sin;
        for j in 1..D {
            let along = self.turn[j - 1] / angle;
            turned[j] = rows[j] + (towards * (cos - 1.0) - rows[0] * sin) * along;
        }
        orthonormalise(&mut turned);
        for j in 0..D {
            for d in 0..D {
                frame.put(D * j + d, turned[j][d]);
            }
        }
    }
}

/// Gram and Schmidt, so that rounding does not add up over the iterations.
pub(super) fn orthonormalise<const D: usize>(frame: &mut [SVector<f64, D>; D]) {
    for j in 0..D {
        let mut row = frame[j];
        for i in 0..j {
            let along = row.dot(&frame[i]);
            row -= frame[i] * along;
        }
        frame[j] = row / sqrt(row.dot(&row));
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    /// An end with a frame that is turned against the axes.
    fn some<const D: usize>() -> End<D> {
        let numbers = [0.3, -0.8, 0.5, 0.9, 0.2, 0.4, -0.1, 0.7, -0.6];
        let mut frame: [SVector<f64, D>; D] =
            core::array::from_fn(|j| SVector::from_fn(|d, _| numbers[3 * j + d]));
        orthonormalise(&mut frame);
        End {
            point: SVector::from_fn(|d, _| 1.0 - d as f64),
            frame,
            curvature: core::array::from_fn(|j| [0.7, -1.1, 0.0][j]),
            speed: 1.7,
            stretch: -0.4,
        }
    }

    /// An end after a step, as the curve's problem moves it.
    fn moved<const D: usize>(end: &End<D>, steps: [(Coordinate, f64); 2]) -> End<D> {
        let mut side: Vec<f64> = end.frame.iter().flat_map(|row| row.iter().copied()).collect();
        side.extend(end.curvature);
        let (mut turn, mut to, mut slide) = (SideStep::<D>::default(), *end, 0.0);
        let mut centre = None;
        for (coordinate, step) in steps {
            match coordinate {
                Coordinate::Point(d) => {
                    to.point[d] += step;
                    slide += step * end.frame[0][d];
                }
                Coordinate::Across(j) => to.point += end.normal(j) * step,
                Coordinate::Speed => to.speed += step,
                Coordinate::Stretch => to.stretch += step,
                Coordinate::Roll(left) => {
                    centre = Some((end.point + end.frame[D - 1] * left, left));
                    turn.turn[0] += step;
                }
                _ => turn.note(coordinate, step),
            }
        }
        to.point += end.curvature_vector() * (0.5 * slide * slide);
        turn.apply(&mut side);
        to.frame = core::array::from_fn(|j| SVector::from_fn(|d, _| side[D * j + d]));
        to.curvature = core::array::from_fn(|j| side[D * D + j]);
        if let Some((centre, left)) = centre {
            to.point = centre - to.frame[D - 1] * left;
        }
        to
    }

    fn check<const D: usize>(coordinates: &[Coordinate]) {
        let end = some::<D>();
        let weights: [SVector<f64, D>; 3] =
            core::array::from_fn(|a| SVector::from_fn(|d, _| [0.9, -0.3, 0.6, -0.7][(2 * a + d) % 4]));
        let of = |steps| {
            let [point, first, second] = moved(&end, steps).rows();
            point.dot(&weights[0]) + first.dot(&weights[1]) + second.dot(&weights[2])
        };
        let h = 1e-4;
        for (i, &one) in coordinates.iter().enumerate() {
            let map = end.tangent_map(one);
            let slope: f64 = map.iter().zip(&weights).map(|(row, weight)| row.dot(weight)).sum();
            let none = (Coordinate::Speed, 0.0);
            let found = (of([(one, h), none]) - of([(one, -h), none])) / (2.0 * h);
            assert!((found - slope).abs() < 1e-7, "{D} {i}: {slope} {found}");
            // What is not moved says so.
            for (order, row) in map.iter().enumerate() {
                assert!(one.orders().contains(&order) || row.amax() == 0.0, "{D} {i} {order}");
            }
            for (j, &other) in coordinates.iter().enumerate() {
                let [point, first, second] = &weights;
                let claimed = end.second_map(one, other, point, first, second);
                let found = if i == j {
                    (of([(one, h), none]) + of([(one, -h), none]) - 2.0 * of([none; 2])) / (h * h)
                } else {
                    let both = |a: f64, b: f64| of([(one, a * h), (other, b * h)]);
                    (both(1.0, 1.0) - both(1.0, -1.0) - both(-1.0, 1.0) + both(-1.0, -1.0)) / (4.0 * h * h)
                };
                assert!((found - claimed).abs() < 1e-6, "{D} {i} {j}: {claimed} {found}");
            }
        }
    }

    /// First and second derivatives of a weighted sum of `P, P', P''` against differences along the steps that the solver
    /// makes: of every coordinate and every two that go together.
    #[test]
    fn an_end_moves_as_its_derivatives_say() {
        use Coordinate::{Across, Curvature, Point, Roll, Speed, Stretch, Tangent, Turn};
        check::<2>(&[Point(0), Point(1), Tangent(0), Curvature(0), Speed, Stretch]);
        check::<2>(&[Across(0), Tangent(0), Curvature(0), Speed, Stretch]);
        for left in [0.6, -0.6] {
            check::<2>(&[Roll(left), Curvature(0), Speed, Stretch]);
        }
        let [x, y, z] = [0, 1, 2].map(Point);
        check::<3>(&[x, y, z, Tangent(0), Tangent(1), Curvature(0), Curvature(1), Speed, Stretch]);
        check::<3>(&[Across(0), Across(1), Tangent(0), Tangent(1), Turn, Speed, Stretch]);
    }

    #[test]
    fn rows_stand_where_an_end_s_derivatives_count() {
        assert_eq!([0, 1, 2].map(|order| row_of(0, order)), [0, 1, 2]);
        assert_eq!([0, 1, 2].map(|order| row_of(1, order)), [0, 4, 3]);
        let [before, after] =
            [some::<3>(), moved(&some::<3>(), [(Coordinate::Speed, 1.0), (Coordinate::Point(0), 2.0)])];
        let rows = rows_between(&[before, after]);
        let ([p0, v0, a0], [p1, v1, a1]) = (before.rows(), after.rows());
        assert_eq!(rows, [p0, v0, a0, a1, v1, p1]);
    }
}
