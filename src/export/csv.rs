//! Writes tables as CSV: a header line, then numbers in the shortest form that reads back as the same number. Lengths are in mm.

use super::model::{Loop, PatchRow};
use crate::numerics::interval::Interval;
use crate::table::{COEFFICIENTS, ContactTable};
use std::fmt::Write;

/// Writes `boundary.csv` with the columns component, xi and eta. The loops follow each other; each is counter-clockwise
/// (clockwise around holes) and ends with its first point.
pub fn boundary_csv(loops: &[Loop]) -> String {
    let mut text = String::from("component,xi,eta\n");
    for ring in loops {
        for point in ring.points.iter().chain(ring.points.first()) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{},{:?},{:?}", ring.component, point.x, point.y);
        }
    }
    text
}

/// Writes `interpen.csv`, INTERPEN's own table, with the columns xi, component, eta_min, eta_max and cut: one row for each
/// interval of each grid ξ inside the patch. `cut` says which end of it is the window's, not the patch's: 0 none, 1 the lower
/// one, 2 the upper one, 3 both.
pub fn interpen_csv(rows: &[PatchRow]) -> String {
    let mut text = String::from("xi,component,eta_min,eta_max,cut\n");
    for PatchRow { xi, component, eta: Interval { low, high }, cut } in rows {
        let _ = writeln!(text, "{xi:?},{component},{low:?},{high:?},{}", code(*cut));
    }
    text
}

/// Writes `interpen_sigma.csv`, INTERPEN's table over the rail's surface, with the columns sigma, xi, eta_min, eta_max and cut: an
/// interval of η with t ≤ δ cos α for each grid σ inside the conformal patch. Each row is \[σ, ξ, η_min, η_max\] \[mm\], and
/// whether the lower and the upper end are the window's; `cut` is 0 none, 1 the lower one, 2 the upper one, 3 both.
pub fn interpen_sigma_csv(rows: &[([f64; 4], [bool; 2])]) -> String {
    let mut text = String::from("sigma,xi,eta_min,eta_max,cut\n");
    for ([sigma, xi, low, high], cut) in rows {
        let _ = writeln!(text, "{sigma:?},{xi:?},{low:?},{high:?},{}", code(*cut));
    }
    text
}

/// Writes `table.csv`: a row for each cell and each quantity that exists there, with the cell's number from 1, its ends, the code of
/// how it begins, the quantity, its stated error over the whole table, and the coefficients of 1, t, … t⁸. A cell in which a wheel is
/// off its rail has one row without a quantity.
///
/// Over yaw a row has the yaws of the cell in place of its ends, and each quantity has a row for each power j of u, which is −1 to 1
/// over these yaws. The ends are the first two quantities of each cell, `from_mm` and `to_mm` of the wheelset.
pub fn table_csv(table: &ContactTable) -> String {
    let about = table.about();
    let (ends, power) =
        if about.over_yaw() { ("yaw_from_rad,yaw_to_rad", ",j") } else { ("from_mm,to_mm", "") };
    let powers: String = (0..COEFFICIENTS).map(|k| format!(",c{k}")).collect();
    let mut text = format!("cell,{ends},begins,side,quantity,error{power}{powers}\n");
    for (c, cell) in table.cells().iter().enumerate() {
        let ends = if about.over_yaw() { cell.yaw } else { table.ends(c, cell.yaw.low) };
        let [from, to] = ends.ends();
        let place = format!("{},{from:?},{to:?},{}", c + 1, table.begins(c).code());
        let mut put = |quantity: &str, error: f64, j: usize, coefficients: &[f64]| {
            let _ = write!(text, "{place},{quantity},{error:?}");
            if about.over_yaw() {
                let _ = write!(text, ",{j}");
            }
            coefficients.iter().for_each(|c| {
                let _ = write!(text, ",{c:?}");
            });
            text.push('\n');
        };
        if about.over_yaw() {
            for (name, curve) in ["wheelset,from_mm", "wheelset,to_mm"].into_iter().zip(cell.curves) {
                for (j, y) in table.curves()[curve].over(cell.yaw).into_iter().enumerate() {
                    let mut coefficients = [0.0; COEFFICIENTS];
                    coefficients[0] = y;
                    put(name, about.beside_curves(), j, &coefficients);
                }
            }
        } else if !cell.touches {
            let _ = writeln!(text, "{place},,,{}", ",".repeat(COEFFICIENTS));
            continue;
        }
        for (q, quantity) in table.quantities().iter().enumerate() {
            for j in (0..about.yaw_coefficients()).filter(|j| !table.coefficients(c, q, *j)[0].is_nan()) {
                let name = format!("{},{}", quantity.side(), quantity.name);
                put(&name, quantity.error, j, &table.coefficients(c, q, j));
            }
        }
    }
    text
}

/// Gives the number that says which ends are cut.
fn code([low, high]: [bool; 2]) -> u8 {
    u8::from(low) + 2 * u8::from(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::square;

    #[test]
    fn loops_are_closed_and_numbers_read_back() {
        let text = boundary_csv(&[square()]);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!((lines.len(), lines[1], lines[5]), (6, "0,-1.0,-1.0", "0,-1.0,-1.0"));
        let row =
            PatchRow { xi: 0.1 + 0.2, component: 1, eta: Interval::new(-1e-9, 2.0), cut: [false, true] };
        let text = "xi,component,eta_min,eta_max,cut\n0.30000000000000004,1,-1e-9,2.0,2\n";
        assert_eq!(interpen_csv(&[row]), text);
        let cuts = [[false; 2], [true, false], [false, true], [true; 2]];
        assert_eq!(cuts.map(code), [0, 1, 2, 3]);
        assert_eq!(boundary_csv(&[]), "component,xi,eta\n");
    }
}
