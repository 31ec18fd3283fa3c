//! The kernel allocates nothing: an allocator counts while every public function works, and the functions that were
//! counted are compared with those that `kernel/src` makes public. A program of its own, for the sake of the allocator.

use minvar::basis::bernstein::{Bernstein, RootsError};
use minvar::curve::{
    Continuity, Curve, CurveError, Element, Functional, Joint, MeasureError, Obstacle, OptionName, Options,
    Part, Quantity, Reference, Region, Report, Side,
};
use minvar::solve::{Control, Executor, InOrder, Observer, Record, Settings, Silent, Status};
use minvar::toolpath::{GcodeError, GcodeOptions, Motion, PathError};
use minvar::{basis, curve, solve, toolpath};
use minvar_tests::kinds::{Kind, kinds};
use minvar_tests::toolchain::root;
use minvar_tests::valley::{Rosenbrock, rosenbrock_start};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::fmt::{self, Write};
use std::fs;
use std::hint::black_box;
use std::path::Path;

/// Counts the calls of each thread: tests run side by side.
struct Counting;

thread_local! {
    static CALLS: Cell<usize> = const { Cell::new(0) };
}

fn count_one() {
    CALLS.with(|calls| calls.set(calls.get() + 1));
}

// SAFETY: everything is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_one();
        // SAFETY: promised by the caller.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count_one();
        // SAFETY: promised by the caller.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_one();
        // SAFETY: promised by the caller.
        unsafe { System.realloc(place, layout, size) }
    }
    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        count_one();
        // SAFETY: promised by the caller.
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// What something does with the heap on this thread.
fn calls_of<T>(work: impl FnOnce() -> T) -> (usize, T) {
    let before = CALLS.with(Cell::get);
    let value = black_box(work());
    (CALLS.with(Cell::get) - before, value)
}

/// What was counted: the functions' names, and those that allocated.
#[derive(Default)]
struct Count {
    names: BTreeSet<String>,
    wrong: Vec<String>,
}

impl Count {
    fn note(&mut self, name: String, calls: usize) {
        if calls > 0 {
            self.wrong.push(format!("{name}: {calls} calls of the heap"));
        }
        self.names.insert(name);
    }

    /// `curve::Joint::at` is `curve Joint::at`; the modules of a layer do not matter: `curve::measure::at` is `curve
    /// at`.
    fn function(&mut self, path: &str, calls: usize) {
        let parts: Vec<_> = path.split("::").map(str::trim).collect();
        let [layer, .., last] = parts[..] else { panic!("{path}") };
        let of = parts[parts.len() - 2];
        let method = of.starts_with(|first: char| first.is_ascii_uppercase());
        self.note(if method { format!("{layer} {of}::{last}") } else { format!("{layer} {last}") }, calls);
    }
}

/// A call that must not touch the heap; its name is read off the call itself.
macro_rules! counted {
    ($count:ident, $first:ident $(:: $rest:ident)+ ( $($argument:expr),* $(,)? )) => {{
        let (calls, value) = calls_of(|| $first $(:: $rest)+ ($($argument),*));
        $count.function(concat!(stringify!($first), $("::", stringify!($rest)),+), calls);
        value
    }};
}

/// The same for what a type does by a trait.
macro_rules! counted_trait {
    ($count:ident, $name:literal, $work:expr) => {{
        let (calls, value) = calls_of(|| $work);
        $count.note($name.to_owned(), calls);
        value
    }};
}

/// A page that text fits on or does not.
struct Page {
    text: [u8; 65536],
    used: usize,
}

impl Page {
    const BLANK: Self = Self { text: [0; 65536], used: 0 };
}

impl Write for Page {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.used + text.len();
        self.text.get_mut(self.used..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.used = end;
        Ok(())
    }
}

/// Stops at an iteration.
struct StopAt(usize);

impl Observer for StopAt {
    fn iteration(&mut self, number: usize, _: &Record) -> Control {
        if number == self.0 { Control::Cancel } else { Control::Continue }
    }
}

#[test]
fn the_count_counts() {
    let place = Cell::new(Vec::<u8>::new());
    assert_eq!(calls_of(|| place.set(Vec::with_capacity(black_box(10)))).0, 1);
    assert_eq!(calls_of(|| place.set(vec![0; black_box(1000)])).0, 2, "one is taken, one is given back");
    let grows = || {
        let mut grown = place.take();
        grown.reserve_exact(black_box(5000));
        place.set(grown);
    };
    assert_eq!(calls_of(grows).0, 1);
    assert_eq!(calls_of(|| drop(place.take())).0, 1);
    let mut count = Count::default();
    counted!(count, std::string::String::with_capacity(black_box(9)));
    assert_eq!(count.wrong, ["std String::with_capacity: 1 calls of the heap"]);
}

#[test]
fn no_kind_of_curve_allocates_solved_refused_or_cancelled() {
    for kind in kinds() {
        let mut workspace = vec![f64::NAN; kind.workspace_len()];
        let mut records = vec![Record::ZERO; 100];
        for stop_at in [0, 1, 5] {
            let mut elements = kind.room();
            let (calls, report) =
                calls_of(|| kind.run(&mut workspace, &mut elements, &mut records, &mut StopAt(stop_at)));
            assert_eq!((calls, report.is_ok()), (0, true), "{}, stopped at {stop_at}", kind.name);
        }
        let mut elements = kind.room();
        let (calls, report) =
            calls_of(|| kind.run(&mut workspace[1..], &mut elements, &mut records, &mut Silent));
        assert_eq!((calls, report.is_err()), (0, true), "{}", kind.name);
    }
}

fn basis_layer(count: &mut Count) {
    for points in [0, 2, 12, 32, 33] {
        let rules = [
            counted!(count, basis::quadrature::lobatto(points)),
            counted!(count, basis::quadrature::legendre(points)),
        ];
        for rule in rules.into_iter().flatten() {
            let mut pairs = counted!(count, basis::quadrature::Rule::iter(&rule));
            let (calls, sum) = calls_of(|| pairs.by_ref().map(|(x, weight)| x * weight).sum::<f64>());
            assert!(calls == 0 && (sum - 0.5).abs() < 1e-12);
            assert_eq!(counted!(count, basis::quadrature::Rule::len(&rule)), points);
        }
    }
    counted!(count, basis::hermite::basis(0.3));
    counted!(count, basis::hermite::fourth(0.3));
    let rows = [[0.0, 1.0], [1.0, 0.0], [0.2, 0.1], [0.0, 0.3], [1.0, 1.0], [1.0, 2.0]];
    let points = counted!(count, basis::hermite::to_bezier(&rows));
    counted!(count, basis::hermite::from_bezier(&points));

    let wave = counted!(count, basis::bernstein::Bernstein::new([-1.0, 3.0, -3.0, 1.0]));
    let line = counted!(count, basis::bernstein::Bernstein::from_slice(&[0.5, -0.5])).expect("short enough");
    assert_eq!(counted!(count, basis::bernstein::Bernstein::from_slice(&[1.0; 40])), None);
    counted!(count, basis::bernstein::Bernstein::degree(&wave));
    counted!(count, basis::bernstein::Bernstein::coefficients(&wave));
    counted!(count, basis::bernstein::Bernstein::value(&wave, 0.3));
    counted!(count, basis::bernstein::Bernstein::derivative(&wave));
    counted!(count, basis::bernstein::Bernstein::elevated(&wave, 30));
    counted!(count, basis::bernstein::Bernstein::restricted(&wave, 0.2, 0.7));
    counted!(count, basis::bernstein::Bernstein::range(&wave));
    assert_eq!(counted!(count, basis::bernstein::Bernstein::roots(&wave)).map(|roots| roots.len()), Ok(3));
    let zero = counted!(count, basis::bernstein::Bernstein::constant(0.0));
    let error = counted!(count, basis::bernstein::Bernstein::roots(&zero)).expect_err("zero everywhere");
    assert_eq!(error, RootsError::Zero);
    counted_trait!(count, "basis Add for Bernstein", wave + line);
    counted_trait!(count, "basis Sub for Bernstein", wave - line);
    let product: Bernstein = counted_trait!(count, "basis Mul for Bernstein", wave * line * 2.0);
    let large = counted!(count, basis::bernstein::Bernstein::elevated(&product, 31));
    counted_trait!(count, "basis Mul for Bernstein", large * large);
    let mut page = Page::BLANK;
    for error in [RootsError::Zero, RootsError::NotFinite] {
        counted_trait!(count, "basis Display for RootsError", write!(page, "{error}")).expect("room");
    }
}

fn solve_layer(count: &mut Count) {
    let problem = Rosenbrock { count: 12 };
    let len = counted!(count, solve::workspace_len(&problem, 1));
    let (mut workspace, mut state) = (vec![f64::NAN; len], rosenbrock_start(12));
    let mut records = vec![Record::ZERO; 9];
    let settings = counted_trait!(count, "solve Default for Settings", Settings::default());
    for given in [len - 1, len] {
        let result = counted!(
            count,
            solve::minimise(
                &problem,
                &settings,
                &InOrder,
                &mut state,
                &mut workspace[..given],
                &mut records,
                &mut Silent
            )
        );
        assert_eq!(result.is_ok(), given == len);
    }
    counted!(count, solve::packed(3, 2));
    counted!(count, solve::packed_len(3));
    counted!(count, solve::Coupled::plain([1.0, 2.0]));
    counted!(count, solve::Status::sentence(Status::Stalled));
    counted!(count, solve::Status::name(Status::Stalled));
    counted_trait!(count, "solve Observer for Silent", Silent.iteration(1, &Record::ZERO));
    let mut slots = [0.0; 6];
    let work = |index: usize, slot: &mut [f64]| slot[0] = index as f64;
    let mut in_order = || (InOrder.width(), InOrder.run(&mut slots, 2, &work));
    counted_trait!(count, "solve Executor for InOrder", in_order());
    assert_eq!(slots, [0.0, 0.0, 1.0, 0.0, 2.0, 0.0]);
}

fn joints_and_errors(count: &mut Count) {
    let quantity = counted!(count, curve::Quantity::initial([1.0, 0.0, 0.0]));
    counted!(count, curve::Quantity::fixed([1.0, 0.0, 0.0]));
    counted!(count, curve::Quantity::of_size([0.0, 1.0, 0.0]));
    let joint: Joint = counted!(count, curve::Joint::at([0.0; 3]));
    let joint = counted!(count, curve::Joint::on_line(joint, [0.0; 3], [1.0, 0.0, 0.0]));
    let joint = counted!(count, curve::Joint::on_plane(joint, [0.0; 3], [1.0, 0.0, 0.0]));
    let joint = counted!(count, curve::Joint::with_continuity(joint, Continuity::G1));
    let joint = counted!(count, curve::Joint::with_position(joint, quantity));
    let joint = counted!(count, curve::Joint::with_tangent(joint, quantity));
    counted!(count, curve::Joint::with_curvature(joint, Quantity::FREE));
    let obstacle = counted!(count, curve::Obstacle::point([1.0; 3], 0.5, Side::LEFT));
    counted!(count, curve::Obstacle::segment([1.0; 3], [2.0; 3], 0.5, Side::RIGHT));
    let joints = [joint; 3];
    let through: Curve<'_> = counted!(count, curve::Curve::open(&joints));
    let through =
        counted!(count, curve::Curve::with_obstacles(through, std::slice::from_ref::<Obstacle>(&obstacle)));
    let reference = Reference { elements: &[], weight: 0.0 };
    let through = counted!(count, curve::Curve::with_reference(through, reference));
    assert_eq!(counted!(count, curve::Curve::spans(&through)), 2);
    counted!(count, curve::Curve::new(&joints, true));
    assert!(counted!(count, curve::Functional::is_known(Functional::MVC)));
    let options = counted_trait!(count, "curve Default for Options", Options::default());
    assert_eq!(options, Options::DEFAULT);

    let mut page = Page::BLANK;
    let (joint, element, needed, given) = (3, 4, 5, 6);
    for error in [
        CurveError::TooFewJoints { given },
        CurveError::ClosedTooFewJoints { given },
        CurveError::NotFinite { joint, part: Part::Guide },
        CurveError::UnknownCode { joint, part: Part::Position },
        CurveError::CoincidentJoints { joint, next: 4 },
        CurveError::ZeroTangent { joint },
        CurveError::ZeroGuide { joint },
        CurveError::LengthTooShort,
        CurveError::WrongElementCount { needed, given },
        CurveError::BadObstacle { obstacle: 1 },
        CurveError::ObstaclesNotPossible,
        CurveError::BadRegion { first: 1, count: 2, elements: 2 },
        CurveError::BadRegion { first: 1, count: 0, elements: 2 },
        CurveError::BadElement { element },
        CurveError::CurvatureNotPerpendicular { joint },
        CurveError::CurvatureNeedsTangent { joint },
        CurveError::SidesDiffer { joint, part: Part::Tangent },
        CurveError::NoPosition,
        CurveError::SizeOutOfRange,
        CurveError::NotPlanar,
        CurveError::BadOption(OptionName::Tolerance),
        CurveError::WorkspaceTooSmall { needed, given },
        CurveError::ElementsTooShort { needed, given },
    ] {
        counted_trait!(count, "curve Display for CurveError", write!(page, "{error}")).expect("room");
    }
    for error in [
        MeasureError::NoElements,
        MeasureError::NotFinite { element },
        MeasureError::Irregular { element },
        MeasureError::OutOfRange,
        MeasureError::TooShort { needed, given },
    ] {
        counted_trait!(count, "curve Display for MeasureError", write!(page, "{error}")).expect("room");
    }
}

/// Solves by the functions themselves; returns a solved chain.
fn curves(count: &mut Count, kind: &Kind) -> Vec<Element> {
    let (data, options) = (kind.curve(), kind.options);
    let len = counted!(count, curve::workspace_len(&data, &options)).expect("good data");
    let each = counted!(count, curve::elements_len(&data, &options));
    let mut workspace = vec![0.0; len];
    let mut elements = vec![Element::ZERO; 4 * each];
    let mut records = vec![Record::ZERO; 9];
    let report = counted!(
        count,
        curve::solve(&data, &options, &mut workspace, &mut elements, &mut records, &mut Silent)
    );
    let report = report.expect("good data");
    assert_eq!(report.status, Status::Converged);
    let solved = elements[..each].to_vec();
    let again = counted!(
        count,
        curve::update(&data, &options, &mut workspace, &mut elements, &mut records, &mut Silent)
    );
    assert!(again.is_ok());
    let mut reports = vec![report; 3];
    let found = counted!(
        count,
        curve::minima(&data, &options, &mut workspace, &mut elements, &mut reports, &mut Silent)
    );
    assert!(found.is_ok_and(|found| found > 0));
    let mut values = vec![0.0; 3];
    let found = counted!(
        count,
        curve::minima_as(
            &data,
            &options,
            &mut workspace,
            &mut elements,
            &mut values,
            |report: &Report| report.value,
            |value: &f64| [*value, report.length, report.bending],
            &mut Silent
        )
    );
    assert!(found.is_ok());
    solved
}

fn chains(count: &mut Count, chain: &[Element]) {
    counted!(count, curve::Element::derivatives(&chain[0], 0.5));
    counted!(count, curve::Element::point(&chain[0], 0.5));
    counted!(count, curve::Element::bezier(&chain[0]));
    counted!(count, curve::measure::check(chain)).expect("a good chain");
    counted!(count, curve::measure::plane_normal(chain)).expect("a planar chain");
    let place = counted!(count, curve::measure::at(chain, 1, 0.5)).expect("a place");
    assert!(counted!(count, curve::measure::at(chain, 99, 0.5)).is_err());
    counted!(count, curve::measure::at_length(chain, 1.5)).expect("a place");
    counted!(count, curve::measure::closest(chain, [3.0, 3.0, 0.0])).expect("a place");
    counted!(count, curve::measure::length(chain));
    counted!(count, curve::measure::variation(chain));
    counted!(count, curve::measure::bending(chain));
    counted!(count, curve::measure::curvature_range(chain)).expect("a regular chain");
    counted!(count, curve::measure::bounding_box(chain)).expect("a good chain");
    let held = counted!(count, curve::Joint::held_at(&place));
    let mut joints = [held, Joint::at([3.0, 2.6, 0.0])];
    let region = Region { elements: chain, closed: false, first: 1, count: 2 };
    assert!(counted!(count, curve::Region::hold(&region, &mut joints)).is_ok());
    let (controls, knots) = counted!(count, curve::convert::bspline_len(chain));
    let (mut controls, mut knots) = (vec![[0.0; 3]; controls], vec![0.0; knots]);
    assert!(counted!(count, curve::convert::bspline(chain, &mut controls, &mut knots[1..])).is_err());
    counted!(count, curve::convert::bspline(chain, &mut controls, &mut knots)).expect("room");
}

fn paths(count: &mut Count, chain: &[Element]) {
    let mut chords = counted!(count, toolpath::chords(chain, 1e-4)).expect("a good chain");
    counted!(count, toolpath::Chords::point(&chords));
    assert!(counted_trait!(count, "toolpath Iterator for Chords", chords.by_ref().count()) > 10);
    let mut arcs = counted!(count, toolpath::arcs(chain, 1e-4)).expect("a planar chain");
    counted!(count, toolpath::Arcs::start(&arcs));
    counted!(count, toolpath::Arcs::height(&arcs));
    assert!(counted_trait!(count, "toolpath Iterator for Arcs", arcs.by_ref().count()) > 5);
    let pair =
        counted!(count, toolpath::biarc([0.0; 2], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0])).expect("a pair");
    counted!(count, toolpath::Arc::motion(&pair[0]));
    let options: GcodeOptions = counted!(count, toolpath::GcodeOptions::new(1e-3, 600.0, 5.0));
    let mut page = Page::BLANK;
    for motion in [Motion::Arcs, Motion::Chords] {
        let options = GcodeOptions { motion, comments: true, ..options };
        assert!(counted!(count, toolpath::write_gcode(chain, &options, &mut page)).is_ok());
    }
    page.used = page.text.len() - 20;
    assert_eq!(counted!(count, toolpath::write_gcode(chain, &options, &mut page)), Err(GcodeError::Write));
    let from = || [GcodeError::from(fmt::Error), GcodeError::from(PathError::Tolerance)];
    counted_trait!(count, "toolpath From for GcodeError", from());
    let (mut page, element, finest) = (Page::BLANK, 4, 1e-9);
    for error in [
        PathError::NoElements,
        PathError::Tolerance,
        PathError::ToleranceTooFine { finest },
        PathError::NotFinite { element },
        PathError::Gap { element },
        PathError::NotPlanar { element },
        PathError::Irregular { element },
    ] {
        counted_trait!(count, "toolpath Display for PathError", write!(page, "{error}")).expect("room");
        let error = GcodeError::from(error);
        counted_trait!(count, "toolpath Display for GcodeError", write!(page, "{error}")).expect("room");
    }
    for error in [
        GcodeError::ToleranceBelowDecimals { finest },
        GcodeError::Decimals,
        GcodeError::Feed,
        GcodeError::PlungeFeed,
        GcodeError::Depth,
        GcodeError::SafeHeight { cut: 1.5 },
        GcodeError::CoordinateTooLarge { element },
        GcodeError::Write,
    ] {
        counted_trait!(count, "toolpath Display for GcodeError", write!(page, "{error}")).expect("room");
    }
}

/// What is left of a type or trait without its path and its parameters.
fn plain(name: &str) -> &str {
    let name = name.split('<').next().unwrap_or_default().trim();
    name.rsplit("::").next().unwrap_or_default()
}

/// What a source file makes public: functions by themselves, methods with their type, and traits of `public` types. It
/// leans on rustfmt's layout, and on the lint `unreachable_pub`: what is `pub` can be reached.
fn public_functions(layer: &str, text: &str, public: &BTreeSet<String>, found: &mut BTreeSet<String>) {
    let mut of: Option<&str> = None;
    for line in text.lines() {
        if let Some(head) = line.strip_prefix("impl") {
            // After the parameters of the `impl` itself, which may hold brackets of their own.
            let mut depth = 0;
            let head = head.trim_end_matches(" {");
            let start = head.find(|c: char| {
                depth += i32::from(c == '<') - i32::from(c == '>');
                depth == 0 && c == ' '
            });
            let head = head[start.map_or(0, |start| start + 1)..].trim_end_matches(" {}");
            if let Some((by, whose)) = head.split_once(" for ") {
                let (by, whose) = (plain(by), plain(whose));
                // Errors add no function of their own.
                if public.contains(whose) && by != "Error" {
                    found.insert(format!("{layer} {by} for {whose}"));
                }
                of = None;
            } else {
                of = Some(plain(head));
            }
        }
        if line == "}" {
            of = None;
        }
        let code = line.trim_start();
        let function = ["pub fn ", "pub const fn "].into_iter().find_map(|start| code.strip_prefix(start));
        if let Some(rest) = function {
            let name = rest.split(['(', '<']).next().unwrap_or_default();
            found.insert(match of {
                Some(of) => format!("{layer} {of}::{name}"),
                None => format!("{layer} {name}"),
            });
        }
    }
}

/// All source files of a layer, without their tests.
fn sources(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a layer") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs")
            && path.file_stem() != Some("tests".as_ref())
        {
            let text = fs::read_to_string(&path).expect("a source");
            found.push(text.split("#[cfg(test)]").next().unwrap_or_default().to_owned());
        }
    }
    found
}

#[test]
fn no_public_function_of_the_kernel_allocates_and_none_is_left_out() {
    let mut count = Count::default();
    basis_layer(&mut count);
    solve_layer(&mut count);
    joints_and_errors(&mut count);
    let kind = kinds().into_iter().find(|kind| kind.name == "seven points").expect("a kind");
    let chain = curves(&mut count, &kind);
    chains(&mut count, &chain);
    paths(&mut count, &chain);
    assert!(count.wrong.is_empty(), "{}", count.wrong.join("\n"));

    let lib = fs::read_to_string(root().join("kernel/src/lib.rs")).expect("kernel/src/lib.rs");
    let layers: Vec<_> = lib
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .map(|layer| (layer, sources(&root().join("kernel/src").join(layer))))
        .collect();
    let mut public = BTreeSet::new();
    for line in layers.iter().flat_map(|(_, texts)| texts).flat_map(|text| text.lines()) {
        let declared = ["pub struct ", "pub enum "].into_iter().find_map(|start| line.strip_prefix(start));
        public.extend(
            declared.map(|rest| rest.split([' ', '<', '(', ';']).next().unwrap_or_default().to_owned()),
        );
    }
    let mut wanted = BTreeSet::new();
    for (layer, texts) in &layers {
        texts.iter().for_each(|text| public_functions(layer, text, &public, &mut wanted));
    }
    assert!(wanted.len() > 80 && wanted.contains("curve Joint::at") && wanted.contains("solve minimise"));
    let left_out: Vec<_> = wanted.difference(&count.names).collect();
    let unknown: Vec<_> = count.names.difference(&wanted).collect();
    assert!(
        left_out.is_empty() && unknown.is_empty(),
        "not counted: {left_out:?}; not in kernel/src: {unknown:?}"
    );
}
