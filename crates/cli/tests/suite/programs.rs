//! The programs that our files are for, and the scripts that run them: shared by the tests of the clients.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Where the tests' folders go, to be looked at afterwards.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Where this is set to 1, a client that cannot run fails the tests; elsewhere its tests say so and go on.
const REQUIRED: &str = "WHEELRAIL_REQUIRE_CLIENTS";

/// What the clients run on.
struct Clients {
    /// The environment's interpreter.
    python: String,
    /// The compiled Fortran reader of the decks.
    reader: Option<String>,
}

/// The clients, set up once by setup.sh; `None` where no Python environment can be made.
fn clients() -> Option<&'static Clients> {
    static CLIENTS: OnceLock<Option<Clients>> = OnceLock::new();
    let clients = CLIENTS.get_or_init(|| {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/setup.sh");
        let output = Command::new(script).stderr(std::process::Stdio::inherit()).output().ok()?;
        let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
        let mut lines = text.lines().map(String::from);
        Some(Clients { python: lines.next()?, reader: lines.next() })
    });
    if clients.is_none() {
        not_run("the clients' Python environment could not be made: see above");
    }
    clients.as_ref()
}

/// Says that something did not run, or fails where it must.
pub fn not_run(what: &str) {
    assert!(std::env::var(REQUIRED).as_deref() != Ok("1"), "{what} ({REQUIRED} is 1)");
    eprintln!("NOT RUN: {what}");
}

/// The interpreter of the environment; `None` where none can be made.
pub fn python() -> Option<&'static str> {
    clients().map(|clients| clients.python.as_str())
}

/// Runs one script on a folder, prints its lines, and fails with them.
pub fn check(script: &str, dir: &Path, arguments: &[&str]) {
    if let Some(lines) = output_of(script, dir, arguments) {
        eprint!("{lines}");
    }
}

/// What a script prints about a folder; a failed script fails the test. `None` where there is no Python to run it.
pub fn output_of(script: &str, dir: &Path, arguments: &[&str]) -> Option<String> {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients");
    let python = &clients()?.python;
    let output = Command::new(python).arg(scripts.join(script)).arg(dir).args(arguments).output().unwrap();
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{script}:\n{lines}{}", String::from_utf8_lossy(&output.stderr));
    Some(lines)
}

/// Runs the script that needs Gmsh, whose package is linked with libraries that it does not bring.
pub fn check_gmsh(dir: &Path) {
    let Some(python) = python() else { return };
    let import = Command::new(python).args(["-c", "import gmsh"]).output().unwrap();
    if import.status.success() {
        check("check_gmsh.py", dir, &[]);
    } else {
        not_run("gmsh cannot be imported: libraries of .ci/run are missing");
    }
}

/// Runs the script that needs CalculiX, of the Debian package `calculix-ccx`.
pub fn check_calculix(dir: &Path) {
    match Command::new("ccx").arg("-v").output() {
        Ok(_) => check("check_calculix.py", dir, &["ccx"]),
        Err(_) => not_run("ccx is missing, the program of the package calculix-ccx"),
    }
}

/// Runs one script that needs the Fortran reader.
fn check_decks(script: &str, dir: &Path) {
    match clients().map(|clients| &clients.reader) {
        Some(Some(reader)) => check(script, dir, &[reader]),
        Some(None) => not_run("gfortran is missing, which the reader of the decks is compiled with"),
        None => {}
    }
}

/// Runs every reader on a folder of `wheelrail run` with all formats.
pub fn check_run(dir: &Path) {
    check_all(dir);
    check("check_ply.py", dir, &[]);
    check_decks("check_run.py", dir);
}

/// Runs every reader on a folder of `wheelrail run` over the rail's surface.
pub fn check_conformal(dir: &Path) {
    check_decks("check_conformal.py", dir);
    check("check_view.py", dir, &[]);
}

/// Runs every reader on one folder.
pub fn check_all(dir: &Path) {
    check_decks("check_text.py", dir);
    check("check_netcdf.py", dir, &[]);
    check("check_vtk.py", dir, &[]);
    check("check_meshio.py", dir, &[]);
    check("check_view.py", dir, &[]);
}
