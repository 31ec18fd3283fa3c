//! A curve as a G-code program, written to any [`core::fmt::Write`].
//!
//! What is promised is the *printed* path: coordinates are rounded to the printed decimals first, an arc's
//! centre is given from the printed start, and what the rounding may displace is taken from the tolerance
//! beforehand. With `ρ` the most that rounding moves a point (1.04 units of the last decimal in space):
//!
//! - a chord between rounded points is within `ρ` of the exact chord;
//! - an arc with rounded start, end and centre is within `4ρ` of the exact arc: the centre is off by `ρ`, the
//!   radius at either end therefore by `2ρ`, and the ends' directions by `2ρ/R`. This assumes of the control
//!   only that it turns about the given centre and keeps its radius between those at the two ends. It is not
//!   true of arcs as short as the rounding, so arcs with a chord below 120 units of the last decimal become
//!   chords.
//!
//! Controls reject arcs whose radii at start and end differ (LinuxCNC: by 0.1 %). Those that differ by more
//! than a tenth of that or 0.0005 units, and those whose radius exceeds 1e5 chords, become chords too, as
//! many as the tolerance needs.
//!
//! No spindle, coolant, tool, work offset or path-blending command is written (no M3, M6, G43, G49, G54,
//! G64): they belong to the operator's machine. Note that `G64 P` spends a tolerance of its own on top of
//! this one.

use core::fmt::{self, Write};

use super::figure::RoundedUp;
use super::{Arcs, Chord, Chords, Move, PathError, Segment, arcs, chords};
use crate::curve::Element;
use crate::order::Order;
use crate::root::sqrt;

/// The most that rounding moves a point, in units of the last decimal: √3 halves, and a fifth of it for the
/// rounding of the product that finds the nearest decimal.
const ROUNDED: f64 = 1.04;

/// How much of the tolerance rounding takes from arcs, in `ρ`.
const ARC_RESERVE: f64 = 4.0;

/// The smallest tolerance in `ρ`: rounding may take a quarter of it.
const LEAST_TOLERANCE: f64 = 16.0;

/// Coordinates in units of the last decimal stay below this, so that their products round to a tenth of a
/// unit.
const LARGEST: f64 = (1_u64 << 49) as f64;

/// The shortest chord of a printed arc, in units of the last decimal.
const SHORTEST_ARC: f64 = 120.0;

/// The largest radius of a printed arc, in chords.
const FLATTEST_ARC: f64 = 1e5;

/// The largest difference of an arc's radii at its start and end, relative.
const MISMATCH: f64 = 1e-4;

/// The same as a length, in the program's unit.
const MISMATCH_LENGTH: f64 = 0.5e-3;

/// The unit of all lengths: the curve's, the tolerance's and the feed's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// `G21`.
    Millimetres,
    /// `G20`.
    Inches,
}

/// The machine's plane in which the curve's x and y lie; the curve's z is the third axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// `G17`: x, y, z are the machine's X, Y, Z.
    Xy,
    /// `G18`: x, y, z are the machine's Z, X, Y. Counterclockwise on paper is `G3` here too: the order is
    /// right-handed.
    Zx,
    /// `G19`: x, y, z are the machine's Y, Z, X.
    Yz,
}

/// How the path is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// `G2`/`G3` arcs and `G1` lines of a curve in a plane z = constant.
    Arcs,
    /// `G1` only, for any curve, also in space.
    Chords,
}

/// What a program is to be. Lengths are in the program's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GcodeOptions {
    /// The greatest distance between the printed path and the curve, positive.
    pub tolerance: f64,
    /// The unit, `G21` or `G20`.
    pub units: Units,
    /// The plane, `G17`, `G18` or `G19`.
    pub plane: Plane,
    /// Arcs or chords.
    pub motion: Motion,
    /// The cutting feed, length/minute, positive. There is no default: it is the material's.
    pub feed: f64,
    /// The feed while plunging, length/minute; `None` for the cutting feed.
    pub plunge_feed: Option<f64>,
    /// The third axis while moving to the start and after the end. Must be above the cut everywhere.
    pub safe_height: f64,
    /// What is added to the curve's z while cutting: negative goes into the material.
    pub depth: f64,
    /// Decimals printed, 6 … 9: with fewer, controls reject arcs.
    pub decimals: u8,
    /// Whether to explain the lines by comments in parentheses.
    pub comments: bool,
}

impl GcodeOptions {
    /// Arcs in the XY plane in millimetres at the curve's own height, 6 decimals, no comments.
    pub const fn new(tolerance: f64, feed: f64, safe_height: f64) -> Self {
        Self {
            tolerance,
            units: Units::Millimetres,
            plane: Plane::Xy,
            motion: Motion::Arcs,
            feed,
            plunge_feed: None,
            safe_height,
            depth: 0.0,
            decimals: 6,
            comments: false,
        }
    }
}

/// What was written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Lines of text.
    pub lines: usize,
    /// `G2` and `G3` moves.
    pub arcs: usize,
    /// `G1` moves that cut (the plunge is not counted).
    pub chords: usize,
    /// The length of the cut.
    pub length: f64,
    /// The time of the cut at the programmed feed, minutes, without acceleration, plunge and rapids.
    pub minutes: f64,
    /// Proven: no point of the printed cut is farther than this from the curve (raised by `depth`), nor the
    /// curve from the cut.
    pub deviation: f64,
}

/// Why a program was not written. All but `Write` are found before the first character.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GcodeError {
    /// The curve or the tolerance does not make a path.
    Path(PathError),
    /// The tolerance is too small for the number of decimals.
    ToleranceBelowDecimals {
        /// The smallest tolerance for these decimals.
        finest: f64,
    },
    /// The number of decimals is not 6 … 9.
    Decimals,
    /// The feed is not a positive number that can be printed with these decimals.
    Feed,
    /// As `Feed`, of the plunge feed.
    PlungeFeed,
    /// The depth is not finite or too large.
    Depth,
    /// The safe height is not above the cut, not finite or too large.
    SafeHeight {
        /// The highest that the cut may reach.
        cut: f64,
    },
    /// The element has a coordinate too large for these decimals: 2^48 units of the last.
    CoordinateTooLarge {
        /// The element, from 0.
        element: usize,
    },
    /// The writer failed; the program is incomplete.
    Write,
}

impl From<PathError> for GcodeError {
    fn from(error: PathError) -> Self {
        Self::Path(error)
    }
}

impl From<fmt::Error> for GcodeError {
    fn from(_: fmt::Error) -> Self {
        Self::Write
    }
}

impl fmt::Display for GcodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Path(error) => error.fmt(f),
            Self::ToleranceBelowDecimals { finest } => {
                write!(
                    f,
                    "the tolerance is too small for the decimals: give at least {} or more decimals",
                    RoundedUp(finest)
                )
            }
            Self::Decimals => write!(f, "the number of decimals must be 6 to 9"),
            Self::Feed => write!(f, "the feed must be positive, finite and not round to zero"),
            Self::PlungeFeed => write!(f, "the plunge feed must be positive, finite and not round to zero"),
            Self::Depth => write!(f, "the depth is not finite or too large for the printed decimals"),
            Self::SafeHeight { cut } => {
                write!(
                    f,
                    "the safe height must be finite and above the cut, which reaches {}",
                    RoundedUp(cut)
                )
            }
            Self::CoordinateTooLarge { element } => {
                write!(f, "element {element} has a coordinate too large for the printed decimals")
            }
            Self::Write => write!(f, "the output could not be written: the program is incomplete"),
        }
    }
}

impl core::error::Error for GcodeError {}

/// Writes the chain of elements as one complete program, and says what was written.
///
/// The lines, one word group each: the unit (`G21`/`G20`), the plane (`G17`/`G18`/`G19`), `G90` absolute
/// coordinates, `G91.1` arc centres from the arc's start, `G94` feed per minute, `G40` no cutter
/// compensation, `G80` no canned cycle; `G0` to the safe height, `G0` to the start, `G1` down at the plunge
/// feed; the cut at the feed; `G0` to the safe height; `M2`. A tool length offset in force stays in force.
///
/// Numbers have at most `decimals` decimals, no trailing zeros, no exponent and no negative zero; lines end
/// with `\n`. The same input gives the same bytes on every machine.
///
/// Errors: [`GcodeError`].
pub fn write_gcode<W: Write>(
    elements: &[Element],
    options: &GcodeOptions,
    out: &mut W,
) -> Result<Summary, GcodeError> {
    let grid = Grid::new(options.decimals).ok_or(GcodeError::Decimals)?;
    let rho = ROUNDED / grid.scale;
    let path = match options.motion {
        Motion::Arcs => Path::Arcs(arcs(elements, options.tolerance - ARC_RESERVE * rho)),
        Motion::Chords => Path::Chords(chords(elements, options.tolerance - rho)),
    };
    if options.tolerance > 0.0 && options.tolerance < LEAST_TOLERANCE * rho {
        return Err(GcodeError::ToleranceBelowDecimals { finest: LEAST_TOLERANCE * rho });
    }
    let feed = grid.positive(options.feed).ok_or(GcodeError::Feed)?;
    let plunge_feed = match options.plunge_feed {
        Some(plunge_feed) => grid.positive(plunge_feed).ok_or(GcodeError::PlungeFeed)?,
        None => feed,
    };
    if !grid.holds(options.depth) {
        return Err(GcodeError::Depth);
    }
    let mut cut = f64::NEG_INFINITY;
    for (element, one) in elements.iter().enumerate() {
        for point in one.bezier() {
            if !point.iter().all(|&x| grid.holds(2.0 * x)) {
                // A path error says it better.
                path.check()?;
                return Err(GcodeError::CoordinateTooLarge { element });
            }
            cut = cut.larger(point[2] + options.depth);
        }
    }
    path.check()?;
    if !(grid.holds(options.safe_height) && grid.nearest(options.safe_height) > grid.nearest(cut)) {
        return Err(GcodeError::SafeHeight { cut });
    }

    let mut program =
        Program { out, options, grid, rho, at: [0; 3], feed: None, summary: Summary::default() };
    program.preamble()?;
    match path {
        Path::Arcs(path) => {
            let path = path?;
            let [x, y] = path.start();
            program.approach([x, y, path.height()], plunge_feed)?;
            for segment in path {
                program.segment(&segment, feed)?;
            }
        }
        Path::Chords(path) => {
            let path = path?;
            program.approach(path.point(), plunge_feed)?;
            for Chord { end, deviation } in path {
                let end = program.on_grid(end);
                program.chord(end, deviation, feed)?;
            }
        }
    }
    program.leave()?;
    program.summary.minutes = program.summary.length / grid.value(feed);
    Ok(program.summary)
}

enum Path<'a> {
    Arcs(Result<Arcs<'a>, PathError>),
    Chords(Result<Chords<'a>, PathError>),
}

impl Path<'_> {
    fn check(&self) -> Result<(), PathError> {
        match self {
            Path::Arcs(path) => path.as_ref().map(|_| ()).map_err(|&error| error),
            Path::Chords(path) => path.as_ref().map(|_| ()).map_err(|&error| error),
        }
    }
}

/// The printable numbers: multiples of one unit of the last decimal, counted as integers.
#[derive(Clone, Copy)]
struct Grid {
    /// `10^decimals`.
    scale: f64,
}

impl Grid {
    fn new(decimals: u8) -> Option<Self> {
        let scale = match decimals {
            6 => 1e6,
            7 => 1e7,
            8 => 1e8,
            9 => 1e9,
            _ => return None,
        };
        Some(Self { scale })
    }

    /// Whether the number is small enough to be printed; false for what is not finite.
    fn holds(self, x: f64) -> bool {
        (x * self.scale).abs() < LARGEST
    }

    /// The nearest multiple of the unit.
    fn nearest(self, x: f64) -> i64 {
        libm::round(x * self.scale) as i64
    }

    /// The nearest multiple of the unit if it is positive and small enough.
    fn positive(self, x: f64) -> Option<i64> {
        (self.holds(x) && self.nearest(x) > 0).then(|| self.nearest(x))
    }

    /// The number as a reader of the printed decimals sees it.
    fn value(self, n: i64) -> f64 {
        n as f64 / self.scale
    }

    fn write<W: Write>(self, out: &mut W, n: i64) -> fmt::Result {
        if n < 0 {
            out.write_char('-')?;
        }
        let scale = self.scale as u64;
        let whole = n.unsigned_abs().checked_div(scale).unwrap_or(0);
        write!(out, "{whole}")?;
        let mut fraction = n.unsigned_abs() - whole * scale;
        if fraction > 0 {
            out.write_char('.')?;
        }
        // Ends with the last digit that is not zero.
        let mut unit = scale;
        while fraction > 0 {
            unit = (unit / 10).max(1);
            let digit = fraction / unit;
            fraction -= digit * unit;
            out.write_char(char::from(b'0' + digit as u8))?;
        }
        Ok(())
    }
}

struct Program<'a, W> {
    out: &'a mut W,
    options: &'a GcodeOptions,
    grid: Grid,
    rho: f64,
    /// Where the tool is, in the curve's axes.
    at: [i64; 3],
    feed: Option<i64>,
    summary: Summary,
}

impl<W: Write> Program<'_, W> {
    fn preamble(&mut self) -> fmt::Result {
        match self.options.units {
            Units::Millimetres => self.words("G21", "millimetres")?,
            Units::Inches => self.words("G20", "inches")?,
        }
        match self.options.plane {
            Plane::Xy => self.words("G17", "XY plane")?,
            Plane::Zx => self.words("G18", "ZX plane")?,
            Plane::Yz => self.words("G19", "YZ plane")?,
        }
        self.words("G90", "absolute coordinates")?;
        self.words("G91.1", "arc centres from the start of the arc")?;
        self.words("G94", "feed per minute")?;
        self.words("G40", "no cutter compensation")?;
        self.words("G80", "no canned cycle")
    }

    fn approach(&mut self, start: [f64; 3], plunge_feed: i64) -> fmt::Result {
        let safe = self.grid.nearest(self.options.safe_height);
        let [x, y, z] = self.on_grid(start);
        self.go("G0", [None, None, Some(safe)], None, None, "safe height")?;
        self.go("G0", [Some(x), Some(y), None], None, None, "start")?;
        self.go("G1", [None, None, Some(z)], None, Some(plunge_feed), "plunge")
    }

    fn leave(&mut self) -> fmt::Result {
        let safe = self.grid.nearest(self.options.safe_height);
        self.go("G0", [None, None, Some(safe)], None, None, "safe height")?;
        self.words("M2", "end")
    }

    /// A move of the arc path, as an arc if a control takes it, else as chords.
    fn segment(&mut self, segment: &Segment, feed: i64) -> fmt::Result {
        let height = self.grid.value(self.at[2]) - self.options.depth;
        match segment.motion {
            Move::Line { end: [x, y] } => {
                let end = self.on_grid([x, y, height]);
                self.chord(end, segment.deviation, feed)
            }
            Move::Arc { end: [x, y], centre, clockwise } => {
                let to = self.on_grid([x, y, height]);
                match self.printable(to, centre) {
                    Some(printable) => {
                        self.note(segment.deviation + ARC_RESERVE * self.rho, printable.length);
                        self.summary.arcs += 1;
                        let code = if clockwise { "G2" } else { "G3" };
                        self.go(
                            code,
                            [Some(to[0]), Some(to[1]), None],
                            Some(printable.offset),
                            Some(feed),
                            "",
                        )
                    }
                    None => self.arc_as_chords(segment, [x, y], centre, clockwise, feed),
                }
            }
        }
    }

    /// The centre from the start, both as printed, unless a control might reject the arc.
    fn printable(&self, to: [i64; 3], centre: [f64; 2]) -> Option<PrintableArc> {
        let offset = [centre[0] - self.grid.value(self.at[0]), centre[1] - self.grid.value(self.at[1])];
        if !(self.grid.holds(offset[0]) && self.grid.holds(offset[1])) {
            return None;
        }
        let offset = offset.map(|x| self.grid.nearest(x));
        // All differences of integers below 2^50: exact.
        let [i, j] = offset.map(|n| n as f64);
        let (dx, dy) = ((to[0] - self.at[0]) as f64, (to[1] - self.at[1]) as f64);
        let chord = length(dx, dy);
        let (from_start, from_end) = (length(i, j), length(dx - i, dy - j));
        let mismatch = (from_start - from_end).abs();
        let fits = chord >= SHORTEST_ARC
            && from_start <= FLATTEST_ARC * chord
            && mismatch <= MISMATCH * from_start
            && mismatch <= MISMATCH_LENGTH * self.grid.scale;
        let radius = 0.5 * (from_start + from_end);
        let length = 2.0 * radius * libm::asin((0.5 * chord / radius).smaller(1.0)) / self.grid.scale;
        fits.then_some(PrintableArc { offset, length })
    }

    /// An arc as the fewest equal chords that keep what is left of the tolerance.
    fn arc_as_chords(
        &mut self,
        segment: &Segment,
        end: [f64; 2],
        centre: [f64; 2],
        clockwise: bool,
        feed: i64,
    ) -> fmt::Result {
        let start = segment.start;
        let height = self.grid.value(self.at[2]) - self.options.depth;
        let chord = [end[0] - start[0], end[1] - start[1]];
        let chord_length = length(chord[0], chord[1]);
        let radius = length(start[0] - centre[0], start[1] - centre[1]);
        // Half the angle of the arc.
        let half = libm::asin((0.5 * chord_length / radius).smaller(1.0));
        // A chord of angle φ deviates by R(1 − cos(φ/2)) ≤ Rφ²/8; what is left is at least 3ρ.
        let left = self.options.tolerance - self.rho - segment.deviation;
        let whole = 0.5 * radius * half * half;
        // Not a number if the radius overflows: then the arc is straight.
        let whole = if whole.is_finite() { whole } else { 0.0 };
        let count = libm::ceil(sqrt(whole / left)).clamp(1.0, 1e6);
        let side = if clockwise { 1.0 } else { -1.0 };
        let deviation = segment.deviation + whole / (count * count);
        for k in 1..count as u32 {
            let angle = half * (2.0 * f64::from(k) / count - 1.0);
            // In the chord's frame: along it, and to its left.
            let along = 0.5 + radius * libm::sin(angle) / chord_length;
            let bulge = libm::sin(0.5 * (half + angle)) * libm::sin(0.5 * (half - angle));
            let across = side * 2.0 * radius * bulge / chord_length;
            let x = start[0] + along * chord[0] - across * chord[1];
            let y = start[1] + along * chord[1] + across * chord[0];
            let to = self.on_grid([x, y, height]);
            self.chord(to, deviation, feed)?;
        }
        let to = self.on_grid([end[0], end[1], height]);
        self.chord(to, deviation, feed)
    }

    /// A straight cut; nothing if it ends where it begins as printed.
    fn chord(&mut self, to: [i64; 3], deviation: f64, feed: i64) -> fmt::Result {
        let [dx, dy, dz] = [to[0] - self.at[0], to[1] - self.at[1], to[2] - self.at[2]].map(|n| n as f64);
        self.note(deviation + self.rho, length(length(dx, dy), dz) / self.grid.scale);
        if to == self.at {
            return Ok(());
        }
        self.summary.chords += 1;
        let z = (to[2] != self.at[2]).then_some(to[2]);
        self.go("G1", [Some(to[0]), Some(to[1]), z], None, Some(feed), "")
    }

    fn note(&mut self, deviation: f64, length: f64) {
        self.summary.deviation = self.summary.deviation.larger(deviation);
        self.summary.length += length;
    }

    /// A point of the curve where it is cut.
    fn on_grid(&self, [x, y, z]: [f64; 3]) -> [i64; 3] {
        [x, y, z + self.options.depth].map(|x| self.grid.nearest(x))
    }

    fn words(&mut self, words: &str, comment: &str) -> fmt::Result {
        self.out.write_str(words)?;
        self.end_line(comment)
    }

    fn end_line(&mut self, comment: &str) -> fmt::Result {
        if self.options.comments && !comment.is_empty() {
            write!(self.out, " ({comment})")?;
        }
        self.summary.lines += 1;
        self.out.write_char('\n')
    }

    /// One move, its coordinates and centre in the curve's axes, the words in the machine's.
    fn go(
        &mut self,
        code: &str,
        to: [Option<i64>; 3],
        centre: Option<[i64; 2]>,
        feed: Option<i64>,
        comment: &str,
    ) -> fmt::Result {
        self.out.write_str(code)?;
        for (letter, value) in ['X', 'Y', 'Z'].into_iter().zip(self.on_machine(to)) {
            self.word(letter, value)?;
        }
        if let Some([i, j]) = centre {
            for (letter, value) in ['I', 'J', 'K'].into_iter().zip(self.on_machine([Some(i), Some(j), None]))
            {
                self.word(letter, value)?;
            }
        }
        if feed.is_some() && feed != self.feed {
            self.word('F', feed)?;
            self.feed = feed;
        }
        for (at, to) in self.at.iter_mut().zip(to) {
            *at = to.unwrap_or(*at);
        }
        self.end_line(comment)
    }

    fn on_machine<T>(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        match self.options.plane {
            Plane::Xy => [x, y, z],
            Plane::Zx => [y, z, x],
            Plane::Yz => [z, x, y],
        }
    }

    fn word(&mut self, letter: char, value: Option<i64>) -> fmt::Result {
        let Some(value) = value else { return Ok(()) };
        self.out.write_char(' ')?;
        self.out.write_char(letter)?;
        self.grid.write(self.out, value)
    }
}

struct PrintableArc {
    /// From the start to the centre.
    offset: [i64; 2],
    /// In the program's unit.
    length: f64,
}

fn length(x: f64, y: f64) -> f64 {
    sqrt(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(x: f64, decimals: u8) -> heapless::String<32> {
        let grid = Grid::new(decimals).unwrap();
        let mut text = heapless::String::new();
        grid.write(&mut text, grid.nearest(x)).unwrap();
        text
    }

    #[test]
    fn numbers_are_trimmed_and_never_minus_zero() {
        for (x, decimals, text) in [
            (0.0, 6, "0"),
            (-1e-9, 6, "0"),
            (1.5, 6, "1.5"),
            (-0.000_001, 6, "-0.000001"),
            (123.0, 9, "123"),
            (100.000_25, 6, "100.00025"),
            (-0.1, 7, "-0.1"),
        ] {
            assert_eq!(printed(x, decimals), text);
        }
    }
}
