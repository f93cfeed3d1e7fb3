//! Draws a page of lines, areas and words as SVG: real text, two decimals, no style sheet.

use std::fmt::{Display, Write};

/// A colour as red, green, blue.
pub(super) type Colour = [u8; 3];

pub(super) const INK: Colour = [34, 34, 34];
pub(super) const GREY: Colour = [120, 120, 120];
pub(super) const INSIDE: Colour = [253, 232, 226];
pub(super) const WHITE: Colour = [255; 3];
pub(super) const BLUE: Colour = [31, 98, 168];
pub(super) const RED: Colour = [200, 30, 30];

/// The style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: Colour,
    /// Width \[page units\].
    pub(super) width: f64,
    /// Lengths of dash and gap \[page units\]; `None` for a solid line.
    pub(super) dash: Option<[f64; 2]>,
}

impl Pen {
    pub(super) const fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: None }
    }

    pub(super) const fn dashed(self, dash: [f64; 2]) -> Self {
        Self { dash: Some(dash), ..self }
    }
}

/// The style of words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Words {
    /// Size of the letters \[page units\].
    pub(super) size: f64,
    pub(super) colour: Colour,
    /// The part of the words that is at the given place: start, middle or end.
    anchor: &'static str,
}

impl Words {
    pub(super) const fn new(size: f64) -> Self {
        Self { size, colour: INK, anchor: "start" }
    }

    pub(super) const fn middle(self) -> Self {
        Self { anchor: "middle", ..self }
    }

    pub(super) const fn end(self) -> Self {
        Self { anchor: "end", ..self }
    }

    pub(super) const fn in_colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }
}

/// Style of ticks and legends.
pub(super) const SMALL: Words = Words::new(11.0);
/// Style of the names of axes.
pub(super) const BODY: Words = Words::new(12.0);
/// Style of headings.
const HEADING: Words = Words::new(13.0);
const TITLE: Words = Words::new(18.0);
const FOOT: Words = Words::new(9.0).in_colour(GREY).end();

/// Most characters of a title that fit onto the page.
const TITLE_FITS: usize = 80;
/// Most characters of any other line that fit onto the page.
const LINE_FITS: usize = 120;

/// Width of every page \[page units\].
const WIDTH: f64 = 900.0;
/// Margin of every page \[page units\].
const MARGIN: f64 = 40.0;

/// A page: x to the right, y downwards, in page units; a screen shows one unit as a pixel.
#[derive(Debug)]
pub(super) struct Page {
    /// SVG elements, one per line.
    marks: String,
}

impl Page {
    /// Begins a page with its title and one line below it.
    pub(super) fn new(title: &str, about: &str) -> Self {
        let mut page = Self { marks: String::new() };
        page.text([MARGIN, 42.0], cut(title, TITLE_FITS), TITLE);
        page.text([MARGIN, 64.0], cut(about, LINE_FITS), BODY);
        page
    }

    /// Returns the SVG document of a page of this height, with a line at its foot.
    pub(super) fn finish(mut self, height: f64, foot: &str) -> String {
        self.text([WIDTH - MARGIN, height - 16.0], cut(foot, LINE_FITS), FOOT);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
             height=\"{height}\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" fill=\"none\" \
             stroke-linejoin=\"round\">\n<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.marks
        )
    }

    /// Draws polylines with one pen.
    pub(super) fn lines(&mut self, lines: &[Vec<[f64; 2]>], pen: Pen) {
        let dash = pen.dash.map(|[a, b]| format!(" stroke-dasharray=\"{a} {b}\"")).unwrap_or_default();
        let (path, colour, width) = (path(lines, ""), hex(pen.colour), pen.width);
        if !path.is_empty() {
            self.mark(format_args!(
                "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash}/>"
            ));
        }
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], pen: Pen) {
        self.lines(&[vec![from, to]], pen);
    }

    /// Fills rings by the even-odd rule.
    pub(super) fn area(&mut self, rings: &[Vec<[f64; 2]>], colour: Colour) {
        let (path, colour) = (path(rings, "Z"), hex(colour));
        if !path.is_empty() {
            self.mark(format_args!("<path d=\"{path}\" fill=\"{colour}\" fill-rule=\"evenodd\"/>"));
        }
    }

    /// Writes one line of words with its base line at a point; nothing if there are no words.
    pub(super) fn text(&mut self, at: [f64; 2], text: impl Display, words: Words) {
        self.written(at, &text.to_string(), words, "");
    }

    /// Writes one line of words that reads upwards.
    pub(super) fn upright(&mut self, [x, y]: [f64; 2], text: &str, words: Words) {
        self.written([x, y], text, words, &format!(" transform=\"rotate(-90 {x:.2} {y:.2})\""));
    }

    fn written(&mut self, [x, y]: [f64; 2], text: &str, words: Words, turn: &str) {
        let Words { size, colour, anchor } = words;
        let (colour, text) = (hex(colour), escape(text));
        if !text.is_empty() {
            self.mark(format_args!(
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                 fill=\"{colour}\"{turn}>{text}</text>"
            ));
        }
    }

    /// Writes the heading of a part of the page, given as left, top, width, height.
    pub(super) fn heading(&mut self, room: [f64; 4], text: &str) {
        self.text([room[0], room[1] - 14.0], text, HEADING);
    }

    /// Draws a piece of line and writes what it means.
    pub(super) fn legend(&mut self, [x, y]: [f64; 2], pen: Pen, name: &str) {
        self.line([x, y], [x + 26.0, y], pen);
        self.text([x + 32.0, y + 4.0], name, SMALL);
    }

    fn mark(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.marks, "{element}");
    }
}

/// Returns the corners of a regular polygon; the first is at the angle `turn` \[rad\] clockwise from the top.
pub(super) fn polygon([x, y]: [f64; 2], radius: f64, corners: u32, turn: f64) -> Vec<[f64; 2]> {
    let angle = |k: u32| turn + std::f64::consts::TAU * f64::from(k) / f64::from(corners);
    (0..corners).map(|k| [x + radius * angle(k).sin(), y - radius * angle(k).cos()]).collect()
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

/// Escapes text for XML. Control characters, and two others that XML does not allow, are dropped.
fn escape(text: &str) -> String {
    let text: String = text.chars().filter(|c| !c.is_control() && !"\u{fffe}\u{ffff}".contains(*c)).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn cut(text: &str, longest: usize) -> String {
    if text.chars().count() <= longest {
        return text.into();
    }
    let kept: String = text.chars().take(longest - 1).collect();
    format!("{}…", kept.trim_end_matches(|c: char| !c.is_alphanumeric()))
}

/// Separator between the parts of a line of words: SVG readers show several blanks as one.
pub const SEPARATOR: &str = " · ";

/// Returns the line at the foot of pictures that belong to no scene.
pub(super) fn foot() -> String {
    format!("wheelrail {}", env!("CARGO_PKG_VERSION"))
}
