//! The programs that our files are for, and the scripts that run them: shared by the tests of the clients.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Where the tests' folders go, to be looked at afterwards.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// The environment's python, set up once; without it the tests fail, they do not pass by skipping.
pub fn python() -> &'static str {
    static PYTHON: OnceLock<String> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/setup.sh");
        let output = Command::new(script).stderr(std::process::Stdio::inherit()).output().unwrap();
        assert!(output.status.success(), "the client programs could not be installed: see above");
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    })
}

/// Runs one script on a folder, prints its lines, and fails with them.
pub fn check(script: &str, dir: &Path, arguments: &[&str]) {
    eprint!("{}", output_of(script, dir, arguments));
}

/// What a script prints about a folder; a failed script fails the test.
pub fn output_of(script: &str, dir: &Path, arguments: &[&str]) -> String {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients");
    let output = Command::new(python()).arg(scripts.join(script)).arg(dir).args(arguments).output().unwrap();
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{script}:\n{lines}{}", String::from_utf8_lossy(&output.stderr));
    lines
}

/// The Fortran reader that setup.sh has compiled, in the same target folder as the environment.
fn reader() -> String {
    let target = Path::new(python()).ancestors().nth(3).unwrap();
    target.join("read_wrp").to_str().unwrap().to_owned()
}

/// Every reader on a folder of `wheelrail run` with all formats.
pub fn check_run(dir: &Path) {
    check_all(dir);
    check("check_run.py", dir, &[&reader()]);
}

/// Every reader on one folder.
pub fn check_all(dir: &Path) {
    check("check_text.py", dir, &[&reader()]);
    check("check_netcdf.py", dir, &[]);
    check("check_vtk.py", dir, &[]);
    check("check_meshio.py", dir, &[]);
    check("check_view.py", dir, &[]);
}
