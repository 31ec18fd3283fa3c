//! A region of a curve computed anew between held ends (thesis 4.4): the rest stays as it is, and the region joins it.

use minvar::curve::{
    Continuity, Curve, CurveError, Element, Functional, Joint, Options, Part, Quantity, Region, Report,
    elements_len, measure, update, workspace_len,
};
use minvar::solve::{Silent, Status};
use minvar_tests::appendix::figure;
use minvar_tests::compare::kernel_joints;
use minvar_tests::curves::{
    MARKER, Vector, add, deviation, distance, end_shape, functional_value, norm, solve_curve, sub, times,
};

const MVC: Options = Options { quadrature_points: 32, ..Options::DEFAULT };

fn woodford() -> Vec<Joint> {
    let points = [[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.89], [6.0, 1.2]];
    points.iter().map(|&[x, y]| Joint::at([x, y, 0.0])).collect()
}

/// Closed: five joints around, not a circle.
fn egg() -> Vec<Joint> {
    let points = [[3.0, 0.0], [1.0, 2.0], [-2.0, 1.5], [-2.5, -1.0], [0.5, -2.2]];
    points.iter().map(|&[x, y]| Joint::at([x, y, 0.0])).collect()
}

/// Peters' helix of the thesis (Fig. 4.21), a space curve of twelve spans.
fn helix() -> Vec<Joint> {
    kernel_joints(&figure("4.21"))
}

fn moved(joint: &Joint, by: Vector) -> Joint {
    joint.with_position(Quantity::fixed(add(joint.position.value, by)))
}

fn value(functional: Functional, elements: &[Element]) -> f64 {
    functional_value(functional, elements)
}

fn variation(elements: &[Element]) -> f64 {
    value(Functional::MVC, elements)
}

fn cut(elements: &[Element], first: usize, count: usize) -> Region<'_> {
    Region { elements, closed: false, first, count }
}

/// The elements of a region in order.
fn own(region: &Region<'_>) -> Vec<Element> {
    region.elements.iter().cycle().skip(region.first).take(region.count).copied().collect()
}

/// Computes a region from its data.
fn solved(region: &Region<'_>, joints: &mut [Joint], options: &Options) -> (Report, Vec<Element>) {
    region.hold(joints).expect("a good region");
    let (report, elements) = solve_curve(joints, false, options).expect("good data");
    assert_eq!(report.status, Status::Converged);
    fits(region, &elements);
    (report, elements)
}

/// Computes a region from its old elements.
fn updated(region: &Region<'_>, joints: &mut [Joint], options: &Options) -> (Report, Vec<Element>) {
    let curve = region.hold(joints).expect("a good region");
    let mut elements = own(region);
    assert_eq!(elements_len(&curve, options), elements.len());
    let mut workspace = vec![f64::NAN; workspace_len(&curve, options).expect("good data")];
    let report =
        update(&curve, options, &mut workspace, &mut elements, &mut [], &mut Silent).expect("good data");
    assert_eq!(report.status, Status::Converged);
    fits(region, &elements);
    (report, elements)
}

/// Checks that one element goes over into the next: the point to the last bit, tangent and curvature to rounding.
#[track_caller]
fn joins(before: &Element, after: &Element) {
    assert_eq!(before.rows[5].map(f64::to_bits), after.rows[0].map(f64::to_bits), "position");
    let ((t, k, _), (u, l, _)) = (end_shape(before, 1), end_shape(after, 0));
    assert!(distance(t, u) < 1e-14, "tangent: {}", distance(t, u));
    let size = norm(sub(before.rows[5], before.rows[0]));
    assert!(distance(k, l) * size < 1e-12, "curvature: {}", distance(k, l) * size);
}

/// Checks both ends of a region's new elements against the rest.
#[track_caller]
fn fits(region: &Region<'_>, fresh: &[Element]) {
    let (all, after) = (region.elements, region.first + region.count);
    if region.closed || region.first > 0 {
        joins(&all[(region.first + all.len() - 1) % all.len()], &fresh[0]);
    }
    if region.closed || after < all.len() {
        joins(&fresh[fresh.len() - 1], &all[after % all.len()]);
    }
}

#[track_caller]
fn close(found: f64, wanted: f64, allowed: f64, what: &str) {
    assert!((found - wanted).abs() <= allowed * wanted.abs(), "{what}: {found}, not {wanted}");
}

#[test]
fn a_region_whose_joints_stay_comes_out_as_it_was() {
    for (joints, closed) in [(woodford(), false), (egg(), true)] {
        for (functional, parts) in
            [(Functional::MVC, 1), (Functional::MVC, 2), (Functional::MEC, 1), (Functional::MEC, 2)]
        {
            let options = Options { functional, elements_per_span: parts, ..MVC };
            let (_, elements) = solve_curve(&joints, closed, &options).expect("good data");
            let parts = parts as usize;
            let spans = elements.len() / parts;
            for first in 0..spans {
                // Of a closed curve all the way around too, from a joint to itself.
                for count in 1..=if closed { spans } else { spans - first } {
                    let region =
                        Region { elements: &elements, closed, first: first * parts, count: count * parts };
                    let old = own(&region);
                    let around: Vec<Joint> =
                        (first..=first + count).map(|k| joints[k % joints.len()]).collect();
                    for (_, fresh) in [
                        solved(&region, &mut around.clone(), &options),
                        updated(&region, &mut around.clone(), &options),
                    ] {
                        let what = format!("closed {closed}, {functional:?}, {parts}: {first}, {count}");
                        let ratio = value(functional, &fresh) / value(functional, &old);
                        // The parametrisation of single elements has minima of its own, of which a part may find a
                        // lower one.
                        let lower = if parts == 1 { 1e-7 } else { 1e-9 };
                        assert!(ratio <= 1.0 + 1e-9 && ratio >= 1.0 - lower, "{what}: {ratio}");
                        let off = deviation(&fresh, &old, count);
                        assert!(off < 1e-6, "{what}: {off}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_part_of_a_helix_comes_out_as_it_was_and_gives_way() {
    let joints = helix();
    let (_, elements) = solve_curve(&joints, false, &MVC).expect("good data");
    for (first, count) in [(0, 2), (4, 1), (4, 4), (10, 2), (1, 10)] {
        let region = cut(&elements, first, count);
        let inner = &joints[first..=first + count];
        for (report, fresh) in
            [solved(&region, &mut inner.to_vec(), &MVC), updated(&region, &mut inner.to_vec(), &MVC)]
        {
            assert!(!report.planar);
            close(variation(&fresh), variation(&own(&region)), 1e-9, "variation");
            assert!(deviation(&fresh, &own(&region), count) < 1e-6);
        }
        if count > 1 {
            let mut inner = inner.to_vec();
            inner[1] = moved(&inner[1], [0.1, -0.1, 0.2]);
            let (report, fresh) = updated(&region, &mut inner, &MVC);
            assert!(!report.planar);
            assert_eq!(fresh[0].rows[5], inner[1].position.value);
            let mut edited = elements.clone();
            edited[first..first + count].copy_from_slice(&fresh);
            let mut all = joints.clone();
            all[first + 1] = inner[1];
            let (whole, _) = solve_curve(&all, false, &MVC).expect("good data");
            let ratio = variation(&edited) / whole.fine_value;
            assert!(ratio > 1.0 + 1e-6, "{first} {count}: {ratio}");
        }
    }
}

#[test]
fn ends_need_not_be_joints() {
    let joints = helix();
    let (_, elements) =
        solve_curve(&joints, false, &Options { elements_per_span: 4, ..MVC }).expect("good data");
    // From within span 3 to within span 4: two elements on either side of joint 4.
    let region = cut(&elements, 14, 4);
    let options = Options { elements_per_span: 2, ..MVC };
    for (_, fresh) in [
        solved(&region, &mut [joints[0], joints[4], joints[0]], &options),
        updated(&region, &mut [joints[0], joints[4], joints[0]], &options),
    ] {
        close(variation(&fresh), variation(&own(&region)), 1e-9, "variation");
        assert!(deviation(&fresh, &own(&region), 2) < 1e-6);
    }
}

#[test]
fn a_moved_joint_changes_its_region_and_nothing_else() {
    let joints = woodford();
    let (_, before) = solve_curve(&joints, false, &MVC).expect("good data");
    for (first, count) in [(2, 2), (1, 4), (0, 4), (2, 4), (0, 6)] {
        let mut all = joints.clone();
        all[3] = moved(&all[3], [0.05, 0.15, 0.0]);
        let mut inner = all[first..=first + count].to_vec();
        // In place, as a program would that drags a joint.
        let mut elements = before.clone();
        let curve = cut(&elements, first, count).hold(&mut inner).expect("a good region");
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &MVC).expect("good data")];
        let fresh = &mut elements[first..first + count];
        let report = update(&curve, &MVC, &mut workspace, fresh, &mut [], &mut Silent).expect("good data");
        assert_eq!(report.status, Status::Converged);

        for (index, (new, old)) in elements.iter().zip(&before).enumerate() {
            assert_eq!(new != old, (first..first + count).contains(&index), "{first} {count}: {index}");
        }
        for (index, joint) in all.iter().enumerate() {
            let [arriving, leaving] = [index.checked_sub(1), (index < 6).then_some(index)];
            assert!(arriving.is_none_or(|element| elements[element].rows[5] == joint.position.value));
            assert!(leaving.is_none_or(|element| elements[element].rows[0] == joint.position.value));
        }
        for pair in elements.windows(2) {
            joins(&pair[0], &pair[1]);
        }
        // With less to choose from the curve is no fairer than one that may change everywhere, and the same where the
        // region is all of it.
        let (whole, _) = solve_curve(&all, false, &MVC).expect("good data");
        let ratio = variation(&elements) / whole.fine_value;
        assert!(if count == 6 { (ratio - 1.0).abs() < 1e-7 } else { ratio > 1.0 + 1e-4 }, "{first}: {ratio}");
        let (_, cold) = solved(&cut(&before, first, count), &mut inner, &MVC);
        close(variation(&cold), variation(&elements[first..first + count]), 1e-7, "from the data");
    }
}

#[test]
fn a_region_of_a_closed_curve_runs_past_its_last_element() {
    let joints = egg();
    let (_, elements) = solve_curve(&joints, true, &MVC).expect("good data");
    // From joint 4 over joints 0 and 1 to 2; joint 0 moves.
    let region = Region { elements: &elements, closed: true, first: 4, count: 3 };
    let mut inner = [joints[4], moved(&joints[0], [0.1, 0.0, 0.0]), joints[1], joints[2]];
    let (_, fresh) = updated(&region, &mut inner, &MVC);
    assert_eq!(inner[0].position.value, joints[4].position.value);
    assert_eq!(inner[3].position.value, joints[2].position.value);

    // The same region of the curve that starts elsewhere lies in one piece.
    let mut turned = elements.clone();
    turned.rotate_left(3);
    let (_, same) =
        updated(&Region { elements: &turned, closed: true, first: 1, count: 3 }, &mut inner.clone(), &MVC);
    assert_eq!(same, fresh);
    turned[1..4].copy_from_slice(&fresh);
    for k in 0..5 {
        joins(&turned[k], &turned[(k + 1) % 5]);
    }
    let mut all = joints;
    all[0] = inner[1];
    let (whole, _) = solve_curve(&all, true, &MVC).expect("good data");
    assert!(variation(&turned) > whole.fine_value * (1.0 + 1e-6));
}

#[test]
fn joints_may_be_added_and_removed() {
    let joints = woodford();
    let (_, elements) = solve_curve(&joints, false, &MVC).expect("good data");
    let more = vec![joints[1], joints[2], Joint::at([2.5, 2.8, 0.0]), joints[4]];
    let fewer = vec![joints[1], joints[4]];
    let as_needed = Options { elements_per_span: 64, tolerance: 1e-8, ..MVC };
    for (mut inner, options) in [(more, MVC), (fewer.clone(), MVC), (fewer, as_needed)] {
        let region = cut(&elements, 1, 3);
        let curve = region.hold(&mut inner).expect("a good region");
        let mut workspace = vec![f64::NAN; workspace_len(&curve, &options).expect("good data")];
        let mut fresh = vec![MARKER; elements_len(&curve, &options)];
        let report = minvar::curve::solve(&curve, &options, &mut workspace, &mut fresh, &mut [], &mut Silent)
            .expect("good data");
        assert_eq!(report.status, Status::Converged);
        fresh.truncate(report.elements);
        fits(&region, &fresh);
        let mut edited = elements.clone();
        edited.splice(1..4, fresh);
        assert_eq!(edited.len(), 3 + report.elements);
        for pair in edited.windows(2) {
            joins(&pair[0], &pair[1]);
        }
    }
}

#[test]
fn dragging_there_and_back_a_hundred_times_leaves_the_curve_as_it_was() {
    let joints = woodford();
    let (_, before) = solve_curve(&joints, false, &MVC).expect("good data");
    let mut elements = before.clone();
    for step in 1..=100 {
        let by = [0.0, 0.003 * f64::from(50 - (step - 50i32).abs()), 0.0];
        // Two regions by turns, so that the ends of each are what the other left.
        for (first, at) in [(1, 2), (2, 3)] {
            let mut inner = [joints[at - 1], moved(&joints[at], by), joints[at + 1]];
            let (_, fresh) = updated(&cut(&elements, first, 2), &mut inner, &MVC);
            elements[first..first + 2].copy_from_slice(&fresh);
        }
    }
    for pair in elements.windows(2) {
        joins(&pair[0], &pair[1]);
    }
    // By turns the two regions come back to the minimum that they have together.
    for _ in 0..60 {
        for (first, at) in [(1, 2), (2, 3)] {
            let (_, fresh) =
                updated(&cut(&elements, first, 2), &mut [joints[at - 1], joints[at], joints[at + 1]], &MVC);
            elements[first..first + 2].copy_from_slice(&fresh);
        }
    }
    close(variation(&elements), variation(&before), 1e-7, "variation");
}

#[test]
fn an_end_of_the_curve_keeps_its_own_conditions() {
    let joints = woodford();
    let (_, elements) = solve_curve(&joints, false, &MVC).expect("good data");
    let clamped = joints[0].with_tangent(Quantity::fixed([0.0, 2.0, 0.0]));
    let mut inner = [clamped, joints[1], joints[2]];
    let (_, fresh) = solved(&cut(&elements, 0, 2), &mut inner, &MVC);
    assert_eq!(inner[0], clamped);
    assert!(distance(end_shape(&fresh[0], 0).0, [0.0, 1.0, 0.0]) < 1e-15);
    let mut inner = [joints[4], joints[5], moved(&joints[6], [0.0, -0.3, 0.0])];
    let end = inner[2];
    let (_, fresh) = solved(&cut(&elements, 4, 2), &mut inner, &MVC);
    assert_eq!(inner[2], end);
    assert_eq!(fresh[1].rows[5], end.position.value);
    // A free end bends evenly, whatever the other end is held to.
    let place = measure::at(&fresh, 1, 1.0).expect("a point");
    assert!(place.curvature_derivative.abs() < 1e-2 * norm(place.curvature));
}

#[test]
fn the_rest_alone_says_what_is_held_and_the_continuity_how_much() {
    let joints = woodford();
    let (_, mut elements) = solve_curve(&joints, false, &MVC).expect("good data");
    elements[2..4].fill(MARKER);
    let there = measure::at(&elements[..2], 1, 1.0).expect("a point");
    let given = Quantity::initial([0.5, -0.5, 0.0]);
    for (continuity, tangent, curvature) in [
        (Continuity::G2, Quantity::fixed(there.tangent), Some(there.curvature)),
        (Continuity::G1, Quantity::fixed(there.tangent), None),
        (Continuity::G0, given, None),
    ] {
        let wrong = Joint::at([9.0; 3]).with_tangent(given).with_continuity(continuity);
        let mut inner = [wrong, joints[3], wrong];
        let curve = cut(&elements, 2, 2).hold(&mut inner).expect("a good region");
        assert_eq!((curve.joints.len(), curve.closed), (3, false));
        assert_eq!(inner[1], joints[3]);
        assert_eq!(inner[0].continuity, continuity);
        assert_eq!(inner[0].position, Quantity::fixed(elements[1].rows[5]));
        assert_eq!(inner[2].position, Quantity::fixed(elements[4].rows[0]));
        assert_eq!(inner[0].tangent, [tangent; 2]);
        match curvature {
            None => assert_eq!(inner[0].curvature, [Quantity::FREE; 2]),
            Some(curvature) => {
                assert!(distance(inner[0].curvature[0].value, curvature) < 1e-15);
                assert_eq!(inner[0].curvature, [Quantity::fixed(inner[0].curvature[0].value); 2]);
            }
        }
    }
    // A corner stays one: the region comes in along its own tangent.
    let corner = joints[4].with_continuity(Continuity::G0);
    let region = cut(&elements, 2, 2);
    let mut inner = [Joint::at([0.0; 3]), joints[3], corner];
    region.hold(&mut inner).expect("a good region");
    let (report, fresh) = solve_curve(&inner, false, &MVC).expect("good data");
    assert_eq!(report.status, Status::Converged);
    joins(&elements[1], &fresh[0]);
    assert_eq!(fresh[1].rows[5], elements[4].rows[0]);
    assert!(distance(end_shape(&fresh[1], 1).0, end_shape(&elements[4], 0).0) > 1e-2);
}

#[test]
fn a_joint_held_at_any_place_goes_on_from_there() {
    let (_, elements) = solve_curve(&egg(), true, &MVC).expect("good data");
    for t in [0.0, 0.3, 1.0] {
        let place = measure::at(&elements, 2, t).expect("a point");
        let ahead = add(place.tangent, times(place.curvature, 0.2));
        let branch = [Joint::held_at(&place), Joint::at(add(place.point, times(ahead, 3.0)))];
        let (report, fresh) = solve_curve(&branch, false, &MVC).expect("good data");
        assert_eq!(report.status, Status::Converged);
        let found = measure::at(&fresh, 0, 0.0).expect("a point");
        assert_eq!(found.point, place.point);
        assert!(distance(found.tangent, place.tangent) < 1e-14);
        assert!(distance(found.curvature, place.curvature) < 1e-12);
    }
}

#[test]
fn ends_are_held_as_well_in_any_unit_and_place() {
    for (scale, shift) in [(1e-6, 0.0), (1e6, 0.0), (1e60, 0.0), (1.0, 1e6)] {
        let place =
            |joint: &Joint| Joint::at(add(times(joint.position.value, scale), [shift, -0.5 * shift, 0.0]));
        let joints: Vec<Joint> = woodford().iter().map(place).collect();
        let (_, elements) = solve_curve(&joints, false, &MVC).expect("good data");
        let mut inner = [joints[2], moved(&joints[3], [0.0, 0.1 * scale, 0.0]), joints[4]];
        updated(&cut(&elements, 2, 2), &mut inner, &MVC);
        solved(&cut(&elements, 2, 2), &mut inner, &MVC);
    }
}

#[test]
fn where_the_curve_is_straight_rounding_of_its_curvature_does_no_harm() {
    // An S through its inflection, and a line, in planes of all kinds: rounding must not tilt them.
    for [along, across] in [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]],
        [[0.3, 0.5, 0.7], [0.7, 0.3, -0.4]],
        [[1.0, 1.0, 1.0], [1.0, -2.0, 0.3]],
    ] {
        for bulge in [1.0, 0.0] {
            let at = |x: f64, y: f64| add(times(along, x), times(across, bulge * y));
            let joints: Vec<Joint> =
                [[-3.0, -0.2], [-2.0, -1.0], [-1.0, -0.9], [0.0, 0.0], [1.0, 0.9], [2.0, 1.0], [3.0, 0.2]]
                    .iter()
                    .map(|&[x, y]| Joint::at(at(x, y)))
                    .collect();
            let options = Options { dimension: 2, ..MVC };
            let (report, elements) = solve_curve(&joints, false, &options).expect("good data");
            assert_eq!(report.status, Status::Converged);
            // Between them the held joints, and the one at the inflection.
            let (report, _) = solved(&cut(&elements, 3, 2), &mut joints[3..6].to_vec(), &options);
            assert!(report.planar);
            let mut inner = [joints[3], moved(&joints[4], times(across, 0.1)), joints[5], joints[6]];
            assert!(updated(&cut(&elements, 3, 3), &mut inner, &options).0.planar);
        }
    }
}

#[test]
fn a_straight_element_is_held_whatever_rounding_leaves_along_it() {
    for k in 0..1000 {
        let (speed, stretch) = (0.3 + 0.01 * f64::from(k % 31), 1.3 - 0.023 * f64::from(k));
        for along in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.3, 0.5, 0.7]] {
            let [first, second] = [times(along, speed), times(along, stretch)];
            let line = [Element { rows: [[0.0; 3], first, second, second, first, along] }];
            let place = measure::at(&line, 0, 1.0).expect("a point");
            let joints = [Joint::held_at(&place), Joint::at([3.0, 4.0, 5.0])];
            let asked = workspace_len(&Curve::open(&joints), &MVC);
            assert!(asked.is_ok(), "{along:?}: {asked:?}, {:?}", place.curvature);
        }
    }
}

#[test]
fn a_space_curve_that_counts_torsion_joins_with_its_curvature() {
    let joints = [[0.0, 0.0, 0.0], [1.0, 0.6, 0.2], [1.6, -0.2, 0.7], [1.0, -0.8, 1.3], [0.2, -0.4, 1.9]]
        .map(Joint::at);
    let options = Options { functional: Functional::SPACE_MVC, ..Options::DEFAULT };
    let (_, elements) = solve_curve(&joints, false, &options).expect("good data");
    let (report, fresh) = updated(&cut(&elements, 1, 2), &mut joints[1..4].to_vec(), &options);
    assert!(!report.planar);
    // Torsion, free at both ends, moves it a little.
    let off = deviation(&fresh, &elements[1..3], 2);
    assert!(off > 1e-6 && off < 1e-3, "{off}");
    let mut inner = [joints[1], moved(&joints[2], [0.05, 0.0, 0.05]), joints[3]];
    updated(&cut(&elements, 1, 2), &mut inner, &options);
}

#[test]
fn a_region_that_cannot_be_is_refused() {
    let joints = woodford();
    let (_, elements) = solve_curve(&joints, false, &MVC).expect("good data");
    let refused = |region: &Region<'_>, given: &[Joint], error: CurveError, words: &[&str]| {
        let mut inner = given.to_vec();
        assert_eq!(region.hold(&mut inner).err(), Some(error));
        assert_eq!(inner, given, "an error changes nothing");
        let message = error.to_string();
        for word in words {
            assert!(message.contains(word), "“{message}” does not say “{word}”");
        }
    };
    let inner = joints[2..5].to_vec();
    let bad = |first, count, elements| CurveError::BadRegion { first, count, elements };
    for closed in [false, true] {
        for (first, count) in
            [(6, 1), (0, 7), (7, 1), (usize::MAX, 1), (1, usize::MAX), (usize::MAX, usize::MAX)]
        {
            let region = Region { elements: &elements, closed, first, count };
            refused(&region, &inner, bad(first, count, 6), &["curve of 6", &format!("element {first}")]);
        }
        for first in [0, 3, 6, usize::MAX] {
            let region = Region { elements: &elements, closed, first, count: 0 };
            refused(&region, &inner, bad(first, 0, 6), &["no elements", &format!("element {first}")]);
        }
        refused(&Region { elements: &[], closed, first: 0, count: 1 }, &inner, bad(0, 1, 0), &["curve of 0"]);
        let region = Region { elements: &elements, closed, first: 2, count: 2 };
        refused(&region, &inner[..1], CurveError::TooFewJoints { given: 1 }, &["two joints"]);
        refused(&region, &[], CurveError::TooFewJoints { given: 0 }, &["two joints"]);
    }
    // An open curve's region ends with the curve.
    refused(&cut(&elements, 5, 2), &inner, bad(5, 2, 6), &["2 elements from element 5"]);
    assert!(
        Region { elements: &elements, closed: true, first: 5, count: 2 }.hold(&mut inner.clone()).is_ok()
    );

    // Neighbours that say nothing are refused, and no other element is read.
    for bad in [f64::NAN, f64::INFINITY, 1e101] {
        for row in 0..6 {
            for (element, beside) in [(0, false), (1, true), (2, false), (3, false), (4, true), (5, false)] {
                let mut broken = elements.clone();
                broken[element].rows[row][1] = bad;
                if beside {
                    refused(
                        &cut(&broken, 2, 2),
                        &inner,
                        CurveError::BadElement { element },
                        &["element", "region"],
                    );
                } else {
                    assert!(cut(&broken, 2, 2).hold(&mut inner.clone()).is_ok());
                }
            }
        }
    }
    for (element, row) in [(1, 4), (4, 1)] {
        let mut still = elements.clone();
        still[element].rows[row] = [0.0; 3];
        refused(&cut(&still, 2, 2), &inner, CurveError::BadElement { element }, &["no direction"]);
    }

    // What is wrong with the joints the solver says.
    let mut wrong = [inner[0], Joint::at([f64::NAN, 0.0, 0.0]), inner[2]];
    let curve = cut(&elements, 2, 2).hold(&mut wrong).expect("the ends are good");
    assert_eq!(workspace_len(&curve, &MVC), Err(CurveError::NotFinite { joint: 1, part: Part::Position }));
    // A warm start with another number of elements.
    let mut wrong = inner;
    let curve: Curve<'_> = cut(&elements, 2, 2).hold(&mut wrong).expect("a good region");
    let error = update(&curve, &MVC, &mut [0.0; 5000], &mut [MARKER; 1], &mut [], &mut Silent);
    assert_eq!(error, Err(CurveError::ElementsTooShort { needed: 2, given: 1 }));
}
