//! Prints the curves of `tests/data/curves` as C: `make cross-curves`.

fn main() {
    print!("{}", minvar_tests::cross::data::as_c());
}
