//! Where the joints stand among the elements. With a tolerance or obstacles each span has as many as it needs, and the
//! kernel does not say which are whose: a fixed joint is known by its point, the others by what is known of them.

use super::Options;
use crate::constraints::{Given, NamedJoint, Specification};
use crate::trace::{Vector, add, dot, norm, scale};
use minvar::curve::{Element, measure};

/// More comparisons of joints with elements than this are not made for a picture.
const MOST_COMPARISONS: usize = 4_000_000;
/// What an uneven division counts beside what is known of a joint.
const EVEN: f64 = 1e-6;

/// The element that begins at each joint; the number of elements at the end of an open curve.
pub(super) fn starts(specification: &Specification, elements: &[Element], options: &Options) -> Vec<usize> {
    let (joints, count) = (&specification.joints, elements.len());
    let spans = if specification.closed { joints.len() } else { joints.len() - 1 };
    if count <= spans || count == spans * options.elements_per_span as usize {
        return (0..joints.len()).map(|joint| joint * count / spans.max(1)).collect();
    }
    let mut starts = vec![0];
    for (index, joint) in joints.iter().enumerate().skip(1) {
        let between = index - starts.len();
        let first = starts.last().map_or(0, |last| last + between + 1);
        let here = match joint.position {
            _ if index == spans => Some(count),
            Given::Fixed(point) => (first..count).find(|&element| elements[element].rows[0] == point),
            _ => None,
        };
        if let Some(here) = here {
            fill(&mut starts, &joints[index - between..index], elements, here);
            starts.push(here);
        }
    }
    let rest = starts.len();
    fill(&mut starts, &joints[rest..], elements, count);
    starts
}

/// Adds the starts of joints whose points are not known, between the last and the element `end`: where they fit best.
fn fill(starts: &mut Vec<usize>, joints: &[NamedJoint], elements: &[Element], end: usize) {
    let first = starts.last().map_or(0, |last| last + 1);
    // As many places as leave every joint one.
    let (most, choices) = (joints.len(), (end + 1).saturating_sub(first + joints.len()));
    if most == 0 {
        return;
    }
    let even = |index: usize| (index + 1) * choices / (most + 1);
    if choices == 0 || most.saturating_mul(choices) > MOST_COMPARISONS {
        starts.extend((0..most).map(|index| first + index + even(index)));
        return;
    }
    let size = elements[first - 1..end]
        .iter()
        .map(|element| norm(add(element.rows[5], -1.0, element.rows[0])))
        .sum::<f64>();
    // The joint of an index at its `choice` is at element `first + index + choice`; choices do not fall.
    let mut best = vec![0.0; choices];
    let mut chosen = vec![0; most * choices];
    for (index, joint) in joints.iter().enumerate() {
        let (mut least, mut at) = (f64::INFINITY, 0);
        for choice in 0..choices {
            if best[choice] < least {
                (least, at) = (best[choice], choice);
            }
            chosen[index * choices + choice] = at;
            let uneven = choice.abs_diff(even(index)) as f64 / choices as f64;
            best[choice] = least + misfit(joint, elements, first + index + choice, size) + EVEN * uneven;
        }
    }
    let mut choice = (0..choices).fold(0, |low, choice| if best[choice] < best[low] { choice } else { low });
    let from = starts.len();
    for index in (0..most).rev() {
        starts.push(first + index + choice);
        choice = chosen[index * choices + choice];
    }
    starts[from..].reverse();
}

/// How badly the start of an element is the joint's: 0 where it meets all that is known.
fn misfit(joint: &NamedJoint, elements: &[Element], element: usize, size: f64) -> f64 {
    let Ok(here) = measure::at(&elements[element..=element], 0, 0.0) else { return 1.0 };
    let unit = |v: Vector| scale(1.0 / norm(v), v);
    let off = |from: Vector| add(here.point, -1.0, from);
    let mut sum = match joint.position {
        Given::OnLine(from, along) => {
            let along = unit(along);
            norm(add(off(from), -dot(off(from), along), along)) / size
        }
        Given::OnPlane(from, normal) => dot(off(from), unit(normal)).abs() / size,
        _ => 0.0,
    };
    if let Given::Fixed(tangent) = joint.tangent[1] {
        sum += norm(add(here.tangent, -1.0, unit(tangent)));
    }
    if let Given::Fixed(curvature) | Given::Size(curvature) = joint.curvature[1] {
        sum += (norm(here.curvature) - norm(curvature)).abs() * size;
    }
    if sum.is_finite() { sum } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints;
    use crate::solve::solve;

    /// The starts of a curve, each with its point.
    fn found(text: &str, tolerance: f64) -> (usize, Vec<(usize, Vector)>) {
        let specification = constraints::read(text.as_bytes()).expect("a curve").specification;
        let options = Options { tolerance, elements_per_span: 64, ..Options::PLAIN };
        let solution = &solve(&specification, &options).expect("good data")[0];
        let point = |start: usize| match solution.elements.get(start) {
            Some(element) => element.rows[0],
            None => solution.elements[start - 1].rows[5],
        };
        (solution.elements.len(), solution.starts.iter().map(|&start| (start, point(start))).collect())
    }

    const WOODFORD: &str =
        "(G2Joint a (0,0,0))(G2Joint b (1,1.9,0))(G2Joint c (2,2.7,0))(G2Joint d (3,2.6,0))
        (G2Joint e (4,1.6,0))(G2Joint f (5,0.89,0))(G2Joint g (6,1.2,0))(G2Curve c Open (a,b,c,d,e,f,g))";

    #[test]
    fn fixed_joints_are_found_among_uneven_elements() {
        let (count, starts) = found(WOODFORD, 1e-7);
        assert!(count > 6 && count % 6 != 0, "{count}");
        let xs: Vec<f64> = starts.iter().map(|(_, point)| point[0]).collect();
        assert_eq!(xs, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!((starts[0].0, starts[6].0), (0, count));
    }

    #[test]
    fn sliding_joints_are_found_where_they_slide() {
        let text = WOODFORD
            .replace("c (2,2.7,0)", "c Line (2,2.7,0) (0,1,0)")
            .replace("d (3,2.6,0)", "d Plane (3,2.6,0) (1,0,0)");
        let (_, starts) = found(&text, 1e-7);
        assert!((starts[2].1[0] - 2.0).abs() < 1e-9 && (starts[3].1[0] - 3.0).abs() < 1e-9, "{starts:?}");
        assert!(starts.is_sorted());
        let (count, starts) = found(&WOODFORD.replace("g (6,1.2,0)", "g Line (6,1.2,0) (0,1,0)"), 1e-7);
        assert_eq!(starts[6].0, count);
    }

    #[test]
    fn of_a_closed_curve_the_last_span_is_a_span() {
        let text = "(G2Joint a (0,0,0))(G2Joint b (3,0,0))(G2Joint c Initial (3,1,0))(G2Joint d (0,2,0))
            (G2Curve c Closed (a,b,c,d))";
        let (count, starts) = found(text, 1e-6);
        assert_eq!((starts[0].1, starts[1].1, starts[3].1), ([0.0; 3], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0]));
        assert!(starts.windows(2).all(|pair| pair[0].0 < pair[1].0) && starts[3].0 < count, "{starts:?}");
        let (count, starts) = found(&text.replace("d (0", "d Initial (0"), 1e-6);
        assert!(starts.windows(2).all(|pair| pair[0].0 < pair[1].0) && starts[3].0 < count, "{starts:?}");
    }
}
