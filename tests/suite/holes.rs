//! Holes of lists of slices: where neighbours show different parts, and no features say what belongs together.

use std::path::PathBuf;
use std::sync::Arc;

use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::lofted::{Joining, Loft, LoftSlice};
use wheelrail::placement::{Track, Wheelset};
use wheelrail::scene;
use wheelrail::search::{
    EventKind, LoftedPair, March, ONE_CONTACT, Position, Roll, Selection, SideOnTrack, Stop, TrackSide,
    WheelsetOnTrack,
};
use wheelrail::{Half, Interval, Profile, Segment, WheelDistance};

use super::campaign::scenes;
use crate::common::repository;

const SPACING: f64 = 1500.0;
const RADIUS: f64 = 460.0;

/// A head of one crown with corners of 13 mm, z at its top, and flanks of 10:1 that go down by so much to the left and to the right
/// \[mm\]; with only the right half of it where it is cut.
fn head(z: f64, [left, right]: [f64; 2], cut: bool) -> Profile {
    let arc =
        |centre, radius, x| Segment::arc(wheelrail::Arc::about(centre, radius, Half::Upper, x).unwrap());
    let (crown, corner, half) = (300.0, 13.0, 20.0);
    let shoulder = crown - f64::sqrt(crown * crown - half * half);
    let (a, b) = (half - corner * half / crown, -shoulder - corner * (1.0 - shoulder / crown));
    // The corners end where they are as steep as the flanks.
    let (sin, cos) = (10.0 / f64::sqrt(101.0), 1.0 / f64::sqrt(101.0));
    let end = [a + corner * sin, b + corner * cos];
    let line = |from, to| Segment::arc(wheelrail::Arc::line(from, to).unwrap());
    let mut all = vec![
        line([-end[0] - left / 10.0, end[1] - left], [-end[0], end[1]]),
        arc([-a, b], corner, [-end[0], -half]),
        arc([0.0, -crown], crown, [-half, half]),
        arc([a, b], corner, [half, end[0]]),
        line(end, [end[0] + right / 10.0, end[1] - right]),
    ];
    if cut {
        all.splice(..3, [arc([0.0, -crown], crown, [5.0, half])]);
    }
    Profile::new("head", "", all).unwrap().shifted(0.0, z)
}

/// A list of slices with holes, and what is true of it.
struct RandomList {
    slices: Vec<LoftSlice>,
    holes: Vec<Interval>,
    /// Rise of the rail along the track.
    rate: f64,
    wheel: Profile,
}

/// Makes a rail that rises at a rate, whose flanks an instrument has seen down to random depths, and some of whose slices lack the half
/// of the head. Half of the lists have no such slice.
fn random_list(random: &mut Random) -> RandomList {
    let rate = if random.below(2) == 0 { 0.0 } else { random.between(-0.03, 0.03) };
    let holed = random.below(2) == 0;
    let (mut slices, mut holes, mut at) = (Vec::new(), Vec::new(), -300.0);
    let mut depths = [6.0; 2];
    let mut before: Option<(f64, bool)> = None;
    while at < 300.0 {
        for depth in &mut depths {
            if random.below(3) == 0 {
                *depth = *random.pick(&[6.0, 22.0, 38.0]);
            }
        }
        // A slice of half a head stands alone.
        let cut = holed && random.below(4) == 0 && before.is_some_and(|(_, cut)| !cut);
        slices.push(LoftSlice {
            at,
            name: format!("at {at:.1}"),
            profile: head(rate * at, depths, cut),
            features: Vec::new(),
            measured_along: None,
        });
        if let Some((last, _)) = before.filter(|(_, was_cut)| cut || *was_cut) {
            // A slice between two holes has no surface either: it has no neighbour.
            match holes.last_mut() {
                Some(Interval { high, .. }) if *high == last => *high = at,
                _ => holes.push(Interval::new(last, at)),
            }
        }
        before = Some((at, cut));
        at += random.between(5.0, 60.0);
    }
    let tread = wheelrail::Arc::line([-40.0, 0.0], [40.0, 0.0]).unwrap();
    let wheel = Profile::new("tread", "", vec![Segment::arc(tread)]).unwrap();
    RandomList { slices, holes, rate, wheel }
}

fn march_over(list: &RandomList) -> Result<March> {
    let loft = Arc::new(Loft::new(&list.slices, Joining::Monotone)?);
    let reach = loft.reach();
    let pair = Arc::new(LoftedPair::new(loft, &list.wheel, RADIUS)?);
    let axle = Wheelset::new(WheelDistance::Spacing(SPACING), RADIUS)?;
    let side = SideOnTrack::lofted(pair, Track::between_origins(SPACING)?, axle);
    let selection = Selection { within: 0.5, apart: ONE_CONTACT };
    let position = Position { lateral: 0.0, yaw: 0.0, roll: Roll::Fixed(0.0) };
    Ok(March { system: WheelsetOnTrack::symmetrical(side), position, selection, reach, pitch: 0.0 })
}

/// A cylinder on a rail that rises at a rate has a closed form, whatever the instrument has seen of the flanks. Where half of the head is
/// missing there is nothing: neither contact, nor event, nor a place that bridges the hole.
#[test]
fn a_march_stops_at_holes_and_goes_on_over_flanks_seen_deeper() -> Result<()> {
    let mut random = Random::new(6511);
    let (mut over, mut on, mut deeper) = (0, 0, 0);
    for number in 0..scenes() {
        let list = random_list(&mut random);
        let march = march_over(&list)?;
        assert_eq!(march.holes(march.reach), list.holes, "list {number}");
        deeper += usize::from(list.holes.is_empty());
        let length = f64::hypot(1.0, list.rate);
        let ahead = RADIUS * list.rate / length;
        let last = list.slices.last().unwrap().at;
        let places: Vec<f64> = (0..80).map(|k| -270.0 + (last + 240.0) * f64::from(k) / 79.0).collect();
        let (mut stops, mut events): (Vec<Stop>, Vec<_>) = Default::default();
        march.blocks(&places, |some, found| {
            stops.extend_from_slice(some);
            events.extend_from_slice(found);
            Ok(true)
        })?;
        // With near misses up to half a millimetre, the edges of a hole beyond would be second places.
        assert!(events.is_empty(), "list {number}: {events:?}");
        for stop in &stops {
            let missing = |at: f64| list.holes.iter().any(|hole| hole.low < at && at < hole.high);
            let hole = missing(stop.along) || missing(stop.along + ahead);
            let place = format!("list {number} at {}: {:?}", stop.along, list.holes);
            assert_eq!(stop.holes, [hole; 2], "{place}");
            assert_eq!(stop.rows.len(), if hole { 0 } else { 2 }, "{place}");
            for row in &stop.rows {
                let height = list.rate * stop.along + RADIUS * (length - 1.0);
                assert!((row.z - height).abs() < 1e-8, "{place}: {} instead of {height}", row.z);
                assert!((row.contact.y - ahead).abs() < 1e-4, "{place}: {:?}", row.contact);
            }
            if hole { over += 1 } else { on += 1 }
        }
    }
    assert!(over > 20 && on > 200 && deeper > 3, "{over} {on} {deeper}");
    Ok(())
}

#[test]
fn a_run_in_a_hole_is_refused_by_name() {
    let mut random = Random::new(7);
    let list =
        std::iter::repeat_with(|| random_list(&mut random)).find(|list| !list.holes.is_empty()).unwrap();
    let march = march_over(&list).unwrap();
    let mut search = march.system.search();
    search.stand_at(list.holes[0].middle(), 0.0);
    let error = search.touch(&march.position, &march.selection).unwrap_err();
    assert!(error.to_string().starts_with("wheelset: along: found a hole of the list"), "{error}");
}

/// The measured crossing of the repository that `WHEELRAIL_CONTACT` names: its holes, the transfer from wing to nose, and one to the casting.
#[test]
fn a_measured_crossing_has_its_holes_and_two_hard_transfers() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let text = std::fs::read_to_string(repository("tests/defects/march-holes.toml")).unwrap();
    let case = scene::march(&scene::parse(&text.replace("CONTACT/", ""), false)?, &copy)?;
    let march = &case.march;
    let holes: Vec<[f64; 2]> = march.holes(march.reach).into_iter().map(Interval::ends).collect();
    let expected = [[-592.57, -568.93], [113.95, 118.94], [1058.53, 1098.1], [1714.08, 1731.73]];
    let off = holes.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs());
    assert!(holes.len() == expected.len() && off.fold(0.0, f64::max) < 1e-9, "{holes:?}");
    assert_eq!(case.profiles.right.pair.rail().name, "uk_crossing.slcs");
    let places: Vec<f64> = (-80..=200).map(|k| 10.0 * f64::from(k)).collect();
    let (mut stops, mut events): (Vec<Stop>, Vec<_>) = Default::default();
    march.blocks(&places, |some, found| {
        stops.extend_from_slice(some);
        events.extend_from_slice(found);
        Ok(true)
    })?;
    for stop in &stops {
        let inside = holes.iter().any(|hole| hole[0] < stop.along && stop.along < hole[1]);
        assert!(!inside || stop.rows.is_empty() && stop.holes == [true; 2], "{stop:?}");
    }
    for event in &events {
        assert!(holes.iter().all(|hole| event.along < hole[0] || event.along > hole[1]), "{event:?}");
    }
    // Where the casting begins its field side rises by 40 mrad; then comes the transfer from wing to nose.
    let hard = events.iter().filter(|event| event.side == TrackSide::Right && event.impact_angle() > 0.0183);
    let hard: Vec<_> = hard.map(|event| (event.kind, event.along, event.impact_angle())).collect();
    let expected = [(-690.93, 0.01906), (251.98, 0.01860)];
    let same = |(found, expected): (&(EventKind, f64, f64), &(f64, f64))| {
        found.0 == EventKind::Transfer
            && (found.1 - expected.0).abs() < 0.1
            && (found.2 - expected.1).abs() < 1e-4
    };
    assert!(hard.len() == expected.len() && hard.iter().zip(&expected).all(same), "{hard:?}");
    Ok(())
}
