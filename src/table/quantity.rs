//! The quantities of a table, their units and their tolerances.

use crate::search::Contact;

/// Length \[mm\] of a patch, over which the tolerances of curvatures, approaches and pressures are taken.
pub const TOLERANCE_LENGTH: f64 = 10.0;

/// Pressure \[N/mm²\] of which the tolerance of pressures is a share: that of lengths over [`TOLERANCE_LENGTH`].
const PRESSURE: f64 = 1000.0;

/// Least stated error, as a share of the tolerance: it covers the rounding of readers.
const LEAST_ERROR: f64 = 1e-6;

/// The values at the lowest place of contact of one side.
#[derive(Debug, Clone, Copy)]
pub(super) struct SideValues {
    /// Height of the axle's middle \[mm\].
    pub z: f64,
    pub contact: Contact,
    /// Coefficients \[1/mm\] of ξ², ξη and η² of s.
    pub form: [f64; 3],
    /// Semi-axes nearest to ξ and η \[mm\], approach \[mm\] and largest pressure \[N/mm²\] of Hertz's ellipse.
    pub ellipse: [f64; 4],
}

/// What has to exist for a quantity to exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Contact.
    Contact,
    /// Curvatures of both bodies.
    Curvatures,
    /// Hertz's ellipse.
    Ellipse,
}

impl Needs {
    /// Returns its code in files: 0 contact, 1 curvatures, 2 ellipse. A quantity exists where the sum of this code and of that of what
    /// its side lacks is at most 2.
    pub fn code(self) -> u8 {
        self as u8
    }
}

/// What a quantity is measured in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum QuantityUnit {
    Length,
    Angle,
    Curvature,
    Approach,
    Pressure,
}

/// A quantity of a table: of the wheelset, or of one side in its own profile axes.
#[derive(Debug, Clone, PartialEq)]
pub struct TableQuantity {
    /// Its name, with the unit; that of the sweep's column where it has one.
    pub name: &'static str,
    /// Whether it is of the right-hand side; `None` for the wheelset.
    pub right: Option<bool>,
    /// What has to exist.
    pub needs: Needs,
    /// Tolerance, in the unit of the quantity.
    pub tolerance: f64,
    /// Largest error of the polynomials, in the unit of the quantity: twice the largest difference from a direct search in the dense
    /// check of every cell.
    pub error: f64,
}

/// A quantity of each side: its name, what it is measured in, what it needs, and which value it is.
struct OfSide(&'static str, QuantityUnit, Needs, fn(&SideValues) -> f64);

/// The quantity of the wheelset.
const ROLL: &str = "roll_rad";

/// The quantities of each side.
const SIDE: [OfSide; 14] = [
    OfSide("z_mm", QuantityUnit::Length, Needs::Contact, |side| side.z),
    OfSide("rail_x_mm", QuantityUnit::Length, Needs::Contact, |side| side.contact.rail_x),
    OfSide("wheel_x_mm", QuantityUnit::Length, Needs::Contact, |side| side.contact.wheel_x),
    OfSide("y_mm", QuantityUnit::Length, Needs::Contact, |side| side.contact.y),
    OfSide("contact_angle_rad", QuantityUnit::Angle, Needs::Contact, |side| side.contact.contact_angle),
    OfSide("rolling_radius_mm", QuantityUnit::Length, Needs::Contact, |side| side.contact.rolling_radius),
    OfSide("skew_rad", QuantityUnit::Angle, Needs::Contact, |side| side.contact.skew),
    OfSide("a_xi_per_mm", QuantityUnit::Curvature, Needs::Curvatures, |side| side.form[0]),
    OfSide("b_eta_per_mm", QuantityUnit::Curvature, Needs::Curvatures, |side| side.form[2]),
    OfSide("c_xi_eta_per_mm", QuantityUnit::Curvature, Needs::Curvatures, |side| side.form[1]),
    OfSide("hertz_xi_mm", QuantityUnit::Length, Needs::Ellipse, |side| side.ellipse[0]),
    OfSide("hertz_eta_mm", QuantityUnit::Length, Needs::Ellipse, |side| side.ellipse[1]),
    OfSide("hertz_approach_mm", QuantityUnit::Approach, Needs::Ellipse, |side| side.ellipse[2]),
    OfSide("hertz_p_n_per_mm2", QuantityUnit::Pressure, Needs::Ellipse, |side| side.ellipse[3]),
];

/// The most quantities of a table.
pub(super) const MOST: usize = 1 + 2 * SIDE.len();

/// Values of the quantities, in their order.
pub(super) type QuantityValues = [f64; MOST];

impl QuantityUnit {
    /// Returns the tolerance of quantities in this unit, from that of lengths and the nominal rolling radius \[mm\].
    fn tolerance(self, length: f64, radius: f64) -> f64 {
        match self {
            Self::Length => length,
            Self::Angle => length / radius,
            Self::Curvature => length / (TOLERANCE_LENGTH * TOLERANCE_LENGTH),
            Self::Approach => length * TOLERANCE_LENGTH / radius,
            Self::Pressure => PRESSURE * length / TOLERANCE_LENGTH,
        }
    }
}

impl TableQuantity {
    /// Lists the quantities of a table, with tolerances from that of lengths and the nominal rolling radius \[mm\]; those of Hertz's
    /// ellipse only if `pressed`.
    pub(super) fn all(tolerance: f64, radius: f64, pressed: bool) -> Vec<Self> {
        let of = |name, right, unit: QuantityUnit, needs| {
            let tolerance = unit.tolerance(tolerance, radius);
            Self { name, right, needs, tolerance, error: LEAST_ERROR * tolerance }
        };
        let mut all = vec![of(ROLL, None, QuantityUnit::Angle, Needs::Contact)];
        for right in [false, true] {
            let asked = |OfSide(.., needs, _): &&OfSide| pressed || *needs != Needs::Ellipse;
            let side = SIDE.iter().filter(asked);
            all.extend(side.map(|OfSide(name, unit, needs, _)| of(name, Some(right), *unit, *needs)));
        }
        all
    }

    /// Returns the quantity with this name and side, with this tolerance and error; `None` for an unknown one.
    pub(super) fn named(name: &str, right: Option<bool>, [tolerance, error]: [f64; 2]) -> Option<Self> {
        let mut all = Self::all(1.0, 1.0, true).into_iter();
        let known = all.find(|known| known.name == name && known.right == right)?;
        Some(Self { tolerance, error, ..known })
    }

    /// Names the side in files: "left", "right", or "wheelset".
    pub fn side(&self) -> &'static str {
        match self.right {
            None => "wheelset",
            Some(false) => "left",
            Some(true) => "right",
        }
    }
}

/// Puts the values of the wheelset and both sides into the order of the quantities.
pub(super) fn values(roll: f64, sides: &[SideValues; 2], pressed: bool) -> QuantityValues {
    let mut out = [0.0; MOST];
    let asked = |OfSide(.., needs, _): &&OfSide| pressed || *needs != Needs::Ellipse;
    let of_sides = sides.iter().flat_map(|side| SIDE.iter().filter(asked).map(|OfSide(.., of)| of(side)));
    out.iter_mut().zip(std::iter::once(roll).chain(of_sides)).for_each(|(place, value)| *place = value);
    out
}
