//! What a wheel sinks by under a load, and what its contacts carry, is continuous as the wheel moves sideways.

use crate::common::repository;
use wheelrail::case::sites;
use wheelrail::{Result, scene};

/// Largest jump of what the wheel sinks by \[mm\], and of the sum of its normal forces, relative.
const BOUNDS: [f64; 2] = [2e-4, 2e-3];

/// Steps \[mm\] of a scan, and those down to which the largest change is followed: no slope makes a jump there.
const STEPS: [f64; 2] = [0.5, 1e-6];

/// Rail, wheel, yaw \[rad\], and the offsets of a scan \[mm\]: places change, flanges begin to carry, and regions join and part.
const SCANS: [(&str, &str, f64, [f64; 2]); 8] = [
    ("profile = \"60E1\", rotate = \"1:40\"", "profile = \"S1002\"", 0.0, [1.5, 2.5]),
    ("profile = \"UIC60\", rotate = \"1:20\"", "profile = \"S1002\"", 0.0, [2.8, 4.3]),
    ("profile = \"50E6\", rotate = \"1:20\"", "profile = \"EN15302-H\"", 0.0, [6.1, 7.6]),
    ("profile = \"60E2\", rotate = \"1:40\"", "profile = \"EN13715-1:40-h28-e32.5\"", 0.0, [2.9, 3.9]),
    ("profile = \"54E3\", rotate = \"1:20\"", "profile = \"EN15302-C\"", 0.0, [-3.2, -2.2]),
    ("profile = \"49E1\", rotate = \"1:40\"", "profile = \"EN15302-A\"", 0.0, [2.45, 3.45]),
    ("file = \"60E1.ban\", mirror = true, rotate = \"1:40\"", "file = \"S1002.prw\"", 0.0, [1.3, 2.3]),
    ("profile = \"60E1\", rotate = \"1:40\"", "profile = \"S1002\"", 0.01, [1.5, 2.5]),
];

/// What the wheel sinks by \[mm\], and the sum of its normal forces \[N\].
fn carried((rail, wheel, yaw, _): &(&str, &str, f64, [f64; 2]), offset: f64) -> Result<[f64; 2]> {
    let text = format!(
        "rail = {{ {rail} }}\nwheel = {{ {wheel}, radius = 460.0 }}\n\
         contact = {{ offset = {offset:?}, yaw = {yaw:?} }}\npatch = {{ load = 60e3, frame = \"weighted\" }}\n"
    );
    let folder = repository("examples/profiles");
    let sites = sites(&scene::resolve(&scene::parse(&text, false)?, &folder, "continuity")?)?;
    let sunk = sites[0].approach() / sites[0].contact.placement.upright();
    Ok([sunk, sites.iter().filter_map(|site| site.normal_load).sum()])
}

/// The larger of both changes, as a share of its bound.
fn change(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((a[0] - b[0]).abs() / BOUNDS[0]).max((a[1] / b[1] - 1.0).abs() / BOUNDS[1])
}

/// Every step of a scan is halved where more of the change lies, until what is left is a jump.
#[test]
fn sinking_and_forces_do_not_jump_in_the_weighted_frame() -> Result<()> {
    for scan in &SCANS {
        let [from, to] = scan.3;
        let mut next = [from, from + STEPS[0]];
        while next[0] < to {
            let [mut a, mut b] = next;
            let [mut at_a, mut at_b] = [carried(scan, a)?, carried(scan, b)?];
            while b - a > STEPS[1] && change(at_a, at_b) > 0.5 {
                let middle = a + (b - a) / 2.0;
                let here = carried(scan, middle)?;
                let left = change(at_a, here) > change(here, at_b);
                *(if left { &mut b } else { &mut a }) = middle;
                *(if left { &mut at_b } else { &mut at_a }) = here;
            }
            assert!(change(at_a, at_b) <= 1.0, "{scan:?} {a}: {at_a:?} {at_b:?}");
            next = next.map(|offset| offset + STEPS[0]);
        }
    }
    Ok(())
}
