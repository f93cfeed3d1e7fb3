//! Draws the picture of a gap over the rail's surface for a report: both profiles with the rail's normals, the gap along
//! these normals magnified, and the unrolled surface with lines of equal gap and the conformal patch.

use super::contact::{APPROACH, ClosingPlace, PicturedContact, RAIL, SHOWN_GAP, WHEEL, WINDOW, overlaps};
use super::contour::Nodes;
use super::map::Map;
use super::page::{GREY, INSIDE, Page, Pen, RED, SMALL, polygon};
use super::panel::{Panel, airy, extremes, number, range, round_below, significant};
use crate::numerics::interval::Interval;

const NORMAL: Pen = Pen::new(GREY, 0.6);
/// A normal along which the gap goes on beyond what is shown.
const BEYOND: Pen = NORMAL.dashed([2.0, 3.0]);

/// Length of the normals beside the whole profiles as a share of the rail's length over the window, and its bounds \[page units\].
const LENGTH: (f64, Interval) = (0.5, Interval::new(18.0, 40.0));
/// Least distance of normals on the rail \[page units\], beside the whole profiles and in the panel of the magnified gap.
const APART: [f64; 2] = [6.0, 9.0];

/// Longest gap of the magnified fan as a share of the rail's length over the window.
const LONGEST: f64 = 0.5;

/// Distance of words from the rail's line \[page units\].
const OFF: f64 = 14.0;
/// Sine of α beyond which words beside the rail's line begin or end there, so that they do not cross it.
const SIDEWAYS: f64 = 0.2;
/// Free space beside the magnified fan along u and v, as shares of its size, in which α is written beside its ends.
const AIR: [f64; 2] = [0.1, 0.06];

/// Distance of the rows of the legend \[page units\].
const ROW: f64 = 26.0;
/// Radius of the dot at C \[page units\].
const DOT: f64 = 2.8;

/// Height of the page \[page units\].
const HEIGHT: f64 = 1072.0;

/// The rail's normal at one arc length, with the gap along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RailNormal {
    /// Arc length σ \[mm\].
    pub sigma: f64,
    /// The rail's point \[ξ, ζ\] \[mm\].
    pub foot: [f64; 2],
    /// Outward unit normal (n_ξ, n_ζ).
    pub direction: [f64; 2],
    /// t(σ, 0) \[mm\]; NaN where the line misses the wheel.
    pub gap: f64,
}

impl RailNormal {
    /// Returns the point at a distance \[mm\] along the normal.
    fn point(&self, length: f64) -> [f64; 2] {
        [0, 1].map(|k| self.foot[k] + length * self.direction[k])
    }

    /// Returns cos α.
    fn cosine(&self) -> f64 {
        self.direction[1]
    }

    /// Returns α \[°\], positive counter-clockwise from ξ to ζ.
    fn degrees(&self) -> f64 {
        (-self.direction[0]).atan2(self.direction[1]).to_degrees()
    }
}

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct ConformalPicture<'a> {
    /// The contact.
    pub contact: PicturedContact<'a>,
    /// Centres σ and η of the solver's cells \[mm\], ascending.
    pub cells: [&'a [f64]; 2],
    /// t \[mm\] over the window of the cells, on as many points as smooth lines need; its `xi` are σ.
    pub gap: Nodes<'a>,
    /// The rail's normals over the window of the cells, in equal steps of σ, ascending.
    pub normals: &'a [RailNormal],
    /// The boundary of the conformal patch: closed loops of \[σ, η\] \[mm\], whose first points are not repeated.
    pub loops: &'a [Vec<[f64; 2]>],
}

impl ConformalPicture<'_> {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let mut page = self.contact.page();
        self.profiles(&mut page, [40.0, 122.0, 380.0, 250.0]);
        self.magnified(&mut page, [470.0, 122.0, 390.0, 250.0]);
        self.unrolled(&mut page, [90.0, 526.0, 570.0, 466.0]);
        self.contact.finish(page, HEIGHT)
    }

    fn approach(&self) -> f64 {
        self.contact.header.approach
    }

    /// Returns the length \[mm\] of the rail over the window.
    fn length(&self) -> f64 {
        range(self.normals.iter().map(|normal| normal.sigma)).width()
    }

    /// Returns normals in equal steps with those at both ends, at least `apart` from each other on the rail \[page units\].
    fn some_normals(&self, panel: &Panel, apart: f64) -> impl Iterator<Item = &RailNormal> {
        let last = self.normals.len().saturating_sub(1).max(1);
        let step = panel.scale()[0] * self.length() / last as f64;
        let stride = (1..last).find(|k| last.is_multiple_of(*k) && *k as f64 * step >= apart);
        self.normals.iter().step_by(stride.unwrap_or(last))
    }

    /// Draws both profiles at true scale, with the rail's normals over the part that the other panels show.
    fn profiles(&self, page: &mut Page, room: [f64; 4]) {
        page.heading(room, "Profiles and the rail's normals, true scale");
        self.contact.profiles(page, room, |page, panel, _| {
            let scale = panel.scale()[0];
            let (share, bounds) = LENGTH;
            let length = bounds.nearest(share * self.length() * scale) / scale;
            let feet = self.normals.iter().map(|normal| panel.point(normal.foot));
            let ends = self.normals.iter().rev().map(|normal| panel.point(normal.point(length)));
            page.area(&[feet.chain(ends).collect()], WINDOW);
            let ends = |normal: &RailNormal| [normal.foot, normal.point(length)];
            let line = |normal: &RailNormal| ends(normal).map(|end| panel.point(end)).to_vec();
            let lines: Vec<_> = self.some_normals(panel, APART[0]).map(line).collect();
            page.lines(&lines, NORMAL);
        });
    }

    /// Draws the rail over the window at true scale, and the gap in the midplane along its normals, magnified.
    fn magnified(&self, page: &mut Page, room: [f64; 4]) {
        let fan = Fan::new(self);
        let factor = number(fan.factor, fan.factor);
        let cut = if fan.cuts(self.normals) {
            format!(", cut off at {} mm", significant(fan.shown, 2))
        } else {
            String::new()
        };
        page.heading(room, &format!("Gap t along the normals at η = 0, × {factor}{cut}"));
        let approach = self.approach();
        let wheel = fan.wheel(self.normals);
        let rail: Vec<[f64; 2]> = self.normals.iter().map(|normal| normal.foot).collect();
        let closed = |normal: &RailNormal| normal.point(fan.factor * approach * normal.cosine());
        let closed: Vec<[f64; 2]> = self.normals.iter().map(closed).collect();
        let all = || rail.iter().chain(&wheel).chain(&closed);
        let [u, v] = [0, 1].map(|k| airy(range(all().map(|p| p[k])), AIR[k], 0.0));
        let panel = Panel::true_scale(room, u, v);
        let closing = |(normal, &closed): (&RailNormal, &[f64; 2])| ClosingPlace {
            wheel: normal.point(fan.factor * normal.gap),
            closed,
            overlap: approach * normal.cosine() - normal.gap,
        };
        let closings: Vec<ClosingPlace> = self.normals.iter().zip(&closed).map(closing).collect();
        page.area(&overlaps(&panel, &closings), INSIDE);
        self.rays(page, &panel, &fan);
        page.lines(&panel.curve(&rail), RAIL);
        page.lines(&panel.curve(&wheel), WHEEL);
        if approach > 0.0 {
            page.lines(&panel.curve(&closed), APPROACH);
        }
        self.angles(page, &panel, fan.factor);
        let foot = room[1] + room[3] + 28.0;
        let [left, right] = [room[0], room[0] + 135.0];
        page.legend([left, foot], RAIL, "rail");
        page.legend([right, foot], WHEEL, &format!("wheel at {factor} t"));
        if approach > 0.0 {
            page.legend([left, foot + ROW], APPROACH, &format!("{factor} δ cos α"));
            page.legend([right, foot + ROW], Pen::new(INSIDE, 9.0), "t < δ cos α");
        }
        let end = room[0] + room[2];
        let gaps = Panel { u: panel.u.map(|u| u / fan.factor), ..panel };
        for (panel, name, row) in [(panel, "rail", foot), (gaps, "gaps", foot + ROW)] {
            let start = panel.scale_bar(page, [end, row], 80.0);
            page.text([start - 10.0, row + 4.0], name, SMALL.end());
        }
    }

    /// Draws normals as long as the gap; none where the line misses the wheel, and a dashed one where the gap is cut off.
    fn rays(&self, page: &mut Page, panel: &Panel, fan: &Fan) {
        let (mut whole, mut beyond) = (Vec::new(), Vec::new());
        for normal in self.some_normals(panel, APART[1]) {
            let (length, lines) =
                if normal.gap > fan.shown { (fan.shown, &mut beyond) } else { (normal.gap, &mut whole) };
            lines.extend(panel.curve(&[normal.foot, normal.point(fan.factor * length)]));
        }
        page.lines(&whole, NORMAL);
        page.lines(&beyond, BEYOND);
    }

    /// Marks C, and writes α at both ends of the window, below both bodies.
    fn angles(&self, page: &mut Page, panel: &Panel, factor: f64) {
        let ends = [self.normals.first(), self.normals.last()];
        if let [Some(first), Some(last)] = ends
            && (first.sigma..=last.sigma).contains(&0.0)
        {
            let [x, y] = panel.point([0.0, 0.0]);
            page.area(&[polygon([x, y], DOT, 24, 0.0)], RED);
            page.text([x, y + OFF + 4.0], "C", SMALL.in_colour(RED).middle());
        }
        for normal in ends.into_iter().flatten() {
            let [x, y] = panel.point(normal.point(factor * normal.gap.min(0.0)));
            let [a, b] = normal.direction;
            let at = [x - OFF * a, y + OFF * b + 4.0];
            // The words go on in the direction of the material.
            let words = match a {
                a if a > SIDEWAYS => SMALL.end(),
                a if a < -SIDEWAYS => SMALL,
                _ => SMALL.middle(),
            };
            page.text(at, format!("α = {}°", number(normal.degrees(), 0.1)), words);
        }
    }

    /// Draws lines of equal gap over the unrolled surface, at one scale, with α above them.
    fn unrolled(&self, page: &mut Page, room: [f64; 4]) {
        let above = [room[0], room[1] - 20.0, room[2], room[3]];
        page.heading(above, "Normal gap t(σ, η) before approach, the rail's surface unrolled, true scale");
        let map = Map {
            gap: "t",
            along: "σ",
            boundary: "t = δ cos α",
            cells: self.cells,
            values: self.gap,
            loops: self.loops.to_vec(),
            pressed: None,
            approach: self.approach(),
        };
        let panel = map.draw(page, room);
        panel
            .above(page, "α [°]", |sigma| self.degrees(sigma).map_or_else(String::new, |a| number(a, 0.1)));
    }

    /// Returns α \[°\] at σ, linear between two normals; `None` beyond them.
    fn degrees(&self, sigma: f64) -> Option<f64> {
        let next = self.normals.partition_point(|normal| normal.sigma < sigma);
        let b = self.normals.get(next)?;
        let a = self.normals.get(next.saturating_sub(1)).filter(|a| a.sigma <= sigma).unwrap_or(b);
        if a.sigma > sigma || a.sigma == b.sigma {
            return (b.sigma == sigma).then(|| b.degrees());
        }
        let share = (sigma - a.sigma) / (b.sigma - a.sigma);
        Some(a.degrees() + share * (b.degrees() - a.degrees()))
    }
}

/// The magnification of the gaps.
struct Fan {
    /// 1, 2 or 5 times a power of ten.
    factor: f64,
    /// Largest gap shown \[mm\].
    shown: f64,
}

impl Fan {
    /// Chooses the factor by the largest gap that matters, or the deepest overlap if that is more.
    fn new(picture: &ConformalPicture<'_>) -> Self {
        let [low, high] = extremes(picture.normals.iter().map(|normal| normal.gap)).ends();
        let approach = picture.approach();
        let high = if approach > 0.0 { high.min(SHOWN_GAP * approach) } else { high };
        let (most, longest) = (high.max(approach).max(-low), LONGEST * picture.length());
        if !most.is_normal() {
            return Self { factor: 1.0, shown: longest };
        }
        let factor = round_below(longest / most).max(1.0);
        Self { factor, shown: most.min(longest / factor) }
    }

    /// Returns whether gaps are larger than what is shown.
    fn cuts(&self, normals: &[RailNormal]) -> bool {
        normals.iter().any(|normal| normal.gap > self.shown)
    }

    /// Returns the ends of the magnified gaps; NaN separates pieces between which the gap is larger than shown or undefined.
    fn wheel(&self, normals: &[RailNormal]) -> Vec<[f64; 2]> {
        let within = |normal: &RailNormal| normal.gap <= self.shown;
        let end = |normal: &RailNormal| normal.point(self.factor * normal.gap);
        let mut points = Vec::with_capacity(normals.len());
        for pair in normals.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if within(&a) {
                points.push(end(&a));
            }
            if within(&a) != within(&b) {
                let share = (self.shown - a.gap) / (b.gap - a.gap);
                let (from, to) = (end(&a), end(&b));
                points.push([0, 1].map(|k| from[k] + share * (to[k] - from[k])));
            }
            if !within(&b) {
                points.push([f64::NAN; 2]);
            }
        }
        points.extend(normals.last().filter(|last| within(last)).map(end));
        points
    }
}

#[cfg(test)]
mod tests;
