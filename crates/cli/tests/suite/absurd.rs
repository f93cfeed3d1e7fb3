//! Absurd numbers: random scenes in which some numbers are a thousand times to 10³⁰⁰ times what they were, negative or zero. Each
//! ends in a result or an error, without a panic, within ten seconds of two processors and a gigabyte.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

use crate::campaign;
use crate::programs::folder;
use wheelrail::internal::Random;

/// Seed of the scenes, printed with every failure.
const SEED: u64 = 0x000A_B50B_D001;

/// Address space that a run gets \[kB\]: an allocation beyond it aborts.
const MEMORY: u64 = 1_000_000;

/// After this many seconds of a processor a run is ended.
const STUCK: u64 = 20;

/// Scenes with every way to place bodies, and most tables.
fn bases() -> [Value; 6] {
    let arc = |a: f64, b: f64, radius: f64, half: &str, x: [f64; 2]| json!({"arc": {"center": [a, b], "radius": radius, "half": half, "x": x}});
    let rail = json!({"profile": "60E1", "rotate": 0.025});
    let wheel = json!({"profile": "S1002", "radius": 460.0});
    let output = json!({"formats": ["vtk", "contact", "gmsh", "html"]});
    [
        json!({"rail": rail, "wheel": wheel, "contact": {"rail_x": 10.0, "wheel_x": 11.0}, "patch": {"approach": 0.05, "pressure": true, "pressure_cell": 0.3},
            "grid": {"xi": {"from": -6.0, "to": 6.0, "n": 21}, "eta": {"from": -5.0, "to": 5.0, "n": 17}, "tolerance": 1e-9},
            "mesh": {"size": 1.0}, "output": output}),
        json!({"rail": rail, "wheel": wheel, "contact": {"offset": 3.0, "yaw": 0.01, "roll": 0.001, "within": 0.1},
            "patch": {"load": 60000.0, "pressure": true}, "grid": {"spacing": 0.5, "merge": 0.2}, "material": {"youngs_modulus": 210000.0},
            "output": output}),
        json!({"rail": rail, "wheel": wheel, "track": {"gauge": 1435.0, "gauge_height": 14.0},
            "wheelset": {"back_to_back": 1360.0, "flange_back_x": -70.0, "lateral": 2.0, "yaw": 0.002},
            "patch": {"load": 60000.0}, "motion": {"speed": 30.0, "lateral": 0.1}, "friction": {"static": 0.3},
            "output": output}),
        json!({"rail": {"segments": [arc(0.0, -300.0, 300.0, "upper", [-30.0, 5.0]), {"line": {"from": [5.0, -0.0417], "to": [20.0, -3.0]}},
            arc(30.0, 5.0, 12.0, "lower", [20.0, 30.0])]}, "wheel": {"segments": [{"line": {"from": [-45.0, -2.0], "to": [-10.0, -0.5]}},
            {"polynomial": {"x": [-10.0, 40.0], "coefficients": [0.0, 0.05, -0.001, 1e-5]}}], "radius": 460.0, "shift": [1.0, 0.5]},
            "contact": {"offset": 1.0, "yaw": -0.02}, "patch": {"approach": 0.2}, "output": output}),
        json!({"rail": rail, "wheel": wheel, "contact": {"offset": 6.0}, "patch": {"approach": 0.06},
            "grid": {"reference": "rail"}, "motion": {"speed": 20.0}, "output": output}),
        json!({"rail": {"segments": [arc(0.0, -80.0, 80.0, "upper", [-20.0, 20.0])], "rotate": "1:20"},
            "wheel": {"segments": [arc(0.0, -90.0, 90.0, "upper", [-25.0, 25.0])], "radius": 45.0},
            "contact": {"rail_x": 1.0, "wheel_x": 1.5}, "patch": {"approach": 0.5, "frame": "weighted"}, "output": output}),
    ]
}

/// Gives the places of all numbers in a scene.
fn numbers(value: &Value, at: &str, out: &mut Vec<String>) {
    match value {
        Value::Number(_) => out.push(at.into()),
        Value::Array(all) => (0..).zip(all).for_each(|(k, value)| numbers(value, &format!("{at}/{k}"), out)),
        Value::Object(all) => all.iter().for_each(|(key, value)| numbers(value, &format!("{at}/{key}"), out)),
        _ => {}
    }
}

/// Replaces one number by an absurd one.
fn absurd(random: &mut Random, number: &mut Value) {
    if let Some(n) = number.as_u64() {
        *number = json!(*random.pick(&[
            0,
            1,
            2,
            n.saturating_mul(1000),
            n.saturating_mul(1_000_000),
            1_000_000_000,
            u64::MAX
        ]));
        return;
    }
    let old = number.as_f64().unwrap_or(1.0);
    let exponent = *random.pick(&[1, 3, 6, 9, 12, 18, 30, 100, 300]);
    *number = match random.below(8) {
        0 => json!(-old),
        1 => json!(0.0),
        2 => json!(old + 1e-6),
        3 => json!(1e-6),
        4 => json!(old * 10f64.powi(-exponent)),
        5 => json!(f64::MAX),
        _ => json!((old * 10f64.powi(exponent)).clamp(f64::MIN, f64::MAX)),
    };
}

fn scene(number: u64) -> Value {
    let mut random = Random::new(SEED ^ number.wrapping_mul(0xD134_2543_DE82_EF95));
    let mut scene = random.pick(&bases()).clone();
    let mut places = Vec::new();
    numbers(&scene, "", &mut places);
    for _ in 0..1 + random.below(3) {
        let place = random.pick(&places).clone();
        scene.pointer_mut(&place).into_iter().for_each(|number| absurd(&mut random, number));
    }
    scene
}

/// Runs a command of the program within the limits.
fn limited(arguments: &[&Path], scene: &Path) -> Output {
    let line = format!("ulimit -v {MEMORY} -t {STUCK}; exec \"$0\" --threads 2 \"$@\"");
    let mut bash = Command::new("bash");
    let bash = bash.arg("-c").arg(line).arg(env!("CARGO_BIN_EXE_wheelrail"));
    bash.args(arguments).arg(scene).output().expect("bash")
}

#[test]
#[cfg(target_os = "linux")]
fn absurd_numbers_end_in_a_result_or_an_error() {
    let (dir, mut results, mut wrong) = (folder("absurd"), 0, Vec::new());
    std::fs::create_dir_all(&dir).expect("a folder");
    for number in 0..campaign::scenes() {
        let (path, text) = (dir.join("scene.json"), scene(number).to_string());
        std::fs::write(&path, &text).expect("a scene");
        let out = dir.join("out");
        let run = ["run", "--quiet", "--out"].map(Path::new);
        let commands: [&[&Path]; 2] = [&[run[0], run[1], run[2], &out], &[Path::new("check")]];
        for command in commands {
            let output = limited(command, &path);
            let said = String::from_utf8_lossy(&output.stderr);
            let code = output.status.code();
            if !matches!(code, Some(0..=2)) || said.contains("panicked") {
                wrong.push(format!("scene {number}, {command:?}: {}\n{text}\n{said}", output.status));
            }
            results += u32::from(code != Some(2));
        }
    }
    assert!(wrong.is_empty(), "{} scenes of seed {SEED:#x}\n{}", wrong.len(), wrong.join("\n\n"));
    // Scenes that never get through would test the reader only.
    assert!(results > 5, "{results} results");
}
