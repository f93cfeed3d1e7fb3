//! `wheelrail profile`: list and show profiles.

use std::fmt::Write;
use std::path::Path;

use clap::Subcommand;

use super::{Outcome, print};
use crate::error::Result;
use crate::profile::{Profile, Shape, standards};
use crate::scene;

/// What to do with profiles.
#[derive(Debug, Subcommand)]
pub(super) enum ProfileCommand {
    /// Names and sources of the built-in profiles.
    List,
    /// Segments, joints and source of a built-in profile or of a profile file.
    Show {
        /// Name or file.
        profile: String,
    },
}

/// Runs `wheelrail profile …`.
pub(super) fn profile(command: &ProfileCommand) -> Result<Outcome> {
    match command {
        ProfileCommand::List => print(&list()?),
        ProfileCommand::Show { profile } => print(&show(&find(profile)?)),
    }
}

fn list() -> Result<String> {
    let mut out = String::new();
    for name in standards::rail_names() {
        let _ = writeln!(out, "rail   {name:<24} {}", standards::rail(name)?.source);
    }
    for name in standards::wheel_names() {
        let _ = writeln!(out, "wheel  {name:<24} {}", standards::wheel(name)?.source);
    }
    Ok(out)
}

/// A built-in rail or wheel, or a file.
fn find(name: &str) -> Result<Profile> {
    if Path::new(name).exists() {
        return scene::profile_from_file(Path::new(name));
    }
    if standards::rail_names().any(|rail| rail == name) {
        return standards::rail(name);
    }
    standards::wheel(name)
}

fn show(profile: &Profile) -> String {
    let mut out = format!("# {}\n# {}\n", profile.name, profile.source);
    let _ = writeln!(
        out,
        "# {:<10} {:<10} {:>22} {:>22} {:>22} {:>22} {:>14}",
        "segment", "kind", "x_start", "z_start", "x_end", "z_end", "radius_mm"
    );
    for (index, segment) in profile.segments().iter().enumerate() {
        let label = if segment.label.is_empty() { (index + 1).to_string() } else { segment.label.clone() };
        let (kind, radius) = match &segment.shape {
            Shape::Arc(arc) if arc.radius.is_finite() => ("arc", format!("{:.9}", arc.radius)),
            Shape::Arc(_) => ("line", "-".into()),
            Shape::Polynomial(_) => ("polynomial", "-".into()),
        };
        let (start, end) = (segment.start(), segment.end());
        let _ = writeln!(
            out,
            "{:<12} {kind:<10} {:22.15} {:22.15} {:22.15} {:22.15} {radius:>14}",
            label.replace(' ', "_"),
            start.x,
            start.z,
            end.x,
            end.z
        );
    }
    out += "\n# joint           x_mm         gap_mm        kink_rad  curvature_jump_per_mm\n";
    for joint in profile.continuity() {
        let _ = writeln!(
            out,
            "{:<7} {:14.6} {:14.3e} {:15.6e} {:22.6e}",
            joint.left + 1,
            joint.x,
            joint.gap,
            joint.kink,
            joint.curvature_jump
        );
    }
    out
}
