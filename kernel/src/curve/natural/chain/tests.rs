//! Settled chains of every kind of joint: stationary in all that is free, with the rest kept.

extern crate std;

use super::super::functions::{COARSE, FINE};
use super::*;
use crate::curve::functional::Functional;
use crate::curve::joint::{Continuity, Curve, Given, Joint, Quantity};
use crate::curve::options::Options;
use crate::curve::tests::{planar, started};
use core::f64::consts::PI;
use std::vec;
use std::vec::Vec;

const EXACT: Effort = Effort { settled: 1e-10, iterations: 60, exact: true };

/// The start of a planar curve through fixed joints.
fn with<T>(curve: &Curve<'_>, functional: Functional, work: impl FnOnce(&Model<'_, 2>, &[f64]) -> T) -> T {
    let model = planar(curve, &Options { functional, ..Options::DEFAULT });
    work(&model, &started(&model))
}

fn memory<const N: usize>(model: &Model<'_, 2>) -> Vec<f64> {
    vec![f64::NAN; memory_len(N, model.node_count(), model.element_count(), model.curve.closed)]
}

/// Six joints around, with a corner, kinks in the curvature and fixed values as `kinds` says.
fn around(kinds: [u32; 6]) -> [Joint; 6] {
    core::array::from_fn(|k| {
        let at = k as f64 + 0.1 * (k % 2) as f64;
        let (sine, cosine) = (libm::sin(at), libm::cos(at));
        let joint = Joint::at([2.0 * cosine, 1.6 * sine, 0.0]);
        let along = [-2.0 * sine, 1.6 * cosine, 0.0];
        let tangent = Quantity::fixed(along);
        let curvature = |size: f64| {
            let by = size / sqrt(along[0] * along[0] + along[1] * along[1]);
            Quantity::fixed([-along[1] * by, along[0] * by, 0.0])
        };
        let mut out = joint;
        match kinds[k] {
            0 => {}
            1 => out = joint.with_tangent(tangent),
            2 => out = joint.with_tangent(tangent).with_curvature(curvature(0.4)),
            3 => out = joint.with_continuity(Continuity::G1),
            4 => {
                out = joint.with_continuity(Continuity::G1).with_tangent(tangent);
                out.curvature[0] = curvature(0.7);
            }
            5 => out = joint.with_continuity(Continuity::G1).with_tangent(tangent),
            6 => out = joint.with_continuity(Continuity::G0),
            7 => {
                out = joint.with_continuity(Continuity::G0);
                out.tangent[1] = tangent;
            }
            _ => {
                out = joint.with_continuity(Continuity::G0);
                out.tangent[0] = tangent;
                out.curvature[0] = curvature(0.6);
            }
        }
        out
    })
}

/// What is wrong at the joints of a settled chain: what is given is kept, what is shared agrees, and by nothing that is free
/// the functional sinks, to first order.
fn check<const N: usize, const C: usize>(
    chain: &Chain<'_, N, C>,
    tables: &'static Tables<N, C>,
    model: &Model<'_, 2>,
    state: &[f64],
    weigh: &Weigh,
) {
    let count = model.element_count();
    let natural = chain.integral(&Weigh { length: weigh.length.abs(), ..*weigh });
    let chords: Vec<(SVector<f64, 2>, Span<N>, Condensed<N>)> = (0..count)
        .map(|index| {
            let ends = [model.end(index, 0, state), model.end(index, 1, state)];
            let span = chain.span(index);
            let Some(found) = condense(tables, &span, weigh, 1.0, true) else { panic!("a regular span") };
            assert!(found.gap < 1e-9, "{}", found.gap);
            (ends[1].point - ends[0].point, span, found)
        })
        .collect();
    for (chord, span, _) in &chords {
        assert!((sqrt(chord.dot(chord)) - span.chord).abs() < 1e-14);
    }
    for (number, joint) in model.curve.joints.iter().enumerate() {
        // Direction and curvature on either side with what they belong to: span and end.
        let before = if number > 0 { Some(number - 1) } else { model.curve.closed.then(|| count - 1) };
        let sides = [(before, 1), ((number < count).then_some(number), 0)];
        let mut shared: Vec<[f64; 2]> = Vec::new();
        let mut slopes: Vec<[f64; 2]> = Vec::new();
        for (side, (index, end)) in sides.into_iter().enumerate() {
            let Some(index) = index else { continue };
            let (chord, span, found) = &chords[index];
            let values = [span.shared[2 * end], span.shared[2 * end + 1]];
            let direction = libm::atan2(chord[1], chord[0]) + values[0];
            shared.push([direction, values[1]]);
            let own = [found.gradient[2 * end], found.gradient[2 * end + 1]];
            let (tangent, curvature) = (&joint.tangent[side], &joint.curvature[side]);
            let (sine, cosine) = (libm::sin(direction), libm::cos(direction));
            if tangent.given == Given::FIXED {
                let [x, y, _] = tangent.value;
                assert!(
                    (cosine * y - sine * x).abs() < 1e-12 && cosine * x + sine * y > 0.0,
                    "{number} {side}"
                );
            }
            if curvature.given == Given::FIXED {
                let [x, y, _] = curvature.value;
                assert!((cosine * y - sine * x - values[1]).abs() < 1e-12, "{number} {side}: {}", values[1]);
            }
            let free = [tangent, curvature].map(|quantity| f64::from(quantity.given != Given::FIXED));
            slopes.push([own[0] * free[0], own[1] * free[1]]);
            // The end that is handed back.
            let along = chord / span.chord;
            let was = model.end(index, end, state);
            let is = chain.joint_end(index, end, span, &along, &was);
            assert!(is.point == was.point && is.curvature[0] == values[1]);
            let wanted = [SVector::from([cosine, sine]), SVector::from([-sine, cosine])];
            assert!((is.frame[0] - wanted[0]).amax() < 1e-12 && (is.frame[1] - wanted[1]).amax() < 1e-12);
            assert!(tangent.given != Given::FIXED || is.frame == was.frame);
        }
        let (shares_tangent, shares_curvature) =
            (joint.continuity != Continuity::G0, joint.continuity == Continuity::G2);
        for (which, shares) in [shares_tangent, shares_curvature].into_iter().enumerate() {
            if let ([one, other], true) = (shared.as_slice(), shares) {
                let mut off = one[which] - other[which];
                if which == 0 {
                    off -= 2.0 * PI * libm::round(off / (2.0 * PI));
                }
                assert!(off.abs() < 1e-9, "{number} {which}: {off}");
                let both = slopes[0][which] + slopes[1][which];
                assert!(both.abs() < 1e-7 * natural, "{number} {which}: {both} of {natural}");
            } else {
                for slope in &slopes {
                    assert!(slope[which].abs() < 1e-7 * natural, "{number} {which}: {slope:?} of {natural}");
                }
            }
        }
    }
}

const KINDS: [[u32; 6]; 5] =
    [[0, 0, 0, 0, 0, 0], [1, 0, 2, 3, 0, 4], [3, 4, 5, 0, 1, 0], [6, 0, 7, 3, 8, 0], [0, 8, 6, 6, 0, 1]];

#[test]
fn a_settled_chain_is_stationary_in_all_that_is_free_and_keeps_the_rest() {
    for kinds in KINDS {
        let joints = around(kinds);
        for closed in [false, true] {
            for functional in [Functional::MVC, Functional::MEC] {
                with(&Curve::new(&joints, closed), functional, |model, state| {
                    let (asked, _) = super::super::task(model, None);
                    for extra in [0.0, 0.2] {
                        let mut weigh = Weigh { length: extra, ..asked };
                        let mut memory = memory::<24>(model);
                        let Some(mut chain) = Chain::of(&FINE, model, state, None, &mut memory) else {
                            panic!("it can be closed")
                        };
                        let mut steps = 0;
                        let ended = chain.settle(&mut weigh, Law::Plain, &EXACT, &mut |_, _| {
                            steps += 1;
                            true
                        });
                        assert!(ended == Ended::Settled && weigh.length == extra, "{kinds:?} {closed}");
                        assert!(steps < 30, "{steps}");
                        check(&chain, &FINE, model, state, &weigh);
                        let [bend, slope, length] = chain.sums();
                        let value = weigh.bend * bend + weigh.slope * slope + weigh.length * length;
                        assert!((value - chain.integral(&weigh)).abs() < 1e-12 * value);
                        assert!((length - chain.length()).abs() < 1e-14 * length);
                    }
                });
            }
        }
    }
}

/// A power of the length that multiplies the integral, and a length that is given, by the tension that belongs to them.
#[test]
fn the_tension_is_the_one_that_the_law_asks_for() {
    for kinds in KINDS {
        let joints = around(kinds);
        for closed in [false, true] {
            with(&Curve::new(&joints, closed), Functional::MVC, |model, state| {
                let (asked, _) = super::super::task(model, None);
                let settle = |law: Law| {
                    let mut weigh = asked;
                    let mut memory = memory::<24>(model);
                    let Some(mut chain) = Chain::of(&FINE, model, state, None, &mut memory) else {
                        panic!("it can be closed")
                    };
                    let ended = chain.settle(&mut weigh, law, &EXACT, &mut |_, _| true);
                    assert!(ended == Ended::Settled, "{kinds:?} {closed}");
                    check(&chain, &FINE, model, state, &weigh);
                    (chain.integral(&asked), chain.length(), weigh.length)
                };
                for power in [1.0, 3.0] {
                    let (integral, length, tension) = settle(Law::Power(power));
                    let wanted = power * integral / length;
                    assert!((tension - wanted).abs() < 1e-7 * wanted, "{tension} {wanted}");
                }
                let (_, natural, _) = settle(Law::Plain);
                for factor in [0.98, 1.03] {
                    let (_, length, tension) = settle(Law::Length(factor * natural));
                    assert!((length - factor * natural).abs() < 1e-9 * natural, "{length}");
                    assert!((tension > 0.0) == (factor < 1.0), "{factor}: {tension}");
                }
            });
        }
    }
}

#[test]
fn who_watches_sees_every_iteration_and_may_stop() {
    let joints = around(KINDS[0]);
    with(&Curve::new(&joints, false), Functional::MVC, |model, state| {
        let (asked, _) = super::super::task(model, None);
        let run = |effort: &Effort, most: usize| {
            let mut memory = memory::<6>(model);
            let Some(mut chain) = Chain::of(&COARSE, model, state, None, &mut memory) else {
                panic!("a chain")
            };
            let (mut seen, mut before) = (Vec::new(), chain.sums());
            let ended = chain.settle(&mut asked.clone(), Law::Plain, effort, &mut |sums, step| {
                seen.push((*sums, step));
                seen.len() < most
            });
            // The first sums are the start's.
            if let Some((sums, _)) = seen.first() {
                for k in 0..3 {
                    before[k] -= sums[k];
                    assert!(before[k].abs() < 1e-2 * sums[k], "{k}: {before:?}");
                }
            }
            (ended, seen, chain.length())
        };
        let (ended, seen, length) = run(&EXACT, usize::MAX);
        assert!(ended == Ended::Settled && seen.len() > 2);
        let (last, step) = seen[seen.len() - 1];
        assert!(step < 1e-10 && (last[2] - length).abs() < 1e-9 * length);
        assert!(seen.windows(2).all(|two| two[1].1 < two[0].1), "{seen:?}");
        for most in 1..seen.len() {
            let (ended, some, _) = run(&EXACT, most);
            assert!(ended == Ended::Stopped && some == seen[..most]);
            let (ended, some, _) = run(&Effort { iterations: most, ..EXACT }, usize::MAX);
            assert!(ended == Ended::Failed && some == seen[..most]);
        }
        let rough = seen[1].1 * 1.01;
        let (ended, some, _) = run(&Effort { settled: rough, ..EXACT }, usize::MAX);
        assert!(ended == Ended::Settled && some.len() == 2);
    });
}

/// An antisymmetric S that turns too far has no minimum variation curve (thesis 4.10).
#[test]
fn a_curve_that_grows_is_given_up() {
    let joints = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
        .map(|point| Joint::at(point).with_tangent(Quantity::fixed([-1.0, 0.6, 0.0])));
    with(&Curve::open(&joints), Functional::MVC, |model, state| {
        let (mut weigh, law) = super::super::task(model, None);
        let mut memory = memory::<6>(model);
        let Some(mut chain) = Chain::of(&COARSE, model, state, None, &mut memory) else { panic!("a chain") };
        let start = chain.length();
        let ended = chain.settle(&mut weigh, law, &Effort { iterations: 100, ..EXACT }, &mut |_, _| true);
        assert!(ended == Ended::Grown && chain.length() > 4.0 * start, "{}", chain.length());
    });
}

/// A span closed the second-nearest way is another one, and longer; the others are as they were.
#[test]
fn one_span_is_bent_another_way() {
    let joints = [(0.0, 2.1), (1.0, 2.5), (2.0, 2.2), (3.0, 2.4)].map(|(x, angle)| {
        let tangent = Quantity::fixed([libm::cos(angle), libm::sin(angle), 0.0]);
        Joint::at([x, 0.0, 0.0]).with_tangent(tangent).with_continuity(Continuity::G1)
    });
    with(&Curve::open(&joints), Functional::MVC, |model, state| {
        let of = |bent: Option<usize>| -> [f64; 3] {
            let mut memory = memory::<6>(model);
            let Some(chain) = Chain::of(&COARSE, model, state, bent, &mut memory) else { panic!("{bent:?}") };
            core::array::from_fn(|index| chain.span(index).length())
        };
        let plain = of(None);
        for bent in 0..3 {
            let other = of(Some(bent));
            for index in 0..3 {
                assert_eq!(other[index] > 1.2 * plain[index], index == bent, "{bent}: {other:?} {plain:?}");
                assert_eq!(other[index] == plain[index], index != bent, "{bent}: {other:?} {plain:?}");
            }
        }
    });
}
