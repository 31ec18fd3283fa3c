//! Measuring a chain of elements: what holds at a point, and what holds for the whole.
//!
//! A place on a chain is an element's number and a parameter `t` in [0, 1]. Curvature vectors point to the centre of
//! curvature. The *signed* curvature is that about a normal: positive where the curve bends to the left seen from the
//! normal's tip. [`plane_normal`] finds the normal of a planar chain; for a space curve there is none, and the
//! curvature's size takes the place of the signed one.
//!
//! Every element is brought to a size near one by a power of two before it is measured, so lengths from 1e-90 to
//! 1e90 give the same digits.

mod place;
mod whole;

pub use place::{at, at_length, closest};
pub use whole::{bending, bounding_box, curvature_range, length, variation};

use super::element::Element;
use super::rows;
use crate::basis::bernstein::Bernstein;
use crate::basis::hermite;
use crate::basis::quadrature::FINEST;
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;
use core::fmt;
use nalgebra::Vector3;

/// Why a chain cannot be measured. Elements are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureError {
    /// There are no elements.
    NoElements,
    /// A row of an element is NaN, infinite or beyond 1e100.
    NotFinite {
        /// The element.
        element: usize,
    },
    /// `|C'|` vanishes at the place: there is no tangent and no curvature.
    Irregular {
        /// The element.
        element: usize,
    },
    /// There is no such element, or the parameter or arc length is not a number.
    OutOfRange,
    /// A slice for results is too short.
    TooShort {
        /// The length that is needed.
        needed: usize,
        /// The length that was given.
        given: usize,
    },
}

impl fmt::Display for MeasureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoElements => f.write_str("there are no elements to measure"),
            Self::NotFinite { element } => {
                write!(f, "element {element} has a number that is NaN, infinite or beyond 1e100")
            }
            Self::Irregular { element } => {
                write!(f, "element {element} has no tangent there: its first derivative vanishes")
            }
            Self::OutOfRange => f.write_str("the place is not on the curve"),
            Self::TooShort { needed, given } => {
                write!(f, "the result needs room for {needed} entries; {given} given")
            }
        }
    }
}

impl core::error::Error for MeasureError {}

/// What holds at a place of a curve, all in the caller's units.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The element.
    pub element: usize,
    /// The parameter in it, 0 to 1.
    pub parameter: f64,
    /// The arc length from the start of the chain.
    pub arc_length: f64,
    /// The position.
    pub point: [f64; 3],
    /// The unit tangent.
    pub tangent: [f64; 3],
    /// The curvature vector, perpendicular to the tangent; 1/length.
    pub curvature: [f64; 3],
    /// The signed curvature of a planar chain, the curvature's size of any other; 1/length.
    pub signed_curvature: f64,
    /// The derivative of `signed_curvature` by arc length; 1/length².
    pub curvature_derivative: f64,
    /// The torsion, positive for a right-handed helix (the opposite of thesis (2.8)); 0 where the curvature vanishes;
    /// 1/length.
    pub torsion: f64,
}

/// The least exponent of an element's unit: what is divided by it, and its square, are numbers still.
const LEAST_EXPONENT: i32 = -500;

/// A power of two near the largest derivative of an element, or larger if that is next to nothing; 0 if all rows are.
fn size_of(element: &Element) -> f64 {
    let mut most = 0.0f64;
    for row in &element.rows[1..5] {
        for x in row {
            most = most.larger(x.abs());
        }
    }
    for (a, b) in element.rows[0].iter().zip(&element.rows[5]) {
        most = most.larger((a - b).abs());
    }
    if !(most > 0.0 && most.is_finite()) {
        return most;
    }
    let (_, exponent) = libm::frexp(most);
    libm::scalbn(1.0, exponent.max(LEAST_EXPONENT))
}

/// The rows of an element relative to its first point, in a unit in which they are near one, and that unit.
fn normalised(element: &Element) -> ([Vector3<f64>; 6], f64) {
    let unit = size_of(element);
    let by = if unit > 0.0 { 1.0 / unit } else { 1.0 };
    let origin = element.rows[0];
    let mut rows = element.rows.map(|row| Vector3::from(row.map(|x| x * by)));
    for row in [0, 5] {
        rows[row] = Vector3::from_fn(|d, _| (element.rows[row][d] - origin[d]) * by);
    }
    (rows, if unit > 0.0 { unit } else { 1.0 })
}

/// `C', C'', C'''` at a parameter.
fn derivatives(rows: &[Vector3<f64>; 6], t: f64) -> [Vector3<f64>; 3] {
    rows::derivatives(rows, &hermite::basis(t))
}

/// Numbers beyond this overflow when they are multiplied.
const LARGEST: f64 = 1e100;

/// Checks that there are elements and that their numbers are finite, and not beyond 1e100.
///
/// # Errors
/// [`MeasureError::NoElements`], [`MeasureError::NotFinite`].
pub fn check(elements: &[Element]) -> Result<(), MeasureError> {
    if elements.is_empty() {
        return Err(MeasureError::NoElements);
    }
    for (element, data) in elements.iter().enumerate() {
        if data.rows.iter().flatten().any(|x| !(x.abs() <= LARGEST)) {
            return Err(MeasureError::NotFinite { element });
        }
    }
    Ok(())
}

/// The unit normal of the plane in which a chain lies, to 1e-9 of its extent: +z, +x or +y for a plane parallel to a
/// coordinate plane, else with its largest coordinate positive. `None` for a space curve. A straight chain lies in
/// many planes; one is taken.
pub fn plane_normal(elements: &[Element]) -> Option<[f64; 3]> {
    let first = elements.first()?;
    let origin = Vector3::from(first.rows[0]);
    // Every vector that must lie in the plane, each with the size against which it is small.
    let vectors = || {
        elements.iter().flat_map(|element| element.rows.iter().enumerate()).map(|(a, row)| {
            let row = Vector3::from(*row);
            if a == 0 || a == 5 { row - origin } else { row }
        })
    };
    for (across, normal) in [(2, [0.0, 0.0, 1.0]), (0, [1.0, 0.0, 0.0]), (1, [0.0, 1.0, 0.0])] {
        if vectors().all(|vector| vector.as_slice().at(across) == 0.0) {
            return Some(normal);
        }
    }
    let mut extent = 0.0f64;
    let mut longest = Vector3::zeros();
    for vector in vectors() {
        if vector.amax() > extent {
            extent = vector.amax();
            longest = vector;
        }
    }
    let along = longest / extent;
    let along = along / sqrt(along.dot(&along));
    let mut off = Vector3::zeros();
    for vector in vectors() {
        let vector = vector / extent;
        let beside = vector - along * vector.dot(&along);
        if beside.amax() > off.amax() {
            off = beside;
        }
    }
    if !(off.amax() > PLANAR) {
        let least = (0..3).fold(0, |least, d| if along[d].abs() < along[least].abs() { d } else { least });
        off = Vector3::from_fn(|d, _| if d == least { 1.0 } else { 0.0 });
        off -= along * along.as_slice().at(least);
    }
    let normal = along.cross(&off);
    let mut normal = normal / sqrt(normal.dot(&normal));
    let largest = (0..3).fold(0, |most, d| if normal[d].abs() > normal[most].abs() { d } else { most });
    if normal[largest] < 0.0 {
        normal = -normal;
    }
    vectors().all(|vector| (vector / extent).dot(&normal).abs() <= PLANAR).then_some(normal.into())
}

/// How far from a plane a chain may lie that counts as planar, as a fraction of its extent.
const PLANAR: f64 = 1e-9;

fn part_length(rows: &[Vector3<f64>; 6], to: f64) -> f64 {
    let mut sum = 0.0;
    for (t, weight) in FINEST.iter() {
        let first = derivatives(rows, t * to)[0];
        sum += weight * to * sqrt(first.dot(&first));
    }
    sum
}

/// What holds at parameter `t`, 0 to 1, of an element, its arc length apart. `normal` as [`plane_normal`] gives it.
fn properties(
    elements: &[Element],
    element: usize,
    t: f64,
    normal: Option<[f64; 3]>,
) -> Result<CurvePoint, MeasureError> {
    let data = elements.get(element).ok_or(MeasureError::OutOfRange)?;
    if !(0.0..=1.0).contains(&t) {
        return Err(MeasureError::OutOfRange);
    }
    let (rows, unit) = normalised(data);
    let [d1, d2, d3] = derivatives(&rows, t);
    let p = d1.dot(&d1);
    if !(p > 1e-28) {
        return Err(MeasureError::Irregular { element });
    }
    let speed = sqrt(p);
    let q = d1.dot(&d2);
    let (u, v) = (d1.cross(&d2), d1.cross(&d3));
    let tangent = d1 / speed;
    let curvature = (d2 - d1 * (q / p)) / p;
    let binormal = u / (p * speed);
    let numerator = v * p - u * (3.0 * q);
    let size = sqrt(binormal.dot(&binormal));
    // The derivative of the binormal curvature vector by arc length.
    let slope = numerator / (p * p * p);
    let (signed, derivative) = match normal {
        Some(normal) => {
            let normal = Vector3::from(normal);
            (binormal.dot(&normal), slope.dot(&normal))
        }
        None => (size, if size > 0.0 { slope.dot(&binormal) / size } else { 0.0 }),
    };
    let torsion = if u.dot(&u) > 0.0 { u.dot(&d3) / u.dot(&u) } else { 0.0 };
    Ok(CurvePoint {
        element,
        parameter: t,
        arc_length: 0.0,
        point: data.point(t),
        tangent: tangent.into(),
        curvature: (curvature / unit).into(),
        signed_curvature: signed / unit,
        curvature_derivative: derivative / unit / unit,
        torsion: torsion / unit,
    })
}

/// A coordinate of an element's derivative of an order from 1 to 3 as a polynomial.
fn derivative_polynomial(bezier: &[Vector3<f64>; 6], order: usize, d: usize) -> Bernstein {
    let mut polynomial = Bernstein::new(bezier.map(|point| point[d]));
    for _ in 0..order {
        polynomial = polynomial.derivative();
    }
    polynomial
}

fn dot(a: &[Bernstein; 3], b: &[Bernstein; 3]) -> Bernstein {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
