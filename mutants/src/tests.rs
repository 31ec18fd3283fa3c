//! The test programs of the woven copy: what is in them, how long each test takes, which places it reaches.

use crate::problem::Problem;
use crate::tree::{PACKAGES, Tree};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::Duration;
use wait_timeout::ChildExt;

/// Programs that build the C library, which has a panic handler of its own; one about files that cannot be written; one
/// that counts what the woven kernel allocates where it makes tables when they are first used. `cross` is left out for
/// its hashes too: they would notice every changed bit, whether it is for worse or not.
const LEFT_OUT: [&str; 7] = [
    "cli/tests/faults.rs",
    "tests/tests/c_api.rs",
    "tests/tests/c_examples.rs",
    "tests/tests/cross.rs",
    "tests/tests/no_allocation.rs",
    "tests/tests/no_heap.rs",
    "tests/tests/readme.rs",
];
/// Address space of a test (kB): a mutant may ask for any amount.
const MEMORY: u64 = 8_000_000;

/// A test program.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Program {
    pub name: String,
    pub path: PathBuf,
    /// Where cargo runs it.
    pub folder: PathBuf,
    /// Tells its sources from others.
    pub key: u64,
}

/// One test of a program.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Test {
    pub program: usize,
    pub name: String,
    /// Processor time without a mutant, once it is known.
    pub seconds: Option<f64>,
    /// Under which numbers the places that it reaches are recorded.
    pub reaches: Vec<u32>,
}

/// All tests.
#[derive(Default, Deserialize, Serialize)]
pub struct Tests {
    kernel: String,
    keys: Vec<u64>,
    pub programs: Vec<Program>,
    pub tests: Vec<Test>,
}

impl Test {
    pub fn cost(&self) -> f64 {
        self.seconds.unwrap_or(0.0)
    }
}

/// How some tests of a program ended.
pub enum Ended {
    Passed,
    /// The test that failed, as far as the program said.
    Failed(String),
    /// It took much longer than it should.
    TimedOut(String),
}

#[derive(Deserialize)]
struct Artifact {
    executable: Option<PathBuf>,
    manifest_path: PathBuf,
    profile: Profile,
    target: Target,
}

#[derive(Deserialize)]
struct Profile {
    test: bool,
}

#[derive(Deserialize)]
struct Target {
    kind: Vec<String>,
    src_path: PathBuf,
}

impl Tests {
    /// A test's program and its name.
    pub fn full_name(&self, test: &Test) -> String {
        format!("{} {}", self.programs[test.program].name, test.name)
    }

    /// Builds the programs twice: recording what each test reaches, then as they are run with mutants.
    pub fn prepare(tree: &Tree, work: &Path) -> Result<Self, Problem> {
        let memory = work.join("tests.json");
        let known: Self =
            fs::read(&memory).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default();
        let sources = tree.sources();
        if known.kernel == tree.kernel
            && known.keys == sources
            && known.programs.iter().all(|p| p.path.is_file())
        {
            return Ok(known);
        }
        let old: BTreeMap<(u64, String), Test> = if known.kernel == tree.kernel {
            let keys: Vec<u64> = known.programs.iter().map(|program| program.key).collect();
            known.tests.into_iter().map(|test| ((keys[test.program], test.name.clone()), test)).collect()
        } else {
            BTreeMap::new()
        };

        eprintln!("building the tests with records of what they reach");
        let programs = build(tree, true)?;
        // What is known is kept as soon as it is: it takes a while.
        let keep = |found: &Self| {
            fs::write(&memory, serde_json::to_vec(found).expect("plain data")).map_err(Problem::with(&memory))
        };
        let mut found = Self { kernel: tree.kernel.clone(), keys: Vec::new(), programs, tests: Vec::new() };
        for index in 0..found.programs.len() {
            let program = &found.programs[index];
            let mut tests = Vec::new();
            for name in names(program)? {
                let known = old.get(&(program.key, name.clone()));
                let test = match known {
                    Some(test) => Test { program: index, ..test.clone() },
                    None => {
                        let reaches = reached(program, &name, work)?;
                        Test { program: index, name, seconds: None, reaches }
                    }
                };
                tests.push(test);
            }
            eprintln!("  {}: {} tests", program.name, tests.len());
            found.tests.extend(tests);
            keep(&found)?;
        }
        eprintln!("building the tests");
        found.programs = build(tree, false)?;
        let programs = &found.programs;
        for test in found.tests.iter_mut().filter(|test| test.seconds.is_none()) {
            let program = &programs[test.program];
            let before = children_seconds();
            let ended = run(program, &[&test.name], 0, 3600, &work.join("test"))?;
            test.seconds = Some(children_seconds() - before);
            if !matches!(ended, Ended::Passed) {
                return Err(Problem(format!(
                    "without a mutant, {} {} does not pass",
                    program.name, test.name
                )));
            }
        }
        found.keys = sources;
        keep(&found)?;
        Ok(found)
    }
}

/// Builds all test programs, with records of what runs or without.
fn build(tree: &Tree, covers: bool) -> Result<Vec<Program>, Problem> {
    let mut command = tree.cargo(covers);
    command.args(["test", "--locked", "--no-run", "--message-format=json"]).stderr(Stdio::inherit());
    for package in PACKAGES {
        command.args(["--package", package]);
    }
    let said = command.output().map_err(|error| Problem(format!("cargo test: {error}")))?;
    if !said.status.success() {
        return Err(Problem("the woven tests do not build".into()));
    }
    let folder = tree.folder.canonicalize().map_err(Problem::with(&tree.folder))?;
    let mut programs = Vec::new();
    for line in String::from_utf8_lossy(&said.stdout).lines() {
        let Ok(Artifact { executable: Some(path), manifest_path, profile, target }) =
            serde_json::from_str(line)
        else {
            continue;
        };
        let is_test = target.kind.iter().any(|kind| kind == "test");
        let package = manifest_path.parent().unwrap_or(&manifest_path);
        let relative =
            |path: &Path| path.strip_prefix(&folder).unwrap_or(path).to_string_lossy().into_owned();
        if !profile.test || LEFT_OUT.contains(&relative(&target.src_path).as_str()) {
            continue;
        }
        let name = if is_test {
            relative(&target.src_path)
        } else {
            format!("{} (unit)", relative(&target.src_path))
        };
        // A test program is made of its own file, its folder, and what the package's programs share.
        let own = relative(&target.src_path.with_extension(""));
        let of_package = format!("{}/", relative(package));
        let tests = format!("{of_package}tests/");
        let mut hasher = DefaultHasher::new();
        for (file, hash) in &tree.files {
            let is_own = file.strip_prefix(&own).is_some_and(|rest| rest.starts_with(['.', '/']));
            let is_shared = file.starts_with(&of_package) && (!is_test || !file.starts_with(&tests));
            if is_own || is_shared {
                (file, hash).hash(&mut hasher);
            }
        }
        programs.push(Program { name, path, folder: package.to_owned(), key: hasher.finish() });
    }
    programs.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(programs)
}

fn names(program: &Program) -> Result<Vec<String>, Problem> {
    let mut command = Command::new(&program.path);
    let listed = crate::problem::output(command.arg("--list").current_dir(&program.folder))?;
    Ok(listed.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect())
}

/// The numbers of the places that a test, and every program that it starts, reaches.
fn reached(program: &Program, test: &str, work: &Path) -> Result<Vec<u32>, Problem> {
    let folder = work.join("reached");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(Problem::with(&folder))?;
    let folder = folder.canonicalize().map_err(Problem::with(&folder))?;
    let mut command = Command::new(&program.path);
    command.args(["--exact", test, "--test-threads=1"]).current_dir(&program.folder);
    command.env("MINVAR_MUTANT_COVER", &folder).env("CARGO_MANIFEST_DIR", &program.folder);
    crate::problem::output(&mut command)?;
    let mut reached = Vec::<bool>::new();
    for file in fs::read_dir(&folder).map_err(Problem::with(&folder))?.flatten() {
        let bytes = fs::read(file.path()).map_err(Problem::with(&file.path()))?;
        reached.resize(bytes.len().max(reached.len()), false);
        for (reached, byte) in reached.iter_mut().zip(bytes) {
            *reached |= byte != 0;
        }
    }
    Ok((0..).zip(&reached).filter(|(_, reached)| **reached).map(|(number, _)| number).collect())
}

/// Runs some tests of a program one after the other, with a mutant, for so many seconds of the processor at most. What
/// the program says goes to files of this name.
pub fn run(
    program: &Program,
    tests: &[&str],
    mutant: u32,
    seconds: u64,
    said: &Path,
) -> Result<Ended, Problem> {
    let file = |extension: &str| {
        let path = said.with_extension(extension);
        File::create(&path).map_err(Problem::with(&path))
    };
    let limits = format!("ulimit -c 0; ulimit -t {seconds}; ulimit -v {MEMORY}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &limits]).arg(&program.path).args(["--test-threads=1", "--exact"]).args(tests);
    command.current_dir(&program.folder).env("CARGO_MANIFEST_DIR", &program.folder);
    command.env("MINVAR_MUTANT", mutant.to_string()).env("RUST_BACKTRACE", "0");
    command.stdin(Stdio::null()).stdout(file("out")?).stderr(file("err")?);
    let failed = |error| Problem(format!("{}: {error}", program.path.display()));
    let mut child = command.spawn().map_err(failed)?;
    // Who waits for something that never comes uses no time of the processor.
    let status: Option<ExitStatus> =
        child.wait_timeout(Duration::from_secs(60 + 30 * seconds)).map_err(failed)?;
    if status.is_some_and(|status| status.success()) {
        return Ok(Ended::Passed);
    }
    let out = fs::read_to_string(said.with_extension("out")).unwrap_or_default();
    let last = out.lines().rfind(|line| line.starts_with("test ") && !line.ends_with("... ok"));
    let name = last.and_then(|line| line.split(' ').nth(1)).unwrap_or("?").to_owned();
    match status {
        None => {
            child.kill().and_then(|()| child.wait()).map_err(failed)?;
            Ok(Ended::TimedOut(name))
        }
        Some(status) if over_time(status) => Ok(Ended::TimedOut(name)),
        Some(_) => Ok(Ended::Failed(name)),
    }
}

/// Whether a program was ended by the limit of its processor time.
fn over_time(status: ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt;
    const SIGXCPU: i32 = 24;
    const SIGKILL: i32 = 9;
    matches!(status.signal(), Some(SIGXCPU | SIGKILL))
}

/// The processor time of all programs that have ended.
fn children_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which may hold anything: state is the first, the children's two times are 14 and 15.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |field: usize| fields.get(field).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(13) + ticks(14)) / 100.0
}
