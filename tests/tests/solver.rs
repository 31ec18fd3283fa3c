//! The one solver on problems that have nothing to do with curves.

use minvar::solve::{
    BlockList, Control, Executor, InOrder, Observer, Outcome, Problem, Record, Settings, Silent, Status,
    Task, WorkspaceTooSmall, minimise, packed, workspace_len,
};
use minvar_tests::solving;
use minvar_tests::valley::{Rosenbrock, rosenbrock_start};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Solves in a workspace of exactly the right length, full of NaN.
fn run<P: Problem>(problem: &P, settings: &Settings, executor: &dyn Executor, state: &mut [f64]) -> Outcome {
    solving::run(problem, settings, executor, &mut Silent, state).0
}

#[test]
fn a_chain_of_curved_valleys_is_followed_to_its_minimum() {
    for count in [2, 3, 10, 200] {
        let mut state = vec![0.5; count];
        let outcome = run(
            &Rosenbrock { count },
            &Settings { max_iterations: 1000, ..Settings::DEFAULT },
            &InOrder,
            &mut state,
        );
        assert_eq!(outcome.status, Status::Converged);
        assert!(outcome.value < 1e-20, "{outcome:?}");
        assert!(outcome.gradient < 1e-8 && outcome.decrement < 1e-20, "{outcome:?}");
        assert!(state.iter().all(|x| (x - 1.0).abs() < 1e-9));
    }
}

#[test]
fn the_hard_start_of_two_unknowns_takes_a_known_few_iterations() {
    let mut state = vec![-1.2, 1.0];
    let outcome = run(&Rosenbrock { count: 2 }, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    assert!((state[0] - 1.0).abs() < 1e-9 && (state[1] - 1.0).abs() < 1e-9);
    // Newton's method with a trust region needs some twenty.
    assert!(outcome.iterations <= 40, "{outcome:?}");
}

#[test]
fn the_number_of_linearisations_is_what_was_done() {
    struct Counted(Rosenbrock, AtomicUsize);
    impl Problem for Counted {
        fn blocks(&self) -> usize {
            self.0.blocks()
        }
        fn dofs(&self, block: usize) -> usize {
            self.0.dofs(block)
        }
        fn state_range(&self, block: usize) -> Range<usize> {
            self.0.state_range(block)
        }
        fn state_len(&self) -> usize {
            self.0.state_len()
        }
        fn elements(&self) -> usize {
            self.0.elements()
        }
        fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
            self.0.element_blocks(element, blocks);
        }
        fn max_element_dofs(&self) -> usize {
            self.0.max_element_dofs()
        }
        fn cost(&self, element: usize, state: &[f64]) -> f64 {
            self.0.cost(element, state)
        }
        fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
            assert!(gradient.iter().chain(matrix.iter()).all(|&x| x == 0.0), "both come filled with zeros");
            assert_eq!((gradient.len(), matrix.len()), (2, 3));
            self.1.fetch_add(1, Ordering::Relaxed);
            self.0.linearise(element, state, gradient, matrix)
        }
        fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
            self.0.retract(block, from, step, to);
        }
        fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
            self.0.natural_sizes(block, state, sizes);
        }
        fn natural_cost(&self) -> f64 {
            self.0.natural_cost()
        }
    }
    for relaxation in [0, 5] {
        let problem = Counted(Rosenbrock { count: 8 }, AtomicUsize::new(0));
        let mut state = rosenbrock_start(8);
        let outcome = run(&problem, &Settings { relaxation, ..Settings::DEFAULT }, &InOrder, &mut state);
        assert_eq!(outcome.linearisations, problem.1.load(Ordering::Relaxed));
    }
}

/// `Σ (x² − 1)² + ½ (x_i − x_{i+1})²`, with a saddle at the origin from which only the second derivatives lead away.
struct Wells {
    count: usize,
}

impl Problem for Wells {
    fn blocks(&self) -> usize {
        self.count
    }
    fn dofs(&self, _: usize) -> usize {
        1
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        self.count
    }
    fn elements(&self) -> usize {
        self.count - 1
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend([element + 1, element]);
    }
    fn max_element_dofs(&self) -> usize {
        2
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let (x, y) = (state[element], state[element + 1]);
        let mut sum = 0.5 * (x - y) * (x - y) + (y * y - 1.0) * (y * y - 1.0);
        if element == 0 {
            sum += (x * x - 1.0) * (x * x - 1.0);
        }
        sum
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        // The blocks are listed backwards: the local unknown 0 is the second number.
        let (x, y) = (state[element], state[element + 1]);
        gradient[0] = y - x + 4.0 * y * (y * y - 1.0);
        gradient[1] = x - y;
        matrix[packed(0, 0)] = 1.0 + 12.0 * y * y - 4.0;
        matrix[packed(1, 0)] = -1.0;
        matrix[packed(1, 1)] = 1.0;
        if element == 0 {
            gradient[1] += 4.0 * x * (x * x - 1.0);
            matrix[packed(1, 1)] += 12.0 * x * x - 4.0;
        }
        self.cost(element, state)
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to[0] = from[0] + step[0];
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.count as f64
    }
}

#[test]
fn a_saddle_with_no_gradient_at_all_is_left() {
    for count in [2, 3, 17] {
        let mut state = vec![0.0; count];
        let outcome = run(&Wells { count }, &Settings::DEFAULT, &InOrder, &mut state);
        assert_eq!(outcome.status, Status::Converged);
        assert!(outcome.iterations > 0);
        assert!(outcome.value < count as f64, "better than the saddle: {outcome:?}");
        assert!(outcome.decrement < 1e-15, "{outcome:?}");
        // A minimum: every number in one of the two wells.
        assert!(state.iter().all(|x| x.abs() > 0.5), "{state:?}");
    }
}

#[test]
fn a_saddle_whose_gradient_points_only_along_the_ridge_is_left() {
    // All equal numbers stay equal under gradient and Newton steps alone; here they start on the ridge between wells.
    let mut state = vec![1e-3, -1e-3];
    let outcome = run(&Wells { count: 2 }, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    assert!(state.iter().all(|x| x.abs() > 0.5), "{state:?}");
}

/// Unit vectors in space that repel each other along a ring, `Σ 1/(1.1 − aᵢ·bᵢ)`: blocks of two dofs kept in three numbers,
/// the first one fixed. The Hessian is that of the exponential map.
struct Sphere {
    count: usize,
    closed: bool,
}

impl Sphere {
    fn frame(x: &[f64]) -> [[f64; 3]; 2] {
        let least = (0..3).fold(0, |least, d| if x[d].abs() < x[least].abs() { d } else { least });
        let mut e = [0.0; 3];
        e[least] = 1.0;
        let along = x[least];
        let mut one = [0, 1, 2].map(|d| e[d] - along * x[d]);
        let size = one.iter().map(|x| x * x).sum::<f64>().sqrt();
        one = one.map(|x| x / size);
        let two =
            [x[1] * one[2] - x[2] * one[1], x[2] * one[0] - x[0] * one[2], x[0] * one[1] - x[1] * one[0]];
        [one, two]
    }
    fn pair(&self, element: usize) -> [usize; 2] {
        [element, (element + 1) % self.count]
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Problem for Sphere {
    fn blocks(&self) -> usize {
        self.count
    }
    fn dofs(&self, block: usize) -> usize {
        if block == 0 { 0 } else { 2 }
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        3 * block..3 * block + 3
    }
    fn state_len(&self) -> usize {
        3 * self.count
    }
    fn elements(&self) -> usize {
        if self.closed { self.count } else { self.count - 1 }
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend(self.pair(element));
    }
    fn max_element_dofs(&self) -> usize {
        4
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let [i, j] = self.pair(element);
        1.0 / (1.1 - dot(&state[3 * i..3 * i + 3], &state[3 * j..3 * j + 3]))
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let pair = self.pair(element);
        let x = pair.map(|i| &state[3 * i..3 * i + 3]);
        let c = dot(x[0], x[1]);
        let f = 1.0 / (1.1 - c);
        let (f1, f2) = (f * f, 2.0 * f * f * f);
        let mut at = Vec::new();
        for (side, &block) in pair.iter().enumerate() {
            if self.dofs(block) > 0 {
                at.extend(Self::frame(x[side]).map(|e| (side, e)));
            }
        }
        for (r, &(side, e)) in at.iter().enumerate() {
            let slope = dot(&e, x[1 - side]);
            gradient[r] = f1 * slope;
            for (s, &(other, d)) in at.iter().enumerate().take(r + 1) {
                let bend = if side != other {
                    dot(&e, &d)
                } else if r == s {
                    -c
                } else {
                    0.0
                };
                matrix[packed(r, s)] = f2 * slope * dot(&d, x[1 - other]) + f1 * bend;
            }
        }
        f
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        let [one, two] = Self::frame(from);
        let v = [0, 1, 2].map(|d| one[d] * step[0] + two[d] * step[1]);
        let angle = dot(&v, &v).sqrt();
        let (sin, cos) = if angle > 0.0 { (libm_sin(angle) / angle, libm_cos(angle)) } else { (1.0, 1.0) };
        for d in 0..3 {
            to[d] = from[d] * cos + v[d] * sin;
        }
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.elements() as f64
    }
}

#[allow(clippy::disallowed_methods, reason = "the tests may use the platform's sines")]
fn libm_sin(x: f64) -> f64 {
    x.sin()
}

#[allow(clippy::disallowed_methods, reason = "the tests may use the platform's sines")]
fn libm_cos(x: f64) -> f64 {
    x.cos()
}

fn scattered(count: usize) -> Vec<f64> {
    let mut seed = 7u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count)
        .flat_map(|_| {
            let v = [next(), next(), next()];
            let size = dot(&v, &v).sqrt();
            v.map(|x| x / size)
        })
        .collect()
}

#[test]
fn points_on_spheres_find_the_minimum_on_their_manifold() {
    for count in [2, 3, 8, 30] {
        let problem = Sphere { count, closed: false };
        let mut state = scattered(count);
        let first = state[..3].to_vec();
        let outcome = run(&problem, &Settings::DEFAULT, &InOrder, &mut state);
        assert_eq!(outcome.status, Status::Converged, "{outcome:?}");
        // Neighbours end up opposite: 1/2.1 an element.
        assert!((outcome.value - (count - 1) as f64 / 2.1).abs() < 1e-12 * count as f64, "{outcome:?}");
        for pair in state.chunks(3).collect::<Vec<_>>().windows(2) {
            assert!((dot(pair[0], pair[1]) + 1.0).abs() < 1e-12);
            assert!((dot(pair[1], pair[1]) - 1.0).abs() < 1e-13);
        }
        assert_eq!(state[..3], first, "a block without dofs stays");
    }
    // An even ring alternates as well; it is a ring of the matrix too.
    let mut state = scattered(12);
    let outcome = run(&Sphere { count: 12, closed: true }, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Converged, "{outcome:?}");
    assert!((outcome.value - 12.0 / 2.1).abs() < 1e-11, "{outcome:?}");
}

#[test]
fn the_iteration_limit_is_kept_and_told() {
    for max_iterations in [0, 1, 2, 5] {
        let settings = Settings { max_iterations, ..Settings::DEFAULT };
        let mut state = rosenbrock_start(6);
        let start: f64 = (0..5).map(|element| Rosenbrock { count: 6 }.cost(element, &state)).sum();
        let outcome = run(&Rosenbrock { count: 6 }, &settings, &InOrder, &mut state);
        assert_eq!((outcome.status, outcome.iterations), (Status::IterationLimit, max_iterations));
        let value: f64 = (0..5).map(|element| Rosenbrock { count: 6 }.cost(element, &state)).sum();
        assert!((outcome.value - value).abs() <= 1e-15 * value, "the value is that of the state");
        assert!(value <= start);
    }
}

/// Watches and stops.
struct Watch {
    stop_at: usize,
    records: Vec<Record>,
}

impl Observer for Watch {
    fn iteration(&mut self, number: usize, record: &Record) -> Control {
        self.records.push(*record);
        assert_eq!(number, self.records.len());
        if number == self.stop_at { Control::Cancel } else { Control::Continue }
    }
}

#[test]
fn an_observer_can_cancel_and_gets_the_best_state_so_far() {
    let problem = Rosenbrock { count: 6 };
    for stop_at in 1..12 {
        let mut state = rosenbrock_start(6);
        let mut workspace = vec![f64::NAN; workspace_len(&problem, 1)];
        let mut watch = Watch { stop_at, records: Vec::new() };
        let outcome =
            minimise(&problem, &Settings::DEFAULT, &InOrder, &mut state, &mut workspace, &mut [], &mut watch)
                .expect("enough memory");
        assert_eq!((outcome.status, outcome.iterations), (Status::Cancelled, stop_at));
        let value: f64 = (0..5).map(|element| problem.cost(element, &state)).sum();
        assert!((outcome.value - value).abs() <= 1e-15 * value);
        assert_eq!(watch.records.len(), stop_at);
        assert!(watch.records.windows(2).all(|pair| pair[1].value <= pair[0].value));
        assert!((watch.records[stop_at - 1].value - value).abs() <= 1e-14 * value);
    }
}

#[test]
fn records_tell_what_every_iteration_did() {
    let problem = Rosenbrock { count: 6 };
    let mut state = rosenbrock_start(6);
    let mut before: f64 = (0..5).map(|element| problem.cost(element, &state)).sum();
    let mut workspace = vec![f64::NAN; workspace_len(&problem, 1)];
    let mut records = vec![Record::ZERO; 5];
    let mut watch = Watch { stop_at: 0, records: Vec::new() };
    let outcome = minimise(
        &problem,
        &Settings::DEFAULT,
        &InOrder,
        &mut state,
        &mut workspace,
        &mut records,
        &mut watch,
    )
    .expect("enough memory");
    assert!(outcome.iterations > 5, "more iterations than room for records");
    assert_eq!(watch.records.len(), outcome.iterations);
    assert_eq!(records[..], watch.records[..5]);
    for record in &watch.records {
        assert!(record.predicted > 0.0 && record.step > 0.0 && record.shift >= 0.0 && record.gradient >= 0.0);
        if record.value < before {
            assert!((before - record.value - record.actual).abs() <= 1e-12 * before);
        }
        before = record.value;
    }
    assert_eq!(before, outcome.value);
}

#[test]
fn a_workspace_one_too_short_is_refused_with_the_length_that_works() {
    let problem = Rosenbrock { count: 9 };
    for width in [1, 4] {
        let executor = Backwards { width };
        let needed = workspace_len(&problem, width);
        let start = rosenbrock_start(9);
        for given in [needed - 1, needed / 3, 0] {
            let mut state = start.clone();
            let mut workspace = vec![0.0; given];
            let result = minimise(
                &problem,
                &Settings::DEFAULT,
                &executor,
                &mut state,
                &mut workspace,
                &mut [],
                &mut Silent,
            );
            assert_eq!(result, Err(WorkspaceTooSmall { needed, given }));
            assert_eq!(state, start, "nothing was done");
        }
        let mut state = start.clone();
        let mut workspace = vec![0.0; needed];
        let result = minimise(
            &problem,
            &Settings::DEFAULT,
            &executor,
            &mut state,
            &mut workspace,
            &mut [],
            &mut Silent,
        );
        assert_eq!(result.expect("enough memory").status, Status::Converged);
    }
}

/// Computes the slots of a batch from the last to the first.
struct Backwards {
    width: usize,
}

impl Executor for Backwards {
    fn width(&self) -> usize {
        self.width
    }
    fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
        assert_eq!(slots.len() % slot_len, 0);
        assert!(slots.len() / slot_len <= self.width);
        for (index, slot) in slots.chunks_mut(slot_len).enumerate().rev() {
            task(index, slot);
        }
    }
}

/// Computes every slot on a thread of its own.
struct Threads;

impl Executor for Threads {
    fn width(&self) -> usize {
        8
    }
    fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
        std::thread::scope(|scope| {
            for (index, slot) in slots.chunks_mut(slot_len).enumerate() {
                scope.spawn(move || task(index, slot));
            }
        });
    }
}

#[test]
fn the_executor_does_not_change_a_bit() {
    let bits = |executor: &dyn Executor, relaxation: usize| {
        let mut state = scattered(23);
        let problem = Sphere { count: 23, closed: true };
        let settings = Settings { relaxation, ..Settings::DEFAULT };
        let mut workspace = vec![f64::NAN; workspace_len(&problem, executor.width())];
        let mut watch = Watch { stop_at: 0, records: Vec::new() };
        let outcome =
            minimise(&problem, &settings, executor, &mut state, &mut workspace, &mut [], &mut watch)
                .expect("enough memory");
        assert_eq!(outcome.status, Status::Converged);
        // Debug output of a number is as long as it takes to tell it from its neighbours.
        (state, format!("{outcome:?}"), format!("{:?}", watch.records))
    };
    for relaxation in [0, 3] {
        let want = bits(&InOrder, relaxation);
        for width in [1, 2, 4, 23, 100] {
            assert_eq!(bits(&Backwards { width }, relaxation), want);
        }
        assert_eq!(bits(&Threads, relaxation), want);
    }
}

/// A chain of blocks of `dofs` numbers whose places in the list of blocks are shuffled, as are its elements: a sum of
/// squares of steps, with one end held. `bound` is what it tells the solver of its envelope.
struct Shuffled {
    place: Vec<usize>,
    elements: Vec<usize>,
    dofs: usize,
    bound: usize,
}

impl Shuffled {
    fn new(count: usize, dofs: usize, closed: bool, bound: usize, mut seed: u64) -> Self {
        let mut shuffle = |len: usize| {
            let mut list: Vec<usize> = (0..len).collect();
            for i in (1..len).rev() {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                list.swap(i, (seed >> 33) as usize % (i + 1));
            }
            list
        };
        Self { place: shuffle(count), elements: shuffle(if closed { count } else { count - 1 }), dofs, bound }
    }
    fn pair(&self, element: usize) -> [usize; 2] {
        let link = self.elements[element];
        [self.place[link], self.place[(link + 1) % self.place.len()]]
    }
    /// What the first block in the chain is drawn to.
    fn held(&self, element: usize) -> bool {
        self.elements[element] == 0
    }
}

impl Problem for Shuffled {
    fn blocks(&self) -> usize {
        self.place.len()
    }
    fn dofs(&self, _: usize) -> usize {
        self.dofs
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block * self.dofs..(block + 1) * self.dofs
    }
    fn state_len(&self) -> usize {
        self.place.len() * self.dofs
    }
    fn elements(&self) -> usize {
        self.elements.len()
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend(self.pair(element));
    }
    fn max_element_dofs(&self) -> usize {
        2 * self.dofs
    }
    fn envelope_bound(&self) -> usize {
        self.bound
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let [a, b] = self.pair(element).map(|block| &state[self.state_range(block)]);
        let steps: f64 = a.iter().zip(b).map(|(x, y)| (y - x - 1.0) * (y - x - 1.0)).sum();
        if self.held(element) { steps + dot(a, a) } else { steps }
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let [a, b] = self.pair(element).map(|block| &state[self.state_range(block)]);
        for d in 0..self.dofs {
            let e = self.dofs + d;
            let step = b[d] - a[d] - 1.0;
            gradient[d] = -2.0 * step;
            gradient[e] = 2.0 * step;
            matrix[packed(d, d)] = 2.0;
            matrix[packed(e, e)] = 2.0;
            matrix[packed(e, d)] = -2.0;
            if self.held(element) {
                gradient[d] += 2.0 * a[d];
                matrix[packed(d, d)] += 2.0;
            }
        }
        self.cost(element, state)
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        for ((to, from), step) in to.iter_mut().zip(from).zip(step) {
            *to = from + step;
        }
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.elements() as f64
    }
}

#[test]
fn a_shuffled_chain_is_put_in_order() {
    let far = Settings { first_radius: 1e6, ..Settings::DEFAULT };
    for (count, dofs) in [(2, 1), (5, 1), (40, 3), (300, 2)] {
        // In order, a row of a chain reaches back over its own block and the one before.
        let n = count * dofs;
        let bound = (n - dofs) * dofs + count * dofs * (dofs + 1) / 2;
        for seed in 0..20 {
            let problem = Shuffled::new(count, dofs, false, bound, seed);
            let mut state = vec![0.0; n];
            let mut workspace = vec![f64::NAN; workspace_len(&problem, 1)];
            let outcome =
                minimise(&problem, &far, &InOrder, &mut state, &mut workspace, &mut [], &mut Silent)
                    .expect("the envelope of a chain in order");
            assert_eq!(outcome.status, Status::Converged);
            for (i, &block) in problem.place.iter().enumerate() {
                for d in 0..dofs {
                    assert!((state[block * dofs + d] - i as f64).abs() < 1e-9 * count as f64);
                }
            }
        }
        // The formula is sharp: an entry less is not enough, and the error says how many are missing.
        for missing in [1, 2, bound] {
            let problem = Shuffled::new(count, dofs, false, bound - missing, 3);
            let given = workspace_len(&problem, InOrder.width());
            let mut state = vec![0.0; n];
            let mut workspace = vec![f64::NAN; given];
            let result = minimise(&problem, &far, &InOrder, &mut state, &mut workspace, &mut [], &mut Silent);
            assert_eq!(result, Err(WorkspaceTooSmall { needed: given + 2 * missing, given }));
        }
    }
}

#[test]
fn a_shuffled_ring_reaches_back_two_blocks() {
    for count in [3, 4, 11, 200] {
        // Breadth first from anywhere numbers a ring from both sides: a row reaches back over two blocks.
        let bound = 3 * count;
        for seed in 0..20 {
            let problem = Shuffled::new(count, 1, true, bound, seed);
            let mut state = vec![0.0; count];
            let outcome = run(&problem, &Settings::DEFAULT, &InOrder, &mut state);
            assert_eq!(outcome.status, Status::Converged);
            // The steps of a ring cannot all be one: they are all none.
            assert!((outcome.value - count as f64).abs() < 1e-9, "{outcome:?}");
        }
    }
}

/// A strip of square patches, `width` by `length` corners, each corner one number: `Σ` over patches of the squares of the
/// differences along its sides less one in each direction, one corner held. Corners and patches are shuffled.
struct Strip {
    width: usize,
    place: Vec<usize>,
    patches: Vec<usize>,
    bound: usize,
}

impl Strip {
    fn corners(&self, element: usize) -> [usize; 4] {
        let patch = self.patches[element];
        let (x, y) = (patch / (self.width - 1), patch % (self.width - 1));
        let at = |x: usize, y: usize| self.place[x * self.width + y];
        [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)]
    }
}

/// The sides of a patch as pairs of its corners.
const SIDES: [(usize, usize); 4] = [(0, 1), (2, 3), (0, 2), (1, 3)];

impl Problem for Strip {
    fn blocks(&self) -> usize {
        self.place.len()
    }
    fn dofs(&self, _: usize) -> usize {
        1
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        self.place.len()
    }
    fn elements(&self) -> usize {
        self.patches.len()
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend(self.corners(element));
    }
    fn max_element_dofs(&self) -> usize {
        4
    }
    fn envelope_bound(&self) -> usize {
        self.bound
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let x = self.corners(element).map(|block| state[block]);
        let sides: f64 = SIDES.iter().map(|&(a, b)| (x[b] - x[a] - 1.0) * (x[b] - x[a] - 1.0)).sum();
        if self.patches[element] == 0 { sides + x[0] * x[0] } else { sides }
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let x = self.corners(element).map(|block| state[block]);
        for (a, b) in SIDES {
            let step = x[b] - x[a] - 1.0;
            gradient[a] -= 2.0 * step;
            gradient[b] += 2.0 * step;
            matrix[packed(a, a)] += 2.0;
            matrix[packed(b, b)] += 2.0;
            matrix[packed(b, a)] -= 2.0;
        }
        if self.patches[element] == 0 {
            gradient[0] += 2.0 * x[0];
            matrix[packed(0, 0)] += 2.0;
        }
        self.cost(element, state)
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to[0] = from[0] + step[0];
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.elements() as f64
    }
}

#[test]
fn a_shuffled_strip_of_patches_gets_a_narrow_envelope() {
    for (width, length) in [(2, 60), (4, 50), (6, 30)] {
        for seed in 0..20 {
            let n = width * length;
            // Numbered across the strip a row would reach back over width + 1 others.
            let bound = n * (width + 2);
            let shuffled = |count, seed| Shuffled::new(count, 1, false, 0, seed).place;
            let problem = Strip {
                width,
                place: shuffled(n, seed),
                patches: shuffled((width - 1) * (length - 1), seed + 100),
                bound,
            };
            let mut state = vec![0.0; n];
            let mut workspace = vec![f64::NAN; workspace_len(&problem, 1)];
            let settings = Settings { first_radius: 1e6, ..Settings::DEFAULT };
            let outcome =
                minimise(&problem, &settings, &InOrder, &mut state, &mut workspace, &mut [], &mut Silent);
            let outcome = outcome.expect("a narrow envelope");
            assert_eq!(outcome.status, Status::Converged);
            for x in 0..length {
                for y in 0..width {
                    assert!((state[problem.place[x * width + y]] - (x + y) as f64).abs() < 1e-8);
                }
            }
        }
    }
}

#[test]
fn separate_parts_and_blocks_that_no_element_touches_do_no_harm() {
    /// Two chains and a block on its own, in one problem.
    struct Parts(Rosenbrock);
    impl Problem for Parts {
        fn blocks(&self) -> usize {
            11
        }
        fn dofs(&self, _: usize) -> usize {
            1
        }
        fn state_range(&self, block: usize) -> Range<usize> {
            block..block + 1
        }
        fn state_len(&self) -> usize {
            11
        }
        fn elements(&self) -> usize {
            8
        }
        fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
            let at = if element < 4 { element } else { element + 2 };
            blocks.extend([at, at + 1]);
        }
        fn max_element_dofs(&self) -> usize {
            2
        }
        fn cost(&self, element: usize, state: &[f64]) -> f64 {
            self.0.cost(if element < 4 { element } else { element + 2 }, state)
        }
        fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
            self.0.linearise(if element < 4 { element } else { element + 2 }, state, gradient, matrix)
        }
        fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
            self.0.retract(block, from, step, to);
        }
        fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
            self.0.natural_sizes(block, state, sizes);
        }
        fn natural_cost(&self) -> f64 {
            8.0
        }
    }
    let mut state = vec![0.5; 11];
    state[5] = 0.125;
    let outcome = run(&Parts(Rosenbrock { count: 11 }), &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    for (i, x) in state.iter().enumerate() {
        assert!((x - if i == 5 { 0.125 } else { 1.0 }).abs() < 1e-9, "{state:?}");
    }
}

#[test]
fn a_start_outside_the_domain_is_stalled_and_left_as_it_is() {
    struct Outside(Rosenbrock);
    impl Problem for Outside {
        fn blocks(&self) -> usize {
            2
        }
        fn dofs(&self, _: usize) -> usize {
            1
        }
        fn state_range(&self, block: usize) -> Range<usize> {
            block..block + 1
        }
        fn state_len(&self) -> usize {
            2
        }
        fn elements(&self) -> usize {
            1
        }
        fn element_blocks(&self, _: usize, blocks: &mut BlockList) {
            blocks.extend([0, 1]);
        }
        fn max_element_dofs(&self) -> usize {
            2
        }
        fn cost(&self, _: usize, state: &[f64]) -> f64 {
            // A logarithm's wall: finite for positive numbers only.
            if state.iter().all(|&x| x > 0.0) { self.0.cost(0, state) } else { f64::NAN }
        }
        fn linearise(&self, _: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
            self.0.linearise(0, state, gradient, matrix);
            self.cost(0, state)
        }
        fn retract(&self, block: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
            self.0.retract(block, from, step, to);
        }
        fn natural_sizes(&self, block: usize, state: &[f64], sizes: &mut [f64]) {
            self.0.natural_sizes(block, state, sizes);
        }
        fn natural_cost(&self) -> f64 {
            1.0
        }
    }
    let problem = Outside(Rosenbrock { count: 2 });
    let mut state = vec![-1.2, 1.0];
    let outcome = run(&problem, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!((outcome.status, outcome.iterations), (Status::Stalled, 0));
    assert_eq!(state, [-1.2, 1.0]);
    // From inside, steps that would leave it are shortened.
    let mut state = vec![0.01, 3.0];
    let outcome = run(&problem, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    assert!((state[0] - 1.0).abs() < 1e-9);
}

#[test]
fn a_shape_that_runs_away_is_unbounded() {
    /// `1/x`: sinks as x grows.
    struct Away;
    impl Problem for Away {
        fn blocks(&self) -> usize {
            1
        }
        fn dofs(&self, _: usize) -> usize {
            1
        }
        fn state_range(&self, _: usize) -> Range<usize> {
            0..1
        }
        fn state_len(&self) -> usize {
            1
        }
        fn elements(&self) -> usize {
            1
        }
        fn element_blocks(&self, _: usize, blocks: &mut BlockList) {
            blocks.extend([0]);
        }
        fn max_element_dofs(&self) -> usize {
            1
        }
        fn cost(&self, _: usize, state: &[f64]) -> f64 {
            if state[0] > 0.0 { 1.0 / state[0] } else { f64::INFINITY }
        }
        fn linearise(&self, _: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
            let x = state[0];
            gradient[0] = -1.0 / (x * x);
            matrix[0] = 2.0 / (x * x * x);
            1.0 / x
        }
        fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
            to[0] = from[0] + step[0];
        }
        fn natural_sizes(&self, _: usize, state: &[f64], sizes: &mut [f64]) {
            sizes[0] = state[0];
        }
        fn natural_cost(&self) -> f64 {
            1.0
        }
        fn runs_away(&self, state: &[f64]) -> bool {
            state[0] > 1e4
        }
    }
    let mut state = [1.0];
    let outcome = run(&Away, &Settings::DEFAULT, &InOrder, &mut state);
    assert_eq!(outcome.status, Status::Unbounded);
    assert!(state[0] > 1e4);
}

#[test]
fn every_status_has_a_name_and_a_sentence_of_its_own() {
    use Status::{Cancelled, Converged, IterationLimit, Stalled, Unbounded, Unsolved};
    let all = [Unsolved, Converged, Stalled, IterationLimit, Unbounded, Cancelled];
    for (k, status) in all.into_iter().enumerate() {
        assert_eq!(status as usize, k);
        assert!(status.sentence().len() > 10 && status.sentence().is_ascii());
        assert!(!status.name().is_empty() && status.name() == status.name().to_lowercase());
        for other in &all[..k] {
            assert!(status.sentence() != other.sentence() && status.name() != other.name());
        }
    }
}
