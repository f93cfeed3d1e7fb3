//! What `run` says of its results, and the commands of the first hour: `init`, `completions`, `man`.

use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

const SCENE: &str = "title = \"Two contacts\"\n[rail]\nprofile = \"UIC60\"\nrotate = \"1:20\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                     [track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = 5.5\n\
                     [patch]\nload = 60000.0\n[output]\nformats = [\"npy\"]\n";

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).current_dir(folder).args(arguments).output().unwrap()
}

/// Returns what a call that succeeds writes to stdout.
fn said(folder: &Path, arguments: &[&str]) -> String {
    let output = wheelrail(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_run_says_what_it_found_and_wrote() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    std::fs::write(here.join("scene.toml"), SCENE).unwrap();
    let table = said(here, &["run", "scene.toml"]);
    assert!(table.starts_with("Two contacts\n") && table.ends_with("output/scene\n"), "{table}");
    let summary: serde_json::Value =
        serde_json::from_slice(&std::fs::read(here.join("output/scene/summary.json")).unwrap()).unwrap();
    let row = |label: &str| {
        let line = table.lines().find(|line| line.starts_with(label));
        line.unwrap_or_else(|| panic!("no {label}: {table}"))[26..].to_owned()
    };
    for (label, key, scale, digits) in [
        ("approach, mm", "approach_mm", 1.0, 5),
        ("normal force, kN", "normal_load_n", 1e-3, 3),
        ("rolling radius, mm", "rolling_radius_mm", 1.0, 3),
    ] {
        let value = format!("{:.*}", digits, scale * summary[key].as_f64().unwrap());
        assert_eq!(row(label).split_whitespace().next(), Some(value.as_str()), "{label}");
    }
    // Every file is named with its size.
    for entry in std::fs::read_dir(here.join("output/scene")).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_file() {
            let name = entry.file_name().into_string().unwrap();
            assert!(table.contains(&format!("{name} ")), "{name}: {table}");
        }
    }
    assert_eq!(said(here, &["run", "scene.toml", "--quiet"]), "");
}

#[test]
fn a_run_answers_programs_in_json() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    std::fs::write(here.join("scene.toml"), SCENE).unwrap();
    let answer: serde_json::Value =
        serde_json::from_str(&said(here, &["run", "scene.toml", "--json"])).unwrap();
    assert_eq!((&answer["folder"], &answer["outcome"]), (&"output/scene".into(), &"done".into()));
    let contacts = answer["contacts"].as_array().unwrap();
    assert!(contacts.len() >= 2, "{}", contacts.len());
    for contact in contacts {
        let part = here.join("output/scene").join(contact["folder"].as_str().unwrap());
        let written: serde_json::Value =
            serde_json::from_slice(&std::fs::read(part.join("summary.json")).unwrap()).unwrap();
        assert_eq!(contact["summary"]["contact_to_track"], written["contact_to_track"]);
        for (name, size) in contact["file_sizes_bytes"].as_object().unwrap() {
            assert_eq!(std::fs::metadata(part.join(name)).unwrap().len(), size.as_u64().unwrap(), "{name}");
        }
    }
}

#[test]
fn the_first_scene_is_written_once_and_runs_without_a_warning() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let next = said(here, &["init"]);
    assert!(next.contains("wheelrail run scene.toml"), "{next}");
    let run = wheelrail(here, &["run", "scene.toml"]);
    let warned = String::from_utf8_lossy(&run.stderr).contains("warning");
    assert!(run.status.success() && !warned, "{}", String::from_utf8_lossy(&run.stderr));
    let again = wheelrail(here, &["init"]);
    let complaint = String::from_utf8_lossy(&again.stderr).into_owned();
    assert_eq!(again.status.code(), Some(2));
    assert!(complaint.contains("scene.toml: found a file that exists already; expected a name that is free"));
    // What its comments offer can be taken: every line that is commented out is TOML, with keys that are known.
    let text = std::fs::read_to_string(here.join("scene.toml")).unwrap();
    let other = text.replace("[contact]", "#[contact]").replace("offset = 0.0", "#");
    let taken: Vec<String> = other.lines().map(|line| uncommented(line).to_owned()).collect();
    std::fs::write(here.join("all.toml"), taken.join("\n")).unwrap();
    let run = wheelrail(here, &["run", "all.toml"]);
    assert!(run.status.success(), "{}\n{}", String::from_utf8_lossy(&run.stderr), taken.join("\n"));
}

/// Returns a line without its comment sign if it is a table or a key with a value, but for keys that exclude others.
fn uncommented(line: &str) -> &str {
    let Some(rest) = line.strip_prefix("# ") else { return line };
    let is_key = rest.split_once(" = ").is_some_and(|(key, _)| !key.contains(' '));
    let excluded = rest.starts_with("yaw") || rest.starts_with("mirror");
    if (rest.starts_with('[') || is_key) && !excluded { rest } else { line }
}

#[test]
fn shells_and_the_manual_know_every_command() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let help = said(here, &["--help"]);
    assert!(help.starts_with("Finds where a railway wheel touches its rail"), "{help}");
    assert!(said(here, &["--version"]).starts_with("wheelrail "));
    let listed = help.split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap();
    let commands: Vec<&str> = listed
        .lines()
        .filter_map(|line| line.strip_prefix("  ").filter(|rest| !rest.starts_with(' ')))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(commands.contains(&"run") && commands.contains(&"profile"), "{commands:?}");
    for shell in ["bash", "zsh", "fish"] {
        let text = said(here, &["completions", shell]);
        assert!(commands.iter().all(|command| text.contains(command)), "{shell}");
        assert!(text.contains("wheelrail") && !text.contains("wheelrail-cli"), "{shell}");
    }
    said(here, &["man", "--out", "pages/man1"]);
    let page = |name: &str| std::fs::read_to_string(here.join("pages/man1").join(name)).unwrap();
    for command in commands.into_iter().filter(|command| *command != "help") {
        assert!(page(&format!("wheelrail-{command}.1")).contains(".TH"), "{command}");
    }
    assert!(page("wheelrail-sweep.1").contains("lateral"), "options of commands are in the manual");
    let every: String = std::fs::read_dir(here.join("pages/man1"))
        .unwrap()
        .map(|entry| page(entry.unwrap().file_name().to_str().unwrap()))
        .collect();
    assert_eq!(said(here, &["man"]).len(), every.len(), "on stdout are the pages of the files");
    for named in every.replace("\\-", "-").split("(1)").filter_map(|before| before.split_whitespace().last())
    {
        if named.starts_with("wheelrail") {
            page(&format!("{named}.1"));
        }
    }
}
