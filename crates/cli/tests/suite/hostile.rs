//! Hostile input: mutated scenes end in a result or an error, kills and full disks leave whole folders.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;
use wheelrail::internal::Random;

use crate::campaign;
use crate::in_time::InTime;

use wheelrail::case::{Run, SILENT};
use wheelrail::scene::{self, Scene};

/// Scenes of one ordinary test run; `WHEELRAIL_HOSTILE_SCENES=1000000` is the long one (five minutes).
const SCENES: u64 = 20_000;

/// Seed of the mutations, printed with every failure.
const SEED: u64 = 0x5EED_0F5C_E4E5;

/// Runs that are to be caught alive, the moments at which they are killed, and the most runs until then.
const CAUGHT: u32 = 10;
const STEPS: u32 = 50;
const MOST_RUNS: u32 = 1000;

/// Larger grids are rejected by the program or, below its own limit, not run here.
const POINTS: usize = 20_000;

const BASES: [&str; 4] = [
    include_str!("../../../../examples/scenes/60e1_s1002.toml"),
    r#"
[rail]
segments = [{ arc = { center = [0.0, -300.0], radius = 300.0, half = "upper", x = [-30.0, 30.0] } }]
[wheel]
segments = [{ line = { from = [-40.0, -2.0], to = [40.0, 2.0] } }]
radius = 460.0
[contact]
rail_x = -14.981273
wheel_x = 0.0
[patch]
approach = 0.05
[grid]
xi = { from = -8.0, to = 8.0, n = 33 }
eta = { from = -9.0, to = 9.0, n = 31 }
tolerance = 1e-9
"#,
    r#"
[rail]
start = [-20.0, -1.0]
segments = [
  { line = { slope = 0.05, to_x = -10.0 } },
  { arc = { radius = 80.0, half = "upper", to_x = 10.0 } },
  { line = { to_x = 20.0 } },
]
[wheel]
segments = [
  { polynomial = { x = [-30.0, 0.0], coefficients = [0.0, 0.02, -0.001, 1e-5] } },
  { polynomial = { x = [0.0, 30.0], coefficients = [0.0, 0.02, 0.0005] } },
]
radius = 150.0
[contact]
rail_x = 1.0
wheel_x = -1.0
[patch]
load = 60000.0
[grid]
xi = { values = [-5.0, -1.0, 0.0, 0.5, 4.0] }
eta = { from = -20.0, to = 25.0, n = 40 }
method = "spectral"
"#,
    r#"{"rail": {"profile": "60E1"}, "wheel": {"profile": "EN15302-A", "radius": 460.0},
"contact": {"rail_x": -27.0, "wheel_x": -29.0}, "patch": {"approach": 0.05},
"grid": {"xi": {"from": -4.0, "to": 6.0, "n": 21}, "eta": {"from": 0.0, "to": 14.0, "n": 15}}}"#,
];

const NUMBERS: [&str; 24] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-300",
    "5e-324",
    "1e300",
    "1.8e308",
    "nan",
    "-inf",
    "inf",
    "1e12",
    "9007199254740993",
    "1e-12",
    "-1e-12",
    "0.5",
    "12.99999999999999",
    "-70",
    "35.99981082207864",
    "1e6",
    "1e-6",
    "3",
    "200",
    "-0.3",
];

const WORDS: [&str; 12] = [
    "60E1",
    "S1002",
    "APTA-120",
    "upper",
    "lower",
    "auto",
    "quadratic",
    "pointwise",
    "report-newton",
    "1:40",
    "1:0",
    "\u{3be}",
];

/// Byte ranges of the numbers in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut out = Vec::new();
    let mut begin = None;
    for (i, c) in text.char_indices().chain([(text.len(), ' ')]) {
        let part = c.is_ascii_digit() || (begin.is_some() && matches!(c, '.' | 'e' | '-' | '+'));
        match (part, begin) {
            (true, None) => begin = Some(i),
            (false, Some(b)) => {
                out.push(b..i);
                begin = None;
            }
            _ => {}
        }
    }
    out
}

fn mutated(dice: &mut Random, base: &str) -> String {
    let mut text = base.to_string();
    for _ in 0..1 + dice.below(3) {
        match dice.below(8) {
            0..=3 => {
                let places = numbers(&text);
                if places.is_empty() {
                    continue;
                }
                let place = places[dice.below(places.len())].clone();
                let old: f64 = text[place.clone()].parse().unwrap_or(1.0);
                let new = match dice.below(4) {
                    0 => dice.pick(&NUMBERS).to_string(),
                    1 => format!("{:?}", old * (1.0 + 1e-12 * dice.below(1000) as f64)),
                    2 => format!("{:?}", old * [0.5, 2.0, -1.0, 10.0, 1e-3, 1e3][dice.below(6)]),
                    _ => format!("{:?}", old + [1.0, -1.0, 0.1, 30.0][dice.below(4)]),
                };
                text.replace_range(place, &new);
            }
            4 => {
                let lines: Vec<&str> = text.lines().collect();
                let drop = dice.below(lines.len());
                text = lines
                    .iter()
                    .enumerate()
                    .filter(|(i, _)| *i != drop)
                    .map(|(_, l)| format!("{l}\n"))
                    .collect();
            }
            5 => {
                let quotes: Vec<usize> = text.match_indices('"').map(|(i, _)| i).collect();
                if quotes.len() > 1 {
                    let k = dice.below(quotes.len() / 2) * 2;
                    text.replace_range(quotes[k] + 1..quotes[k + 1], dice.pick::<&str>(&WORDS));
                }
            }
            6 => {
                let at = dice.below(text.len());
                if text.is_char_boundary(at) {
                    text.insert(at, *dice.pick(&['[', ']', '{', '"', '=', '\n', '9', '.', '\u{0}', 'é']));
                }
            }
            _ => text.truncate(
                (0..=dice.below(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0),
            ),
        }
    }
    text
}

/// Reads and runs a scene; `Ok(true)` when it gave a result.
fn attempt(text: &str, json: bool) -> Result<bool, String> {
    let Ok(scene) = scene::parse::<Scene>(text, json) else { return Ok(false) };
    let in_time = InTime::begin();
    let Ok(case) = scene::resolve(&scene, Path::new("."), "hostile") else { return Ok(false) };
    let points = |axis: &Option<Vec<f64>>| axis.as_ref().map_or(usize::MAX, Vec::len);
    if points(&case.axes().xi).saturating_mul(points(&case.axes().eta)) > POINTS {
        return Ok(false);
    }
    let Ok(run) = Run::new(case, SILENT) else { return Ok(false) };
    drop(in_time);
    for part in &run.parts {
        let analysis = &part.analysis;
        let numbers = analysis.patch.iter().flat_map(|p| &p.components).flat_map(|c| {
            let sizes = [c.xi.low, c.xi.high, c.eta.low, c.eta.high, c.area, c.perimeter, c.deepest[0]];
            c.boundary.iter().flatten().copied().chain(sizes)
        });
        if let Some(bad) = numbers.into_iter().find(|v| !v.is_finite()) {
            return Err(format!("{bad} in the patch"));
        }
        let claimed =
            [part.site.contact.feasibility.least_separation_mm, part.site.contact.feasibility.at_xi_mm];
        if claimed.iter().any(|v| !v.is_finite()) {
            return Err(format!("feasibility {claimed:?}"));
        }
        if analysis.separation.iter().any(|s| s.is_infinite()) {
            return Err("an infinite separation".into());
        }
    }
    Ok(true)
}

#[test]
fn mutated_scenes_end_in_a_result_or_an_error() {
    let wanted =
        std::env::var("WHEELRAIL_HOSTILE_SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(SCENES);
    let mut results = 0u64;
    for number in 0..wanted {
        let mut dice = Random::new(SEED ^ number.wrapping_mul(0xD134_2543_DE82_EF95));
        let base = *dice.pick(&BASES);
        let text = mutated(&mut dice, base);
        let outcome = std::panic::catch_unwind(|| attempt(&text, base.starts_with('{')));
        match outcome {
            Ok(Ok(result)) => results += u64::from(result),
            Ok(Err(complaint)) => panic!("scene {number} of seed {SEED:#x}: {complaint}\n{text}"),
            Err(_) => panic!("scene {number} of seed {SEED:#x} panicked\n{text}"),
        }
    }
    println!("{results} of {wanted} scenes gave a result");
    // Mutations that never get through would test the parser only.
    assert!(results * 10 > wanted, "{results} of {wanted}");
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The program with no signal ignored, though these tests may run under `nohup` or in the background of a script.
#[cfg(unix)]
fn heard() -> Command {
    if cfg!(not(target_os = "linux")) {
        return program();
    }
    let mut command = Command::new("env");
    command.args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_wheelrail")]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// A fresh folder for one test.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a scratch folder");
    folder
}

fn scene_file(folder: &Path, approach: f64) -> PathBuf {
    let path = folder.join("scene.toml");
    let text =
        BASES[1].replace("approach = 0.05", &format!("approach = {approach}")).replace("n = 33", "n = 201");
    std::fs::write(&path, text).expect("a scene file");
    path
}

/// The approach in a folder's summary, once every file that it names is there.
fn whole(folder: &Path) -> f64 {
    let text = std::fs::read_to_string(folder.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for name in summary["files"].as_array().expect("a list of files") {
        let file = folder.join(name.as_str().expect("a name"));
        assert!(file.metadata().is_ok_and(|m| m.len() > 0), "{} is missing or empty", file.display());
    }
    let last = std::fs::read_to_string(folder.join("conform.wrp")).expect("a deck");
    assert!(last.ends_with("END\n"), "a cut deck");
    summary["approach_mm"].as_f64().expect("the approach")
}

#[test]
fn a_kill_at_any_moment_leaves_the_old_or_the_new_folder_whole() {
    let folder = scratch("kill");
    let out = folder.join("out");
    let run = |approach: f64| {
        let mut command = program();
        command.arg("run").arg(scene_file(&folder, approach)).arg("--out").arg(&out);
        command
    };
    let start = Instant::now();
    assert!(run(0.01).status().is_ok_and(|s| s.success()));
    let duration = start.elapsed();
    let (mut before, mut killed, mut k) = (0.01, 0, 0);
    while killed < CAUGHT || k < STEPS {
        let approach = 0.02 + 0.001 * f64::from(k);
        let mut child = run(approach).spawn().expect("the program");
        std::thread::sleep(duration * (k % STEPS) / STEPS);
        k += 1;
        assert!(k < MOST_RUNS, "only {killed} of {k} runs were caught alive");
        killed += u32::from(child.try_wait().is_ok_and(|s| s.is_none()));
        let _ = child.kill();
        let _ = child.wait();
        let now = whole(&out);
        assert!(now == before || now == approach, "neither {before} nor {approach} but {now}");
        before = now;
    }
    // The next run clears what the killed ones left.
    assert!(run(0.01).status().is_ok_and(|s| s.success()));
    let left: Vec<_> =
        std::fs::read_dir(&folder).expect("the folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

/// Ctrl-C, SIGTERM and SIGHUP at random moments: the exit code of shells, the folder as it was or new, and nothing beside it.
#[test]
#[cfg(unix)]
fn signals_leave_the_old_or_the_new_folder_and_nothing_else() {
    let folder = scratch("signals");
    let out = folder.join("out");
    let run = |approach: f64| {
        let mut command = heard();
        command.arg("run").arg(scene_file(&folder, approach)).arg("--out").arg(&out);
        command
    };
    let start = Instant::now();
    assert!(run(0.01).status().is_ok_and(|s| s.success()));
    let duration = start.elapsed();
    let signals = [("INT", 130), ("TERM", 143), ("HUP", 129)];
    let (mut dice, mut before, mut ended, mut k) = (Random::new(SEED), 0.01, [0; 3], 0);
    while ended.contains(&0) || k < campaign::scenes() as u32 {
        let approach = 0.02 + 1e-5 * f64::from(k);
        let signal = k as usize % signals.len();
        let (name, code) = signals[signal];
        k += 1;
        assert!(k < MOST_RUNS || !ended.contains(&0), "runs caught at work: {ended:?}");
        let mut child = run(approach).spawn().expect("the program");
        std::thread::sleep(duration.mul_f64(dice.uniform()));
        let kill = Command::new("kill")
            .arg(format!("-{name}"))
            .arg(child.id().to_string())
            .stderr(Stdio::null())
            .status();
        kill.expect("the program kill");
        let status = child.wait().expect("a status");
        let now = whole(&out);
        assert!(now == before || now == approach, "neither {before} nor {approach} but {now}");
        // A signal before the program listens ends it at once, and before it has made anything.
        let at_once = status.code().is_none() && now == before;
        assert!(status.success() || status.code() == Some(code) || at_once, "SIG{name}: {status}");
        ended[signal] += u32::from(status.code() == Some(code));
        before = now;
        let left: Vec<_> =
            std::fs::read_dir(&folder).expect("the folder").flatten().map(|e| e.file_name()).collect();
        assert_eq!(left.len(), 2, "SIG{name}, {status}: {left:?}");
    }
}

/// `nohup` has a program ignore SIGHUP, a script the SIGINT of what it begins by `&`: it goes on.
#[test]
#[cfg(target_os = "linux")]
fn a_signal_that_the_caller_has_ignored_stays_ignored() {
    for (name, number) in [("HUP", 1), ("INT", 2), ("TERM", 15)] {
        let folder = scratch(&format!("ignored-{name}"));
        let out = folder.join("out");
        let mut child = Command::new("env")
            .args([&format!("--ignore-signal={name}"), env!("CARGO_BIN_EXE_wheelrail"), "run"])
            .arg(scene_file(&folder, 0.03))
            .arg("--out")
            .arg(&out)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("env");
        let id = child.id().to_string();
        let ignores = || {
            let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
            let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
            let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok());
            mask.is_some_and(|mask| mask >> (number - 1) & 1 == 1)
        };
        // Before `env` has said so, a signal would end it.
        while !ignores() && child.try_wait().is_ok_and(|status| status.is_none()) {}
        while child.try_wait().is_ok_and(|status| status.is_none()) {
            let _ = Command::new("kill").args([&format!("-{name}"), &id]).stderr(Stdio::null()).status();
        }
        assert!(child.wait().is_ok_and(|status| status.success()) && whole(&out) == 0.03, "SIG{name}");
    }
}

#[test]
fn bad_input_gives_exit_code_2_and_leaves_the_old_folder() {
    let folder = scratch("bad");
    let out = folder.join("out");
    let scene = scene_file(&folder, 0.05);
    let good = std::fs::read_to_string(&scene).expect("the scene");
    let run = || program().arg("run").arg(&scene).arg("--out").arg(&out).status().ok().and_then(|s| s.code());
    assert_eq!(run(), Some(0));
    for (from, to) in [
        ("approach", "aproach"),
        ("radius = 460.0", "radius = 0.0"),
        ("rail_x = -14.981273", "rail_x = -40.0"),
        ("rail_x = -14.981273", "rail_x = nan"),
        ("to = [40.0, 2.0]", "to = [-40.0, 2.0]"),
        ("n = 201", "n = 1000000000000"),
        ("[rail]", "[rail]\nprofile = \"60E1\""),
        ("approach = 0.05", "approach = -1.0"),
        ("tolerance = 1e-9", "tolerance = 0.0"),
    ] {
        assert!(good.contains(from), "{from}");
        std::fs::write(&scene, good.replacen(from, to, 1)).expect("the scene");
        assert_eq!(run(), Some(2), "{to}");
        assert_eq!(whole(&out), 0.05, "{to}");
    }
    std::fs::write(&scene, good.replace("rail_x = -14.981273", "rail_x = -12.0")).expect("the scene");
    assert_eq!(run(), Some(0), "lines and arcs are in contact at any pair of points");
}

#[test]
fn a_full_disk_is_an_error_and_leaves_nothing() {
    let folder = scratch("full");
    let out = folder.join("out");
    // A limit on the size of files stands for the full disk: the same write fails half-way.
    let command = format!(
        "trap '' XFSZ; ulimit -f 200; exec {} run {} --out {}",
        env!("CARGO_BIN_EXE_wheelrail"),
        scene_file(&folder, 0.05).display(),
        out.display()
    );
    let status = Command::new("bash").arg("-c").arg(command).stderr(Stdio::piped()).output().expect("bash");
    assert_eq!(status.status.code(), Some(2), "{}", String::from_utf8_lossy(&status.stderr));
    let left: Vec<_> =
        std::fs::read_dir(&folder).expect("the folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(left, ["scene.toml"], "{left:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_stdout_is_an_error_for_help_as_for_data() {
    for arguments in ["--help", "--version", "run --help", "schema", "profile list"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a device of Linux");
        let status = program().args(arguments.split(' ')).stdout(full).status().expect("the program");
        assert_eq!(status.code(), Some(2), "{arguments}");
    }
}
