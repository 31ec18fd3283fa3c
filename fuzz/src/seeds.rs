//! Where fuzzing begins: the curves of `tests/data/curves`, as the bytes of each target's cases.

use crate::coder::{Reading, Writing};
use crate::{chain, curve, data, path, reference};
use minvar_cli::constraints::{Continuity, Given, NamedJoint, Specification, read};
use minvar_ffi::*;
use std::path::Path;
use std::{fs, io};

/// The targets.
pub const TARGETS: [&str; 5] = ["c_curve", "c_chain", "constraints", "path", "reference"];

fn quantity(given: Given) -> minvar_quantity {
    let (given, value) = match given {
        Given::Free => (0, [0.0; 3]),
        Given::Initial(value) => (1, value),
        Given::Fixed(value) => (2, value),
        Given::OnLine(value, _) => (3, value),
        Given::OnPlane(value, _) => (4, value),
        Given::Size(value) => (5, value),
    };
    minvar_quantity { given, value }
}

fn joint(named: &NamedJoint) -> minvar_joint {
    minvar_joint {
        continuity: match named.continuity {
            Continuity::G0 => 0,
            Continuity::G1 => 1,
            Continuity::G2 => 2,
        },
        position: quantity(named.position),
        tangent: named.tangent.map(quantity),
        curvature: named.curvature.map(quantity),
        guide: match named.position {
            Given::OnLine(_, guide) | Given::OnPlane(_, guide) => guide,
            _ => [0.0; 3],
        },
    }
}

/// A case of the curve functions with a file's data.
fn case(specification: &Specification) -> curve::Case {
    let obstacle = |shape: &minvar::curve::Obstacle| minvar_obstacle {
        from: shape.from,
        to: shape.to,
        clearance: shape.clearance,
        side: shape.side.0,
    };
    curve::Case {
        closed: specification.closed.into(),
        joints: specification.joints.iter().map(joint).take(5).collect(),
        obstacles: specification.obstacles.iter().map(|obstacle_| obstacle(&obstacle_.shape)).collect(),
        options: minvar_options { max_iterations: 12, ..minvar_options_defaults() },
        ..curve::Case::default()
    }
}

/// The elements of a case's curve.
fn solved(case: &curve::Case) -> Vec<minvar_element> {
    let curve = minvar_curve_through(case.joints.as_ptr(), case.joints.len(), case.closed as i32);
    let (mut workspace, mut elements) = (vec![0.0; 50_000], vec![data::NO_ELEMENT; 16]);
    let mut report = std::mem::MaybeUninit::<minvar_report>::uninit();
    // SAFETY: everything is as long as is said.
    let code = unsafe {
        minvar_curve_solve(
            &curve,
            &case.options,
            workspace.as_mut_ptr(),
            workspace.len(),
            None,
            std::ptr::null_mut(),
            elements.as_mut_ptr(),
            elements.len(),
            std::ptr::null_mut(),
            0,
            report.as_mut_ptr(),
            std::ptr::null_mut(),
        )
    };
    if code != minvar_code::MINVAR_OK {
        return Vec::new();
    }
    // SAFETY: the call wrote it.
    elements.truncate(unsafe { report.assume_init() }.elements);
    elements
}

/// The bytes of a case, of which it is read again.
macro_rules! coded {
    ($kind:ty, $case:expr) => {{
        let [mut written, mut again] = [Writing::default(), Writing::default()];
        let mut case: $kind = $case;
        case.code(&mut written);
        let mut read = <$kind>::default();
        read.code(&mut Reading::new(&written.bytes));
        read.code(&mut again);
        if again.bytes != written.bytes {
            return Err(io::Error::other("a case is not read as it was written"));
        }
        written.bytes
    }};
}

/// Sizes that the reader lays along a tangent: none of the vectors' numbers stands in the file.
const SIZED: &str = "(G2Joint a (0,0,0) (Initial Tangent (0,8,1)) (Size Curvature 0.3))
(G2Joint b (1,0,1) (Fixed Tangent (1e-300,-3e-300,2e-300)) (Size Curvature 0))
(G2Joint c (2,2,1))
(G2Curve sized Open (a,b,c))
";

/// Writes the seeds of all targets into a folder each.
///
/// # Errors
///
/// Those of the file system.
pub fn write(curves: &Path, folder: &Path) -> io::Result<()> {
    for target in TARGETS {
        fs::create_dir_all(folder.join(target))?;
    }
    fs::write(folder.join("constraints").join("sized"), SIZED)?;
    for entry in fs::read_dir(curves)? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = fs::read(&path)?;
        let put = |target: &str, variant: &str, bytes: &[u8]| {
            fs::write(folder.join(target).join(format!("{name}{variant}")), bytes)
        };
        put("constraints", "", &text)?;
        for letters in ["a", "bl", "hx", "jv", "dp", "fts"] {
            put("constraints", letters, &[b";!", letters.as_bytes(), b"\n", &text].concat())?;
        }
        let specification =
            read(&text).map_err(|fault| io::Error::other(fault.render(&name, false)))?.specification;
        let plain = case(&specification);
        for kind in [0, 8, 10, 12] {
            for (functional, elements_per_span) in [(0, 1), (1, 2)] {
                let options = minvar_options { functional, elements_per_span, ..plain.options };
                let moved = [0.125, -0.125, 0.0];
                let case = curve::Case { kind, options, moved, part: [1, 1], ..plain.clone() };
                put("c_curve", &format!("-{kind}-{functional}"), &coded!(curve::Case, case))?;
            }
        }
        let elements = solved(&plain);
        if !elements.is_empty() {
            let rows: Vec<_> = elements.iter().map(|element| element.rows).collect();
            let shape = serde_json::json!({ "elements": rows }).to_string();
            put("constraints", "q", &[b";!q\n", &text[..], b"\n#json\n", shape.as_bytes()].concat())?;
            let few: Vec<_> = elements.iter().take(3).copied().collect();
            let case = chain::Case { chain: few.clone(), ..chain::Case::default() };
            put("c_chain", "", &coded!(chain::Case, case))?;
            let case = path::Case { chain: few, scale: 20, tolerance: 0.01, ..path::Case::default() };
            put("path", "", &coded!(path::Case, case))?;
        }
        for functional in 0..3 {
            let joints = plain.joints.iter().take(4).copied().collect();
            let closed = plain.closed as u8;
            let case = reference::Case { closed, functional, elements: 0, joints };
            put("reference", &format!("-{functional}"), &coded!(reference::Case, case))?;
        }
    }
    Ok(())
}
