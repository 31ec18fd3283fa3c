//! Start values of planar curves in their natural parameter: the direction as a function of arc length.
//!
//! Written by the direction `θ(s)`, the functionals are quadratic: `∫ θ''² ds`, `∫ θ'² ds`, `L`. All that is nonlinear is
//! that every span must end at its joint. With `u = s/L`, a span's direction is taken as the quintic
//!
//! ```text
//! θ(u) = φ₀ h₀₀ + λa h₁₀ + φ₁ h₀₁ + λb h₁₁ + x B₁ + y B₂,     B₁ = u²(1−u)², B₂ = B₁ (2u − 1)
//! ```
//!
//! with `φ₀, φ₁` the directions at its ends against the chord of length `c`, `a, b` the curvatures there times `c`,
//! `λ = L/c`, and cubic Hermite functions `h`. The span closes if `∫ sin θ du = 0` and `∫ cos θ du = 1/λ`, which
//! determine `x` and `λ`; `y` is free. Directions and curvatures at the joints are what spans share: two unknowns a
//! joint. Newton's method on the Lagrangian, every span condensed to its four shared unknowns, takes a handful of
//! iterations of a fraction of a microsecond a span, and ends near the true minimum variation curve: nearer than
//! quintics in Hermite form can be. It is trusted only where it settles fast; elsewhere the thesis's start values stand.

use super::fairness::{Density, Shape};
use super::joint::Given;
use super::model::{Division, Model};
use crate::basis::lanes::{Lanes, WIDTH};
use crate::basis::quadrature::legendre;
use crate::solve::{Envelope, Indices};

/// Functions of `u` that make up a direction.
const FUNCTIONS: usize = 6;
/// Gauss–Legendre points a span.
const POINTS: usize = 8;
const CHUNKS: usize = POINTS / WIDTH;

/// The most iterations.
const MOST_ITERATIONS: usize = 12;
/// Settled when no direction changes by more than this (radians), nor a curvature by this over the chord.
const SETTLED: f64 = 3e-3;
/// A curve that grows by this factor may grow without limit.
const GROWN: f64 = 10.0;
/// The longest step of a direction.
const LONGEST_STEP: f64 = 0.5;

/// The functions and their first two derivatives at a place.
const fn functions(u: f64) -> [[f64; FUNCTIONS]; 3] {
    let (v, m) = (1.0 - u, 2.0 * u - 1.0);
    let b = u * u * v * v;
    // B₁' = −2uv m,  B₁'' = 2m² − 4uv.
    let (b1, b2) = (-2.0 * u * v * m, 2.0 * m * m - 4.0 * u * v);
    [
        [(1.0 + 2.0 * u) * v * v, u * v * v, u * u * (3.0 - 2.0 * u), -u * u * v, b, b * m],
        [-6.0 * u * v, v * (1.0 - 3.0 * u), 6.0 * u * v, u * (3.0 * u - 2.0), b1, b1 * m + 2.0 * b],
        [6.0 * m, 6.0 * u - 4.0, -6.0 * m, 6.0 * u - 2.0, b2, b2 * m + 4.0 * b1],
    ]
}

struct Tables {
    weight: [Lanes; CHUNKS],
    at: [[Lanes; FUNCTIONS]; CHUNKS],
    /// `∫ ψᵢ'' ψⱼ''` and `∫ ψᵢ' ψⱼ'`.
    bend: [[f64; FUNCTIONS]; FUNCTIONS],
    slope: [[f64; FUNCTIONS]; FUNCTIONS],
}

const fn tables() -> Tables {
    let mut out = Tables {
        weight: [Lanes::ZERO; CHUNKS],
        at: [[Lanes::ZERO; FUNCTIONS]; CHUNKS],
        bend: [[0.0; FUNCTIONS]; FUNCTIONS],
        slope: [[0.0; FUNCTIONS]; FUNCTIONS],
    };
    if let Some(rule) = legendre(POINTS) {
        let mut k = 0;
        while k < POINTS {
            let (u, w) = (rule.nodes[k], rule.weights[k]);
            let f = functions(u);
            out.weight[k / WIDTH].0[k % WIDTH] = w;
            let mut i = 0;
            while i < FUNCTIONS {
                out.at[k / WIDTH][i].0[k % WIDTH] = f[0][i];
                let mut j = 0;
                while j < FUNCTIONS {
                    out.bend[i][j] += w * f[2][i] * f[2][j];
                    out.slope[i][j] += w * f[1][i] * f[1][j];
                    j += 1;
                }
                i += 1;
            }
            k += 1;
        }
    }
    out
}

static TABLES: Tables = tables();

/// Sine and cosine for start values: to 1e-9 up to a turn of 5 radians. Cheaper side by side than one by one.
#[inline(always)]
fn sine_cosine(angle: Lanes) -> [Lanes; 2] {
    let x = angle * 0.25;
    let z = x * x;
    let one = Lanes::ONE;
    let mut s = z * (-1.0 / 39_916_800.0) + one * (1.0 / 362_880.0);
    s = z * s + one * (-1.0 / 5_040.0);
    s = z * s + one * (1.0 / 120.0);
    s = z * s + one * (-1.0 / 6.0);
    s = x * (z * s + one);
    let mut c = z * (1.0 / 479_001_600.0) + one * (-1.0 / 3_628_800.0);
    c = z * c + one * (1.0 / 40_320.0);
    c = z * c + one * (-1.0 / 720.0);
    c = z * c + one * (1.0 / 24.0);
    c = z * c + one * (-0.5);
    c = z * c + one;
    for _ in 0..2 {
        let double = s * c * 2.0;
        c = one - s * s * 2.0;
        s = double;
    }
    [s, c]
}

/// A span: its chord, its shared values and its own.
#[derive(Clone, Copy)]
struct Span {
    chord: f64,
    /// `φ₀, κ₀, φ₁, κ₁`.
    shared: [f64; 4],
    /// `λ, x, y`.
    own: [f64; 3],
}

/// How a span's own values follow the shared ones, to first order: `y`, then `λ` and `x`.
#[derive(Clone, Copy)]
struct Follow {
    y: f64,
    y_by: [f64; 4],
    own: [f64; 2],
    /// By the four shared ones and by `y`.
    own_by: [[f64; 5]; 2],
}

/// A span's share of the functional: condensed gradient and Hessian by the shared values.
struct Condensed {
    gradient: [f64; 4],
    hessian: [[f64; 4]; 4],
    follow: Follow,
    /// How far the span is from closing, as a fraction of its chord.
    gap: f64,
    /// `∫ θ_ss² ds` or `∫ θ_s² ds` as the functional asks, and the length.
    sums: [f64; 2],
}

/// The weights of `∫ θ''² ds`, `∫ θ'² ds` and `L`.
#[derive(Clone, Copy)]
struct Weigh {
    bend: f64,
    slope: f64,
    length: f64,
}

fn product(matrix: &[[f64; FUNCTIONS]; FUNCTIONS], q: &[f64; FUNCTIONS]) -> [f64; FUNCTIONS] {
    let mut out = [0.0; FUNCTIONS];
    for i in 0..FUNCTIONS {
        let mut sum = 0.0;
        for j in 0..FUNCTIONS {
            sum += matrix[i][j] * q[j];
        }
        out[i] = sum;
    }
    out
}

fn inner(a: &[f64; FUNCTIONS], b: &[f64; FUNCTIONS]) -> f64 {
    let mut sum = 0.0;
    for i in 0..FUNCTIONS {
        sum += a[i] * b[i];
    }
    sum
}

/// Condenses a span; `None` where it has no regular solution nearby. `curvature` is the part of the closing conditions'
/// second derivatives that is taken into account, 1 for Newton's method.
fn condense(span: &Span, weigh: &Weigh, curvature: f64) -> Option<Condensed> {
    let c = span.chord;
    let [l, x, y] = span.own;
    let [phi0, k0, phi1, k1] = span.shared;
    let (a, b) = (k0 * c, k1 * c);
    let q = [phi0, l * a, phi1, l * b, x, y];

    // The moments of sine and cosine.
    let mut sines = [Lanes::ZERO; CHUNKS];
    let mut cosines = [Lanes::ZERO; CHUNKS];
    let (mut sine_sum, mut cosine_sum) = (Lanes::ZERO, Lanes::ZERO);
    let mut moments = [[Lanes::ZERO; FUNCTIONS]; 2];
    for k in 0..CHUNKS {
        let at = &TABLES.at[k];
        let mut theta = at[0] * q[0];
        for i in 1..FUNCTIONS {
            theta += at[i] * q[i];
        }
        let [s, co] = sine_cosine(theta);
        let (s, co) = (s * TABLES.weight[k], co * TABLES.weight[k]);
        sines[k] = s;
        cosines[k] = co;
        sine_sum += s;
        cosine_sum += co;
        for i in 0..FUNCTIONS {
            moments[0][i] += s * at[i];
            moments[1][i] += co * at[i];
        }
    }
    let [s, co] = moments.map(|row| row.map(|x: Lanes| x.total()));
    let inverse = 1.0 / l;
    let gaps = [sine_sum.total(), cosine_sum.total() - inverse];

    // The functional by q and λ.
    let bend = weigh.bend * inverse * inverse * inverse / (c * c * c);
    let slope = weigh.slope * inverse / c;
    let (by_bend, by_slope) = (product(&TABLES.bend, &q), product(&TABLES.slope, &q));
    let (bends, slopes) = (inner(&q, &by_bend), inner(&q, &by_slope));
    let mut g = [0.0; FUNCTIONS];
    let mut g_l = [0.0; FUNCTIONS];
    for i in 0..FUNCTIONS {
        g[i] = 2.0 * (bend * by_bend[i] + slope * by_slope[i]);
        g_l[i] = -2.0 * inverse * (3.0 * bend * by_bend[i] + slope * by_slope[i]);
    }
    let of_l = -inverse * (3.0 * bend * bends + slope * slopes) + weigh.length * c;
    let of_ll = inverse * inverse * (12.0 * bend * bends + 2.0 * slope * slopes);

    // The closing conditions by φ₀, a, φ₁, b, y and by λ, x.
    let r1 = [co[0], l * co[1], co[2], l * co[3], co[5]];
    let r2 = [-s[0], -l * s[1], -s[2], -l * s[3], -s[5]];
    let d = [[a * co[1] + b * co[3], co[4]], [inverse * inverse - (a * s[1] + b * s[3]), -s[4]]];
    let determinant = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    if !(determinant.abs() > 1e-4 * (d[0][1].abs() + d[1][1].abs())) {
        return None;
    }
    let solve = |r: [f64; 2]| {
        [(d[1][1] * r[0] - d[0][1] * r[1]) / determinant, (d[0][0] * r[1] - d[1][0] * r[0]) / determinant]
    };
    // The multipliers that leave no gradient by λ and x.
    let (j_l, j_x) = (of_l + a * g[1] + b * g[3], g[4]);
    let mu = [-(d[1][1] * j_l - d[1][0] * j_x) / determinant, -(d[0][0] * j_x - d[0][1] * j_l) / determinant];

    // Second derivatives of the Lagrangian by q.
    let mut second = [[Lanes::ZERO; FUNCTIONS]; FUNCTIONS];
    for k in 0..CHUNKS {
        let at = &TABLES.at[k];
        let w = sines[k] * (-mu[0] * curvature) + cosines[k] * (-mu[1] * curvature);
        for i in 0..FUNCTIONS {
            let row = w * at[i];
            for j in 0..=i {
                second[i][j] += row * at[j];
            }
        }
    }
    let mut h = [[0.0; FUNCTIONS]; FUNCTIONS];
    for i in 0..FUNCTIONS {
        for j in 0..=i {
            h[i][j] = second[i][j].total() + 2.0 * (bend * TABLES.bend[i][j] + slope * TABLES.slope[i][j]);
            h[j][i] = h[i][j];
        }
    }
    let mut by_q = [0.0; FUNCTIONS];
    for i in 0..FUNCTIONS {
        by_q[i] = g[i] + mu[0] * co[i] - mu[1] * s[i];
    }
    // By φ₀, a, φ₁, b, y | λ, x.
    let place = [0, 1, 2, 3, 5];
    let scale = [1.0, l, 1.0, l, 1.0];
    let along_l: [f64; FUNCTIONS] = core::array::from_fn(|i| g_l[i] + a * h[i][1] + b * h[i][3]);
    let mut with_l = [0.0; 5];
    let mut with_x = [0.0; 5];
    let mut gradient = [0.0; 5];
    for f in 0..5 {
        let (i, by) = (place[f], scale[f]);
        gradient[f] = by * by_q[i];
        with_l[f] = by * along_l[i] + if i == 1 || i == 3 { by_q[i] } else { 0.0 };
        with_x[f] = by * h[i][4];
    }
    let cube = inverse * inverse * inverse;
    let ll =
        of_ll - 2.0 * mu[1] * curvature * cube + a * g_l[1] + b * g_l[3] + a * along_l[1] + b * along_l[3];
    let lx = along_l[4];
    let xx = h[4][4];

    let off = solve(gaps).map(|v| -v);
    let mut follow = [[0.0; 5]; 2];
    for f in 0..5 {
        let [by_l, by_x] = solve([r1[f], r2[f]]);
        follow[0][f] = -by_l;
        follow[1][f] = -by_x;
    }
    let mut reduced = [[0.0; 5]; 5];
    for f in 0..5 {
        let (tl, tx) = (follow[0][f], follow[1][f]);
        let (own_l, own_x) = (with_l[f] + tl * ll + tx * lx, with_x[f] + tl * lx + tx * xx);
        gradient[f] += own_l * off[0] + own_x * off[1];
        for e in 0..=f {
            let plain = scale[f] * scale[e] * h[place[f]][place[e]];
            reduced[f][e] =
                plain + own_l * follow[0][e] + own_x * follow[1][e] + tl * with_l[e] + tx * with_x[e];
            reduced[e][f] = reduced[f][e];
        }
    }
    let pivot = reduced[4][4];
    if !(pivot > 0.0) {
        return None;
    }
    // Out with y; the shared curvatures are κ, not κc.
    let units = [1.0, c, 1.0, c];
    let mut out = Condensed {
        gradient: [0.0; 4],
        hessian: [[0.0; 4]; 4],
        follow: Follow { y: -gradient[4] / pivot, y_by: [0.0; 4], own: off, own_by: follow },
        gap: gaps[0].abs() + gaps[1].abs(),
        sums: [if weigh.bend != 0.0 { bends * cube / (c * c * c) } else { slopes * inverse / c }, l * c],
    };
    for f in 0..4 {
        let by = reduced[4][f] / pivot;
        out.follow.y_by[f] = -by * units[f];
        out.gradient[f] = (gradient[f] - by * gradient[4]) * units[f];
        for e in 0..4 {
            out.hessian[f][e] = (reduced[f][e] - by * reduced[4][e]) * units[f] * units[e];
        }
        for row in &mut out.follow.own_by {
            row[f] *= units[f];
        }
    }
    Some(out)
}

impl Span {
    /// Takes a step of the shared values by `by`, a part of the whole step that `follow` belongs to.
    fn advance(&mut self, step: &[f64; 4], follow: &Follow, by: f64) {
        let mut y = follow.y;
        for f in 0..4 {
            self.shared[f] += by * step[f];
            y += follow.y_by[f] * step[f];
        }
        for (own, (start, slopes)) in self.own.iter_mut().zip(follow.own.iter().zip(&follow.own_by)) {
            let mut change = start + slopes[4] * y;
            for f in 0..4 {
                change += slopes[f] * step[f];
            }
            *own += by * change;
        }
        self.own[2] += by * y;
    }

    fn length(&self) -> f64 {
        self.own[0] * self.chord
    }

    /// `∫ sin θ du` and `∫ cos θ du` for a direction by its coefficients.
    fn reach(q: &[f64; FUNCTIONS]) -> [f64; 2] {
        let mut sums = [Lanes::ZERO; 2];
        for (at, weight) in TABLES.at.iter().zip(TABLES.weight) {
            let mut theta = at[0] * q[0];
            for i in 1..FUNCTIONS {
                theta += at[i] * q[i];
            }
            let [s, c] = sine_cosine(theta);
            sums[0] += s * weight;
            sums[1] += c * weight;
        }
        sums.map(|sum| sum.total())
    }

    /// Closes the span for a start: bends it between its ends, as little as possible, until it runs along its chord. Where
    /// the curvature at an end is the span's own, that is bent too, so that the curvature changes evenly. Returns whether it
    /// could.
    fn close(&mut self, alone: [bool; 2]) -> bool {
        let [phi0, k0, phi1, k1] = self.shared;
        let turn = phi1 - phi0;
        let stretched = self.own[0] * self.chord;
        let [a, b] = [(alone[0], k0), (alone[1], k1)].map(|(own, k)| if own { turn } else { k * stretched });
        let start = [phi0, a, phi1, b, 0.0, 0.0];
        let mut towards = [0.0; FUNCTIONS];
        match alone {
            [false, false] => towards[4] = 16.0,
            [first, last] => {
                towards[1] = if first { 4.0 } else { 0.0 };
                towards[3] = if last { -4.0 } else { 0.0 };
            }
        }
        let bent = |by: f64| -> [f64; FUNCTIONS] { core::array::from_fn(|i| start[i] + by * towards[i]) };
        let found = |by: f64| Self::reach(&bent(by));
        // The nearest change of sign, either way, with the span running forward.
        let mut best: Option<f64> = None;
        let [here, forward] = found(0.0);
        if here.abs() < 1e-12 && forward > 0.0 {
            best = Some(0.0);
        }
        let mut last = [here; 2];
        let mut step = 0;
        while best.is_none() && step < MOST_BEND {
            step += 1;
            for (way, last) in [1.0, -1.0].into_iter().zip(&mut last) {
                let by = way * BEND * f64::from(step);
                let [value, forward] = found(by);
                if forward > 0.0 && (value > 0.0) != (*last > 0.0) {
                    let share = *last / (*last - value);
                    let mut root = by - way * BEND * (1.0 - share);
                    // Two secants more.
                    let (mut x, mut f) = (by, value);
                    for _ in 0..3 {
                        let [g, _] = found(root);
                        if g == f {
                            break;
                        }
                        let next = root - g * (root - x) / (g - f);
                        (x, f) = (root, g);
                        root = next;
                    }
                    if best.is_none_or(|best| root.abs() < best.abs()) {
                        best = Some(root);
                    }
                }
                *last = value;
            }
        }
        let Some(by) = best else { return false };
        let q = bent(by);
        let [_, forward] = Self::reach(&q);
        if !(forward > LEAST_REACH) {
            return false;
        }
        self.own = [1.0 / forward, q[4], 0.0];
        let length = self.length();
        if alone[0] {
            self.shared[1] = q[1] / length;
        }
        if alone[1] {
            self.shared[3] = q[3] / length;
        }
        true
    }
}

/// How finely and how far a span is bent to close it (radians).
const BEND: f64 = 0.25;
const MOST_BEND: u32 = 20;
/// A span must reach this fraction of its length along its chord.
const LEAST_REACH: f64 = 0.05;

/// Numbers that a span occupies in memory: where its unknowns stand, its values and how they follow.
const SPAN_LEN: usize = 4 + 8 + 17;

impl Span {
    fn store(&self, to: &mut [f64]) {
        to[0] = self.chord;
        to[1..5].copy_from_slice(&self.shared);
        to[5..8].copy_from_slice(&self.own);
    }

    fn load(from: &[f64]) -> Self {
        Self {
            chord: from[0],
            shared: core::array::from_fn(|i| from[1 + i]),
            own: core::array::from_fn(|i| from[5 + i]),
        }
    }
}

impl Follow {
    fn store(&self, to: &mut [f64]) {
        to[0] = self.y;
        to[1..5].copy_from_slice(&self.y_by);
        to[5..7].copy_from_slice(&self.own);
        to[7..12].copy_from_slice(&self.own_by[0]);
        to[12..17].copy_from_slice(&self.own_by[1]);
    }

    fn load(from: &[f64]) -> Self {
        Self {
            y: from[0],
            y_by: core::array::from_fn(|i| from[1 + i]),
            own: [from[5], from[6]],
            own_by: [core::array::from_fn(|i| from[7 + i]), core::array::from_fn(|i| from[12 + i])],
        }
    }
}

/// No unknown stands here: the value is fixed.
const FIXED: f64 = -1.0;

/// The most unknowns of a joint: direction and curvature on either side.
const MOST_A_JOINT: usize = 4;

/// The longest row of the matrix that an open chain needs.
const REACH: usize = 3 * MOST_A_JOINT;

/// The memory that [`improve`] needs for so many joints and spans.
pub(super) const fn memory_len(joints: usize, spans: usize, closed: bool) -> usize {
    let unknowns = MOST_A_JOINT * joints;
    let across = if closed { MOST_A_JOINT } else { 0 };
    spans * SPAN_LEN + joints + 4 * unknowns + 2 * unknowns * (REACH + across)
}

fn total_length(spans: &[f64]) -> f64 {
    spans.chunks_exact(SPAN_LEN).map(|memory| Span::load(&memory[4..]).length()).sum()
}

/// What of a side of a joint is an unknown: its place among the joint's unknowns.
fn rank<const D: usize>(model: &Model<'_, D>, joint: usize, side: usize, bends: bool) -> Option<usize>
where
    Shape<D>: Density<D>,
{
    let mut count = 0;
    let mut found = None;
    let mut offer = |owner: Option<usize>, is_curvature: bool, free: bool| {
        if free {
            if is_curvature == bends && owner.is_none_or(|owner| owner == side) {
                found = Some(count);
            }
            count += 1;
        }
    };
    let (shares_tangent, shares_curvature) = model.shares(joint);
    let [arriving, leaving] = [0, 1].map(|side| model.bends_and_turns(joint, side));
    if !shares_curvature {
        offer(Some(0), true, arriving.0);
    }
    if shares_tangent {
        offer(None, false, arriving.1);
    } else {
        offer(Some(0), false, arriving.1);
        offer(Some(1), false, leaving.1);
    }
    if shares_curvature {
        offer(None, true, arriving.0);
    } else {
        offer(Some(1), true, leaving.0);
    }
    found
}

/// How many unknowns a joint has.
fn joint_unknowns<const D: usize>(model: &Model<'_, D>, joint: usize) -> usize
where
    Shape<D>: Density<D>,
{
    let last = |side, bends| rank(model, joint, side, bends).map_or(0, |rank| rank + 1);
    last(0, true).max(last(0, false)).max(last(1, true)).max(last(1, false))
}

/// The direction of `b` against `a`.
fn angle<const D: usize>(a: &nalgebra::SVector<f64, D>, b: &nalgebra::SVector<f64, D>) -> f64 {
    libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
}

/// Improves the start values of a planar curve with one element a span whose joints all stand fixed: directions and curvatures
/// at the joints, and the speeds. Returns whether it did; the state is untouched otherwise.
///
/// `memory` holds [`memory_len`] numbers.
pub(super) fn improve<const D: usize>(model: &Model<'_, D>, state: &mut [f64], memory: &mut [f64]) -> bool
where
    Shape<D>: Density<D>,
{
    let (joints, spans, closed) = (model.node_count(), model.element_count(), model.curve.closed);
    if D != 2
        || model.division != Division::Even(1)
        || model.curve.reference.is_some()
        || model.curve.joints.iter().any(|joint| joint.position.given != Given::FIXED)
        || memory.len() < memory_len(joints, spans, closed)
    {
        return false;
    }
    let (span_memory, rest) = memory.split_at_mut(spans * SPAN_LEN);
    let (offset, rest) = rest.split_at_mut(joints);
    // A ring is cut open at its first joint, whose unknowns come last.
    let mut offsets = Indices::new(offset);
    let mut unknowns = 0;
    for at in 0..joints {
        let joint = if closed { (at + 1) % joints } else { at };
        offsets.set(joint, unknowns);
        unknowns += joint_unknowns(model, joint);
    }
    let (first, rest) = rest.split_at_mut(unknowns);
    let (start, rest) = rest.split_at_mut(unknowns);
    let (gradient, rest) = rest.split_at_mut(unknowns);
    let (step, rest) = rest.split_at_mut(unknowns);

    for (index, memory) in span_memory.chunks_exact_mut(SPAN_LEN).enumerate() {
        let (places, values) = memory.split_at_mut(4);
        let ends = [model.end(index, 0, state), model.end(index, 1, state)];
        let chord = ends[1].point - ends[0].point;
        let phi = [0, 1].map(|end: usize| angle(&chord, &ends[end].frame[0]));
        let half = 0.5 * (phi[1] - phi[0]);
        let stretched = if half.abs() > 1e-3 { half / libm::sin(half) } else { 1.0 };
        let mut span = Span {
            chord: libm::sqrt(chord.dot(&chord)),
            shared: [phi[0], ends[0].curvature[0], phi[1], ends[1].curvature[0]],
            own: [if stretched > 0.0 { stretched.min(4.0) } else { 4.0 }, 0.0, 0.0],
        };
        let alone = [0, 1].map(|end: usize| {
            let joint = model.node(index, end);
            let (bends, _) = model.bends_and_turns(joint, 1 - end);
            let (_, shared) = model.shares(joint);
            bends && (!shared || (!closed && (joint == 0 || joint + 1 == joints)))
        });
        if !span.close(alone) {
            return false;
        }
        span.store(values);
        for (kind, place) in places.iter_mut().enumerate() {
            let (end, bends) = (kind / 2, kind % 2 == 1);
            let joint = model.node(index, end);
            *place =
                rank(model, joint, 1 - end, bends).map_or(FIXED, |rank| (offsets.get(joint) + rank) as f64);
        }
    }

    // The rows of the envelope.
    let (mut row_first, mut row_start) = (Indices::new(first), Indices::new(start));
    for row in 0..unknowns {
        row_first.set(row, row);
    }
    for memory in span_memory.chunks_exact(SPAN_LEN) {
        let places = &memory[..4];
        let low = places.iter().filter(|&&place| place >= 0.0).fold(f64::INFINITY, |low, &p| low.min(p));
        for &place in places.iter().filter(|&&place| place >= 0.0) {
            let row = place as usize;
            row_first.set(row, row_first.get(row).min(low as usize));
        }
    }
    let mut entries = 0;
    for row in 0..unknowns {
        row_start.set(row, entries);
        entries += row - row_first.get(row) + 1;
    }
    if rest.len() < 2 * entries {
        return false;
    }
    let (matrix, rest) = rest.split_at_mut(entries);
    let factor = &mut rest[..entries];
    let envelope = Envelope { first: &row_first, start: &row_start };

    let mut weigh =
        Weigh { bend: model.weights.variation, slope: model.weights.bending, length: model.weights.length };
    let power = f64::from(model.functional.length_power());
    let start_length = total_length(span_memory);
    let mut settled = false;
    for _ in 0..MOST_ITERATIONS {
        let mut solved = false;
        let mut gap = 0.0f64;
        for curvature in [1.0, 0.0] {
            gradient.fill(0.0);
            matrix.fill(0.0);
            let mut sums = [0.0; 2];
            gap = 0.0;
            for memory in span_memory.chunks_exact_mut(SPAN_LEN) {
                let (places, rest) = memory.split_at_mut(4);
                let (values, follow) = rest.split_at_mut(8);
                let Some(condensed) = condense(&Span::load(values), &weigh, curvature) else { return false };
                condensed.follow.store(follow);
                gap = gap.max(condensed.gap);
                sums[0] += condensed.sums[0];
                sums[1] += condensed.sums[1];
                for f in 0..4 {
                    if places[f] < 0.0 {
                        continue;
                    }
                    let row = places[f] as usize;
                    gradient[row] += condensed.gradient[f];
                    for e in 0..4 {
                        if places[e] >= 0.0 && places[e] <= places[f] {
                            envelope.add(matrix, row, places[e] as usize, condensed.hessian[f][e]);
                        }
                    }
                }
            }
            if power > 0.0 {
                // Where a power of the length multiplies the integral, its stationary points are those under this tension.
                weigh.length = model.weights.length + power * sums[0] / sums[1];
            }
            for (s, g) in step.iter_mut().zip(gradient.iter()) {
                *s = -g;
            }
            let norm = envelope.norm(matrix, factor.split_at_mut(unknowns).0);
            if envelope.factor(matrix, norm, 0.0, factor).is_ok() {
                solved = true;
                break;
            }
        }
        if !solved {
            return false;
        }
        envelope.forward(factor, step);
        envelope.backward(factor, step, unknowns);
        let own_step = |places: &[f64]| -> [f64; 4] {
            core::array::from_fn(|f| if places[f] >= 0.0 { step[places[f] as usize] } else { 0.0 })
        };
        let (mut largest, mut turn) = (gap, 0.0f64);
        for memory in span_memory.chunks_exact(SPAN_LEN) {
            let [t0, k0, t1, k1] = own_step(&memory[..4]);
            turn = turn.max(t0.abs()).max(t1.abs());
            largest = largest.max((k0.abs()).max(k1.abs()) * memory[4]);
        }
        largest = largest.max(turn);
        if !largest.is_finite() {
            return false;
        }
        let by = if turn > LONGEST_STEP { LONGEST_STEP / turn } else { 1.0 };
        for memory in span_memory.chunks_exact_mut(SPAN_LEN) {
            let step = own_step(&memory[..4]);
            let (values, follow) = memory[4..].split_at_mut(8);
            let mut span = Span::load(values);
            let before = span.own[0];
            span.advance(&step, &Follow::load(follow), by);
            span.own[0] = span.own[0].clamp(0.5 * before, 2.0 * before);
            span.store(values);
        }
        if largest < SETTLED {
            settled = true;
            break;
        }
        if total_length(span_memory) > GROWN * start_length {
            // There may be no minimum: what follows goes on from here, and finds out.
            settled = true;
            break;
        }
    }
    if !settled {
        return false;
    }
    for (index, memory) in span_memory.chunks_exact(SPAN_LEN).enumerate() {
        let span = Span::load(&memory[4..]);
        let mut ends = [model.end(index, 0, state), model.end(index, 1, state)];
        let chord = (ends[1].point - ends[0].point) / span.chord;
        let length = span.length();
        let turn = {
            let q = [
                span.shared[0],
                length * span.shared[1],
                span.shared[2],
                length * span.shared[3],
                span.own[1],
                span.own[2],
            ];
            libm::sqrt(inner(&q, &product(&TABLES.slope, &q)))
        };
        for (end, this) in ends.iter_mut().enumerate() {
            if memory[2 * end] >= 0.0 {
                let (sin, cos) = (libm::sin(span.shared[2 * end]), libm::cos(span.shared[2 * end]));
                this.frame[0][0] = cos * chord[0] - sin * chord[1];
                this.frame[0][1] = sin * chord[0] + cos * chord[1];
                this.frame[1][0] = -this.frame[0][1];
                this.frame[1][1] = this.frame[0][0];
            }
            this.curvature[0] = span.shared[2 * end + 1];
        }
        super::start::give_speeds(&mut ends, length, turn);
        for (end, value) in ends.iter().enumerate() {
            model.set_end(index, end, value, state);
        }
    }
    true
}
