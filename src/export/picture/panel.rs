//! A panel: a rectangle of the page with its own coordinates, ticks and scale bar.

use super::canvas::{Anchor, Canvas, Colour, Pen};

pub(super) const INK: Colour = [34, 34, 34];
pub(super) const GREY: Colour = [120, 120, 120];
const FRAME: Pen = Pen::new(GREY, 0.8);

/// Size of the smaller texts \[page units\].
pub(super) const SMALL: f64 = 11.0;

/// A map from (u, v), v upwards, onto a rectangle of the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Panel {
    /// Left, top, width, height \[page units\].
    pub(super) place: [f64; 4],
    /// Smallest and largest u and v that it shows.
    pub(super) u: [f64; 2],
    pub(super) v: [f64; 2],
}

impl Panel {
    /// The largest panel inside `room` that shows u and v at one scale, centred.
    pub(super) fn true_scale(room: [f64; 4], u: [f64; 2], v: [f64; 2]) -> Self {
        let scale = (room[2] / (u[1] - u[0])).min(room[3] / (v[1] - v[0]));
        let size = [scale * (u[1] - u[0]), scale * (v[1] - v[0])];
        let place =
            [room[0] + (room[2] - size[0]) / 2.0, room[1] + (room[3] - size[1]) / 2.0, size[0], size[1]];
        Self { place, u, v }
    }

    /// Page units per unit of u and v.
    pub(super) fn scale(&self) -> [f64; 2] {
        [self.place[2] / (self.u[1] - self.u[0]), self.place[3] / (self.v[1] - self.v[0])]
    }

    pub(super) fn point(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.scale();
        [self.place[0] + a * (u - self.u[0]), self.place[1] + b * (self.v[1] - v)]
    }

    /// Polylines on the page, cut off at the panel's edges and where a point is undefined.
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

    /// The part of a segment inside the panel (Liang and Barsky).
    fn clip(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (k, range) in [self.u, self.v].into_iter().enumerate() {
            let d = b[k] - a[k];
            let mut ends = [(range[0] - a[k]) / d, (range[1] - a[k]) / d];
            if d == 0.0 {
                let inside = range[0] <= a[k] && a[k] <= range[1];
                ends = if inside { [0.0, 1.0] } else { [2.0, 2.0] };
            }
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        // Untouched ends keep their bits, so that neighbouring pieces are seen to meet.
        let ends = [if from == 0.0 { a } else { at(from) }, if to == 1.0 { b } else { at(to) }];
        let known = ends.iter().flatten().chain(&a).chain(&b).all(|x| x.is_finite());
        (known && from < to).then_some(ends)
    }

    pub(super) fn frame(&self, canvas: &mut Canvas) {
        let [x, y, w, h] = self.place;
        canvas.lines(vec![vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]]], FRAME);
    }

    /// Ticks, numbers and names below and to the left.
    pub(super) fn axes(&self, canvas: &mut Canvas, names: [&str; 2]) {
        let [x, y, w, h] = self.place;
        let mut ticks = Vec::new();
        for (value, label) in ticks_of(self.u, w / 45.0) {
            let [px, _] = self.point([value, self.v[0]]);
            ticks.push(vec![[px, y + h], [px, y + h + 5.0]]);
            canvas.text([px, y + h + 18.0], label, SMALL, Anchor::Middle, INK);
        }
        for (value, label) in ticks_of(self.v, h / 28.0) {
            let [_, py] = self.point([self.u[0], value]);
            ticks.push(vec![[x, py], [x - 5.0, py]]);
            canvas.text([x - 8.0, py + 4.0], label, SMALL, Anchor::End, INK);
        }
        canvas.lines(ticks, FRAME);
        canvas.text([x + w / 2.0, y + h + 36.0], names[0], SMALL + 1.0, Anchor::Middle, INK);
        canvas.upright([x - 46.0, y + h / 2.0], names[1], SMALL + 1.0, INK);
    }

    /// A bar of a round length along u, with its right end at `end` \[page units\].
    pub(super) fn scale_bar(&self, canvas: &mut Canvas, end: [f64; 2], longest: f64) {
        let scale = self.scale()[0];
        let length = round_below(longest / scale);
        let start = end[0] - length * scale;
        let pen = Pen::new(INK, 1.6);
        canvas.line([start, end[1]], end, pen);
        let caps = [start, end[0]].map(|x| vec![[x, end[1] - 3.0], [x, end[1] + 3.0]]);
        canvas.lines(caps.to_vec(), Pen::new(INK, 1.0));
        let middle = [(start + end[0]) / 2.0, end[1] - 7.0];
        canvas.text(middle, format!("{} mm", number(length, length)), SMALL, Anchor::Middle, INK);
    }
}

/// The largest of …, 1, 2, 5, 10, … that is not above x > 0.
pub(super) fn round_below(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    // Factors a touch low, so that 5 is not missed for 4.999….
    [10.0, 5.0, 2.0].into_iter().find(|f| x >= 0.999_999 * f * power).unwrap_or(1.0) * power
}

/// x with as many decimals as multiples of `step` need.
pub(super) fn number(x: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{x:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if zero { "0".into() } else { text.replace('-', "\u{2212}") }
}

/// Round values inside a range with their labels: about `most` of them, and two at least, or there is no scale.
fn ticks_of(range: [f64; 2], most: f64) -> Vec<(f64, String)> {
    // Rounding takes off up to a factor of 2.5.
    let mut step = round_below(2.5 * (range[1] - range[0]) / most);
    let mut values = multiples(range, step);
    // Half the range has two multiples in it: three or four steps down the ladder 1, 2, 5 at most.
    for _ in 0..LADDER {
        if values.len() >= 2 {
            break;
        }
        step = round_below(0.7 * step);
        values = multiples(range, step);
    }
    values.into_iter().map(|value| (value, number(value, step))).collect()
}

/// Most steps down from a first tick's distance, at most some times the range.
const LADDER: usize = 6;

fn multiples([low, high]: [f64; 2], step: f64) -> Vec<f64> {
    let first = (low / step).ceil();
    let count = (high / step).floor() - first;
    let all = (0..=count.max(-1.0) as usize).map(|k| (first + k as f64) * step);
    all.filter(|value| (low..=high).contains(value)).collect()
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
    fn narrow_axes_have_two_ticks_at_least() {
        for range in [[-1.5, 1.5], [-0.9, 1.9], [0.21, 0.29], [-7.0, 90.0]] {
            for most in [0.2, 1.2, 7.0] {
                assert!(ticks_of(range, most).len() >= 2, "{range:?} {most}: {:?}", ticks_of(range, most));
            }
        }
        assert_eq!(ticks_of([-1.5, 1.5], 1.2).len(), 3);
    }

    #[test]
    fn curves_end_at_the_edge_and_at_undefined_points() {
        let panel = Panel { place: [0.0, 0.0, 10.0, 10.0], u: [0.0, 1.0], v: [0.0, 1.0] };
        let line = [[-1.0, 0.5], [0.5, 0.5], [0.6, 0.5], [f64::NAN, 0.5], [0.7, 0.5], [0.7, 3.0]];
        let pieces = panel.curve(&line);
        assert_eq!(pieces, [vec![[0.0, 5.0], [5.0, 5.0], [6.0, 5.0]], vec![[7.0, 5.0], [7.0, 0.0]]]);
    }
}
