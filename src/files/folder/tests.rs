use super::super::temporary::TEMPORARY;
use super::*;
use std::process;
use std::time::{Duration, Instant};

const NAMES: Names = Names {
    marker: "summary.json",
    is_file: |name| ["summary.json", "a.npy", "b.npy"].contains(&name),
    is_part: |name| name.starts_with("part"),
};
const SUMMARY: &[u8] = b"{\"program\": \"wheelrail 0.1.0\"}";

/// Writes and commits a folder with a summary and the given file.
fn written(dir: &Path, file: &str) -> Result<()> {
    let folder = Folder::create(dir, NAMES)?;
    folder.write("summary.json", SUMMARY)?;
    folder.write(file, b"data")?;
    folder.commit()
}

fn listing(dir: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_new_folder_appears_whole_and_replaces_the_old_one_whole() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("deep/er/out");
    let folder = Folder::create(&dir, NAMES).unwrap();
    folder.write("summary.json", SUMMARY).unwrap();
    folder.write("a.npy", b"1").unwrap();
    assert!(!dir.exists(), "seen before the commit");
    folder.commit().unwrap();
    assert_eq!(listing(&dir), ["a.npy", "summary.json"]);
    written(&dir, "b.npy").unwrap();
    assert_eq!(listing(&dir), ["b.npy", "summary.json"]);
    assert_eq!(listing(dir.parent().unwrap()), ["out"], "nothing is left beside it");
}

#[test]
fn an_empty_folder_is_taken_and_a_link_is_followed() {
    let root = tempfile::tempdir().unwrap();
    let (real, link) = (root.path().join("real"), root.path().join("link"));
    fs::create_dir(&real).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    written(&link, "a.npy").unwrap();
    assert_eq!(listing(&real), ["a.npy", "summary.json"]);
    assert!(link.is_symlink());
}

#[test]
fn the_way_to_a_file_holds_behind_a_linked_parent() {
    let root = tempfile::tempdir().unwrap();
    let [real, link, scene] = ["disk/with/much/space", "output", "scene.toml"].map(|n| root.path().join(n));
    fs::create_dir_all(&real).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    fs::write(&scene, b"").unwrap();
    let scene = scene.canonicalize().unwrap();
    // The first time the folder is still missing.
    for _ in 0..2 {
        let dir = link.join("scene");
        let folder = Folder::create(&dir, NAMES).unwrap();
        let way = folder.part("").unwrap().relative(&scene);
        folder.write("summary.json", SUMMARY).unwrap();
        folder.commit().unwrap();
        assert!(dir.join(&way).canonicalize().is_ok_and(|found| found == scene), "{}", way.display());
    }
}

#[test]
fn a_failed_or_dropped_run_leaves_everything_as_it_was() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    written(&dir, "a.npy").unwrap();
    let folder = Folder::create(&dir, NAMES).unwrap();
    folder.write("b.npy", b"half").unwrap();
    let twice = folder.write("b.npy", b"again").unwrap_err();
    assert!(twice.place.ends_with("out/b.npy"), "{twice}");
    drop(folder);
    assert_eq!(listing(&dir), ["a.npy", "summary.json"]);
    assert_eq!(listing(root.path()), ["out"]);
}

#[test]
fn what_is_not_ours_is_refused_or_kept() {
    let root = tempfile::tempdir().unwrap();
    let home = root.path().join("home");
    fs::create_dir(&home).unwrap();
    fs::write(home.join("thesis.tex"), "years").unwrap();
    assert!(Folder::create(&home, NAMES).unwrap_err().found.contains("no summary.json"));
    fs::write(home.join("summary.json"), "{}").unwrap();
    assert!(Folder::create(&home, NAMES).unwrap_err().found.contains("no summary.json of ours"));

    let file = root.path().join("file");
    fs::write(&file, "").unwrap();
    assert_eq!(Folder::create(&file, NAMES).unwrap_err().found, "a file");
    assert!(Folder::create(&file.join("below"), NAMES).is_err());
    assert!(Folder::create(Path::new("/"), NAMES).is_err());
    assert!(Folder::create(Path::new("."), NAMES).unwrap_err().found.contains("working folder"));
    assert!(Folder::create(Path::new("missing/.."), NAMES).is_err());

    let dir = root.path().join("out");
    written(&dir, "a.npy").unwrap();
    fs::write(dir.join("notes.txt"), "mine").unwrap();
    written(&dir, "b.npy").unwrap();
    assert_eq!(listing(&dir), ["b.npy", "notes.txt", "summary.json"]);
    assert_eq!(fs::read(dir.join("notes.txt")).unwrap(), b"mine");
}

#[test]
fn a_solvers_output_stays_wherever_it_was_written() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    let with_part = |name: &str| {
        let folder = Folder::create(&dir, NAMES)?;
        folder.write("summary.json", SUMMARY)?;
        let part = folder.part(name)?;
        part.write("summary.json", SUMMARY)?;
        part.write("a.npy", b"data")?;
        folder.commit()
    };
    with_part("part-1").unwrap();
    for file in ["contact.out", "part-1/contact.out", "part-1/frames/1.png", "frames/deep/2.png"] {
        let path = dir.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, file).unwrap();
    }
    std::os::unix::fs::symlink("nowhere", dir.join("link")).unwrap();
    // A solver that is still writing goes on in the new folder.
    let mut open = File::options().append(true).open(dir.join("part-1/contact.out")).unwrap();
    // The part stays for the sake of what is in it, though the next run has none of that name.
    for (part, first) in [
        ("part-1", &["a.npy", "contact.out", "frames", "summary.json"][..]),
        ("part-2", &["contact.out", "frames"]),
    ] {
        with_part(part).unwrap();
        assert_eq!(listing(&dir.join("part-1")), first);
        assert_eq!(listing(&dir.join(part))[0], "a.npy");
    }
    with_part("part-1").unwrap();
    assert_eq!(listing(&dir), ["contact.out", "frames", "link", "part-1", "summary.json"]);
    assert_eq!(listing(&dir.join("part-1")), ["a.npy", "contact.out", "frames", "summary.json"]);
    assert_eq!(fs::read(dir.join("frames/deep/2.png")).unwrap(), b"frames/deep/2.png");
    assert_eq!(fs::read_link(dir.join("link")).unwrap(), Path::new("nowhere"));
    open.write_all(b", later").unwrap();
    assert_eq!(fs::read(dir.join("part-1/contact.out")).unwrap(), b"part-1/contact.out, later");
    assert_eq!(listing(root.path()), ["out"]);
}

#[test]
fn what_comes_during_the_exchange_is_taken_over_after_it() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    written(&dir, "a.npy").unwrap();
    let folder = Folder::create(&dir, NAMES).unwrap();
    folder.write("summary.json", SUMMARY).unwrap();
    // As `commit` would, but for a solver that ends between its two steps.
    fs::write(dir.join("contact.out"), "late").unwrap();
    exchange(&folder.temporary, &dir).unwrap();
    assert_eq!(listing(&dir), ["summary.json"]);
    folder.leave().unwrap();
    drop(folder);
    assert_eq!(listing(&dir), ["contact.out", "summary.json"]);
    assert_eq!(listing(root.path()), ["out"]);
    // What cannot be taken over keeps its folder.
    let folder = Folder::create(&dir, NAMES).unwrap();
    folder.write("summary.json", SUMMARY).unwrap();
    fs::create_dir(folder.temporary.join("later")).unwrap();
    fs::write(dir.join("later"), "a file").unwrap();
    exchange(&folder.temporary, &dir).unwrap();
    let error = folder.leave().unwrap_err();
    assert!(error.place.contains("out.old-1"), "{error}");
    assert_eq!(listing(&root.path().join("out.old-1")), ["contact.out", "later", "summary.json"]);
}

#[test]
fn results_and_files_of_others_inside_are_never_replaced() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    let with_part = |name: &str| {
        let folder = Folder::create(&dir, NAMES)?;
        folder.write("summary.json", SUMMARY)?;
        folder.part(name)?.write("summary.json", SUMMARY)?;
        folder.commit()
    };
    with_part("part-1").unwrap();
    // A part of the last run is removed with it; another run's folder, filed here by the user, stays whole.
    with_part("part-2").unwrap();
    assert_eq!(listing(&dir), ["part-2", "summary.json"]);
    written(&dir.join("archive"), "a.npy").unwrap();
    with_part("part-2").unwrap();
    assert_eq!(listing(&dir), ["archive", "part-2", "summary.json"]);
    assert_eq!(listing(&dir.join("archive")), ["a.npy", "summary.json"]);
    fs::write(dir.join("part-3"), "mine").unwrap();
    assert!(with_part("part-3").unwrap_err().found.contains("named like a folder"));
    assert_eq!(fs::read(dir.join("part-3")).unwrap(), b"mine");
}

#[test]
fn a_folder_that_turned_foreign_during_the_run_is_not_replaced() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    let folder = Folder::create(&dir, NAMES).unwrap();
    fs::create_dir(&dir).unwrap();
    fs::write(dir.join("thesis.tex"), "years").unwrap();
    assert!(folder.commit().is_err());
    assert_eq!(listing(&dir), ["thesis.tex"]);
    assert_eq!(listing(root.path()), ["out"]);
}

#[test]
fn two_renames_do_where_there_is_no_exchange_and_half_of_them_is_undone() {
    let root = tempfile::tempdir().unwrap();
    let (dir, new) = (root.path().join("out"), root.path().join("new"));
    written(&dir, "a.npy").unwrap();
    written(&new, "b.npy").unwrap();
    exchange_in_two(&new, &dir).unwrap();
    assert_eq!((listing(&dir)[0].as_str(), listing(&new)[0].as_str()), ("b.npy", "a.npy"));
    fs::rename(&dir, aside_of(&dir)).unwrap();
    drop(Folder::create(&dir, NAMES).unwrap());
    assert_eq!(listing(&dir), ["b.npy", "summary.json"]);
}

#[test]
fn runs_into_one_folder_at_once_leave_one_of_them_whole() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| (0..20).for_each(|_| written(&dir, "a.npy").unwrap()));
        }
    });
    assert_eq!(listing(&dir), ["a.npy", "summary.json"]);
    assert_eq!(listing(root.path()), ["out"]);
}

/// The environment variable that turns the next test into the run that it kills.
const TO_BE_KILLED: &str = "WHEELRAIL_TEST_FOLDER";

fn run_to_be_killed(dir: &Path) {
    let folder = Folder::create(dir, NAMES).unwrap();
    folder.write("a.npy", b"half").unwrap();
    std::thread::sleep(Duration::from_secs(60));
}

#[test]
fn a_killed_run_is_swept_up_by_the_next_one_and_a_living_one_is_not() {
    if let Some(dir) = std::env::var_os(TO_BE_KILLED) {
        return run_to_be_killed(Path::new(&dir));
    }
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    written(&dir, "b.npy").unwrap();
    let mut child = process::Command::new(std::env::current_exe().unwrap())
        .args([
            "--exact",
            "files::folder::tests::a_killed_run_is_swept_up_by_the_next_one_and_a_living_one_is_not",
        ])
        .env(TO_BE_KILLED, &dir)
        .stdout(process::Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let written_half = || {
        listing(root.path())
            .iter()
            .any(|n| n.starts_with(TEMPORARY) && root.path().join(n).join("a.npy").exists())
    };
    while !written_half() && begun.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(written_half());
    drop(Folder::create(&dir, NAMES).unwrap());
    assert!(written_half(), "a living run's folder was removed");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(written_half());
    assert_eq!(listing(&dir), ["b.npy", "summary.json"], "the old folder is whole");
    written(&dir, "a.npy").unwrap();
    assert_eq!(listing(root.path()), ["out"], "the dead run's folder is gone");
    assert_eq!(listing(&dir), ["a.npy", "summary.json"]);
}
