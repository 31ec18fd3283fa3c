//! The functions of the C boundary that compute curves: any joints, options, obstacles and references, in memory of any
//! length, watched by observers that cancel, lie and call back.

use crate::answer::{Answer, TURNS, Turn, ask};
use crate::coder::{Coder, Reading};
use crate::data;
use crate::memory::{Fault, Room};
use crate::result::Solved;
use minvar_ffi::minvar_code::{self, *};
use minvar_ffi::minvar_status::*;
use minvar_ffi::*;
use std::cell::RefCell;
use std::ffi::c_void;

/// What a curve's data and options may be refused for.
const LISTED: [minvar_code; 22] = [
    MINVAR_TOO_FEW_JOINTS,
    MINVAR_CLOSED_TOO_FEW_JOINTS,
    MINVAR_JOINT_NOT_FINITE,
    MINVAR_UNKNOWN_CODE,
    MINVAR_COINCIDENT_JOINTS,
    MINVAR_ZERO_TANGENT,
    MINVAR_CURVATURE_NOT_PERPENDICULAR,
    MINVAR_CURVATURE_NEEDS_TANGENT,
    MINVAR_SIDES_DIFFER,
    MINVAR_NO_POSITION,
    MINVAR_SIZE_OUT_OF_RANGE,
    MINVAR_NOT_PLANAR,
    MINVAR_BAD_OPTION,
    MINVAR_WORKSPACE_TOO_SMALL,
    MINVAR_RESULT_TOO_SHORT,
    MINVAR_ZERO_GUIDE,
    MINVAR_LENGTH_TOO_SHORT,
    MINVAR_WRONG_ELEMENT_COUNT,
    MINVAR_BAD_REFERENCE,
    MINVAR_BAD_OBSTACLE,
    MINVAR_OBSTACLES_NOT_POSSIBLE,
    MINVAR_BAD_REGION,
];

/// Larger problems are asked about but not solved: an input has a second or two.
const MOST_ELEMENTS: usize = 24;
/// No observer lets a computation go on for longer.
const MOST_ITERATIONS: usize = 24;
/// Room where the length that is needed is not known.
const SOME_ROOM: usize = 64;

/// Everything that one input says.
#[derive(Clone)]
pub struct Case {
    /// Which function: the first of [`Kind`]'s.
    pub kind: u8,
    /// As in `minvar_curve`.
    pub closed: u32,
    /// The joints.
    pub joints: Vec<minvar_joint>,
    /// The obstacles.
    pub obstacles: Vec<minvar_obstacle>,
    /// The reference shape, or where an update starts.
    pub chain: Vec<minvar_element>,
    /// Whether the chain is a reference.
    pub refers: u8,
    /// The reference's weight.
    pub weight: f64,
    /// The options.
    pub options: minvar_options,
    /// Which pointer is wrong, if any.
    pub fault: u8,
    /// How much longer or shorter than needed memory is.
    pub room: u8,
    /// What the observer does.
    pub watcher: u8,
    /// How far the joints move before an update.
    pub moved: [f64; 3],
    /// The region, or the number of minima.
    pub part: [u8; 2],
}

impl Default for Case {
    fn default() -> Self {
        Self {
            kind: 0,
            closed: 0,
            joints: Vec::new(),
            obstacles: Vec::new(),
            chain: Vec::new(),
            refers: 0,
            weight: 0.0,
            options: minvar_options_defaults(),
            fault: 0,
            room: 0,
            watcher: 0,
            moved: [0.0; 3],
            part: [0; 2],
        }
    }
}

impl Case {
    /// The fields in order.
    pub fn code<C: Coder>(&mut self, c: &mut C) {
        c.byte(&mut self.kind);
        c.one_of(&mut self.closed, &[0, 0, 1, 1, u32::MAX, 0x8000_0000]);
        c.list(&mut self.joints, 5, data::NO_JOINT, data::joint);
        data::options(c, &mut self.options);
        c.byte(&mut self.watcher);
        c.byte(&mut self.room);
        c.byte(&mut self.fault);
        self.part.iter_mut().for_each(|part| c.byte(part));
        c.vector(&mut self.moved);
        c.list(&mut self.obstacles, 3, data::NO_OBSTACLE, data::obstacle);
        c.byte(&mut self.refers);
        c.number_of(&mut self.weight, &[1.0, 0.5, 0.0, 1.5]);
        data::elements(c, &mut self.chain, 6);
    }
}

/// Which functions a case is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// `minvar_curve_solve`.
    Solve,
    /// `minvar_curve_update` from the solution, the joints moved.
    Drag,
    /// `minvar_curve_minima`.
    Minima,
    /// `minvar_region_hold` in the solution, then `minvar_curve_update`.
    Region,
    /// `minvar_curve_update` from any elements.
    Update,
    /// `minvar_region_hold` in any elements.
    Hold,
}

impl Kind {
    fn of(choice: u8) -> Self {
        match choice % 16 {
            0..8 => Self::Solve,
            8 | 9 => Self::Drag,
            10 | 11 => Self::Minima,
            12 | 13 => Self::Region,
            14 => Self::Update,
            _ => Self::Hold,
        }
    }
}

/// Runs an input.
pub fn run(bytes: &[u8]) {
    let mut case = Case::default();
    case.code(&mut Reading::new(bytes));
    if crate::shows() {
        case.show();
    }
    case.check();
}

/// The curve of a call, in memory of its own.
struct Data {
    joints: Room<minvar_joint>,
    obstacles: Room<minvar_obstacle>,
    reference: Room<minvar_element>,
    curve: Room<minvar_curve>,
    options: Room<minvar_options>,
}

impl Data {
    fn new(case: &Case, joints: &[minvar_joint], fault: &Fault) -> Self {
        let refers = if case.refers % 4 == 1 { &case.chain[..] } else { &[] };
        let (mut joints, mut obstacles, mut reference) =
            (Room::of(joints), Room::of(&case.obstacles), Room::of(refers));
        let (joints_at, joint_count) = fault.array(6, "curve->joints", joints.pointer(), joints.len());
        let (obstacles_at, obstacle_count) =
            fault.array(7, "curve->obstacles", obstacles.pointer(), obstacles.len());
        let (reference_at, reference_count) = match reference.len() {
            0 => (std::ptr::null_mut(), 0),
            len => fault.array(8, "curve->reference", reference.pointer(), len),
        };
        let curve = Room::of(&[minvar_curve {
            joints: joints_at,
            joint_count,
            closed: case.closed as i32,
            reference: reference_at,
            reference_count,
            reference_weight: case.weight,
            obstacles: obstacles_at,
            obstacle_count,
        }]);
        Self { joints, obstacles, reference, curve, options: Room::of(&[case.options]) }
    }

    fn pointers(&mut self, fault: &Fault) -> (*const minvar_curve, *const minvar_options) {
        let curve = fault.pointer(0, "curve", self.curve.pointer());
        (curve, fault.pointer(1, "options", self.options.pointer()))
    }

    /// That the call left its input as it was.
    fn is_unchanged(&self, case: &Case, joints: &[minvar_joint]) -> bool {
        // SAFETY: they were copied from slices and are numbers.
        let (mine, obstacles, reference, options) = unsafe {
            (
                self.joints.first(self.joints.len()),
                self.obstacles.first(self.obstacles.len()),
                self.reference.first(self.reference.len()),
                &self.options.first(1)[0],
            )
        };
        let same = |a: &[f64; 3], b: &[f64; 3]| a.map(f64::to_bits) == b.map(f64::to_bits);
        mine.iter().zip(joints).all(|(a, b)| joint_bits(a) == joint_bits(b))
            && obstacles.iter().zip(&case.obstacles).all(|(a, b)| {
                same(&a.from, &b.from)
                    && same(&a.to, &b.to)
                    && (a.clearance.to_bits(), a.side) == (b.clearance.to_bits(), b.side)
            })
            && reference
                .iter()
                .zip(&case.chain)
                .all(|(a, b)| a.rows.iter().zip(&b.rows).all(|(a, b)| same(a, b)))
            && options.max_iterations == case.options.max_iterations
            && options.length.to_bits() == case.options.length.to_bits()
    }
}

/// An observer: counts, stops the work or lets it go on, calls the library itself.
struct Watcher {
    stops_after: usize,
    /// What it returns to stop.
    answer: i32,
    calls_back: bool,
    /// Whether every solve begins with iteration 1 anew.
    restarts: bool,
    seen: RefCell<Vec<(usize, minvar_record)>>,
    stopped: RefCell<bool>,
}

impl Watcher {
    fn new(choice: u8, restarts: bool) -> Self {
        let stops = choice % 4 == 1;
        let early = usize::from(choice / 16);
        Self {
            stops_after: if stops { early } else { MOST_ITERATIONS },
            answer: [1, -1, i32::MIN, 256][usize::from(choice / 4 % 4)],
            calls_back: choice % 4 == 2,
            restarts,
            seen: RefCell::default(),
            stopped: RefCell::new(false),
        }
    }
}

unsafe extern "C" fn watch(context: *mut c_void, iteration: usize, record: *const minvar_record) -> i32 {
    // SAFETY: the context is the watcher, which outlives the call.
    let watcher = unsafe { &*context.cast::<Watcher>() };
    // SAFETY: promised by the library.
    let record = unsafe { *record };
    assert!(!*watcher.stopped.borrow(), "called again after it said stop");
    let mut seen = watcher.seen.borrow_mut();
    let before = seen.last().map_or(0, |(number, _)| *number);
    let begins = watcher.restarts && iteration == 1;
    assert!(iteration == before + 1 || begins, "iteration {iteration} after {before}");
    seen.push((iteration, record));
    if watcher.calls_back {
        half_circle();
    }
    let stop = seen.len() > watcher.stops_after;
    *watcher.stopped.borrow_mut() = stop;
    if stop { watcher.answer } else { 0 }
}

/// A curve computed while another one is: the same bits every time.
fn half_circle() {
    thread_local!(static LENGTH: RefCell<Option<u64>> = const { RefCell::new(None) });
    let joint = |x, y| minvar_joint_with_tangent(minvar_joint_at(x, 0.0, 0.0), 2, 0.0, y, 0.0);
    let joints = [joint(-1.0, 1.0), joint(1.0, -1.0)];
    let curve = minvar_curve_through(joints.as_ptr(), 2, 0);
    let options = minvar_options_defaults();
    let (mut workspace, mut element, mut report) = (Room::<f64>::new(512, 0xff), Room::one(0), Room::one(0));
    // SAFETY: everything is as long as is said.
    let code = unsafe {
        minvar_curve_solve(
            &curve,
            &options,
            workspace.pointer(),
            512,
            None,
            std::ptr::null_mut(),
            element.pointer(),
            1,
            std::ptr::null_mut(),
            0,
            report.pointer(),
            std::ptr::null_mut(),
        )
    };
    assert_eq!(code, MINVAR_OK);
    // SAFETY: the call wrote it.
    let length = unsafe { report.first(1)[0] }.length.to_bits();
    LENGTH.with_borrow_mut(|first| assert_eq!(*first.get_or_insert(length), length));
}

/// What one call gave.
struct Done {
    answer: Answer,
    elements: Vec<minvar_element>,
    /// The bytes of all that was written.
    written: Vec<u8>,
}

impl Done {
    fn same(&self, other: &Self) {
        self.answer.same(&other.answer);
        assert!(self.written == other.written, "the same call gave other bits");
    }
}

impl Case {
    fn show(&self) {
        eprintln!("{:?}, closed {}", Kind::of(self.kind), self.closed);
        self.joints.iter().for_each(|joint| eprintln!("{:?}", data::kernel_joint(joint)));
        let o = &self.options;
        eprintln!(
            "functional {}, elements_per_span {}, quadrature_points {}, max_iterations {}, dimension {}, continuation {}, \
             relative_decrease {:e}, tension {:e}, bending {:e}, length {:e}, tolerance {:e}",
            o.functional,
            o.elements_per_span,
            o.quadrature_points,
            o.max_iterations,
            o.dimension,
            o.continuation,
            o.relative_decrease,
            o.tension,
            o.bending,
            o.length,
            o.tolerance
        );
        for o in &self.obstacles {
            eprintln!("obstacle {:?} {:?} clearance {:e} side {}", o.from, o.to, o.clearance, o.side);
        }
        eprintln!(
            "fault {}, room {}, watcher {}, moved {:?}, part {:?}, refers {}, weight {:e}",
            self.fault, self.room, self.watcher, self.moved, self.part, self.refers, self.weight
        );
        self.chain.iter().for_each(|element| eprintln!("element {:?}", element.rows));
    }

    fn is_closed(&self) -> bool {
        self.closed != 0
    }

    /// Makes the calls and holds them to what is promised.
    pub fn check(&self) {
        match Kind::of(self.kind) {
            Kind::Hold => self.hold(&self.chain, true, Fault::new(self.fault)),
            kind => self.compute(kind),
        }
    }

    fn compute(&self, kind: Kind) {
        let lens = match self.lens(&self.joints, Fault::new(self.fault)) {
            Ok(lens) => lens,
            Err(answer) => return self.refused(&answer),
        };
        let [_, elements_len] = lens;
        match kind {
            Kind::Minima => self.minima(lens),
            Kind::Update => {
                let start: Vec<_> = self.chain.iter().cycle().take(elements_len).copied().collect();
                if elements_len <= MOST_ELEMENTS && start.len() == elements_len {
                    self.twice(&self.joints, Some(&start), lens, Fault::new(self.fault));
                }
            }
            _ => {
                let Some(solved) = self.twice(&self.joints, None, lens, Fault::new(self.fault)) else {
                    return;
                };
                if kind == Kind::Drag {
                    self.drag(&solved);
                } else if kind == Kind::Region {
                    self.hold(&solved.elements, false, Fault::none());
                }
            }
        }
    }

    /// What the workspace's length was refused for, solving is refused for.
    fn refused(&self, answer: &Answer) {
        let mut before: Option<Done> = None;
        for turn in TURNS {
            let fault = Fault::new(self.fault);
            let done = self.once(turn, &self.joints, None, [SOME_ROOM, SOME_ROOM, 0], &fault);
            let by_pointer = answer.is_by_pointer() || fault.expected().is_some() || fault.is_misaligned(15);
            assert!(by_pointer || done.answer.code == answer.code, "{answer:?} and then {:?}", done.answer);
            if let Some(before) = &before {
                before.same(&done);
            }
            before = Some(done);
        }
    }

    /// Both lengths that a curve needs: workspace and elements.
    fn lens(&self, joints: &[minvar_joint], fault: Fault) -> Result<[usize; 2], Answer> {
        let mut found: Option<(Answer, usize, usize)> = None;
        for turn in TURNS {
            let fault = &fault;
            fault.begin();
            let mut data = Data::new(self, joints, fault);
            let (curve, options) = data.pointers(fault);
            // SAFETY: NULL, misaligned, or as long as is said.
            let elements_len = unsafe { minvar_curve_elements_len(curve, options) };
            if fault.expected().is_some() {
                assert_eq!(elements_len, 0, "the length of a curve that cannot be looked at");
            }
            let mut len = Room::<usize>::one(turn.fill);
            let len_at = fault.pointer(9, "len", len.pointer());
            let answer = ask(turn, fault, &LISTED[..], |error| {
                // SAFETY: as above.
                unsafe { minvar_curve_workspace_len(curve, options, len_at, error) }
            });
            let workspace_len = if answer.is_ok() {
                // SAFETY: any bytes are a number.
                unsafe { len.first(1)[0] }
            } else {
                assert!(len.is_untouched(), "{answer:?}, but a length was written");
                0
            };
            if let Some((before, workspace, elements)) = &found {
                before.same(&answer);
                assert_eq!((*workspace, *elements), (workspace_len, elements_len), "other lengths");
            }
            found = Some((answer, workspace_len, elements_len));
        }
        let (answer, workspace, elements) = found.expect("there are two turns");
        if answer.is_ok() { Ok([workspace, elements]) } else { Err(answer) }
    }

    /// Solves, or updates from a start, twice; `None` where that is refused.
    fn twice(
        &self,
        joints: &[minvar_joint],
        start: Option<&[minvar_element]>,
        [workspace_len, elements_len]: [usize; 2],
        fault: Fault,
    ) -> Option<Done> {
        // What is too large for a test is given too little memory, and must say so.
        let large = elements_len > MOST_ELEMENTS;
        let workspace_given = match self.room % 8 {
            _ if large => SOME_ROOM,
            1 => workspace_len.saturating_sub(1),
            2 => workspace_len + 3,
            3 => 0,
            _ => workspace_len,
        };
        let elements_given = match self.room / 8 % 8 {
            _ if large => SOME_ROOM,
            1 => elements_len.saturating_sub(1),
            2 => elements_len + 2,
            3 => 0,
            _ => elements_len,
        };
        let records_given = [0, 0, 1, 3, 40][usize::from(self.room / 64 % 5)];
        let mut before: Option<Done> = None;
        for turn in TURNS {
            let given = [workspace_given, elements_given, records_given];
            let done = self.once(turn, joints, start, given, &fault);
            if let Some(code) = [
                (workspace_given < workspace_len, MINVAR_WORKSPACE_TOO_SMALL),
                (elements_given < elements_len, MINVAR_RESULT_TOO_SHORT),
            ]
            .into_iter()
            .find_map(|(short, code)| (short && done.answer.code == code).then_some(code))
            {
                assert!(start.is_none() || code != MINVAR_OK);
            } else if fault.expected().is_none() && !fault.is_misaligned(15) {
                assert!(
                    !matches!(done.answer.code, MINVAR_WORKSPACE_TOO_SMALL | MINVAR_RESULT_TOO_SHORT)
                        && (!done.answer.is_ok()
                            || (workspace_given >= workspace_len && elements_given >= elements_len)),
                    "{:?}: {workspace_given} of {workspace_len}, {elements_given} of {elements_len}",
                    done.answer
                );
            }
            if let Some(before) = &before {
                before.same(&done);
            }
            before = Some(done);
        }
        before.filter(|done| done.answer.is_ok())
    }

    /// One call in memory of its own.
    fn once(
        &self,
        turn: Turn,
        joints: &[minvar_joint],
        start: Option<&[minvar_element]>,
        [workspace_given, elements_given, records_given]: [usize; 3],
        fault: &Fault,
    ) -> Done {
        fault.begin();
        let mut data = Data::new(self, joints, fault);
        let watcher = Watcher::new(self.watcher, false);
        let (curve, options) = data.pointers(fault);
        let mut workspace = Room::<f64>::new(workspace_given, turn.fill);
        let mut elements = match start {
            Some(start) => Room::of(&start[..elements_given.min(start.len())]),
            None => Room::<minvar_element>::new(elements_given, turn.fill),
        };
        let untouched = elements.bytes().to_vec();
        let mut records = Room::<minvar_record>::new(records_given, turn.fill);
        let mut report = Room::<minvar_report>::one(turn.fill);
        let (workspace_at, workspace_len) = fault.array(2, "workspace", workspace.pointer(), workspace.len());
        let (elements_at, elements_len) = fault.array(3, "elements", elements.pointer(), elements.len());
        let report_at = fault.pointer(5, "report", report.pointer());
        let watched = self.watcher % 4 != 3 || self.options.max_iterations as usize > MOST_ITERATIONS;
        let observer: minvar_observer = if watched { Some(watch) } else { None };
        let context = (&raw const watcher).cast_mut().cast::<c_void>();
        let answer = if start.is_some() {
            ask(turn, fault, &LISTED, |error| {
                // SAFETY: every pointer is NULL, misaligned, or to room of just the length that is said.
                unsafe {
                    minvar_curve_update(
                        curve,
                        options,
                        workspace_at,
                        workspace_len,
                        observer,
                        context,
                        elements_at,
                        elements_len,
                        report_at,
                        error,
                    )
                }
            })
        } else {
            let (records_at, records_len) = fault.array(4, "records", records.pointer(), records.len());
            ask(turn, fault, &LISTED, |error| {
                // SAFETY: as above.
                unsafe {
                    minvar_curve_solve(
                        curve,
                        options,
                        workspace_at,
                        workspace_len,
                        observer,
                        context,
                        elements_at,
                        elements_len,
                        records_at,
                        records_len,
                        report_at,
                        error,
                    )
                }
            })
        };
        assert!(data.is_unchanged(self, joints), "the call changed its input");
        let seen = watcher.seen.borrow();
        if !answer.is_ok() {
            assert!(
                elements.bytes() == untouched && records.is_untouched() && report.is_untouched(),
                "{answer:?}, but a result was written"
            );
            assert!(seen.is_empty(), "{answer:?}, but there was an iteration");
            return Done { answer, elements: Vec::new(), written: Vec::new() };
        }
        // SAFETY: the call wrote it; checked against the statuses' numbers below by being matched.
        let found = unsafe { report.first(1)[0] };
        assert!(found.elements <= elements.len() && found.elements > 0, "{} elements", found.elements);
        let size = size_of::<minvar_element>();
        assert!(
            elements.bytes()[found.elements * size..] == untouched[found.elements * size..],
            "elements beyond the last were written"
        );
        let kept = if start.is_some() { 0 } else { found.iterations.min(records.len()) };
        assert!(records.is_untouched_from(kept), "records beyond the last were written");
        // SAFETY: any bytes are numbers.
        let (made, kept) = unsafe { (elements.first(found.elements).to_vec(), records.first(kept)) };
        if watched {
            assert_eq!(*watcher.stopped.borrow(), found.status == MINVAR_CANCELLED, "{:?}", found.status);
            for (place, (_, record)) in kept.iter().zip(seen.iter()) {
                let bits = |r: &minvar_record| {
                    [r.value, r.predicted, r.actual, r.gradient, r.step, r.shift].map(f64::to_bits)
                };
                assert_eq!(bits(place), bits(record), "a record that the observer saw otherwise");
            }
            assert_eq!(seen.len(), found.iterations, "iterations that the observer did not see");
        }
        let mut written = report.bytes().to_vec();
        written.extend(&elements.bytes()[..found.elements * size]);
        written.extend(&records.bytes()[..size_of_val(kept)]);
        Solved {
            joints,
            closed: self.is_closed(),
            obstacles: &self.obstacles,
            options: &self.options,
            elements: &made,
            report: &found,
        }
        .check();
        Done { answer, elements: made, written }
    }

    /// The joints, moved by some of `moved` each.
    fn moved(&self) -> Vec<minvar_joint> {
        let mut joints = self.joints.clone();
        for (index, joint) in joints.iter_mut().enumerate() {
            for d in 0..3 {
                joint.position.value[d] += self.moved[(d + index) % 3];
            }
        }
        joints
    }

    /// Updates the solution after the joints have moved.
    fn drag(&self, solved: &Done) {
        let joints = self.moved();
        if let Ok(lens @ [_, elements_len]) = self.lens(&joints, Fault::none())
            && elements_len == solved.elements.len()
        {
            self.twice(&joints, Some(&solved.elements), lens, Fault::none());
        }
    }

    /// Holds a region of a chain and computes it anew; of a chain that may be anything the elements are not computed.
    fn hold(&self, chain: &[minvar_element], any: bool, fault: Fault) {
        let [first, count] = self.part.map(usize::from);
        let first = if first >= 240 { usize::MAX - (255 - first) } else { first % (chain.len() + 2) };
        let count = if count >= 240 { usize::MAX - (255 - count) } else { count % (chain.len() + 2) };
        let moved = self.moved();
        let joints: Vec<_> =
            moved.iter().cycle().skip(first % 7).take(if any { moved.len() } else { 3 }).collect();
        let joints: Vec<minvar_joint> = joints.into_iter().copied().collect();
        let mut before: Option<(Answer, Vec<minvar_joint>)> = None;
        for turn in TURNS {
            fault.begin();
            let (mut elements, mut held) = (Room::of(chain), Room::of(&joints));
            let (elements_at, elements_len) = fault.array(3, "elements", elements.pointer(), elements.len());
            let (joints_at, joints_len) = fault.array(6, "joints", held.pointer(), held.len());
            let listed = [MINVAR_BAD_REGION, MINVAR_TOO_FEW_JOINTS, MINVAR_BAD_REFERENCE];
            let answer = ask(turn, &fault, &listed, |error| {
                // SAFETY: every pointer is NULL, misaligned, or to room of just the length that is said.
                unsafe {
                    minvar_region_hold(
                        elements_at,
                        elements_len,
                        self.closed as i32,
                        first,
                        count,
                        joints_at,
                        joints_len,
                        error,
                    )
                }
            });
            // SAFETY: joints are numbers.
            let held = unsafe { held.first(joints.len()) }.to_vec();
            let bits = |joints: &[minvar_joint]| -> Vec<u64> { joints.iter().flat_map(joint_bits).collect() };
            let changed = if answer.is_ok() { 1..held.len() - 1 } else { 0..held.len() };
            assert_eq!(bits(&held[changed.clone()]), bits(&joints[changed]), "a joint within changed");
            if let Some((earlier, others)) = &before {
                earlier.same(&answer);
                assert_eq!(bits(others), bits(&held), "other joints");
            }
            before = Some((answer, held));
        }
        let Some((answer, held)) = before else { return };
        if any || !answer.is_ok() || self.options.tolerance != 0.0 || !self.obstacles.is_empty() {
            return;
        }
        let region = Self { closed: 0, refers: 0, obstacles: Vec::new(), ..self.clone() };
        if let Ok(lens @ [_, elements_len]) = region.lens(&held, Fault::none())
            && elements_len <= MOST_ELEMENTS
        {
            region.twice(&held, None, lens, Fault::none());
            let start: Vec<_> = chain.iter().cycle().skip(first).take(elements_len).copied().collect();
            region.twice(&held, Some(&start), lens, Fault::none());
        }
    }

    /// Looks for several minima.
    fn minima(&self, [workspace_len, elements_len]: [usize; 2]) {
        if elements_len > MOST_ELEMENTS / 4 {
            return;
        }
        let most = usize::from(self.part[0] % 5);
        let short = self.part[1] >= 240;
        let elements_given = ((most + 1) * elements_len).saturating_sub(usize::from(short));
        let mut before: Option<(Answer, Vec<u8>)> = None;
        for turn in TURNS {
            let fault = &Fault::new(self.fault);
            let mut data = Data::new(self, &self.joints, fault);
            let watcher = Watcher::new(self.watcher, true);
            let (curve, options) = data.pointers(fault);
            let mut workspace = Room::<f64>::new(workspace_len, turn.fill);
            let mut elements = Room::<minvar_element>::new(elements_given, turn.fill);
            let mut reports = Room::<minvar_report>::new(most, turn.fill);
            let mut count = Room::<usize>::one(turn.fill);
            let (workspace_at, workspace_len) =
                fault.array(2, "workspace", workspace.pointer(), workspace.len());
            let (elements_at, elements_len_given) =
                fault.array(3, "elements", elements.pointer(), elements.len());
            let (reports_at, reports_len) = fault.array(4, "reports", reports.pointer(), reports.len());
            let count_at = fault.pointer(9, "count", count.pointer());
            let context = (&raw const watcher).cast_mut().cast::<c_void>();
            let answer = ask(turn, fault, &LISTED, |error| {
                // SAFETY: every pointer is NULL, misaligned, or to room of just the length that is said.
                unsafe {
                    minvar_curve_minima(
                        curve,
                        options,
                        workspace_at,
                        workspace_len,
                        Some(watch),
                        context,
                        elements_at,
                        elements_len_given,
                        reports_at,
                        reports_len,
                        count_at,
                        error,
                    )
                }
            });
            let mut written = Vec::new();
            if answer.is_ok() {
                assert!(!short, "too few elements were taken");
                // SAFETY: any bytes are a number; `found` reports were written.
                let found = unsafe { count.first(1)[0] };
                assert!(found <= most, "{found} minima in room for {most}");
                assert!(reports.is_untouched_from(found), "reports beyond the last were written");
                // SAFETY: as above.
                let (made, chains) = unsafe { (reports.first(found), elements.first(found * elements_len)) };
                assert!(made.is_sorted_by(|a, b| a.value <= b.value), "minima out of order");
                for (report, chain) in made.iter().zip(chains.chunks(elements_len.max(1))) {
                    assert_eq!(report.status, MINVAR_CONVERGED);
                    Solved {
                        joints: &self.joints,
                        closed: self.is_closed(),
                        obstacles: &self.obstacles,
                        options: &self.options,
                        elements: &chain[..report.elements],
                        report,
                    }
                    .check();
                    written.extend(
                        chain[..report.elements]
                            .iter()
                            .flat_map(|e| e.rows)
                            .flatten()
                            .flat_map(f64::to_le_bytes),
                    );
                }
                written.extend(&reports.bytes()[..size_of_val(made)]);
                written.extend(count.bytes());
            } else {
                assert!(
                    elements.is_untouched() && reports.is_untouched() && count.is_untouched(),
                    "{answer:?}, but a result was written"
                );
                assert!(!short || answer.code != MINVAR_OK);
            }
            if let Some((earlier, others)) = &before {
                earlier.same(&answer);
                assert!(*others == written, "the same call gave other bits");
            }
            before = Some((answer, written));
        }
    }
}

/// A joint's numbers.
fn joint_bits(joint: &minvar_joint) -> Vec<u64> {
    let quantities =
        [joint.position, joint.tangent[0], joint.tangent[1], joint.curvature[0], joint.curvature[1]];
    let mut bits = vec![u64::from(joint.continuity)];
    for quantity in quantities {
        bits.push(u64::from(quantity.given));
        bits.extend(quantity.value.map(f64::to_bits));
    }
    bits.extend(joint.guide.map(f64::to_bits));
    bits
}
