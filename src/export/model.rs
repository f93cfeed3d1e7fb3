//! The input of the writers: slices of numbers, and statements about them.

use nalgebra::{Isometry2, Point3, Unit, Vector3};

use crate::error::{Error, Result};
use crate::mesh::TriangleMesh;
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::separation::{LowerBody, LowerSurface};

/// Largest difference of one step from the mean step of an evenly spaced grid, as a multiple of the largest |coordinate|. A
/// smaller factor would refuse grids that are even to rounding (two roundings of `from + i·step` at each end). A larger one would
/// accept points that are not where a solver, which reads only the first point and the step, assumes them.
const STEP_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The contact frame ξηζ in the rail profile's axes (x lateral, y rolling direction, z up) \[mm\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The initial contact point C.
    pub origin: Point3<f64>,
    /// Direction of ξ, along the common tangent.
    pub xi: Unit<Vector3<f64>>,
    /// Direction of η, along the rail.
    pub eta: Unit<Vector3<f64>>,
    /// Direction of ζ, along the common normal from rail to wheel.
    pub zeta: Unit<Vector3<f64>>,
}

impl From<&Isometry2<f64>> for Frame {
    /// Makes the frame in space from the contact frame of the rail's plane (x, z), which
    /// [`Body::contact_frame`](crate::placement::Body::contact_frame) returns: eqs. (4.2). ξ × η = ζ.
    fn from(in_plane: &Isometry2<f64>) -> Self {
        let (origin, turn) = (in_plane.translation.vector, in_plane.rotation);
        Self {
            origin: Point3::new(origin.x, 0.0, origin.y),
            xi: Unit::new_unchecked(Vector3::new(turn.re, 0.0, turn.im)),
            eta: Vector3::y_axis(),
            zeta: Unit::new_unchecked(Vector3::new(-turn.im, 0.0, turn.re)),
        }
    }
}

impl Frame {
    /// Returns the contact frame of a placed pair; on a rail that varies along the track, y is that of its slices.
    pub fn of(placement: &Placement) -> Self {
        let Some(lofted) = placement.lofted_rail() else {
            return Self::from(&placement.rail().contact_frame());
        };
        let [xi, eta, zeta] = lofted.axes().map(|axis| Unit::new_normalize(Vector3::from(axis)));
        Self { origin: Point3::from(lofted.origin()), xi, eta, zeta }
    }
}

/// The statements that every file makes about itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Title of the scene.
    pub title: String,
    /// Version of this program, e.g. `0.1.0`.
    pub version: String,
    /// Hash of the scene that was run.
    pub scene_hash: String,
    /// Approach δ \[mm\], ≥ 0, typically 0.01 to 0.2.
    pub approach: f64,
    /// The frame of all coordinates.
    pub frame: Frame,
    /// Special properties of this contact that a reader must know.
    pub remarks: Vec<String>,
}

impl Header {
    /// Makes the header of a contact without a scene: its hash is `none`, and there are no remarks.
    pub fn new(title: String, frame: Frame, approach: f64) -> Self {
        let (version, scene_hash) = (env!("CARGO_PKG_VERSION").into(), "none".into());
        Self { title, version, scene_hash, approach, frame, remarks: Vec::new() }
    }

    /// Returns the lines that explain a file: ASCII, at most 76 columns, none empty.
    pub fn statements(&self) -> Vec<String> {
        let remarks = self.remarks.iter().flat_map(|remark| wrapped(remark));
        let lines = [
            format!("title: {}", self.title),
            format!("written by wheelrail {}", self.version),
            format!("scene {}", self.scene_hash),
            "lengths in mm; contact frame, right-handed, origin C on the rail:".into(),
            "xi along the common tangent, eta along the rail (rolling direction),".into(),
            "zeta along the common normal from rail to wheel".into(),
            "separation s = zeta(wheel) - zeta(rail) at equal xi, eta, before any".into(),
            "approach: s > 0 apart, s < 0 overlapping".into(),
            format!("approach delta = {:?} mm; patch where s < delta", self.approach),
            "values at grid points = centres of the cells d_xi x d_eta (not corners)".into(),
            "order [i_xi][i_eta]: eta fastest, both ascending".into(),
            "undefined where a body has no surface: NaN in arrays, mask m = 0 in text".into(),
        ];
        lines.into_iter().chain(remarks).map(|line| plain(&line)).collect()
    }
}

/// Returns lines of at most [`LINE`] characters, divided between words; a longer word is a line of its own.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= LINE => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

/// Most characters of a line of a comment.
const LINE: usize = 76;

/// Returns one printable ASCII line of at most [`LINE`] characters, fit for the comments of every format:
/// `--`, which XML forbids in a comment, becomes `==`.
pub(super) fn plain(line: &str) -> String {
    let printable = |c: char| if c.is_ascii_graphic() || c == ' ' { c } else { '?' };
    let line: String = line.chars().map(printable).take(LINE).collect();
    line.replace("--", "==")
}

/// The separation over the grid, and the rail below it.
#[derive(Debug, Clone, Copy)]
pub struct GridFields<'a> {
    xi: &'a [f64],
    eta: &'a [f64],
    separation: &'a [f64],
    rail_height: &'a [f64],
    rail_normal: &'a [[f64; 2]],
    surface: Option<&'a LowerSurface>,
    pressure: Option<&'a [f64]>,
}

impl<'a> GridFields<'a> {
    /// Makes the fields from arrays whose lengths must agree.
    ///
    /// `xi`, `eta`: ascending grid coordinates \[mm\]. `separation`: s \[mm\] at `i_xi * n_eta + i_eta`, NaN where
    /// undefined. `rail_height`: ζ^R(ξ) \[mm\] for each ξ, NaN where the rail has no surface. `rail_normal`: the rail's
    /// outward (upward) unit normal (n_ξ, n_ζ) for each ξ.
    ///
    /// # Errors
    /// An empty axis, or lengths that do not agree.
    pub fn new(
        xi: &'a [f64],
        eta: &'a [f64],
        separation: &'a [f64],
        rail_height: &'a [f64],
        rail_normal: &'a [[f64; 2]],
    ) -> Result<Self> {
        let lengths = [
            ("separation", separation.len(), xi.len() * eta.len()),
            ("rail heights", rail_height.len(), xi.len()),
            ("rail normals", rail_normal.len(), xi.len()),
        ];
        for (what, found, expected) in lengths {
            same_length(what, found, expected)?;
        }
        if separation.is_empty() {
            return Err(Error::new("grid", "no points", "at least one", "give xi and eta values"));
        }
        Ok(Self { xi, eta, separation, rail_height, rail_normal, surface: None, pressure: None })
    }

    /// Makes the fields of s over a lower body, whose heights and normals they take; other arrays as in [`GridFields::new`].
    ///
    /// # Errors
    /// An empty axis, or lengths that do not agree.
    pub fn over(xi: &'a [f64], eta: &'a [f64], separation: &'a [f64], lower: &'a LowerBody) -> Result<Self> {
        let fields = Self::new(xi, eta, separation, &lower.height, &lower.normal)?;
        if let Some(surface) = &lower.surface {
            same_length("falls of the lower body", surface.fall.len(), separation.len())?;
            same_length("normals of the lower body", surface.normal.len(), separation.len())?;
        }
        Ok(Self { surface: lower.surface.as_ref(), ..fields })
    }

    /// Returns the fields with the pressures \[N/mm²\] at their points, at `i_xi * n_eta + i_eta`.
    ///
    /// # Errors
    /// Lengths that do not agree.
    pub fn with_pressure(self, pressure: &'a [f64]) -> Result<Self> {
        same_length("pressures", pressure.len(), self.separation.len())?;
        Ok(Self { pressure: Some(pressure), ..self })
    }

    /// Returns the pressures \[N/mm²\] at `i_xi * n_eta + i_eta`; `None` where none were solved.
    pub fn pressure(&self) -> Option<&'a [f64]> {
        self.pressure
    }

    /// Returns the grid coordinates ξ \[mm\], ascending.
    pub fn xi(&self) -> &'a [f64] {
        self.xi
    }

    /// Returns the grid coordinates η \[mm\], ascending.
    pub fn eta(&self) -> &'a [f64] {
        self.eta
    }

    /// Returns s \[mm\] at `i_xi * n_eta + i_eta`, NaN where undefined.
    pub fn separation(&self) -> &'a [f64] {
        self.separation
    }

    /// Returns s \[mm\] along the column of ξ number `i`.
    pub fn column(&self, i: usize) -> &'a [f64] {
        &self.separation[i * self.eta.len()..(i + 1) * self.eta.len()]
    }

    /// Returns ζ^R(ξ) \[mm\] of the rail at η = 0, NaN where there is no surface.
    pub fn rail_height(&self) -> &'a [f64] {
        self.rail_height
    }

    /// Returns the points \[ξ, η, ζ^R\] \[mm\] of the surface of rail or roller under the column of ξ number `i`. ζ is 0 where
    /// there is no surface, because a point must have coordinates.
    pub(super) fn rail_points(&self, i: usize) -> impl Iterator<Item = [f64; 3]> + 'a {
        let (xi, zeta, surface) = (self.xi[i], self.rail_height[i], self.surface);
        let first = i * self.eta.len();
        let fall = move |j: usize| surface.map_or(0.0, |surface| surface.fall[first + j]);
        self.eta.iter().enumerate().map(move |(j, &eta)| [xi, eta, known(zeta - fall(j))])
    }

    /// Returns the outward unit normals (ξ, η, ζ) of rail or roller along the column of ξ number `i`.
    pub(super) fn lower_normals(&self, i: usize) -> impl Iterator<Item = [f64; 3]> + 'a {
        let ([n_xi, n_zeta], surface) = (self.rail_normal[i], self.surface);
        let first = i * self.eta.len();
        (0..self.eta.len())
            .map(move |j| surface.map_or([n_xi, 0.0, n_zeta], |surface| surface.normal[first + j]))
    }

    /// Returns the mask along the column of ξ number `i`: 1 where s is defined, 0 elsewhere.
    pub(super) fn mask(&self, i: usize) -> impl Iterator<Item = u8> + 'a {
        self.column(i).iter().map(|s| u8::from(!s.is_nan()))
    }

    /// Returns the rail's outward unit normal (n_ξ, n_ζ) for each ξ.
    pub fn rail_normal(&self) -> &'a [[f64; 2]] {
        self.rail_normal
    }

    /// Returns the steps \[d_ξ, d_η\] \[mm\] of a grid of equal steps.
    ///
    /// # Errors
    /// Unequal steps, or an axis of one point, because `format` has no field for the places of the points.
    pub fn steps(&self, format: &str) -> Result<[f64; 2]> {
        Ok([even_step(format, "xi", self.xi)?, even_step(format, "eta", self.eta)?])
    }

    /// Returns the number \[mm\] that replaces an undefined s in formats that need a number: 10 × the largest |s|, or 1 where no s
    /// differs from 0. Much larger values spoil a solver's result without a warning.
    pub fn fill_value(&self) -> f64 {
        // `max` ignores NaN.
        let largest = self.separation.iter().fold(0.0, |largest: f64, s| largest.max(s.abs()));
        if largest == 0.0 { 1.0 } else { 10.0 * largest }
    }
}

/// Returns the value, or 0 for an undefined one.
pub(super) fn known(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

/// Gives the step \[mm\] of an axis of a grid, which `format` needs to have equal steps.
///
/// # Errors
/// Fewer than two values; unequal steps.
pub fn even_step(format: &str, axis: &str, values: &[f64]) -> Result<f64> {
    let advice = format!("give grid.{axis} as from, to, n, or leave {format} out of output.formats");
    let (&[first, ..], &[.., last]) = (values, values) else {
        return Err(Error::new(format!("grid.{axis}"), "no points", "at least two", advice));
    };
    if values.len() < 2 {
        return Err(Error::new(
            format!("grid.{axis}"),
            "one point",
            format!("two or more for {format}"),
            advice,
        ));
    }
    let step = (last - first) / (values.len() - 1) as f64;
    let slack = STEP_ROUNDING * first.abs().max(last.abs());
    let even = |pair: &[f64]| (pair[1] - pair[0] - step).abs() <= slack;
    match values.windows(2).find(|pair| !even(pair)) {
        None => Ok(step),
        Some(pair) => Err(Error::new(
            format!("grid.{axis}"),
            format!("a step of {} mm from {} among steps of {step} mm", pair[1] - pair[0], pair[0]),
            format!("equal steps for {format}"),
            advice,
        )),
    }
}

/// One closed loop of the interpenetration boundary s = δ.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    /// Number of the component that the loop bounds, from 0.
    pub component: usize,
    /// Its points (ξ, η, ζ^R) \[mm\] on the rail's surface, counter-clockwise in (ξ, η), clockwise around a hole. The first is not
    /// repeated at the end.
    pub points: Vec<Point3<f64>>,
}

/// One row of INTERPEN's table: an interval of η in which a line of constant ξ is inside the patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchRow {
    /// ξ of a grid column \[mm\].
    pub xi: f64,
    /// Number of the component, from 0.
    pub component: usize,
    /// Smallest and largest η \[mm\] with s ≤ δ.
    pub eta: Interval,
    /// Whether the lower and the upper end are ends of the window, where s < δ.
    pub cut: [bool; 2],
}

/// The boundary-fitted solver mesh of the patch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct QuadMesh {
    /// Nodes (ξ, η, ζ^R) \[mm\] on the rail's surface.
    pub points: Vec<Point3<f64>>,
    /// Cells: indices of four nodes, counter-clockwise in (ξ, η). A cell at a tip may repeat a node.
    pub quads: Vec<[usize; 4]>,
    /// Exact area of each cell in the ξ–η plane \[mm²\], with its curved boundary edge.
    pub area: Vec<f64>,
    /// Number of the component to which each cell belongs, from 0.
    pub component: Vec<usize>,
}

impl QuadMesh {
    /// Checks the properties that every writer relies on.
    ///
    /// # Errors
    /// Lengths that do not agree; a node number beyond the nodes.
    pub fn validate(&self) -> Result<()> {
        same_length("cell areas", self.area.len(), self.quads.len())?;
        same_length("cell components", self.component.len(), self.quads.len())?;
        nodes_exist(self.quads.iter().flatten(), self.points.len())
    }
}

/// A triangulated surface of one body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceMesh {
    /// Name of what is meshed, in ASCII letters: "patch", "rail", "wheel".
    pub name: &'static str,
    /// Nodes (ξ, η, ζ) \[mm\].
    pub points: Vec<Point3<f64>>,
    /// Triangles: indices of three nodes, counter-clockwise seen from outside the body.
    pub triangles: Vec<[usize; 3]>,
    /// s \[mm\] at the nodes, NaN where it is not defined.
    pub separation: Vec<f64>,
    /// Outward unit normals at the nodes.
    pub normals: Vec<Vector3<f64>>,
}

impl SurfaceMesh {
    /// Checks the properties that every writer relies on.
    ///
    /// # Errors
    /// Lengths that do not agree; a node number beyond the nodes.
    pub fn validate(&self) -> Result<()> {
        same_length("separations of a surface", self.separation.len(), self.points.len())?;
        same_length("normals of a surface", self.normals.len(), self.points.len())?;
        nodes_exist(self.triangles.iter().flatten(), self.points.len())
    }
}

/// The triangle mesh of the patch, with what its nodes and components carry.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchMesh {
    /// The mesh.
    pub mesh: TriangleMesh,
    /// s \[mm\] at the nodes.
    pub separation: Vec<f64>,
    /// Outward unit normals of the rail at the nodes; zero where it has none.
    pub rail_normals: Vec<Vector3<f64>>,
    /// Outward unit normals of the wheel over the nodes; zero where it has none.
    pub wheel_normals: Vec<Vector3<f64>>,
    /// Exact area of each component \[mm²\]: that inside the curve s = δ, not inside the edges of the mesh.
    pub areas: Vec<f64>,
}

impl PatchMesh {
    /// Checks the properties that every writer relies on.
    ///
    /// # Errors
    /// Lengths that do not agree; the number of a node or component that does not exist.
    pub fn validate(&self) -> Result<()> {
        let nodes = self.mesh.points.len();
        same_length("separations of the patch", self.separation.len(), nodes)?;
        same_length("rail normals of the patch", self.rail_normals.len(), nodes)?;
        same_length("wheel normals of the patch", self.wheel_normals.len(), nodes)?;
        same_length("cell components", self.mesh.component.len(), self.mesh.triangles.len())?;
        nodes_exist(self.mesh.component.iter(), self.areas.len())?;
        nodes_exist(self.mesh.triangles.iter().flatten(), nodes)?;
        nodes_exist(self.mesh.boundary.iter().flat_map(|chain| &chain.nodes), nodes)
    }

    /// Returns the nodes of the boundary, ascending.
    pub(super) fn boundary_nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> =
            self.mesh.boundary.iter().flat_map(|chain| &chain.nodes).copied().collect();
        nodes.sort_unstable();
        nodes
    }

    /// Returns the patch as a part of the rail's surface.
    pub fn surface(&self) -> SurfaceMesh {
        SurfaceMesh {
            name: "patch",
            points: self.mesh.points.clone(),
            triangles: self.mesh.triangles.clone(),
            separation: self.separation.clone(),
            normals: self.rail_normals.clone(),
        }
    }
}

/// Checks the length of an array.
///
/// # Errors
/// `found` differs from `expected`.
pub(super) fn same_length(what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Error::new(what, format!("{found} values"), expected.to_string(), "pass arrays of one grid or mesh"))
}

fn nodes_exist<'a>(mut nodes: impl Iterator<Item = &'a usize>, count: usize) -> Result<()> {
    match nodes.find(|&&node| node >= count) {
        None => Ok(()),
        Some(node) => Err(Error::new(
            "mesh cells",
            format!("node {node}"),
            format!("less than {count}, the number of nodes"),
            "pass the mesh with all of its nodes",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_is_right_handed() {
        let frame = crate::export::sample::header().frame;
        assert_eq!(frame.xi.cross(&frame.eta), *frame.zeta);
    }

    #[test]
    fn statements_are_plain_whatever_the_title() {
        let title = format!("Weiche <7> -- \u{3be}\n{}", "x".repeat(200));
        let header = Header { title, ..crate::export::sample::header() };
        for line in header.statements() {
            assert!(
                line.is_ascii() && line.len() <= 76 && !line.contains("--") && !line.is_empty(),
                "{line}"
            );
        }
    }

    #[test]
    fn even_steps_are_told_from_uneven_ones() {
        let even: Vec<f64> = (0..241).map(|i| -12.0 + f64::from(i) * (24.0 / 240.0)).collect();
        assert_eq!(even_step("netcdf", "xi", &even), Ok(0.1));
        let mut uneven = even;
        uneven[100] += 1e-12;
        let error = even_step("netcdf", "xi", &uneven).unwrap_err();
        assert!(error.place == "grid.xi" && error.advice.contains("netcdf"), "{error}");
        assert!(even_step("netcdf", "xi", &[1.0]).is_err());
        assert!(even_step("netcdf", "xi", &[0.0, f64::NAN]).is_err());
    }

    #[test]
    fn fields_that_do_not_fit_are_refused() {
        let (xi, eta) = ([0.0, 1.0], [0.0]);
        assert!(GridFields::new(&xi, &eta, &[0.0; 3], &[0.0; 2], &[[0.0, 1.0]; 2]).is_err());
        assert!(GridFields::new(&xi, &[], &[], &[0.0; 2], &[[0.0, 1.0]; 2]).is_err());
        let grid = GridFields::new(&xi, &eta, &[f64::NAN, -2.0], &[0.0; 2], &[[0.0, 1.0]; 2]).unwrap();
        assert_eq!(grid.fill_value(), 20.0);
        let nowhere = GridFields::new(&xi, &eta, &[f64::NAN; 2], &[0.0; 2], &[[0.0, 1.0]; 2]).unwrap();
        assert!(nowhere.fill_value() > 0.0);
    }
}
