//! Hostile data: joints, obstacles, options and elements of which few bytes make good ones and a few more make any.

use crate::coder::Coder;
use minvar::curve::{Continuity, Given, Joint, Quantity};
use minvar_ffi::{minvar_element, minvar_joint, minvar_obstacle, minvar_options, minvar_quantity};

/// A quantity that is left to the solver.
const FREE: minvar_quantity = minvar_quantity { given: 0, value: [0.0; 3] };
/// A joint before its bytes are read.
pub const NO_JOINT: minvar_joint = minvar_joint {
    continuity: 2,
    position: minvar_quantity { given: 2, ..FREE },
    tangent: [FREE; 2],
    curvature: [FREE; 2],
    guide: [0.0; 3],
};
/// An obstacle before its bytes are read.
pub const NO_OBSTACLE: minvar_obstacle =
    minvar_obstacle { from: [0.0; 3], to: [0.0; 3], clearance: 0.0, side: 0 };
/// An element before its bytes are read.
pub const NO_ELEMENT: minvar_element = minvar_element { rows: [[0.0; 3]; 6] };

const TANGENTS_DIFFER: u8 = 1;
const CURVATURES_DIFFER: u8 = 2;
const IN_SPACE: u8 = 4;
const CURVATURE_AS_IT_IS: u8 = 8;
const GUIDED: u8 = 16;

/// A point or vector, in the plane z = 0 or not.
fn point<C: Coder>(c: &mut C, x: &mut [f64; 3], in_space: bool) {
    if in_space {
        c.vector(x);
    } else {
        c.number(&mut x[0]);
        c.number(&mut x[1]);
        x[2] = 0.0;
    }
}

fn quantity<C: Coder>(c: &mut C, x: &mut minvar_quantity, usual: &[u32], in_space: bool) {
    c.one_of(&mut x.given, usual);
    if x.given != 0 {
        point(c, &mut x.value, in_space);
    }
}

/// The same on both sides, or not.
fn sides<C: Coder>(c: &mut C, x: &mut [minvar_quantity; 2], usual: &[u32], differ: bool, in_space: bool) {
    quantity(c, &mut x[0], usual, in_space);
    if differ {
        quantity(c, &mut x[1], usual, in_space);
    } else {
        x[1] = x[0];
    }
}

fn same(a: &minvar_quantity, b: &minvar_quantity) -> bool {
    a.given == b.given && (a.given == 0 || a.value.map(f64::to_bits) == b.value.map(f64::to_bits))
}

/// The part of a curvature that is perpendicular to a tangent.
fn across(curvature: [f64; 3], tangent: [f64; 3]) -> [f64; 3] {
    let most = tangent.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let t = tangent.map(|x| x / most);
    let along = (0..3).map(|d| t[d] * curvature[d]).sum::<f64>() / t.iter().map(|x| x * x).sum::<f64>();
    std::array::from_fn(|d| curvature[d] - along * t[d])
}

/// A joint.
pub fn joint<C: Coder>(c: &mut C, joint: &mut minvar_joint) {
    let vectors =
        [joint.position, joint.tangent[0], joint.tangent[1], joint.curvature[0], joint.curvature[1]];
    let set = |bit: u8, is: bool| if is { bit } else { 0 };
    let mut flags = set(TANGENTS_DIFFER, !same(&joint.tangent[0], &joint.tangent[1]))
        | set(CURVATURES_DIFFER, !same(&joint.curvature[0], &joint.curvature[1]))
        | set(IN_SPACE, vectors.iter().any(|v| v.given != 0 && v.value[2].to_bits() != 0))
        | set(CURVATURE_AS_IT_IS, joint.curvature.iter().any(|curvature| curvature.given != 0))
        | set(GUIDED, joint.guide.iter().any(|x| x.to_bits() != 0));
    c.byte(&mut flags);
    let is = |bit: u8| flags & bit != 0;
    c.one_of(&mut joint.continuity, &[2, 2, 1, 0]);
    quantity(c, &mut joint.position, &[2, 2, 2, 3, 4, 1, 0, 5], is(IN_SPACE));
    sides(c, &mut joint.tangent, &[0, 2, 1, 2, 0, 3], is(TANGENTS_DIFFER), is(IN_SPACE));
    sides(c, &mut joint.curvature, &[0, 0, 2, 1, 5, 0, 3], is(CURVATURES_DIFFER), is(IN_SPACE));
    if !is(CURVATURE_AS_IT_IS) {
        for side in 0..2 {
            if joint.tangent[side].given != 0 {
                joint.curvature[side].value = across(joint.curvature[side].value, joint.tangent[side].value);
            }
        }
    }
    if is(GUIDED) {
        c.vector(&mut joint.guide);
    }
}

/// An obstacle.
pub fn obstacle<C: Coder>(c: &mut C, obstacle: &mut minvar_obstacle) {
    let vectors = [obstacle.from, obstacle.to];
    let mut in_space = u8::from(vectors.iter().any(|x| x[2].to_bits() != 0));
    c.byte(&mut in_space);
    let in_space = in_space % 8 == 1;
    point(c, &mut obstacle.from, in_space);
    point(c, &mut obstacle.to, in_space);
    c.number_of(&mut obstacle.clearance, &[0.0, 0.25, 1.0, 0.0078125, -1.0]);
    c.one_of(&mut obstacle.side, &[0, 1, 0, 1, 2]);
}

/// The options.
pub fn options<C: Coder>(c: &mut C, options: &mut minvar_options) {
    c.one_of(&mut options.functional, &[0, 1, 2, 3, 4, 5, 0, 1, 6]);
    c.one_of(&mut options.elements_per_span, &[1, 2, 3, 4, 1, 2, 8, 16, 0, 1023, 1024, 1025, u32::MAX]);
    c.one_of(&mut options.quadrature_points, &[0, 0, 0, 12, 16, 20, 32, 11, 33]);
    c.one_of(&mut options.max_iterations, &[12, 5, 24, 0, 1, 2, 3, 60, 500, u32::MAX]);
    c.one_of(&mut options.dimension, &[0, 0, 2, 3, 1]);
    c.one_of(&mut options.continuation, &[0, 0, 0, 0, 1, 3, 16, 17]);
    c.number_of(&mut options.relative_decrease, &[1e-12, 1e-12, 0.0, 1e-6, 1e-3, 0.5, 1.0]);
    for free in [&mut options.tension, &mut options.bending, &mut options.length, &mut options.tolerance] {
        c.number_of(free, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1e-3, 1e-6, 100.0, -1.0]);
    }
}

const NEW_START: u8 = 1;
const CORNER: u8 = 2;
const SPATIAL: u8 = 4;

/// A chain of elements that meet, with common tangents or corners, or not at all.
pub fn elements<C: Coder>(c: &mut C, chain: &mut Vec<minvar_element>, most: u8) {
    let mut before: Option<[[f64; 3]; 6]> = None;
    c.list(chain, most, NO_ELEMENT, |c, element| {
        let rows = &mut element.rows;
        let bits = |x: [f64; 3]| x.map(f64::to_bits);
        let meets = before.is_some_and(|before| bits(before[5]) == bits(rows[0]));
        let mut flags = CORNER | if meets { 0 } else { NEW_START };
        flags |= if rows.iter().any(|row| row[2].to_bits() != 0) { SPATIAL } else { 0 };
        c.byte(&mut flags);
        let spatial = flags & SPATIAL != 0;
        match before {
            Some(before) if flags & NEW_START == 0 => rows[0] = before[5],
            _ => point(c, &mut rows[0], spatial),
        }
        match before {
            Some(before) if flags & CORNER == 0 => rows[1] = before[4],
            _ => point(c, &mut rows[1], spatial),
        }
        rows[2..].iter_mut().for_each(|row| point(c, row, spatial));
        before = Some(*rows);
    });
}

/// The kernel's joint of C's: what a test is written with.
pub fn kernel_joint(joint: &minvar_joint) -> Joint {
    let quantity = |q: minvar_quantity| Quantity { given: Given(q.given), value: q.value };
    Joint {
        continuity: Continuity(joint.continuity),
        position: quantity(joint.position),
        tangent: joint.tangent.map(quantity),
        curvature: joint.curvature.map(quantity),
        guide: joint.guide,
    }
}
