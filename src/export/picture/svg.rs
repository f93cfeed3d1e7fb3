//! A page as SVG: real text, two decimals, no style sheet.

use super::canvas::{Anchor, Canvas, Colour, Mark};
use std::fmt::Write;

/// The page as an SVG document.
pub(super) fn document(canvas: &Canvas) -> String {
    let [width, height] = canvas.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" fill=\"none\" \
         stroke-linejoin=\"round\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    canvas.marks.iter().for_each(|mark| put(&mut svg, mark));
    svg + "</svg>\n"
}

/// Writing to a String cannot fail, which is why the results are dropped here.
fn put(svg: &mut String, mark: &Mark) {
    match mark {
        Mark::Lines { lines, pen } => {
            let dash = pen.dash.map(|[a, b]| format!(" stroke-dasharray=\"{a} {b}\"")).unwrap_or_default();
            let (colour, width) = (hex(pen.colour), pen.width);
            let path = path(lines, "");
            let _ = writeln!(svg, "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash}/>");
        }
        Mark::Area { rings, colour } => {
            let path = path(rings, "Z");
            let _ = writeln!(svg, "<path d=\"{path}\" fill=\"{}\" fill-rule=\"evenodd\"/>", hex(*colour));
        }
        Mark::Text { at: [x, y], text, size, anchor, colour, upright } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn =
                if *upright { format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"") } else { String::new() };
            let _ = writeln!(
                svg,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                 fill=\"{}\"{turn}>{}</text>",
                hex(*colour),
                escape(text)
            );
        }
    }
}

fn path(lines: &[Vec<[f64; 2]>], close: &str) -> String {
    let mut data = String::new();
    for line in lines {
        for (k, [x, y]) in line.iter().enumerate() {
            let _ = write!(data, "{}{x:.2} {y:.2}", if k == 0 { "M" } else { "L" });
        }
        data += close;
    }
    data
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Text as XML takes it; characters that XML does not know are dropped.
fn escape(text: &str) -> String {
    // XML has no control characters, nor these two.
    let text: String = text.chars().filter(|c| !c.is_control() && !"\u{fffe}\u{ffff}".contains(*c)).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
