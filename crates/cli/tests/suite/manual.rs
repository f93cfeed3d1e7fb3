//! The manual: its pages are in order, their links lead somewhere, and every command, scene and picture of them is of today.

use crate::programs::folder;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The pages: those of SUMMARY.md, in its order, and the README.
fn pages() -> Vec<PathBuf> {
    let docs = Path::new(ROOT).join("src/docs");
    let summary = std::fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    let named = summary.lines().filter_map(|line| line.split("](").nth(1)?.strip_suffix(')'));
    named.map(|name| docs.join(name)).chain([Path::new(ROOT).join("README.md")]).collect()
}

/// The fenced blocks of a page in one language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut fence: Option<bool> = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), fence) {
            (Some(_), Some(_)) => fence = None,
            (Some(begins), None) => {
                fence = Some(begins == language);
                if begins == language {
                    found.push(String::new());
                }
            }
            (None, Some(true)) => found.iter_mut().last().unwrap().extend([line, "\n"]),
            _ => {}
        }
    }
    found
}

/// A folder of a test's own for a page, with the examples in it.
#[cfg(unix)]
fn page_folder(test: &str, page: &Path) -> PathBuf {
    let here = folder(test).join(page.file_stem().unwrap());
    let _ = std::fs::remove_dir_all(&here);
    std::fs::create_dir_all(&here).unwrap();
    std::os::unix::fs::symlink(
        Path::new(ROOT).canonicalize().unwrap().join("examples"),
        here.join("examples"),
    )
    .unwrap();
    here
}

/// The command line that a line of a page gives; `None` for one of other programs.
#[cfg(unix)]
fn command(line: &str) -> Option<String> {
    let line = line.replace("cargo run --release -- ", "wheelrail ");
    line.starts_with("wheelrail ").then_some(line)
}

#[test]
fn every_page_is_in_the_summary_and_begins_with_what_it_is_for() {
    let pages = pages();
    for file in std::fs::read_dir(Path::new(ROOT).join("src/docs")).unwrap().flatten() {
        let name = file.file_name().into_string().unwrap();
        if name.ends_with(".md") && name != "SUMMARY.md" {
            assert!(pages.iter().any(|page| page.ends_with(&name)), "{name} is not in src/docs/SUMMARY.md");
            let text = std::fs::read_to_string(file.path()).unwrap();
            let begin = text.lines().nth(2).unwrap_or_default();
            assert!(begin.starts_with("*After this page you can "), "{name} begins with: {begin}");
            let module = format!("include_str!(\"{name}\")");
            assert!(
                include_str!("../../../../src/docs/mod.rs").contains(&module),
                "{name} is not in src/docs/mod.rs"
            );
        }
    }
}

#[test]
fn every_link_of_the_manual_leads_to_a_file() {
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            let is_path = target.contains('.') && !target.contains("://") && !target.contains(' ');
            let there = page.parent().unwrap().join(target).exists();
            assert!(!is_path || there, "{}: {target} does not exist", page.display());
        }
    }
}

#[test]
fn every_command_is_on_the_page_of_commands() {
    let pages = folder("man");
    wheelrail(Path::new(ROOT), &["man", "--out", pages.to_str().unwrap()]);
    let page = include_str!("../../../../src/docs/commands.md");
    let rows: String =
        page.lines().filter_map(|line| line.strip_prefix("| `")?.split(" | ").next()).collect();
    for file in std::fs::read_dir(pages).unwrap().flatten() {
        let name = file.file_name().into_string().unwrap();
        let name = name.strip_suffix(".1").unwrap().trim_start_matches("wheelrail").replace('-', " ");
        let last = name.rsplit(' ').next().unwrap();
        assert!(rows.contains(&format!("wheelrail{name}")) || rows.contains(&format!("`{last}")), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn every_command_of_the_manual_runs() {
    let program = Path::new(env!("CARGO_BIN_EXE_wheelrail")).parent().unwrap().display().to_string();
    let path = format!("{program}:{}", std::env::var("PATH").unwrap());
    let mut run = 0;
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        let commands: Vec<String> = blocks(&text, "sh")
            .iter()
            .flat_map(|block| block.lines().filter_map(command).collect::<Vec<_>>())
            .collect();
        let here = if commands.is_empty() { continue } else { page_folder("commands of pages", &page) };
        for command in commands {
            let output = Command::new("sh")
                .args(["-c", &command])
                .env("PATH", &path)
                .current_dir(&here)
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {command}\n{said}", page.display());
            run += 1;
        }
    }
    assert!(run > 15, "only {run} commands were found");
}

#[cfg(unix)]
#[test]
fn every_scene_and_profile_of_the_manual_is_accepted() {
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for (k, block) in blocks(&text, "toml").iter().enumerate() {
            let value: toml::Table =
                block.parse().unwrap_or_else(|error| panic!("{}: {error}", page.display()));
            let is_scene = ["rail", "wheel", "patch"].iter().all(|key| value.contains_key(*key));
            let arguments: &[&str] = if is_scene {
                &["midsep", "block.toml"]
            } else if value.contains_key("segments") {
                &["profile", "show", "block.toml", "--side", "rail"]
            } else {
                continue;
            };
            let here = page_folder("scenes of pages", &page);
            std::fs::write(here.join("block.toml"), block).unwrap();
            let output = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
                .args(arguments)
                .current_dir(here)
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}, block {k}: {said}", page.display());
        }
    }
}

/// What a picture says, line by line.
fn words(svg: &str) -> Vec<&str> {
    let texts = svg.split("<text ").skip(1);
    texts.filter_map(|text| text.split('>').nth(1)?.split('<').next()).collect()
}

/// Runs the program in a folder, which has to be content.
fn wheelrail(here: &Path, arguments: &[&str]) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    let output = program.args(arguments).current_dir(here).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Makes the picture of a scene in a folder; gives what was made, and what the repository has of it.
fn pictured(scene: &str, name: &str, here: &Path) -> [PathBuf; 2] {
    let kept = Path::new(ROOT).join(format!("output/pictures/scenes/{name}.svg"));
    let marches = [
        ("crossing", ["--along", "-100:300:2"], "along_track.svg"),
        ("wheel_flat", ["--angle", "-0.1:0.1:0.001"], "around_the_wheel.svg"),
    ];
    if let Some((_, range, kept)) = marches.into_iter().find(|(march, ..)| *march == name) {
        let files = ["--out", "march.csv", "--picture", "march.svg"];
        wheelrail(here, &[&["march", scene][..], &range, &files].concat());
        return [here.join("march.svg"), Path::new(ROOT).join("src/docs").join(kept)];
    }
    wheelrail(here, &["run", scene, "--out", "run"]);
    let made = ["conformal.svg", "patch.svg"].map(|file| here.join("run").join(file));
    [made.into_iter().find(|file| file.exists()).unwrap(), kept]
}

/// The scenes of the gallery's table with their names.
fn gallery() -> Vec<(String, String)> {
    let page = std::fs::read_to_string(Path::new(ROOT).join("src/docs/gallery-of-scenes.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| ["));
    let paths = rows.filter_map(|line| line.rsplit("](../../").next()?.split(')').next());
    let root = Path::new(ROOT).canonicalize().unwrap();
    let scene = |path: &str| {
        let name = Path::new(path).file_stem().unwrap().to_str().unwrap();
        (root.join(path).display().to_string(), name.to_owned())
    };
    paths.map(scene).collect()
}

/// A folder of a scene's own.
fn gallery_folder(name: &str) -> PathBuf {
    let here = folder("gallery").join(name);
    let _ = std::fs::remove_dir_all(&here);
    std::fs::create_dir_all(&here).unwrap();
    here
}

/// Whether the pictures of the manual are to be made anew.
fn anew() -> bool {
    std::env::var_os("WHEELRAIL_PICTURES").is_some()
}

#[test]
fn pictures_of_the_gallery_are_of_today() {
    let scenes = gallery();
    assert!(scenes.len() >= 10, "{scenes:?}");
    for (scene, name) in scenes.iter().filter(|(_, name)| name != "fleet") {
        let [made, kept] = pictured(scene, name, &gallery_folder(name));
        let made = std::fs::read_to_string(made).unwrap();
        if anew() {
            std::fs::write(&kept, &made).unwrap();
        }
        let kept = std::fs::read_to_string(kept).unwrap();
        assert_eq!(words(&kept), words(&made), "{name}: see the page for how to make it anew");
    }
}

/// Puts a photograph of a page among the pictures of the manual.
fn photograph(page: &Path, picture: &str, size: &str) {
    let picture = Path::new(ROOT).canonicalize().unwrap().join("output/pictures").join(picture);
    let mut browser = Command::new("chromium");
    browser.args(["--headless", "--no-sandbox", "--enable-unsafe-swiftshader", "--hide-scrollbars"]);
    browser.arg(format!("--window-size={size}")).arg(format!("--screenshot={}", picture.display()));
    let output = browser.arg(page).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The picture is a photograph of the page that the fleet has; the numbers below it are those of its table.
#[test]
fn the_fleet_of_the_gallery_is_of_today() {
    let (scene, name) = gallery().into_iter().find(|(_, name)| name == "fleet").unwrap();
    let here = gallery_folder(&name);
    let wheels = scene.replace("fleet.toml", "wheelsets.csv");
    wheelrail(&here, &["fleet", &scene, "--wheels", &wheels, "--rails", "60E1", "--out", "fleet"]);
    let table = std::fs::read_to_string(here.join("fleet/fleet.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let shown = ["conicity", "nonlinearity_per_mm", "right_flange_thickness_mm", "right_hollow_mm"]
        .map(|column| rows[0].iter().position(|name| *name == column).unwrap());
    let mut text = String::new();
    for row in &rows[1..] {
        assert!(row.last().unwrap().is_empty(), "edges of standards are no findings: {row:?}");
        let numbers = shown.map(|k| row[k].parse::<f64>().unwrap());
        let cells = [3, 3, 2, 2].iter().zip(numbers).map(|(&digits, number)| format!("{number:>10.digits$}"));
        text += &format!("{:<16}{}\n", row[0], cells.collect::<String>());
    }
    if anew() {
        photograph(&here.join("fleet/fleet.html"), "scenes/fleet.png", "1280,906");
        let scene = scene.replace("fleet/fleet.toml", "scenes/60e1_s1002.toml");
        wheelrail(&here, &["run", &scene, "--out", "run"]);
        photograph(&here.join("run/view.html"), "view_html.png", "1280,936");
    }
    let page = std::fs::read_to_string(Path::new(ROOT).join("src/docs/gallery-of-scenes.md")).unwrap();
    assert!(page.contains(&text), "the page and its picture are to have\n{text}");
}
