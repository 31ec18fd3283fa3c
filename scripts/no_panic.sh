#!/bin/sh
# no_panic.sh: proves that no function of the C library can panic, by linking it with a panic handler that calls a symbol
# which does not exist; and that such a link fails where a function can.
set -eu
cd "$(dirname "$0")/.."
cargo=${CARGO:-cargo}
folder=${CARGO_TARGET_DIR:-target}/proof
log=$folder/log
mkdir -p "$folder"

# link CFG...: builds the shared library with every function exported; nothing may be missing but what the C library has.
link() {
    flags=
    for cfg; do flags="$flags --cfg $cfg"; done
    # shellcheck disable=SC2086
    CARGO_TARGET_DIR=$folder $cargo rustc --locked --release -p minvar-ffi --lib --crate-type cdylib -- \
        $flags -C link-arg=-Wl,-z,defs -C link-arg=-lc >"$log" 2>&1
}

if ! link minvar_proof; then
    grep -E 'minvar_can_panic|^error' "$log" | head -5 >&2 || true
    echo "no_panic.sh: a function of the C library can panic (or the library does not build: $log)" >&2
    exit 1
fi
functions=$(nm -D --defined-only "$folder/release/libminvar.so" | grep -c ' T minvar_')
if link minvar_proof minvar_planted_panic; then
    echo "no_panic.sh: a planted panic was not found: the proof proves nothing" >&2
    exit 1
fi
grep -q 'undefined.*minvar_can_panic' "$log" || { cat "$log" >&2; exit 1; }
echo "none of the $functions functions of the C library can panic; a planted panic is found"
