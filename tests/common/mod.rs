//! The 60-digit reference values, shared by the integration tests.
#![allow(dead_code, unused_imports, clippy::expect_used, reason = "each integration test uses its own part")]

use wheelrail::accuracy::errors::Point;
pub use wheelrail::accuracy::reference::{Reference, ReferenceScene, ReferenceSegment, chain};

/// All reference scenes; they are part of the program, in `src/accuracy/reference`.
pub fn references() -> Vec<Reference> {
    wheelrail::accuracy::reference::references().expect("reference files in their format")
}

/// All reference files of a folder below `tests`, in order of their names; at least one.
pub fn references_in(name: &str) -> Vec<Reference> {
    let files = std::fs::read_dir(folder(name)).expect("the folder of reference values");
    let mut files: Vec<_> = files.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "json"));
    files.sort();
    assert!(!files.is_empty(), "no reference values in tests/{name}");
    let read = |path: &std::path::PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Reference::read(&name, &std::fs::read_to_string(path).expect("a readable file")).expect("its format")
    };
    files.iter().map(read).collect()
}

/// A folder below `tests`.
pub fn folder(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

/// Largest errors of some points.
#[derive(Debug, Clone, Copy, Default)]
pub struct Worst {
    /// Relative, over both contact segments; infinite for a wrong value where s = 0.
    pub relative: f64,
    /// \[mm\] elsewhere.
    pub elsewhere: f64,
    /// \[mm\] anywhere.
    pub anywhere: f64,
}

impl Worst {
    /// The largest errors of a method; fails where a value is missing or should be.
    pub fn of(name: &str, points: &[Point]) -> Self {
        let mut worst = Self::default();
        for point in points {
            let error = point.error();
            assert!(!error.is_nan(), "{name}: {point:?}");
            worst.anywhere = worst.anywhere.max(error);
            if !point.over_contact {
                worst.elsewhere = worst.elsewhere.max(error);
            } else if error > 0.0 {
                worst.relative = worst.relative.max(point.relative().unwrap_or(f64::INFINITY));
            }
        }
        worst
    }
}
