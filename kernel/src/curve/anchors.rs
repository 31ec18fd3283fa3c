//! What holds a curve of which nothing is fixed.
//!
//! A scale-invariant functional of such a curve does not change when the whole is moved, turned or scaled, nor, but for
//! what quintics are coarser than curves, when its joints slide along it. Written in any coordinates these motions are
//! bent, and away from a minimum a bent motion without effect looks like a negative curvature of the functional: steps
//! would follow it instead of the shape. So two joints hold the curve. First they stand with their tangents, and the
//! others move only across: what is left is the shape alone. Then all joints slide, one after the other and with the
//! whole, whose steps leave the two in their places.
//!
//! Of a circle two tangents are tied to the chord between them, and a closed curve that turns round, of which nothing
//! is fixed, becomes one. So only a planar curve is held that in all does not turn, like a figure-8.

use super::fairness::{Density, Shape};
use super::joint::{Curve, Given, Joint, Quantity};
use super::model::Model;
use super::natural::angle;
use super::options::Options;
use core::f64::consts::PI;

/// The first joint, and the one farthest from it, where nothing holds a curve that does not turn in all.
pub(super) fn anchors<const D: usize>(
    model: &Model<'_, D>,
    options: &Options,
    state: &[f64],
) -> Option<[usize; 2]>
where
    Shape<D>: Density<D>,
{
    let found = farthest(&model.curve, options)?;
    if D != 2 || !model.curve.closed {
        return None;
    }
    let mut turning = 0.0;
    for element in 0..model.element_count() {
        let ends = [model.end(element, 0, state), model.end(element, 1, state)];
        let chord = ends[1].point - ends[0].point;
        turning += angle(&ends[0].frame[0], &chord) + angle(&chord, &ends[1].frame[0]);
    }
    (turning.abs() < PI).then_some(found)
}

/// Two joints that are far from each other where nothing of a curve is fixed, nor its size.
fn farthest(curve: &Curve<'_>, options: &Options) -> Option<[usize; 2]> {
    let keeps_size = options.functional.length_power() == 0 || options.length > 0.0;
    if keeps_size || curve.reference.is_some() || !curve.obstacles.is_empty() {
        return None;
    }
    let free = |quantity: &Quantity| matches!(quantity.given, Given::FREE | Given::INITIAL);
    let loose = |joint: &Joint| {
        free(&joint.position) && joint.tangent.iter().all(free) && joint.curvature.iter().all(free)
    };
    let [first, rest @ ..] = curve.joints else { return None };
    if first.position.given != Given::INITIAL || !loose(first) || !rest.iter().all(loose) {
        return None;
    }
    let mut found = (0, 0.0);
    for (k, joint) in rest.iter().enumerate().filter(|(_, joint)| joint.position.given == Given::INITIAL) {
        let mut square = 0.0;
        for d in 0..3 {
            let step = joint.position.value[d] - first.position.value[d];
            square += step * step;
        }
        if square > found.1 {
            found = (k + 1, square);
        }
    }
    (found.0 > 0).then_some([0, found.0])
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::curve::functional::Functional;
    use crate::curve::obstacle::{Obstacle, Side};
    use crate::curve::tests::{planar, spatial, started};

    /// Joints that are where they begin.
    fn joints<const N: usize>(points: [[f64; 3]; N]) -> [Joint; N] {
        points.map(|point| Joint::at(point).with_position(Quantity::initial(point)))
    }

    const EIGHT: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [3.0, 0.0, 0.0],
        [2.0, -1.0, 0.0],
        [-2.0, 1.0, 0.0],
        [-2.0, -1.0, 0.0],
    ];
    const SI: Options = Options { functional: Functional::SI_MVC, ..Options::DEFAULT };

    #[test]
    fn two_joints_hold_only_what_nothing_holds() {
        let free = joints(EIGHT);
        let of = |joints: &[Joint], options: &Options| farthest(&Curve::new(joints, true), options);
        assert_eq!(of(&free, &SI), Some([0, 2]));
        assert_eq!(of(&free, &Options { functional: Functional::SI_MEC, ..SI }), Some([0, 2]));
        // A functional or a length that knows a size.
        assert_eq!(of(&free, &Options::DEFAULT), None);
        assert_eq!(of(&free, &Options { length: 3.0, ..SI }), None);
        let obstacles = [Obstacle::point([0.0, 9.0, 0.0], 1.0, Side::LEFT)];
        assert_eq!(farthest(&Curve::new(&free, true).with_obstacles(&obstacles), &SI), None);
        for k in 0..free.len() {
            let with = |joint: Joint| {
                let mut joints = free;
                joints[k] = joint;
                of(&joints, &SI)
            };
            let value = [1.0, 2.0, 0.0];
            assert_eq!(with(Joint::at(EIGHT[k])), None, "{k}");
            assert_eq!(with(free[k].on_line(EIGHT[k], value)), None, "{k}");
            for side in 0..2 {
                let mut fixed = free[k];
                fixed.tangent[side] = Quantity::fixed(value);
                assert_eq!(with(fixed), None, "{k} {side}");
                let mut fixed = free[k];
                fixed.curvature[side] = Quantity::of_size(value);
                assert_eq!(with(fixed), None, "{k} {side}");
            }
            let hinted =
                free[k].with_tangent(Quantity::initial(value)).with_curvature(Quantity::initial(value));
            assert_eq!(with(hinted), Some([0, 2]), "{k}");
            // A joint without a place is no anchor.
            let nowhere = with(free[k].with_position(Quantity::FREE));
            assert_eq!(
                nowhere,
                [None, Some([0, 2]), Some([0, 1]), Some([0, 2]), Some([0, 2]), Some([0, 2])][k]
            );
        }
        // By all three coordinates.
        let deep =
            joints([[1.0, 2.0, 3.0], [2.0, 1.0, 4.0], [1.0, 2.0, 5.5], [3.2, 2.0, 3.0], [1.0, 4.4, 3.0]]);
        assert_eq!(of(&deep, &SI), Some([0, 2]));
        let heap = joints([[1.0; 3]; 3]);
        assert_eq!(of(&heap, &SI), None);
    }

    #[test]
    fn only_a_curve_that_does_not_turn_in_all_is_held() {
        let anchored = |points: &[Joint], closed: bool| {
            let curve = Curve::new(points, closed);
            let model = planar(&curve, &SI);
            anchors(&model, &SI, &started(&model))
        };
        let eight = joints(EIGHT);
        assert_eq!(anchored(&eight, true), Some([0, 2]));
        assert_eq!(anchored(&eight, false), None);
        let round = joints([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.5, 0.0]]);
        assert_eq!(anchored(&round, true), None);
        let mut back = round;
        back.reverse();
        assert_eq!(anchored(&back, true), None);
        let deep = joints([[0.0, 0.0, 0.0], [2.0, 0.0, 0.5], [2.0, 1.0, 0.0], [0.0, 1.5, 1.0]]);
        let curve = Curve::new(&deep, true);
        let model = spatial(&curve, &SI);
        assert_eq!(anchors(&model, &SI, &started(&model)), None);
    }
}
