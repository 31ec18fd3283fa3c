//! The command `minvar`: all of it is the library's, where it can be tested without files.

use std::process::ExitCode;

fn main() -> ExitCode {
    minvar_cli::command()
}
