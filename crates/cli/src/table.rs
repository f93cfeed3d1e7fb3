//! `wheelrail table`: writes contact tables for vehicle dynamics, with a stated error.

use std::path::PathBuf;

use super::progress::Progress;
use crate::answer::{Outcome, complain, counted, folder_of, print};
use crate::range::interval;
use wheelrail::case::{TABLE_FOLDER, table as tabulate, table_roll_ends, write_table};
use wheelrail::error::{Error, Result};
use wheelrail::files::Folder;
use wheelrail::scene;
use wheelrail::table::{Beginning, ContactTable};

/// The scene, the range, the tolerance and the folder.
#[derive(Debug, clap::Args)]
pub(super) struct TableArguments {
    /// Scene file with [track] and [wheelset], whose roll the table has, and whose yaw unless --yaw is given.
    scene: PathBuf,
    /// Range FROM:TO of the lateral displacement, mm.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    lateral: String,
    /// Range FROM:TO of the yaw, rad: the table is over both.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    yaw: Option<String>,
    /// Tolerance of lengths, mm; those of angles, curvatures, approaches and pressures follow from it and stand in the file.
    #[arg(long, value_name = "MM", default_value_t = 1e-3, allow_negative_numbers = true)]
    tolerance: f64,
    /// Add Hertz's ellipse, approach and largest pressure under the scene's load or approach.
    #[arg(long)]
    hertz: bool,
    /// Folder to write; by default output/<scene name>-table.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Makes the table. The exit code is 0 also where a wheel leaves its rail on the way: those cells say so.
pub(super) fn table(arguments: &TableArguments) -> Result<Outcome> {
    let progress = Progress::of("table", "scene");
    let path = arguments.scene.as_path();
    let scene = scene::load(path)?;
    let lateral = interval(("mm", "-9:9"), "--lateral", &arguments.lateral)?;
    let yaw = arguments.yaw.as_ref().map(|yaw| interval(("rad", "-0.02:0.02"), "--yaw", yaw)).transpose()?;
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let default = || PathBuf::from("output").join(format!("{name}-table"));
    let target = arguments.out.clone().unwrap_or_else(default);
    let in_scene = |error: Error| error.within(path.display());
    let case = scene::resolve(&scene, folder_of(path), &name).map_err(in_scene)?;
    for warning in case.warnings() {
        complain(&format!("warning: {warning}"));
    }
    let folder = Folder::create(&target, TABLE_FOLDER)?;
    progress.at("searches");
    let made = tabulate(&case, lateral, yaw, arguments.tolerance, arguments.hertz).map_err(in_scene)?;
    progress.at("files");
    write_table(&made, scene.title.as_deref().unwrap_or(&name), &folder)?;
    folder.commit()?;
    drop(progress);
    remarks(&made).iter().for_each(|remark| complain(&format!("warning: table: {remark}")));
    print(&format!("{}{}\n", about(&made), target.display()))
}

/// Says what is in the table.
fn about(table: &ContactTable) -> String {
    let middle = table.about().yaw.at(0.5);
    let [hops, joints] = [(Beginning::Hop, "hop"), (Beginning::Joint, "joint")]
        .map(|(kind, name)| counted(table.places(kind, middle).len(), name));
    let under =
        if table.about().over_yaw() { format!(" under a yaw of {middle} rad") } else { String::new() };
    let mut text = format!("{}, {hops}, {joints}{under}\n", counted(table.cells().len(), "cell"));
    for quantity in table.quantities() {
        let (name, side) = (quantity.name, quantity.side());
        text += &format!(
            "{name:<18} {side:<8} error {:.1e}, tolerance {:.1e}\n",
            quantity.error, quantity.tolerance
        );
    }
    text
}

/// Says what a user should know before using the table.
fn remarks(table: &ContactTable) -> Vec<String> {
    let under = if table.about().over_yaw() { " under some yaws" } else { "" };
    let missing = table.off_rail_somewhere().into_iter().map(|off| {
        format!(
            "no contact from {} to {} mm{under}: a wheel is off its rail, and the table has nothing there",
            off.low, off.high
        )
    });
    let over =
        table.quantities().iter().filter(|quantity| quantity.error > quantity.tolerance).map(|quantity| {
            let (name, side, error) = (quantity.name, quantity.side(), quantity.error);
            format!(
                "{name} of the {side} errs by up to {error:.1e}, more than the tolerance {:.1e}",
                quantity.tolerance
            )
        });
    missing.chain(over).chain(table_roll_ends(table)).collect()
}
