//! Elements in the forms that other programs read: Bézier control points, one B-spline.

use super::element::Element;
use super::measure::{MeasureError, check};
use crate::root::sqrt;
use crate::total::Total;
use nalgebra::Vector3;

/// Neighbouring elements whose tangents differ by less than this angle (radians) are joined smoothly in a B-spline.
const SMOOTH: f64 = 1e-9;

/// Whether a chain goes on with the same tangent direction after an element.
fn smooth_after(elements: &[Element], element: usize) -> bool {
    let (Some(here), Some(next)) = (elements.get(element), elements.get(element + 1)) else { return false };
    let (a, b) = (Vector3::from(here.rows[4]), Vector3::from(next.rows[1]));
    let (a, b) = (a / a.amax(), b / b.amax());
    let cross = a.cross(&b);
    here.rows[5] == next.rows[0]
        && a.dot(&b) > 0.0
        && cross.dot(&cross) <= SMOOTH * SMOOTH * a.dot(&a) * b.dot(&b)
}

/// The numbers of control points and of knots of a chain's B-spline.
pub fn bspline_len(elements: &[Element]) -> (usize, usize) {
    let count = elements.len();
    let smooth = (0..count.saturating_sub(1)).filter(|&element| smooth_after(elements, element)).count();
    let controls = if count == 0 { 0 } else { 5 * count + 1 - smooth };
    (controls, if count == 0 { 0 } else { controls + 6 })
}

/// The whole chain as one non-rational B-spline of degree 5, the same curve point by point.
///
/// The knots start at 0 and end at 1, six-fold each; an interior joint has a four-fold knot where the tangent is
/// continuous (the spline is C1 there, and G2 if the chain is) and a five-fold one at a corner. The knot intervals
/// follow the speeds of the elements, so that the spline's speed is continuous. A closed chain gives a spline whose
/// ends meet. `controls` and `knots` receive what [`bspline_len`] says, `controls.len() + 6` knots to so many control
/// points.
///
/// # Errors
/// [`MeasureError::NoElements`], [`MeasureError::NotFinite`], [`MeasureError::Irregular`] where an element starts or
/// ends without speed, or with so much less than its neighbour that two knots coincide, [`MeasureError::TooShort`].
pub fn bspline(
    elements: &[Element],
    controls: &mut [[f64; 3]],
    knots: &mut [f64],
) -> Result<(), MeasureError> {
    check(elements)?;
    let (control_count, knot_count) = bspline_len(elements);
    for (needed, given) in [(control_count, controls.len()), (knot_count, knots.len())] {
        if given < needed {
            return Err(MeasureError::TooShort { needed, given });
        }
    }
    let speed = |element: usize, row: usize| {
        let rows = elements.get(element).map_or([[0.0; 3]; 6], |element| element.rows);
        let vector = Vector3::from(rows.at(row));
        let most = vector.amax();
        if most > 0.0 {
            let vector = vector / most;
            Ok(most * sqrt(vector.dot(&vector)))
        } else {
            Err(MeasureError::Irregular { element })
        }
    };
    // The interval of an element relative to the first's: speed over interval is the same on both sides of a joint.
    let after = |interval: f64, element: usize| Ok(interval * (speed(element, 1)? / speed(element - 1, 4)?));
    let mut interval = 1.0;
    let mut total = 1.0;
    for element in 1..elements.len() {
        interval = after(interval, element)?;
        total += interval;
    }
    // Speeds that differ beyond measure put two joints at one knot.
    let (mut interval, mut sum, mut before) = (1.0, 0.0, 0.0);
    for element in 1..elements.len() {
        sum += interval;
        let knot = sum / total;
        if !(before < knot && knot < 1.0) {
            return Err(MeasureError::Irregular { element });
        }
        before = knot;
        interval = after(interval, element)?;
    }
    let mut control_at = 0;
    let mut knot_at = 0;
    let mut put_knots = |value: f64, times: usize| {
        for _ in 0..times {
            knots.put(knot_at, value);
            knot_at += 1;
        }
    };
    put_knots(0.0, 6);
    let (mut interval, mut sum) = (1.0, 0.0);
    for (index, element) in elements.iter().enumerate() {
        if index > 0 {
            interval = after(interval, index)?;
        }
        sum += interval;
        let bezier = element.bezier();
        let from = usize::from(index > 0);
        let to = if smooth_after(elements, index) { 5 } else { 6 };
        for point in &bezier[from..to] {
            controls.put(control_at, *point);
            control_at += 1;
        }
        let last = index + 1 == elements.len();
        let times = if last { 6 } else { 4 + to - 5 };
        put_knots(if last { 1.0 } else { sum / total }, times);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However long the tangents are, and wherever they point.
    #[test]
    fn a_joint_is_smooth_where_tangents_differ_by_next_to_nothing() {
        let directions: [[f64; 3]; 4] =
            [[1.0, 1.0, 1.0], [0.0, -2.0, 0.0], [3.0, -1.0, 0.5], [-1.0, 1.0, -1.0]];
        for direction in directions {
            let along = Vector3::from(direction);
            let along = along / sqrt(along.dot(&along));
            let across = along.cross(&Vector3::new(0.6, 0.64, 0.48));
            let across = across / sqrt(across.dot(&across));
            for (size, other) in [(1.0, 1.0), (1e-200, 1e200), (1e6, 0.3)] {
                for (angle, smooth) in
                    [(0.0, true), (0.95e-9, true), (-0.95e-9, true), (1.05e-9, false), (0.1, false)]
                {
                    let mut chain = [Element::ZERO; 2];
                    chain[0].rows[4] = (along * size).into();
                    chain[1].rows[1] = ((along + across * angle) * other).into();
                    assert_eq!(smooth_after(&chain, 0), smooth, "{direction:?} {size} {angle}");
                    chain[1].rows[1] = ((along + across * angle) * -other).into();
                    assert!(!smooth_after(&chain, 0), "it turns back");
                    chain[1].rows[1] = chain[0].rows[4];
                    chain[1].rows[0] = [0.0, 0.0, 1e-300];
                    assert!(!smooth_after(&chain, 0), "there is a gap");
                }
            }
        }
        assert!(!smooth_after(&[Element::ZERO; 1], 0));
    }
}
