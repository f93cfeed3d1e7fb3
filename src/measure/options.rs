//! Where quantities are measured, and how profiles are aligned.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
use crate::profile::Side;

/// Where quantities are measured; lengths in mm. Every option may be left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MeasureOptions {
    /// Distance X of the taping line from the flange back; 70.
    pub tread_at: f64,
    /// Height over the tread at which flange thickness is measured; 10.
    pub flange_level: f64,
    /// Depth below the flange's tip at which qR is measured; 2.
    pub tip_depth: f64,
    /// Height over the tread at which flange width is measured; 14.
    pub width_level: f64,
    /// Depth below the top of rail at which W2, groove width and keeper wear are measured; 14.
    pub gauge_level: f64,
    /// The rail from whose top `gauge_level` counts: "measured", or "nominal".
    pub gauge_from: GaugeFrom,
    /// Alignment; if not given, the one that [`Align`] says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub align: Option<Align>,
    /// Ranges of the nominal's x that are not worn, for the alignment "unworn".
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unworn: Vec<Interval>,
}

/// The rail from whose top the gauge level counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GaugeFrom {
    /// The measured rail.
    Measured,
    /// The nominal rail.
    Nominal,
}

/// How a measured profile is put on its nominal one, or what its axes are without one.
///
/// If none is chosen: with a nominal, the best fit; without one, the file's axes for rails and for wheels whose x = 0 is the flange back,
/// and the flange back for other wheels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Align {
    /// The file's axes.
    None,
    /// Wheels: moved along x so that X = 0 is the flange back; possible without a nominal.
    Back,
    /// Wheels: moved so that the flange backs, and the tread points at the taping line, coincide.
    TreadPoint,
    /// Wheels: moved and turned so that flange back and outer tread fit those of the nominal.
    BackAndTread,
    /// Moved and turned as by `back-and-tread` or `field-side`, then by all places that fit.
    BestFit,
    /// Rails: moved and turned so that the field side fits, from where its tangent is inclined by 60°.
    FieldSide,
    /// Rails: moved and turned so that web and underside of the head fit.
    Web,
    /// Moved and turned so that the ranges of `unworn` fit.
    Unworn,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self {
            tread_at: 70.0,
            flange_level: 10.0,
            tip_depth: 2.0,
            width_level: 14.0,
            gauge_level: 14.0,
            gauge_from: GaugeFrom::Measured,
            align: None,
            unworn: Vec::new(),
        }
    }
}

impl Align {
    /// Returns the word of scenes, options and tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Back => "back",
            Self::TreadPoint => "tread-point",
            Self::BackAndTread => "back-and-tread",
            Self::BestFit => "best-fit",
            Self::FieldSide => "field-side",
            Self::Web => "web",
            Self::Unworn => "unworn",
        }
    }

    /// Returns the body that it is for; `None` for both.
    fn side(self) -> Option<Side> {
        match self {
            Self::Back | Self::TreadPoint | Self::BackAndTread => Some(Side::Wheel),
            Self::FieldSide | Self::Web => Some(Side::Rail),
            Self::None | Self::BestFit | Self::Unworn => None,
        }
    }
}

impl MeasureOptions {
    /// Rejects numbers without meaning, and an alignment that this body or a missing nominal does not allow.
    ///
    /// # Errors
    /// An option without meaning; the error names it.
    pub fn validate(&self, side: Side, nominal: bool) -> Result<()> {
        let lengths = [
            ("tread_at", self.tread_at),
            ("flange_level", self.flange_level),
            ("tip_depth", self.tip_depth),
            ("width_level", self.width_level),
            ("gauge_level", self.gauge_level),
        ];
        for (name, value) in lengths {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::new(name, value.to_string(), "a positive length in mm", "correct it"));
            }
        }
        for Interval { low, high } in &self.unworn {
            if !(low < high && low.is_finite() && high.is_finite()) {
                let found = format!("{low} to {high}");
                return Err(Error::new("unworn", found, "a range from less to more, in mm", "correct it"));
            }
        }
        if self.unworn.is_empty() == (self.align == Some(Align::Unworn)) {
            let found = if self.unworn.is_empty() { "align = \"unworn\" without ranges" } else { "ranges" };
            let expected = "`unworn` beside align = \"unworn\", and neither alone";
            return Err(Error::new("unworn", found, expected, "give both or neither"));
        }
        let Some(align) = self.align else { return Ok(()) };
        if align.side().is_some_and(|own| own != side) {
            let found = format!("\"{}\" for a {}", align.word(), name(side));
            let expected = match side {
                Side::Wheel => "none, back, tread-point, back-and-tread, best-fit or unworn",
                Side::Rail => "none, field-side, web, best-fit or unworn",
            };
            return Err(Error::new("align", found, expected, "choose another, or give the body by its side"));
        }
        if !nominal && !matches!(align, Align::None | Align::Back) {
            let found = format!("\"{}\" without a nominal profile", align.word());
            return Err(Error::new("align", found, "a nominal profile to align with", "give the nominal"));
        }
        Ok(())
    }
}

/// Returns the word of a body.
pub(super) fn name(side: Side) -> &'static str {
    match side {
        Side::Rail => "rail",
        Side::Wheel => "wheel",
    }
}
