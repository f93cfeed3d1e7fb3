use super::*;
use crate::export::Header;
use crate::export::sample::{Sample, header};

/// Radius of the rail \[mm\].
const RADIUS: f64 = 13.0;

/// Returns the normals of an arc about the point below C over |σ| ≤ 6.5 mm, with a gap.
fn normals(gap: impl Fn(f64) -> f64) -> Vec<RailNormal> {
    let normal = |k: i32| {
        let sigma = 6.5 * f64::from(k) / 60.0;
        let (sin, cos) = (sigma / RADIUS).sin_cos();
        let foot = [RADIUS * sin, RADIUS * (cos - 1.0)];
        RailNormal { sigma, foot, direction: [sin, cos], gap: gap(sigma) }
    };
    (-60..=60).map(normal).collect()
}

/// Draws the normals above a map of the sample.
fn drawn(header: &Header, sample: &Sample, normals: &[RailNormal], loops: &[Vec<[f64; 2]>]) -> String {
    let profile: Vec<[f64; 2]> = normals.iter().map(|normal| normal.foot).collect();
    let refusals = ["a <no>; what to do".to_owned()];
    let contact =
        PicturedContact { header, name: "contact 2", refusals: &refusals, rail: &profile, wheel: &profile };
    let gap = Nodes { xi: &sample.xi, eta: &sample.eta, values: &sample.separation };
    ConformalPicture { contact, cells: [&sample.xi, &sample.eta], gap, normals, loops }.svg()
}

#[test]
fn pictures_of_good_and_of_odd_data_are_drawn() {
    let square = vec![[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]];
    let gaps: [fn(f64) -> f64; 5] = [
        |sigma| sigma * sigma / 100.0,
        |sigma| if sigma.abs() > 2.0 { f64::NAN } else { 0.0 },
        |_| f64::NAN,
        |sigma| sigma.powi(4),
        |sigma| sigma - 1.0,
    ];
    for approach in [0.05, 0.0] {
        let header = Header { approach, ..header() };
        for n in [[1, 1], [1, 5], [2, 2], [130, 170]] {
            let sample = Sample::new(n[0], n[1]);
            for gap in gaps {
                let all = normals(gap);
                for normals in [&all[..], &all[60..61], &all[90..], &[]] {
                    for loops in [vec![], vec![square.clone()]] {
                        let svg = drawn(&header, &sample, normals, &loops);
                        assert!(svg.ends_with("</svg>\n") && svg.contains("contact 2 · "));
                        assert!(svg.contains(">a &lt;no&gt;<") && !svg.contains("what to do"));
                        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{n:?} {approach} {svg}");
                    }
                }
            }
        }
    }
}

/// Returns the words of a picture in order.
fn words(svg: &str) -> Vec<&str> {
    svg.lines().filter_map(|line| line.strip_suffix("</text>")?.rsplit('>').next()).collect()
}

#[test]
fn the_angle_stands_above_the_arc_length() {
    let (header, sample) = (header(), Sample::new(121, 121));
    let svg = drawn(&header, &sample, &normals(|sigma| sigma * sigma / 100.0), &[]);
    let words = words(&svg);
    let name = words.iter().position(|word| *word == "α [°]").unwrap();
    // Ticks at −6, −4, …: a positive σ is down the right flank, where α is negative.
    let below: Vec<f64> = words.iter().filter_map(|word| word.replace('−', "-").parse().ok()).collect();
    let above: Vec<f64> =
        words[..name].iter().rev().map_while(|word| word.replace('−', "-").parse().ok()).collect();
    assert!(above.len() > 4 && above.is_sorted(), "{above:?}");
    for angle in above {
        let sigma = -angle.to_radians() * RADIUS;
        // Angles have one decimal.
        assert!(below.iter().any(|tick| (tick - sigma).abs() < 0.02), "{angle} {sigma} {below:?}");
    }
    assert!(words.contains(&"α = 28.6°") && words.contains(&"α = −28.6°"), "{words:?}");
}

#[test]
fn the_magnification_is_round_and_the_fan_fits() {
    let header = header();
    let sample = Sample::new(3, 3);
    let fan = |gap: fn(f64) -> f64, approach: f64| {
        let (normals, header) = (normals(gap), Header { approach, ..header.clone() });
        let contact = PicturedContact { header: &header, name: "", refusals: &[], rail: &[], wheel: &[] };
        let gap = Nodes { xi: &sample.xi, eta: &sample.eta, values: &sample.separation };
        let picture = ConformalPicture {
            contact,
            cells: [&sample.xi, &sample.eta],
            gap,
            normals: &normals,
            loops: &[],
        };
        let fan = Fan::new(&picture);
        (fan.factor, fan.shown, fan.cuts(&normals))
    };
    // 0.5 × 13 mm / 0.15 mm = 43.
    assert_eq!(fan(|sigma| sigma * sigma, 0.05), (20.0, SHOWN_GAP * 0.05, true));
    assert_eq!(fan(|_| 0.05, 0.05), (100.0, 0.05, false));
    assert_eq!(fan(|_| -0.65, 0.05).0, 10.0);
    // Gaps that are longer than the panel at true scale are cut.
    assert_eq!(fan(|sigma| 100.0 * sigma.abs(), 0.0), (1.0, LONGEST * 13.0, true));
    assert_eq!(fan(|_| 0.0, 0.0).0, 1.0);
}

#[test]
fn the_wheel_ends_where_the_gap_is_cut_and_where_rays_miss() {
    let gap = |sigma: f64| if sigma < -2.0 { f64::NAN } else { sigma.abs() / 10.0 };
    let normals = normals(gap);
    let wheel = Fan { factor: 2.0, shown: 0.3 }.wheel(&normals);
    let known: Vec<_> = wheel.iter().filter(|point| point[0].is_finite()).collect();
    let height = |point: &[f64; 2]| (point[0].hypot(point[1] + RADIUS) - RADIUS) / 2.0;
    assert!(known.iter().all(|point| height(point) < 0.3 + 1e-3));
    assert!((height(known[known.len() - 1]) - 0.3).abs() < 1e-3);
    assert!((height(known[0]) - 0.195).abs() < 1e-12, "{}", height(known[0]));
    // Two gaps on both sides of a line that misses are not joined.
    let lone = [0.1, f64::NAN, 0.2].map(|gap| RailNormal { gap, ..normals[60] });
    let wheel = Fan { factor: 1.0, shown: 1.0 }.wheel(&lone);
    assert!(wheel.windows(2).all(|pair| pair[0][0].is_nan() || pair[1][0].is_nan()), "{wheel:?}");
    assert_eq!(wheel.iter().filter(|point| point[0].is_finite()).count(), 2);
}
