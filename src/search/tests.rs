use super::locus::Attitude;
use super::*;
use crate::error::{Error, ErrorKind, Result};
use crate::placement::{Pair, RailDistance, WheelDistance};
use crate::profile::{Arc, Half, Polynomial, Profile, Section, Segment, Shape, Side, inclination, standards};
use nalgebra::{Point2, UnitComplex, Vector3};

mod brute;
mod reference;
mod rough;

const ALL: Selection = Selection { within: 0.0, apart: 0.0 };

/// Makes the pair of the Manchester contact benchmark: S1002 on UIC60 at 1:40.
fn manchester() -> Result<WheelsetOnTrack> {
    let rail = standards::rail("UIC60")?.rotated(inclination(1.0, 40.0)?);
    let backs = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
    WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, backs)
}

/// Makes the pair of EN 15302: wheel A over rail A, inclined by 0.05 rad.
fn en_15302_a() -> Result<WheelsetOnTrack> {
    let rail = standards::rail("UIC60")?.rotated(UnitComplex::new(0.05)).shifted(2.60264, 0.14155);
    let pair = Pair::new(rail, standards::wheel("EN15302-A")?, 460.0)?;
    WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))
}

#[test]
fn heights_of_first_touch_of_the_manchester_benchmark() -> Result<()> {
    let system = manchester()?;
    let mut search = system.search();
    // Lateral, yaw, roll, side (0 left, 1 right), height; CONTACT's yaw and height are the negatives.
    let table = [
        (0.0, 0.0, 0.0, 0, -0.1821),
        (0.0, 0.0, 0.0, 1, -0.1821),
        (5.0, -0.0120, -0.000_355_40, 0, 0.0205),
        (5.0, -0.0120, -0.000_355_40, 1, 0.0271),
        (6.5, -0.0156, -0.004_376_00, 1, 3.1382),
        (10.0, -0.0240, -0.011_264_31, 1, 8.3159),
    ];
    for (lateral, yaw, roll, side, z) in table {
        let position = Position { lateral, yaw, roll: Roll::Fixed(roll) };
        let found = search.touch(&position, &ALL)?.sides[side].z;
        // CONTACT's search is sampled and its numbers have four decimals; the worst row is 2.6e-4.
        assert!((found - z).abs() < 3e-4, "at {lateral}, {yaw}, side {side}: {found} is not {z}");
    }
    Ok(())
}

#[test]
fn rolling_radius_differences_of_en_15302_wheel_a() -> Result<()> {
    let system = en_15302_a()?;
    let mut search = system.search();
    for (lateral, expected) in [(2.0, 0.667), (4.0, 1.913), (6.0, 4.327)] {
        let position = Position { lateral, yaw: 0.0, roll: Roll::Neglect };
        let touch = search.touch(&position, &ALL)?;
        let radii = touch.sides.map(|s| s.touch.contacts[0].rolling_radius);
        let found = radii[1] - radii[0];
        assert!((found - expected).abs() < 1e-3, "at {lateral}: {found} is not {expected}");
    }
    Ok(())
}

#[test]
fn mirrored_positions_have_mirrored_answers_to_the_bit() -> Result<()> {
    for system in [manchester()?, en_15302_a()?] {
        let (mut one, mut other) = (system.search(), system.search());
        for (lateral, yaw) in [(0.0, 0.0), (1.5, 0.0), (5.0, 0.01), (-7.0, 0.02), (9.0, -0.03)] {
            for roll in [Roll::Solve, Roll::Neglect, Roll::Fixed(0.004)] {
                let back = if let Roll::Fixed(roll) = roll { Roll::Fixed(-roll) } else { roll };
                let selection = Selection { within: 1.0, apart: 0.0 };
                let there = one.touch(&Position { lateral, yaw, roll }, &selection)?;
                let here = other.touch(&Position { lateral: -lateral, yaw: -yaw, roll: back }, &selection)?;
                // Two equal Newton iterates may end a rounding apart, since −0 − x is not 0 + x in a bracket.
                assert!((there.roll + here.roll).abs() < 1e-16, "{} {}", there.roll, here.roll);
                for side in 0..2 {
                    let (a, b) = (there.sides[side], here.sides[1 - side]);
                    assert!((a.z - b.z).abs() < 2e-13, "{} {}", a.z, b.z);
                    assert_eq!(a.touch.contacts.len(), b.touch.contacts.len());
                }
            }
        }
    }
    Ok(())
}

#[test]
fn a_solved_roll_makes_both_wheels_touch() -> Result<()> {
    for system in [manchester()?, en_15302_a()?] {
        let mut search = system.search();
        for k in -40..=40 {
            let position =
                Position { lateral: 0.25 * f64::from(k), yaw: 5e-4 * f64::from(k), roll: Roll::Solve };
            let touch = search.touch(&position, &ALL)?;
            let [left, right] = touch.sides.map(|side| side.z);
            assert!((left - right).abs() < 6e-13, "{position:?}: {left} {right}");
        }
    }
    Ok(())
}

#[test]
fn contact_jumps_pass_through_two_points_of_contact() -> Result<()> {
    let system = manchester()?;
    let mut search = system.search();
    // Displacements between which the right-hand wheel's contact jumps past a place on the rail: on the tread, into
    // the flange root, onto the flange.
    for (mut low, mut high, past) in [(0.2, 0.3, -5.0), (5.0, 5.1, -20.0), (6.6, 6.7, -32.0)] {
        let mut last = Vec::new();
        for _ in 0..60 {
            let lateral = (low + high) / 2.0;
            let position = Position { lateral, yaw: 0.0, roll: Roll::Neglect };
            let touch = search.touch(&position, &Selection { within: 0.1, apart: 0.1 })?;
            last = touch.sides[1].touch.contacts.to_vec();
            if last[0].rail_x > past { low = lateral } else { high = lateral }
        }
        assert!(last.len() > 1 && last[1].gap < 1e-12, "at {low}: {last:?}");
        assert!((last[0].rail_x - last[1].rail_x).abs() > 3.0, "at {low}: {last:?}");
    }
    Ok(())
}

#[test]
fn attitudes_stand_where_the_rotation_puts_the_wheelset() -> Result<()> {
    let system = manchester()?;
    let (out, radius) = (system.right().wheelset.wheel_x, system.right().wheelset.radius);
    for (lateral, yaw, roll) in [(5.0, 0.012, -0.0004), (10.0, -0.3, -0.0113), (-6.0, 0.05, 0.2)] {
        let position = Position { lateral, yaw, roll: Roll::Fixed(roll) };
        let axle = position.rotation(roll) * Vector3::x();
        let closed = Vector3::new(yaw.cos() * roll.cos(), yaw.sin(), -yaw.cos() * roll.sin());
        assert!((axle - closed).norm() < 1e-15, "{axle} {closed}");
        assert_eq!(position.rotation(roll), Pose::new(lateral, yaw, roll)?.rotation());
        for sign in [-1.0, 1.0] {
            let (attitude, level) = system.attitude(&position, roll, usize::from(sign > 0.0));
            // The side's own axes, mirrored on the left: middle of the axle to the wheel profile's origin.
            let origin = wheel_rotation(sign * yaw, sign * roll) * Vector3::new(out, 0.0, -radius);
            let x = sign * lateral + origin.x - system.right().track.rail_x;
            assert!((attitude.offset - x).abs() < 1e-12, "{} {x}", attitude.offset);
            // With both origins level the axle's middle is `level` above R over the top of rail.
            let z = radius + level + origin.z - system.right().track.rail_z;
            assert!(z.abs() < 1e-12, "{z}");
        }
    }
    Ok(())
}

#[test]
fn a_contact_is_placed_with_its_angles_and_its_skew() -> Result<()> {
    let system = manchester()?;
    let pair = Pair::new(
        standards::rail("UIC60")?.rotated(inclination(1.0, 40.0)?),
        standards::wheel("S1002")?,
        460.0,
    )?;
    let mut search = system.search();
    for (lateral, yaw) in [(0.0, 0.0), (3.0, 0.01), (6.5, -0.02)] {
        let position = Position { lateral, yaw, roll: Roll::Solve };
        let touch = search.touch(&position, &ALL)?;
        for contact in touch.sides.iter().flat_map(|side| side.touch.contacts) {
            let placement = contact.placed(&pair)?;
            let [rail, wheel] = [placement.rail(), placement.wheel()];
            assert_eq!((placement.skew(), placement.pair().wheel_radius()), (contact.skew, 460.0));
            assert_eq!([rail.is_smooth(), wheel.is_smooth()], [!contact.rail_kink, !contact.wheel_kink]);
            assert!((rail.contact_angle() - contact.contact_angle).abs() < 1e-12, "{contact:?}");
            assert!((wheel.contact_angle() - contact.wheel_angle).abs() < 1e-12, "{contact:?}");
            let c = rail.contact_frame() * Point2::origin();
            assert!((c - Point2::new(contact.rail_x, contact.rail_z)).norm() < 1e-12, "{contact:?}");
        }
    }
    Ok(())
}

#[test]
fn skew_turns_the_wheel_s_frame_into_the_rail_s() -> Result<()> {
    let system = manchester()?;
    let mut search = system.search();
    for (lateral, yaw, roll) in [(5.0, 0.012, -0.0004), (10.0, -0.024, -0.0113), (-6.0, 0.05, 0.02)] {
        let position = Position { lateral, yaw, roll: Roll::Fixed(roll) };
        let touch = search.touch(&position, &ALL)?;
        for (side, sign) in touch.sides.iter().zip([-1.0, 1.0]) {
            let c = side.touch.contacts[0];
            let (yaw, roll) = (sign * yaw, sign * roll);
            // Yaw, then roll, of the wheel's meridian tangent and circumferential direction at angle ω.
            let turned = |x, y, z| wheel_rotation(yaw, roll) * Vector3::new(x, y, z);
            let omega = -(c.wheel_angle.tan() * yaw.tan()).asin();
            let (s, t) = (c.wheel_angle.sin(), c.wheel_angle.cos());
            let meridian = turned(t, -s * omega.sin(), s * omega.cos());
            let round = turned(0.0, omega.cos(), omega.sin());
            let normal = turned(-s, -t * omega.sin(), t * omega.cos());
            let (sin, cos) = c.contact_angle.sin_cos();
            let (xi, eta, zeta) = (Vector3::new(cos, 0.0, sin), Vector3::y(), Vector3::new(-sin, 0.0, cos));
            let expected =
                [(meridian, xi, c.skew.cos()), (meridian, eta, c.skew.sin()), (round, xi, -c.skew.sin())];
            for (wheel, rail, expected) in expected {
                assert!((wheel.dot(&rail) - expected).abs() < 1e-14, "{c:?}");
            }
            assert!((round.dot(&eta) - c.skew.cos()).abs() < 1e-14, "{c:?}");
            assert!((normal.dot(&zeta) - 1.0).abs() < 1e-14, "{c:?}");
        }
    }
    Ok(())
}

#[test]
fn parallel_lines_and_equal_arcs_touch_in_their_middle() -> Result<()> {
    let line = |from, to| Ok::<_, Error>(vec![Segment::arc(Arc::line(from, to)?)]);
    let rail = Profile::new("", "", line([-10.0, -1.0], [10.0, 1.0])?)?;
    let wheel = Profile::new("", "", line([-20.0, -2.0], [20.0, 2.0])?)?;
    let pair = ProfilePair::new(&Pair::new(rail, wheel, 460.0)?)?;
    let pose = Pose::new(15.0, 0.0, 0.0)?;
    let mut search = pair.search();
    let contacts = search.touch(&pose, &ALL)?.contacts;
    assert!(contacts.iter().any(|c| (c.rail_x - 2.5).abs() < 1e-12 && !c.kink()), "{contacts:?}");

    let arc = |x| Ok::<_, Error>(vec![Segment::arc(Arc::about([0.0, 80.0], 80.0, Half::Lower, x)?)]);
    let rail = Profile::new("", "", arc([-30.0, 10.0])?)?;
    let wheel = Profile::new("", "", arc([-20.0, 20.0])?)?;
    let pair = ProfilePair::new(&Pair::new(rail, wheel, 460.0)?)?;
    let mut search = pair.search();
    let touch = search.touch(&Pose::new(0.0, 0.0, 0.0)?, &ALL)?;
    assert!(touch.height.abs() < 1e-13, "{touch:?}");
    Ok(())
}

#[test]
fn a_wheel_beside_its_rail_touches_nothing() -> Result<()> {
    let pair = ProfilePair::new(&Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?)?;
    let mut search = pair.search();
    for offset in [-200.0, 300.0] {
        let touch = search.touch(&Pose::new(offset, 0.0, 0.0)?, &ALL);
        assert_eq!(touch.map_err(|error| error.kind), Err(ErrorKind::NoContact));
    }
    assert!(Pose::new(f64::NAN, 0.0, 0.0).is_err());
    assert!(Pose::new(0.0, 1.0, 0.0).is_err());
    assert!(Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 1.0).is_err());
    Ok(())
}

#[test]
fn lengths_times_four_give_the_same_bits() -> Result<()> {
    let scaled = |k: f64| -> Result<f64> {
        let arc = |c: [f64; 2], r: f64, half, x: [f64; 2]| {
            Ok::<_, Error>(Segment::arc(Arc::about(c.map(|v| v * k), r * k, half, x.map(|v| v * k))?))
        };
        let rail = Profile::new("", "", vec![arc([0.0, -300.0], 300.0, Half::Upper, [-20.0, 25.0])?])?;
        let wheel = Profile::new("", "", vec![arc([3.0, -330.0], 330.0, Half::Upper, [-40.0, 30.0])?])?;
        let pair = ProfilePair::new(&Pair::new(rail, wheel, 460.0 * k)?)?;
        let mut search = pair.search();
        Ok(search.touch(&Pose::new(1.5 * k, 0.02, 0.01)?, &ALL)?.height / k)
    };
    assert_eq!(scaled(1.0)?.to_bits(), scaled(4.0)?.to_bits());
    assert_eq!(scaled(1.0)?.to_bits(), scaled(0.0625)?.to_bits());
    Ok(())
}
