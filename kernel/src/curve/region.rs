//! A region of a solved curve, to be computed anew while the rest stays as it is (thesis 4.4, local control).
//!
//! A sum over elements that meet in position, tangent and curvature is least as a whole only if every part of it is least
//! between its ends held as they are: a region whose joints did not move comes out as it was.

use super::element::Element;
use super::error::CurveError;
use super::joint::{Continuity, Curve, Joint, Quantity};
use super::measure::{self, CurvePoint};
use nalgebra::Vector3;

/// A curvature of which less than this part lies across the tangent is rounding.
const ACROSS: f64 = 1e-6;

impl Joint {
    /// A G2 joint held at a place of a curve, which [`measure`] finds: position, tangent and curvature fixed as they are
    /// there. A curve that starts or ends with it joins that curve with G2 continuity, to rounding.
    pub fn held_at(place: &CurvePoint) -> Self {
        let (tangent, found) = (Vector3::from(place.tangent), Vector3::from(place.curvature));
        // Of a curvature that is next to nothing rounding may leave a vector along the tangent.
        let across = found - tangent * found.dot(&tangent);
        let curvature = if across.amax() > ACROSS * found.amax() { across } else { Vector3::zeros() };
        Self::at(place.point)
            .with_tangent(Quantity::fixed(place.tangent))
            .with_curvature(Quantity::fixed(curvature.into()))
    }
}

/// A region of a solved curve: consecutive elements that are to be replaced. Its ends may be joints of the curve or any
/// other ends of elements.
///
/// [`Region::hold`] makes the region's joints an open curve that joins the rest. Whatever is done with a curve can be done
/// with it: [`super::solve()`] finds its elements from the data, [`super::update`] from the old elements, which suits
/// dragging. Inner joints may be moved, added and removed; if the number of elements stays, the new ones may be written
/// over the old ones. The rest is not touched, whatever the status is that the region ends with.
///
/// ```
/// use minvar::curve::{Curve, Element, Joint, Options, Region, solve, update};
/// use minvar::solve::Silent;
///
/// let points = [[0.0, 0.0], [1.0, 1.9], [2.0, 2.7], [3.0, 2.6], [4.0, 1.6], [5.0, 0.9], [6.0, 1.2]];
/// let joints = points.map(|[x, y]| Joint::at([x, y, 0.0]));
/// let (options, mut workspace) = (Options::DEFAULT, [0.0; 4096]);
/// let mut elements = [Element::ZERO; 6];
/// solve(&Curve::open(&joints), &options, &mut workspace, &mut elements, &mut [], &mut Silent)?;
///
/// // The joint between elements 2 and 3 moves; these two change and no others. Their outer ends are filled in.
/// let mut joints = [joints[2], Joint::at([3.0, 2.7, 0.0]), joints[4]];
/// let curve = Region { elements: &elements, closed: false, first: 2, count: 2 }.hold(&mut joints)?;
/// update(&curve, &options, &mut workspace, &mut elements[2..4], &mut [], &mut Silent)?;
/// # Ok::<(), minvar::curve::CurveError>(())
/// ```
///
/// The functional is the region's own. For MVC and MEC, with a tension or a bending term or without, a region of a
/// minimum whose joints did not move comes out as it was. Scale-invariant functionals and a given length look at the
/// region's length alone, and the space functionals leave its torsion free at both ends: these move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<'a> {
    /// The whole curve: its elements in order.
    pub elements: &'a [Element],
    /// Whether the curve returns from the last element to the first.
    pub closed: bool,
    /// The region's first element, from 0.
    pub first: usize,
    /// The number of its elements, 1 or more. Of a closed curve they may run past the last element into the first ones;
    /// such a curve may be rotated (`rotate_left`), so that they lie in one piece.
    pub count: usize,
}

impl Region<'_> {
    /// The elements of the rest next to the region's start and end; `None` where an open curve ends.
    ///
    /// # Errors
    /// [`CurveError::BadRegion`].
    fn neighbours(&self) -> Result<[Option<usize>; 2], CurveError> {
        let (first, count, elements) = (self.first, self.count, self.elements.len());
        let after = first.checked_add(count).filter(|&after| {
            count > 0 && first < elements && if self.closed { count <= elements } else { after <= elements }
        });
        let after = after.ok_or(CurveError::BadRegion { first, count, elements })?;
        Ok(if self.closed {
            [Some((first + elements - 1) % elements), Some(after % elements)]
        } else {
            [first.checked_sub(1), Some(after).filter(|&after| after < elements)]
        })
    }

    /// Holds the first and the last of the region's joints to the rest, and returns the open curve through the joints.
    ///
    /// What a joint's continuity makes common is fixed as the rest has it there: the position, to the last bit; of a G1
    /// joint the tangent too; of a G2 joint, which [`Joint::at`] gives, the curvature vector as well. What the continuity
    /// leaves independent stays as given, and so does a joint where an open curve ends: its own conditions hold.
    ///
    /// # Errors
    /// [`CurveError::BadRegion`], [`CurveError::TooFewJoints`], and [`CurveError::BadElement`] for an element of the rest
    /// that has no direction where the region joins it. `joints` is untouched then. All else about the joints is looked
    /// at by the solver.
    pub fn hold<'j>(&self, joints: &'j mut [Joint]) -> Result<Curve<'j>, CurveError> {
        let neighbours = self.neighbours()?;
        let given = joints.len();
        if given < 2 {
            return Err(CurveError::TooFewJoints { given });
        }
        let mut held = [joints[0], joints[given - 1]];
        for ((joint, element), end) in held.iter_mut().zip(neighbours).zip([1.0, 0.0]) {
            let Some(element) = element else { continue };
            let bad = CurveError::BadElement { element };
            let beside = self.elements.get(element).ok_or(bad)?;
            let place = measure::at(core::slice::from_ref(beside), 0, end).map_err(|_| bad)?;
            let there = Joint::held_at(&place);
            joint.position = there.position;
            if joint.continuity != Continuity::G0 {
                joint.tangent = there.tangent;
            }
            if joint.continuity == Continuity::G2 {
                joint.curvature = there.curvature;
            }
        }
        [joints[0], joints[given - 1]] = held;
        Ok(Curve::open(joints))
    }
}
