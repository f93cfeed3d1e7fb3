//! Builds the section on the normal gap of conformal contact.

use super::section::PageSection;
use crate::conformal::GapScene;
use crate::conformal::pairs::ConformingPair;
use crate::conformal::values::{BOUNDS, GapBound, GapErrors};
use crate::loads::Solved;
use crate::measurements::Measurements;
use crate::table::{markdown, normal_gap_csv};

/// Makes the section: errors against bounds, scenes, and the conforming pairs.
pub(super) fn normal_gap(m: &Measurements) -> PageSection {
    let figures = &m.normal_gap;
    let body = format!(
        "The gap t along the rail's own normal, over the rail's surface. Errors against 60-digit values, with the bounds that \
         the tests hold them to: relative over both contact segments, absolute elsewhere, the latter over max(1, R_max/300 \
         mm).\n\n{}\n\
         Scene by scene: grids of n × n points at full precision, t over (σ, η) against spectral columns of s over (ξ, η); and \
         the largest by which closest distances of parry3d's meshes exceed |t|, with what both may err by taken off, so that it \
         should not be above 0.\n\n{}\n\
         All figures: [normal_gap.csv](normal_gap.csv).\n\n\
         Conforming pairs under a load of 60 kN: {}\n{}",
        errors(&figures.scenes),
        scenes(&figures.scenes),
        PAIRS_NOTE,
        conforming_table(&figures.pairs),
    );
    let files = vec![("normal_gap.csv", normal_gap_csv(&figures.scenes).into_bytes())];
    PageSection { title: "Normal gap of conformal contact", body, files }
}

const PAIRS_NOTE: &str = "the turn of the rail's normal over the patch t < δ cos α, the largest differences of s and s cos α from \
                          t in it, and pressures of Tamaas under one normal force with each of the three gaps.\n";

/// Returns the table of errors and bounds.
fn errors(scenes: &[GapScene]) -> String {
    let row = |bound: &GapBound| {
        let of_kind = scenes.iter().filter(|scene| scene.skewed == bound.skewed);
        let all =
            of_kind.map(|scene| scene.errors[usize::from(bound.grid)]).fold(GapErrors::NONE, GapErrors::and);
        let met = all.relative <= bound.relative && all.absolute <= bound.absolute && all.wrongly_masked == 0;
        vec![
            if bound.grid { "grids" } else { "points" }.to_string(),
            if bound.skewed { "yes" } else { "no" }.into(),
            format!("{:.1e}", all.relative),
            format!("{:.1e}", bound.relative),
            format!("{:.1e}", all.absolute),
            format!("{:.1e}", bound.absolute),
            (all.over_contact + all.elsewhere).to_string(),
            all.wrongly_masked.to_string(),
            if met { "yes" } else { "**no**" }.into(),
        ]
    };
    let head = [
        "computed as",
        "skewed",
        "relative error",
        "bound",
        "error elsewhere, mm",
        "bound, mm",
        "values",
        "wrongly undefined",
        "within",
    ];
    markdown(&head, 2, &BOUNDS.iter().map(row).collect::<Vec<_>>())
}

/// Returns the table of times and checks, one row per scene.
fn scenes(scenes: &[GapScene]) -> String {
    let sides =
        scenes.first().map_or_else(Vec::new, |scene| scene.costs.iter().map(|cost| cost.side).collect());
    let mut head = vec!["scene".to_string()];
    for side in sides {
        head.extend([format!("{side}², µs"), "over s".into()]);
    }
    head.extend(["checked points".into(), "distance beyond \\|t\\|, mm".into(), "agrees".into()]);
    let row = |scene: &GapScene| {
        let mut cells = vec![scene.name.clone()];
        for cost in &scene.costs {
            cells.extend([format!("{:.1}", 1e6 * cost.normal_gap), format!("{:.2}", cost.ratio())]);
        }
        let check = &scene.check;
        let verdict = if check.agrees { "yes" } else { "**no**" };
        cells.extend([check.points.to_string(), format!("{:.1e}", check.beyond_mm), verdict.into()]);
        cells
    };
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    markdown(&head, 1, &scenes.iter().map(row).collect::<Vec<_>>())
}

/// Returns the table of conforming pairs, as the documentation has it.
pub fn conforming_table(pairs: &[ConformingPair]) -> String {
    let row = |pair: &ConformingPair| {
        let loaded = &pair.loaded;
        let microns = |length: f64| format!("{:.1}", 1e3 * length);
        let mut cells = vec![
            loaded.pair.to_string(),
            loaded.offset.to_string(),
            loaded.yaw.to_string(),
            format!("{:.1}°", pair.site.contact.placement.rail().contact_angle().to_degrees()),
            format!("{:.1}", pair.normal_load() / 1e3),
            format!("{:.1}°", pair.turn().to_degrees()),
            microns(pair.patch.approach),
            microns(pair.difference(1)),
            microns(pair.difference(2)),
        ];
        let Some([t, others @ ..]) = pair.solved else {
            cells.extend(["–"; 5].map(String::from));
            return cells;
        };
        cells.push(format!("{:.0}", t.peak));
        for figure in [|solved: &Solved| solved.peak, |solved: &Solved| solved.area] {
            let change = |other: &Solved| 100.0 * (figure(other) / figure(&t) - 1.0);
            // No minus before a zero.
            cells.extend(
                others.iter().map(|other| format!("{:+.1} %", (10.0 * change(other)).round() / 10.0 + 0.0)),
            );
        }
        cells
    };
    let head = [
        "pair",
        "offset, mm",
        "yaw, rad",
        "θ_C",
        "F, kN",
        "turn",
        "δ, µm",
        "\\|s − t\\|, µm",
        "\\|s cos α − t\\|, µm",
        "p with t, MPa",
        "p with s",
        "p with s cos α",
        "area with s",
        "area with s cos α",
    ];
    markdown(&head, 1, &pairs.iter().map(row).collect::<Vec<_>>())
}
