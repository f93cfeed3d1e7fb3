//! Draws a panel: a rectangle of the page with its own coordinates, ticks and scale bar.

use super::page::{BODY, GREY, INK, Page, Pen, SMALL};
use crate::numerics::interval::Interval;

const FRAME: Pen = Pen::new(GREY, 0.8);
const ZERO: Pen = Pen::new(GREY, 0.6);
const GRID: Pen = Pen::new([221; 3], 1.0);

/// Width of a digit as a share of its size.
pub(super) const DIGIT: f64 = 0.64;
/// Width of a decimal point as a share of its size.
const POINT: f64 = 0.32;
/// Width of a minus sign as a share of its size.
const MINUS: f64 = 0.84;
/// Least free space between two numbers of an axis \[page units\].
const BETWEEN: f64 = 2.5;

/// Values along an axis with their labels.
type Ticks = Vec<(f64, String)>;

/// A map from (u, v), v upwards, onto a rectangle of the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Panel {
    /// Left, top, width, height \[page units\].
    pub(super) place: [f64; 4],
    /// Smallest and largest u shown.
    pub(super) u: Interval,
    /// Smallest and largest v shown.
    pub(super) v: Interval,
}

impl Panel {
    /// Makes the largest panel inside `room` that shows u and v at one scale, centred.
    pub(super) fn true_scale(room: [f64; 4], u: Interval, v: Interval) -> Self {
        let scale = (room[2] / u.width()).min(room[3] / v.width());
        let size = [scale * u.width(), scale * v.width()];
        let place =
            [room[0] + (room[2] - size[0]) / 2.0, room[1] + (room[3] - size[1]) / 2.0, size[0], size[1]];
        Self { place, u, v }
    }

    /// Returns the page units per unit of u and v.
    pub(super) fn scale(&self) -> [f64; 2] {
        [self.place[2] / self.u.width(), self.place[3] / self.v.width()]
    }

    pub(super) fn point(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.scale();
        [self.place[0] + a * (u - self.u.low), self.place[1] + b * (self.v.high - v)]
    }

    /// Returns polylines on the page, cut off at the panel's edges and where a point is undefined.
    pub(super) fn curve(&self, line: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        for pair in line.windows(2) {
            let Some([a, b]) = self.clip(pair[0], pair[1]) else { continue };
            let (a, b) = (self.point(a), self.point(b));
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&a) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        pieces
    }

    /// Returns the part of a segment inside the panel (Liang and Barsky).
    fn clip(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let mut shares = Interval::new(0.0, 1.0);
        for (k, range) in [self.u, self.v].into_iter().enumerate() {
            let d = b[k] - a[k];
            if d != 0.0 {
                shares = shares.cut(Interval::around(range.map(|end| (end - a[k]) / d).ends()));
            } else if !range.contains(a[k]) {
                return None;
            }
        }
        let Interval { low: from, high: to } = shares;
        let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        // Ends inside the panel keep their bits, so that neighbouring pieces meet exactly.
        let ends = [if from == 0.0 { a } else { at(from) }, if to == 1.0 { b } else { at(to) }];
        let known = ends.iter().flatten().chain(&a).chain(&b).all(|x| x.is_finite());
        (known && from < to).then_some(ends)
    }

    /// Draws a line at v = 0, if the panel shows it.
    pub(super) fn zero_line(&self, page: &mut Page) {
        page.lines(&self.curve(&self.u.ends().map(|u| [u, 0.0])), ZERO);
    }

    /// Draws the frame, ticks, numbers and names below and to the left.
    pub(super) fn axes(&self, page: &mut Page, names: [&str; 2]) {
        let [_, _, w, h] = self.place;
        let powers = [self.u, self.v].map(|range| power_for(range.magnitude()));
        let ticks = [ticks_of(self.u, w / 45.0, powers[0]), ticks_of(self.v, h / 28.0, powers[1])];
        let [u, v] = [0, 1].map(|k| in_power(names[k], powers[k]));
        self.ticked(page, [&u, &v], ticks);
    }

    /// Draws the frame, ticks and names if u and v are decimal logarithms between whole numbers.
    pub(super) fn decade_axes(&self, page: &mut Page, names: [&str; 2]) {
        self.ticked(page, names, [self.u, self.v].map(decades));
    }

    /// Draws lines across the panel at its decades.
    pub(super) fn decade_grid(&self, page: &mut Page) {
        let across = decades(self.u).into_iter().map(|(u, _)| self.v.ends().map(|v| [u, v]));
        let along = decades(self.v).into_iter().map(|(v, _)| self.u.ends().map(|u| [u, v]));
        let lines: Vec<_> =
            across.chain(along).map(|ends| ends.map(|end| self.point(end)).to_vec()).collect();
        page.lines(&lines, GRID);
    }

    fn ticked(&self, page: &mut Page, names: [&str; 2], [below, left]: [Ticks; 2]) {
        let [x, y, w, h] = self.place;
        page.lines(&[vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]]], FRAME);
        let mut ticks = Vec::new();
        let below: Ticks =
            below.into_iter().map(|(value, label)| (self.point([value, self.v.low])[0], label)).collect();
        ticks.extend(below.iter().map(|(px, _)| vec![[*px, y + h], [*px, y + h + 5.0]]));
        for (px, label) in labelled(&below) {
            page.text([*px, y + h + 18.0], label, SMALL.middle());
        }
        let widest = left.iter().map(|(_, label)| width(label)).fold(0.0, f64::max);
        for (value, label) in left {
            let [_, py] = self.point([self.u.low, value]);
            ticks.push(vec![[x, py], [x - 5.0, py]]);
            page.text([x - 8.0, py + 4.0], label, SMALL.end());
        }
        page.lines(&ticks, FRAME);
        page.text([x + w / 2.0, y + h + 36.0], names[0], BODY.middle());
        // Clear of the longest number, whose end is 8 from the frame; 5 for what hangs below the letters.
        page.upright([x - widest.max(33.0) - 13.0, y + h / 2.0], names[1], BODY.middle());
    }

    /// Writes the values of another quantity at the ticks of u, above the frame, and its name to the left of them.
    pub(super) fn above(&self, page: &mut Page, name: &str, value: impl Fn(f64) -> String) {
        let [x, y, w, _] = self.place;
        let ticks = ticks_of(self.u, w / 45.0, 0).into_iter();
        let ticks: Ticks = ticks.map(|(u, _)| (self.point([u, self.v.high])[0], value(u))).collect();
        let marks: Vec<_> = ticks.iter().map(|(px, _)| vec![[*px, y], [*px, y - 5.0]]).collect();
        page.lines(&marks, FRAME);
        for (px, value) in labelled(&ticks) {
            page.text([*px, y - 10.0], value, SMALL.middle());
        }
        page.text([x - 26.0, y - 10.0], name, BODY.end());
    }

    /// Draws a bar of a round length along u, at most `longest`, with its right end at `end` \[page units\]. Returns the x of its left end.
    pub(super) fn scale_bar(&self, page: &mut Page, end: [f64; 2], longest: f64) -> f64 {
        let scale = self.scale()[0];
        let length = round_below(longest / scale);
        let start = end[0] - length * scale;
        page.line([start, end[1]], end, Pen::new(INK, 1.6));
        let caps = [start, end[0]].map(|x| vec![[x, end[1] - 3.0], [x, end[1] + 3.0]]);
        page.lines(&caps, Pen::new(INK, 1.0));
        let middle = [(start + end[0]) / 2.0, end[1] - 7.0];
        let power = power_for(length);
        let length = length / 10f64.powi(power);
        let power = if power == 0 { String::new() } else { format!("·{}", power_of_ten(power)) };
        page.text(middle, format!("{}{power} mm", number(length, length)), SMALL.middle());
        start
    }
}

/// Returns the smallest range that holds all finite values, widened by 0.5 to both sides if they are equal; 0 to 1 if
/// there are none.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Interval {
    let all = extremes(values);
    match all.low {
        low if all.high > low => all,
        low if low.is_finite() => Interval::of(low).grown(0.5),
        _ => Interval::new(0.0, 1.0),
    }
}

/// Returns the smallest and the largest finite value; +∞ and −∞ if there are none.
pub(super) fn extremes(values: impl Iterator<Item = f64>) -> Interval {
    Interval::around(values.filter(|value| value.is_finite()))
}

/// Returns a range with free space at both ends: `share` of its length, or `least` if that is more, so that a constant with
/// rounding errors appears as a line.
pub(super) fn airy(range: Interval, share: f64, least: f64) -> Interval {
    range.grown((share * range.width()).max(least))
}

/// Returns the largest of …, 1, 2, 5, 10, … that is not above x > 0.
pub(super) fn round_below(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    // The factors are slightly low, so that 5 is not missed for 4.999….
    [10.0, 5.0, 2.0].into_iter().find(|f| x >= 0.999_999 * f * power).unwrap_or(1.0) * power
}

/// Returns the number x with as many decimals as multiples of `step` need.
pub(super) fn number(x: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{x:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if zero { "0".into() } else { text.replace('-', "\u{2212}") }
}

/// Returns the power of ten, a multiple of 3, in which numbers up to `largest` are written: 0 from 10⁻² to 10⁶, so that small and
/// large ones have few digits.
pub(super) fn power_for(largest: f64) -> i32 {
    let power = largest.log10().floor();
    if !power.is_finite() || (-2.0..6.0).contains(&power) { 0 } else { 3 * (power / 3.0).floor() as i32 }
}

/// Least number that is written in words without a power of ten.
const PLAIN: f64 = 1e-4;

/// Returns a positive number with so many significant digits, without zeros at its end; small ones with a power of ten. What has
/// underflowed to 0 stays "0".
pub(super) fn significant(x: f64, digits: i32) -> String {
    if x == 0.0 {
        return number(x, 1.0);
    }
    let power = if x < PLAIN { power_for(x) } else { 0 };
    if power != 0 {
        return format!("{}·{}", significant(x / 10f64.powi(power), digits), power_of_ten(power));
    }
    let step = 10f64.powi(x.log10().floor() as i32 + 1 - digits);
    let text = number((x / step).round() * step, step);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// Puts a power of ten before the unit of a name: "s [10⁻⁹ mm]".
pub(super) fn in_power(name: &str, power: i32) -> String {
    if power == 0 { name.into() } else { name.replacen('[', &format!("[{} ", power_of_ten(power)), 1) }
}

/// Returns round values inside a range with their labels, in a power of ten. There are about `most` of them, and at least two, because one
/// tick gives no scale.
fn ticks_of(range: Interval, most: f64, power: i32) -> Ticks {
    // Rounding down takes off up to a factor of 2.5.
    let mut step = round_below(2.5 * range.width() / most);
    let mut values = multiples(range, step);
    // A step of half the range has two multiples in it; it is at most three or four steps down the ladder 1, 2, 5.
    for _ in 0..LADDER {
        if values.len() >= 2 {
            break;
        }
        step = round_below(0.7 * step);
        values = multiples(range, step);
    }
    let unit = 10f64.powi(power);
    values.into_iter().map(|value| (value, number(value / unit, step / unit))).collect()
}

/// Most steps down from the first distance of ticks, which is at most a few times the range.
const LADDER: usize = 6;

/// Returns the ticks, given with their places along u \[page units\], that have a label: all, or every second or third and so on
/// where the labels do not fit beside each other otherwise. At least two are left.
fn labelled(ticks: &[(f64, String)]) -> impl Iterator<Item = &(f64, String)> {
    let fits = |stride: &usize| {
        let some: Vec<_> = ticks.iter().step_by(*stride).collect();
        some.windows(2)
            .all(|pair| pair[1].0 - pair[0].0 > 0.5 * (width(&pair[0].1) + width(&pair[1].1)) + BETWEEN)
    };
    let stride = (1..ticks.len()).find(fits).unwrap_or(ticks.len().saturating_sub(1).max(1));
    ticks.iter().step_by(stride)
}

/// Returns the width of a number on an axis \[page units\].
fn width(label: &str) -> f64 {
    let letter = |c| match c {
        '.' => POINT,
        '\u{2212}' => MINUS,
        _ => DIGIT,
    };
    SMALL.size * label.chars().map(letter).sum::<f64>()
}

fn multiples(range: Interval, step: f64) -> Vec<f64> {
    let first = (range.low / step).ceil();
    let count = (range.high / step).floor() - first;
    let all = (0..=count.max(-1.0) as usize).map(|k| (first + k as f64) * step);
    all.filter(|value| range.contains(*value)).collect()
}

/// Returns powers of ten as labels along a range of logarithms between whole numbers, at most about ten.
fn decades(range: Interval) -> Ticks {
    let (low, high) = (range.low.round() as i32, range.high.round() as i32);
    let step = ((high - low) / 10 + 1) as usize;
    (low..=high).step_by(step).map(|power| (f64::from(power), power_of_ten(power))).collect()
}

/// Returns a power of ten in words: "10⁻¹²".
fn power_of_ten(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    format!("10{}", power.to_string().chars().map(digit).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        let found = [0.07, 0.1, 0.19, 3.0, 49.0, 5000.0].map(round_below);
        let expected = [0.05, 0.1, 0.1, 2.0, 20.0, 5000.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{found:?}");
        assert_eq!(number(-0.25, 0.05), "\u{2212}0.25");
        assert_eq!(number(-1e-17, 0.1), "0");
        assert_eq!(number(20.0, 20.0), "20");
    }

    #[test]
    fn numbers_have_their_digits() {
        let found = [0.076_974_259_6, 0.05, 110.4, 63.0, 1e-9].map(|x| significant(x, 4));
        assert_eq!(found, ["0.07697", "0.05", "110.4", "63", "1·10⁻⁹"]);
        assert_eq!(significant(1234.5, 2), "1200");
    }

    #[test]
    fn narrow_axes_have_two_ticks_at_least() {
        for range in [[-1.5, 1.5], [-0.9, 1.9], [0.21, 0.29], [-7.0, 90.0]] {
            for most in [0.2, 1.2, 7.0] {
                let ticks = ticks_of(range.into(), most, 0);
                assert!(ticks.len() >= 2, "{range:?} {most}: {ticks:?}");
            }
        }
        assert_eq!(ticks_of(Interval::new(-1.5, 1.5), 1.2, 0).len(), 3);
        let labels: Vec<String> =
            ticks_of(Interval::new(0.0, 3.1e-9), 6.0, -9).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "1", "2", "3"]);
        assert_eq!([2e-9, 7e-4, 0.2, 0.0, 3e7].map(power_for), [-9, -6, 0, 0, 6]);
        assert_eq!(in_power("s [mm]", -9), "s [10⁻⁹ mm]");
    }

    #[test]
    fn labels_that_do_not_fit_are_left_out() {
        let ticks = |step: f64, labels: &[&str]| -> Ticks {
            labels.iter().enumerate().map(|(k, label)| (step * k as f64, (*label).into())).collect()
        };
        let left = |ticks: &Ticks| labelled(ticks).map(|(_, label)| label.clone()).collect::<Vec<_>>();
        let few = ["\u{2212}1", "0", "1"];
        assert_eq!(left(&ticks(12.3, &few)), ["\u{2212}1", "1"]);
        assert_eq!(left(&ticks(15.0, &few)), few);
        // Two are left whatever their distance.
        assert_eq!(left(&ticks(1.0, &few)), ["\u{2212}1", "1"]);
        assert_eq!(left(&ticks(20.0, &["10.0", "20.0", "30.0", "40.0", "50.0"])), ["10.0", "30.0", "50.0"]);
        assert_eq!(left(&Ticks::new()), [""; 0]);
    }

    #[test]
    fn decades_are_labelled_as_powers() {
        let labels = |low, high| -> Vec<String> {
            decades(Interval::new(low, high)).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(-1.0, 1.0), ["10⁻¹", "10⁰", "10¹"]);
        assert_eq!(labels(-24.0, 0.0).first().map(String::as_str), Some("10⁻²⁴"));
        assert!(labels(-24.0, 0.0).len() <= 11);
    }

    #[test]
    fn curves_end_at_the_edge_and_at_undefined_points() {
        let unit = Interval::new(0.0, 1.0);
        let panel = Panel { place: [0.0, 0.0, 10.0, 10.0], u: unit, v: unit };
        let line = [[-1.0, 0.5], [0.5, 0.5], [0.6, 0.5], [f64::NAN, 0.5], [0.7, 0.5], [0.7, 3.0]];
        let pieces = panel.curve(&line);
        assert_eq!(pieces, [vec![[0.0, 5.0], [5.0, 5.0], [6.0, 5.0]], vec![[7.0, 5.0], [7.0, 0.0]]]);
    }
}
