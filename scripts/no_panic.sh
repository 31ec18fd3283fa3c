#!/bin/sh
# no_panic.sh [TRIPLE]: proves that no function of the C library can panic, by linking it with a panic handler that calls a
# symbol which does not exist; and that such a link fails where a function can. TRIPLE is that of an Arm without an
# operating system, whose static library is linked whole; without one it is this machine's shared library.
set -eu
cd "$(dirname "$0")/.."
cargo=${CARGO:-cargo}
triple=${1:-}
folder=${CARGO_TARGET_DIR:-target}/proof
log=$folder/log
mkdir -p "$folder"
if [ -n "$triple" ]; then
    RUSTC=$(scripts/cross/rustc.sh "$triple")
    export RUSTC
fi

# link CFG...: builds the library and links it with every function kept; nothing may be missing but what C has.
link() {
    flags=
    for cfg; do flags="$flags --cfg $cfg"; done
    if [ -z "$triple" ]; then
        # shellcheck disable=SC2086
        CARGO_TARGET_DIR=$folder $cargo rustc --locked --release -p minvar-ffi --lib --crate-type cdylib -- \
            $flags -C link-arg=-Wl,-z,defs -C link-arg=-lc >"$log" 2>&1
        return
    fi
    # shellcheck disable=SC2086
    CARGO_TARGET_DIR=$folder $cargo rustc --locked --release -p minvar-ffi --lib --crate-type staticlib \
        --target "$triple" -- $flags >"$log" 2>&1 || return 1
    scripts/cross/whole.sh "$folder/$triple/release/libminvar.a" "$folder/linked" >>"$log" 2>&1
}

functions() { nm "$@" --defined-only 2>/dev/null | awk '$2 == "T" && $3 ~ /^minvar_/ {print $3}' | sort -u; }

if ! link minvar_proof; then
    grep -E 'minvar_can_panic|^error' "$log" | head -5 >&2 || true
    echo "no_panic.sh: a function of the C library can panic (or the library does not build: $log)" >&2
    exit 1
fi
if [ -z "$triple" ]; then count=$(functions -D "$folder/release/libminvar.so" | wc -l)
else count=$(functions "$folder/linked" | wc -l); fi
[ "$count" -gt 20 ] || { echo "no_panic.sh: only $count functions were linked" >&2; exit 1; }
if link minvar_proof minvar_planted_panic; then
    echo "no_panic.sh: a planted panic was not found: the proof proves nothing" >&2
    exit 1
fi
grep -q 'undefined.*minvar_can_panic' "$log" || { cat "$log" >&2; exit 1; }
echo "${triple:-this machine}: none of the $count functions of the C library can panic; a planted panic is found"
