#!/bin/sh
# rustc.sh TRIPLE: the path of a Rust compiler that has `core` for the triple: the machine's, if `rustup target add TRIPLE`
# was done, or Debian's, unpacked apart, with a `core` that is compiled once from its sources.
set -eu
here=$(dirname "$0")
cross=${CROSS:-target/cross}
triple=$1
has_core() { ls "$("$1" --print target-libdir --target "$triple")"/libcore-*.rlib >/dev/null 2>&1; }
if has_core rustc; then
    command -v rustc
    exit
fi
mkdir -p "$cross"
cross=$(cd "$cross" && pwd)
# Debian's rustc is too old for us; the one that browsers are built with is not.
place=$cross/bin/rustc-private
if [ ! -x "$place" ]; then
    exec 8>"$cross/lock.rustc"
    flock 8
    if [ ! -x "$place" ]; then
        CROSS=$cross "$here/unpack.sh" rustc-web rust-web-src libstd-rust-web-dev
        mkdir -p "$cross/bin"
        lib=$cross/debian/usr/lib/$(gcc -print-multiarch)
        printf '#!/bin/sh\nLD_LIBRARY_PATH=%s exec %s "$@"\n' "$lib" "$cross/debian/usr/bin/rustc" >"$place.new"
        chmod +x "$place.new"
        mv "$place.new" "$place"
    fi
    exec 8>&-
fi
if ! has_core "$place"; then
    echo "compiling core for $triple" >&2
    scratch=$(mktemp -d)
    trap 'rm -rf "$scratch"' EXIT
    mkdir "$scratch/src"
    printf '[package]\nname = "empty"\nversion = "0.0.0"\nedition = "2024"\n[profile.release]\npanic = "abort"\n' \
        >"$scratch/Cargo.toml"
    printf '#![no_std]\n' >"$scratch/src/lib.rs"
    # RUSTC_BOOTSTRAP lets a stable compiler build its own library; bitcode is for our release profile's lto.
    (cd "$scratch" && RUSTC=$place RUSTC_BOOTSTRAP=1 RUSTFLAGS="-C embed-bitcode=yes" \
        cargo build -q --release -Z build-std=core --target "$triple" --target-dir "$scratch/target") >&2
    library=$("$place" --print target-libdir --target "$triple")
    mkdir -p "$library"
    cp "$scratch/target/$triple/release/deps/"libcompiler_builtins-*.rlib "$library"
    cp "$scratch/target/$triple/release/deps/"libcore-*.rlib "$library"
fi
echo "$place"
