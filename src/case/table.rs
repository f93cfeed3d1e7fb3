//! The contact table of a case.

use super::input::{ApproachBy, Arrangement, Case, RollByLoad};
use crate::error::{Error, Result};
use crate::export::{table_csv, table_nc, table_wrp};
use crate::files::{Folder, Names};
use crate::numerics::interval::Interval;
use crate::table::{Asked, ContactTable, Pressed, build};

/// Names of the files of a table: for C and Fortran, for whatever reads NetCDF, and for everything else.
const FILES: [&str; 3] = ["table.wrp", "table.nc", "table.csv"];

/// The folder of `wheelrail table`.
pub const TABLE_FOLDER: Names =
    Names { marker: FILES[0], is_file: |name| FILES.contains(&name), is_part: |_| false };

/// Tabulates the contact of a case's wheelset over a range of lateral displacements \[mm\] and of yaws \[rad\] (`None` takes the case's
/// yaw), with the case's roll; `tolerance` is that of lengths \[mm\]. `hertz` adds Hertz's ellipses under the case's approach or
/// load, as if the lowest place carried its wheel alone.
///
/// # Errors
/// A single wheel; bodies that vary; a roll by the wheels' loads; ellipses without an approach or load; the errors of [`build`].
pub fn table(
    case: &Case,
    lateral: Interval,
    yaw: Option<Interval>,
    tolerance: f64,
    hertz: bool,
) -> Result<ContactTable> {
    let Arrangement::Wheelset { system, position } = &case.setup.arrangement else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("table", "a single wheel", expected, "a table is of a wheelset on its track"));
    };
    case.profiles().swept("take `wheelrail march`")?;
    if case.setup.roll_by_load == RollByLoad::Asked {
        let expected = "\"solve\", \"neglect\" or an angle in rad";
        let advice = "a table is of wheels at first touch: change it";
        return Err(Error::new("wheelset: roll", "\"load\"", expected, advice));
    }
    let modulus = case.question.modulus();
    let pressed = match case.question.approach.filter(|_| hertz) {
        None if hertz => {
            let (found, expected) =
                ("neither a load nor an approach", "patch.load, patch.approach or wheelset.load");
            return Err(Error::new(
                "table: hertz",
                found,
                expected,
                "add one to the scene, or leave hertz out",
            ));
        }
        None => None,
        Some(by) => Some(([true, false].map(|left| pressed_by(by, left)), modulus)),
    };
    let yaw = yaw.unwrap_or(Interval::of(position.yaw));
    let asked = Asked { lateral, yaw, roll: position.roll, tolerance, pressed };
    build(system, &asked)
}

fn pressed_by(by: ApproachBy, left: bool) -> Pressed {
    match (by, by.of_wheel(left)) {
        (ApproachBy::Given(approach), _) => Pressed::Approach(approach),
        (_, load) => Pressed::Load(load.unwrap_or_default()),
    }
}

/// Writes the files of a table into a folder: `table.wrp`, `table.nc`, `table.csv`.
///
/// # Errors
/// Any error of the disk.
pub fn write_table(table: &ContactTable, title: &str, folder: &Folder) -> Result<()> {
    folder.write(FILES[0], table_wrp(table, title).as_bytes())?;
    folder.write(FILES[1], &table_nc(table, title))?;
    folder.write(FILES[2], table_csv(table).as_bytes())
}
