#!/bin/sh
# run.sh TARGET PROGRAM [FLAG...]: builds the library and a program of tests/cross for a target and runs it there. What it
# prints comes to target/cross/TARGET/PROGRAM.txt. FLAGs are the C compiler's. PROGRAM `stack`, for Cortex-M, is run here: it
# reads the machine code of the whole library and prints the stack that every function takes at most.
set -eu
cd "$(dirname "$0")/../.."
export CROSS="${CROSS:-target/cross}" MINVAR_HEADER=check
# Cargo would take part in make's bookkeeping of jobs, which it is not invited to.
unset MAKEFLAGS MFLAGS MAKELEVEL
target=$1 program=$2
shift 2
out=$CROSS/$target
result=$out/$program.txt
mkdir -p "$out"
rm -f "$result"

# The triple in Rust's words and what rustc is told besides; clang's flags; the platform; what runs it.
triple= rust= optimise=-O2 c= platform= linker= run= profile=release
freestanding="-ffreestanding -nostdlib -fuse-ld=lld -Wl,--gc-sections"
linux="tests/cross/platform/linux.c tests/cross/platform/memory.c"
board() {
    platform=tests/cross/platform/cortex_m.c
    linker="$freestanding -L tests/cross/platform -T tests/cross/platform/$1.ld"
    run="semihosted $2"
    # Frames are noted beside the code, which stays the same; a stable compiler has to be asked twice.
    rust="${rust:+$rust }-Z emit-stack-sizes"
    export RUSTC_BOOTSTRAP=1
}
case $target in
x86-64) ;;
x86-64-debug) profile=debug optimise=-O0 ;;
x86-64-native) triple=x86_64-unknown-linux-gnu rust="-C target-cpu=native" optimise=-O3 c=-march=native ;;
i686)
    triple=i686-unknown-linux-gnu c="--target=i686-linux-gnu -msse2 -mfpmath=sse"
    platform=$linux linker="$freestanding -static" run=as_it_is
    ;;
aarch64)
    triple=aarch64-unknown-linux-gnu c=--target=aarch64-linux-gnu
    platform=$linux linker="$freestanding -static" run="emulated qemu-aarch64"
    ;;
riscv64)
    triple=riscv64gc-unknown-linux-gnu c="--target=riscv64-linux-gnu -march=rv64gc -mabi=lp64d -mno-relax"
    platform=$linux linker="$freestanding -static" run="emulated qemu-riscv64"
    ;;
cortex-m4)
    triple=thumbv7em-none-eabihf c="--target=thumbv7em-none-eabihf -mcpu=cortex-m4 -mfpu=fpv4-sp-d16"
    board mps2 mps2-an386
    ;;
cortex-m7)
    triple=thumbv7em-none-eabihf rust="-C target-cpu=cortex-m7"
    c="--target=thumbv7em-none-eabihf -mcpu=cortex-m7 -mfpu=fpv5-d16"
    board mps2 mps2-an500
    ;;
cortex-m33)
    triple=thumbv8m.main-none-eabihf c="--target=thumbv8m.main-none-eabihf -mcpu=cortex-m33 -mfpu=fpv5-sp-d16"
    board mps2_an505 mps2-an505
    ;;
wasm)
    triple=wasm32-unknown-unknown c=--target=wasm32
    platform=tests/cross/platform/wasm.c linker="$freestanding -Wl,--no-entry"
    run="node tests/cross/platform/run.mjs"
    ;;
*)
    echo "no target $target" >&2
    exit 2
    ;;
esac
case $target in
x86-64*)
    [ "$(uname -m)" = x86_64 ] || { echo "$target needs a machine of that kind" >&2; exit 2; }
    cc="${CC:-cc}" platform=tests/cross/platform/hosted.c linker="-Wl,--gc-sections" run=as_it_is
    ;;
*) cc=clang ;;
esac

# What was done, and how many seconds it took.
start=$(date +%s)
say() {
    now=$(date +%s)
    printf '%-14s %4d s  %s\n' "$target" $((now - start)) "$1" >&2
    start=$now
}

# Sets `library`.
build_library() {
    if [ -z "$triple" ]; then
        build=${CARGO_TARGET_DIR:-target}
        [ "$profile" = debug ] && flag= || flag=--release
        cargo build -q --locked -p minvar-ffi $flag --target-dir "$build"
        library=$build/$profile/libminvar.a
        return
    fi
    rustc=$(scripts/cross/rustc.sh "$triple")
    say "the compiler"
    # Builds with other flags or compilers would drive each other out of one directory.
    case $target in
    x86-64*) build=${CARGO_TARGET_DIR:-target} ;;
    cortex-m7) build=$CROSS/build-cortex-m7 ;;
    cortex-*) build=$CROSS/build-cortex ;;
    *) build=$CROSS/build ;;
    esac
    RUSTC=$rustc RUSTFLAGS=$rust cargo rustc -q --locked --release -p minvar-ffi --lib --crate-type staticlib \
        --target "$triple" --target-dir "$build"
    library=$build/$triple/release/libminvar.a
}

as_it_is() { ${UNDER:-} "$@"; }
emulated() {
    emulator=$(scripts/cross/private.sh "$1" qemu-user)
    shift
    "$emulator" "$@"
}
semihosted() {
    emulator=$(scripts/cross/private.sh qemu-system-arm qemu-system-arm)
    "$emulator" -M "$1" -nographic -monitor none -serial none -chardev stdio,id=text \
        -semihosting-config enable=on,target=native,chardev=text ${ICOUNT:-} -kernel "$2" </dev/null
}

build_library
say "the library"
if [ "$program" = stack ]; then
    scripts/cross/whole.sh "$library" "$out/stack" --emit-relocs
    unset RUSTC_BOOTSTRAP
    cargo run -q --locked -p minvar-tests --bin stack_bound -- "$out/stack" "$@" >"$result.part"
    mv "$result.part" "$result"
    say "$program run"
    exit
fi
corpus=$(echo tests/cross/corpus/*.c)
measured="tests/cross/bounds/$program.c tests/cross/platform/meter.c"
case $program in
corpus) sources="tests/cross/main.c $corpus" ;;
solves) sources=$measured ;;
size)
    sources=tests/cross/bounds/size.c optimise=-Os
    # It is measured, not run.
    run=:
    ;;
worst)
    sources="$measured $corpus"
    # The functions that it names stand before the library's.
    for name in $(grep -o '"minvar_[a-z_]*"' tests/cross/bounds/worst.c | tr -d '"'); do
        linker="$linker -Wl,--wrap=$name"
    done
    ;;
*)
    echo "no program $program" >&2
    exit 2
    ;;
esac
# shellcheck disable=SC2086
$cc $c -std=c11 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror $optimise -ffp-contract=off -Iinclude -Itests/cross "$@" \
    $sources $platform "$library" $linker -o "$out/$program"
say "$program compiled"
# shellcheck disable=SC2086
$run "$out/$program" >"$result.part"
mv "$result.part" "$result"
say "$program run"
