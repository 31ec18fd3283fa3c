//! The panic handler, which a library must have though no function of this one can come to it: that is proven by linking it
//! with a handler that does not exist (scripts/no_panic.sh). A library built for debugging stops the program.

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    stop()
}

#[cfg(minvar_proof)]
fn stop() -> ! {
    unsafe extern "C" {
        fn minvar_can_panic() -> !;
    }
    // SAFETY: a program in which this is reachable cannot be linked.
    unsafe { minvar_can_panic() }
}

#[cfg(all(not(minvar_proof), target_family = "wasm"))]
fn stop() -> ! {
    core::arch::wasm32::unreachable()
}

#[cfg(all(
    not(minvar_proof),
    any(target_os = "none", all(target_os = "unknown", not(target_family = "wasm")))
))]
fn stop() -> ! {
    loop {}
}

#[cfg(not(any(minvar_proof, target_family = "wasm", target_os = "none", target_os = "unknown")))]
fn stop() -> ! {
    unsafe extern "C" {
        fn abort() -> !;
    }
    // SAFETY: C's abort takes nothing and does not return.
    unsafe { abort() }
}
