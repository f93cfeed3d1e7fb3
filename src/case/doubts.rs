//! Doubts: what is possible in a scene or a result but seldom meant, each with its number and its likely cause.

use std::fmt;

use serde::Serialize;

/// What a doubt is about. Runs, sweeps and the page on sweeps read this one list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DoubtKind {
    /// The wheel stands on the tip of its flange.
    FlangeTip,
    /// The wheel stands on the back of its flange.
    FlangeBack,
    /// The wheel's tread is far above the top of the rail.
    Lifted,
    /// The wheel touches beyond the part of the tread that runs on rails.
    BeyondTread,
    /// The rolling radius on the tread is far from the nominal one.
    RollingRadius,
    /// The bodies touch at the end of a profile, or the end cuts their patch off.
    ProfileEnd,
    /// The approach is larger or smaller than any elastic one.
    Approach,
    /// The tangents at chosen points differ.
    Tilt,
    /// A profile is turned by more than any inclination.
    Inclination,
    /// A rail is inclined away from the middle of the track.
    Outwards,
    /// A yaw or roll is larger than those of wheelsets.
    Angle,
    /// A load is smaller than the weight of any wheel.
    Load,
    /// Young's modulus is no metal's.
    Modulus,
    /// The nominal radius is no railway wheel's.
    Radius,
    /// The gauge does not go with the distance of the flange backs.
    Gauge,
    /// The gauge is measured at an unusual depth below the top of rail.
    GaugeHeight,
    /// The profile has its flange back elsewhere than the scene says.
    FlangeBackX,
    /// The wheel has its flange at the field side.
    FlangeSide,
    /// Two drawn segments meet at a kink.
    Kink,
    /// The wheelset is faster than any train.
    Speed,
    /// Two integrations of an equivalent conicity differ by more than their errors.
    Integrations,
    /// A list of slices defines no surface under the wheel.
    Hole,
    /// The bodies touch where a file has no points, or points off the curve.
    Unmeasured,
}

impl DoubtKind {
    /// All kinds.
    pub const ALL: [Self; 23] = [
        Self::FlangeTip,
        Self::FlangeBack,
        Self::Lifted,
        Self::BeyondTread,
        Self::RollingRadius,
        Self::ProfileEnd,
        Self::Approach,
        Self::Tilt,
        Self::Inclination,
        Self::Outwards,
        Self::Angle,
        Self::Load,
        Self::Modulus,
        Self::Radius,
        Self::Gauge,
        Self::GaugeHeight,
        Self::FlangeBackX,
        Self::FlangeSide,
        Self::Kink,
        Self::Speed,
        Self::Integrations,
        Self::Hole,
        Self::Unmeasured,
    ];

    /// The kinds about a place of contact: those that a sweep names at each position.
    pub const OF_CONTACT: [Self; 8] = [
        Self::FlangeTip,
        Self::FlangeBack,
        Self::Lifted,
        Self::BeyondTread,
        Self::RollingRadius,
        Self::Hole,
        Self::ProfileEnd,
        Self::Unmeasured,
    ];

    /// Gives the word that stands for the kind in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::FlangeTip => "flange-tip",
            Self::FlangeBack => "flange-back",
            Self::Lifted => "lifted",
            Self::BeyondTread => "beyond-tread",
            Self::RollingRadius => "rolling-radius",
            Self::ProfileEnd => "profile-end",
            Self::Approach => "approach",
            Self::Tilt => "tilt",
            Self::Inclination => "inclination",
            Self::Outwards => "outwards",
            Self::Angle => "angle",
            Self::Load => "load",
            Self::Modulus => "modulus",
            Self::Radius => "radius",
            Self::Gauge => "gauge",
            Self::GaugeHeight => "gauge-height",
            Self::FlangeBackX => "flange-back-x",
            Self::FlangeSide => "flange-side",
            Self::Kink => "kink",
            Self::Speed => "speed",
            Self::Integrations => "integrations",
            Self::Hole => "hole",
            Self::Unmeasured => "unmeasured",
        }
    }

    /// Gives the likely cause, and what to look at.
    pub fn cause(self) -> &'static str {
        match self {
            Self::FlangeTip | Self::FlangeBack => {
                "check the offset, the gauge, the side that the profiles' x points to (mirror), and the origin (a wheel \
                 measured from its flange back needs shift = [-70.0, 0.0])"
            }
            Self::Lifted => {
                "the wheel stands on its flange: check the lateral displacement, gauge and back_to_back, and the origins of \
                 measured profiles"
            }
            Self::BeyondTread => {
                "treads run on their first 90 mm: check the offset, or gauge, back_to_back and flange_back_x"
            }
            Self::RollingRadius => {
                "R is measured to the profile's origin, which some drawings (APTA) have at the gauge point and instruments at \
                 the flange; give the radius there, or move the profile by shift or origin"
            }
            Self::ProfileEnd => {
                "what stands beyond was not measured or drawn: give a profile that goes farther; pressures are left out"
            }
            Self::Approach => {
                "wheels and rails approach each other by 0.05 to 0.2 mm; check the unit, mm for an approach and N for a load"
            }
            Self::Tilt => {
                "the wheel is tilted by as much to touch there; [contact] offset finds the points at which it touches upright"
            }
            Self::Inclination => "angles are in rad, and inclinations like \"1:40\"",
            Self::Outwards => {
                "rails are inclined towards the middle of the track, where x is negative: \"1:40\" does it; a profile whose x \
                 points to the middle needs mirror = true"
            }
            Self::Angle => "wheelsets turn by less than 2; angles are in rad",
            Self::Load => "loads are in N, not in kN",
            Self::Modulus => "steel has 2.1e5; it looks like GPa or Pa",
            Self::Radius => "R is half of the diameter at the tread, in mm",
            Self::Gauge => {
                "gauge and back_to_back of one railway differ by 50 to 85 mm (1435 and 1360, 1520 and 1440, 1000 and 925): \
                 check that both are of the same one, and not swapped"
            }
            Self::GaugeHeight => "the gauge is measured 9 to 16 mm below the top of rail; check the unit, mm",
            Self::FlangeBackX => {
                "measured profiles have the origin of their instrument: give the abscissa of the back, or origin = \"tape-line\", \
                 which puts it at -70"
            }
            Self::FlangeSide => {
                "x points to the field side, and flanges are at negative x: mirror = true for a profile whose x points to the \
                 middle of the track"
            }
            Self::Kink => "check their ends, unless the corner is meant",
            Self::Speed => "speeds are in m/s, not in km/h",
            Self::Integrations => {
                "trust neither: look at the rolling radius difference beside the turning points and for jumps of it, and take \
                 smaller steps"
            }
            Self::Hole => {
                "give features, or slices that show the same parts; the warnings about the list say which do not"
            }
            Self::Unmeasured => {
                "what bridges a gap or points off the curve is no surface, and pressures there are none that can be trusted: allow \
                 repair = [\"remove-spikes\"], or measure it again; the warnings about the file name its rows"
            }
        }
    }
}

/// The doubts about a place of contact: a number \[mm\] for each kind of [`DoubtKind::OF_CONTACT`], `None` where there is none.
///
/// The numbers are x on the wheel of a contact on tip or back, the height of the tread over the rail, the distance from the
/// tip, the rolling radius less the nominal one, and x on the wheel of a contact at the end of a profile or where none was measured.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactDoubts(pub(super) [Option<f64>; DoubtKind::OF_CONTACT.len()]);

impl ContactDoubts {
    /// Adds the doubt of a kind with its number \[mm\], if there is one.
    #[must_use]
    pub(super) fn and(mut self, kind: DoubtKind, number: Option<f64>) -> Self {
        let known = DoubtKind::OF_CONTACT.iter().zip(&mut self.0).find(|(known, _)| **known == kind);
        if let Some((_, own)) = known {
            *own = number.or(*own);
        }
        self
    }

    /// Lists the doubts with their numbers \[mm\].
    pub fn list(self) -> impl Iterator<Item = (DoubtKind, f64)> {
        DoubtKind::OF_CONTACT.into_iter().zip(self.0).filter_map(|(kind, value)| Some((kind, value?)))
    }

    /// Gives the kinds without their numbers.
    pub fn kinds(self) -> DoubtSet {
        let bits = self.0.iter().enumerate().map(|(k, value)| u8::from(value.is_some()) << k);
        DoubtSet(bits.fold(0, |set, bit| set | bit))
    }
}

/// A set of kinds of [`DoubtKind::OF_CONTACT`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DoubtSet(u8);

impl DoubtSet {
    /// Lists every set by ascending code.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..=u8::MAX >> (8 - DoubtKind::OF_CONTACT.len())).map(Self)
    }

    /// Joins two sets.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Gives the set of one kind; of a kind that is about no contact, the empty one.
    pub fn of(kind: DoubtKind) -> Self {
        let bits = DoubtKind::OF_CONTACT.iter().enumerate().map(|(k, own)| u8::from(*own == kind) << k);
        Self(bits.sum())
    }

    /// Gives the number of the set, below 2⁸.
    pub fn code(self) -> u8 {
        self.0
    }
}

impl fmt::Display for DoubtSet {
    /// Writes the words of the kinds, a space between two; nothing for the empty set.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let kinds = DoubtKind::OF_CONTACT.into_iter().enumerate();
        for (n, (_, kind)) in kinds.filter(|(k, _)| self.0 >> k & 1 == 1).enumerate() {
            write!(f, "{}{}", if n > 0 { " " } else { "" }, kind.word())?;
        }
        Ok(())
    }
}

/// A doubt with its number.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Doubt {
    /// What it is about.
    pub kind: DoubtKind,
    /// What was found, with its number and its place in the scene.
    pub found: String,
}

impl Doubt {
    /// Makes a doubt.
    pub(crate) fn new(kind: DoubtKind, found: impl Into<String>) -> Self {
        Self { kind, found: found.into() }
    }

    /// Makes a doubt of [`ContactDoubts::list`], with its number \[mm\], for a wheel of a nominal radius \[mm\].
    pub fn of_contact(kind: DoubtKind, value: f64, radius: f64) -> Self {
        let on_wheel = format!("x = {value:.2} mm on the wheel");
        let found = match kind {
            DoubtKind::FlangeTip => format!("the wheel stands on the tip of its flange, {on_wheel}"),
            DoubtKind::FlangeBack => format!("the wheel stands on the back of its flange, {on_wheel}"),
            DoubtKind::Lifted => format!("the wheel's tread is {value:.2} mm above the top of the rail"),
            DoubtKind::Hole => "the list of slices defines no surface under the wheel".into(),
            DoubtKind::BeyondTread => format!("the wheel touches {value:.2} mm from the tip of its flange"),
            DoubtKind::ProfileEnd => format!("the bodies touch at the end of a profile, {on_wheel}"),
            DoubtKind::Unmeasured => format!("the bodies touch where no surface was measured, {on_wheel}"),
            _ => {
                let rolling = radius + value;
                format!("the rolling radius, {rolling:.2} mm, differs by {value:.2} mm from wheel.radius")
            }
        };
        Self::new(kind, found)
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}", self.found, self.kind.cause())
    }
}
