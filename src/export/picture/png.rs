//! A page as PNG. Words are drawn as outlines from `glyphs.txt`, so no font is looked for on the machine.

use super::canvas::{Anchor, Canvas, Colour, Mark, Pen};
use crate::error::{Error, Result};
use std::collections::HashMap;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

const GLYPHS: &str = include_str!("glyphs.txt");

/// Font units to the em.
const EM: f64 = 2048.0;

/// The page with `scale` pixels to the page unit.
///
/// # Errors
/// An empty page; what the encoder refuses.
pub(super) fn encode(canvas: &Canvas, scale: f64) -> Result<Vec<u8>> {
    let [width, height] = canvas.size.map(|side| (side * scale).ceil() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| refused("an empty page"))?;
    pixels.fill(Color::WHITE);
    let mut painter = Painter { pixels, scale: scale as f32, glyphs: glyphs() };
    canvas.marks.iter().for_each(|mark| painter.draw(mark));
    painter.pixels.encode_png().map_err(|e| refused(&e.to_string()))
}

fn refused(found: &str) -> Error {
    let advice = "report this as a fault of wheelrail, take the picture as SVG meanwhile";
    Error::new("PNG", found, "a picture", advice)
}

struct Glyph {
    /// Width that it takes on the line \[font units\].
    advance: f64,
    outline: &'static str,
}

struct Painter {
    pixels: Pixmap,
    scale: f32,
    glyphs: HashMap<char, Glyph>,
}

impl Painter {
    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Lines { lines, pen } => self.lines(lines, *pen),
            Mark::Area { rings, colour } => {
                self.fill(polylines(rings, true), *colour, FillRule::EvenOdd, self.page());
            }
            Mark::Text { at, text, size, anchor, colour, upright } => {
                let length: f64 = text.chars().map(|c| self.glyph(c).advance).sum::<f64>() * size / EM;
                let shift = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => length / 2.0,
                    Anchor::End => length,
                };
                let place = self.page().pre_translate(at[0] as f32, at[1] as f32);
                let place = if *upright { place.pre_rotate(-90.0) } else { place };
                let place = place.pre_translate(-shift as f32, 0.0);
                // Font units have y upwards.
                let unit = (size / EM) as f32;
                self.fill(self.words(text), *colour, FillRule::Winding, place.pre_scale(unit, -unit));
            }
        }
    }

    fn page(&self) -> Transform {
        Transform::from_scale(self.scale, self.scale)
    }

    fn lines(&mut self, lines: &[Vec<[f64; 2]>], pen: Pen) {
        let Some(path) = polylines(lines, false) else { return };
        let dash = pen.dash.and_then(|[a, b]| StrokeDash::new(vec![a as f32, b as f32], 0.0));
        let stroke =
            Stroke { width: pen.width as f32, line_join: LineJoin::Round, dash, ..Stroke::default() };
        self.pixels.stroke_path(&path, &paint(pen.colour), &stroke, self.page(), None);
    }

    fn fill(&mut self, path: Option<Path>, colour: Colour, rule: FillRule, place: Transform) {
        if let Some(path) = path {
            self.pixels.fill_path(&path, &paint(colour), rule, place, None);
        }
    }

    /// A character without an outline here is shown as a question mark.
    fn glyph(&self, c: char) -> &Glyph {
        const NOTHING: Glyph = Glyph { advance: 0.0, outline: "" };
        self.glyphs.get(&c).or_else(|| self.glyphs.get(&'?')).unwrap_or(&NOTHING)
    }

    fn words(&self, text: &str) -> Option<Path> {
        let mut path = PathBuilder::new();
        let mut x = 0.0;
        for glyph in text.chars().map(|c| self.glyph(c)) {
            outline(&mut path, glyph.outline, x);
            x += glyph.advance as f32;
        }
        path.finish()
    }
}

fn paint(colour: Colour) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    paint
}

fn polylines(lines: &[Vec<[f64; 2]>], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        for (k, [x, y]) in line.iter().enumerate() {
            let (x, y) = (*x as f32, *y as f32);
            if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
        }
        if closed {
            path.close();
        }
    }
    path.finish()
}

/// Lines `HEX ADVANCE OUTLINE`; comments begin with #.
fn glyphs() -> HashMap<char, Glyph> {
    let entry = |line: &'static str| {
        let mut parts = line.splitn(3, ' ');
        let code = char::from_u32(u32::from_str_radix(parts.next()?, 16).ok()?)?;
        let advance = parts.next()?.parse().ok()?;
        Some((code, Glyph { advance, outline: parts.next().unwrap_or_default() }))
    };
    GLYPHS.lines().filter(|line| !line.starts_with('#')).filter_map(entry).collect()
}

/// Adds an outline of M, L, Q and Z, moved by x \[font units\].
fn outline(path: &mut PathBuilder, text: &str, x: f32) {
    for piece in text.split_inclusive(['M', 'L', 'Q', 'Z']).zip(text.split(['M', 'L', 'Q', 'Z']).skip(1)) {
        let (command, numbers) = piece;
        let n: Vec<f32> = numbers.split(' ').filter_map(|word| word.parse().ok()).collect();
        match (command.as_bytes().last(), n.as_slice()) {
            (Some(b'M'), [a, b]) => path.move_to(x + a, *b),
            (Some(b'L'), [a, b]) => path.line_to(x + a, *b),
            (Some(b'Q'), [a, b, c, d]) => path.quad_to(x + a, *b, x + c, *d),
            _ => path.close(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_outlines_are_well_formed() {
        let glyphs = glyphs();
        assert_eq!(glyphs.len(), GLYPHS.lines().filter(|line| !line.starts_with('#')).count());
        for c in "Aaξηζδθ°×−…0123456789²".chars() {
            let mut path = PathBuilder::new();
            outline(&mut path, glyphs[&c].outline, 0.0);
            let bounds = path.finish().unwrap().bounds();
            assert!(bounds.width() > 100.0 && bounds.right() < 2048.0, "{c}: {bounds:?}");
        }
    }
}
