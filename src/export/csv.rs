//! Writes `boundary.csv` and `interpen.csv`: a header line, then numbers in mm, in the shortest form that reads back as the
//! same number.

use super::model::{Interval, Loop};
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

/// Writes `interpen.csv`, INTERPEN's own table, with the columns xi, component, eta_min and eta_max: one row for each
/// interval of each grid ξ inside the patch.
pub fn interpen_csv(intervals: &[Interval]) -> String {
    let mut text = String::from("xi,component,eta_min,eta_max\n");
    for Interval { xi, component, eta: [low, high] } in intervals {
        let _ = writeln!(text, "{xi:?},{component},{low:?},{high:?}");
    }
    text
}

/// Writes `interpen_sigma.csv`, the same table over the rail's surface, with the columns sigma, xi, eta_min and eta_max: the
/// interval of η with t ≤ δ cos α for each grid σ inside the conformal patch. Each row is \[σ, ξ, η_min, η_max\] \[mm\].
pub fn interpen_sigma_csv(rows: &[[f64; 4]]) -> String {
    let mut text = String::from("sigma,xi,eta_min,eta_max\n");
    for [sigma, xi, low, high] in rows {
        let _ = writeln!(text, "{sigma:?},{xi:?},{low:?},{high:?}");
    }
    text
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
        let row = Interval { xi: 0.1 + 0.2, component: 1, eta: [-1e-9, 2.0] };
        assert_eq!(interpen_csv(&[row]), "xi,component,eta_min,eta_max\n0.30000000000000004,1,-1e-9,2.0\n");
        assert_eq!(boundary_csv(&[]), "component,xi,eta\n");
    }
}
