//! `stack_bound PROGRAM [FUNCTION]`: the bytes of stack that every function of the C library in a Thumb program takes at most, or
//! the deepest chain of calls below one. The program is linked with `--emit-relocs` of code that was compiled with
//! `-Z emit-stack-sizes`: see scripts/cross/run.sh.

use minvar_tests::stack::bound::Bounds;
use minvar_tests::stack::program::Program;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(path) = arguments.next() else {
        eprintln!("stack_bound PROGRAM [FUNCTION]");
        return ExitCode::from(2);
    };
    let found =
        std::fs::read(&path).map_err(|e| e.to_string()).and_then(|data| print(&data, arguments.next()));
    if let Err(why) = found {
        eprintln!("stack_bound: {path}: {why}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

fn print(data: &[u8], of: Option<String>) -> Result<(), String> {
    let program = Program::read(data)?;
    let bounds = Bounds::new(&program)?;
    if let Some(function) = of {
        let chain = bounds.chain(&function);
        if chain.is_empty() {
            return Err(format!("no function {function}"));
        }
        chain.iter().for_each(|(frame, name)| println!("{frame:6} {name}"));
    } else {
        bounds.of_the_library().iter().for_each(|(name, bytes)| println!("{name};{bytes}"));
    }
    Ok(())
}
