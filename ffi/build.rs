//! Writes the C header, and names the shared library as Linux loads it.
//!
//! `include/minvar.h` is committed. With `MINVAR_HEADER=check` the build fails where it has drifted from this crate;
//! otherwise it is written anew.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=cbindgen.toml");
    println!("cargo::rerun-if-changed=../include/minvar.h");
    println!("cargo::rerun-if-env-changed=MINVAR_HEADER");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml is readable");
    let bindings = cbindgen::Builder::new()
        .with_crate(&root)
        .with_config(config)
        .generate()
        .expect("the C interface can be written as a header");
    let mut text = Vec::new();
    bindings.write(&mut text);
    let header = root.join("../include/minvar.h");
    let committed = fs::read(&header).unwrap_or_default();
    if committed != text {
        if env::var("MINVAR_HEADER").is_ok_and(|wish| wish == "check") {
            panic!("include/minvar.h has drifted from ffi/: run `make header` and commit it");
        }
        fs::write(&header, &text).expect("include/minvar.h can be written");
    }
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libminvar.so.0");
    }
}
