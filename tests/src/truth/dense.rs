//! Dense linear algebra of a few hundred unknowns, written for clarity.

use std::ops::{Index, IndexMut};

/// A matrix by rows.
#[derive(Clone, Debug)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

impl Matrix {
    /// All zero.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, data: vec![0.0; rows * columns] }
    }

    /// The number of rows.
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// A row.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.data[i * self.columns..][..self.columns]
    }

    /// A row to write.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.data[i * self.columns..][..self.columns]
    }

    /// The product with a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        (0..self.rows).map(|i| dot(self.row(i), x)).collect()
    }

    /// The product of the transpose with a vector.
    pub fn transposed_times(&self, y: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        for (i, &by) in y.iter().enumerate() {
            for (o, a) in out.iter_mut().zip(self.row(i)) {
                *o += by * a;
            }
        }
        out
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.data[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.data[i * self.columns + j]
    }
}

/// The inner product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The solution of a square system by elimination with row pivoting, refined once; `None` where a pivot vanishes.
pub fn solve(matrix: &Matrix, right: &[f64]) -> Option<Vec<f64>> {
    let factors = Factors::of(matrix)?;
    let mut x = factors.solve(right);
    let rest: Vec<f64> = matrix.times(&x).iter().zip(right).map(|(ax, b)| b - ax).collect();
    for (x, d) in x.iter_mut().zip(factors.solve(&rest)) {
        *x += d;
    }
    Some(x)
}

struct Factors {
    lu: Matrix,
    order: Vec<usize>,
}

impl Factors {
    fn of(matrix: &Matrix) -> Option<Self> {
        let n = matrix.rows;
        let mut lu = matrix.clone();
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let pivot = (k..n).max_by(|&a, &b| lu[(a, k)].abs().total_cmp(&lu[(b, k)].abs()))?;
            if !(lu[(pivot, k)].abs() > 0.0) {
                return None;
            }
            if pivot != k {
                order.swap(pivot, k);
                for j in 0..n {
                    lu.data.swap(pivot * n + j, k * n + j);
                }
            }
            let (above, below) = lu.data.split_at_mut((k + 1) * n);
            let top = &above[k * n..];
            for row in below.chunks_mut(n) {
                let by = row[k] / top[k];
                row[k] = by;
                if by != 0.0 {
                    for j in k + 1..n {
                        row[j] -= by * top[j];
                    }
                }
            }
        }
        Some(Self { lu, order })
    }

    fn solve(&self, right: &[f64]) -> Vec<f64> {
        let n = right.len();
        let mut x: Vec<f64> = self.order.iter().map(|&i| right[i]).collect();
        for i in 1..n {
            x[i] -= dot(&self.lu.row(i)[..i], &x[..i]);
        }
        for i in (0..n).rev() {
            x[i] = (x[i] - dot(&self.lu.row(i)[i + 1..], &x[i + 1..])) / self.lu[(i, i)];
        }
        x
    }
}

/// An orthonormal basis, by rows, of what the rows of a matrix of full rank are orthogonal to: the last reflections of
/// Householder's factorisation of the transpose.
pub fn null_space(matrix: &Matrix) -> Matrix {
    let (m, n) = (matrix.rows, matrix.columns);
    let mut work = matrix.clone();
    let mut reflectors: Vec<Vec<f64>> = Vec::with_capacity(m);
    for k in 0..m {
        let mut v = vec![0.0; n];
        v[k..].copy_from_slice(&work.row(k)[k..]);
        let size = dot(&v, &v).sqrt();
        v[k] += size.copysign(v[k]);
        let norm = dot(&v, &v).sqrt();
        v.iter_mut().for_each(|x| *x /= norm);
        for i in k..m {
            reflect(&v, work.row_mut(i));
        }
        reflectors.push(v);
    }
    let mut out = Matrix::zeros(n - m, n);
    for i in 0..n - m {
        out[(i, m + i)] = 1.0;
        for v in reflectors.iter().rev() {
            reflect(v, out.row_mut(i));
        }
    }
    out
}

fn reflect(v: &[f64], x: &mut [f64]) {
    let by = 2.0 * dot(v, x);
    for (x, v) in x.iter_mut().zip(v) {
        *x -= by * v;
    }
}

/// The smallest eigenvalue of a symmetric matrix, by bisection on its tridiagonal form.
pub fn smallest_eigenvalue(matrix: &Matrix) -> f64 {
    let (diagonal, beside) = tridiagonal(matrix);
    // Gershgorin's discs hold all eigenvalues.
    let reach = |i: usize| {
        let before = if i > 0 { beside[i - 1].abs() } else { 0.0 };
        before + beside.get(i).map_or(0.0, |x| x.abs())
    };
    let largest = (0..diagonal.len()).map(|i| diagonal[i].abs() + reach(i)).fold(0.0, f64::max);
    let (mut low, mut high) = (-largest, largest);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // An eigenvalue lies below where a pivot of the shifted matrix is negative (Sylvester's law).
        let mut pivot = 1.0;
        let below = (0..diagonal.len()).any(|i| {
            let carried = if i > 0 { beside[i - 1] * beside[i - 1] / pivot } else { 0.0 };
            pivot = diagonal[i] - middle - carried;
            pivot < 0.0
        });
        if below {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// The diagonal and the side diagonal of a similar tridiagonal matrix (Householder).
fn tridiagonal(matrix: &Matrix) -> (Vec<f64>, Vec<f64>) {
    let n = matrix.rows;
    let mut a = matrix.clone();
    for k in 0..n.saturating_sub(2) {
        let mut v = vec![0.0; n];
        for i in k + 1..n {
            v[i] = a[(i, k)];
        }
        v[k + 1] += dot(&v, &v).sqrt().copysign(v[k + 1]);
        let norm = dot(&v, &v).sqrt();
        if norm == 0.0 {
            continue;
        }
        v.iter_mut().for_each(|x| *x /= norm);
        let mut w = a.times(&v);
        let along = dot(&v, &w);
        w.iter_mut().zip(&v).for_each(|(w, v)| *w -= along * v);
        for i in 0..n {
            for (j, x) in a.row_mut(i).iter_mut().enumerate() {
                *x -= 2.0 * (v[i] * w[j] + w[i] * v[j]);
            }
        }
    }
    ((0..n).map(|i| a[(i, i)]).collect(), (1..n).map(|i| a[(i, i - 1)]).collect())
}
