//! The properties of curves of thesis chapter 2 that hold for minimum variation curves, on random data, and the promises
//! that the kernel makes beside them: constraints, continuity, planes, bits.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's sines")]

use approx::assert_relative_eq;
use minvar::curve::{
    Continuity, Curve, Element, Functional, Given, Joint, Options, Quantity, Report, elements_len, solve,
    workspace_len,
};
use minvar::solve::{Record, Silent, Status};
use minvar_tests::curves::{
    MARKER, Vector, add, cross, derivatives, deviation, distance, dot, end_shape, even_points, extent,
    functional_value, norm, shape, solve_curve, sub, times, unit,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Proptest with the same cases every time.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: count,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x6d69_6e76_6172),
        max_shrink_iters: 200,
        ..ProptestConfig::default()
    }
}

/// A designer's data.
#[derive(Clone, Debug)]
struct Data {
    joints: Vec<Joint>,
    closed: bool,
}

impl Data {
    fn curve(&self) -> Curve<'_> {
        Curve::new(&self.joints, self.closed)
    }

    fn spans(&self) -> usize {
        self.curve().spans()
    }

    fn size(&self) -> f64 {
        extent(self.joints.iter().map(|joint| joint.position.value))
    }

    fn solve(&self, options: &Options) -> (Report, Vec<Element>) {
        solve_curve(&self.joints, self.closed, options).expect("the data are good")
    }
}

fn rotated(v: Vector, axis: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    add(add(times(v, cos), times(cross(axis, v), sin)), times(axis, dot(axis, v) * (1.0 - cos)))
}

/// What makes data: everything from -1 to 1, or a code.
#[derive(Clone, Debug)]
struct RawJoint {
    step: f64,
    turn: f64,
    lift: f64,
    lean: [f64; 2],
    bend: f64,
    tangent: u8,
    curvature: u8,
    continuity: u8,
}

fn raw_joint() -> impl Strategy<Value = RawJoint> {
    let number = || -1.0..1.0f64;
    ((number(), number(), number(), number(), number(), number()), (0u8..20, 0u8..20, 0u8..20)).prop_map(
        |((step, turn, lift, a, b, bend), (tangent, curvature, continuity))| RawJoint {
            step,
            turn,
            lift,
            lean: [a, b],
            bend,
            tangent,
            curvature,
            continuity,
        },
    )
}

/// How far data stray from an even polygon.
#[derive(Clone, Copy)]
struct Wildness {
    turn: f64,
    lean: f64,
    corners: bool,
    curvatures: bool,
}

/// Data for which a curve exists that nobody would call wild.
const GENTLE: Wildness = Wildness { turn: 0.6, lean: 0.3, corners: true, curvatures: false };
/// As gentle, without breaks of the curvature.
const SMOOTH: Wildness = Wildness { corners: false, ..GENTLE };
/// Anything: what is promised for a curve whatever its status.
const WILD: Wildness = Wildness { turn: 2.0, lean: 1.2, corners: true, curvatures: true };

/// Data with a unique minimum if gentle: corners and G1 joints have all their tangents.
fn build(raw: &[RawJoint], closed: bool, space: bool, wildness: Wildness) -> Data {
    let count = raw.len();
    let closed = closed && count > 2;
    let lift = if space { wildness.turn } else { 0.0 };
    let z = [0.0, 0.0, 1.0];
    let mut points = Vec::new();
    let (mut point, mut towards) = ([0.0; 3], [1.0, 0.0, 0.0]);
    for (i, joint) in raw.iter().enumerate() {
        if closed {
            let angle = (i as f64 + 0.3 * wildness.turn.min(1.0) * joint.turn) / count as f64 * TAU;
            let radius = 1.0 + 0.3 * wildness.turn.min(1.0) * joint.step;
            points.push([radius * angle.cos(), radius * angle.sin(), 0.5 * lift * joint.lift]);
        } else {
            points.push(point);
            point = add(point, times(towards, 1.05 + 0.45 * joint.step));
            towards = rotated(towards, z, wildness.turn * joint.turn);
            towards = rotated(towards, [0.0, 1.0, 0.0], lift * joint.lift);
        }
    }
    let mut joints: Vec<Joint> = points.iter().map(|&point| Joint::at(point)).collect();
    for (i, raw) in raw.iter().enumerate() {
        let before = if i > 0 {
            i - 1
        } else if closed {
            count - 1
        } else {
            0
        };
        let after = if i + 1 < count {
            i + 1
        } else if closed {
            0
        } else {
            i
        };
        let along = unit(sub(points[after], points[before]));
        let lean = |by: f64| {
            let t = rotated(along, z, wildness.lean * by);
            if space { rotated(t, [0.6, 0.8, 0.0], wildness.lean * raw.lift) } else { t }
        };
        let tangent = lean(raw.lean[0]);
        let end = !closed && (i == 0 || i + 1 == count);
        let joint = &mut joints[i];
        let corner = wildness.corners && !end && raw.continuity < 5;
        if count == 2 || corner || raw.tangent < if end { 13 } else { 5 } {
            *joint = joint.with_tangent(Quantity::fixed(times(tangent, 0.5 + raw.bend.abs())));
        } else if raw.tangent == 19 {
            *joint = joint.with_tangent(Quantity::initial(tangent));
        }
        if corner {
            let g0 = raw.continuity < 2;
            *joint = joint.with_continuity(if g0 { Continuity::G0 } else { Continuity::G1 });
            if g0 {
                joint.tangent[1].value = lean(raw.lean[1]);
            }
        }
        if wildness.curvatures && raw.curvature < 5 && joint.continuity == Continuity::G2 {
            let t = if joint.tangent[0] == Quantity::FREE {
                *joint = joint.with_tangent(Quantity::initial(tangent));
                tangent
            } else {
                joint.tangent[0].value
            };
            *joint = joint.with_curvature(Quantity::fixed(times(unit(cross(z, t)), raw.bend)));
        }
    }
    Data { joints, closed }
}

fn data(wildness: Wildness) -> impl Strategy<Value = Data> {
    (prop::collection::vec(raw_joint(), 2..=8), prop::bool::weighted(0.3), prop::bool::weighted(0.4))
        .prop_map(move |(raw, closed, space)| build(&raw, closed, space, wildness))
}

fn planar_data(wildness: Wildness) -> impl Strategy<Value = Data> {
    (prop::collection::vec(raw_joint(), 2..=8), prop::bool::weighted(0.3))
        .prop_map(move |(raw, closed)| build(&raw, closed, false, wildness))
}

fn functional() -> impl Strategy<Value = Functional> {
    prop_oneof![Just(Functional::MVC), Just(Functional::MEC)]
}

/// A unit vector and an angle.
fn turning() -> impl Strategy<Value = (Vector, f64)> {
    (-1.0..1.0f64, 0.0..TAU, -PI..PI).prop_map(|(z, longitude, angle)| {
        let r = (1.0 - z * z).sqrt();
        ([r * longitude.cos(), r * longitude.sin(), z], angle)
    })
}

/// A map that keeps shapes: an orthogonal part, a scale and a shift.
struct Similarity<F: Fn(Vector) -> Vector> {
    orthogonal: F,
    scale: f64,
    shift: Vector,
}

impl<F: Fn(Vector) -> Vector> Similarity<F> {
    fn point(&self, p: Vector) -> Vector {
        add(times((self.orthogonal)(p), self.scale), self.shift)
    }

    fn data(&self, data: &Data) -> Data {
        let mut data = data.clone();
        for joint in &mut data.joints {
            joint.position.value = self.point(joint.position.value);
            for side in 0..2 {
                joint.tangent[side].value = (self.orthogonal)(joint.tangent[side].value);
                let curvature = &mut joint.curvature[side].value;
                *curvature = times((self.orthogonal)(*curvature), 1.0 / self.scale);
            }
        }
        data
    }

    fn elements(&self, elements: &[Element]) -> Vec<Element> {
        let row = |(a, row): (usize, &Vector)| {
            if a == 0 || a == 5 { self.point(*row) } else { times((self.orthogonal)(*row), self.scale) }
        };
        let map = |element: &Element| {
            let mut rows = element.rows.iter().enumerate().map(row);
            Element { rows: std::array::from_fn(|_| rows.next().expect("six rows")) }
        };
        elements.iter().map(map).collect()
    }
}

const ORIGIN: Vector = [0.0; 3];

/// Solves data and their images: the curve of the images is the image of the curve.
fn commutes<F: Fn(Vector) -> Vector>(
    data: &Data,
    similarity: &Similarity<F>,
    tolerance: f64,
) -> Result<(), TestCaseError> {
    let (report, elements) = data.solve(&Options::DEFAULT);
    prop_assert_eq!(report.status, Status::Converged);
    let (other, found) = similarity.data(data).solve(&Options::DEFAULT);
    prop_assert_eq!(other.status, Status::Converged);
    let off = deviation(&similarity.elements(&elements), &found, data.spans());
    let allowed = tolerance * data.size() * similarity.scale;
    prop_assert!(off <= allowed, "{off:e} off, {allowed:e} allowed; values {} {}", report.value, other.value);
    Ok(())
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn turning_the_data_turns_the_curve(data in data(GENTLE), (axis, angle) in turning()) {
        commutes(&data, &Similarity { orthogonal: |v| rotated(v, axis, angle), scale: 1.0, shift: ORIGIN }, 1e-6)?;
    }

    #[test]
    fn moving_the_data_moves_the_curve(data in data(GENTLE), to in prop::array::uniform3(-1.0..1.0f64)) {
        commutes(&data, &Similarity { orthogonal: |v| v, scale: 1.0, shift: to }, 1e-6)?;
        commutes(&data, &Similarity { orthogonal: |v| v, scale: 1.0, shift: times(to, 1e6) }, 1e-6)?;
    }

    #[test]
    fn scaling_the_data_scales_the_curve(data in data(GENTLE)) {
        for scale in [1e-6, 1e6, 0.3] {
            commutes(&data, &Similarity { orthogonal: |v| v, scale, shift: ORIGIN }, 1e-6)?;
        }
    }

    #[test]
    fn mirroring_the_data_mirrors_the_curve(data in data(GENTLE), (axis, _) in turning()) {
        let mirror = |v| sub(v, times(axis, 2.0 * dot(axis, v)));
        commutes(&data, &Similarity { orthogonal: mirror, scale: 1.0, shift: ORIGIN }, 1e-6)?;
        commutes(&data, &Similarity { orthogonal: |v: Vector| [v[0], -v[1], v[2]], scale: 1.0, shift: ORIGIN }, 1e-6)?;
    }

    /// Where little is asked for, elements that run along the curve's direction as a function of arc length are taken
    /// as they are, by an estimate of what they exceed the minimum by.
    #[test]
    fn what_is_asked_for_loosely_is_as_near_as_asked(data in data(SMOOTH), digits in 4..9, functional in 0u32..4) {
        let relative_decrease = 0.1f64.powi(digits);
        let loose = Options { relative_decrease, functional: Functional(functional), ..Options::DEFAULT };
        let (report, _) = data.solve(&loose);
        prop_assert_eq!(report.status, Status::Converged);
        if report.linearisations == 0 {
            let (tight, _) = data.solve(&Options { relative_decrease: 1e-12, ..loose });
            prop_assert_eq!(tight.status, Status::Converged);
            let excess = (report.value - tight.value) / tight.value;
            prop_assert!(excess <= relative_decrease, "{excess:e}");
            prop_assert!(report.decrement <= relative_decrease * report.value);
        }
    }

    /// A quintic's minima come in pairs that differ in which end it runs through faster; where both are as good as
    /// equal, the reversed data may find the other one.
    #[test]
    fn reversing_the_joints_reverses_the_curve(data in data(SMOOTH)) {
        let (report, elements) = data.solve(&Options::DEFAULT);
        prop_assert_eq!(report.status, Status::Converged);
        let reversed = Data { joints: data.joints.iter().rev().map(reversed).collect(), ..data };
        let (other, mut found) = reversed.solve(&Options::DEFAULT);
        prop_assert_eq!(other.status, Status::Converged);
        if data.closed {
            // The span between the first two joints is the last but one now.
            found.rotate_left(data.joints.len() - 1);
        }
        let want: Vec<Element> = elements
            .iter()
            .rev()
            .map(|element| {
                let [a, b, c, d, e, f] = element.rows;
                Element { rows: [f, times(e, -1.0), d, c, times(b, -1.0), a] }
            })
            .collect();
        let apart = (other.value - report.value).abs() / report.value;
        let off = deviation(&want, &found, data.spans()) / data.size();
        if apart > 1e-9 && report.value > 1e-9 {
            prop_assert!(apart < 2e-5 && off < 1e-3, "values {} {}, {off:e} off", report.value, other.value);
        } else {
            prop_assert!(off < 1e-6, "{off:e} off");
        }
    }

    /// Whatever the status: a power of two changes no digit.
    #[test]
    fn a_power_of_two_scales_every_bit(data in data(WILD), functional in functional(), power in -250i32..250) {
        let options = Options { functional, max_iterations: 40, ..Options::DEFAULT };
        let scale = 2.0f64.powi(power);
        let similarity = Similarity { orthogonal: |v| v, scale, shift: ORIGIN };
        let (report, elements) = data.solve(&options);
        let (other, found) = similarity.data(&data).solve(&options);
        prop_assert_eq!(similarity.elements(&elements), found);
        prop_assert_eq!(report.iterations, other.iterations);
        prop_assert_eq!(report.status, other.status);
        prop_assert_eq!((report.length * scale).to_bits(), other.length.to_bits());
        let shrink = if functional == Functional::MEC { 1.0 / scale } else { 1.0 / scale / scale / scale };
        if power.abs() < 200 || functional == Functional::MEC {
            prop_assert_eq!((report.value * shrink).to_bits(), other.value.to_bits());
            prop_assert_eq!((report.bending / scale).to_bits(), other.bending.to_bits());
        }
    }

    #[test]
    fn the_functionals_scale_as_their_units_say(data in data(GENTLE), scale in 1e-3..1e3f64) {
        let similarity = Similarity { orthogonal: |v| v, scale, shift: ORIGIN };
        let scaled = similarity.data(&data);
        let solve = |data: &Data, functional| data.solve(&Options { functional, ..Options::DEFAULT }).0;
        let (one, other) = (solve(&data, Functional::MVC), solve(&scaled, Functional::MVC));
        prop_assert!(
            (other.value * scale.powi(3) - one.value).abs() <= 1e-9 * one.value + 1e-18,
            "{} {}", one.value, other.value
        );
        // The MEC has more valleys: its value is compared by the measured energy of one and the same curve.
        let (_, elements) = data.solve(&Options { functional: Functional::MEC, ..Options::DEFAULT });
        let (small, large) = (
            functional_value(Functional::MEC, &elements),
            functional_value(Functional::MEC, &similarity.elements(&elements)),
        );
        prop_assert!((large * scale - small).abs() <= 1e-9 * small + 1e-18, "{large:e} {small:e} {scale}");
        let measured = minvar::curve::measure::bending(&similarity.elements(&elements));
        prop_assert!((measured * scale - minvar::curve::measure::bending(&elements)).abs() <= 1e-9 * small + 1e-18);
    }

    #[test]
    fn exchanging_the_axes_in_a_circle_changes_no_bit_of_a_planar_curve(data in planar_data(WILD), functional in functional()) {
        let options = Options { functional, max_iterations: 40, ..Options::DEFAULT };
        let exchange = Similarity { orthogonal: |v: Vector| [v[2], v[0], v[1]], scale: 1.0, shift: ORIGIN };
        let (_, elements) = data.solve(&options);
        let (report, found) = exchange.data(&data).solve(&options);
        prop_assert!(report.planar);
        // Zeros may change their sign.
        prop_assert!(exchange.elements(&elements) == found);
    }

    #[test]
    fn planar_data_stay_in_their_plane_exactly(data in planar_data(WILD), across in 0usize..3, height in -1e3..1e3f64) {
        let place = |v: Vector| -> Vector {
            let mut out = [0.0; 3];
            (out[across], out[(across + 1) % 3], out[(across + 2) % 3]) = (v[2], v[0], v[1]);
            out
        };
        let mut shift = ORIGIN;
        shift[across] = height;
        let data = Similarity { orthogonal: place, scale: 1.0, shift }.data(&data);
        let (report, elements) = data.solve(&Options { max_iterations: 40, ..Options::DEFAULT });
        prop_assert!(report.planar);
        for element in &elements {
            for (a, row) in element.rows.iter().enumerate() {
                prop_assert_eq!(row[across], if a == 0 || a == 5 { height } else { 0.0 });
            }
        }
    }

    #[test]
    fn planar_data_in_a_tilted_plane_stay_in_it_to_rounding(
        data in planar_data(GENTLE),
        (axis, angle) in turning(),
        shift in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let tilt = |v| rotated(v, axis, angle);
        let (normal, data) = (tilt([0.0, 0.0, 1.0]), Similarity { orthogonal: tilt, scale: 1.0, shift }.data(&data));
        let (report, elements) = data.solve(&Options::DEFAULT);
        prop_assert!(report.planar);
        for element in &elements {
            for (a, row) in element.rows.iter().enumerate() {
                let off = dot(normal, if a == 0 || a == 5 { sub(*row, shift) } else { *row });
                prop_assert!(off.abs() <= 1e-14 * (10.0 + norm(*row)), "row {a} is {off:e} off");
            }
        }
    }

    #[test]
    fn what_is_fixed_is_kept(data in data(WILD), functional in functional(), elements_per_span in 1u32..4) {
        let options = Options { functional, elements_per_span, max_iterations: 30, ..Options::DEFAULT };
        let (_, elements) = data.solve(&options);
        for (joint, sides) in sides(&data, &elements) {
            for (side, element) in sides.iter().enumerate() {
                let Some(element) = element else { continue };
                prop_assert_eq!(element.rows[if side == 0 { 5 } else { 0 }], joint.position.value);
                let (tangent, curvature, rounding) = end_shape(element, 1 - side);
                let tangent_kept = joint.tangent[side].given == Given::FIXED;
                if tangent_kept {
                    prop_assert!(distance(tangent, unit(joint.tangent[side].value)) <= 1e-15);
                }
                if joint.curvature[side].given == Given::FIXED {
                    let given = joint.curvature[side].value;
                    let allowed = 1e-14 * norm(given) + 10.0 * rounding;
                    let off = if tangent_kept {
                        distance(curvature, given)
                    } else {
                        (norm(curvature) - norm(given)).abs()
                    };
                    prop_assert!(off <= allowed, "{curvature:?} {given:?} {off:e} {allowed:e}");
                }
            }
        }
    }

    #[test]
    fn joints_have_the_continuity_that_they_promise(data in data(WILD), functional in functional(), per_span in 1usize..4) {
        let elements_per_span = per_span as u32;
        let options = Options { functional, elements_per_span, max_iterations: 30, ..Options::DEFAULT };
        let (_, elements) = data.solve(&options);
        for k in 0..elements.len() {
            if !data.closed && k + 1 == elements.len() {
                continue;
            }
            let (one, other) = (&elements[k], &elements[(k + 1) % elements.len()]);
            let continuity = if (k + 1).is_multiple_of(per_span) {
                data.joints[(k + 1) / per_span % data.joints.len()].continuity
            } else {
                Continuity::G2
            };
            prop_assert_eq!(one.rows[5], other.rows[0]);
            let ((t1, k1, e1), (t2, k2, e2)) = (end_shape(one, 1), end_shape(other, 0));
            if continuity != Continuity::G0 {
                prop_assert!(distance(t1, t2) <= 1e-12, "tangents {t1:?} {t2:?}");
            }
            if continuity == Continuity::G2 {
                let allowed = 1e-12 * norm(k1).max(1.0) + 10.0 * (e1 + e2);
                prop_assert!(distance(k1, k2) <= allowed, "curvatures {k1:?} {k2:?}");
            }
        }
    }

    #[test]
    fn the_same_input_gives_the_same_bits_in_any_memory(data in data(WILD), functional in functional()) {
        let options = Options { functional, max_iterations: 40, elements_per_span: 2, ..Options::DEFAULT };
        let (report, elements) = data.solve(&options);
        let curve = data.curve();
        let needed = workspace_len(&curve, &options).expect("the data are good");
        for (dirt, more) in [(0.0, 0), (f64::INFINITY, 3), (-1.5e300, 1000), (1.0, 0), (f64::NAN, 0)] {
            let mut workspace = vec![dirt; needed + more];
            let mut found = vec![MARKER; elements_len(&curve, &options) + 1];
            let mut records = [Record::ZERO; 7];
            let again = solve(&curve, &options, &mut workspace, &mut found, &mut records, &mut Silent);
            let again = again.expect("the data are good");
            prop_assert_eq!(bits(&elements), bits(&found[..elements.len()]));
            prop_assert_eq!(found[elements.len()], MARKER);
            prop_assert_eq!(format!("{report:?}"), format!("{again:?}"));
        }
    }
}

proptest! {
    #![proptest_config(cases(12))]

    /// A span of two elements has a free G2 point in its middle. Giving that point as a joint changes neither the set
    /// of curves nor the minimum.
    #[test]
    fn a_joint_between_two_elements_of_a_span_changes_nothing(data in data(SMOOTH)) {
        let two = Options { elements_per_span: 2, max_iterations: 1000, ..Options::DEFAULT };
        let (report, elements) = data.solve(&two);
        prop_assert_eq!(report.status, Status::Converged);
        let joints = (0..2 * data.spans() + usize::from(!data.closed)).map(|node| {
            let inner = node % 2 == 1;
            if inner { Joint::at(elements[node].rows[0]) } else { data.joints[node / 2] }
        });
        let finer = Data { joints: joints.collect(), closed: data.closed };
        let (other, found) = finer.solve(&Options { max_iterations: 1000, ..Options::DEFAULT });
        prop_assert_eq!(other.status, Status::Converged);
        let off = deviation(&elements, &found, finer.spans()) / data.size();
        let apart = (other.value - report.value).abs();
        prop_assert!(off < 2e-5 && apart <= 2e-6 * report.value, "{off:e} off, {} {}", report.value, other.value);
    }

    /// Two elements a span come so near to the true curve that a joint on it, anywhere, leaves it where it is.
    #[test]
    fn a_joint_on_the_curve_does_not_change_it(data in data(SMOOTH), span in 0.0..1.0f64, at in 0.2..0.8f64) {
        let options = Options { elements_per_span: 3, max_iterations: 1000, ..Options::DEFAULT };
        let (report, elements) = data.solve(&options);
        prop_assert_eq!(report.status, Status::Converged);
        let span = (span * data.spans() as f64) as usize;
        let within = &elements[3 * span..3 * span + 3];
        let point = even_points(within, 100)[(100.0 * at) as usize];
        let mut joints = data.joints.clone();
        joints.insert(span + 1, Joint::at(point));
        let more = Data { joints, closed: data.closed };
        let (other, mut found) = more.solve(&options);
        prop_assert_eq!(other.status, Status::Converged);
        let added: Vec<Element> = found.splice(3 * span..3 * span + 6, []).collect();
        let mut rest = elements.clone();
        let cut: Vec<Element> = rest.splice(3 * span..3 * span + 3, []).collect();
        let off = deviation(&cut, &added, 1).max(if rest.is_empty() { 0.0 } else { deviation(&rest, &found, data.spans() - 1) });
        let apart = (other.value - report.value).abs();
        prop_assert!(
            off < 1e-4 * data.size() && apart <= 1e-4 * report.value,
            "{off:e} off, {} {}", report.value, other.value
        );
    }
}

fn bits(elements: &[Element]) -> Vec<u64> {
    elements.iter().flat_map(|element| element.rows).flatten().map(f64::to_bits).collect()
}

fn reversed(joint: &Joint) -> Joint {
    let mut joint = *joint;
    joint.tangent.swap(0, 1);
    joint.curvature.swap(0, 1);
    for tangent in &mut joint.tangent {
        tangent.value = times(tangent.value, -1.0);
    }
    joint
}

/// A joint with the element that arrives at it and the one that leaves from it.
type Sides<'a> = (&'a Joint, [Option<&'a Element>; 2]);

fn sides<'a>(data: &'a Data, elements: &'a [Element]) -> Vec<Sides<'a>> {
    let per_span = elements.len() / data.spans();
    let of = |(i, joint): (usize, &'a Joint)| {
        let arrives =
            if i > 0 { elements.get(i * per_span - 1) } else { elements.last().filter(|_| data.closed) };
        (joint, [arrives, elements.get(i * per_span)])
    };
    data.joints.iter().enumerate().map(of).collect()
}

/// A circle in space: centre, two perpendicular unit vectors and radius.
struct Circle {
    centre: Vector,
    axes: [Vector; 2],
    radius: f64,
}

impl Circle {
    fn new((axis, angle): (Vector, f64), centre: Vector, radius: f64) -> Self {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|v| rotated(v, axis, angle));
        Self { centre, axes, radius }
    }

    fn outward(&self, angle: f64) -> Vector {
        add(times(self.axes[0], angle.cos()), times(self.axes[1], angle.sin()))
    }

    fn point(&self, angle: f64) -> Vector {
        add(self.centre, times(self.outward(angle), self.radius))
    }

    fn tangent(&self, angle: f64) -> Vector {
        self.outward(angle + FRAC_PI_2)
    }

    /// The curvature vector is `-outward / radius` everywhere; positions lie on the circle.
    fn check(&self, elements: &[Element], tolerance: f64) -> Result<(), TestCaseError> {
        for element in elements {
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let from_centre = sub(derivatives(element, t)[0], self.centre);
                let off = (norm(from_centre) / self.radius - 1.0).abs();
                let [_, curvature, _] = shape(element, t);
                let bend = distance(times(curvature, self.radius), times(unit(from_centre), -1.0));
                prop_assert!(
                    off < 0.1 * tolerance && bend < tolerance,
                    "{off:e} off, curvature {bend:e} off"
                );
            }
        }
        Ok(())
    }
}

/// What one quintic reaches on an arc of the unit circle: the value at a quarter (from numerics.md), which rises with the
/// ninth power of the angle or so, and rounding.
fn best_on_arc(angle: f64) -> f64 {
    3.95e-11 * (angle / FRAC_PI_2).powi(9)
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn points_on_a_circle_with_one_tangent_give_the_circle(
        gaps in prop::collection::vec(0.3..1.6f64, 1..=6),
        which in 0.0..1.0f64,
        turning in turning(),
        centre in prop::array::uniform3(-3.0..3.0f64),
        radius in 0.01..100.0f64,
    ) {
        let circle = Circle::new(turning, centre, radius);
        let total: f64 = gaps.iter().sum();
        prop_assume!(total < 6.0);
        let mut angles = vec![0.0];
        gaps.iter().for_each(|gap| angles.push(angles[angles.len() - 1] + gap));
        let which = (which * angles.len() as f64) as usize;
        let joints: Vec<Joint> = angles
            .iter()
            .enumerate()
            .map(|(i, &angle)| {
                let joint = Joint::at(circle.point(angle));
                if i == which { joint.with_tangent(Quantity::fixed(circle.tangent(angle))) } else { joint }
            })
            .collect();
        let (report, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
        prop_assert_eq!(report.status, Status::Converged);
        prop_assert!(report.planar);
        circle.check(&elements, 4e-6)?;
        let best: f64 = gaps.iter().map(|&gap| best_on_arc(gap)).sum();
        let value = report.variation * radius.powi(3);
        prop_assert!(value < 3.0 * best + 1e-13, "{value:e} {best:e}");
        prop_assert!((report.length / radius - total).abs() < 1e-6 * total);
    }

    #[test]
    fn three_or_more_points_on_a_circle_give_the_closed_circle(
        lean in prop::collection::vec(-0.2..0.2f64, 4..=9),
        turning in turning(),
        centre in prop::array::uniform3(-3.0..3.0f64),
        radius in 0.01..100.0f64,
    ) {
        let circle = Circle::new(turning, centre, radius);
        let count = lean.len() as f64;
        let joints: Vec<Joint> = lean
            .iter()
            .enumerate()
            .map(|(i, lean)| Joint::at(circle.point((i as f64 + lean) / count * TAU)))
            .collect();
        let (report, elements) = solve_curve(&joints, true, &Options::DEFAULT).expect("good data");
        prop_assert_eq!(report.status, Status::Converged);
        circle.check(&elements, 4e-5)?;
        prop_assert!((report.length / radius - TAU).abs() < 1e-5);
        prop_assert!((report.bending * radius - TAU).abs() < 1e-5);
    }

    #[test]
    fn points_on_a_straight_line_give_the_line(
        steps in prop::collection::vec(0.1..3.0f64, 1..=7),
        tangent in prop::option::of(0.0..1.0f64),
        (direction, _) in turning(),
        from in prop::array::uniform3(-3.0..3.0f64),
        functional in functional(),
        elements_per_span in 1u32..4,
    ) {
        let mut along = vec![0.0];
        steps.iter().for_each(|step| along.push(along[along.len() - 1] + step));
        let mut joints: Vec<Joint> = along.iter().map(|&s| Joint::at(add(from, times(direction, s)))).collect();
        if let Some(which) = tangent {
            let which = (which * joints.len() as f64) as usize;
            joints[which] = joints[which].with_tangent(Quantity::fixed(times(direction, 7.0)));
        }
        let options = Options { functional, elements_per_span, ..Options::DEFAULT };
        let (report, elements) = solve_curve(&joints, false, &options).expect("good data");
        prop_assert_eq!(report.status, Status::Converged);
        let total = along[along.len() - 1];
        prop_assert!((report.length - total).abs() < 1e-12 * total);
        prop_assert!(report.value < 1e-24, "{:e}", report.value);
        for element in &elements {
            for k in 0..=10 {
                let [point, first, ..] = derivatives(element, f64::from(k) / 10.0);
                let off = norm(cross(sub(point, from), direction));
                prop_assert!(off < 1e-13 * (1.0 + total), "{off:e} off the line");
                prop_assert!(dot(unit(first), direction) > 1.0 - 1e-13);
            }
        }
    }
}

#[test]
fn a_quarter_circle_reaches_the_best_value_of_a_quintic() {
    let joints: Vec<Joint> =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(Joint::at).into();
    let (report, elements) = solve_curve(&joints, true, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    // numerics.md: 3.95e-11 a quarter, at |C'| = 1.59456.
    assert_relative_eq!(report.value, 4.0 * 3.95e-11, max_relative = 2e-3);
    for element in &elements {
        assert_relative_eq!(norm(element.rows[1]), 1.59456, max_relative = 1e-4);
    }
}

/// Two arcs of different radius that touch in a G1 joint.
fn touching_arcs(continuity: Continuity) -> [Joint; 3] {
    let up = Quantity::fixed([0.0, 1.0, 0.0]);
    [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(up),
        Joint::at([1.0, 1.0, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])).with_continuity(continuity),
        Joint::at([3.0, -1.0, 0.0]).with_tangent(Quantity::fixed([0.0, -1.0, 0.0])),
    ]
}

#[test]
fn a_g1_joint_lets_the_curvature_jump_and_a_g2_joint_does_not() {
    let (report, elements) =
        solve_curve(&touching_arcs(Continuity::G1), false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let ((t1, k1, _), (t2, k2, _)) = (end_shape(&elements[0], 1), end_shape(&elements[1], 0));
    assert!(distance(t1, t2) < 1e-15);
    // The quarter circles of radius 1 and 2.
    assert_relative_eq!(k1[1], -1.0, max_relative = 1e-5);
    assert_relative_eq!(k2[1], -0.5, max_relative = 1e-5);
    assert!(report.value < 1e-10);

    let (report, elements) =
        solve_curve(&touching_arcs(Continuity::G2), false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let ((_, k1, _), (_, k2, _)) = (end_shape(&elements[0], 1), end_shape(&elements[1], 0));
    assert!(distance(k1, k2) < 1e-14);
    assert!(report.value > 0.01);
}

#[test]
fn a_g0_joint_is_a_corner_and_its_sides_do_not_know_each_other() {
    let mut joints = touching_arcs(Continuity::G0);
    joints[1].tangent[1] = Quantity::fixed([0.0, 1.0, 0.0]);
    let (report, both) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let ((t1, ..), (t2, ..)) = (end_shape(&both[0], 1), end_shape(&both[1], 0));
    assert!(distance(t1, [1.0, 0.0, 0.0]) < 1e-15 && distance(t2, [0.0, 1.0, 0.0]) < 1e-15);
    for (half, side) in [(0, 0), (1, 1)] {
        let mut alone = [joints[half], joints[half + 1]];
        alone[1 - half] = alone[1 - half].with_tangent(joints[1].tangent[side]);
        let (report, one) = solve_curve(&alone, false, &Options::DEFAULT).expect("good data");
        assert_eq!(report.status, Status::Converged);
        assert!(deviation(&one, &both[half..=half], 1) < 1e-7);
    }
}

#[test]
fn a_free_tangent_at_a_corner_differs_on_its_sides() {
    let up = Quantity::fixed([0.0, 1.0, 0.0]);
    let joints = [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(up),
        Joint::at([2.0, 0.0, 0.0]).with_continuity(Continuity::G0),
        Joint::at([4.0, 0.0, 0.0]).with_tangent(up),
    ];
    let (report, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    assert_eq!(report.status, Status::Converged);
    // A half circle down to the corner, and another one of which only the end is given: (0, -1) arriving, (0, -1) leaving.
    let ((t1, ..), (t2, ..)) = (end_shape(&elements[0], 1), end_shape(&elements[1], 0));
    assert!(distance(t1, [0.0, -1.0, 0.0]) < 1e-3 && distance(t2, [0.0, -1.0, 0.0]) < 1e-3, "{t1:?} {t2:?}");
    let joints = [joints[0], joints[1], joints[2].with_tangent(Quantity::fixed([1.0, 0.0, 0.0]))];
    let (_, elements) = solve_curve(&joints, false, &Options::DEFAULT).expect("good data");
    let ((t1, ..), (t2, ..)) = (end_shape(&elements[0], 1), end_shape(&elements[1], 0));
    assert!(distance(t1, [0.0, -1.0, 0.0]) < 1e-3 && distance(t2, [1.0, 0.0, 0.0]) < 1e-6, "{t1:?} {t2:?}");
}

#[test]
fn initial_values_are_start_values_only() {
    let plain = [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([1.0, 0.2, 0.0])),
        Joint::at([1.0, 0.5, 0.1]),
        Joint::at([2.0, 0.3, 0.3]),
        Joint::at([3.0, 0.9, 0.2]),
    ];
    // One element a span has several minima for one shape; two have none that differ visibly.
    let two = Options { elements_per_span: 2, ..Options::DEFAULT };
    let (report, elements) = solve_curve(&plain, false, &two).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let mut seeded = plain;
    seeded[1] = seeded[1].with_tangent(Quantity::initial([1.0, 0.5, 0.3]));
    seeded[2] = seeded[2]
        .with_tangent(Quantity::initial([3.0, -0.3, 0.0]))
        .with_curvature(Quantity::initial([0.0, 0.0, 1.0]));
    seeded[3] = seeded[3].with_tangent(Quantity::initial([1.0, 0.0, 0.0]));
    let (other, found) = solve_curve(&seeded, false, &two).expect("good data");
    assert_eq!(other.status, Status::Converged);
    assert_eq!(other.unknowns, report.unknowns);
    assert!((other.value - report.value).abs() < 1e-7 * report.value);
    assert!(deviation(&elements, &found, 3) < 1e-4);

    let (report, _) = solve_curve(&plain, false, &Options::DEFAULT).expect("good data");
    // A point that is only a start value is left by the curve, which then is that of the other points.
    let mut pushed = plain;
    pushed[2] = pushed[2].with_position(Quantity::initial([2.0, 0.4, 0.25]));
    let (other, found) = solve_curve(&pushed, false, &Options::DEFAULT).expect("good data");
    assert_eq!(other.status, Status::Converged);
    assert!(other.value < report.value);
    assert!(distance(found[1].rows[5], [2.0, 0.4, 0.25]) > 1e-3);
    assert_eq!(found[0].rows[5], found[1].rows[0]);
    let free = [plain[0], plain[1], plain[3]];
    let (_, fewer) = solve_curve(&free, false, &two).expect("good data");
    let ends: Vec<Element> = fewer[2..].to_vec();
    assert!(deviation(&ends, &found[1..], 1) < 1e-4);
}

/// The README's table of memory: bytes of workspace and of elements.
#[test]
fn memory_is_what_the_readme_says() {
    let coving = [
        Joint::at([0.5, -12.0, 0.0])
            .with_tangent(Quantity::fixed([0.0, 1.0, 0.0]))
            .with_curvature(Quantity::fixed([0.27, 0.0, 0.0])),
        Joint::at([20.0, -0.5, 0.0]).with_tangent(Quantity::fixed([1.0, 0.0, 0.0])),
    ];
    let points = [[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.89], [6.0, 1.2]];
    let planar = points.map(|[x, y]| Joint::at([x, y, 0.0]));
    let space: [Joint; 7] =
        std::array::from_fn(|i| Joint::at([points[i][0], points[i][1], 0.3 * (i * i) as f64]));
    let readme =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md")).expect("README.md");
    for (name, joints, elements_per_span) in [
        ("2 joints, planar", &coving[..], 1),
        ("2 joints, planar, 8 elements", &coving[..], 8),
        ("7 joints, planar", &planar[..], 1),
        ("7 joints, space", &space[..], 1),
    ] {
        let row = readme.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect(name);
        let told = |column: usize| -> usize {
            let cell = row.split('|').nth(column).expect("a cell");
            cell.chars().filter(char::is_ascii_digit).collect::<String>().parse().expect("a number")
        };
        let (curve, options) = (Curve::open(joints), Options { elements_per_span, ..Options::DEFAULT });
        assert_eq!(workspace_len(&curve, &options).expect("good data") * 8, told(3), "{name}");
        assert_eq!(elements_len(&curve, &options) * size_of::<Element>(), told(4), "{name}");
        let (report, _) = solve_curve(joints, false, &options).expect("good data");
        assert_eq!(report.unknowns, told(2), "{name}");
    }
}
