//! Which files a run writes, and from what.

use rayon::prelude::*;

use super::drawn::{Drawn, loops_of, quads};
use super::elements::{surface_mesh, surfaces_around, triangles};
use super::formats::{OutputFormat, SurfaceOf, Writer};
use super::in_place::in_place;
use super::input::Outputs;
use super::jobs::{Job, bytes, contents, possible, stream, write_jobs};
use super::on_rail::OnRail;
use super::run::{COMPUTING, Part, Run, Tell};
use super::site::cut_by;
use super::summary::{Meshes, summary};
use super::unrolled::Unrolled;
use super::view::view;
use crate::error::{Error, Result, in_order};
use crate::export::{
    ConformalPicture, ContactSettings, CurvedDeck, CurvedFields, Deck, Frame, GridFields, Header, InPlace,
    Loop, NetCdf, PatchMesh, PatchPicture, PatchRow, Prescribed, QuadMesh, SurfaceMesh, boundary_csv,
    interpen_csv, interpen_sigma_csv,
};
use crate::files::Folder;
use crate::mesh::Surface;
use crate::patch::Slice;
use crate::placement::Creepages;
use crate::search::TrackSide;
use crate::separation::{LowerBody, midplane_table};

/// Turns a picture's SVG into PNG. The library draws no pixels: a caller who wants them brings this.
pub type Rasterise = fn(&str) -> Result<Vec<u8>>;

/// Writes all files that a run's case asks for, on the threads of the current rayon pool, and tells the step that it is at.
///
/// # Errors
/// The disk's; a format that cannot hold the grid, where the case requires it; a case that asks for PNG without `png`.
pub fn write(run: &Run, folder: &Folder, png: Option<Rasterise>, tell: Tell<'_>) -> Result<Vec<WrittenPart>> {
    let all = run.parts.len() as f64;
    let one = |(k, part): (usize, &Part)| {
        let tell = |step: String, share: f64| {
            tell(step, COMPUTING + (1.0 - COMPUTING) * (k as f64 + share) / all);
        };
        write_part(run, part, folder, png, &tell)
    };
    in_order(run.parts.par_iter().enumerate().map(one))
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
    png: Option<Rasterise>,
    tell: Tell<'_>,
) -> Result<WrittenPart> {
    tell(format!("{}: files", part.site.name()), 0.0);
    with_jobs(run, part, (&run.case.outputs, png), |[always, asked], meshes, skipped| {
        let jobs: Vec<Job<'_>> = always.into_iter().chain(asked).collect();
        let folder = folder.part(&part.site.folder)?;
        let names = write_jobs(&jobs, &folder, |done| {
            let step = format!("{}: {done} of {} files written", part.site.name(), jobs.len());
            tell(step, done as f64 / jobs.len() as f64);
        })?;
        let summary = summary(run, part, Some(&folder), meshes, (&names, skipped))?;
        let mut text = serde_json::to_vec_pretty(&summary).unwrap_or_default();
        text.push(b'\n');
        folder.write("summary.json", &text)?;
        let names = names.into_iter().chain(["summary.json".into()]);
        let files =
            names.map(|name| Ok(WrittenFile { size: folder.size(&name)?, name })).collect::<Result<_>>()?;
        Ok(WrittenPart { folder: part.site.folder.clone(), files, summary })
    })
}

/// Makes the files of one format in memory, or without a format the tables and pictures of every run; gives them by their paths
/// in the run's folder.
///
/// # Errors
/// A format that cannot hold the grid, or has nothing to show; PNG, which the library does not draw.
pub fn files(run: &Run, format: Option<OutputFormat>) -> Result<Vec<(String, Vec<u8>)>> {
    let formats = Vec::from_iter(format);
    let outputs = Outputs { formats, required: true, mesh_size: run.case.outputs.mesh_size };
    let (mut all, mut missing) = (Vec::new(), Vec::new());
    for part in &run.parts {
        with_jobs(run, part, (&outputs, None), |[always, asked], _, skipped| {
            let jobs = if format.is_some() { asked } else { always };
            let folder = &part.site.folder;
            let path = |name| if folder.is_empty() { String::from(name) } else { format!("{folder}/{name}") };
            all.extend(contents(&jobs)?.into_iter().map(|(name, bytes)| (path(name), bytes)));
            missing.extend_from_slice(skipped);
            Ok(())
        })?;
    }
    if all.is_empty() {
        let found = format!("nothing to write {}", missing.join("; "));
        let expected = "a feasible contact with an approach or a load";
        return Err(Error::new("format", found.trim_end(), expected, "give one of them"));
    }
    Ok(all)
}

/// Gives what `summary.json` says of every part, without the lists and measures of files.
///
/// # Errors
/// A wheel at rest where it touches, whose creepages are asked for.
pub fn summaries(run: &Run) -> Result<Vec<serde_json::Value>> {
    let none = Meshes { bodies: None, patch: None };
    run.parts.iter().map(|part| summary(run, part, None, none, (&[], &[]))).collect()
}

/// Calls `then` with the files that every run has and those of the asked formats, with the meshes in them, and with what could not be
/// made.
fn with_jobs<T>(
    run: &Run,
    part: &Part,
    (outputs, png): (&Outputs, Option<Rasterise>),
    then: impl FnOnce([Vec<Job<'_>>; 2], Meshes<'_>, &[String]) -> Result<T>,
) -> Result<T> {
    let (axes, mut skipped) = (&part.site.grid, Vec::new());
    let (header, creepages) = (header(run, part), run.creepages(part)?);
    let lower = LowerBody::under(&part.site.contact.placement, &axes.xi, &axes.eta);
    let grid = GridFields::over(&axes.xi, &axes.eta, &part.analysis.separation, &lower)?;
    let pressure = part.analysis.pressure.as_ref().and_then(|found| found.field.as_deref());
    let grid = pressure.map_or(Ok(grid), |pressure| grid.with_pressure(pressure))?;
    let on_rail = part.analysis.conformal.as_ref().map(|conformal| OnRail::new(&part.site, conformal));
    let curved = on_rail.as_ref().map(OnRail::fields).transpose()?;
    let gridded = Gridded::new(outputs, &header, &grid, curved.as_ref(), &mut skipped)?;
    let bodies = surfaces_around(outputs, part, &mut skipped)?;
    let triangles = triangles(outputs, part, &mut skipped)?;
    let (drawn, unrolled, loops) = (Drawn::new(part), Unrolled::new(part), loops(part));
    // What shows all parts of the run lies with the first.
    let first = run.parts.first().is_some_and(|first| std::ptr::eq(first, part));
    let sources = FileSources {
        header: &header,
        grid: &grid,
        curved: curved.as_ref(),
        gridded,
        settings: contact_settings(run, part, creepages),
        strips: part.analysis.strips.as_ref().map(quads),
        surfaces: surfaces_of(part, triangles.as_ref(), bodies.as_ref()),
        triangles: triangles.as_ref(),
        in_place: (first && outputs.wants(Writer::is_in_place)).then(|| in_place(run)),
        page: first.then_some(run),
        picture: drawn.picture(&header, [&axes.xi, &axes.eta], &loops),
        unrolled: unrolled.as_ref().map(|unrolled| unrolled.picture(&header, &drawn)),
        png: rasterise(outputs, png)?,
        loops: &loops,
    };
    let asked = outputs.files().filter_map(|(name, writer)| job(name, writer, &sources)).collect();
    let meshes = Meshes { bodies: bodies.as_ref(), patch: triangles.as_ref().map(|patch| &patch.mesh) };
    then([always(part, &sources, on_rail.as_ref()), asked], meshes, &skipped)
}

/// What the files of a part are written from.
struct FileSources<'a> {
    header: &'a Header,
    grid: &'a GridFields<'a>,
    curved: Option<&'a CurvedFields<'a>>,
    gridded: Gridded<'a>,
    settings: Option<ContactSettings>,
    loops: &'a [Loop],
    strips: Option<QuadMesh>,
    triangles: Option<&'a PatchMesh>,
    surfaces: Vec<(SurfaceOf, SurfaceMesh)>,
    in_place: Option<InPlace>,
    /// The run, for the part with which its page lies.
    page: Option<&'a Run>,
    picture: PatchPicture<'a>,
    unrolled: Option<ConformalPicture<'a>>,
    png: Option<Rasterise>,
}

/// What needs equal steps, where it is asked for and the grid has them.
struct Gridded<'a> {
    netcdf: Option<NetCdf<'a>>,
    deck: Option<Deck<'a>>,
    curved_deck: Option<CurvedDeck<'a>>,
}

impl<'a> Gridded<'a> {
    fn new(
        outputs: &Outputs,
        header: &'a Header,
        grid: &'a GridFields<'a>,
        curved: Option<&'a CurvedFields<'a>>,
        skipped: &mut Vec<String>,
    ) -> Result<Self> {
        if let Some(curved) = curved {
            OnRail::refuse(outputs, skipped)?;
            let (names, deck) = ("conform.wrp, contact.inp", || CurvedDeck::new(header, curved));
            let curved_deck = possible(outputs, names, Writer::is_curved_deck, deck, skipped)?;
            return Ok(Self { netcdf: None, deck: None, curved_deck });
        }
        let (deck, netcdf) = (|| Deck::new(header, grid), || NetCdf::new(header, grid));
        let deck = possible(outputs, "decks", Writer::is_deck, deck, skipped)?;
        let netcdf = possible(outputs, "separation.nc", Writer::is_netcdf, netcdf, skipped)?;
        Ok(Self { netcdf, deck, curved_deck: None })
    }
}

/// Gives the surfaces that there are.
fn surfaces_of(
    part: &Part,
    patch: Option<&PatchMesh>,
    bodies: Option<&[Surface; 2]>,
) -> Vec<(SurfaceOf, SurfaceMesh)> {
    let patch = patch.map(|patch| (SurfaceOf::Patch, patch.surface()));
    let bodies = bodies.into_iter().flat_map(|[rail, wheel]| {
        [
            (SurfaceOf::Rail, surface_mesh("rail", part, rail)),
            (SurfaceOf::Wheel, surface_mesh("wheel", part, wheel)),
        ]
    });
    patch.into_iter().chain(bodies).collect()
}

/// Makes the job of a file; `None` where what it is written from is not there.
fn job<'a>(name: &'static str, writer: Writer, s: &'a FileSources<'a>) -> Option<Job<'a>> {
    let FileSources { header, grid, gridded: Gridded { netcdf, deck, curved_deck }, .. } = s;
    let (deck, curved_deck) = (deck.as_ref(), curved_deck.as_ref());
    Some(match writer {
        Writer::Grid(write) => stream(name, move |file| write(file, header, grid)),
        Writer::Pressure(write) => {
            let pressure = grid.pressure()?;
            stream(name, move |file| write(file, grid, pressure))
        }
        Writer::Curved(write) => {
            let curved = s.curved?;
            stream(name, move |file| write(file, header, curved))
        }
        Writer::NetCdf => {
            let netcdf = netcdf.as_ref()?;
            stream(name, move |file| netcdf.write(file))
        }
        Writer::Deck(write) => {
            let deck = deck?;
            stream(name, move |file| write(deck, file))
        }
        Writer::StripsDeck(write) => {
            let (deck, strips) = (deck?, s.strips.as_ref()?);
            stream(name, move |file| write(deck, strips, file))
        }
        Writer::PressedDeck(write) => {
            let (deck, settings) = (deck?, s.settings.as_ref()?);
            stream(name, move |file| write(deck, settings, file))
        }
        Writer::CurvedDeck(write) => {
            let deck = curved_deck?;
            stream(name, move |file| write(deck, file))
        }
        Writer::PressedCurvedDeck(write) => {
            let (deck, settings) = (curved_deck?, s.settings.as_ref()?);
            stream(name, move |file| write(deck, settings, file))
        }
        Writer::Loops(write) => bytes(name, move || write(header, s.loops)),
        Writer::Strips(write) => {
            let strips = s.strips.as_ref()?;
            bytes(name, move || write(header, strips))
        }
        Writer::Triangles(write) => {
            let triangles = s.triangles?;
            bytes(name, move || write(header, triangles))
        }
        Writer::Surface(of, write) => {
            let (_, surface) = s.surfaces.iter().find(|(known, _)| *known == of)?;
            bytes(name, move || write(header, surface))
        }
        Writer::InPlace(write) => {
            let in_place = s.in_place.as_ref()?;
            bytes(name, move || write(in_place))
        }
        Writer::Page => {
            let run = s.page?;
            bytes(name, move || Ok(view(run).html()))
        }
        Writer::Picture => {
            let png = s.png?;
            bytes(name, move || png(&s.picture.svg()))
        }
        Writer::CurvedPicture => {
            let (png, unrolled) = (s.png?, s.unrolled.as_ref()?);
            bytes(name, move || png(&unrolled.svg()))
        }
        Writer::Text(text) => bytes(name, move || Ok(text.as_bytes().to_vec())),
    })
}

/// Makes the jobs of the files of every run: tables and pictures.
fn always<'a>(part: &'a Part, s: &'a FileSources<'a>, on_rail: Option<&'a OnRail<'a>>) -> Vec<Job<'a>> {
    let placement = &part.site.contact.placement;
    let mut jobs = vec![
        bytes("boundary.csv", || Ok(boundary_csv(s.loops).into_bytes())),
        bytes("interpen.csv", move || Ok(interpen_csv(&intervals(part)).into_bytes())),
        bytes("patch.svg", || Ok(s.picture.svg().into_bytes())),
    ];
    // Bodies that vary have no one midplane.
    if placement.lofted().is_none() {
        jobs.push(bytes(
            "midsep.txt",
            move || Ok(midplane_table(placement, &part.site.grid.xi).into_bytes()),
        ));
    }
    if let Some(on_rail) = on_rail {
        jobs.push(bytes("interpen_sigma.csv", || Ok(interpen_sigma_csv(&on_rail.intervals()).into_bytes())));
    }
    if let Some(unrolled) = &s.unrolled {
        jobs.push(bytes("conformal.svg", || Ok(unrolled.svg().into_bytes())));
    }
    jobs
}

/// Gives the way from SVG to PNG.
///
/// # Errors
/// PNG is asked for, and there is none.
fn rasterise(outputs: &Outputs, png: Option<Rasterise>) -> Result<Option<Rasterise>> {
    if outputs.wants(Writer::is_picture) && png.is_none() {
        let expected = "formats that the library writes by itself";
        let advice = "use the program `wheelrail`, or leave it out";
        return Err(Error::new("output: formats", "\"png\"", expected, advice));
    }
    Ok(png)
}

fn header(run: &Run, part: &Part) -> Header {
    let (title, hash) = (run.case.echo.title.clone(), run.case.echo.hash.clone());
    let header = Header::new(title, Frame::of(&part.site.contact.placement), part.site.approach());
    Header { scene_hash: hash, remarks: remarks(run, part), ..header }
}

/// Lists what the reader of a file of this part must know.
fn remarks(run: &Run, part: &Part) -> Vec<String> {
    let mut out = part.refusals();
    if part.site.side() == Some(TrackSide::Left) {
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
fn intervals(part: &Part) -> Vec<PatchRow> {
    let Some(patch) = &part.analysis.patch else { return Vec::new() };
    let mut rows = Vec::new();
    for &xi in &part.site.grid.xi {
        let mut here = patch.slices(xi);
        here.sort_by(|(a, p), (b, q)| a.cmp(b).then(p.eta[0].total_cmp(&q.eta[0])));
        let row = |(component, slice): (usize, Slice)| PatchRow {
            xi,
            component,
            eta: slice.eta,
            cut: cut_by(patch.window.eta, slice.eta),
        };
        rows.extend(here.into_iter().map(row));
    }
    rows
}

/// Gives CONTACT's control numbers: the contact's own normal force, or the approach where no load was asked for; `None` without
/// either.
fn contact_settings(run: &Run, part: &Part, creepages: Option<Creepages>) -> Option<ContactSettings> {
    let approach = part.site.contact.approach.filter(|approach| *approach > 0.0)?;
    let load = part.site.normal_load.filter(|load| *load > 0.0);
    let question = &run.case.question;
    Some(ContactSettings {
        material: question.material,
        friction: [question.friction.at_rest, question.friction.sliding],
        creepages,
        normal: load.map_or(Prescribed::Approach(approach), Prescribed::Force),
    })
}
