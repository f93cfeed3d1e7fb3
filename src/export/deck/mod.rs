//! Text decks for solvers: fixed columns, 17 significant digits, ASCII, with an end mark that shows whether
//! the file is complete.
//!
//! The card layouts of the original CONFORM and COUNTACT programs are not public. `conform.wrp` and
//! `countact.wrp` carry what those solvers read (separation, rail normals, boundary-fitted cells) in the grammar
//! of `wrp`; `crates/cli/tests/clients/read_wrp.f90` reads these and `separation.wrp`. `contact.inp` is for Vollebregt's CONTACT.

mod contact;
mod curved;
mod number;
mod table;
mod text;
mod wrp;

pub use contact::{ContactSettings, Prescribed, contact_inp};
pub use curved::{CurvedDeck, conform_curved_wrp, contact_curved_inp};
pub use table::table_wrp;
pub use text::Deck;
pub use wrp::{conform_wrp, countact_wrp, separation_wrp};
