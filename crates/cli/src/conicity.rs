//! `wheelrail conicity`: the contact geometry of a wheelset on its track by EN 15302.

use std::path::PathBuf;

use super::output::{PictureFormat, refuse_files};
use super::progress::Progress;
use super::range::range;
use crate::answer::{Outcome, complain, folder_of, print};
use wheelrail::case::{
    ConicityOptions, ConicityReport, Noise, conicity, conicity_csv, conicity_page, conicity_picture,
    conicity_text, conicity_values,
};
use wheelrail::error::{Error, Result};
use wheelrail::files::NewFile;
use wheelrail::scene::{self, Scene};

/// The scene, what is asked of it, and the outputs.
#[derive(Debug, clap::Args)]
pub(super) struct ConicityArguments {
    /// Scene file with [track] and [wheelset]; its roll is solved or neglected, its yaw and displacement are not used.
    scene: PathBuf,
    /// Largest displacement and amplitude, mm.
    #[arg(long, value_name = "MM", default_value_t = ConicityOptions::default().amplitude, allow_negative_numbers = true)]
    amplitude: f64,
    /// Step of the displacements, mm; EN 15302 has at most 0.1.
    #[arg(long, value_name = "MM", default_value_t = ConicityOptions::default().step, allow_negative_numbers = true)]
    step: f64,
    /// Changes of the gauge for the map FROM:TO:STEP, mm; -5:15:1 if not given.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    gauges: Option<String>,
    /// Standard deviations of the measurement: points, radius and gauge in mm; `step` is the distance of the points.
    #[arg(long, value_name = "points=0.02,radius=0.1,gauge=0.5", value_delimiter = ',')]
    noise: Vec<String>,
    /// Number of samples of the noise.
    #[arg(long, default_value_t = Noise::default().samples, requires = "noise")]
    samples: usize,
    /// Seed of the samples.
    #[arg(long, default_value_t = Noise::default().seed, requires = "noise")]
    seed: u64,
    /// Print the functions over the displacement as CSV.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print everything as JSON, with definitions.
    #[arg(long)]
    json: bool,
    /// File to write; stdout if not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Picture of the functions and the map, in addition: .svg or .png.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    /// Page for a browser, in addition: the same linked to the profiles, with the key figures.
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
}

/// The outputs besides stdout. All have temporary names until everything is done.
struct ConicityOutputs {
    table: Option<NewFile>,
    picture: Option<(PictureFormat, NewFile)>,
    html: Option<NewFile>,
}

impl ConicityOutputs {
    /// Opens the outputs, so that their faults show before the work.
    fn create(arguments: &ConicityArguments, scene: &Scene) -> Result<Self> {
        let picture = arguments.picture.as_deref();
        let format = picture.map(|file| PictureFormat::of_file("--picture", file)).transpose()?;
        let files =
            [("--out", &arguments.out), ("--picture", &arguments.picture), ("--html", &arguments.html)];
        refuse_files(&arguments.scene, scene, None, &files)?;
        Ok(Self {
            table: arguments.out.as_deref().map(NewFile::create).transpose()?,
            picture: format.zip(picture.map(NewFile::create).transpose()?),
            html: arguments.html.as_deref().map(NewFile::create).transpose()?,
        })
    }

    fn commit(self) -> Result<()> {
        self.picture.map_or(Ok(()), |(_, file)| file.commit())?;
        self.html.map_or(Ok(()), NewFile::commit)?;
        self.table.map_or(Ok(()), NewFile::commit)
    }
}

impl ConicityArguments {
    fn options(&self) -> Result<ConicityOptions> {
        let default = ConicityOptions::default();
        let gauges = self.gauges.as_deref().map(|text| range("--gauges", text)).transpose()?;
        Ok(ConicityOptions {
            amplitude: self.amplitude,
            step: self.step,
            gauges: gauges.unwrap_or(default.gauges),
            noise: (!self.noise.is_empty()).then(|| self.noise()).transpose()?,
        })
    }

    /// Reads the keys of `--noise`.
    fn noise(&self) -> Result<Noise> {
        let mut noise = Noise { samples: self.samples, seed: self.seed, ..Noise::default() };
        for part in &self.noise {
            let parsed =
                part.split_once('=').and_then(|(key, value)| Some((key.trim(), value.trim().parse().ok()?)));
            let key = match parsed {
                Some(("points", value)) => (&mut noise.points, value),
                Some(("radius", value)) => (&mut noise.radius, value),
                Some(("gauge", value)) => (&mut noise.gauge, value),
                Some(("step", value)) => (&mut noise.step, value),
                _ => {
                    let expected = "points, radius, gauge or step with a number of mm";
                    return Err(Error::new("--noise", format!("\"{part}\""), expected, "give points=0.02"));
                }
            };
            *key.0 = key.1;
        }
        Ok(noise)
    }

    fn text(&self, report: &ConicityReport) -> String {
        if self.csv {
            conicity_csv(report)
        } else if self.json {
            serde_json::to_string_pretty(&conicity_values(report)).unwrap_or_default() + "\n"
        } else {
            conicity_text(report)
        }
    }
}

/// Finds the contact geometry and writes it.
pub(super) fn run(arguments: &ConicityArguments) -> Result<Outcome> {
    let progress = Progress::of("conicity", "scene");
    let path = arguments.scene.as_path();
    let options = arguments.options()?;
    let scene = scene::load(path)?;
    let mut outputs = ConicityOutputs::create(arguments, &scene)?;
    let in_scene = |error: Error| error.within(path.display());
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let case = scene::resolve(&scene, folder_of(path), &name).map_err(in_scene)?.read_from(path);
    let report = conicity(&case, &options, &|step| progress.at(step)).map_err(in_scene)?;
    let text = arguments.text(&report);
    if let Some((format, file)) = &mut outputs.picture {
        progress.at("picture");
        file.put(&format.bytes(conicity_picture(&case, &report)?.svg())?)?;
    }
    if let Some(file) = &mut outputs.html {
        progress.at("page");
        file.put(&conicity_page(&case, &report)?.html())?;
    }
    if let Some(file) = &mut outputs.table {
        file.put(text.as_bytes())?;
    }
    let printed = outputs.table.is_none();
    outputs.commit()?;
    drop(progress);
    // The text for people has the findings itself.
    if arguments.csv || arguments.json || !printed {
        report.findings.iter().for_each(|finding| complain(&format!("conicity: {finding}")));
    }
    if printed { print(&text) } else { Ok(Outcome::Done) }
}
