//! The curves of `tests/data/curves` as C: `tests/cross/curves.inc`.

use super::form::{Form, forms};
use crate::curves::{norm, times};
use crate::toolchain::root;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

/// A quantity: its constant in C and its value.
type Given = (&'static str, [f64; 3]);

const FREE: Given = ("MINVAR_FREE", [0.0; 3]);

struct Joint {
    continuity: String,
    position: Given,
    guide: [f64; 3],
    tangent: [Given; 2],
    curvature: [Given; 2],
}

fn joint(forms: &[Form]) -> Joint {
    let [head, _, rest @ ..] = forms else { panic!("{forms:?} is no joint") };
    let continuity = format!("MINVAR_{}", head.keyword().replace("joint", "").to_uppercase());
    let places = rest.iter().position(|form| !form.inner().is_empty()).expect("a joint has a position");
    let keyword = rest[..places].last().map(Form::keyword).unwrap_or_default();
    let kind = match keyword.as_str() {
        "initial" => "MINVAR_INITIAL",
        "line" => "MINVAR_ON_LINE",
        "plane" => "MINVAR_ON_PLANE",
        _ => "MINVAR_FIXED",
    };
    let slides = ["MINVAR_ON_LINE", "MINVAR_ON_PLANE"].contains(&kind);
    let mut joint = Joint {
        continuity,
        position: (kind, rest[places].point()),
        guide: if slides { rest[places + 1].point() } else { [0.0; 3] },
        tangent: [FREE; 2],
        curvature: [FREE; 2],
    };
    for condition in &rest[places + 1 + usize::from(slides)..] {
        let [status, property, sides @ .., value] = condition.inner() else { panic!("{condition:?}") };
        let kind = match status.keyword().as_str() {
            "fixed" => "MINVAR_FIXED",
            "initial" => "MINVAR_INITIAL",
            "size" => "MINVAR_SIZE",
            other => panic!("what is {other}?"),
        };
        let sides = match sides.first().map(Form::keyword).as_deref() {
            Some("arriving") => 0..1,
            Some("leaving") => 1..2,
            _ => 0..2,
        };
        for side in sides {
            if property.keyword() == "tangent" {
                joint.tangent[side] = (kind, value.point());
            } else if value.inner().is_empty() {
                // A size alone stands along the tangent, which says nothing of the direction.
                let tangent = joint.tangent[side].1;
                joint.curvature[side] = (kind, times(tangent, value.number() / norm(tangent)));
            } else {
                joint.curvature[side] = (kind, value.point());
            }
        }
    }
    joint
}

fn row(vector: [f64; 3]) -> String {
    let [x, y, z] = vector;
    format!("{{{x}, {y}, {z}}}")
}

fn quantity((kind, value): Given) -> String {
    format!("{{{kind}, {}}}", row(value))
}

/// One file as C: its joints and obstacles, and its line in the list.
fn curve(name: &str, text: &str) -> (String, String) {
    let (mut joints, mut obstacles, mut order, mut closed) = (BTreeMap::new(), Vec::new(), Vec::new(), 0);
    for form in forms(text) {
        let parts = form.inner();
        match parts[0].keyword().as_str() {
            "g2curve" => {
                closed = i32::from(parts[2].keyword() == "closed");
                order = parts[3].inner().iter().map(Form::keyword).collect();
            }
            "obstacle" => obstacles.push(parts.to_vec()),
            _ => drop(joints.insert(parts[1].keyword(), joint(parts))),
        }
    }
    let mut c = format!("static const minvar_joint {name}_joints[] = {{\n");
    for joint_name in &order {
        let Joint { continuity, position, guide, tangent, curvature } = &joints[joint_name];
        let pair = |pair: &[Given; 2]| format!("{{{}, {}}}", quantity(pair[0]), quantity(pair[1]));
        let _ = writeln!(c, "    {{{continuity}, {},", quantity(*position));
        let _ = writeln!(c, "     {},", pair(tangent));
        let _ = writeln!(c, "     {},", pair(curvature));
        let _ = writeln!(c, "     {}}},", row(*guide));
    }
    c.push_str("};\n");
    let mut of_obstacles = "NULL".to_owned();
    if !obstacles.is_empty() {
        of_obstacles = format!("{name}_obstacles");
        let _ = writeln!(c, "static const minvar_obstacle {of_obstacles}[] = {{");
        for parts in &obstacles {
            let (from, to) = (parts[3].point(), parts.last().expect("an obstacle has a point").point());
            let side = if parts[1].keyword() == "left" { "MINVAR_LEFT" } else { "MINVAR_RIGHT" };
            let _ = writeln!(c, "    {{{}, {}, {}, {side}}},", row(from), row(to), parts[2].number());
        }
        c.push_str("};\n");
    }
    let count = order.len();
    let entry = format!(
        "    {{\"{name}\", {name}_joints, {count}, {closed}, {of_obstacles}, {}}},\n",
        obstacles.len()
    );
    (c, entry)
}

/// The text of `tests/cross/curves.inc`.
///
/// # Panics
///
/// If a file of `tests/data/curves` is not well-formed.
pub fn as_c() -> String {
    let folder = root().join("tests/data/curves");
    let mut files: Vec<_> = fs::read_dir(&folder)
        .expect("tests/data/curves")
        .map(|entry| entry.expect("tests/data/curves can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mvc"))
        .collect();
    files.sort();
    let mut text =
        "/* tests/data/curves as C, written by `make cross-curves`: do not edit it. */\n\n".to_owned();
    let mut list = "static const given_curve given_curves[] = {\n".to_owned();
    for path in files {
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name in ASCII");
        let (c, entry) = curve(name, &fs::read_to_string(&path).expect("a constraint file is text"));
        text.push_str(&c);
        text.push('\n');
        list.push_str(&entry);
    }
    text + &list + "};\n"
}
