//! Tests which parts of a closed chain change, which do not, and that the rule has no preferred direction, axes or unit.

use super::*;
use crate::numerics::twice::Twice;
use crate::profile::{Half, Profile, standards};

/// Largest kink of a joint that the drawing does not have.
const SMOOTH: f64 = 1e-12;

fn arcs(step: f64, kink: f64) -> Result<Vec<Segment>> {
    let first = Arc::about([0.0, -96.0], 96.0, Half::Upper, [-40.0, 0.0])?;
    let start = Station { z: first.end.z + step, cos: kink.cos(), sin: kink.sin(), ..first.end };
    let second = Arc::tangent_at(start, -345.0, 30.0)?;
    Ok(vec![Segment::arc(first), Segment::arc(second)])
}

fn polynomials(step: f64) -> Result<Vec<Segment>> {
    let graph = |c: &[f64], x| {
        Ok(Segment { label: String::new(), shape: Shape::Polynomial(Polynomial::graph(c, x)?) })
    };
    Ok(vec![graph(&[0.0, 0.3, -0.01], [-20.0, 0.0])?, graph(&[step, 0.3, -0.005, 1e-4], [0.0, 20.0])?])
}

/// Returns the largest distance \[mm\] across the tangent of one chain's points from another chain, and the largest one of
/// the points more than `beyond` \[mm\] away from x = 0.
fn apart(one: &Profile, other: &Profile, beyond: f64) -> [f64; 2] {
    use crate::profile::trace::{beside, trace};
    let marks = trace(other, 1e-3);
    let (mut hint, mut most, mut outside) = (0, 0f64, 0f64);
    for mark in trace(one, 0.0371) {
        let at = mark.station;
        let found = beside(&marks, [at.x, at.z], hint).expect("marks");
        hint = found.mark;
        most = most.max(found.across.abs());
        if at.x.abs() > beyond {
            outside = outside.max(found.across.abs());
        }
    }
    [most, outside]
}

#[test]
fn a_bend_closes_a_step_and_leaves_the_rest_alone() -> Result<()> {
    for step in [1e-3, -5.4e-5, 3e-8] {
        for drawn in [arcs(step, 0.0)?, arcs(step, 1e-6)?, polynomials(step)?] {
            let profile = Profile::new("closed", "", drawn.clone())?;
            let [closing] = profile.closings() else { return Err(Error::new("", "none", "one", "")) };
            assert_eq!(profile.segments().len(), 4);
            assert!((closing.moved / (0.5 * step.abs()) - 1.0).abs() < 0.05, "{closing:?}");
            assert_eq!(profile.drawn(), drawn);
            let joints = profile.continuity();
            let most = BEND / 70.0;
            for joint in &joints {
                assert!(joint.gap < 1e-14 && joint.kink.abs() < SMOOTH, "{step}: {joint:?}");
            }
            // Joints from left to right: segment to bend, bend to bend, bend to segment.
            let bent = joints[0].curvature_jump.abs().max(joints[2].curvature_jump.abs());
            assert!(bent < 2.0 * most, "{step}: {bent:e} of {most:e}");
            let alone = |k: usize| Profile::new("drawn", "", vec![drawn[k].clone()]);
            for k in 0..2 {
                let half = Profile::new("half", "", profile.segments()[2 * k..2 * k + 2].to_vec())?;
                let [most, outside] = apart(&half, &alone(k)?, closing.reach);
                assert!(most < 0.6 * step.abs() + 1e-12 && outside < 1e-12, "{step}: {most:e} {outside:e}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_drawn_kink_stays_and_moves_to_where_the_segments_cross() -> Result<()> {
    let (flat, slope) = (Arc::line([-30.0, 0.0], [0.0, 0.0])?, Arc::line([0.0, 2e-6], [30.0, 2.0])?);
    let profile = Profile::new("kinked", "", vec![Segment::arc(flat), Segment::arc(slope)])?;
    let ([joint], [_, _]) = (&profile.continuity()[..], profile.segments()) else {
        return Err(Error::new("", "more", "two segments", ""));
    };
    assert!((joint.x + 3e-5).abs() < 1e-9 && joint.gap == 0.0, "{joint:?}");
    assert!((joint.kink - (2.0f64 - 2e-6).atan2(30.0)).abs() < 1e-15, "{joint:?}");
    Ok(())
}

#[test]
fn a_gap_along_a_vertical_tangent_is_no_step() -> Result<()> {
    // A face that ends 0.3 mm above the arc that goes on from it.
    let face = Arc::line([-20.0, 30.0], [-20.0, 0.3])?;
    let arc = Arc::about([0.0, 0.0], 20.0, Half::Lower, [-20.0, 0.0])?;
    let profile = Profile::new("face", "", vec![Segment::arc(face), Segment::arc(arc)])?;
    assert!(profile.segments().len() == 2 && profile.closings().is_empty());
    let [joint] = profile.continuity()[..] else { return Err(Error::new("", "more", "one joint", "")) };
    assert!(joint.gap == 0.0 && joint.kink.abs() < 1e-15, "{joint:?}");
    assert!((profile.segments()[0].end().z).abs() < 1e-14, "{joint:?}");
    Ok(())
}

#[test]
fn closing_again_changes_nothing() -> Result<()> {
    for name in standards::wheel_names() {
        let profile = standards::wheel(name)?;
        let again = Profile::new(name, &profile.source, profile.segments().to_vec())?;
        assert!(again.closings().is_empty(), "{name}: {:?}", again.closings());
        for (one, other) in profile.segments().iter().zip(again.segments()) {
            for (a, b) in [(one.start(), other.start()), (one.end(), other.end())] {
                assert!((a.x - b.x).hypot(a.z - b.z) < 1e-13, "{name}: {a:?} {b:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn closing_commutes_with_mirror_and_motion() -> Result<()> {
    let frame = Station { x: 3.0, z: -7.0, cos: 0.8, sin: 0.6 };
    let wheels = standards::wheel_names().map(standards::wheel).collect::<Result<Vec<_>>>()?;
    for wheel in &wheels {
        let mut drawn: Vec<_> =
            wheel.drawn().iter().map(|s| s.map(Arc::mirrored, Polynomial::mirrored)).collect();
        drawn.reverse();
        same(Profile::new("mirrored", "", drawn)?.segments(), wheel.mirrored().segments());
        let moved = |s: &Segment| s.map(|a| a.placed_by(&frame), |p| p.placed_by(&frame));
        let arcs = |s: &Segment| matches!(s.shape, Shape::Arc(_));
        if wheel.drawn().iter().all(arcs) && wheel.drawn().iter().all(|s| moved(s).end().cos > 0.0) {
            let (segments, _) = close(&wheel.drawn().iter().map(moved).collect::<Vec<_>>(), wheel.extent())?;
            same(&segments, wheel.placed(&frame).segments());
        }
    }
    Ok(())
}

fn same(one: &[Segment], other: &[Segment]) {
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(other) {
        let (a, b) = (a.end(), b.end());
        // Where the tangents are nearly parallel, a rounding of the step moves the crossing by its square root.
        assert!((a.x - b.x).hypot(a.z - b.z) < 1e-6, "{a:?} {b:?}");
        assert!(a.seen_from(&b).z.abs() < 1e-12, "{a:?} {b:?}");
    }
}

#[test]
fn closing_commutes_with_a_change_of_unit_to_the_bit() -> Result<()> {
    let scaled = |segment: &Segment, by: f64| {
        let station = |s: Station| Station { x: s.x * by, z: s.z * by, ..s };
        segment.map(
            |a| Arc { start: station(a.start), end: station(a.end), radius: a.radius * by },
            |p| {
                let power = |(k, &c): (usize, &Twice)| c * by.powi(1 - k as i32);
                let all = |c: &[Twice]| c.iter().enumerate().map(power).collect();
                Polynomial { t: p.t.map(|t| t * by), x: all(&p.x), z: all(&p.z) }
            },
        )
    };
    for name in standards::wheel_names() {
        let wheel = standards::wheel(name)?;
        let drawn = wheel.drawn().iter().map(|s| scaled(s, 4096.0)).collect();
        let expected: Vec<_> = wheel.segments().iter().map(|s| scaled(s, 4096.0)).collect();
        assert_eq!(Profile::new(name, "", drawn)?.segments(), expected, "{name}");
    }
    Ok(())
}

#[test]
fn a_step_that_the_segments_beside_it_cannot_take_is_an_error() -> Result<()> {
    let line = |from: [f64; 2], to| Arc::line(from, to).map(Segment::arc);
    let short = vec![
        line([-50.0, 0.0], [0.0, 0.0])?,
        line([0.0, 5e-3], [0.05, 5e-3])?,
        line([0.05, 5e-3], [50.0, 5e-3])?,
    ];
    let error = Profile::new("short", "", short).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("segment 2") && error.contains("0.005000 mm across"), "{error}");
    Ok(())
}

#[test]
fn sampled_chains_have_no_points_that_files_cannot_tell_apart() -> Result<()> {
    use crate::measured::write::{LEAST_DISTANCE, sample};
    let rails = standards::rail_names().map(standards::rail);
    for profile in rails.chain(standards::wheel_names().map(standards::wheel)) {
        let profile = profile?;
        for step in [0.05, 0.2, 1.0] {
            let points = sample(&profile, step)?;
            let apart = points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
            let least = apart.fold(f64::INFINITY, f64::min);
            assert!(least >= LEAST_DISTANCE, "{} at {step}: {least:e}", profile.name);
        }
    }
    Ok(())
}
