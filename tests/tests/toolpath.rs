//! Tool paths keep their tolerance, measured independently: by dense samples, both ways, of the moves and of
//! the printed G-code, which is read back as a control would read it.

// The measurement is to be independent of the kernel, and needs no equal bits.
#![allow(clippy::disallowed_methods)]

use minvar::curve::Element;
use minvar::toolpath::{
    Arcs, GcodeError, GcodeOptions, Motion, Move, PathError, Plane, Summary, Units, arcs, chords, write_gcode,
};
use minvar_tests::paths::{Piece, arc, assert_within, interpret, norm, sub};

/// A reproducible sequence in [−1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + 0.5 * (high - low) * (self.next() + 1.0)
    }
}

fn element(p: [f64; 2], v: [f64; 2], a: [f64; 2], b: [f64; 2], w: [f64; 2], q: [f64; 2]) -> Element {
    Element { rows: [p, v, a, b, w, q].map(|[x, y]| [x, y, 0.0]) }
}

fn polar(length: f64, angle: f64) -> [f64; 2] {
    [length * angle.cos(), length * angle.sin()]
}

/// A wandering tangent-continuous chain of elements of about unit length, times `size`. Curvatures jump at
/// the joints.
fn wandering(random: &mut Random, count: usize, size: f64, bend: f64) -> Vec<Element> {
    let mut p = [random.next() * size, random.next() * size];
    let mut angle = random.between(-3.0, 3.0);
    let mut chain = Vec::new();
    for _ in 0..count {
        let turn = bend * random.next();
        let reach = random.between(0.6, 1.4) * size;
        let way = polar(reach, angle + 0.5 * turn + 0.3 * bend * random.next());
        let q = [p[0] + way[0], p[1] + way[1]];
        let speed = reach * random.between(0.8, 1.4);
        let wobble = |random: &mut Random| [reach * bend * random.next(), reach * bend * random.next()];
        let (a, b) = (wobble(random), wobble(random));
        chain.push(element(
            p,
            polar(speed, angle),
            a,
            b,
            polar(reach * random.between(0.8, 1.4), angle + turn),
            q,
        ));
        angle += turn;
        p = q;
    }
    chain
}

/// The part of a circle about the origin from angle 0, as elements of at most a quarter each, near enough for
/// any tolerance here.
fn circle(radius: f64, angle: f64) -> Vec<Element> {
    let count = (angle / 0.8).ceil();
    let step = angle / count;
    (0..count as usize)
        .map(|k| {
            let (a, b) = (step * k as f64, step * (k + 1) as f64);
            let at = |r: f64, angle| polar(r * radius, angle);
            use std::f64::consts::FRAC_PI_2 as Q;
            let (s, s2) = (step, step * step);
            element(at(1.0, a), at(s, a + Q), at(-s2, a), at(-s2, b), at(s, b + Q), at(1.0, b))
        })
        .collect()
}

/// A point-symmetric S of chord 100 that leaves and arrives at 60°.
fn s_curve() -> Vec<Element> {
    let v = polar(150.0, 1.047);
    vec![element([0.0, 0.0], v, [0.0; 2], [0.0; 2], v, [100.0, 0.0])]
}

/// The moves as pieces, each beginning where the one before ended, and the greatest deviation that they
/// report.
fn collect(path: Arcs<'_>) -> (Vec<Piece>, f64) {
    let (start, height) = (path.start(), path.height());
    let mut at = [start[0], start[1], height];
    let mut pieces = Vec::new();
    let mut deviation = 0.0_f64;
    for segment in path {
        assert_eq!(segment.start, [at[0], at[1]]);
        deviation = deviation.max(segment.deviation);
        let (end, piece) = match segment.motion {
            Move::Line { end: [x, y] } => ([x, y, height], Piece::Line(at, [x, y, height])),
            Move::Arc { end: [x, y], centre, clockwise } => {
                ([x, y, height], arc(at, [x, y, height], centre, clockwise))
            }
        };
        pieces.push(piece);
        at = end;
    }
    (pieces, deviation)
}

fn greatest_kink(pieces: &[Piece]) -> f64 {
    let angle = |a: [f64; 2], b: [f64; 2]| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).abs();
    pieces.windows(2).map(|w| angle(w[0].tangents()[1], w[1].tangents()[0])).fold(0.0, f64::max)
}

fn program(chain: &[Element], options: &GcodeOptions) -> (String, Summary) {
    let mut text = String::new();
    let summary = write_gcode(chain, options, &mut text).unwrap();
    assert_eq!(text.lines().count(), summary.lines);
    (text, summary)
}

fn options(tolerance: f64) -> GcodeOptions {
    GcodeOptions::new(tolerance, 1000.0, 1e6)
}

#[test]
fn arcs_of_random_chains_keep_the_tolerance_and_are_smooth() {
    let mut random = Random(1);
    for case in 0..24 {
        let size = [1e-3, 1.0, 100.0, 1e4][case % 4];
        let chain = wandering(&mut random, 1 + case % 5, size, [0.5, 1.5, 3.0][case % 3]);
        for relative in [1e-2, 1e-4] {
            let tolerance = relative * size;
            let (pieces, deviation) = collect(arcs(&chain, tolerance).unwrap());
            assert!(deviation <= tolerance);
            let measured = assert_within(&chain, &pieces, deviation, 400);
            assert!(measured > 0.4 * tolerance, "the path wastes its tolerance: {}", measured / tolerance);
            assert!(greatest_kink(&pieces) <= 1.01e-4, "{}", greatest_kink(&pieces));
        }
    }
}

#[test]
fn chords_of_random_chains_keep_the_tolerance() {
    let mut random = Random(2);
    for case in 0..24 {
        let size = [1e-3, 1.0, 100.0, 1e4][case % 4];
        let mut chain = wandering(&mut random, 1 + case % 4, size, [0.5, 1.5, 3.0][case % 3]);
        let mut height = 0.0;
        for element in &mut chain {
            // Into space, continuously.
            let rise = size * random.next();
            for (row, z) in element.rows.iter_mut().zip([height, rise, rise, -rise, 0.0, height + rise]) {
                row[2] = z;
            }
            height += rise;
        }
        let tolerance = 1e-3 * size;
        let path = chords(&chain, tolerance).unwrap();
        let mut at = path.point();
        let mut pieces = Vec::new();
        let mut deviation = 0.0_f64;
        for chord in path {
            pieces.push(Piece::Line(at, chord.end));
            at = chord.end;
            deviation = deviation.max(chord.deviation);
        }
        assert!(deviation <= tolerance);
        let measured = assert_within(&chain, &pieces, deviation, 400);
        assert!(measured > 0.7 * tolerance);
    }
}

#[test]
fn printed_programs_keep_the_tolerance_in_every_plane() {
    let mut random = Random(3);
    for case in 0..18 {
        let size = [0.1, 10.0, 1000.0][case % 3];
        let chain = wandering(&mut random, 2 + case % 3, size, 2.0);
        let plane = [Plane::Xy, Plane::Zx, Plane::Yz][(case / 3) % 3];
        let motion = if case < 12 { Motion::Arcs } else { Motion::Chords };
        let options = GcodeOptions { plane, motion, depth: -1.5, ..options(1e-3 * size) };
        let (text, summary) = program(&chain, &options);
        let (start, mut pieces) = interpret(&text, plane);
        assert_eq!(start[2], -1.5);
        for piece in &mut pieces {
            match piece {
                Piece::Line(a, b) | Piece::Arc { start: a, end: b, .. } => {
                    a[2] += 1.5;
                    b[2] += 1.5;
                }
            }
        }
        assert!(summary.deviation <= options.tolerance);
        assert_within(&chain, &pieces, summary.deviation, 300);
        let arcs = pieces.iter().filter(|p| matches!(p, Piece::Arc { .. })).count();
        assert_eq!((summary.arcs, summary.chords), (arcs, pieces.len() - arcs));
        assert_eq!(motion == Motion::Arcs, arcs > 0);
        let length: f64 = pieces
            .iter()
            .map(|p| {
                (0..1000)
                    .map(|k| norm(sub(p.point(f64::from(k + 1) / 1000.0), p.point(f64::from(k) / 1000.0))))
                    .sum::<f64>()
            })
            .sum();
        assert!((summary.length / length - 1.0).abs() < 1e-5);
        assert!((summary.minutes - summary.length / 1000.0).abs() < 1e-12);
    }
}

#[test]
fn rounding_to_the_printed_decimals_is_part_of_the_tolerance() {
    // A tolerance of some tens of units of the last decimal: rounding is a visible part of it.
    for motion in [Motion::Arcs, Motion::Chords] {
        for chain in [circle(0.05, 5.0), circle(1.0, 1.0), wandering(&mut Random(4), 2, 0.1, 2.0)] {
            let options = GcodeOptions { motion, ..options(20e-6) };
            let (text, summary) = program(&chain, &options);
            let (_, pieces) = interpret(&text, Plane::Xy);
            assert!(summary.deviation <= 20e-6);
            assert_within(&chain, &pieces, summary.deviation, 500);
        }
    }
}

#[test]
fn the_s_curve_takes_few_arcs() {
    let chain = s_curve();
    let (pieces, deviation) = collect(arcs(&chain, 0.01).unwrap());
    let measured = assert_within(&chain, &pieces, deviation, 2000);
    let chord_count = chords(&chain, 0.01).unwrap().count();
    println!("arcs {}, chords {chord_count}, proven {deviation}, measured {measured}", pieces.len());
    assert!(pieces.len() <= 22 && chord_count > 2 * pieces.len());
    assert!(measured > 0.9 * deviation, "the bound is loose: {measured} {deviation}");
}

#[test]
fn circles_become_arcs_of_that_circle() {
    for angle in [0.5, 2.0, 3.1, 5.0, 6.27] {
        let chain = circle(50.0, angle);
        let (pieces, deviation) = collect(arcs(&chain, 0.01).unwrap());
        assert_within(&chain, &pieces, deviation, 500);
        assert!(pieces.len() <= 1 + (angle / 2.0) as usize, "{} arcs for {angle} rad", pieces.len());
        for piece in &pieces {
            let Piece::Arc { centre, .. } = piece else { panic!("not an arc: {piece:?}") };
            assert!(centre[0].hypot(centre[1]) < 0.1, "{centre:?}");
        }
    }
}

#[test]
fn nearly_straight_curves_become_lines() {
    let v = [100.0, 0.0];
    let flat = [element([0.0, 0.0], v, [0.0, 1e-4], [0.0, -1e-4], v, [100.0, 0.0])];
    let (pieces, _) = collect(arcs(&flat, 1e-3).unwrap());
    assert!(matches!(pieces[..], [Piece::Line(..)]), "{pieces:?}");
    let (text, summary) = program(&flat, &options(1e-3));
    assert_eq!((summary.arcs, summary.chords), (0, 1), "{text}");
}

#[test]
fn arcs_too_flat_for_a_control_become_chords_within_the_tolerance() {
    // Radius 2e7 over a length of 100: a bulge of 6e-5, three times the tolerance.
    let chain = [element([0.0, 0.0], [100.0, 0.0], [0.0, 5e-4], [0.0, 5e-4], [100.0, 5e-4], [100.0, 2.5e-4])];
    let (text, summary) = program(&chain, &options(2e-5));
    let (_, pieces) = interpret(&text, Plane::Xy);
    assert!(summary.arcs == 0 && summary.chords >= 2, "{text}");
    assert_within(&chain, &pieces, summary.deviation, 500);
    assert!(summary.deviation <= 2e-5);
}

#[test]
fn corners_stay_and_smooth_joints_do_not_show() {
    let tip = [10.0, 5.0];
    let roof = [
        element([0.0, 0.0], [10.0, 8.0], [0.0; 2], [0.0; 2], [10.0, 2.0], tip),
        element(tip, [10.0, -2.0], [0.0; 2], [0.0; 2], [10.0, -8.0], [20.0, 0.0]),
    ];
    let ends = |pieces: &[Piece]| {
        pieces.iter().any(|p| matches!(p, Piece::Line(_, end) | Piece::Arc { end, .. } if end[..2] == tip))
    };
    let (pieces, deviation) = collect(arcs(&roof, 0.5).unwrap());
    assert!(ends(&pieces) && greatest_kink(&pieces) > 0.3, "{pieces:?}");
    assert_within(&roof, &pieces, deviation, 500);
    // The same circle cut into ever more elements takes the same arcs.
    let count = |n: usize| {
        let chain: Vec<_> = (0..n)
            .flat_map(|k| {
                let turn = 2.0 * k as f64 / n as f64;
                circle(10.0, 2.0 / n as f64).into_iter().map(move |e| turned(e, turn))
            })
            .collect();
        arcs(&chain, 0.001).unwrap().count()
    };
    assert_eq!((count(3), count(100)), (1, 1));
}

fn turned(e: Element, angle: f64) -> Element {
    let (s, c) = angle.sin_cos();
    Element { rows: e.rows.map(|[x, y, z]| [c * x - s * y, s * x + c * y, z]) }
}

#[test]
fn the_path_moves_and_scales_with_the_curve() {
    let chain = wandering(&mut Random(5), 4, 1.0, 2.0);
    let count = arcs(&chain, 1e-3).unwrap().count();
    for (size, shift) in [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)] {
        let moved: Vec<_> = chain
            .iter()
            .map(|e| {
                let mut e = Element { rows: e.rows.map(|row| row.map(|x| size * x)) };
                e.rows[0][0] += shift;
                e.rows[5][0] += shift;
                e
            })
            .collect();
        let (pieces, deviation) = collect(arcs(&moved, 1e-3 * size).unwrap());
        assert!(deviation <= 1e-3 * size && pieces.len() == count, "{size} {shift}");
        assert_within(&moved, &pieces, deviation + 1e-9 * shift.min(1.0), 300);
    }
}

#[test]
fn hairpins_smaller_than_the_tolerance_are_followed() {
    // Almost a cusp: the derivative falls to a thousandth of its greatest in the middle, and the curve turns
    // back.
    let cusp = [element([-1.0, 1.0], [5.0, -5.0], [-9.8, 20.0], [9.8, 20.0], [5.0, 5.0], [1.0, 1.0])];
    for tolerance in [0.1, 1e-2, 1e-4] {
        let (pieces, deviation) = collect(arcs(&cusp, tolerance).unwrap());
        assert!(deviation <= tolerance);
        assert_within(&cusp, &pieces, deviation, 3000);
    }
}

#[test]
fn a_fold_beyond_the_end_is_not_cut_off() {
    // x' = 60 (t − 0.5)(t − 0.9): x goes to 5.5, back to 4.86 and on to 5, while y rises by less than the tolerance.
    let fold = [element([0.0, 0.0], [27.0, 0.01], [-84.0, 0.0], [36.0, 0.0], [3.0, 0.01], [5.0, 0.01])];
    let (pieces, deviation) = collect(arcs(&fold, 0.05).unwrap());
    assert!(deviation <= 0.05);
    assert_within(&fold, &pieces, deviation, 2000);
    let mut at = [0.0; 3];
    let straight: Vec<_> = chords(&fold, 0.05)
        .unwrap()
        .map(|chord| Piece::Line(std::mem::replace(&mut at, chord.end), chord.end))
        .collect();
    assert_within(&fold, &straight, 0.05, 2000);
}

#[test]
fn a_program_reads_as_documented() {
    let chain = [element([0.0, 0.0], [10.0, 0.0], [0.0; 2], [0.0; 2], [10.0, 0.0], [10.0, 0.0])];
    let options = GcodeOptions {
        depth: -2.0,
        plunge_feed: Some(100.0),
        units: Units::Inches,
        plane: Plane::Zx,
        ..GcodeOptions::new(0.01, 250.5, 5.0)
    };
    let (text, summary) = program(&chain, &options);
    assert_eq!(
        text,
        "G20\nG18\nG90\nG91.1\nG94\nG40\nG80\nG0 Y5\nG0 X0 Z0\nG1 Y-2 F100\nG1 X0 Z10 F250.5\nG0 Y5\nM2\n"
    );
    assert_eq!((summary.lines, summary.arcs, summary.chords, summary.length), (13, 0, 1, 10.0));
}

#[test]
fn bad_curves_and_tolerances_are_named() {
    let good = element([0.0, 0.0], [1.0, 0.0], [0.0; 2], [0.0; 2], [1.0, 0.0], [1.0, 0.0]);
    let next = element([1.0, 0.0], [1.0, 0.0], [0.0; 2], [0.0; 2], [1.0, 0.0], [2.0, 0.0]);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(arcs(&[good], tolerance).unwrap_err(), PathError::Tolerance);
        assert_eq!(chords(&[good], tolerance).unwrap_err(), PathError::Tolerance);
    }
    assert!(
        matches!(arcs(&[good], 1e-15), Err(PathError::ToleranceTooFine { finest }) if arcs(&[good], finest).is_ok())
    );
    assert_eq!(arcs(&[], 1.0).unwrap_err(), PathError::NoElements);
    let with = |change: fn(&mut Element)| {
        let mut bad = next;
        change(&mut bad);
        [good, bad]
    };
    assert_eq!(
        arcs(&with(|e| e.rows[2][1] = f64::NAN), 1.0).unwrap_err(),
        PathError::NotFinite { element: 1 }
    );
    assert_eq!(
        chords(&with(|e| e.rows[4][2] = f64::INFINITY), 1.0).unwrap_err(),
        PathError::NotFinite { element: 1 }
    );
    assert_eq!(
        chords(&with(|e| e.rows[2][1] = 1e300), 1.0).unwrap_err(),
        PathError::NotFinite { element: 1 }
    );
    assert_eq!(arcs(&with(|e| e.rows[3][2] = 5.0), 1.0).unwrap_err(), PathError::NotPlanar { element: 1 });
    assert!(chords(&with(|e| e.rows[3][2] = 5.0), 1.0).is_ok());
    assert_eq!(chords(&with(|e| e.rows[0][0] = 1.5), 1.0).unwrap_err(), PathError::Gap { element: 1 });
    assert_eq!(arcs(&with(|e| e.rows[1] = [0.0; 3]), 1.0).unwrap_err(), PathError::Irregular { element: 1 });
    // A cusp inside: C' = (1 − 2t, (1 − 2t)·…) vanishes at one half.
    let cusp = Element {
        rows: [[0.0; 3], [1.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0; 3]],
    };
    assert_eq!(arcs(&[cusp], 1.0).unwrap_err(), PathError::Irregular { element: 0 });
    assert!(chords(&[cusp], 0.01).is_ok());
}

#[test]
fn bad_options_are_named_and_nothing_is_written() {
    let chain = [element([0.0, 0.0], [10.0, 0.0], [0.0; 2], [0.0; 2], [10.0, 0.0], [10.0, 0.0])];
    let good = GcodeOptions::new(0.01, 100.0, 5.0);
    let fail = |options: GcodeOptions| {
        let mut text = String::new();
        let error = write_gcode(&chain, &options, &mut text).unwrap_err();
        assert!(text.is_empty() && !error.to_string().is_empty());
        error
    };
    for feed in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-7] {
        assert_eq!(fail(GcodeOptions { feed, ..good }), GcodeError::Feed);
        assert_eq!(fail(GcodeOptions { plunge_feed: Some(feed), ..good }), GcodeError::PlungeFeed);
    }
    for decimals in [0, 5, 10] {
        assert_eq!(fail(GcodeOptions { decimals, ..good }), GcodeError::Decimals);
    }
    for safe_height in [0.0, -1.0, f64::NAN] {
        assert_eq!(fail(GcodeOptions { safe_height, ..good }), GcodeError::SafeHeight { cut: 0.0 });
    }
    assert_eq!(fail(GcodeOptions { depth: f64::NAN, ..good }), GcodeError::Depth);
    assert_eq!(fail(GcodeOptions { tolerance: f64::NAN, ..good }), GcodeError::Path(PathError::Tolerance));
    let GcodeError::ToleranceBelowDecimals { finest } = fail(GcodeOptions { tolerance: 1e-6, ..good }) else {
        panic!()
    };
    program(&chain, &GcodeOptions { tolerance: finest, ..good });
    let far = turned(chain[0], 0.0);
    let far = Element { rows: far.rows.map(|row| row.map(|x| 1e8 * x)) };
    assert_eq!(
        write_gcode(&[far], &good, &mut String::new()),
        Err(GcodeError::CoordinateTooLarge { element: 0 })
    );
    assert_eq!(write_gcode(&[], &good, &mut String::new()), Err(GcodeError::Path(PathError::NoElements)));

    struct Full(usize);
    impl std::fmt::Write for Full {
        fn write_str(&mut self, s: &str) -> std::fmt::Result {
            self.0 = self.0.checked_sub(s.len()).ok_or(std::fmt::Error)?;
            Ok(())
        }
    }
    assert_eq!(write_gcode(&chain, &good, &mut Full(20)), Err(GcodeError::Write));
}
