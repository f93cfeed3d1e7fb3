//! The quantities that are measured: key, unit, body and text, declared once for tables, files, limits and Python.

use crate::profile::Side;

/// Declares the quantities.
macro_rules! quantities {
    ($($name:ident: $key:literal, $unit:literal, $side:ident, $text:literal;)*) => {
        /// A quantity of a wheel or a rail.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Quantity {
            $(#[doc = $text] $name,)*
        }

        impl Quantity {
            /// All quantities, in the order of the columns.
            pub const ALL: [Self; [$($key),*].len()] = [$(Self::$name),*];

            /// Returns the key in CSV, JSON, limits and Python. It ends with the unit.
            pub fn key(self) -> &'static str {
                match self { $(Self::$name => $key,)* }
            }

            /// Returns the unit: mm, deg or %.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$name => $unit,)* }
            }

            /// Returns the body that has it.
            pub fn side(self) -> Side {
                match self { $(Self::$name => Side::$side,)* }
            }

            /// Returns what it is, in a line.
            pub fn text(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }
        }
    };
}

quantities! {
    FlangeHeight: "flange_height_mm", "mm", Wheel, "flange height Sh: largest Y less Y at X = 70";
    FlangeThickness: "flange_thickness_mm", "mm", Wheel, "flange thickness Sd: X of the flange's face 10 above Y at X = 70";
    Qr: "qr_mm", "mm", Wheel, "qR: Sd less X of the flange's face 2 below its tip";
    W1: "w1_mm", "mm", Rail, "vertical wear W1 at the nominal crown's top";
    W2: "w2_mm", "mm", Rail, "horizontal wear W2 of the gauge face 14 below the top";
    W3: "w3_mm", "mm", Rail, "wear W3 along the nominal's normal where its gauge corner is inclined by 45°";
    FlangeWidth: "flange_width_mm", "mm", Wheel, "X of the flange's face less X of its back, 14 above Y at X = 70";
    Hollow: "hollow_mm", "mm", Wheel, "hollow wear: largest rise of Y along the tread towards the field side";
    TreadWear: "tread_wear_mm", "mm", Wheel, "tread wear at X = 70, against the nominal";
    TreadWearMax: "tread_wear_max_mm", "mm", Wheel, "largest tread wear, against the nominal";
    HeadAreaLost: "head_area_lost_percent", "%", Rail, "part of the nominal head's area that is lost";
    CrownRadius: "crown_radius_mm", "mm", Rail, "radius of the circle that fits the crown within 10 of its top";
    SideFaceAngle: "side_face_angle_deg", "deg", Rail, "angle of the gauge face from the vertical, + where it widens downwards";
    Lip: "lip_mm", "mm", Rail, "how far metal that flowed down overhangs the gauge face below it";
    GrooveWidth: "groove_width_mm", "mm", Rail, "width of the groove 14 below the top";
    GrooveDepth: "groove_depth_mm", "mm", Rail, "depth of the groove below the top";
    KeeperWear: "keeper_wear_mm", "mm", Rail, "horizontal wear of the keeper's face 14 below the top";
    Diameter: "diameter_mm", "mm", Wheel, "diameter at the taping line, as the file states it";
}

impl Quantity {
    /// Returns the quantity of the name that instruments' files have.
    pub(super) fn stated_as(name: &str) -> Option<Self> {
        Some(match name {
            "Sd" => Self::FlangeThickness,
            "Sh" => Self::FlangeHeight,
            "qR" => Self::Qr,
            "W1" => Self::W1,
            "W2" => Self::W2,
            "W3" => Self::W3,
            _ => return None,
        })
    }

    /// Tells whether a wheel's X = 0 decides it.
    pub(super) fn needs_back(self) -> bool {
        matches!(
            self,
            Self::FlangeHeight | Self::FlangeThickness | Self::Qr | Self::FlangeWidth | Self::Hollow
        )
    }

    /// Returns the key of the quantity's largest change if the alignment is off.
    pub fn key_if_off(self) -> String {
        format!("{}_if_off", self.key())
    }
}

/// Writes a number with three decimals, 0 without a sign.
pub(crate) fn in_micrometres(value: f64) -> String {
    format!("{:.3}", (1e3 * value).round() / 1e3 + 0.0)
}
