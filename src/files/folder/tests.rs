use super::super::temporary::TEMPORARY;
use super::*;
use std::process;
use std::time::{Duration, Instant};

const NAMES: Names = Names {
    marker: "summary.json",
    files: &["summary.json", "a.npy", "b.npy"],
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
    fs::create_dir(dir.join("frames")).unwrap();
    assert!(Folder::create(&dir, NAMES).unwrap_err().found.contains("frames"));
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
    // A part of the last run is removed with it; another run's folder, filed here by the user, is not.
    with_part("part-2").unwrap();
    assert_eq!(listing(&dir), ["part-2", "summary.json"]);
    written(&dir.join("archive"), "a.npy").unwrap();
    assert!(with_part("part-2").unwrap_err().found.contains("archive"));
    fs::rename(dir.join("archive"), root.path().join("archive")).unwrap();
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
