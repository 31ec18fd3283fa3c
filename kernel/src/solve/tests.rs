//! The solver's algebra against dense matrices: factors are those a matrix was made of, what is solved is multiplied
//! back, a step is compared with the least of the model as the eigenvectors give it.

extern crate std;

use super::envelope::{Allow, Envelope, dot};
use super::problem::packed;
use super::rank_two::RankTwo;
use super::trust_region::{self, Vectors};
use super::workspace::Indices;
use crate::order::Order;
use nalgebra::{SMatrix, SVector};
use std::vec;
use std::vec::Vec;

/// Numbers in [-1, 1].
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector<const N: usize>(&mut self) -> SVector<f64, N> {
        SVector::from_fn(|_, _| self.next())
    }

    /// The first column of each row.
    fn shape<const N: usize>(&mut self) -> [usize; N] {
        core::array::from_fn(|r| (self.next().abs() * (r + 1) as f64) as usize)
    }

    /// A lower triangle of such a shape, whose diagonal is at least a half.
    fn triangle<const N: usize>(&mut self, first: &[usize; N]) -> SMatrix<f64, N, N> {
        let mut out = SMatrix::zeros();
        for r in 0..N {
            for c in first[r]..r {
                out[(r, c)] = 0.6 * self.next();
            }
            out[(r, r)] = 1.0 + 0.5 * self.next();
        }
        out
    }

    /// A symmetric matrix of such a shape.
    fn symmetric<const N: usize>(&mut self, first: &[usize; N]) -> SMatrix<f64, N, N> {
        let lower = self.triangle(first).map(|x| x - 0.5);
        let inside =
            SMatrix::<f64, N, N>::from_fn(|r, c| if c >= first[r] && c <= r { lower[(r, c)] } else { 0.0 });
        inside + inside.transpose()
    }
}

/// An envelope's indices, in memory of their own.
struct Shape {
    first: Vec<f64>,
    start: Vec<f64>,
    places: Vec<(usize, usize)>,
}

impl Shape {
    fn new(first: &[usize]) -> Self {
        let mut places = Vec::new();
        let (mut firsts, mut starts) = (vec![0.0; first.len()], vec![0.0; first.len()]);
        for (r, &column) in first.iter().enumerate() {
            Indices::new(&mut firsts).set(r, column);
            Indices::new(&mut starts).set(r, places.len());
            places.extend((column..=r).map(|c| (r, c)));
        }
        Self { first: firsts, start: starts, places }
    }

    fn store<const N: usize>(&self, dense: &SMatrix<f64, N, N>) -> Vec<f64> {
        self.places.iter().map(|place| dense[*place]).collect()
    }

    /// Does something with the envelope.
    fn with<T>(&self, work: impl FnOnce(&Envelope<'_, '_>) -> T) -> T {
        let (mut first, mut start) = (self.first.clone(), self.start.clone());
        let (first, start) = (Indices::new(&mut first), Indices::new(&mut start));
        work(&Envelope::Rows { first: &first, start: &start })
    }
}

/// Calls with every small matrix shape, as an envelope and, where it is full, as a full one too.
fn shapes<const N: usize>(mut work: impl FnMut(&Envelope<'_, '_>, &Shape, &[usize; N], &mut Numbers)) {
    for seed in 0..60 {
        let mut numbers = Numbers(seed);
        let first = if seed % 3 == 0 { [0; N] } else { numbers.shape() };
        let shape = Shape::new(&first);
        shape.with(|envelope| work(envelope, &shape, &first, &mut numbers));
        if first == [0; N] {
            work(&Envelope::Full(N), &shape, &first, &mut numbers);
        }
    }
}

fn assert_near(found: &[f64], wanted: &[f64], allowed: f64, what: &str) {
    assert_eq!(found.len(), wanted.len());
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() <= allowed, "{what}: {found:?}, not {wanted:?}");
    }
}

#[test]
fn an_inner_product_takes_every_entry_once() {
    for n in 0..10_usize {
        let a: Vec<f64> = (0..n).map(|k| (k + 1) as f64).collect();
        let b: Vec<f64> = (0..n).map(|k| 1.0 - 2.0 * k as f64).collect();
        let wanted: i64 = (0..n as i64).map(|k| (k + 1) * (1 - 2 * k)).sum();
        assert_eq!(dot(&a, &b), wanted as f64);
    }
}

#[test]
fn an_envelope_is_the_dense_matrix() {
    shapes::<7>(|envelope, shape, first, numbers| {
        let dense = numbers.symmetric(first);
        let mut matrix = shape.store(&dense);
        let x: SVector<f64, 7> = numbers.vector();
        let mut found = [f64::NAN; 7];
        envelope.multiply(&matrix, x.as_slice(), &mut found);
        assert_near(&found, (dense * x).as_slice(), 1e-14, "product");
        let sums: [f64; 7] = core::array::from_fn(|r| dense.row(r).iter().map(|x| x.abs()).sum());
        let largest = sums.iter().fold(0.0, |most: f64, sum| most.larger(*sum));
        assert!((envelope.norm(&matrix, &mut [f64::NAN; 7]) - largest).abs() < 1e-14);
        assert_eq!(envelope.rows(), 7);

        for (r, c) in shape.places.iter().copied() {
            envelope.add(&mut matrix, r, c, 10.0 * r as f64 + c as f64);
        }
        let added = SMatrix::from_fn(|r, c| if c <= r { 10.0 * r as f64 + c as f64 } else { 0.0 });
        assert_near(&matrix, &shape.store(&(dense + added)), 1e-14, "sum");
        let row = first[6];
        envelope.isolate(&mut matrix, row);
        let mut alone = dense + added;
        alone.row_mut(row).fill(0.0);
        alone.column_mut(row).fill(0.0);
        alone[(row, row)] = 1.0;
        assert_near(&matrix, &shape.store(&alone), 1e-14, "isolated");
    });
}

#[test]
fn a_factor_is_the_one_that_the_matrix_was_made_of() {
    shapes::<7>(|envelope, shape, first, numbers| {
        let lower = numbers.triangle(first);
        for negative in [None, Some(0), Some(3), Some(6)] {
            for shift in [0.0, 0.3] {
                let mut signs = SMatrix::<f64, 7, 7>::identity();
                if let Some(n) = negative {
                    signs[(n, n)] = -1.0;
                }
                let dense = lower * signs * lower.transpose();
                let matrix = shape.store(&(dense - SMatrix::identity() * shift));
                let mut factor = vec![f64::NAN; matrix.len()];
                let allow = if negative.is_some() { Allow::OneNegative } else { Allow::Definite };
                let found = envelope.factor(&matrix, 1.0, shift, allow, &mut factor);
                let Ok(factored) = found else { panic!("{negative:?} refused") };
                assert_eq!(factored.negative, negative);
                let mut inverse = lower;
                for r in 0..7 {
                    inverse[(r, r)] = 1.0 / lower[(r, r)];
                }
                assert_near(&factor, &shape.store(&inverse), 1e-9, "factor");

                let wanted: SVector<f64, 7> = numbers.vector();
                let mut x = dense * wanted;
                envelope.solve(&factor, factored, x.as_mut_slice());
                assert_near(x.as_slice(), wanted.as_slice(), 1e-8, "solution");
                let mut half = lower * wanted;
                envelope.forward(&factor, half.as_mut_slice());
                assert_near(half.as_slice(), wanted.as_slice(), 1e-9, "half a solution");
            }
        }
    });
}

#[test]
fn more_negative_pivots_than_are_allowed_are_refused_with_a_direction_down() {
    shapes::<6>(|envelope, shape, first, numbers| {
        let lower = numbers.triangle(first);
        for (one, other) in [(0, 2), (1, 5), (3, 4)] {
            let mut signs = SMatrix::<f64, 6, 6>::identity();
            signs[(one, one)] = -1.0;
            signs[(other, other)] = -1.0;
            let (dense, shift) = (lower * signs * lower.transpose(), 0.25);
            let matrix = shape.store(&(dense - SMatrix::identity() * shift));
            let mut factor = vec![f64::NAN; matrix.len()];
            for (allow, row) in [(Allow::Definite, one), (Allow::OneNegative, other)] {
                let failure =
                    envelope.factor(&matrix, 1.0, shift, allow, &mut factor).err().expect("negative");
                assert_eq!(failure.row, row);
                let pivot = -lower[(row, row)] * lower[(row, row)];
                assert!((failure.pivot - pivot).abs() < 1e-9, "{} {pivot}", failure.pivot);
                if allow == Allow::Definite {
                    let mut v = SVector::<f64, 6>::from_element(f64::NAN);
                    envelope.negative_direction(&factor, &failure, v.as_mut_slice());
                    assert!(v[row] == 1.0 && v.iter().skip(row + 1).all(|x| *x == 0.0), "{v}");
                    assert!((v.dot(&(dense * v)) - pivot).abs() < 1e-8, "{v}");
                }
            }
        }
    });
}

/// A matrix with one pivot of a given size, as it is found.
fn with_pivot(pivot: f64, norm: f64, allow: Allow) -> Result<Option<f64>, f64> {
    let lower = SMatrix::<f64, 3, 3>::new(1.0, 0.0, 0.0, 0.5, 1.0, 0.0, -0.5, 0.25, 1.0);
    let signs = SMatrix::from_diagonal(&SVector::<f64, 3>::new(1.0, pivot, 1.0));
    let dense = lower * signs * lower.transpose();
    let matrix: Vec<f64> = (0..3).flat_map(|r| (0..=r).map(move |c| dense[(r, c)])).collect();
    let envelope = Envelope::Full(3);
    let mut factor = [f64::NAN; 6];
    match envelope.factor(&matrix, norm, 0.0, allow, &mut factor) {
        Ok(factored) => {
            // The right-hand side of a solution that is known.
            let mut x = dense * SVector::<f64, 3>::new(1.0, 2.0, 3.0);
            let wanted = x;
            envelope.solve(&factor, factored, x.as_mut_slice());
            let back = dense * x;
            assert!((back - wanted).amax() < 1e-5, "{pivot:e}: {x}");
            Ok((x[1].abs() > 1e-50).then(|| 1.0 / (factor[packed(1, 1)] * factor[packed(1, 1)])))
        }
        Err(failure) => Err(failure.pivot),
    }
}

#[test]
fn a_pivot_that_is_rounding_gets_no_step_and_one_that_is_not_does() {
    for allow in [Allow::Definite, Allow::OneNegative] {
        for rounding in [0.0, 1e-16, -1e-16, 1e-15, -1e-15] {
            assert_eq!(with_pivot(rounding, 1.0, allow), Ok(None), "{rounding:e}");
        }
        // A part of the matrix's norm, where that is the larger.
        for pivot in [4e-11, -4e-11] {
            assert_eq!(with_pivot(pivot, 1e6, allow), Ok(None), "{pivot:e}");
        }
        let found = with_pivot(1e-9, 1.0, allow).expect("positive").expect("a step");
        assert!((found / 1e-9 - 1.0).abs() < 1e-5, "{found:e}");
    }
    let refused = with_pivot(-1e-9, 1.0, Allow::Definite).expect_err("negative");
    assert!((refused / -1e-9 - 1.0).abs() < 1e-5, "{refused:e}");
    // A negative pivot that would take all digits from the others is not gone on with.
    let refused = with_pivot(-1e-9, 1.0, Allow::OneNegative).expect_err("small");
    assert!((refused / -1e-9 - 1.0).abs() < 1e-5, "{refused:e}");
    // The entry is a quarter: a part of 4e-8 of it is enough.
    let found = with_pivot(-1e-8, 1.0, Allow::OneNegative).expect("allowed").expect("a step");
    assert!((found / 1e-8 - 1.0).abs() < 1e-5, "{found:e}");
}

/// `S`, two gradients and the matrix between them, dense.
struct Dense<const N: usize> {
    sparse: SMatrix<f64, N, N>,
    gradients: [SVector<f64, N>; 2],
    second: [[f64; 2]; 2],
}

impl<const N: usize> Dense<N> {
    /// With one negative pivot, or none.
    fn new(first: &[usize; N], negative: Option<usize>, numbers: &mut Numbers) -> Self {
        let lower = numbers.triangle(first);
        let mut signs = SMatrix::<f64, N, N>::identity();
        if let Some(n) = negative {
            signs[(n, n)] = -1.0;
        }
        let [a, b, c] = [0; 3].map(|_| 2.0 * numbers.next());
        Self {
            sparse: lower * signs * lower.transpose(),
            gradients: [numbers.vector(), numbers.vector()],
            second: [[a, b], [b, c]],
        }
    }

    fn added(&self) -> SMatrix<f64, N, N> {
        let mut sum = SMatrix::zeros();
        for i in 0..2 {
            for j in 0..2 {
                sum += self.gradients[i] * self.gradients[j].transpose() * self.second[i][j];
            }
        }
        sum
    }

    fn whole(&self) -> SMatrix<f64, N, N> {
        self.sparse + self.added()
    }
}

fn least_eigenvalue<const N: usize>(dense: &SMatrix<f64, N, N>) -> f64
where
    nalgebra::Const<N>: nalgebra::DimSub<nalgebra::U1> + nalgebra::ToTypenum,
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<nalgebra::DimDiff<nalgebra::Const<N>, nalgebra::U1>>
        + nalgebra::allocator::Allocator<nalgebra::DimDiff<nalgebra::Const<N>, nalgebra::U1>>,
{
    dense.symmetric_eigenvalues().iter().fold(f64::INFINITY, |least, x| least.smaller(*x))
}

#[test]
fn what_is_added_of_rank_two_is_exact_and_known_to_be_definite_or_not() {
    let (mut taken, mut refused) = ([0; 2], [0; 2]);
    for round in 0..100 {
        shapes::<5>(|envelope, shape, first, numbers| {
            numbers.0 ^= round << 20;
            let negative = (round % 2 == 1).then_some(round as usize / 2 % 5);
            let problem = Dense::new(first, negative, numbers);
            let matrix = shape.store(&problem.sparse);
            let mut factor = vec![f64::NAN; matrix.len()];
            let factored = envelope.factor(&matrix, 1.0, 0.0, Allow::OneNegative, &mut factor);
            let factored = factored.unwrap_or_else(|failure| panic!("pivot {}", failure.pivot));
            let [a, b] = &problem.gradients;
            let (mut one, mut other) = ([f64::NAN; 5], [f64::NAN; 5]);
            let mut coupling = RankTwo::new(
                [a.as_slice(), b.as_slice()],
                problem.second,
                [&mut one, &mut other],
                Allow::OneNegative,
            );

            let (x, mut product) = (numbers.vector::<5>(), SVector::<f64, 5>::from_element(1.0));
            coupling.add_product(x.as_slice(), product.as_mut_slice());
            let wanted = problem.added() * x + SVector::from_element(1.0);
            assert_near(product.as_slice(), wanted.as_slice(), 1e-12, "product");
            let largest = problem.added().symmetric_eigenvalues().amax();
            assert!(coupling.norm() >= largest * (1.0 - 1e-12), "{} {largest}", coupling.norm());

            let least = least_eigenvalue(&problem.whole());
            if least.abs() < 1e-3 {
                return;
            }
            let positive = coupling.take(envelope, &factor, factored);
            let [[aa, ab], [_, bb]] = problem.second;
            // Two positive parts that make up for a negative eigenvalue only together are not looked for.
            let together = negative.is_some() && aa * bb > ab * ab && aa > 0.0;
            assert!(positive == (least > 0.0) || (together && !positive), "{positive} {least}");
            let kind = usize::from(negative.is_some());
            if positive {
                taken[kind] += 1;
                let mut y = problem.whole() * x;
                envelope.solve(&factor, factored, y.as_mut_slice());
                coupling.correct(y.as_mut_slice());
                assert_near(y.as_slice(), x.as_slice(), 1e-8, "solution");
            } else {
                refused[kind] += 1;
            }
        });
    }
    assert!(taken.iter().chain(&refused).all(|count| *count > 50), "{taken:?} {refused:?}");
}

#[test]
fn the_bound_of_what_is_added_is_sharp_where_both_gradients_are_one() {
    let (a, b) = ([1.0, 2.0, -2.0], [-0.5, -1.0, 1.0]);
    for second in [[[2.0, -3.0], [-3.0, 5.0]], [[-2.0, 3.0], [3.0, -5.0]]] {
        let (mut one, mut other) = ([0.0; 3], [0.0; 3]);
        let coupling = RankTwo::new([&a, &b], second, [&mut one, &mut other], Allow::Definite);
        // 9, 2.25 and 4.5 are the products of the gradients.
        let wanted = 2.0 * 9.0 + 2.0 * 3.0 * 4.5 + 5.0 * 2.25;
        assert!((coupling.norm() - wanted).abs() < 1e-12, "{}", coupling.norm());
    }
}

/// The least of `g·s + ½ sᵀ H s` in a ball, by the eigenvectors and bisection for the shift.
fn least_in_ball(h: &SMatrix<f64, 4, 4>, g: &SVector<f64, 4>, radius: f64) -> f64 {
    let eigen = h.symmetric_eigen();
    let along = eigen.eigenvectors.transpose() * g;
    let least = eigen.eigenvalues.iter().fold(f64::INFINITY, |least, x| least.smaller(*x));
    let step = |shift: f64| {
        SVector::<f64, 4>::from_fn(|i, _| {
            let bottom = eigen.eigenvalues[i] + shift;
            if along[i] == 0.0 { 0.0 } else { -along[i] / bottom }
        })
    };
    let value = |s: &SVector<f64, 4>| {
        along.dot(s) + 0.5 * s.iter().zip(eigen.eigenvalues.iter()).map(|(s, e)| e * s * s).sum::<f64>()
    };
    if least > 0.0 && step(0.0).norm() <= radius {
        return value(&step(0.0));
    }
    let (mut low, mut high) = ((-least).larger(0.0), (-least).larger(0.0) + g.norm() / radius + 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if step(middle).norm() > radius {
            low = middle;
        } else {
            high = middle;
        }
    }
    let s = step(high);
    // In the hard case the rest of the way goes along the least eigenvector.
    value(&s) + 0.5 * least.smaller(0.0) * (radius * radius - s.norm_squared()).larger(0.0)
}

#[test]
fn a_step_is_the_least_of_the_model_in_its_ball() {
    let (mut newton, mut shifted, mut coupled_steps) = (0, 0, 0);
    for round in 0..30 {
        shapes::<4>(|envelope, shape, first, numbers| {
            numbers.0 ^= round << 20;
            let coupled = round % 2 == 0;
            // By itself the sparse matrix is definite where something is added to it: a shift that only it needs would
            // leave the whole's step without a meaning.
            let least = if coupled { 3.0 } else { (round % 3) as f64 };
            let sparse = numbers.symmetric(first) + SMatrix::identity() * least;
            if coupled && least_eigenvalue(&sparse) < 0.1 {
                return;
            }
            let gradients = [numbers.vector::<4>(), numbers.vector::<4>()];
            let second = [[4.0 * numbers.next(), 2.0], [2.0, 4.0 * numbers.next()]];
            let dense = Dense { sparse, gradients, second };
            let whole = if coupled { dense.whole() } else { sparse };
            let g: SVector<f64, 4> = numbers.vector();
            let matrix = shape.store(&sparse);
            for radius in [0.03, 0.4, 3.0] {
                for (allow, last_shift) in [(Allow::Definite, 0.0), (Allow::OneNegative, 0.5)] {
                    let mut factor = vec![f64::NAN; matrix.len()];
                    let mut rooms = [[f64::NAN; 4]; 5];
                    let [step, scratch, direction, one, other] = &mut rooms;
                    let sides = [dense.gradients[0].as_slice(), dense.gradients[1].as_slice()];
                    let coupling = coupled.then(|| RankTwo::new(sides, second, [one, other], allow));
                    let gradient = g.as_slice();
                    let mut vectors =
                        Vectors { gradient, step, scratch, direction, factor: &mut factor, coupling };
                    let found = trust_region::solve(envelope, &matrix, &mut vectors, radius, last_shift);
                    let found = found.expect("a finite model");
                    let step = SVector::<f64, 4>::from_column_slice(vectors.step);
                    assert!((step.norm() - found.length).abs() < 1e-9 * radius, "{found:?}");
                    let promised = -(g.dot(&step) + 0.5 * step.dot(&(whole * step)));
                    assert!((promised - found.predicted).abs() < 1e-7 * promised, "{promised} {found:?}");
                    if found.shift == 0.0 && found.length <= radius {
                        newton += 1;
                        assert!((whole * step + g).amax() < 1e-8, "{found:?}");
                        assert!(least_eigenvalue(&whole) > -1e-12);
                        continue;
                    }
                    shifted += 1;
                    coupled_steps += usize::from(coupled);
                    // The radius is met to a tenth; the model is the least there, up to what that tenth is worth.
                    assert!((found.length - radius).abs() <= 0.1 * radius * (1.0 + 1e-12), "{found:?}");
                    let best = -least_in_ball(&whole, &g, found.length);
                    assert!(promised >= best * (1.0 - 1e-2), "{promised} {best} {found:?}");
                }
            }
        });
    }
    assert!(newton > 1000 && shifted > 1000 && coupled_steps > 1000, "{newton} {shifted} {coupled_steps}");
}

#[test]
fn a_ridge_is_left_to_either_side_as_far_as_the_ball_reaches() {
    // The gradient has no part along the direction of negative curvature.
    let matrix = [2.0, 0.0, -1.0, 0.0, 0.0, 3.0];
    let (g, radius) = ([1.0, 0.0, 0.5], 2.0);
    let (mut factor, mut rooms) = ([f64::NAN; 6], [[f64::NAN; 3]; 3]);
    let [step, scratch, direction] = &mut rooms;
    let mut vectors = Vectors { gradient: &g, step, scratch, direction, factor: &mut factor, coupling: None };
    let found = trust_region::solve(&Envelope::Full(3), &matrix, &mut vectors, radius, 0.0).expect("finite");
    let s = &vectors.step;
    assert!((found.length - radius).abs() < 1e-12 && (dot(s, s) - radius * radius).abs() < 1e-9, "{found:?}");
    // (H + 1) s = −g but along the ridge.
    assert!((s[0] + 1.0 / 3.0).abs() < 1e-3 && (s[2] + 0.125).abs() < 1e-3, "{s:?}");
    let promised = -(dot(&g, s) + 0.5 * (2.0 * s[0] * s[0] - s[1] * s[1] + 3.0 * s[2] * s[2]));
    assert!((found.predicted - promised).abs() < 1e-12 * promised, "{found:?}");
}

#[test]
fn a_ridge_is_left_to_the_side_that_falls_however_little() {
    let (matrix, radius) = ([2.0, 0.0, -1.0, 0.0, 0.0, 3.0], 2.0);
    for along in [1e-3, 1e-5, 1e-7, 1e-9, 1e-12] {
        for along in [along, -along] {
            let g = [1.0, along, 0.5];
            let (mut factor, mut rooms) = ([f64::NAN; 6], [[f64::NAN; 3]; 3]);
            let [step, scratch, direction] = &mut rooms;
            let mut vectors =
                Vectors { gradient: &g, step, scratch, direction, factor: &mut factor, coupling: None };
            let found = trust_region::solve(&Envelope::Full(3), &matrix, &mut vectors, radius, 0.0);
            let found = found.expect("a finite model");
            let s = &vectors.step;
            assert!((found.length - radius).abs() <= 0.1 * radius * (1.0 + 1e-12), "{found:?}");
            assert!(s[1] * along < 0.0, "{along:e}: {s:?}");
        }
    }
}

#[test]
fn a_model_that_is_not_finite_has_no_step() {
    for matrix in [[f64::NAN], [f64::INFINITY]] {
        let (mut factor, mut rooms) = ([0.0; 1], [[0.0; 1]; 3]);
        let [step, scratch, direction] = &mut rooms;
        let mut vectors =
            Vectors { gradient: &[1.0], step, scratch, direction, factor: &mut factor, coupling: None };
        assert!(trust_region::solve(&Envelope::Full(1), &matrix, &mut vectors, 1.0, 0.0).is_none());
    }
}
