//! The functionals of space curves that know torsion (thesis 4.3, 4.4): zero on helices, true minima, torsion that is
//! continuous, and values by an evaluation that shares nothing with the kernel.

#![allow(clippy::disallowed_methods, reason = "the tests may use the platform's cosine and powers")]

use minvar::curve::{
    Curve, CurveError, Element, Functional, Joint, OptionName, Options, Quantity, Reference, Report,
    elements_len, solve, update, workspace_len,
};
use minvar::solve::{Control, Observer, Record, Silent, Status};
use minvar_tests::appendix::figures;
use minvar_tests::compare::kernel_joints;
use minvar_tests::curves::{
    Vector, cross, derivatives, deviation, dot, gauss_legendre, norm, solve_curve, sub, times, unit,
};

const SPACE: [Functional; 2] = [Functional::SPACE_MVC, Functional::SPACE_MEC];

fn options(functional: Functional, elements_per_span: u32) -> Options {
    Options { functional, elements_per_span, ..Options::DEFAULT }
}

/// Solves a curve that must have a minimum.
fn solved(joints: &[Joint], closed: bool, options: &Options) -> (Report, Vec<Element>) {
    let (report, elements) = solve_curve(joints, closed, options).expect("good data");
    assert_eq!(report.status, Status::Converged, "{} iterations", report.iterations);
    assert!((report.fine_value - report.value).abs() <= 1e-4 * report.value + 1e-12);
    (report, elements)
}

/// Joints on one turn of a helix with the radius 1 that climbs by 0.35 a radian.
fn helix(joints: u32) -> Vec<Joint> {
    (0..joints)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(joints - 1);
            Joint::at([angle.cos(), angle.sin(), 0.35 * angle])
        })
        .collect()
}

/// Fig. 4.16 of the thesis.
fn simple_space_curve() -> Vec<Joint> {
    let all = figures();
    let figure = all.iter().find(|figure| figure.id == "4.16").expect("in the appendix");
    kernel_joints(figure)
}

/// A closed curve that winds, without symmetry.
fn ring() -> Vec<Joint> {
    (0..7)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / 7.0;
            Joint::at([3.0 * angle.cos(), 2.0 * angle.sin(), 0.7 * (2.0 * angle).cos() + 0.2 * angle.sin()])
        })
        .collect()
}

/// `C''''` of a quintic at `t`.
fn fourth(element: &Element, t: f64) -> Vector {
    std::array::from_fn(|d| {
        let [p0, v0, a0, a1, v1, p1] = element.rows.map(|row| row[d]);
        let (h, v, a) = (p1 - p0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0);
        24.0 * (-15.0 * h + 7.0 * v - a) + 120.0 * t * (6.0 * h - 3.0 * v + 0.5 * a)
    })
}

/// Speed, curvature, torsion, and their derivatives by arc length.
fn frenet(element: &Element, t: f64) -> (f64, [f64; 2], [f64; 2]) {
    let [_, d1, d2, d3] = derivatives(element, t);
    let speed = norm(d1);
    let normal = cross(d1, d2);
    let (size, change) = (norm(normal), cross(d1, d3));
    let (curvature, torsion) = (size / speed.powi(3), dot(normal, d3) / size / size);
    let growth = dot(unit(normal), change);
    let bend = growth / speed.powi(3) - 3.0 * size * dot(d1, d2) / speed.powi(5);
    let twist =
        (dot(change, d3) + dot(normal, fourth(element, t))) / size / size - 2.0 * torsion * growth / size;
    (speed, [curvature, torsion], [bend / speed, twist / speed])
}

/// The functional by the Frenet formulas, over 40 Gauss–Legendre points an element.
fn value(functional: Functional, elements: &[Element]) -> f64 {
    let rule = gauss_legendre(40);
    let density = |element: &Element, t: f64| {
        let (speed, own, slope) = frenet(element, t);
        let [a, b] = if functional == Functional::SPACE_MEC { own } else { slope };
        (a * a + b * b) * speed
    };
    elements
        .iter()
        .map(|element| rule.iter().map(|&(t, weight)| weight * density(element, t)).sum::<f64>())
        .sum()
}

/// The largest jump of torsion between neighbours.
fn torsion_jump(elements: &[Element], closed: bool) -> f64 {
    let pairs = (0..elements.len() - usize::from(!closed)).map(|i| (i, (i + 1) % elements.len()));
    pairs.fold(0.0, |most: f64, (a, b)| {
        let [before, after] = [frenet(&elements[a], 1.0).1[1], frenet(&elements[b], 0.0).1[1]];
        most.max((before - after).abs())
    })
}

fn spread(elements: &[Element], of: usize) -> [f64; 2] {
    let values = elements.iter().flat_map(|element| (0..=16).map(move |i| (element, f64::from(i) / 16.0)));
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], (element, t)| {
        let x = frenet(element, t).1[of];
        [least.min(x), most.max(x)]
    })
}

fn close(found: f64, wanted: f64, allowed: f64, what: &str) {
    assert!((found - wanted).abs() <= allowed * wanted.abs(), "{what}: {found}, not {wanted}");
}

#[test]
fn points_of_a_helix_give_the_helix() {
    let (curvature, torsion) = (1.0 / (1.0 + 0.35 * 0.35), 0.35 / (1.0 + 0.35 * 0.35));
    for (elements, value, allowed) in [(1, 2e-7, 1e-4), (2, 1e-9, 2e-6)] {
        let (report, found) = solved(&helix(5), false, &options(Functional::SPACE_MVC, elements));
        // On the scale of a curve of this length that turns by a radian or so.
        assert!(report.value < value && report.value > 0.0, "{}", report.value);
        for (of, wanted) in [curvature, torsion].into_iter().enumerate() {
            for found in spread(&found, of) {
                close(found, wanted, allowed, "curvature and torsion");
            }
        }
        assert!(torsion_jump(&found, false) < 1e-8);
    }
}

#[test]
fn peters_helix_is_one() {
    // Half of the data of Fig. 4.21.
    let all = figures();
    let figure = all.iter().find(|figure| figure.id == "4.21").expect("in the appendix");
    let joints = kernel_joints(figure);
    let (report, elements) = solved(&joints[6..], false, &options(Functional::SPACE_MVC, 1));
    close(report.value, 6.4135e-9, 1e-3, "V");
    for (of, wanted) in [0.2890, 0.0920].into_iter().enumerate() {
        for found in spread(&elements, of) {
            close(found, wanted, 2e-4, "curvature and torsion");
        }
    }
}

#[test]
fn a_space_curve_reaches_its_true_minimum_with_continuous_torsion() {
    // The values with torsion held exactly, by another program.
    for (count, wanted) in [(1, 3.14082), (2, 3.08628), (4, 3.08624)] {
        let (report, elements) = solved(&simple_space_curve(), false, &options(Functional::SPACE_MVC, count));
        close(report.value, wanted, 4e-6, "V");
        close(report.value, value(Functional::SPACE_MVC, &elements), 1e-8, "V by the Frenet formulas");
        assert!(torsion_jump(&elements, false) < 1e-6);
        assert!(!report.planar && report.iterations < 120, "{}", report.iterations);
    }
    // Less than that of the curve of least variation of curvature alone.
    let (_, plain) = solved(&simple_space_curve(), false, &options(Functional::MVC, 1));
    assert!(value(Functional::SPACE_MVC, &plain) > 3.2);
}

#[test]
fn a_closed_curve_is_found_and_closes_in_torsion() {
    for functional in SPACE {
        let (report, elements) = solved(&ring(), true, &options(functional, 2));
        close(report.value, value(functional, &elements), 1e-6, "by the Frenet formulas");
        let (fewer, _) = solved(&ring(), true, &options(functional, 1));
        assert!(report.value < fewer.value);
        if functional == Functional::SPACE_MVC {
            assert!(torsion_jump(&elements, true) < 1e-6);
        }
    }
}

#[test]
fn circles_and_planar_data_are_those_of_the_plane() {
    let arc: Vec<Joint> =
        (0..5).map(|i| Joint::at([(0.9 * f64::from(i)).cos(), (0.9 * f64::from(i)).sin(), 0.0])).collect();
    for count in [1, 2] {
        for dimension in [0, 3] {
            let options = Options { dimension, ..options(Functional::SPACE_MVC, count) };
            let (report, _) = solved(&arc, false, &options);
            assert!(report.value < 1e-12, "{}", report.value);
        }
    }
    let points = [[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.89], [6.0, 1.2]];
    let joints = points.map(|[x, y]| Joint::at([x, y, 0.0]));
    for (space, plane) in SPACE.into_iter().zip([Functional::MVC, Functional::MEC]) {
        let (same, elements) = solved(&joints, false, &options(space, 1));
        let (wanted, expected) = solved(&joints, false, &options(plane, 1));
        assert!(same.planar);
        assert_eq!(same.value.to_bits(), wanted.value.to_bits());
        assert_eq!(elements, expected);
        // With inflections, as a space curve.
        let (report, _) = solved(&joints, false, &Options { dimension: 3, ..options(space, 1) });
        close(report.value, wanted.value, 1e-6, "in space");
    }
}

#[test]
fn the_value_belongs_to_the_shape() {
    for (functional, power) in SPACE.into_iter().zip([3, 1]) {
        let (report, elements) = solved(&simple_space_curve(), false, &options(functional, 2));
        let allowed = 1e-8;
        let turned = |joint: &Joint, size: f64| {
            // About the axis (1, 2, 2)/3.
            let axis = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
            let (sin, cos) = (0.8f64.sin(), 0.8f64.cos());
            let turn = |x: Vector| {
                let (along, across) = (times(axis, dot(axis, x) * (1.0 - cos)), cross(axis, x));
                std::array::from_fn(|d| x[d] * cos + across[d] * sin + along[d])
            };
            let mut out = *joint;
            out.position.value = times(turn(joint.position.value), size);
            out.tangent = joint.tangent.map(|given| Quantity { value: turn(given.value), ..given });
            out
        };
        for size in [1e-3, 1.0, 1e3] {
            let joints: Vec<Joint> = simple_space_curve().iter().map(|joint| turned(joint, size)).collect();
            let (found, _) = solved(&joints, false, &options(functional, 2));
            close(found.value * f64::powi(size, power), report.value, allowed, "scaled and turned");
        }
        let mut back: Vec<Joint> = simple_space_curve();
        back.reverse();
        for joint in &mut back {
            joint.tangent = [1, 0].map(|side| Quantity {
                value: times(joint.tangent[side].value, -1.0),
                ..joint.tangent[side]
            });
        }
        let (found, reversed) = solved(&back, false, &options(functional, 2));
        close(found.value, report.value, allowed, "reversed");
        let reversed: Vec<Element> = reversed
            .iter()
            .rev()
            .map(|element| {
                let [p0, v0, a0, a1, v1, p1] = element.rows;
                Element { rows: [p1, times(v1, -1.0), a1, a0, times(v0, -1.0), p0] }
            })
            .collect();
        assert!(deviation(&elements, &reversed, 2) < 1e-4);
    }
}

/// At a minimum the functional's derivative vanishes by all that is free.
#[test]
fn a_single_element_is_stationary_by_an_independent_evaluation() {
    let joints = [
        Joint::at([0.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.3, 1.0, 0.2])),
        Joint::at([1.0, 0.4, 0.6]).with_tangent(Quantity::fixed([0.2, -0.5, 1.0])),
    ];
    for functional in SPACE {
        let (report, elements) = solved(&joints, false, &options(functional, 1));
        let at = elements[0];
        close(report.value, value(functional, &[at]), 1e-9, "by the Frenet formulas");
        let mut motions = Vec::new();
        for (first, second) in [(1, 2), (4, 3)] {
            motions.push((first, unit(at.rows[first])));
            for axis in 0..3 {
                motions.push((second, std::array::from_fn(|d| if d == axis { 1.0 } else { 0.0 })));
            }
        }
        for (row, direction) in motions {
            let moved = |by: f64| {
                let mut element = at;
                let step = times(direction, -by);
                element.rows[row] = sub(element.rows[row], step);
                value(functional, &[element])
            };
            let h = 1e-4;
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            let bend = (moved(h) + moved(-h) - 2.0 * report.value) / (h * h);
            assert!(slope.abs() < 1e-5 * (report.value + bend.abs()), "{row}: {slope}");
            assert!(moved(1e-2) > report.value && moved(-1e-2) > report.value);
        }
    }
}

#[test]
fn a_curve_with_free_ends_and_inflections_has_an_energy() {
    // A zigzag: curvature vanishes at the ends and in between.
    let joints = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.3], [2.0, 0.0, 0.0], [3.0, -1.0, 0.5], [4.0, 0.0, 0.2]];
    let (report, _) = solved(&joints.map(Joint::at), false, &options(Functional::SPACE_MEC, 2));
    assert!(report.value > report.bending && report.value < 2.0 * report.bending);
    let (report, _) = solved(&helix(5), false, &options(Functional::SPACE_MEC, 1));
    // The helix itself has more.
    assert!(report.value < 6.6568 * 0.8909, "{}", report.value);
}

#[test]
fn tension_bending_and_a_length_go_with_them() {
    let joints = simple_space_curve();
    for functional in SPACE {
        let (plain, _) = solved(&joints, false, &options(functional, 1));
        let with = Options { tension: 2.0, bending: 0.5, ..options(functional, 1) };
        let (report, elements) = solved(&joints, false, &with);
        let wanted = value(functional, &elements) + 2.0 * report.length + 0.5 * report.bending;
        close(report.value, wanted, 1e-8, "with tension and bending");
        let (taut, _) = solved(&joints, false, &Options { tension: 2.0, ..options(functional, 1) });
        assert!(taut.length < plain.length);
        let (report, elements) = solved(&joints, false, &Options { length: 4.5, ..options(functional, 1) });
        close(report.length, 4.5, 1e-9, "length");
        close(report.value, value(functional, &elements), 1e-8, "at a length");
        assert!(report.value > plain.value);
    }
}

#[test]
fn a_warm_start_and_a_tolerance_find_the_same_curve() {
    let mut joints = simple_space_curve();
    let options = options(Functional::SPACE_MVC, 2);
    let (_, mut elements) = solved(&joints, false, &options);
    joints[1].position.value[2] += 0.05;
    let curve = Curve::open(&joints);
    let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
    let report =
        update(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
    assert_eq!(report.status, Status::Converged);
    let (cold, _) = solved(&joints, false, &options);
    // The nodes between joints stand elsewhere.
    close(report.value, cold.value, 2e-5, "warm");
    assert!(torsion_jump(&elements, false) < 1e-6);
    let options = Options { elements_per_span: 16, tolerance: 1e-3, ..options };
    let (report, _) = solve_curve(&joints, false, &options).expect("good data");
    assert_eq!(report.status, Status::Converged);
    assert!(report.error <= 1e-3 && report.elements >= 4);
}

#[test]
fn bad_input_and_interruptions_are_told() {
    let joints = helix(5);
    let curve = Curve::open(&joints);
    let bad = |options: Options| workspace_len(&curve, &options).expect_err("refused");
    for functional in SPACE {
        let base = options(functional, 1);
        let error = |name| CurveError::BadOption(name);
        assert_eq!(bad(Options { dimension: 2, ..base }), CurveError::NotPlanar);
        assert_eq!(bad(Options { tension: -1.0, ..base }), error(OptionName::Tension));
        assert_eq!(bad(Options { bending: f64::NAN, ..base }), error(OptionName::Bending));
        let shape = vec![Element::ZERO; 4];
        let with = Curve::open(&joints).with_reference(Reference { elements: &shape, weight: 1.0 });
        let refused = workspace_len(&with, &base).expect_err("a reference is for the MVC");
        assert_eq!(refused, error(OptionName::ReferenceWeight));

        let (report, elements) =
            solve_curve(&joints, false, &Options { max_iterations: 5, ..base }).expect("good data");
        assert_eq!(report.status, Status::IterationLimit);
        assert!(elements.iter().flat_map(|element| element.rows.iter().flatten()).all(|x| x.is_finite()));

        struct Third;
        impl Observer for Third {
            fn iteration(&mut self, number: usize, _: &Record) -> Control {
                if number < 3 { Control::Continue } else { Control::Cancel }
            }
        }
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &base).expect("good data")];
        let mut elements = vec![Element::ZERO; elements_len(&curve, &base)];
        let report =
            solve(&curve, &base, &mut workspace, &mut elements, &mut [], &mut Third).expect("good data");
        assert_eq!((report.status, report.iterations), (Status::Cancelled, 3));
    }
    assert_eq!(
        bad(Options { functional: Functional(6), ..Options::DEFAULT }),
        CurveError::BadOption(OptionName::Functional)
    );
}

/// A curvature of which only the size is kept may turn about the tangent; one of nothing has no direction to turn to.
#[test]
fn a_curvature_of_given_size_is_one_unknown_and_none_is_none() {
    let mut joints = [[0.0, 0.0, 0.0], [1.0, 0.8, 0.2], [2.0, 1.0, 0.6], [3.0, 0.6, 0.8]].map(Joint::at);
    joints[0] = joints[0].with_tangent(Quantity::fixed([0.8, 1.0, 0.0]));
    joints[3] = joints[3].with_tangent(Quantity::fixed([1.0, -0.8, 0.0]));
    let unknowns = |joints: &[Joint]| {
        let (report, _) = solve_curve(joints, false, &Options::DEFAULT).expect("good data");
        assert_eq!((report.status, report.planar), (Status::Converged, false));
        report.unknowns
    };
    let free = unknowns(&joints);
    for (value, less) in [([0.0, 0.0, 0.3], 1), ([0.0; 3], 2)] {
        for quantity in [Quantity::of_size(value), Quantity::fixed(value)] {
            let mut given = joints;
            given[1] = given[1].with_curvature(quantity);
            assert_eq!(unknowns(&given), free - less, "{quantity:?}");
        }
    }
}
