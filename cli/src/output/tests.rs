//! What becomes of files when outputs are handed over, and when that fails.

use super::*;
use std::fs;

fn prepare(path: &Path, content: &str) -> Result<Outputs, String> {
    let mut outputs = Outputs::default();
    outputs.add(&Target::new(path), content.as_bytes().to_vec()).map(|()| outputs)
}

fn write(path: &Path, content: &str) -> Result<(), String> {
    prepare(path, content)?.commit()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
        .collect();
    names.sort();
    names
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("a file")
}

#[test]
fn a_file_is_replaced_only_on_commit_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.svg");
    write(&path, "old").expect("the first write");
    let prepared = prepare(&path, "new").expect("prepared");
    assert_eq!(read(&path), "old");
    prepared.commit().expect("committed");
    assert_eq!(read(&path), "new");
    drop(prepare(&path, "never").expect("prepared"));
    assert_eq!(read(&path), "new");
    assert_eq!(names(folder.path()), ["a.svg"]);
}

/// Outputs to files of a folder, the content of each `new` and its name.
fn prepared(folder: &Path, files: &[&str]) -> Outputs {
    let mut outputs = Outputs::default();
    for name in files {
        let content = format!("new {name}").into_bytes();
        outputs.add(&Target::new(&folder.join(name)), content).expect("prepared");
    }
    outputs
}

#[test]
fn if_one_of_several_cannot_take_its_place_none_does() {
    for bad in 0..4 {
        let folder = tempfile::tempdir().expect("a folder");
        let files = ["a", "b", "c", "d"];
        // Two are there already, two are not.
        for name in ["a", "c"] {
            fs::write(folder.path().join(name), format!("old {name}")).expect("a file");
        }
        let outputs = prepared(folder.path(), &files);
        // After everything was looked at, a folder gets into the way, which no file replaces.
        let place = folder.path().join(files[bad]);
        let _ = fs::remove_file(&place);
        fs::create_dir_all(place.join("inner")).expect("a folder");
        let error = outputs.commit().expect_err("no room for it");
        let words = format!("cannot write {} (5 bytes): ", place.display());
        assert!(error.starts_with(&words) && !error.contains("replaced"), "{error}");
        for name in ["a", "c"].into_iter().filter(|name| *name != files[bad]) {
            assert_eq!(read(&folder.path().join(name)), format!("old {name}"));
        }
        let mut left = vec!["a", "c", files[bad]];
        left.sort();
        left.dedup();
        assert_eq!(names(folder.path()), left, "what was not there is not there, and nothing else");
    }
}

#[test]
fn all_of_several_take_their_places_and_leave_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = ["a", "b", "c"];
    fs::write(folder.path().join("b"), "old").expect("a file");
    prepared(folder.path(), &files).commit().expect("written");
    assert_eq!(names(folder.path()), files);
    assert!(files.iter().all(|name| read(&folder.path().join(name)) == format!("new {name}")));
}

#[cfg(unix)]
#[test]
fn a_device_that_takes_nothing_keeps_files_from_changing() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a"), "old").expect("a file");
    let mut outputs = prepared(folder.path(), &["a", "b"]);
    outputs.add(&Target::new(Path::new("/dev/full")), b"12345678".to_vec()).expect("a device");
    assert_eq!(
        outputs.commit().expect_err("it is full"),
        "cannot write /dev/full (8 bytes): no space left on device"
    );
    assert_eq!(
        (names(folder.path()), read(&folder.path().join("a"))),
        (vec!["a".to_owned()], "old".to_owned())
    );
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_any_new_file_and_an_old_file_keeps_its_own() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let mode =
        |name: &str| fs::metadata(folder.path().join(name)).expect("a file").permissions().mode() & 0o777;
    fs::write(folder.path().join("plain"), "").expect("a plain file");
    write(&folder.path().join("ours"), "x").expect("our file");
    assert_eq!(mode("ours"), mode("plain"));
    for given in [0o640, 0o666, 0o600, 0o755] {
        fs::set_permissions(folder.path().join("ours"), fs::Permissions::from_mode(given)).expect("chmod");
        write(&folder.path().join("ours"), "y").expect("our file again");
        assert_eq!(mode("ours"), given);
    }
    fs::set_permissions(folder.path().join("ours"), fs::Permissions::from_mode(0o444)).expect("chmod");
    let error = write(&folder.path().join("ours"), "z").expect_err("it is protected");
    assert!(error.ends_with("ours: it is write-protected"), "{error}");
    assert_eq!(read(&folder.path().join("ours")), "y");
}

/// The owner and group of a file are kept where the system lets us, as it does the superuser.
#[cfg(unix)]
#[test]
fn an_old_file_keeps_its_owner_and_group() {
    use std::os::unix::fs::{MetadataExt, chown};
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a");
    fs::write(&path, "old").expect("a file");
    if chown(&path, Some(12_345), Some(54_321)).is_err() {
        eprintln!("only the superuser gives files away: not checked");
        return;
    }
    write(&path, "new").expect("written");
    let about = fs::metadata(&path).expect("a file");
    assert_eq!((about.uid(), about.gid(), read(&path)), (12_345, 54_321, "new".to_owned()));
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_its_file_is_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, link) = (folder.path().join("file"), folder.path().join("link"));
    fs::write(&file, "old").expect("a file");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    write(&link, "new").expect("written through the link");
    assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
    assert_eq!(read(&file), "new");
    write(Path::new("/dev/null"), "gone").expect("a device");

    // Links to links, from where they stand, to what is not there yet.
    fs::create_dir(folder.path().join("inner")).expect("a folder");
    let (first, second) = (folder.path().join("first"), folder.path().join("inner/second"));
    std::os::unix::fs::symlink("inner/second", &first).expect("a link");
    std::os::unix::fs::symlink("../made", &second).expect("a link");
    write(&first, "made").expect("written through two links");
    assert_eq!(read(&folder.path().join("made")), "made");
    for link in [&first, &second] {
        assert!(fs::symlink_metadata(link).expect("the link").is_symlink());
    }
    let round = folder.path().join("round");
    std::os::unix::fs::symlink("round", &round).expect("a link");
    let error = write(&round, "x").expect_err("a link to itself");
    assert!(error.ends_with("round: too many links lead on from there"), "{error}");
}

/// A second name of an old file keeps the old content: what is replaced is the name.
#[cfg(unix)]
#[test]
fn another_name_of_an_old_file_keeps_the_old_content() {
    let folder = tempfile::tempdir().expect("a folder");
    let (one, other) = (folder.path().join("one"), folder.path().join("other"));
    fs::write(&one, "old").expect("a file");
    fs::hard_link(&one, &other).expect("a second name");
    assert_eq!(
        same_twice(&[("FILE", Target::new(&other)), ("--svg", Target::new(&one))]),
        Some(("FILE", "--svg")),
        "an input under another name"
    );
    write(&one, "new").expect("written");
    assert_eq!((read(&one), read(&other)), ("new".into(), "old".into()));
}

#[test]
fn what_cannot_be_written_is_named_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("no").join("a.svg");
    let error = write(&missing, "x").expect_err("no such folder");
    assert!(error.contains(&missing.display().to_string()) && error.contains("no folder"), "{error}");
    let error = write(folder.path(), "x").expect_err("a folder");
    assert!(error.ends_with("it is a folder"), "{error}");
    let error = write(&folder.path().join("new/"), "x").expect_err("no file's name");
    assert!(error.ends_with("it names no file"), "{error}");
    fs::write(folder.path().join("file"), "").expect("a file");
    let error = write(&folder.path().join("file/a.svg"), "x").expect_err("a file is no folder");
    assert!(error.contains("file/a.svg: not a directory"), "{error}");
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn one_place_under_two_names_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    let target = |name: &str| Target::new(&folder.path().join(name));
    fs::write(folder.path().join("c"), "").expect("a file");
    assert_eq!(same_twice(&[("--svg", target("a")), ("--nc", target("b"))]), None);
    assert_eq!(same_twice(&[("--svg", target("a")), ("--nc", target("./a"))]), Some(("--svg", "--nc")));
    assert_eq!(same_twice(&[("--svg", target("c")), ("--nc", target("./c"))]), Some(("--svg", "--nc")));
    let stdout = || Target::new(Path::new("-"));
    assert_eq!(
        same_twice(&[("--svg", stdout()), ("--nc", target("b")), ("--csv", stdout())]),
        Some(("--svg", "--csv"))
    );
    #[cfg(unix)]
    {
        for link in ["to_a", "to_to_a"] {
            let _ = std::os::unix::fs::symlink(&link[3..], folder.path().join(link));
        }
        assert_eq!(
            same_twice(&[("--svg", target("a")), ("--nc", target("to_to_a"))]),
            Some(("--svg", "--nc")),
            "a link to a link to a file that is not there yet"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_standard_output_is_known_by_its_other_names() {
    for name in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        assert_eq!(Target::new(Path::new(name)), Target::Stdout, "{name}");
    }
    let own = format!("/proc/{}/fd/1", std::process::id());
    assert_eq!(Target::new(Path::new(&own)), Target::Stdout);
    for name in ["/dev/stderr", "/dev/fd/2", "/dev/null", "fd/1"] {
        assert_ne!(Target::new(Path::new(name)), Target::Stdout, "{name}");
    }
}

#[test]
fn what_a_killed_call_left_behind_is_cleared_away_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    for litter in [".minvar-a1b2c3.part", ".minvar-d4e5f6.old"] {
        fs::write(place(litter), "half a fi").expect("litter");
    }
    let kept = [".minvar", ".minvar-notes.txt", "a.part", "minvar-x.part"];
    for name in kept {
        fs::write(place(name), "the user's").expect("a file");
    }
    fs::create_dir(place(".minvar-folder.part")).expect("a folder");
    // Another call is writing here just now.
    let busy = prepare(&place("b"), "busy").expect("prepared");
    let drafts = || names(folder.path()).iter().filter(|name| name.ends_with(".part")).count();
    assert_eq!(drafts(), 4, "its draft and what is none of ours: {:?}", names(folder.path()));
    write(&place("a"), "new").expect("written");
    assert_eq!(drafts(), 4, "a draft in work is left alone: {:?}", names(folder.path()));
    busy.commit().expect("and takes its place");
    assert_eq!((read(&place("a")), read(&place("b"))), ("new".into(), "busy".into()));
    let mut left = vec!["a", "b", ".minvar-folder.part"];
    left.extend(kept);
    left.sort();
    assert_eq!(names(folder.path()), left);
}
