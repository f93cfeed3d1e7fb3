//! `wheelrail profile measure` through the binary: columns, rows of bad files, limits.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;
use wheelrail::internal::Random;

use crate::campaign::scenes;
use crate::whole_rails::{Scan, built_in, drawn_at_random, motion};

fn measure(folder: &Path, arguments: &[&str]) -> Output {
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    Command::new(binary).current_dir(folder).args(["profile", "measure"]).args(arguments).output().unwrap()
}

/// stdout of a call that must end with this exit code.
fn text(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = measure(folder, arguments);
    assert_eq!(
        output.status.code(),
        Some(code),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn csv_and_json_have_the_same_columns_and_bad_files_are_rows() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fs::write(here.join("bad.whl"), "no numbers").unwrap();
    let files = ["S1002", "60E1", "bad.whl", "nowhere"];
    let csv = text(here, &[&files[..], &["--csv"]].concat(), 1);
    let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let first =
        ["file", "kind", "flange_height_mm", "flange_thickness_mm", "qr_mm", "w1_mm", "w2_mm", "w3_mm"];
    assert_eq!((&header[..8], header[header.len() - 1]), (&first[..], "finding"));
    let json: Vec<Value> = serde_json::from_str(&text(here, &[&files[..], &["--json"]].concat(), 1)).unwrap();
    let mut read = csv::Reader::from_reader(csv.as_bytes());
    for (row, (object, file)) in read.records().zip(json.iter().zip(files)) {
        let object = object.as_object().unwrap();
        assert!(object.keys().map(String::as_str).eq(header.iter().copied()));
        for (cell, value) in row.unwrap().iter().zip(object.values()) {
            assert_eq!(
                cell,
                value.as_str().map_or_else(|| value.to_string().replace("null", ""), String::from)
            );
        }
        assert_eq!(object["file"], *file);
    }
    assert!((json[0]["flange_height_mm"].as_f64().unwrap() - 28.0).abs() < 1e-6);
    assert!(json[0]["w1_mm"].is_null() && json[0]["finding"].is_null(), "{}", json[0]);
    assert_eq!((&json[1]["kind"], json[2]["qr_mm"].is_null()), (&Value::from("rail"), true));
    assert!(json[2]["finding"].as_str().unwrap().starts_with("bad.whl"), "{}", json[2]);
    assert!(json[3]["finding"].as_str().unwrap().contains("no file and no built-in profile"), "{}", json[3]);
}

#[test]
fn limits_mark_rows_and_fail_where_they_are_asked_to() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fs::write(here.join("l.toml"), "flange_height_mm = { min = 27.5, max = 27.9 }\nw1_mm = { max = 1.0 }\n")
        .unwrap();
    let with = |more: &[&str], code| text(here, &[&["S1002", "--limits", "l.toml"], more].concat(), code);
    assert!(with(&[], 0).contains("S1002: limit: flange_height_mm 28.000 above 27.9\n"));
    assert!(with(&["--fail", "--csv"], 1).contains(",flange_height_mm 28.000 above 27.9,"));
    // W1 cannot be had without a nominal.
    assert!(text(here, &["60E1", "--limits", "l.toml", "--fail"], 1).contains("limit: w1_mm not measured"));
    text(here, &["60E1", "--nominal", "60E1", "--limits", "l.toml", "--fail"], 0);
    for (limits, expected) in [
        (
            "flange_hight_mm = { min = 1.0 }",
            "l.toml: flange_hight_mm: found no quantity; expected one of flange_height_mm",
        ),
        ("w1_mm = { }", "l.toml: w1_mm: found no limit"),
        ("w1_mm = { min = 2.0, max = 1.0 }", "l.toml: w1_mm: found min 2 above max 1"),
        ("w1_mm = { least = 2.0 }", "least"),
    ] {
        fs::write(here.join("l.toml"), limits).unwrap();
        let output = measure(here, &["S1002", "--limits", "l.toml"]);
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && complaint.contains(expected), "{limits}: {complaint}");
    }
}

#[test]
fn a_picture_shows_both_profiles_and_their_differences() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    text(here, &["54E1", "--nominal", "60E1", "--align", "field-side", "--picture", "o.svg"], 0);
    let svg = fs::read_to_string(here.join("o.svg")).unwrap();
    assert!(svg.contains("nominal 60E1") && svg.contains("× 5; the largest is 1.997 mm"), "{svg}");
    assert_eq!(svg, include_str!("../../../../src/docs/overlay.svg"), "draw the picture of the page anew");
    for arguments in [
        &["54E1", "60E1", "--nominal", "60E1", "--picture", "o.svg"][..],
        &["54E1", "--picture", "o.svg"],
        &["54E1", "--nominal", "60E1", "--picture", "o.jpg"],
        &["54E1", "--nominal", "60E1", "--out", "o.svg", "--picture", "o.svg"],
    ] {
        assert_eq!(measure(here, arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn a_page_walks_through_all_files_the_bad_ones_too() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fs::write(here.join("bad.ban"), "no numbers").unwrap();
    text(here, &["54E1", "bad.ban", "60E1", "--nominal", "60E1", "--html", "m.html"], 1);
    let page = fs::read_to_string(here.join("m.html")).unwrap();
    let data = page.split_once("application/json\">").unwrap().1.split_once("</script>").unwrap().0;
    let data: Value = serde_json::from_str(data).unwrap();
    let files = data["files"].as_array().unwrap();
    let names: Vec<&str> = files.iter().map(|file| file["name"].as_str().unwrap()).collect();
    assert_eq!((names, data["about"].as_str()), (vec!["54E1", "bad.ban", "60E1"], Some("nominal 60E1")));
    let drawn = |k: usize| !files[k]["differences"].as_str().unwrap().is_empty();
    assert_eq!([0, 1, 2].map(drawn), [true, false, true]);
    assert!(
        files[1]["findings"][0].as_str().unwrap().starts_with("bad.ban")
            && files[2]["measures"].as_array().unwrap().len() > 3
    );
    assert_eq!(measure(here, &["54E1", "--out", "m.html", "--html", "m.html"]).status.code(), Some(2));
}

#[test]
fn wheels_given_as_rails_and_wrong_options_say_what_is_wrong() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let made = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .current_dir(here)
        .args(["profile", "convert", "S1002", "--to", "text", "--out", "w.txt"])
        .status();
    assert!(made.unwrap().success());
    let found = |arguments: &[&str], code| text(here, arguments, code);
    assert!(found(&["w.txt", "--side", "wheel"], 0).contains("flange_height_mm"));
    // By its shape the file is a wheel; told otherwise, there is no rail in it.
    assert!(found(&["w.txt", "--side", "rail"], 1).contains("finding: w.txt"));
    let forced = found(&["w.txt", "--side", "rail", "--mirror", "false", "--flip-z", "false", "--json"], 0);
    let forced: Vec<Value> = serde_json::from_str(&forced).unwrap();
    assert!(forced[0]["finding"].as_str().unwrap().contains("no crown_radius_mm"), "{forced:?}");
    assert!(found(&["w.txt", "--side", "wheel", "--nominal", "60E1"], 2).is_empty());
    assert!(
        found(&["S1002", "--nominal", "60E1"], 1).contains("S1002: found a wheel beside a rail as nominal")
    );
    assert!(found(&["S1002", "--align", "web"], 1).contains("\"web\" for a wheel"));
    let wrong: [&[&str]; 5] = [
        &["S1002", "--align", "wep"],
        &["S1002", "--unworn", "3"],
        &["S1002", "--fail"],
        &["S1002", "--csv", "--json"],
        &["S1002", "--nominal", "nowhere"],
    ];
    for arguments in wrong {
        assert!(found(arguments, 2).is_empty());
    }
}

#[test]
fn noise_gives_every_quantity_an_interval_in_columns_at_the_end() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let noise = ["S1002", "nowhere", "--noise", "0.02", "--samples", "40", "--seed", "7"];
    let plain = text(here, &["S1002", "nowhere", "--csv"], 1);
    let csv = text(here, &[&noise[..], &["--csv"]].concat(), 1);
    let [before, after] = [&plain, &csv].map(|text| text.lines().next().unwrap().to_owned());
    assert!(
        after.starts_with(&format!("{before},flange_height_mm_samples,flange_height_mm_mean,")),
        "{after}"
    );
    let rows: Vec<Value> = serde_json::from_str(&text(here, &[&noise[..], &["--json"]].concat(), 1)).unwrap();
    let [wheel, nowhere] = [&rows[0], &rows[1]].map(|row| row.as_object().unwrap());
    assert!(wheel.keys().map(String::as_str).eq(after.split(',')) && nowhere.len() == wheel.len());
    // Under this noise Sd is the least sharp: X = 0 is the leftmost of noisy points.
    for (key, most) in
        [("flange_height_mm", 0.15), ("flange_thickness_mm", 1.0), ("qr_mm", 0.3), ("flange_width_mm", 0.2)]
    {
        let number = |end: &str| wheel[&format!("{key}{end}")].as_f64().unwrap();
        assert!(number("_low") < number("_mean") && number("_mean") < number("_high"), "{key}");
        assert!(number("_low_error") > 0.0 && number("_high") - number("_low") < most, "{key}");
        assert!(nowhere[&format!("{key}_low")].is_null());
    }
    assert_eq!(wheel["flange_height_mm_samples"], 40);
    let table = text(here, &noise, 1);
    assert!(
        table.contains("S1002: spread: noise of 0.02 mm of points every 0.2 mm; 40 samples of seed 7\n"),
        "{table}"
    );
    assert_eq!(table, text(here, &noise, 1));
    text(here, &[&noise[..], &["--html", "m.html"]].concat(), 1);
    let page = fs::read_to_string(here.join("m.html")).unwrap();
    assert!(page.contains("intervals: noise of 0.02 mm") && page.contains(" to\u{a0}28."));
    for wrong in [
        &["S1002", "--noise", "-0.02"][..],
        &["S1002", "--noise", "0.02", "--samples", "39"],
        &["S1002", "--samples", "100"],
        &["S1002", "S1002", "--noise", "0.02", "--repeats"],
    ] {
        assert_eq!(measure(here, wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn repeats_have_a_last_row_with_their_mean_and_interval() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let points =
        wheelrail::measured::write::sample(&wheelrail::standards::wheel("S1002").unwrap(), 0.2).unwrap();
    for (name, high) in [("a", -0.1), ("b", 0.0), ("c", 0.1)] {
        // The flange grows, the tread stays.
        let grown = |x: f64, z: f64| if x < -20.0 { z - high } else { z };
        let rows: Vec<String> = points.iter().map(|&[x, z]| format!("{x} {}\n", grown(x, z))).collect();
        fs::write(here.join(format!("{name}.txt")), rows.concat()).unwrap();
    }
    let files = ["a.txt", "b.txt", "c.txt", "--side", "wheel", "--repeats"];
    let rows: Vec<Value> = serde_json::from_str(&text(here, &[&files[..], &["--json"]].concat(), 0)).unwrap();
    assert_eq!((rows.len(), rows[3]["file"].as_str()), (4, Some("mean of 3 repeats")));
    let number = |key: &str| rows[3][key].as_f64().unwrap();
    assert!((number("flange_height_mm") - 28.0).abs() < 0.01, "{}", rows[3]);
    assert!((number("flange_height_mm_deviation") - 0.1).abs() < 1e-3, "{}", rows[3]);
    // Student's t of two degrees of freedom, and one further measurement.
    let reach = 4.302_653 * 0.1 * (4.0f64 / 3.0).sqrt();
    assert!((number("flange_height_mm_high") - 28.0 - reach).abs() < 0.02, "{}", rows[3]);
    assert!(rows[0]["flange_height_mm_low"].is_null());
    let table = text(here, &files, 0);
    assert!(table.contains("mean of 3 repeats: spread: over the repeats"), "{table}");
    text(here, &[&files[..], &["--html", "m.html"]].concat(), 0);
    // A file that cannot be measured is a row, and the others are the repeats.
    fs::write(here.join("bad.txt"), "no numbers").unwrap();
    let bad = ["a.txt", "bad.txt", "c.txt", "--side", "wheel", "--repeats"];
    assert!(text(here, &bad, 1).contains("mean of 2 repeats"));
    for wrong in [&["S1002", "--repeats"][..], &["S1002", "60E1", "--repeats"]] {
        assert_eq!(measure(here, wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn an_average_is_a_profile_with_its_spread() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let average = |arguments: &[&str]| {
        let binary = env!("CARGO_BIN_EXE_wheelrail");
        Command::new(binary).current_dir(here).args(["profile", "average"]).args(arguments).output().unwrap()
    };
    // Worn by 0, 0.1 and 0.5 mm over 20 mm of the tread, and displaced.
    let whole =
        wheelrail::measured::write::sample(&wheelrail::standards::wheel("S1002").unwrap(), 0.2).unwrap();
    for (k, depth) in [0.0, 0.1, 0.5].into_iter().enumerate() {
        let bump = |x: f64| {
            if x.abs() < 10.0 {
                depth * (0.1 * std::f64::consts::PI * x).cos().mul_add(0.5, 0.5)
            } else {
                0.0
            }
        };
        let shift = 3.0 * k as f64;
        let rows: Vec<String> =
            whole.iter().map(|[x, z]| format!("{} {}\n", x + shift, z + bump(*x) - shift)).collect();
        fs::write(here.join(format!("w{k}.txt")), rows.concat()).unwrap();
    }
    let files = ["w0.txt", "w1.txt", "w2.txt", "--side", "wheel"];
    let arguments =
        ["--nominal", "S1002", "--out", "mean.txt", "--band", "band.csv", "--picture", "band.svg"];
    let output = average(&[&files[..], &arguments].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut band = csv::Reader::from_path(here.join("band.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        band.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect()).collect();
    let at = |x: f64| rows.iter().min_by(|a, b| (a[0] - x).abs().total_cmp(&(b[0] - x).abs())).unwrap();
    // On the tread the mean of 0, 0.1 and 0.5; beyond it nothing.
    let (worn, unworn) = (at(0.0), at(30.0));
    assert!((worn[1] - 0.2).abs() < 0.01 && (worn[2] - 0.2646).abs() < 0.01, "{worn:?}");
    assert!((worn[3] + 0.2).abs() < 0.01 && (worn[4] - 0.3).abs() < 0.01 && worn[5] == 3.0, "{worn:?}");
    assert!(unworn[2] < 0.01, "{unworn:?}");
    assert!(fs::read_to_string(here.join("band.svg")).unwrap().contains("average of 3 profiles"));
    // The file is a wheel like any other.
    assert!(text(here, &["mean.txt", "--side", "wheel"], 0).contains("flange_height_mm"));
    for arguments in [
        &["S1002"][..],
        &["S1002", "60E1"],
        &["w0.txt", "w1.txt"],
        &["S1002", "S1002", "--out", "o.xyz", "--to", "xyz"],
    ] {
        assert_eq!(average(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

/// A file of the tests beside a folder of this package.
fn of_tests(file: &str) -> String {
    format!("{}/../../{file}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn what_lies_in_a_gap_has_no_value_but_a_finding() {
    let folder = TempDir::new().unwrap();
    let file = of_tests("tests/defects/measure-gap-tip.txt");
    let arguments = [&file, "--side", "wheel", "--mirror", "false", "--json"];
    for nominal in [&[][..], &["--nominal", "S1002"]] {
        let rows = text(folder.path(), &[&arguments[..], nominal].concat(), 0);
        let rows: Vec<Value> = serde_json::from_str(&rows).unwrap();
        let row = &rows[0];
        assert!(row["flange_height_mm"].is_null() && row["qr_mm"].is_null(), "{row}");
        assert!((row["flange_thickness_mm"].as_f64().unwrap() - 32.5).abs() < 0.01, "{row}");
        assert!(row["finding"].as_str().unwrap().contains("no flange tip: a gap of the points"), "{row}");
    }
}

#[test]
fn a_nominal_file_takes_the_options_that_its_own_leaves_open() {
    let folder = TempDir::new().unwrap();
    let file = of_tests("examples/profiles/60E1.ban");
    let rows = text(folder.path(), &[&file, "--mirror", "--nominal", &file, "--json"], 0);
    let rows: Vec<Value> = serde_json::from_str(&rows).unwrap();
    assert!(rows[0]["w1_mm"].as_f64().unwrap().abs() < 1e-6 && rows[0]["finding"].is_null(), "{}", rows[0]);
    // A head that is the same from both sides leaves nothing open; one whose gauge corner is worn asks for its side.
    text(folder.path(), &["60E1", "--nominal", &file], 0);
    let worn = |x: f64, z: f64| format!("{x} {}\n", if x < -20.0 { z - 0.2 * (x + 20.0).abs() } else { z });
    let points = fs::read_to_string(&file).unwrap();
    let rows = points.lines().filter_map(|line| line.split_once(' '));
    let numbers = rows.filter_map(|(x, z)| Some(worn(x.parse().ok()?, z.trim().parse().ok()?)));
    fs::write(folder.path().join("worn.txt"), numbers.collect::<String>()).unwrap();
    let asked = measure(folder.path(), &["60E1", "--side", "rail", "--nominal", "worn.txt"]);
    let complaint = String::from_utf8_lossy(&asked.stderr).into_owned();
    assert!(asked.status.code() == Some(2) && complaint.contains("--mirror"), "{complaint}");
    // A built-in nominal has no question.
    text(folder.path(), &[&file, "--mirror", "--nominal", "60E1"], 0);
}

/// The text of points, none nearer to the one before than `nearest` \[mm\].
fn points(all: &[[f64; 2]], nearest: f64) -> String {
    let mut last: Option<[f64; 2]> = None;
    let mut text = String::new();
    for at in all {
        if last.is_none_or(|last| (last[0] - at[0]).hypot(last[1] - at[1]) > nearest) {
            text += &format!("{:.5} {:.5}\n", at[0], at[1]);
            last = Some(*at);
        }
    }
    text
}

/// Random scans of one side against a file of the whole rail: fitted by the web to what moved them, with the wear that they have, or
/// refused with a finding.
#[test]
fn a_scan_of_one_side_is_fitted_by_the_web_of_a_nominal_file() {
    let count = scenes().div_ceil(4);
    let (mut fitted, mut wrong) = (0, Vec::new());
    for number in 0..count {
        let mut random = Random::stream(6507, number);
        let name = *random.pick(&["60E1", "UIC60", "", ""]);
        let outline = if name.is_empty() { drawn_at_random(&mut random) } else { built_in(name).unwrap() };
        let scan = Scan::random(&mut random);
        let folder = TempDir::new().unwrap();
        let worn: Vec<[f64; 2]> = outline.iter().map(|at| scan.worn(*at)).collect();
        let scanned = scan.points(&outline, &mut random);
        for (file, all) in [("whole.txt", &outline), ("worn.txt", &worn), ("scan.txt", &scanned)] {
            fs::write(folder.path().join(file), points(all, 0.18)).unwrap();
        }
        let options = ["--side", "rail", "--mirror", "false", "--flip-z", "false", "--nominal", "whole.txt"];
        let w1 = |file, align| {
            let text = text(folder.path(), &[&[file, "--align", align, "--json"], &options[..]].concat(), 0);
            let row = serde_json::from_str::<Vec<Value>>(&text).unwrap().swap_remove(0);
            [row["w1_mm"].as_f64(), row["w1_mm_if_off"].as_f64()]
        };
        let said = text(folder.path(), &[&["scan.txt", "--align", "web"], &options[..]].concat(), 0);
        let by_web = said.lines().find(|line| line.contains("alignment: web"));
        let Some(found) = by_web.and_then(motion) else {
            if !said.contains("finding: ") {
                wrong.push(format!("{number}: {said}"));
            }
            continue;
        };
        fitted += 1;
        let off = [0, 1, 2].map(|k| (found[k] - scan.motion[k]).abs());
        let wear = w1("scan.txt", "web").into_iter().chain(w1("worn.txt", "none")).collect::<Vec<_>>();
        let kept = match wear[..] {
            [Some(own), if_off, Some(exact), _] => if_off.is_some_and(|off| (own - exact).abs() <= 3.0 * off),
            _ => true,
        };
        // The origin lies as far from the web as the top does: a turn moves it.
        if !kept || off[2] > 0.1 || off[0].max(off[1]) > 0.3 {
            wrong.push(format!("{number}: {off:?} {wear:?} {scan:?}\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{} wrong of {count}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(10 * fitted >= 8 * count, "{fitted} of {count} fitted");
}

#[test]
fn a_verdict_is_the_same_with_and_without_a_nominal() {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return };
    let folder = TempDir::new().unwrap();
    let file = Path::new(&contact).join("testbank/profiles/whl_left_iter795.whl");
    let limits = of_tests("tests/defects/measure-limits.toml");
    let arguments = [file.to_str().unwrap(), "--limits", &limits, "--json"];
    let rows = |more: &[&str]| -> Value {
        let rows = text(folder.path(), &[&arguments[..], more].concat(), 0);
        serde_json::from_str::<Vec<Value>>(&rows).unwrap()[0].clone()
    };
    let (alone, on_nominal) = (rows(&[]), rows(&["--nominal", "S1002"]));
    for (key, header) in [("flange_height_mm", 34.9985), ("flange_thickness_mm", 34.3347), ("qr_mm", 10.0658)]
    {
        assert_eq!(alone[key], on_nominal[key]);
        assert!((alone[key].as_f64().unwrap() - header).abs() < 0.05, "{alone}");
    }
    assert_eq!(alone["limits"], on_nominal["limits"]);
    let finding = on_nominal["finding"].as_str().unwrap();
    assert!(finding.contains("residual") || finding.contains("off the nominal by"), "{finding}");
}
