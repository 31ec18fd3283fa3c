//! Pictures, read back as XML and measured.

use super::page::width;
use super::{Mark, Picture, Slide, svg};
use crate::constraints::PlacedObstacle;
use crate::trace::shapes::{circle, polynomial, quarter};
use crate::trace::{Vector, add};
use minvar::curve::{Element, Obstacle, Side};
use roxmltree::{Document, Node};

fn marks(count: usize) -> Vec<Mark> {
    let mark = |element: usize| Mark {
        name: format!("p{element}"),
        element,
        fixed: element % 3 != 1,
        slide: None,
        tangent: [element.is_multiple_of(2); 2],
        curvature: element.is_multiple_of(5),
    };
    (0..count).map(mark).collect()
}

fn draw(elements: &[Element], closed: bool, polygons: &[Vec<Vector>]) -> String {
    draw_with(elements, closed, polygons, &[])
}

fn draw_with(
    elements: &[Element],
    closed: bool,
    polygons: &[Vec<Vector>],
    obstacles: &[PlacedObstacle],
) -> String {
    let joints = marks(if closed { elements.len() } else { elements.len() + 1 });
    let figures = ["value 1".to_owned()];
    svg(&Picture { title: "t", figures: &figures, elements, closed, joints: &joints, polygons, obstacles })
}

fn obstacle(from: Vector, to: Vector, clearance: f64) -> PlacedObstacle {
    PlacedObstacle { shape: Obstacle::segment(from, to, clearance, Side::LEFT), line: 1, column: 1 }
}

fn line(a: Vector, b: Vector) -> Element {
    let zero = [0.0; 3];
    polynomial([a, add(b, -1.0, a), zero, zero])
}

/// A screw of so many quarter turns.
fn screw(turns: usize) -> Vec<Element> {
    let quarters = circle(2.0, [0.0; 3]);
    let lift = |turn: usize| {
        let mut rows = quarters[turn % 4].rows;
        (rows[0][2], rows[1][2], rows[4][2], rows[5][2]) = (turn as f64, 1.0, 1.0, turn as f64 + 1.0);
        Element { rows }
    };
    (0..turns).map(lift).collect()
}

fn all() -> Vec<(&'static str, String)> {
    let point = [3.0, -2.0, 5.0];
    vec![
        ("circle", draw(&circle(1.0, [0.0; 3]), true, &[])),
        ("tiny circle", draw(&circle(1e-6, [0.0; 3]), true, &[])),
        ("huge circle", draw(&circle(1e6, [0.0; 3]), true, &[])),
        ("far circle", draw(&circle(1e-3, [1e6, -1e6, 0.0]), true, &[])),
        ("line", draw(&[line([0.0; 3], [3.0, 1.0, 0.0])], false, &[])),
        ("level line", draw(&[line([0.0; 3], [3.0, 0.0, 0.0])], false, &[])),
        ("upright line", draw(&[line([0.0; 3], [0.0, 0.0, 7.0])], false, &[])),
        ("line in space", draw(&[line([0.0; 3], [3.0, 1.0, 2.0])], false, &[])),
        ("point", draw(&[line(point, point)], false, &[])),
        ("screw", draw(&screw(9), false, &[])),
        ("polygon", draw(&[quarter(1.0)], false, &[vec![[0.0; 3], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]])),
        ("obstacle", draw_with(&[quarter(1.0)], false, &[], &[obstacle([0.0; 3], [0.5, 0.0, 0.0], 0.1)])),
        (
            "obstacle without clearance",
            draw_with(&[quarter(1.0)], false, &[], &[obstacle([0.0; 3], [0.0; 3], 0.0)]),
        ),
        ("not a number", draw(&[Element { rows: [[f64::NAN; 3]; 6] }], false, &[])),
        ("infinite", draw(&[Element { rows: [[1e200; 3]; 6] }], false, &[])),
    ]
}

fn of_class<'a, 'i>(document: &'a Document<'i>, class: &'a str) -> Vec<Node<'a, 'i>> {
    document.descendants().filter(|node| node.attribute("class") == Some(class)).collect()
}

fn number(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{name} of {node:?}"))
}

/// The end points of a path's commands.
fn ends(path: Node<'_, '_>) -> Vec<[f64; 2]> {
    let data = path.attribute("d").expect("a path has data").trim_end_matches('Z');
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',').expect("a pair");
        [x.parse().expect("x"), y.parse().expect("y")]
    };
    data.split(['M', 'L', 'C'])
        .skip(1)
        .map(|command| pair(command.split(' ').next_back().expect("pairs")))
        .collect()
}

#[test]
fn every_picture_is_xml_of_finite_numbers() {
    for (name, text) in all() {
        let document = Document::parse(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
        let [w, h] = ["width", "height"].map(|side| number(document.root_element(), side));
        assert!(w == 800.0 && h > 300.0 && h < 1200.0, "{name}: {w} × {h}");
        for circle in document.descendants().filter(|node| node.has_tag_name("circle")) {
            assert!(
                (0.0..w).contains(&number(circle, "cx")) && (0.0..h).contains(&number(circle, "cy")),
                "{name}"
            );
        }
    }
}

#[test]
fn a_title_is_escaped() {
    let joints = [Mark {
        name: "<&\u{1}".into(),
        element: 0,
        fixed: true,
        slide: None,
        tangent: [false; 2],
        curvature: false,
    }];
    let elements = [quarter(1.0)];
    let picture = Picture {
        title: "a<b & \"c\"",
        figures: &[],
        elements: &elements,
        closed: false,
        joints: &joints,
        polygons: &[],
        obstacles: &[],
    };
    let text = svg(&picture);
    let document = Document::parse(&text).expect("XML");
    assert_eq!(of_class(&document, "title")[0].text(), Some("a<b & \"c\""));
    assert_eq!(of_class(&document, "name")[0].text(), Some("<&\u{fffd}"));
}

#[test]
fn a_circle_is_round_and_y_points_up() {
    let text = draw(&circle(1.0, [5.0, 7.0, 0.0]), true, &[]);
    let document = Document::parse(&text).expect("XML");
    let curve =
        of_class(&document, "curve").into_iter().find(|node| node.has_tag_name("path")).expect("a curve");
    let ends = ends(curve);
    let middle = |d: usize| {
        let values = ends.iter().map(|end| end[d]);
        0.5 * (values.clone().fold(f64::INFINITY, f64::min) + values.fold(f64::NEG_INFINITY, f64::max))
    };
    let centre = [middle(0), middle(1)];
    let radius = |end: &[f64; 2]| (end[0] - centre[0]).hypot(end[1] - centre[1]);
    assert!(ends.iter().all(|end| (radius(end) - radius(&ends[0])).abs() < 0.02), "{ends:?}");
    // The curve starts at (r, 0) and goes on to (0, r), which is up: to a smaller y.
    let at = ends.iter().position(|end| (end[0] - centre[0]).abs() < 0.02).expect("a quarter");
    assert!(ends[at][1] < centre[1]);
}

#[test]
fn the_path_keeps_to_the_quintic() {
    // 2,000 points of the drawn cubics, each within 1e-4 of the picture of the circle that the elements are.
    let text = draw(&circle(1.0, [0.0; 3]), true, &[]);
    let document = Document::parse(&text).expect("XML");
    let curve =
        of_class(&document, "curve").into_iter().find(|node| node.has_tag_name("path")).expect("a curve");
    let data = curve.attribute("d").expect("data").trim_end_matches('Z').replace(['M', 'C'], " ");
    let spots: Vec<[f64; 2]> = data
        .split_whitespace()
        .map(|pair| {
            pair.split_once(',').map(|(x, y)| [x.parse().expect("x"), y.parse().expect("y")]).expect("a pair")
        })
        .collect();
    let xs = spots.iter().map(|spot| spot[0]);
    let [left, right] = [xs.clone().fold(f64::INFINITY, f64::min), xs.fold(f64::NEG_INFINITY, f64::max)];
    let radius = 0.5 * (right - left);
    let [x, y] = [0.5 * (left + right), spots[0][1]];
    for piece in spots.windows(4).step_by(3) {
        for i in 0..=60 {
            let t = f64::from(i) / 60.0;
            let u = 1.0 - t;
            let b = [u * u * u, 3.0 * t * u * u, 3.0 * t * t * u, t * t * t];
            let [px, py] = [0, 1].map(|d| (0..4).map(|k| b[k] * piece[k][d]).sum::<f64>());
            assert!(((px - x).hypot(py - y) - radius).abs() < 0.08, "{t} of {piece:?}");
        }
    }
}

#[test]
fn the_longest_tooth_is_a_fifth_of_the_diagonal_and_stands_outside() {
    for r in [1e-6, 1.0, 1e6] {
        let text = draw(&circle(r, [0.0; 3]), true, &[]);
        let document = Document::parse(&text).expect("XML");
        let comb = of_class(&document, "comb")[0];
        let teeth: Vec<_> = comb
            .children()
            .filter(Node::is_element)
            .map(|tooth| ["x1", "y1", "x2", "y2"].map(|a| number(tooth, a)))
            .collect();
        let span = |i: usize| {
            let values = teeth.iter().map(|tooth| tooth[i]);
            values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
        };
        let diagonal = span(0).hypot(span(1));
        assert!(teeth.len() >= 30 && span(2) > span(0) && span(3) > span(1), "outside");
        for [x1, y1, x2, y2] in &teeth {
            let part = (x2 - x1).hypot(y2 - y1) / diagonal;
            assert!((part - 0.2).abs() < 1e-3, "{part}");
        }
    }
}

#[test]
fn constant_curvature_is_a_level_line_and_a_straight_line_has_none() {
    for (elements, closed) in
        [(circle(1.0, [1e6, 0.0, 0.0]), true), (vec![line([0.0; 3], [1.0, 3.0, 0.0])], false)]
    {
        let text = draw(&elements, closed, &[]);
        let document = Document::parse(&text).expect("XML");
        let heights: Vec<_> =
            of_class(&document, "kappa").into_iter().flat_map(ends).map(|end| end[1]).collect();
        assert!(heights.len() > 100 && heights.iter().all(|y| (y - heights[0]).abs() < 0.1));
        assert_eq!(of_class(&document, "comb").is_empty(), !closed);
    }
}

#[test]
fn joints_show_what_is_fixed() {
    let text = draw(&circle(1.0, [0.0; 3]), true, &[]);
    let document = Document::parse(&text).expect("XML");
    // One each in the legend; of p0 … p3 p1 is free, p0 and p2 have tangents (two halves each), p0 has a curvature.
    let count = |class: &str| of_class(&document, class).len();
    assert_eq!(count("fixed"), 3 + 1 + 1, "the ring's dot in the legend is one more");
    assert_eq!((count("free"), count("tangent"), count("ring")), (1 + 1, 4 + 1, 1 + 1));
    // The closed curve's first joint is marked at both ends of the plot.
    assert_eq!(count("station"), 5);
}

/// The classed lines from the group of slides, as vectors, of a quarter circle or a screw whose first joint slides.
fn slides(elements: &[Element], slide: Slide) -> Vec<[f64; 2]> {
    let mut joints = marks(elements.len() + 1);
    joints[0].slide = Some(slide);
    joints[0].fixed = false;
    let text = svg(&Picture {
        title: "t",
        figures: &[],
        elements,
        closed: false,
        joints: &joints,
        polygons: &[],
        obstacles: &[],
    });
    let document = Document::parse(&text).expect("XML");
    assert!(text.contains(">sliding point<") && !text.contains("NaN"));
    let group = of_class(&document, "slides")[0];
    let clip = of_class(&document, "frame")[0];
    assert!(
        group.attribute("clip-path") == Some("url(#clip-shape)")
            && clip.has_tag_name("rect") == (elements.len() == 1)
    );
    let lines = group.children().filter(Node::is_element);
    lines
        .map(|line| [number(line, "x2") - number(line, "x1"), number(line, "y2") - number(line, "y1")])
        .collect()
}

#[test]
fn a_sliding_joint_shows_its_way() {
    let near = |a: &[f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 0.03 && (a[1] - b[1]).abs() < 0.03;
    let quarter = [quarter(1.0)];
    for size in [1e-200, 1.0, 1e200] {
        let line = slides(&quarter, Slide::Line([0.6 * size, 0.8 * size, 0.0]));
        assert!(line.len() == 1 && near(&line[0], [52.8, -70.4]), "{line:?}");
        let plane = slides(&quarter, Slide::Plane([0.0, size, 0.0]));
        assert!(plane.len() == 1 && near(&plane[0].map(f64::abs), [88.0, 0.0]), "{plane:?}");
    }
    // A plane that holds the curve, and one in space: two ways.
    assert_eq!(slides(&quarter, Slide::Plane([0.0, 0.0, 2.0])).len(), 2);
    assert_eq!(slides(&screw(9), Slide::Plane([1.0, 2.0, 3.0])).len(), 2);
    assert_eq!(slides(&screw(9), Slide::Line([1.0, 2.0, 3.0])).len(), 1);
    let still = draw(&quarter, false, &[]);
    assert!(!still.contains("class=\"slide") && !still.contains("sliding"));
}

#[test]
fn an_obstacle_is_drawn_with_its_clearance_around_it() {
    // A quarter circle of radius 2 in every coordinate plane, and a segment with a point beside it.
    let turned = |p: Vector, turn: usize| -> Vector { std::array::from_fn(|d| p[(d + turn) % 3]) };
    for turn in 0..3 {
        let mut element = quarter(2.0);
        element.rows = element.rows.map(|row| turned(row, turn));
        let [from, to, point] = [[0.0; 3], [0.6, 0.8, 0.0], [1.0, 0.0, 0.0]].map(|point| turned(point, turn));
        let obstacles = [obstacle(from, to, 0.25), obstacle(point, point, 0.5), obstacle(point, from, 0.0)];
        let text = draw_with(&[element], false, &[], &obstacles);
        assert!(text.contains(">obstacle, its clearance dotted<"));
        let document = Document::parse(&text).expect("XML");
        let shown = |class: &'static str, tag: &str| -> Vec<_> {
            of_class(&document, class).into_iter().filter(|node| node.has_tag_name(tag)).collect()
        };
        // The first line is the legend's.
        let [_, segment, other] = shown("obstacle", "line")[..] else { panic!("two segments") };
        let [dot] = shown("obstacle", "circle")[..] else { panic!("one point") };
        let [around, circle] = shown("clearance", "path")[..] else { panic!("two outlines") };
        let ends_of = |line| [["x1", "y1"], ["x2", "y2"]].map(|end| end.map(|name| number(line, name)));
        let [a, b] = ends_of(segment);
        let distance = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let zoom = distance(a, b);
        let centre = ["cx", "cy"].map(|name| number(dot, name));
        assert!((distance(a, centre) - zoom).abs() < 0.03 && distance(ends_of(other)[0], centre) < 0.03);
        for spot in ends(circle) {
            assert!((distance(spot, centre) - 0.5 * zoom).abs() < 0.03, "turn {turn}: {spot:?}");
        }
        let to_segment = |p: [f64; 2]| {
            let (step, off) = ([0, 1].map(|d| b[d] - a[d]), [0, 1].map(|d| p[d] - a[d]));
            let share = ((step[0] * off[0] + step[1] * off[1]) / (zoom * zoom)).clamp(0.0, 1.0);
            distance(p, [0, 1].map(|d| a[d] + share * step[d]))
        };
        let spots = ends(around);
        assert!(spots.iter().all(|spot| (to_segment(*spot) - 0.25 * zoom).abs() < 0.03), "{spots:?}");
        // Once around: the area of a stadium.
        let cross = |p: &[f64; 2], q: &[f64; 2]| p[0] * q[1] - p[1] * q[0];
        let area: f64 = spots.iter().zip(spots.iter().cycle().skip(1)).map(|(p, q)| 0.5 * cross(p, q)).sum();
        let stadium = (0.5 + std::f64::consts::PI / 16.0) * zoom * zoom;
        assert!((area.abs() / stadium - 1.0).abs() < 2e-3, "{area} {stadium}");
    }
    let plain = draw(&[quarter(2.0)], false, &[]);
    assert!(!plain.contains("class=\"obstacle") && !plain.contains("class=\"clearance"));
}

#[test]
fn the_picture_holds_its_obstacles_with_their_clearance() {
    let far = obstacle([30.0, 0.0, 0.0], [30.0, 0.0, 0.0], 5.0);
    let text = draw_with(&[quarter(1.0)], false, &[], &[far]);
    let document = Document::parse(&text).expect("XML");
    let frame = of_class(&document, "frame")[0];
    let [x, y, w, h] = ["x", "y", "width", "height"].map(|name| number(frame, name));
    let outline = of_class(&document, "clearance").into_iter().find(|node| node.has_tag_name("path"));
    for [u, v] in ends(outline.expect("an outline")) {
        assert!((x..=x + w).contains(&u) && (y..=y + h).contains(&v), "{u} {v}");
    }
}

#[test]
fn a_corner_breaks_the_envelope() {
    let corner = [
        line([0.0; 3], [1.0, 0.0, 0.0]),
        polynomial([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.0; 3]]),
    ];
    let smooth = circle(1.0, [0.0; 3]);
    let runs = |elements: &[Element]| {
        let text = draw(elements, false, &[]);
        let document = Document::parse(&text).expect("XML");
        of_class(&document, "envelope").into_iter().filter(|node| node.has_tag_name("path")).count()
    };
    assert_eq!((runs(&corner), runs(&smooth)), (2, 1));
}

#[test]
fn words_do_not_overlap() {
    for (name, text) in
        all().into_iter().filter(|(name, _)| !["point", "not a number", "infinite"].contains(name))
    {
        let document = Document::parse(&text).expect("XML");
        let areas: Vec<_> =
            document.descendants().filter(|node| node.has_tag_name("text")).map(area).collect();
        for (i, (word, a)) in areas.iter().enumerate() {
            for (other, b) in &areas[..i] {
                let apart = a[0] > b[2] || b[0] > a[2] || a[1] > b[3] || b[1] > a[3];
                assert!(apart, "{name}: `{word}` {a:?} lies on `{other}` {b:?}");
            }
            assert!(a[0] >= 0.0 && a[2] <= 800.0, "{name}: `{word}` {a:?} leaves the page");
        }
    }
}

/// Left, upper, right and lower edge of a text's letters, about.
fn area<'a>(node: Node<'a, '_>) -> (&'a str, [f64; 4]) {
    let size = match node.attribute("class") {
        Some("title") => 18.0,
        Some("figures") => 12.0,
        Some("caption" | "name") => 11.5,
        _ => 10.5,
    };
    let text = node.text().unwrap_or_default();
    let (w, x, y) = (width(text, size), number(node, "x"), number(node, "y"));
    let left = match node.attribute("text-anchor") {
        Some("middle") => x - 0.5 * w,
        Some("end") => x - w,
        _ => x,
    };
    (text, [left, y - 0.72 * size, left + w, y])
}
