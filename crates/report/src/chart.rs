//! Log–log charts as SVG, without fonts or libraries.

use std::fmt::Write;

/// Size of the picture and its plotting area \[px\].
const SIZE: [f64; 2] = [760.0, 460.0];
const AREA: [[f64; 2]; 2] = [[78.0, 560.0], [44.0, 400.0]];

/// Radius of a mark \[px\].
const MARK: f64 = 4.0;

/// One set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Single values (x, y), drawn faintly.
    pub marks: Vec<[f64; 2]>,
    /// Main values (x, y), drawn strongly and joined.
    pub line: Vec<[f64; 2]>,
}

/// A chart with logarithmic axes. Values that are not positive and finite are drawn at the lower edge of the axis,
/// or not at all where they are NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// Title and unit of both axes.
    pub labels: [String; 2],
    /// What is drawn; as many as there are [`COLOURS`].
    pub series: Vec<Series>,
    /// A vertical line and its name.
    pub limit: Option<(f64, String)>,
}

/// Okabe and Ito's palette, told apart by colour-blind readers too.
pub const COLOURS: [&str; 7] = ["#E69F00", "#56B4E9", "#009E73", "#D55E00", "#0072B2", "#CC79A7", "#000000"];

/// Decades of one axis.
#[derive(Debug, Clone, Copy)]
struct Axis {
    decades: [i32; 2],
    pixels: [f64; 2],
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let logs: Vec<f64> = values.filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10).collect();
        let low = logs.iter().copied().fold(f64::INFINITY, f64::min);
        let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let decades = if low <= high { [low.floor() as i32, high.ceil() as i32] } else { [0, 1] };
        let last = if decades[0] == decades[1] { decades[1] + 1 } else { decades[1] };
        Self { decades: [decades[0], last], pixels }
    }

    fn at(&self, value: f64) -> f64 {
        let [low, high] = self.decades.map(f64::from);
        let log = if value > 0.0 { value.log10().clamp(low, high) } else { low };
        self.pixels[0] + (log - low) / (high - low) * (self.pixels[1] - self.pixels[0])
    }

    /// Powers of ten to label, at most about ten.
    fn ticks(&self) -> impl Iterator<Item = i32> + use<> {
        let [low, high] = self.decades;
        let step = ((high - low) / 10 + 1) as usize;
        (low..=high).step_by(step)
    }
}

/// The chart as an SVG document.
pub fn svg(chart: &Chart) -> String {
    let all = || chart.series.iter().flat_map(|s| s.marks.iter().chain(&s.line));
    let limit = chart.limit.as_ref().map(|(value, _)| *value);
    let x = Axis::over(all().map(|p| p[0]).chain(limit), AREA[0]);
    let y = Axis::over(all().map(|p| p[1]), [AREA[1][1], AREA[1][0]]);
    let mut out = String::new();
    let [width, height] = SIZE;
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"sans-serif\" font-size=\"12\">"
    );
    let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
    text(&mut out, [AREA[0][0], 24.0], "start", &format!("<tspan font-size=\"15\">{}</tspan>", chart.title));
    axes(&mut out, chart, &x, &y);
    if let Some((value, name)) = &chart.limit {
        let px = x.at(*value);
        let [top, bottom] = AREA[1];
        let _ = writeln!(
            out,
            "<path d=\"M{px:.1} {top}V{bottom}\" stroke=\"#000000\" stroke-dasharray=\"4 4\"/>"
        );
        text(&mut out, [px - 4.0, top + 12.0], "end", name);
    }
    for (k, series) in chart.series.iter().enumerate() {
        draw(&mut out, series, k, &x, &y);
    }
    out += "</svg>\n";
    out
}

fn axes(out: &mut String, chart: &Chart, x: &Axis, y: &Axis) {
    let [[left, right], [top, bottom]] = AREA;
    for power in x.ticks() {
        let px = x.at(10f64.powi(power));
        let _ = writeln!(out, "<path d=\"M{px:.1} {top}V{bottom}\" stroke=\"#dddddd\"/>");
        text(out, [px, bottom + 18.0], "middle", &power_of_ten(power));
    }
    for power in y.ticks() {
        let py = y.at(10f64.powi(power));
        let _ = writeln!(out, "<path d=\"M{left} {py:.1}H{right}\" stroke=\"#dddddd\"/>");
        text(out, [left - 8.0, py + 4.0], "end", &power_of_ten(power));
    }
    text(out, [f64::midpoint(left, right), bottom + 42.0], "middle", &chart.labels[0]);
    let middle = f64::midpoint(top, bottom);
    let _ = writeln!(
        out,
        "<text x=\"20\" y=\"{middle}\" text-anchor=\"middle\" transform=\"rotate(-90 20 {middle})\">{}</text>",
        chart.labels[1]
    );
}

fn draw(out: &mut String, series: &Series, k: usize, x: &Axis, y: &Axis) {
    let colour = COLOURS[k % COLOURS.len()];
    let place = |p: &&[f64; 2]| !p[0].is_nan() && !p[1].is_nan();
    let at = |p: &[f64; 2]| [x.at(p[0]), y.at(p[1])];
    for p in series.marks.iter().filter(place) {
        mark(out, at(p), k, colour, 0.3, 0.7 * MARK);
    }
    let line: Vec<[f64; 2]> = series.line.iter().filter(place).map(at).collect();
    let points: Vec<String> = line.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    if points.len() > 1 {
        let points = points.join(" ");
        let _ = writeln!(
            out,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>"
        );
    }
    for p in line {
        mark(out, p, k, colour, 1.0, 1.3 * MARK);
    }
    let row = AREA[1][0] + 14.0 + 22.0 * k as f64;
    mark(out, [AREA[0][1] + 24.0, row], k, colour, 1.0, 1.3 * MARK);
    text(out, [AREA[0][1] + 38.0, row + 4.0], "start", &series.name);
}

/// A mark whose shape tells the series too.
fn mark(out: &mut String, [x, y]: [f64; 2], k: usize, colour: &str, opacity: f64, r: f64) {
    let style = format!("fill=\"{colour}\" fill-opacity=\"{opacity}\"");
    let polygon = |sides: usize, turn: f64| {
        let corners = (0..sides).map(|j| {
            let angle = turn + std::f64::consts::TAU * j as f64 / sides as f64;
            format!("{:.1},{:.1}", x + 1.2 * r * angle.sin(), y - 1.2 * r * angle.cos())
        });
        format!("<polygon points=\"{}\" {style}/>", corners.collect::<Vec<_>>().join(" "))
    };
    let shape = match k % 4 {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r:.1}\" {style}/>"),
        1 => polygon(4, std::f64::consts::FRAC_PI_4),
        2 => polygon(3, 0.0),
        _ => polygon(4, 0.0),
    };
    let _ = writeln!(out, "{shape}");
}

fn text(out: &mut String, [x, y]: [f64; 2], anchor: &str, content: &str) {
    let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{content}</text>");
}

/// "10⁻¹²".
fn power_of_ten(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    format!("10{}", power.to_string().chars().map(digit).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_its_place_and_zero_the_lowest() {
        let axis = Axis::over([1e-3, 50.0, 0.0].into_iter(), [0.0, 100.0]);
        assert_eq!(axis.decades, [-3, 2]);
        assert!((axis.at(0.1) - 40.0).abs() < 1e-9);
        assert_eq!(axis.at(0.0), 0.0);
        assert_eq!(power_of_ten(-12), "10⁻¹²");
    }

    #[test]
    fn a_chart_of_nothing_is_still_a_picture() {
        let labels = ["x".to_string(), "y".to_string()];
        let series = vec![Series { name: "none".into(), marks: vec![[f64::NAN; 2]], line: Vec::new() }];
        let picture = svg(&Chart { title: "empty".into(), labels, series, limit: None });
        assert!(picture.ends_with("</svg>\n") && !picture.contains("NaN"), "{picture}");
    }
}
