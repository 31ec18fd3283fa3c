//! minvar against Ceres, libspiro and OpenCASCADE in one run: `make bench`, which builds the peers first.
//!
//! `bench PEERS OUTPUT [PEER…]`: the directory with the peers' programs, where the records go, and which peers (all).

use minvar_tests::bench::peer::Peer;
use minvar_tests::bench::record::{Record, head, mean, write};
use minvar_tests::bench::{least_squares, opencascade, own, spiro};
use std::path::Path;
use std::process::ExitCode;

/// What minvar is asked to show by itself.
const OWN: &str = "minvar";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let [peers, output, only @ ..] = arguments else {
        return Err("usage: bench PEERS OUTPUT [PEER…]".into());
    };
    let (peers, output) = (Path::new(peers), Path::new(output));
    let wanted = |name: &str| only.is_empty() || only.iter().any(|one| one == name);
    let mut records: Vec<Record> = Vec::new();
    let mut done = |new: Vec<Record>| {
        new.iter().filter(|record| record.counts).for_each(|record| println!("{}", record.row()));
        records.extend(new);
    };
    println!("{}", head());
    if wanted(least_squares::NAME) {
        least_squares::run(&mut Peer::start(peers, "least_squares")?, &mut done)?;
    }
    if wanted(spiro::NAME) {
        spiro::run(&mut Peer::start(peers, "spiro")?, &mut done)?;
    }
    if wanted(opencascade::NAME) {
        opencascade::run(&mut Peer::start(peers, "opencascade")?, &mut done)?;
    }
    write(&records, output)?;
    summary(&records);
    if wanted(OWN) {
        own::run(output)?;
    }
    println!("\nAll {} records are in {}.", records.len(), output.display());
    Ok(())
}

/// The means, peer by peer.
fn summary(records: &[Record]) {
    println!("\nGeometric means of the ratios, peer to minvar: above one, minvar is faster.");
    for (name, what) in [
        (least_squares::NAME, "the fastest way, case by case"),
        (spiro::NAME, "g4"),
        (opencascade::NAME, "default and free sliding"),
    ] {
        let counted = || records.iter().filter(|record| record.peer == name && record.counts);
        if counted().next().is_none() {
            continue;
        }
        let fair = || counted().filter(|record| record.minvar_reached);
        let (done, many) = mean(fair().filter(|record| record.reached));
        let (all, of) = mean(fair());
        println!(
            "  {name} ({what}): {done:.3} over the {many} cases in which both were done; {all:.3} over all {of}, \
             where the peer's best effort is a lower bound"
        );
        for record in counted().filter(|record| !record.minvar_reached) {
            println!("    left out, minvar was not done: {} {}", record.case, record.functional);
        }
    }
}
