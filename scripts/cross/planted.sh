#!/bin/sh
# planted.sh: that the committed hashes notice what they are for. In a copy of the project the sine is the platform's, in
# another one a sum of the factor is a fused multiply-add; each must differ from tests/cross/hashes.txt. Exit status 1 if one
# does not. Needs an x86-64.
set -eu
cd "$(dirname "$0")/../.."
planted=$(mkdir -p "${CROSS:-target/cross}/planted" && cd "${CROSS:-target/cross}/planted" && pwd)

# plant FILE OLD NEW: every OLD of a file becomes NEW; there must be one.
plant() {
    grep -qF "$2" "$copy/$1" || { echo "planted.sh: no $2 in $1 any more" >&2; exit 1; }
    OLD=$2 NEW=$3 awk '{
        while (at = index($0, ENVIRON["OLD"])) {
            printf "%s%s", substr($0, 1, at - 1), ENVIRON["NEW"]
            $0 = substr($0, at + length(ENVIRON["OLD"]))
        }
        print
    }' "$copy/$1" >"$copy/planted"
    mv "$copy/planted" "$copy/$1"
}

# check WHAT: the corpus of the copy runs to its end, and the comparison finds it another one.
check() {
    export CROSS="$copy/cross" CARGO_TARGET_DIR="$planted/build"
    "$copy/scripts/cross/run.sh" x86-64 corpus -Wl,--no-as-needed -lm
    if "$copy/scripts/cross/table.sh" --short x86-64 >/dev/null; then
        echo "planted.sh: $1 is not noticed" >&2
        exit 1
    fi
    echo "$1: $(wc -l <"$CROSS/x86-64/differing.txt") of $(wc -l <"$CROSS/expected.txt") lines differ"
}

for name in sine fused; do
    copy=$planted/$name
    rm -rf "$copy"
    mkdir -p "$copy"
    tar -cf - Cargo.toml Cargo.lock kernel ffi include cli tests c_examples scripts | tar -xf - -C "$copy"
    case $name in
    sine)
        plant kernel/src/lib.rs '#![forbid(unsafe_code)]' ''
        cat >>"$copy/kernel/src/lib.rs" <<'RUST'
mod planted {
    unsafe extern "C" {
        safe fn sin(x: f64) -> f64;
    }
    pub(crate) fn sine(x: f64) -> f64 {
        sin(x)
    }
}
RUST
        for file in end natural/functions natural/chain natural/trace; do
            plant "kernel/src/curve/$file.rs" 'libm::sin' 'crate::planted::sine'
        done
        check "the platform's sine"
        ;;
    fused)
        plant kernel/src/solve/envelope.rs 'sum += Lanes(*x) * Lanes(*y);' \
            'sum = Lanes([0, 1].map(|lane| libm::fma(x[lane], y[lane], sum.0[lane])));'
        check "a fused multiply-add in the sums of the factor"
        ;;
    esac
done
