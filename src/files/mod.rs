//! The disk: the files that the program reads and writes. No other room opens a file.
//!
//! A written file or folder appears whole or not at all: a single file by [`NewFile`], a folder of files by
//! [`Folder`]. A [`KeptFolder`] is added to, file by file.

mod complaint;
mod file;
mod folder;
mod foreign;
mod kept;
mod names;
mod read;
mod system;
mod temporary;

pub use file::{NewFile, make_folder, write_file};
pub use folder::{Folder, FolderPart};
pub use kept::{KeptFolder, files_in};
pub use names::{Names, file_name, short_names};
pub use read::{read_bytes, read_text};
pub use temporary::discard_all;
