//! A page of lines and words, independent of the format that it becomes.

/// A colour as red, green, blue.
pub(super) type Colour = [u8; 3];

/// How a path is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: Colour,
    /// \[page units\]
    pub(super) width: f64,
    /// Lengths of dash and gap \[page units\].
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

/// Which end of a text its place is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One thing on the page.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Mark {
    /// Polylines under one pen.
    Lines { lines: Vec<Vec<[f64; 2]>>, pen: Pen },
    /// Rings filled by the even-odd rule.
    Area { rings: Vec<Vec<[f64; 2]>>, colour: Colour },
    /// One line of text; `at` is on its base line. Upright text is read from below to above.
    Text { at: [f64; 2], text: String, size: f64, anchor: Anchor, colour: Colour, upright: bool },
}

/// A page: x to the right, y downwards, in units of which a screen shows one as a pixel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Canvas {
    pub(super) size: [f64; 2],
    pub(super) marks: Vec<Mark>,
}

impl Canvas {
    pub(super) fn lines(&mut self, lines: Vec<Vec<[f64; 2]>>, pen: Pen) {
        self.marks.push(Mark::Lines { lines, pen });
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], pen: Pen) {
        self.lines(vec![vec![from, to]], pen);
    }

    pub(super) fn area(&mut self, rings: Vec<Vec<[f64; 2]>>, colour: Colour) {
        self.marks.push(Mark::Area { rings, colour });
    }

    pub(super) fn text(
        &mut self,
        at: [f64; 2],
        text: impl Into<String>,
        size: f64,
        anchor: Anchor,
        colour: Colour,
    ) {
        self.marks.push(Mark::Text { at, text: text.into(), size, anchor, colour, upright: false });
    }

    pub(super) fn upright(&mut self, at: [f64; 2], text: impl Into<String>, size: f64, colour: Colour) {
        let anchor = Anchor::Middle;
        self.marks.push(Mark::Text { at, text: text.into(), size, anchor, colour, upright: true });
    }
}
