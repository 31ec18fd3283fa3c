//! minvar against the independent reference in Ceres, on small problems of the plane and of space. Where both converge, minvar's
//! functional is not above the reference's by more than is promised, and no Newton step of the reference's own would lower it. A
//! functional has several minima, of the parametrisation too: one that is lower *and elsewhere* breaks no promise; it is counted.

use crate::coder::{Coder, Reading};
use crate::data;
use minvar::curve::{Continuity, Curve, Functional, Given, Joint, Options, Quantity};
use minvar::solve::Status;
use minvar_ffi::minvar_joint;
use minvar_tests::ceres::{self, Start};
use minvar_tests::compare::reference_joint;
use minvar_tests::curves::{Vector, norm, solve_curve, times};
use minvar_tests::random::finding::{Check, Findings};
use minvar_tests::random::judge::{MEANINGLESS, judge, natural, polygon};
use minvar_tests::random::problem::Problem;
use minvar_tests::random::samples::Family;
use minvar_tests::random::similarity::Similarity;
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How far minvar's functional may be above, as a fraction: what `make random` allows.
const PROMISE: f64 = 1e-6;
/// Where the rules of both differ by more than that: the same, as a multiple of the difference.
const OF_RULES: f64 = 100.0;
/// A curve as long as this many polygons is no minimum in reach.
const IN_REACH: f64 = 10.0;
/// Chains whose rows are no farther apart than this part of the largest are the same minimum.
const SAME: f64 = 3e-4;

/// Everything that one input says.
#[derive(Clone, Default)]
pub struct Case {
    /// Whether the curve returns to its first joint.
    pub closed: u8,
    /// Which functional the reference knows.
    pub functional: u8,
    /// Elements a span.
    pub elements: u8,
    /// The joints.
    pub joints: Vec<minvar_joint>,
}

impl Case {
    /// The fields in order.
    pub fn code<C: Coder>(&mut self, c: &mut C) {
        c.byte(&mut self.closed);
        c.byte(&mut self.functional);
        c.byte(&mut self.elements);
        c.list(&mut self.joints, 4, data::NO_JOINT, data::joint);
    }
}

/// Runs an input.
pub fn run(bytes: &[u8]) {
    let mut case = Case::default();
    case.code(&mut Reading::new(bytes));
    case.check();
}

/// A number that a designer may give: a sixty-fourth, not beyond 16.
fn gentle(x: f64) -> f64 {
    if x.is_finite() { (x * 64.0).round().clamp(-1024.0, 1024.0) / 64.0 } else { 0.0 }
}

fn quantity(given: u32, value: Vector) -> Quantity {
    match given {
        1 => Quantity::initial(value),
        2 => Quantity::fixed(value),
        _ => Quantity::FREE,
    }
}

/// A joint of data that both programs understand.
fn joint(given: &minvar_joint) -> Joint {
    let mut joint = Joint::at(given.position.value.map(gentle))
        .with_continuity(Continuity(if given.continuity < 2 { given.continuity } else { 2 }));
    let towards = given.tangent[0].value.map(gentle);
    if matches!(given.tangent[0].given, 1 | 2) && norm(towards) > 0.0 {
        joint = joint.with_tangent(quantity(given.tangent[0].given, towards));
        let bend = given.curvature[0].value.map(gentle);
        let along = (0..3).map(|d| towards[d] * bend[d]).sum::<f64>() / norm(towards) / norm(towards);
        let across: Vector = std::array::from_fn(|d| bend[d] - along * towards[d]);
        let size = norm(across);
        let across = if size > 1e-3 { times(across, size.min(2.0) / size) } else { [0.0; 3] };
        if matches!(given.curvature[0].given, 1 | 2) {
            joint = joint.with_curvature(quantity(given.curvature[0].given, across));
        }
    }
    joint
}

impl Case {
    /// Solves and compares.
    pub fn check(&self) {
        let mut joints: Vec<Joint> = self.joints.iter().map(joint).collect();
        let flat = joints.iter().all(|j| {
            [j.position.value, j.tangent[0].value, j.curvature[0].value].iter().all(|value| value[2] == 0.0)
        });
        if !flat {
            // In space a fixed curvature turns with its tangent for us, and does not for the reference.
            for joint in joints.iter_mut().filter(|joint| joint.tangent[0].given != Given::FIXED) {
                if joint.curvature[0].given == Given::FIXED {
                    *joint = joint.with_curvature(Quantity::initial(joint.curvature[0].value));
                }
            }
        }
        let closed = self.closed % 2 == 1;
        let (functional, known) = [
            (Functional::MVC, ceres::Functional::Mvc),
            (Functional::MEC, ceres::Functional::Mec),
            (Functional::SI_MVC, ceres::Functional::SiMvc),
        ][usize::from(self.functional % 3)];
        let elements_per_span = 1 + u32::from(self.elements % 8 == 7);
        let dimension = if flat { 2 } else { 3 };
        let options = Options { functional, elements_per_span, dimension, ..Options::DEFAULT };
        if crate::shows() {
            joints.iter().for_each(|joint| eprintln!("{joint:?}"));
            eprintln!("closed {closed}, {options:?}");
        }
        let Ok((report, elements)) = solve_curve(&joints, closed, &options) else { return };
        let problem = Problem {
            index: 0,
            family: Family::Uniform,
            planar: flat,
            closed,
            plain: joints.clone(),
            place: Similarity::IDENTITY,
            joints: joints.clone(),
        };
        let mut findings = Findings::default();
        let _ = judge(&problem, &options, &report, &elements, &mut findings);
        for check in Check::ALL.into_iter().filter(|check| check.is_promise()) {
            assert!(!findings.beyond(check), "{check:?} {:?}: {report:?}", findings.of(check));
        }
        // An energy with a fixed curvature has an infimum only: a step long enough always promises a little more.
        if report.status != Status::Converged
            || (functional == Functional::MEC && !problem.has_least_energy())
        {
            return;
        }

        TELL.call_once(tell_at_the_end);
        let list: Vec<ceres::Joint> = joints.iter().map(reference_joint).collect();
        let reference = ceres::Problem {
            elements_per_span: elements_per_span as usize,
            ..ceres::Problem::new(&list, closed, flat, known)
        };
        let curve = Curve::new(&joints, closed);
        // What the elements have, by the finer rule.
        let ours = report.fine_value;
        let size = if functional == Functional::SI_MVC {
            // What a bend on every chord costs grows with the others' length.
            natural(&curve, Functional::MVC) * report.length.powi(3)
        } else {
            natural(&curve, functional)
        };
        // Where two rules do not agree on what the elements cost, each leads to a minimum of its own.
        let apart = (report.fine_value - report.value).abs();
        let differ = apart > PROMISE * ours;
        RULES.fetch_add(differ.into(), Ordering::Relaxed);
        let allowed = PROMISE * ours + MEANINGLESS * size + if differ { OF_RULES * apart } else { 0.0 };
        let good = |found: &ceres::Solution| {
            let trusted = (found.finer_value - found.value).abs() <= 1e-6 * found.value;
            let near = found.measure.l <= IN_REACH * polygon(&curve);
            (found.converged && !found.runaway && trusted && near).then_some(found.value)
        };
        let rows: Vec<_> = elements.iter().map(|element| element.rows).collect();
        if let Ok(certificate) = ceres::certify(&reference, &rows) {
            let size = rows.iter().flatten().flatten().fold(1.0_f64, |most, x| most.max(x.abs()));
            assert!(
                certificate.defect <= 1e-6 * size,
                "no curve of the reference's by {}",
                certificate.defect
            );
            assert!(
                certificate.decrement <= allowed,
                "a Newton step of the reference's gains {:e} of {ours:e}: {report:?}",
                certificate.decrement
            );
        }
        // The reference's derivatives are automatic and its matrices dense: an input has a second or two.
        let newton = ceres::Options { newton_iterations: 60, ..ceres::Options::newton() };
        for (begins, start) in [(0, Start::Rows(&rows)), (1, Start::Thesis)] {
            let Ok(found) = ceres::solve(&reference, start, &newton) else { continue };
            let Some(value) = good(&found) else { continue };
            BOTH[begins].fetch_add(1, Ordering::Relaxed);
            if ours > value + allowed {
                assert!(
                    !is_same(&rows, &found.rows),
                    "{ours:e}, and the reference finds {value:e} there: {report:?}"
                );
                ELSEWHERE[begins].fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

/// Whether two chains are one minimum.
fn is_same(ours: &[ceres::Rows], theirs: &[ceres::Rows]) -> bool {
    let size = |rows: &ceres::Rows| rows.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    ours.iter().zip(theirs).all(|(a, b)| {
        let off =
            a.iter().flatten().zip(b.iter().flatten()).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        off <= SAME * size(a)
    })
}

/// How often both converged, and how often the reference's was a lower one of the other minima: from minvar's result, and
/// from the thesis's start.
static BOTH: [AtomicUsize; 2] = [AtomicUsize::new(0), AtomicUsize::new(0)];
static ELSEWHERE: [AtomicUsize; 2] = [AtomicUsize::new(0), AtomicUsize::new(0)];
/// On how many converged curves the rules differ.
static RULES: AtomicUsize = AtomicUsize::new(0);

unsafe extern "C" {
    fn atexit(last: extern "C" fn()) -> i32;
}

extern "C" fn tell() {
    let of = |counts: &[AtomicUsize; 2]| counts.each_ref().map(|count| count.load(Ordering::Relaxed));
    let ([near, far], [near_lower, far_lower]) = (of(&BOTH), of(&ELSEWHERE));
    eprintln!(
        "both converged {near} times from minvar's result ({near_lower} times the reference went on to a lower minimum \
         elsewhere) and {far} times from the thesis's start ({far_lower} times to a lower minimum elsewhere); the rules \
         differ on {} curves",
        RULES.load(Ordering::Relaxed)
    );
}

static TELL: Once = Once::new();

fn tell_at_the_end() {
    // SAFETY: the function lives as long as the program.
    assert_eq!(unsafe { atexit(tell) }, 0);
}
