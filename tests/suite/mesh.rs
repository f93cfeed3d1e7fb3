//! Solver meshes: grids that never cut the patch, strips whose exact areas sum up, surfaces within their tolerance.

use crate::common::{approached_references, two_crowns};
use wheelrail::Interval;
use wheelrail::Result;
use wheelrail::mesh::{self, Axes, GridGroup, Quality, StripCounts, StripMesh, Surface};
use wheelrail::nalgebra::Point3;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, Segment, standards};
use wheelrail::separation::Evaluator;

/// Every reference scene at each of its approaches, plain and turned; two components; a built-in pair.
fn cases() -> Vec<(String, Placement, f64)> {
    let mut all = approached_references();
    let crowns = two_crowns(-1e-3, 0.0).expect("a placement");
    all.extend([0.02, 0.1, 0.3].map(|d| (format!("two crowns δ = {d}"), crowns.clone(), d)));
    let pair = Pair::new(
        standards::rail("60E1").expect("a rail"),
        standards::wheel("S1002").expect("a wheel"),
        460.0,
    );
    let flange = pair.and_then(|pair| pair.placed(-34.0, -33.0, 0.0)).expect("a placement");
    all.push(("60E1/S1002 at the flange root".into(), flange, 0.05));
    all
}

fn whole(placement: &Placement, delta: f64) -> Patch {
    Patch::new(placement, delta, &Window::UNBOUNDED)
}

#[test]
fn areas_of_cells_sum_up_to_the_patch() {
    for (name, placement, delta) in cases() {
        let patch = whole(&placement, delta);
        assert!(!patch.components.is_empty(), "{name}");
        for counts in [
            StripCounts::default(),
            StripCounts { strips: 5, across: 3 },
            StripCounts { strips: 2, across: 1 },
        ] {
            let mesh = StripMesh::new(&placement, &patch, counts).expect("a mesh");
            for (index, component) in patch.components.iter().enumerate() {
                let own = mesh.cells.iter().filter(|cell| cell.component == index);
                let sum: f64 = own.map(|cell| cell.area).sum();
                let error = (sum / component.area - 1.0).abs();
                assert!(error < 1e-10, "{name}, {counts:?}: cells {sum}, component {}", component.area);
            }
        }
    }
}

#[test]
fn cells_are_sound_and_share_their_sides() {
    for (name, placement, delta) in cases() {
        let patch = whole(&placement, delta);
        let mesh = StripMesh::new(&placement, &patch, StripCounts::default()).expect("a mesh");
        let quality = Quality::of_strips(&mesh).expect("cells");
        assert_eq!(quality.inverted, 0, "{name}: {quality:?}");
        assert!(mesh.cells.iter().all(|cell| cell.area > 0.0), "{name}");
        let mut directed = std::collections::HashMap::new();
        for cell in &mesh.cells {
            let v = cell.vertices();
            for k in 0..v.len() {
                *directed.entry((v[k], v[(k + 1) % v.len()])).or_insert(0usize) += 1;
            }
        }
        assert!(directed.values().all(|&n| n == 1), "{name}: a side used twice in one sense");
        let outer: Vec<_> = directed.keys().filter(|(a, b)| !directed.contains_key(&(*b, *a))).collect();
        // The outer sides of a component form one closed loop: as many sides as points.
        let points: std::collections::HashSet<_> = outer.iter().map(|(a, _)| *a).collect();
        assert_eq!(points.len(), outer.len(), "{name}");
        let used: std::collections::HashSet<_> = mesh.cells.iter().flat_map(|c| c.corners).collect();
        assert_eq!(used.len(), mesh.points.len(), "{name}: points without a cell");
        let mut evaluator = Evaluator::new(&placement);
        for &k in &points {
            let (xi, eta) = (mesh.points[k].x, mesh.points[k].y);
            // A point on the end of the surface may round off it.
            let [inner, outer] =
                [1.0 - 1e-12, 1.0 + 1e-12].map(|nudge| evaluator.separation(xi, eta * nudge));
            let s = if inner.is_nan() { outer } else { inner };
            assert!(s <= delta * (1.0 + 1e-9), "{name}: boundary point ({xi}, {eta}) has s = {s}");
        }
    }
}

#[test]
fn centroids_are_inside_and_give_the_first_moment() {
    for (name, placement, delta) in cases() {
        let patch = whole(&placement, delta);
        let [coarse, fine] = [StripCounts { strips: 6, across: 3 }, StripCounts { strips: 40, across: 20 }]
            .map(|counts| StripMesh::new(&placement, &patch, counts).expect("a mesh"));
        for cell in &coarse.cells {
            assert!(cell.separation < delta, "{name}: s = {} at the centroid", cell.separation);
        }
        for axis in 0..2 {
            let moment = |mesh: &StripMesh| {
                mesh.cells.iter().map(|c| c.area * c.centroid[axis]).sum::<f64>() / patch.area()
            };
            let size = patch.extent().map_or(1.0, |w| if axis == 0 { w.xi.width() } else { w.eta.width() });
            let difference = (moment(&coarse) - moment(&fine)).abs();
            assert!(difference < 1e-8 * size, "{name}: {axis} {difference:e} of {size}");
        }
    }
}

#[test]
fn boundary_cells_include_the_curved_edge() -> Result<()> {
    // A nearly elliptic patch: the polygon of the corners misses area, the cells do not.
    let crown = Profile::new(
        "rail",
        "test",
        vec![Segment::arc(Arc::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 30.0])?)],
    )?;
    let cylinder = Profile::new("wheel", "test", vec![Segment::arc(Arc::line([-40.0, 0.0], [40.0, 0.0])?)])?;
    let placement = Pair::new(crown, cylinder, 460.0)?.placed(0.0, 0.0, 0.0)?;
    let patch = whole(&placement, 0.05);
    let mesh = StripMesh::new(&placement, &patch, StripCounts { strips: 8, across: 4 })?;
    let polygon: f64 = mesh
        .cells
        .iter()
        .map(|cell| {
            let v = cell.vertices();
            let corner = |k: usize| mesh.points[v[k % v.len()]].coords.xy();
            (0..v.len()).map(|k| corner(k).perp(&corner(k + 1)) / 2.0).sum::<f64>()
        })
        .sum();
    assert!(polygon < 0.98 * patch.area());
    let exact = std::f64::consts::PI * 0.05 * (600f64 * 920.0).sqrt();
    let sum: f64 = mesh.cells.iter().map(|cell| cell.area).sum();
    assert!((sum / exact - 1.0).abs() < 2e-4, "{sum} {exact}");
    // Cells become small towards the boundary, and mirror images are equal.
    let area = |i: usize, j: usize| mesh.cells[4 * i + j].area;
    assert!(area(4, 0) < 0.5 * area(4, 1) && area(0, 1) < 0.3 * area(4, 1));
    assert!((area(2, 0) / area(5, 3) - 1.0).abs() < 1e-10);
    Ok(())
}

#[test]
fn windows_cut_the_mesh_too() {
    let (_, placement, delta) = cases().swap_remove(0);
    for eta in [Interval::new(-1.0, 2.0), Interval::new(0.5, 20.0)] {
        let patch = Patch::new(&placement, delta, &Window { xi: Interval::new(-4.0, 30.0), eta });
        let mesh = StripMesh::new(&placement, &patch, StripCounts::default()).expect("a mesh");
        let sum: f64 = mesh.cells.iter().map(|cell| cell.area).sum();
        assert!((sum / patch.area() - 1.0).abs() < 1e-10);
        assert_eq!(Quality::of_strips(&mesh).map(|q| q.inverted), Some(0));
        assert!(mesh.points.iter().all(|p| p[0] >= -4.0 && eta.contains(p[1])));
    }
    let empty =
        StripMesh::new(&placement, &whole(&placement, 0.0), StripCounts::default()).expect("no cells");
    assert!(empty.cells.is_empty() && Quality::of_strips(&empty).is_none());
    for counts in [
        StripCounts { strips: 1, across: 4 },
        StripCounts { strips: 4, across: 0 },
        StripCounts { strips: 1 << 20, across: 1 << 20 },
    ] {
        assert!(StripMesh::new(&placement, &whole(&placement, delta), counts).is_err());
    }
}

/// Whether the cells of the two outermost rows and columns are empty and all of the group inside.
fn covers(placement: &Placement, delta: f64, group: &GridGroup, axes: &Axes) -> bool {
    let mut evaluator = Evaluator::new(placement);
    let (xi, eta) = (&axes.xi, &axes.eta);
    let (n, m) = (xi.len(), eta.len());
    let mut empty = true;
    for (i, &x) in xi.iter().enumerate() {
        for (j, &y) in eta.iter().enumerate() {
            if i < 2 || j < 2 || i + 2 >= n || j + 2 >= m {
                let s = evaluator.separation(x, y);
                empty &= s.is_nan() || s > delta || !group.extent.xi.contains(x);
            }
        }
    }
    let (box_, window) = (&group.extent, axes.window());
    empty && window.surrounds(box_)
}

#[test]
fn grids_never_cut_the_patch() {
    for (name, placement, delta) in cases() {
        for spacing in [None, Some([0.37, 0.53])] {
            let patch = whole(&placement, delta);
            let groups = mesh::groups(&patch, 0.0, spacing);
            assert_eq!(groups.iter().map(|g| g.components.len()).sum::<usize>(), patch.components.len());
            for group in &groups {
                let axes = group.axes(spacing).expect("axes");
                assert!(covers(&placement, delta, group, &axes), "{name}: {group:?}");
                let extent = &group.extent;
                let short = extent.xi.width().min(extent.eta.width());
                assert!(spacing.is_some() || short / axes.spacing[0] >= 16.0 - 1e-9, "{name}");
                if placement.skew() == 0.0 {
                    let eta = &axes.eta;
                    assert!(eta.iter().zip(eta.iter().rev()).all(|(a, b)| *a == -*b), "{name}");
                }
            }
            let first = groups[0].axes(spacing).expect("axes");
            assert!(first.xi.contains(&0.0) && first.eta.contains(&0.0), "{name}");
        }
    }
}

#[test]
fn parts_are_merged_by_a_stated_distance_and_c_comes_first() -> Result<()> {
    let placement = two_crowns(-1e-3, 0.0)?;
    let patch = whole(&placement, 0.08);
    let apart = mesh::groups(&patch, 0.0, None);
    assert_eq!(patch.components.len(), 2);
    assert_eq!(apart.iter().map(|g| g.components.clone()).collect::<Vec<_>>(), [vec![1], vec![0]]);
    let gap = patch.components[1].xi.low - patch.components[0].xi.high;
    assert_eq!(mesh::groups(&patch, 0.99 * gap, None).len(), 2);
    let merged = mesh::groups(&patch, 1.01 * gap, None);
    assert_eq!(merged.len(), 1);
    assert_eq!(merged[0].components, [0, 1]);
    assert_eq!(Some(merged[0].extent), patch.extent());
    assert_eq!(merged[0].axes(None)?.spacing, apart[0].axes(None)?.spacing);
    assert!(mesh::groups(&whole(&placement, 0.0), 0.0, None).is_empty());
    assert!(apart[0].axes(Some([1e-4, 1e-4])).is_err());
    Ok(())
}

/// Largest distance of points between the corners of a facet from the true surface, and of the corners themselves.
fn departures(placement: &Placement, surface: &Surface) -> [f64; 2] {
    let mut evaluator = Evaluator::new(placement);
    let mut off = |point: Point3<f64>| {
        let (xi, eta, zeta) = (point.x, point.y, point.z);
        let rail = placement.rail().section().height(xi);
        match surface.side {
            wheelrail::profile::Side::Rail => zeta - rail,
            wheelrail::profile::Side::Wheel => zeta - (rail + evaluator.separation(xi, eta)),
        }
    };
    let corner = |k: usize| surface.points[k];
    let corners =
        (0..surface.points.len()).map(|k| off(corner(k)).abs()).filter(|d| !d.is_nan()).fold(0.0, f64::max);
    let mut between = 0f64;
    for [a, b, c] in surface.triangles() {
        for weights in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
            let [p, q, r] = [corner(a), corner(b), corner(c)];
            let point = weights[0] * p.coords + weights[1] * q.coords + weights[2] * r.coords;
            between = between.max(off(point.into()).abs());
        }
    }
    [corners, between]
}

#[test]
fn surfaces_keep_their_tolerance_and_hold_c() {
    let window = Window { xi: Interval::new(-3.0, 2.5), eta: Interval::new(-8.0, 9.0) };
    for (name, placement, _) in cases() {
        for tolerance in [1e-2, 1e-4] {
            for surface in [
                Surface::rail(&placement, &window, tolerance),
                Surface::wheel(&placement, &window, tolerance),
            ] {
                let surface = surface.expect("a surface");
                let side = surface.side;
                assert_eq!(surface.points.len(), surface.n[0] * surface.n[1]);
                assert!(surface.points.contains(&Point3::origin()), "{name} {side:?}");
                let [corners, between] = departures(&placement, &surface);
                assert!(corners < 1e-11, "{name} {side:?}: corners {corners:e}");
                // Along ζ, which is not quite across the surface.
                assert!(between < 1.1 * tolerance, "{name} {side:?}: {between:e} for {tolerance:e}");
                let quality = Quality::of_surface(&surface).expect("facets");
                assert_eq!(quality.inverted, 0, "{name} {side:?} {quality:?}");
            }
        }
    }
}

#[test]
fn surfaces_face_outwards_and_move_into_rail_axes() {
    let window = Window { xi: Interval::new(-3.0, 2.5), eta: Interval::new(-8.0, 9.0) };
    for (name, placement, _) in cases() {
        let rail = Surface::rail(&placement, &window, 1e-3).expect("a rail");
        let wheel = Surface::wheel(&placement, &window, 1e-3).expect("a wheel");
        for (surface, sign) in [(&rail, 1.0), (&wheel, -1.0)] {
            for [a, b, c] in surface.triangles() {
                let [p, q, r] = [a, b, c].map(|k| surface.points[k]);
                let up = (q - p).cross(&(r - p));
                assert!(sign * up.z > 0.0, "{name} {:?}", surface.side);
            }
        }
        let own = &placement.rail().point().station;
        let moved = rail.in_rail_axes(&placement);
        let profile =
            wheelrail::profile::Section::own_axes(placement.rail().profile(), wheelrail::profile::Side::Rail);
        for p in &moved.points {
            let miss = (profile.height(p[0]) - p[2]).abs();
            assert!(miss.is_nan() || miss < 1e-3, "{name}: {p:?} {miss:e}");
        }
        assert!(moved.points.iter().any(|p| p[0] == own.x && p[1] == 0.0 && p[2] == own.z), "{name}");
    }
}

#[test]
fn bad_requests_for_surfaces_are_refused() {
    let placement = two_crowns(-1e-3, 0.0).expect("a placement");
    let good = Window { xi: Interval::symmetric(3.0), eta: Interval::symmetric(3.0) };
    for (window, tolerance) in [
        (Window::UNBOUNDED, 1e-3),
        (Window { eta: Interval::symmetric(500.0), ..good }, 1e-3),
        (Window { xi: Interval::new(3.0, -3.0), ..good }, 1e-3),
        (good, 0.0),
        (good, f64::NAN),
        (good, 1e-18),
    ] {
        assert!(Surface::rail(&placement, &window, tolerance).is_err(), "{window:?} {tolerance}");
        assert!(Surface::wheel(&placement, &window, tolerance).is_err(), "{window:?} {tolerance}");
    }
}
