//! Outlines of whole rails with web and foot, and scans of one side of them, for the tests of measures and of the program.

use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::profile::{Station, standards, trace};

/// Distance of the points of which outlines are made \[mm\].
const FINE: f64 = 0.05;
/// The right half of 60E1, 60E2 and UIC60 below the head, from the underside down: centres, signed radii and ends of arcs, 0 for lines.
/// Mirrored about z = −95.75 it goes on to the foot.
const FISHING: [([f64; 2], f64, [f64; 2]); 3] = [
    ([18.911_230_74, 44.178_365_78], 7.0, [12.269_322_64, 46.388_582_23]),
    ([45.478_863_16, 35.337_5], 35.0, [11.396_630_34, 43.3]),
    ([128.25, 16.0], 120.0, [8.25, 16.0]),
];
const UNDERSIDE: [f64; 2] = [16.519_029_3, 50.756_919_75];

/// Appends points of an arc about a centre, the shorter way, or of a line.
fn go(points: &mut Vec<[f64; 2]>, (centre, radius): ([f64; 2], f64), to: [f64; 2]) {
    let from = points[points.len() - 1];
    let angle = |[x, z]: [f64; 2]| (z - centre[1]).atan2(x - centre[0]);
    let turn = (angle(to) - angle(from) + 9.0 * std::f64::consts::PI).rem_euclid(2.0 * std::f64::consts::PI)
        - std::f64::consts::PI;
    let length = if radius > 0.0 { radius * turn.abs() } else { (to[0] - from[0]).hypot(to[1] - from[1]) };
    let count = (length / FINE).ceil().max(1.0) as usize;
    for k in 1..=count {
        let share = k as f64 / count as f64;
        let (sin, cos) = (angle(from) + share * turn).sin_cos();
        points.push(if radius > 0.0 {
            [centre[0] + radius * cos, centre[1] + radius * sin]
        } else {
            [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
        });
    }
}

/// Appends a corner that is rounded on the way from the last point to `next`.
fn round(points: &mut Vec<[f64; 2]>, corner: [f64; 2], next: [f64; 2], radius: f64) {
    let from = points[points.len() - 1];
    let unit = |a: [f64; 2], b: [f64; 2]| {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
    };
    let (u, w) = (unit(from, corner), unit(corner, next));
    let turn = (u[0] * w[1] - u[1] * w[0]).atan2(u[0] * w[0] + u[1] * w[1]);
    let taken = radius * (0.5 * turn.abs()).tan();
    let [begin, end] =
        [[-taken, u[0], u[1]], [taken, w[0], w[1]]].map(|[t, x, z]| [corner[0] + t * x, corner[1] + t * z]);
    let signed = radius.copysign(turn);
    go(points, ([0.0; 2], 0.0), begin);
    go(points, ([begin[0] - signed * u[1], begin[1] + signed * u[0]], radius), end);
}

/// Appends the image of a right half.
fn whole(right: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let left = right.iter().rev().filter(|at| at[0] > 0.0).map(|[x, z]| [-x, *z]);
    left.collect::<Vec<_>>().into_iter().chain(right).collect()
}

/// The outline of a built-in rail with its web and foot.
pub fn built_in(name: &str) -> Result<Vec<[f64; 2]>> {
    let head = standards::rail(name)?;
    let mut right: Vec<[f64; 2]> = trace(&head, FINE)
        .iter()
        .map(|mark| [mark.station.x, mark.station.z])
        .filter(|at| at[0] >= 0.0)
        .collect();
    let at = |d: f64| -95.75 + d;
    // The flank goes on to the underside, 1:2.75 from an apex 51 mm below the top.
    let end = right[right.len() - 1];
    let z = (-51.0 + (end[0] + 0.05 * end[1]) / 2.75) / (1.0 + 0.05 / 2.75);
    let corner = [end[0] + 0.05 * (end[1] - z), z];
    right.pop();
    round(&mut right, corner, [UNDERSIDE[0], at(UNDERSIDE[1])], 3.0);
    go(&mut right, ([0.0; 2], 0.0), [UNDERSIDE[0], at(UNDERSIDE[1])]);
    for (centre, radius, to) in FISHING {
        go(&mut right, ([centre[0], at(centre[1])], radius), [to[0], at(to[1])]);
    }
    go(&mut right, ([0.0; 2], 0.0), [8.25, at(-16.0)]);
    let ends = [FISHING[1].2, FISHING[0].2, UNDERSIDE];
    for ((centre, radius, _), to) in FISHING.into_iter().rev().zip(ends) {
        go(&mut right, ([centre[0], at(-centre[1])], radius), [to[0], at(-to[1])]);
    }
    round(&mut right, [50.111_111_11, -158.722_222_22], [75.0, -160.5], 40.0);
    round(&mut right, [75.0, -160.5], [75.0, -170.0], 4.0);
    go(&mut right, ([0.0; 2], 0.0), [75.0, -170.0]);
    Ok(whole(right))
}

/// The outline of a rail that no standard has.
pub fn drawn_at_random(random: &mut Random) -> Vec<[f64; 2]> {
    let mut of = |from: f64, to: f64| random.between(from, to);
    let (head, web, foot) = (of(30.0, 37.0), 0.5 * of(13.0, 19.0), 0.5 * of(125.0, 155.0));
    let (depth, height) = (of(32.0, 42.0), of(140.0, 186.0));
    let lower = [head + 0.05 * depth, -depth];
    let under = [web, -depth - (head - web) / of(2.2, 4.0)];
    let edge = of(9.0, 13.0);
    let kink = [of(35.0, 50.0), -height + edge + of(2.0, 3.5)];
    let inner = [web, kink[1] + (kink[0] - web) / of(2.2, 4.0)];
    let crown = of(200.0, 400.0);
    let flat = 0.55 * head;
    // A crown of one radius up to where its tangent meets the corner.
    let mut right = vec![[0.0, 0.0]];
    go(&mut right, ([0.0, -crown], crown), [flat, (crown * crown - flat * flat).sqrt() - crown]);
    let last = right[right.len() - 1];
    let slope = flat / (last[1] + crown);
    let corner = [head, last[1] - slope * (head - last[0])];
    round(&mut right, corner, lower, of(7.0, 12.0));
    round(&mut right, lower, under, of(1.0, 4.0));
    round(&mut right, under, inner, of(12.0, 25.0));
    round(&mut right, inner, kink, of(12.0, 25.0));
    round(&mut right, kink, [foot, -height + edge], of(20.0, 40.0));
    round(&mut right, [foot, -height + edge], [foot, -height + 1.0], of(2.0, 5.0));
    go(&mut right, ([0.0; 2], 0.0), [foot, -height + 2.0]);
    whole(right)
}

/// A scan: one side of an outline, worn at its head, moved, turned and noisy.
#[derive(Debug)]
pub struct Scan {
    pub gauge_side: bool,
    pub depth: [f64; 2],
    pub motion: [f64; 3],
    pub sigma: f64,
    pub step: f64,
}

impl Scan {
    pub fn random(random: &mut Random) -> Self {
        Self {
            gauge_side: random.below(4) > 0,
            depth: [random.between(0.0, 4.0), random.between(0.0, 4.0)],
            motion: [random.between(-50.0, 50.0), random.between(-50.0, 50.0), random.between(-1.5, 1.5)],
            sigma: *random.pick(&[0.0, 0.005, 0.01, 0.02]),
            step: random.between(0.2, 0.6),
        }
    }

    pub fn worn(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        // Wear ends well above the lower edge of the head.
        let upper = 1.0 / (1.0 + (-(z + 20.0) / 1.0).exp());
        let face = 1.0 / (1.0 + ((x + 24.0) / 2.0).exp());
        [x + self.depth[1] * face * upper, z - self.depth[0] * upper / (1.0 + ((x - 30.0) / 2.0).exp())]
    }

    pub fn points(&self, outline: &[[f64; 2]], random: &mut Random) -> Vec<[f64; 2]> {
        // The motion leads back to the nominal.
        let [x, z, degrees] = self.motion;
        let (sin, cos) = degrees.to_radians().sin_cos();
        let frame = Station { x, z, cos, sin };
        let sign = if self.gauge_side { 1.0 } else { -1.0 };
        let worn: Vec<[f64; 2]> = outline.iter().map(|at| self.worn(*at)).collect();
        let (mut points, mut way) = (Vec::new(), f64::INFINITY);
        for pair in worn.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            way += length;
            if way < self.step || sign * a[0] > 15.0 || length == 0.0 {
                continue;
            }
            way = 0.0;
            let off = self.sigma * random.normal();
            let [cos, sin] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
            let at = Station { x: a[0] - off * sin, z: a[1] + off * cos, ..Station::AXES }.seen_from(&frame);
            points.push([at.x, at.z]);
        }
        points
    }
}

/// Returns x, z and the turn of an alignment.
pub fn motion(text: &str) -> Option<[f64; 3]> {
    let (by, turn) = text.split_once("moved by (")?.1.split_once(") mm, turned by ")?;
    let (x, z) = by.split_once(", ")?;
    let turn = turn.split(" deg").next()?;
    Some([x.parse().ok()?, z.parse().ok()?, turn.parse().ok()?])
}
