//! Several minima of one curve.

use super::element::Element;
use super::error::CurveError;
use super::joint::Curve;
use super::options::Options;
use super::report::{NOTHING, Report, functional_scale};
use super::solve::{Begin, begin, elements_len, starts};
use crate::solve::{Observer, Status};
use crate::total::Total;

/// Looks for several minima of one curve: from the usual start values, from each start tangent turned round, and from each
/// span bent the other way or further (thesis 4.10: curves with and without a loop). The list is what these starts lead
/// to; it need not be complete.
///
/// `reports` receives a report a minimum, the lowest first, as many as it has room for; `elements` holds
/// `(reports.len() + 1) ·` [`elements_len`] elements, of which the first [`elements_len`] receive the first minimum's, and
/// so on; the last are scratch. The observer sees every solve begin with iteration 1; if it asks to stop, the minima that
/// were found before are the result. Returns the number of minima.
///
/// # Errors
/// As [`super::solve()`].
pub fn minima(
    curve: &Curve<'_>,
    options: &Options,
    workspace: &mut [f64],
    elements: &mut [Element],
    reports: &mut [Report],
    observer: &mut dyn Observer,
) -> Result<usize, CurveError> {
    let figures = |report: &Report| [report.value, report.length, report.bending];
    minima_as(curve, options, workspace, elements, reports, |report| *report, figures, observer)
}

/// [`minima`] into reports of another form, which can be made of ours. `figures` tells value, length and bending of one
/// that was made; it is asked of no other.
///
/// # Errors
/// As [`minima`].
#[doc(hidden)]
#[expect(clippy::too_many_arguments, reason = "the caller's, and two conversions")]
pub fn minima_as<R: Copy>(
    curve: &Curve<'_>,
    options: &Options,
    workspace: &mut [f64],
    elements: &mut [Element],
    reports: &mut [R],
    make: impl Fn(&Report) -> R,
    figures: impl Fn(&R) -> [f64; 3],
    observer: &mut dyn Observer,
) -> Result<usize, CurveError> {
    let len = elements_len(curve, options);
    let (needed, given) = (len.saturating_mul(reports.len() + 1), elements.len());
    if given < needed {
        return Err(CurveError::ElementsTooShort { needed, given });
    }
    let mut found = 0;
    for start in 0..starts(curve) {
        let (kept, rest) = elements.cut_mut(reports.len() * len);
        let scratch = rest.part_mut(..len);
        let report = begin(curve, options, workspace, scratch, &mut [], observer, Begin::Data(start))?;
        if report.status == Status::Cancelled {
            break;
        }
        if report.status != Status::Converged {
            continue;
        }
        let same = |other: &R| {
            let [value, length, bending] = figures(other);
            // Circles have no value: what is nothing beside that of bending once around is the same nothing.
            let nothing = NOTHING * bending * length * functional_scale(options, length);
            (report.value - value).abs() <= SAME_VALUE * (report.value + value) + nothing
                && (report.length - length).abs() <= SAME_LENGTH * report.length
        };
        if reports.iter().take(found).any(same) {
            continue;
        }
        let lower = |other: &R| report.value < figures(other)[0];
        let place = reports.iter().take(found).position(lower).unwrap_or(found);
        if place == reports.len() {
            continue;
        }
        found = (found + 1).min(reports.len());
        // The new one takes its place, and each that is higher the next one's.
        let mut report = make(&report);
        for slot in reports.iter_mut().take(found).skip(place) {
            core::mem::swap(slot, &mut report);
        }
        for slot in kept.chunks_exact_mut(len.max(1)).take(found).skip(place) {
            for (kept, new) in slot.iter_mut().zip(&mut *scratch) {
                core::mem::swap(kept, new);
            }
        }
    }
    Ok(found)
}

/// Minima whose values and lengths differ by less than these fractions are the same: one element a span has several for one
/// shape.
const SAME_VALUE: f64 = 1e-4;
const SAME_LENGTH: f64 = 1e-3;

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::curve::error::CurveError;
    use crate::curve::joint::{Joint, Quantity};
    use crate::curve::measure::{length, variation};
    use crate::curve::solve::workspace_len;
    use crate::solve::{Control, Record};
    use std::vec;
    use std::vec::Vec;

    /// Thesis Fig. 4.9: a curve with a loop and without.
    fn looped(size: f64) -> [Joint; 5] {
        let at = |x: f64, y: f64| Joint::at([x * size, y * size, 0.0]);
        let towards = |x: f64, y: f64| Quantity::initial([x, y, 0.0]);
        [
            at(-1.5, 0.0).with_tangent(towards(1.0, 0.1)),
            at(-0.5, 0.5),
            at(0.0, 1.0).with_tangent(towards(-1.0, 0.0)).with_curvature(Quantity::fixed([
                0.0,
                -10.0 / size,
                0.0,
            ])),
            at(0.5, 0.5),
            at(1.5, 0.0).with_tangent(towards(1.0, -0.1)),
        ]
    }

    /// Counts solves, and asks to stop at the beginning of one of them.
    struct Solves {
        seen: usize,
        last: usize,
    }

    impl Observer for Solves {
        fn iteration(&mut self, number: usize, _: &Record) -> Control {
            self.seen += usize::from(number == 1);
            if self.seen == self.last { Control::Cancel } else { Control::Continue }
        }
    }

    const UNSOLVED: Report = Report {
        status: Status::Unsolved,
        iterations: 0,
        linearisations: 0,
        unknowns: 0,
        planar: false,
        elements: 0,
        error: 0.0,
        value: 0.0,
        fine_value: 0.0,
        length: 0.0,
        variation: 0.0,
        bending: 0.0,
        gradient: 0.0,
        decrement: 0.0,
    };

    /// The minima of a curve, as many as there is room for, with their elements and the number of solves.
    fn list(joints: &[Joint], room: usize, last: usize) -> (Vec<(Report, Vec<Element>)>, usize) {
        let (curve, options) = (Curve::open(joints), Options::DEFAULT);
        let len = elements_len(&curve, &options);
        let Ok(numbers) = workspace_len(&curve, &options) else { panic!("good data") };
        let (mut workspace, mut elements) = (vec![f64::NAN; numbers], vec![Element::ZERO; len * (room + 1)]);
        let mut reports = vec![UNSOLVED; room];
        let mut solves = Solves { seen: 0, last };
        let found = minima(&curve, &options, &mut workspace, &mut elements, &mut reports, &mut solves);
        let Ok(found) = found else { panic!("{found:?}") };
        assert!(reports[found..].iter().all(|report| *report == UNSOLVED));
        let chunks = elements.chunks(len).map(<[Element]>::to_vec);
        (reports[..found].iter().copied().zip(chunks).collect(), solves.seen)
    }

    #[test]
    fn minima_are_told_apart_sorted_and_kept_with_their_elements() {
        let joints = looped(1.0);
        let (all, solves) = list(&joints, 8, usize::MAX);
        assert_eq!(solves, 1 + 5 + 4);
        assert!((2..8).contains(&all.len()), "{}", all.len());
        for (report, elements) in &all {
            assert_eq!(report.status, Status::Converged);
            assert!((variation(elements) - report.variation).abs() < 1e-6 * report.variation);
            assert!((length(elements) - report.length).abs() < 1e-9 * report.length);
        }
        for pair in all.windows(2) {
            let [(one, _), (other, _)] = pair else { continue };
            assert!(one.value < other.value);
            let apart = (other.value - one.value) > 1e-4 * (one.value + other.value)
                || (other.length - one.length).abs() > 1e-3 * one.length;
            assert!(apart, "{one:?} {other:?}");
        }
        // The usual start leads to one of them, and not to the lowest.
        let (usual, _) = list(&joints, 8, 2);
        assert!(usual.len() == 1 && usual[0].0.value > all[0].0.value);
        assert!(all.iter().any(|one| *one == usual[0]));
        // With less room the lowest stay.
        for room in 1..all.len() {
            assert!(list(&joints, room, usize::MAX).0 == all[..room], "{room}");
        }
        assert!(list(&joints, 0, usize::MAX).0.is_empty() && list(&joints, 8, 1).0.is_empty());
        // In other units the same list.
        let (scaled, _) = list(&looped(1024.0), 8, usize::MAX);
        assert_eq!(scaled.len(), all.len());
        for ((one, _), (other, _)) in scaled.iter().zip(&all) {
            assert!((one.length - 1024.0 * other.length).abs() < 1e-6 * one.length);
        }
    }

    /// A circle has no value to compare with: what is nothing is the same nothing.
    #[test]
    fn one_circle_is_found_once() {
        for size in [1.0, 1e-6, 1e6] {
            let joints = [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.0, 1.0, 0.0], [-0.8, 0.6, 0.0]]
                .map(|point| Joint::at(point.map(|x| x * size)));
            let (all, _) = list(&joints, 6, usize::MAX);
            let circles = all.iter().filter(|(report, _)| {
                report.variation * report.length * report.length < 1e-6 * report.bending
            });
            assert_eq!(circles.count(), 1, "{size}: {}", all.len());
        }
    }

    #[test]
    fn too_few_elements_are_refused_with_what_is_needed() {
        let joints = looped(1.0);
        let (curve, options) = (Curve::open(&joints), Options::DEFAULT);
        let mut reports = [UNSOLVED; 2];
        let mut solves = Solves { seen: 0, last: usize::MAX };
        let mut workspace = [0.0; 4000];
        let mut of = |elements: &mut [Element]| {
            minima(&curve, &options, &mut workspace, elements, &mut reports, &mut solves)
        };
        assert_eq!(of(&mut [Element::ZERO; 11]), Err(CurveError::ElementsTooShort { needed: 12, given: 11 }));
        assert_eq!(of(&mut [Element::ZERO; 12]), Ok(2));
    }
}
