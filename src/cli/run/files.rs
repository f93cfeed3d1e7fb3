//! Which files a run writes, and from what.

use rayon::prelude::*;

use super::{Run, summary};
use crate::error::{Error, Result};
use crate::export::deck::Deck;
use crate::export::deck::contact::{Normal, Settings};
use crate::export::{Folder, Frame, GridFields, Header, npy, vts};
use crate::placement::midsep;
use crate::scene::Format;

/// A file and the writer of its content.
type Job<'a> = (&'static str, Box<dyn Fn(&Folder) -> Result<()> + Sync + Send + 'a>);

/// Writes all files that the scene asks for, side by side; summary.json last.
pub(super) fn write(folder: &Folder, run: &Run) -> Result<()> {
    let header = header(run);
    let rail = RailColumns::new(run);
    let analysis = &run.analysis;
    let grid =
        GridFields::new(&analysis.xi, &analysis.eta, &analysis.separation, &rail.height, &rail.normal)?;
    let mut skipped = Vec::new();
    let deck = if run.wants_any(&[Format::Text, Format::Conform, Format::Countact, Format::Contact]) {
        run.needing_equal_steps(Deck::new(&header, &grid), &mut skipped)?
    } else {
        None
    };
    let mut jobs: Vec<Job<'_>> = Vec::new();
    tables(&mut jobs, run);
    arrays(&mut jobs, run);
    surfaces(&mut jobs, run, &header, &grid);
    if let Some(deck) = &deck {
        decks(&mut jobs, run, deck);
    }
    jobs.par_iter().try_for_each(|(name, job)| job(folder).map_err(|error| error.within(name)))?;
    let mut names: Vec<String> = jobs.iter().map(|(name, _)| (*name).to_string()).collect();
    names.sort();
    folder.write("summary.json", &summary::summary(run, &names, &skipped))
}

/// ζ^R and the rail's normal at every ξ of the grid.
struct RailColumns {
    height: Vec<f64>,
    normal: Vec<[f64; 2]>,
}

impl RailColumns {
    fn new(run: &Run) -> Self {
        let section = &run.contact.placement.rail.section;
        let stations =
            run.analysis.xi.iter().map(|&xi| section.branch_at(xi).map(|branch| branch.station(xi)));
        let (height, normal) = stations
            .map(|station| station.map_or((f64::NAN, [f64::NAN; 2]), |s| (s.z, [-s.sin, s.cos])))
            .unzip();
        Self { height, normal }
    }
}

fn header(run: &Run) -> Header {
    let rail = run.contact.placement.rail.point.station;
    Header {
        title: run.title.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: run.hash.clone(),
        approach: run.contact.approach.map_or(0.0, |(approach, _)| approach),
        frame: Frame::at(rail.x, rail.z, rail.cos, rail.sin),
    }
}

fn tables<'a>(jobs: &mut Vec<Job<'a>>, run: &'a Run) {
    jobs.push((
        "midsep.txt",
        Box::new(move |folder: &Folder| {
            folder.write("midsep.txt", midsep::table(&run.contact.placement, &run.analysis.xi).as_bytes())
        }),
    ));
}

fn arrays<'a>(jobs: &mut Vec<Job<'a>>, run: &'a Run) {
    if !run.wants_any(&[Format::Npy]) {
        return;
    }
    let analysis = &run.analysis;
    let (n, m) = (analysis.xi.len() as u64, analysis.eta.len() as u64);
    let mut add = |name: &'static str, shape: Vec<u64>, values: &'a [f64]| {
        jobs.push((
            name,
            Box::new(move |folder: &Folder| folder.stream(name, |file| npy::array(file, &shape, values))),
        ));
    };
    add("xi.npy", vec![n], &analysis.xi);
    add("eta.npy", vec![m], &analysis.eta);
    add("separation.npy", vec![n, m], &analysis.separation);
}

fn surfaces<'a>(jobs: &mut Vec<Job<'a>>, run: &Run, header: &'a Header, grid: &'a GridFields<'a>) {
    if !run.wants_any(&[Format::Vtk]) {
        return;
    }
    type Writer = fn(&mut dyn std::io::Write, &Header, &GridFields<'_>) -> std::io::Result<()>;
    let writers: [(&'static str, Writer); 3] =
        [("separation.vts", vts::separation), ("rail.vts", vts::rail), ("wheel.vts", vts::wheel)];
    for (name, writer) in writers {
        jobs.push((
            name,
            Box::new(move |folder: &Folder| folder.stream(name, |file| writer(file, header, grid))),
        ));
    }
}

fn decks<'a>(jobs: &mut Vec<Job<'a>>, run: &'a Run, deck: &'a Deck<'a>) {
    if run.wants_any(&[Format::Text]) {
        let name = "separation.wrp";
        jobs.push((name, Box::new(move |folder: &Folder| folder.stream(name, |file| deck.separation(file)))));
    }
    if run.wants_any(&[Format::Conform]) {
        let name = "conform.wrp";
        jobs.push((name, Box::new(move |folder: &Folder| folder.stream(name, |file| deck.conform(file)))));
    }
    if let (true, Some(settings)) = (run.wants_any(&[Format::Contact]), contact_settings(run)) {
        let name = "contact.inp";
        jobs.push((
            name,
            Box::new(move |folder: &Folder| folder.stream(name, |file| deck.contact(&settings, file))),
        ));
    }
}

/// CONTACT's control numbers; none without an approach.
fn contact_settings(run: &Run) -> Option<Settings> {
    let (approach, _) = run.contact.approach.filter(|(approach, _)| *approach > 0.0)?;
    let load = run.scene.patch.as_ref().and_then(|patch| patch.load);
    let bodies = run.question.material;
    Some(Settings {
        normal: load.map_or(Normal::Approach(approach), Normal::Force),
        poisson: bodies.map(|body| body.poissons_ratio),
        shear_modulus: bodies.map(|body| body.youngs_modulus / (2.0 * (1.0 + body.poissons_ratio))),
        ..Settings::steel(Normal::Approach(approach))
    })
}

impl Run {
    /// Whether any of the formats is asked for.
    fn wants_any(&self, formats: &[Format]) -> bool {
        self.scene.output.wanted().iter().any(|format| formats.contains(format))
    }

    /// A writer's refusal of unequal steps is an error where the scene names the formats, and a remark in the
    /// summary where they are the default ones.
    fn needing_equal_steps<T>(&self, writer: Result<T>, skipped: &mut Vec<String>) -> Result<Option<T>> {
        match writer {
            Ok(writer) => Ok(Some(writer)),
            Err(Error { place, found, .. }) if self.scene.output.formats.is_none() => {
                skipped.push(format!("files for solvers: {place} has {found}"));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}
