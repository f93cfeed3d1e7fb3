//! Wheelsets whose sides differ: other profiles, other radii, rails off their places.

use std::path::Path;

use wheelrail::case::{Site, sites};
use wheelrail::search::TrackSide;
use wheelrail::{Result, scene};

fn found(text: &str) -> Result<Vec<Site>> {
    sites(&scene::resolve(&scene::parse(text, false)?, Path::new("."), "sides")?)
}

fn wheelset(rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[track]\ngauge = 1435.0\n\
         [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = 1.0\n{rest}"
    )
}

/// (side, abscissa on the rail \[mm\], rolling radius \[mm\], height \[mm\], roll \[rad\]) of the first contact of both sides.
fn touching(text: &str) -> Result<Vec<(Option<TrackSide>, [f64; 4])>> {
    let numbers = |site: Site| {
        let found = site.contact.found.unwrap();
        let place = found.place;
        (found.side, [place.rail_x_mm, place.rolling_radius_mm, found.height_mm, found.roll_rad])
    };
    let first = |site: &Site| site.contact.found.as_ref().is_some_and(|found| found.contact == 1);
    Ok(found(text)?.into_iter().filter(first).map(numbers).collect())
}

#[test]
fn sides_described_apart_and_alike_are_a_symmetric_wheelset() -> Result<()> {
    let patch = "[patch]\napproach = 0.05\n";
    let own = "[left.rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[left.wheel]\nprofile = \"S1002\"\n\
               [right.deviation]\nlateral = 0.0\n";
    assert_eq!(touching(&wheelset(patch))?, touching(&wheelset(&format!("{patch}{own}")))?);
    Ok(())
}

/// Both wheels 1 mm smaller lower the axle by 1 mm; one of them rolls it by 1 mm over their distance.
#[test]
fn a_smaller_wheel_rolls_the_axle() -> Result<()> {
    let patch = "[patch]\napproach = 0.05\n[left.wheel]\nprofile = \"cone-1:40\"\nradius = 459.0\n\
                 [right.wheel]\nprofile = \"cone-1:40\"\n";
    let sides = touching(&wheelset(patch))?;
    let [(_, right), (_, left)] = sides.as_slice() else { panic!("{sides:?}") };
    assert!((left[1] - right[1] + 1.0).abs() < 0.1, "{sides:?}");
    // roll > 0 lowers the right-hand side: the left one is lower here. The contacts are some 1480 mm apart.
    assert!((right[3] * 1480.0 + 1.0).abs() < 0.05, "{sides:?}");
    assert_eq!(left[2..], right[2..]);
    Ok(())
}

/// Rails that are both moved to the right by as much as the wheelset was are where they were, seen from it.
#[test]
fn deviations_are_in_track_axes() -> Result<()> {
    let rest = |lateral: f64| {
        format!(
            "[patch]\napproach = 0.05\n[left.deviation]\nlateral = {lateral:?}\nvertical = -2.0\n\
             [right.deviation]\nlateral = {lateral:?}\nvertical = -2.0\n"
        )
    };
    let (moved, still) =
        (touching(&wheelset(&rest(1.0)))?, touching(&wheelset("[patch]\napproach = 0.05\n"))?);
    // The wheelset stands at 1 mm: seen from the moved rails it is centred.
    let centred = wheelset("[patch]\napproach = 0.05\n").replace("lateral = 1.0", "lateral = 0.0");
    for ((_, a), (_, b)) in moved.iter().zip(touching(&centred)?) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[2] - b[2] + 2.0).abs() < 1e-9, "{a:?} {b:?}");
    }
    assert_ne!(moved[0].1[0], still[0].1[0]);
    Ok(())
}

/// A roll of both rails is a roll of the track: the right-hand rail leans as if it was inclined by so much less.
#[test]
fn a_rail_rolls_clockwise_on_the_right() -> Result<()> {
    let inclined = "[right.rail]\nprofile = \"60E1\"\nrotate = 0.0249947936189\n[patch]\napproach = 0.05\n";
    let rolled = "[right.rail]\nprofile = \"60E1\"\n[right.deviation]\nroll = -0.0249947936189\n[patch]\napproach = 0.05\n";
    let [a, b] = [touching(&wheelset(inclined))?, touching(&wheelset(rolled))?];
    // The gauge is that of the rail before it rolls, so that the places differ by what the roll moves the gauge face.
    assert!((a[0].1[0] - b[0].1[0]).abs() < 0.5 && a[0].1[0] != b[0].1[0], "{a:?} {b:?}");
    Ok(())
}

#[test]
fn sides_that_make_no_sense_are_named() {
    let complaint = |text: &str| found(text).err().map(|error| error.to_string()).unwrap_or_default();
    let far = complaint(&wheelset("[left.deviation]\nlateral = 800.0\n"));
    assert!(far.contains("left: deviation: lateral: found -800; expected a rail on its side"), "{far}");
    let turned = complaint(&wheelset("[right.deviation]\nroll = 2.0\n"));
    assert!(turned.contains("right: deviation: roll: found 2"), "{turned}");
    let wrong = complaint(&wheelset("[left.wheel]\nprofile = \"60E1\"\n"));
    assert!(wrong.contains("left: wheel: profile: found \"60E1\", a rail"), "{wrong}");
    let single = complaint(
        "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\noffset = 0.0\n\
         [left.deviation]\nlateral = 1.0\n",
    );
    assert!(single.contains("left: found a side beside [contact]; expected"), "{single}");
}
