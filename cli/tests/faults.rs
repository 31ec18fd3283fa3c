//! Faults around the command: disks that are full, calls that are killed, pipes, devices, links, several outputs of
//! which one fails. A file is always the old one or the new one, as a whole; an error changes none.
//!
//! Some tests need a file system of their own, which `unshare` (util-linux) makes where the system lets it; where it
//! does not, they say so, and the others stand for them.
#![cfg(unix)]

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const MINVAR: &str = env!("CARGO_BIN_EXE_minvar");
const WOODFORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/woodford.mvc");
const SPACE_CURVE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/curves/space_curve.mvc");

/// All outputs, in the order in which the command makes them.
const OUTPUTS: [&str; 4] = ["a.svg", "a.ngc", "a.csv", "a.json"];
const ALL: [&str; 8] = ["--svg", "a.svg", "--nc", "a.ngc", "--csv", "a.csv", "--json", "a.json"];

fn minvar(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(MINVAR);
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.arg("curve").args(arguments);
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Exit code and messages.
fn run(command: &mut Command) -> (Option<i32>, String) {
    let Output { status, stderr, .. } = command.output().expect("the command starts");
    (status.code(), text(&stderr))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

const NOTHING: [PathBuf; 0] = [];

fn drafts(folder: &Path) -> Vec<PathBuf> {
    names(folder).iter().filter(|name| name.starts_with(".minvar-")).map(|name| folder.join(name)).collect()
}

/// What all outputs are, with these options.
fn outputs(options: &[&str]) -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, error) = run(minvar(folder.path(), &[WOODFORD]).args(ALL).args(options));
    assert_eq!((code, error.as_str()), (Some(0), ""));
    OUTPUTS.map(|name| fs::read(folder.path().join(name)).expect(name)).to_vec()
}

/// A shell in a folder, with the command and more as its arguments.
fn shell(folder: &Path, script: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.current_dir(folder).stdin(Stdio::null()).arg("-c").arg(script).arg(MINVAR).args(arguments);
    command
}

/// A folder with old outputs.
fn with_old_outputs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in OUTPUTS {
        fs::write(folder.path().join(name), format!("old {name}")).expect("a file");
    }
    folder
}

fn assert_old(folder: &Path, what: &str) {
    for name in OUTPUTS {
        assert_eq!(text(&fs::read(folder.join(name)).expect(name)), format!("old {name}"), "{what}");
    }
}

/// The output that a message says could not be written: one of them, with its size.
fn not_written(sizes: &[usize], why: &str, error: &str) -> &'static str {
    let told =
        |name: &str, size: &usize| error == format!("error: cannot write {name} ({size} bytes): {why}\n");
    let found = OUTPUTS.into_iter().zip(sizes).find(|(name, size)| told(name, size));
    found.unwrap_or_else(|| panic!("{sizes:?}: {error}")).0
}

#[test]
fn a_file_that_may_not_grow_is_named_with_its_size_and_nothing_changes() {
    // The table is larger than the picture, which is written first.
    let samples = ["--samples", "100"];
    let sizes: Vec<_> = outputs(&samples).iter().map(Vec::len).collect();
    assert!(sizes[2] > 2 * sizes[0], "{sizes:?}");
    let mut failed = BTreeSet::new();
    // In a shell's blocks, whatever their size is, up to more than the largest file.
    for blocks in (0..16).map(|k| (1 << k) - 1) {
        let folder = with_old_outputs();
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" curve \"$@\"");
        let (code, error) =
            run(shell(folder.path(), &script, &[WOODFORD]).args(ALL).args(samples).stdout(Stdio::null()));
        if code == Some(0) {
            break;
        }
        assert_eq!(code, Some(3), "{blocks} blocks: {error}");
        failed.insert(not_written(&sizes, "file too large", &error));
        assert_old(folder.path(), &error);
        assert_eq!(drafts(folder.path()), NOTHING, "{error}");
    }
    assert!(failed.len() >= 2, "not only the first fails: {failed:?}");
}

#[test]
fn a_call_that_dies_while_it_writes_changes_nothing_and_the_next_one_clears_away() {
    let new = outputs(&[]);
    let mut died = 0;
    for blocks in [0, 1, 3, 10, 20, 40] {
        let folder = with_old_outputs();
        fs::copy(WOODFORD, folder.path().join("w.mvc")).expect("the input");
        // The system kills what writes on beyond the limit.
        let script = format!("ulimit -c 0; ulimit -f {blocks}; exec \"$0\" curve \"$@\"");
        let mut command = shell(folder.path(), &script, &["w.mvc"]);
        let status = command.args(ALL).stdout(Stdio::null()).stderr(Stdio::null()).status().expect("a shell");
        if status.signal().is_none() {
            continue;
        }
        died += 1;
        assert_old(folder.path(), "killed within a write");
        assert!(!drafts(folder.path()).is_empty(), "it died with a draft in work");
        assert_eq!(fs::read(folder.path().join("w.mvc")).ok(), fs::read(WOODFORD).ok(), "the input");
        let (code, error) = run(minvar(folder.path(), &["w.mvc"]).args(ALL));
        assert_eq!((code, error.as_str()), (Some(0), ""));
        assert_eq!(drafts(folder.path()), NOTHING, "the next call clears away");
        for (name, new) in OUTPUTS.iter().zip(&new) {
            let found = fs::read(folder.path().join(name)).expect(name);
            // The title is the input's name.
            assert!(found == *new || (*name == "a.svg" && !found.is_empty()), "{name}");
        }
    }
    assert!(died >= 3, "only {died} calls died");
}

/// Numbers that look like chance, the same ones in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end.max(1)
    }
}

/// Waits until a call has begun to write, or is over. Whether it has begun.
fn writes(folder: &Path, child: &mut Child, old: &BTreeSet<PathBuf>) -> bool {
    loop {
        if drafts(folder).iter().any(|draft| !old.contains(draft)) {
            return true;
        }
        if child.try_wait().expect("a child").is_some() {
            return false;
        }
    }
}

#[test]
fn a_call_killed_at_any_moment_leaves_whole_files_and_no_more_than_its_own_litter() {
    const KILLS: usize = 240;
    let variants = [["--samples", "400"], ["--samples", "300"]];
    // The pictures and paths differ too: by the weight of a tension.
    let options: Vec<Vec<&str>> = variants
        .iter()
        .zip(["0.1", "0.2"])
        .map(|(samples, tension)| [samples.as_slice(), &["--tension", tension]].concat())
        .collect();
    let contents: Vec<_> = options.iter().map(|options| outputs(options)).collect();
    for (k, name) in OUTPUTS.iter().enumerate() {
        assert_ne!(contents[0][k], contents[1][k], "{name}: old and new can be told apart");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let call = |variant: usize| {
        let mut command = minvar(folder.path(), &[WOODFORD]);
        command.args(ALL).args(&options[variant]).arg("--quiet").stderr(Stdio::null());
        command
    };
    assert!(call(0).status().expect("a call").success());
    // How long a call writes.
    let mut shortest = Duration::MAX;
    for variant in [1, 0, 1, 0] {
        let mut child = call(variant).spawn().expect("a call");
        writes(folder.path(), &mut child, &BTreeSet::new());
        let begun = Instant::now();
        child.wait().expect("a child");
        shortest = shortest.min(begun.elapsed());
    }
    let span = u64::try_from(shortest.as_micros()).expect("a short time") * 4 / 3;
    let mut dice = Dice(1);
    let [mut unchanged, mut partly, mut all, mut littered] = [0; 4];
    let mut stand = 0;
    for round in 0..KILLS {
        let variant = 1 - stand;
        let old = drafts(folder.path()).into_iter().collect();
        let mut child = call(variant).spawn().expect("a call");
        let delay = Duration::from_micros(dice.below(span));
        // One in eight dies before it writes, at any moment from its start.
        if round % 8 != 0 {
            writes(folder.path(), &mut child, &old);
        }
        let begun = Instant::now();
        while begun.elapsed() < delay {
            std::hint::spin_loop();
        }
        child.kill().expect("a child");
        child.wait().expect("a child");
        let mut new = 0;
        for (k, name) in OUTPUTS.iter().enumerate() {
            let found = fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
            let is = |which: usize| found == contents[which][k];
            assert!(is(0) || is(1), "round {round}: {name} is torn, {} bytes", found.len());
            new += usize::from(is(variant));
        }
        let litter = drafts(folder.path());
        assert!(litter.len() <= 2 * OUTPUTS.len(), "round {round}: litter is piling up: {litter:?}");
        littered += usize::from(!litter.is_empty());
        match new {
            0 => unchanged += 1,
            4 => (all, stand) = (all + 1, variant),
            _ => {
                partly += 1;
                // From here on either of both again.
                assert!(call(stand).status().expect("a call").success());
                assert_eq!(drafts(folder.path()), NOTHING, "round {round}");
            }
        }
    }
    println!(
        "{KILLS} kills: {unchanged} changed nothing, {partly} some files, {all} all; {littered} left drafts"
    );
    assert!(littered >= 20, "only {littered} of {KILLS} kills met a call that was writing");
    assert!(unchanged >= 20 && all >= 1, "{unchanged} kills changed nothing, {all} all");
    assert!(call(stand).status().expect("a call").success());
    assert_eq!(names(folder.path()), sorted(&OUTPUTS), "the last call cleared away");
}

/// Runs a call under strace, which does something to it at certain calls of the system: to all, or to one of them.
fn injected(folder: &Path, injections: &[String]) -> Output {
    let mut command = Command::new("strace");
    command.current_dir(folder).stdin(Stdio::null()).args(["--follow-forks", "--output=/dev/null"]);
    for injection in injections {
        command.arg(format!("--inject={injection}"));
    }
    command.args([MINVAR, "curve", WOODFORD, "--quiet"]).args(ALL);
    command.output().expect("strace")
}

/// Whether strace is there and the system lets it trace.
fn can_inject() -> bool {
    let tried = Command::new("strace").args(["--output=/dev/null", "true"]).output();
    let can = tried.is_ok_and(|output| output.status.success());
    if !can {
        eprintln!("strace cannot be used here: not checked");
    }
    can
}

/// What the command asks of the system for its files; not all are there on every machine.
const CALLS: [&str; 10] = [
    "?open,openat",
    "write",
    "fsync",
    "flock",
    "fchmod",
    "fchown",
    "?rename,?renameat,renameat2",
    "?link,linkat",
    "?unlink,unlinkat",
    "?stat,?lstat,statx",
];

/// Every output as a whole the old or the new one; how many are new.
fn count_new(folder: &Path, new: &[Vec<u8>], what: &str) -> usize {
    let is_new = |(name, new): (&&str, &Vec<u8>)| {
        let found = fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{what}: {name}: {error}"));
        assert!(found == *new || found == format!("old {name}").as_bytes(), "{what}: {name} is torn");
        found == *new
    };
    OUTPUTS.iter().zip(new).filter(|pair| is_new((pair.0, pair.1))).count()
}

#[test]
fn a_call_killed_before_any_call_of_the_system_leaves_whole_files() {
    if !can_inject() {
        return;
    }
    let new = outputs(&[]);
    let mut found = [0; 5];
    for calls in CALLS {
        for at in 1.. {
            let folder = with_old_outputs();
            let what = format!("killed at {calls} number {at}");
            let output = injected(folder.path(), &[format!("{calls}:signal=KILL:when={at}")]);
            let count = count_new(folder.path(), &new, &what);
            if output.status.signal().is_none() {
                assert_eq!((output.status.code(), count), (Some(0), 4), "{what}: {output:?}");
                // All outputs are new, so that nobody is given away.
                assert!(at > 1 || calls == "fchown", "{calls} is not called");
                break;
            }
            found[count] += 1;
            assert!(drafts(folder.path()).len() <= 2 * OUTPUTS.len(), "{what}");
            // A small call clears away what this one left.
            let (code, error) = run(&mut minvar(folder.path(), &[WOODFORD, "--json", "a.json"]));
            assert_eq!((code, error.as_str()), (Some(0), ""), "{what}");
            assert_eq!(names(folder.path()), sorted(&OUTPUTS), "{what}");
        }
    }
    println!("killed with so many files replaced: {found:?}");
    assert!(found.iter().all(|&count| count > 0) && found[0] > 20, "{found:?}");
}

/// What a disk holds after a loss of power is what was asked for: the files before their names, and then the names.
#[test]
fn files_are_on_the_disk_before_they_get_their_names() {
    if !can_inject() {
        return;
    }
    let folder = with_old_outputs();
    let mut command = Command::new("strace");
    command.current_dir(folder.path()).stdin(Stdio::null()).args(["--follow-forks", "--output=trace"]);
    command.arg("--trace=fsync,?rename,?renameat,renameat2").args([MINVAR, "curve", WOODFORD, "--quiet"]);
    assert!(command.args(ALL).status().expect("strace").success());
    let trace = fs::read_to_string(folder.path().join("trace")).expect("a trace");
    let calls: Vec<_> = ["fsync(", "rename"]
        .iter()
        .flat_map(|call| trace.match_indices(call).map(|(at, _)| (at, call.trim_end_matches('('))))
        .collect::<std::collections::BTreeMap<_, _>>()
        .into_values()
        .collect();
    assert_eq!(calls[..9], [["fsync"; 4].as_slice(), &["rename"; 4], &["fsync"]].concat(), "{trace}");
}

#[test]
fn an_error_of_any_call_of_the_system_leaves_all_files_old_or_makes_all_new() {
    if !can_inject() {
        return;
    }
    let new = outputs(&[]);
    let mut found = [0; 2];
    for calls in &CALLS[1..9] {
        for at in 1.. {
            let folder = with_old_outputs();
            let what = format!("{calls} number {at} fails");
            let output = injected(folder.path(), &[format!("{calls}:error=EIO:when={at}")]);
            let (error, count) = (text(&output.stderr), count_new(folder.path(), &new, &what));
            match output.status.code() {
                Some(0) => assert_eq!((count, error.as_str()), (4, ""), "{what}"),
                Some(3) => {
                    assert_eq!(count, 0, "{what}: {error}");
                    let named = OUTPUTS.iter().zip(&new).any(|(name, new)| {
                        error.starts_with(&format!("error: cannot write {name} ({} bytes): ", new.len()))
                    });
                    assert!(named && error.ends_with("input/output error\n"), "{what}: {error}");
                }
                code => panic!("{what}: {code:?} {error}"),
            }
            // What could not be removed stays, until the next call.
            assert!(drafts(folder.path()).is_empty() || calls.contains("unlink"), "{what}");
            found[usize::from(count > 0)] += 1;
            // Beyond the last one nothing is different any more.
            if at > 12 {
                break;
            }
        }
    }
    assert!(found[0] > 10, "{found:?}");

    // Without second names for old files, as on a memory card, those before the one that fails cannot be put back: the
    // message says so.
    let folder = with_old_outputs();
    let no_links = "?link,linkat:error=EPERM".to_owned();
    let output = injected(folder.path(), &[no_links, "?rename,?renameat,renameat2:error=EIO:when=3".into()]);
    let error = text(&output.stderr);
    let words = format!(
        "error: cannot write a.csv ({} bytes): input/output error; a.ngc has been replaced already; a.svg has been \
         replaced already\n",
        new[2].len()
    );
    assert_eq!((output.status.code(), error), (Some(3), words));
    assert_eq!(count_new(folder.path(), &new, "no second names"), 2);
    assert_eq!(names(folder.path()), sorted(&OUTPUTS));
}

/// Between its making and its locking a draft looks like one that was left behind.
#[test]
fn a_draft_that_another_call_clears_away_too_early_is_begun_again() {
    if !can_inject() {
        return;
    }
    let new = outputs(&[]);
    let folder = with_old_outputs();
    let mut command = Command::new("strace");
    command.current_dir(folder.path()).stdin(Stdio::null()).args(["--follow-forks", "--output=/dev/null"]);
    command
        .args(["--inject=flock:delay_enter=2000000:when=1", MINVAR, "curve", WOODFORD, "--quiet"])
        .args(ALL);
    let mut child = command.spawn().expect("strace");
    wait_for_drafts(folder.path(), 1, &mut child);
    let first = drafts(folder.path());
    let (code, error) = run(&mut minvar(folder.path(), &[WOODFORD, "--json", "b.json"]));
    assert_eq!((code, error.as_str()), (Some(0), ""));
    assert!(!first[0].exists(), "the other call cleared it away");
    assert_eq!(child.wait().expect("strace").code(), Some(0));
    assert_eq!(count_new(folder.path(), &new, "begun again"), 4);
    assert!(drafts(folder.path()).is_empty());
}

fn sorted(names: &[&str]) -> Vec<String> {
    let mut names: Vec<_> = names.iter().map(|name| (*name).to_owned()).collect();
    names.sort();
    names
}

#[test]
fn calls_that_write_the_same_files_at_once_get_in_nobodys_way() {
    let variants = [["--tension", "0.1"], ["--tension", "0.2"], ["--tension", "0.3"]];
    let contents: Vec<_> = variants.iter().map(|options| outputs(options)).collect();
    let folder = tempfile::tempdir().expect("a folder");
    for _ in 0..15 {
        let children: Vec<_> = (0..9)
            .map(|k| {
                minvar(folder.path(), &[WOODFORD]).args(ALL).args(variants[k % 3]).spawn().expect("a call")
            })
            .collect();
        for child in children {
            let output = child.wait_with_output().expect("a child");
            assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
        }
        for (k, name) in OUTPUTS.iter().enumerate() {
            let found = fs::read(folder.path().join(name)).expect(name);
            assert!(contents.iter().any(|content| content[k] == found), "{name} is none of theirs");
        }
        assert_eq!(names(folder.path()), sorted(&OUTPUTS), "drafts are left");
    }
}

fn fifo(folder: &Path, name: &str) {
    let made = Command::new("mkfifo").arg(folder.join(name)).status().expect("mkfifo (coreutils)");
    assert!(made.success());
}

/// Waits until so many drafts are there.
fn wait_for_drafts(folder: &Path, count: usize, child: &mut Child) {
    let begun = Instant::now();
    while drafts(folder).len() < count {
        assert!(child.try_wait().expect("a child").is_none(), "it did not wait for the pipe");
        assert!(begun.elapsed() < Duration::from_secs(60), "no drafts");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Everything stands still where a pipe has no reader: all drafts are written, nothing is replaced.
#[test]
fn no_file_changes_before_pipes_have_got_theirs() {
    let folder = with_old_outputs();
    let folder = folder.path();
    fs::remove_file(folder.join("a.csv")).expect("the table");
    fifo(folder, "a.csv");
    let mut child = minvar(folder, &[WOODFORD]).args(ALL).spawn().expect("a call");
    wait_for_drafts(folder, 3, &mut child);
    std::thread::sleep(Duration::from_millis(100));
    for name in ["a.svg", "a.ngc", "a.json"] {
        assert_eq!(text(&fs::read(folder.join(name)).expect(name)), format!("old {name}"));
    }
    // A second call leaves the drafts of the first alone, which lives; a third finds the first one killed.
    let (code, error) = run(&mut minvar(folder, &[WOODFORD, "--json", "b.json"]));
    assert_eq!((code, error.as_str(), drafts(folder).len()), (Some(0), "", 3));
    child.kill().expect("a child");
    child.wait().expect("a child");
    assert_eq!(drafts(folder).len(), 3);
    let (code, error) = run(&mut minvar(folder, &[WOODFORD, "--json", "b.json"]));
    assert_eq!((code, error.as_str(), drafts(folder).len()), (Some(0), "", 0));
    for name in ["a.svg", "a.ngc", "a.json"] {
        assert_eq!(text(&fs::read(folder.join(name)).expect(name)), format!("old {name}"));
    }

    // With a reader all goes on.
    let child = minvar(folder, &[WOODFORD]).args(ALL).spawn().expect("a call");
    let mut table = String::new();
    File::open(folder.join("a.csv")).and_then(|mut pipe| pipe.read_to_string(&mut table)).expect("the table");
    assert_eq!(child.wait_with_output().expect("a child").status.code(), Some(0));
    let new = outputs(&[]);
    assert_eq!(table.as_bytes(), new[2]);
    for (k, name) in OUTPUTS.iter().enumerate().filter(|(k, _)| *k != 2) {
        assert_eq!(fs::read(folder.join(name)).expect(name), new[k], "{name}");
    }
    // Nor does a reader that goes away keep files from changing.
    fs::write(folder.join("a.json"), "old").expect("a file");
    let child = minvar(folder, &[WOODFORD]).args(ALL).args(["--samples", "5000"]).spawn().expect("a call");
    let mut first = [0; 7];
    File::open(folder.join("a.csv"))
        .and_then(|mut pipe| pipe.read_exact(&mut first))
        .expect("the first bytes");
    let output = child.wait_with_output().expect("a child");
    assert_eq!((output.status.code(), text(&output.stderr), &first), (Some(0), String::new(), b"element"));
    assert_eq!(fs::read(folder.join("a.json")).expect("JSON"), new[3]);
}

/// Sends a signal by the shell.
fn send(signal: &str, to: u32) {
    let sent = Command::new("sh").arg("-c").arg(format!("kill -{signal} {to}")).status().expect("a shell");
    assert!(sent.success());
}

/// Runs the command as a shell in the foreground does: what a shell runs in the background ignores INT and QUIT, what
/// nohup runs HUP, and hands that on.
const HEEDING: &str = "env --default-signal true 2>/dev/null && exec env --default-signal \"$0\" curve \"$@\"; \
                       exec \"$0\" curve \"$@\"";

/// A computation that takes much longer than anybody waits.
const LONG: [&str; 7] =
    [SPACE_CURVE, "--elements-per-span", "1024", "--functional", "space-mvc", "--minima", "100"];

#[test]
fn a_signal_ends_a_long_solve_at_once_and_nothing_is_written() {
    for (signal, number) in [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3)] {
        let folder = with_old_outputs();
        let mut command = shell(folder.path(), &format!("ulimit -c 0; {HEEDING}"), &LONG);
        let mut child = command.args(ALL).arg("--chords").stdout(Stdio::null()).spawn().expect("a call");
        std::thread::sleep(Duration::from_millis(300));
        assert!(child.try_wait().expect("a child").is_none(), "the solve is not long enough for this test");
        send(signal, child.id());
        let begun = Instant::now();
        let status = child.wait().expect("a child");
        assert!(begun.elapsed() < Duration::from_secs(5), "{signal}: it went on");
        assert_eq!((status.signal(), status.code()), (Some(number), None), "{signal}");
        assert_old(folder.path(), signal);
        assert_eq!(names(folder.path()), sorted(&OUTPUTS), "{signal}");
    }
}

#[test]
fn a_shell_shows_a_call_ended_by_ctrl_c_as_130() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = format!("sh -c 'echo $$; {HEEDING}' \"$0\" \"$@\" --svg a.svg; echo \"shows $?\"");
    let mut child = shell(folder.path(), &script, &LONG)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("a shell");
    let mut stdout = child.stdout.take().expect("a pipe");
    let mut line = Vec::new();
    let mut byte = [0];
    while stdout.read(&mut byte).expect("the first line") == 1 && byte[0] != b'\n' {
        line.push(byte[0]);
    }
    let id = text(&line).parse().expect("a process's number");
    std::thread::sleep(Duration::from_millis(200));
    send("INT", id);
    let mut rest = String::new();
    stdout.read_to_string(&mut rest).expect("the rest");
    child.wait().expect("a shell");
    assert_eq!((rest.as_str(), names(folder.path()).len()), ("shows 130\n", 0));
}

/// One who presses Ctrl-C while a call waits for its pipe.
#[test]
fn a_signal_while_writing_changes_no_file() {
    let folder = with_old_outputs();
    fs::remove_file(folder.path().join("a.json")).expect("JSON");
    fifo(folder.path(), "a.json");
    let mut child = shell(folder.path(), HEEDING, &[WOODFORD]).args(ALL).spawn().expect("a call");
    wait_for_drafts(folder.path(), 3, &mut child);
    send("INT", child.id());
    assert_eq!(child.wait().expect("a child").signal(), Some(2));
    for name in ["a.svg", "a.ngc", "a.csv"] {
        assert_eq!(text(&fs::read(folder.path().join(name)).expect(name)), format!("old {name}"));
    }
    assert_eq!(run(&mut minvar(folder.path(), &[WOODFORD, "--svg", "b.svg"])).0, Some(0));
    assert!(drafts(folder.path()).is_empty());
}

#[test]
fn a_device_that_is_full_is_an_error_and_no_file_changes() {
    if !Path::new("/dev/full").exists() {
        eprintln!("there is no /dev/full: not checked");
        return;
    }
    let size = outputs(&[])[3].len();
    let full = || Stdio::from(File::options().write(true).open("/dev/full").expect("/dev/full"));
    for (arguments, out, words) in [
        (&["--json", "/dev/full"][..], Stdio::null(), format!("cannot write /dev/full ({size} bytes)")),
        (&["--json", "-"], full(), format!("cannot write {size} bytes to the standard output")),
        (&["--json", "/dev/stdout"], full(), format!("cannot write {size} bytes to the standard output")),
        // The figures.
        (&[], full(), "to the standard output".into()),
    ] {
        let folder = with_old_outputs();
        let mut command = minvar(folder.path(), &[WOODFORD]);
        let (code, error) = run(command.args(&ALL[..6]).args(arguments).stdout(out));
        assert_eq!(code, Some(3), "{arguments:?}: {error}");
        assert!(error.contains(&words) && error.ends_with(": no space left on device\n"), "{error}");
        assert_old(folder.path(), &error);
        assert_eq!(names(folder.path()), sorted(&OUTPUTS), "{error}");
    }
}

#[test]
fn the_names_of_open_descriptors_are_written_to_and_not_replaced() {
    let new = outputs(&[]);
    let json = text(&new[3]);
    let folder = tempfile::tempdir().expect("a folder");
    let call = |script: &str| {
        let (code, error) = run(shell(folder.path(), script, &["curve", WOODFORD]).stdout(Stdio::null()));
        assert_eq!(code, Some(0), "{script}: {error}");
        error
    };
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "-"] {
        if name.starts_with("/proc") && !Path::new(name).exists() {
            continue;
        }
        fs::write(folder.path().join("log"), "before\n").expect("a file");
        let figures = call(&format!("\"$0\" \"$@\" --json {name} >> log"));
        assert_eq!(read("log"), format!("before\n{json}"), "{name}: what was there stays");
        assert!(figures.starts_with("curve       test"), "{name}: figures go elsewhere: {figures}");
    }
    call("\"$0\" \"$@\" --json /dev/fd/3 3> three");
    assert_eq!(read("three"), json);
    call("echo before > four; \"$0\" \"$@\" --json /dev/fd/3 3>> four");
    assert_eq!(read("four"), format!("before\n{json}"));
    call("\"$0\" \"$@\" --json /dev/fd/3 3>&1 | cat > five");
    assert!(read("five").contains(&json), "figures and JSON in one pipe");
    call("\"$0\" \"$@\" --quiet --json /dev/stderr 2> six");
    assert_eq!(read("six"), json);
    assert!(drafts(folder.path()).is_empty());
}

#[test]
fn an_input_is_never_written_over_by_whatever_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let input = fs::read(WOODFORD).expect("the input");
    fs::write(folder.path().join("w.mvc"), &input).expect("a file");
    std::os::unix::fs::symlink("w.mvc", folder.path().join("link")).expect("a link");
    fs::hard_link(folder.path().join("w.mvc"), folder.path().join("twin")).expect("a second name");
    for (script, words) in [
        ("\"$0\" curve w.mvc --json w.mvc", "FILE and --json"),
        ("\"$0\" curve w.mvc --json ./link", "FILE and --json"),
        ("\"$0\" curve link --json w.mvc", "FILE and --json"),
        ("\"$0\" curve w.mvc --json twin", "FILE and --json"),
        ("\"$0\" curve - --json w.mvc < w.mvc", "FILE and --json"),
        ("\"$0\" curve /dev/stdin --json link < w.mvc", "FILE and --json"),
        ("\"$0\" curve w.mvc --json - >> w.mvc", "FILE and the standard output"),
        ("\"$0\" curve w.mvc >> twin", "FILE and the standard output"),
        ("\"$0\" curve w.mvc --json /dev/fd/3 3>> w.mvc", "FILE and --json"),
        ("\"$0\" curve w.mvc --svg out > out", "--svg and the standard output"),
        ("\"$0\" curve w.mvc --json - --svg out > out", "--svg and the standard output"),
    ] {
        let (code, error) = run(shell(folder.path(), script, &[]).stdout(Stdio::null()));
        assert_eq!(
            (code, error.as_str()),
            (Some(2), format!("error: {words} are the same file\n").as_str()),
            "{script}"
        );
        assert_eq!(fs::read(folder.path().join("w.mvc")).expect("the input"), input, "{script}");
    }
    // Nothing runs into what a quiet call does not print.
    let script = "\"$0\" curve w.mvc --quiet --svg out > out";
    assert_eq!(run(&mut shell(folder.path(), script, &[])).0, Some(0));
}

/// Runs a script on a file system of its own, of which nobody else knows and which goes with it: as the superuser, or
/// as one in a space of names of one's own. `None` where the system lets neither.
fn on_a_disk_of_its_own(options: &str, script: &str) -> Option<Output> {
    let folder = tempfile::tempdir().expect("a folder");
    let mount = format!("mount -t tmpfs -o {options} none . && cd \"$PWD\" && {{ {script}\n}}");
    let run = |flags: &[&str], script: &str| {
        let mut command = Command::new("unshare");
        command.args(flags).args(["sh", "-c", script, MINVAR, WOODFORD]).current_dir(folder.path());
        command.stdin(Stdio::null()).output()
    };
    let can = |flags: &[&str]| {
        run(flags, "mount -t tmpfs -o size=64k none .").is_ok_and(|output| output.status.success())
    };
    let ways = [&["--mount"][..], &["--user", "--map-root-user", "--mount"]];
    let Some(flags) = ways.into_iter().find(|flags| can(flags)) else {
        eprintln!("no file system of its own can be made here: not checked");
        return None;
    };
    run(flags, &mount).ok()
}

/// Old outputs, a call with all outputs, then what is there: its code, its messages, the names, and each file with its
/// size.
const ON_FULL_DISK: &str = "for f in a.svg a.ngc a.csv a.json; do printf 'old %s' $f > $f; done
    FILL
    \"$0\" curve \"$1\" --svg a.svg --nc a.ngc --csv a.csv --json a.json > /dev/null; echo \"code $?\"
    ls -A | tr '\\n' ' '; echo; for f in a.svg a.ngc a.csv a.json; do head -c 9 $f | tr '\\n' ' '; echo; done";

#[test]
fn on_a_full_disk_nothing_changes_and_the_message_says_what_did_not_fit() {
    let sizes: Vec<_> = outputs(&[]).iter().map(Vec::len).collect();
    let mut failed = BTreeSet::new();
    let mut written = false;
    for kilobytes in (20..260).step_by(8) {
        let script = ON_FULL_DISK.replace("FILL", "");
        let Some(output) = on_a_disk_of_its_own(&format!("size={kilobytes}k"), &script) else { return };
        let (out, error) = (text(&output.stdout), text(&output.stderr));
        let lines: Vec<_> = out.lines().collect();
        assert_eq!(lines[1], "a.csv a.json a.ngc a.svg ", "{kilobytes} kB: {out} {error}");
        if lines[0] == "code 0" {
            written = true;
            assert!(lines[2..].iter().all(|line| !line.starts_with("old")), "{out}");
            continue;
        }
        assert_eq!(lines[0], "code 3", "{kilobytes} kB: {out} {error}");
        let old: Vec<_> =
            OUTPUTS.iter().map(|name| format!("old {name}").chars().take(9).collect::<String>()).collect();
        assert_eq!(lines[2..], old, "{kilobytes} kB: {error}");
        failed.insert(not_written(&sizes, "no space left on device", &error));
    }
    assert!(written && failed.len() >= 2, "files that did not fit: {failed:?}");

    // No room for one more name.
    let script = ON_FULL_DISK
        .replace("FILL", "i=0; while touch filler$i 2> /dev/null; do i=$((i+1)); done; rm filler0");
    let Some(output) = on_a_disk_of_its_own("size=1m,nr_inodes=9", &script) else { return };
    let (out, error) = (text(&output.stdout), text(&output.stderr));
    assert!(out.starts_with("code 3\n") && out.contains("\nold a.svg\n"), "{out} {error}");
    let words = format!(
        "error: cannot write a.ngc ({} bytes): the folder . takes no new file: no space left on device\n",
        sizes[1]
    );
    assert_eq!(error, words);
}

#[test]
fn where_nothing_may_be_written_or_replaced_nothing_changes() {
    // A file system that can only be read.
    let read_only = ON_FULL_DISK.replace("FILL", "mount -o remount,ro . ");
    let Some(output) = on_a_disk_of_its_own("size=1m", &read_only) else { return };
    let (out, error) = (text(&output.stdout), text(&output.stderr));
    assert!(
        out.starts_with("code 3\n") && out.contains("\nold a.svg\nold a.ngc\nold a.csv\nold a.jso\n"),
        "{out}"
    );
    assert_eq!(error, "error: cannot write a.svg: read-only file system\n");

    // A file that is mounted by itself, as into a container, cannot be replaced: those before it are put back.
    for (last, others) in [("a.json", "a.svg a.ngc a.csv"), ("a.ngc", "a.svg a.csv a.json")] {
        let mounted = format!("rm a.svg; printf 'old {last}' > original; mount --bind original {last}");
        let script = ON_FULL_DISK.replace("FILL", &mounted);
        let Some(output) = on_a_disk_of_its_own("size=1m", &script) else { return };
        let (out, error) = (text(&output.stdout), text(&output.stderr));
        assert!(out.starts_with("code 3\n"), "{out} {error}");
        assert!(error.contains(&format!("error: cannot write {last} (")), "{error}");
        assert!(error.contains(" bytes): device or resource busy\n"), "{error}");
        // The picture was not there before.
        assert!(out.contains("\na.csv a.json a.ngc original \n"), "{others}: {out}");
        for name in others.split(' ').filter(|name| *name != "a.svg") {
            assert!(out.contains(&format!("\nold {}\n", &name[..name.len().min(5)])), "{name}: {out}");
        }
    }
}

#[test]
fn a_folder_that_takes_no_files_is_an_error() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("a folder");
    fs::write(inner.join("a.svg"), "old").expect("a file");
    fs::set_permissions(&inner, fs::Permissions::from_mode(0o555)).expect("chmod");
    if File::create(inner.join("try")).is_ok() {
        eprintln!(
            "nothing is forbidden to the superuser: not checked here, but on a file system that can only be read"
        );
        return;
    }
    let size = outputs(&[])[0].len();
    for name in ["inner/a.svg", "inner/b.svg"] {
        let (code, error) = run(&mut minvar(folder.path(), &[WOODFORD, "--csv", "a.csv", "--svg", name]));
        let words = format!(
            "error: cannot write {name} ({size} bytes): the folder inner takes no new file: permission denied\n"
        );
        assert_eq!((code, error), (Some(3), words));
        assert_eq!(names(folder.path()), ["inner"]);
    }
    fs::set_permissions(&inner, fs::Permissions::from_mode(0o755)).expect("chmod");
    assert_eq!(names(&inner), ["a.svg"]);
}
