# To be sourced: the compiler's unstable flags (sanitizers, coverage), from a nightly toolchain where there is one, else from
# the one in use, told to take them.
if rustup toolchain list 2>/dev/null | grep -q '^nightly'; then
    RUSTUP_TOOLCHAIN=$(rustup toolchain list | sed -n 's/^\(nightly[^ ]*\).*/\1/p' | head -1)
    export RUSTUP_TOOLCHAIN
else
    export RUSTC_BOOTSTRAP=1
fi
