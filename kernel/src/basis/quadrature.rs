//! Gauss–Lobatto and Gauss–Legendre quadrature on [0, 1].
//!
//! Every node and weight is the `f64` nearest to the true value. The tables are written by
//! `kernel/generate/quadrature.py` (mpmath, 60 digits); `tests/tests/quadrature.rs` proves each constant again in exact
//! arithmetic.

mod tables;

/// The most points a rule has.
pub const MAX_POINTS: usize = 32;

/// A quadrature rule on [0, 1]: `∫ f ≈ Σ weights[i] · f(nodes[i])`.
///
/// Both slices have one entry a point. The nodes ascend and are symmetric about 1/2 to rounding; the weights are
/// positive, symmetric and sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// Where to evaluate, ascending in [0, 1].
    pub nodes: &'static [f64],
    /// What each evaluation counts.
    pub weights: &'static [f64],
}

/// The finest Gauss–Lobatto rule, of [`MAX_POINTS`] points: what results are measured with.
pub const FINEST: Rule = match lobatto(MAX_POINTS) {
    Some(rule) => rule,
    None => Rule { nodes: &[], weights: &[] },
};

impl Rule {
    /// The number of points.
    #[expect(clippy::len_without_is_empty, reason = "a rule has at least one point")]
    pub const fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The `(node, weight)` pairs, nodes ascending.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + DoubleEndedIterator + Clone + use<> {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }
}

/// The Gauss–Lobatto rule of `points` = 2 … 32 points: exact for polynomials of degree `2·points − 3`.
///
/// The ends 0 and 1 are nodes, so that it sees what happens at the joints (thesis 6.2.3). `None` for any other count.
pub const fn lobatto(points: usize) -> Option<Rule> {
    if points < 2 || points > MAX_POINTS {
        return None;
    }
    let start = points * (points - 1) / 2 - 1;
    rule(&tables::LOBATTO_NODES, &tables::LOBATTO_WEIGHTS, start, points)
}

/// The Gauss–Legendre rule of `points` = 1 … 32 points: exact for polynomials of degree `2·points − 1`.
///
/// The ends are not nodes. `None` for any other count.
pub const fn legendre(points: usize) -> Option<Rule> {
    if points < 1 || points > MAX_POINTS {
        return None;
    }
    let start = points * (points - 1) / 2;
    rule(&tables::LEGENDRE_NODES, &tables::LEGENDRE_WEIGHTS, start, points)
}

const fn rule(nodes: &'static [f64], weights: &'static [f64], start: usize, points: usize) -> Option<Rule> {
    match (cut(nodes, start, points), cut(weights, start, points)) {
        (Some(nodes), Some(weights)) => Some(Rule { nodes, weights }),
        _ => None,
    }
}

/// `table[start..start + len]` without a panic, in a constant too.
const fn cut(table: &'static [f64], start: usize, len: usize) -> Option<&'static [f64]> {
    match table.split_at_checked(start) {
        Some((_, tail)) => match tail.split_at_checked(len) {
            Some((head, _)) => Some(head),
            None => None,
        },
        None => None,
    }
}
