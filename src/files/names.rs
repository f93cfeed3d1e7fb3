//! The names by which the program knows its own folders.

/// The files by which the output folder of one command is known.
#[derive(Debug, Clone, Copy)]
pub struct Names {
    /// The file that marks a folder as ours: it contains the word `wheelrail`. A folder without it is
    /// replaced only if it is empty.
    pub marker: &'static str,
    /// All files that the command may write. Those of an earlier run are deleted with the old folder; every
    /// other file is the user's and is kept.
    pub files: &'static [&'static str],
    /// Returns whether the command may write a subfolder of this name, with files of the same names.
    pub is_part: fn(&str) -> bool,
}

/// The folder of `wheelrail run`.
pub const RUN_FOLDER: Names = Names {
    marker: "summary.json",
    files: &[
        "summary.json",
        "xi.npy",
        "eta.npy",
        "separation.npy",
        "sigma.npy",
        "angle.npy",
        "normal_gap.npy",
        "boundary.csv",
        "interpen.csv",
        "interpen_sigma.csv",
        "midsep.txt",
        "separation.vts",
        "conformal.vts",
        "rail.vts",
        "wheel.vts",
        "boundary.vtp",
        "patch.vtu",
        "strips.vtu",
        "patch.msh",
        "patch.inp",
        "patch.stl",
        "rail.stl",
        "wheel.stl",
        "patch.vtp",
        "rail.vtp",
        "wheel.vtp",
        "rail.vtu",
        "wheel.vtu",
        "separation.vtk",
        "surface.pvd",
        "patch.svg",
        "patch.png",
        "conformal.svg",
        "conformal.png",
        "separation.nc",
        "separation.wrp",
        "conform.wrp",
        "countact.wrp",
        "contact.inp",
        "view.py",
        "wheelset.vtm",
        "wheelset.pvd",
        "rails.vtp",
        "wheels.vtp",
        "patches.vtp",
        "boundaries.vtp",
        "contacts.vtp",
        "view.html",
        // A Python that imports or compiles view.py leaves this folder.
        "__pycache__",
    ],
    is_part: |name| {
        let words = ["left", "right", "single", "contact", "patch"];
        name.split('-').all(|word| words.contains(&word) || word.parse::<u32>().is_ok())
    },
};

/// The folder of `wheelrail sweep --patches`: its subfolders are folders of runs.
pub const PATCHES_FOLDER: Names = Names { is_part: |name| name.starts_with("position-"), ..RUN_FOLDER };
