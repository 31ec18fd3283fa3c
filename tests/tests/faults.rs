//! Faults of those who call: a workspace that is short or dirty, an observer that stops at any moment or does not keep
//! to its word. What comes out then is what the documentation says, and the next call is none the worse.

use minvar::curve::{CurveError, Element, Given, Report, elements_len, measure, minima};
use minvar::solve::{Control, Observer, Record, Silent, Status};
use minvar_tests::curves::{MARKER, end_shape, norm, sub};
use minvar_tests::kinds::{Kind, kinds};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// More iterations than any of the kinds takes.
const RECORDS: usize = 600;

/// A record of the test's own, which no solve writes.
const BLANK: Record =
    Record { value: -1.5, predicted: -1.5, actual: -1.5, gradient: -1.5, step: -1.5, shift: -1.5 };

/// All that a computation wrote.
#[derive(Clone, Debug)]
struct Written {
    report: Report,
    elements: Vec<Element>,
    records: Vec<Record>,
}

/// Computes with this memory, in whatever condition it is.
fn compute(kind: &Kind, workspace: &mut [f64], observer: &mut dyn Observer) -> Written {
    let (mut elements, mut records) = (kind.room(), vec![BLANK; RECORDS]);
    let report = kind.run(workspace, &mut elements, &mut records, observer);
    Written { report: report.unwrap_or_else(|error| panic!("{}: {error}", kind.name)), elements, records }
}

/// In exactly the memory that it needs, full of zeros.
fn clean(kind: &Kind) -> Written {
    compute(kind, &mut vec![0.0; kind.workspace_len()], &mut Silent)
}

/// A report's bits, so that NaN and the sign of zero count.
fn report_bits(report: &Report) -> Vec<u64> {
    let Report { value, fine_value, length, variation, bending, error, gradient, decrement, .. } = *report;
    let figures = [value, fine_value, length, variation, bending, error, gradient, decrement];
    let Report { iterations, linearisations, unknowns, elements, .. } = *report;
    let counts = [iterations, linearisations, unknowns, elements].map(|count| count as u64);
    let rest = [report.status as u64, u64::from(report.planar)];
    counts.into_iter().chain(rest).chain(figures.map(f64::to_bits)).collect()
}

fn bits(written: &Written) -> Vec<u64> {
    let rows = written.elements.iter().flat_map(|element| element.rows.into_iter().flatten());
    let records =
        written.records.iter().flat_map(|r| [r.value, r.predicted, r.actual, r.gradient, r.step, r.shift]);
    report_bits(&written.report).into_iter().chain(rows.chain(records).map(f64::to_bits)).collect()
}

#[test]
fn every_kind_of_curve_ends_as_it_should() {
    for kind in kinds() {
        let report = clean(&kind).report;
        assert_eq!(report.status, kind.status, "{}: {report:?}", kind.name);
    }
}

#[test]
fn a_workspace_one_number_short_is_refused_and_nothing_is_written() {
    for kind in kinds() {
        let needed = kind.workspace_len();
        for given in [needed - 1, needed / 2, 1, 0] {
            let mut workspace = vec![-3.5; given];
            let (mut elements, mut records) = (kind.room(), vec![BLANK; 4]);
            let before = elements.clone();
            let result = kind.run(&mut workspace, &mut elements, &mut records, &mut Silent);
            assert_eq!(result, Err(CurveError::WorkspaceTooSmall { needed, given }), "{}", kind.name);
            assert!(elements == before && records == [BLANK; 4], "{}: a result was written", kind.name);
            assert!(workspace.iter().all(|&x| x == -3.5), "{}: there was work before the refusal", kind.name);
        }
    }
}

#[test]
fn a_dirty_workspace_changes_no_bit() {
    let kinds = kinds();
    let most = kinds.iter().map(Kind::workspace_len).max().expect("kinds");
    // As the kind before left it, too.
    let mut used = vec![0.0; most];
    for kind in &kinds {
        let wanted = bits(&clean(kind));
        // NaN, a number that overflows when doubled, one that counts as nothing, and a plausible one.
        for dirt in [f64::NAN, -f64::MAX, f64::from_bits(1), 0.3] {
            // Longer than is needed: what was not asked for is left alone.
            let needed = kind.workspace_len();
            let mut workspace = vec![dirt; needed + 7];
            for again in [false, true] {
                let same = bits(&compute(kind, &mut workspace, &mut Silent)) == wanted;
                assert!(same, "{} over {dirt}, again: {again}", kind.name);
            }
            let kept = workspace[needed..].iter().all(|x| x.to_bits() == dirt.to_bits());
            assert!(kept, "{}: what was not asked for was touched", kind.name);
        }
        assert!(bits(&compute(kind, &mut used, &mut Silent)) == wanted, "{} after another", kind.name);
    }
}

/// Stops once, and would go on if it were asked again.
#[derive(Default)]
struct Wavering {
    stop_at: usize,
    calls: usize,
    seen: Vec<Record>,
}

impl Observer for Wavering {
    fn iteration(&mut self, number: usize, record: &Record) -> Control {
        self.calls += 1;
        assert_eq!(number, self.calls, "iterations are numbered through");
        self.seen.push(*record);
        if self.calls == self.stop_at { Control::Cancel } else { Control::Continue }
    }
}

/// What is wrong with a chain as a curve through the kind's joints.
fn flaw(kind: &Kind, report: &Report, elements: &[Element]) -> Option<String> {
    let (chain, rest) = elements.split_at(report.elements);
    if rest.iter().any(|element| *element != MARKER) {
        return Some("what lies beyond the elements was touched".into());
    }
    if chain.iter().flat_map(|element| element.rows.iter().flatten()).any(|x| !x.is_finite()) {
        return Some("a number is none".into());
    }
    let extent = chain.iter().flat_map(|e| e.rows[0]).fold(1.0f64, |most, x| most.max(x.abs()));
    let corners =
        kind.joints.iter().any(|joint| joint.tangent[0] != joint.tangent[1]) || kind.name.contains("corner");
    for (k, element) in chain.iter().enumerate() {
        let next = match chain.get(k + 1) {
            Some(next) => next,
            None if kind.closed => &chain[0],
            None => continue,
        };
        if norm(sub(element.rows[5], next.rows[0])) > 1e-12 * extent {
            return Some(format!("element {k} does not end where the next begins"));
        }
        let [(before, ..), (after, ..)] = [end_shape(element, 1), end_shape(next, 0)];
        if !corners && !(norm(sub(before, after)) < 1e-9) {
            return Some(format!("element {k} has another direction at its end than the next"));
        }
    }
    for joint in kind.joints.iter().filter(|joint| joint.position.given == Given::FIXED) {
        let point = joint.position.value;
        if !chain.iter().any(|e| e.rows[0] == point || e.rows[5] == point) {
            return Some(format!("no element meets the joint at {point:?}"));
        }
    }
    // A wild curve's figures are known to a few parts in a thousand.
    let (measured, said) = (measure::length(chain), report.length);
    ((measured - said).abs() > 1e-2 * measured).then(|| format!("the length is {measured}, not {said}"))
}

#[test]
fn a_solve_cancelled_at_any_iteration_stops_there_and_hands_over_a_whole_curve() {
    let mut wrong = Vec::new();
    let mut cancelled = 0;
    for kind in kinds() {
        let mut all = Wavering::default();
        let whole = compute(&kind, &mut vec![0.0; kind.workspace_len()], &mut all);
        assert_eq!(whole.report.iterations, all.calls, "{}", kind.name);
        let mut workspace = vec![f64::NAN; kind.workspace_len()];
        // Of the longest every seventh, and the last ones.
        let few = |stop_at: &usize| *stop_at < 40 || stop_at.is_multiple_of(7) || all.calls - stop_at < 10;
        for stop_at in (1..=all.calls).filter(few) {
            let mut wavering = Wavering { stop_at, ..Wavering::default() };
            let written = compute(&kind, &mut workspace, &mut wavering);
            let of = format!("{}, cancelled at {stop_at} of {}", kind.name, all.calls);
            if wavering.calls != stop_at {
                wrong.push(format!("{of}: the observer was called {} times", wavering.calls));
                continue;
            }
            let Report { status, iterations, .. } = written.report;
            if (status, iterations) != (Status::Cancelled, stop_at) {
                wrong.push(format!("{of}: {status:?} after {iterations}"));
            }
            if written.records[..stop_at] != whole.records[..stop_at]
                || written.records[..stop_at] != wavering.seen
                || written.records[stop_at..].iter().any(|record| *record != BLANK)
            {
                wrong.push(format!("{of}: other records"));
            }
            if let Some(flaw) = flaw(&kind, &written.report, &written.elements) {
                wrong.push(format!("{of}: {flaw}"));
            }
            cancelled += 1;
        }
        // The workspace of a cancelled solve is as good as any.
        if bits(&compute(&kind, &mut workspace, &mut Silent)) != bits(&whole) {
            wrong.push(format!("{}: other bits after a cancelled solve", kind.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(cancelled > 600, "{cancelled}");
}

#[test]
fn a_search_for_minima_that_is_cancelled_keeps_those_it_found() {
    let kind = kinds().into_iter().find(|kind| kind.name == "a loop").expect("a kind");
    let (curve, options) = (kind.curve(), kind.options);
    let len = elements_len(&curve, &options);
    const MOST: usize = 3;
    struct Count {
        calls: usize,
        stop_at: usize,
    }
    impl Observer for Count {
        fn iteration(&mut self, _: usize, _: &Record) -> Control {
            self.calls += 1;
            if self.calls == self.stop_at { Control::Cancel } else { Control::Continue }
        }
    }
    let mut workspace = vec![f64::NAN; kind.workspace_len()];
    let mut search = |stop_at: usize| {
        let mut elements = vec![MARKER; (MOST + 1) * len + 2];
        let blank = Report { iterations: usize::MAX, ..clean(&kind).report };
        let mut reports = vec![blank; MOST];
        let mut count = Count { calls: 0, stop_at };
        let found = minima(&curve, &options, &mut workspace, &mut elements, &mut reports, &mut count)
            .expect("good data");
        assert!(stop_at == 0 || count.calls == stop_at, "called {} times, not {stop_at}", count.calls);
        assert!(elements[(MOST + 1) * len..].iter().all(|element| *element == MARKER));
        for (k, report) in reports.iter().enumerate() {
            if k < found {
                assert_eq!(report.status, Status::Converged);
                let chain = &elements[k * len..(k + 1) * len];
                assert_eq!(flaw(&kind, report, chain), None, "minimum {k}, stopped at {stop_at}");
                assert!((measure::length(chain) - report.length).abs() < 1e-6 * report.length);
            } else {
                assert_eq!(report.iterations, usize::MAX, "report {k} was touched");
            }
        }
        (found, count.calls, reports)
    };
    let (all, calls, _) = search(0);
    assert!(all >= 2 && calls > 60, "{all} minima in {calls} iterations");
    let mut counts = Vec::new();
    for stop_at in (1..=calls).step_by(29) {
        counts.push(search(stop_at).0);
    }
    assert!(counts[0] == 0 && counts.iter().all(|&count| count <= MOST), "{counts:?}");
    assert!(counts.contains(&1) && counts.contains(&all), "{counts:?}");
}

/// Leaves by a panic.
struct Bolting(usize);

impl Observer for Bolting {
    fn iteration(&mut self, number: usize, _: &Record) -> Control {
        assert_ne!(number, self.0, "I am off");
        Control::Continue
    }
}

#[test]
fn an_observer_that_panics_leaves_the_elements_as_they_were() {
    for kind in kinds() {
        let wanted = clean(&kind);
        let mut workspace = vec![0.0; kind.workspace_len()];
        for bolts_at in [1, wanted.report.iterations.div_ceil(2), wanted.report.iterations] {
            if bolts_at == 0 {
                continue;
            }
            let (mut elements, mut records) = (kind.room(), vec![BLANK; RECORDS]);
            let before = elements.clone();
            let hook = std::panic::take_hook();
            std::panic::set_hook(Box::new(|_| {}));
            let left = catch_unwind(AssertUnwindSafe(|| {
                kind.run(&mut workspace, &mut elements, &mut records, &mut Bolting(bolts_at))
            }));
            std::panic::set_hook(hook);
            assert!(left.is_err(), "{}: iteration {bolts_at} was not seen", kind.name);
            assert!(elements == before, "{}: elements were written", kind.name);
        }
        assert!(bits(&compute(&kind, &mut workspace, &mut Silent)) == bits(&wanted), "{}", kind.name);
    }
}

/// Solves another curve, or the same, at every iteration.
struct Busy<'a> {
    other: &'a Kind,
    wanted: &'a Written,
    workspace: Vec<f64>,
}

impl Observer for Busy<'_> {
    fn iteration(&mut self, _: usize, _: &Record) -> Control {
        let found = compute(self.other, &mut self.workspace, &mut Silent);
        assert!(bits(&found) == bits(self.wanted), "{} within a solve", self.other.name);
        Control::Continue
    }
}

#[test]
fn an_observer_may_solve_in_memory_of_its_own() {
    let all = kinds();
    let find = |name: &str| all.iter().find(|kind| kind.name == name).expect("a kind");
    for [outer, inner] in
        [["points in space", "seven points"], ["seven points", "seven points"], ["obstacles", "a ring"]]
    {
        let (outer, other) = (find(outer), find(inner));
        let (wanted, inner) = (clean(outer), clean(other));
        let mut busy = Busy { other, wanted: &inner, workspace: vec![f64::NAN; other.workspace_len()] };
        let found = compute(outer, &mut vec![0.0; outer.workspace_len()], &mut busy);
        assert!(bits(&found) == bits(&wanted), "{} around {}", outer.name, other.name);
    }
}
