//! The 60-digit reference values and a few placed pairs, shared by the integration tests.

use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use wheelrail::Result;
use wheelrail::internal::bracketed;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Polynomial, Profile, Segment, Shape};
use wheelrail_report::errors::ComparedPoint;
pub use wheelrail_report::reference::{ReferenceFile, ReferenceSegment};

/// All reference scenes; they are part of the program, in `crates/report/src/reference`.
pub fn references() -> Vec<ReferenceFile> {
    wheelrail_report::reference::references().expect("reference files in their format")
}

/// All reference files of a folder below `tests`, in order of their names; at least one.
pub fn references_in(name: &str) -> Vec<ReferenceFile> {
    let files = std::fs::read_dir(repository("tests").join(name)).expect("the folder of reference values");
    let mut files: Vec<_> = files.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "json"));
    files.sort();
    assert!(!files.is_empty(), "no reference values in tests/{name}");
    let read = |path: &std::path::PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        ReferenceFile::read(&name, &std::fs::read_to_string(path).expect("a readable file"))
            .expect("its format")
    };
    files.iter().map(read).collect()
}

/// The seed of all generated cases.
const SEED: [u8; 32] = *b"wheelrail invariances, fixed run";

/// Runs a property over so many generated cases with the fixed seed.
pub fn holds<S: Strategy>(
    name: &str,
    cases: u32,
    strategy: S,
    property: impl Fn(S::Value) -> std::result::Result<(), TestCaseError>,
) {
    println!("{name}: {cases} cases, ChaCha seed {:?}", std::str::from_utf8(&SEED));
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &SEED);
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    if let Err(error) = TestRunner::new_with_rng(config, rng).run(&strategy, property) {
        panic!("{name}: {error}");
    }
}

/// A folder or file of the repository.
pub fn repository(path: &str) -> std::path::PathBuf {
    let tests = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("the repository around tests").join(path)
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
    pub fn of(name: &str, points: &[ComparedPoint]) -> Self {
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

/// Every reference scene at each of its approaches, plain and turned: name, pair, δ \[mm\].
pub fn approached_references() -> Vec<(String, Placement, f64)> {
    let mut all = Vec::new();
    for reference in references() {
        for skew in [0.0, 0.01] {
            let placement = reference.placement().and_then(|placement| placement.with_skew(skew));
            let placement = placement.expect("a placement");
            let deltas = reference.scene.delta.iter();
            all.extend(
                deltas.map(|&d| (format!("{} δ = {d} χ = {skew}", reference.name), placement.clone(), d)),
            );
        }
    }
    all
}

/// A profile of one arc or line.
pub fn profile(arc: Arc) -> Result<Profile> {
    Profile::new("one segment", "test", vec![Segment::arc(arc)])
}

/// A rail with two crowns of 250 mm, 40 mm apart and 0.16 mm above the valley between them, the right one in contact
/// with a cone.
pub fn two_crowns(slope: f64, skew: f64) -> Result<Placement> {
    let curve = Polynomial::graph(&[-0.16, 0.0, 8e-4, 0.0, -1e-6], [-35.0, 35.0])?;
    let crowns = Segment { label: String::new(), shape: Shape::Polynomial(curve) };
    let rail = Profile::new("two crowns", "test", vec![crowns])?;
    let wheel = profile(Arc::line([-60.0, -60.0 * slope], [60.0, 60.0 * slope])?)?;
    let touching = bracketed(|x| x * (1.6e-3 - 4e-6 * x * x) - slope, 15.0, 25.0).unwrap_or(f64::NAN);
    Pair::new(rail, wheel, 460.0)?.placed(touching, 20.0, skew)
}
