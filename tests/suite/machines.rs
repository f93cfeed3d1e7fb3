//! Columns by the code for every kind of machine: the same bits.

use wheelrail::Result;
use wheelrail::internal::columns_by;
use wheelrail::measured::{self, CurveKind, Format, Options, write};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Profile, Side, standards};
use wheelrail::separation::EtaAxis;

/// Most joints beside which columns are placed. A spline has more joints, and so many columns would be in strips.
const FEW_JOINTS: usize = 24;

/// Fills a window, with columns beside its joints, by code for one kind of machine. Returns s and the largest number of spans of
/// the strips' columns.
fn filled(placement: &Placement, count: i32, arch: pulp::Arch) -> (Vec<f64>, usize) {
    let steps = |reach: f64, n: i32| (0..n).map(move |k| reach * f64::from(2 * k - n + 1) / f64::from(n - 1));
    let mut xi: Vec<f64> = steps(12.0, 101).collect();
    // In these columns a joint is near η = 0.
    let beside = |joint: f64| (0..16).map(move |k| joint - 1e-6 * 1.6f64.powi(k));
    let joints = placement.joints(-12.0, 12.0);
    if joints.len() <= FEW_JOINTS {
        xi.extend(joints.into_iter().flat_map(beside));
    }
    xi.sort_by(f64::total_cmp);
    let axis = EtaAxis::new(&steps(15.0, count).collect::<Vec<_>>());
    let mut out = vec![0.0; xi.len() * axis.eta().len()];
    let spans = columns_by(placement, arch, &xi, &axis, &mut out);
    (out, spans)
}

/// Returns a spline through points of a profile.
fn spline(profile: &Profile, side: Side) -> Result<Profile> {
    let text = write::points(&write::sample(profile, 0.5)?, Format::Csv, side, "sample");
    let [mirror, flip_z] = [Some(false); 2];
    let options = Options { mirror, flip_z, curve: Some(CurveKind::Smoothing), ..Options::default() };
    measured::profile("sample.csv", text.as_bytes(), side, &options).map(|measured| measured.profile)
}

#[test]
fn every_machine_gives_the_same_bits() -> Result<()> {
    let rail = standards::rail("UIC60")?;
    let splines = [spline(&rail, Side::Rail)?, spline(&standards::wheel("S1002")?, Side::Wheel)?];
    // One pair has a kink; the other has the closing of a drawing, 0.06 mm wide.
    let drawings = [rail.clone(), standards::wheel("APTA-120")?];
    let closed = [rail, standards::wheel("EN15302-A")?];
    let cases = [
        (drawings.clone(), -14.0, 0.0, 2),
        (closed, -49.6, 0.0, 3),
        (drawings, -14.0, 0.02, 0),
        (splines, -9.0, 0.0, 0),
    ];
    for ([rail, wheel], wheel_x, yaw, most_spans) in cases {
        let placement = Pair::new(rail, wheel, 460.0)?.placed(-11.0, wheel_x, yaw)?;
        // The columns of the second count are whole vectors, so that one half is the mirror image of the other.
        for count in [253, 248] {
            let (plain, spans) = filled(&placement, count, pulp::Arch::Scalar);
            assert_eq!(spans, most_spans);
            assert!(plain.iter().all(|s| s.is_finite()));
            let same = |arch| {
                let (other, _) = filled(&placement, count, arch);
                plain.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits())
            };
            assert!(same(pulp::Arch::new()));
            #[cfg(target_arch = "x86_64")]
            if let Some(v3) = pulp::x86::V3::try_new() {
                assert!(same(pulp::Arch::V3(v3)));
            }
        }
    }
    Ok(())
}
