//! Reads the 60-digit reference values, made by `tests/reference/reference.py`, which shares no formula with
//! the program.

use serde::Deserialize;

use wheelrail::error::{Error, Result};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape};

/// Largest residue \[mm\] that counts as zero. 60-digit arithmetic leaves residues of about 1e-59 mm where s is zero, and
/// no true value of a file is this small.
const RESIDUE: f64 = 1e-40;

/// A scene and its values, from one file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ReferenceFile {
    /// Name of the file, without its ending.
    #[serde(skip)]
    pub name: String,
    /// The scene that was evaluated.
    pub scene: ReferenceScene,
    /// Values (ξ \[mm\], η \[mm\], s \[mm\] to 25 digits), by ξ, then η; `None` where a body has no surface.
    pub separation: Vec<(f64, f64, Option<String>)>,
    /// Values (δ \[mm\], ξ \[mm\], half width η \[mm\] of the patch to 25 digits); `None` outside the patch.
    pub boundary: Vec<(f64, f64, Option<String>)>,
}

/// A pair in contact, in the format of the reference program. Lengths are in mm. Every number is the exact binary value
/// that a program reads.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ReferenceScene {
    /// Rail segments from left to right.
    pub rail: Vec<ReferenceSegment>,
    /// Wheel segments from left to right.
    pub wheel: Vec<ReferenceSegment>,
    /// Nominal rolling radius R \[mm\].
    pub wheel_radius: f64,
    /// Distance from a roller's axle to the origin of its profile \[mm\]; `None` on a rail.
    #[serde(default)]
    pub roller_radius: Option<f64>,
    /// Abscissa of C on the rail \[mm\].
    pub contact_rail_x: f64,
    /// Abscissa of C on the wheel \[mm\].
    pub contact_wheel_x: f64,
    /// Skew χ \[rad\], 0 without yaw.
    #[serde(default)]
    pub chi: f64,
    /// ξ of the values \[mm\], in any order.
    pub xi: Vec<f64>,
    /// η of the values \[mm\], in any order.
    pub eta: Vec<f64>,
    /// Approaches δ of the boundary \[mm\].
    pub delta: Vec<f64>,
}

/// One segment of a profile.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ReferenceSegment {
    /// A straight line.
    Line {
        /// Beginning, x \[mm\].
        x0: f64,
        /// Beginning, z \[mm\].
        z0: f64,
        /// End, x \[mm\].
        x1: f64,
        /// End, z \[mm\].
        z1: f64,
    },
    /// A part of a half circle.
    Arc {
        /// Smallest x \[mm\].
        x0: f64,
        /// Largest x \[mm\].
        x1: f64,
        /// Centre, x \[mm\].
        a: f64,
        /// Centre, z \[mm\].
        b: f64,
        /// Radius \[mm\].
        r: f64,
        /// +1 for the upper half, −1 for the lower half.
        sigma: f64,
    },
    /// A polynomial z = Σ c_k x^k.
    Poly {
        /// Smallest x \[mm\].
        x0: f64,
        /// Largest x \[mm\].
        x1: f64,
        /// Coefficients c_0, c_1, … \[mm¹⁻ᵏ\].
        c: Vec<f64>,
    },
    /// A span of a spline, (Σ cx_k t^k, Σ cz_k t^k) over 0 ≤ t ≤ t1.
    Spline {
        /// Largest t.
        t1: f64,
        /// Coefficients of x \[mm\].
        cx: Vec<f64>,
        /// Coefficients of z \[mm\].
        cz: Vec<f64>,
    },
}

impl ReferenceSegment {
    /// Returns the segment in the program's own type.
    ///
    /// # Errors
    /// Numbers that make no segment.
    pub fn segment(&self) -> Result<Segment> {
        let shape = match self {
            Self::Line { x0, z0, x1, z1 } => Shape::Arc(Arc::line([*x0, *z0], [*x1, *z1])?),
            Self::Arc { x0, x1, a, b, r, sigma } => {
                let half = if *sigma > 0.0 { Half::Upper } else { Half::Lower };
                Shape::Arc(Arc::about([*a, *b], *r, half, [*x0, *x1])?)
            }
            Self::Spline { t1, cx, cz } => Shape::Polynomial(Polynomial::span(cx, cz, [0.0, *t1])?),
            Self::Poly { x0, x1, c } => Shape::Polynomial(Polynomial::graph(c, [*x0, *x1])?),
        };
        Ok(Segment { label: String::new(), shape })
    }
}

/// Returns the profile of a chain of reference segments.
///
/// # Errors
/// A wrong segment or joint.
pub fn chain(name: &str, segments: &[ReferenceSegment]) -> Result<Profile> {
    Profile::new(name, "reference", segments.iter().map(ReferenceSegment::segment).collect::<Result<_>>()?)
}

impl ReferenceScene {
    /// Places the pair.
    ///
    /// # Errors
    /// Wrong profiles or contact points.
    pub fn placement(&self) -> Result<Placement> {
        let (rail, wheel) = (chain("rail", &self.rail)?, chain("wheel", &self.wheel)?);
        let on_rail = Pair::new(rail, wheel, self.wheel_radius)?;
        let pair = self.roller_radius.map_or(Ok(on_rail.clone()), |radius| on_rail.on_roller(radius))?;
        pair.placed(self.contact_rail_x, self.contact_wheel_x, self.chi)
    }

    /// Returns the distinct ξ and η of the values, ascending \[mm\].
    pub fn axes(&self) -> [Vec<f64>; 2] {
        [&self.xi, &self.eta].map(|values| {
            let mut values = values.clone();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        })
    }

    /// Returns the largest radius of an arc of either profile \[mm\], 0 without arcs: the scale of absolute bounds.
    pub fn largest_radius(&self) -> f64 {
        let radius = |segment: &ReferenceSegment| match segment {
            ReferenceSegment::Arc { r, .. } => *r,
            _ => 0.0,
        };
        self.rail.iter().chain(&self.wheel).map(radius).fold(0.0, f64::max)
    }
}

impl ReferenceFile {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// Text that is not in the format.
    pub fn read(name: &str, text: &str) -> Result<Self> {
        let reference: Self = serde_json::from_str(text).map_err(|error| malformed(name, &error))?;
        Ok(Self { name: name.into(), ..reference })
    }

    /// Places the pair of the scene.
    ///
    /// # Errors
    /// The errors of [`ReferenceScene::placement`].
    pub fn placement(&self) -> Result<Placement> {
        self.scene.placement().map_err(|error| error.within(&self.name))
    }
}

/// Makes the error of a file that is not in its format.
pub(super) fn malformed(name: &str, error: &serde_json::Error) -> Error {
    Error::new(name, error.to_string(), "the format of reference.py", "make the file anew with the script")
}

/// Returns a 25-digit value rounded to f64; NaN for text that is not a number.
pub fn exact(text: &str) -> f64 {
    let value: f64 = text.parse().unwrap_or(f64::NAN);
    if value.abs() < RESIDUE { 0.0 } else { value }
}

/// Embeds the files of a folder in the program, as (name, text).
macro_rules! embedded {
    ($folder:literal: $($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!($folder, $name, ".json")))),*]
    };
}
pub(super) use embedded;

/// Names and texts of the reference scenes.
pub const FILES: &[(&str, &str)] = embedded!("reference/":
    "60E1_S1002_tread", "UIC60_EN15302A_root", "conforming", "convex_tread", "crown_on_cone", "hollow_tread",
    "huge_radius", "joint_in_column", "long_patch_small_wheel", "near_contact", "steep_flange", "throat",
);

/// Reads all reference scenes, by name.
///
/// # Errors
/// A file that is not in the format.
pub fn references() -> Result<Vec<ReferenceFile>> {
    FILES.iter().map(|(name, text)| ReferenceFile::read(name, text)).collect()
}
