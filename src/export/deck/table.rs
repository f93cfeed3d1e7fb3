//! Writes `table.wrp`: a contact table in the fixed columns of the other decks.
//!
//! ```text
//! WRTABLE    1 mm                            (a8,i4,1x,a8)   magic, version, unit
//!       18                                   (i8)            comment lines that follow
//! # …
//! n_cells n_quantities n_coefficients        (3i8)           9 coefficients
//! from to                                    (2e25.16)       range of the lateral displacement
//! yaw radius tolerance                       (3e25.16)       rad, nominal rolling radius, tolerance of lengths
//! name needs side tolerance error            (a18,i2,1x,a8,2e25.16)  n_quantities records
//! touches begins lacks lacks from to         (4i2,2e25.16)   n_cells times: flags, ends of the cell
//! c0 … c8                                    3 × (3e25.16)   … and if touches = 1, for each quantity
//! END
//! ```

use super::super::model::plain;
use super::text::line;
use crate::table::{BREAK, COEFFICIENTS, ContactTable, Lacks, TOLERANCE_LENGTH};

/// Writes `table.wrp`; `title` is that of its scene.
pub fn table_wrp(table: &ContactTable, title: &str) -> String {
    let comments = comments(table, title);
    let (cells, quantities) = (table.cells(), table.quantities());
    let mut text = format!("{:<8}{:>4} {:<8}\n{:>8}\n", "WRTABLE", 1, "mm", comments.len());
    comments.iter().for_each(|comment| text += &format!("# {comment}\n"));
    text += &format!("{:>8}{:>8}{:>8}\n", cells.len(), quantities.len(), COEFFICIENTS);
    text += &line(&table.lateral());
    text += &line(&[table.yaw(), table.radius(), table.tolerance()]);
    for quantity in quantities {
        text += &format!("{:<18}{:>2} {:<8}", quantity.name, quantity.needs.code(), quantity.side());
        text += &line(&[quantity.tolerance, quantity.error]);
    }
    for (c, cell) in cells.iter().enumerate() {
        let [left, right] = cell.lacks.map(Lacks::code);
        text += &format!("{:>2}{:>2}{left:>2}{right:>2}", u8::from(cell.touches), cell.begins.code());
        text += &line(&cell.lateral);
        if !cell.touches {
            continue;
        }
        for q in 0..quantities.len() {
            let coefficients = table.coefficients(c, q).map(|c| if c.is_nan() { 0.0 } else { c });
            coefficients.chunks_exact(3).for_each(|three| text += &line(three));
        }
    }
    text + "END\n"
}

/// Explains the file.
fn comments(table: &ContactTable, title: &str) -> Vec<String> {
    let off = table.off_rail().map(|[from, to]| format!("off the rail, without values: {from} to {to}"));
    let lines = [
        format!("title: {title}"),
        format!("written by wheelrail {}: contact of a wheelset over y", env!("CARGO_PKG_VERSION")),
        "y: lateral displacement of the axle's middle, mm, + to the right".into(),
        "lengths mm, angles rad, curvatures 1/mm, pressures N/mm2; x and angles in".into(),
        "the profile axes of each side, x towards its field side".into(),
        "separation s = a_xi xi^2 + c_xi_eta xi eta + b_eta eta^2 at the contact".into(),
        "hertz_*: Hertz's ellipse of the lowest place alone under the scene's load".into(),
        "head: n_cells n_quantities n_coefficients (3i8); from to (2e25.16);".into(),
        "yaw, nominal radius, tolerance of lengths (3e25.16)".into(),
        "quantity (a18,i2,1x,a8,2e25.16): name needs side tolerance largest_error".into(),
        "cell (4i2,2e25.16): touches begins lacks_left lacks_right from to; begins".into(),
        "0 smoothly 1 at a joint 2 at a hop 3 at an edge; touches = 0: a wheel is".into(),
        "off its rail and no coefficients follow; a quantity exists where its needs".into(),
        "(0 contact 1 curvatures 2 ellipse) + lacks of its side are at most 2".into(),
        "then for each quantity c0..c8 (3e25.16): value = sum of c_k t^k with".into(),
        "t = (2 y - from - to) / (to - from)".into(),
        format!("largest_error: twice the largest difference from direct searches; {BREAK:e} mm"),
        "around hops and joints are left out".into(),
        format!("tolerance: angles over the nominal radius, curvatures over ({TOLERANCE_LENGTH} mm)^2,"),
        format!("approach x {TOLERANCE_LENGTH} mm / radius, pressures x 1000 N/mm2 / {TOLERANCE_LENGTH} mm"),
    ];
    debug_assert!(table.quantities().iter().all(|quantity| quantity.name.len() <= 18));
    lines.into_iter().chain(off).map(|line| plain(&line)).collect()
}
