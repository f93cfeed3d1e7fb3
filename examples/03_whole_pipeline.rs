//! How do I run a scene and write its files from my own program?
//!
//!     cargo run --release --example 03_whole_pipeline
#![allow(clippy::print_stdout)]

use std::path::Path;

use wheelrail::case::{RUN_FOLDER, Run, SILENT, write};
use wheelrail::files::Folder;
use wheelrail::scene;

fn main() -> wheelrail::Result<()> {
    let path = Path::new("examples/scenes/60e1_s1002.toml");
    let case = scene::resolve(&scene::load(path)?, Path::new("examples/scenes"), "60e1_s1002")?;
    let run = Run::new(case, SILENT)?;
    for part in &run.parts {
        println!(
            "method {}, error below {:e} mm",
            part.analysis.plan.choice.method.name(),
            part.analysis.plan.error
        );
    }
    let folder = Folder::create(Path::new("output/from_library"), RUN_FOLDER)?;
    write(&run, &folder, None, SILENT)?;
    folder.commit()
}
