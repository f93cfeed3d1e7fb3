//! The Python package: built, tested by pytest without being installed, and compared bit by bit with the library and the program.

use crate::programs::{folder, python};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use wheelrail::case::contacts;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, plan};

/// The package's sources.
const PACKAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../python");

/// A scene of a wheelset with two-point contact.
const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes/wheelset.toml");

/// Builds the extension module once and gives the folder to put into `PYTHONPATH`.
fn package(python: &str) -> &'static Path {
    static PACKAGE_FOLDER: OnceLock<PathBuf> = OnceLock::new();
    PACKAGE_FOLDER.get_or_init(|| {
        // The profile of the tests: it shares what they have compiled.
        let build = Command::new(env!("CARGO"))
            .args(["build", "--locked", "--quiet", "--profile", "test", "--package", "wheelrail-python"])
            .args(["--message-format", "json-render-diagnostics"])
            .env("PYO3_BUILD_EXTENSION_MODULE", "1")
            .env("PYO3_PYTHON", python)
            .current_dir(PACKAGE)
            .stderr(std::process::Stdio::inherit())
            .output()
            .unwrap();
        assert!(build.status.success(), "the extension module does not build: see above");
        let messages = String::from_utf8(build.stdout).unwrap();
        let mut files = messages.lines().filter(|line| line.contains("_wheelrail")).flat_map(|line| {
            let message: serde_json::Value = serde_json::from_str(line).unwrap_or_default();
            let files = message["filenames"].as_array().cloned().unwrap_or_default();
            files.into_iter().filter_map(|file| file.as_str().map(PathBuf::from))
        });
        let library = files
            .find(|file| {
                file.extension().is_some_and(|end| ["so", "dylib", "dll"].iter().any(|known| end == *known))
            })
            .expect("cargo names the library");
        let site = folder("python-package");
        let home = site.join("wheelrail");
        std::fs::create_dir_all(&home).unwrap();
        for file in std::fs::read_dir(Path::new(PACKAGE).join("python/wheelrail")).unwrap().flatten() {
            if file.path().is_file() {
                std::fs::copy(file.path(), home.join(file.file_name())).unwrap();
            }
        }
        let name = if cfg!(windows) { "_wheelrail.pyd" } else { "_wheelrail.abi3.so" };
        std::fs::copy(library, home.join(name)).unwrap();
        site
    })
}

/// Runs the environment's Python with the package, somewhere else than beside its sources; `None` without a Python.
fn run(arguments: &[&str]) -> Option<String> {
    let python = python()?;
    let output = Command::new(python)
        .args(arguments)
        .env("PYTHONPATH", package(python))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .current_dir(folder("python-package"))
        .output()
        .unwrap();
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{arguments:?}:\n{lines}{}", String::from_utf8_lossy(&output.stderr));
    Some(lines)
}

#[test]
fn the_python_package_passes_its_own_tests() {
    let config = format!("{PACKAGE}/pyproject.toml");
    let docs = format!("{PACKAGE}/../../src/docs/python.md");
    let tests = format!("{PACKAGE}/tests");
    let plain = ["-m", "pytest", "-p", "no:cacheprovider", "-o", "faulthandler_timeout=300", "-c", &config];
    let tested = run(&[&plain[..], &["--doctest-glob=*.md", &tests, &docs]].concat());
    if let Some(lines) = tested {
        eprint!("{lines}");
    }
}

#[test]
fn the_stubs_and_the_tests_of_the_python_package_have_strict_types() {
    let config = format!("{PACKAGE}/pyproject.toml");
    let cache = folder("mypy").display().to_string();
    let plain = ["-m", "mypy", "--strict", "--config-file", &config, "--cache-dir", &cache];
    let checked = ["python/wheelrail", "tests", "benches", "gallery"].map(|part| format!("{PACKAGE}/{part}"));
    run(&[&plain[..], &checked.each_ref().map(String::as_str)].concat());
}

#[test]
fn rust_the_command_line_and_python_give_the_same_bits() {
    let here = folder("same-bits");
    std::fs::create_dir_all(&here).unwrap();
    let path = Path::new(SCENE);
    let case = scene::resolve(&scene::load(path).unwrap(), path.parent().unwrap(), "wheelset").unwrap();
    let (_, placement) = contacts(&case).unwrap().swap_remove(0);
    let axis = |half: f64| (-100..=100).map(|k| half * f64::from(k) / 100.0).collect::<Vec<f64>>();
    let (xi, eta) = (axis(12.0), EtaAxis::new(&axis(10.0)));
    let mut values = vec![0.0; xi.len() * eta.eta().len()];
    plan(&placement, &xi, &eta, 1e-12, None).fill(&placement, &xi, &eta, &mut values);
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    std::fs::write(here.join("grid.f64"), bytes).unwrap();
    let program = |arguments: &[&str]| {
        let status = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
            .args(arguments)
            .current_dir(&here)
            .output()
            .unwrap();
        assert!(status.status.success(), "{}", String::from_utf8_lossy(&status.stderr));
    };
    program(&["run", SCENE, "--out", "run"]);
    program(&["sweep", SCENE, "--lateral", "-8:8:0.1", "--out", "sweep.csv"]);
    let script = format!("{PACKAGE}/tests/same_bits.py");
    if let Some(lines) = run(&[&script, SCENE, &here.display().to_string()]) {
        eprint!("{lines}");
    }
}
