//! The names by which the program knows its own folders.

/// The files by which the output folder of one command is known.
#[derive(Debug, Clone, Copy)]
pub struct Names {
    /// The file that marks a folder as ours: it contains the word `wheelrail`. A folder without it is
    /// replaced only if it is empty.
    pub marker: &'static str,
    /// Returns whether the command may write a file of this name. Those of an earlier run are deleted with the old folder;
    /// every other file is the user's and is kept.
    pub is_file: fn(&str) -> bool,
    /// Returns whether the command may write a subfolder of this name, with files of the same names.
    pub is_part: fn(&str) -> bool,
}
