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
