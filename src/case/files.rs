//! Which files a run writes, and from what.

use std::io::Write;

use super::drawn::{Drawn, loops_of, quads};
use super::elements::{elements, surface_mesh, surfaces_around, triangles};
use super::in_place::write_in_place;
use super::input::{OutputFormat, Outputs};
use super::jobs::{Job, bytes, possible, stream, write_jobs};
use super::on_rail::OnRail;
use super::run::{COMPUTING, Part, Run, Tell};
use super::site::cut_by;
use super::summary::{Meshes, summary};
use super::unrolled::Unrolled;
use super::view::view;
use crate::error::{Error, Result};
use crate::export::{
    ConformalPicture, ContactSettings, CurvedDeck, CurvedFields, Deck, Frame, GridFields, Header, Interval,
    Loop, NetCdf, PatchPicture, Prescribed, QuadMesh, VIEW_SCRIPT, array_npy, boundary_csv, boundary_vtp,
    conform_curved_wrp, conform_wrp, conformal_vts, contact_curved_inp, contact_inp, countact_wrp,
    interpen_csv, interpen_sigma_csv, rail_vts, separation_vtk, separation_vts, separation_wrp, strips_vtu,
    wheel_vts,
};
use crate::files::Folder;
use crate::patch::{Outline, Slice};
use crate::placement::Creepages;
use crate::profile::Station;
use crate::separation::midplane_table;

/// Turns a picture's SVG into PNG. The library draws no pixels: a caller who wants them brings this.
pub type Rasterise = fn(&str) -> Result<Vec<u8>>;

/// Writes all files that a run's case asks for, part by part, and tells what it is at.
///
/// # Errors
/// The disk's; a format that cannot hold the grid, where the case requires it; a case that asks for PNG without `png`.
pub fn write(run: &Run, folder: &Folder, png: Option<Rasterise>, tell: Tell<'_>) -> Result<Vec<WrittenPart>> {
    let mut in_place = write_in_place(run, folder)?;
    let all = run.parts.len() as f64;
    let one = |(k, part): (usize, &Part)| {
        let tell = |step: String, share: f64| {
            tell(step, COMPUTING + (1.0 - COMPUTING) * (k as f64 + share) / all);
        };
        // They lie beside the first part's own files.
        write_part(run, part, folder, std::mem::take(&mut in_place), png, &tell)
    };
    run.parts.iter().enumerate().map(one).collect()
}

/// What was written of one part.
#[derive(Debug, Clone)]
pub struct WrittenPart {
    /// Folder below the run's own; empty for the run's own.
    pub folder: String,
    /// Its files by name.
    pub files: Vec<WrittenFile>,
    /// What `summary.json` says.
    pub summary: serde_json::Value,
}

/// A file that was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFile {
    /// Its name.
    pub name: String,
    /// Its size \[bytes\].
    pub size: u64,
}

/// Writes the files of one part side by side; summary.json last.
fn write_part(
    run: &Run,
    part: &Part,
    folder: &Folder,
    in_place: Vec<String>,
    png: Option<Rasterise>,
    tell: Tell<'_>,
) -> Result<WrittenPart> {
    tell(format!("{}: files", part.site.name()), 0.0);
    let (outputs, mut skipped) = (&run.case.outputs, Vec::new());
    let header = header(run, part);
    let rail = RailColumns::new(part);
    let axes = &part.site.grid;
    let grid = GridFields::new(&axes.xi, &axes.eta, &part.analysis.separation, &rail.height, &rail.normal)?;
    let creepages = run.creepages(part)?;
    let on_rail = part.analysis.conformal.as_ref().map(|conformal| OnRail::new(&part.site, conformal));
    let curved = on_rail.as_ref().map(OnRail::fields).transpose()?;
    let (decks_of, netcdf_of) = match &curved {
        Some(_) => (&[][..], &[][..]),
        None => (&OutputFormat::DECKS[..], &[OutputFormat::Netcdf][..]),
    };
    let deck = possible(outputs, "decks", decks_of, || Deck::new(&header, &grid), &mut skipped)?;
    let netcdf = || NetCdf::new(&header, &grid);
    let netcdf = possible(outputs, "separation.nc", netcdf_of, netcdf, &mut skipped)?;
    let curved_deck = match &curved {
        Some(curved) => {
            OnRail::refuse(outputs, &mut skipped)?;
            let formats = [OutputFormat::Conform, OutputFormat::Contact];
            let deck = || CurvedDeck::new(&header, curved);
            possible(outputs, "conform.wrp, contact.inp", &formats, deck, &mut skipped)?
        }
        None => None,
    };
    let bodies = surfaces_around(outputs, part, &mut skipped)?;
    let solids = bodies.as_ref().map(|bodies| bodies.each_ref().map(|body| surface_mesh(part, body)));
    let triangles = triangles(run, part, &mut skipped)?;
    let loops = loops(part);
    let strips = part.analysis.strips.as_ref().map(quads);
    let drawn = Drawn::new(part);
    let picture = drawn.picture(&header, [&axes.xi, &axes.eta], &loops);
    let unrolled = Unrolled::new(part);
    let unrolled = unrolled.as_ref().map(|unrolled| unrolled.picture(&header, &drawn));
    let mut jobs: Vec<Job<'_>> = Vec::new();
    tables(&mut jobs, part, &loops);
    arrays(&mut jobs, outputs, part);
    pictures(&mut jobs, outputs, (&picture, unrolled.as_ref()), png)?;
    // One page shows all parts of the run; it lies with the first.
    if outputs.any(&[OutputFormat::Html]) && run.parts.first().is_some_and(|first| std::ptr::eq(first, part))
    {
        bytes(&mut jobs, "view.html", || Ok(view(run).html()));
    }
    if outputs.any(&[OutputFormat::Vtk]) {
        surfaces(&mut jobs, &header, &grid, &loops, strips.as_ref());
    }
    elements(&mut jobs, outputs, &header, triangles.as_ref(), solids.as_ref());
    if let Some(netcdf) = &netcdf {
        stream(&mut jobs, "separation.nc", move |file| netcdf.write(file));
    }
    if let (Some(on_rail), Some(curved)) = (&on_rail, &curved) {
        surface_of_rail(&mut jobs, outputs, &header, (on_rail, curved));
    }
    if let Some(deck) = &curved_deck {
        curved_decks(&mut jobs, outputs, deck, contact_settings(run, part, creepages));
    }
    if let Some(deck) = &deck {
        let settings = contact_settings(run, part, creepages);
        decks(&mut jobs, run, deck, strips.as_ref(), settings);
    }
    let folder = folder.part(&part.site.folder)?;
    let mut names = write_jobs(&jobs, &folder, |done| {
        let step = format!("{}: {done} of {} files written", part.site.name(), jobs.len());
        tell(step, done as f64 / jobs.len() as f64);
    })?;
    names.extend(in_place);
    names.sort();
    let meshes = Meshes { bodies: bodies.as_ref(), patch: triangles.as_ref().map(|patch| &patch.mesh) };
    let summary = summary(run, part, &folder, creepages, meshes, &names, &skipped);
    let mut text = serde_json::to_vec_pretty(&summary).unwrap_or_default();
    text.push(b'\n');
    folder.write("summary.json", &text)?;
    let names = names.into_iter().chain(["summary.json".into()]);
    let files =
        names.map(|name| Ok(WrittenFile { size: folder.size(&name)?, name })).collect::<Result<_>>()?;
    Ok(WrittenPart { folder: part.site.folder.clone(), files, summary })
}

/// ζ^R and the rail's normal at every ξ of the grid.
struct RailColumns {
    height: Vec<f64>,
    normal: Vec<[f64; 2]>,
}

impl RailColumns {
    fn new(part: &Part) -> Self {
        let section = &part.site.contact.placement.rail().section;
        let station = |&xi: &f64| section.branch_at(xi).map(|branch| branch.station(xi));
        let column = |s: Station| (s.z, [-s.sin, s.cos]);
        let columns =
            part.site.grid.xi.iter().map(|xi| station(xi).map_or((f64::NAN, [f64::NAN; 2]), column));
        let (height, normal) = columns.unzip();
        Self { height, normal }
    }
}

fn header(run: &Run, part: &Part) -> Header {
    Header {
        title: run.case.echo.title.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: run.case.echo.hash.clone(),
        approach: part.site.approach(),
        frame: Frame::from(&part.site.contact.placement.rail().contact_frame()),
        remarks: remarks(run, part),
    }
}

/// Lists what the reader of a file of this part must know.
fn remarks(run: &Run, part: &Part) -> Vec<String> {
    let mut out = part.refusals();
    if part.site.side() == Some("left") {
        let signs = match run.case.question.motion {
            Some(_) => "creepages are those of the mirror image",
            None => "lateral creepage, spin and skew change sign",
        };
        out.push(format!(
            "left side of a wheelset, as its mirror image: x to the left, y forward, z up; {signs}"
        ));
    }
    out
}

/// Gives the boundary loops, lifted onto the rail: of every component the outer one, then those around its holes.
fn loops(part: &Part) -> Vec<Loop> {
    let placement = &part.site.contact.placement;
    part.analysis.patch.as_ref().map_or_else(Vec::new, |patch| loops_of(placement, patch))
}

/// Gives INTERPEN's own table: the intervals of η at every ξ of the grid that lies in the patch, by component and η.
fn intervals(part: &Part) -> Vec<Interval> {
    let Some(patch) = &part.analysis.patch else { return Vec::new() };
    let mut outline = Outline::new(&part.site.contact.placement, patch.approach, &patch.window);
    let mut rows = Vec::new();
    for &xi in &part.site.grid.xi {
        let mut here = patch.slices(&mut outline, xi);
        here.sort_by(|(a, p), (b, q)| a.cmp(b).then(p.eta[0].total_cmp(&q.eta[0])));
        let row = |(component, slice): (usize, Slice)| Interval {
            xi,
            component,
            eta: slice.eta,
            cut: cut_by(patch.window.eta, slice.eta),
        };
        rows.extend(here.into_iter().map(row));
    }
    rows
}

fn tables<'a>(jobs: &mut Vec<Job<'a>>, part: &'a Part, loops: &'a [Loop]) {
    bytes(jobs, "boundary.csv", move || Ok(boundary_csv(loops).into_bytes()));
    bytes(jobs, "interpen.csv", move || Ok(interpen_csv(&intervals(part)).into_bytes()));
    bytes(jobs, "midsep.txt", move || {
        Ok(midplane_table(&part.site.contact.placement, &part.site.grid.xi).into_bytes())
    });
}

fn arrays<'a>(jobs: &mut Vec<Job<'a>>, outputs: &Outputs, part: &'a Part) {
    if !outputs.any(&[OutputFormat::Npy]) {
        return;
    }
    let axes = &part.site.grid;
    let (n, m) = (axes.xi.len() as u64, axes.eta.len() as u64);
    let mut add = |name: &'static str, shape: Vec<u64>, values: &'a [f64]| {
        stream(jobs, name, move |file| array_npy(file, &shape, values));
    };
    add("xi.npy", vec![n], &axes.xi);
    add("eta.npy", vec![m], &axes.eta);
    add("separation.npy", vec![n, m], &part.analysis.separation);
}

/// Adds the pictures over the plane and over the rail's surface, as PNG too where that is asked for.
fn pictures<'a>(
    jobs: &mut Vec<Job<'a>>,
    outputs: &Outputs,
    (plane, rail): (&'a PatchPicture<'a>, Option<&'a ConformalPicture<'a>>),
    png: Option<Rasterise>,
) -> Result<()> {
    let wanted = outputs.any(&[OutputFormat::Png]);
    if wanted && png.is_none() {
        let expected = "formats that the library writes by itself";
        let advice = "use the program `wheelrail`, or leave it out";
        return Err(Error::new("output: formats", "\"png\"", expected, advice));
    }
    let png = png.filter(|_| wanted);
    picture(jobs, ["patch.svg", "patch.png"], (plane, PatchPicture::svg), png);
    if let Some(rail) = rail {
        picture(jobs, ["conformal.svg", "conformal.png"], (rail, ConformalPicture::svg), png);
    }
    Ok(())
}

/// Adds one picture as SVG, and as PNG where there is a way to it.
fn picture<'a, P: Sync>(
    jobs: &mut Vec<Job<'a>>,
    [svg, as_png]: [&'static str; 2],
    (picture, draw): (&'a P, fn(&P) -> String),
    png: Option<Rasterise>,
) {
    bytes(jobs, svg, move || Ok(draw(picture).into_bytes()));
    if let Some(png) = png {
        bytes(jobs, as_png, move || png(&draw(picture)));
    }
}

fn surfaces<'a>(
    jobs: &mut Vec<Job<'a>>,
    header: &'a Header,
    grid: &'a GridFields<'a>,
    loops: &'a [Loop],
    strips: Option<&'a QuadMesh>,
) {
    type Writer = fn(&mut dyn Write, &Header, &GridFields<'_>) -> std::io::Result<()>;
    let writers: [(&'static str, Writer); 4] = [
        ("separation.vts", separation_vts),
        ("rail.vts", rail_vts),
        ("wheel.vts", wheel_vts),
        ("separation.vtk", separation_vtk),
    ];
    for (name, writer) in writers {
        stream(jobs, name, move |file| writer(file, header, grid));
    }
    if let Some(strips) = strips {
        bytes(jobs, "strips.vtu", move || strips_vtu(header, strips));
    }
    bytes(jobs, "boundary.vtp", move || boundary_vtp(header, loops));
    bytes(jobs, "view.py", || Ok(VIEW_SCRIPT.as_bytes().to_vec()));
}

fn decks<'a>(
    jobs: &mut Vec<Job<'a>>,
    run: &Run,
    deck: &'a Deck<'a>,
    strips: Option<&'a QuadMesh>,
    settings: Option<ContactSettings>,
) {
    if run.case.outputs.any(&[OutputFormat::Text]) {
        stream(jobs, "separation.wrp", move |file| separation_wrp(deck, file));
    }
    if run.case.outputs.any(&[OutputFormat::Conform]) {
        stream(jobs, "conform.wrp", move |file| conform_wrp(deck, file));
    }
    if let (true, Some(strips)) = (run.case.outputs.any(&[OutputFormat::Countact]), strips) {
        stream(jobs, "countact.wrp", move |file| countact_wrp(deck, strips, file));
    }
    if let (true, Some(settings)) = (run.case.outputs.any(&[OutputFormat::Contact]), settings) {
        stream(jobs, "contact.inp", move |file| contact_inp(deck, &settings, file));
    }
}

/// Adds the table, the arrays and the grid over the rail's surface.
fn surface_of_rail<'a>(
    jobs: &mut Vec<Job<'a>>,
    outputs: &Outputs,
    header: &'a Header,
    (on_rail, curved): (&'a OnRail<'a>, &'a CurvedFields<'a>),
) {
    bytes(jobs, "interpen_sigma.csv", || Ok(interpen_sigma_csv(&on_rail.intervals()).into_bytes()));
    if outputs.any(&[OutputFormat::Npy]) {
        let (n, m) = (on_rail.sigma.len() as u64, curved.grid().eta().len() as u64);
        let mut add = |name: &'static str, shape: Vec<u64>, values: &'a [f64]| {
            stream(jobs, name, move |file| array_npy(file, &shape, values));
        };
        add("sigma.npy", vec![n], &on_rail.sigma);
        add("angle.npy", vec![n], &on_rail.angle);
        add("normal_gap.npy", vec![n, m], curved.grid().separation());
    }
    if outputs.any(&[OutputFormat::Vtk]) {
        stream(jobs, "conformal.vts", move |file| conformal_vts(file, header, curved));
    }
}

/// Adds the decks over the rail's surface.
fn curved_decks<'a>(
    jobs: &mut Vec<Job<'a>>,
    outputs: &Outputs,
    deck: &'a CurvedDeck<'a>,
    settings: Option<ContactSettings>,
) {
    if outputs.any(&[OutputFormat::Conform]) {
        stream(jobs, "conform.wrp", move |file| conform_curved_wrp(deck, file));
    }
    if let (true, Some(settings)) = (outputs.any(&[OutputFormat::Contact]), settings) {
        stream(jobs, "contact.inp", move |file| contact_curved_inp(deck, &settings, file));
    }
}

/// Gives CONTACT's control numbers: the contact's own normal force, or the approach where no load was asked for; `None` without
/// either.
fn contact_settings(run: &Run, part: &Part, creepages: Option<Creepages>) -> Option<ContactSettings> {
    let (approach, _) = part.site.contact.approach.filter(|(approach, _)| *approach > 0.0)?;
    let load = part.site.normal_load.filter(|load| *load > 0.0);
    let bodies = run.case.question.material;
    Some(ContactSettings {
        poisson: bodies.map(|body| body.poissons_ratio),
        shear_modulus: bodies.map(|body| body.youngs_modulus / (2.0 * (1.0 + body.poissons_ratio))),
        friction: [run.case.question.friction.at_rest, run.case.question.friction.sliding],
        creepages,
        normal: load.map_or(Prescribed::Approach(approach), Prescribed::Force),
    })
}
