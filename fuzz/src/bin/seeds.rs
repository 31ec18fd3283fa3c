//! Writes the seeds of all targets: `seeds CURVES FOLDER`.

use std::env;
use std::io;
use std::path::PathBuf;

fn main() -> io::Result<()> {
    let words: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [curves, folder] = words.as_slice() else { return Err(io::Error::other("seeds CURVES FOLDER")) };
    hostile::seeds::write(curves, folder)
}
