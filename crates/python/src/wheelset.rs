//! Wheelsets on their track.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::case::{ConicityBasis, ContactDoubts, Doubt, SideLandmarks, usual};
use wheelrail::measured::GAUGE_HEIGHT;
use wheelrail::placement::{self, Track};
use wheelrail::scene;
use wheelrail::search::{
    self, Conicity, ONE_CONTACT, Position, Roll, Selection, SideOnTrack, TrackSide, WheelsetOnTrack,
};
use wheelrail::{Error, ErrorKind, RailDistance, WheelDistance};

use crate::asked::{asked, checked_modulus};
use crate::errors::{OrRaise, exception, say, warn};
use crate::long::waited;
use crate::pair::Pair;
use crate::positions::{RollArgument, positions};
use crate::sweep::{AskedOfSweep, sweep};
use crate::values::made;

/// A wheelset on its track: a pair of profiles on the right, and its mirror image, or that of the pair `left`, on the left.
/// Lengths in mm.
///
/// The track is given by its `gauge`, measured down to `gauge_height` below the top of rail (14 if None), or by
/// `rail_spacing`, the distance between the rail profiles' origins. The wheelset is given by the distance `back_to_back`
/// between the flange backs, which lie at `flange_back_x` on the wheel profile, or by `wheel_spacing`, the distance between
/// the wheel profiles' origins. A wheelset can be pickled, and used by several threads at once.
///
///     >>> track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
///     >>> round(track.conicity(3.0), 4)
///     0.1771
///
/// Raises InputError for a track or wheelset given twice or not at all, distances that are not positive or in another unit, and a
/// rail without a gauge face; warns of distances that belong to no railway.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Wheelset {
    pair: Pair,
    /// The pair of the left-hand side, where it is another one.
    left: Option<Pair>,
    system: Arc<WheelsetOnTrack>,
    landmarks: Arc<SideLandmarks>,
    distances: Distances,
}

/// The distances of a wheelset and its track, by their keywords.
type Distances = [(&'static str, Option<f64>); 6];

#[pymethods]
impl Wheelset {
    #[new]
    #[pyo3(signature = (pair, *, left = None, gauge = None, gauge_height = None, rail_spacing = None, back_to_back = None,
                        flange_back_x = None, wheel_spacing = None))]
    #[expect(clippy::too_many_arguments, reason = "these are keywords")]
    fn new(
        py: Python<'_>,
        pair: &Pair,
        left: Option<&Pair>,
        gauge: Option<f64>,
        gauge_height: Option<f64>,
        rail_spacing: Option<f64>,
        back_to_back: Option<f64>,
        flange_back_x: Option<f64>,
        wheel_spacing: Option<f64>,
    ) -> PyResult<Self> {
        let given = |keys: &[(&str, Option<f64>)]| {
            let keys: Vec<(&str, bool)> = keys.iter().map(|(key, value)| (*key, value.is_some())).collect();
            wheelrail::error::given(&keys)
        };
        let distances = [
            ("gauge", gauge),
            ("gauge_height", gauge_height),
            ("rail_spacing", rail_spacing),
            ("back_to_back", back_to_back),
            ("flange_back_x", flange_back_x),
            ("wheel_spacing", wheel_spacing),
        ];
        let rails = match (gauge, gauge_height, rail_spacing) {
            (Some(gauge), height, None) => {
                let gauge = scene::distance("gauge", gauge).or_raise()?;
                RailDistance::Gauge { gauge, height: height.unwrap_or(GAUGE_HEIGHT) }
            }
            (None, None, Some(spacing)) => {
                RailDistance::Spacing(scene::distance("rail_spacing", spacing).or_raise()?)
            }
            _ => {
                let expected = "either `gauge` with perhaps `gauge_height`, or `rail_spacing`";
                let error =
                    Error::new("Wheelset", given(&distances[..3]), expected, "keep one of the two forms");
                return Err(exception(error));
            }
        };
        let wheels = match (back_to_back, flange_back_x, wheel_spacing) {
            (Some(distance), Some(flange_back_x), None) => {
                let distance = scene::distance("back_to_back", distance).or_raise()?;
                WheelDistance::BackToBack { distance, flange_back_x }
            }
            (None, None, Some(spacing)) => {
                WheelDistance::Spacing(scene::distance("wheel_spacing", spacing).or_raise()?)
            }
            _ => {
                let expected = "either `back_to_back` and `flange_back_x`, or `wheel_spacing`";
                let error =
                    Error::new("Wheelset", given(&distances[3..]), expected, "keep one of the two forms");
                return Err(exception(error));
            }
        };
        let system = system_of(pair, left, rails, wheels).or_raise()?;
        let marks = |pair: &Pair| pair.landmarks.on(TrackSide::Right).clone();
        let both = |left| Arc::new(SideLandmarks::new(marks(pair), Some(marks(left))));
        let landmarks = left.map_or_else(|| Arc::clone(&pair.landmarks), both);
        let made =
            Self { pair: pair.clone(), left: left.cloned(), system: Arc::new(system), landmarks, distances };
        warn(py, made.doubts_of_distances())?;
        Ok(made)
    }

    /// The profiles of the right-hand side.
    #[getter]
    fn pair(&self) -> Pair {
        self.pair.clone()
    }

    /// The profiles of the left-hand side, described as a right-hand one; those of `pair` where no others are given.
    #[getter]
    fn left(&self) -> Pair {
        self.left_pair().clone()
    }

    /// Lower the wheelset until both wheels touch: `lateral` mm to the right, turned by `yaw` in rad, which moves the
    /// right-hand wheel forward when it is positive.
    ///
    /// `roll` is "solve" (both wheels touch), "neglect" (0, the convention of EN 15302: each side is lowered on its own) or an
    /// angle in rad, which lowers the right-hand wheel when it is positive. `within` mm: near misses up to this vertical gap
    /// are contacts too.
    ///
    /// Raises GeometryError for a wheelset beside its track; InputError for values that are not finite and angles beyond
    /// 0.5 rad.
    #[pyo3(signature = (lateral = 0.0, *, yaw = 0.0, roll = RollArgument::Word("solve".into()), within = 0.0))]
    fn touch<'py>(
        &self,
        py: Python<'py>,
        lateral: f64,
        yaw: f64,
        roll: RollArgument,
        within: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let position = Position { lateral, yaw, roll: roll.roll()? };
        let within = scene::within(Some(within)).or_raise()?;
        let mut search = self.system.search();
        let selection = Selection { within, apart: ONE_CONTACT };
        let found = search.touch(&position, &selection);
        let fixed = if let Roll::Fixed(roll) = position.roll { roll } else { 0.0 };
        warn(
            py,
            [("yaw", yaw), ("roll", fixed)].into_iter().filter_map(|(name, angle)| usual::angle(name, angle)),
        )?;
        let touch = found.or_raise()?;
        let contacts = touch.sides.each_ref().map(|side| side.touch.contacts);
        warn(py, self.doubts_of_contacts(contacts.map(<[_]>::first)))?;
        let z = (touch.sides[0].z, touch.sides[1].z);
        let left = self.left_pair().contacts("left", contacts[0]);
        let right = self.pair.contacts("right", contacts[1]);
        made(py, "Touch", (lateral, yaw, touch.roll, z, left, right))
    }

    /// Compute the equivalent conicity at an amplitude in mm: the tangent of the cone that a wheelset of the same wavelength has.
    ///
    /// `roll` is "solve" or "neglect", the convention of EN 15302.
    ///
    /// Raises InputError for an amplitude that is not positive; GeometryError where the wheelset leaves its track before the movement
    /// turns, or the movement does not come back. Warns where two integrations differ by more than their errors, and of contacts on the
    /// way that no wheel stands at.
    #[pyo3(signature = (amplitude, *, roll = RollArgument::Word("solve".into())))]
    fn conicity(&self, py: Python<'_>, amplitude: f64, roll: RollArgument) -> PyResult<f64> {
        let roll = roll.roll()?;
        let radii = [self.left_pair(), &self.pair].map(|pair| pair.pair.wheel_radius());
        let radius = move |side| radii[usize::from(side == TrackSide::Right)];
        let (system, landmarks) = (Arc::clone(&self.system), Arc::clone(&self.landmarks));
        let (found, doubts) = waited(py, move |_| {
            let table = Conicity::new(&system, amplitude, roll)?;
            let found = table.at(amplitude);
            let doubts = match found {
                Ok(_) => {
                    let basis = ConicityBasis::new(&system, &table, roll)?;
                    basis.doubts(&[amplitude], &landmarks, radius)
                }
                Err(_) => Vec::new(),
            };
            Ok((found, doubts))
        })?;
        let found = found.map_err(|why| {
            let expected = "a rolling radius that grows towards the flange";
            let error = Error::new("amplitude", why.to_string(), expected, "take a smaller amplitude");
            exception(error.of_kind(ErrorKind::Geometry))
        })?;
        for doubt in &doubts {
            say(py, "conicity", doubt, "see `wheelrail.conicity`")?;
        }
        Ok(found.conicity)
    }

    /// Find the contacts at many positions: a table with a row for each position, side and contact.
    ///
    /// `lateral` in mm, `yaw` in rad and `roll` are arrays or numbers, of one length once numbers are repeated; `roll` may
    /// also be "solve" or "neglect", for all positions. `within` mm: near misses up to this vertical gap are contacts too.
    /// `conicity` adds the equivalent conicity at the amplitude of every lateral displacement; it needs the roll "solve" or
    /// "neglect". `load` in N or `approach` in mm adds the semi-axes of Hertz's ellipses, with E* `modulus` in N/mm2.
    ///
    /// It runs on all threads without the GIL and gives the same bits on any number of them. `progress(done, all)` is called
    /// about twenty times a second, with positions; an exception in it ends the sweep, and so does Ctrl-C within 0.2 s.
    /// `progress=True` shows a bar of tqdm.
    ///
    /// Raises InputError for lengths that differ, values that are not finite, and angles beyond 0.5 rad; LimitError for more
    /// than 10**7 positions; warns in one line of the places that no wheel stands at, which the column `doubt` has.
    #[pyo3(signature = (lateral, yaw = None, roll = None, *, within = 0.0, conicity = true, load = None, approach = None,
                        modulus = None, progress = None))]
    #[expect(clippy::too_many_arguments, reason = "these are keywords")]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        lateral: &Bound<'py, PyAny>,
        yaw: Option<&Bound<'py, PyAny>>,
        roll: Option<&Bound<'py, PyAny>>,
        within: f64,
        conicity: bool,
        load: Option<f64>,
        approach: Option<f64>,
        modulus: Option<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ellipses = match (load, approach) {
            (None, None) => {
                checked_modulus(py, modulus)?;
                None
            }
            _ => Some(asked(py, load, approach, modulus)?),
        };
        let within = scene::within(Some(within)).or_raise()?;
        warn(py, approach.and_then(|approach| usual::approach(self.pair.pair.rail(), approach, false)))?;
        let positions = positions(lateral, yaw, roll)?;
        let asked = AskedOfSweep { within, conicity, ellipses };
        let radii = [self.left_pair(), &self.pair].map(|pair| pair.pair.wheel_radius());
        let bodies = (Arc::clone(&self.system), Arc::clone(&self.landmarks), radii);
        sweep(py, bodies, positions, asked, progress.as_ref())
    }

    fn __repr__(&self) -> String {
        let left = self.left.as_ref().map(|left| format!("left={}", left.__repr__()));
        let given = self.distances.iter().filter_map(|(key, value)| Some(format!("{key}={:?}", (*value)?)));
        let given: Vec<String> = left.into_iter().chain(given).collect();
        format!("Wheelset({}, {})", self.pair.__repr__(), given.join(", "))
    }

    fn __eq__(&self, other: &Self) -> bool {
        let same = |(one, other): (&Pair, &Pair)| one.__eq__(other);
        let pairs = [(&self.pair, &other.pair), (self.left_pair(), other.left_pair())];
        self.distances == other.distances
            && self.left.is_some() == other.left.is_some()
            && pairs.into_iter().all(same)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((Pair,), Bound<'py, PyDict>)> {
        let keywords = PyDict::new(py);
        keywords.set_item("left", self.left.clone())?;
        for (key, value) in self.distances {
            keywords.set_item(key, value)?;
        }
        Ok(((self.pair.clone(),), keywords))
    }
}

impl Wheelset {
    /// Gives the system, and the pairs of the left and the right side.
    pub(crate) fn parts(&self) -> (Arc<WheelsetOnTrack>, [wheelrail::Pair; 2]) {
        (Arc::clone(&self.system), [self.left_pair().pair.clone(), self.pair.pair.clone()])
    }

    fn left_pair(&self) -> &Pair {
        self.left.as_ref().unwrap_or(&self.pair)
    }

    /// Lists what is doubtful about the distances.
    fn doubts_of_distances(&self) -> Vec<Doubt> {
        let [gauge, height, _, back, back_x, _] = self.distances.map(|(_, value)| value);
        let mut out = Vec::from_iter(height.and_then(|height| usual::gauge_height("gauge_height", height)));
        let places = ["gauge", "back_to_back"];
        out.extend(gauge.zip(back).and_then(|(gauge, back)| usual::gauge(places, gauge, back)));
        let sides = [Some(TrackSide::Right), self.left.as_ref().map(|_| TrackSide::Left)];
        for marks in sides.into_iter().flatten().map(|side| self.landmarks.on(side)) {
            out.extend(back_x.and_then(|x| usual::flange_back_x(["flange_back_x", "wheel"], x, marks)));
        }
        out
    }

    /// Lists what is doubtful about the first contacts of the left and the right side.
    fn doubts_of_contacts(&self, first: [Option<&search::Contact>; 2]) -> Vec<Doubt> {
        let sides = [("left", self.left_pair()), ("right", &self.pair)].into_iter();
        let of_side = |((side, pair), doubts): ((&str, &Pair), ContactDoubts)| {
            let doubt = |(kind, value)| {
                let doubt = Doubt::of_contact(kind, value, pair.pair.wheel_radius());
                Doubt { found: format!("{side} side: {}", doubt.found), ..doubt }
            };
            doubts.list().map(doubt).collect::<Vec<_>>()
        };
        sides.zip(self.landmarks.of_first(first)).flat_map(of_side).collect()
    }
}

/// Prepares both sides.
fn system_of(
    right: &Pair,
    left: Option<&Pair>,
    rails: RailDistance,
    wheels: WheelDistance,
) -> wheelrail::Result<WheelsetOnTrack> {
    let Some(left) = left else { return WheelsetOnTrack::new(&right.pair, rails, wheels) };
    let side = |pair: &Pair| {
        let track = Track::new(pair.pair.rail(), rails)?;
        SideOnTrack::new(&pair.pair, track, placement::Wheelset::new(wheels, pair.pair.wheel_radius())?)
    };
    Ok(WheelsetOnTrack::of_sides(side(left)?, side(right)?))
}
