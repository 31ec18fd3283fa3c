#!/bin/sh
# planted.sh: that the committed hashes notice what they are for. In a copy of the library the sine is the platform's, in
# another one sum is a fused multiply-add; each must differ from tests/cross/hashes.txt. Exit status 1 if one does not.
set -eu
cd "$(dirname "$0")/../.."
cross=${CROSS:-$PWD/target/cross}
unset MAKEFLAGS MFLAGS MAKELEVEL
mkdir -p "$cross/planted"
grep -v '^long/' tests/cross/hashes.txt >"$cross/planted/expected.txt"

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

# check NAME: how many lines of the corpus differ.
check() {
    cargo build -q --locked --release -p minvar-ffi --manifest-path "$copy/Cargo.toml" --target-dir "$cross/planted/build"
    # shellcheck disable=SC2046
    ${CC:-cc} -std=c11 -O2 -ffp-contract=off -Iinclude -Itests/cross tests/cross/main.c $(echo tests/cross/corpus/*.c) \
        tests/cross/platform/hosted.c "$cross/planted/build/release/libminvar.a" -lm -o "$copy/corpus"
    "$copy/corpus" >"$cross/planted/found.txt"
    lines=$(wc -l <"$cross/planted/expected.txt")
    differ=$(diff "$cross/planted/expected.txt" "$cross/planted/found.txt" | grep -c '^<' || true)
    echo "$1: $differ of $lines lines differ"
    [ "$differ" -gt 0 ] || { echo "planted.sh: the hashes did not notice" >&2; exit 1; }
}

for name in sine fused; do
    copy=$cross/planted/$name
    rm -rf "$copy"
    mkdir -p "$copy"
    tar -cf - Cargo.toml Cargo.lock kernel ffi include cli tests c_examples | tar -xf - -C "$copy"
    case $name in
    sine)
        plant kernel/src/lib.rs '#![forbid(unsafe_code)]' ''
        cat >>"$copy/kernel/src/lib.rs" <<'END'
mod planted {
    unsafe extern "C" {
        safe fn sin(x: f64) -> f64;
    }
    pub(crate) fn sine(x: f64) -> f64 {
        sin(x)
    }
}
END
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
