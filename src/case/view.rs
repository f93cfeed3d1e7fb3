//! What the page of a run shows: every contact on a grid of the page's own, and what is known of it in words.

use super::drawn::contact_name;
use super::facts::{FACTS, Fact};
use super::polylines::{pairs, thinned};
use super::run::{Part, Run};
use crate::conformal::{NormalGap, RailArcLength, fill_normal_gap};
use crate::export::{PageConformal, PageFrame, PageLoop, PagePressure, ViewContact, ViewPage};
use crate::mesh::equal_steps;
use crate::numerics::interval::Interval;
use crate::patch::{Component, Patch, Window};
use crate::search::TrackSide;
use crate::separation::{EtaAxis, Evaluator, plan};

/// Most contacts that a page shows: more would take more than the 1.5 MB that a mail or a browser takes at once.
const MOST_SHOWN: usize = 16;

/// Points of a page's grid along ξ and along η, for up to four contacts. Boundaries by linear interpolation are then within
/// some 0.01 of a step of the exact ones, and within 0.1 where a joint of the profiles bends them.
const POINTS: usize = 161;

/// Points of all grids of a page together.
const ALL_POINTS: f64 = 4.0 * (POINTS * POINTS) as f64;

/// The largest approach that a page shows, as a multiple of the run's: its colours end there, too.
const SHOWN: f64 = 3.0;

/// Margin of a page's window around what it shows, as a share of its side.
const MARGIN: f64 = 0.04;

/// Farthest distance of the window's edge from the patch's box, as a multiple of the box's side. Where bodies conform, the
/// patch under the largest approach is many times as wide, and the grid over it would be coarse.
const WIDEST: f64 = 1.5;

/// Half the side \[mm\] of a window that would have no extent.
const LEAST_HALF: f64 = 5.0;

/// Most points of the boundaries of one contact. Only patches of rough profiles have more.
const BOUNDARY_POINTS: usize = 2000;

/// Makes the page of a run.
pub(super) fn view(run: &Run) -> ViewPage {
    let shown = &run.parts[..run.parts.len().min(MOST_SHOWN)];
    let gaps: usize = shown.iter().map(|part| 1 + usize::from(part.analysis.conformal.is_some())).sum();
    let n = ((ALL_POINTS / gaps as f64).sqrt() as usize).min(POINTS);
    ViewPage {
        title: run.case.echo.title.clone(),
        about: about(&run.case.echo.scene, &[BODIES.as_slice(), &POSITION].concat()),
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: run.case.echo.hash.clone(),
        pairs: pairs(&run.case.profiles),
        contacts: shown.iter().map(|part| contact(run, part, n)).collect(),
        notes: notes(run, n),
    }
}

/// What a page says of a scene: word, key and unit of a value.
type PageValue = (&'static str, &'static str, &'static str);

/// Profiles, inclination, radius and gauge.
const BODIES: [PageValue; 18] = [
    ("rail ", "/rail/profile", ""),
    ("rail ", "/rail/file", ""),
    ("rail ", "/rail/segments", ""),
    ("rotated ", "/rail/rotate", ""),
    ("on a roller of ", "/roller/radius", " mm"),
    ("wheel ", "/wheel/profile", ""),
    ("wheel ", "/wheel/file", ""),
    ("wheel ", "/wheel/segments", ""),
    ("R ", "/wheel/radius", " mm"),
    ("left rail ", "/left/rail/profile", ""),
    ("left rail ", "/left/rail/file", ""),
    ("left wheel ", "/left/wheel/profile", ""),
    ("left wheel ", "/left/wheel/file", ""),
    ("right rail ", "/right/rail/profile", ""),
    ("right rail ", "/right/rail/file", ""),
    ("right wheel ", "/right/wheel/profile", ""),
    ("right wheel ", "/right/wheel/file", ""),
    ("gauge ", "/track/gauge", " mm"),
];

/// The one position of a run.
const POSITION: [PageValue; 4] = [
    ("lateral ", "/wheelset/lateral", " mm"),
    ("offset ", "/contact/offset", " mm"),
    ("yaw ", "/wheelset/yaw", " rad"),
    ("yaw ", "/contact/yaw", " rad"),
];

/// Names profiles, inclination, radius and gauge of a scene, as far as it gives them.
pub(crate) fn about_bodies(scene: &serde_json::Value) -> String {
    about(scene, &BODIES)
}

/// Puts parts of a scene into words, as far as it gives them.
fn about(scene: &serde_json::Value, parts: &[PageValue]) -> String {
    let said = |(word, key, unit): &PageValue| {
        let value = match scene.pointer(key)? {
            serde_json::Value::Null => return None,
            serde_json::Value::String(text) => text.clone(),
            serde_json::Value::Array(_) => "drawn in the scene".into(),
            number => number.to_string(),
        };
        Some(format!("{word}{}{unit}", with_minus(&value)))
    };
    parts.iter().filter_map(said).collect::<Vec<_>>().join(", ")
}

/// Says what the page's numbers are, and what it leaves out.
fn notes(run: &Run, n: usize) -> Vec<String> {
    let mut notes = vec![format!(
        "Numbers of this page are in single precision, on a grid of {n} × {n} points of its own; gaps and boundaries of other δ are \
         interpolated linearly. The exact ones are in the files beside it."
    )];
    if run.parts.len() > MOST_SHOWN {
        notes.push(format!("The page shows the first {MOST_SHOWN} of {} contacts.", run.parts.len()));
    }
    if run.case.profiles.varying().next().is_some() {
        notes.push(
            "Rails that vary along the track, and wheels that vary around their axle, are drawn in space as if one section went on; \
             separations are those of their surface."
                .into(),
        );
    }
    if run.parts.iter().any(|part| part.analysis.conformal.is_some()) {
        notes.push(
            "The gap t is that along the rail's turning normal, over the same ξ and η as s: δ closes t by δ cos α. Areas of its \
             patch are those on the rail's surface. The δ of a load, and pressures, are those of s."
                .into(),
        );
    }
    if run.parts.len() > 1 {
        notes.push("Dashed regions in the colour of the boundary belong to a neighbouring contact.".into());
    }
    if run.parts.iter().any(|part| part.site.side() == Some(TrackSide::Left)) {
        notes.push("The left side is shown as its mirror image: x to the left, y forward, z up.".into());
    }
    notes
}

fn contact(run: &Run, part: &Part, n: usize) -> ViewContact {
    let (placement, patch) = (&part.site.contact.placement, part.analysis.patch.as_ref());
    let window = window(part);
    let [xi, eta] = [window.xi, window.eta].map(|range| through_zero(range, n));
    let axis = EtaAxis::new(&eta);
    let question = &run.case.question;
    let mut plan = plan(placement, &xi, &axis, question.tolerance, question.method);
    let mut separation = vec![0.0; n * n];
    plan.fill(placement, &xi, &axis, &mut separation);
    let mut below = Evaluator::new(placement);
    let both = run.case.profiles.left.is_some() && part.site.side() == Some(TrackSide::Left);
    let mut warnings = part.refusals();
    warnings.extend_from_slice(&part.warnings);
    ViewContact {
        name: contact_name(part),
        pair: usize::from(both),
        frames: [placement.rail(), placement.wheel()].map(|body| PageFrame::from(&body.contact_frame())),
        skew: placement.skew(),
        approach: part.site.contact.approach.filter(|approach| *approach > 0.0),
        area: patch.map(Patch::area),
        rail_height: xi.iter().map(|&xi| below.lower_height(xi, 0.0)).collect(),
        separation: separation.to_vec(),
        boundary: patch.map_or_else(Vec::new, |patch| boundary(patch, |point| point)),
        conformal: conformal(part, &xi, &axis, question.tolerance),
        pressed: pressed(part),
        pressure: pressure(part),
        facts: facts(part),
        warnings,
        xi,
        eta: axis.eta,
    }
}

/// Gives the window of a page's grid: the patch under three times the approach, as far as it is around the patch itself.
fn window(part: &Part) -> Window {
    let placement = &part.site.contact.placement;
    let patch = part.analysis.patch.as_ref();
    let Some((patch, inner)) = patch.and_then(|patch| Some((patch, patch.extent()?))) else {
        let Window { xi, eta } = part.site.window();
        return Window { xi: with_extent(xi), eta: with_extent(eta) };
    };
    let inner = conformal_box(part).map_or(inner, |on_rail| inner.hull(on_rail));
    let largest = (SHOWN * patch.approach).min(f64::MAX);
    let wide = Patch::new(placement, largest, &Window::UNBOUNDED);
    let boxes = wide.components.iter().map(Component::extent);
    let outer = boxes.filter(|part| inner.meets(part)).fold(inner, Window::hull);
    let shown = |inner: Interval, outer: Interval| {
        let shown = outer.cut(inner.grown(WIDEST * inner.width()));
        with_extent(shown.grown(MARGIN * shown.width()))
    };
    Window { xi: shown(inner.xi, outer.xi), eta: shown(inner.eta, outer.eta) }
}

/// Gives the box of ξ and η around the patch on the rail's surface; `None` where there is none.
fn conformal_box(part: &Part) -> Option<Window> {
    let Window { xi: sigma, eta } = part.analysis.conformal.as_ref()?.patch.as_ref()?.extent()?;
    let rail = RailArcLength::new(&part.site.contact.placement);
    let xi = sigma.map(|sigma| on_plane(&rail, [sigma, 0.0])[0]);
    (xi.has_width()).then_some(Window { xi, eta })
}

/// Widens an interval that has no length.
fn with_extent(range: Interval) -> Interval {
    if range.has_width() { range } else { range.grown(LEAST_HALF) }
}

/// Gives n ≥ 2 values in equal steps over an interval. The interval moves by less than a step, so that 0, where C lies, is
/// one of the values if it is between them.
fn through_zero(range: Interval, n: usize) -> Vec<f64> {
    let step = range.width() / (n - 1) as f64;
    let before = (-range.low / step).round();
    if before < 0.0 || before >= n as f64 {
        return equal_steps(range.low, range.high, n);
    }
    (0..n).map(|k| (k as f64 - before) * step).collect()
}

/// Gives the gap along the rail's turning normal at the points of a page's grid; `None` for a run over the tangent plane.
fn conformal(part: &Part, xi: &[f64], axis: &EtaAxis, tolerance: f64) -> Option<PageConformal> {
    let patch = part.analysis.conformal.as_ref()?.patch.as_ref();
    let normal_gap = NormalGap::new(&part.site.contact.placement);
    let rail = normal_gap.rail();
    let sigma: Vec<f64> = xi.iter().map(|&xi| rail.sigma(xi)).collect();
    let mut gap = vec![0.0; xi.len() * axis.eta.len()];
    fill_normal_gap(&normal_gap, &sigma, axis, tolerance, &mut gap);
    Some(PageConformal {
        gap: gap.to_vec(),
        cosine: sigma.iter().map(|&sigma| rail.point(sigma).map_or(f64::NAN, |at| at.cos)).collect(),
        sigma,
        boundary: patch.map_or_else(Vec::new, |patch| boundary(patch, |point| on_plane(rail, point))),
        area: patch.map(Patch::area),
    })
}

/// Gives ξ, η of σ, η on the rail's surface.
fn on_plane(rail: &RailArcLength<'_>, [sigma, eta]: [f64; 2]) -> [f64; 2] {
    [rail.point(sigma).map_or(f64::NAN, |at| at.xi), eta]
}

/// Gives the loops around a patch, thinned, with every point moved by `placed`.
fn boundary(patch: &Patch, placed: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<PageLoop> {
    let loops = || patch.components.iter().flat_map(|c| [&c.boundary].into_iter().chain(&c.holes));
    let all: usize = loops().map(Vec::len).sum();
    let kept = |points: &Vec<[f64; 2]>| {
        // At least a triangle of every loop is left.
        let most = (points.len() * BOUNDARY_POINTS / all.max(1)).clamp(3, points.len().max(3));
        PageLoop(thinned(points, most).into_iter().flat_map(&placed).collect())
    };
    loops().map(kept).collect()
}

/// Gives the edges of the true contact.
fn pressed(part: &Part) -> Vec<PageLoop> {
    let outline = part.analysis.pressure.as_ref().map_or(&[][..], |found| &found.outline);
    outline.iter().map(|line| PageLoop(line.iter().flatten().copied().collect())).collect()
}

/// Gives the pressures over the grid, on the page's few points where it has more.
fn pressure(part: &Part) -> Option<PagePressure> {
    let (grid, field) = (&part.site.grid, part.analysis.pressure.as_ref()?.field.as_ref()?);
    let every = |count: usize| count.div_ceil(POINTS);
    let [along, across] = [every(grid.xi.len()), every(grid.eta.len())];
    let thin = |axis: &[f64], every: usize| axis.iter().step_by(every).copied().collect();
    let columns = field.chunks_exact(grid.eta.len()).step_by(along);
    Some(PagePressure {
        xi: thin(&grid.xi, along),
        eta: thin(&grid.eta, across),
        values: columns.flat_map(|column| column.iter().step_by(across).copied()).collect(),
    })
}

/// Gives the facts of a contact as rows of label and text.
fn facts(part: &Part) -> Vec<[String; 2]> {
    let row = |fact: &Fact| {
        let value = format!("{} {}", fact.text(part)?, fact.unit);
        Some([fact.label.into(), with_minus(value.trim_end())])
    };
    FACTS.iter().filter_map(row).collect()
}

/// Writes a minus sign before negative numbers instead of a hyphen; hyphens of words stay.
pub(super) fn with_minus(text: &str) -> String {
    let mut before = ' ';
    let mark = |(at, c): (usize, char)| {
        let number = c == '-' && text[at + 1..].starts_with(|next: char| next.is_ascii_digit());
        let word = before.is_alphabetic() && before != 'e';
        before = c;
        if number && !word { '\u{2212}' } else { c }
    };
    text.char_indices().map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_get_a_minus_sign_and_words_keep_their_hyphens() {
        assert_eq!(with_minus("(-12.5, 0.1) mm"), "(\u{2212}12.5, 0.1) mm");
        assert_eq!(with_minus("report-newton, ± 6e-15 mm"), "report-newton, ± 6e\u{2212}15 mm");
        assert_eq!(with_minus("half-space"), "half-space");
    }

    #[test]
    fn axes_of_a_page_pass_through_c_where_it_is_inside() {
        let around = through_zero(Interval::new(-1.0, 2.1), 32);
        assert!(around.len() == 32 && around.contains(&0.0), "{around:?}");
        assert!((around[0] + 1.0).abs() < 0.1 && (around[31] - 2.1).abs() < 0.1, "{around:?}");
        assert_eq!(through_zero(Interval::new(3.0, 4.0), 3), [3.0, 3.5, 4.0]);
    }
}
