//! The curves of the table: their data, and minvar's elements or arcs to start from.

use minvar_tests::appendix::figure;
use minvar_tests::ceres::{self, Given};
use minvar_tests::compare::{ours, rows};
use minvar_tests::truth::quintic;
use minvar_tests::truth::{Continuity, Functional, Joint, Problem, SpanStart, TrueCurve, solve, start};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::sync::OnceLock;

/// The degree of the turning rates. MVCs are there at 20; elasticas of few spans need more.
pub(crate) const DEGREE: usize = 40;

/// A curve of the table.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) functional: &'static str,
    pub(crate) problem: Problem,
    pub(crate) curve: TrueCurve,
}

pub(crate) fn case(name: &str, functional: &str) -> &'static Case {
    cases()
        .iter()
        .find(|case| case.name == name && case.functional == functional)
        .unwrap_or_else(|| panic!("no case {name} {functional}"))
}

/// What the table calls a functional, and the length it is to have.
fn functional(name: &str) -> (Functional, Option<f64>) {
    let (name, length) = match name.split_once(" at l=") {
        Some((name, length)) => (name, Some(length.parse().expect("a length"))),
        None => (name, None),
    };
    let functional = match name {
        "mvc" => Functional::MVC,
        "mec" => Functional::MEC,
        "si-mvc" => Functional::SI_MVC,
        "si-mec" => Functional::SI_MEC,
        "mvc+0.5l" => Functional { tension: 0.5, ..Functional::MVC },
        "mvc+0.5e" => Functional { bending: 0.5, ..Functional::MVC },
        "mec+0.5l" => Functional { tension: 0.5, ..Functional::MEC },
        other => panic!("no such functional: {other}"),
    };
    (functional, length)
}

/// A planar figure of Appendix A and minvar's elements for it, as problem and start.
fn from_appendix(id: &str, of: ceres::Functional, elements_per_span: usize) -> (Problem, Vec<SpanStart>) {
    let figure = figure(id);
    let elements = rows(&ours(&figure, of, elements_per_span).1);
    let joints: Vec<Joint> = figure
        .joints
        .iter()
        .enumerate()
        .map(|(i, joint)| {
            let (Given::Fixed(at) | Given::Initial(at)) = joint.position else {
                panic!("{id}: a free point")
            };
            let mut out = Joint::at([at[0], at[1]]);
            out.fixed = matches!(joint.position, Given::Fixed(_));
            out.continuity = match joint.continuity {
                ceres::Continuity::G0 => Continuity::G0,
                ceres::Continuity::G1 => Continuity::G1,
                ceres::Continuity::G2 => Continuity::G2,
            };
            if let Given::Fixed([x, y, _]) = joint.tangent {
                out = out.with_angle(y.atan2(x));
            }
            if let Given::Fixed([x, y, _]) = joint.curvature {
                // The side to which it bends follows the tangent, which the elements know if the data do not.
                let first = i * elements_per_span;
                let [_, [tx, ty], _] = match elements.get(first) {
                    Some(rows) => quintic::derivatives(rows, 0.0),
                    None => quintic::derivatives(&elements[first - 1], 1.0),
                };
                out = out.with_curvature(x.hypot(y).copysign(tx * y - ty * x));
            }
            out
        })
        .collect();
    let problem = Problem::new(joints, figure.closed, Functional::MVC);
    let start = start::from_elements(&elements, problem.spans());
    (problem, start)
}

/// The S of chord 4 through the origin, its end tangents both at an angle (Figs 4.13 and 4.14 at 90° and 180°).
pub(crate) fn s_curve(degrees: f64, functional: Functional) -> Problem {
    let end = |x| Joint::at([x, 0.0]).with_angle(degrees.to_radians());
    Problem::new([end(-2.0), Joint::at([0.0; 2]), end(2.0)], false, functional)
}

/// The figure-8 of Fig. 4.15, of which nothing is fixed, from arcs between its start tangents.
pub(crate) fn figure_eight(functional: Functional) -> (Problem, Vec<SpanStart>) {
    let free = |x| Joint { fixed: false, ..Joint::at([x, 0.0]) };
    let problem = Problem::new([free(-2.0), free(0.0), free(2.0), free(0.0)], true, functional);
    let start = start::from_angles(&problem, &[FRAC_PI_2, -FRAC_PI_4, FRAC_PI_2, -3.0 * FRAC_PI_4]);
    (problem, start)
}

pub(crate) fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        let mut cases = Vec::new();
        let mut add = |name, label: &'static str, problem: &Problem, start: &[SpanStart]| {
            let (functional, length) = functional(label);
            let problem = Problem { functional, length, ..problem.clone() };
            let curve = solve(&problem, start, DEGREE).unwrap_or_else(|e| panic!("{name} {label}: {e:?}"));
            let onward = curve.as_start();
            cases.push(Case { name, functional: label, problem, curve });
            onward
        };
        let (coving, at) = from_appendix("4.22", ceres::Functional::Mvc, 2);
        let at = add("coving", "mvc", &coving, &at);
        let mut clear = coving;
        clear.joints[0] = clear.joints[0].with_curvature(-0.33667);
        add("coving_clear", "mvc", &clear, &at);

        let (woodford, at) = from_appendix("4.11", ceres::Functional::Mvc, 2);
        let mvc = add("woodford", "mvc", &woodford, &at);
        let mec = add("woodford", "mec", &woodford, &from_appendix("4.11", ceres::Functional::Mec, 2).1);
        for label in ["si-mvc", "mvc+0.5l", "mvc+0.5e"] {
            add("woodford", label, &woodford, &mvc);
        }
        for label in ["si-mec", "mec+0.5l", "mec at l=8.4"] {
            add("woodford", label, &woodford, &mec);
        }
        // The first span bears the surplus of length, on either side: two minima.
        for (name, more) in [("woodford", -0.5), ("woodford_other_side", 0.5)] {
            let mut bent = mvc.clone();
            bent[0].curvature.iter_mut().for_each(|kappa| *kappa += more);
            add(name, "mvc at l=8.4", &woodford, &bent);
        }
        for (name, id, labels) in [
            ("wicket", "4.2", &["mvc", "si-mvc", "si-mec"][..]),
            ("g2_box", "4.10-1", &["mvc"]),
            ("g1_box", "4.10-2", &["mvc"]),
            ("loop", "4.9-1", &["mvc"]),
            ("no_loop", "4.9-2", &["mvc"]),
            ("s_curve", "4.13", &["mvc", "si-mvc", "si-mec"]),
        ] {
            let (problem, at) = from_appendix(id, ceres::Functional::Mvc, 2);
            for label in labels {
                add(name, label, &problem, &at);
            }
        }
        let mut at = from_appendix("4.13", ceres::Functional::Mvc, 2).1;
        for degrees in [100.0, 105.0] {
            at = solve(&s_curve(degrees, Functional::MVC), &at, 20).expect("an S").as_start();
        }
        add("s_110", "mvc", &s_curve(110.0, Functional::MVC), &at);
        let antipodal = s_curve(180.0, Functional::SI_MVC);
        let at = add("antipodal_s", "si-mvc", &antipodal, &start::from_circles(&antipodal));
        add("antipodal_s", "si-mec", &antipodal, &at);
        let (eight, at) = figure_eight(Functional::SI_MVC);
        let at = add("figure_eight", "si-mvc at l=10", &eight, &at);
        add("figure_eight", "si-mec at l=10", &eight, &at);
        cases
    })
}
