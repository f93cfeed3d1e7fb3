//! The 60-digit reference values, shared by the integration tests.
#![allow(dead_code, unused_imports, clippy::expect_used, reason = "each integration test uses its own part")]

pub use wheelrail::accuracy::reference::{Reference, ReferenceScene, ReferenceSegment, chain};

/// All reference scenes; they are part of the program, in `src/accuracy/reference`.
pub fn references() -> Vec<Reference> {
    wheelrail::accuracy::reference::references().expect("reference files in their format")
}

/// A folder below `tests`.
pub fn folder(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}
