//! The path writer: every program that is written is read back as a control reads it, and is within its tolerance of the curve,
//! by dense samples both ways.

use crate::coder::{Coder, Reading};
use crate::data;
use crate::result::elements_of;
use minvar::curve::Element;
use minvar::toolpath::{GcodeOptions, Motion, Move, Plane, Units, arcs, chords, write_gcode};
use minvar_ffi::minvar_element;
use minvar_tests::curves::derivatives;
use minvar_tests::paths::{Piece, Point, arc, interpret, norm, sub};
use std::fmt;

/// Longer paths are not measured: that takes as many steps as moves times samples.
const MOST_MOVES: usize = 120;
/// The bytes of so many moves.
const MOST_BYTES: usize = 6_000;
/// Samples an element.
const SAMPLES: usize = 48;

/// Everything that one input says.
#[derive(Clone)]
pub struct Case {
    /// The chain, before it is scaled and moved.
    pub chain: Vec<minvar_element>,
    /// Its size, as a power of two.
    pub scale: u8,
    /// Where it lies, in its size.
    pub shift: [f64; 3],
    /// The tolerance, in its size.
    pub tolerance: f64,
    /// Decimals, plane, motion.
    pub form: [u8; 3],
    /// What is added to z.
    pub depth: f64,
}

impl Default for Case {
    fn default() -> Self {
        Self { chain: Vec::new(), scale: 0, shift: [0.0; 3], tolerance: 0.0, form: [0; 3], depth: 0.0 }
    }
}

impl Case {
    /// The fields in order.
    pub fn code<C: Coder>(&mut self, c: &mut C) {
        data::elements(c, &mut self.chain, 3);
        c.byte(&mut self.scale);
        c.number_of(&mut self.tolerance, &[0.01, 1e-3, 0.1, 1e-4, 1e-5, 1e-6]);
        self.form.iter_mut().for_each(|form| c.byte(form));
        c.number_of(&mut self.depth, &[0.0, -2.0, 1.0]);
        let mut moves = u8::from(self.shift != [0.0; 3]);
        c.byte(&mut moves);
        if moves % 4 == 1 {
            c.vector(&mut self.shift);
        }
    }
}

/// Runs an input.
pub fn run(bytes: &[u8]) {
    let mut case = Case::default();
    case.code(&mut Reading::new(bytes));
    if crate::shows() {
        case.chain().iter().for_each(|element| eprintln!("{element:?}"));
        eprintln!(
            "scale 2^{}, tolerance {:e} of it, form {:?}, depth {:e}",
            case.scale % 64,
            case.tolerance,
            case.form,
            case.depth
        );
    }
    case.check();
}

/// Paper for so much text.
struct Paper(String);

impl fmt::Write for Paper {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        self.0 += s;
        if self.0.len() <= MOST_BYTES { Ok(()) } else { Err(fmt::Error) }
    }
}

impl Case {
    fn chain(&self) -> Vec<Element> {
        let scale = libm::exp2(f64::from(self.scale % 64) - 20.0);
        let mut chain = elements_of(&self.chain);
        for element in &mut chain {
            for (a, row) in element.rows.iter_mut().enumerate() {
                for (x, shift) in row.iter_mut().zip(self.shift) {
                    *x = scale * (*x + if a == 0 || a == 5 { shift } else { 0.0 });
                }
            }
        }
        chain
    }

    /// Follows the paths and reads the program back.
    pub fn check(&self) {
        let chain = self.chain();
        let scale = libm::exp2(f64::from(self.scale % 64) - 20.0);
        // Beyond this rounding of the measurement itself would be seen.
        let numbers = chain.iter().flat_map(|e| e.rows).flatten();
        let largest =
            numbers.fold(0.0f64, |most, x| if x.is_finite() { x.abs().max(most) } else { f64::MAX });
        let tolerance = self.tolerance * scale;
        if !(largest <= 1e12 && tolerance >= 1e-11 * largest) {
            return;
        }
        follow_chords(&chain, tolerance);
        follow_arcs(&chain, tolerance);
        self.program(&chain, tolerance);
    }

    fn program(&self, chain: &[Element], tolerance: f64) {
        let [decimals, plane, motion] = self.form;
        let plane = [Plane::Xy, Plane::Zx, Plane::Yz][usize::from(plane % 3)];
        let top = chain.iter().flat_map(Element::bezier).fold(f64::NEG_INFINITY, |top, p| top.max(p[2]));
        let options = GcodeOptions {
            plane,
            motion: if motion % 2 == 0 { Motion::Arcs } else { Motion::Chords },
            units: if motion / 2 % 2 == 0 { Units::Millimetres } else { Units::Inches },
            depth: self.depth,
            decimals: 6 + decimals % 4,
            ..GcodeOptions::new(tolerance, 1000.0, top + self.depth + 1.0)
        };
        let mut paper = Paper(String::new());
        let Ok(summary) = write_gcode(chain, &options, &mut paper) else { return };
        let (start, mut pieces) = interpret(&paper.0, plane);
        if pieces.len() > MOST_MOVES {
            return;
        }
        let raise = |p: &mut [f64; 3]| p[2] -= self.depth;
        for piece in &mut pieces {
            match piece {
                Piece::Line(a, b) | Piece::Arc { start: a, end: b, .. } => {
                    raise(a);
                    raise(b);
                }
            }
        }
        let (mut begin, first) = (start, chain[0].rows[0]);
        raise(&mut begin);
        assert!(norm(sub(begin, first)) <= tolerance, "the cut begins at {begin:?}, the curve at {first:?}");
        assert!(summary.deviation <= tolerance);
        let arcs = pieces.iter().filter(|piece| matches!(piece, Piece::Arc { .. })).count();
        assert_eq!((summary.arcs, summary.chords), (arcs, pieces.len() - arcs));
        assert_eq!(summary.lines, paper.0.lines().count());
        if pieces.is_empty() {
            // A curve no longer than the tolerance: the plunge is all.
            pieces.push(Piece::Line(begin, begin));
            assert_within(chain, &pieces, tolerance);
        } else {
            assert_within(chain, &pieces, bound(summary.deviation, chain, self.depth));
        }
    }
}

/// A deviation that was proven, and what rounding of the measurement may add.
fn bound(deviation: f64, chain: &[Element], depth: f64) -> f64 {
    let largest =
        chain.iter().flat_map(Element::bezier).flatten().fold(depth.abs(), |most, x| most.max(x.abs()));
    deviation + 1e-14 * largest
}

fn follow_chords(chain: &[Element], tolerance: f64) {
    let Ok(path) = chords(chain, tolerance) else { return };
    let (mut at, mut deviation, mut pieces) = (path.point(), 0.0f64, Vec::new());
    for chord in path.take(MOST_MOVES + 1) {
        pieces.push(Piece::Line(at, chord.end));
        at = chord.end;
        deviation = deviation.max(chord.deviation);
    }
    if pieces.len() <= MOST_MOVES {
        assert!(deviation <= tolerance);
        assert_within(chain, &pieces, bound(deviation, chain, 0.0));
    }
}

fn follow_arcs(chain: &[Element], tolerance: f64) {
    let Ok(path) = arcs(chain, tolerance) else { return };
    let (start, height) = (path.start(), path.height());
    let (mut at, mut deviation, mut pieces) = ([start[0], start[1], height], 0.0f64, Vec::new());
    for segment in path.take(MOST_MOVES + 1) {
        if crate::shows() {
            eprintln!("{segment:?}");
        }
        assert_eq!(segment.start, [at[0], at[1]]);
        deviation = deviation.max(segment.deviation);
        let (to, piece) = match segment.motion {
            Move::Line { end: [x, y] } => ([x, y, height], Piece::Line(at, [x, y, height])),
            Move::Arc { end: [x, y], centre, clockwise } => {
                ([x, y, height], arc(at, [x, y, height], centre, clockwise))
            }
        };
        pieces.push(piece);
        at = to;
    }
    if pieces.len() <= MOST_MOVES {
        assert!(deviation <= tolerance);
        assert_within(chain, &pieces, bound(deviation, chain, 0.0));
    }
}

/// Asserts that path and curve are within a bound of each other, by samples: of the curve from the path's pieces, which is
/// exact, and of the path from the curve, which [`reaches`].
fn assert_within(chain: &[Element], pieces: &[Piece], bound: f64) {
    let places: Vec<(f64, Point)> = chain
        .iter()
        .flat_map(|element| (0..=SAMPLES).map(move |k| (element, k as f64 / SAMPLES as f64)))
        .map(|(element, t)| (t, derivatives(element, t)[0]))
        .collect();
    for (t, place) in &places {
        let off = pieces.iter().map(|piece| piece.distance(*place)).fold(f64::INFINITY, f64::min);
        assert!(off <= bound, "the curve at {t} is {off:e} from the path, bound {bound:e}");
    }
    let per_piece = (2 * places.len() / pieces.len()).clamp(4, 60);
    let points =
        pieces.iter().flat_map(|piece| (0..=per_piece).map(|k| piece.point(k as f64 / per_piece as f64)));
    for point in points {
        if !places.iter().any(|(_, place)| norm(sub(*place, point)) <= bound) {
            let least = reaches(chain, point, bound);
            assert!(least <= bound, "the path at {point:?} is {least:e} from the curve, bound {bound:e}");
        }
    }
}

/// The distance of a place on the curve from a point: the first that is found within the bound, or the least of all. Arcs of
/// the curve are halved until one has an end that is near enough, or the boxes around their control points are all farther
/// away, so that no turn of the curve is overlooked, however sharp.
fn reaches(chain: &[Element], point: Point, bound: f64) -> f64 {
    let off_box = |points: &[Point; 6]| {
        let off: Point = std::array::from_fn(|d| {
            let low = points.iter().fold(f64::INFINITY, |low, p| low.min(p[d]));
            let high = points.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[d]));
            (low - point[d]).max(point[d] - high).max(0.0)
        });
        norm(off)
    };
    let mut least = f64::INFINITY;
    let mut arcs: Vec<([Point; 6], u32)> = chain.iter().map(|element| (element.bezier(), 0)).collect();
    while let Some((points, depth)) = arcs.pop() {
        least = [points[0], points[5]].into_iter().fold(least, |least, end| least.min(norm(sub(end, point))));
        if least <= bound {
            return least;
        }
        if off_box(&points) <= bound && depth < DEEPEST {
            let (mut left, mut right, mut row) = ([points[0]; 6], [points[5]; 6], points);
            for k in 1..6 {
                for i in 0..6 - k {
                    row[i] = std::array::from_fn(|d| 0.5 * (row[i][d] + row[i + 1][d]));
                }
                (left[k], right[5 - k]) = (row[0], row[5 - k]);
            }
            // The nearer half is looked at first.
            let mut halves = [(left, depth + 1), (right, depth + 1)];
            halves.sort_by(|a, b| off_box(&b.0).total_cmp(&off_box(&a.0)));
            arcs.extend(halves);
        }
    }
    least
}

/// How often an arc is halved at most: it is then as short as rounding.
const DEEPEST: u32 = 50;
