//! Feet, worst places, pulls and insertions against brute force, differences, and the curve as it was.

extern crate std;

use super::*;
use crate::curve::functional::Functional;
use crate::curve::joint::{Continuity, Curve, Joint, Quantity};
use crate::curve::obstacle::{Obstacle, Side};
use crate::curve::options::Options;
use crate::curve::passes::value_of;
use crate::curve::rows::place;
use crate::curve::tests::{planar, started};
use crate::order::Order;
use crate::root::sqrt;
use std::vec;
use std::vec::Vec;

type Point = SVector<f64, 2>;

/// The start of a planar curve through a joint at the origin: the local system is the caller's.
fn with<T>(curve: &Curve<'_>, work: impl FnOnce(&Model<'_, 2>, Vec<f64>) -> T) -> T {
    let model = planar(curve, &Options::DEFAULT);
    let state = started(&model);
    work(&model, state)
}

fn joints<const N: usize>(points: [[f64; 2]; N]) -> [Joint; N] {
    points.map(|[x, y]| Joint::at([x, y, 0.0]))
}

const WAVE: [[f64; 2]; 5] = [[0.0, 0.0], [2.0, 1.0], [4.0, -0.5], [6.0, 0.5], [7.0, 2.5]];
const RING: [[f64; 2]; 5] = [[0.0, 0.0], [3.0, -1.0], [5.0, 1.5], [3.0, 4.0], [0.0, 3.0]];

/// A place of a curve and its normal to the left.
fn beside(model: &Model<'_, 2>, state: &[f64], element: usize, t: f64) -> (Point, Point) {
    let [here, first, _] = place(&model.rows(element, state), t);
    let tangent = first / sqrt(first.dot(&first));
    (here, Point::from([-tangent[1], tangent[0]]))
}

#[test]
fn the_foot_of_a_point_beside_a_curve_is_where_the_curve_is_nearest() {
    let (open, closed) = (joints(WAVE), joints(RING));
    for curve in [Curve::open(&open), Curve { closed: true, ..Curve::open(&closed) }] {
        with(&curve, |model, state| {
            for element in 0..model.element_count() {
                for t in [0.0, 1e-6, 0.01, 0.03, 0.29, 0.5, 0.77, 0.99, 1.0 - 1e-6, 1.0] {
                    let (here, normal) = beside(model, &state, element, t);
                    for left in [-0.3, -0.01, 1e-7, 0.02, 0.3] {
                        let Some(foot) = Foot::of(model, &state, &(here + normal * left), 0.0) else {
                            panic!("{element} {t} {left}: no foot")
                        };
                        let (found, _) = beside(model, &state, foot.element, foot.t);
                        assert!((found - here).amax() < 1e-9, "{element} {t} {left}: {found}");
                        assert!((foot.left - left).abs() < 1e-9, "{element} {t} {left}: {}", foot.left);
                    }
                }
            }
        });
    }
}

#[test]
fn what_an_open_curve_does_not_pass_has_no_foot() {
    let wave = joints(WAVE);
    with(&Curve::open(&wave), |model, state| {
        for (element, t, ahead) in [(0, 0.0, -1.0), (3, 1.0, 1.0)] {
            let (here, normal) = beside(model, &state, element, t);
            let tangent = Point::from([normal[1], -normal[0]]) * ahead;
            for left in [-0.5, 0.0, 0.5] {
                let beyond = here + tangent * 0.3 + normal * left;
                assert!(Foot::of(model, &state, &beyond, 0.0).is_none(), "{element} {left}");
            }
            // Nearly beside the end it is still passed.
            let Some(foot) = Foot::of(model, &state, &(here + normal * 0.5 + tangent * 0.01), 0.0) else {
                panic!("{element}: no foot")
            };
            assert!((foot.element, foot.t) == (element, t) && (foot.left - 0.5).abs() < 1e-3);
        }
    });
    // A closed curve has no end where its numbers begin.
    let ring = joints(RING);
    with(&Curve { closed: true, ..Curve::open(&ring) }, |model, state| {
        let (here, normal) = beside(model, &state, 0, 0.0);
        let tangent = Point::from([normal[1], -normal[0]]);
        for ahead in [-0.3, 0.3] {
            assert!(Foot::of(model, &state, &(here + tangent * ahead + normal * 0.5), 0.0).is_some());
        }
    });
}

/// Within a corner's wedge the corner is nearest, and the sides of what halves it tell which side a point is on; of two
/// legs to which a point inside is equally near either will do.
#[test]
fn a_corner_has_two_sides() {
    let mut zigzag = joints([[0.0, 0.0], [2.0, 2.0], [4.0, 0.0]]);
    zigzag[1] = zigzag[1].with_continuity(Continuity::G0);
    let straight = |towards: [f64; 3]| Quantity::fixed(towards);
    zigzag[0] = zigzag[0].with_tangent(straight([1.0, 1.0, 0.0]));
    zigzag[1].tangent = [straight([1.0, 1.0, 0.0]), straight([1.0, -1.0, 0.0])];
    zigzag[2] = zigzag[2].with_tangent(straight([1.0, -1.0, 0.0]));
    with(&Curve::open(&zigzag), |model, state| {
        for x in [-0.2, 0.0, 0.2] {
            let Some(foot) = Foot::of(model, &state, &Point::from([2.0 + x, 2.5]), 0.0) else {
                panic!("no foot")
            };
            assert!((foot.left - sqrt(0.25 + x * x)).abs() < 1e-12, "{x}: {}", foot.left);
            assert!((foot.element, foot.t) == (0, 1.0) || (foot.element, foot.t) == (1, 0.0));
            let Some(foot) = Foot::of(model, &state, &Point::from([2.0 + x, 1.5]), 0.0) else {
                panic!("no foot")
            };
            assert!((foot.left + (0.5 - x.abs()) * sqrt(0.5)).abs() < 1e-12, "{x}: {}", foot.left);
            assert!(x == 0.0 || foot.element == usize::from(x > 0.0));
        }
    });
}

/// The obstacles of a curve that runs straight from left to right.
fn lack(obstacles: &[Obstacle]) -> Option<(f64, usize, f64, Point)> {
    let line = joints([[0.0, 0.0], [4.0, 0.0], [8.0, 0.0]]);
    with(&Curve::open(&line).with_obstacles(obstacles), |model, state| {
        worst(model, &state)
            .map(|(lack, code, foot, point)| (lack, code, 4.0 * (foot.element as f64 + foot.t), point))
    })
}

#[test]
fn the_worst_violation_comes_first() {
    let (left, right) = (Side::LEFT, Side::RIGHT);
    let [near, far] = [[3.0, 0.5, 0.0], [5.0, 0.9, 0.0]];
    let check = |found: Option<(f64, usize, f64, Point)>, wanted: (f64, usize, [f64; 2])| {
        let Some((lack, code, x, point)) = found else { panic!("nothing was found instead of {wanted:?}") };
        assert!((lack - wanted.0).abs() < 1e-9 && code == wanted.1, "{lack} {code} instead of {wanted:?}");
        assert!((point - Point::from(wanted.2)).amax() < 1e-9, "{point} instead of {wanted:?}");
        assert!((x - wanted.2[0]).abs() < 0.05, "{x} instead of {wanted:?}");
    };
    let point = |at, clearance, side| Obstacle::point(at, clearance, side);
    check(lack(&[point(near, 1.0, left)]), (0.5, 0, [3.0, 0.5]));
    // On the wrong side it lacks the distance and the clearance.
    check(lack(&[point(near, 1.0, right)]), (1.5, 0, [3.0, 0.5]));
    check(lack(&[point([3.0, -0.5, 0.0], 1.0, left)]), (1.5, 0, [3.0, -0.5]));
    check(lack(&[point(far, 1.0, left), point(near, 1.0, left)]), (0.5, 3, [3.0, 0.5]));
    check(lack(&[point(near, 1.0, left), point(far, 1.0, left)]), (0.5, 0, [3.0, 0.5]));
    // What is clear, or lies beyond the ends, is no violation.
    assert!(lack(&[point(near, 0.5, left)]).is_none());
    assert!(lack(&[point(near, 0.5 + 1e-9, left)]).is_none());
    check(lack(&[point(near, 0.5 + 1e-7, left)]), (1e-7, 0, [3.0, 0.5]));
    assert!(lack(&[point([9.0, 0.5, 0.0], 1.0, left)]).is_none());

    // Of a segment either end, numbered apart.
    let slope = [Obstacle::segment(near, far, 1.0, left)];
    check(lack(&slope), (0.5, 0, [3.0, 0.5]));
    let slope = [point(far, 0.0, left), Obstacle::segment(far, near, 1.0, left)];
    check(lack(&slope), (0.5, 4, [3.0, 0.5]));
}

/// A segment over the top of an arc, the top between two of its samples, to either side of the nearest.
#[test]
fn the_worst_place_of_a_segment_is_found_between_its_samples() {
    let arc = joints([[-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]).map(|joint| {
        let [x, y, _] = joint.position.value;
        Joint::at([x + 1.0, y, 0.0])
    });
    for (from, to) in [(0.15, 2.1), (0.1, 1.95), (0.2, 1.85), (0.3, 1.72), (0.05, 1.9)] {
        for (begin, end) in [(from, to), (to, from)] {
            let segment = [Obstacle::segment([begin, 1.2, 0.0], [end, 1.2, 0.0], 0.5, Side::LEFT)];
            with(&Curve::open(&arc).with_obstacles(&segment), |model, state| {
                let Some((lack, 2, foot, place)) = worst(model, &state) else { panic!("a place") };
                assert!((place[0] - 1.0).abs() < 1e-4 && (place[1] - 1.2).abs() < 1e-12, "{place}");
                assert!((lack - 0.3).abs() < 1e-9 && (foot.left - 0.2).abs() < 1e-9, "{lack}");
            });
        }
    }
}

/// The same where the segment is so long that no sample of it lies near the curve, in any direction and from either end.
#[test]
fn the_worst_place_of_a_long_segment_is_found() {
    let arc = joints([[-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
    let clear = |from: [f64; 2], to: [f64; 2], clearance: f64| {
        let segment =
            [Obstacle::segment([from[0], from[1], 0.0], [to[0], to[1], 0.0], clearance, Side::LEFT)];
        with(&Curve::open(&arc).with_obstacles(&segment), |model, state| {
            // The local system has its origin in the first joint.
            worst(model, &state).map(|(lack, code, _, place)| (lack, code, place - Point::from([1.0, 0.0])))
        })
    };
    for length in [3.0, 1e3, 5e23, 1e90] {
        for angle in [-0.6f64, -0.2, 0.0, 0.7] {
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let middle = [-1.2 * sin, 1.2 * cos];
            // One end near: of a segment that is far away at both ends the line is known only as well as those are.
            let [back, on] = [-0.5, length].map(|way| [middle[0] + way * cos, middle[1] + way * sin]);
            for (from, to) in [(back, on), (on, back)] {
                let Some((lack, 2, place)) = clear(from, to, 0.5) else {
                    panic!("{length} {angle}: no place between the ends")
                };
                assert!((place - Point::from(middle)).amax() < 1e-3, "{length} {angle}: {place}");
                // The start is no circle yet.
                assert!((lack - 0.3).abs() < 1e-5, "{length} {angle}: {lack}");
                assert_eq!(clear(from, to, 0.199), None, "{length} {angle}");
            }
        }
        // Far away at both ends, but along an axis.
        for (from, to) in [([-length, 1.2], [length, 1.2]), ([length, 1.2], [-length, 1.2])] {
            let Some((lack, 2, place)) = clear(from, to, 0.5) else { panic!("{length}: no place") };
            assert!((place - Point::from([0.0, 1.2])).amax() < 1e-3, "{length}: {place}");
            assert!((lack - 0.3).abs() < 1e-6, "{length}: {lack}");
        }
    }
}

/// Of many waves beside a wall one reaches nearer than the others.
#[test]
fn the_one_wave_that_is_too_near_a_wall_is_found() {
    for high in [7, 20, 51] {
        let waves: Vec<Joint> = (0..80)
            .map(|k| {
                let crest = if k % 2 == 0 { -0.5 } else { 0.5 };
                Joint::at([k as f64, if k == high { 0.8 } else { crest }, 0.0])
            })
            .collect();
        let wall = [Obstacle::segment([-3.0, 1.0, 0.0], [83.0, 1.0, 0.0], 0.3, Side::LEFT)];
        with(&Curve::open(&waves).with_obstacles(&wall), |model, state| {
            let found = worst(model, &state);
            if high % 2 == 0 {
                // A trough pulled up.
                let Some((lack, 2, foot, _)) = found else { panic!("{high}: nothing") };
                assert!(lack > 0.09 && foot.element.abs_diff(high) <= 1, "{high}: {lack} {}", foot.element);
            } else {
                let Some((lack, 2, foot, place)) = found else { panic!("{high}: nothing") };
                assert!((0.1..0.2).contains(&lack) && (place[0] - high as f64).abs() < 0.2, "{lack} {place}");
                assert!(foot.element.abs_diff(high) <= 1);
            }
        });
    }
}

/// Against every place of random segments: where any is too near one is found, and where none is across the curve the worst.
#[test]
fn no_violation_of_random_segments_is_missed() {
    let mut bits = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        (bits >> 11) as f64 / (1u64 << 53) as f64
    };
    let (open, closed) = (joints(WAVE), joints(RING));
    let (mut clear, mut near, mut across) = (0, 0, 0);
    for round in 0..400 {
        let [from, to] = [0; 2].map(|_| [12.0 * random() - 3.0, 12.0 * random() - 4.0, 0.0]);
        let side = if round % 2 == 0 { Side::LEFT } else { Side::RIGHT };
        let obstacle = [Obstacle::segment(from, to, 0.5 * random(), side)];
        let curve =
            if round % 4 < 2 { Curve::open(&open) } else { Curve { closed: true, ..Curve::open(&closed) } };
        with(&curve.with_obstacles(&obstacle), |model, state| {
            let [from, to] = [from, to].map(|[x, y, _]| Point::from([x, y]));
            let lack = |place: Point| {
                let foot = Foot::of(model, &state, &place, obstacle[0].clearance)?;
                Some(obstacle[0].clearance - side.sign() * foot.left)
            };
            let lacks: Vec<_> =
                (0..=2000).map(|k| lack(from + (to - from) * (f64::from(k) / 2000.0))).collect();
            // The worst, but for places that the curve's end just passes.
            let ends = [lacks[0], lacks[2000]].into_iter().flatten();
            let inner = lacks.windows(3).filter_map(|three| {
                let (Some(before), Some(here), Some(after)) = (three[0], three[1], three[2]) else {
                    return None;
                };
                (here >= before && here >= after).then_some(here)
            });
            let most = ends.chain(inner).fold(f64::NEG_INFINITY, f64::larger);
            let found = worst(model, &state);
            let Some((most_found, _, foot, place)) = found else {
                assert!(most < 1e-6, "round {round}: {most} was missed");
                clear += 1;
                return;
            };
            assert!(lack(place) == Some(most_found) && foot.left.abs() < 20.0);
            if most <= obstacle[0].clearance {
                near += 1;
                assert!(most_found > most - 1e-9, "round {round}: {most_found} instead of {most}");
            } else {
                across += 1;
            }
        });
    }
    assert!(clear > 30 && near > 20 && across > 30, "{clear} {near} {across}");
}

/// Against a difference of the functional itself, at every node: ends have one element, others two.
#[test]
fn the_pull_at_a_node_is_the_slope_of_the_functional() {
    for functional in [Functional::MVC, Functional::MEC, Functional::SI_MVC] {
        let (open, closed) = (joints(WAVE), joints(RING));
        for curve in [Curve::open(&open), Curve { closed: true, ..Curve::open(&closed) }] {
            let model = planar(&curve, &Options { functional, ..Options::DEFAULT });
            let state = started(&model);
            let first = weights_of_sums(&model, &state);
            let mut most = 0.0f64;
            for node in 0..model.node_count() {
                let (element, end) = if node == model.element_count() { (node - 1, 1) } else { (node, 0) };
                let (_, left) = beside(&model, &state, element, end as f64);
                let value = |step: f64| {
                    let mut moved = state.clone();
                    for d in 0..2 {
                        moved[Model::<2>::point_place(node) + d] += step * left[d];
                    }
                    value_of(&model, &moved)
                };
                let step = 1e-5;
                let slope = (value(step) - value(-step)) / (2.0 * step);
                let found = pull(&model, node, first, &state);
                assert!(
                    (found + slope).abs() < 1e-6 * slope.abs().larger(value(0.0)),
                    "{node}: {found} {slope}"
                );
                most = most.larger(slope.abs() / value(0.0));
            }
            assert!(most > 0.05, "{most}");
        }
    }
}

/// Where the curve already keeps just the distance, a contact's node and the division of all elements leave its shape alone,
/// and all other nodes and contacts stay what they are.
#[test]
fn a_contact_is_put_into_a_curve_without_changing_it() {
    let (open, closed) = (joints(WAVE), joints(RING));
    for curve in [Curve::open(&open), Curve { closed: true, ..Curve::open(&closed) }] {
        for cuts in [[(1, 0.4), (3, 0.6)], [(3, 0.25), (0, 0.1)], [(2, 0.8), (2, 0.3)]] {
            let (mut obstacles, mut feet) = (Vec::new(), Vec::new());
            with(&curve, |model, state| {
                for (number, (element, t)) in cuts.into_iter().enumerate() {
                    let (here, left) = beside(model, &state, element, t);
                    let side = if number == 0 { Side::LEFT } else { Side::RIGHT };
                    let centre = here + left * (0.3 * side.sign());
                    // A point, and a segment along the curve there.
                    let along = Point::from([left[1], -left[0]]) * (0.1 * number as f64);
                    let [from, to] = [centre - along, centre + along].map(|at| [at[0], at[1], 0.0]);
                    obstacles.push(Obstacle::segment(from, to, 0.3, side));
                    feet.push((here, centre));
                }
            });
            with(&curve.with_obstacles(&obstacles), |plain, before| {
                let (nodes, room) = (plain.node_count(), 4 * (plain.node_count() + 2));
                let (mut marks, mut old_marks) = (vec![0.0; room], vec![f64::NAN; room]);
                (0..nodes).for_each(|node| marks[node] = plain.joint_mark(node));
                let len = plain.touching(&marks, &[]).state_len();
                let (mut state, mut spare) = (vec![f64::NAN; len], vec![f64::NAN; len]);
                state[..before.len()].copy_from_slice(&before);
                let mut contacts = [f64::NAN; 2];
                let mut touching = Touching {
                    marks: &mut marks,
                    old_marks: &mut old_marks,
                    contacts: &mut contacts,
                    state: &mut state,
                    spare: &mut spare,
                    nodes,
                    used: 0,
                    divided: false,
                };
                for (number, (_, centre)) in feet.iter().enumerate() {
                    let foot = {
                        let now = plain.touching(&touching.marks[..touching.nodes], touching.contacts);
                        let Some(foot) = Foot::of(&now, touching.state, centre, 0.0) else {
                            panic!("a foot")
                        };
                        foot
                    };
                    touching.contacts[number] = (3 * number + 2 * number) as f64;
                    touching.used = number + 1;
                    insert(plain, &mut touching, &foot, centre);
                }
                let check = |touching: &Touching<'_>, parts: usize| {
                    assert_eq!(
                        touching.nodes,
                        (plain.element_count() + 2) * parts + usize::from(!plain.curve.closed)
                    );
                    let marks = &touching.marks[..touching.nodes];
                    let now = plain.touching(marks, touching.contacts);
                    let mut seen = 0;
                    for (node, &mark) in marks.iter().enumerate() {
                        let point =
                            Point::from([0, 1].map(|d| touching.state[Model::<2>::point_place(node) + d]));
                        if mark > 0.0 {
                            let wanted = plain.curve.joints[mark as usize - 1].position.value;
                            assert_eq!([point[0], point[1]], [wanted[0], wanted[1]]);
                        } else if mark < 0.0 {
                            let number = -mark as usize - 1;
                            assert!((point - feet[number].0).amax() < 1e-9, "{number}: {point}");
                            assert_eq!(now.contact_code(node), Some(5 * number));
                        }
                        seen += usize::from(mark != 0.0);
                    }
                    assert_eq!(seen, plain.node_count() + 2);
                    // Every element lies on the curve as it was.
                    for element in 0..now.element_count() {
                        for t in [0.0, 0.2, 0.5, 0.9] {
                            let (here, normal) = beside(&now, touching.state, element, t);
                            let Some(foot) = Foot::of(plain, &before, &here, 0.0) else { continue };
                            let (was, normal_was) = beside(plain, &before, foot.element, foot.t);
                            assert!((here - was).amax() < 1e-9, "{element} {t}: {here} {was}");
                            assert!((normal - normal_was).amax() < 1e-7, "{element} {t}");
                        }
                    }
                    let length =
                        |model: &Model<'_, 2>, state: &[f64]| crate::curve::passes::total(model, state)[1];
                    let (was, is) = (length(plain, &before), length(&now, touching.state));
                    assert!((is - was).abs() < 1e-6 * was, "{is} {was}");
                };
                check(&touching, 1);
                touching.divide(plain, 3);
                assert!(touching.divided);
                check(&touching, 3);
            });
        }
    }
}

/// The memory for contacts is what they take, whatever they touch: neither less nor more blocks, elements and numbers, and
/// blocks that are wide enough.
#[test]
fn room_for_contacts_is_what_they_take() {
    let (open, closed) = (joints(WAVE), joints(RING));
    let point = |x: f64| Obstacle::point([x, 5.0, 0.0], 0.5, Side::LEFT);
    let segment = |x: f64| Obstacle::segment([x, 5.0, 0.0], [x + 1.0, 6.0, 0.0], 0.5, Side::LEFT);
    let obstacles = [point(1.0), segment(2.0), segment(3.0)];
    for curve in [Curve::open(&open), Curve { closed: true, ..Curve::open(&closed) }] {
        with(&curve.with_obstacles(&obstacles), |plain, _| {
            for more in 1..=3 {
                let extended = Extended { model: plain, more };
                // Contacts in the second element, and in the first if there are three.
                let mut marks: Vec<f64> =
                    (0..plain.node_count()).map(|node| plain.joint_mark(node)).collect();
                for number in 0..more {
                    marks.insert(if number < 2 { 2 } else { 1 }, -(number as f64 + 1.0));
                }
                let contacts = [0.0, 4.0, 8.0];
                let touching = plain.touching(&marks, &contacts);
                assert_eq!(extended.blocks(), touching.blocks());
                assert_eq!(extended.elements(), touching.elements());
                assert_eq!(extended.state_len(), touching.state_len());
                assert_eq!(extended.is_coupled(), touching.is_coupled());
                assert!(extended.max_element_dofs() >= touching.max_element_dofs());
                assert_eq!(extended.max_element_dofs(), 3 * 4);
                let (mut room, mut taken) = (0, 0);
                for block in 0..touching.blocks() {
                    room += extended.dofs(block);
                    taken += touching.dofs(block);
                }
                assert!((taken..=taken + 8 * more).contains(&room), "{more}: {room} for {taken}");
                let reach = if curve.closed { 4 } else { 3 } * 4;
                assert_eq!(extended.envelope_bound(), room * reach.min(room));
            }
        });
    }
}
