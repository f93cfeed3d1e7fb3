//! Placed pairs as engineers have them, and some that nobody has.

use wheelrail::conformal::NormalGap;
use wheelrail::internal::Random;
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape, inclination, standards};
use wheelrail::{ONE_CONTACT, Pair, Placement, Pose, ProfilePair, Selection};
use wheelrail_report::specimen::{Instrument, Specimen, SpecimenKind};

/// Yaw and skew angles \[rad\].
const YAWS: [f64; 4] = [0.0, 0.01, 0.02, 0.05];

/// Kinds of placed pairs.
pub const KINDS: [&str; 4] = ["lowered", "chosen", "measured", "strange"];

/// Profiles that random pairs are made of.
pub struct Stock {
    built_in: [Vec<Profile>; 2],
    measured: [Vec<Profile>; 2],
    strange: [Vec<Profile>; 2],
}

/// A placed pair with its name.
pub struct Placed {
    pub name: String,
    pub placement: Placement,
}

impl Stock {
    pub fn new() -> Self {
        let rails = standards::rail_names().map(standards::rail).map(|rail| rail.expect("a rail"));
        let wheels = standards::wheel_names().map(standards::wheel).map(|wheel| wheel.expect("a wheel"));
        let measured = |kinds: &[SpecimenKind]| {
            let files = kinds.iter().flat_map(|&kind| [(kind, 3), (kind, 4)]);
            let profile = |(kind, seed): (SpecimenKind, u64)| {
                let instrument = Instrument::new(0.3, 2.0 * (seed - 3) as f64, seed);
                Specimen::new(kind, instrument).and_then(|specimen| specimen.profile()).ok()
            };
            files.filter_map(profile).collect::<Vec<_>>()
        };
        Self {
            built_in: [rails.collect(), wheels.collect()],
            measured: [measured(&SpecimenKind::RAILS), measured(&SpecimenKind::WHEELS)],
            strange: strange().expect("profiles"),
        }
    }

    /// The pairs of a number and a kind; none where the two do not meet, or where the rail hides C.
    pub fn placed(&self, kind: usize, number: u64) -> Vec<Placed> {
        let mut all = self.met(kind, number);
        all.retain(|placed| NormalGap::new(&placed.placement).rail().reach().is_some());
        all
    }

    fn met(&self, kind: usize, number: u64) -> Vec<Placed> {
        let mut dice = Random::new(number ^ (kind as u64) << 32);
        let [rails, wheels] = match kind {
            0 | 1 => &self.built_in,
            2 => &self.measured,
            _ => &self.strange,
        };
        let (rail, wheel) = (dice.pick(rails).clone(), dice.pick(wheels).clone());
        let rotation = *dice.pick(&[0.0, 1.0 / 20.0, 1.0 / 40.0]);
        let rail = rail.rotated(inclination(rotation, 1.0).expect("a rotation"));
        let (radius, yaw) = (dice.between(200.0, 600.0), *dice.pick(&YAWS) * *dice.pick(&[-1.0, 1.0]));
        let name = format!(
            "{} {number}: {} at {rotation} under {}, R {radius}, yaw {yaw}",
            KINDS[kind], rail.name, wheel.name
        );
        let pair = Pair::new(rail, wheel, radius).expect("a pair");
        if kind == 1 || (kind == 3 && dice.below(2) == 0) {
            let at = [dice.between(-36.0, 36.0), dice.between(-60.0, 60.0)];
            let placement = pair.placed(at[0], at[1], yaw).ok();
            let name = format!("{name}, points {at:?}");
            return placement.map(|placement| Placed { name, placement }).into_iter().collect();
        }
        // Half the wheels stand where the flange is near the rail.
        let offset = if dice.below(2) == 0 { dice.between(-9.0, 9.0) } else { dice.between(1.0, 9.0) };
        let Ok(profiles) = ProfilePair::new(&pair) else { return Vec::new() };
        let pose = Pose::new(offset, yaw, dice.between(-0.01, 0.01)).expect("a pose");
        let mut search = profiles.search();
        let touch = search.touch(&pose, &Selection { within: 0.5, apart: ONE_CONTACT });
        let contacts = touch.map_or_else(|_| Vec::new(), |touch| touch.contacts.to_vec());
        let placed = contacts.iter().enumerate().filter_map(|(k, contact)| {
            let placement = contact.placed(&pair).ok()?;
            Some(Placed { name: format!("{name}, offset {offset}, contact {k}"), placement })
        });
        placed.collect()
    }
}

/// Rails and wheels with kinks, grooves, vertical sides, overhangs and polynomials; some wheels are met three times by a line.
pub fn strange() -> wheelrail::Result<[Vec<Profile>; 2]> {
    let chain = |name: &str, points: &[[f64; 2]]| {
        let lines = points.windows(2).map(|ends| Arc::line(ends[0], ends[1]).map(Segment::arc));
        Profile::new(name, "", lines.collect::<wheelrail::Result<_>>()?)
    };
    let curve = |name: &str, c: &[f64], reach: f64| {
        let curve = Polynomial::graph(c, [-reach, reach])?;
        Profile::new(name, "", vec![Segment { label: String::new(), shape: Shape::Polynomial(curve) }])
    };
    let arc = |name: &str, r: f64, half: Half| {
        let centre = if half == Half::Upper { -r } else { r };
        Profile::new(name, "", vec![Segment::arc(Arc::about([0.0, centre], r, half, [-0.98 * r, 0.98 * r])?)])
    };
    let rails = vec![
        arc("corner", 13.0, Half::Upper)?,
        arc("crown", 80.0, Half::Upper)?,
        curve("two crowns", &[-0.16, 0.0, 8e-4, 0.0, -1e-6], 38.0)?,
        curve("wave", &[0.0, 0.02, -2e-3, 3e-5, -1e-6], 36.0)?,
        chain(
            "kinked",
            &[
                [-36.0, -30.0],
                [-35.0, -6.0],
                [-28.0, -1.5],
                [-8.0, 0.0],
                [9.0, 0.1],
                [27.0, -1.0],
                [36.0, -12.0],
                [36.0, -20.0],
            ],
        )?,
        chain(
            "grooved",
            &[
                [-60.0, -20.0],
                [-58.0, -1.0],
                [-50.0, -1.0],
                [-46.0, -14.0],
                [-40.0, -14.0],
                [-36.0, -1.0],
                [0.0, 0.0],
                [36.0, -1.0],
                [37.0, -20.0],
            ],
        )?,
    ];
    let wheels = vec![
        arc("root", 14.5, Half::Upper)?,
        arc("ball", 120.0, Half::Lower)?,
        curve("hollow", &[0.0, 0.03, -1e-3, -1e-5, 2e-6], 40.0)?,
        curve("waves", &[0.0, -0.05, -4e-3, 6e-5, 2.5e-6], 45.0)?,
        chain(
            "kinked flange",
            &[
                [-60.0, 10.0],
                [-58.0, -20.0],
                [-50.0, -28.0],
                [-44.0, -26.0],
                [-37.0, -6.0],
                [-30.0, -1.0],
                [0.0, 0.0],
                [30.0, 0.4],
                [50.0, 3.0],
                [55.0, 12.0],
            ],
        )?,
        chain(
            "two flanges",
            &[
                [-50.0, -20.0],
                [-42.0, -22.0],
                [-36.0, -2.0],
                [0.0, 0.0],
                [36.0, 1.0],
                [42.0, -18.0],
                [50.0, -18.0],
            ],
        )?,
    ];
    Ok([rails, wheels])
}
