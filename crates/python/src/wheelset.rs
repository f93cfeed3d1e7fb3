//! Wheelsets on their track.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::Error;
use wheelrail::case::SweepDoubts;
use wheelrail::measured::GAUGE_HEIGHT;
use wheelrail::search::{ONE_CONTACT, Selection};
use wheelrail::search::{Position, WheelsetOnTrack};
use wheelrail::{RailDistance, WheelDistance};

use crate::contact::{Contact, Place, asked, checked_modulus};
use crate::errors::{OrRaise, exception, no_contact};
use crate::pair::Pair;
use crate::positions::{RollArgument, positions};
use crate::sweep::{Asked, sweep};

/// A wheelset on its track: a pair of profiles on the right, its mirror image on the left. Lengths in mm.
///
/// The track is given by its `gauge`, measured down to `gauge_height` below the top of rail (14 if None), or by
/// `rail_spacing`, the distance between the rail profiles' origins. The wheelset is given by the distance `back_to_back`
/// between the flange backs, which lie at `flange_back_x` on the wheel profile, or by `wheel_spacing`, the distance between
/// the wheel profiles' origins. A wheelset can be pickled, and used by several threads at once.
///
/// Raises InputError for a track or wheelset given twice or not at all, distances that are not positive, and a rail without
/// a gauge face.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Wheelset {
    pair: Pair,
    system: Arc<WheelsetOnTrack>,
    distances: Distances,
}

/// The distances of a wheelset and its track, by their keywords.
type Distances = [(&'static str, Option<f64>); 6];

#[pymethods]
impl Wheelset {
    #[new]
    #[pyo3(signature = (pair, *, gauge = None, gauge_height = None, rail_spacing = None, back_to_back = None,
                        flange_back_x = None, wheel_spacing = None))]
    fn new(
        pair: &Pair,
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
                RailDistance::Gauge { gauge, height: height.unwrap_or(GAUGE_HEIGHT) }
            }
            (None, None, Some(spacing)) => RailDistance::Spacing(spacing),
            _ => {
                let expected = "either `gauge` with perhaps `gauge_height`, or `rail_spacing`";
                let error =
                    Error::new("Wheelset", given(&distances[..3]), expected, "keep one of the two forms");
                return Err(exception(error));
            }
        };
        let wheels = match (back_to_back, flange_back_x, wheel_spacing) {
            (Some(distance), Some(flange_back_x), None) => {
                WheelDistance::BackToBack { distance, flange_back_x }
            }
            (None, None, Some(spacing)) => WheelDistance::Spacing(spacing),
            _ => {
                let expected = "either `back_to_back` and `flange_back_x`, or `wheel_spacing`";
                let error =
                    Error::new("Wheelset", given(&distances[3..]), expected, "keep one of the two forms");
                return Err(exception(error));
            }
        };
        let system = Arc::new(WheelsetOnTrack::new(&pair.pair, rails, wheels).or_raise()?);
        Ok(Self { pair: pair.clone(), system, distances })
    }

    /// The profiles of the right-hand side.
    #[getter]
    fn pair(&self) -> Pair {
        self.pair.clone()
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
    fn touch(&self, lateral: f64, yaw: f64, roll: RollArgument, within: f64) -> PyResult<Touch> {
        let position = Position { lateral, yaw, roll: roll.roll()? };
        let mut search = self.system.search();
        let selection = Selection { within, apart: ONE_CONTACT };
        let Some(touch) = search.touch(&position, &selection).or_raise()? else {
            let expected = "wheels over their rails, and a roll within ±0.1 rad at which both sides touch";
            return Err(no_contact("lateral", expected));
        };
        let contacts = |side, at: usize| {
            let contact = |(k, found)| Contact::found(&self.pair.pair, found, Place { side, number: k + 1 });
            touch.sides[at].touch.contacts.iter().copied().enumerate().map(contact).collect()
        };
        Ok(Touch {
            lateral,
            yaw,
            roll: touch.roll,
            z: (touch.sides[0].z, touch.sides[1].z),
            left: contacts("left", 0),
            right: contacts("right", 1),
        })
    }

    /// Find the contacts at many positions: a table with a row for each position, side and contact.
    ///
    /// `lateral` in mm, `yaw` in rad and `roll` are arrays or numbers, of one length once numbers are repeated; `roll` may
    /// also be "solve" or "neglect", for all positions. `within` mm: near misses up to this vertical gap are contacts too.
    /// `conicity` adds the equivalent conicity at the amplitude of every lateral displacement; it needs a roll that is not
    /// given. `load` in N or `approach` in mm adds the semi-axes of Hertz's ellipses, with E* `modulus` in N/mm2.
    ///
    /// It runs on all threads without the GIL and gives the same bits on any number of them. `progress(done, all)` is called
    /// about twenty times a second, with positions; an exception in it ends the sweep, and so does Ctrl-C within 0.2 s.
    ///
    /// Raises InputError for lengths that differ, values that are not finite, and angles beyond 0.5 rad; LimitError for more
    /// than 10**7 positions.
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
                checked_modulus(modulus)?;
                None
            }
            _ => Some(asked(load, approach, modulus)?),
        };
        let positions = positions(lateral, yaw, roll)?;
        let asked = Asked { within, conicity, ellipses };
        let doubts = SweepDoubts::new(&self.pair.pair, None);
        sweep(py, (&self.system, &doubts), positions, asked, progress.as_ref())
    }

    fn __repr__(&self) -> String {
        let given = self.distances.iter().filter_map(|(key, value)| Some(format!("{key}={:?}", (*value)?)));
        format!("Wheelset({}, {})", self.pair.__repr__(), given.collect::<Vec<_>>().join(", "))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.distances == other.distances && self.pair.__eq__(&other.pair)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((Pair,), Bound<'py, PyDict>)> {
        let keywords = PyDict::new(py);
        for (key, value) in self.distances {
            keywords.set_item(key, value)?;
        }
        Ok(((self.pair.clone(),), keywords))
    }
}

/// First touch of both wheels. Lengths in mm, angles in rad.
#[pyclass(frozen, get_all, module = "wheelrail")]
pub(crate) struct Touch {
    /// Lateral displacement, mm, + to the right.
    lateral: f64,
    /// Yaw, rad, + moves the right-hand wheel forward.
    yaw: f64,
    /// Roll, rad, solved or given, + lowers the right-hand wheel.
    roll: f64,
    /// Height of the axle's middle above the rolling radius over the top of rail when the left and the right side touch,
    /// mm, + up: equal where the roll is solved.
    z: (f64, f64),
    /// Contacts of the left side, the lowest gap first, in mirrored axes.
    left: Vec<Contact>,
    /// Contacts of the right side, the lowest gap first.
    right: Vec<Contact>,
}

#[pymethods]
impl Touch {
    /// Right less left rolling radius of the lowest contacts, mm.
    #[getter]
    fn delta_r(&self) -> PyResult<f64> {
        let radius = |side: &[Contact]| side.first().map_or(Ok(f64::NAN), Contact::rolling_radius);
        Ok(radius(&self.right)? - radius(&self.left)?)
    }

    fn __repr__(&self) -> String {
        format!(
            "Touch(lateral={:?}, yaw={:?}, roll={:.6e}, {} left, {} right)",
            self.lateral,
            self.yaw,
            self.roll,
            self.left.len(),
            self.right.len()
        )
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let html = py.import("wheelrail._html")?.getattr("touch")?;
        html.call1((self.roll, self.left.clone(), self.right.clone()))?.extract()
    }
}
