//! A certificate, from outside, that the kernel's derivatives are right: at a converged curve the functional's gradient
//! vanishes along every admissible motion.
//!
//! The motions are made here from elements and joints alone: the speed and the stretch of each end of an element, the
//! turn of a tangent that is not fixed, a curvature that is not fixed, a point that is not fixed. The functional is
//! that of the thesis, by its formulas, over 40 Gauss–Legendre points, in dual numbers: the gradient is exact to
//! rounding. Wrong derivatives in the kernel would lead to curves where it does not vanish.

use minvar::curve::{Continuity, Element, Functional, Given, Joint, Options};
use minvar::solve::Status;
use minvar_tests::appendix::{Figure, figures};
use minvar_tests::compare::kernel_joints;
use minvar_tests::curves::{gauss_legendre, solve_curve};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Arithmetic that the functional is computed in.
trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + From<f64>
{
    fn sqrt(self) -> Self;
}

impl Scalar for f64 {
    fn sqrt(self) -> Self {
        self.sqrt()
    }
}

/// `value + slope ε` with `ε² = 0`.
#[derive(Clone, Copy, Debug)]
struct Dual {
    value: f64,
    slope: f64,
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl Scalar for Dual {
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        Self { value, slope: 0.5 * self.slope / value }
    }
}

type Vector<S> = [S; 3];

fn add<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times<S: Scalar>(a: Vector<S>, by: S) -> Vector<S> {
    a.map(|x| x * by)
}

fn dot<S: Scalar>(a: Vector<S>, b: Vector<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit<S: Scalar>(a: Vector<S>) -> Vector<S> {
    times(a, S::from(1.0) / dot(a, a).sqrt())
}

/// What a row triple at an end of an element is made of: `P' = v t`, `P'' = v² κ + β t`.
#[derive(Clone, Copy)]
struct End<S> {
    point: Vector<S>,
    tangent: Vector<S>,
    curvature: Vector<S>,
    speed: S,
    stretch: S,
}

impl End<f64> {
    fn of(element: &Element, end: usize) -> Self {
        let [point, first, second] = if end == 0 {
            [element.rows[0], element.rows[1], element.rows[2]]
        } else {
            [element.rows[5], element.rows[4], element.rows[3]]
        };
        let speed = dot(first, first).sqrt();
        let tangent = unit(first);
        let stretch = dot(second, tangent);
        let curvature = times(sub(second, times(tangent, stretch)), 1.0 / (speed * speed));
        Self { point, tangent, curvature, speed, stretch }
    }

    fn lift<S: Scalar>(&self) -> End<S> {
        End {
            point: self.point.map(S::from),
            tangent: self.tangent.map(S::from),
            curvature: self.curvature.map(S::from),
            speed: S::from(self.speed),
            stretch: S::from(self.stretch),
        }
    }
}

impl<S: Scalar> End<S> {
    /// Turns the tangent towards a perpendicular direction; the curvature vector goes with it on the shortest way.
    fn turn(&mut self, towards: Vector<f64>, by: S) {
        let from = self.tangent;
        let to = unit(add(from, times(towards.map(S::from), by)));
        let share = dot(self.curvature, to) / (S::from(1.0) + dot(from, to));
        self.curvature = sub(self.curvature, times(add(from, to), share));
        self.tangent = to;
    }

    /// Turns the curvature vector about the tangent.
    fn twist(&mut self, by: S) {
        let size = dot(self.curvature, self.curvature).sqrt();
        let across = cross(self.tangent, self.curvature);
        self.curvature = times(unit(add(self.curvature, times(across, by))), size);
    }

    fn rows(&self) -> [Vector<S>; 3] {
        let second = add(times(self.curvature, self.speed * self.speed), times(self.tangent, self.stretch));
        [self.point, times(self.tangent, self.speed), second]
    }
}

#[derive(Clone, Copy, Debug)]
enum Change {
    Speed,
    Stretch,
    Shift(Vector<f64>),
    Turn(Vector<f64>),
    Bend(Vector<f64>),
    Twist,
}

/// One admissible motion: a change of one or two ends of elements, and its natural size.
#[derive(Clone, Debug)]
struct Motion {
    ends: Vec<(usize, usize)>,
    change: Change,
    size: f64,
}

impl Motion {
    fn apply<S: Scalar>(&self, by: S, ends: &mut [[End<S>; 2]]) {
        let by = by * S::from(self.size);
        for &(element, end) in &self.ends {
            let end = &mut ends[element][end];
            match self.change {
                Change::Speed => end.speed = end.speed + by,
                Change::Stretch => end.stretch = end.stretch + by,
                Change::Shift(along) => end.point = add(end.point, times(along.map(S::from), by)),
                Change::Turn(towards) => end.turn(towards, by),
                Change::Bend(along) => end.curvature = add(end.curvature, times(along.map(S::from), by)),
                Change::Twist => end.twist(by),
            }
        }
    }
}

/// A curve as a set of admissible motions about its elements.
struct Family {
    ends: Vec<[End<f64>; 2]>,
    motions: Vec<Motion>,
    functional: Functional,
    rule: Vec<(f64, f64)>,
}

impl Family {
    fn new(
        joints: &[Joint],
        closed: bool,
        planar: bool,
        functional: Functional,
        elements: &[Element],
    ) -> Self {
        let ends: Vec<[End<f64>; 2]> =
            elements.iter().map(|element| [End::of(element, 0), End::of(element, 1)]).collect();
        let spans = if closed { joints.len() } else { joints.len() - 1 };
        let per_span = elements.len() / spans;
        let mut motions = Vec::new();
        for element in 0..elements.len() {
            for end in 0..2 {
                let size = ends[element][end].speed;
                motions.push(Motion { ends: vec![(element, end)], change: Change::Speed, size });
                motions.push(Motion { ends: vec![(element, end)], change: Change::Stretch, size });
            }
        }
        let nodes = elements.len() + usize::from(!closed);
        let free = Joint::at([0.0; 3]).with_position(minvar::curve::Quantity::FREE);
        for node in 0..nodes {
            let joint = if node % per_span == 0 { &joints[node / per_span] } else { &free };
            let before = if node > 0 { Some(node - 1) } else { closed.then(|| elements.len() - 1) };
            let mut sides = Vec::new();
            if let Some(element) = before {
                sides.push((element, 1));
            }
            if node < elements.len() {
                sides.push((node, 0));
            }
            let groups = |shared: bool| -> Vec<Vec<(usize, usize)>> {
                if shared { vec![sides.clone()] } else { sides.iter().map(|&side| vec![side]).collect() }
            };
            let length =
                sides.iter().map(|&(element, end)| ends[element][end].speed).fold(f64::INFINITY, f64::min);
            if joint.position.given != Given::FIXED {
                for d in 0..if planar { 2 } else { 3 } {
                    let mut along = [0.0; 3];
                    along[d] = 1.0;
                    motions.push(Motion { ends: sides.clone(), change: Change::Shift(along), size: length });
                }
            }
            for group in groups(joint.continuity != Continuity::G0) {
                let (element, end) = group[0];
                let tangent = ends[element][end].tangent;
                let normals = normals(tangent, planar);
                if joint.tangent[1 - end].given != Given::FIXED {
                    for &normal in &normals {
                        motions.push(Motion { ends: group.clone(), change: Change::Turn(normal), size: 1.0 });
                    }
                }
            }
            for group in groups(joint.continuity == Continuity::G2) {
                let (element, end) = group[0];
                let given = &joint.curvature[1 - end];
                if given.given != Given::FIXED {
                    for &normal in &normals(ends[element][end].tangent, planar) {
                        motions.push(Motion {
                            ends: group.clone(),
                            change: Change::Bend(normal),
                            size: 1.0 / length,
                        });
                    }
                } else if joint.tangent[1 - end].given != Given::FIXED && !planar && given.value != [0.0; 3] {
                    motions.push(Motion { ends: group, change: Change::Twist, size: 1.0 });
                }
            }
        }
        Self { ends, motions, functional, rule: gauss_legendre(40) }
    }

    /// The functional of one element after it moved.
    fn element<S: Scalar>(&self, ends: &[End<S>; 2]) -> S {
        let [p0, v0, a0] = ends[0].rows();
        let [p1, v1, a1] = ends[1].rows();
        let number = S::from;
        let half = |x| times(x, number(0.5));
        let h = sub(sub(sub(p1, p0), v0), half(a0));
        let v = sub(sub(v1, v0), a0);
        let a = sub(a1, a0);
        let mix =
            |x: f64, y: f64, z: f64| add(add(times(h, number(x)), times(v, number(y))), times(a, number(z)));
        let c = [v0, half(a0), mix(10.0, -4.0, 0.5), mix(-15.0, 7.0, -1.0), mix(6.0, -3.0, 0.5)];
        let mut sum = number(0.0);
        for &(t, weight) in &self.rule {
            let derivative = |order: usize| {
                let mut out = [number(0.0); 3];
                for k in (order..=5).rev() {
                    let factor: f64 = (k + 1 - order..=k).map(|x| x as f64).product();
                    out = add(times(out, number(t)), times(c[k - 1], number(factor)));
                }
                out
            };
            let [d1, d2, d3] = [derivative(1), derivative(2), derivative(3)];
            let square = dot(d1, d1);
            let speed = square.sqrt();
            let cube = square * speed;
            let density = if self.functional == Functional::MEC {
                let bend = times(cross(d1, d2), number(1.0) / cube);
                dot(bend, bend) * speed
            } else {
                let slope = sub(
                    times(cross(d1, d3), number(1.0) / cube),
                    times(cross(d1, d2), number(3.0) * dot(d1, d2) / (cube * square)),
                );
                dot(slope, slope) / speed
            };
            sum = sum + density * number(weight);
        }
        sum
    }

    fn value(&self) -> f64 {
        self.ends.iter().map(|ends| self.element(ends)).sum()
    }

    /// The ends after all motions at once, by multiples of their natural sizes.
    fn moved<S: Scalar>(&self, by: &[S]) -> Vec<[End<S>; 2]> {
        let mut ends: Vec<[End<S>; 2]> =
            self.ends.iter().map(|ends| [ends[0].lift(), ends[1].lift()]).collect();
        for (motion, &by) in self.motions.iter().zip(by) {
            motion.apply(by, &mut ends);
        }
        ends
    }

    /// The functional's gradient by the motions, each times its natural size, at a state given by them.
    fn gradient(&self, at: &[f64]) -> Vec<f64> {
        let mut by: Vec<Dual> = at.iter().map(|&value| Dual::from(value)).collect();
        let slope = |i: usize| {
            by[i].slope = 1.0;
            let ends = self.moved(&by);
            by[i].slope = 0.0;
            let mut touched: Vec<usize> = self.motions[i].ends.iter().map(|&(element, _)| element).collect();
            touched.dedup();
            touched.iter().map(|&element| self.element(&ends[element]).slope).sum()
        };
        (0..at.len()).map(slope).collect()
    }

    /// Second derivatives by central differences of the gradient.
    fn hessian(&self) -> Vec<Vec<f64>> {
        const STEP: f64 = 1e-5;
        let n = self.motions.len();
        let mut hessian: Vec<Vec<f64>> = (0..n)
            .map(|j| {
                let mut at = vec![0.0; n];
                at[j] = STEP;
                let up = self.gradient(&at);
                at[j] = -STEP;
                let down = self.gradient(&at);
                up.iter().zip(&down).map(|(up, down)| (up - down) / (2.0 * STEP)).collect()
            })
            .collect();
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (hessian[i][j] + hessian[j][i]);
                (hessian[i][j], hessian[j][i]) = (mean, mean);
            }
        }
        hessian
    }

    fn certificate(&self) -> Certificate {
        let gradient = self.gradient(&vec![0.0; self.motions.len()]);
        let (values, vectors) = eigen(self.hessian());
        let most = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let decrement = values
            .iter()
            .zip(&vectors)
            .map(|(value, vector)| {
                let slope: f64 = vector.iter().zip(&gradient).map(|(x, g)| x * g).sum();
                0.5 * slope * slope / value.abs().max(1e-10 * most)
            })
            .sum();
        Certificate {
            value: self.value(),
            slope: gradient.iter().fold(0.0, |most: f64, slope| most.max(slope.abs())),
            decrement,
            least: values.iter().fold(f64::INFINITY, |least, &value| least.min(value)) / most,
        }
    }
}

/// How near a curve is to a minimum.
#[derive(Debug)]
struct Certificate {
    value: f64,
    /// The largest slope along a motion, times its natural size.
    slope: f64,
    /// What a Newton step would still gain.
    decrement: f64,
    /// The least eigenvalue of the Hessian as a fraction of the largest.
    least: f64,
}

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations.
fn eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut vectors: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..30 {
        let size = |pick: fn(usize, usize) -> bool| -> f64 {
            (0..n)
                .flat_map(|i| (0..n).map(move |j| (i, j)))
                .filter(|&(i, j)| pick(i, j))
                .map(|(i, j)| a[i][j].abs())
                .sum()
        };
        if size(|i, j| i != j) <= 1e-18 * size(|i, j| i == j) {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (vectors[p][k], vectors[q][k]);
                    (vectors[p][k], vectors[q][k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), vectors)
}

fn normals(tangent: Vector<f64>, planar: bool) -> Vec<Vector<f64>> {
    if planar {
        return vec![[-tangent[1], tangent[0], 0.0]];
    }
    let other = if tangent[2].abs() < 0.8 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let one = unit(cross(tangent, other));
    vec![one, cross(tangent, one)]
}

/// Numbers from -1 to 1, the same every time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Whether a figure has a curve of least value (numerics.md): two sets sink as they grow, and a fixed curvature makes a MEC
/// approach the curve without it ever closer, with a kink at the joint.
fn has_minimum(figure: &Figure, functional: Functional) -> bool {
    let sinks = ["4.14", "4.15"].contains(&figure.id.as_str());
    let kinks = ["4.9-1", "4.9-2", "4.10-1", "4.22"].contains(&figure.id.as_str());
    !(sinks || kinks && functional == Functional::MEC)
}

/// Appendix A's sets that have a minimum, solved.
fn minima(functional: Functional, elements_per_span: u32) -> Vec<(Figure, Family)> {
    let solved = |figure: Figure| {
        let (status, family) = family(&figure, functional, elements_per_span, 2000);
        assert_eq!(status, Status::Converged, "{}", figure.id);
        (figure, family)
    };
    figures().into_iter().filter(|figure| has_minimum(figure, functional)).map(solved).collect()
}

fn family(
    figure: &Figure,
    functional: Functional,
    elements_per_span: u32,
    iterations: u32,
) -> (Status, Family) {
    let joints = kernel_joints(figure);
    let options = Options {
        functional,
        elements_per_span,
        max_iterations: iterations,
        relative_decrease: 0.0,
        ..Options::DEFAULT
    };
    let (report, elements) =
        solve_curve(&joints, figure.closed, &options).expect("the thesis's data are good");
    assert_eq!(report.planar, figure.planar(), "{}", figure.id);
    let family = Family::new(&joints, figure.closed, report.planar, functional, &elements);
    assert_eq!(family.motions.len(), report.unknowns, "{}: as many motions as unknowns", figure.id);
    (report.status, family)
}

/// The size that is natural for the functional: 1/length³ or 1/length an element.
fn natural(family: &Family) -> f64 {
    let of =
        |length: f64| if family.functional == Functional::MEC { length } else { length * length * length };
    family.ends.iter().map(|ends| 1.0 / of(ends[0].speed)).sum()
}

/// A slope is small as a fraction of the functional, or of a thousandth of its natural size where it nearly vanishes.
/// What could still be gained is below any tolerance, or below what rounding lets one know of a sum of squares of
/// residuals that are themselves known to rounding of their natural size.
fn is_certain(functional: Functional, elements_per_span: u32, slope: f64) {
    for (figure, family) in minima(functional, elements_per_span) {
        let certificate = family.certificate();
        let (value, natural) = (certificate.value, natural(&family));
        let rounding = 16.0 * f64::EPSILON * (value * natural).sqrt();
        let about = format!("{}: {certificate:?}", figure.id);
        assert!(certificate.slope <= slope * (value + 1e-3 * natural), "{about}");
        assert!(certificate.decrement <= 1e-10 * value + rounding, "{about}");
        assert!(certificate.least >= -1e-9, "{about}");
    }
}

#[test]
fn the_gradient_vanishes_and_the_hessian_is_positive_at_every_mvc_of_appendix_a() {
    is_certain(Functional::MVC, 1, 1e-7);
}

#[test]
fn the_gradient_vanishes_and_the_hessian_is_positive_at_every_mec_of_appendix_a() {
    is_certain(Functional::MEC, 1, 1e-7);
}

#[test]
fn the_gradient_vanishes_with_two_elements_a_span() {
    is_certain(Functional::MVC, 2, 1e-5);
    is_certain(Functional::MEC, 2, 1e-5);
}

#[test]
fn no_small_admissible_motion_lowers_the_functional_beyond_second_order() {
    let mut random = Random(4);
    for functional in [Functional::MVC, Functional::MEC] {
        for (figure, family) in minima(functional, 1) {
            let value = family.value();
            for size in [1e-2, 1e-3, 1e-4] {
                for _ in 0..20 {
                    let by: Vec<f64> = family.motions.iter().map(|_| size * random.next()).collect();
                    let back: Vec<f64> = by.iter().map(|x| -x).collect();
                    let sum = |by: &[f64]| -> f64 {
                        family.moved(by).iter().map(|ends| family.element(ends)).sum()
                    };
                    let (up, down) = (sum(&by), sum(&back));
                    let what = format!("{} {functional:?} {size:e}: {up} {down} {value}", figure.id);
                    // A sum of both is free of odd orders.
                    assert!(0.5 * (up + down) >= value * (1.0 - 1e-10), "{what}");
                    assert!(up.min(down) >= value * (1.0 - 1e-8), "{what}");
                }
            }
        }
    }
}

#[test]
fn the_certificate_is_refused_to_a_curve_that_is_no_minimum() {
    // A little motion in everything shows.
    for (figure, mut family) in minima(Functional::MVC, 1) {
        let by: Vec<f64> = (0..family.motions.len()).map(|i| if i % 2 == 0 { 1e-3 } else { -1e-3 }).collect();
        family.ends = family.moved(&by);
        let certificate = family.certificate();
        let natural = natural(&family);
        assert!(
            certificate.decrement > 1e-9 * (certificate.value + 1e-3 * natural),
            "{}: {certificate:?}",
            figure.id
        );
    }
    // One percent off in a single speed shows.
    let (_, mut family) = family(&figures()[0], Functional::MVC, 1, 200);
    family.ends[0][0].speed *= 1.01;
    let certificate = family.certificate();
    assert!(certificate.slope > 1e-3 * certificate.value, "{certificate:?}");
}
