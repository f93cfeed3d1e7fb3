//! The names by which the program knows its own folders, and those by which it shows files.

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

/// Returns the name of the file of a path, of which either kind of slash parts the folders. A text without them stays as it is, and so does
/// one that is no path, as a kilometre 12/3: it does not begin at a root and has no extension.
pub fn file_name(path: &str) -> &str {
    let name = tail(path, 1);
    let is_path = path.starts_with(['/', '\\']) || path.get(1..2) == Some(":") || name.contains('.');
    if is_path { name } else { path }
}

/// Returns the names of the files of paths; where different files have one name, with as many of their folders as tell all apart.
pub fn short_names<'a>(paths: &[&'a str]) -> Vec<&'a str> {
    let most = paths.iter().map(|path| path.matches(['/', '\\']).count() + 1).max().unwrap_or(1);
    let names = |parts: usize| paths.iter().map(move |path| tail(path, parts)).collect::<Vec<_>>();
    let count = |names: &[&str]| names.iter().collect::<std::collections::BTreeSet<_>>().len();
    (1..most).map(names).find(|names| count(names) == count(paths)).unwrap_or_else(|| names(most))
}

/// Returns the last parts of a path.
fn tail(path: &str, parts: usize) -> &str {
    let cut = path.rmatch_indices(['/', '\\']).nth(parts - 1);
    cut.map_or(path, |(at, slash)| &path[at + slash.len()..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_shown_by_their_names() {
        for (path, name) in [
            ("/home/a b/60E1.ban", "60E1.ban"),
            ("C:\\data\\60E1.ban", "60E1.ban"),
            ("../profiles/60E1.ban", "60E1.ban"),
            ("/data/profile", "profile"),
            ("cone-1:20", "cone-1:20"),
            ("km 12/3", "km 12/3"),
        ] {
            assert_eq!(file_name(path), name);
        }
        let short = |paths: &[&'static str]| short_names(paths).join(" ");
        assert_eq!(short(&["/x/a/left.prw", "S1002", "/x/a/right.prw"]), "left.prw S1002 right.prw");
        assert_eq!(
            short(&["/x/a/1.prw", "/x/b/1.prw", "/x/b/1.prw", "2.prw"]),
            "a/1.prw b/1.prw b/1.prw 2.prw"
        );
        assert_eq!((short(&["/x/a.prw"]), short(&[])), ("a.prw".into(), String::new()));
    }
}
