//! Imports run one way: from the files down to the geometry.

use std::path::{Path, PathBuf};

/// Modules from the bottom up; each may use those before it and itself.
const ORDER: [&str; 15] = [
    "error",
    "files",
    "numerics",
    "profile",
    "measured",
    "placement",
    "separation",
    "search",
    "patch",
    "load",
    "mesh",
    "export",
    "case",
    "scene",
    "docs",
];

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a source folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// The modules that a file imports by `crate::`.
fn imported(text: &str) -> Vec<&str> {
    text.match_indices("crate::")
        .filter(|(at, _)| !text[..*at].ends_with('$'))
        .filter_map(|(at, word)| {
            text[at + word.len()..].split(|c: char| !c.is_alphanumeric() && c != '_').next()
        })
        .collect()
}

#[test]
fn no_module_imports_upward() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let rank = |module: &str| ORDER.iter().position(|m| *m == module);
    let mut seen = 0;
    for file in files {
        let inside = file.strip_prefix(&src).expect("a path below src");
        let module = inside.components().next().map(|c| c.as_os_str().to_string_lossy().replace(".rs", ""));
        let Some(own) = module.as_deref().and_then(rank) else { continue };
        let text = std::fs::read_to_string(&file).expect("a source file");
        for import in imported(&text) {
            if let Some(other) = rank(import) {
                seen += 1;
                assert!(other <= own, "{} imports {import}", inside.display());
            }
        }
    }
    assert!(seen > 100, "only {seen} imports were looked at");
}

#[test]
fn one_room_touches_the_disk() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let elsewhere = files.iter().filter(|file| !file.starts_with(src.join("files")));
    for file in elsewhere.filter(|file| !file.ends_with("tests.rs")) {
        let text = std::fs::read_to_string(file).expect("a source file");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let found = ["std::fs", "std::os", "rustix::fs"].into_iter().find(|word| code.contains(word));
        assert_eq!(found, None, "{}", file.display());
    }
}

#[test]
fn every_module_has_its_place_in_the_order() {
    let lib =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).expect("lib.rs");
    for line in lib.lines().filter_map(|line| line.strip_prefix("pub mod ")) {
        let name = line.trim_end_matches(';');
        assert!(ORDER.contains(&name), "{name} has no place in the order");
    }
}
