//! Our files, read and solved by the programs that they are for: `tests/clients/setup.sh` installs those,
//! pinned, and the scripts beside it print one line per check.

use crate::programs::{check, check_all, folder};
use std::path::Path;
use wheelrail::Interval;
use wheelrail::case::RUN_FOLDER;
use wheelrail::export::{
    ContactSettings, Deck, Frame, GridFields, Header, Loop, NetCdf, Nodes, PatchPicture, PatchRow,
    PicturedContact, Prescribed, QuadMesh, VIEW_SCRIPT, array_npy, boundary_csv, boundary_vtp,
    collection_pvd, conform_wrp, contact_inp, countact_wrp, interpen_csv, rail_vts, separation_vtk,
    separation_vts, separation_wrp, strips_vtu, wheel_vts,
};
use wheelrail::files::Folder;
use wheelrail::nalgebra::{Isometry2, Point3, Translation2, UnitComplex, Vector2};

/// Hertz: a wheel of 460 mm on a rail of 300 mm, 80 kN, E* of steel; closed form with elliptic integrals.
const RADII: [f64; 2] = [300.0, 460.0];
const MODULUS: &str = "113932";
const LOAD: f64 = 80_000.0;
const PEAK: &str = "1139.19";
const APPROACH: f64 = 0.0904879;

/// A scene in closed form.
struct Scene {
    separation: fn(f64, f64) -> f64,
    /// Approach δ \[mm\]; 0 gives an empty patch.
    approach: f64,
    n: [usize; 2],
}

fn hertz(xi: f64, eta: f64) -> f64 {
    xi * xi / (2.0 * RADII[0]) + eta * eta / (2.0 * RADII[1])
}

/// The same with a stiffer and a softer side, and a corner in which a body ends.
fn lopsided(xi: f64, eta: f64) -> f64 {
    if xi > 5.0 && eta > 6.0 {
        return f64::NAN;
    }
    hertz(xi, eta) * (1.0 + 0.04 * xi) + 2e-6 * xi.powi(4)
}

impl Scene {
    /// Cell centres over the box of {s < δ} plus two cells on each side.
    fn axes(&self) -> [Vec<f64>; 2] {
        let delta = if self.approach > 0.0 { self.approach } else { APPROACH };
        [0, 1].map(|k| {
            let half = (2.0 * RADII[k] * delta).sqrt();
            let step = 2.0 * half / (self.n[k] - 4) as f64;
            let first = -0.5 * (self.n[k] - 1) as f64 * step;
            (0..self.n[k]).map(|i| first + i as f64 * step).collect()
        })
    }

    /// The boundary of the paraboloid {s < δ}.
    fn loops(&self) -> Vec<Loop> {
        let half = RADII.map(|radius| (2.0 * radius * self.approach).sqrt());
        let point = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / 180.0;
            let xi = half[0] * angle.cos();
            Point3::new(xi, half[1] * angle.sin(), rail_height(xi))
        };
        let points = (0..180).map(point).collect();
        if self.approach > 0.0 { vec![Loop { component: 0, points }] } else { Vec::new() }
    }

    /// Strips of four cells across ξ between the boundary's branches, closed at the tips.
    fn mesh(&self) -> QuadMesh {
        let mut mesh = QuadMesh::default();
        let half = RADII.map(|radius| (2.0 * radius * self.approach).sqrt());
        if self.approach <= 0.0 {
            return mesh;
        }
        for i in 0..=32u32 {
            let xi = -half[0] * (f64::from(i) * std::f64::consts::PI / 32.0).cos();
            let edge = half[1] * (1.0 - (xi / half[0]).powi(2)).max(0.0).sqrt();
            mesh.points.extend((-2..=2).map(|j| Point3::new(xi, edge * f64::from(j) / 2.0, rail_height(xi))));
        }
        for i in 0..32 {
            for j in 0..4 {
                let node = 5 * i + j;
                // At a tip the five nodes of the column are one.
                let tip = |n: usize| match n / 5 {
                    0 => 0,
                    32 => 160,
                    _ => n,
                };
                mesh.quads.push([node, node + 5, node + 6, node + 1].map(tip));
            }
        }
        let corners = |quad: &[usize; 4]| quad.map(|n| mesh.points[n].coords.xy());
        let area = |p: [Vector2<f64>; 4]| (0..4).map(|k| p[k].perp(&p[(k + 1) % 4])).sum::<f64>() / 2.0;
        mesh.area = mesh.quads.iter().map(|quad| area(corners(quad))).collect();
        mesh.component = vec![0; mesh.quads.len()];
        mesh
    }

    fn write(&self, dir: &Path) {
        let [xi, eta] = self.axes();
        let separation: Vec<f64> =
            xi.iter().flat_map(|&x| eta.iter().map(move |&y| (self.separation)(x, y))).collect();
        let heights: Vec<f64> = xi.iter().map(|&x| rail_height(x)).collect();
        let normals: Vec<[f64; 2]> = xi.iter().map(|x| [x / 300.0, (1.0 - x * x / 9e4).sqrt()]).collect();
        let grid = GridFields::new(&xi, &eta, &separation, &heights, &normals).unwrap();
        let turn = UnitComplex::from_cos_sin_unchecked(0.8, 0.6);
        let header = Header {
            title: "Paraboloids -- \u{a7}7 <test>".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene_hash: "0123456789abcdef".into(),
            approach: self.approach,
            frame: Frame::from(&Isometry2::from_parts(Translation2::new(10.0, -0.2), turn)),
            remarks: Vec::new(),
        };
        let folder = Folder::create(dir, RUN_FOLDER).unwrap();
        write_grid(&folder, &header, &grid);
        write_decks(&folder, &header, &grid, &self.mesh());
        let loops = self.loops();
        folder.write("boundary.csv", boundary_csv(&loops).as_bytes()).unwrap();
        let row = PatchRow { xi: 0.0, component: 0, eta: Interval::symmetric(1.0), cut: [false; 2] };
        folder.write("interpen.csv", interpen_csv(&[row]).as_bytes()).unwrap();
        folder.write("boundary.vtp", &boundary_vtp(&header, &loops).unwrap()).unwrap();
        folder.write("strips.vtu", &strips_vtu(&header, &self.mesh()).unwrap()).unwrap();
        let steps = [(0.0, 0, "rail.vts".into()), (0.5, 0, "wheel.vts".into())];
        folder.write("surface.pvd", collection_pvd(&steps).as_bytes()).unwrap();
        folder.write("patch.svg", picture(&header, &grid, &loops).as_bytes()).unwrap();
        folder.write("view.py", VIEW_SCRIPT.as_bytes()).unwrap();
        folder.write("summary.json", b"{\"program\": \"wheelrail\"}\n").unwrap();
        folder.commit().unwrap();
    }
}

fn picture(header: &Header, grid: &GridFields, loops: &[Loop]) -> String {
    let profile = |f: fn(f64) -> f64| (-40..=40).map(|x| [f64::from(x), f(f64::from(x))]).collect::<Vec<_>>();
    let (rail, wheel) = (profile(rail_height), profile(|x| 1e-3 * x * x));
    let midplane: Vec<[f64; 2]> = grid.xi().iter().map(|&x| [x, hertz(x, 0.0)]).collect();
    let separation = Nodes { xi: grid.xi(), eta: grid.eta(), values: grid.separation() };
    let cells = [grid.xi(), grid.eta()];
    let contact = PicturedContact { header, name: "", refusals: &[], rail: &rail, wheel: &wheel };
    PatchPicture { contact, cells, separation, midplane: &midplane, loops, pressed: None }.svg()
}

fn rail_height(xi: f64) -> f64 {
    -xi * xi / 600.0
}

fn write_grid(folder: &Folder, header: &Header, grid: &GridFields) {
    let (xi, eta) = (grid.xi(), grid.eta());
    let shape = [xi.len() as u64, eta.len() as u64];
    folder.stream("xi.npy", |sink| array_npy(sink, &shape[..1], xi)).unwrap();
    folder.stream("eta.npy", |sink| array_npy(sink, &shape[1..], eta)).unwrap();
    folder.stream("separation.npy", |sink| array_npy(sink, &shape, grid.separation())).unwrap();
    folder.stream("separation.vts", |sink| separation_vts(sink, header, grid)).unwrap();
    folder.stream("rail.vts", |sink| rail_vts(sink, header, grid)).unwrap();
    folder.stream("wheel.vts", |sink| wheel_vts(sink, header, grid)).unwrap();
    folder.stream("separation.vtk", |sink| separation_vtk(sink, header, grid)).unwrap();
    let netcdf = NetCdf::new(header, grid).unwrap();
    folder.stream("separation.nc", |sink| netcdf.write(sink)).unwrap();
}

fn write_decks(folder: &Folder, header: &Header, grid: &GridFields, mesh: &QuadMesh) {
    let deck = Deck::new(header, grid).unwrap();
    folder.stream("separation.wrp", |sink| separation_wrp(&deck, sink)).unwrap();
    folder.stream("conform.wrp", |sink| conform_wrp(&deck, sink)).unwrap();
    let mut countact = Vec::new();
    countact_wrp(&deck, mesh, &mut countact).unwrap();
    folder.write("countact.wrp", &countact).unwrap();
    let settings = ContactSettings::steel(Prescribed::Force(LOAD));
    folder.stream("contact.inp", |sink| contact_inp(&deck, &settings, sink)).unwrap();
}

#[test]
fn every_reader_gives_back_what_was_written() {
    let dirs = [("lopsided", 0.05, [61, 40]), ("empty", 0.0, [6, 7])].map(|(name, approach, n)| {
        let dir = folder(name);
        Scene { separation: lopsided, approach, n }.write(&dir);
        dir
    });
    check_all(&dirs);
}

#[test]
fn tamaas_and_contact_mechanics_solve_hertz() {
    let dir = folder("hertz");
    Scene { separation: hertz, approach: APPROACH, n: [128, 128] }.write(&dir);
    check_all(&[&dir]);
    let (load, approach) = (LOAD.to_string(), APPROACH.to_string());
    let arguments = ["--modulus", MODULUS, "--load", &load, "--peak", PEAK, "--approach", &approach];
    check("solve.py", &dir, &[&arguments[..], &["--within", "0.001"]].concat());
}

#[test]
fn tamaas_and_contact_mechanics_agree_on_what_is_not_hertz() {
    let dir = folder("solved");
    Scene { separation: lopsided, approach: 0.12, n: [100, 110] }.write(&dir);
    check("solve.py", &dir, &["--modulus", MODULUS, "--load", "60000", "--within", "0.005"]);
}
