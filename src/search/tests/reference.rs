//! Tests the search against `tests/reference_yawed/yawed_*.json`.

use serde_json::Value;

use super::*;
use crate::separation::methods::quadratic::form;

const SCENES: [&str; 3] = [
    include_str!("../../../tests/reference_yawed/yawed_crown_on_cone.json"),
    include_str!("../../../tests/reference_yawed/yawed_60E1_S1002_tread.json"),
    include_str!("../../../tests/reference_yawed/yawed_flange.json"),
];

fn number(value: &Value, key: &str) -> f64 {
    let v = &value[key];
    v.as_f64().or_else(|| v.as_str().and_then(|s| s.parse().ok())).unwrap_or(f64::NAN)
}

fn profile(segments: &Value) -> Result<Profile> {
    let mut out = Vec::new();
    for s in segments.as_array().unwrap_or(&Vec::new()) {
        let get = |key| number(s, key);
        let x = [get("x0"), get("x1")];
        let shape = match s["kind"].as_str() {
            Some("line") => Shape::Arc(Arc::line([x[0], get("z0")], [x[1], get("z1")])?),
            Some("arc") => {
                let half = if get("sigma") > 0.0 { Half::Upper } else { Half::Lower };
                Shape::Arc(Arc::about([get("a"), get("b")], get("r"), half, x)?)
            }
            _ => {
                let c: Vec<f64> =
                    s["c"].as_array().map_or(Vec::new(), |c| c.iter().filter_map(Value::as_f64).collect());
                Shape::Polynomial(Polynomial::graph(&c, x)?)
            }
        };
        out.push(Segment { label: String::new(), shape });
    }
    Profile::new("reference", "", out)
}

#[test]
fn contacts_agree_with_60_digit_values() -> Result<()> {
    for text in SCENES {
        let file: Value = serde_json::from_str(text).unwrap_or_default();
        let scene = &file["scene"];
        let (rail, wheel) = (profile(&scene["rail"])?, profile(&scene["wheel"])?);
        let radius = number(scene, "wheel_radius");
        let (yaw, roll) = (number(scene, "yaw"), number(scene, "roll"));
        let pair = ProfilePair::new(&Pair::new(rail, wheel.clone(), radius)?)?;
        // The offset that brings the two given points over each other.
        let station = Section::own_axes(&wheel, Side::Wheel)
            .branch_at(number(scene, "contact_wheel_x"))
            .map(|branch| branch.station(number(scene, "contact_wheel_x")))
            .unwrap_or(crate::profile::Station::AXES);
        let rail_x = number(&file, "exact_rail_x");
        let offset = rail_x - Attitude::new(0.0, yaw, roll, radius).outline(&station).x;
        let mut search = pair.search();
        let contacts =
            search.touch(&Pose::new(offset, yaw, roll)?, &Selection { within: 20.0, apart: 0.0 })?.contacts;
        let title = &scene["title"];
        let found = contacts.iter().find(|c| (c.rail_x - rail_x).abs() < 1e-9);
        let Some(c) = found else { panic!("{title}: no contact at {rail_x} among {contacts:?}") };
        let pairs = [
            (c.wheel_x, number(scene, "contact_wheel_x"), 2e-12),
            (c.skew, number(&file, "exact_chi"), 1e-13),
            (c.contact_angle, number(&file, "theta_rail"), 2e-13),
            (c.wheel_angle, number(&file, "theta_wheel"), 2e-13),
            (c.y, number(&file, "y"), 1e-10),
        ];
        for (found, expected, bound) in pairs {
            assert!((found - expected).abs() < bound, "{title}: {found} is not {expected}");
        }
        // Second differences of s over ±0.01 mm along η and over ±0.001 along ξ.
        let s = |xi: f64, eta: f64| {
            let rows = file["separation"].as_array().map_or(&[] as &[Value], Vec::as_slice);
            let row = rows.iter().find(|row| row[0] == xi && row[1] == eta);
            row.and_then(|row| row[2].as_str()?.parse().ok()).unwrap_or(f64::NAN)
        };
        let around = c.wheel_angle.cos() / c.rolling_radius;
        let [along, mixed, across] = form([c.rail_curvature, c.wheel_curvature], around, c.skew);
        let expected = [
            (2.0 * along, (s(-1e-3, 0.0) + s(1e-3, 0.0)) / 1e-6),
            (2.0 * across, (s(0.0, -1e-2) + s(0.0, 1e-2)) / 1e-4),
            (mixed, (s(1e-3, 1e-2) + s(-1e-3, -1e-2) - s(1e-3, -1e-2) - s(-1e-3, 1e-2)) / 4e-5),
        ];
        for (found, expected) in expected {
            // The differences have an error of the square of the step.
            assert!((found - expected).abs() < 1e-6, "{title}: {found} is not {expected}");
        }
    }
    Ok(())
}
