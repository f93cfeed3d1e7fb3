//! Renders a picture's SVG as PNG. The program carries its own font, so that a picture looks the same on every machine.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use wheelrail::error::{Error, Result};

/// DejaVu Sans without hinting: Latin, Greek, Cyrillic and mathematical signs. Its licence lies beside it.
const FONT: &[u8] = include_bytes!("png/DejaVuSans-subset.ttf");
const FAMILY: &str = "DejaVu Sans";

/// Pixels of one page unit.
const SCALE: f32 = 2.0;

/// Returns the PNG of an SVG document, with two pixels for each of its units. A character that the font lacks becomes an
/// empty box.
///
/// # Errors
/// SVG that the renderer rejects, or a page without extent; both are faults of this program.
pub(super) fn png(svg: &str) -> Result<Vec<u8>> {
    let mut options = Options::default();
    options.fontdb_mut().load_font_data(FONT.to_vec());
    options.fontdb_mut().set_sans_serif_family(FAMILY);
    let tree = Tree::from_str(svg, &options).map_err(|error| refused(&error.to_string()))?;
    let [width, height] =
        [tree.size().width(), tree.size().height()].map(|side| (SCALE * side).ceil() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| refused("an empty page"))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| refused(&error.to_string()))
}

fn refused(found: &str) -> Error {
    let advice = "report this as a fault of wheelrail, take the picture as SVG meanwhile";
    Error::new("PNG", found, "a picture", advice)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of pixels that are not white on a page of 20 × 20 units with these words.
    fn inked(words: &str) -> usize {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20\" height=\"20\"><rect width=\"20\" height=\"20\" \
             fill=\"#ffffff\"/><text x=\"2\" y=\"16\" font-size=\"14\" font-family=\"Nowhere, sans-serif\">{words}</text></svg>"
        );
        let pixels = Pixmap::decode_png(&png(&svg).unwrap()).unwrap();
        assert_eq!([pixels.width(), pixels.height()], [40, 40]);
        pixels.pixels().iter().filter(|pixel| pixel.red() < 128).count()
    }

    #[test]
    fn every_sign_of_a_picture_is_in_the_font() {
        let [blank, unknown] = [" ", "\u{4e00}"].map(inked);
        assert_eq!(blank, 0);
        for sign in "Aaξηζδθγ°×\u{2212}…·0123456789²µΔ⁻".chars() {
            let inked = inked(&sign.to_string());
            assert!(inked > 0 && inked != unknown, "{sign}");
        }
    }

    #[test]
    fn what_is_no_svg_is_refused() {
        assert_eq!(png("<svg").unwrap_err().place, "PNG");
    }
}
