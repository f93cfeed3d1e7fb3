//! What the page of a sweep or a march shows: the usual curves, and the pair of profiles at every position.

use super::columns::SweepColumns;
use super::curves::curves;
use super::input::{Case, Profiles};
use super::polylines::{page_cut, pairs};
use super::view::{about_bodies, with_minus};
use crate::error::Result;
use crate::export::{
    CurvesPanel, CurvesPicture, PageCut, PageEvents, PlottedCurve, SEPARATOR, SweepCurve, SweepPage,
    SweepPanel, SweepSide,
};
use crate::search::{Cut, Position, Roll, TrackSide, WheelsetOnTrack};

/// What the pictures of pairs of profiles show.
const SECTION: &str = "The section is that through the lowest contact of its side; further ones lie before or behind it, so that their two \
                       points are not in one place.";
const SECTION_OF_ROLLER: &str = "The section is that through the axles: under yaw a contact lies before or behind it, and its two points \
                                 are not in one place.";

/// A wheelset at many positions, as pages show it.
pub(super) struct Shown<'a> {
    pub profiles: &'a Profiles,
    /// The scene as it was read.
    pub scene: &'a serde_json::Value,
    pub system: &'a WheelsetOnTrack,
    /// The contacts; there may be none at a position.
    pub columns: &'a SweepColumns,
    /// The positions on the axis of the curves, ascending.
    pub positions: &'a [f64],
    /// Where the wheelset stands at a position, of bodies that vary: along the track \[mm\], and its pitch \[rad\].
    pub stands: &'a dyn Fn(f64) -> [f64; 2],
    /// Normal force of the region of each contact \[N\]; `None` where none is known.
    pub loads: Option<&'a [f64]>,
    /// Name of the table that holds the exact numbers: "sweep", "march" or "conicity".
    pub table: &'a str,
}

/// Makes the page of a sweep from its columns, over the lateral displacements \[mm\] of all its positions; these have to ascend,
/// and `columns` may lack those without contact. `about` stands below the names of the profiles, after what the scene says of them.
///
/// # Errors
/// Lateral displacements that do not ascend.
pub fn sweep_page(
    case: &Case,
    system: &WheelsetOnTrack,
    columns: &SweepColumns,
    lateral: &[f64],
    about: &str,
) -> Result<SweepPage> {
    // Not the title of the scene, which may name its one position.
    let picture = curves(columns, lateral, &case.profiles.right.names(), about)?;
    Ok(page_of(&swept(case, system, columns, lateral), picture))
}

/// Gives what the page of a sweep shows.
pub(super) fn swept<'a>(
    case: &'a Case,
    system: &'a WheelsetOnTrack,
    columns: &'a SweepColumns,
    positions: &'a [f64],
) -> Shown<'a> {
    Shown {
        profiles: &case.profiles,
        scene: &case.echo.scene,
        system,
        columns,
        positions,
        stands: &|_| [0.0; 2],
        loads: None,
        table: "sweep",
    }
}

/// Makes the page of the panels of a picture.
pub(super) fn page_of(shown: &Shown<'_>, picture: CurvesPicture) -> SweepPage {
    let on_rollers = shown.profiles.right.pair.roller_radius().is_some();
    let numbers = format!(
        "Numbers of this page are in single precision; the exact ones are in the table of the {}.",
        shown.table
    );
    SweepPage {
        title: picture.title,
        about: shown.about(&picture.about),
        version: env!("CARGO_PKG_VERSION").into(),
        abscissa: picture.abscissa,
        positions: shown.positions.to_vec(),
        panels: picture.quantities.into_iter().map(panel).collect(),
        pairs: pairs(shown.profiles),
        sides: [false, true].map(|right| shown.side(right)).into(),
        events: PageEvents::default(),
        figures: Vec::new(),
        map: None,
        findings: Vec::new(),
        notes: vec![if on_rollers { SECTION_OF_ROLLER } else { SECTION }.into(), numbers],
    }
}

fn panel(panel: CurvesPanel) -> SweepPanel {
    let curve = |PlottedCurve { name, points, jumps }| SweepCurve {
        name,
        values: points.into_iter().map(|[_, value]| value).collect(),
        jumps,
    };
    let title = panel.heading();
    let curves = panel.curves.into_iter().map(curve).collect();
    SweepPanel { title, axis: panel.axis, curves, shown: panel.shown }
}

impl Shown<'_> {
    /// Says what is the same at all positions, and then what the picture says.
    fn about(&self, picture: &str) -> String {
        let mut said = about_bodies(self.scene);
        let yaws = self.columns.quantity("yaw_rad").unwrap_or_default();
        if let [yaw, others @ ..] = yaws
            && others.iter().all(|other| other == yaw)
        {
            said += &with_minus(&format!(", yaw {yaw} rad"));
        }
        [said.trim_start_matches(", "), picture].join(SEPARATOR)
    }

    /// Gives where the wheel of a side is at every position, what varies there, and the contacts.
    fn side(&self, right: bool) -> SweepSide {
        let on_track = if right { self.system.right() } else { self.system.left() };
        let mut out = SweepSide {
            right,
            pair: usize::from(!right && self.profiles.left.is_some()),
            rail: [on_track.track().rail_x(), on_track.track().rail_z()],
            places: vec![f64::NAN; 5 * self.positions.len()],
            rails: Vec::new(),
            wheels: Vec::new(),
            position: Vec::new(),
            rail_x: Vec::new(),
            wheel_x: Vec::new(),
            angle: Vec::new(),
            gap: Vec::new(),
            load: Vec::new(),
        };
        let shown = |row: &usize| self.columns.right[*row] == right && self.columns.contact[*row] > 0;
        for row in (0..self.columns.rows()).filter(shown) {
            let value = |name: &str| self.columns.quantity(name).map_or(f64::NAN, |column| column[row]);
            let number = self.columns.position[row] as usize;
            out.position.push(number);
            out.rail_x.push(value("rail_x_mm"));
            out.wheel_x.push(value("wheel_x_mm"));
            out.angle.push(value("contact_angle_rad"));
            out.gap.push(value("gap_mm"));
            out.load.extend(self.loads.and_then(|loads| loads.get(row)));
            if self.columns.contact[row] == 1 && number < self.positions.len() {
                self.place(&mut out, number, &value);
            }
        }
        out
    }

    /// Puts down where a wheel is at a position, and what varies there; `value` gives numbers of its lowest contact.
    fn place(&self, out: &mut SweepSide, number: usize, value: &dyn Fn(&str) -> f64) {
        let (lateral, yaw, roll) = (value("lateral_mm"), value("yaw_rad"), value("roll_rad"));
        let position = Position { lateral, yaw, roll: Roll::Fixed(roll) };
        let section = self.system.section(out.right, &position, roll, value("z_mm"));
        let side = if out.right { TrackSide::Right } else { TrackSide::Left };
        let [yaw, ahead] = match self.profiles.on(Some(side)).pair.roller_radius() {
            Some(_) => [0.0; 2],
            None => [if out.right { yaw } else { -yaw }, value("y_mm")],
        };
        let origin = section.translation.vector;
        let place = [origin.x, origin.y, section.rotation.angle(), yaw, ahead];
        out.places[5 * number..5 * number + 5].copy_from_slice(&place);
        let [along, pitch] = (self.stands)(self.positions[number]);
        let stands = [self.system.along(out.right, &position, along), pitch];
        let on_track = if out.right { self.system.right() } else { self.system.left() };
        let (of, pieces) = match on_track.cut(stands, yaw, ahead) {
            Some(Cut::Rail(pieces)) => (&mut out.rails, pieces),
            Some(Cut::Wheel(pieces)) => (&mut out.wheels, pieces),
            None => return,
        };
        of.resize(self.positions.len(), PageCut(Vec::new()));
        of[number] = page_cut(&pieces);
    }
}
