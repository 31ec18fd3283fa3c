//! The solver on a problem whose elements have unknowns of their own and whose blocks are loose: what is relaxed by itself
//! is at its minimum, other minima are looked for, and all work is counted.

use minvar::solve::{
    BlockList, Coupled, InOrder, Observer, Outcome, Problem, Record, Settings, Silent, Status, packed,
};
use minvar_tests::solving;
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Nodes in a row, the first and the last fixed; an element between two has a value `p` of its own with two wells:
///
/// ```text
/// a = (y − x − 1 − 0.3 p)² + 0.2 (p² − 1)² + 0.05 p + 1,   b = 1 + 0.1 y² + 0.05 p²
/// ```
///
/// The objective is `Σ a`, or the product `Σ a · Σ b`, or either `scale` times. Without wells the second term of `a` is not
/// there, and `Σ a` is quadratic.
struct Links {
    nodes: usize,
    is_product: bool,
    scale: f64,
    wells: f64,
    loosens: bool,
    variants: usize,
    linearised: AtomicUsize,
    varied: AtomicUsize,
}

impl Links {
    fn new(nodes: usize, is_product: bool) -> Self {
        Self {
            nodes,
            is_product,
            scale: 1.0,
            wells: 0.2,
            loosens: true,
            variants: 1,
            linearised: AtomicUsize::new(0),
            varied: AtomicUsize::new(0),
        }
    }

    /// Nodes on a line, all values in the higher well.
    fn start(&self) -> Vec<f64> {
        let nodes = (0..self.nodes).map(|node| node as f64);
        nodes.chain((0..self.elements()).map(|_| 0.9)).collect()
    }

    fn values(&self, element: usize, state: &[f64]) -> [f64; 3] {
        [state[element], state[element + 1], state[self.nodes + element]]
    }

    fn objective(&self, state: &[f64]) -> f64 {
        let mut sums = [0.0; 2];
        for element in 0..self.elements() {
            let [a, b] = self.sums(element, state);
            sums[0] += a;
            sums[1] += b;
        }
        self.couple(sums).value
    }

    /// What the sums are multiplied by; the product is as a whole.
    fn plain_scale(&self) -> f64 {
        if self.is_product { 1.0 } else { self.scale }
    }

    /// By differences.
    fn gradient(&self, state: &[f64]) -> Vec<f64> {
        let slope = |k: usize| {
            let moved = |by: f64| {
                let mut state = state.to_vec();
                state[k] += by;
                self.objective(&state)
            };
            (moved(1e-5) - moved(-1e-5)) / 2e-5
        };
        (0..state.len()).map(|k| if k == 0 || k == self.nodes - 1 { 0.0 } else { slope(k) }).collect()
    }
}

impl Problem for Links {
    fn blocks(&self) -> usize {
        self.nodes + self.elements()
    }
    fn dofs(&self, block: usize) -> usize {
        usize::from(block != 0 && block != self.nodes - 1)
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        self.blocks()
    }
    fn elements(&self) -> usize {
        self.nodes - 1
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend([element, element + 1, self.nodes + element]);
    }
    fn max_element_dofs(&self) -> usize {
        3
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        self.sums(element, state)[0]
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        self.linearise_sums(element, state, [1.0, 0.0], gradient, &mut [0.0; 3], matrix)[0]
    }
    fn is_coupled(&self) -> bool {
        self.is_product
    }
    fn couple(&self, sums: [f64; 2]) -> Coupled {
        if !self.is_product {
            return Coupled::plain(sums);
        }
        let ([a, b], scale) = (sums, self.scale);
        Coupled { value: scale * a * b, first: [scale * b, scale * a], second: [[0.0, scale], [scale, 0.0]] }
    }
    fn sums(&self, element: usize, state: &[f64]) -> [f64; 2] {
        let [x, y, p] = self.values(element, state);
        let (step, well) = (y - x - 1.0 - 0.3 * p, p * p - 1.0);
        let a = step * step + self.wells * well * well + 0.05 * p + 1.0;
        [self.plain_scale() * a, 1.0 + 0.1 * y * y + 0.05 * p * p]
    }
    fn linearise_sums(
        &self,
        element: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> [f64; 2] {
        self.linearised.fetch_add(1, Ordering::Relaxed);
        let [x, y, p] = self.values(element, state);
        let step = y - x - 1.0 - 0.3 * p;
        let by = [-1.0, 1.0, -0.3];
        let own = [0.0, 0.0, 4.0 * self.wells * p * (p * p - 1.0) + 0.05];
        let first = [first[0] * self.plain_scale(), first[1]];
        let of_second = [0.0, 0.2 * y, 0.1 * p];
        let mut list = BlockList::new();
        self.element_blocks(element, &mut list);
        // Fixed nodes have no unknowns.
        let free: Vec<usize> = (0..3).filter(|&k| self.dofs(list[k]) > 0).collect();
        for (i, &k) in free.iter().enumerate() {
            gradient[i] = first[0] * (2.0 * step * by[k] + own[k]) + first[1] * of_second[k];
            if self.is_product {
                second[i] = of_second[k];
            }
            for (j, &l) in free.iter().enumerate().take(i + 1) {
                let diagonal = [0.0, 0.0, 4.0 * self.wells * (3.0 * p * p - 1.0)][k];
                let second_diagonal = [0.0, 0.2, 0.1][k];
                matrix[packed(i, j)] = first[0] * 2.0 * by[k] * by[l];
                if k == l {
                    matrix[packed(i, j)] += first[0] * diagonal + first[1] * second_diagonal;
                }
            }
        }
        self.sums(element, state)
    }
    fn is_loose(&self, block: usize) -> bool {
        self.loosens && block < self.nodes && self.dofs(block) > 0
    }
    fn most_loose_dofs(&self) -> usize {
        if self.loosens { 3 } else { 0 }
    }
    fn variants(&self) -> usize {
        self.variants
    }
    fn vary(&self, element: usize, _: usize, state: &mut [f64]) {
        self.varied.fetch_add(1, Ordering::Relaxed);
        state[self.nodes + element] *= -1.0;
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        // A fixed node that one element has for itself is asked to stay.
        to[0] = from[0] + step.first().unwrap_or(&0.0);
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.scale * self.elements() as f64
    }
}

fn run(problem: &Links, settings: &Settings, observer: &mut dyn Observer) -> (Outcome, Vec<f64>) {
    let mut state = problem.start();
    let (outcome, _) = solving::run(problem, settings, &InOrder, observer, &mut state);
    (outcome, state)
}

const SETTINGS: Settings = Settings { relaxation: 3, first_relaxation: 30, ..Settings::DEFAULT };

#[test]
fn every_linearisation_is_counted_whatever_it_is_for() {
    for is_product in [false, true] {
        for (relaxation, first_relaxation, explores) in
            [(0, 0, false), (3, 0, false), (0, 5, false), (3, 5, false), (3, 0, true), (2, 4, true)]
        {
            let problem = Links::new(6, is_product);
            let settings = Settings { relaxation, first_relaxation, explores, ..Settings::DEFAULT };
            let (outcome, _) = run(&problem, &settings, &mut Silent);
            assert_eq!(outcome.status, Status::Converged, "{settings:?}");
            let done = problem.linearised.load(Ordering::Relaxed);
            assert_eq!(outcome.linearisations, done, "{is_product} {settings:?}");
        }
    }
}

#[test]
fn the_lower_well_of_every_element_is_found_where_it_is_looked_for() {
    for is_product in [false, true] {
        let problem = Links::new(6, is_product);
        for explores in [false, true] {
            let (outcome, state) = run(&problem, &Settings { explores, ..SETTINGS }, &mut Silent);
            assert_eq!(outcome.status, Status::Converged);
            assert!((outcome.value - problem.objective(&state)).abs() < 1e-12 * outcome.value);
            let steepest = problem.gradient(&state).iter().fold(0.0, |most: f64, g| most.max(g.abs()));
            assert!(steepest < 1e-6, "{is_product} {explores}: {steepest}");
            // In the product nodes are drawn to zero, which tilts the wells.
            let is_low = |p: &f64| *p < 0.0;
            assert!(is_product || state[problem.nodes..].iter().all(|p| is_low(p) == explores), "{state:?}");
        }
    }
}

#[test]
fn what_is_relaxed_before_the_first_step_is_at_its_minimum() {
    for is_product in [false, true] {
        // Two loose nodes: each is relaxed beside the other, again and again.
        let problem = Links::new(4, is_product);
        let before = problem.objective(&problem.start());
        let (outcome, state) =
            run(&problem, &Settings { max_iterations: 0, explores: false, ..SETTINGS }, &mut Silent);
        assert_eq!(outcome.iterations, 0);
        assert!(outcome.value < before && (outcome.value - problem.objective(&state)).abs() < 1e-12 * before);
        let steepest = problem.gradient(&state).iter().fold(0.0, |most: f64, g| most.max(g.abs()));
        assert!(steepest < 1e-4, "{is_product}: {steepest} {state:?}");
    }
}

/// A power of four takes square roots along: every number of the history is the same, so many times as large.
#[test]
fn the_size_of_the_objective_changes_no_bit() {
    for is_product in [false, true] {
        for settings in [
            Settings { relative_decrease: 1e-3, ..SETTINGS },
            Settings { relative_decrease: 1e-12, spares_relaxation: true, ..SETTINGS },
            Settings { relative_decrease: 1e-6, first_relaxation: 1, ..SETTINGS },
            Settings::DEFAULT,
        ] {
            let run = |scale: f64| {
                let problem = Links { scale, ..Links::new(6, is_product) };
                let mut state = problem.start();
                let (outcome, records) = solving::run(&problem, &settings, &InOrder, &mut Silent, &mut state);
                let parts = |r: &Record| [r.value, r.predicted, r.actual, r.gradient, r.shift];
                let mut history: Vec<f64> =
                    records.iter().flat_map(parts).chain([outcome.value]).map(|x| x / scale).collect();
                history.extend(records.iter().map(|r| r.step));
                (history, state, outcome.linearisations, outcome.status)
            };
            let usual = run(1.0);
            for exponent in [-200, 200] {
                assert_eq!(run(2.0_f64.powi(exponent)), usual, "{is_product} 2^{exponent} {settings:?}");
            }
        }
    }
}

/// What a run costs, and how often starts were taken.
fn work(problem: &Links, settings: &Settings, state: &mut [f64]) -> (usize, usize, Outcome) {
    let (outcome, _) = solving::run(problem, settings, &InOrder, &mut Silent, state);
    (problem.linearised.load(Ordering::Relaxed), problem.varied.load(Ordering::Relaxed), outcome)
}

#[test]
fn nothing_is_explored_where_there_is_nothing_to_explore() {
    for is_product in [false, true] {
        // No other starts; or nothing that an element could do from them.
        for (variants, relaxation) in [(0, 3), (1, 0), (0, 0)] {
            let count = |explores: bool| {
                let problem = Links { variants, ..Links::new(6, is_product) };
                let settings = Settings { relaxation, explores, ..SETTINGS };
                let (linearised, varied, _) = work(&problem, &settings, &mut problem.start());
                (linearised, varied)
            };
            assert_eq!(count(true), count(false), "{is_product} {variants} {relaxation}");
        }
    }
}

#[test]
fn what_was_explored_in_vain_is_not_explored_again() {
    for is_product in [false, true] {
        let problem = Links::new(6, is_product);
        let (_, mut state) = run(&problem, &SETTINGS, &mut Silent);
        // Beside the best there is: some steps lead back.
        state[2] += 0.5;
        state[8] += 0.3;
        let problem = Links { loosens: false, ..Links::new(6, is_product) };
        let settings = Settings { first_relaxation: 0, relaxation: 1, ..SETTINGS };
        let (_, varied, outcome) = work(&problem, &settings, &mut state);
        assert!(outcome.status == Status::Converged && outcome.iterations > 1, "{outcome:?}");
        assert_eq!(varied, problem.elements(), "{is_product}");
    }
}

#[test]
fn loose_blocks_are_relaxed_at_most_eight_times_before_the_first_step_and_not_where_nothing_is_relaxed() {
    // In such a row what one node does comes to the others slowly.
    let (nodes, elements) = (30, 29);
    let count = |settings: &Settings, loosens: bool| {
        let problem = Links { loosens, ..Links::new(nodes, false) };
        let settings = Settings { max_iterations: 0, first_relaxation: 1, explores: false, ..*settings };
        work(&problem, &settings, &mut problem.start()).0
    };
    // Every element once, the inner nodes with both of their elements, and once for the step that is not taken.
    let whole = 2 * elements;
    let sweep = 2 * (nodes - 2);
    assert_eq!(count(&SETTINGS, true), whole + 8 * sweep);
    // Who asks for little ends when once all round brings little.
    assert_eq!(count(&Settings { relative_decrease: 1e-2, ..SETTINGS }, true), whole + sweep);
    assert_eq!(count(&SETTINGS, false), whole);
    assert_eq!(count(&Settings { relaxation: 0, ..SETTINGS }, true), whole);
}

#[test]
fn a_step_that_keeps_its_promise_is_spared_relaxation_and_no_other() {
    let settings = Settings { relaxation: 3, spares_relaxation: true, explores: false, ..Settings::DEFAULT };
    // Quadratic: every step brings what it promises.
    let problem = Links { wells: 0.0, ..Links::new(6, false) };
    let mut state = problem.start();
    state[problem.nodes..].fill(40.0);
    let (linearised, _, outcome) = work(&problem, &settings, &mut state);
    assert_eq!(linearised, (outcome.iterations + 1) * problem.elements(), "{outcome:?}");
    // From between the wells no step does at first: all is as if nothing were spared.
    let first = |spares_relaxation: bool| {
        let problem = Links::new(6, false);
        let mut state = problem.start();
        state[problem.nodes..].fill(0.3);
        let settings = Settings { max_iterations: 1, spares_relaxation, ..settings };
        let (linearised, _, outcome) = work(&problem, &settings, &mut state);
        assert!(linearised > 2 * problem.elements(), "{linearised}");
        (linearised, outcome, state)
    };
    assert_eq!(first(true), first(false));
}

/// Elements with one number each, of which every well is a little lower than the one before: `sin² πp + 0.1 p`.
struct Stairs(usize);

impl Problem for Stairs {
    fn blocks(&self) -> usize {
        self.0
    }
    fn dofs(&self, _: usize) -> usize {
        1
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        self.0
    }
    fn elements(&self) -> usize {
        self.0
    }
    fn element_blocks(&self, element: usize, blocks: &mut BlockList) {
        blocks.extend([element]);
    }
    fn max_element_dofs(&self) -> usize {
        1
    }
    fn cost(&self, element: usize, state: &[f64]) -> f64 {
        let p = state[element];
        (PI * p).sin().powi(2) + 0.1 * p
    }
    fn linearise(&self, element: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        let p = state[element];
        gradient[0] = PI * (2.0 * PI * p).sin() + 0.1;
        matrix[0] = 2.0 * PI * PI * (2.0 * PI * p).cos();
        self.cost(element, state)
    }
    fn variants(&self) -> usize {
        1
    }
    fn vary(&self, element: usize, _: usize, state: &mut [f64]) {
        state[element] -= 1.0;
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to[0] = from[0] + step[0];
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(0.1);
    }
    fn natural_cost(&self) -> f64 {
        self.0 as f64
    }
}

#[test]
fn other_minima_are_looked_for_three_times_and_told_of() {
    for relative_decrease in [0.0, 1e-2] {
        let settings = Settings { relaxation: 9, relative_decrease, ..Settings::DEFAULT };
        let problem = Stairs(3);
        let mut state = vec![10.0; 3];
        let (outcome, _) = solving::run(&problem, &settings, &InOrder, &mut Silent, &mut state);
        assert_eq!(outcome.status, Status::Converged);
        assert!(state.iter().all(|p| (p - 7.0).abs() < 0.01), "{relative_decrease} {state:?}");
        let value: f64 = (0..3).map(|element| problem.cost(element, &state)).sum();
        assert!((outcome.value - value).abs() < 1e-12, "{relative_decrease} {outcome:?} {value}");
    }
}
