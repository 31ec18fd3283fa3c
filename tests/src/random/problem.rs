//! A problem: which of a shape's points, tangents and curvatures are given, and where it all lies.

use super::dice::Dice;
use super::samples::{Family, Sample, Samples, draw, on_grid};
use super::similarity::{Similarity, Turn};
use crate::curves::{Vector, add, distance, dot, norm, sub, times, unit};
use minvar::curve::{Continuity, Curve, Given, Joint, Quantity};

/// A random curve problem.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Its number; with the seed it makes the problem.
    pub index: u64,
    /// Where its points come from.
    pub family: Family,
    /// Whether it is made to lie in a plane.
    pub planar: bool,
    /// Whether the curve returns to its first joint.
    pub closed: bool,
    /// The joints near the origin, of a size near one, on the grid; in the plane z = 0 if planar.
    pub plain: Vec<Joint>,
    /// Where the problem lies.
    pub place: Similarity,
    /// The joints in their place: what is solved.
    pub joints: Vec<Joint>,
}

/// The cosine of 75 degrees.
const MOST_GENTLE_COSINE: f64 = 0.2588;

/// How likely a sample's properties are given; of the joints between the ends.
struct Mix {
    tangent: f64,
    initial_tangent: f64,
    curvature: f64,
    initial_curvature: f64,
    g1: f64,
    g0: f64,
    loose: f64,
    /// A tangent at an end of an open curve.
    end: f64,
}

const NOTHING: Mix = Mix {
    tangent: 0.0,
    initial_tangent: 0.0,
    curvature: 0.0,
    initial_curvature: 0.0,
    g1: 0.0,
    g0: 0.0,
    loose: 0.0,
    end: 0.0,
};
const ENDS: Mix = Mix { end: 0.85, ..NOTHING };
const SOME: Mix = Mix {
    tangent: 0.2,
    initial_tangent: 0.1,
    curvature: 0.05,
    initial_curvature: 0.05,
    g1: 0.08,
    g0: 0.05,
    loose: 0.03,
    end: 0.6,
};
const MUCH: Mix = Mix {
    tangent: 0.4,
    initial_tangent: 0.15,
    curvature: 0.2,
    initial_curvature: 0.1,
    g1: 0.15,
    g0: 0.1,
    loose: 0.06,
    end: 0.8,
};

impl Problem {
    /// Problem number `index` of a seed.
    pub fn new(seed: u64, index: u64) -> Self {
        let mut dice = Dice::new(seed, index);
        let family = Family::ALL[dice.below(Family::ALL.len())];
        let samples = draw(&mut dice, family);
        let plain = constrain(&mut dice, family, &samples);
        let place = place(&mut dice, samples.planar);
        let joints = place.joints(&plain);
        Self { index, family, planar: samples.planar, closed: samples.closed, plain, place, joints }
    }

    /// The curve to solve.
    pub fn curve(&self) -> Curve<'_> {
        Curve::new(&self.joints, self.closed)
    }

    /// Whether an energy (MEC) has a minimum here and not only an infimum. A curvature that is fixed costs an energy
    /// nothing if the curve leaves it at once, ever more sharply; so does the common curvature of a G2 joint whose
    /// tangent is fixed.
    pub fn has_least_energy(&self) -> bool {
        let count = self.plain.len();
        self.plain.iter().enumerate().all(|(i, joint)| {
            let end = !self.closed && (i == 0 || i + 1 == count);
            let fixed = |quantity: &Quantity| quantity.given == Given::FIXED;
            let split = joint.continuity == Continuity::G2 && !end && fixed(&joint.tangent[0]);
            !split && !joint.curvature.iter().any(fixed)
        })
    }

    /// Whether nobody would call the data wild: no two steps beside each other differ by more than a factor of four,
    /// neighbouring chords turn by no more than 75 degrees, and no tangent leaves its chord by more than that.
    pub fn is_gentle(&self) -> bool {
        let joints: Vec<&Joint> = self.plain.iter().filter(|j| j.position.given != Given::FREE).collect();
        let count = joints.len();
        let chords: Vec<Vector> = (0..count - usize::from(!self.closed))
            .map(|i| sub(joints[(i + 1) % count].position.value, joints[i].position.value))
            .collect();
        let near = |a: Vector, b: Vector| dot(a, b) >= MOST_GENTLE_COSINE * norm(a) * norm(b);
        (0..count).all(|i| {
            let before = if i > 0 { Some(i - 1) } else { self.closed.then(|| chords.len() - 1) };
            let sides = [before, Some(i).filter(|&i| i < chords.len())].map(|side| side.map(|k| chords[k]));
            let tangents = joints[i].tangent.iter().zip(sides).all(|(tangent, chord)| {
                tangent.given == Given::FREE || chord.is_none_or(|chord| near(tangent.value, chord))
            });
            tangents
                && match sides {
                    [Some(a), Some(b)] => near(a, b) && (0.25..=4.0).contains(&(norm(a) / norm(b))),
                    _ => true,
                }
        })
    }

    /// Whether only positions are given, all of them fixed.
    pub fn points_only(&self) -> bool {
        self.plain.iter().all(|joint| {
            joint.position.given == Given::FIXED
                && joint.continuity == Continuity::G2
                && joint.tangent.iter().chain(&joint.curvature).all(|quantity| quantity.given == Given::FREE)
        })
    }
}

/// A curvature vector perpendicular to the tangent to the last digit but a few.
fn sensible(dice: &mut Dice, sample: &Sample, tangent: Vector, step: f64, planar: bool) -> Vector {
    // Rarely none at all, else the sample's own size or a like one, but no circle much smaller than the step.
    if dice.chance(0.1) {
        return [0.0; 3];
    }
    let own = norm(sample.curvature);
    let size = (if dice.chance(0.5) { own } else { own * dice.factor(0.3, 3.0) }).min(2.0 / step);
    if size == 0.0 {
        return [0.0; 3];
    }
    let along = dot(sample.curvature, tangent);
    let across = sub(sample.curvature, times(tangent, along));
    if norm(across) > 0.5 * own {
        times(across, size / norm(across))
    } else {
        times(dice.across(tangent, planar), size)
    }
}

fn constrain(dice: &mut Dice, family: Family, samples: &Samples) -> Vec<Joint> {
    let mix = match dice.below(10) {
        0..3 => &NOTHING,
        3..5 => &ENDS,
        5..8 => &SOME,
        _ => &MUCH,
    };
    let (list, planar) = (&samples.list, samples.planar);
    let count = list.len();
    let g1_designer = dice.chance(0.4);
    let keeps_tangents = family == Family::Designer && dice.chance(0.85);
    let mut given = count;
    let mut joints = Vec::with_capacity(count);
    for (i, sample) in list.iter().enumerate() {
        let end = !samples.closed && (i == 0 || i + 1 == count);
        let step = [(i + count - 1) % count, (i + 1) % count]
            .map(|other| distance(list[other].point, sample.point))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let mut joint = Joint::at(sample.point);
        if !end && dice.chance(mix.g1) || (keeps_tangents && g1_designer) {
            joint = joint.with_continuity(Continuity::G1);
        } else if !end && dice.chance(mix.g0) {
            joint = joint.with_continuity(Continuity::G0);
        }
        let sides = if joint.continuity == Continuity::G0 { 2 } else { 1 };
        for side in 0..sides {
            let likely = if end { mix.end } else { mix.tangent };
            // A corner's sides look where they like; a start value may be a little wrong.
            let corner = if sides == 2 { dice.within(1.2) } else { 0.0 };
            let wrong = dice.within(0.4);
            let length = dice.factor(0.01, 100.0);
            let tangent = |dice: &mut Dice, angle: f64| {
                if angle == 0.0 { sample.tangent } else { dice.turned(sample.tangent, angle, planar) }
            };
            let quantity = if keeps_tangents || family == Family::TwoPoints || dice.chance(likely) {
                Quantity::fixed(times(tangent(dice, corner), length))
            } else if dice.chance(mix.initial_tangent) {
                Quantity::initial(times(tangent(dice, corner + wrong), length))
            } else {
                Quantity::FREE
            };
            joint.tangent[side] = quantity;
        }
        if sides == 1 {
            joint.tangent[1] = joint.tangent[0];
        }
        let curvatures = if joint.continuity == Continuity::G2 { 1 } else { 2 };
        for side in 0..curvatures {
            let fixed = dice.chance(mix.curvature);
            if !fixed && !dice.chance(mix.initial_curvature) {
                continue;
            }
            // A curvature says little without a tangent to be perpendicular to: a start value is given then.
            if joint.tangent[side].given == Given::FREE {
                joint.tangent[side] = Quantity::initial(sample.tangent);
                if joint.continuity != Continuity::G0 {
                    joint.tangent[1 - side] = joint.tangent[side];
                }
            }
            let tangent = unit(joint.tangent[side].value);
            let value = sensible(dice, sample, tangent, step, planar);
            joint.curvature[side] = if fixed { Quantity::fixed(value) } else { Quantity::initial(value) };
        }
        if curvatures == 1 {
            joint.curvature[1] = joint.curvature[0];
        }
        let enough = if samples.closed { 3 } else { 2 };
        if !end && given > enough && dice.chance(mix.loose) {
            given -= 1;
            let push = times(dice.turned(sample.tangent, 1.0, planar), 0.1 * step);
            joint.position = if dice.chance(0.5) {
                Quantity::FREE
            } else {
                Quantity::initial(on_grid(add(sample.point, push)))
            };
        }
        joints.push(joint);
    }
    if neighbours_coincide(&joints, samples.closed) {
        for (joint, sample) in joints.iter_mut().zip(list) {
            joint.position = Quantity::fixed(sample.point);
        }
    }
    joints
}

/// Whether neighbours that are left when free positions are passed over are at the same point: a shape that crosses itself
/// may do that.
fn neighbours_coincide(joints: &[Joint], closed: bool) -> bool {
    let points: Vec<Vector> =
        joints.iter().filter(|j| j.position.given != Given::FREE).map(|j| j.position.value).collect();
    let count = points.len();
    (0..count - usize::from(!closed)).any(|i| distance(points[i], points[(i + 1) % count]) < 1e-5)
}

/// Where a problem lies: mostly near, sometimes far, of any size and direction.
fn place(dice: &mut Dice, planar: bool) -> Similarity {
    let turn = match dice.below(10) {
        0..4 => Turn::None,
        4 => Turn::Axes(1),
        5 => Turn::Axes(2),
        _ => Turn::About(dice.direction(), dice.angle()),
    };
    let turn = if !planar && matches!(turn, Turn::Axes(_)) { Turn::None } else { turn };
    let scale = match dice.below(10) {
        0..4 => 1.0,
        4..6 => libm::exp2(dice.count(0, 40) as f64 - 20.0),
        _ => dice.factor(1e-6, 1e6),
    };
    let far = if dice.chance(0.4) { dice.factor(0.1, 1e6) } else { 0.0 };
    let mut shift = times(dice.direction(), far * scale).map(|x| x + 0.0);
    if planar && turn == Turn::None && dice.chance(0.5) {
        shift[2] = 0.0;
    }
    Similarity { turn, scale, shift }
}
