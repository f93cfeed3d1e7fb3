//! The triangle mesh of a patch: angles, boundary nodes on the exact curve, areas, topology, and the same bits in every run.

use std::collections::{HashMap, HashSet};
use std::f64::consts::FRAC_PI_6;
use std::path::Path;

use crate::campaign;
use crate::common::{approached_references, profile, repository, two_crowns};
use crate::in_time::InTime;
use wheelrail::Interval;
use wheelrail::case::{Run, SILENT, contacts};
use wheelrail::internal::Random;
use wheelrail::mesh::TriangleMesh;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, inclination, standards};
use wheelrail::scene;
use wheelrail::separation::Evaluator;

/// Largest |s − δ| at a node of the boundary \[mm\]: the bound of s, and of δ's own rounding.
const ON_BOUNDARY: f64 = 4e-12;

/// What a mesh is made of.
struct Meshed {
    triangles: usize,
    /// Nodes of the boundary that lie on s = δ.
    level: usize,
    sharp: usize,
}

/// Checks everything that is promised of the mesh of a patch.
fn check(name: &str, placement: &Placement, patch: &Patch, size: Option<f64>) -> Meshed {
    let mesh = TriangleMesh::new(placement, patch, size).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(mesh, TriangleMesh::new(placement, patch, size).expect("a mesh"), "{name}: other bits");
    check_angles(name, &mesh);
    check_topology(name, &mesh, patch);
    check_areas(name, &mesh, patch);
    let level = check_boundary(name, placement, &mesh, patch);
    let angles = mesh.boundary.iter().flat_map(|chain| &chain.angles);
    let sharp = angles.filter(|angle| **angle < FRAC_PI_6).count();
    Meshed { triangles: mesh.triangles.len(), level, sharp }
}

fn check_angles(name: &str, mesh: &TriangleMesh) {
    let sharp: HashSet<usize> = mesh
        .boundary
        .iter()
        .flat_map(|chain| chain.nodes.iter().zip(&chain.angles))
        .filter(|(_, angle)| **angle < FRAC_PI_6)
        .map(|(node, _)| *node)
        .collect();
    // Smooth boundaries turn by small angles only: what is sharp is a corner.
    assert!(sharp.len() <= 4 * mesh.size.len(), "{name}: {} sharp corners", sharp.len());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|node| mesh.points[node].xy());
        for [here, on, back] in [[a, b, c], [b, c, a], [c, a, b]] {
            let (on, back) = (on - here, back - here);
            let angle = on.perp(&back).atan2(on.dot(&back));
            assert!(angle > 0.0, "{name}: a triangle is not counter-clockwise");
            let corner = triangle.iter().any(|node| sharp.contains(node));
            let good = (FRAC_PI_6..=4.0 * FRAC_PI_6).contains(&angle);
            assert!(good || corner, "{name}: {:.3}° at {here:?}", angle.to_degrees());
        }
    }
}

fn check_topology(name: &str, mesh: &TriangleMesh, patch: &Patch) {
    let mut sides: HashMap<[usize; 2], i32> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for side in [[a, b], [b, c], [c, a]] {
            assert!(sides.insert(side, 1).is_none(), "{name}: a side used twice in one sense");
        }
    }
    let outer: HashSet<[usize; 2]> =
        sides.keys().filter(|[a, b]| !sides.contains_key(&[*b, *a])).copied().collect();
    let chained: HashSet<[usize; 2]> = mesh
        .boundary
        .iter()
        .flat_map(|chain| {
            (0..chain.nodes.len()).map(|k| [chain.nodes[k], chain.nodes[(k + 1) % chain.nodes.len()]])
        })
        .collect();
    assert_eq!(outer, chained, "{name}: the chains are the boundary of the triangles");
    let used: HashSet<usize> = mesh.triangles.iter().flatten().copied().collect();
    assert_eq!(used.len(), mesh.points.len(), "{name}: points without a triangle");
    let edges = (sides.len() + outer.len()) / 2;
    let euler = mesh.points.len() as i64 - edges as i64 + mesh.triangles.len() as i64;
    let expected: i64 = patch.components.iter().map(|component| 1 - component.holes.len() as i64).sum();
    assert_eq!(euler, expected, "{name}: V − E + F");
    let rings: usize = patch.components.iter().map(|component| 1 + component.holes.len()).sum();
    assert_eq!(mesh.boundary.len(), rings, "{name}");
}

/// The mesh's area differs from the exact one by what lies between chords and curve, at most ⅔ of the chord error along
/// the perimeter where the curve bends, and all of it beside a corner that is no node.
fn check_areas(name: &str, mesh: &TriangleMesh, patch: &Patch) {
    for (k, component) in patch.components.iter().enumerate() {
        let bound = mesh.chord_error[k] * component.perimeter + 1e-11 * component.area;
        let off = (mesh.area(k) - component.area).abs();
        assert!(off <= bound, "{name}: off by {off} mm², {bound} allowed");
        assert!(
            mesh.chord_error[k] <= 0.0101 * mesh.size[k],
            "{name}: {} of {}",
            mesh.chord_error[k],
            mesh.size[k]
        );
    }
}

/// Returns how many nodes lie on s = δ. The others lie on an edge of the window, or where a body ends or steps.
fn check_boundary(name: &str, placement: &Placement, mesh: &TriangleMesh, patch: &Patch) -> usize {
    let (mut evaluator, mut level) = (Evaluator::new(placement), 0);
    for &node in mesh.boundary.iter().flat_map(|chain| &chain.nodes) {
        let (xi, eta) = (mesh.points[node].x, mesh.points[node].y);
        let at_window = patch.window.xi.ends().contains(&xi) || patch.window.eta.ends().contains(&eta);
        let off = evaluator.separation(xi, eta) - patch.approach;
        if off.abs() <= ON_BOUNDARY {
            level += 1;
            continue;
        }
        // The surface ends or steps here: s jumps within a nanometre.
        let near = 1e-6;
        let beside = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
        let ends = beside.iter().any(|[x, y]| {
            let there = evaluator.separation(xi + near * x, eta + near * y) - patch.approach;
            there.is_nan() || (there - off).abs() > 100.0 * near
        });
        assert!(at_window || ends || off.is_nan(), "{name}: s − δ = {off:e} at ({xi}, {eta})");
    }
    level
}

fn whole(placement: &Placement, delta: f64) -> Patch {
    Patch::new(placement, delta, &Window::UNBOUNDED)
}

#[test]
fn meshes_of_references_keep_every_promise() {
    for (name, placement, delta) in approached_references() {
        let meshed = check(&name, &placement, &whole(&placement, delta), None);
        assert!(meshed.triangles > 200 && meshed.level > 20, "{name}: {}", meshed.triangles);
    }
}

#[test]
fn meshes_of_example_scenes_keep_every_promise() {
    let mut parts = 0;
    let scenes = repository("examples/scenes");
    let mut files: Vec<_> =
        std::fs::read_dir(scenes).expect("the scenes").map(|file| file.expect("a file").path()).collect();
    files.sort();
    for file in files.iter().filter(|file| file.extension().is_some_and(|end| end == "toml")) {
        let text = std::fs::read_to_string(file).expect("a scene");
        let scene = scene::parse(&text, false).expect("a scene");
        let case =
            scene::resolve(&scene, file.parent().unwrap_or(Path::new(".")), "example").expect("a case");
        for part in Run::new(case, SILENT).expect("a run").parts {
            let Some(patch) = part.site.contact.whole_patch() else { continue };
            check(
                &format!("{} {}", file.display(), part.site.name()),
                &part.site.contact.placement,
                patch,
                None,
            );
            parts += 1;
        }
    }
    assert!(parts >= 5, "{parts} parts");
}

/// A random chain of lines and parabolas over \[−half, half\] without steps, as a scene has it.
fn chain(random: &mut Random, half: f64, steepest: f64) -> String {
    let mut x: Vec<f64> = (0..2 + random.below(5)).map(|_| random.between(-half, half)).collect();
    x.extend([-half, half]);
    x.sort_by(f64::total_cmp);
    let mut z = 0.0;
    let segments = x.windows(2).filter(|ends| ends[1] - ends[0] > 0.1).map(|ends| {
        let ([x0, x1], m) = ([ends[0], ends[1]], random.between(-steepest, steepest));
        let a = *random.pick(&[0.0, 1.0]) * random.between(-1.0, 1.0) * steepest / (x1 - x0);
        let from = z;
        z += m * (x1 - x0);
        // The line and a (x − x0) (x − x1).
        let coefficients = [from - m * x0 + a * x0 * x1, m - a * (x0 + x1), a];
        format!("{{ polynomial = {{ x = [{x0:?}, {x1:?}], coefficients = {coefficients:?} }} }}")
    });
    segments.collect::<Vec<_>>().join(", ")
}

/// The patch ends in a point where the wheel's end leaves it, a rounding beside a corner of its boundary.
#[test]
fn a_corner_a_rounding_beside_a_tip_crosses_no_edges() {
    let text = "[rail]\nsegments = [\
        { line = { from = [4.3842030807824806, -6.16741156756034], to = [20.072037264548143, -2.08035042966919] } },\
        { arc = { center = [9.761431111119986, -169.84178907621737], radius = 168.0779845667203, half = \"upper\", \
        x = [20.072037264548143, 35.80773760717342] } }]\n[wheel]\nradius = 534.9\nsegments = [\
        { line = { from = [3.502664830427779, -2.394717943731659], to = [19.996807854279165, -6.662337787733948] } },\
        { polynomial = { x = [19.996807854279165, 30.486366749978174], coefficients = \
        [-3.1420030530202046, 0.1400247301748465, -0.022629878622180667, 0.00034124834681330827] } }]\n\
        [contact]\noffset = -4.398\nyaw = -0.0589143622294339\n";
    let scene = scene::parse(text, false).expect("a scene");
    let case = scene::resolve(&scene, Path::new("."), "sliver").expect("a case");
    let (_, placement) = &contacts(&case).expect("a contact")[0];
    let patch = whole(placement, 0.04119795942022962);
    let area = patch.area();
    for size in [1.0, 0.1, 0.02] {
        let mesh = TriangleMesh::new(placement, &patch, Some(size)).expect("a mesh");
        assert!((mesh.area(0) / area - 1.0).abs() < 1e-3, "{size}: {} of {area}", mesh.area(0));
    }
}

/// Steep ridges that press on a crown under much yaw: parts 30 mm long and some micrometres to tenths of a millimetre wide, across the axes.
#[test]
fn meshes_of_slivers_are_bounded() {
    let (mut random, mut meshes, mut most) = (Random::new(65), 0, 0);
    // They are large: a quarter as many as of other kinds.
    let scenes = campaign::scenes().div_ceil(4);
    for number in 0..scenes {
        let (slope, yaw) = (10f64.powf(random.between(0.3, 2.0)), random.between(-0.3, 0.3));
        let delta = 10f64.powf(random.between(-2.0, -0.3));
        let up = 3.0 * slope;
        let text = format!(
            "[rail]\nsegments = [{{ arc = {{ center = [0, -3000], radius = 3000, half = \"upper\", x = [-65, 65] }} }}]\n\
             [wheel]\nradius = 460\nsegments = [{{ line = {{ from = [-3, {up:?}], to = [0, 0] }} }}, \
             {{ line = {{ from = [0, 0], to = [3, {up:?}] }} }}]\n[contact]\noffset = 0\nyaw = {yaw:?}\n"
        );
        let case = scene::resolve(&scene::parse(&text, false).expect("a scene"), Path::new("."), "ridge");
        let (_, placement) = contacts(&case.expect("a case")).expect("contacts").swap_remove(0);
        let patch = whole(&placement, delta);
        let name = format!("sliver {number}: slope {slope}, yaw {yaw}, δ = {delta}");
        match TriangleMesh::new(&placement, &patch, None) {
            Ok(mesh) => {
                assert!(mesh.points.len() < 200_000, "{name}: {} points", mesh.points.len());
                let made = mesh.made.iter().sum::<usize>();
                assert!(made <= 4_000_000, "{name}: {made} nodes made");
                most = most.max(made);
                assert!((mesh.area(0) / patch.area() - 1.0).abs() < 0.01, "{name}: {}", mesh.area(0));
                meshes += 1;
            }
            Err(error) => assert!(error.place == "mesh" && !error.advice.is_empty(), "{name}: {error}"),
        }
    }
    println!("{meshes} meshes of {scenes} slivers, at most {most} nodes made");
    assert!(2 * meshes > scenes, "{meshes} meshes");
}

/// Patches with cusps at the ends of profiles, thin parts and several parts: random chains, under windows that cut.
#[test]
fn random_chains_keep_their_angles() {
    let mut random = Random::new(9);
    let (mut meshes, mut sharp, mut refused) = (0, 0, 0);
    for number in 0..campaign::scenes() {
        let _in_time = InTime::begin();
        let steepest = 10f64.powf(random.between(-2.0, 0.2));
        let text = format!(
            "[rail]\nsegments = [{}]\n[wheel]\nsegments = [{}]\nradius = {:?}\n[contact]\noffset = {:?}\nyaw = {:?}\n",
            chain(&mut random, 30.0, steepest),
            chain(&mut random, 45.0, steepest),
            random.between(200.0, 600.0),
            random.between(-10.0, 10.0),
            *random.pick(&[0.0, 0.0, 0.01, -0.06]),
        );
        let case =
            scene::parse(&text, false).and_then(|scene| scene::resolve(&scene, Path::new("."), "chain"));
        // Profiles whose pieces fold over, and wheels beside their rails, are none.
        let Ok(found) = case.and_then(|case| contacts(&case)) else { continue };
        let delta = 10f64.powf(random.between(-3.0, 0.6));
        let width = 10f64.powf(random.between(-3.0, 1.0));
        let from = -width * random.uniform();
        let narrow = Window { xi: Interval::new(from, from + width), ..Window::UNBOUNDED };
        let window = *random.pick(&[Window::UNBOUNDED, narrow]);
        for (_, placement) in found.iter().take(1) {
            let patch = Patch::new(placement, delta, &window);
            match TriangleMesh::new(placement, &patch, None) {
                Ok(mesh) => {
                    let name = format!("scene {number}, δ = {delta}, {window:?}\n{text}");
                    check_angles(&name, &mesh);
                    meshes += usize::from(!mesh.triangles.is_empty());
                    sharp += (0..mesh.size.len()).map(|k| mesh.sharp_corners(k).len()).sum::<usize>();
                }
                // Too narrow, or as small as rounding.
                Err(error) => {
                    assert!(error.place == "mesh" && !error.advice.is_empty(), "{number}: {error}\n{text}");
                    refused += 1;
                }
            }
        }
    }
    println!("{meshes} meshes, {sharp} sharp corners, {refused} refused");
    assert!(meshes >= 8 && refused * 3 < meshes, "{meshes} meshes, {refused} refused");
}

#[test]
fn a_cusp_at_a_profile_s_end_has_few_triangles() {
    let text = std::fs::read_to_string(repository("tests/defects/mesh-angle-cusp.json")).expect("a scene");
    let scene = scene::parse(&text, true).expect("a scene");
    let case = scene::resolve(&scene, Path::new("."), "cusp").expect("a case");
    let (_, placement) = contacts(&case).expect("contacts").swap_remove(0);
    let patch = whole(&placement, 3.713_119_220_922_863);
    let mesh = TriangleMesh::new(&placement, &patch, None).expect("a mesh");
    check_angles("cusp", &mesh);
    let sharpest = mesh.sharp_corners(0).into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("a cusp");
    assert!(sharpest.1 < 0.02, "{sharpest:?}");
    let at_cusp = mesh.triangles.iter().filter(|triangle| triangle.contains(&sharpest.0)).count();
    assert!(at_cusp <= 8, "{at_cusp} triangles at the cusp");
}

/// Long patches of crowns in hollow wheels, cut by the window almost along their boundary, and next to their tips: corners of
/// minutes of arc between a straight edge and the curve.
#[test]
fn windows_that_cut_at_sharp_corners_keep_the_angles() {
    let mut random = Random::new(31);
    let (mut sharp, mut sharpest, mut refused) = (0, f64::INFINITY, 0);
    for number in 0..campaign::scenes() {
        let _in_time = InTime::begin();
        let crown = |radius: f64, reach: f64| {
            profile(Arc::about([0.0, -radius], radius, Half::Upper, [-reach, reach]).expect("an arc"))
                .expect("a profile")
        };
        let (radius, hollow) = (random.between(60.0, 300.0), 10f64.powf(random.between(-4.0, -0.5)));
        let wheel = crown(radius * (1.0 + hollow), 50.0);
        let yaw = *random.pick(&[0.0, 0.0, 0.01]);
        let pair = Pair::new(crown(radius, 45.0), wheel, random.between(200.0, 600.0)).expect("a pair");
        let placement = pair.placed(0.0, 0.0, yaw).expect("a placement");
        let delta = 10f64.powf(random.between(-4.0, -0.5));
        let patch = whole(&placement, delta);
        let [b, h] = [patch.components[0].xi.high, patch.components[0].eta.high];
        let mut near_end = || 1.0 - 10f64.powf(random.between(-4.0, 0.3));
        let (along, across) =
            (Interval::new(near_end() * b, 2.0 * b), Interval::new(near_end() * h, 2.0 * h));
        let wide = Interval::symmetric(2.0 * b);
        let window = *random.pick(&[
            Window { xi: wide, eta: across },
            Window { xi: wide, eta: across },
            Window { xi: along, eta: Interval::symmetric(2.0 * h) },
            Window { xi: along, eta: across },
        ]);
        let cut = Patch::new(&placement, delta, &window);
        let name = format!("scene {number}: {radius} in 1 + {hollow}, yaw {yaw}, δ {delta}, {window:?}");
        let mesh = match TriangleMesh::new(&placement, &cut, None) {
            Ok(mesh) => mesh,
            // A strip of a micrometre along the whole patch.
            Err(error) => {
                assert!(error.to_string().contains("so narrow"), "{name}: {error}");
                refused += 1;
                continue;
            }
        };
        check_angles(&name, &mesh);
        for (_, angle) in (0..mesh.size.len()).flat_map(|k| mesh.sharp_corners(k)) {
            sharp += 1;
            sharpest = sharpest.min(angle);
        }
    }
    println!(
        "{sharp} sharp corners, the sharpest of {:.4} degrees, {refused} refused",
        sharpest.to_degrees()
    );
    assert!(20 * refused <= campaign::scenes(), "{refused} refused");
    assert!(sharp >= 8 && sharpest < 0.02, "{sharp} sharp corners, the sharpest of {sharpest} rad");
}

/// A part that the window cuts a nanometre beyond C takes a billion edges: it is refused before they are made.
#[test]
fn a_part_too_narrow_for_a_mesh_is_refused() {
    let placement = two_crowns(0.0, 0.0).expect("a pair");
    for width in [1e-5, 1e-7, 1e-9, 1e-12] {
        let window = Window { xi: Interval::new(-5.0, width), eta: Interval::symmetric(5.0) };
        let wide = Patch::new(&placement, 0.05, &window);
        assert!(TriangleMesh::new(&placement, &wide, None).is_ok(), "{width}");
        let narrow = Patch::new(&placement, 0.05, &Window { xi: Interval::new(0.0, width), ..window });
        let Err(error) = TriangleMesh::new(&placement, &narrow, None) else { panic!("{width}: a mesh") };
        assert!(error.to_string().contains("narrow") || error.to_string().contains("rounding"), "{error}");
    }
}

#[test]
fn random_pairs_keep_every_promise() {
    let mut random = Random::new(22);
    let (mut pairs, mut cut, mut sharp, mut several) = (0, 0, 0, 0);
    while pairs < 100 {
        let rail = standards::rail(random.pick::<&str>(&["60E1", "56E1", "49E1"])).expect("a rail");
        let rail = rail.rotated(inclination(1.0, *random.pick(&[20.0, 40.0])).expect("an inclination"));
        let wheel =
            standards::wheel(random.pick::<&str>(&["S1002", "EN15302-A", "APTA-120"])).expect("a wheel");
        let pair = Pair::new(rail, wheel, random.between(200.0, 1200.0)).expect("a pair");
        let yaw = *random.pick(&[0.0, 0.0, 0.01, -0.04, 0.1]);
        let (rail_x, wheel_x) = (random.between(-35.0, 25.0), random.between(-40.0, 25.0));
        let Ok(placement) = pair.placed(rail_x, wheel_x, yaw) else { continue };
        let delta = 10f64.powf(random.between(-6.0, 0.0));
        let from = random.between(-5.0, 5.0);
        let window = Window {
            xi: Interval::new(from, from + random.between(0.1, 8.0)),
            eta: Interval::new(random.between(-6.0, -0.1), random.between(0.1, 6.0)),
        };
        let window = if random.uniform() < 0.4 { window } else { Window::UNBOUNDED };
        let patch = Patch::new(&placement, delta, &window);
        if patch.components.is_empty() {
            continue;
        }
        let name = format!("pair {pairs}: {rail_x} on {wheel_x}, yaw {yaw}, δ {delta}, {window:?}");
        sharp += check(&name, &placement, &patch, None).sharp;
        cut += usize::from(patch.cut_by_window());
        several += usize::from(patch.components.len() > 1);
        pairs += 1;
    }
    assert!(cut > 10 && sharp > 2 && several > 2, "{cut} cut, {sharp} sharp corners, {several} with parts");
}

#[test]
fn tiny_narrow_and_cut_patches_keep_every_promise() {
    let crown = |radius: f64, reach: f64| {
        profile(Arc::about([0.0, -radius], radius, Half::Upper, [-reach, reach]).expect("an arc"))
            .expect("a profile")
    };
    let line = || profile(Arc::line([-60.0, 0.0], [60.0, 0.0]).expect("a line")).expect("a profile");
    let placed = |rail, wheel| Pair::new(rail, wheel, 460.0).and_then(|pair| pair.placed(0.0, 0.0, 0.0));
    let round = placed(crown(300.0, 30.0), line()).expect("a placement");
    // 1e-6 mm, and everything up to 40 mm across.
    for delta in [1e-15, 1e-9, 1e-3, 0.05, 1.0] {
        check(&format!("crown, δ = {delta}"), &round, &whole(&round, delta), None);
    }
    for narrow in [placed(crown(300.0, 30.0), crown(300.01, 40.0)), placed(crown(1.0, 0.9), line())] {
        let narrow = narrow.expect("a placement");
        for delta in [1e-9, 3e-6, 1e-3] {
            check(&format!("narrow, δ = {delta}"), &narrow, &whole(&narrow, delta), None);
        }
    }
    let patch = whole(&round, 0.05);
    let [b, h] = [patch.components[0].xi.high, patch.components[0].eta.high];
    for (xi, eta) in [
        ([0.97 * b, 2.0 * b], [-2.0 * h, 2.0 * h]),
        ([-2.0 * b, 2.0 * b], [0.999 * h, 2.0 * h]),
        ([-0.1, 0.1], [-0.1, 0.1]),
        ([-2.0 * b, 2.0 * b], [-0.001, 0.001]),
        ([-0.3 * b, 2.0 * b], [-0.2 * h, 0.9 * h]),
    ] {
        let window = Window { xi: Interval::from(xi), eta: Interval::from(eta) };
        let cut = Patch::new(&round, 0.05, &window);
        check(&format!("cut by {window:?}"), &round, &cut, None);
        check(&format!("cut by {window:?}, coarse"), &round, &cut, Some(20.0));
    }
    assert!(TriangleMesh::new(&round, &whole(&round, 0.0), None).expect("no cells").triangles.is_empty());
}

#[test]
fn parts_and_holes_are_meshed_by_themselves() {
    let crowns = two_crowns(-1e-3, 0.0).expect("a placement");
    for delta in [0.02, 0.1, 0.3] {
        check(&format!("two crowns, δ = {delta}"), &crowns, &whole(&crowns, delta), None);
    }
    let mut holes = 0;
    for skew in [0.05, 0.1, 0.2, 0.3] {
        for delta in [0.1, 0.16, 0.17, 0.2, 0.3, 0.5, 1.0] {
            let crowns = two_crowns(-1e-3, skew).expect("a placement");
            let patch = whole(&crowns, delta);
            holes += patch.components.iter().map(|component| component.holes.len()).sum::<usize>();
            check(&format!("two crowns, skew {skew}, δ = {delta}"), &crowns, &patch, None);
        }
    }
    println!("{holes} holes");
}

#[test]
fn sizes_are_kept_and_bad_ones_refused() {
    let crowns = two_crowns(0.0, 0.0).expect("a placement");
    let patch = whole(&crowns, 0.05);
    let mut before = 0;
    for size in [2.0, 1.0, 0.5, 0.25] {
        let cells = check(&format!("size {size}"), &crowns, &patch, Some(size)).triangles;
        assert!(cells > before, "{cells} after {before}");
        before = cells;
    }
    // A quarter of the size makes about 16 times the cells.
    let area = patch.area() / (0.25 * 0.25 * 3f64.sqrt() / 4.0);
    assert!((before as f64 / area - 1.0).abs() < 0.5, "{before} cells, {area} equilateral ones");
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-5] {
        assert!(TriangleMesh::new(&crowns, &patch, Some(size)).is_err(), "{size}");
    }
}

#[test]
fn a_scene_gives_the_size() {
    let case = |size: f64| {
        let text = format!(
            "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
             [contact]\noffset = 0.0\n[mesh]\nsize = {size:?}\n"
        );
        scene::resolve(&scene::parse(&text, false)?, Path::new("."), "sized")
    };
    assert!(case(0.5).is_ok());
    for size in [0.0, -1.0, f64::INFINITY] {
        let Err(error) = case(size) else { panic!("{size} cannot be meant") };
        assert_eq!(error.place, "mesh: size", "{error}");
    }
}
