//! How a contact was found.

use serde::{Serialize, Serializer};

use crate::search::{self, TrackSide};

/// How a contact was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// The side of a wheelset, whose left one's axes are mirrored; `None` of a single wheel.
    #[serde(serialize_with = "named")]
    pub side: Option<TrackSide>,
    /// Height at first touch \[mm\], + up: of a wheelset's centre above R, the right-hand wheel's, over the top of rail, of a single
    /// wheel's profile origin over the rail's.
    pub height_mm: f64,
    /// Roll \[rad\], solved or given.
    pub roll_rad: f64,
    /// Number on its side, from 1.
    pub contact: usize,
    /// This contact.
    pub place: ListedContact,
    /// Places whose patches overlap that of this contact, or are merged with it: they are one region with it.
    pub merged: Vec<ListedContact>,
    /// Other places on this side within `within` that are no contact of their own and merged with none.
    pub near_misses: Vec<ListedContact>,
}

/// A place of contact or near miss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ListedContact {
    /// Abscissa on the rail profile \[mm\].
    pub rail_x_mm: f64,
    /// Abscissa on the wheel profile \[mm\].
    pub wheel_x_mm: f64,
    /// Along the rail from the wheel's centre \[mm\].
    pub y_mm: f64,
    /// Contact angle in the rail profile's axes \[rad\].
    pub contact_angle_rad: f64,
    /// Rolling radius \[mm\].
    pub rolling_radius_mm: f64,
    /// Vertical gap at first touch \[mm\].
    pub gap_mm: f64,
    /// Whether a body touches with a kink, step or end.
    pub kink: bool,
}

/// What stands for the side of a single wheel.
const SINGLE: &str = "single";

fn named<S: Serializer>(side: &Option<TrackSide>, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    serializer.serialize_str(side.map_or(SINGLE, TrackSide::name))
}

impl Found {
    /// Names side and number, as messages call the contact.
    pub fn name(&self) -> String {
        match self.side {
            None => format!("contact {}", self.contact),
            Some(side) => format!("{side} side, contact {}", self.contact),
        }
    }

    /// Names the folder of the contact's files.
    pub(super) fn folder(&self) -> String {
        let side = self.side.map_or(SINGLE, TrackSide::name);
        if self.contact == 1 { side.to_string() } else { format!("{side}-contact-{}", self.contact) }
    }
}

impl From<&search::Contact> for ListedContact {
    fn from(c: &search::Contact) -> Self {
        Self {
            rail_x_mm: c.rail_x,
            wheel_x_mm: c.wheel_x,
            y_mm: c.y,
            contact_angle_rad: c.contact_angle,
            rolling_radius_mm: c.rolling_radius,
            gap_mm: c.gap,
            kink: c.kink(),
        }
    }
}
