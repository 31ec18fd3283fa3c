//! Draws the figures of thesis chapter 4 and writes the page that shows them, with Table 4.1 computed anew and the
//! iterations: `figures [DIRECTORY]`, by default `docs/figures`. `make figures`.

use minvar_tests::figures::{all, page, table};
use minvar_tests::iterations;
use std::path::PathBuf;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let directory = env::args_os().nth(1).map_or_else(|| PathBuf::from("docs/figures"), PathBuf::from);
    fs::create_dir_all(&directory)?;
    let figures = all();
    for figure in &figures {
        fs::write(directory.join(figure.file()), &figure.svg)?;
    }
    fs::write(directory.join("README.md"), page(&figures, &format!("{}\n{}", table(), iterations::table())))?;
    println!("{} figures and README.md in {}", figures.len(), directory.display());
    Ok(())
}
