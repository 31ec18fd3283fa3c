//! Where the computation takes place: a local system in which the data have a size near one, and only two
//! coordinates where they lie in a plane.
//!
//! Moving the origin to the data keeps digits far from the caller's origin; the scale is a power of two, so it
//! costs none.

use super::check::direction;
use super::element::Element;
use super::error::CurveError;
use super::joint::{Curve, Given, Joint};
use crate::order::Order;
use crate::root::sqrt;
use crate::total::Total;
use nalgebra::{SVector, Vector3};

#[cfg(test)]
mod tests;

/// A local orthonormal system of `D` axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement<const D: usize> {
    origin: Vector3<f64>,
    axes: [Vector3<f64>; D],
    /// The local unit of length in the caller's; a power of two.
    pub(super) unit: f64,
}

impl<const D: usize> Placement<D> {
    pub(super) fn local_point(&self, point: &[f64; 3]) -> SVector<f64, D> {
        let offset = Vector3::from(*point) - self.origin;
        SVector::from_fn(|d, _| self.axes[d].dot(&offset) / self.unit)
    }

    /// A direction, made a unit vector.
    pub(super) fn local_direction(&self, vector: &[f64; 3]) -> SVector<f64, D> {
        let Some(towards) = direction(vector) else { return SVector::zeros() };
        let local = SVector::<f64, D>::from_fn(|d, _| self.axes[d].dot(&towards));
        local / sqrt(local.dot(&local))
    }

    pub(super) fn local_curvature(&self, vector: &[f64; 3]) -> SVector<f64, D> {
        let vector = Vector3::from(*vector);
        SVector::from_fn(|d, _| self.axes[d].dot(&vector) * self.unit)
    }

    pub(super) fn local_length(&self, length: f64) -> f64 {
        length / self.unit
    }

    /// The size of a curvature vector.
    pub(super) fn local_size(&self, value: &[f64; 3]) -> f64 {
        let vector = Vector3::from(*value);
        sqrt(vector.dot(&vector)) * self.unit
    }

    /// A parametric derivative, or a point of which only differences count: the local origin does not enter.
    pub(super) fn local_vector(&self, vector: &[f64; 3]) -> SVector<f64, D> {
        let vector = Vector3::from(*vector);
        SVector::from_fn(|d, _| self.axes[d].dot(&vector) / self.unit)
    }

    /// The rows of an element.
    pub(super) fn local_rows(&self, element: &Element) -> [SVector<f64, D>; 6] {
        let [p0, v0, a0, a1, v1, p1] = &element.rows;
        let [v0, a0, a1, v1] = [v0, a0, a1, v1].map(|row| self.local_vector(row));
        [self.local_point(p0), v0, a0, a1, v1, self.local_point(p1)]
    }

    /// The `k`-th direction, a unit vector, in which a joint slides; `None` where there is no such direction, or where a
    /// joint in a plane that holds a planar curve is free.
    pub(super) fn slide(&self, joint: &Joint, k: usize) -> Option<SVector<f64, D>> {
        let guide = direction(&joint.guide)?;
        let local = SVector::<f64, D>::from_fn(|d, _| self.axes[d].dot(&guide));
        let size = sqrt(local.dot(&local));
        if joint.position.given == Given::ON_LINE {
            return (k == 0 && size > 0.0).then(|| local / size);
        }
        if D == 2 {
            // The line in which the joint's plane and the curve's meet.
            if k > 0 || size < FLATNESS {
                return None;
            }
            let mut along = local / size;
            let first = along[0];
            along[0] = -along[1];
            along[1] = first;
            return Some(along);
        }
        let least = (0..D).fold(0, |least, d| if guide[d].abs() < guide[least].abs() { d } else { least });
        let mut across = Vector3::zeros();
        across[least] = 1.0;
        let first = guide.cross(&across);
        let first = first / sqrt(first.dot(&first));
        let found = if k == 0 { first } else { guide.cross(&first) };
        Some(SVector::from_fn(|d, _| self.axes[d].dot(&found)))
    }

    pub(super) fn world_point(&self, local: &SVector<f64, D>) -> [f64; 3] {
        let offset = self.world_vector(local);
        core::array::from_fn(|d| self.origin[d] + offset[d])
    }

    /// A parametric derivative: a vector that scales with the lengths.
    pub(super) fn world_vector(&self, local: &SVector<f64, D>) -> [f64; 3] {
        let mut sum = Vector3::zeros();
        for d in 0..D {
            sum += self.axes[d] * (local[d] * self.unit);
        }
        sum.into()
    }
}

/// The place of a curve: in a plane or in space.
pub(super) enum Place {
    Plane(Placement<2>),
    Space(Placement<3>),
}

impl Place {
    /// Finds the place of a checked curve. `dimension` as in [`super::Options::dimension`].
    pub(super) fn of(curve: &Curve<'_>, unit: f64, dimension: u32) -> Result<Self, CurveError> {
        let origin = curve
            .joints
            .iter()
            .find(|joint| joint.position.given != Given::FREE)
            .map_or(Vector3::zeros(), |joint| Vector3::from(joint.position.value));
        if dimension != 3
            && let Some(axes) = plane_axes(curve, &origin)
        {
            return Ok(Self::Plane(Placement { origin, axes, unit }));
        }
        if dimension == 2 {
            return Err(CurveError::NotPlanar);
        }
        Ok(Self::Space(Placement { origin, axes: [Vector3::x(), Vector3::y(), Vector3::z()], unit }))
    }
}

/// Calls `visit` with every given vector relative to the origin: offsets of points with their rounding error, unit
/// tangents, and directions of curvature. A curvature that is next to nothing over the data's extent has no direction but
/// rounding: it counts as much as it bends.
fn vectors(curve: &Curve<'_>, origin: &Vector3<f64>, extent: f64, mut visit: impl FnMut(Vector3<f64>, f64)) {
    for obstacle in curve.obstacles {
        for point in [&obstacle.from, &obstacle.to] {
            let point = Vector3::from(*point);
            visit(point - origin, 4.0 * f64::EPSILON * (point.amax() + origin.amax()));
        }
    }
    for joint in curve.joints {
        if joint.position.given != Given::FREE {
            let point = Vector3::from(joint.position.value);
            visit(point - origin, 4.0 * f64::EPSILON * (point.amax() + origin.amax()));
        }
        if joint.position.given == Given::ON_LINE
            && let Some(along) = direction(&joint.guide)
        {
            visit(along, 0.0);
        }
        for quantity in &joint.tangent {
            if quantity.given != Given::FREE
                && let Some(towards) = direction(&quantity.value)
            {
                visit(towards, 0.0);
            }
        }
        for quantity in &joint.curvature {
            if !matches!(quantity.given, Given::FREE | Given::SIZE)
                && let Some(towards) = direction(&quantity.value)
            {
                let bend = Vector3::from(quantity.value).amax() * extent;
                visit(towards * bend.smaller(1.0), 0.0);
            }
        }
    }
}

/// How far from a plane data may lie that count as planar, as a fraction of their extent.
const FLATNESS: f64 = 1e-12;

/// Two axes that span a plane in which all data lie, right-handed about +z, +x or +y where it is one of the
/// coordinate planes.
fn plane_axes(curve: &Curve<'_>, origin: &Vector3<f64>) -> Option<[Vector3<f64>; 2]> {
    for (across, axes) in [
        (2, [Vector3::x(), Vector3::y()]),
        (0, [Vector3::y(), Vector3::z()]),
        (1, [Vector3::z(), Vector3::x()]),
    ] {
        let mut flat = true;
        vectors(curve, origin, f64::INFINITY, |vector, _| flat &= vector.as_slice().at(across) == 0.0);
        if flat {
            return Some(axes);
        }
    }
    // The longest offset is one axis; the vector farthest from it shows the other.
    let mut first = Vector3::zeros();
    vectors(curve, origin, f64::INFINITY, |vector, error| {
        if error > 0.0 && vector.dot(&vector) > first.dot(&first) {
            first = vector;
        }
    });
    let extent = sqrt(first.dot(&first));
    let first = first / extent;
    let mut second = Vector3::zeros();
    vectors(curve, origin, extent, |vector, error| {
        let vector = if error > 0.0 { vector / extent } else { vector };
        let off = vector - first * first.dot(&vector);
        if off.dot(&off) > second.dot(&second) {
            second = off;
        }
    });
    let width = sqrt(second.dot(&second));
    if width <= FLATNESS {
        // All on one line: any plane that holds it serves.
        let least = (0..3).fold(0, |least, d| if first[d].abs() < first[least].abs() { d } else { least });
        let unit = Vector3::from_fn(|d, _| if d == least { 1.0 } else { 0.0 });
        second = unit - first * first.dot(&unit);
    }
    let second = second / sqrt(second.dot(&second));
    // What is left of a short vector leans back by its rounding: once more.
    let second = second - first * first.dot(&second);
    let second = second / sqrt(second.dot(&second));
    let normal = first.cross(&second);
    let mut flat = true;
    vectors(curve, origin, extent, |vector, error| {
        // A plane that leans by the rounding of its points would turn directions that are given exactly: space keeps them.
        let allowed = if error > 0.0 { error + FLATNESS * extent } else { FLATNESS };
        flat &= normal.dot(&vector).abs() <= allowed;
    });
    // Right-handed about the normal that points along the positive side of its largest coordinate.
    let largest = (0..3).fold(0, |most, d| if normal[d].abs() > normal[most].abs() { d } else { most });
    let second = if normal[largest] < 0.0 { -second } else { second };
    flat.then_some([first, second])
}
