//! A copy of the repository with all mutants woven into its kernel, and what of it the compiler takes.

use crate::constant::Constants;
use crate::edit::Owner;
use crate::list::Mutant;
use crate::problem::{Problem, output};
use crate::weave::{Source, weave};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use syn::spanned::Spanned;

/// The kernel's folder.
pub const KERNEL: &str = "kernel/";
/// The packages whose tests are run. The C library is not among them: it has a panic handler of its own.
pub const PACKAGES: [&str; 3] = ["minvar", "minvar-tests", "minvar-cli"];

/// What became of the mutants.
pub struct Tree {
    pub folder: PathBuf,
    work: PathBuf,
    /// Those that can be run, and the number under which each is recorded.
    pub woven: BTreeMap<u32, u32>,
    /// Those that the compiler refuses.
    pub refused: BTreeSet<u32>,
    /// Those in code that this machine does not compile.
    pub elsewhere: BTreeSet<u32>,
    /// Tells this kernel from others, whatever its tests.
    pub kernel: String,
    /// The files outside the kernel's mutable part, with what tells them from others.
    pub files: BTreeMap<String, u64>,
}

/// What the compiler said before, so that it need not be asked again.
#[derive(Default, Deserialize, Serialize)]
struct Known {
    kernel: String,
    refused: BTreeSet<u32>,
    dropped: BTreeSet<u32>,
}

struct File {
    path: String,
    text: String,
    syntax: syn::File,
}

impl Tree {
    /// Copies and weaves, until everything compiles.
    pub fn grow(repository: &Path, work: &Path, mutants: &[Mutant]) -> Result<Self, Problem> {
        let mut tree = Self {
            folder: work.join("tree"),
            work: work.to_owned(),
            woven: BTreeMap::new(),
            refused: BTreeSet::new(),
            elsewhere: BTreeSet::new(),
            kernel: String::new(),
            files: BTreeMap::new(),
        };
        let mut kernel_hash = DefaultHasher::new();
        let (mut kernel, mut others) = (Vec::new(), Vec::new());
        for path in tracked(repository)? {
            let bytes = fs::read(repository.join(&path)).map_err(Problem::with(Path::new(&path)))?;
            tree.files.insert(path.clone(), hash(&bytes));
            if !path.ends_with(".rs") {
                write(&tree.folder.join(&path), &bytes)?;
                continue;
            }
            let text = String::from_utf8(bytes).map_err(|_| Problem(format!("{path} is not text")))?;
            let syntax = syn::parse_file(&text).map_err(|error| Problem(format!("{path}: {error}")))?;
            if path.starts_with(KERNEL) {
                // A file of tests is no part of the kernel that is changed.
                if !path.ends_with("/tests.rs") {
                    without_tests(&text, &syntax).hash(&mut kernel_hash);
                }
                kernel.push(File { path, text, syntax });
            } else {
                write(&tree.folder.join(&path), without_shrinking(&text).as_bytes())?;
                others.push(syntax);
            }
        }
        tree.kernel = format!("{:016x}", kernel_hash.finish());
        let module = include_str!("woven.rs")
            .replace("COUNT: usize = 0", &format!("COUNT: usize = {}", mutants.len()));
        write(&tree.folder.join(KERNEL).join("src/mutant.rs"), module.as_bytes())?;

        let machine: BTreeSet<String> =
            output(Command::new("rustc").args(["--print", "cfg"]))?.lines().map(str::to_owned).collect();
        let places = |file: &File| {
            let lines: Vec<&str> = file.text.split_inclusive('\n').collect();
            let start = |line: usize| lines[..line].iter().map(|line| line.len()).sum::<usize>();
            let here = mutants.iter().filter(|mutant| mutant.file == file.path);
            here.map(|mutant| start(mutant.span.start.line - 1) + mutant.span.start.column - 1).collect()
        };
        let parts: Vec<(&str, &syn::File, Vec<usize>)> =
            kernel.iter().map(|file| (file.path.as_str(), &file.syntax, places(file))).collect();
        let constants = Constants::of(&parts, &others);

        let memory = work.join("refused.json");
        let mut known: Known =
            fs::read(&memory).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default();
        if known.kernel != tree.kernel {
            known = Known { kernel: tree.kernel.clone(), ..Known::default() };
        }
        // Those whose place does not compile for a reason that is not theirs.
        let mut dropped = known.dropped;
        tree.refused = known.refused;
        for packages in [&PACKAGES[..1], &PACKAGES[..]] {
            loop {
                let mut owners = BTreeMap::new();
                (tree.woven, tree.elsewhere) = (BTreeMap::new(), BTreeSet::new());
                let out: BTreeSet<u32> = tree.refused.union(&dropped).copied().collect();
                for file in &kernel {
                    let source = Source { path: &file.path, text: &file.text, syntax: &file.syntax };
                    let woven = weave(&source, mutants, &out, &constants, &machine);
                    write(&tree.folder.join(&file.path), woven.edited.text.as_bytes())?;
                    owners.insert(file.path.clone(), woven.edited.owners);
                    tree.woven.extend(woven.marks);
                    tree.refused.extend(woven.refused);
                    tree.elsewhere.extend(woven.elsewhere);
                }
                let before = tree.refused.len() + dropped.len();
                let errors = tree.check(packages)?;
                if errors.is_empty() {
                    break;
                }
                for error in &errors {
                    blame(error, &owners, &mut tree.refused, &mut dropped)?;
                }
                if tree.refused.len() + dropped.len() == before {
                    return Err(Problem(format!(
                        "the woven kernel does not compile:\n{}",
                        errors[0].rendered
                    )));
                }
                eprintln!(
                    "  {} errors; {} mutants do not compile, {} cannot be woven",
                    errors.len(),
                    tree.refused.len(),
                    dropped.len()
                );
            }
        }
        let known = Known { kernel: tree.kernel.clone(), refused: tree.refused.clone(), dropped };
        write(&memory, &serde_json::to_vec(&known).expect("plain data"))?;
        Ok(tree)
    }

    /// Cargo in the copy, quick programs wanted and no warnings; with records of what runs in a folder of its own.
    pub fn cargo(&self, covers: bool) -> Command {
        let mut command = Command::new("cargo");
        command
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", self.work.join(if covers { "covering" } else { "build" }));
        command.env_remove("MINVAR_MUTANT_COVERS");
        if covers {
            command.env("MINVAR_MUTANT_COVERS", "1");
        }
        command.env("RUSTFLAGS", "--cap-lints=warn -Awarnings").env("CARGO_INCREMENTAL", "0");
        command.env("CARGO_PROFILE_TEST_DEBUG", "0").env("CARGO_PROFILE_DEV_DEBUG", "0");
        command
    }

    /// What tells the sources of the test programs from others.
    pub fn sources(&self) -> Vec<u64> {
        let is_source = |path: &str| {
            ["Cargo.", "kernel/", "tests/", "cli/"].iter().any(|folder| path.starts_with(folder))
        };
        self.files.iter().filter(|(path, _)| is_source(path)).map(|(_, hash)| *hash).collect()
    }

    fn check(&self, packages: &[&str]) -> Result<Vec<Diagnostic>, Problem> {
        let mut command = self.cargo(false);
        command.args(["check", "--locked", "--tests", "--keep-going", "--message-format=json"]);
        for package in packages {
            command.args(["--package", package]);
        }
        let said = command.output().map_err(|error| Problem(format!("cargo check: {error}")))?;
        let mut errors = Vec::new();
        for line in String::from_utf8_lossy(&said.stdout).lines() {
            if let Ok(Message { message: Some(message) }) = serde_json::from_str(line)
                && message.level.starts_with("error")
                && !message.spans.is_empty()
            {
                errors.push(message);
            }
        }
        if errors.is_empty() && !said.status.success() {
            return Err(Problem(format!("cargo check failed:\n{}", String::from_utf8_lossy(&said.stderr))));
        }
        Ok(errors)
    }
}

#[derive(Deserialize)]
struct Message {
    message: Option<Diagnostic>,
}

/// What the compiler says.
#[derive(Deserialize)]
struct Diagnostic {
    level: String,
    spans: Vec<DiagnosticSpan>,
    #[serde(default)]
    rendered: String,
}

#[derive(Deserialize)]
struct DiagnosticSpan {
    file_name: String,
    byte_start: usize,
    byte_end: usize,
    is_primary: bool,
}

type Owners = BTreeMap<String, Vec<(Range<usize>, Owner)>>;

/// Finds whose fault an error is: the mutant whose own text it points at is refused; where it points at a place, the
/// place's mutants are dropped.
fn blame(
    error: &Diagnostic,
    owners: &Owners,
    refused: &mut BTreeSet<u32>,
    dropped: &mut BTreeSet<u32>,
) -> Result<(), Problem> {
    for primary in [true, false] {
        for span in error.spans.iter().filter(|span| span.is_primary == primary) {
            let meets = |range: &Range<usize>| range.start < span.byte_end && span.byte_start < range.end;
            for (range, owner) in owners.get(&span.file_name).into_iter().flatten() {
                if let (true, Owner::Mutant(id)) = (meets(range), owner)
                    && range.start <= span.byte_start
                    && span.byte_end <= range.end
                {
                    refused.insert(*id);
                    return Ok(());
                }
            }
        }
    }
    let around = error.spans.iter().flat_map(|span| {
        let of_file = owners.get(&span.file_name).into_iter().flatten();
        of_file.filter_map(move |(range, owner)| match owner {
            Owner::Place(ids) if range.start <= span.byte_start && span.byte_end <= range.end => {
                Some((range.len(), ids))
            }
            _ => None,
        })
    });
    match around.min_by_key(|(len, _)| *len) {
        Some((_, ids)) => dropped.extend(ids),
        None => return Err(Problem(format!("the woven kernel does not compile:\n{}", error.rendered))),
    }
    Ok(())
}

/// The repository's files, as git knows them, without this tool.
fn tracked(repository: &Path) -> Result<Vec<String>, Problem> {
    let mut git = Command::new("git");
    git.args(["ls-files", "--cached", "--others", "--exclude-standard"]).current_dir(repository);
    let paths = output(&mut git)?;
    let there = |path: &&str| repository.join(path).is_file() && !path.starts_with("mutants/");
    Ok(paths.lines().filter(there).map(str::to_owned).collect())
}

/// A failed case need not be made small.
fn without_shrinking(text: &str) -> String {
    let mut parts = text.split("max_shrink_iters: ");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push_str("max_shrink_iters: 0");
        out.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit() || c == '_'));
    }
    out
}

/// A source without its tests, which are no part of what is changed.
fn without_tests(text: &str, syntax: &syn::File) -> String {
    let is_test = |item: &&syn::Item| {
        matches!(item, syn::Item::Mod(module) if module.attrs.iter().any(|attribute| {
            attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|name| name == "test")
        }))
    };
    let mut out = String::new();
    let mut at = 0;
    for item in syntax.items.iter().filter(is_test) {
        let range = item.span().byte_range();
        out.push_str(&text[at..range.start]);
        at = range.end;
    }
    out + &text[at..]
}

fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}

/// Writes a file unless it is the same: cargo builds what is newer.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Problem> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(Problem::with(folder))?;
    }
    fs::write(path, bytes).map_err(Problem::with(path))
}
