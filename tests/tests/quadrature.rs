//! Every quadrature constant, proved to be the f64 nearest to the truth.
//!
//! Nodes are located by exact sign changes of integer polynomials (shifted Legendre polynomials have integer
//! coefficients); weights come from the Christoffel sums in 120-digit fixed-point arithmetic, a formula that the
//! generator does not use.

use minvar::basis::quadrature::{self, Rule};
use num_bigint::{BigInt, Sign};
use num_traits::{One, Signed, Zero};

/// Fixed point: an integer `v` stands for `v · 2^-BITS`.
const BITS: u32 = 400;

/// What every comparison tolerates in fixed point: 2^-340 is below 1e-102, far beyond the 40 digits that 0 ulp needs.
const SLACK_BITS: u32 = BITS - 340;

fn one() -> BigInt {
    BigInt::one() << BITS
}

fn slack() -> BigInt {
    BigInt::one() << SLACK_BITS
}

fn times(a: &BigInt, b: &BigInt) -> BigInt {
    (a * b) >> BITS
}

/// Zero or an f64 in [1e-60, 2), exactly; there the midpoints between neighbours fit too.
fn fixed(x: f64) -> BigInt {
    if x == 0.0 {
        return BigInt::zero();
    }
    assert!((1e-60..2.0).contains(&x));
    let exponent = (x.to_bits() >> 52) as u32;
    let mantissa = x.to_bits() & ((1 << 52) - 1) | 1 << 52;
    BigInt::from(mantissa) << (BITS + exponent - 1075)
}

/// Half way to the f64 below and half way to the f64 above: what lies strictly between them rounds to `x`.
fn rounding_interval(x: f64) -> (BigInt, BigInt) {
    ((fixed(x) + fixed(x.next_down())) >> 1, (fixed(x) + fixed(x.next_up())) >> 1)
}

fn rounds_to(value: &BigInt, x: f64) -> bool {
    let (below, above) = rounding_interval(x);
    below + slack() < *value && *value < above - slack()
}

/// Integer coefficients, lowest first, of the Legendre polynomial of the given degree shifted to [0, 1].
fn shifted_legendre(degree: usize) -> Vec<BigInt> {
    let binomial = |n: usize, k: usize| (0..k).fold(BigInt::one(), |b, i| b * (n - i) / (i + 1));
    (0..=degree)
        .map(|k| {
            let c = binomial(degree, k) * binomial(degree + k, k);
            if (degree + k).is_multiple_of(2) { c } else { -c }
        })
        .collect()
}

fn derivative(p: &[BigInt]) -> Vec<BigInt> {
    p.iter().enumerate().skip(1).map(|(k, c)| c * k).collect()
}

/// The exact sign of an integer polynomial at a fixed-point number.
fn sign_at(p: &[BigInt], x: &BigInt) -> Sign {
    let degree = p.len() - 1;
    let mut sum = BigInt::zero();
    for (k, c) in p.iter().enumerate().rev() {
        sum = sum * x + (c << (BITS as usize * (degree - k)));
    }
    sum.sign()
}

/// A fixed-point value of an integer polynomial, within a few thousand units of the last place.
fn value_at(p: &[BigInt], x: &BigInt) -> BigInt {
    p.iter().rev().fold(BigInt::zero(), |sum, c| times(&sum, x) + (c << BITS))
}

/// The root of `p` near `start`, by Newton's method, then fenced by exact signs on both sides.
fn root_near(p: &[BigInt], start: f64) -> BigInt {
    let slope = derivative(p);
    let mut x = fixed(start);
    for _ in 0..6 {
        let step = (value_at(p, &x) << BITS) / value_at(&slope, &x);
        x -= step;
    }
    let fence: BigInt = slack() >> 8;
    let (left, right) = (sign_at(p, &(&x - &fence)), sign_at(p, &(&x + &fence)));
    assert!(left != right && left != Sign::NoSign && right != Sign::NoSign, "no root within 2^-348");
    x
}

/// The nodes and weights of a rule in fixed point, nodes near those given (they are proved by their signs).
fn truth(rule: &Rule, lobatto: bool) -> Vec<(BigInt, BigInt)> {
    let n = rule.nodes.len();
    let legendre: Vec<_> = (0..=n).map(shifted_legendre).collect();
    let polynomial = if lobatto { derivative(&legendre[n - 1]) } else { legendre[n].clone() };
    let mut pairs = Vec::new();
    for (i, &node) in rule.nodes.iter().enumerate() {
        let x = match i {
            0 if lobatto => BigInt::zero(),
            _ if lobatto && i == n - 1 => one(),
            _ => root_near(&polynomial, node),
        };
        // 1/w = Σ (2k+1) P_k(x)² over the degrees that the rule integrates as squares; in Gauss–Lobatto rules the
        // last polynomial's discrete norm is 1/(n−1) and not 1/(2n−1).
        let mut sum = BigInt::zero();
        for (k, p) in legendre.iter().enumerate().take(n) {
            let value = value_at(p, &x);
            let factor = if lobatto && k == n - 1 { n - 1 } else { 2 * k + 1 };
            sum += times(&value, &value) * factor;
        }
        pairs.push((x, (one() << BITS) / sum));
    }
    pairs
}

/// |Σ w x^degree − 1/(degree+1)| in fixed point.
fn moment_error(pairs: &[(BigInt, BigInt)], degree: usize) -> BigInt {
    let mut sum = BigInt::zero();
    for (x, w) in pairs {
        sum += (0..degree).fold(w.clone(), |term, _| times(&term, x));
    }
    (sum - one() / (degree + 1)).abs()
}

fn check(points: usize, rule: Rule, lobatto: bool) {
    let family = if lobatto { "Lobatto" } else { "Legendre" };
    assert_eq!((rule.nodes.len(), rule.weights.len(), rule.len()), (points, points, points));
    assert!(rule.nodes.is_sorted_by(|a, b| a < b), "{family} {points}: nodes ascend");
    assert!(rule.iter().eq(rule.nodes.iter().copied().zip(rule.weights.iter().copied())));

    let true_pairs = truth(&rule, lobatto);
    for (i, ((node, weight), (x, w))) in rule.iter().zip(&true_pairs).enumerate() {
        let exact_end = (node == 0.0 && x.is_zero()) || (node == 1.0 && *x == one());
        assert!(exact_end || rounds_to(x, node), "{family} {points}: node {i} = {node:e} is not nearest");
        assert!(rounds_to(w, weight), "{family} {points}: weight {i} = {weight:e} is not nearest");
        assert_eq!(weight, rule.weights[points - 1 - i], "{family} {points}: weights are symmetric");
    }

    let degree = if lobatto { 2 * points - 3 } else { 2 * points - 1 };
    let rounded: Vec<_> = rule.iter().map(|(x, w)| (fixed(x), fixed(w))).collect();
    // Each weight is off by at most 2^-54 and each power by degree · 2^-54 relative to its own size.
    let rounding = (one() * (degree + points)) >> 53;
    for k in 0..=degree {
        assert!(moment_error(&true_pairs, k) < slack(), "{family} {points}: degree {k} is exact");
        assert!(moment_error(&rounded, k) < rounding, "{family} {points}: degree {k} is exact to rounding");
    }
    assert!(moment_error(&true_pairs, degree + 1) > slack() << 20, "{family} {points}: not exact beyond");
}

#[test]
fn every_lobatto_constant_is_the_nearest_f64() {
    for points in 2..=quadrature::MAX_POINTS {
        check(points, quadrature::lobatto(points).expect("a rule of 2..=32 points"), true);
    }
}

#[test]
fn every_legendre_constant_is_the_nearest_f64() {
    for points in 1..=quadrature::MAX_POINTS {
        check(points, quadrature::legendre(points).expect("a rule of 1..=32 points"), false);
    }
}

#[test]
fn a_count_outside_the_tables_is_none() {
    assert!([0, 1, 33, usize::MAX].iter().all(|&points| quadrature::lobatto(points).is_none()));
    assert!([0, 33, usize::MAX].iter().all(|&points| quadrature::legendre(points).is_none()));
}

#[test]
fn the_nearest_f64_test_rejects_a_neighbour() {
    let third = one() / 3;
    let nearest = 1.0 / 3.0;
    assert!(rounds_to(&third, nearest));
    assert!(!rounds_to(&third, f64::next_up(nearest)) && !rounds_to(&third, f64::next_down(nearest)));
}

#[test]
fn rules_can_be_taken_in_constants() {
    const SIMPSON: Option<Rule> = quadrature::lobatto(3);
    let rule = SIMPSON.expect("three points");
    assert_eq!(rule.nodes, [0.0, 0.5, 1.0]);
    assert_eq!(rule.weights, [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]);
}
