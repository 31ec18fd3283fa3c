//! Whether a curve's data make sense, before any work.

use super::element::Element;
use super::error::{CurveError, Part};
use super::joint::{Continuity, Curve, Given, Joint, Quantity};
use super::obstacle::Side;
use super::options::Options;
use crate::order::Order;
use crate::root::sqrt;
use nalgebra::Vector3;

/// Below this fraction of the data's extent two points are the same, and a circle of such a radius is a point.
const COINCIDENT: f64 = 1e-12;
/// The largest distance from the first joint: beyond it products overflow.
const LARGEST_EXTENT: f64 = 1e100;
/// How far a curvature may lean towards its tangent, as a fraction of its length.
const PERPENDICULAR: f64 = 1e-6;

fn check_quantity(joint: usize, part: Part, quantity: &Quantity) -> Result<(), CurveError> {
    let known = match quantity.given {
        Given::FREE | Given::INITIAL | Given::FIXED => true,
        Given::ON_LINE | Given::ON_PLANE => part == Part::Position,
        Given::SIZE => part == Part::Curvature,
        _ => false,
    };
    if !known {
        return Err(CurveError::UnknownCode { joint, part });
    }
    if quantity.given != Given::FREE && quantity.value.iter().any(|x| !x.is_finite()) {
        return Err(CurveError::NotFinite { joint, part });
    }
    Ok(())
}

/// The direction of a vector of any size but zero.
pub(super) fn direction(vector: &[f64; 3]) -> Option<Vector3<f64>> {
    let most = vector.iter().fold(0.0f64, |most, x| most.larger(x.abs()));
    if !(most > 0.0) {
        return None;
    }
    let scaled = Vector3::from(vector.map(|x| x / most));
    Some(scaled / sqrt(scaled.dot(&scaled)))
}

fn check_joint(joint: usize, data: &Joint) -> Result<(), CurveError> {
    if data.continuity.0 > Continuity::G2.0 {
        return Err(CurveError::UnknownCode { joint, part: Part::Continuity });
    }
    check_quantity(joint, Part::Position, &data.position)?;
    if matches!(data.position.given, Given::ON_LINE | Given::ON_PLANE) {
        if data.guide.iter().any(|x| !x.is_finite()) {
            return Err(CurveError::NotFinite { joint, part: Part::Guide });
        }
        if direction(&data.guide).is_none() {
            return Err(CurveError::ZeroGuide { joint });
        }
    }
    for side in 0..2 {
        let (tangent, curvature) = (&data.tangent[side], &data.curvature[side]);
        check_quantity(joint, Part::Tangent, tangent)?;
        check_quantity(joint, Part::Curvature, curvature)?;
        let towards = if tangent.given == Given::FREE {
            None
        } else {
            Some(direction(&tangent.value).ok_or(CurveError::ZeroTangent { joint })?)
        };
        let directed = matches!(curvature.given, Given::INITIAL | Given::FIXED);
        if let (Some(towards), true) = (towards, directed)
            && let Some(across) = direction(&curvature.value)
            && across.dot(&towards).abs() > PERPENDICULAR
        {
            return Err(CurveError::CurvatureNotPerpendicular { joint });
        }
    }
    let differ = |sides: &[Quantity; 2]| {
        sides[0].given != sides[1].given
            || (sides[0].given != Given::FREE && sides[0].value != sides[1].value)
    };
    if data.continuity != Continuity::G0 && differ(&data.tangent) {
        return Err(CurveError::SidesDiffer { joint, part: Part::Tangent });
    }
    if data.continuity == Continuity::G2 && differ(&data.curvature) {
        return Err(CurveError::SidesDiffer { joint, part: Part::Curvature });
    }
    Ok(())
}

/// Checks everything but the plane; returns a power of two near the longest step between given neighbours.
pub(super) fn check(curve: &Curve<'_>) -> Result<f64, CurveError> {
    let given = curve.joints.len();
    if curve.closed && given < 3 {
        return Err(CurveError::ClosedTooFewJoints { given });
    }
    if given < 2 {
        return Err(CurveError::TooFewJoints { given });
    }
    for (joint, data) in curve.joints.iter().enumerate() {
        check_joint(joint, data)?;
    }
    let points = || curve.joints.iter().enumerate().filter(|(_, joint)| joint.position.given != Given::FREE);
    let Some((_, first)) = points().next() else { return Err(CurveError::NoPosition) };
    if points().count() < 2 {
        return Err(CurveError::NoPosition);
    }
    let mut extent = 0.0f64;
    for (_, joint) in points() {
        for (a, b) in joint.position.value.iter().zip(&first.position.value) {
            extent = extent.larger((a - b).abs());
        }
    }
    if !(extent <= LARGEST_EXTENT) {
        return Err(CurveError::SizeOutOfRange);
    }
    // Neighbours, a free joint between them counting as none: free joints stand evenly between given ones.
    let mut longest = 0.0f64;
    let mut before: Option<(usize, [f64; 3])> = None;
    let wrapped = points().next().filter(|_| curve.closed);
    for (joint, data) in points().chain(wrapped) {
        let here = data.position.value;
        if let Some((previous, there)) = before {
            let step = here.iter().zip(&there).fold(0.0f64, |most, (a, b)| most.larger((a - b).abs()));
            if !(step > COINCIDENT * extent) {
                return Err(CurveError::CoincidentJoints { joint: previous, next: joint });
            }
            longest = longest.larger(step);
        }
        before = Some((joint, here));
    }
    let curvatures = curve.joints.iter().flat_map(|joint| &joint.curvature);
    let given =
        curvatures.filter(|curvature| curvature.given != Given::FREE).flat_map(|curvature| curvature.value);
    let sharpest = given.fold(0.0f64, |most, x| most.larger(x.abs()));
    if !(1e-90..=1e90).contains(&longest) || sharpest * longest > 1.0 / COINCIDENT {
        return Err(CurveError::SizeOutOfRange);
    }
    let (_, exponent) = libm::frexp(longest);
    Ok(libm::scalbn(1.0, exponent))
}

/// Whether elements can be a start or a reference: finite, with a direction at either end.
pub(super) fn check_elements(elements: &[Element]) -> Result<(), CurveError> {
    for (element, Element { rows }) in elements.iter().enumerate() {
        let good = rows.iter().flatten().all(|x| x.abs() <= LARGEST_EXTENT)
            && direction(&rows[1]).is_some()
            && direction(&rows[4]).is_some();
        if !good {
            return Err(CurveError::BadElement { element });
        }
    }
    Ok(())
}

/// Whether a length that is asked for (0 if none is) can be met: it must be greater than the polygon's through the fixed
/// joints.
pub(super) fn check_length(curve: &Curve<'_>, length: f64) -> Result<(), CurveError> {
    if length == 0.0 {
        return Ok(());
    }
    let mut fixed = curve.joints.iter().filter(|joint| joint.position.given == Given::FIXED);
    let Some(first) = fixed.next() else { return Ok(()) };
    let (mut sum, mut last) = (0.0, Vector3::from(first.position.value));
    let back = if curve.closed { Some(first) } else { None };
    for joint in fixed.chain(back) {
        let here = Vector3::from(joint.position.value);
        let step = here - last;
        sum += sqrt(step.dot(&step));
        last = here;
    }
    if length > sum { Ok(()) } else { Err(CurveError::LengthTooShort) }
}

/// Whether obstacles make sense.
pub(super) fn check_obstacles(curve: &Curve<'_>, options: &Options) -> Result<(), CurveError> {
    for (index, obstacle) in curve.obstacles.iter().enumerate() {
        let finite = obstacle.from.iter().chain(&obstacle.to).all(|x| x.abs() <= LARGEST_EXTENT);
        let clear = obstacle.clearance >= 0.0 && obstacle.clearance <= LARGEST_EXTENT;
        if !(finite && clear && obstacle.side.0 <= Side::RIGHT.0) {
            return Err(CurveError::BadObstacle { obstacle: index });
        }
    }
    let alone = options.tolerance == 0.0 && options.length == 0.0 && curve.reference.is_none();
    if curve.obstacles.is_empty() || alone { Ok(()) } else { Err(CurveError::ObstaclesNotPossible) }
}
