//! The reader against the thesis's listings and against everything a hand may get wrong.
#![expect(clippy::approx_constant, reason = "the listings round π")]

use super::Given::{Fixed, Free, Initial, OnLine, OnPlane, Size};
use super::{Continuity, Fault, Reading, Specification, read};
use minvar::curve::{Obstacle, Side};
use std::time::{Duration, Instant};

fn curve(text: &str) -> Specification {
    let Reading { specification, warnings } =
        read(text.as_bytes()).unwrap_or_else(|fault| panic!("{}", show(&fault)));
    assert_eq!(warnings, [], "no warnings");
    specification
}

fn fault(text: impl AsRef<[u8]>) -> Fault {
    *read(text.as_ref()).expect_err("the reader takes a wrong file")
}

fn show(fault: &Fault) -> String {
    fault.render("file.mvc", false)
}

/// The file of a thesis figure.
fn figure(name: &str) -> Specification {
    let path = format!("{}/../tests/data/curves/{name}.mvc", env!("CARGO_MANIFEST_DIR"));
    curve(&std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}")))
}

/// Checks the first error's line and column, that the rendered lines point there too, and the words of the message.
fn check(text: &str, line: usize, column: usize, words: &str) {
    let fault = fault(text);
    let shown = show(&fault);
    assert!(fault.message.contains(words), "expected {words:?} in\n{shown}");
    assert_eq!((fault.line, fault.column), (line, column), "{shown}");
    assert!(shown.contains(&format!("file.mvc:{line}:{column}\n")), "{shown}");
    assert!(shown.contains('^') && !shown.contains('\u{1b}'), "{shown}");
}

/// `check` on a curve of joints `a` and `b` whose first line is given.
fn check_joint(joint: &str, column: usize, words: &str) {
    check(&format!("{joint}\n(G2Joint b (1,0,0))\n(G2Curve test Open (a,b))\n"), 1, column, words);
}

#[test]
fn the_wicket_is_read_as_printed() {
    let wicket = figure("wicket");
    assert_eq!((wicket.name.as_str(), wicket.closed, wicket.joints.len()), ("test", false, 2));
    let a = &wicket.joints[0];
    assert_eq!((a.name.as_str(), a.continuity, a.line, a.column), ("a", Continuity::G2, 2, 1));
    assert_eq!(a.position, Fixed([-1.0, 0.0, 0.0]));
    assert_eq!(a.tangent, [Fixed([0.0, 1.0, 0.0]); 2]);
    assert_eq!(a.curvature, [Free; 2]);
    assert_eq!(wicket.joints[1].position, Fixed([1.0, 0.0, 0.0]));
}

#[test]
fn every_listing_of_appendix_a_is_read() {
    let counts = [
        ("wicket", 2, false),
        ("loop", 5, false),
        ("no_loop", 5, false),
        ("g1_box", 8, true),
        ("g2_box", 8, true),
        ("woodford", 7, false),
        ("s_curve", 3, false),
        ("antipodal_s", 3, false),
        ("figure_eight", 4, true),
        ("space_curve", 3, false),
        ("peters_helix", 13, false),
        ("coving", 2, false),
    ];
    for (name, joints, closed) in counts {
        let specification = figure(name);
        assert_eq!((specification.joints.len(), specification.closed), (joints, closed), "{name}");
    }
    assert_eq!(figure("loop").joints[2].tangent, [Initial([-1.0, 0.0, 0.0]); 2]);
    assert_eq!(figure("no_loop").joints[2].curvature, [Fixed([0.0, -10.0, 0.0]); 2]);
    assert!(figure("g1_box").joints.iter().all(|joint| joint.continuity == Continuity::G1));
    assert!(figure("g2_box").joints.iter().all(|joint| joint.curvature == [Fixed([0.0; 3]); 2]));
    assert_eq!(figure("s_curve").joints[1].position, Fixed([0.0; 3]));
    assert_eq!(figure("figure_eight").joints[3].position, Initial([0.0; 3]));
    assert_eq!(figure("peters_helix").joints[11].position, Fixed([-3.14159, -3.14159, -7.85398]));
    assert_eq!(figure("coving").joints[0].curvature, [Fixed([0.27, 0.0, 0.0]); 2]);
}

#[test]
fn a_joint_may_slide_on_a_line_or_in_a_plane() {
    let got = curve(
        "(G2Joint a Line (0,1,2) (3,4,5) (Fixed Tangent (1,0,0)))
         (g1joint b 7 PLANE(1,0,0)(0,0,-2))
         (G2Joint Line (2,0,0))
         (G2Curve c Open (a,b,Line))",
    );
    assert_eq!(got.joints[0].position, OnLine([0.0, 1.0, 2.0], [3.0, 4.0, 5.0]));
    assert_eq!(got.joints[0].tangent, [Fixed([1.0, 0.0, 0.0]); 2]);
    assert_eq!(got.joints[1].position, OnPlane([1.0, 0.0, 0.0], [0.0, 0.0, -2.0]));
    assert_eq!((got.joints[2].name.as_str(), got.joints[2].position), ("Line", Fixed([2.0, 0.0, 0.0])));
    assert!(!got.joints[0].position.is_fixed() && !got.joints[1].position.is_fixed());
    assert_eq!(figure("coving_slide").joints[0].position, OnLine([0.5, -12.0, 0.0], [0.0, 1.0, 0.0]));
    assert_eq!(figure("rail_slide").joints[1].position, OnPlane([1.0, 0.5, 0.3], [1.0, 0.2, -0.1]));
}

#[test]
fn a_slide_that_is_wrong_is_named() {
    check_joint(
        "(G2Joint a Line (0,0,0))",
        24,
        "the line of joint `a` has no direction: a second point is missing",
    );
    check_joint(
        "(G2Joint a Plane (0,0,0) (Fixed Tangent (1,0,0)))",
        26,
        "the plane of joint `a` has no direction: a second point",
    );
    check_joint(
        "(G2Joint a Line (0,0,0) (0,0,0))",
        25,
        "the direction of the line of joint `a` has no direction",
    );
    check_joint(
        "(G2Joint a Plane (0,0,0) (0,-0,0))",
        26,
        "the normal of the plane of joint `a` has no direction",
    );
    check_joint("(G2Joint a Line (0,0,0) (nan,0,0))", 26, "`nan` is not finite");
    check_joint("(G2Joint a Line (0,0,0) (0,inf,0))", 28, "`inf` is not finite");
    check_joint(
        "(G2Joint a Line (0,0,0) (1,0))",
        25,
        "the direction of the line of joint `a` has 2 coordinates",
    );
    check_joint("(G2Joint a Line (0,0,0) (1,x,0))", 28, "`x` is not a number");
    check_joint("(G2Joint a Line (0,0,0) 1)", 25, "expected the direction of the line `(x,y,z)`");
    check_joint("(G2Joint a Line)", 16, "joint `a` has no position");
    check_joint("(G2Joint a Line Plane (0,0,0) (0,0,1))", 17, "expected the position `(x,y,z)`");
    check_joint("(G2Joint a Lyne (0,0,0) (0,0,1))", 12, "expected the position of joint `a`, found `Lyne`");
    assert_eq!(fault("(G2Joint a Lyne (0,0,0))").help.as_deref(), Some("did you mean `Line`?"));
    let lost = fault("(G2Joint a (0,0,0) (0,0,1))");
    assert!(
        lost.help.as_deref().is_some_and(|help| help.contains("Line (x,y,z) (dx,dy,dz)")),
        "{}",
        show(&lost)
    );
    check("(G2Joint a Line (0,0,0) (0,0", 1, 25, "the file ends inside the direction of the line");
    check("(G2Joint a Line (0,0,0)", 1, 1, "the file ends inside joint `a`");
    check("(G2Joint a Line", 1, 1, "the file ends inside joint `a`");
}

#[test]
fn of_a_curvature_the_size_alone_may_be_kept() {
    let got = curve(
        "(G2Joint a (0,0,0) (size curvature (0,0.3,0)))
         (G2Joint b (1,0,0) (SIZE CURVATURE 0.25) (Initial Tangent (0,0,4e200)))
         (G1Joint c (2,0,0) (Fixed Tangent (0,3,4)) (Size Curvature Leaving .5) (Fixed Curvature Arriving (1,0,0)))
         (G0Joint d (3,0,0) (Fixed Tangent Arriving (1,0,0)) (Fixed Tangent Leaving (0,1,0)) (Size Curvature 2))
         (G2Curve c Open (a,b,c,d))",
    );
    assert_eq!(got.joints[0].curvature, [Size([0.0, 0.3, 0.0]); 2]);
    assert_eq!(
        got.joints[1].curvature,
        [Size([0.0, 0.0, 0.25]); 2],
        "along the tangent, wherever that stands"
    );
    assert_eq!(got.joints[2].curvature, [Fixed([1.0, 0.0, 0.0]), Size([0.0, 0.3, 0.4])]);
    assert_eq!(got.joints[3].curvature, [Size([2.0, 0.0, 0.0]), Size([0.0, 2.0, 0.0])]);
    assert_eq!(figure("size_curvature").joints[0].curvature, [Size([0.0, 0.0, 0.3]); 2]);
}

#[test]
fn a_size_that_is_wrong_is_named() {
    check_joint("(G2Joint a (0,0,0) (Size Curvature 0.3))", 20, "has a size but the joint has no tangent");
    check_joint(
        "(G0Joint a (0,0,0) (Size Curvature 0.3) (Fixed Tangent Leaving (1,0,0)))",
        20,
        "has a size but the joint has no tangent",
    );
    check_joint(
        "(G2Joint a (0,0,0) (Size Curvature -0.3))",
        36,
        "the size of the curvature of joint `a` is negative",
    );
    check_joint("(G2Joint a (0,0,0) (Size Curvature 1e999))", 36, "`1e999` is not finite");
    check_joint("(G2Joint a (0,0,0) (Size Curvature +nan))", 36, "`+nan` is not finite");
    check_joint("(G2Joint a (0,0,0) (Size Curvature NaN))", 36, "expected the value of the curvature");
    check_joint("(G2Joint a (0,0,0) (Size Curvature 0.3.1))", 36, "`0.3.1` is not a number");
    check_joint("(G2Joint a (0,0,0) (Size Curvature))", 35, "the curvature of joint `a` has no value");
    check_joint("(G2Joint a (0,0,0) (Size Curvature 0.3 0.4))", 40, "expected `)` after the value");
    check_joint("(G2Joint a (0,0,0) (Size Tangent (1,0,0)))", 21, "cannot be given by its size");
    check_joint("(G2Joint a (0,0,0) (Size 0.3))", 26, "unknown keyword `0.3`");
    check_joint("(G2Joint a (0,0,0) (Size Curvature Leaving 0.3))", 20, "has one curvature");
    check_joint("(G2Joint a (0,0,0) (Fixed Curvature (0,1,0)) (Size Curvature (0,1,0)))", 46, "given twice");
    let bare = fault("(G2Joint a (0,0,0) (Fixed Curvature 0.3))");
    assert_eq!((bare.column, bare.line), (37, 1), "{}", show(&bare));
    assert!(
        bare.help.as_deref().is_some_and(|help| help.contains("`(Size Curvature 0.27)`")),
        "{}",
        show(&bare)
    );
    assert_eq!(fault("(G2Joint a (0,0,0) (Sise Curvature 1))").help.as_deref(), Some("did you mean `Size`?"));
}

/// `check` on an obstacle before a curve of joints `a` and `b`.
fn check_obstacle(obstacle: &str, column: usize, words: &str) {
    let curve = "(G2Joint a (0,0,0))(G2Joint b (1,0,0))(G2Curve test Open (a,b))";
    check(&format!("{obstacle}\n{curve}\n"), 1, column, words);
}

#[test]
fn obstacles_stand_beside_the_joints() {
    let got = curve(
        "(Obstacle Left 0.25 (6,-6,0))
         (G2Joint Left (0,0,0)) ; a name, not a side
         (OBSTACLE right 0 (0,1,0)(3,1,-2.5))(obstacle LEFT 1e-3 (0,0,0))
         (G2Joint b (1,0,0))
         (G2Curve c Open (Left,b))
         (Obstacle Right +2. (1,1,1) (1,1,1))",
    );
    let shapes: Vec<_> = got.obstacles.iter().map(|obstacle| obstacle.shape).collect();
    assert_eq!(
        shapes,
        [
            Obstacle::point([6.0, -6.0, 0.0], 0.25, Side::LEFT),
            Obstacle::segment([0.0, 1.0, 0.0], [3.0, 1.0, -2.5], 0.0, Side::RIGHT),
            Obstacle::point([0.0; 3], 1e-3, Side::LEFT),
            Obstacle::point([1.0; 3], 2.0, Side::RIGHT),
        ],
        "in the file's order"
    );
    let places: Vec<_> = got.obstacles.iter().map(|obstacle| (obstacle.line, obstacle.column)).collect();
    assert_eq!(places, [(1, 1), (3, 10), (3, 46), (6, 10)]);
    let clear = figure("coving_clear");
    assert_eq!(clear.obstacles[1].shape.to, [6.0, 0.0, 0.0]);
    assert_eq!(figure("coving").obstacles, []);
}

#[test]
fn an_obstacle_that_is_wrong_is_named() {
    let side = "expected `Left` or `Right`, the side of the curve on which it stays, found";
    check_obstacle("(Obstacle 0.25 (0,0,0))", 11, &format!("{side} `0.25`"));
    check_obstacle("(Obstacle (0,0,0))", 11, side);
    check_obstacle("(Obstacle Lefft 0.25 (0,0,0))", 11, side);
    check_obstacle("(Obstacle)", 10, side);
    check_obstacle("(Obstacle Left)", 15, "this obstacle has no clearance: found `)` in its place");
    check_obstacle("(Obstacle Left (0,0,0))", 16, "this obstacle has no clearance: found `(` in its place");
    check_obstacle("(Obstacle Left far (0,0,0))", 16, "this obstacle has no clearance: found `far`");
    check_obstacle("(Obstacle Left -0.25 (0,0,0))", 16, "the clearance `-0.25` is negative");
    check_obstacle("(Obstacle Left 1e999 (0,0,0))", 16, "`1e999` is not finite");
    check_obstacle("(Obstacle Left nan (0,0,0))", 16, "`nan` is not finite");
    check_obstacle("(Obstacle Left 0.2.5 (0,0,0))", 16, "`0.2.5` is not a number");
    check_obstacle("(Obstacle Left 0.25)", 1, "this obstacle has no point");
    check_obstacle(
        "(Obstacle Left 0.25 0.5 (0,0,0))",
        21,
        "expected a point `(x,y,z)` of this obstacle, found `0.5`",
    );
    check_obstacle(
        "(Obstacle Left 0.25 (0,0))",
        21,
        "a point of this obstacle has 2 coordinates and not three",
    );
    check_obstacle("(Obstacle Left 0.25 (0,0,0) (1,x,0))", 32, "`x` is not a number");
    check_obstacle("(Obstacle Left 0.25 (0,0,0) 1)", 29, "expected a point `(x,y,z)` of this obstacle");
    check_obstacle("(Obstacle Left 0.25 (0,0,0) (1,0,0) (1,1,0))", 37, "this obstacle has a third point");
    check_obstacle(
        "(Obstacle Left 0.25 (0,0,0) (1,0,0) 1)",
        37,
        "expected the `)` of this obstacle, found `1`",
    );
    let help = |text: &str| fault(text).help.unwrap_or_else(|| panic!("no help for {text}"));
    assert_eq!(help("(Obstacle Rihgt 0.25 (0,0,0))"), "did you mean `Right`?");
    assert_eq!(help("(Obstacel Left 0.25 (0,0,0))"), "did you mean `Obstacle`?");
    assert_eq!(help("(Obstacle Left -1 (0,0,0))"), "which side is said by `Left` or `Right`");
    assert!(help("(Obstacle Left 1 (0,0,0) (1,0,0) (2,0,0))").contains("one for each side"));
    for text in ["(Obstacle (0,0,0))", "(Obstacle Left (0,0,0))", "(Obstacle Left 1)"] {
        assert!(help(text).contains("`(Obstacle Left 0.25 (x,y,z) (x,y,z))` a segment"), "{text}");
    }
}

#[test]
fn an_obstacle_that_is_not_closed_is_found_where_it_begins() {
    for text in ["", " Left", " Left 0.25", " Left 0.25 (0,0,0)", " Left 0.25 (0,0,0) (1,0,0)"] {
        check(&format!("(Obstacle{text}"), 1, 1, "a `)` is missing: the file ends inside this obstacle");
        let open = text.contains('(');
        if open {
            let words = "missing before this form: this obstacle is still open";
            check(&format!("(Obstacle{text}\n(G2Joint b (1,0,0))"), 2, 1, words);
            check(&format!("(Obstacle{text}\n(Obstacle Left 1 (1,0,0))"), 2, 1, words);
        }
    }
    check("(Obstacle Left 1 (0,0,0) (1,0", 1, 26, "the file ends inside a point of this obstacle");
    check("(G2Joint a (0,0,0)\n(Obstacle Left 1 (0,0,0))", 2, 1, "joint `a` is still open");
    check("(Obstacle Left 1 (0,0,0))", 1, 26, "this file has no curve");
}

#[test]
fn keywords_take_any_case_and_names_keep_theirs() {
    let got =
        curve("(g2joint A(0,0,0)(FIXED tangent(1,0,0)))(G2JOINT a INITIAL(1,0,0))(g2curve C OPEN(a,A))");
    assert_eq!(got.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["a", "A"]);
}

#[test]
fn numbers_may_be_written_in_any_common_form() {
    let got =
        curve("(G2Joint a (-3.14159,1e-3,.5))(G2Joint b 12 Fixed (+1.,-2.E+2,0))(G2Curve c Open (a,b))");
    assert_eq!(got.joints[0].position, Fixed([-3.14159, 1e-3, 0.5]));
    assert_eq!(got.joints[1].position, Fixed([1.0, -200.0, 0.0]));
}

#[test]
fn comments_blanks_and_line_ends_do_not_matter() {
    let plain = curve("(G2Joint a (0,0,0))\n(G2Joint b (1,0,0))\n(G2Curve c Open (a,b))\n");
    let texts = [
        "\u{feff}(G2Joint a (0,0,0))\r\n(G2Joint b (1,0,0))\r\n(G2Curve c Open (a,b))",
        "(G2Joint a (0,0,0)) ; (not read\n(G2Joint b (1,0,0))# nor ) this\n(G2Curve c Open (a,b));",
        "(G2Joint\ta\t( 0 , 0 ,\t0 ) )\r(G2Joint b (1,0,0))\r(G2Curve c Open(a ,b))\r; lone CR ends a line\r",
    ];
    for text in texts {
        assert_eq!(curve(text), plain, "{text:?}");
    }
    let scattered = curve("(\nG2Joint\na\n(0\n,0,\n0)\n)\n (G2Joint b (1,0,0))(G2Curve c Open (a,b))");
    assert_eq!((scattered.joints[0].line, scattered.joints[1].line, scattered.joints[1].column), (1, 8, 2));
}

#[test]
fn the_curve_may_stand_before_its_joints() {
    assert_eq!(curve("(G2Curve c Open (a,b))(G2Joint b (1,0,0))(G2Joint a (0,0,0))").joints[0].name, "a");
}

#[test]
fn names_may_be_in_any_script() {
    let got = curve("(G2Joint Bug.é (0,0,0))\n(G2Joint 艉 (1,0,0))\n(G2Curve Größe Open (Bug.é,艉))");
    assert_eq!((got.name.as_str(), got.joints[1].name.as_str()), ("Größe", "艉"));
    check("(G2Joint é (0,0,0)) (G2Joint 艉 (1,0,x))", 1, 37, "`x` is not a number");
}

#[test]
fn a_split_joint_takes_one_value_for_both_sides_or_one_for_each() {
    let got = curve(
        "(G0Joint a (0,0,0) (Fixed Tangent Arriving (1,0,0)) (Initial Tangent LEAVING (0,1,0)))
         (G1Joint b (1,0,0) (Fixed Tangent (1,0,0)) (Fixed Curvature Leaving (0,2,0)))
         (G0Joint c (2,0,0) (Fixed Curvature (0,0,0)))
         (G2Curve c Open (a,b,c))",
    );
    assert_eq!(got.joints[0].tangent, [Fixed([1.0, 0.0, 0.0]), Initial([0.0, 1.0, 0.0])]);
    assert_eq!(got.joints[1].tangent, [Fixed([1.0, 0.0, 0.0]); 2]);
    assert_eq!(got.joints[1].curvature, [Free, Fixed([0.0, 2.0, 0.0])]);
    assert_eq!(got.joints[2].curvature, [Fixed([0.0; 3]); 2]);
}

#[test]
fn sides_are_refused_where_nothing_is_split() {
    check_joint("(G2Joint a (0,0,0) (Fixed Tangent Leaving (1,0,0)))", 20, "has one tangent");
    check_joint("(G1Joint a (0,0,0) (Fixed Tangent Leaving (1,0,0)))", 20, "has one tangent");
    check_joint("(G2Joint a (0,0,0) (Fixed Curvature Arriving (1,0,0)))", 20, "has one curvature");
}

#[test]
fn a_missing_parenthesis_is_found_where_it_is_missing() {
    check("(G2Joint a (0,0,0) (Fixed Tangent (1,0,0))", 1, 1, "the file ends inside joint `a`");
    check(
        "(G2Joint a (0,0,0)\n(G2Joint b (1,0,0))",
        2,
        1,
        "missing before this form: joint `a` is still open",
    );
    check("(G2Joint a (0,0,0", 1, 12, "the file ends inside the position of joint `a`");
    check(
        "(G2Joint a (0,0,0 (Fixed Tangent (1,0,0)))",
        1,
        19,
        "expected the `)` of the position of joint `a`",
    );
    check("(G2Joint a (0,0,0) (Fixed Tangent (1,0,0)", 1, 1, "the file ends inside joint `a`");
    check("(G2Joint a", 1, 1, "the file ends inside joint `a`");
    check("(G2Joint", 1, 1, "the file ends inside a joint");
    check("(", 1, 1, "the file ends inside this form");
    check("(G2Curve c Open (a,b)", 1, 1, "the file ends inside curve `c`");
    check("(G2Curve c Open (a,b", 1, 17, "the file ends inside the joints of curve `c`");
    check("(G2Joint a (0,0,0)))", 1, 20, "this `)` closes nothing");
}

#[test]
fn a_wrong_value_is_named() {
    check_joint("(G2Joint a (0,0))", 12, "the position of joint `a` has 2 coordinates and not three");
    check_joint("(G2Joint a (0,0,0,0))", 12, "has 4 coordinates");
    check_joint("(G2Joint a (7))", 12, "has 1 coordinate and");
    check_joint("(G2Joint a ())", 12, "has 0 coordinates");
    check_joint("(G2Joint a (0,,0))", 15, "expected a coordinate, found `,`");
    check_joint("(G2Joint a (0,0,))", 17, "expected a coordinate, found `)`");
    check_joint("(G2Joint a (0 0 0))", 15, "expected `,` before the next coordinate");
    check_joint("(G2Joint a (0,zero,0))", 15, "`zero` is not a number");
    check_joint("(G2Joint a (0,1e999,0))", 15, "`1e999` is not finite");
    check_joint("(G2Joint a (0,nan,0))", 15, "`nan` is not finite");
    check_joint("(G2Joint a (0,-inf,0))", 15, "`-inf` is not finite");
    check_joint("(G2Joint a (0,\u{2212}1,0))", 15, "is not a number");
    check_joint("(G2Joint a (0,0,0) (Fixed Tangent (0,0,0)))", 35, "has no direction");
    check_joint("(G2Joint a)", 11, "joint `a` has no position");
    check_joint("(G2Joint a (0,0,0) (Fixed Tangent))", 34, "the tangent of joint `a` has no value");
    check_joint("(G2Joint a 1.5 (0,0,0))", 12, "index of joint `a` must be a whole number");
    check_joint("(G2Joint (0,0,0))", 10, "this joint has no name");
    check_joint("(G2Joint Fixed (0,0,0))", 10, "this joint has no name");
}

#[test]
fn a_condition_given_twice_shows_both_places() {
    check_joint("(G2Joint a (0,0,0) (Fixed Tangent (1,0,0)) (Initial Tangent (1,0,0)))", 44, "given twice");
    check_joint(
        "(G0Joint a (0,0,0) (Fixed Tangent (1,0,0)) (Fixed Tangent Leaving (1,0,0)))",
        44,
        "given twice",
    );
}

#[test]
fn an_unknown_keyword_brings_the_nearest_known() {
    let cases = [
        ("(G2Jiont a (0,0,0))", 2, "G2Joint"),
        ("(G2Joint a Fxed (0,0,0))", 12, "Fixed"),
        ("(G2Joint a (0,0,0) (Fixd Tangent (1,0,0)))", 21, "Fixed"),
        ("(G2Joint a (0,0,0) (Fixed Tagnent (1,0,0)))", 27, "Tangent"),
        ("(G0Joint a (0,0,0) (Fixed Tangent Leving (1,0,0)))", 35, "Leaving"),
        ("(G2Curve c Opne (a,b))", 12, "Open"),
    ];
    for (text, column, meant) in cases {
        let fault = fault(text);
        assert_eq!((fault.line, fault.column), (1, column), "{}", show(&fault));
        assert_eq!(
            fault.help.as_deref(),
            Some(format!("did you mean `{meant}`?").as_str()),
            "{}",
            show(&fault)
        );
    }
    check("(Banana a)", 1, 2, "unknown keyword `Banana`");
    check("(G1Curve test Open (a,b))", 1, 2, "unknown keyword `G1Curve`");
    check_joint("(G2Joint a (0,0,0) (Tangent (1,0,0)))", 21, "unknown keyword `Tangent`");
    check_joint("(G2Joint a (0,0,0) (Fixed Torsion (1,0,0)))", 27, "unknown keyword `Torsion`");
}

#[test]
fn a_list_marker_before_a_form_is_refused() {
    check("\n- (G2Joint a (0,0,0))", 2, 1, "found `-`");
}

#[test]
fn names_are_checked_against_the_joints() {
    let joints = "(G2Joint alpha (0,0,0))\n(G2Joint beta (1,0,0))\n(G2Joint gamma (2,0,0))\n";
    check(&format!("{joints}(G2Curve c Open (alpha,bet,gamma))"), 4, 24, "`bet`, which is not defined");
    assert_eq!(
        fault(format!("{joints}(G2Curve c Open (alpha,bet,gamma))")).help.as_deref(),
        Some("did you mean `beta`?")
    );
    check(&format!("{joints}(G2Joint beta (3,0,0))"), 4, 1, "joint `beta` is defined twice");
    check(&format!("{joints}(G2Curve c Open (alpha,beta,beta,gamma))"), 4, 29, "twice in a row");
    check(&format!("{joints}(G2Curve c Open (alpha,beta,alpha,gamma))"), 4, 29, "listed twice");
    check(&format!("{joints}(G2Curve c Closed (alpha,beta,gamma,alpha))"), 4, 37, "listed twice");
    check(
        &format!("{joints}(G2Curve c Open (alpha))"),
        4,
        1,
        "curve `c` has 1 joint: an open curve needs at least 2",
    );
    check(&format!("{joints}(G2Curve c Open ())"), 4, 1, "curve `c` has 0 joints:");
    check(&format!("{joints}(G2Curve c Closed (alpha,beta))"), 4, 1, "a closed curve needs at least 3");
    check(&format!("{joints}(G2Curve c Open (alpha,))"), 4, 24, "expected the name of a joint");
    check(&format!("{joints}(G2Curve Open (alpha,beta))"), 4, 10, "this curve has no name");
    check(&format!("{joints}(G2Curve c (alpha,beta))"), 4, 12, "expected `Open` or `Closed`");
    let curve = "(G2Curve c Open (alpha,beta,gamma))\n";
    check(&format!("{joints}{curve}{curve}"), 5, 1, "curve `c` is a second curve");
    check(joints, 3, 24, "this file has no curve");
}

#[test]
fn an_unused_joint_is_a_warning() {
    let text = "(G2Joint a (0,0,0))(G2Joint b (0,0,0))\n (G2Joint spare (0,0,0))(G2Curve c Open (a,b))";
    let warnings = read(text.as_bytes()).expect("the file is good").warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!((warnings[0].line, warnings[0].column), (2, 2));
    assert!(show(&warnings[0]).starts_with("warning: joint `spare` is not used by curve `c`"));
}

#[test]
fn files_that_are_no_text_are_refused_in_words() {
    check("", 1, 1, "this file is empty");
    check(" \n\t; nothing\n", 2, 11, "this file is empty");
    let binary = fault(b"(G2Joint a\n (0,\xff\xfe\x00\x01".as_slice());
    assert_eq!((binary.line, binary.column), (2, 5), "{}", show(&binary));
    assert!(binary.message.contains("byte 16 of this file is not UTF-8"), "{}", binary.message);
    let wide = fault(b"\xff\xfe(\x00G\x00".as_slice());
    assert!(show(&wide).contains("UTF-16"), "{}", show(&wide));
    let zeros = fault([0_u8; 1000]);
    assert!(show(&zeros).len() < 3000, "{}", show(&zeros));
}

#[test]
fn the_message_shows_the_line_and_a_caret() {
    let shown = show(&fault("(G2Joint a (0,0,0))\n\t(G2Joint b (0,O,0))\n"));
    assert_eq!(
        shown,
        "error: `O` is not a number
 --> file.mvc:2:16
  |
2 |     (G2Joint b (0,O,0))
  |                   ^"
    );
}

#[test]
fn a_hundred_thousand_joints_are_read_in_linear_time() {
    let text = |count: usize, break_line: &str| {
        let mut text = String::new();
        for i in 0..count {
            text += &format!("(G2Joint j{i} ({i},0,0)){break_line}");
        }
        let names: Vec<_> = (0..count).map(|i| format!("j{i}")).collect();
        text + "(G2Curve long Open (" + &names.join(",") + "))"
    };
    for break_line in ["\n", ""] {
        let start = Instant::now();
        assert_eq!(curve(&text(100_000, break_line)).joints.len(), 100_000);
        // Quadratic time would be minutes.
        assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    }
    let start = Instant::now();
    let unused = text(100_000, "").replace("(j0,j1,", "(j0,j1)) ; ");
    assert_eq!(read(unused.as_bytes()).expect("warnings only").warnings.len(), 5);
    let wrong = text(100_000, "").replace("j99999))", "k99999))");
    let shown = show(&fault(wrong));
    assert!(shown.len() < 2000 && shown.contains("did you mean `j99999`?"), "{} bytes", shown.len());
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}
