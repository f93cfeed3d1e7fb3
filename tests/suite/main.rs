//! The tests of the library, in one binary: each binary links the whole library.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "tests stop at the first surprise and say what they saw"
)]

mod along_track;
mod any_grid;
mod around_the_wheel;
mod bodies_beside;
mod campaign;
mod closed_forms;
mod common;
mod conformal;
mod conformal_brute;
mod conicity;
mod continuity;
mod cuts;
mod doubts;
mod extents;
mod flange_backs;
mod flood_fill;
mod half_space;
mod hard_cases;
mod hard_scenes;
mod headline_pressures;
mod holes;
mod in_place;
mod in_time;
mod independent_check;
mod interpenetration;
mod invariances;
mod layers;
mod loads;
mod machines;
mod measure;
mod measured_files;
mod measured_scene;
mod mesh;
mod motion;
mod over_slices;
mod packages;
mod parts;
mod polynomial_patches;
mod practice;
mod pressures;
mod profile_ends;
mod promises;
mod referee;
mod reference_values;
mod reference_yawed;
mod report;
mod roll_ends;
mod rollers;
mod slices;
mod smoothing;
mod specimens;
mod steps;
mod strips;
mod sweep_order;
mod sweep_page;
mod tables;
mod triangles;
mod turned_wheels;
mod two_sides;
mod unequal_wheels;
mod unmeasured_contacts;
mod varying_normals;
mod vtk_files;
mod whole_rails;
mod wrong_scenes;
mod yawed_patches;
