//! Which files a run writes, and from what.

use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::Point3;
use rayon::prelude::*;

use super::{Part, Rasterise, Run, Tell, summary};
use crate::error::{Error, Result};
use crate::export::deck::contact::{Normal, Settings, contact};
use crate::export::deck::{Deck, wrp};
use crate::export::netcdf::NetCdf;
use crate::export::picture::{Nodes, Picture, SEPARATOR};
use crate::export::{
    Frame, GridFields, Header, Interval, Loop, QuadMesh, SurfaceMesh, VIEW_SCRIPT, csv, legacy, npy, vtk, vts,
};
use crate::files::{Folder, FolderPart};
use crate::mesh::strips::StripMesh;
use crate::mesh::surfaces::Surface;
use crate::patch::Outline;
use crate::profile::Section;
use crate::scene::{Format, equal_steps};
use crate::separation::axis::EtaAxis;
use crate::separation::values::Values;
use crate::separation::{Evaluator, midplane};

/// A file and the writer of its content.
type Job<'a> = (&'static str, Box<dyn Fn(&FolderPart<'_>) -> Result<()> + Sync + Send + 'a>);

/// Writes all files that the scene asks for, side by side; summary.json last.
pub(super) fn write(
    folder: &Folder,
    run: &Run,
    part: &Part,
    png: Option<Rasterise>,
    tell: Tell<'_>,
) -> Result<()> {
    tell(format!("{}: files", part.name()));
    let header = header(run, part);
    let rail = RailColumns::new(part);
    let analysis = &part.analysis;
    let grid =
        GridFields::new(&analysis.xi, &analysis.eta, &analysis.separation, &rail.height, &rail.normal)?;
    let mut skipped = Vec::new();
    let decks_of = [Format::Text, Format::Conform, Format::Countact, Format::Contact];
    let deck = run.possible("decks", &decks_of, || Deck::new(&header, &grid), &mut skipped)?;
    let netcdf =
        run.possible("separation.nc", &[Format::Netcdf], || NetCdf::new(&header, &grid), &mut skipped)?;
    let bodies = surfaces_around(run, part, &mut skipped)?;
    let loops = loops(part);
    let strips = part.analysis.strips.as_ref().map(quads);
    let outlines =
        [&part.contact.placement.rail().section, &part.contact.placement.wheel().section].map(outline);
    let drawn = Drawn::new(part);
    let contact = contact_name(part);
    let picture = Picture {
        header: &header,
        contact: &contact,
        cells: [&analysis.xi, &analysis.eta],
        separation: Nodes { xi: &drawn.xi, eta: &drawn.eta.eta, values: &drawn.separation },
        midplane: &drawn.midplane,
        loops: &loops,
        rail: &outlines[0],
        wheel: &outlines[1],
    };
    let mut jobs: Vec<Job<'_>> = Vec::new();
    tables(&mut jobs, part, &loops);
    arrays(&mut jobs, run, part);
    bytes(&mut jobs, "patch.svg", || Ok(picture.svg().into_bytes()));
    if run.wants_any(&[Format::Png]) {
        let png = png.ok_or_else(|| {
            let expected = "formats that the library writes by itself";
            Error::new("output: formats", "\"png\"", expected, "use the program `wheelrail`, or leave it out")
        })?;
        let picture = &picture;
        bytes(&mut jobs, "patch.png", move || png(&picture.svg()));
    }
    if run.wants_any(&[Format::Vtk]) {
        surfaces(&mut jobs, &header, &grid, &loops, strips.as_ref(), bodies.as_ref());
    }
    if let Some(netcdf) = &netcdf {
        stream(&mut jobs, "separation.nc", move |file| netcdf.write(file));
    }
    if let Some(deck) = &deck {
        decks(&mut jobs, run, part, deck, strips.as_ref());
    }
    let folder = folder.part(&part.folder)?;
    let written = AtomicUsize::new(0);
    jobs.par_iter().try_for_each(|(_, job)| {
        job(&folder)?;
        let written = 1 + written.fetch_add(1, Ordering::Relaxed);
        tell(format!("{}: {written} of {} files written", part.name(), jobs.len()));
        Ok(())
    })?;
    let mut names: Vec<String> = jobs.iter().map(|(name, _)| (*name).to_string()).collect();
    names.sort();
    folder.write("summary.json", &summary::summary(run, part, &folder, bodies.as_ref(), &names, &skipped))
}

/// ζ^R and the rail's normal at every ξ of the grid.
struct RailColumns {
    height: Vec<f64>,
    normal: Vec<[f64; 2]>,
}

impl RailColumns {
    fn new(part: &Part) -> Self {
        let section = &part.contact.placement.rail().section;
        let station = |&xi: &f64| section.branch_at(xi).map(|branch| branch.station(xi));
        let column = |s: crate::profile::Station| (s.z, [-s.sin, s.cos]);
        let columns = part.analysis.xi.iter().map(|xi| station(xi).map_or((f64::NAN, [f64::NAN; 2]), column));
        let (height, normal) = columns.unzip();
        Self { height, normal }
    }
}

fn header(run: &Run, part: &Part) -> Header {
    Header {
        title: run.title.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: run.hash.clone(),
        approach: part.contact.approach.map_or(0.0, |(approach, _)| approach),
        frame: Frame::from(&part.contact.placement.rail().contact_frame()),
        remarks: remarks(run, part),
    }
}

/// What the reader of a file of this part must know.
fn remarks(run: &Run, part: &Part) -> Vec<String> {
    let mut out = part.refusals();
    out.extend(run.shared_load(part));
    if part.side() == Some("left") {
        out.push(
            "left side of a wheelset, as its mirror image: x to the left, y forward, z up; lateral creepage, spin \
             and skew change sign"
                .into(),
        );
    }
    out
}

/// What tells the pictures of a run apart: side and number of a contact that was found, or the part of the patch.
fn contact_name(part: &Part) -> String {
    match &part.found {
        Some(found) if found.side == "single" => format!("contact {}", found.contact),
        Some(found) => {
            let mirrored = if found.side == "left" { ", mirrored" } else { "" };
            format!("{} side{mirrored}{SEPARATOR}contact {}", found.side, found.contact)
        }
        None => part.folder.clone(),
    }
}

/// Points of a picture along ξ and along η: a line of equal separation is smooth to the eye, and C is among them where
/// the grid is symmetric about it.
const DRAWN: usize = 121;

/// s over the window of the grid as a picture takes it, whatever the spacing of the solver's cells.
struct Drawn {
    xi: Vec<f64>,
    eta: EtaAxis,
    separation: Values,
    /// (ξ, s(ξ, 0))
    midplane: Vec<[f64; 2]>,
}

impl Drawn {
    fn new(part: &Part) -> Self {
        let (analysis, placement) = (&part.analysis, &part.contact.placement);
        let window = analysis.window();
        let axis = |[from, to]: [f64; 2]| if from < to { equal_steps(from, to, DRAWN) } else { vec![from] };
        let (xi, eta) = (axis(window.xi), EtaAxis::new(&axis(window.eta)));
        let mut separation = Values::new(xi.len() * eta.eta.len());
        analysis.plan.choice.fill(placement, &xi, &eta, &mut separation);
        let mut evaluator = Evaluator::new(placement);
        let midplane = xi.iter().map(|&xi| [xi, evaluator.separation(xi, 0.0)]).collect();
        Self { xi, eta, separation, midplane }
    }
}

/// Points of a picture's profile along one piece of it.
const OUTLINE_POINTS: usize = 32;

/// A body's profile in the contact frame, for pictures; NaN between pieces that do not join.
fn outline(section: &Section) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for piece in &section.pieces {
        if points.last().is_some_and(|last| last[0] != piece.xi[0]) {
            points.push([f64::NAN; 2]);
        }
        let branch = &section.branches[piece.branch];
        let xi = equal_steps(piece.xi[0], piece.xi[1], OUTLINE_POINTS);
        points.extend(xi.into_iter().map(|xi| [xi, branch.height(xi)]));
    }
    points
}

/// The boundary-fitted mesh as writers take it.
fn quads(strips: &StripMesh) -> QuadMesh {
    QuadMesh {
        points: strips.points.clone(),
        quads: strips.cells.iter().map(|cell| cell.corners).collect(),
        area: strips.cells.iter().map(|cell| cell.area).collect(),
        component: strips.cells.iter().map(|cell| cell.component).collect(),
    }
}

/// The boundary loops, lifted onto the rail: of every component the outer one, then those around its holes.
fn loops(part: &Part) -> Vec<Loop> {
    let section = &part.contact.placement.rail().section;
    let components = part.analysis.patch.iter().flat_map(|patch| &patch.components).enumerate();
    let loops = components.flat_map(|(index, component)| {
        [&component.boundary].into_iter().chain(&component.holes).map(move |points| (index, points))
    });
    loops
        .map(|(component, points)| {
            let points = points.iter().map(|&[xi, eta]| Point3::new(xi, eta, section.height(xi))).collect();
            Loop { component, points }
        })
        .collect()
}

/// INTERPEN's own table: the intervals of η at every ξ of the grid that lies in the patch, by component and η.
fn intervals(part: &Part) -> Vec<Interval> {
    let Some(patch) = &part.analysis.patch else { return Vec::new() };
    let mut outline = Outline::new(&part.contact.placement, patch.approach, &patch.window);
    let mut rows = Vec::new();
    for &xi in &part.analysis.xi {
        let mut here = patch.slices(&mut outline, xi);
        here.sort_by(|(a, p), (b, q)| a.cmp(b).then(p.eta[0].total_cmp(&q.eta[0])));
        rows.extend(here.into_iter().map(|(component, slice)| Interval { xi, component, eta: slice.eta }));
    }
    rows
}

fn tables<'a>(jobs: &mut Vec<Job<'a>>, part: &'a Part, loops: &'a [Loop]) {
    bytes(jobs, "boundary.csv", move || Ok(csv::boundary(loops).into_bytes()));
    bytes(jobs, "interpen.csv", move || Ok(csv::interpen(&intervals(part)).into_bytes()));
    bytes(jobs, "midsep.txt", move || {
        Ok(midplane::table(&part.contact.placement, &part.analysis.xi).into_bytes())
    });
}

fn arrays<'a>(jobs: &mut Vec<Job<'a>>, run: &Run, part: &'a Part) {
    if !run.wants_any(&[Format::Npy]) {
        return;
    }
    let analysis = &part.analysis;
    let (n, m) = (analysis.xi.len() as u64, analysis.eta.len() as u64);
    let mut add = |name: &'static str, shape: Vec<u64>, values: &'a [f64]| {
        stream(jobs, name, move |file| npy::array(file, &shape, values));
    };
    add("xi.npy", vec![n], &analysis.xi);
    add("eta.npy", vec![m], &analysis.eta);
    add("separation.npy", vec![n, m], &analysis.separation);
}

/// Both bodies around the patch, if VTK's files are asked for; a grid of one row or column has none.
fn surfaces_around(run: &Run, part: &Part, skipped: &mut Vec<String>) -> Result<Option<[Surface; 2]>> {
    let window = part.analysis.window();
    let names = "rail.vtu, wheel.vtu";
    if window.xi[0] >= window.xi[1] || window.eta[0] >= window.eta[1] {
        skipped.push(format!("{names}: the grid has no extent"));
        return Ok(None);
    }
    let approach = part.contact.approach.map(|(approach, _)| approach);
    let surfaces = || Surface::around(&part.contact.placement, &window, approach);
    run.possible(names, &[Format::Vtk], surfaces, skipped)
}

fn surfaces<'a>(
    jobs: &mut Vec<Job<'a>>,
    header: &'a Header,
    grid: &'a GridFields<'a>,
    loops: &'a [Loop],
    strips: Option<&'a QuadMesh>,
    bodies: Option<&'a [Surface; 2]>,
) {
    type Writer = fn(&mut dyn Write, &Header, &GridFields<'_>) -> std::io::Result<()>;
    let writers: [(&'static str, Writer); 4] = [
        ("separation.vts", vts::separation),
        ("rail.vts", vts::rail),
        ("wheel.vts", vts::wheel),
        ("separation.vtk", legacy::separation),
    ];
    for (name, writer) in writers {
        stream(jobs, name, move |file| writer(file, header, grid));
    }
    for (name, body) in ["rail.vtu", "wheel.vtu"].into_iter().zip(bodies.into_iter().flatten()) {
        bytes(jobs, name, move || {
            let mesh = SurfaceMesh { points: body.points.clone(), triangles: body.triangles() };
            vtk::surface(header, &mesh)
        });
    }
    if let Some(strips) = strips {
        bytes(jobs, "patch.vtu", move || vtk::patch(header, strips));
    }
    bytes(jobs, "boundary.vtp", move || vtk::boundary(header, loops));
    bytes(jobs, "view.py", || Ok(VIEW_SCRIPT.as_bytes().to_vec()));
}

/// A small file, made in memory.
fn bytes<'a>(
    jobs: &mut Vec<Job<'a>>,
    name: &'static str,
    content: impl Fn() -> Result<Vec<u8>> + Sync + Send + 'a,
) {
    let content = move || content().map_err(|error| error.within(name));
    jobs.push((name, Box::new(move |folder: &FolderPart<'_>| folder.write(name, &content()?))));
}

/// A large file, written piece by piece.
fn stream<'a>(
    jobs: &mut Vec<Job<'a>>,
    name: &'static str,
    content: impl Fn(&mut dyn Write) -> std::io::Result<()> + Sync + Send + 'a,
) {
    jobs.push((name, Box::new(move |folder: &FolderPart<'_>| folder.stream(name, &content))));
}

fn decks<'a>(
    jobs: &mut Vec<Job<'a>>,
    run: &Run,
    part: &Part,
    deck: &'a Deck<'a>,
    strips: Option<&'a QuadMesh>,
) {
    if run.wants_any(&[Format::Text]) {
        stream(jobs, "separation.wrp", move |file| wrp::separation(deck, file));
    }
    if run.wants_any(&[Format::Conform]) {
        stream(jobs, "conform.wrp", move |file| wrp::conform(deck, file));
    }
    if let (true, Some(strips)) = (run.wants_any(&[Format::Countact]), strips) {
        stream(jobs, "countact.wrp", move |file| wrp::countact(deck, strips, file));
    }
    if let (true, Some(settings)) = (run.wants_any(&[Format::Contact]), contact_settings(run, part)) {
        stream(jobs, "contact.inp", move |file| contact(deck, &settings, file));
    }
}

/// CONTACT's control numbers; none without an approach. A load is the force of a contact only where it is the only one of
/// its wheel.
fn contact_settings(run: &Run, part: &Part) -> Option<Settings> {
    let (approach, _) = part.contact.approach.filter(|(approach, _)| *approach > 0.0)?;
    let load = run.load().filter(|_| !run.shares_load(part));
    let bodies = run.question.material;
    Some(Settings {
        poisson: bodies.map(|body| body.poissons_ratio),
        shear_modulus: bodies.map(|body| body.youngs_modulus / (2.0 * (1.0 + body.poissons_ratio))),
        ..Settings::steel(load.map_or(Normal::Approach(approach), Normal::Force))
    })
}

impl Run {
    /// Whether any of the formats is asked for.
    fn wants_any(&self, formats: &[Format]) -> bool {
        self.scene.output.wanted().iter().any(|format| formats.contains(format))
    }

    /// What files of these formats are made from, if any of them is asked for. That it cannot be made (decks need
    /// equal steps) is an error where the scene names the formats, and a remark in the summary where they are the
    /// default ones.
    fn possible<T>(
        &self,
        files: &str,
        formats: &[Format],
        content: impl FnOnce() -> Result<T>,
        skipped: &mut Vec<String>,
    ) -> Result<Option<T>> {
        if !self.wants_any(formats) {
            return Ok(None);
        }
        match content() {
            Ok(content) => Ok(Some(content)),
            Err(Error { place, found, .. }) if self.scene.output.formats.is_none() => {
                skipped.push(format!("{files}: {place} has {found}"));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}
