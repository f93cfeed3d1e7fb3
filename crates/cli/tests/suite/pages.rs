//! The pages for a browser: opened in headless Chromium, and bundled from their sources anew.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use crate::programs::{folder, not_run};
use serde_json::{Value, json};

/// Largest size of a page \[bytes\]: what a mail takes.
const LARGEST: u64 = 1_500_000;

/// Files that the build writes beside its sources.
const BUILT: [&str; 5] = ["view.js", "sweep.js", "fleet.js", "measure.js", "three-LICENSE.txt"];

/// A folder with node's packages and the pages' sources, and the browser.
struct Tools {
    folder: PathBuf,
    browser: String,
}

/// What setup_pages.sh makes, once; `None` where it cannot.
fn tools() -> Option<&'static Tools> {
    static TOOLS: OnceLock<Option<Tools>> = OnceLock::new();
    let tools = TOOLS.get_or_init(|| {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/setup_pages.sh");
        let output = Command::new(script).stderr(Stdio::inherit()).output().ok()?;
        let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
        let (folder, browser) = text.trim_end().split_once('\n')?;
        Some(Tools { folder: folder.into(), browser: browser.into() })
    });
    if tools.is_none() {
        not_run("the pages have no npm or no Chromium: see above");
    }
    tools.as_ref()
}

/// A single S1002 wheel over 60E1, with the rest of the scene.
fn single(contact: &str, rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\n{contact}\n{rest}\n"
    )
}

/// The example's wheelset with other numbers in place of its load and its lateral displacement.
fn wheelset(lateral: &str, patch: &str) -> String {
    let text = include_str!("../../../../examples/scenes/wheelset.toml");
    let moved = text.replace("lateral = 5.0", &format!("lateral = {lateral}"));
    moved.replace("load = 60000.0", patch)
}

/// Runs a scene with the page alone and gives its folder; `exit` is the exit code to be.
fn run(name: &str, scene: &str, exit: i32) -> PathBuf {
    let (path, dir) = (folder(&format!("{name}.toml")), folder(name));
    std::fs::write(&path, format!("{scene}\n[output]\nformats = [\"html\"]\n")).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    let output = program.arg("run").arg(&path).arg("--out").arg(&dir).output().unwrap();
    assert_eq!(output.status.code(), Some(exit), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    dir
}

/// The folders of a run's parts in the order of its page: its own, then those that the summary names.
fn parts(dir: &Path) -> Vec<PathBuf> {
    let summary = summary(dir);
    let others = summary["other_parts"].as_array().unwrap().iter();
    std::iter::once(dir.into()).chain(others.map(|part| dir.join(part.as_str().unwrap()))).collect()
}

fn summary(dir: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(dir.join("summary.json")).unwrap()).unwrap()
}

/// The loops of a boundary.csv.
fn loops(dir: &Path) -> Vec<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(dir.join("boundary.csv")).unwrap();
    let mut loops: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
    for line in text.lines().skip(1).filter(|line| !line.is_empty()) {
        let cells: Vec<&str> = line.split(',').collect();
        loops.entry(cells[0].into()).or_default().push([1, 2].map(|k| cells[k].parse().unwrap()));
    }
    loops.into_values().collect()
}

/// Runs a scene under several approaches: the page of the first is to show the boundaries of the others.
fn compared(name: &str, scene: impl Fn(&str) -> String, deltas: &[f64]) -> Value {
    let at = |delta: f64| format!("approach = {delta:?}");
    let dir = run(&format!("page_{name}"), &scene(&at(deltas[0])), 0);
    let mut others = Vec::new();
    for (number, &delta) in deltas[1..].iter().enumerate() {
        let other = run(&format!("page_{name}_{number}"), &scene(&at(delta)), 0);
        let (known, found) = (parts(&dir), parts(&other));
        assert_eq!(known.len(), found.len(), "{name}: as many contacts under {delta}");
        for (contact, part) in found.iter().enumerate() {
            let summary = summary(part);
            let (approach, area) = (&summary["approach_mm"], &summary["patch"]["area_mm2"]);
            others.push(json!({ "contact": contact, "delta": approach, "loops": loops(part), "area": area }));
        }
    }
    page(name, &dir, others)
}

/// The boundary on the rail's surface that an interpen_sigma.csv gives, in ξ and η.
fn loop_on_rail(dir: &Path) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(dir.join("interpen_sigma.csv")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let end = |k: usize| rows.iter().map(move |row| [row[1], row[k]]);
    end(2).chain(end(3).rev()).collect()
}

/// Runs the example over the rail's surface under several approaches, as [`compared`]: its page is to show s, too.
fn over_the_rail(deltas: &[f64]) -> Value {
    let runs: Vec<PathBuf> = deltas
        .iter()
        .enumerate()
        .map(|(number, delta)| {
            let text = include_str!("../../../../examples/scenes/flange_root.toml");
            run(
                &format!("page_rail_{number}"),
                &text.replace("load = 60000.0", &format!("approach = {delta:?}")),
                0,
            )
        })
        .collect();
    let other = |(dir, delta): (&PathBuf, &f64)| {
        let area = &summary(dir)["conformal"]["patch"]["area_mm2"];
        json!({ "contact": 0, "delta": delta, "loops": [loop_on_rail(dir)], "area": area, "plane": loops(dir) })
    };
    page("flange-root", &runs[0], runs.iter().zip(deltas).map(other).collect())
}

fn page(name: &str, dir: &Path, others: Vec<Value>) -> Value {
    let file = dir.join("view.html");
    let size = std::fs::metadata(&file).unwrap().len();
    assert!(size < LARGEST, "{name}: {size} bytes");
    json!({ "name": name, "page": file, "others": others })
}

/// Sweeps the example's wheelset, or marches: the page of what the command computes by these arguments, with its table.
fn swept(name: &str, command: &str, arguments: &[&str], events: bool) -> Value {
    let [page, table, told] = ["html", "csv", "events.csv"].map(|end| folder(&format!("page_{name}.{end}")));
    let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    program.arg(command).args(arguments).arg("--html").arg(&page).arg("--out").arg(&table);
    if events {
        program.arg("--events").arg(&told);
    }
    let output = program.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let size = std::fs::metadata(&page).unwrap().len();
    assert!(size < LARGEST, "{size} bytes");
    json!({ "name": name, "page": page, "table": table, "events": events.then_some(told) })
}

/// The sweep of the example's wheelset, which is yawed, and the marches of the examples over a crossing and a flat.
fn swept_pages() -> [Value; 3] {
    let path = folder("page_sweep.toml");
    std::fs::write(&path, wheelset("0.0", "approach = 0.05")).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let [scene, crossing, flat] =
        [path, root.join("crossing/crossing.toml"), root.join("wheel_flat/wheel_flat.toml")]
            .map(|path| path.display().to_string());
    [
        swept("sweep", "sweep", &[&scene, "--lateral", "-8:8:0.5"], false),
        swept("crossing", "march", &[&crossing, "--along", "-100:300:10"], true),
        swept("flat", "march", &[&flat, "--angle", "-0.1:0.1:0.005"], true),
    ]
}

#[test]
fn pages_open_in_a_browser_and_their_slider_gives_the_boundary_of_a_run() {
    let patch = |approach: &str| format!("[patch]\n{approach}");
    let empty = "[patch]\napproach = 0.01\n[grid]\nxi = { from = 5.0, to = 9.0, n = 31 }\neta = { from = 5.0, to = 9.0, n = 21 }";
    let [sweep, crossing, flat] = swept_pages();
    let pages = json!([
        compared("tread", |approach| single("offset = 0.0", &patch(approach)), &[0.08, 0.05, 0.16]),
        compared(
            "flange",
            |approach| single("offset = 6.0\nyaw = 0.01", &patch(approach)),
            &[0.1, 0.05, 0.15]
        ),
        over_the_rail(&[0.09, 0.05, 0.15]),
        compared("two-point", |approach| wheelset("4.84", approach), &[0.02, 0.012, 0.03]),
        compared("wheelset", |approach| wheelset("2.0", approach), &[0.08, 0.04]),
        page("no-patch", &run("page_no_patch", &single("offset = 0.0", empty), 1), Vec::new()),
        sweep,
        crossing,
        flat,
    ]);
    check("check_page.mjs", &[], &pages.to_string());
}

/// A page of every kind: of a run with one contact and two gaps, of one with two contacts, and of all other commands.
#[test]
fn pages_are_used_by_keyboard_at_three_widths_light_and_dark() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").canonicalize().unwrap();
    let example = |name: &str| root.join(name).display().to_string();
    let rail = include_str!("../../../../examples/scenes/flange_root.toml");
    let runs = [
        ("keys_rail", rail.replace("load = 60000.0", "approach = 0.08")),
        ("keys_pair", wheelset("2.0", "approach = 0.08")),
    ];
    let mut pages: Vec<PathBuf> =
        runs.iter().map(|(name, scene)| run(name, scene, 0).join("view.html")).collect();
    let [scene, crossing, fleet, wheels] =
        ["scenes/wheelset.toml", "crossing/crossing.toml", "fleet/fleet.toml", "fleet/wheelsets.csv"]
            .map(example);
    // Whatever the path of this repository, that of a measured file is long, and so is its name.
    let deep = folder("keys").join("a_folder_of_forty_characters_or_thereabouts/".repeat(4));
    std::fs::create_dir_all(&deep).unwrap();
    let prw = deep.join(format!("{}.prw", "a_long_name".repeat(12)));
    std::fs::copy(root.join("profiles/S1002.prw"), &prw).unwrap();
    let prw = prw.display().to_string();
    let commands: [(&str, &[&str]); 5] = [
        ("sweep.html", &["sweep", &scene, "--lateral", "-8:8:0.5", "--html"]),
        ("crossing.html", &["march", &crossing, "--along", "-100:300:20", "--html"]),
        ("conicity.html", &["conicity", &scene, "--html"]),
        ("measures.html", &["profile", "measure", &prw, "APTA-120", "--nominal", "S1002", "--html"]),
        ("fleet", &["fleet", &fleet, "--wheels", &wheels, "--rails", "60E1", "--out"]),
    ];
    for (name, arguments) in commands {
        let out = folder(&format!("keys_{name}"));
        let mut program = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
        let output = program.args(arguments).arg(&out).output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let page = if out.is_dir() { out.join("fleet.html") } else { out };
        let text = std::fs::read_to_string(&page).unwrap();
        assert!(!text.contains(folder("").to_str().unwrap()), "{name}: a path");
        assert!(!text.contains(root.to_str().unwrap()), "{name}: a path");
        pages.push(page);
    }
    let pages: Vec<&str> = pages.iter().map(|page| page.to_str().unwrap()).collect();
    check("check_keys.mjs", &pages, "");
}

/// Runs a script with the browser, arguments and an input; it has to be content.
fn check(script: &str, arguments: &[&str], input: &str) {
    let Some(tools) = tools() else { return };
    let mut node = Command::new("node");
    node.arg(script).arg(&tools.browser).args(arguments).current_dir(&tools.folder);
    let mut node = node.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    node.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = node.wait_with_output().unwrap();
    let lines = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{lines}{}", String::from_utf8_lossy(&output.stderr));
    eprint!("{lines}");
}

#[test]
fn the_scripts_of_pages_are_what_their_sources_build() {
    let Some(tools) = tools() else { return };
    let built = tools.folder.join("built");
    std::fs::create_dir_all(&built).unwrap();
    let mut node = Command::new("node");
    let output = node.arg("build.mjs").arg(&built).current_dir(&tools.folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src/export/html");
    for name in BUILT {
        let [new, old] = [&built, &committed].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(new == old, "{name} is not what `npm ci && npm run build` makes in {}", committed.display());
    }
}
