//! `wheelrail table` through the binary: its files, read in Rust, C and Fortran, against direct searches; and what bad calls get.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::programs::not_run;
use tempfile::TempDir;
use wheelrail::Interval;
use wheelrail::table::{Beginning, ContactTable};

/// Random displacements of every test run. The environment variable `WHEELRAIL_TABLE_POINTS` takes another number.
const POINTS: usize = 2000;

/// Yaw of the scene [rad].
const YAW: f64 = 0.002;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).current_dir(folder).args(arguments).output().unwrap()
}

/// Displacements from −9 to 9 mm and yaws of a range, by Knuth's generator.
fn random(yaw: [f64; 2]) -> Vec<[f64; 2]> {
    let points = std::env::var("WHEELRAIL_TABLE_POINTS").ok().and_then(|n| n.parse().ok()).unwrap_or(POINTS);
    let mut state = 2026_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..points).map(|_| [[-9.0, 9.0], yaw].map(|[from, to]| from + (to - from) * next())).collect()
}

/// Quantities of the lowest places that `wheelrail sweep` finds, by name and side, a row for each displacement.
fn searched(folder: &Path, scene: &str, places: &[[f64; 2]]) -> Vec<BTreeMap<(String, String), f64>> {
    let lines: Vec<String> = places.iter().map(|[y, yaw]| format!("{y:?},{yaw:?}")).collect();
    std::fs::write(folder.join("at.csv"), format!("lateral_mm,yaw_rad\n{}\n", lines.join("\n"))).unwrap();
    let output = wheelrail(folder, &["sweep", scene, "--positions", "at.csv", "--out", "sweep.csv"]);
    assert!(output.status.success(), "{output:?}");
    let table = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let mut out: Vec<BTreeMap<(String, String), f64>> = Vec::new();
    for row in table.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()) {
        if row[column("contact")] != "1" {
            continue;
        }
        let side = row[column("side")];
        if side == "left" {
            out.push(BTreeMap::new());
        }
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap_or(f64::NAN);
        let yaw = places[out.len() - 1][1];
        let found = out.last_mut().unwrap();
        found.insert(("roll_rad".into(), "wheelset".into()), number("roll_rad"));
        let same = [
            "z_mm",
            "rail_x_mm",
            "wheel_x_mm",
            "y_mm",
            "contact_angle_rad",
            "rolling_radius_mm",
            "skew_rad",
            "hertz_xi_mm",
            "hertz_eta_mm",
        ];
        same.iter().for_each(|name| {
            found.insert(((*name).into(), side.into()), number(name));
        });
        let (skew, roll) = (number("skew_rad"), if side == "left" { -1.0 } else { 1.0 } * number("roll_rad"));
        let [rail, wheel] = ["rail_curvature_per_mm", "wheel_curvature_per_mm"].map(number);
        // The normal, which is across the rail, is at this angle from the plane across the axle, of yaw and roll.
        let (across, up) = number("contact_angle_rad").sin_cos();
        let along_axle = across * yaw.cos() * roll.cos() + up * roll.sin();
        let around = (1.0 - along_axle * along_axle).sqrt() / number("rolling_radius_mm");
        let (sin, cos) = skew.sin_cos();
        let smooth = if row[column("kink")] == "0" { 1.0 } else { f64::NAN };
        let form = [
            ("a_xi_per_mm", (wheel * cos * cos + around * sin * sin - rail) / 2.0),
            ("b_eta_per_mm", (wheel * sin * sin + around * cos * cos) / 2.0),
            ("c_xi_eta_per_mm", (wheel - around) * sin * cos),
        ];
        form.iter().for_each(|(name, value)| {
            found.insert(((*name).into(), side.into()), smooth * value);
        });
    }
    assert_eq!(out.len(), places.len());
    out
}

/// Compares rows of all quantities with direct searches: no error above the stated one.
fn compare(
    reader: &str,
    table: &ContactTable,
    rows: &[Vec<f64>],
    direct: &[BTreeMap<(String, String), f64>],
) {
    for (q, quantity) in table.quantities().iter().enumerate() {
        let key = (quantity.name.to_string(), quantity.side().to_string());
        // The angle of the wheel's profile, which the curvatures depend on, is not in the table of a sweep: it follows from others to this.
        let slack = if quantity.name.ends_with("_per_mm") { 1e-8 } else { 0.0 };
        for (row, found) in rows.iter().zip(direct) {
            let Some(value) = found.get(&key) else { continue };
            let error = (row[q] - value).abs();
            let same = value.is_nan() && row[q].is_nan() || error <= quantity.error + slack;
            assert!(same, "{reader}: {key:?}: {} for {value}, stated {:e}", row[q], quantity.error);
        }
    }
}

/// Compiles a reader and gives its rows; `None` without the compiler.
fn rows_of(folder: &Path, compiler: &str, sources: &[&str], count: usize) -> Option<Vec<Vec<f64>>> {
    let program = format!("look_up_{compiler}");
    let sources = sources.iter().map(|source| root().join(source));
    let include = root().join("examples/tables");
    let compiled = Command::new(compiler)
        .current_dir(folder)
        .args(["-O2", "-Wall", "-Wextra", "-Werror", "-I"])
        .arg(include)
        .args(["-o", &program])
        .args((compiler == "gfortran").then_some("-Wno-compare-reals"))
        .args(sources)
        .arg("-lm")
        .output();
    let Ok(compiled) = compiled else {
        not_run(&format!("{compiler} is missing, which a reader of tables is compiled with"));
        return None;
    };
    assert!(compiled.status.success(), "{compiled:?}");
    let run = Command::new(folder.join(&program))
        .current_dir(folder)
        .args(["t/table.wrp", "at.bin", "out.bin"])
        .output();
    let run = run.unwrap();
    assert!(run.status.success(), "{compiler}: {run:?}");
    let bytes = std::fs::read(folder.join("out.bin")).unwrap();
    let numbers: Vec<f64> =
        bytes.chunks_exact(8).map(|b| f64::from_ne_bytes(b.try_into().unwrap())).collect();
    Some(numbers.chunks_exact(count).map(<[f64]>::to_vec).collect())
}

/// Compares all readers of the table in a folder with direct searches; gives the table.
fn compare_readers(folder: &Path, scene: &str) -> ContactTable {
    let text = std::fs::read_to_string(folder.join("t/table.wrp")).unwrap();
    assert!(text.is_ascii() && text.lines().all(|line| line.len() < 80));
    let table = ContactTable::read(&text).unwrap();
    let about = table.about();
    assert_eq!((about.lateral.ends(), about.tolerance), ([-9.0, 9.0], 1e-3));
    let middle = about.yaw.middle();
    for kind in [Beginning::Hop, Beginning::Joint] {
        assert!(!table.places(kind, middle).is_empty());
    }
    for quantity in table.quantities() {
        assert!(quantity.error > 0.0 && quantity.error <= quantity.tolerance, "{quantity:?}");
    }

    let places = random(about.yaw.ends());
    let direct = searched(folder, scene, &places);
    let count = table.quantities().len();
    let own = |[y, yaw]: &[f64; 2]| {
        let mut row = vec![0.0; count];
        table.fill(*y, *yaw, &mut row);
        row
    };
    compare("Rust", &table, &places.iter().map(own).collect::<Vec<_>>(), &direct);
    let bytes: Vec<u8> = places.iter().flatten().flat_map(|value| value.to_ne_bytes()).collect();
    std::fs::write(folder.join("at.bin"), bytes).unwrap();
    let fortran = ["examples/tables/wheelrail_table.f90", "crates/cli/tests/clients/look_up.f90"];
    let readers = [("cc", &["crates/cli/tests/clients/look_up.c"][..]), ("gfortran", &fortran[..])];
    for (compiler, sources) in readers {
        if let Some(rows) = rows_of(folder, compiler, sources, count) {
            assert_eq!(rows.len(), places.len());
            compare(compiler, &table, &rows, &direct);
        }
    }
    assert!(std::fs::read(folder.join("t/table.nc")).unwrap().starts_with(b"CDF\x01"));
    table
}

#[test]
fn no_reader_errs_by_more_than_the_table_states() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    let scene = root().join("examples/scenes/wheelset.toml").display().to_string();
    let output = wheelrail(folder, &["table", &scene, "--lateral", "-9:9", "--hertz", "--out", "t"]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(compare_readers(folder, &scene).about().yaw.ends(), [YAW; 2]);
    let csv = std::fs::read_to_string(folder.join("t/table.csv")).unwrap();
    let head = "cell,from_mm,to_mm,begins,side,quantity,error,c0,c1,c2,c3,c4,c5,c6,c7,c8";
    assert!(csv.starts_with(head) && csv.lines().all(|row| row.split(',').count() == 16));
}

#[test]
fn no_reader_errs_by_more_than_the_table_over_yaw_states() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    let scene = root().join("examples/scenes/wheelset.toml").display().to_string();
    let asked = ["table", &scene, "--lateral", "-9:9", "--yaw", "-0.02:0.02", "--hertz", "--out", "t"];
    let output = wheelrail(folder, &asked);
    assert!(output.status.success(), "{output:?}");
    let table = compare_readers(folder, &scene);
    assert_eq!(table.about().yaw.ends(), [-0.02, 0.02]);
    let csv = std::fs::read_to_string(folder.join("t/table.csv")).unwrap();
    let head = "cell,yaw_from_rad,yaw_to_rad,begins,side,quantity,error,j,c0,c1,";
    assert!(csv.starts_with(head) && csv.lines().all(|row| row.split(',').count() == 17));
    assert_eq!(csv.lines().count(), 1 + 5 * table.cells().len() * (2 + table.quantities().len()));

    // A file that leads in a ring, or to nowhere, is refused.
    let text = std::fs::read_to_string(folder.join("t/table.wrp")).unwrap();
    let (count, at) = (table.curves().len(), table.quantities().len());
    let first = text.lines().position(|line| !line.starts_with('#') && line.contains("roll_rad")).unwrap();
    let fork = first + at + 3 * count;
    for wrong in ["       1", "     999", "   -9999", "       0"] {
        let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
        lines[fork].replace_range(0..8, wrong);
        let refused = ContactTable::read(&(lines.join("\n") + "\n")).unwrap_err().to_string();
        assert!(refused.contains("fork 1") || refused.contains("expected two parts"), "{wrong}: {refused}");
    }
}

#[test]
fn cells_off_the_rail_say_so_and_cut_files_are_refused() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    let scene = "rail = { profile = \"60E1\" }\nwheel = { profile = \"cone-1:20\", radius = 460.0 }\n\
                 track = { spacing = 1500.0 }\nwheelset = { spacing = 1500.0 }\n";
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    let table = |arguments: &[&str]| {
        let arguments: Vec<&str> = ["table", "scene.toml"].iter().chain(arguments).copied().collect();
        let output = wheelrail(folder, &arguments);
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, said) = table(&["--lateral", "50:140", "--out", "t"]);
    assert!(code == Some(0) && said.contains("warning: table: no contact from "), "{said}");
    let text = std::fs::read_to_string(folder.join("t/table.wrp")).unwrap();
    let read = ContactTable::read(&text).unwrap();
    let off = read.off_rail(0.0);
    let [Interval { low: from, high: to }] = off[..] else { panic!("{off:?}") };
    assert!(from > 50.0 && from < 139.0 && to == 140.0, "{off:?}");
    assert!(said.contains(&format!("{from} to 140 mm: a wheel is off its rail")), "{said}");
    assert!(text.contains(&format!("# off the rail, without values: {from} to 140\n")), "{text}");
    assert!(text.lines().all(|line| line.len() < 80));
    let mut values = vec![0.0; read.quantities().len()];
    read.fill(139.0, 0.0, &mut values);
    assert!(values.iter().all(|value| value.is_nan()));
    read.fill(50.0, 0.0, &mut values);
    assert!(values[0].is_finite());
    let cut = ContactTable::read(&text[..text.len() / 2]).unwrap_err().to_string();
    assert!(cut.contains("table.wrp: line "), "{cut}");

    let by_load = scene.replace("wheelset = { ", "patch = { load = 6e4 }\nwheelset = { roll = \"load\", ");
    std::fs::write(folder.join("by-load.toml"), by_load).unwrap();
    let output = wheelrail(folder, &["table", "by-load.toml", "--lateral", "-1:1", "--out", "bad"]);
    let complaint =
        "by-load.toml: wheelset: roll: found \"load\"; expected \"solve\", \"neglect\" or an angle";
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains(complaint), "{said}");

    let bad: [(&[&str], &str); 8] = [
        (&["--lateral", "-9:9", "--yaw", "0.01"], "--yaw: found 0.01; expected FROM:TO in rad"),
        (&["--lateral", "-9:9", "--yaw", "0.01:-0.01"], "table: yaw: found 0.01:-0.01"),
        (&["--lateral", "-9:9", "--hertz"], "table: hertz: found neither a load nor an approach"),
        (&["--lateral", "-9"], "--lateral: found -9; expected FROM:TO in mm"),
        (&["--lateral", "9:-9"], "table: lateral: found 9:-9"),
        (&["--lateral", "nan:9"], "table: lateral: found NaN"),
        (&["--lateral", "-9:9", "--tolerance", "0"], "table: tolerance: found 0"),
        (&["--lateral", "300:310"], "table: lateral: found no contact from 300 to 310 mm"),
    ];
    for (arguments, complaint) in bad {
        let (code, said) = table(&[arguments, &["--out", "bad"]].concat());
        assert!(code == Some(2) && said.contains(complaint), "{arguments:?}: {said}");
        assert!(!folder.join("bad").exists());
    }
}
