//! The runs that are timed as their users wait for them: whole processes, from the start to the last file on the disk. The
//! program runs them itself, because nothing here touches the disk.

/// A scene that `run` computes in a process of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Process {
    /// What the scene is, and what is written.
    pub name: &'static str,
    /// The scene, as TOML.
    pub scene: &'static str,
    /// Largest wall-clock time \[s\].
    pub bound: f64,
}

/// The processes that are timed.
pub const PROCESSES: [Process; 2] = [
    Process {
        name: "`run` of the wheelset example, all its files",
        scene: "[rail]\nprofile = \"UIC60\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[track]\n\
                gauge = 1435.0\ngauge_height = 14.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n\
                lateral = 5.0\nyaw = 0.002\nroll = \"solve\"\nwithin = 0.5\n[patch]\nload = 60000.0\n",
        bound: 30e-3,
    },
    Process {
        name: "`run` of a drawn pair by an approach, npy alone",
        scene: "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\n\
                offset = 0.0\n[patch]\napproach = 0.08\n[grid]\nxi = { from = -12.0, to = 12.0, n = 201 }\n\
                eta = { from = -10.0, to = 10.0, n = 201 }\n[output]\nformats = [\"npy\"]\n",
        bound: 5e-3,
    },
];

/// The time that a process took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessCost {
    /// The process.
    pub process: Process,
    /// Shortest wall-clock time \[s\], from the start of the process to its end, on all threads.
    pub seconds: f64,
}
