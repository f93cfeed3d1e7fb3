//! `wheelrail profile …` through the binary: round trips between all formats, pictures, and what bad input gets.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    Command::new(binary).current_dir(folder).arg("profile").args(arguments).output().unwrap()
}

/// stdout of a call that must succeed.
fn text(folder: &Path, arguments: &[&str]) -> String {
    let output = wheelrail(folder, arguments);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {complaint}");
    String::from_utf8(output.stdout).unwrap()
}

/// Numbers of a file, line by line, without its first ones.
fn numbers(csv: &str) -> Vec<[f64; 2]> {
    let row = |line: &str| {
        let (x, z) = line.split_once(',')?;
        Some([x.parse().ok()?, z.parse().ok()?])
    };
    csv.lines().filter_map(row).collect()
}

/// A sample of every format, made by the program itself; what its reading needs.
const ROUND_TRIPS: [(&str, &str, &[&str]); 8] = [
    ("miniprof", "rail.ban", &["--mirror"]),
    ("simpack", "rail.prr", &[]),
    ("gensys", "rail.rail", &[]),
    ("text", "rail.txt", &["--mirror", "false"]),
    ("miniprof", "wheel.whl", &[]),
    ("simpack", "wheel.prw", &[]),
    ("gensys", "wheel.wheel", &[]),
    ("csv", "wheel.csv", &[]),
];

#[test]
fn points_come_back_from_every_format_bit_for_bit() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    for (format, file, needed) in ROUND_TRIPS {
        let (name, side) = if file.starts_with("rail") { ("60E1", "rail") } else { ("S1002", "wheel") };
        let exact = numbers(&text(here, &["convert", name, "--to", "csv", "--step", "0.7"]));
        text(here, &["convert", name, "--to", format, "--step", "0.7", "--out", file]);
        let back = [&["convert", file, "--side", side, "--to", "csv"], needed].concat();
        let back = numbers(&text(here, &back));
        assert!(exact.len() > 150);
        assert_eq!(back, exact, "{file}");
    }
}

#[test]
fn simpack_wheels_descend_and_a_file_on_its_head_is_kept_by_its_definition_and_told_of() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let wheel = text(here, &["convert", "S1002", "--to", "simpack", "--out", "wheel.prw"]);
    assert!(wheel.is_empty());
    let file = std::fs::read_to_string(here.join("wheel.prw")).unwrap();
    let points = file.split("point.begin").nth(1).unwrap().split("point.end").next().unwrap();
    let y: Vec<f64> =
        points.lines().filter_map(|line| line.split_whitespace().next()?.parse().ok()).collect();
    assert!(
        y.len() > 500 && y[0] == 60.0 && *y.last().unwrap() == -70.0 && file.contains("inversion      =  0")
    );
    // The same file with z up: SIMPACK's definition holds, the flange that then points up is told of with the option.
    std::fs::write(here.join("up.prw"), file.replace("mirror.z       =  0", "mirror.z       =  1")).unwrap();
    let shown = text(here, &["show", "up.prw"]);
    assert!(shown.contains("z = -1 second") && shown.contains("finding    orientation"), "{shown}");
    assert!(shown.contains("it is kept, `--flip-z false` would change it"), "{shown}");
    let turned = text(here, &["show", "up.prw", "--flip-z", "false"]);
    assert!(turned.contains("z = 1 second") && !turned.contains("orientation"), "{turned}");
}

#[test]
fn segments_come_back_from_toml() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    for name in ["S1002", "60E1", "cone-1:20"] {
        text(here, &["convert", name, "--to", "toml", "--out", "once.toml"]);
        text(here, &["convert", "once.toml", "--to", "toml", "--out", "twice.toml"]);
        let [once, twice] =
            ["once.toml", "twice.toml"].map(|f| std::fs::read_to_string(here.join(f)).unwrap());
        assert!(once.contains(&format!("name = \"{name}\"")) && once.contains("[[segments]]"), "{once}");
        assert_eq!(once.lines().count(), twice.lines().count(), "{name}");
    }
    // A measured file becomes a chain of arcs within its tolerance.
    text(here, &["convert", "S1002", "--to", "simpack", "--step", "0.5", "--out", "wheel.prw"]);
    let arcs = wheelrail(
        here,
        &[
            "convert",
            "wheel.prw",
            "--side",
            "wheel",
            "--to",
            "toml",
            "--arc-tolerance",
            "0.01",
            "--curve",
            "arcs",
            "--out",
            "arcs.toml",
        ],
    );
    assert!(arcs.status.success() && String::from_utf8_lossy(&arcs.stderr).contains("arcs within 0.01 mm"));
    assert!(text(here, &["show", "arcs.toml"]).lines().filter(|line| line.contains(" arc ")).count() < 60);
}

#[test]
fn show_tells_how_a_measured_file_was_read_and_fitted() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    text(here, &["convert", "60E1", "--to", "miniprof", "--out", "rail.ban"]);
    let shown = text(here, &["show", "rail.ban", "--side", "rail", "--mirror", "--cutoff-wavelength", "3"]);
    for part in [
        "format     miniprof",
        "mirror: x = \u{2212}first axis, because of option",
        "cut-off wavelength 3 mm",
        "residual   largest ",
    ] {
        assert!(shown.contains(part), "no \"{part}\" in\n{shown}");
    }
    assert!(text(here, &["show", "60E1"]).contains("# joint"));
    // The file says of which body it is; a chain file is one by its extension in upper case too.
    assert_eq!(text(here, &["show", "rail.ban", "--mirror", "--cutoff-wavelength", "3"]), shown);
    let chain = r#"{"segments": [{"line": {"from": [0, 0], "to": [1, 0]}}]}"#;
    std::fs::write(here.join("chain.JSON"), chain).unwrap();
    assert!(text(here, &["show", "chain.JSON"]).contains(" line "));
}

#[test]
fn plots_have_their_panels_with_units() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    text(here, &["convert", "S1002", "--to", "csv", "--out", "wheel.csv"]);
    let measured = text(here, &["plot", "wheel.csv", "--side", "wheel"]);
    for part in ["x [mm]", "z [mm]", "residual [µm]", "curvature [1/m]", "arc length [mm]"] {
        assert!(measured.contains(part), "{part}");
    }
    text(here, &["plot", "60E1", "--out", "rail.svg"]);
    let drawn = std::fs::read_to_string(here.join("rail.svg")).unwrap();
    assert!(drawn.contains("curvature [1/m]") && !drawn.contains("residual"));
    text(here, &["plot", "60E1", "--out", "rail.PNG"]);
    assert!(std::fs::read(here.join("rail.PNG")).unwrap().starts_with(b"\x89PNG"));
    assert!(![measured, drawn].iter().any(|svg| svg.contains("NaN") || svg.contains("inf")));
}

#[test]
fn bad_input_ends_with_code_2_and_says_what_to_do() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let wheel: PathBuf = here.join("wheel.csv");
    text(here, &["convert", "S1002", "--to", "csv", "--out", "wheel.csv"]);
    std::fs::write(here.join("bad.csv"), "x,z\n1.0,2.0\n1.5,two\n").unwrap();
    let exact = std::fs::read(&wheel).unwrap();
    let cases: [(&[&str], &str); 17] = [
        (&["show", "nowhere"], "nowhere: found no file and no built-in profile; expected a file"),
        (&["show", "61E1"], "perhaps `60E1` is meant"),
        (&["show", "wheel.csv"], "wheel.csv: found no side; expected"),
        (&["show", "S1002", "--side", "rail"], "S1002: found the name of a wheel; expected"),
        (
            &["show", "S1002", "--unit", "mm", "--kink-angle", "1"],
            "S1002: found --unit, --kink-angle for a drawn",
        ),
        (
            &["convert", "wheel.csv", "--side", "wheel", "--to", "csv", "--out", "./wheel.csv"],
            "--out: found wheel.csv",
        ),
        (&["plot", "bad.csv", "--side", "wheel", "--out", "bad.csv"], "--out: found bad.csv, which"),
        (
            &["plot", "S1002", "--out", "wheel.pdf"],
            "--out: found \"wheel.pdf\"; expected a name that ends in .svg",
        ),
        (&["convert", "S1002", "--to", "foo"], "correct or remove it"),
        (
            &["show", "wheel.csv", "--side", "wheel", "--unit", "furlong"],
            "--unit: found `furlong`; expected one of m",
        ),
        (&["plot", "bad.csv", "--side", "wheel"], "bad.csv: line 3"),
        (&["convert", "S1002", "--to", "pdf"], "--to: found `pdf`; expected one of miniprof"),
        (&["convert", "S1002", "--to", "CSV"], "perhaps `csv` is meant"),
        (&["show", "wheel.csv", "--side", "Wheel", "--unit", "MM"], "perhaps `mm` is meant"),
        (
            &["show", "wheel.csv", "--side", "wheel", "--columns", "1"],
            "--columns: found \"1\"; expected two columns",
        ),
        (&["convert", "S1002", "--to", "csv", "--step", "-1"], "--step"),
        (
            &["convert", "wheel.csv", "--side", "wheel", "--curve", "smoothing", "--to", "toml"],
            "spline; expected a graph",
        ),
    ];
    for (arguments, message) in cases {
        let output = wheelrail(here, arguments);
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {complaint}");
        assert!(complaint.contains(message), "{arguments:?}: {complaint}");
    }
    assert_eq!(std::fs::read(&wheel).unwrap(), exact);
}

#[test]
fn messages_name_the_options_of_the_command_line_and_following_them_reads_the_file() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let row = |k: i32, z: f64| format!("{};{};{}\n", 1 + i32::from(z < 0.0), k, z - 0.01 * f64::from(k * k));
    let blocks: String = [0.0, -3.0].iter().flat_map(|z| (-25..30).map(move |k| row(k, *z))).collect();
    std::fs::write(here.join("blocks.csv"), format!("km;y [mm];z [mm]\n{blocks}")).unwrap();
    let output = wheelrail(here, &["show", "blocks.csv", "--side", "rail"]);
    let complaint = String::from_utf8_lossy(&output.stderr);
    for part in
        ["`--columns y,z`", "`--section 1` to `--section 2`", "`--mirror true` (", "`--mirror false` ("]
    {
        assert!(complaint.contains(part), "{part}: {complaint}");
    }
    assert!(!complaint.contains(" = "), "{complaint}");
    let given = ["--columns", "y,z", "--section", "2", "--mirror", "false"];
    let shown = text(here, &[&["show", "blocks.csv", "--side", "rail"], &given[..]].concat());
    assert!(shown.contains("points     55 read, 55 used") && shown.contains("line 1 of the file"), "{shown}");
    std::fs::write(here.join("list.txt"), "153.28 nose-1.prr\n153.31 nose-2.prr\n").unwrap();
    let output = wheelrail(here, &["show", "list.txt", "--side", "rail"]);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains("line 1: found a position and the file of a slice"), "{complaint}");
}

#[test]
fn former_names_of_rails_are_known_and_listed() {
    let here = TempDir::new().unwrap();
    assert!(text(here.path(), &["list"]).contains("\nrail   UIC54                    54E1 of EN 13674-1"));
    let [former, today] = ["UIC54", "54E1"].map(|name| text(here.path(), &["convert", name, "--to", "csv"]));
    assert_eq!(former, today);
}

#[test]
fn what_killed_conversions_leave_goes_with_the_next_one() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let arguments = ["convert", "60E1", "--to", "csv", "--step", "0.001", "--out", "rail.csv"];
    let start = std::time::Instant::now();
    text(here, &arguments);
    let (duration, exact) = (start.elapsed(), std::fs::read(here.join("rail.csv")).unwrap());
    for k in 0..40 {
        let binary = env!("CARGO_BIN_EXE_wheelrail");
        let mut child =
            Command::new(binary).current_dir(here).arg("profile").args(arguments).spawn().unwrap();
        std::thread::sleep(duration * k / 40);
        let _ = child.kill();
        let _ = child.wait();
        assert_eq!(
            std::fs::read(here.join("rail.csv")).unwrap(),
            exact,
            "neither the old file nor the new one"
        );
    }
    std::fs::write(here.join(".wheelrail-tmp.rail.csv.1.0"), "half").unwrap();
    text(here, &arguments);
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 1);
}
