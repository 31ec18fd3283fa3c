//! What a chain of elements is like along its length: points, curvature, torsion. Pictures and tables are made of this.

use minvar::basis::quadrature;
use minvar::curve::{Element, measure};

/// A vector.
pub(crate) type Vector = [f64; 3];

/// Below this angle (curvature times the curve's length, radians) a curve counts as straight: what is left is rounding.
pub(crate) const STRAIGHT: f64 = 1e-9;

/// A coordinate plane to which a curve is parallel. Right-handed: left of the curve is where the curvature is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    /// x to the right, y up, seen from +z.
    Xy,
    /// z to the right, x up, seen from +y.
    Zx,
    /// y to the right, z up, seen from +x.
    Yz,
}

impl Plane {
    /// The coordinates that point right, up and to the viewer.
    pub(crate) fn axes(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }

    /// The plane that the elements keep to, if there is one. A straight line in several takes the first.
    pub(crate) fn of(elements: &[Element]) -> Option<Self> {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in elements.iter().flat_map(Element::bezier) {
            for d in 0..3 {
                low[d] = low[d].min(point[d]);
                high[d] = high[d].max(point[d]);
            }
        }
        let extent = (0..3).map(|d| high[d] - low[d]).fold(0.0, f64::max);
        let flat = |d: usize| high[d] - low[d] <= 1e-9 * extent + 1e-15 * high[d].abs().max(low[d].abs());
        [Self::Xy, Self::Zx, Self::Yz].into_iter().find(|plane| flat(plane.axes()[2]))
    }
}

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// The element, from 0.
    pub(crate) element: usize,
    /// The parameter within the element, 0 to 1.
    pub(crate) t: f64,
    /// The arc length from the curve's start.
    pub(crate) s: f64,
    /// The position.
    pub(crate) point: Vector,
    /// The unit tangent; zero where the curve stops (`C' = 0`).
    pub(crate) tangent: Vector,
    /// The curvature vector: to the centre of curvature, 1/radius long.
    pub(crate) curvature: Vector,
    /// The curvature: signed, positive to the left, in a plane; not negative in space.
    pub(crate) kappa: f64,
    /// The torsion: `None` where the curve is too straight to have one.
    pub(crate) torsion: Option<f64>,
    /// The derivative of `kappa` along the arc: `None` where a space curve is straight.
    pub(crate) dkappa_ds: Option<f64>,
}

/// A curve's samples in order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Trace {
    /// The coordinate plane that the curve keeps to.
    pub(crate) plane: Option<Plane>,
    /// The normal of the plane, also an oblique one, about which curvature is signed.
    pub(crate) normal: Option<Vector>,
    /// The arc length at each element's start, and at the end of the last.
    pub(crate) starts: Vec<f64>,
    /// The samples: each element's from `t = 0` to `t = 1`, so that a joint shows both its sides.
    pub(crate) samples: Vec<Sample>,
}

impl Trace {
    /// Samples every element at `count` equidistant parameters, at least 2, both ends among them.
    pub(crate) fn new(elements: &[Element], count: usize) -> Self {
        let (plane, normal) = (Plane::of(elements), measure::plane_normal(elements));
        let steps = count.max(2) - 1;
        let mut starts = Vec::with_capacity(elements.len() + 1);
        let mut samples = Vec::with_capacity(elements.len() * (steps + 1));
        let mut s = 0.0;
        for (index, element) in elements.iter().enumerate() {
            starts.push(s);
            let mut t = 0.0;
            for step in 0..=steps {
                let next = step as f64 / steps as f64;
                s += arc_length(element, t, next);
                t = next;
                samples.push(sample(element, index, t, s, normal));
            }
        }
        starts.push(s);
        for sample in &mut samples {
            let straight = norm(sample.curvature) * s <= STRAIGHT;
            if straight {
                sample.torsion = None;
            }
            if plane.is_some() || (normal.is_some() && !straight) {
                sample.torsion = Some(0.0);
            }
        }
        Self { plane, normal, starts, samples }
    }

    /// One more sample, without its arc length.
    pub(crate) fn sample_at(&self, element: &Element, t: f64) -> Sample {
        sample(element, 0, t, 0.0, self.normal)
    }

    /// The curve's length.
    pub(crate) fn length(&self) -> f64 {
        self.starts.last().copied().unwrap_or(0.0)
    }
}

/// The arc length between two parameters; `C'` is near enough to a polynomial over the short pieces asked for here.
fn arc_length(element: &Element, from: f64, to: f64) -> f64 {
    let rule = quadrature::legendre(12);
    let speed = |x: f64| norm(element.derivatives(from + (to - from) * x)[1]);
    rule.iter().flat_map(|rule| rule.iter()).map(|(x, weight)| weight * (to - from) * speed(x)).sum()
}

fn sample(element: &Element, index: usize, t: f64, s: f64, normal: Option<Vector>) -> Sample {
    let [point, d1, d2, d3] = element.derivatives(t);
    let speed2 = dot(d1, d1);
    let speed = speed2.sqrt();
    let zero = Sample {
        element: index,
        t,
        s,
        point,
        tangent: [0.0; 3],
        curvature: [0.0; 3],
        kappa: 0.0,
        torsion: None,
        dkappa_ds: None,
    };
    if speed == 0.0 {
        return zero;
    }
    let binormal = cross(d1, d2);
    let size = norm(binormal);
    // The direction along which curvature is measured: the plane's normal, or the binormal itself.
    let normal = normal.or((size > 0.0).then(|| scale(1.0 / size, binormal)));
    let along = |normal: Vector| dot(binormal, normal) / (speed2 * speed);
    let derivative = |normal: Vector| {
        let change = dot(cross(d1, d3), normal) / (speed2 * speed);
        (change - 3.0 * along(normal) * dot(d1, d2) / speed2) / speed
    };
    Sample {
        tangent: scale(1.0 / speed, d1),
        curvature: scale(1.0 / (speed2 * speed2), cross(binormal, d1)),
        kappa: normal.map_or(0.0, along),
        torsion: (size > 0.0).then(|| dot(binormal, d3) / (size * size)),
        dkappa_ds: normal.map(derivative),
        ..zero
    }
}

/// The scalar product.
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length of a vector.
pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// A multiple of a vector.
pub(crate) fn scale(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

/// `a + factor · b`
pub(crate) fn add(a: Vector, factor: f64, b: Vector) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

#[cfg(test)]
pub(crate) mod shapes {
    //! Curves whose figures are known, for tests.

    use super::*;

    /// A polynomial curve `C(t) = Σ c_k t^k` as one element.
    pub(crate) fn polynomial(c: [Vector; 4]) -> Element {
        let at = |t: f64| add(add(add(c[0], t, c[1]), t * t, c[2]), t * t * t, c[3]);
        let first = |t: f64| add(add(c[1], 2.0 * t, c[2]), 3.0 * t * t, c[3]);
        let second = |t: f64| add(scale(2.0, c[2]), 6.0 * t, c[3]);
        Element { rows: [at(0.0), first(0.0), second(0.0), second(1.0), first(1.0), at(1.0)] }
    }

    /// A counter-clockwise quarter of the circle about the origin in the xy-plane, starting at (r, 0, 0).
    pub(crate) fn quarter(r: f64) -> Element {
        // The best MVC quintic: for r = 1 |C'| = 1.59456, and the tangential part of C'' is -0.0929 |C'|.
        let (v, a) = (1.594_56 * r, -0.0929 * 1.594_56 * r);
        let n = v * v / r;
        Element {
            rows: [[r, 0.0, 0.0], [0.0, v, 0.0], [-n, a, 0.0], [a, -n, 0.0], [-v, 0.0, 0.0], [0.0, r, 0.0]],
        }
    }

    /// The circle of four quarters, counter-clockwise from (r, 0, 0), moved.
    pub(crate) fn circle(r: f64, centre: Vector) -> Vec<Element> {
        let mut rows = quarter(r).rows;
        let quarters = (0..4).map(|_| {
            let mut moved = rows;
            moved[0] = add(moved[0], 1.0, centre);
            moved[5] = add(moved[5], 1.0, centre);
            rows = rows.map(|[x, y, z]| [-y, x, z]);
            Element { rows: moved }
        });
        quarters.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64, tolerance: f64) -> bool {
        (a - b).abs() <= tolerance
    }

    #[test]
    fn a_quarter_circle_has_the_circles_figures() {
        for r in [1e-6, 1.0, 1e6] {
            let trace = Trace::new(&[shapes::quarter(r)], 33);
            assert_eq!(trace.plane, Some(Plane::Xy));
            assert!(near(trace.length() / r, std::f64::consts::FRAC_PI_2, 1e-5), "{}", trace.length() / r);
            for sample in &trace.samples {
                assert!(near(sample.kappa * r, 1.0, 2e-4), "{sample:?}");
                assert!(near(dot(sample.curvature, sample.point), -1.0, 1e-3), "points to the centre");
                assert_eq!(sample.torsion, Some(0.0));
            }
        }
    }

    #[test]
    fn a_clockwise_curve_has_negative_curvature() {
        let [p0, v0, a0, a1, v1, p1] = shapes::quarter(1.0).rows;
        let back = Element { rows: [p1, scale(-1.0, v1), a1, a0, scale(-1.0, v0), p0] };
        assert!(Trace::new(&[back], 9).samples.iter().all(|sample| sample.kappa < -0.99));
    }

    #[test]
    fn the_twisted_cubic_has_its_curvature_and_torsion() {
        // C = (t, t², t³): κ² = 4(9t⁴+9t²+1)/(9t⁴+4t²+1)³, τ = 3/(9t⁴+9t²+1).
        let zero = [0.0; 3];
        let cubic = shapes::polynomial([zero, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let trace = Trace::new(&[cubic], 17);
        assert_eq!(trace.plane, None);
        for sample in &trace.samples {
            let t = sample.t;
            let (p, q) = (9.0 * t * t * t * t + 9.0 * t * t + 1.0, 9.0 * t * t * t * t + 4.0 * t * t + 1.0);
            assert!(near(sample.kappa, 2.0 * (p / (q * q * q)).sqrt(), 1e-13), "{sample:?}");
            assert!(near(sample.torsion.expect("a torsion"), 3.0 / p, 1e-13), "{sample:?}");
            let ratio = (36.0 * t * t * t + 18.0 * t) / p - 3.0 * (36.0 * t * t * t + 8.0 * t) / q;
            let expected = 0.5 * sample.kappa * ratio / q.sqrt();
            assert!(near(sample.dkappa_ds.expect("a derivative"), expected, 1e-12), "{sample:?}");
        }
    }

    #[test]
    fn a_parabola_in_each_coordinate_plane_is_planar_and_turns_left() {
        for (plane, axes) in [(Plane::Xy, [0, 1, 2]), (Plane::Zx, [2, 0, 1]), (Plane::Yz, [1, 2, 0])] {
            let place = |u: f64, v: f64| {
                let mut p = [0.0; 3];
                (p[axes[0]], p[axes[1]]) = (u, v);
                p
            };
            let mut start = place(1e6, -3.0);
            start[axes[2]] = 7e5;
            let element = shapes::polynomial([start, place(1.0, 0.0), place(0.0, 1.0), [0.0; 3]]);
            let trace = Trace::new(&[element], 5);
            assert_eq!(trace.plane, Some(plane));
            assert!(near(trace.samples[0].kappa, 2.0, 1e-8));
            // ∫₀¹ √(1+4t²) dt
            assert!(near(trace.length(), 1.478_942_857_544_597_4, 1e-10), "{}", trace.length());
            assert!(near(trace.samples[0].dkappa_ds.expect("planar"), 0.0, 1e-6));
        }
    }

    #[test]
    fn a_straight_line_has_no_torsion_and_a_point_no_tangent() {
        let line = shapes::polynomial([[0.0; 3], [1.0, 2.0, 3.0], [0.0; 3], [0.0; 3]]);
        let trace = Trace::new(&[line], 5);
        assert!(trace.samples.iter().all(|sample| sample.torsion.is_none() && sample.kappa * 4.0 < STRAIGHT));
        let point = Element { rows: [[1.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [1.0; 3]] };
        let trace = Trace::new(&[point], 3);
        assert_eq!(trace.length(), 0.0);
        assert!(trace.samples.iter().all(|sample| sample.tangent == [0.0; 3] && sample.kappa == 0.0));
    }
}
