//! Executors that do not do what they are asked to: whatever they do, the solver ends, and does not panic. What keeps
//! to the words of [`Executor`] changes no bit, what leaves elements out is noticed.

use minvar::solve::{
    Executor, InOrder, Outcome, Record, Settings, Silent, Status, Task, WorkspaceTooSmall, minimise,
    workspace_len,
};
use minvar_tests::valley::{Rosenbrock, rosenbrock_start};
use std::sync::atomic::{AtomicUsize, Ordering};

const COUNT: usize = 24;
const PROBLEM: Rosenbrock = Rosenbrock { count: COUNT };

/// An executor made of a function.
struct Does<F>(usize, F);

impl<F: Fn(&mut [f64], usize, &Task<'_>)> Executor for Does<F> {
    fn width(&self) -> usize {
        self.0
    }
    fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
        (self.1)(slots, slot_len, task);
    }
}

/// Solves over memory full of numbers that look like results.
fn attempt(executor: &dyn Executor) -> (Outcome, Vec<f64>, Vec<Record>) {
    let mut state = rosenbrock_start(COUNT);
    let mut workspace = vec![0.125; workspace_len(&PROBLEM, executor.width())];
    let mut records = vec![Record::ZERO; 400];
    let settings = Settings { max_iterations: 300, relaxation: 2, ..Settings::DEFAULT };
    let outcome =
        minimise(&PROBLEM, &settings, executor, &mut state, &mut workspace, &mut records, &mut Silent);
    let outcome = outcome.expect("enough memory");
    assert!(outcome.iterations <= 300);
    (outcome, state, records)
}

fn honestly(slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
    for (index, slot) in slots.chunks_exact_mut(slot_len).enumerate() {
        task(index, slot);
    }
}

#[test]
fn order_threads_and_repetition_change_no_bit() {
    let honest = attempt(&InOrder);
    assert_eq!(honest.0.status, Status::Converged);
    let twice = |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        honestly(slots, slot_len, task);
        honestly(slots, slot_len, task);
    };
    let backwards = |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        for (index, slot) in slots.chunks_exact_mut(slot_len).enumerate().rev() {
            task(index, slot);
            task(index, slot);
        }
    };
    let threads = |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        std::thread::scope(|scope| {
            for (index, slot) in slots.chunks_exact_mut(slot_len).enumerate() {
                scope.spawn(move || task(index, slot));
            }
        });
    };
    // First wrongly, then as it should be.
    let dirty = |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        slots.fill(f64::NAN);
        honestly(slots, slot_len, task);
    };
    for width in [0, 1, 2, 7, COUNT, 1000] {
        assert_eq!(attempt(&Does(width, honestly)), honest, "width {width}");
        assert_eq!(attempt(&Does(width, twice)), honest, "twice, width {width}");
        assert_eq!(attempt(&Does(width, backwards)), honest, "backwards, width {width}");
        assert_eq!(attempt(&Does(width, dirty)), honest, "over NaN, width {width}");
    }
    assert_eq!(attempt(&Does(7, threads)), honest, "in threads");
}

/// The state is one of those that were accepted: no worse than the start.
fn sound(state: &[f64], what: &str) {
    use minvar::solve::Problem;
    let cost = |state: &[f64]| (0..COUNT - 1).map(|element| PROBLEM.cost(element, state)).sum::<f64>();
    let (start, end) = (cost(&rosenbrock_start(COUNT)), cost(state));
    assert!(end <= start * (1.0 + 1e-12), "{what}: {end} from {start}");
}

#[test]
fn an_element_that_is_left_out_at_any_time_is_noticed() {
    // How often an honest executor is called.
    let calls = AtomicUsize::new(0);
    let counting = Does(5, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        calls.fetch_add(1, Ordering::Relaxed);
        honestly(slots, slot_len, task);
    });
    attempt(&counting);
    let all = calls.load(Ordering::Relaxed);
    assert!(all > 50, "{all}");
    for from in (0..all).step_by(3) {
        for left_out in [0, 2, 4] {
            let calls = AtomicUsize::new(0);
            let lazy = Does(5, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
                let lazy = calls.fetch_add(1, Ordering::Relaxed) >= from;
                for (index, slot) in slots.chunks_exact_mut(slot_len).enumerate() {
                    // The last batch is shorter: of it nothing is done.
                    if !(lazy && (index == left_out || index == 2)) {
                        task(index, slot);
                    }
                }
            });
            let (outcome, state, _) = attempt(&lazy);
            let what = format!("element {left_out} from call {from} on");
            assert_eq!(outcome.status, Status::Stalled, "{what}: {outcome:?}");
            assert!(state.iter().all(|x| x.is_finite()), "{what}");
            assert!(outcome.iterations == 0 || outcome.value.is_finite(), "{what}: {outcome:?}");
            sound(&state, &what);
        }
    }
    let idle = Does(5, |_: &mut [f64], _: usize, _: &Task<'_>| {});
    let (outcome, state, _) = attempt(&idle);
    assert_eq!((outcome.status, outcome.iterations), (Status::Stalled, 0));
    assert!(!outcome.value.is_finite());
    assert_eq!(state, rosenbrock_start(COUNT), "a state of which nothing is known stays");
}

#[test]
fn an_element_that_is_left_out_once_costs_a_step_at_most() {
    for once in 1..12 {
        let calls = AtomicUsize::new(0);
        let absent = Does(COUNT, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
            if slot_len > 2 || calls.fetch_add(1, Ordering::Relaxed) != once {
                honestly(slots, slot_len, task);
            }
        });
        let (outcome, ..) = attempt(&absent);
        assert_eq!(outcome.status, Status::Converged, "call {once}: {outcome:?}");
        assert!(outcome.gradient < 1e-6, "call {once}: {outcome:?}");
    }
}

#[test]
fn places_and_slots_that_do_not_exist_are_left_alone() {
    let honest = attempt(&InOrder);
    let astray = Does(5, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
        let mut own = vec![0.5; slot_len + 3];
        task(usize::MAX, &mut own[..slot_len]);
        task(5, &mut own[..slot_len]);
        for len in [0, 1, slot_len - 1, slot_len + 1, slot_len + 3] {
            if len != slot_len {
                task(0, &mut own[..len]);
            }
        }
        assert!(own.iter().all(|&x| x == 0.5), "somebody wrote there");
        honestly(slots, slot_len, task);
    });
    assert_eq!(attempt(&astray), honest);
    // Results that are kept to himself are left out.
    let greedy = Does(5, |_: &mut [f64], slot_len: usize, task: &Task<'_>| {
        let mut own = vec![0.0; slot_len];
        task(0, &mut own);
    });
    assert_eq!(attempt(&greedy).0.status, Status::Stalled);
}

#[test]
fn garbage_in_the_slots_comes_to_an_end() {
    let garbage = [0.0, -1.0, 1e300, -1e300, f64::MIN_POSITIVE, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for from in [0, 1, 3, 9] {
        for number in garbage {
            let calls = AtomicUsize::new(0);
            let liar = Does(5, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
                honestly(slots, slot_len, task);
                if calls.fetch_add(1, Ordering::Relaxed) >= from {
                    for (k, x) in slots.iter_mut().enumerate() {
                        *x = if k % 3 == 1 { -number } else { number };
                    }
                }
            });
            attempt(&liar);
        }
        // Every element another's numbers.
        let swapping = Does(5, |slots: &mut [f64], slot_len: usize, task: &Task<'_>| {
            honestly(slots, slot_len, task);
            slots.rotate_left(slot_len);
        });
        attempt(&swapping);
    }
}

#[test]
fn a_width_that_changes_or_has_no_memory_does_no_harm() {
    struct Fickle(AtomicUsize);
    impl Executor for Fickle {
        fn width(&self) -> usize {
            [3, 900, 0, usize::MAX][self.0.fetch_add(1, Ordering::Relaxed) % 4]
        }
        fn run(&self, slots: &mut [f64], slot_len: usize, task: &Task<'_>) {
            honestly(slots, slot_len, task);
        }
    }
    let solve = |executor: &dyn Executor, workspace: &mut [f64]| {
        let mut state = rosenbrock_start(COUNT);
        let settings = Settings { max_iterations: 300, relaxation: 2, ..Settings::DEFAULT };
        minimise(&PROBLEM, &settings, executor, &mut state, workspace, &mut [], &mut Silent)
            .map(|outcome| (outcome, state))
    };
    let mut workspace = vec![f64::NAN; workspace_len(&PROBLEM, 900)];
    let (outcome, state, _) = attempt(&InOrder);
    for begin in 0..3 {
        let found = solve(&Fickle(AtomicUsize::new(begin)), &mut workspace);
        assert_eq!(found, Ok((outcome, state.clone())));
    }
    let needed = usize::MAX;
    let given = workspace.len();
    assert_eq!(workspace_len(&PROBLEM, usize::MAX), needed);
    let result = solve(&Fickle(AtomicUsize::new(3)), &mut workspace);
    assert_eq!(result, Err(WorkspaceTooSmall { needed, given }));
}
