//! A span by its direction: its share of the functional, condensed to what it shares with its neighbours.

use super::functions::{BEYOND, Tables, rough_sine_cosine, sine_cosine};
use crate::basis::lanes::Lanes;
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;

/// A span: its chord's length, the directions at its ends against the chord and the curvatures there, `φ₀, κ₀, φ₁, κ₁`,
/// and its own values: `λ = L/chord`, then the coefficients of the functions beyond the cubics.
#[derive(Clone, Copy)]
pub(super) struct Span<const N: usize> {
    pub(super) chord: f64,
    pub(super) shared: [f64; 4],
    /// The first `N − 3` count.
    pub(super) own: [f64; N],
}

/// How the own values change with a step: each a constant, slopes by the four shared values, and one by the tension.
pub(super) type Follow<const N: usize> = [[f64; COLUMNS]; N];
pub(super) const COLUMNS: usize = 6;

/// A span's share of the functional: condensed gradient and Hessian by the shared values.
pub(super) struct Condensed<const N: usize> {
    pub(super) gradient: [f64; 4],
    /// The length's gradient: that by the tension of the gradient.
    pub(super) length_gradient: [f64; 4],
    pub(super) hessian: [[f64; 4]; 4],
    pub(super) follow: Follow<N>,
    /// How far the span is from closing, as a fraction of its length.
    pub(super) gap: f64,
    /// `∫ θ''² ds`, `∫ θ'² ds` and the length.
    pub(super) sums: [f64; 3],
    /// By how much the functional would sink, about, with more functions.
    pub(super) left_out: f64,
}

/// The weights of `∫ θ''² ds`, `∫ θ'² ds` and `L`.
#[derive(Clone, Copy)]
pub(super) struct Weigh {
    pub(super) bend: f64,
    pub(super) slope: f64,
    pub(super) length: f64,
}

#[inline(always)]
fn product<const N: usize>(matrix: &[[f64; N]; N], q: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        let mut sum = 0.0;
        for j in 0..N {
            sum += matrix[i][j] * q[j];
        }
        out[i] = sum;
    }
    out
}

#[inline(always)]
fn inner<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for i in 0..N {
        sum += a[i] * b[i];
    }
    sum
}

/// The least part of its length that a span may reach along its chord.
const LEAST_REACH: f64 = 0.05;
/// How finely and how far a span is bent to close it (radians).
const BEND: f64 = 0.25;
const MOST_BEND: u32 = 20;

impl<const N: usize> Span<N> {
    pub(super) fn length(&self) -> f64 {
        self.own[0] * self.chord
    }

    /// The coefficients of the direction.
    #[inline(always)]
    pub(super) fn coefficients(&self) -> [f64; N] {
        let [phi0, k0, phi1, k1] = self.shared;
        let length = self.length();
        let mut q = [0.0; N];
        q[0] = phi0;
        q[1] = length * k0;
        q[2] = phi1;
        q[3] = length * k1;
        q[4..].copy_from_slice(&self.own[1..N - 3]);
        q
    }

    /// Takes the part `by` of a step of the shared values and of the tension.
    pub(super) fn advance(&mut self, step: &[f64; 4], tension: f64, follow: &[f64], by: f64) {
        for f in 0..4 {
            self.shared[f] += by * step[f];
        }
        for (own, row) in self.own[..N - 3].iter_mut().zip(follow.chunks_exact(COLUMNS)) {
            let mut change = row[0] + row[5] * tension;
            for f in 0..4 {
                change += row[1 + f] * step[f];
            }
            *own += by * change;
        }
    }

    /// The numbers that are kept of a span.
    pub(super) const LEN: usize = 5 + N - 3;

    pub(super) fn store(&self, to: &mut [f64]) {
        to.put(0, self.chord);
        to.part_mut(1..5).copy(&self.shared);
        to.part_mut(5..N + 2).copy(&self.own[..N - 3]);
    }

    pub(super) fn load(from: &[f64]) -> Self {
        let mut own = [0.0; N];
        own[..N - 3].copy(from.part(5..N + 2));
        Self { chord: from.at(0), shared: core::array::from_fn(|i| from.at(1 + i)), own }
    }

    /// `∫ θ'² du`, the square of the turning where that is even.
    pub(super) fn turning<const C: usize>(&self, tables: &Tables<N, C>) -> f64 {
        let q = self.coefficients();
        sqrt(inner(&q, &product(&tables.slope, &q)).larger(0.0))
    }

    /// Its weighed integrals.
    pub(super) fn integral<const C: usize>(&self, tables: &Tables<N, C>, weigh: &Weigh) -> f64 {
        let (q, length) = (self.coefficients(), self.length());
        let bends = inner(&q, &product(&tables.bend, &q)) / (length * length * length);
        let slopes = inner(&q, &product(&tables.slope, &q)) / length;
        weigh.bend * bends + weigh.slope * slopes + weigh.length * length
    }

    /// Closes the span for a start: bends it between its ends, as little as possible, until it runs along its chord. Where
    /// the curvature at an end is the span's own, that is bent too, so that the curvature changes evenly. As many ways to
    /// close it as `skip` says are passed over. Returns whether it could.
    pub(super) fn close<const C: usize>(
        &mut self,
        tables: &Tables<N, C>,
        alone: [bool; 2],
        skip: usize,
    ) -> bool {
        let [phi0, k0, phi1, k1] = self.shared;
        let turn = phi1 - phi0;
        let stretched = self.length();
        let [a, b] = [(alone[0], k0), (alone[1], k1)].map(|(own, k)| if own { turn } else { k * stretched });
        let bent = |by: f64| {
            let mut q = [0.0; N];
            (q[0], q[1], q[2], q[3]) = (phi0, a, phi1, b);
            match alone {
                // The first function beyond the cubics is at most 1/32.
                [false, false] => q[4] = 32.0 * by,
                [first, last] => {
                    q[1] += if first { 4.0 * by } else { 0.0 };
                    q[3] -= if last { 4.0 * by } else { 0.0 };
                }
            }
            q
        };
        let reach = |by: f64| {
            let q = bent(by);
            let mut sums = [Lanes::ZERO; 2];
            for (at, weight) in tables.at.iter().zip(tables.weight) {
                let [s, c] = rough_sine_cosine(combine(at, &q));
                sums[0] += s * weight;
                sums[1] += c * weight;
            }
            sums.map(|sum| sum.total())
        };
        // The nearest change of sign, either way, with the span running forward.
        let [here, forward] = reach(0.0);
        let mut skip = skip;
        let mut best = None;
        if here.abs() < 1e-12 && forward > LEAST_REACH {
            if skip == 0 {
                best = Some(0.0);
            } else {
                skip -= 1;
            }
        }
        let mut last = [here; 2];
        let mut step = 0;
        while best.is_none() && step < MOST_BEND {
            step += 1;
            for (way, last) in [1.0, -1.0].into_iter().zip(&mut last) {
                let by = way * BEND * f64::from(step);
                let [value, _] = reach(by);
                if (value > 0.0) != (*last > 0.0) {
                    let (mut x, mut f) = (by, value);
                    let mut root = by - way * BEND * (value / (value - *last));
                    for _ in 0..3 {
                        let [g, _] = reach(root);
                        if g == f {
                            break;
                        }
                        let next = root - g * (root - x) / (g - f);
                        (x, f, root) = (root, g, next);
                    }
                    let [_, forward] = reach(root);
                    let nearer = best.is_none_or(|best: f64| root.abs() < best.abs());
                    // From 0 on the sign changes at once: that is the way that was passed over.
                    let again = step == 1 && here.abs() < 1e-12;
                    if forward > LEAST_REACH && nearer && !again {
                        if skip == 0 {
                            best = Some(root);
                        } else {
                            skip -= 1;
                        }
                    }
                }
                *last = value;
            }
        }
        let Some(by) = best else { return false };
        let q = bent(by);
        let [_, forward] = reach(by);
        self.own = [0.0; N];
        self.own[0] = 1.0 / forward;
        self.own[1] = q[4];
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

/// The direction at a pair of points.
#[inline(always)]
pub(super) fn combine<const N: usize>(at: &[Lanes; N], q: &[f64; N]) -> Lanes {
    let mut theta = at[0] * q[0];
    for i in 1..N {
        theta += at[i] * q[i];
    }
    theta
}

/// Condenses a span; `None` where it has no regular solution nearby. `curvature` is the part of the closing conditions'
/// second derivatives that is taken into account, 1 for Newton's method.
#[inline(always)]
pub(super) fn condense<const N: usize, const C: usize>(
    tables: &Tables<N, C>,
    span: &Span<N>,
    weigh: &Weigh,
    curvature: f64,
    exact: bool,
) -> Option<Condensed<N>> {
    // The free values: the four shared ones, then the coefficients from the sixth function on. λ and the fifth function's
    // coefficient x follow from the closing conditions.
    let free = N - 1;
    let c = span.chord;
    let l = span.own[0];
    let (a, b) = (span.shared[1] * c, span.shared[3] * c);
    let q = span.coefficients();

    // The moments of sine and cosine.
    let mut sines = [Lanes::ZERO; C];
    let mut cosines = [Lanes::ZERO; C];
    let (mut sine_sum, mut cosine_sum) = (Lanes::ZERO, Lanes::ZERO);
    let (mut sine_moments, mut cosine_moments) = ([Lanes::ZERO; N], [Lanes::ZERO; N]);
    for k in 0..C {
        let at = &tables.at[k];
        let theta = combine(at, &q);
        let [s, co] = if exact { sine_cosine(theta) } else { rough_sine_cosine(theta) };
        let (s, co) = (s * tables.weight[k], co * tables.weight[k]);
        sines[k] = s;
        cosines[k] = co;
        sine_sum += s;
        cosine_sum += co;
        for i in 0..N {
            sine_moments[i] += s * at[i];
            cosine_moments[i] += co * at[i];
        }
    }
    let (mut s, mut co) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        s[i] = sine_moments[i].total();
        co[i] = cosine_moments[i].total();
    }
    let inverse = 1.0 / l;
    let gaps = [sine_sum.total(), cosine_sum.total() - inverse];

    // The functional by q and λ.
    let cube = inverse * inverse * inverse;
    let bend = weigh.bend * cube / (c * c * c);
    let slope = weigh.slope * inverse / c;
    let (by_bend, by_slope) = (product(&tables.bend, &q), product(&tables.slope, &q));
    let (bends, slopes) = (inner(&q, &by_bend), inner(&q, &by_slope));
    let mut g = [0.0; N];
    let mut g_l = [0.0; N];
    for i in 0..N {
        g[i] = 2.0 * (bend * by_bend[i] + slope * by_slope[i]);
        g_l[i] = -2.0 * inverse * (3.0 * bend * by_bend[i] + slope * by_slope[i]);
    }
    let of_l = -inverse * (3.0 * bend * bends + slope * slopes) + weigh.length * c;
    let of_ll = inverse * inverse * (12.0 * bend * bends + 2.0 * slope * slopes);

    // The closing conditions by λ and x, and the multipliers that leave no gradient by them.
    let d = [[a * co[1] + b * co[3], co[4]], [inverse * inverse - (a * s[1] + b * s[3]), -s[4]]];
    let determinant = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    if !(determinant.abs() > 1e-4 * (d[0][1].abs() + d[1][1].abs())) {
        return None;
    }
    let solve = |r: [f64; 2]| {
        [(d[1][1] * r[0] - d[0][1] * r[1]) / determinant, (d[0][0] * r[1] - d[1][0] * r[0]) / determinant]
    };
    let (j_l, j_x) = (of_l + a * g[1] + b * g[3], g[4]);
    let mu = [-(d[1][1] * j_l - d[1][0] * j_x) / determinant, -(d[0][0] * j_x - d[0][1] * j_l) / determinant];

    // The gradient by the next functions, and what a step along each of them by itself would gain.
    let mut left_out = 0.0;
    for b in 0..BEYOND {
        let (mut sine, mut cosine) = (Lanes::ZERO, Lanes::ZERO);
        for k in 0..C {
            sine += sines[k] * tables.beyond[k][b];
            cosine += cosines[k] * tables.beyond[k][b];
        }
        let own = 2.0 * slope * inner(&q, &tables.beyond_slope[b]);
        let gradient = own + mu[0] * cosine.total() - mu[1] * sine.total();
        let second = 2.0 * (bend * tables.beyond_bend[b] + slope * tables.beyond_own[b]);
        left_out += gradient * gradient / (2.0 * second);
    }

    // Second derivatives of the Lagrangian by q.
    let mut second = [[Lanes::ZERO; N]; N];
    for k in 0..C {
        let at = &tables.at[k];
        let w = sines[k] * (-mu[0] * curvature) + cosines[k] * (-mu[1] * curvature);
        for i in 0..N {
            let row = w * at[i];
            for j in 0..=i {
                second[i][j] += row * at[j];
            }
        }
    }
    let mut h = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            h[i][j] = second[i][j].total() + 2.0 * (bend * tables.bend[i][j] + slope * tables.slope[i][j]);
            h[j][i] = h[i][j];
        }
    }
    let mut by_q = [0.0; N];
    let mut along_l = [0.0; N];
    for i in 0..N {
        by_q[i] = g[i] + mu[0] * co[i] - mu[1] * s[i];
        along_l[i] = g_l[i] + a * h[i][1] + b * h[i][3];
    }
    let ll = of_ll - 2.0 * mu[1] * curvature * cube + a * (g_l[1] + along_l[1]) + b * (g_l[3] + along_l[3]);
    let (lx, xx) = (along_l[4], h[4][4]);

    // By the free values.
    let off = solve(gaps).map(|v| -v);
    let place = |f: usize| if f < 4 { f } else { f + 1 };
    let scale = |f: usize| if f == 1 || f == 3 { l } else { 1.0 };
    let (mut gradient, mut to_l, mut to_x) = ([0.0; N], [0.0; N], [0.0; N]);
    let mut reduced = [[0.0; N]; N];
    let (mut with_l, mut with_x) = ([0.0; N], [0.0; N]);
    for f in 0..free {
        let (i, by) = (place(f), scale(f));
        let [by_l, by_x] = solve([by * co[i], -by * s[i]]);
        (to_l[f], to_x[f]) = (-by_l, -by_x);
        with_l[f] = by * along_l[i] + if i == 1 || i == 3 { by_q[i] } else { 0.0 };
        with_x[f] = by * h[i][4];
        let own_l = with_l[f] + to_l[f] * ll + to_x[f] * lx;
        let own_x = with_x[f] + to_l[f] * lx + to_x[f] * xx;
        gradient[f] = by * by_q[i] + own_l * off[0] + own_x * off[1];
        for e in 0..=f {
            reduced[f][e] = by * scale(e) * h[i].at(place(e))
                + own_l * to_l[e]
                + own_x * to_x[e]
                + to_l[f] * with_l[e]
                + to_x[f] * with_x[e];
        }
    }

    // Out with the inner ones: a Cholesky factor of their part, in place, and through it the rows that couple them. Rows of
    // `right` are gradient, couplings and the length's gradient, which is that of λ.
    let mut right = [[0.0; COLUMNS]; N];
    for f in 4..free {
        let row = &reduced[f];
        right[f] = [gradient[f], row[0], row[1], row[2], row[3], c * to_l[f]];
        for e in 4..f {
            let mut sum = reduced[f][e];
            for k in 4..e {
                sum -= reduced[f][k] * reduced[e][k];
            }
            reduced[f][e] = sum / reduced[e][e];
        }
        let mut pivot = reduced[f][f];
        for k in 4..f {
            pivot -= reduced[f][k] * reduced[f][k];
        }
        if !(pivot > 0.0) {
            return None;
        }
        let root = sqrt(pivot);
        reduced[f][f] = root;
        for k in 4..f {
            for r in 0..COLUMNS {
                right[f][r] -= reduced[f][k] * right[k][r];
            }
        }
        for r in 0..COLUMNS {
            right[f][r] /= root;
        }
    }
    // The shared curvatures are κ, not κ times the chord.
    let units = [1.0, c, 1.0, c];
    let mut out = Condensed {
        gradient: [0.0; 4],
        length_gradient: [0.0; 4],
        hessian: [[0.0; 4]; 4],
        follow: [[0.0; COLUMNS]; N],
        gap: gaps[0].abs() + gaps[1].abs(),
        sums: [bends * cube / (c * c * c), slopes * inverse / c, l * c],
        left_out,
    };
    for f in 0..4 {
        let (mut slope, mut length) = (gradient[f], c * to_l[f]);
        for k in 4..free {
            slope -= right[k][1 + f] * right[k][0];
            length -= right[k][1 + f] * right[k][5];
        }
        out.gradient[f] = slope * units[f];
        out.length_gradient[f] = length * units[f];
        for e in 0..=f {
            let mut sum = reduced[f][e];
            for k in 4..free {
                sum -= right[k][1 + f] * right[k][1 + e];
            }
            out.hessian[f][e] = sum * units[f] * units[e];
            out.hessian[e][f] = out.hessian[f][e];
        }
    }
    // How the inner ones follow, back through the factor, then λ and x.
    for f in (4..free).rev() {
        for k in f + 1..free {
            for r in 0..COLUMNS {
                right[f][r] -= reduced[k][f] * right[k][r];
            }
        }
        for r in 0..COLUMNS {
            right[f][r] /= reduced[f][f];
        }
    }
    let mut row_l = [off[0], to_l[0], to_l[1], to_l[2], to_l[3], 0.0];
    let mut row_x = [off[1], to_x[0], to_x[1], to_x[2], to_x[3], 0.0];
    for f in 4..free {
        for r in 0..COLUMNS {
            let own = -right[f][r];
            out.follow[f - 2][r] = own;
            row_l[r] += to_l[f] * own;
            row_x[r] += to_x[f] * own;
        }
    }
    out.follow[0] = row_l;
    out.follow[1] = row_x;
    for row in &mut out.follow {
        for f in 0..4 {
            row[1 + f] *= units[f];
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::super::functions::{COARSE, FINE};
    use super::*;
    use crate::basis::quadrature::legendre;

    const WEIGH: Weigh = Weigh { bend: 0.7, slope: 0.4, length: 0.3 };
    /// Turned either way, curved at the ends as it likes or not.
    const SHARED: [[f64; 4]; 3] = [[0.4, 0.3, -0.5, -0.2], [-0.7, 0.1, 0.9, 0.6], [0.3, -0.4, 0.6, 0.8]];
    const CHORD: f64 = 1.7;

    /// Follows Newton's method in the span's own values.
    fn settled<const N: usize, const C: usize>(
        tables: &Tables<N, C>,
        mut span: Span<N>,
        weigh: &Weigh,
    ) -> (Span<N>, Condensed<N>) {
        for _ in 0..40 {
            let found = condense(tables, &span, weigh, 1.0, true).expect("a regular span");
            let change = found.follow[..N - 3].iter().fold(0.0f64, |most, row| most.larger(row[0].abs()));
            if found.gap < 1e-14 && change < 1e-13 {
                return (span, found);
            }
            span.advance(&[0.0; 4], 0.0, found.follow.as_flattened(), 1.0);
        }
        panic!("Newton's method does not settle");
    }

    fn started<const N: usize, const C: usize>(tables: &Tables<N, C>, shared: [f64; 4]) -> Span<N> {
        let mut span = Span { chord: CHORD, shared, own: [0.0; N] };
        span.own[0] = 1.0;
        assert!(span.close(tables, [false; 2], 0), "{shared:?}");
        span
    }

    /// The slope of `f` at 0, by differences of two steps.
    fn slope<const K: usize>(f: impl Fn(f64) -> [f64; K]) -> [f64; K] {
        let difference = |h: f64| {
            let (up, down) = (f(h), f(-h));
            core::array::from_fn::<f64, K, _>(|i| (up[i] - down[i]) / (2.0 * h))
        };
        let (wide, narrow) = (difference(2e-3), difference(1e-3));
        core::array::from_fn(|i| (4.0 * narrow[i] - wide[i]) / 3.0)
    }

    fn near(found: f64, wanted: f64, what: &str) {
        assert!((found - wanted).abs() < 1e-7 * (1.0 + wanted.abs()), "{what}: {found}, not {wanted}");
    }

    /// A condensed span is the least of its functional by what it shares: its derivatives are differences of that.
    fn derivatives_agree<const N: usize, const C: usize>(tables: &Tables<N, C>) {
        for shared in SHARED {
            let (span, found) = settled(tables, started(tables, shared), &WEIGH);
            let moved = |f: usize, by: f64| {
                let mut span = span;
                span.shared[f] += by;
                settled(tables, span, &WEIGH)
            };
            for f in 0..4 {
                let [value, length] = slope(|by| {
                    let (span, _) = moved(f, by);
                    [span.integral(tables, &WEIGH), span.length()]
                });
                near(found.gradient[f], value, "gradient");
                near(found.length_gradient[f], length, "length's gradient");
                let gradient = slope(|by| moved(f, by).1.gradient);
                let own = slope(|by| moved(f, by).0.own);
                for e in 0..4 {
                    near(found.hessian[e][f], gradient[e], "Hessian");
                }
                for (row, own) in found.follow.iter().zip(own).take(N - 3) {
                    near(row[1 + f], own, "what follows");
                }
            }
            let tightened = |by: f64| {
                let weigh = Weigh { length: WEIGH.length + by, ..WEIGH };
                settled(tables, span, &weigh)
            };
            let own = slope(|by| tightened(by).0.own);
            for (row, own) in found.follow.iter().zip(own).take(N - 3) {
                near(row[5], own, "what follows of the tension");
            }
            let gradient = slope(|by| tightened(by).1.gradient);
            for f in 0..4 {
                near(found.length_gradient[f], gradient[f], "the gradient by the tension");
            }
        }
    }

    #[test]
    fn a_condensed_span_has_the_derivatives_of_its_least_functional() {
        derivatives_agree(&COARSE);
        derivatives_agree(&FINE);
    }

    #[test]
    fn the_sums_are_those_of_the_curve_that_the_direction_draws() {
        let rule = legendre(32).expect("a rule");
        for shared in SHARED {
            let (span, found) = settled(&FINE, started(&FINE, shared), &WEIGH);
            let (q, length) = (span.coefficients(), span.length());
            let direction = |u: f64| {
                let by = super::super::functions::functions::<24>(u);
                by.map(|row| row.iter().zip(&q).map(|(f, q)| f * q).sum::<f64>())
            };
            let (mut end, mut bends, mut slopes) = ([0.0; 2], 0.0, 0.0);
            for (u, w) in rule.iter() {
                let [theta, by_u, by_uu] = direction(u);
                end[0] += w * length * libm::cos(theta);
                end[1] += w * length * libm::sin(theta);
                slopes += w * by_u * by_u / length;
                bends += w * by_uu * by_uu / (length * length * length);
            }
            near(end[0], CHORD, "along the chord");
            near(end[1], 0.0, "across it");
            let [found_bends, found_slopes, found_length] = found.sums;
            near(found_bends, bends, "variation");
            near(found_slopes, slopes, "bending");
            near(found_length, length, "length");
            let value = WEIGH.bend * bends + WEIGH.slope * slopes + WEIGH.length * length;
            near(span.integral(&FINE, &WEIGH), value, "functional");
            near(span.turning(&FINE), sqrt(slopes * length), "turning");
            // The shared values are the direction and the curvature at the ends.
            let [phi0, k0, phi1, k1] = shared;
            for (u, phi, k) in [(0.0, phi0, k0), (1.0, phi1, k1)] {
                near(direction(u)[0], phi, "direction");
                near(direction(u)[1] / length, k, "curvature");
            }
        }
    }

    #[test]
    fn what_is_left_out_is_what_more_functions_gain() {
        for shared in SHARED {
            let (coarse, found) = settled(&COARSE, started(&COARSE, shared), &WEIGH);
            let (fine, rest) = settled(&FINE, started(&FINE, shared), &WEIGH);
            let gain = coarse.integral(&COARSE, &WEIGH) - fine.integral(&FINE, &WEIGH);
            assert!(
                gain > 0.0 && found.left_out > 0.25 * gain && found.left_out < 2.0 * gain,
                "{gain} {}",
                found.left_out
            );
            assert!(rest.left_out < 1e-9 * found.left_out, "{}", rest.left_out);
        }
    }

    #[test]
    fn a_span_is_closed_the_nearest_way_and_then_the_next() {
        for shared in SHARED {
            for alone in [[false; 2], [true, false], [false, true], [true; 2]] {
                let closed = |skip: usize| {
                    let mut span = Span { chord: CHORD, shared, own: [0.0; 24] };
                    span.own[0] = 1.1;
                    span.close(&FINE, alone, skip).then_some(span)
                };
                let mut seen = std::vec::Vec::new();
                for skip in 0..3 {
                    let Some(span) = closed(skip) else { continue };
                    let gap = condense(&FINE, &span, &WEIGH, 1.0, true).map(|found| found.gap);
                    assert!(gap.is_none_or(|gap| gap < 0.1), "{shared:?} {alone:?} {skip}: {gap:?}");
                    assert!(span.length() > CHORD * (1.0 - 1e-9) && span.own[0] < 1.0 / LEAST_REACH);
                    assert_eq!([span.shared[0], span.shared[2]], [shared[0], shared[2]]);
                    for end in 0..2 {
                        assert!(alone[end] || span.shared[1 + 2 * end] == shared[1 + 2 * end]);
                    }
                    let way = [span.own[1], span.shared[1], span.shared[3], span.length()];
                    assert!(!seen.contains(&way), "{skip} is another way");
                    seen.push(way);
                }
                assert!(!seen.is_empty(), "{shared:?} {alone:?}");
                assert!(seen.windows(2).all(|two| two[0][3] <= two[1][3] * 1.5), "{seen:?}");
            }
        }
    }
}
