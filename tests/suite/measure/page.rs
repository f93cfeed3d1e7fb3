//! The page of the manual and the quantities.

use super::*;

#[test]
fn the_page_lists_every_column_and_alignment() {
    let page = include_str!("../../../src/docs/measures.md");
    for quantity in Quantity::ALL {
        assert!(page.contains(&format!("`{}`", quantity.key())), "{quantity:?}");
        assert!(quantity.key().ends_with(&quantity.unit().replace('%', "percent")), "{quantity:?}");
    }
    let all = [
        Align::None,
        Align::Back,
        Align::TreadPoint,
        Align::BackAndTread,
        Align::FieldSide,
        Align::Web,
        Align::Unworn,
        Align::BestFit,
    ];
    for align in all {
        assert!(page.contains(&format!("| `{}` |", align.word())), "{align:?}");
        assert_eq!(serde_json::to_value(align).ok(), Some(align.word().into()));
    }
}
