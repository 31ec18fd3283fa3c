//! Orthonormal Legendre polynomials on [0, 1].

use crate::curves::gauss_legendre;

/// The polynomials `p_0 … p_n` at a point, with slopes and integrals.
#[derive(Clone, Debug)]
pub struct Basis {
    /// `p_j(u)`.
    pub value: Vec<f64>,
    /// `p_j'(u)`.
    pub slope: Vec<f64>,
    /// The integral of `p_j` from 0 to `u`.
    pub integral: Vec<f64>,
}

impl Basis {
    /// The polynomials up to a degree at `u`.
    pub fn at(degree: usize, u: f64) -> Self {
        let x = 2.0 * u - 1.0;
        // The classical polynomials and their derivatives by x; one more than asked for, which the integrals need.
        let (mut p, mut d) = (vec![1.0, x], vec![0.0, 1.0]);
        for j in 1..=degree {
            let n = j as f64;
            p.push(((2.0 * n + 1.0) * x * p[j] - n * p[j - 1]) / (n + 1.0));
            d.push(d[j - 1] + (2.0 * n + 1.0) * p[j]);
        }
        let norm = |j: usize| (2.0 * j as f64 + 1.0).sqrt();
        Self {
            value: (0..=degree).map(|j| norm(j) * p[j]).collect(),
            slope: (0..=degree).map(|j| 2.0 * norm(j) * d[j]).collect(),
            integral: (0..=degree)
                .map(|j| if j == 0 { u } else { 0.5 * (p[j + 1] - p[j - 1]) / norm(j) })
                .collect(),
        }
    }
}

/// `Σ c_j p_j` for the values, slopes or integrals of a basis.
pub fn sum(coefficients: &[f64], of: &[f64]) -> f64 {
    coefficients.iter().zip(of).map(|(c, p)| c * p).sum()
}

/// The series of a degree through samples at the Gauss nodes of as many points: the projection of the interpolant.
pub fn project(degree: usize, samples: &[f64]) -> Vec<f64> {
    let mut series = vec![0.0; degree + 1];
    let known = degree.min(samples.len().saturating_sub(1));
    for (&(u, weight), sample) in gauss_legendre(samples.len()).iter().zip(samples) {
        for (c, p) in series.iter_mut().zip(Basis::at(known, u).value) {
            *c += weight * sample * p;
        }
    }
    series
}
