//! `wheelrail man`: a manual page for the program and for each of its commands.

use std::path::Path;

use clap::Command;

use crate::answer::{Outcome, print};
use wheelrail::error::{Error, Result};
use wheelrail::files::{make_folder, write_file};

/// Prints all pages one after the other, or writes each into `folder` as its name in section 1.
///
/// # Errors
/// Any error of the disk.
pub(super) fn man(program: Command, folder: Option<&Path>) -> Result<Outcome> {
    // `help` has no page of its own, and no page may name it.
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    collect(&program, &mut pages)?;
    let Some(folder) = folder else {
        return print(&pages.into_iter().map(|(_, text)| text).collect::<String>());
    };
    make_folder(folder)?;
    for (name, text) in &pages {
        write_file(&folder.join(name), text.as_bytes())?;
    }
    print(&format!("{}: {} pages\n", folder.display(), pages.len()))
}

/// Adds the page of a command and those of the commands below it, each with the name of its file.
fn collect(command: &Command, pages: &mut Vec<(String, String)>) -> Result<()> {
    let page = clap_mangen::Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text).map_err(|error| {
        Error::new("man", error.to_string(), "a page", "report this as a fault of wheelrail")
    })?;
    pages.push((page.get_filename(), String::from_utf8_lossy(&text).into_owned()));
    command.get_subcommands().filter(|below| !below.is_hide_set()).try_for_each(|below| collect(below, pages))
}
