//! Webs and feet of built-in rails, for alignments. No contact reaches them, and so the rails themselves end below their heads.

use serde::Deserialize;

use crate::error::Result;
use crate::profile::{Arc, Profile, Segment, Station};

/// What lies below the head of some rails, from the numbers of their standard. The fishing chamber is symmetric about a level line.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct WebData {
    /// The rails that have it.
    pub rails: Vec<String>,
    /// z of that line \[mm\], half way up the plain part of the web.
    middle_z: f64,
    /// Thickness of the web \[mm\].
    thickness: f64,
    /// Radii of the fillet from the web outwards \[mm\].
    fillet_radii: [f64; 3],
    /// Distances \[mm\] from the level line at which the first of these arcs begins and ends.
    first_fillet: [f64; 2],
    /// Width of the foot \[mm\], and z of its edge before it is rounded.
    foot_width: f64,
    foot_edge_z: f64,
    /// Run per unit of fall of the outer foot.
    foot_1_to: f64,
    /// Radius between inner and outer foot, and that of the edge \[mm\].
    foot_radius: f64,
    foot_edge_radius: f64,
    /// z at which the upright edge ends \[mm\].
    foot_edge_end_z: f64,
    /// Published numbers that the section must reproduce.
    #[cfg(test)]
    check: Vec<SectionCheck>,
}

/// Published area and moments of inertia of a rail.
#[cfg(test)]
#[derive(Debug, Clone, Deserialize)]
struct SectionCheck {
    rail: String,
    /// Area \[cm²\], and its moments about the level and the upright axis through its centre \[cm⁴\].
    area: f64,
    moments: [f64; 2],
    /// Height of the rail, and radius at the bottom of the foot's edge \[mm\].
    height: f64,
    bottom_radius: f64,
}

type Place = [f64; 2];

/// The underside of a head.
pub(super) struct Underside {
    /// Run per unit of rise, outwards.
    pub run: f64,
    /// z of the point where both undersides meet \[mm\].
    pub apex_z: f64,
    /// Radius between flank and underside \[mm\].
    pub fillet_radius: f64,
}

/// Returns a rail with web and upper side of the foot, from one edge of the foot to the other; `head` is the rail as it is built in.
pub(super) fn section(head: &Profile, under: &Underside, web: &WebData) -> Result<Profile> {
    let Some(end) = head.segments().last().map(Segment::end) else { return Ok(head.clone()) };
    let right = below(end, under, web);
    let half = Profile::new(&head.name, &head.source, right.clone())?;
    let mut all = half.mirrored().segments().to_vec();
    all.extend(head.segments().iter().cloned());
    all.extend(right);
    Profile::new(&head.name, &head.source, all)
}

/// Returns what lies below the right end of a head: underside, web and foot.
fn below(head: Station, under: &Underside, web: &WebData) -> Vec<Segment> {
    let n = under.run;
    let at = |[x, d]: Place| [x, web.middle_z + d];
    let lower = |[x, d]: Place| [x, web.middle_z - d];
    let inwards = unit([-n, -1.0]);
    // The underside meets the flank's tangent where it is as high.
    let share = (under.apex_z + head.x / n - head.z) / (head.sin - head.cos / n);
    let corner = [head.x + share * head.cos, head.z + share * head.sin];
    let corner = Rounding::new(corner, [head.cos, head.sin], inwards, under.fillet_radius);
    let (centres, joints) = web.fillet(n, under.apex_z - web.middle_z);
    let radii = web.fillet_radii;
    let mut all = vec![corner.arc(), line(corner.to, at(joints[3]))];
    all.extend((0..3).rev().map(|k| arc(at(centres[k]), radii[k], at(joints[k + 1]), at(joints[k]))));
    all.push(line(at(joints[0]), lower(joints[0])));
    all.extend((0..3).map(|k| arc(lower(centres[k]), radii[k], lower(joints[k]), lower(joints[k + 1]))));
    let (half, m) = (0.5 * web.foot_width, web.foot_1_to);
    // The inner foot is the underside's image; it meets the outer foot here.
    let apex = 2.0 * web.middle_z - under.apex_z;
    let x = (web.foot_edge_z + half / m - apex) / (m.recip() - n.recip());
    let [inner, outer] = [unit([n, -1.0]), unit([m, -1.0])];
    let foot = Rounding::new([x, apex - x / n], inner, outer, web.foot_radius);
    let edge = Rounding::new([half, web.foot_edge_z], outer, [0.0, -1.0], web.foot_edge_radius);
    all.extend([line(lower(joints[3]), foot.from), foot.arc(), line(foot.to, edge.from), edge.arc()]);
    all.push(line(edge.to, [half, web.foot_edge_end_z]));
    all
}

impl WebData {
    /// Returns centres and ends of the fillet's arcs from the web outwards, as \[x, distance from the level line\]. The last one touches
    /// the underside, which rises by 1 in `n` from `apex`.
    fn fillet(&self, n: f64, apex: f64) -> ([Place; 3], [Place; 4]) {
        let [r, second, third] = self.fillet_radii;
        let [begin, end] = self.first_fillet;
        let side = 0.5 * self.thickness;
        let c1 = [side + r, begin];
        let j1 = [c1[0] - (r * r - (end - begin).powi(2)).sqrt(), end];
        let c2 = towards(j1, c1, second / r);
        // The third centre is as far from the underside as from its arc, and on the line of the second one's joint.
        let [along, across] = [unit([n, 1.0]), unit([1.0, -n])];
        let from = [third * across[0] - c2[0], apex + third * across[1] - c2[1]];
        let (over, square) = (dot(from, along), dot(from, from) - (second - third).powi(2));
        let s = -over - (over * over - square).max(0.0).sqrt();
        let j3 = [s * along[0], apex + s * along[1]];
        let c3 = [j3[0] + third * across[0], j3[1] + third * across[1]];
        let j2 = towards(c2, c3, second / (second - third));
        ([c1, c2, c3], [[side, begin], j1, j2, j3])
    }
}

/// An arc between two lines.
struct Rounding {
    centre: Place,
    /// Signed as that of [`Arc`].
    radius: f64,
    from: Place,
    to: Place,
}

impl Rounding {
    /// Rounds the corner at which the direction changes from `u` to `w`, both of length 1.
    fn new(corner: Place, u: Place, w: Place, radius: f64) -> Self {
        let turn = (u[0] * w[1] - u[1] * w[0]).atan2(dot(u, w));
        let taken = radius * (0.5 * turn.abs()).tan();
        let radius = radius.copysign(turn);
        let from = [corner[0] - taken * u[0], corner[1] - taken * u[1]];
        let to = [corner[0] + taken * w[0], corner[1] + taken * w[1]];
        Self { centre: [from[0] - radius * u[1], from[1] + radius * u[0]], radius, from, to }
    }

    fn arc(&self) -> Segment {
        arc(self.centre, self.radius, self.from, self.to)
    }
}

/// Makes the arc about a centre between two points on its circle; `radius` is signed.
fn arc(centre: Place, radius: f64, from: Place, to: Place) -> Segment {
    let at = |[x, z]: Place| Station { x, z, cos: (centre[1] - z) / radius, sin: (x - centre[0]) / radius };
    Segment::arc(Arc { start: at(from), end: at(to), radius })
}

fn line(from: Place, to: Place) -> Segment {
    let [cos, sin] = unit([to[0] - from[0], to[1] - from[1]]);
    let at = |[x, z]: Place| Station { x, z, cos, sin };
    Segment::arc(Arc { start: at(from), end: at(to), radius: f64::INFINITY })
}

fn unit([x, z]: Place) -> Place {
    let length = x.hypot(z);
    [x / length, z / length]
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the point at a share of the way from `a` to `b`.
fn towards(a: Place, b: Place, share: f64) -> Place {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::standards::{RAILS, rail, with_web};
    use crate::profile::trace;

    /// Published values are rounded to half of their last digit: 0.01 cm² and 0.1 cm⁴.
    const AREA: f64 = 0.0051;
    const MOMENT: f64 = 0.1;

    /// Area \[cm²\] and both moments \[cm⁴\] of a closed outline.
    fn properties(ring: &[Place]) -> (f64, [f64; 2]) {
        let edges = || ring.iter().zip(ring.iter().cycle().skip(1));
        let sum = |of: &dyn Fn(Place, Place) -> f64| {
            edges().map(|(a, b)| (a[0] * b[1] - b[0] * a[1]) * of(*a, *b)).sum::<f64>()
        };
        let area = sum(&|_, _| 0.5);
        let centre = sum(&|a, b| (a[1] + b[1]) / 6.0) / area;
        let moment = |k: usize| sum(&|a, b| (a[k] * a[k] + a[k] * b[k] + b[k] * b[k]) / 12.0);
        let [level, upright] = [moment(1) - area * centre * centre, moment(0)];
        (area.abs() / 1e2, [level.abs() / 1e4, upright.abs() / 1e4])
    }

    #[test]
    fn sections_have_their_published_areas_and_moments() -> Result<()> {
        let mut checked = 0;
        for web in &RAILS.webs {
            for check in &web.check {
                let whole = with_web(&rail(&check.rail)?).expect("a web");
                for joint in whole.continuity() {
                    assert!(joint.gap < 1e-9 && joint.kink.abs() < 1e-9, "{}: {joint:?}", check.rail);
                }
                let mut ring: Vec<Place> =
                    trace(&whole, 0.05).iter().map(|mark| [mark.station.x, mark.station.z]).collect();
                let (half, r) = (0.5 * web.foot_width, check.bottom_radius);
                for k in 0..=50 {
                    let (sin, cos) = (f64::from(k) / 50.0 * std::f64::consts::FRAC_PI_2).sin_cos();
                    ring.push([half - r * (1.0 - cos), -check.height + r * (1.0 - sin)]);
                }
                for k in 0..=50 {
                    let (sin, cos) = (f64::from(k) / 50.0 * std::f64::consts::FRAC_PI_2).sin_cos();
                    ring.push([-half + r * (1.0 - sin), -check.height + r * (1.0 - cos)]);
                }
                let (area, moments) = properties(&ring);
                assert!((area - check.area).abs() < AREA, "{}: {area}", check.rail);
                for (own, published) in moments.into_iter().zip(check.moments) {
                    assert!((own - published).abs() < MOMENT, "{}: {own} {published}", check.rail);
                }
                checked += 1;
            }
        }
        assert_eq!(checked, 2);
        Ok(())
    }

    #[test]
    fn a_web_lies_as_its_head() -> Result<()> {
        let rail = rail("60E2")?;
        let moved = rail.rotated(nalgebra::UnitComplex::new(0.05)).shifted(3.0, -7.0);
        let whole = with_web(&moved).expect("a web");
        let own =
            with_web(&rail).expect("a web").rotated(nalgebra::UnitComplex::new(0.05)).shifted(3.0, -7.0);
        for (a, b) in whole.segments().iter().zip(own.segments()) {
            let (a, b) = (a.end(), b.end());
            assert!((a.x - b.x).abs() < 1e-9 && (a.z - b.z).abs() < 1e-9, "{a:?} {b:?}");
        }
        Ok(())
    }
}
