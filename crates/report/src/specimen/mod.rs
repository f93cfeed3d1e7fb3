//! Makes profiles as instruments measure them, from a seed: new and worn, hollow, lipped, grooved, noisy.
//!
//! A [`SpecimenKind`] is an outline that wear has changed by an amount drawn from the seed. An [`Instrument`]
//! takes points along it. [`Specimen::file`] writes them in a format of measured files, and
//! [`Specimen::measured`] reads that file back, so that a case takes the whole way of a user's file.

mod instrument;
mod outline;

pub use instrument::Instrument;

use serde::Deserialize;

use outline::{OutlinePoint, drawn, recorded, rounded, worn};
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::measured::{self, Format, Measured, Options, write};
use wheelrail::profile::{Profile, Side, standards};

/// The body that is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpecimenKind {
    /// 60E1 as drawn, with its inclined flanks.
    NewRail,
    /// A head with flanks that are vertical for 20 mm on both sides.
    FullHead,
    /// 60E1 worn by 1–3 mm on the crown and by 0.5–2 mm on the gauge face.
    WornRail,
    /// A head whose gauge corner and gauge face are worn to the shape of S1002's root and flange: radius 14
    /// mm, 70°.
    ConformalRail,
    /// 60E1 with lips of 0.5–1.5 mm that overhang the gauge and the field flank.
    LippedRail,
    /// A grooved rail: head, groove 47 mm deep, keeper, with the outer faces of head and keeper.
    GroovedRail,
    /// A switch blade whose head is 8–24 mm wide.
    SwitchBlade,
    /// S1002 as drawn, up to its flange back.
    NewWheel,
    /// S1002 with 30 mm of its flange back, vertical.
    FullFlangeWheel,
    /// S1002 worn by 0.7–2 mm on the tread and by 0.5–1.5 mm on the flange.
    WornWheel,
    /// S1002 with a tread worn hollow by 2–4 mm, so that the field side protrudes.
    HollowWheel,
    /// A tram wheel for the grooved rail: flange 22 mm high and 20 mm thick, vertical flange back, tread 1:40.
    TramWheel,
}

impl SpecimenKind {
    /// All kinds of rail.
    pub const RAILS: [Self; 7] = [
        Self::NewRail,
        Self::FullHead,
        Self::WornRail,
        Self::ConformalRail,
        Self::LippedRail,
        Self::GroovedRail,
        Self::SwitchBlade,
    ];
    /// All kinds of wheel.
    pub const WHEELS: [Self; 5] =
        [Self::NewWheel, Self::FullFlangeWheel, Self::WornWheel, Self::HollowWheel, Self::TramWheel];

    /// Returns the body of the specimen.
    pub fn side(self) -> Side {
        if Self::WHEELS.contains(&self) { Side::Wheel } else { Side::Rail }
    }

    /// Returns the name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::NewRail => "new-rail",
            Self::FullHead => "full-head",
            Self::WornRail => "worn-rail",
            Self::ConformalRail => "conformal-rail",
            Self::LippedRail => "lipped-rail",
            Self::GroovedRail => "grooved-rail",
            Self::SwitchBlade => "switch-blade",
            Self::NewWheel => "new-wheel",
            Self::FullFlangeWheel => "full-flange-wheel",
            Self::WornWheel => "worn-wheel",
            Self::HollowWheel => "hollow-wheel",
            Self::TramWheel => "tram-wheel",
        }
    }
}

/// A measured body.
#[derive(Debug, Clone, PartialEq)]
pub struct Specimen {
    /// The body that was measured.
    pub kind: SpecimenKind,
    /// The instrument that measured it.
    pub instrument: Instrument,
    /// The points \[mm\] in profile axes, from left to right.
    pub points: Vec<[f64; 2]>,
}

impl Specimen {
    /// Measures a body. A kind and an instrument give the same points on every machine with correctly rounded
    /// elementary functions, and points equal to 1e-12 mm on others.
    ///
    /// # Errors
    /// A fault of the built-in profiles only.
    pub fn new(kind: SpecimenKind, instrument: Instrument) -> Result<Self> {
        // The wear takes its own stream of random numbers, not that of the noise.
        let mut wear = Random::new(!instrument.seed);
        let points = recorded(&outline(kind, &mut wear)?, kind.side(), &instrument);
        Ok(Self { kind, instrument, points })
    }

    /// Returns the name and the text of a file of the points.
    pub fn file(&self, format: Format) -> (String, String) {
        let side = self.kind.side();
        let extension = match (format, side) {
            (Format::MiniProf, Side::Rail) => "ban",
            (Format::MiniProf, Side::Wheel) => "whl",
            (Format::Simpack, Side::Rail) => "prr",
            (Format::Simpack, Side::Wheel) => "prw",
            (Format::Gensys, Side::Rail) => "rail",
            (Format::Gensys, Side::Wheel) => "wheel",
            (Format::Text, _) => "txt",
            (Format::Csv, _) => "csv",
            (Format::Vampire, Side::Rail) => "rai",
            (Format::Vampire, Side::Wheel) => "whe",
        };
        let name = format!("{}-{}.{extension}", self.kind.name(), self.instrument.seed);
        let text = write::points(&self.points, format, side, &name);
        (name, text)
    }

    /// Returns the options for what a format leaves open.
    pub fn options(&self, format: Format) -> Options {
        let (mirror, flip_z) = match (format, self.kind.side()) {
            (Format::MiniProf, Side::Rail) => (Some(true), Some(false)),
            (Format::Text | Format::Csv, _) => (Some(false), Some(false)),
            _ => (None, None),
        };
        Options { mirror, flip_z, ..Options::default() }
    }

    /// Returns the profile that the program makes of the file in a format, with its default smoothing.
    ///
    /// # Errors
    /// A file that the program rejects.
    pub fn measured(&self, format: Format) -> Result<Measured> {
        self.measured_with(format, &self.options(format))
    }

    /// Returns the profile that the program makes of the file in a format with these options.
    ///
    /// # Errors
    /// A file or options that the program rejects.
    pub fn measured_with(&self, format: Format, options: &Options) -> Result<Measured> {
        let (name, text) = self.file(format);
        measured::profile(&name, text.as_bytes(), self.kind.side(), options)
    }

    /// Returns the profile that the program makes of a SIMPACK file of the points, with its default
    /// smoothing.
    ///
    /// # Errors
    /// A file that the program rejects.
    pub fn profile(&self) -> Result<Profile> {
        self.measured(Format::Simpack).map(|measured| measured.profile)
    }
}

/// Returns the outline of a body \[mm\], with its wear drawn from the stream.
fn outline(kind: SpecimenKind, wear: &mut Random) -> Result<Vec<[f64; 2]>> {
    Ok(match kind {
        SpecimenKind::NewRail => head()?,
        SpecimenKind::FullHead => rounded(&FULL_HEAD),
        SpecimenKind::WornRail => {
            let (crown, face) = (wear.between(1.0, 3.0), wear.between(0.5, 2.0));
            worn(&head()?, Side::Rail, |at| bell(at.x, -4.0, 18.0, crown) + bell(at.x, -37.0, 4.0, face))
        }
        SpecimenKind::ConformalRail => rounded(&CONFORMAL_HEAD),
        SpecimenKind::LippedRail => {
            let (gauge, field) = (wear.between(0.5, 1.5), wear.between(0.5, 1.2));
            let lip = |at: &OutlinePoint| match at.x {
                x if x < -30.0 => -bell(at.z, -17.0, 1.5, gauge),
                x if x > 30.0 => -bell(at.z, -15.0, 1.5, field),
                _ => 0.0,
            };
            worn(&head()?, Side::Rail, lip)
        }
        SpecimenKind::GroovedRail => {
            let crown = wear.between(0.0, 1.5);
            worn(&rounded(&GROOVED_HEAD), Side::Rail, |at| bell(at.x, -2.0, 12.0, crown))
        }
        SpecimenKind::SwitchBlade => rounded(&blade(wear.between(8.0, 24.0))),
        SpecimenKind::NewWheel => drawn(&standards::wheel("S1002")?),
        SpecimenKind::FullFlangeWheel => {
            let mut points = drawn(&standards::wheel("S1002")?);
            let back = points.first().map_or([0.0; 2], |first| [first[0], first[1] + FLANGE_BACK]);
            points.insert(0, back);
            points
        }
        SpecimenKind::WornWheel => {
            let (tread, flange) = (wear.between(0.7, 2.0), wear.between(0.5, 1.5));
            let depth = |at: &OutlinePoint| bell(at.x, 2.0, 16.0, tread) + bell(at.x, -43.0, 4.0, flange);
            worn(&drawn(&standards::wheel("S1002")?), Side::Wheel, depth)
        }
        SpecimenKind::HollowWheel => {
            let depth = wear.between(2.0, 4.0);
            worn(&drawn(&standards::wheel("S1002")?), Side::Wheel, |at| bell(at.x, 6.0, 15.0, depth))
        }
        SpecimenKind::TramWheel => rounded(&TRAM_WHEEL),
    })
}

/// Length of the flange back \[mm\].
const FLANGE_BACK: f64 = 30.0;
/// Depth \[mm\] below its top to which a drawn head is measured: the flank, above the fillet of the
/// underside.
const HEAD_DEPTH: f64 = 32.0;
/// Corners \[x, z, radius\] of the full head \[mm\].
const FULL_HEAD: [[f64; 3]; 6] = [
    [-36.0, -34.0, 0.0],
    [-36.0, -1.2, 13.0],
    [-10.0, 0.0, 200.0],
    [10.0, 0.0, 200.0],
    [36.0, -1.2, 13.0],
    [36.0, -34.0, 0.0],
];
const CONFORMAL_HEAD: [[f64; 3]; 5] =
    [[-48.0, -40.0, 0.0], [-34.5, -1.2, 14.0], [10.0, 0.2, 200.0], [36.0, -2.0, 12.0], [36.0, -34.0, 0.0]];
const GROOVED_HEAD: [[f64; 3]; 9] = [
    [-92.0, -30.0, 0.0],
    [-92.0, -2.0, 4.0],
    [-76.0, -2.0, 5.0],
    [-70.0, -47.0, 11.0],
    [-40.0, -47.0, 11.0],
    [-36.0, -0.8, 12.0],
    [0.0, 0.3, 250.0],
    [34.0, -0.8, 10.0],
    [34.0, -30.0, 0.0],
];
const TRAM_WHEEL: [[f64; 3]; 6] = [
    [-62.0, 20.0, 0.0],
    [-62.0, -22.0, 9.0],
    [-44.0, -22.0, 7.0],
    [-38.0, -1.0, 12.0],
    [50.0, 1.2, 3.0],
    [58.0, 9.0, 0.0],
];

/// Returns a switch blade whose head has this width \[mm\] at its top.
fn blade(width: f64) -> [[f64; 3]; 4] {
    let radius = 0.3 * width;
    [[-39.0, -38.0, 0.0], [-36.0, -2.0, radius], [-36.0 + width, -3.0, radius], [-24.0 + width, -36.0, 0.0]]
}

/// Returns the head of 60E1 with its flanks.
fn head() -> Result<Vec<[f64; 2]>> {
    let mut points = drawn(&standards::rail("60E1")?);
    let top = points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
    points.retain(|p| p[1] >= top - HEAD_DEPTH);
    Ok(points)
}

/// Returns a Gaussian curve: `height` at `centre`, 61 % of it at the distance `width`.
fn bell(at: f64, centre: f64, width: f64, height: f64) -> f64 {
    let share = (at - centre) / width;
    height * (-0.5 * share * share).exp()
}
