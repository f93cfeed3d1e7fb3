//! Random rough pairs, from their seeds.

use super::*;
use crate::numerics::random::Random;

/// A path that is sampled: its direction turns by a curvature over each length.
struct Path {
    at: [f64; 2],
    angle: f64,
    /// Pairs \[length \[mm\], curvature \[1/mm\]\].
    parts: Vec<[f64; 2]>,
}

impl Path {
    /// Returns points every `spacing` mm with their normals.
    fn points(&self, spacing: f64) -> Vec<[f64; 4]> {
        let (mut at, mut angle) = (self.at, self.angle);
        let mut out = Vec::new();
        for [length, curvature] in &self.parts {
            let steps = (length / spacing).ceil().max(1.0);
            let step = length / steps;
            for _ in 0..steps as u32 {
                out.push([at[0], at[1], -angle.sin(), angle.cos()]);
                let middle = angle + 0.5 * step * curvature;
                at = [at[0] + step * middle.cos(), at[1] + step * middle.sin()];
                angle += step * curvature;
            }
        }
        out.push([at[0], at[1], -angle.sin(), angle.cos()]);
        out
    }

    /// Returns an arc of a radius that turns by an angle, both of the same sign.
    fn turn(radius: f64, angle: f64) -> [f64; 2] {
        [radius * angle.abs(), angle.signum() / radius]
    }
}

fn rail_path(random: &mut Random) -> Path {
    let lean = [0.5 * std::f64::consts::PI, 1.2, 0.9][random.between(0.0, 3.0) as usize];
    let crown = random.between(60.0, 300.0);
    let half = random.between(4.0, 9.0);
    let corner = random.between(2.0, 10.0);
    let side = random.between(1.0, 5.0);
    let over = half / crown;
    let parts = vec![
        [side, 0.0],
        Path::turn(corner, -(lean - over)),
        Path::turn(crown, -2.0 * over),
        Path::turn(corner, -(lean - over)),
        [side, 0.0],
    ];
    Path { at: [-half - corner, -corner - side], angle: lean, parts }
}

fn wheel_path(random: &mut Random) -> Path {
    let flank = random.between(1.0, 1.5);
    let slope = random.between(0.0, 0.08);
    let (tip, root) = (random.between(4.0, 10.0), random.between(6.0, 14.0));
    let back = random.between(0.0, 1.0) < 0.5;
    let mut parts = Vec::new();
    if back {
        parts.extend([[random.between(0.5, 3.0), 0.0], Path::turn(tip, 0.5 * std::f64::consts::PI)]);
    }
    parts.extend([
        Path::turn(tip, flank),
        [random.between(0.5, 3.0), 0.0],
        Path::turn(root, -(flank - slope)),
        [random.between(5.0, 14.0), 0.0],
    ]);
    let angle = if back { -0.5 * std::f64::consts::PI } else { 0.0 };
    Path { at: [-26.0, -9.0], angle, parts }
}

/// Makes wear and faults on sampled points, outwards along their normals \[mm\].
fn worn(points: &[[f64; 4]], random: &mut Random, side: Side, noise: f64) -> Vec<[f64; 2]> {
    let outward = if side == Side::Rail { 1.0 } else { -1.0 };
    let mut faults = Vec::new();
    for _ in 0..random.between(0.0, 3.0) as u32 {
        let middle = random.between(0.0, points.len() as f64) as usize;
        // A pit, a flake or a lip.
        let height = [-0.2, 0.02, 0.6][random.between(0.0, 3.0) as usize] * random.between(0.3, 1.0);
        faults.push((middle, height, random.between(0.3, 1.5)));
    }
    let deviate = |random: &mut Random| (0..4).map(|_| random.between(-1.0, 1.0)).sum::<f64>() * 0.866;
    let out = points.iter().map(|[x, z, nx, nz]| {
        let mut off = noise * deviate(random);
        for (middle, height, width) in &faults {
            let [a, b, ..] = points[*middle];
            off += outward * height * (-(((x - a).powi(2) + (z - b).powi(2)) / (width * width))).exp();
        }
        [x + off * nx, z + off * nz]
    });
    out.collect()
}

/// Cuts the points off at a height, as a flat wears them; the flat is rough.
fn flattened(points: &mut [[f64; 2]], side: Side, depth: f64) {
    let sign = if side == Side::Rail { 1.0 } else { -1.0 };
    let top = points.iter().map(|p| sign * p[1]).fold(f64::NEG_INFINITY, f64::max);
    for (k, point) in points.iter_mut().enumerate() {
        if sign * point[1] > top - depth {
            point[1] = sign * (top - depth + 1e-4 * (k % 3) as f64);
        }
    }
}

/// Returns cubics through the points with the tangents of central differences, or the straight lines between
/// the points.
fn through(points: &[[f64; 2]], straight: bool) -> Result<Profile> {
    let n = points.len();
    let slope = |k: usize, axis: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(n - 1));
        let chord = |i: usize, j: usize| (points[j][0] - points[i][0]).hypot(points[j][1] - points[i][1]);
        let length: f64 = (a..b).map(|i| chord(i, i + 1)).sum();
        (points[b][axis] - points[a][axis]) / length
    };
    let mut segments = Vec::new();
    for k in 0..n - 1 {
        let (a, b) = (points[k], points[k + 1]);
        let shape = if straight {
            Shape::Arc(Arc::line(a, b)?)
        } else {
            let step = (b[0] - a[0]).hypot(b[1] - a[1]);
            let cubic = |axis: usize| {
                let (from, to) = (slope(k, axis), slope(k + 1, axis));
                let mean = (b[axis] - a[axis]) / step;
                let bend = (3.0 * mean - 2.0 * from - to) / step;
                [a[axis], from, bend, (from + to - 2.0 * mean) / (step * step)]
            };
            Shape::Polynomial(Polynomial::span(&cubic(0), &cubic(1), [0.0, step])?)
        };
        segments.push(Segment { label: String::new(), shape });
    }
    Profile::new("rough", "", segments)
}

/// A rough pair and its position.
pub(super) struct Pair3 {
    pub(super) rail: Profile,
    pub(super) wheel: Profile,
    pub(super) pose: [f64; 3],
    /// Distance of the points before they were moved \[mm\].
    pub(super) spacing: f64,
}

pub(super) fn random_pair(seed: u64) -> Result<Pair3> {
    let mut random = Random::new(seed);
    let noise = 1e-3 * [0.0, 1.0, 5.0, 20.0][random.between(0.0, 4.0) as usize];
    let spacing = [0.05, 0.1, 0.3, 1.0][random.between(0.0, 4.0) as usize];
    let straight = random.between(0.0, 1.0) < 0.2;
    let rail_points = rail_path(&mut random).points(spacing);
    let mut rail = worn(&rail_points, &mut random, Side::Rail, noise);
    let conformal = random.between(0.0, 1.0) < 0.15;
    let mut wheel = if conformal {
        // The rail's own crown as a hollow wheel: it touches in many points.
        let inner: Vec<[f64; 4]> = rail_points.iter().copied().filter(|p| p[3] > 0.6).collect();
        worn(&inner, &mut random, Side::Wheel, noise)
    } else {
        worn(&wheel_path(&mut random).points(spacing), &mut random, Side::Wheel, noise)
    };
    for (points, side) in [(&mut rail, Side::Rail), (&mut wheel, Side::Wheel)] {
        if random.between(0.0, 1.0) < 0.15 {
            flattened(points, side, random.between(0.005, 0.05));
        }
    }
    let offset = if conformal { random.between(-0.5, 0.5) } else { random.between(-12.0, 12.0) };
    // The oracle misses a ring that reaches less far than the distance of its samples: so yaw is 0 or not
    // small.
    let yaw = [0.0, 0.0, -1.0, 1.0, 1.0][random.between(0.0, 5.0) as usize] * random.between(0.015, 0.05);
    let roll = [0.0, 1.0][random.between(0.0, 2.0) as usize] * random.between(-0.05, 0.05);
    let pose = [offset, yaw, roll];
    Ok(Pair3 { rail: through(&rail, straight)?, wheel: through(&wheel, straight)?, pose, spacing })
}
