//! The quintic Hermite basis tabulated at the points of every Gauss–Lobatto rule, in mirrored pairs.
//!
//! A rule is symmetric, and so is the basis: `H_1(1 − t) = −H_4(t)`, `H_2(1 − t) = H_3(t)`. In the coordinates
//!
//! ```text
//! even   chord = C(1) − C(0),   C'(0) + C'(1),   C''(0) − C''(1)
//! odd    C'(0) − C'(1),   C''(0) + C''(1)
//! ```
//!
//! the first and the third derivative at `t` are `E + O` and at `1 − t` are `E − O`, with `E` of the even and `O` of the
//! odd coordinates; the second derivative at `1 − t` is `−(E − O)`, which is the second derivative of the same curve run
//! backwards. Whatever does not depend on the direction in which a curve runs is thus had at two points for little
//! more than the work of one, and its sums over the rule need half the products.

use super::hermite;
use super::lanes::{Lanes, WIDTH};
use super::quadrature::{MAX_POINTS, lobatto};

/// The even coordinates come first.
pub(crate) const EVEN: usize = 3;
/// All coordinates.
pub(crate) const COORDINATES: usize = 5;

/// Points `t` and their weights, with the basis there; each stands for `1 − t` too.
#[derive(Clone, Copy)]
pub(crate) struct Pairs {
    pub(crate) weight: Lanes,
    /// `by[k][a]`: derivative `k + 1` of coordinate `a`'s function, the even coordinates first.
    pub(crate) by: [[Lanes; COORDINATES]; 3],
}

const NO_PAIRS: Pairs = Pairs { weight: Lanes::ZERO, by: [[Lanes::ONE; COORDINATES]; 3] };

/// The fewest points of a tabulated rule.
pub(crate) const LEAST_POINTS: usize = 8;

const fn chunks(points: usize) -> usize {
    points.div_ceil(2).div_ceil(WIDTH)
}

const fn chunks_before(points: usize) -> usize {
    let (mut count, mut sum) = (LEAST_POINTS, 0);
    while count < points {
        sum += chunks(count);
        count += 1;
    }
    sum
}

const TOTAL: usize = chunks_before(MAX_POINTS + 1);

const fn table() -> [Pairs; TOTAL] {
    let mut out = [NO_PAIRS; TOTAL];
    let mut points = LEAST_POINTS;
    while points <= MAX_POINTS {
        if let Some(rule) = lobatto(points) {
            let mut pair = 0;
            while pair < chunks(points) * WIDTH {
                let chunk = &mut out[chunks_before(points) + pair / WIDTH];
                let lane = pair % WIDTH;
                // What pads the last chunk weighs nothing, and stands at an ordinary place.
                let real = 2 * pair < points;
                let t = if real { rule.nodes[pair] } else { 0.25 };
                let basis = hermite::basis(t);
                let mut k = 0;
                while k < 3 {
                    let [_, v0, a0, a1, v1, p1] = basis[k + 1];
                    let by = &mut chunk.by[k];
                    by[0].0[lane] = p1;
                    by[1].0[lane] = 0.5 * (v0 + v1);
                    by[2].0[lane] = 0.5 * (a0 - a1);
                    by[3].0[lane] = 0.5 * (v0 - v1);
                    by[4].0[lane] = 0.5 * (a0 + a1);
                    k += 1;
                }
                if real {
                    // The point in the middle is its own mirror image.
                    let alone = 2 * pair + 1 == points;
                    chunk.weight.0[lane] = if alone { 0.5 * rule.weights[pair] } else { rule.weights[pair] };
                }
                pair += 1;
            }
        }
        points += 1;
    }
    out
}

static TABLE: [Pairs; TOTAL] = table();

/// The pairs of the Gauss–Lobatto rule of `points` points, from the ends inwards; those of the nearest tabulated rule
/// where there is none of so many.
pub(crate) fn pairs(points: usize) -> &'static [Pairs] {
    let points = points.clamp(LEAST_POINTS, MAX_POINTS);
    let first = chunks_before(points);
    TABLE.get(first..first + chunks(points)).unwrap_or(&[])
}

/// How many real pairs there are in the pairs of `points` points; what follows pads.
pub(crate) const fn pair_count(points: usize) -> usize {
    points.div_ceil(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six rows of no symmetry, in the coordinates of the pairs.
    const ROWS: [f64; 6] = [0.25, -1.0, 1.5, 2.0, -0.75, 3.5];

    fn coordinates() -> [f64; COORDINATES] {
        let [p0, v0, a0, a1, v1, p1] = ROWS;
        [p1 - p0, v0 + v1, a0 - a1, v0 - v1, a0 + a1]
    }

    #[test]
    fn pairs_are_the_points_of_the_rule_and_weigh_as_much() {
        for points in LEAST_POINTS..=MAX_POINTS {
            let rule = lobatto(points).expect("a rule");
            let found = pairs(points);
            assert_eq!(pair_count(points), points.div_ceil(2));
            let lanes = found.iter().flat_map(|chunk| (0..WIDTH).map(move |lane| (chunk, lane)));
            let mut weight = 0.0;
            for (pair, (chunk, lane)) in lanes.clone().enumerate() {
                if pair >= pair_count(points) {
                    assert_eq!(chunk.weight.0[lane], 0.0, "what pads weighs nothing");
                    // It is at an ordinary place: nothing divides by zero there.
                    assert!(chunk.by.iter().flatten().all(|x| x.0[lane].is_finite()));
                    assert!(chunk.by[0][0].0[lane] > 0.5, "{points}");
                    continue;
                }
                weight += 2.0 * chunk.weight.0[lane];
                let alone = 2 * pair + 1 == points;
                let whole = if alone { 2.0 * chunk.weight.0[lane] } else { chunk.weight.0[lane] };
                assert_eq!(whole, rule.weights[pair], "{points} {pair}");
                let (here, there) =
                    (hermite::basis(rule.nodes[pair]), hermite::basis(1.0 - rule.nodes[pair]));
                for k in 0..3 {
                    let sum = |of: [f64; 6]| of.iter().zip(ROWS).map(|(h, row)| h * row).sum::<f64>();
                    let part = |from: usize, to: usize| {
                        (from..to).map(|a| chunk.by[k][a].0[lane] * coordinates()[a]).sum::<f64>()
                    };
                    let (even, odd) = (part(0, EVEN), part(EVEN, COORDINATES));
                    let mirrored = if k == 1 { odd - even } else { even - odd };
                    assert!((even + odd - sum(here[k + 1])).abs() < 1e-11, "{points} {pair} {k}");
                    assert!((mirrored - sum(there[k + 1])).abs() < 1e-11, "{points} {pair} {k}");
                }
            }
            assert!((weight - 1.0).abs() < 1e-14, "{points}: {weight}");
            assert!(lanes.count() < pair_count(points) + WIDTH);
        }
    }

    #[test]
    fn a_rule_that_is_not_tabulated_gives_the_nearest() {
        for (asked, nearest) in
            [(0, LEAST_POINTS), (LEAST_POINTS - 1, LEAST_POINTS), (MAX_POINTS + 9, MAX_POINTS)]
        {
            assert!(core::ptr::eq(pairs(asked), pairs(nearest)), "{asked}");
        }
    }
}
