//! Builds the page of the report: a list of sections, each made by one function, and the files beside it.

mod conformal;
mod in_use;
mod section;

pub use conformal::conforming_table;
pub use section::PageSection;

use super::hard_run::HardOutcome;
use super::measured;
use super::measurements::{AccuracyRow, Growth, Measurements, PASSES, median};
use super::requirements;
use super::spline_cost::SplineCost;
use super::table::{accuracy_csv, growth_csv, hard_cases_csv, markdown, verification_csv};
use super::verification::{Verified, floors};
use wheelrail::export::{Chart, Series};
use wheelrail::internal::nan_max;
use wheelrail_check::{RELATION, Report};

/// Where, with what and how the numbers were made, as (name, value) for the head of the page.
pub type PageOrigin = Vec<(&'static str, String)>;

/// Name of the page's own file.
pub const PAGE: &str = "report.md";

/// Names of all files of a report.
pub const FILES: [&str; 12] = [
    PAGE,
    "accuracy.csv",
    "positions.csv",
    "cases.csv",
    "hard_cases.csv",
    "practice.csv",
    "normal_gap.csv",
    "verification.csv",
    "scaling.csv",
    "scaling.svg",
    "work_error_small.svg",
    "work_error_large.svg",
];

/// Returns the sections of the report, in order.
pub fn sections(m: &Measurements) -> Vec<PageSection> {
    vec![
        requirements_section(m),
        speed_and_error(m),
        scenes(m),
        growth(m),
        threads(m),
        in_use::positions(m),
        in_use::cases(m),
        hard_cases(m),
        in_use::practice(m),
        in_use::loads(m),
        conformal::normal_gap(m),
        verification(m),
        measured_profiles(m),
        method(m),
    ]
}

/// Returns the page: head, origin, sections.
pub fn page(origin: &PageOrigin, sections: &[PageSection]) -> String {
    let mut out = String::from("# wheelrail: speed against error\n\n");
    let rows: Vec<Vec<String>> =
        origin.iter().map(|(name, value)| vec![(*name).into(), value.clone()]).collect();
    out += &markdown(&["made", "by"], 2, &rows);
    for section in sections {
        out += &format!("\n## {}\n\n{}", section.title, section.body);
    }
    out
}

/// Returns the table for a README, with the command that made it.
pub fn excerpt(m: &Measurements, origin: &PageOrigin) -> String {
    let value = |name: &str| origin.iter().find(|(n, _)| *n == name).map_or("unknown", |(_, v)| v.as_str());
    format!(
        "{}\nErrors over all reference scenes against 60-digit values, relative ones over all points but C itself: beyond the \
         contact segments only absolute digits are promised.\n\n{}\n{}\n{}\n{}\n{}\n{}\nWhat is asked for, and what was \
         found:\n\n{}\nMade by `{}` on {}; {}. One thread, but for whole processes.\n",
        summary(m),
        in_use::rate_table(m),
        in_use::rate_note(m),
        in_use::case_table(m),
        in_use::case_note(m),
        in_use::cost_table(&m.load_costs),
        in_use::COST_NOTE,
        requirements_table(m),
        value("command"),
        value("processor"),
        value("compiler"),
    )
}

fn plain(title: &'static str, body: String) -> PageSection {
    PageSection { title, body, files: Vec::new() }
}

fn requirements_table(m: &Measurements) -> String {
    let rows: Vec<Vec<String>> = requirements::all(m)
        .into_iter()
        .map(|r| vec![r.what, r.least, r.found, r.remark, if r.met { "pass" } else { "**miss**" }.into()])
        .collect();
    markdown(&["requirement", "asked for", "found", "where", "verdict"], 5, &rows)
}

fn requirements_section(m: &Measurements) -> PageSection {
    let table = requirements_table(m);
    plain("What is asked for", format!("Best times within one run, spectral at 1e-12 mm.\n\n{table}"))
}

/// Returns (method, tolerance) in the order of the rows.
fn kinds(m: &Measurements) -> Vec<(&'static str, Option<f64>)> {
    let mut all = Vec::new();
    for row in &m.rows {
        if !all.contains(&(row.method, row.tolerance)) {
            all.push((row.method, row.tolerance));
        }
    }
    all
}

fn sides(m: &Measurements) -> Vec<usize> {
    let mut sides: Vec<usize> = m.rows.iter().map(|row| row.side).collect();
    sides.sort_unstable();
    sides.dedup();
    sides
}

fn of<'m>(
    m: &'m Measurements,
    kind: (&str, Option<f64>),
    side: usize,
) -> impl Iterator<Item = &'m AccuracyRow> {
    m.rows.iter().filter(move |row| (row.method, row.tolerance, row.side) == (kind.0, kind.1, side))
}

/// Returns the table of rates, ratios and worst errors, method by method.
fn summary(m: &Measurements) -> String {
    let sides = sides(m);
    let last = sides.last().copied().unwrap_or(0);
    let mut head = vec!["method".to_string(), "tolerance, mm".into()];
    head.extend(sides.iter().map(|side| format!("Mpoints/s at {side}²")));
    head.extend(["× store".into(), "× report-newton".into(), "largest error, mm".into()]);
    head.extend(["median scene's, mm".into(), "largest relative error".into()]);
    let rows: Vec<Vec<String>> = kinds(m)
        .into_iter()
        .map(|kind| {
            let mut cells = vec![kind.0.to_string(), kind.1.map_or_else(|| "–".into(), |t| format!("{t:e}"))];
            cells.extend(
                sides.iter().map(|&side| format!("{:.0}", median(of(m, kind, side).map(AccuracyRow::rate)))),
            );
            for other in ["store", "report-newton"] {
                cells.push(format!(
                    "{:.2}",
                    median(requirements::ratios(m, kind, other, last).map(|(_, r)| r))
                ));
            }
            let errors = || of(m, kind, last).filter_map(|row| row.errors);
            if errors().next().is_none() {
                cells.extend(["–", "–", "–"].map(String::from));
                return cells;
            }
            cells.push(format!("{:.1e}", errors().map(|e| e.max_abs).fold(0.0, nan_max)));
            cells.push(format!("{:.1e}", median(errors().map(|e| e.max_abs))));
            cells.push(format!("{:.1e}", errors().map(|e| e.max_rel).fold(0.0, nan_max)));
            cells
        })
        .collect();
    markdown(&head.iter().map(String::as_str).collect::<Vec<_>>(), 2, &rows)
}

fn speed_and_error(m: &Measurements) -> PageSection {
    let mut body = format!(
        "Median over the reference scenes; one thread; ratios at the largest grid.\n\n{}\n\
         All rows: [accuracy.csv](accuracy.csv).\n",
        summary(m)
    );
    let mut files = vec![("accuracy.csv", accuracy_csv(&m.rows).into_bytes())];
    for (side, name) in sides(m).into_iter().zip(["work_error_small.svg", "work_error_large.svg"]) {
        body += &format!("\n![error against speed, {side} × {side} points]({name})\n");
        files.push((name, work_error(m, side).svg().into_bytes()));
    }
    PageSection { title: "Speed against error", body, files }
}

/// Returns the chart of error over rate: a faint mark for each scene, strong ones for the medians, with the
/// tolerances joined.
fn work_error(m: &Measurements, side: usize) -> Chart {
    let mut series: Vec<Series> = Vec::new();
    for kind in kinds(m).into_iter().filter(|(name, _)| *name != "store") {
        let points = || of(m, kind, side).filter_map(|row| Some([row.rate(), row.errors?.max_abs]));
        let middle = [0, 1].map(|k| median(points().map(|p| p[k])));
        if series.last().is_none_or(|last| last.name != kind.0) {
            series.push(Series { name: kind.0.into(), marks: Vec::new(), line: Vec::new() });
        }
        if let Some(last) = series.last_mut() {
            last.marks.extend(points());
            last.line.push(middle);
        }
    }
    let store = median(of(m, ("store", None), side).map(AccuracyRow::rate));
    Chart {
        title: format!("Largest error of s over speed, {side} × {side} points, one thread"),
        labels: ["Mpoints/s".into(), "largest error of s, mm".into()],
        series,
        limit: store.is_finite().then(|| (store, "plain store".into())),
    }
}

fn scenes(m: &Measurements) -> PageSection {
    let side = sides(m).last().copied().unwrap_or(0);
    let full = Some(wheelrail::separation::FULL_PRECISION);
    let kinds = [("store", None), ("spectral", full), ("pointwise", None), ("report-newton", full)];
    let mut names: Vec<&str> = m.rows.iter().map(|row| row.scene.as_str()).collect();
    names.dedup();
    names.sort_unstable();
    names.dedup();
    let rows: Vec<Vec<String>> = names
        .into_iter()
        .map(|scene| {
            let row = |kind| of(m, kind, side).find(|row| row.scene == scene);
            let mut cells = vec![scene.to_string()];
            cells.extend(
                kinds.iter().map(|&kind| row(kind).map_or("–".into(), |r| format!("{:.0}", r.rate()))),
            );
            cells.extend(kinds[1..].iter().map(|&kind| {
                let errors = row(kind).and_then(|row| row.errors);
                errors.map_or("–".into(), |e| format!("{:.1e}", e.max_rel))
            }));
            cells
        })
        .collect();
    let head = [
        "scene",
        "store, Mpoints/s",
        "spectral",
        "pointwise",
        "report-newton",
        "spectral, relative error",
        "pointwise",
        "report-newton",
    ];
    let note = "Relative errors over all points but C itself; beyond the contact segments only absolute digits are \
                promised.";
    plain(
        "Scene by scene",
        format!("{side} × {side} points, full precision. {note}\n\n{}", markdown(&head, 1, &rows)),
    )
}

fn growth(m: &Measurements) -> PageSection {
    let rows: Vec<Vec<String>> = m
        .growth
        .iter()
        .map(|row| {
            let per_point = |seconds: f64| format!("{:.2}", seconds / row.points as f64 * 1e9);
            let seconds = format!("{:.3e}", row.spectral);
            vec![row.points.to_string(), seconds, per_point(row.spectral), per_point(row.store)]
        })
        .collect();
    let head = ["points", "spectral, s", "spectral, ns a point", "store, ns a point"];
    let body = format!(
        "Spectral columns at 1e-12 mm, one thread, square grids of one scene.\n\n{}\n\
         ![time over number of points](scaling.svg)\n\nAs numbers: [scaling.csv](scaling.csv).\n",
        markdown(&head, 0, &rows)
    );
    let files = vec![
        ("scaling.csv", growth_csv(&m.growth).into_bytes()),
        ("scaling.svg", growth_chart(&m.growth).svg().into_bytes()),
    ];
    PageSection { title: "Growth of cost", body, files }
}

fn growth_chart(rows: &[Growth]) -> Chart {
    let series = |name: &str, seconds: fn(&Growth) -> f64| Series {
        name: name.into(),
        marks: Vec::new(),
        line: rows.iter().map(|row| [row.points as f64, seconds(row)]).collect(),
    };
    Chart {
        title: "Time over number of points, one thread".into(),
        labels: ["points".into(), "s".into()],
        series: vec![series("spectral, 1e-12 mm", |r| r.spectral), series("plain store", |r| r.store)],
        limit: None,
    }
}

fn threads(m: &Measurements) -> PageSection {
    let rows: Vec<Vec<String>> = m
        .threads
        .iter()
        .map(|row| {
            let [one, two] = row.seconds;
            let bits = if row.same_bits { "yes" } else { "**no**" };
            let times = [one, two].map(|t| format!("{t:.3e}"));
            let [one_text, two_text] = times;
            vec![
                row.method.name().into(),
                row.points.to_string(),
                one_text,
                two_text,
                format!("{:.2}", one / two),
                bits.into(),
            ]
        })
        .collect();
    let head = ["method", "points", "1 thread, s", "2 threads, s", "ratio", "same bits"];
    plain("Threads", markdown(&head, 1, &rows))
}

fn hard_cases(m: &Measurements) -> PageSection {
    let rows: Vec<Vec<String>> = m.hard_cases.iter().map(hard_case).collect();
    let head = ["case", "status", "as stated", "spectral, mm", "pointwise, mm", "report-newton, mm", "why"];
    let body = format!(
        "Files of `crates/report/src/hard_cases`: largest error where there is a value, and in brackets the number of points \
         where there wrongly is one or none. The last column is about the Report's method.\n\n{}\n\
         All figures: [hard_cases.csv](hard_cases.csv).\n",
        markdown(&head, 7, &rows)
    );
    let files = vec![("hard_cases.csv", hard_cases_csv(&m.hard_cases).into_bytes())];
    PageSection { title: "Hard cases", body, files }
}

fn hard_case(outcome: &HardOutcome) -> Vec<String> {
    let case = &outcome.case;
    let errors = outcome.errors.map(|e| match e.wrongly_masked {
        0 => format!("{:.1e}", e.max_abs),
        n => format!("{:.1e} ({n})", e.max_abs),
    });
    let verdict = if outcome.as_stated() { "yes" } else { "**no**" };
    let mut cells = vec![case.title.clone(), case.status.name().into(), verdict.into()];
    cells.extend(errors);
    cells.push(case.report_newton.remark.replace('|', "\\|"));
    cells
}

fn measured_profiles(m: &Measurements) -> PageSection {
    let row = |cost: &SplineCost| {
        let [splines, arcs] = cost.seconds;
        let figures = [
            format!("{splines:.2e}"),
            format!("{arcs:.2e}"),
            format!("{:.2}", splines / arcs),
            format!("{:.2}", cost.nanoseconds()),
        ];
        [vec![format!("{0} × {0}", cost.side), cost.spacing.to_string()], figures.to_vec()].concat()
    };
    let rows: Vec<Vec<String>> = m.splines.iter().map(row).collect();
    let head =
        ["grid", "points every, mm", "splines, s", "arcs, s", "ratio", "splines with plan, ns a point"];
    plain(
        "Measured profiles",
        format!(
            "{}\nTime of a grid at 1e-12 mm over smoothed points of 60E1 and S1002, and over chains of arcs fitted to \
             them, one thread:\n\n{}",
            measured::section(&m.evidence),
            markdown(&head, 0, &rows)
        ),
    )
}

fn verification(m: &Measurements) -> PageSection {
    let floors: Vec<Vec<String>> = floors(m.verified.iter().flatten())
        .into_iter()
        .map(|floor| {
            let figures = [floor.ray_mm, floor.closest_mm, floor.normal];
            [vec![floor.form.to_string()], figures.map(|v| format!("{v:.1e}")).to_vec()].concat()
        })
        .collect();
    let floors = markdown(&["closed form", "rays, mm", "closest points, mm", "unit normals"], 1, &floors);
    let [scenes, pairs] = &m.verified;
    let rows =
        [agreement("reference scenes, with and without skew", scenes), agreement("built-in pairs", pairs)];
    let head = [
        "checked",
        "agree",
        "points",
        "s − rays, mm",
        "99 %",
        "median",
        "bracket of s, mm",
        "unit normals",
        "relation, mm",
        "order",
    ];
    let mut body = format!(
        "`wheelrail check`: both bodies as triangle meshes, measured by parry3d; no formula of the separation code is \
         on that path. The checker's own errors, measured first on closed forms of every scene's size, the largest:\n\n\
         {floors}\n\
         What the program says against what the meshes say: the largest difference of all, the worst scene's 99 % \
         quantile, the median scene's median; the widest rigorous bracket, in which every s lies; by how much the \
         closest distance d leaves its relation to s, {RELATION}; the median order of the meshes' convergence.\n\n{}\n\
         All rows: [verification.csv](verification.csv).\n",
        markdown(&head, 1, &rows)
    );
    for verified in m.verified.iter().flatten().filter(|v| !v.report.agrees) {
        body += &format!("\n**{}**: {}\n", verified.name, verified.report.objections.join("; "));
    }
    let files = vec![("verification.csv", verification_csv(&m.verified).into_bytes())];
    PageSection { title: "Checked by triangle meshes", body, files }
}

/// Returns one row: how many agree, and the figures of all of them together.
fn agreement(name: &str, all: &[Verified]) -> Vec<String> {
    let of = |figure: fn(&Report) -> f64| all.iter().map(move |v| figure(&v.report));
    let largest = |figure: fn(&Report) -> f64| format!("{:.1e}", of(figure).fold(0.0, f64::max));
    let agreeing = all.iter().filter(|v| v.report.agrees).count();
    vec![
        name.into(),
        format!("{agreeing} of {}", all.len()),
        all.iter().map(|v| v.report.counts.compared).sum::<usize>().to_string(),
        largest(|r| r.separation.max),
        largest(|r| r.separation.p99),
        format!("{:.1e}", median(of(|r| r.separation.median))),
        largest(|r| r.bracket_mm),
        largest(|r| r.normals.max),
        largest(|r| r.distances.violation.max),
        format!("{:.2}", median(of(|r| r.orders.median))),
    ]
}

fn method(m: &Measurements) -> PageSection {
    let [least, middle, most] = m.planning.map(|seconds| seconds * 1e6);
    let scenes = m.rows.iter().filter(|row| row.method == "store").count() / sides(m).len().max(1);
    plain(
        "How it was measured, and what favours whom",
        format!(
            "- Error: the method's values at the points of {scenes} reference scenes against `reference.py`'s \
             60-digit values, on grids that reach as far and have as many columns as the timed ones, so that spectral \
             columns are the same polynomials. There are 15 to 50 points a scene, so that a 99 % quantile is close to the largest. \
             Relative errors leave out C itself.\n\
             - Time: processor time of the one thread, which leaves out what other processes took but not what \
             they did to caches and memory, and below 1 ms the time on the wall; the shortest of at least three runs (of \
             one, where a run takes seconds). \
             Next is always the contestant that has had least time, so that a ratio's two sides met the same \
             disturbances; the races of all scenes are taken up {PASSES} times, since on a shared machine these come and go \
             within seconds. With two threads it is time on the wall, and means nothing on a busy machine (load above).\n\
             - `store` writes one value to the same array; like every method it finds the array's pages already \
             touched, which a program that fills a fresh array once does not. Arrays of up to some MB stay in cache. \
             Both favour the store most.\n\
             - Choosing method and degree is not in the times: {least:.0} µs at least, {middle:.0} µs in the middle, \
             {most:.0} µs at most per scene and grid, which counts on small grids. `[grid] method` skips no more than \
             part of it.\n\
             - η axes are symmetric: a spectral column is set up once for both halves, and evaluated once where its \
             values are a multiple of 8, as with 200 a side. `pointwise` and \
             `report-newton` do not use it, which favours the others by up to two.\n\
             - `report-newton` is the Report's iteration as printed, compiled by today's compiler; it looks its wheel \
             segment up at every iterate, from the last one found. Its tolerance is on the step.\n\
             - `quadratic`, `constant-radius` and `parabolic` have an error of model, not of arithmetic: over windows \
             smaller than the scenes' they are far better. The last two take no less time than spectral columns and \
             err more, so that `auto` passes them over.\n",
        ),
    )
}
