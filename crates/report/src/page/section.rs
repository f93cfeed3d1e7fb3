//! A section of the page.

/// One section of the page. For a new one, add a function to those that the page calls.
#[derive(Debug, Clone, PartialEq)]
pub struct PageSection {
    /// Heading of the section.
    pub title: &'static str,
    /// Text of the section in Markdown.
    pub body: String,
    /// Files of the section, as (name in the report's folder, content).
    pub files: Vec<(&'static str, Vec<u8>)>,
}
