//! Threads that solve at once from the same joints, each in its own memory: the bits that one gets alone.

use crate::memory::bits;
use crate::solving::{coving, options, solved};
use minvar_ffi::*;
use std::thread;

/// Pointers that threads read through.
#[derive(Clone, Copy)]
struct Shared(*const minvar_joint);

// SAFETY: the joints are only read while the threads run.
unsafe impl Send for Shared {}

#[test]
fn threads_that_solve_at_once_get_the_same_bits() {
    let joints = coving();
    let shared = Shared(joints.as_ptr());
    let work = move || {
        let shared = shared;
        let curve = minvar_curve_through(shared.0, 2, 0);
        bits(&solved(&curve, &options()).elements)
    };
    let alone = work();
    let at_once = thread::scope(|scope| [scope.spawn(work), scope.spawn(work)].map(|thread| thread.join()));
    for bits in at_once {
        assert_eq!(bits.expect("a thread that ends well"), alone);
    }
}
