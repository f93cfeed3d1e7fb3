//! Writes `table.wrp`: a contact table in the fixed columns of the other decks; [`crate::docs::tables`] has the grammar.

use super::super::model::plain;
use super::text::line;
use crate::numerics::interval::Interval;
use crate::table::{COEFFICIENTS, ContactTable, Lacks, PlanePart, TOLERANCE_LENGTH, YAW_COEFFICIENTS};

/// Writes `table.wrp`; `title` is that of its scene.
pub fn table_wrp(table: &ContactTable, title: &str) -> String {
    let (comments, about) = (comments(table, title), table.about());
    let (cells, quantities, over_yaw) = (table.cells(), table.quantities(), about.over_yaw());
    let version = if over_yaw { 2 } else { 1 };
    let mut text = format!("{:<8}{version:>4} {:<8}\n{:>8}\n", "WRTABLE", "mm", comments.len());
    comments.iter().for_each(|comment| text += &format!("# {comment}\n"));
    text += &format!("{:>8}{:>8}{:>8}", cells.len(), quantities.len(), COEFFICIENTS);
    if over_yaw {
        text += &format!("{:>8}{:>8}{:>8}\n", YAW_COEFFICIENTS, table.curves().len(), table.forks().len());
        text += &line(&about.lateral.ends());
        text += &line(&about.yaw.ends());
        text += &line(&[about.radius, about.tolerance, about.beside_curves()]);
    } else {
        text += "\n";
        text += &line(&about.lateral.ends());
        text += &line(&[about.yaw.low, about.radius, about.tolerance]);
    }
    for quantity in quantities {
        text += &format!("{:<18}{:>2} {:<8}", quantity.name, quantity.needs.code(), quantity.side());
        text += &line(&[quantity.tolerance, quantity.error]);
    }
    if over_yaw {
        put_tree(&mut text, table);
    }
    for (c, cell) in cells.iter().enumerate() {
        let [left, right] = cell.lacks.map(Lacks::code);
        text += &format!("{:>2}{:>2}{left:>2}{right:>2}", u8::from(cell.touches), table.begins(c).code());
        if over_yaw {
            let [begin, end] = cell.curves.map(|curve| curve + 1);
            text += &format!("{begin:>8}{end:>8}");
            text += &line(&cell.yaw.ends());
        } else {
            text += &line(&table.ends(c, about.yaw.low).ends());
        }
        if !cell.touches {
            continue;
        }
        for q in 0..quantities.len() {
            for j in 0..about.yaw_coefficients() {
                let coefficients = table.coefficients(c, q, j).map(|c| if c.is_nan() { 0.0 } else { c });
                coefficients.chunks_exact(3).for_each(|three| text += &line(three));
            }
        }
    }
    text + "END\n"
}

/// Writes the curves and forks of a table over yaw.
fn put_tree(text: &mut String, table: &ContactTable) {
    for curve in table.curves() {
        *text += &format!("{:>8}", curve.kind.code());
        *text += &line(&curve.yaw.ends());
        curve.coefficients.chunks(3).for_each(|three| *text += &line(three));
    }
    for fork in table.forks() {
        for part in fork.parts {
            let code = match part {
                PlanePart::Fork(fork) => (fork + 1).to_string(),
                PlanePart::Cell(cell) => format!("-{}", cell + 1),
            };
            *text += &format!("{code:>8}");
        }
        *text += &format!("{:>8}", fork.curve.map_or(0, |curve| curve + 1));
        *text += &line(&[fork.yaw]);
    }
}

/// Returns the comment lines, which explain the file.
fn comments(table: &ContactTable, title: &str) -> Vec<String> {
    let about = table.about();
    let under = if about.over_yaw() { " under some yaws" } else { "" };
    let off = |off: Interval| format!("off the rail, without values{under}: {} to {}", off.low, off.high);
    let off = table.off_rail_somewhere().into_iter().map(off);
    let before = [
        format!("title: {title}"),
        format!("written by wheelrail {}: contact of a wheelset over y", env!("CARGO_PKG_VERSION")),
        "y: lateral displacement of the axle's middle, mm, + to the right".into(),
        "lengths mm, angles rad, curvatures 1/mm, pressures N/mm2; x and angles in".into(),
        "the profile axes of each side, x towards its field side".into(),
        "separation s = a_xi xi^2 + c_xi_eta xi eta + b_eta eta^2 at the contact".into(),
        "hertz_*: Hertz's ellipse of the lowest place alone under the scene's load".into(),
    ];
    let behind = [
        "off its rail and no coefficients follow; a quantity exists where its needs".into(),
        "(0 contact 1 curvatures 2 ellipse) + lacks of its side are at most 2".into(),
        format!(
            "largest_error: twice the largest difference from direct searches; {:e} mm",
            about.beside_curves()
        ),
        "around hops and joints are left out".into(),
        format!("tolerance: angles over the nominal radius, curvatures over ({TOLERANCE_LENGTH} mm)^2,"),
        format!("approach x {TOLERANCE_LENGTH} mm / radius, pressures x 1000 N/mm2 / {TOLERANCE_LENGTH} mm"),
    ];
    let grammar: &[&str] = if about.over_yaw() { &OVER_YAW } else { &UNDER_ONE_YAW };
    debug_assert!(table.quantities().iter().all(|quantity| quantity.name.len() <= 18));
    let grammar = grammar.iter().map(|line| (*line).to_string());
    before.into_iter().chain(grammar).chain(behind).chain(off).map(|line| plain(&line)).collect()
}

/// The grammar of a table under one yaw.
const UNDER_ONE_YAW: [&str; 8] = [
    "head: n_cells n_quantities n_coefficients (3i8); from to (2e25.16);",
    "yaw, nominal radius, tolerance of lengths (3e25.16)",
    "quantity (a18,i2,1x,a8,2e25.16): name needs side tolerance largest_error",
    "cell (4i2,2e25.16): touches begins lacks_left lacks_right from to,",
    "then for each quantity c0..c8 (3e25.16): value = sum of c_k t^k with",
    "t = (2 y - from - to) / (to - from)",
    "begins: 0 smoothly 1 at a joint 2 at a hop 3 at an edge",
    "touches = 0: a wheel is",
];

/// The grammar of a table over yaw.
const OVER_YAW: [&str; 16] = [
    "head: n_cells n_quantities 9 5 n_curves n_forks (6i8); from to (2e25.16);",
    "yaw_from yaw_to, rad (2e25.16); radius, tolerance, beside_curves (3e25.16)",
    "quantity (a18,i2,1x,a8,2e25.16): name needs side tolerance largest_error",
    "curve (i8,2e25.16): kind yaw_from yaw_to, then c0..c4 (3e25.16):",
    "y = sum of c_j u^j with u = (2 yaw - yaw_from - yaw_to)/(yaw_to - yaw_from)",
    "fork (3i8,e25.16): below above curve yaw. Begin at fork 1; go below where",
    "y < curve, or yaw < yaw if curve = 0; otherwise above; n > 0 is fork n,",
    "n < 0 is cell -n. Without forks the table is cell 1",
    "cell (4i2,2i8,2e25.16): touches begins lacks_left lacks_right curve_from",
    "curve_to yaw_from yaw_to, then for each quantity and j = 0..4 c_j0..c_j8",
    "(3e25.16): value = sum of c_jk u^j t^k with u of the cell's yaws (0 if they",
    "are equal), t = (2 y - from - to) / (to - from) between its curves at this",
    "yaw, in -1 to 1 (0 if to <= from)",
    "kind, begins: 0 smoothly 1 at a joint 2 at a hop 3 at an edge",
    "beside_curves: mm from curves within which values may be the other side's",
    "touches = 0: a wheel is",
];
