//! The programs that our files are for, and the scripts that run them: shared by the tests of the clients.

use std::ffi::OsStr;
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
    printed(script, std::iter::once(dir.as_os_str()).chain(arguments.iter().map(OsStr::new)))
}

/// What a script prints; a failed one fails the test. `None` where there is no Python to run it.
fn printed<'a>(script: &str, arguments: impl Iterator<Item = &'a OsStr>) -> Option<String> {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients");
    let python = &clients()?.python;
    let output = Command::new(python).arg(scripts.join(script)).args(arguments).output().unwrap();
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

/// Scripts that read the grid over the tangent plane and the boundary, which tests write, too.
const OVER_THE_PLANE: [&str; 5] =
    ["check_text.py", "check_netcdf.py", "check_vtk.py", "check_meshio.py", "check_view.py"];

/// Scripts that read what only `wheelrail run` writes over the tangent plane.
const OF_RUNS: [&str; 2] = ["check_ply.py", "check_run.py"];

/// Scripts that read a run over the rail's surface.
const OVER_THE_RAIL: [&str; 2] = ["check_conformal.py", "check_view.py"];

/// Scripts that need the compiled reader of the decks.
const OF_DECKS: [&str; 3] = ["check_text.py", "check_run.py", "check_conformal.py"];

/// Runs every reader on folders of `wheelrail run` with all formats.
pub fn check_run(dirs: &[impl AsRef<Path>]) {
    check_each(&[&OVER_THE_PLANE[..], &OF_RUNS].concat(), dirs);
}

/// Runs every reader on folders of `wheelrail run` over the rail's surface.
pub fn check_conformal(dirs: &[impl AsRef<Path>]) {
    check_each(&OVER_THE_RAIL, dirs);
}

/// Runs every reader of the grid and the boundary on folders that tests have written.
pub fn check_all(dirs: &[impl AsRef<Path>]) {
    check_each(&OVER_THE_PLANE, dirs);
}

/// Runs scripts on folders, without those of decks where no compiler makes their reader; fails with what they print.
fn check_each(scripts: &[&str], dirs: &[impl AsRef<Path>]) {
    let reader = clients().and_then(|clients| clients.reader.as_deref());
    if clients().is_some() && reader.is_none() {
        not_run("gfortran is missing, which the reader of the decks is compiled with");
    }
    let scripts = scripts.iter().filter(|script| reader.is_some() || !OF_DECKS.contains(script));
    let arguments = std::iter::once(reader.unwrap_or_default()).chain(scripts.copied()).chain(["--"]);
    let dirs = dirs.iter().map(|dir| dir.as_ref().as_os_str());
    if let Some(lines) = printed("check_each.py", arguments.map(OsStr::new).chain(dirs)) {
        eprint!("{lines}");
    }
}
