//! Puts a page together: title, style, data, script.

use serde::Serialize;

/// The style of all pages.
const STYLE: &str = include_str!("page.css");

/// Content security policy of a page: no script, style, picture or number comes from outside its own file.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

/// Returns an HTML document whose `script` finds `data` as JSON in the element `data`.
///
/// Cost: a few copies of the data. Text in the data cannot end its element, because JSON needs no `<` outside of strings, and
/// inside of them it is written as an escape.
pub(super) fn document(title: &str, data: &impl Serialize, script: &str) -> Vec<u8> {
    let data = serde_json::to_string(data).unwrap_or_default().replace('<', "\\u003c");
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main id=\"page\"><noscript>{title}: this page \
         needs JavaScript.</noscript></main>\n<script id=\"data\" type=\"application/json\">{data}</script>\n\
         <script>\n{script}</script>\n</body>\n</html>\n"
    )
    .into_bytes()
}

/// Escapes text for HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A script element ends, or changes its state, at each of these words, even inside a string.
    #[test]
    fn scripts_cannot_end_their_element() {
        for script in [
            include_str!("view.js"),
            include_str!("sweep.js"),
            include_str!("fleet.js"),
            include_str!("measure.js"),
        ]
        .map(str::to_ascii_lowercase)
        {
            assert!(!script.contains("</script") && !script.contains("<!--") && !script.contains("<script"));
        }
    }

    #[test]
    fn text_of_the_data_ends_no_element() {
        let title = "</script><script>alert(1)</script><!-- & \"]]>";
        let page = String::from_utf8(document(title, &[title, "</title>"], "run();\n")).unwrap();
        assert_eq!(page.matches("</script").count(), 2, "{page}");
        assert_eq!(page.matches("<script").count(), 2, "{page}");
        assert!(page.matches("</title").count() == 1 && !page.contains("<!--"), "{page}");
        let data = page.split_once("application/json\">").unwrap().1.split_once("</script>").unwrap().0;
        assert_eq!(serde_json::from_str::<Vec<String>>(data).unwrap(), [title, "</title>"]);
    }
}
