//! A chain measured anew: adaptive quadrature over the quintics' own formulas, with what rounding of the rows may change.

use crate::curves::{Vector, cross, derivatives, dot, gauss_legendre, norm, sub, times, unit};
use minvar::curve::{Element, Functional};
use std::sync::OnceLock;

/// The functionals by name, with the code that the kernel knows them by.
pub const FUNCTIONALS: [(&str, Functional); 4] = [
    ("mvc", Functional::MVC),
    ("mec", Functional::MEC),
    ("si-mvc", Functional(2)),
    ("si-mec", Functional(3)),
];

/// A functional's name.
pub fn name(functional: Functional) -> &'static str {
    FUNCTIONALS.iter().find(|(_, other)| *other == functional).map_or("unknown", |(name, _)| name)
}

/// The power of the length by which a functional shrinks when the shape grows.
pub fn power(functional: Functional) -> i32 {
    match name(functional) {
        "mvc" => 3,
        "mec" => 1,
        _ => 0,
    }
}

/// Whether a functional is one of the curvature and not of its change.
pub fn is_energy(functional: Functional) -> bool {
    matches!(name(functional), "mec" | "si-mec")
}

/// What a chain measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// The length.
    pub length: f64,
    /// `∫ |dκ/ds|² ds`.
    pub variation: f64,
    /// `∫ κ² ds`.
    pub bending: f64,
    /// What the rounding of the rows may make of a variation of zero.
    pub variation_noise: f64,
    /// What the rounding of the rows may make of a bending of zero.
    pub bending_noise: f64,
    /// Whether the quadrature came to an end.
    pub settled: bool,
}

impl Measured {
    /// A functional of the chain.
    pub fn value(&self, functional: Functional) -> f64 {
        let cube = self.length * self.length * self.length;
        match name(functional) {
            "mvc" => self.variation,
            "mec" => self.bending,
            "si-mvc" => cube * self.variation,
            "si-mec" => self.length * self.bending,
            _ => f64::NAN,
        }
    }

    /// How far rounding of the rows may move a functional: it adds noise to what is squared.
    pub fn rounding(&self, functional: Functional) -> f64 {
        let moved = |value: f64, noise: f64| 2.0 * (value * noise).sqrt() + noise;
        let (variation, bending) =
            (moved(self.variation, self.variation_noise), moved(self.bending, self.bending_noise));
        let cube = self.length * self.length * self.length;
        match name(functional) {
            "mvc" => variation,
            "mec" => bending,
            "si-mvc" => cube * variation,
            _ => self.length * bending,
        }
    }
}

/// How far the rounding of an element's rows, relative to the largest of them, moves its first three derivatives: what the
/// basis functions' derivatives sum to, by size.
const SPREAD: [f64; 3] = [5.0, 18.0, 192.0];

/// A piece is no shorter than its element halved so often.
const MOST_HALVINGS: u32 = 10;

/// Sums of a piece: length, variation, bending, and their noises.
type Sums = [f64; 5];

fn piece(element: &Element, from: f64, to: f64, blur: f64) -> Sums {
    static RULE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    let rule = RULE.get_or_init(|| gauss_legendre(16));
    let mut sums = [0.0; 5];
    for &(t, weight) in rule {
        let [_, d1, d2, d3] = derivatives(element, from + t * (to - from));
        let speed = norm(d1);
        let cube = speed * speed * speed;
        let bend = times(cross(d1, d2), 1.0 / cube);
        // Thesis (4.9) by the parameter, then by arc length.
        let by_parameter =
            sub(times(cross(d1, d3), 1.0 / cube), times(bend, 3.0 * dot(d1, d2) / (speed * speed)));
        let slope = times(by_parameter, 1.0 / speed);
        // To first order, the size of every summand's change: products change by each factor's, powers of the speed by its
        // own times the exponent. Where a curve nearly stops `C''` is much larger than the curvature asks for.
        let [e1, e2, e3] = SPREAD.map(|spread| spread * blur);
        let (second, third, along) = (norm(d2), norm(d3), dot(d1, d2).abs());
        let [product_blur, other_blur] = [speed * e2 + second * e1, speed * e3 + third * e1];
        let bend_blur = product_blur / cube + 3.0 * norm(bend) * e1 / speed;
        let slope_blur = (other_blur / cube
            + 3.0 * norm(cross(d1, d3)) / cube * e1 / speed
            + 3.0 * (bend_blur * along + norm(bend) * product_blur) / (speed * speed)
            + 6.0 * norm(bend) * along / (speed * speed) * e1 / speed
            + norm(by_parameter) * e1 / speed)
            / speed;
        let ds = weight * (to - from) * speed;
        for (sum, density) in sums.iter_mut().zip([
            1.0,
            dot(slope, slope),
            dot(bend, bend),
            slope_blur * slope_blur,
            bend_blur * bend_blur,
        ]) {
            *sum += density * ds;
        }
    }
    sums
}

/// How the rows of an element may be wrong.
#[derive(Clone, Copy)]
struct Blur {
    /// By rounding of what they are made of: positions too, however far they are from the origin.
    rows: f64,
    /// The square of the share of it that is left within the element, where only the chord counts: what an evaluation
    /// makes of rows that are taken as they stand.
    own: f64,
}

impl Blur {
    fn of(element: &Element) -> Self {
        let [p0, v0, a0, a1, v1, p1] = element.rows;
        let largest = |rows: &[Vector]| rows.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        let (all, own) = (largest(&element.rows), largest(&[sub(p1, p0), v0, a0, a1, v1]));
        Self { rows: 2.0 * f64::EPSILON * all, own: own / all * (own / all) }
    }
}

/// Halves pieces until both halves together are what the whole is.
fn adaptive(
    element: &Element,
    from: f64,
    to: f64,
    whole: Sums,
    blur: Blur,
    depth: u32,
    total: &mut Measured,
) {
    let middle = 0.5 * (from + to);
    let halves = [piece(element, from, middle, blur.rows), piece(element, middle, to, blur.rows)];
    let sum: Sums = std::array::from_fn(|i| halves[0][i] + halves[1][i]);
    // An evaluation's error has no sign that it keeps: over the points of a rule it averages out as chance does.
    let same = |i: usize, noise: f64| {
        (sum[i] - whole[i]).abs() <= 1e-9 * sum[i] + 2.0 * (sum[i] * noise).sqrt() / 16.0 + noise / 16.0
    };
    let settled = same(0, 0.0) && same(1, sum[3] * blur.own) && same(2, sum[4] * blur.own);
    if settled || depth == 0 {
        total.settled &= settled;
        total.length += sum[0];
        total.variation += sum[1];
        total.bending += sum[2];
        total.variation_noise += sum[3];
        total.bending_noise += sum[4];
        return;
    }
    adaptive(element, from, middle, halves[0], blur, depth - 1, total);
    adaptive(element, middle, to, halves[1], blur, depth - 1, total);
}

/// Measures a chain.
pub fn measure(elements: &[Element]) -> Measured {
    let mut total = Measured { settled: true, ..Measured::default() };
    for element in elements {
        let blur = Blur::of(element);
        adaptive(element, 0.0, 1.0, piece(element, 0.0, 1.0, blur.rows), blur, MOST_HALVINGS, &mut total);
    }
    total
}

/// The sharpest turn (radians) between neighbours of 256 places an element: a cusp is near a half turn.
pub fn sharpest_turn(elements: &[Element]) -> f64 {
    const PLACES: usize = 256;
    let mut most = 0.0f64;
    for element in elements {
        let mut before: Option<Vector> = None;
        for k in 0..=PLACES {
            let tangent = unit(derivatives(element, k as f64 / PLACES as f64)[1]);
            if let Some(before) = before {
                let turn = libm::atan2(norm(cross(before, tangent)), dot(before, tangent));
                most = if turn > most || turn.is_nan() { turn } else { most };
            }
            before = Some(tangent);
        }
    }
    most
}

/// The largest ratio of an element's mean speed to its least: an element that nearly stops hides a sharp bend from any
/// rule.
pub fn slowest(elements: &[Element]) -> f64 {
    const PLACES: usize = 256;
    let mut most = 1.0f64;
    for element in elements {
        let speeds: Vec<f64> =
            (0..=PLACES).map(|k| norm(derivatives(element, k as f64 / PLACES as f64)[1])).collect();
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        most = most.max(mean / speeds.iter().copied().fold(f64::INFINITY, f64::min));
    }
    most
}
