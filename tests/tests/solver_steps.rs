//! What one step of the solver is, and when steps end: objectives of one element, of few unknowns.

use minvar::solve::{
    BlockList, Coupled, InOrder, Outcome, Problem, Record, Settings, Silent, Status, packed,
};
use minvar_tests::solving;
use std::ops::Range;

/// The sums at a state, the gradient of the objective, that of the second sum, and the second derivatives of the first one
/// by the numbers themselves: there are none between two.
struct Local<const N: usize> {
    sums: [f64; 2],
    gradient: [f64; N],
    second: [f64; N],
    curvature: [f64; N],
}

/// An element of `N` numbers, each a block of its own. The objective is the first sum, or that plus half the square of the
/// second one, which is linear, times the natural cost.
struct Toy<const N: usize, F> {
    local: F,
    natural: f64,
    coupled: bool,
    cautious: bool,
    held: usize,
}

impl<const N: usize, F: Fn(&[f64]) -> Local<N> + Sync> Toy<N, F> {
    fn new(local: F) -> Self {
        Self { local, natural: 1.0, coupled: false, cautious: false, held: 0 }
    }

    /// Minimises from a state, which is left where that ended; with what every iteration did.
    fn run(&self, settings: &Settings, state: &mut [f64; N]) -> (Outcome, Vec<Record>) {
        solving::run(self, settings, &InOrder, &mut Silent, state)
    }
}

impl<const N: usize, F: Fn(&[f64]) -> Local<N> + Sync> Problem for Toy<N, F> {
    fn blocks(&self) -> usize {
        N
    }
    fn dofs(&self, _: usize) -> usize {
        1
    }
    fn state_range(&self, block: usize) -> Range<usize> {
        block..block + 1
    }
    fn state_len(&self) -> usize {
        N
    }
    fn elements(&self) -> usize {
        1
    }
    fn element_blocks(&self, _: usize, blocks: &mut BlockList) {
        blocks.extend(0..N);
    }
    fn max_element_dofs(&self) -> usize {
        N
    }
    fn cost(&self, _: usize, state: &[f64]) -> f64 {
        (self.local)(state).sums[0]
    }
    fn linearise(&self, _: usize, state: &[f64], gradient: &mut [f64], matrix: &mut [f64]) -> f64 {
        self.linearise_sums(0, state, [1.0, 0.0], gradient, &mut [], matrix)[0]
    }
    fn is_coupled(&self) -> bool {
        self.coupled
    }
    fn is_cautious(&self) -> bool {
        self.cautious
    }
    fn couple(&self, sums: [f64; 2]) -> Coupled {
        if !self.coupled {
            return Coupled::plain(sums);
        }
        let ([a, b], weight) = (sums, self.natural);
        Coupled {
            value: a + 0.5 * weight * b * b,
            first: [1.0, weight * b],
            second: [[0.0, 0.0], [0.0, weight]],
        }
    }
    fn sums(&self, _: usize, state: &[f64]) -> [f64; 2] {
        (self.local)(state).sums
    }
    fn linearise_sums(
        &self,
        _: usize,
        state: &[f64],
        first: [f64; 2],
        gradient: &mut [f64],
        second: &mut [f64],
        matrix: &mut [f64],
    ) -> [f64; 2] {
        let local = (self.local)(state);
        for k in 0..N {
            gradient[k] = first[0] * local.gradient[k] + first[1] * local.second[k];
            if self.coupled {
                second[k] = local.second[k];
            }
            matrix[packed(k, k)] = first[0] * local.curvature[k];
        }
        local.sums
    }
    fn held(&self, block: usize) -> usize {
        usize::from(block < self.held)
    }
    fn retract(&self, _: usize, from: &[f64], step: &[f64], to: &mut [f64]) {
        to[0] = from[0] + step[0];
    }
    fn natural_sizes(&self, _: usize, _: &[f64], sizes: &mut [f64]) {
        sizes.fill(1.0);
    }
    fn natural_cost(&self) -> f64 {
        self.natural
    }
}

/// `slope·x + curvature/2·x²` in every number.
fn quadratic<const N: usize>(slope: [f64; N], curvature: [f64; N]) -> impl Fn(&[f64]) -> Local<N> + Sync {
    move |x| Local {
        sums: [
            (0..N).map(|k| slope[k] * x[k] + 0.5 * curvature[k] * x[k] * x[k]).sum(),
            x.last().copied().unwrap_or(0.0),
        ],
        gradient: core::array::from_fn(|k| slope[k] + curvature[k] * x[k]),
        second: core::array::from_fn(|k| f64::from(u8::from(k + 1 == N))),
        curvature,
    }
}

const ONE: Settings = Settings { max_iterations: 1, ..Settings::DEFAULT };

/// The slope along the ridge goes from what decides nothing to what decides all: for some the shift that would make the step
/// as long as the ball lies between two numbers. The size of the objective is nothing to that.
#[test]
fn a_step_from_a_ridge_ends_in_the_ball_and_brings_what_it_promises() {
    for (coupled, cautious) in [(false, false), (true, false), (true, true)] {
        for (scale, k) in [1.0, 1e-120, 1e120].into_iter().flat_map(|scale| (0..240).map(move |k| (scale, k)))
        {
            let slope = if k == 0 { 0.0 } else { scale * 0.8_f64.powi(k - 1) };
            for aside in [0.5, 0.0] {
                let local = quadratic([slope, scale * aside], [-scale, 2.0 * scale]);
                let toy = Toy { coupled, cautious, natural: scale, ..Toy::new(local) };
                let what = format!("{coupled} {cautious} {scale} {slope} {aside}");
                let mut state = [0.0; 2];
                let (_, records) = toy.run(&ONE, &mut state);
                if cautious && records.is_empty() {
                    // What is careful may go nowhere from where next to nothing leads away.
                    assert!(slope < 1e-3 * scale && aside == 0.0, "{what}");
                    continue;
                }
                let [Record { predicted, actual, step, .. }] = records[..] else { panic!("{what}: no step") };
                let length = state[0].hypot(state[1]);
                assert!((length - step).abs() < 1e-12, "{what}: {length} is called {step}");
                assert!(length < 1.1 + 1e-12, "{what}: {length}");
                assert!(
                    (predicted - actual).abs() < 1e-9 * actual.abs() && actual > 0.0,
                    "{what}: {predicted} {actual}"
                );
                // All the way down on either side, unless carefully.
                assert!(cautious || length > 0.89, "{what}: {length}");
            }
        }
    }
}

/// What bends down by rounding alone is no ridge, however large all is.
#[test]
fn a_step_goes_no_way_along_what_is_flat_to_rounding() {
    for scale in [1e-8, 1.0, 1e8] {
        let local = quadratic([0.0, 0.5 * scale], [-1e-12 * scale, 2.0 * scale]);
        let toy = Toy { coupled: true, natural: scale, ..Toy::new(local) };
        let mut state = [0.0; 2];
        let (_, records) = toy.run(&ONE, &mut state);
        assert_eq!(records.len(), 1);
        assert!(state[0].abs() < 1e-3 && state[1] < -0.1, "{scale} {state:?}");
    }
}

/// What is added of rank two makes up for the negative eigenvalue, unless the problem says that it must not.
#[test]
fn a_step_is_newton_s_where_the_whole_is_definite() {
    let toy = Toy { coupled: true, ..Toy::new(quadratic([0.25, 0.125], [2.0, -0.5])) };
    let mut state = [0.0; 2];
    let (outcome, records) = toy.run(&Settings { max_iterations: 9, ..ONE }, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    assert!(records[0].shift == 0.0 && records[0].predicted > 0.0, "{:?}", records[0]);
    assert!((state[0] + 0.125).abs() < 1e-15 && (state[1] + 0.25).abs() < 1e-15, "{state:?}");
}

#[test]
fn what_is_held_stays_and_the_rest_goes_where_it_belongs() {
    for coupled in [false, true] {
        let toy = Toy { coupled, held: 2, ..Toy::new(quadratic([1.0, -2.0, 0.5], [2.0, 4.0, 1.0])) };
        let mut state = [0.25, 0.375, 0.0];
        let (outcome, _) = toy.run(&Settings { max_iterations: 9, ..ONE }, &mut state);
        assert_eq!(outcome.status, Status::Converged);
        let wanted = if coupled { -0.25 } else { -0.5 };
        assert_eq!(state[..2], [0.25, 0.375]);
        assert!((state[2] - wanted).abs() < 1e-12, "{coupled} {state:?}");
    }
}

/// A cost that is a thousandth of the natural one and less is as good as nothing: `x⁴`, of which every step of Newton's leaves
/// a fifth, need not go on to rounding.
#[test]
fn a_cost_of_nearly_nothing_is_not_followed_for_its_own_fraction() {
    let quartic = |x: &[f64]| Local {
        sums: [x[0].powi(4), 0.0],
        gradient: [4.0 * x[0].powi(3)],
        second: [0.0],
        curvature: [12.0 * x[0] * x[0]],
    };
    let settings = Settings { max_iterations: 99, relative_decrease: 1e-6, ..Settings::DEFAULT };
    let (outcome, _) = Toy::new(quartic).run(&settings, &mut [1.0]);
    assert_eq!(outcome.status, Status::Converged);
    // It promises two thirds of what is left.
    assert!(outcome.value > 1e-10 && outcome.value < 2e-9, "{outcome:?}");
    // Where the natural cost is small, that is followed further.
    let toy = Toy { natural: 1e-6, ..Toy::new(quartic) };
    let (outcome, _) = toy.run(&settings, &mut [1.0]);
    assert!(outcome.status == Status::Converged && outcome.value < 2e-15, "{outcome:?}");
}

/// A slope that would gain little by a step of natural size is enough for who asks for little; a step that gains little because
/// it is short is not.
#[test]
fn a_short_step_that_gains_little_is_no_reason_to_end() {
    let slope = Toy::new(|x: &[f64]| Local {
        sums: [1.0 - 5e-4 * x[0] + 5e-10 * x[0] * x[0], 0.0],
        gradient: [-5e-4 + 1e-9 * x[0]],
        second: [0.0],
        curvature: [1e-9],
    });
    let settings =
        Settings { max_iterations: 50, relative_decrease: 1e-3, first_radius: 1e-3, ..Settings::DEFAULT };
    let mut state = [0.0];
    let (outcome, _) = slope.run(&settings, &mut state);
    assert_eq!(outcome.status, Status::Converged);
    assert!(state[0] > 0.2 && state[0] < 3.0 && outcome.iterations < 12, "{state:?} {outcome:?}");
    // Who asks for much goes on to the bottom.
    let mut state = [0.0];
    let (outcome, _) = slope.run(&Settings { relative_decrease: 1e-12, ..settings }, &mut state);
    assert!(outcome.status == Status::Converged && (state[0] - 5e5).abs() < 1.0, "{state:?} {outcome:?}");
}

/// With the gradient's sign wrong every step goes uphill and is refused, until the ball is so small that a step promises
/// nothing: that proves nothing.
#[test]
fn a_ball_that_shrank_to_nothing_is_no_minimum() {
    for natural in [1.0, 1e6] {
        let lie = |x: &[f64]| Local {
            sums: [1.0 + 1e-5 * x[0], 0.0],
            gradient: [-1e-5],
            second: [0.0],
            curvature: [1e-9],
        };
        let (outcome, records) = Toy { natural, ..Toy::new(lie) }.run(&Settings::DEFAULT, &mut [0.0]);
        assert_eq!(outcome.status, Status::Stalled, "{natural}");
        assert!(records.iter().all(|r| r.actual <= 0.0) && outcome.iterations < 30);
    }
}

/// Second derivatives that are half as large again as they should be leave a third of every error: below what costs can
/// tell two steps are taken, and no more.
#[test]
fn two_steps_are_taken_below_what_costs_can_tell() {
    let stiff = |x: &[f64]| Local {
        sums: [1.0 + x[0] * x[0], 0.0],
        gradient: [2.0 * x[0]],
        second: [0.0],
        curvature: [3.0],
    };
    let (outcome, records) = Toy::new(stiff).run(&Settings::DEFAULT, &mut [0.5]);
    assert_eq!(outcome.status, Status::Converged);
    let below = records.iter().filter(|r| r.predicted < 3e-15).count();
    assert!(below == 2 && records.len() > 8, "{below} of {}", records.len());
}
