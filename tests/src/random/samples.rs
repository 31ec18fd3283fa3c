//! The families of shapes: points in order, each with a tangent and a curvature that a designer might give there.

use super::dice::{Dice, rotated};
use crate::curves::{Vector, add, cross, distance, norm, sub, times, unit};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Where a problem's points come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// A circle or an arc of one.
    Circle,
    /// A helix.
    Helix,
    /// An ellipse, up to ten times as long as wide.
    Ellipse,
    /// An Archimedean spiral, in space on a cone.
    Spiral,
    /// A Lissajous figure of the plane or of space.
    Lissajous,
    /// A random walk: gentle or with turns of more than half a turn.
    Walk,
    /// Points anywhere in a box.
    Uniform,
    /// Two points with tangents anywhere.
    TwoPoints,
    /// A row that is straight but for little.
    Straight,
    /// A polygon with rounded corners: where the rounding begins and ends, with tangents.
    Designer,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Circle,
        Self::Helix,
        Self::Ellipse,
        Self::Spiral,
        Self::Lissajous,
        Self::Walk,
        Self::Uniform,
        Self::TwoPoints,
        Self::Straight,
        Self::Designer,
    ];
}

/// A point and the curve's likely direction and curvature vector there.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The point.
    pub point: Vector,
    /// The tangent, a unit vector.
    pub tangent: Vector,
    /// The curvature vector, perpendicular to the tangent.
    pub curvature: Vector,
}

/// A shape's samples.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The samples in order.
    pub list: Vec<Sample>,
    /// Whether the shape returns to its first point.
    pub closed: bool,
    /// Whether everything lies in the plane z = 0.
    pub planar: bool,
}

/// The longest step is up to this many times the shortest.
const CLUSTERING: f64 = 1e3;
/// Points are on a grid of this spacing, so that they can be moved far without rounding.
const GRID: f64 = 1.0 / (1u64 << 32) as f64;

/// A point on the grid, without negative zeros.
pub fn on_grid(point: Vector) -> Vector {
    point.map(|x| libm::rint(x / GRID) * GRID + 0.0)
}

/// How many joints: few more often than many.
fn joints(dice: &mut Dice, least: usize) -> usize {
    let most = if dice.chance(0.8) { 12 } else { 40 };
    dice.count(least, most)
}

/// Steps whose sum is `total`: nearly even, or clustered.
fn steps(dice: &mut Dice, count: usize, total: f64, clustered: bool) -> Vec<f64> {
    let raw: Vec<f64> = (0..count)
        .map(|_| if clustered { dice.factor(1.0 / CLUSTERING, 1.0) } else { dice.between(0.6, 1.4) })
        .collect();
    let sum: f64 = raw.iter().sum();
    raw.iter().map(|step| step * total / sum).collect()
}

/// Draws the samples of a family until neighbours are apart by more than the grid could blur.
pub fn draw(dice: &mut Dice, family: Family) -> Samples {
    loop {
        let mut samples = match family {
            Family::Circle | Family::Helix | Family::Ellipse | Family::Spiral | Family::Lissajous => {
                smooth(dice, family)
            }
            Family::Walk => walk(dice),
            Family::Uniform => uniform(dice),
            Family::TwoPoints => two_points(dice),
            Family::Straight => straight(dice),
            Family::Designer => designer(dice),
        };
        for sample in &mut samples.list {
            sample.point = on_grid(sample.point);
        }
        let count = samples.list.len();
        let apart = |i: usize| distance(samples.list[i].point, samples.list[(i + 1) % count].point) > 1e-5;
        if (0..count - usize::from(!samples.closed)).all(apart) {
            return samples;
        }
    }
}

/// The point and two derivatives of a curve by its parameter.
type Jet = [Vector; 3];

fn smooth(dice: &mut Dice, family: Family) -> Samples {
    let clustered = dice.chance(0.2);
    let may_close = !matches!(family, Family::Helix | Family::Spiral);
    let closed = may_close && dice.chance(0.4);
    let count = joints(dice, if closed { 3 } else { 2 });
    let spans = if closed { count } else { count - 1 };
    // Up to 200 degrees a span, and up to a few turns in all; a circle or an ellipse is gone round once at most.
    let turns = if matches!(family, Family::Circle | Family::Ellipse) { 0.98 } else { 3.0 };
    let total = if closed { TAU } else { dice.between(0.2, (spans as f64 * 3.5).min(turns * TAU)) };
    let (a, b, c) = (dice.factor(1.0, 10.0), dice.within(1.5), dice.within(0.7));
    let (p, q, mut r) = (dice.count(1, 3), dice.count(1, 3), dice.count(1, 3));
    if p == q && q == r {
        // One frequency for all three coordinates is an ellipse in some plane.
        r = p % 3 + 1;
    }
    let [p, q, r] = [p, q, r].map(|frequency| frequency as f64);
    let (phase, lift) = (dice.between(0.2, 1.4), dice.between(0.0, TAU));
    let space =
        family == Family::Helix || (matches!(family, Family::Spiral | Family::Lissajous) && dice.chance(0.4));
    let begin = dice.between(0.0, TAU);
    let jet = |t: f64| -> Jet {
        // A wave's value and derivatives.
        let wave = |size: f64, rate: f64, phase: f64| {
            let (sin, cos) = libm::sincos(rate * t + phase);
            [size * sin, size * rate * cos, -size * rate * rate * sin]
        };
        let raised = |on: bool, wave: [f64; 3]| if on { wave } else { [0.0; 3] };
        let [x, y, z] = match family {
            Family::Circle => [wave(1.0, 1.0, begin + FRAC_PI_2), wave(1.0, 1.0, begin), [0.0; 3]],
            Family::Helix => [wave(1.0, 1.0, begin + FRAC_PI_2), wave(1.0, 1.0, begin), [b * t, b, 0.0]],
            Family::Ellipse => [wave(a, 1.0, begin + FRAC_PI_2), wave(1.0, 1.0, begin), [0.0; 3]],
            Family::Spiral => {
                let ([cos, dcos, ddcos], [sin, dsin, ddsin]) =
                    (wave(1.0, 1.0, begin + FRAC_PI_2), wave(1.0, 1.0, begin));
                let (radius, grows) = (1.0 + 0.2 * a * t, 0.2 * a);
                let times_radius = |f: f64, d: f64, dd: f64| {
                    [f * radius, d * radius + f * grows, dd * radius + 2.0 * d * grows]
                };
                [
                    times_radius(cos, dcos, ddcos),
                    times_radius(sin, dsin, ddsin),
                    raised(space, [c * t, c, 0.0]),
                ]
            }
            _ => [wave(2.0, p, phase), wave(1.5, q, 0.0), raised(space, wave(1.0, r, lift))],
        };
        std::array::from_fn(|order| [x[order], y[order], z[order]])
    };
    let mut t = 0.0;
    let mut parameters = vec![t];
    for step in steps(dice, spans, total, clustered) {
        t += step;
        parameters.push(t);
    }
    parameters.truncate(count);
    let list = parameters
        .into_iter()
        .map(|t| {
            let [point, d1, d2] = jet(t);
            let speed = norm(d1);
            let tangent = times(d1, 1.0 / speed);
            let curvature = times(cross(cross(d1, d2), d1), 1.0 / (speed * speed * speed * speed));
            Sample { point, tangent, curvature }
        })
        // A Lissajous figure may stop for a moment.
        .filter(|sample| {
            sample.tangent.iter().chain(&sample.curvature).all(|x| x.is_finite() && x.abs() < 1e3)
        })
        .collect::<Vec<_>>();
    if list.len() < if closed { 3 } else { 2 } {
        return smooth(dice, family);
    }
    Samples { list, closed, planar: !space }
}

/// Tangents along the bisectors of points, leant by up to `lean`, with curvatures of up to `bend` over the nearer
/// neighbour's distance.
fn with_guesses(
    dice: &mut Dice,
    points: &[Vector],
    closed: bool,
    planar: bool,
    lean: f64,
    bend: f64,
) -> Samples {
    let count = points.len();
    let list = (0..count)
        .map(|i| {
            let before = if i > 0 { Some(i - 1) } else { closed.then_some(count - 1) };
            let after = if i + 1 < count { Some(i + 1) } else { closed.then_some(0) };
            let arriving = before.map(|j| sub(points[i], points[j]));
            let leaving = after.map(|j| sub(points[j], points[i]));
            let chords: Vec<Vector> = [arriving, leaving].into_iter().flatten().collect();
            let near = chords.iter().map(|&chord| norm(chord)).fold(f64::INFINITY, f64::min);
            let sum = chords.iter().filter(|&&c| norm(c) > 0.0).fold([0.0; 3], |sum, &c| add(sum, unit(c)));
            let along = if norm(sum) > 1e-3 { unit(sum) } else { dice.across([1.0, 0.0, 0.0], planar) };
            let angle = dice.within(lean);
            let tangent = dice.turned(along, angle, planar);
            let size = dice.within(bend) / near.max(1e-9);
            let curvature = times(dice.across(tangent, planar), size);
            Sample { point: points[i], tangent, curvature }
        })
        .collect();
    Samples { list, closed, planar }
}

fn walk(dice: &mut Dice) -> Samples {
    let (planar, clustered) = (dice.chance(0.6), dice.chance(0.2));
    let closed = dice.chance(0.25);
    let count = joints(dice, if closed { 3 } else { 2 });
    // Gentle, lively, or with turnings of more than half a turn.
    let turn = [0.6, 1.5, 1.1 * PI][dice.below(3)];
    let (mut point, mut towards) = ([0.0; 3], [1.0, 0.0, 0.0]);
    let mut points = vec![point];
    for _ in 1..count {
        let step = if clustered { dice.factor(1.0 / CLUSTERING, 1.0) } else { dice.between(0.5, 1.5) };
        point = add(point, times(towards, step));
        points.push(point);
        let angle = dice.within(turn);
        towards = dice.turned(towards, angle, planar);
    }
    with_guesses(dice, &points, closed, planar, 0.5 * turn, 1.0)
}

fn uniform(dice: &mut Dice) -> Samples {
    let (planar, clustered, closed) = (dice.chance(0.6), dice.chance(0.2), dice.chance(0.3));
    let count = joints(dice, if closed { 3 } else { 2 });
    let mut points: Vec<Vector> = Vec::with_capacity(count);
    for _ in 0..count {
        let point = match points.last() {
            Some(&last) if clustered && dice.chance(0.3) => {
                let near = dice.factor(4.0 / CLUSTERING, 0.4);
                let towards = dice.turned([1.0, 0.0, 0.0], PI, planar);
                let angle = dice.angle();
                add(last, times(dice.turned(towards, angle, planar), near))
            }
            _ => std::array::from_fn(|_| dice.between(0.0, 4.0)),
        };
        points.push(if planar { [point[0], point[1], 0.0] } else { point });
    }
    let lean = [0.3, 1.5][dice.below(2)];
    with_guesses(dice, &points, closed, planar, lean, 1.0)
}

fn two_points(dice: &mut Dice) -> Samples {
    let planar = dice.chance(0.6);
    let chord = dice.between(0.5, 4.0);
    let most = [1.0, 2.0, PI][dice.below(3)];
    let sample = |dice: &mut Dice, x: f64| {
        let angle = dice.within(most);
        let tangent = dice.turned([1.0, 0.0, 0.0], angle, planar);
        let size = dice.within(3.0) / chord;
        Sample { point: [x, 0.0, 0.0], tangent, curvature: times(dice.across(tangent, planar), size) }
    };
    Samples { list: vec![sample(dice, 0.0), sample(dice, chord)], closed: false, planar }
}

fn straight(dice: &mut Dice) -> Samples {
    let (planar, clustered) = (dice.chance(0.7), dice.chance(0.2));
    let count = joints(dice, 2);
    let off = if dice.chance(0.2) { 0.0 } else { dice.factor(if planar { 1e-9 } else { 1e-7 }, 0.05) };
    let mut along = 0.0;
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        let [y, z] = [dice.within(off), dice.within(off)];
        points.push([along, y, if planar { 0.0 } else { z }]);
        along += if clustered { dice.factor(1.0 / CLUSTERING, 1.0) } else { dice.between(0.5, 1.5) };
    }
    with_guesses(dice, &points, false, planar, off, off)
}

/// A polygon whose corners are cut: two joints a corner, with the tangents of the sides.
fn designer(dice: &mut Dice) -> Samples {
    let (planar, closed) = (dice.chance(0.75), dice.chance(0.5));
    let most = if dice.chance(0.8) { 6 } else { 18 };
    // A triangle lies in a plane, lifted or not.
    let corners = dice.count(if planar { 3 } else { 4 }, most);
    let (ragged, stretch) = (dice.between(0.0, 0.8), dice.factor(0.3, 1.0));
    let lift = if planar { 0.0 } else { dice.between(0.1, 1.0) };
    let about = dice.direction();
    let corner: Vec<Vector> = (0..corners)
        .map(|i| {
            let angle = TAU * (i as f64 + 0.25 * dice.within(ragged)) / corners as f64;
            let radius = 2.0 * (1.0 - 0.8 * ragged * dice.unit());
            let (sin, cos) = libm::sincos(angle);
            let point = [radius * cos, stretch * radius * sin, dice.within(lift)];
            if planar { point } else { rotated(point, about, 0.3) }
        })
        .collect();
    let cut = dice.between(0.15, 0.45);
    let mut list = Vec::with_capacity(2 * corners);
    for i in 0..corners {
        let here = corner[i];
        let sides = [corner[(i + corners - 1) % corners], corner[(i + 1) % corners]];
        for (side, other) in sides.into_iter().enumerate() {
            let towards = sub(other, here);
            let tangent = unit(if side == 0 { times(towards, -1.0) } else { towards });
            list.push(Sample { point: add(here, times(towards, cut)), tangent, curvature: [0.0; 3] });
        }
    }
    Samples { list, closed, planar }
}
