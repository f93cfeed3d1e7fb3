//! Compares the normal gap with 60-digit values, made by `tests/reference_conformal/conformal_reference.py`, which shares no
//! formula with the program.

use serde::Deserialize;

use crate::reference::{ReferenceScene, embedded, exact, malformed};
use wheelrail::conformal::{NormalGap, fill_normal_gap};
use wheelrail::error::Result;
use wheelrail::mesh::equal_steps;
use wheelrail::placement::Placement;
use wheelrail::separation::{EtaAxis, FULL_PRECISION};

/// Relative error of t over the contact segments that is promised to users.
pub const PROMISED_RELATIVE: f64 = 1e-13;
/// Error of t elsewhere that is promised to users \[mm\], × max(1, R_max/300 mm).
pub const PROMISED_ABSOLUTE: f64 = 2e-12;

/// Number of values of η that a grid has in addition to those of a file: columns of so many points are interpolated.
const BETWEEN: usize = 110;

/// A way to compute t and the bounds it is held to. They are measured over all scenes. If less than a quarter of one is
/// used, the suite fails.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapBound {
    /// Whether whole grids are filled by polynomials, or single points are computed.
    pub grid: bool,
    /// Whether the wheel is skewed.
    pub skewed: bool,
    /// Largest relative error of t where the point lies over both contact segments.
    pub relative: f64,
    /// Largest absolute error elsewhere \[mm\], × max(1, R_max/300 mm).
    pub absolute: f64,
}

/// The bounds of single points and of grids. An interpolated skewed column has the accuracy of its largest t in an interval,
/// and t may fall to a 64th of that.
pub const BOUNDS: [GapBound; 4] = [
    GapBound { grid: false, skewed: false, relative: 2.5e-15, absolute: 6e-15 },
    GapBound { grid: false, skewed: true, relative: 2.5e-15, absolute: 6e-15 },
    GapBound { grid: true, skewed: false, relative: 2.5e-15, absolute: 6e-15 },
    GapBound { grid: true, skewed: true, relative: 8e-14, absolute: 2.5e-14 },
];

/// A scene and its normal gaps, from one file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct GapReference {
    /// Name of the file, without its ending.
    #[serde(skip)]
    pub name: String,
    /// The scene that was evaluated; its ξ are values of σ.
    pub scene: ReferenceScene,
    /// The values, by σ, then η.
    pub normal_gap: Vec<GapValue>,
}

/// The values of one point, to 25 digits; `None` where the line misses the wheel or σ is beyond the rail.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct GapValue {
    /// σ \[mm\].
    pub sigma: f64,
    /// η \[mm\].
    pub eta: f64,
    /// t \[mm\].
    pub gap: Option<String>,
    /// α \[rad\].
    pub angle: Option<String>,
    /// ξ of the rail's point \[mm\].
    pub xi: Option<String>,
    /// ζ of the rail's point \[mm\].
    pub zeta: Option<String>,
}

/// The errors of one scene, or of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapErrors {
    /// Largest relative error of t where the point lies over both contact segments.
    pub relative: f64,
    /// Number of values over both contact segments.
    pub over_contact: usize,
    /// Largest error of t elsewhere \[mm\], over max(1, R_max/300 mm).
    pub absolute: f64,
    /// Number of values elsewhere.
    pub elsewhere: usize,
    /// Number of points with a value where there is none, or without one where there is one.
    pub wrongly_masked: usize,
}

impl GapErrors {
    /// The errors of no scene.
    pub const NONE: Self =
        Self { relative: 0.0, over_contact: 0, absolute: 0.0, elsewhere: 0, wrongly_masked: 0 };

    /// Joins the errors of two scenes.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            relative: self.relative.max(other.relative),
            over_contact: self.over_contact + other.over_contact,
            absolute: self.absolute.max(other.absolute),
            elsewhere: self.elsewhere + other.elsewhere,
            wrongly_masked: self.wrongly_masked + other.wrongly_masked,
        }
    }
}

impl GapReference {
    /// Places the pair of the scene.
    ///
    /// # Errors
    /// The errors of [`ReferenceScene::placement`].
    pub fn placement(&self) -> Result<Placement> {
        self.scene.placement().map_err(|error| error.within(&self.name))
    }

    /// Returns whether the wheel is skewed.
    pub fn skewed(&self) -> bool {
        self.scene.chi != 0.0
    }

    /// Compares t with the values, computed point by point or as a grid that has more rows between the values'.
    pub fn errors(&self, placement: &Placement, grid: bool) -> GapErrors {
        let gap = NormalGap::new(placement);
        let found = if grid { self.filled(&gap) } else { self.single(&gap) };
        let scale = (self.scene.largest_radius() / 300.0).max(1.0);
        let mut errors = GapErrors::NONE;
        for (value, found) in self.normal_gap.iter().zip(found) {
            let Some(t) = value.gap.as_deref().map(exact).filter(|_| !found.is_nan()) else {
                errors.wrongly_masked += usize::from(value.gap.is_some() || !found.is_nan());
                continue;
            };
            let error = (found - t).abs();
            if gap.point(value.sigma, value.eta).is_some_and(|point| point.over_contact) {
                // At C itself t = 0.
                errors.relative = errors.relative.max(if error == 0.0 { 0.0 } else { error / t.abs() });
                errors.over_contact += 1;
            } else {
                errors.absolute = errors.absolute.max(error / scale);
                errors.elsewhere += 1;
            }
        }
        errors
    }

    fn single(&self, gap: &NormalGap<'_>) -> Vec<f64> {
        self.normal_gap.iter().map(|value| gap.gap(value.sigma, value.eta)).collect()
    }

    fn filled(&self, gap: &NormalGap<'_>) -> Vec<f64> {
        let [sigma, mut eta] = self.scene.axes();
        if let (Some(&first), Some(&last)) = (eta.first(), eta.last()) {
            eta.extend(equal_steps(first, last, BETWEEN));
            eta.sort_by(f64::total_cmp);
        }
        let mut out = vec![0.0; sigma.len() * eta.len()];
        fill_normal_gap(gap, &sigma, &EtaAxis::new(&eta), FULL_PRECISION, &mut out);
        let index = |values: &[f64], value: f64| values.partition_point(|&v| v < value);
        let at = |value: &GapValue| out[index(&sigma, value.sigma) * eta.len() + index(&eta, value.eta)];
        self.normal_gap.iter().map(at).collect()
    }
}

/// Names and texts of the files.
pub const FILES: &[(&str, &str); 11] = embedded!("reference/":
    "60E1_S1002_root", "corner_13_root_13.5", "corner_13_root_14", "corner_13_root_15", "corner_at_45", "equal_to_1e-9",
    "measured_corner", "two_joints", "yawed_60E1_S1002_root", "yawed_corner_13_root_14", "yawed_measured_corner",
);

/// Reads all scenes, by name.
///
/// # Errors
/// A file that is not in the format.
pub fn gap_references() -> Result<Vec<GapReference>> {
    let read = |(name, text): &(&str, &str)| {
        let reference: GapReference = serde_json::from_str(text).map_err(|error| malformed(name, &error))?;
        Ok(GapReference { name: (*name).into(), ..reference })
    };
    FILES.iter().map(read).collect()
}
