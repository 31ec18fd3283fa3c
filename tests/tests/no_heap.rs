//! No heap: nothing that the library is made of links `alloc` or `std`, nothing that is linked knows a heap, and no
//! function of the C interface calls one. `no_allocation.rs` counts the kernel's.

use minvar_tests::interface::{declared, symbols};
use minvar_tests::toolchain::{compile, compiler, library, must, root, run, scratch};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn tool(variable: &str, usual: &str) -> OsString {
    env::var_os(variable).unwrap_or_else(|| usual.into())
}

/// Builds a Rust file as the library is built, without the standard library; what the compiler says if it refuses.
fn static_library(name: &str, text: &str) -> Result<PathBuf, String> {
    let (source, built) = (scratch().join(format!("{name}.rs")), scratch().join(format!("lib{name}.a")));
    fs::write(&source, text).expect("the target directory can be written");
    let mut command = Command::new(tool("RUSTC", "rustc"));
    command.args(["--edition=2024", "--crate-type=staticlib", "-Cpanic=abort", "-Copt-level=3", "-o"]);
    let output = run(command.arg(&built).arg(&source), "rustc");
    if output.status.success() {
        Ok(built)
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

/// Ours in small: no standard library, a panic handler of its own.
const LIKE_OURS: &str = "#![no_std]\n\
    #[panic_handler] fn panic(_: &core::panic::PanicInfo<'_>) -> ! { loop {} }\n\
    #[unsafe(no_mangle)] pub extern \"C\" fn answer() -> i32 { 42 }\n";

/// A library that allocates by C's heap.
const ALLOCATES: &str = "extern crate alloc;\n\
    struct Heap;\n\
    unsafe extern \"C\" { fn malloc(size: usize) -> *mut u8; fn free(at: *mut u8); }\n\
    unsafe impl core::alloc::GlobalAlloc for Heap {\n\
        unsafe fn alloc(&self, layout: core::alloc::Layout) -> *mut u8 { unsafe { malloc(layout.size()) } }\n\
        unsafe fn dealloc(&self, at: *mut u8, _: core::alloc::Layout) { unsafe { free(at) } }\n\
    }\n\
    #[unsafe(no_mangle)] extern \"C\" fn rust_eh_personality() {}\n\
    #[global_allocator] static HEAP: Heap = Heap;\n\
    #[unsafe(no_mangle)] pub extern \"C\" fn grows(n: usize) -> usize {\n\
        let mut v = alloc::vec::Vec::new(); for i in 0..n { v.push(i) } v.iter().sum()\n\
    }\n";

/// That libminvar can be built at all is a proof: the compiler refuses one like it as soon as any crate in it, at
/// whatever depth, links `alloc` without an allocator, or `std`, which has a panic handler already.
#[test]
fn the_compiler_refuses_a_library_like_ours_that_links_alloc_or_std() {
    assert!(static_library("plain", LIKE_OURS).is_ok(), "it takes one that links neither");
    let error =
        static_library("with_alloc", &format!("{LIKE_OURS}extern crate alloc;\n")).expect_err("alloc");
    assert!(error.contains("no global memory allocator found"), "{error}");
    let error = static_library("with_std", &format!("{LIKE_OURS}extern crate std;\n")).expect_err("std");
    assert!(error.contains("panic_impl"), "{error}");
    // It takes one that brings an allocator: so none of ours may, which the next test sees to.
    assert!(static_library("with_heap", &format!("{LIKE_OURS}{ALLOCATES}")).is_ok());
    library();
}

/// The crates that a package is linked of, with the features that they have there.
fn linked(package: &str) -> BTreeMap<String, Vec<String>> {
    let mut cargo = Command::new(tool("CARGO", "cargo"));
    cargo.args(["tree", "--locked", "--package", package, "--edges=normal,no-proc-macro", "--prefix=none"]);
    cargo.args(["--no-dedupe", "--format={p}|{f}"]).current_dir(root());
    let crates: BTreeMap<_, _> = must(&mut cargo, "cargo tree")
        .lines()
        .filter_map(|line| {
            let (package, features) = line.split_once('|')?;
            let features = features.split(',').filter(|feature| !feature.is_empty()).map(str::to_owned);
            Some((package.split(' ').next()?.to_owned(), features.collect()))
        })
        .collect();
    assert!(crates.contains_key("nalgebra") && crates.contains_key("minvar"), "{package}: {crates:?}");
    crates
}

/// All Rust files below a folder.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

/// Whether a module's file `tests.rs` is compiled with its tests alone.
fn has_tests_apart(module: &Path) -> bool {
    fs::read_to_string(module).is_ok_and(|text| text.contains("#[cfg(test)]\nmod tests;"))
}

#[test]
fn no_crate_that_is_linked_has_a_heap_switched_on_or_an_allocator_of_its_own() {
    let (kernel, library) = (linked("minvar"), linked("minvar-ffi"));
    let mut more = library.clone();
    more.retain(|name, _| !kernel.contains_key(name));
    assert_eq!(more.keys().collect::<Vec<_>>(), ["minvar-ffi"], "the library is the kernel and the boundary");
    for (name, features) in &library {
        let heap: Vec<_> = features
            .iter()
            .filter(|feature| feature.split(['-', '_']).any(|word| ["std", "alloc"].contains(&word)))
            .collect();
        assert!(heap.is_empty(), "{name} has the features {heap:?}");
    }
    // Where their sources are.
    let mut cargo = Command::new(tool("CARGO", "cargo"));
    cargo.args(["metadata", "--locked", "--format-version=1"]).current_dir(root());
    let output = run(&mut cargo, "cargo metadata");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    let mut searched = BTreeSet::new();
    for package in metadata["packages"].as_array().expect("packages") {
        let name = package["name"].as_str().expect("a name");
        if !library.contains_key(name) {
            continue;
        }
        let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
        for file in rust_files(&manifest.with_file_name("src")) {
            let text = fs::read_to_string(&file).expect("a source");
            let allocator = text.lines().any(|line| line.trim_start().starts_with("#[global_allocator]"));
            assert!(!allocator, "{} brings an allocator", file.display());
            if name.starts_with("minvar") {
                // Tests may have the standard library.
                let folder = file.parent().expect("a folder");
                let modules = [folder.join("mod.rs"), folder.with_extension("rs")];
                if file.ends_with("tests.rs") && modules.iter().any(|module| has_tests_apart(module)) {
                    continue;
                }
                let code = text.replace("#[cfg(test)]\nmod tests;", "");
                let code = code.split("#[cfg(test)]").next().unwrap_or_default();
                // The feature for programs that bring std is not on: it would have been found above.
                let code = code.replace("#[cfg(feature = \"std\")]\nextern crate std;", "");
                let crates: Vec<_> = code.lines().filter(|line| line.contains("extern crate")).collect();
                assert!(crates.is_empty(), "{}: {crates:?}", file.display());
            }
        }
        searched.insert(name.to_owned());
    }
    assert!(library.keys().all(|name| searched.contains(name)), "{searched:?}");
    for source in ["kernel/src/lib.rs", "ffi/src/lib.rs"] {
        let text = fs::read_to_string(root().join(source)).expect(source);
        assert!(text.lines().any(|line| line == "#![no_std]"), "{source} is not no_std");
    }
}

/// Whether a symbol is a heap's: C's and C++'s, the system's calls beneath, Rust's hooks.
fn is_heaps(symbol: &str) -> bool {
    const C: [&str; 20] = [
        "malloc",
        "calloc",
        "realloc",
        "reallocarray",
        "free",
        "cfree",
        "posix_memalign",
        "aligned_alloc",
        "memalign",
        "valloc",
        "pvalloc",
        "strdup",
        "strndup",
        "asprintf",
        "vasprintf",
        "mmap",
        "mmap64",
        "munmap",
        "brk",
        "sbrk",
    ];
    const CPP: [&str; 4] = ["_Znw", "_Zna", "_Zdl", "_Zda"];
    // The hooks, and anything of the crate `alloc`, in either way of writing names.
    const RUST: [&str; 8] = [
        "__rust_alloc",
        "__rust_dealloc",
        "__rust_realloc",
        "__rust_no_alloc_shim",
        "__rdl_",
        "__rg_",
        "_ZN5alloc",
        "_5alloc",
    ];
    C.contains(&symbol.trim_start_matches("__libc_"))
        || CPP.iter().any(|start| symbol.starts_with(start))
        || RUST.iter().any(|part| symbol.contains(part))
}

fn heap_symbols(file: &Path) -> BTreeSet<String> {
    let all = symbols(file, &[]);
    assert!(all.len() > 3, "{}: no symbols", file.display());
    all.into_iter().filter(|symbol| is_heaps(symbol)).collect()
}

/// Links a C program with a static library as an embedded one is linked: what is not used is dropped.
fn link(name: &str, source: &Path, library: &Path) -> PathBuf {
    let program = scratch().join(name);
    let mut command = compile("program.c");
    command.args(["-Os", "-ffunction-sections", "-Wl,--gc-sections"]).arg(source).arg(library);
    must(command.args(["-lm", "-o"]).arg(&program), "linking a program");
    program
}

#[test]
fn a_planted_allocation_is_found() {
    let planted = static_library("planted", &format!("{LIKE_OURS}{ALLOCATES}")).expect("it brings a heap");
    let found = heap_symbols(&planted);
    assert!(found.contains("malloc") && found.contains("free"), "{found:?}");
    assert!(found.iter().any(|symbol| symbol.contains("__rust_alloc")), "{found:?}");
    // Linked too, where only what is used is left.
    let write = |name: &str, text: &str| {
        let source = scratch().join(name);
        fs::write(&source, text).expect("the target directory can be written");
        source
    };
    let calls =
        write("calls.c", "unsigned long grows(unsigned long); int main(void) { return (int)grows(9); }\n");
    assert!(heap_symbols(&link("calls", &calls, &planted)).contains("malloc"));
    let spares = write("spares.c", "int answer(void); int main(void) { return answer(); }\n");
    assert_eq!(
        heap_symbols(&link("spares", &spares, &planted)),
        BTreeSet::new(),
        "what is not used is dropped"
    );
    // And of C, each name by itself.
    for call in ["malloc(9)", "calloc(9, 9)", "realloc(p, 9)", "aligned_alloc(8, 8)", "sbrk(9)"] {
        let text = format!(
            "#define _GNU_SOURCE\n#include <stdlib.h>\n#include <unistd.h>\n#include \"minvar.h\"\n\
             int main(void) {{ void *volatile p = NULL; p = {call}; return p != NULL && minvar_abi_check(2); }}\n"
        );
        let source = write("planted.c", &text);
        let found = heap_symbols(&link("planted_c", &source, &library().join("libminvar.a")));
        let name = call.split('(').next().expect("a name");
        assert_eq!(found.into_iter().collect::<Vec<_>>(), [name]);
    }
}

#[test]
fn nothing_that_is_linked_knows_a_heap() {
    let (archive, shared) = (library().join("libminvar.a"), library().join("libminvar.so"));
    for file in [&archive, &shared] {
        assert_eq!(heap_symbols(file), BTreeSet::new(), "{}", file.display());
    }
    // No object of the crates `alloc` and `std` is in the archive.
    let members = must(Command::new("ar").arg("t").arg(&archive), "ar (Debian: binutils)");
    assert!(members.lines().any(|member| member.starts_with("minvar")), "{members}");
    let foreign: Vec<_> =
        members.lines().filter(|name| name.starts_with("alloc-") || name.starts_with("std-")).collect();
    assert_eq!(foreign, [""; 0]);

    // The whole interface in one object, and the example as it is linked for a small machine.
    let everything = scratch().join("no_heap_everything.o");
    let mut command = Command::new(compiler("CC", "cc"));
    command.args(["-r", "-nostdlib", "-o"]).arg(&everything);
    command.args(declared().iter().map(|name| format!("-Wl,--undefined={name}"))).arg(&archive);
    must(&mut command, "linking the whole interface");
    assert!(declared().is_subset(&symbols(&everything, &["--defined-only"])), "not everything was linked");
    assert_eq!(heap_symbols(&everything), BTreeSet::new());
    let example = link("no_heap_coving", &root().join("c_examples/01_coving.c"), &archive);
    assert!(symbols(&example, &[]).contains("minvar_curve_solve"), "the example is linked with the library");
    assert_eq!(heap_symbols(&example), BTreeSet::new(), "01_coving");
}

#[test]
fn no_c_function_allocates() {
    let source = root().join("tests/c/no_heap.c");
    for shared in [false, true] {
        let program = scratch().join(format!("no_heap_{shared}"));
        let mut command = compile("no_heap.c");
        command.arg(&source).arg("-o").arg(&program);
        if shared {
            let path = format!("-Wl,-rpath,{}", scratch().display());
            command.arg("-L").arg(library()).arg("-lminvar").arg(path);
        } else {
            command.arg(library().join("libminvar.a"));
        }
        must(command.arg("-lm"), "compiling no_heap.c");
        let printed = must(&mut Command::new(&program), "no_heap.c");
        let called: BTreeSet<_> = printed.lines().filter_map(|line| line.strip_prefix("counted ")).collect();
        let declared = declared();
        let declared: BTreeSet<_> = declared.iter().map(String::as_str).collect();
        assert_eq!(called, declared, "the functions that were counted, and those of minvar.h");
    }
}
