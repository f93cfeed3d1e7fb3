//! Folders of `wheelrail run` itself, read and solved by the programs that they are for.

use crate::programs::{check, check_calculix, check_conformal, check_gmsh, check_run, folder};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use wheelrail::case::{OutputFormat, run_files};

/// The Hertz case of a 460 mm wheel on a 300 mm crown under 80 kN: E* \[N/mm²\], p₀ \[N/mm²\], δ \[mm\].
const HERTZ: [&str; 3] = ["113932", "1139.19", "0.0904879"];

/// Asks for every format but these.
fn formats(but: &[&str]) -> String {
    let names =
        OutputFormat::ALL.iter().map(|format| format.name()).filter(|name| !but.contains(&name.as_str()));
    format!("[output]\nformats = {:?}\n", names.collect::<Vec<_>>())
}

/// What a solver of rolling contact needs besides.
const ROLLING: &str = "[motion]\nspeed = 30.0\n[friction]\nstatic = 0.35\nkinetic = 0.25\n";

/// What only a run writes that is asked for pressures.
const PRESSURE: &str = "pressure.npy";

/// What only a run over the rail's surface writes.
const ON_RAIL: [&str; 7] = [
    "sigma.npy",
    "angle.npy",
    "normal_gap.npy",
    "conformal.vts",
    "interpen_sigma.csv",
    "conformal.svg",
    "conformal.png",
];

/// What has no form over the rail's surface.
const ON_PLANE: [&str; 4] = ["separation.nc", "separation.wrp", "countact.wrp", PRESSURE];

/// The page that holds the table of estimates, and programs in Python.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../src/docs/clients.md");

/// A scene of one standard rail, inclined 1:40, under one standard wheel.
fn standard(rail: &str, wheel: &str, offset: f64, rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"{rail}\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"{wheel}\"\nradius = 460.0\n\
         [contact]\noffset = {offset:?}\n{rest}"
    )
}

/// A 300 mm crown under a wheel of one line with this slope, touching at the rail's `x`.
fn crown(slope: f64, x: f64, rest: &str) -> String {
    let z = 40.0 * slope;
    format!(
        "[rail]\nsegments = [{{ arc = {{ center = [0.0, -300.0], radius = 300.0, half = \"upper\", x = [-40.0, 40.0] \
         }} }}]\n[wheel]\nsegments = [{{ line = {{ from = [-40.0, {:?}], to = [40.0, {z:?}] }} }}]\nradius = 460.0\n\
         [contact]\nrail_x = {x:?}\nwheel_x = 0.0\n{rest}",
        -z
    )
}

/// Runs a scene with the real program and all formats and returns its folder, in which every file is.
fn run(name: &str, scene: &str) -> PathBuf {
    let (path, dir) = (folder(&format!("{name}.toml")), folder(name));
    std::fs::write(&path, format!("{scene}{}", formats(&[]))).unwrap();
    run_file(&path, &dir);
    let pressed = scene.contains("pressure = true");
    assert_complete(&dir, &[&ON_RAIL[..], if pressed { &[] } else { &[PRESSURE] }].concat());
    dir
}

/// Runs a scene's file with the real program.
fn run_file(path: &Path, dir: &Path) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    let output = program.arg("run").arg(path).arg("--out").arg(dir).output().unwrap();
    assert!(output.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stderr));
}

/// What only the folder of a run's first contact holds: the page and the bodies in their place.
const OF_ALL_CONTACTS: [&str; 7] =
    ["view.html", "wheelset.vtm", "rails.vtp", "wheels.vtp", "patches.vtp", "boundaries.vtp", "contacts.vtp"];

/// The folder holds the files of a run but for these, no other ones, and the summary lists the same.
fn assert_complete(dir: &Path, missing: &[&str]) {
    let summary = std::fs::read_to_string(dir.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let listed = summary["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap().to_owned());
    let listed: BTreeSet<String> = listed.chain(["summary.json".to_owned()]).collect();
    let entries = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.file_type().unwrap().is_file());
    let written: BTreeSet<String> = files.map(|entry| entry.file_name().into_string().unwrap()).collect();
    let expected: BTreeSet<String> =
        run_files().filter(|name| !missing.contains(name)).map(str::to_owned).collect();
    assert_eq!(written, expected, "{}", dir.display());
    assert_eq!(listed, expected, "{}", dir.display());
}

/// The page that explains the folder names each of its files, and the formats that have to be asked for.
#[test]
fn the_page_about_the_folder_is_complete() {
    let page = include_str!("../../../../output/README.md");
    for name in run_files() {
        assert!(page.contains(&format!("`{name}`")), "output/README.md does not name {name}");
    }
    for format in OutputFormat::ALL.iter().filter(|format| !format.unasked()) {
        let asked = format!("on request (format \"{}\")", format.name());
        let row = |line: &str| line.contains(&asked) && format.files().any(|name| line.contains(name));
        assert!(page.lines().any(row), "output/README.md does not say: {asked}");
    }
}

#[test]
fn every_reader_reads_what_runs_write() {
    let tread = run("tread", include_str!("../../../../examples/scenes/60e1_s1002.toml"));
    let flange = run("flange", &standard("60E1", "S1002", 6.0, "[patch]\nload = 60000.0\npressure = true\n"));
    // Beyond the ends of both profiles, where cells are undefined.
    let wide = "[patch]\napproach = 0.08\npressure = true\n[grid]\nxi = { from = -60.0, to = 90.0, n = 76 }\n\
                eta = { from = -9.0, to = 9.0, n = 19 }\n";
    let wide = run("wide", &standard("60E1", "S1002", 0.0, wide));
    check_run(&[&tread, &flange, &wide]);
    check("check_undefined.py", &wide, &[]);
}

#[test]
fn every_reader_reads_runs_over_the_rails_surface() {
    let grid = "[grid]\nreference = \"rail\"\n";
    let corner = "[rail]\nsegments = [{ arc = { center = [0.0, -13.0], radius = 13.0, half = \"upper\", x = [-12.0, 12.0] } }]\n\
                  [wheel]\nradius = 460.0\nsegments = [{ arc = { center = [0.0, -14.5], radius = 14.5, half = \"upper\", \
                  x = [-13.5, 13.5] } }]\n[contact]\nrail_x = 0.0\nwheel_x = 0.0\n[patch]\napproach = 0.08\n";
    let wide = "xi = { from = -4.5, to = 9.0, n = 55 }\neta = { from = -12.0, to = 12.0, n = 49 }\n";
    let yawed = standard("60E1", "S1002", 6.0, "yaw = 0.01\n[patch]\nload = 60000.0\n");
    let root = include_str!("../../../../examples/scenes/flange_root.toml");
    let scenes = [
        ("corner", format!("{corner}{grid}")),
        ("corner_wide", format!("{corner}{grid}{wide}")),
        ("corner_yawed", format!("{yawed}{grid}")),
        ("flange_root", root.to_owned()),
        ("flange_root_rolling", format!("{root}[motion]\nspeed = 30.0\n")),
    ];
    let dirs = scenes.map(|(name, scene)| {
        let (path, dir) = (folder(&format!("{name}.toml")), folder(name));
        std::fs::write(&path, format!("{scene}{}", formats(&["netcdf", "text", "countact"]))).unwrap();
        run_file(&path, &dir);
        assert_complete(&dir, &ON_PLANE);
        dir
    });
    check_conformal(&dirs);
}

#[test]
fn every_reader_reads_each_contact_of_a_wheelset() {
    let text = include_str!("../../../../examples/scenes/wheelset.toml");
    let dir = run("wheelset", &format!("{text}{ROLLING}"));
    let parts = std::fs::read_dir(&dir).unwrap().map(|entry| entry.unwrap().path());
    let parts: Vec<_> = parts.filter(|path| path.is_dir()).collect();
    assert!(parts.iter().any(|part| part.ends_with("left")), "{parts:?}");
    for part in &parts {
        assert_complete(part, &[&ON_RAIL[..], &OF_ALL_CONTACTS, &[PRESSURE]].concat());
    }
    check_run(&[&[dir], &parts[..]].concat());
}

/// Ten boundaries: plain, cut by the window, yawed, narrow, of two sizes, and beside the flange.
#[test]
fn gmsh_meshes_the_same_boundaries_no_better() {
    let yawed = |yaw: f64| format!("yaw = {yaw:?}\n[patch]\napproach = 0.05\n");
    let cut = |xi: [f64; 2], eta: [f64; 2]| {
        format!(
            "[patch]\napproach = 0.05\n[grid]\nxi = {{ from = {:?}, to = {:?}, n = 33 }}\n\
             eta = {{ from = {:?}, to = {:?}, n = 33 }}\n",
            xi[0], xi[1], eta[0], eta[1]
        )
    };
    let plain = "[patch]\napproach = 0.05\n";
    let sized = |size: f64| format!("{plain}[mesh]\nsize = {size:?}\n");
    let scenes = [
        ("mesh_tread", standard("60E1", "S1002", 0.0, plain)),
        ("mesh_fine", standard("60E1", "S1002", 0.0, &sized(0.3))),
        ("mesh_coarse", standard("60E1", "S1002", 0.0, &sized(2.0))),
        ("mesh_deep", standard("56E1", "EN15302-A", 2.0, "[patch]\napproach = 0.3\n")),
        ("mesh_yawed", standard("60E1", "S1002", 0.0, &yawed(0.05))),
        ("mesh_yawed_flange", standard("60E1", "S1002", 5.0, &yawed(0.02))),
        ("mesh_flange", standard("60E1", "S1002", 6.0, plain)),
        ("mesh_corner", standard("60E1", "S1002", 0.0, &cut([-1.0, 12.0], [-2.0, 4.0]))),
        ("mesh_cap", standard("60E1", "S1002", 0.0, &cut([-12.0, 12.0], [5.0, 12.0]))),
        ("mesh_crown", crown(0.0, 0.0, plain)),
    ];
    for (name, scene) in scenes {
        check_gmsh(&run(name, &scene));
    }
}

/// A job that adds material, thickness, supports and a pressure: one part, one with a corner, and two in one mesh.
#[test]
fn calculix_solves_a_job_over_the_triangles() {
    let plain = "[patch]\napproach = 0.05\n";
    let cut = "[patch]\napproach = 0.05\n[grid]\nxi = { from = -1.0, to = 12.0, n = 33 }\neta = { from = -2.0, to = 4.0, n = 33 }\n";
    let two = "[patch]\napproach = 0.3\n[grid]\nxi = { from = -60.0, to = 40.0, n = 51 }\neta = { from = -20.0, to = 20.0, n = 21 }\n";
    let scenes = [
        ("job_tread", standard("60E1", "S1002", 0.0, plain)),
        ("job_corner", standard("60E1", "S1002", 0.0, cut)),
        ("job_two", standard("60E1", "S1002", 5.9, two)),
    ];
    for (name, scene) in scenes {
        check_calculix(&run(name, &scene));
    }
}

#[test]
fn pyvista_plays_the_patches_of_a_sweep() {
    let dir = folder("swept");
    let text = include_str!("../../../../examples/scenes/wheelset.toml");
    let run = run("swept_run", text);
    let (scene, table) = (folder("swept.toml"), folder("swept.csv"));
    std::fs::write(&scene, text).unwrap();
    // The second one is the scene's own; the last one is off the track.
    std::fs::write(&table, "lateral_mm,yaw_rad,roll_rad\n4,0.001,\n5,0.002,\n300,0,\n").unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    program.arg("sweep").arg(&scene).arg("--positions").arg(&table).arg("--patches").arg(&dir);
    let output = program.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("1 position without contact"), "{said}");
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    let row = |side: &str| table.lines().any(|row| row.starts_with("5,") && row.contains(side));
    assert!(row(",left,1,") && row(",right,1,"), "{table}");
    check("check_sweep.py", &dir, &[run.to_str().unwrap(), "5"]);
}

#[test]
fn tamaas_and_contact_mechanics_solve_hertz_from_a_run() {
    let dir = run("hertz_run", &crown(0.0, 0.0, "[patch]\nload = 80000.0\n[grid]\nspacing = 0.12\n"));
    check_run(&[&dir]);
    let [modulus, peak, approach] = HERTZ;
    let expected = ["--peak", peak, "--approach", approach, "--within", "0.001"];
    check("solve.py", &dir, &[&["--modulus", modulus, "--load", "80000"][..], &expected].concat());
}

#[test]
fn tamaas_and_contact_mechanics_agree_on_60e1_under_s1002() {
    let dir = run("tread60", &standard("60E1", "S1002", 0.0, "[patch]\nload = 60000.0\n"));
    check_run(&[&dir]);
    check("solve.py", &dir, &["--modulus", HERTZ[0], "--load", "60000", "--within", "0.005"]);
    check("check_docs.py", &dir, &[DOCS]);
}
