//! The graded triangle mesh of a patch for finite elements.
//!
//! Every component is meshed by itself. Its boundary is divided into edges whose nodes lie on the exact curve. The crate
//! `spade` triangulates it and refines the triangles until their angles are good. Refinement divides edges of the boundary
//! at points of the chord: these nodes are put onto the curve, and the component is triangulated anew, until no edge is
//! divided. The inner nodes are then smoothed.

use std::f64::consts::{FRAC_PI_6, TAU};

use nalgebra::{Point2, Point3};

use super::boundary::{BoundaryTracer, Ring};
use super::delaunay::{self, MeshRegion};
use super::smoothing::{angles, smooth};
use super::spacing::{self, BoundaryNode, EdgeLimits, RingSpacing};
use crate::error::{Error, ErrorKind, Result, finite};
use crate::patch::{Component, Patch};
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Edges along the side of a square with the area of a component, if no size is given.
const EDGES_PER_SIDE: f64 = 16.0;

/// Largest chord error, as a share of the size.
const CHORD_SHARE: f64 = 0.01;

/// Largest area of a triangle, as a multiple of that of an equilateral triangle with sides of the size.
const AREA_SHARE: f64 = 1.3;

/// Least number of samples of a ring. One with fewer has no inside.
const LEAST_SAMPLES: usize = 3;

/// Most cells of a component. With more, cells are smaller than the accuracy of the patch, which can only be a mistake.
const MOST_CELLS: f64 = 1e6;

/// Most points that refinement may add to a component, beyond those that its area asks for.
const MOST_ADDED: f64 = 1e5;

/// Most rounds of refinement in which edges of the boundary are divided.
const ROUNDS: usize = 12;

/// Most that all attempts and rounds at a component may count before the best mesh so far is taken: nodes, [`edge_cost`] of every round, and
/// twice that of the next one. Its nodes are not known before, and may be as many again. This takes a few seconds.
const MOST_MADE: usize = 2_000_000;

/// Number of edges around a thin part from which on they count more than their nodes: 5,000 take 40 ms, and 30,000 take half a second, so
/// that these are triangulated three times at most.
const LONG_BOUNDARY: usize = 1_000;

/// Attempts at a component, each with shorter edges of the boundary than the one before.
const ATTEMPTS: i32 = 6;

/// Length of the boundary's edges in an attempt, as a multiple of their length in the attempt before.
const SHORTER: f64 = 0.85;

/// Rounds of smoothing, each with a new triangulation.
const SMOOTHINGS: usize = 2;

/// A closed chain of nodes around a component or one of its holes.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryChain {
    /// Index of the component.
    pub component: usize,
    /// Indices of the nodes, with the patch on the left: counter-clockwise around the component, clockwise around a hole.
    pub nodes: Vec<usize>,
    /// Interior angle \[rad\] between the two edges at each node.
    pub angles: Vec<f64>,
}

/// The graded triangle mesh of all components of a patch.
///
/// Angles: triangles have angles from 30° to 120°, except those with a corner of the patch that is sharper than 30°. Where no attempt
/// reaches that, the mesh is the best one found, and [`TriangleMesh::smallest_angle`] tells how good it is. Boundary: every node of it
/// lies on the exact curve s = δ, or on the edge of the window or of a body that cuts the patch there.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::{Evaluator, Patch, Window, mesh::TriangleMesh};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
/// let mesh = TriangleMesh::new(&placement, &patch, Some(0.5))?;
/// assert!(mesh.smallest_angle() >= 30f64.to_radians());
/// let mut evaluator = Evaluator::new(&placement);
/// for node in &mesh.boundary[0].nodes {
///     let point = mesh.points[*node];
///     assert!((evaluator.separation(point.x, point.y) - 0.05).abs() < 1e-14);
/// }
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleMesh {
    /// Points (ξ, η, ζ^R) \[mm\] on the rail's surface.
    pub points: Vec<Point3<f64>>,
    /// Indices of the corners of each triangle, counter-clockwise seen from +ζ, component by component.
    pub triangles: Vec<[usize; 3]>,
    /// Index of the component of each triangle.
    pub component: Vec<usize>,
    /// The chains of boundary nodes: of every component the outer one, then those around its holes.
    pub boundary: Vec<BoundaryChain>,
    /// Largest edge asked for in each component \[mm\].
    pub size: Vec<f64>,
    /// Largest distance of the exact boundary from the edges between its nodes \[mm\], for each component: at most a
    /// hundredth of the size.
    pub chord_error: Vec<f64>,
    /// Nodes made for each component in all attempts, and a thousandth of the squares of its edges: what the mesh has cost, at most 4·10⁶.
    pub made: Vec<usize>,
}

impl TriangleMesh {
    /// Makes the mesh of a patch of this placed pair. `size` \[mm\] is the length of the edges where neither the boundary's
    /// curvature nor a narrow place asks for shorter ones; if not given, it is for each component a 16th of the side of a
    /// square with its area. An empty patch gives an empty mesh.
    ///
    /// # Errors
    /// A size that is not positive, or that gives more than 10⁶ cells; a boundary that meets itself, or takes more than 40,000
    /// edges; a part of the patch as small as the rounding of its coordinates.
    pub fn new(placement: &Placement, patch: &Patch, size: Option<f64>) -> Result<Self> {
        let mut mesh = Self {
            points: Vec::new(),
            triangles: Vec::new(),
            component: Vec::new(),
            boundary: Vec::new(),
            size: Vec::new(),
            chord_error: Vec::new(),
            made: Vec::new(),
        };
        for component in &patch.components {
            let size = match size {
                Some(size) => checked(component, size)?,
                None => component.area.sqrt() / EDGES_PER_SIDE,
            };
            mesh.add(placement, component, size)?;
        }
        Ok(mesh)
    }

    /// Returns the nodes of a component at which the patch has a corner sharper than 30°, each with the angle \[rad\].
    pub fn sharp_corners(&self, component: usize) -> Vec<(usize, f64)> {
        let chains = self.boundary.iter().filter(|chain| chain.component == component);
        let corners = chains.flat_map(|chain| chain.nodes.iter().copied().zip(chain.angles.iter().copied()));
        corners.filter(|(_, angle)| *angle < FRAC_PI_6).collect()
    }

    /// Returns the smallest angle \[rad\] of all triangles without a corner of the patch that is sharper than 30°; infinite
    /// without triangles.
    pub fn smallest_angle(&self) -> f64 {
        let mut sharp = vec![false; self.points.len()];
        for (node, _) in (0..self.size.len()).flat_map(|component| self.sharp_corners(component)) {
            sharp[node] = true;
        }
        let away = self.triangles.iter().filter(|triangle| !triangle.iter().any(|&node| sharp[node]));
        away.flat_map(|&triangle| angles(triangle.map(|node| self.points[node].xy())))
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the area of the triangles of a component in the ξ–η plane \[mm²\]. It differs from that of the component by
    /// what lies between the boundary's edges and the curve.
    pub fn area(&self, component: usize) -> f64 {
        let own = self.triangles.iter().zip(&self.component).filter(|(_, own)| **own == component);
        let area = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|node| self.points[node].xy());
            (b - a).perp(&(c - a)) / 2.0
        };
        own.map(|(triangle, _)| area(triangle)).sum()
    }

    fn add(&mut self, placement: &Placement, component: &Component, size: f64) -> Result<()> {
        let mut tracer = BoundaryTracer::new(component);
        let mut rings = tracer.rings();
        if size.is_nan() || size <= 0.0 || rings.iter().any(|ring| ring.samples.len() < LEAST_SAMPLES) {
            let found = format!("a part of {:e} mm²", component.area);
            let expected = "parts above the rounding of their coordinates";
            return Err(Error::new("mesh", found, expected, "take a larger approach"));
        }
        // The ring that encloses most is the outer one.
        rings.sort_by(|a, b| b.enclosed().total_cmp(&a.enclosed()));
        let (region, chains, made) = best(&mut tracer, &rings, component.area, size)?;
        let (first, index) = (self.points.len(), self.size.len());
        let mut bodies = Evaluator::new(placement);
        let on_lower = region.points.iter().map(|p| Point3::new(p.x, p.y, bodies.lower_height(p.x, p.y)));
        self.points.extend(on_lower);
        self.component.extend(region.triangles.iter().map(|_| index));
        self.triangles.extend(region.triangles.iter().map(|triangle| triangle.map(|node| first + node)));
        let mut node = first;
        let mut chord_error = 0.0f64;
        for (ring, chain) in rings.iter().zip(&chains) {
            let angles = interior_angles(chain);
            self.boundary.push(BoundaryChain {
                component: index,
                nodes: (node..node + chain.len()).collect(),
                angles,
            });
            node += chain.len();
            for k in 0..chain.len() {
                let (here, next) = (chain[k], spacing::following(ring, chain, k));
                chord_error = chord_error.max(ring.off_chord([here.at, next.at], [here.point, next.point]));
            }
        }
        self.size.push(size);
        self.chord_error.push(chord_error);
        self.made.push(made);
        Ok(())
    }
}

/// Returns a size of triangles \[mm\] if it is positive.
///
/// # Errors
/// A size that is not positive and finite.
pub fn checked_size(size: f64) -> Result<f64> {
    if finite("mesh: size", size)? > 0.0 {
        return Ok(size);
    }
    let (expected, advice) = ("a positive length in mm", "leave it out, or give a length");
    Err(Error::new("mesh: size", size.to_string(), expected, advice))
}

fn checked(component: &Component, size: f64) -> Result<f64> {
    let size = checked_size(size)?;
    let cells = component.area / (size * size * 3f64.sqrt() / 4.0);
    if cells > MOST_CELLS {
        let expected = format!("at most {MOST_CELLS:e}");
        let found = format!("{size} mm, which makes {cells:.1e} cells");
        return Err(Error::new("mesh: size", found, expected, "take a larger size").of_kind(ErrorKind::Limit));
    }
    Ok(size)
}

/// Meshes the region inside the rings until all angles are good, with shorter and shorter edges of the boundary. If no attempt
/// succeeds, the result is the one with the largest smallest angle. The last value is what [`meshed`] has counted.
fn best(
    tracer: &mut BoundaryTracer<'_>,
    rings: &[Ring],
    area: f64,
    size: f64,
) -> Result<(MeshRegion, Vec<Vec<BoundaryNode>>, usize)> {
    let mut best: Option<(f64, MeshRegion, Vec<Vec<BoundaryNode>>)> = None;
    let mut made = 0;
    let wanted = RingSpacing::new(tracer, rings, EdgeLimits { size, chord_error: CHORD_SHARE * size });
    for attempt in 0..ATTEMPTS {
        let mut chains = wanted.nodes(tracer, SHORTER.powi(attempt))?;
        let edges = chains.iter().map(Vec::len).sum::<usize>();
        let region = meshed(tracer, rings, &mut chains, area, size, &mut made)?;
        let least = least_angle(&region, &sharp_nodes(&chains));
        if best.as_ref().is_none_or(|(before, ..)| least > *before) {
            best = Some((least, region, chains));
        }
        if least >= FRAC_PI_6 || is_beyond(made, (edges as f64 / SHORTER) as usize) {
            break;
        }
    }
    let found = best.map(|(_, region, chains)| (region, chains, made));
    found.ok_or_else(|| Error::new("mesh", "no angles", "a patch with an area", "take a larger approach"))
}

/// Returns what a round counts for its edges, besides its nodes.
fn edge_cost(edges: usize) -> usize {
    edges * edges / LONG_BOUNDARY
}

/// Returns whether another round, of so many edges, would pass [`MOST_MADE`]. It counts twice, since edges that it divides take one more.
fn is_beyond(made: usize, edges: usize) -> bool {
    made + 2 * edge_cost(edges) > MOST_MADE
}

/// Returns for every node of some chains whether their polygon has an angle below 30° there.
fn sharp_nodes(chains: &[Vec<BoundaryNode>]) -> Vec<bool> {
    chains.iter().flat_map(|chain| interior_angles(chain)).map(|angle| angle < FRAC_PI_6).collect()
}

/// Returns the smallest angle \[rad\] of all triangles that have no sharp node.
fn least_angle(region: &MeshRegion, sharp: &[bool]) -> f64 {
    let is_sharp = |node: &usize| sharp.get(*node).copied().unwrap_or(false);
    let away = region.triangles.iter().filter(|triangle| !triangle.iter().any(is_sharp));
    away.flat_map(|triangle| angles(triangle.map(|node| region.points[node]))).fold(f64::INFINITY, f64::min)
}

/// Meshes the region inside the chains. Nodes that the mesh needs on the boundary are added to the chains. `made` grows by the
/// number of nodes made, and by [`edge_cost`].
fn meshed(
    tracer: &mut BoundaryTracer<'_>,
    rings: &[Ring],
    chains: &mut [Vec<BoundaryNode>],
    area: f64,
    size: f64,
    made: &mut usize,
) -> Result<MeshRegion> {
    let largest = AREA_SHARE * size * size * 3f64.sqrt() / 4.0;
    let most = MOST_ADDED + 4.0 * area / largest;
    for round in 0..=ROUNDS {
        let Polygon { points, edges, from, tips } = Polygon::new(chains);
        let last = round == ROUNDS || is_beyond(*made, edges.len());
        let region = delaunay::refined(&points, &edges, largest, most as usize, last)?;
        *made += region.points.len() + edge_cost(edges.len());
        if region.divided.is_empty() {
            let mut region = smoothed(region, points.len(), &edges)?;
            region.triangles.extend(tips);
            return Ok(region);
        }
        let mut divided: Vec<_> =
            region.divided.into_iter().map(|(edge, shares)| (from[edge], shares)).collect();
        divided.dedup_by_key(|(node, _)| *node);
        divide(tracer, rings, chains, divided);
    }
    Err(Error::new("mesh", "a boundary without end of new nodes", "one that settles", "take another size"))
}

/// The polygon around a component without its tips.
struct Polygon {
    /// The nodes of all chains, tips included, and those that divide third sides of tips.
    points: Vec<Point2<f64>>,
    /// The edges around the polygon, in the order of the nodes of the chains from which they go.
    edges: Vec<[usize; 2]>,
    /// For each edge the node of the chains from which it goes, or the third side of a tip that it is a part of.
    from: Vec<usize>,
    /// The triangles at the tips.
    tips: Vec<[usize; 3]>,
}

impl Polygon {
    fn new(chains: &[Vec<BoundaryNode>]) -> Self {
        let points: Vec<_> = chains.iter().flatten().map(|node| node.point).collect();
        let mut polygon = Self { points, edges: Vec::new(), from: Vec::new(), tips: Vec::new() };
        let mut first = 0;
        for chain in chains {
            let n = chain.len();
            for k in (0..n).filter(|&k| chain[k].tip.is_none()) {
                let nodes = [k, k + 1, k + 2].map(|k| first + k % n);
                match chain[(k + 1) % n].tip {
                    Some(parts) => polygon.add_tip(nodes, parts),
                    None => polygon.add_edge([nodes[0], nodes[1]], nodes[0]),
                }
            }
            first += n;
        }
        polygon
    }

    fn add_edge(&mut self, edge: [usize; 2], from: usize) {
        self.edges.push(edge);
        self.from.push(from);
    }

    /// Adds the fan of triangles around a tip, whose third side has equal parts.
    fn add_tip(&mut self, [here, tip, after]: [usize; 3], parts: usize) {
        let (begin, whole) = (self.points[here], self.points[after] - self.points[here]);
        let mut last = here;
        for part in 1..=parts {
            let next = if part == parts { after } else { self.points.len() };
            if part < parts {
                self.points.push(begin + whole * (part as f64 / parts as f64));
            }
            self.add_edge([last, next], here);
            self.tips.push([last, tip, next]);
            last = next;
        }
    }
}

/// Returns the interior angles of the polygon of a chain \[rad\].
fn interior_angles(chain: &[BoundaryNode]) -> Vec<f64> {
    let n = chain.len();
    let angle = |k: usize| {
        let [before, here, after] = [k + n - 1, k, k + 1].map(|k| chain[k % n].point);
        let (on, back) = (after - here, before - here);
        on.perp(&back).atan2(on.dot(&back)).rem_euclid(TAU)
    };
    (0..n).map(angle).collect()
}

/// Adds nodes on the curve where edges of the polygon were divided, which are given by the nodes from which they go and
/// shares of their lengths. Where the third side of a tip was divided, it gets twice as many parts.
fn divide(
    tracer: &mut BoundaryTracer<'_>,
    rings: &[Ring],
    chains: &mut [Vec<BoundaryNode>],
    mut divided: Vec<(usize, Vec<f64>)>,
) {
    let mut end = chains.iter().map(Vec::len).sum::<usize>();
    for (ring, chain) in rings.iter().zip(chains).rev() {
        let n = chain.len();
        let first = end - n;
        // From the last node to the first, so that indices stay right.
        while let Some((node, shares)) = divided.pop_if(|(node, _)| *node >= first) {
            let k = node - first;
            let next = (k + 1) % chain.len();
            if let Some(parts) = &mut chain[next].tip {
                *parts *= 2;
                continue;
            }
            let at = [chain[k].at, spacing::following(ring, chain, k).at];
            let new: Vec<_> = shares.iter().map(|&share| spacing::between(tracer, ring, at, share)).collect();
            chain.splice(k + 1..k + 1, new);
        }
        end = first;
    }
}

/// Smooths the inner nodes of a region as long as its smallest angle does not become worse, or stays above 30°.
fn smoothed(mut region: MeshRegion, fixed: usize, edges: &[[usize; 2]]) -> Result<MeshRegion> {
    for _ in 0..SMOOTHINGS {
        let mut points = region.points.clone();
        smooth(&mut points, &region.triangles, fixed);
        let next = delaunay::retriangulated(&points, edges)?;
        if least_angle(&next, &[]) < least_angle(&region, &[]).min(FRAC_PI_6) {
            break;
        }
        region = next;
    }
    Ok(region)
}
