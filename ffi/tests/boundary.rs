//! The C boundary called as C calls it, by raw pointers, from Rust: so that Miri can watch.
//!
//! Memory is what C hands over: exactly as long as it is said to be, and never written where the library is to write.
//! The figures are the kernel's to the last bit; whether those are right is tested elsewhere. All is small, for Miri
//! takes a thousand times as long (`make miri`).

mod callbacks;
mod memory;
mod paths;
mod places;
mod refusals;
mod solving;
mod threads;

/// The name of every function in `include/minvar.h`.
fn declared() -> Vec<&'static str> {
    let header = include_str!("../../include/minvar.h");
    let name = |line: &'static str| {
        let name = line.split_once('(')?.0.rsplit([' ', '*']).next()?;
        let declares = !line.starts_with([' ', '/', '#']) && !line.starts_with("typedef");
        (declares && name.starts_with("minvar_")).then_some(name)
    };
    header.lines().filter_map(name).collect()
}

#[test]
#[cfg_attr(miri, ignore = "about the sources, without a pointer")]
fn every_function_of_the_header_is_called_here() {
    let sources = [
        include_str!("callbacks.rs"),
        include_str!("memory.rs"),
        include_str!("paths.rs"),
        include_str!("places.rs"),
        include_str!("refusals.rs"),
        include_str!("solving.rs"),
        include_str!("threads.rs"),
    ];
    assert!(declared().len() > 20, "no functions found in minvar.h: {:?}", declared());
    let called = |name: &&str| sources.iter().any(|source| source.contains(&format!("{name}(")));
    let missing: Vec<_> = declared().into_iter().filter(|name| !called(name)).collect();
    assert!(missing.is_empty(), "never called: {missing:?}");
}
