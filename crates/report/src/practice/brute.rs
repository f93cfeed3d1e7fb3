//! Finds first touch and separation by brute force, from the definitions of the axes alone.

use super::polyline::{Facing, Polyline, Vertex, outermost, vertices};
use wheelrail::nalgebra::{Isometry2, Point2, Rotation3, UnitComplex, Vector2, Vector3};
use wheelrail::placement::{Pair, Placement};

/// The attitude of a wheel: position of its profile origin beside the rail's \[mm\] and angles \[rad\], in
/// the side's own axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stance {
    pub offset: f64,
    pub yaw: f64,
    pub roll: f64,
}

/// A pair as vertices.
#[derive(Debug)]
pub(super) struct PairOfVertices {
    pub rail: Vec<Vertex>,
    pub wheel: Vec<Vertex>,
    pub radius: f64,
}

/// First touch of a pair.
#[derive(Debug)]
pub(super) struct FirstTouch {
    /// Height of the wheel's profile origin over the rail's \[mm\].
    pub height: f64,
    rail: Polyline,
    wheel: Polyline,
    /// Pairs \[abscissa, gap at first touch\] \[mm\] at every vertex of either outline, by ascending abscissa.
    pub gaps: Vec<[f64; 2]>,
}

/// Step \[rad\] of the angle about the axle between points of the outline.
const TURN: f64 = 5e-4;
/// Angle \[rad\] about the axle to which the edge of a wheel's end is followed.
const EDGE: f64 = 0.06;

impl PairOfVertices {
    pub fn new(pair: &Pair) -> Self {
        Self { rail: vertices(pair.rail()), wheel: vertices(pair.wheel()), radius: pair.wheel_radius() }
    }

    /// Lowers the wheel; `None` if it is not over its rail.
    pub fn lowered(&self, standing: &Stance) -> Option<FirstTouch> {
        let rail = Polyline::new(self.rail.iter().map(|v| [v.x, v.z]).collect(), Facing::Up);
        let wheel = Polyline::new(self.outline(standing), Facing::Down);
        let mut x: Vec<f64> = rail.abscissae().chain(wheel.abscissae()).collect();
        x.sort_by(f64::total_cmp);
        let over = |x: f64| Some([x, wheel.height(x)? - rail.height(x)?]);
        let mut gaps: Vec<[f64; 2]> = x.into_iter().filter_map(over).collect();
        let least = gaps.iter().map(|gap| gap[1]).fold(f64::INFINITY, f64::min);
        gaps.iter_mut().for_each(|gap| gap[1] -= least);
        (!gaps.is_empty()).then_some(FirstTouch { height: -least, rail, wheel, gaps })
    }

    /// Returns the outline of the wheel as seen along the rail, with its profile origin at height 0: the points of
    /// each circle whose surface normal has no component along the rail.
    fn outline(&self, standing: &Stance) -> Vec<[f64; 2]> {
        let axes = Directions::new(standing);
        let mut out: Vec<[f64; 2]> = Vec::with_capacity(self.wheel.len());
        let mut before: Option<(Vertex, f64)> = None;
        let (first, last) = (self.wheel.first(), self.wheel.last());
        out.extend(first.into_iter().flat_map(|end| self.edge(&axes, standing, end)));
        for vertex in &self.wheel {
            // n = sinθ a + cosθ ρ(β) with n_y = 0.
            let sin = -standing.yaw.tan() * vertex.sin / vertex.cos;
            if vertex.cos <= 0.0 || sin.abs() > 0.9 {
                continue;
            }
            let turn = sin.asin();
            if let Some((last, start)) = before {
                let steps = ((turn - start).abs() / TURN).ceil();
                for k in 1..steps as usize {
                    let share = k as f64 / steps;
                    let at = [last.x + share * (vertex.x - last.x), last.z + share * (vertex.z - last.z)];
                    out.push(axes.place(standing, self.radius, at, start + share * (turn - start)));
                }
            }
            out.push(axes.place(standing, self.radius, [vertex.x, vertex.z], turn));
            before = Some((*vertex, turn));
        }
        out.extend(last.into_iter().flat_map(|end| self.edge(&axes, standing, end)));
        out
    }

    fn edge(&self, axes: &Directions, standing: &Stance, end: &Vertex) -> Vec<[f64; 2]> {
        let steps = (EDGE / TURN) as i32;
        let place = |k: i32| axes.place(standing, self.radius, [end.x, end.z], TURN * f64::from(k));
        if standing.yaw == 0.0 { vec![place(0)] } else { (-steps..=steps).map(place).collect() }
    }

    /// Returns s(ξ, η) \[mm\] of a placed pair; `None` where a body has no surface.
    pub fn separation(&self, placement: &Placement, xi: f64, eta: f64) -> Option<f64> {
        let seen = |frame: &Isometry2<f64>, x: f64, z: f64| -> [f64; 2] {
            frame.inverse_transform_point(&Point2::new(x, z)).into()
        };
        let frame = placement.rail().contact_frame();
        let rail = outermost(self.rail.iter().map(|v| seen(&frame, v.x, v.z)), xi, Facing::Up)?;
        let own = UnitComplex::new(placement.skew()).inverse_transform_vector(&Vector2::new(xi, eta));
        let (xi_w, eta_w) = (own.x, own.y);
        let frame = placement.wheel().contact_frame();
        let section = self.wheel.iter().map(|v| {
            let distance = self.radius - v.z;
            // The circle of this point, cut by the plane η′.
            let sagitta = eta_w * eta_w / (distance + (distance * distance - eta_w * eta_w).sqrt());
            seen(&frame, v.x, v.z + sagitta)
        });
        Some(outermost(section, xi_w, Facing::Down)? - rail)
    }
}

impl FirstTouch {
    /// Returns the gap at first touch at one abscissa \[mm\].
    pub fn gap(&self, x: f64) -> Option<f64> {
        Some(self.wheel.height(x)? - self.rail.height(x)? + self.height)
    }

    /// Returns \[abscissa, gap\] of every place that is the lowest within `apart` to either side, up to the
    /// gap `within` \[mm\].
    pub fn lowest_places(&self, within: f64, apart: f64) -> Vec<[f64; 2]> {
        let mut out = Vec::new();
        let (mut from, mut to) = (0, 0);
        // Indices of the window's candidates for the least gap, by ascending gap.
        let mut least: std::collections::VecDeque<usize> = std::collections::VecDeque::new();
        for (k, [x, gap]) in self.gaps.iter().enumerate() {
            while to < self.gaps.len() && self.gaps[to][0] <= x + apart {
                while least.back().is_some_and(|&j| self.gaps[j][1] >= self.gaps[to][1]) {
                    least.pop_back();
                }
                least.push_back(to);
                to += 1;
            }
            while self.gaps[from][0] < x - apart {
                from += 1;
            }
            while least.front().is_some_and(|&j| j < from) {
                least.pop_front();
            }
            if *gap <= within && least.front() == Some(&k) {
                out.push([*x, *gap]);
            }
        }
        out
    }
}

/// Directions of a turned wheel in the rail's (x, z): along the axle, forward, up.
#[derive(Debug, Clone, Copy)]
struct Directions {
    along: Vector2<f64>,
    forward: Vector2<f64>,
    up: Vector2<f64>,
}

impl Directions {
    /// Returns the columns of R_y(roll) R_z(yaw), both right-handed.
    fn new(standing: &Stance) -> Self {
        let turned = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
        let turn = turned(Vector3::y_axis(), standing.roll) * turned(Vector3::z_axis(), standing.yaw);
        let [along, forward, up] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (turn * axis).xz());
        Self { along, forward, up }
    }

    /// Returns a point of the profile turned about the axle, in the rail's (x, z), with the wheel's profile
    /// origin at height 0.
    fn place(&self, standing: &Stance, radius: f64, [x, z]: [f64; 2], turn: f64) -> [f64; 2] {
        let (sin, cos) = turn.sin_cos();
        let distance = radius - z;
        let turned = radius * self.up + x * self.along + distance * (self.forward * sin - self.up * cos);
        [standing.offset + turned.x, turned.y]
    }
}
