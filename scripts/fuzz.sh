#!/bin/sh
# fuzz.sh build: builds the fuzz targets and what they begin with.
# fuzz.sh run TARGET: runs one for FUZZ_SECONDS, and says how many inputs it took, how much of the program they reached and
# what was found. An input that breaks a promise is a find: it is kept in fuzz/artifacts, and the exit status is 1. So is
# an input that takes longer than FUZZ_LONGEST seconds.
#
# What earlier runs learned stands in fuzz/corpus and is run first, however long that takes; a copy without it starts
# from the curves of tests/data.
set -eu
cd "$(dirname "$0")/.."
seconds=${FUZZ_SECONDS:-60} longest=${FUZZ_LONGEST:-60}
target_dir=${CARGO_TARGET_DIR:-$PWD/target}
# The compiler's features differ from one toolchain to the next, and so must its folder.
fuzz_dir=$target_dir/fuzz
triple=$(rustc -vV | sed -n 's/^host: //p')
programs=$fuzz_dir/$triple/release

build() {
    . scripts/unstable.sh
    PATH=$target_dir/tools/bin:$PATH
    command -v cargo-fuzz >/dev/null || {
        echo "installing cargo-fuzz" >&2
        (
            unset RUSTUP_TOOLCHAIN RUSTC_BOOTSTRAP
            cargo install --quiet --locked --version '=0.13.2' cargo-fuzz --root "$target_dir/tools"
        )
    }
    export CARGO_TARGET_DIR="$fuzz_dir"
    cargo fetch --quiet --locked --manifest-path fuzz/Cargo.toml
    cargo fuzz build
    "$programs/seeds" tests/data/curves fuzz/corpus
}

run() {
    target=$1
    log=$fuzz_dir/$target.log artifacts=fuzz/artifacts/$target begun=$fuzz_dir/$target.begun
    mkdir -p "$artifacts"
    set -- -max_total_time="$seconds" -timeout="$longest" -report_slow_units="$longest" -rss_limit_mb=2048 \
        -max_len=4096 -print_final_stats=1 -artifact_prefix="$artifacts/"
    [ ! -f "fuzz/$target.dict" ] || set -- "$@" "-dict=fuzz/$target.dict"
    touch "$begun"
    status=0
    "$programs/$target" "fuzz/corpus/$target" "$@" >"$log" 2>&1 || status=$?
    finds=$(find "$artifacts" -type f -newer "$begun" | wc -l)
    [ "$status" = 0 ] || [ "$finds" -gt 0 ] || finds=1
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    cover=$(sed -n 's/^#.* cov: \([0-9]*\).*/\1/p' "$log" | tail -1)
    took=$(sed -n 's/^Done [0-9]* runs in \([0-9]*\) .*/ in \1 s/p' "$log")
    printf '%s: %s executions%s, %s branches reached, %s finds\n' "$target" "${runs:-0}" "$took" "${cover:-0}" "$finds"
    sed -n 's/^both converged/  &/p' "$log"
    [ "$finds" -gt 0 ] || return 0
    grep -A 8 -E 'panicked at|ERROR: (Address|libFuzzer)|Slowest unit' "$log" >&2 || tail -20 "$log" >&2
    find "$artifacts" -type f -newer "$begun" >&2
    return 1
}

case "$*" in
build) build ;;
"run "*) run "$2" ;;
*) echo "fuzz.sh build, or fuzz.sh run TARGET" >&2; exit 2 ;;
esac
