#!/bin/sh
# sanitize.sh: the C examples and the C tests with AddressSanitizer and UndefinedBehaviorSanitizer, over the library built
# with AddressSanitizer, debug assertions and overflow checks; then valgrind over the library as it is shipped.
set -eu
cd "$(dirname "$0")/.."
: "${CC:=cc}" "${CXX:=c++}"
target_dir=${CARGO_TARGET_DIR:-$PWD/target}
scripts/need.sh "$CC" gcc "the C compiler"
scripts/need.sh "$CXX" g++ "the C++ compiler"
scripts/need.sh valgrind valgrind "the cross-check"
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
triple=$(rustc -vV | sed -n 's/^host: //p')
out=$target_dir/sanitize
mkdir -p "$out"

(
    . scripts/unstable.sh
    # No link-time optimisation: indices are checked in the code as it is written.
    CARGO_TARGET_DIR=$out MINVAR_HEADER=check \
        RUSTFLAGS="-Zsanitizer=address -Cdebug-assertions=on -Coverflow-checks=on" \
        CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
        cargo build --quiet --locked --release --target "$triple" -p minvar-ffi
)
checked=$out/$triple/release/libminvar.a

# The compiler's own core, which link-time optimisation would have left out, names what unwinds: nothing does.
personality=-Wl,--defsym=rust_eh_personality=0

# program NAME LIBRARY FLAG… : builds it from its sources.
program() {
    name=$1 library=$2
    shift 2
    case $name in
    01_*) sources=c_examples/$name.c ;;
    wrapper) sources="tests/c/wrapper.cpp tests/c/wrapper_twice.cpp" ;;
    wrapper_*) sources=tests/c/$name.cpp ;;
    *) sources=tests/c/$name.c ;;
    esac
    case $sources in
    *.cpp) compiler="$CXX -std=c++17" ;;
    *) compiler="$CC -std=c11 -D_POSIX_C_SOURCE=200809L" ;;
    esac
    # shellcheck disable=SC2086
    $compiler -Iinclude "-DMINVAR_VERSION_EXPECTED=\"$version\"" -g -O1 "$@" $sources "$library" -lm -pthread \
        -o "$out/$name"
}

export ASAN_OPTIONS=abort_on_error=0:handle_abort=1:detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
for name in 01_coving header coving region bad_input callbacks faults threads layout wrapper wrapper_stranger; do
    program "$name" "$checked" "$personality" -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    # What the example writes is to lie there too.
    (cd "$out" && "./$name") >"$out/$name.txt" 2>&1 || {
        cat "$out/$name.txt" >&2
        echo "$name fails under the sanitizers" >&2
        exit 1
    }
    echo "$name: nothing found by AddressSanitizer, UndefinedBehaviorSanitizer, debug assertions and overflow checks"
done

cargo build --quiet --locked --release -p minvar-ffi
for name in 01_coving coving region callbacks bad_input faults; do
    program "$name" "$target_dir/release/libminvar.a"
    (cd "$out" && valgrind --quiet --error-exitcode=9 --leak-check=full "./$name") >"$out/$name.txt" 2>&1 || {
        cat "$out/$name.txt" >&2
        echo "$name fails under valgrind" >&2
        exit 1
    }
    echo "$name: nothing found by valgrind"
done
