//! Slopes at the knots of piecewise cubics through given values.

/// Gives the slopes of the monotone cubic (pchip) through values at ascending places \[FritschButland1984\]: between two knots it
/// stays between their values. One value has the slope 0, two give a straight line.
pub fn monotone(at: &[f64], values: &[f64]) -> Vec<f64> {
    let (steps, rises) = differences(at, values);
    let Some((&first, &last)) = rises.first().zip(rises.last()) else { return vec![0.0; values.len()] };
    if rises.len() == 1 {
        return vec![first; 2];
    }
    let inner = (1..rises.len()).map(|k| {
        let ([a, b], [h, g]) = ([rises[k - 1], rises[k]], [steps[k - 1], steps[k]]);
        if a * b <= 0.0 { 0.0 } else { 3.0 * (h + g) / ((2.0 * g + h) / a + (g + 2.0 * h) / b) }
    });
    let n = rises.len();
    let ends = [
        end([steps[0], steps[1]], [first, rises[1]]),
        end([steps[n - 1], steps[n - 2]], [last, rises[n - 2]]),
    ];
    [ends[0]].into_iter().chain(inner).chain([ends[1]]).collect()
}

/// Gives the slope at the end of a monotone cubic from the next two steps and rises: that of the parabola, as far as it is monotone.
fn end([h, g]: [f64; 2], [a, b]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h + g) * a - h * b) / (h + g);
    if slope * a <= 0.0 {
        0.0
    } else if a * b <= 0.0 && slope.abs() > 3.0 * a.abs() {
        3.0 * a
    } else {
        slope
    }
}

/// Gives the slopes of the cubic spline through values at ascending places, whose first two and last two pieces are one cubic each
/// ("not a knot"). Three values give a parabola, two a straight line, one the slope 0.
pub fn spline(at: &[f64], values: &[f64]) -> Vec<f64> {
    let (h, rises) = differences(at, values);
    let n = values.len();
    match rises.as_slice() {
        [] => return vec![0.0; n],
        [only] => return vec![*only; 2],
        [a, b] => {
            let bend = (b - a) / (h[0] + h[1]);
            return vec![a - bend * h[0], a + bend * h[0], b + bend * h[1]];
        }
        _ => {}
    }
    // Rows (before, own, after, right-hand side) of the tridiagonal system.
    let not_a_knot = |h: [f64; 2], r: [f64; 2]| {
        let sum = h[0] + h[1];
        [h[1], sum, ((h[0] + 2.0 * sum) * h[1] * r[0] + h[0] * h[0] * r[1]) / sum]
    };
    let [own, after, right] = not_a_knot([h[0], h[1]], [rises[0], rises[1]]);
    let mut rows = vec![[0.0, own, after, right]];
    rows.extend((1..n - 1).map(|k| {
        let right = 3.0 * (h[k] * rises[k - 1] + h[k - 1] * rises[k]);
        [h[k], 2.0 * (h[k - 1] + h[k]), h[k - 1], right]
    }));
    let [own, before, right] = not_a_knot([h[n - 2], h[n - 3]], [rises[n - 2], rises[n - 3]]);
    rows.push([before, own, 0.0, right]);
    for k in 1..n {
        let share = rows[k][0] / rows[k - 1][1];
        rows[k][1] -= share * rows[k - 1][2];
        rows[k][3] -= share * rows[k - 1][3];
    }
    let mut slopes = vec![0.0; n];
    for k in (0..n).rev() {
        let after = slopes.get(k + 1).copied().unwrap_or(0.0);
        slopes[k] = (rows[k][3] - rows[k][2] * after) / rows[k][1];
    }
    slopes
}

/// Gives the steps between neighbouring places, and for each step the rise of the values divided by it.
fn differences(at: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let steps: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rises = values.windows(2).zip(&steps).map(|(pair, step)| (pair[1] - pair[0]) / step).collect();
    (steps, rises)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: [f64; 5] = [0.0, 1.0, 2.5, 3.0, 5.0];

    #[test]
    fn a_spline_reproduces_a_cubic() {
        let values = AT.map(|t| 1.0 + t * (2.0 + t * (-3.0 + t)));
        for count in [2, 3, 4, 5] {
            let found = spline(&AT[..count], &values[..count]);
            for (t, slope) in AT.iter().zip(found) {
                let exact = match count {
                    2 => values[1] - values[0],
                    // The parabola through the first three values.
                    3 => -0.5 + t,
                    _ => 2.0 + t * (-6.0 + 3.0 * t),
                };
                assert!((slope - exact).abs() < 1e-12, "{count} values, {t}: {slope} {exact}");
            }
        }
    }

    #[test]
    fn a_monotone_cubic_neither_overshoots_nor_bends_a_line() {
        let line = monotone(&AT, &AT.map(|t| 2.0 - t));
        assert!(line.iter().all(|slope| (slope + 1.0).abs() < 1e-15), "{line:?}");
        // A step: flat at both of its sides.
        let step = monotone(&AT, &[0.0, 0.0, 1.0, 1.0, 1.0]);
        assert_eq!(step, [0.0; 5]);
        // Rises 1, 1/3, 5, −1/2 over steps 1, 3/2, 1/2, 2: harmonic means inside, a parabola at the first end, three times the rise at
        // the last.
        let found = monotone(&AT, &[0.0, 1.0, 1.5, 4.0, 3.0]);
        for (own, exact) in found.iter().zip([19.0 / 15.0, 15.0 / 29.0, 30.0 / 41.0, 0.0, -1.5]) {
            assert!((own - exact).abs() < 1e-14, "{found:?}");
        }
    }
}
