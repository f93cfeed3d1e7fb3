//! The options that a scene may give for a measured file.

use serde::{Deserialize, Serialize};

use super::read::format::Format;
use crate::error::{Error, Result, finite};
use crate::profile::Side;

/// Longest default cut-off wavelength \[mm\] of smoothing; less noise, and models, have shorter ones. It is shorter than the shortest features that carry load (a 13 mm gauge
/// corner turns a right angle over 20 mm), and longer than the waves of measuring noise.
pub const CUTOFF_WAVELENGTH: f64 = 5.0;
/// Cut-off wavelengths \[mm\] tried before a chain of arcs. The first one with a residual small enough for the tolerance is
/// used; if there is none, the points are interpolated.
pub(super) const ARC_CUTOFFS: [f64; 4] = [5.0, 2.5, 1.25, 0.625];
/// Default kink angle \[rad\], 30°. Worn fillets turn by less within 2.5 mm; edges of plastic flow and
/// of drawings turn by more.
pub const KINK_ANGLE: f64 = std::f64::consts::FRAC_PI_6;
/// Default tolerance of a chain of arcs \[mm\]: the accuracy of hand-held instruments.
pub const ARC_TOLERANCE: f64 = 0.01;
/// Default depth of the gauge point below the top of rail \[mm\] (EN 13848: 14).
pub const GAUGE_HEIGHT: f64 = 14.0;
/// Default distance of the taping line from the flange back \[mm\] (EN 13715: 70).
pub const TAPE_DISTANCE: f64 = 70.0;

/// Declares tables that have the keys of a measured file among their own, so that these keys are written once. serde's `flatten` would
/// lose the lines of errors and the list of known keys.
macro_rules! measured_options {
    // The table with its own keys first.
    (table [$(#[$of_table:meta])* pub struct $name:ident { $($own:tt)* }] $($(#[$of_key:meta])* $key:ident: $type:ty;)*) => {
        $(#[$of_table])*
        pub struct $name {
            $($own)*
            $($(#[$of_key])* pub $key: $type,)*
        }
    };
    // The names of the keys.
    (keys [$name:ident] $($(#[$of_key:meta])* $key:ident: $type:ty;)*) => {
        impl $name {
            /// Names of all options.
            pub const KEYS: &'static [&'static str] = &[$(stringify!($key)),*];
        }
    };
    // The conversion of such a table to the options.
    (method [$name:ident] $($(#[$of_key:meta])* $key:ident: $type:ty;)*) => {
        impl $name {
            /// Gives the keys of a measured file.
            pub fn measured(&self) -> $crate::measured::Options {
                $crate::measured::Options { $($key: self.$key.clone(),)* }
            }
        }
    };
    (@$what:ident $($of:tt)*) => {
        $crate::measured::measured_options! {
            $what [$($of)*]
            /// Format of the file; if not given, its extension tells.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            format: Option<$crate::measured::Format>;
            /// Columns of x and z in a text or CSV file: numbers from 1, or names in its first row.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            columns: Option<[$crate::measured::Column; 2]>;
            /// Section of an .mpt file, or profile of a text, CSV or Vampire file, to use, from 1; if not given, all sections in a row
            /// where they go on from each other.
            #[cfg_attr(feature = "files", schemars(extend("minimum" = 1)))]
            #[serde(default, skip_serializing_if = "Option::is_none")]
            section: Option<usize>;
            /// Of an `.slcs` file: place of the section along the track, mm, between the first slice and the last.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            along: Option<f64>;
            /// Of an `.slcw` file: place of the section around the wheel, rad; a wheel is periodic.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            angle: Option<f64>;
            /// Whether the file's first axis points to the centre of the track (x = −first). Profiles are right-hand:
            /// flange and gauge corner at negative x. Of any other profile: mirror image under x → −x, before `rotate` and
            /// `shift`.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            mirror: Option<bool>;
            /// Whether the file's second axis points down, so that z = −second.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            flip_z: Option<bool>;
            /// Unit of the file's coordinates, or of `segments`; if neither the option nor the file states it, mm. `radius` and
            /// `shift` are in mm in any case.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            unit: Option<$crate::measured::Unit>;
            /// Point of the file that becomes the origin.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            origin: Option<$crate::measured::Origin>;
            /// Depth of the gauge point below the top of rail, mm; 14 if not given.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            gauge_height: Option<f64>;
            /// Distance of the taping line from the flange back, mm; 70 if not given.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            tape_distance: Option<f64>;
            /// Whether the rail was measured as it lies. Its points then contain its inclination already, which is not applied
            /// again.
            #[serde(default, skip_serializing_if = "std::ops::Not::not")]
            already_inclined: bool;
            /// Repairs that may be made; the summary lists each repair that was made.
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            repair: Vec<$crate::measured::Repair>;
            /// Kind of curve through the points. If not given: "smoothing", or "elements" for a file that has only design elements.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            curve: Option<$crate::measured::CurveKind>;
            /// Wavelength whose waves smoothing halves, mm; if not given, the noise of the points decides, up to 5. Before a chain
            /// of arcs it smooths the tangents; if not given, the tolerance decides there.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            cutoff_wavelength: Option<f64>;
            /// Largest kink that smoothing may round off, rad; larger kinks stay corners. π/6 if not given; π means no corners.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            kink_angle: Option<f64>;
            /// Largest distance of a point from the chain of arcs, mm; 0.01 if not given.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            arc_tolerance: Option<f64>;
        }
    };
}

pub(crate) use measured_options;

measured_options! {
    @table
    /// How a measured file becomes a profile. Every option may be left out. The definition of the file's format then decides;
    /// if it says nothing, the shape decides; if the shape proves nothing, this is an error.
    #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
    #[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
    #[serde(deny_unknown_fields)]
    pub struct Options {}
}

measured_options! { @keys Options }

/// The point of a file that becomes the origin of the profile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(untagged, expecting = "expected \"as-is\", \"gauge-point\", \"tape-line\" or a point [x, z]")]
pub enum Origin {
    /// An origin with a name.
    Named(NamedOrigin),
    /// This point \[x, z\] of the file, mm, after its axes are turned into those of the profile.
    At([f64; 2]),
}

/// The origins that have a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum NamedOrigin {
    /// The origin of the file.
    AsIs,
    /// For a rail: x of the innermost point down to the gauge height; z of the top of rail.
    GaugePoint,
    /// For a wheel: the point of the tread at the taping distance from the flange back.
    TapeLine,
}

/// A repair that may be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Repair {
    /// Keeps one of several coinciding points.
    DropDuplicates,
    /// Sorts the points between two reversals along the direction across them.
    Sort,
    /// Drops points that stick out, and a short end beyond which the path turns back.
    RemoveSpikes,
    /// Drops points inside a loop.
    CutLoops,
}

impl Repair {
    /// Returns the name of the repair in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::DropDuplicates => "drop-duplicates",
            Self::Sort => "sort",
            Self::RemoveSpikes => "remove-spikes",
            Self::CutLoops => "cut-loops",
        }
    }
}

/// The kind of curve through the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum CurveKind {
    /// A cubic smoothing spline, C² between corners.
    Smoothing,
    /// A cubic interpolating spline through every point, C² between corners.
    Interpolation,
    /// A chain of arcs, G¹ between corners.
    Arcs,
    /// The design elements of the file itself.
    Elements,
}

impl Options {
    /// Returns the depth of the gauge point below the top of rail \[mm\], given or default.
    pub fn gauge_height(&self) -> f64 {
        self.gauge_height.unwrap_or(GAUGE_HEIGHT)
    }

    /// Returns the distance of the taping line from the flange back \[mm\], given or default.
    pub fn tape_distance(&self) -> f64 {
        self.tape_distance.unwrap_or(TAPE_DISTANCE)
    }

    /// Returns the kink angle \[rad\], given or default.
    pub fn kink_angle(&self) -> f64 {
        self.kink_angle.unwrap_or(KINK_ANGLE)
    }

    /// Returns the tolerance of a chain of arcs \[mm\], given or default.
    pub fn arc_tolerance(&self) -> f64 {
        self.arc_tolerance.unwrap_or(ARC_TOLERANCE)
    }

    /// Returns the names of the options that are given.
    pub fn given(&self) -> Vec<String> {
        let [own, default] =
            [self, &Self::default()].map(|options| serde_json::to_value(options).unwrap_or_default());
        let of = own.as_object().into_iter().flatten();
        of.filter(|(key, value)| default.get(key) != Some(value)).map(|(key, _)| key.clone()).collect()
    }

    /// Rejects numbers without meaning, and options that contradict each other.
    ///
    /// # Errors
    /// An option without meaning, or one that contradicts another; the error names it.
    pub fn validate(&self) -> Result<()> {
        let lengths = [
            ("gauge_height", self.gauge_height),
            ("tape_distance", self.tape_distance),
            ("cutoff_wavelength", self.cutoff_wavelength),
            ("arc_tolerance", self.arc_tolerance),
            ("kink_angle", self.kink_angle),
        ];
        for (name, value) in lengths {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return Err(Error::new(name, value.to_string(), "a positive number", "correct it"));
            }
        }
        if let Some(Origin::At(point)) = self.origin {
            finite("origin", point[0])?;
            finite("origin", point[1])?;
        }
        let smooth = matches!(self.curve, None | Some(CurveKind::Smoothing | CurveKind::Arcs));
        let tape_line = Some(Origin::Named(NamedOrigin::TapeLine));
        reject_idle(&[
            (
                "cutoff_wavelength",
                self.cutoff_wavelength.is_some() && !smooth,
                "curve = \"smoothing\" or \"arcs\"",
            ),
            (
                "arc_tolerance",
                self.arc_tolerance.is_some() && self.curve != Some(CurveKind::Arcs),
                "curve = \"arcs\"",
            ),
            (
                "tape_distance",
                self.tape_distance.is_some() && self.origin != tape_line,
                "origin = \"tape-line\"",
            ),
        ])
    }

    /// Rejects options that choose among the contents of a file.
    ///
    /// # Errors
    /// An option without effect; the error names it.
    pub(super) fn validate_without_file(&self) -> Result<()> {
        reject_idle(&[
            ("format", self.format.is_some(), "a file"),
            ("columns", self.columns.is_some(), "a file"),
            ("section", self.section.is_some(), "a file"),
        ])
    }

    /// Rejects options that have no effect for a file of this body and format. `drawn` is true for a file that has only
    /// design elements.
    ///
    /// # Errors
    /// An option without effect; the error names it.
    pub(super) fn validate_for(&self, side: Side, format: Format, drawn: bool) -> Result<()> {
        let table = matches!(format, Format::Text | Format::Csv);
        let wheel = side == Side::Wheel;
        let as_drawn = self.curve == Some(CurveKind::Elements) || drawn && self.curve.is_none();
        let fitted = "a curve through points, not the elements themselves";
        reject_idle(&[
            ("columns", self.columns.is_some() && !table, "a text or CSV file"),
            (
                "section",
                self.section.is_some() && matches!(format, Format::Simpack | Format::Gensys),
                "a file of several profiles: .mpt, text, CSV or Vampire",
            ),
            ("along", self.along.is_some(), "an .slcs file"),
            ("angle", self.angle.is_some(), "an .slcw file"),
            ("gauge_height", self.gauge_height.is_some() && wheel, "a rail"),
            ("already_inclined", self.already_inclined && wheel, "a rail"),
            ("kink_angle", self.kink_angle.is_some() && as_drawn, fitted),
            ("cutoff_wavelength", self.cutoff_wavelength.is_some() && as_drawn, fitted),
            // If a file has points besides its elements, repairs decide whether its points pass the checks.
            ("repair", !self.repair.is_empty() && drawn && as_drawn, fitted),
        ])
    }
}

/// Rejects the first option that is given and has no effect. Each entry is (option, whether it is given without effect, the
/// kind of file or curve that it belongs to).
fn reject_idle(options: &[(&str, bool, &str)]) -> Result<()> {
    match options.iter().find(|(_, idle, _)| *idle) {
        None => Ok(()),
        Some((name, _, with)) => {
            let expected = format!("it with {with} only");
            Err(Error::new(
                *name,
                "an option without effect",
                expected,
                "delete it, or give what it belongs to",
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{Column, Unit};

    #[test]
    fn options_read_as_scenes_write_them() -> std::result::Result<(), toml::de::Error> {
        let options: Options = toml::from_str(
            "unit = 'in'\norigin = 'gauge-point'\nrepair = ['drop-duplicates', 'sort']\ncurve = 'arcs'\n\
             columns = [2, 'z']",
        )?;
        assert_eq!(options.unit, Some(Unit::Inch));
        assert_eq!(options.origin, Some(Origin::Named(NamedOrigin::GaugePoint)));
        assert_eq!(options.columns, Some([Column::Number(2), Column::Name("z".into())]));
        assert_eq!(toml::from_str::<Options>("origin = [1.0, 2]")?.origin, Some(Origin::At([1.0, 2.0])));
        assert!(toml::from_str::<Options>("orgin = 'as-is'").is_err());
        assert!(toml::from_str::<Options>("origin = 'tape'").is_err());
        Ok(())
    }

    #[test]
    fn numbers_and_contradictions_are_checked() {
        let base = Options::default();
        assert!(base.validate().is_ok());
        assert!(Options { kink_angle: Some(f64::NAN), ..base.clone() }.validate().is_err());
        assert!(Options { cutoff_wavelength: Some(-1.0), ..base.clone() }.validate().is_err());
        assert!(Options { arc_tolerance: Some(0.1), ..base.clone() }.validate().is_err());
        let interpolation = Some(CurveKind::Interpolation);
        assert!(Options { curve: interpolation, cutoff_wavelength: Some(3.0), ..base }.validate().is_err());
    }
}
