//! Chooses the lines of equal separation that are drawn, and the places of their numbers.

use super::contour::Nodes;
use super::page::{Colour, INSIDE, Page, Pen, WHITE, Words};
use super::panel::{DIGIT, Panel, extremes, number, power_for, round_below};

/// Largest level drawn, as a multiple of the approach. Near a flange s grows to many times the approach, which does not
/// matter for the patch.
const SHOWN: f64 = 5.0;

/// Number of lines of equal separation aimed at.
const LEVELS: f64 = 10.0;

/// The style of the numbers on the lines.
const NUMBERS: Words = Words::new(9.5).middle();

/// Number of places on one level that are tried for its number.
const TRIED: usize = 48;

/// Least distance of a number from other lines \[page units\]. A number without such a place is left out; the key shows it,
/// too.
const CLEAR: f64 = 9.0;

/// Distance of numbers from each other \[page units\] above which a larger one is no better.
const APART: f64 = 60.0;

/// The lines of one level.
pub(super) struct LevelLines {
    pub(super) name: String,
    /// The power of ten in which the name is written.
    pub(super) power: i32,
    pub(super) pen: Pen,
    /// The lines in coordinates of the page.
    pub(super) lines: Vec<Vec<[f64; 2]>>,
}

/// Returns round levels. They go up to the largest value, or up to [`SHOWN`] times the approach if that is lower and above
/// the least value.
pub(super) fn levels(nodes: &Nodes<'_>, approach: f64, panel: &Panel) -> Vec<LevelLines> {
    let [low, high] = extremes(nodes.values.iter().copied()).ends();
    let shown = SHOWN * approach;
    let high = if approach > 0.0 && shown > low { high.min(shown) } else { high };
    if low >= high {
        return Vec::new();
    }
    let step = round_below(1.5 * (high - low) / LEVELS);
    // There are no round numbers below the normal ones.
    if !step.is_normal() {
        return Vec::new();
    }
    // The lowest value itself has no line; it would be a point.
    let (first, last) = ((low / step).floor() as i64 + 1, (high / step).floor() as i64);
    let power = power_for((first as f64 * step).abs().max((last as f64 * step).abs()));
    let unit = 10f64.powi(power);
    let level = |k: i64| {
        let value = k as f64 * step;
        let pen = Pen::new(shade((value - low) / (high - low)), 1.2);
        let pen = if k < 0 { pen.dashed([4.0, 3.0]) } else { pen };
        let lines = nodes.lines(value).iter().flat_map(|line| panel.curve(line)).collect();
        LevelLines { name: number(value / unit, step / unit), power, pen, lines }
    };
    (first..=last).map(level).filter(|level| !level.lines.is_empty()).collect()
}

/// Writes each level's number where its line is farthest from the neighbouring levels, the rings around the patch and the numbers
/// written before. The closed rings are in coordinates of the page, as the lines are.
pub(super) fn label(page: &mut Page, levels: &[LevelLines], rings: &[Vec<[f64; 2]>], panel: &Panel) {
    let mut placed: Vec<[f64; 2]> = Vec::new();
    for (number, level) in levels.iter().enumerate() {
        let size = [NUMBERS.size * DIGIT * level.name.chars().count() as f64 + 3.0, NUMBERS.size + 1.0];
        let neighbours = levels.iter().enumerate().filter(|(k, _)| k.abs_diff(number) == 1);
        let others = neighbours.flat_map(|(_, other)| &other.lines).chain(rings);
        let others: Vec<[f64; 2]> = others.flatten().copied().collect();
        let points: Vec<[f64; 2]> = level.lines.iter().flatten().copied().collect();
        let free = |at: [f64; 2]| {
            let (clear, apart) = (nearest(at, &others), nearest(at, &placed));
            (clear >= CLEAR && apart >= CLEAR + size[0])
                .then(|| clear.min(3.0 * CLEAR) / CLEAR + apart.min(APART) / APART)
        };
        let tried =
            points.iter().step_by(points.len().div_ceil(TRIED).max(1)).filter(|at| inside(panel, **at, size));
        let rated = tried.filter_map(|at| Some((free(*at)?, *at)));
        let Some((_, [x, y])) = rated.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let ground = if within(rings, [x, y]) { INSIDE } else { WHITE };
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        page.area(&[corners.map(|[i, j]| [x + i * size[0], y + j * size[1]]).to_vec()], ground);
        page.text([x, y + 0.36 * NUMBERS.size], &level.name, NUMBERS);
        placed.push([x, y]);
    }
}

/// Returns whether a number of this size fits into the panel.
fn inside(panel: &Panel, at: [f64; 2], size: [f64; 2]) -> bool {
    (0..2).all(|k| {
        let (from, length) = (panel.place[k], panel.place[k + 2]);
        let half = size[k] / 2.0 + 2.0;
        at[k] - half > from && at[k] + half < from + length
    })
}

/// Returns whether a point lies inside closed rings, by the even-odd rule.
fn within(rings: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let crossed = |side: &[[f64; 2]]| {
        let [[a, b], [c, d]] = [side[0], side[1]];
        (b > y) != (d > y) && x < a + (c - a) * (y - b) / (d - b)
    };
    rings.iter().flat_map(|ring| ring.windows(2)).filter(|side| crossed(side)).count() % 2 == 1
}

/// Returns the distance of the nearest of some points, +∞ if there are none.
fn nearest([x, y]: [f64; 2], points: &[[f64; 2]]) -> f64 {
    let squares = points.iter().map(|[u, v]| (u - x) * (u - x) + (v - y) * (v - y));
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// Returns the colour of a contour, dark to light for t from 0 to 1 (five colours of viridis, without its
/// palest).
fn shade(t: f64) -> Colour {
    const STOPS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [190.0, 200.0, 40.0],
    ];
    let at = t.clamp(0.0, 1.0) * 4.0;
    let k = (at as usize).min(3);
    let mix = at - k as f64;
    [0, 1, 2].map(|c| (STOPS[k][c] + mix * (STOPS[k + 1][c] - STOPS[k][c])).round() as u8)
}
