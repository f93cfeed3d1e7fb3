//! Refines constrained Delaunay triangulations with the crate `spade`.

use nalgebra::Point2;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, InsertionError, RefinementParameters, Triangulation,
};

use crate::error::{Error, ErrorKind, Result};

type Delaunay = ConstrainedDelaunayTriangulation<spade::Point2<f64>>;
type DirectedEdge<'a> =
    spade::handles::DirectedEdgeHandle<'a, spade::Point2<f64>, (), spade::CdtEdge<()>, ()>;

/// Smallest angle \[degrees\] asked of the refinement.
const ANGLE: f64 = 30.5;

/// Points and triangles of a region.
#[derive(Debug, Clone)]
pub(super) struct MeshRegion {
    /// Points (ξ, η) \[mm\]: those given, then the new ones.
    pub(super) points: Vec<Point2<f64>>,
    /// Corners of the triangles, counter-clockwise.
    pub(super) triangles: Vec<[usize; 3]>,
    /// The given edges that were divided: index of the edge, and ascending shares of its length.
    pub(super) divided: Vec<(usize, Vec<f64>)>,
}

/// Triangulates the region bounded by closed chains of edges. Points are added inside it until no triangle is larger than
/// `largest_area` \[mm²\] or has an angle below [`ANGLE`]. Edges are divided where that needs it, unless `keep` is set.
///
/// # Errors
/// Edges that cross; more than `most_points` added points.
pub(super) fn refined(
    points: &[Point2<f64>],
    edges: &[[usize; 2]],
    largest_area: f64,
    most_points: usize,
    keep: bool,
) -> Result<MeshRegion> {
    let mut delaunay = triangulated(points, edges)?;
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(ANGLE))
        .with_max_allowed_area(largest_area)
        .with_max_additional_vertices(most_points);
    let result = delaunay.refine(if keep { parameters.keep_constraint_edges() } else { parameters });
    let mut region = inside(&delaunay);
    if !result.refinement_complete {
        let expected = format!("at most {most_points}");
        return Err(
            Error::new("mesh", "too many points", expected, "ask for larger cells").of_kind(ErrorKind::Limit)
        );
    }
    region.divided = divided(&delaunay, &region.points, points.len(), edges);
    Ok(region)
}

/// Triangulates points of a region bounded by closed chains of edges.
///
/// # Errors
/// Edges that cross.
pub(super) fn retriangulated(points: &[Point2<f64>], edges: &[[usize; 2]]) -> Result<MeshRegion> {
    Ok(inside(&triangulated(points, edges)?))
}

fn triangulated(points: &[Point2<f64>], edges: &[[usize; 2]]) -> Result<Delaunay> {
    let vertices = points.iter().map(|point| spade::Point2::new(point.x, point.y)).collect();
    let mut conflicts = 0usize;
    let delaunay =
        Delaunay::try_bulk_load_cdt(vertices, edges.to_vec(), |_| conflicts += 1).map_err(refused)?;
    if conflicts > 0 || delaunay.num_vertices() != points.len() {
        let found = format!("{conflicts} edges of its boundary that cross others");
        let advice = "take a finer size, or another window";
        return Err(Error::new("mesh", found, "a patch whose boundary meets itself nowhere", advice));
    }
    Ok(delaunay)
}

fn refused(error: InsertionError) -> Error {
    Error::new("mesh", error.to_string(), "coordinates that spade takes", "take other units")
}

/// Returns all points, and the triangles inside an odd number of closed chains.
fn inside(delaunay: &Delaunay) -> MeshRegion {
    let points = delaunay.vertices().map(|vertex| vertex.position());
    let points = points.map(|point| Point2::new(point.x, point.y)).collect();
    // 0: not reached yet, 1: outside, 2: inside.
    let mut sides = vec![0u8; delaunay.num_all_faces()];
    let mut reached = vec![delaunay.outer_face().fix()];
    sides[reached[0].index()] = 1;
    let mut begin = 0;
    while let Some(&face) = reached.get(begin) {
        begin += 1;
        let side = sides[face.index()];
        let mut cross = |edge: DirectedEdge<'_>| {
            let next = if edge.face().fix() == face { edge.rev().face().fix() } else { edge.face().fix() };
            if sides[next.index()] == 0 {
                sides[next.index()] = if edge.is_constraint_edge() { 3 - side } else { side };
                reached.push(next);
            }
        };
        match delaunay.face(face).as_inner() {
            Some(inner) => inner.adjacent_edges().into_iter().for_each(&mut cross),
            None => delaunay.convex_hull().for_each(&mut cross),
        }
    }
    let inner = delaunay.inner_faces().filter(|face| sides[face.fix().index()] == 2);
    let triangles = inner.map(|face| face.vertices().map(|vertex| vertex.fix().index())).collect();
    MeshRegion { points, triangles, divided: Vec::new() }
}

/// Returns which of the edges were divided, and where.
fn divided(
    delaunay: &Delaunay,
    points: &[Point2<f64>],
    first_new: usize,
    edges: &[[usize; 2]],
) -> Vec<(usize, Vec<f64>)> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for edge in delaunay.undirected_edges().filter(|edge| edge.is_constraint_edge()) {
        let [a, b] = edge.vertices().map(|vertex| vertex.fix().index());
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    let mut all = Vec::new();
    for (k, &[from, to]) in edges.iter().enumerate() {
        let (begin, whole) = (points[from], points[to] - points[from]);
        let share = |node: usize| (points[node] - begin).dot(&whole) / whole.norm_squared();
        // A new node on a divided edge has two neighbours on it. Of a corner's two chains, the one on this edge ends at `to`.
        for &start in neighbours[from].iter().filter(|node| **node >= first_new) {
            let (mut before, mut here, mut shares) = (from, start, Vec::new());
            while here >= first_new {
                shares.push(share(here));
                let Some(&next) = neighbours[here].iter().find(|node| **node != before) else { break };
                (before, here) = (here, next);
            }
            if here == to {
                all.push((k, shares));
                break;
            }
        }
    }
    all
}
