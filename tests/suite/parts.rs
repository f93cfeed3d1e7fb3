//! The parts of a run: contacts of one wheel, and parts of a patch with a grid each or, by `[grid] merge`, together.

use std::path::Path;
use wheelrail::case::{FACTS, Part, RUN_FOLDER, Run, SILENT, write};
use wheelrail::files::Folder;
use wheelrail::scene;
use wheelrail::separation::Evaluator;

/// Two crowns 40 mm apart under a cylinder: z = −0.16 + 8e-4 x² − 1e-6 x⁴ is largest at x = ±20.
fn run(grid: &str) -> wheelrail::Result<Run> {
    let text = format!(
        "[rail]\nsegments = [{{ polynomial = {{ x = [-35.0, 35.0], coefficients = [-0.16, 0.0, 8e-4, 0.0, -1e-6] }} }}]\n\
         [wheel]\nsegments = [{{ line = {{ from = [-60.0, 0.0], to = [60.0, 0.0] }} }}]\nradius = 460.0\n\
         [contact]\nrail_x = 20.0\nwheel_x = 20.0\n[patch]\napproach = 0.02\n[grid]\n{grid}\n"
    );
    computed(&text)
}

/// Reads, resolves and computes a scene.
fn computed(text: &str) -> wheelrail::Result<Run> {
    Run::new(scene::resolve(&scene::parse(text, false)?, Path::new("."), "a scene")?, SILENT)
}

#[test]
fn parts_have_a_grid_each_unless_they_are_merged() {
    for (grid, folders) in
        [("", vec!["", "patch-2"]), ("merge = 5.0", vec!["", "patch-2"]), ("merge = 60.0", vec![""])]
    {
        let run = run(grid).expect("a patch");
        assert_eq!(
            run.parts.iter().map(|part| part.site.folder.as_str()).collect::<Vec<_>>(),
            folders,
            "{grid}"
        );
        let components =
            run.parts.iter().map(|part| part.analysis.patch.as_ref().map_or(0, |p| p.components.len()));
        assert_eq!(components.sum::<usize>(), 2, "{grid}");
        assert!(run.warnings().is_empty(), "{:?}", run.warnings());
    }
}

#[test]
fn a_method_that_misses_the_tolerance_is_warned_of() {
    for (method, tolerance, missed) in
        [("quadratic", 1e-6, true), ("quadratic", 1e3, false), ("spectral", 1e-6, false)]
    {
        let run = run(&format!("method = \"{method}\"\ntolerance = {tolerance:?}")).expect("a patch");
        let warned = run.warnings().iter().any(|warning| warning.contains("grid.tolerance"));
        assert_eq!(warned, missed, "{method} to {tolerance:e}: {:?}", run.warnings());
    }
}

#[test]
fn a_distance_that_means_nothing_is_refused() {
    let axes = "xi = { from = -1.0, to = 1.0, n = 3 }\neta = { from = -1.0, to = 1.0, n = 3 }\n";
    for grid in ["merge = -1.0".to_string(), format!("{axes}merge = 1.0")] {
        let error = run(&grid).expect_err("bad input").to_string();
        assert!(error.contains("grid: merge"), "{error}");
    }
}

#[test]
fn lengths_beyond_all_measure_are_refused() {
    let scene = |radius: &str, approach: &str, xi: &str| {
        let text = format!(
            "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = {radius}\n[contact]\noffset = 0.0\n\
             [patch]\napproach = {approach}\n[grid]\nxi = {xi}\neta = {{ from = -10.0, to = 10.0, n = 21 }}\n"
        );
        computed(&text)
    };
    let usual = "{ from = -12.0, to = 12.0, n = 21 }";
    for (radius, approach, xi, place) in [
        ("1e308", "0.08", usual, "wheel: radius"),
        ("460.0", "5e-324", usual, "patch: approach"),
        ("460.0", "0.08", "{ values = [0.0, 5e-324] }", "grid: xi"),
    ] {
        let error = scene(radius, approach, xi).expect_err("bad input").to_string();
        assert!(error.contains(place), "{error}");
    }
    assert!(scene("1e9", "1e-60", usual).is_ok());
}

#[test]
fn narrow_features_and_missing_surfaces_are_seen_by_the_plan() {
    let wheel = "[wheel]\nsegments = [{ line = { from = [-30.0, 0.0], to = [30.0, 0.0] } }]\nradius = 460.0\n\
                 [contact]\nrail_x = 0.0\nwheel_x = 0.0\n";
    let crown = |x: &str| {
        format!("{{ arc = {{ center = [0.0, -300.0], radius = 300.0, half = \"upper\", x = {x} }} }}")
    };
    // A groove 0.3 mm wide and 0.01 mm deep, between the columns of an evenly spread sample; a rail that ends.
    let groove = format!(
        "{}, {{ line = {{ from = [4.15, -0.028705540013390873], to = [4.3, -0.040818249607534655] }} }}, \
         {{ line = {{ from = [4.3, -0.040818249607534655], to = [4.45, -0.03300598232476659] }} }}, {}",
        crown("[-20.0, 4.15]"),
        crown("[4.45, 20.0]")
    );
    for rail in [groove, crown("[-3.0, 3.0]")] {
        let text = format!(
            "[rail]\nsegments = [{rail}]\n{wheel}[grid]\nxi = {{ from = -12.0, to = 12.0, n = 1281 }}\n\
             eta = {{ from = -4.0, to = 4.0, n = 33 }}\ntolerance = 1e-3\n"
        );
        let run = computed(&text).expect("a run");
        let Part { site, analysis, .. } = &run.parts[0];
        let (xi, eta) = (&site.grid.xi, &site.grid.eta);
        let mut evaluator = Evaluator::new(&site.contact.placement);
        let mut worst = 0f64;
        for (&xi, column) in xi.iter().zip(analysis.separation.chunks(eta.len())) {
            for (&eta, &s) in eta.iter().zip(column) {
                let exact = evaluator.separation(xi, eta);
                assert_eq!(s.is_nan(), exact.is_nan(), "ξ = {xi}, η = {eta}");
                worst = worst.max((s - exact).abs());
            }
        }
        assert!(worst <= analysis.plan.error && worst <= 1e-3, "{worst:e}: {:?}", analysis.plan);
    }
}

#[test]
fn a_contact_that_only_the_approach_closes_is_no_refusal() {
    let text = "[rail]\nprofile = \"49E1\"\nrotate = \"1:20\"\n\
                [wheel]\nprofile = \"EN13715-1:40-h28-e32.5\"\nradius = 425.0\n\
                [contact]\noffset = 5.5\nyaw = 0.008\n[patch]\nload = 75000.0\n";
    let run = computed(text).expect("a contact");
    let feasible: Vec<bool> = run.parts.iter().map(|part| part.site.contact.feasibility.feasible).collect();
    assert_eq!(feasible, [true, false]);
    assert!(run.refusals().is_empty(), "{:?}", run.refusals());
    // No deck may give the whole load to one of the two: their vertical parts add up to it.
    let vertical = |part: &Part| {
        let cos = part.site.contact.placement.rail().point().station.cos;
        part.site.normal_load.map_or(f64::NAN, |load| load * cos)
    };
    let shares: Vec<f64> = run.parts.iter().map(vertical).collect();
    assert!(
        (shares.iter().sum::<f64>() / 75e3 - 1.0).abs() < 1e-10 && shares.iter().all(|s| *s < 74e3),
        "{shares:?}"
    );
    let home = tempfile::tempdir().expect("a folder");
    let target = home.path().join("out");
    let folder = Folder::create(&target, RUN_FOLDER).expect("a folder");
    write(&run, &folder, None, SILENT).and_then(|_| folder.commit()).expect("files");
    for part in &run.parts {
        let deck =
            std::fs::read_to_string(target.join(&part.site.folder).join("contact.inp")).expect("a deck");
        let force = format!("   {:?} 0.0 0.0 0.0           FN\n", part.site.normal_load.expect("a load"));
        assert!(deck.contains(&force), "{}", part.site.folder);
    }
}

#[test]
fn files_say_that_a_contact_is_infeasible_or_a_mirror_image() {
    let chosen = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                  [contact]\nrail_x = -10.0\nwheel_x = -30.0\n[patch]\napproach = 0.02\n";
    let wheelset = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                    [track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n\
                    lateral = 1.0\n[patch]\napproach = 0.05\n";
    // An infeasible contact has no mesh of its patch.
    let cases =
        [(chosen, "", "infeasible contact", None), (wheelset, "left", "mirror image", Some("patch.vtu"))];
    for (text, folder, said, mesh) in cases {
        let run = computed(text).expect("a contact");
        let home = tempfile::tempdir().expect("a folder");
        let target = home.path().join("out");
        let out = Folder::create(&target, RUN_FOLDER).expect("a folder");
        write(&run, &out, None, SILENT).and_then(|_| out.commit()).expect("files");
        assert_eq!(target.join(folder).join("patch.vtu").exists(), mesh.is_some());
        for name in ["contact.inp", "separation.wrp", "rail.vtu"].into_iter().chain(mesh) {
            let file = std::fs::read_to_string(target.join(folder).join(name)).expect("a file");
            assert!(file.contains(said), "{folder}/{name}");
        }
    }
}

/// The list of facts and the summary agree: a number stands under the keys that its fact names.
#[test]
fn facts_stand_in_the_summary_under_their_keys() {
    let text = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                [contact]\noffset = 0.0\nyaw = 0.004\n[patch]\nload = 60000.0\n[grid]\nreference = \"rail\"\n\
                [output]\nformats = [\"npy\"]\n";
    let run = computed(text).expect("a contact");
    let home = tempfile::tempdir().expect("a folder");
    let folder = Folder::create(&home.path().join("out"), RUN_FOLDER).expect("a folder");
    let written = write(&run, &folder, None, SILENT).expect("files");
    let (part, summary) = (&run.parts[0], &written[0].summary);
    let mut numbers = 0;
    for fact in &FACTS {
        let Some((keys, value)) = fact.number(part) else { continue };
        let found = keys.iter().fold(summary, |table, key| &table[key]);
        assert_eq!(found.as_f64(), value, "{keys:?}");
        let left_out = ["contact pitch", "skew"].contains(&fact.label) && value == Some(0.0);
        assert_eq!(fact.text(part).is_some(), value.is_some() && !left_out, "{}", fact.label);
        numbers += usize::from(value.is_some());
    }
    assert!(numbers >= 10, "{numbers}");
}

#[test]
fn a_contact_at_an_end_takes_no_quadratic_form() {
    let scene = |method: &str| {
        let text = format!(
            "[rail]\nsegments = [{{ arc = {{ center = [0.0, -300.0], radius = 300.0, half = \"upper\", x = [-30.0, 30.0] }} }}]\n\
             [wheel]\nsegments = [{{ line = {{ from = [-60.0, 0.0], to = [8.0, 0.0] }} }}]\nradius = 460.0\n\
             [contact]\noffset = -10.0\n[patch]\napproach = 0.02\n[grid]\nmethod = \"{method}\"\n"
        );
        computed(&text)
    };
    let run = scene("auto").expect("a contact");
    let analysis = &run.parts[0].analysis;
    assert!(analysis.separation.iter().any(|s| s.is_finite()) && analysis.plan.error.is_finite());
    let error = scene("quadratic").expect_err("no form").to_string();
    assert!(error.contains("quadratic with a contact at a kink or end"), "{error}");
}

#[test]
fn a_joint_of_the_drawing_is_no_second_contact() {
    // S1002's zones B and C miss each other by 0.04 µm at x = −26, where these contacts are.
    let mut nearest = f64::INFINITY;
    for (inclination, from) in [("-0.01", -0.3), ("-0.02", -0.43)] {
        for k in 0..12 {
            let offset = from + 0.01 * f64::from(k);
            let text = format!(
                "[rail]\nprofile = \"60E1\"\nrotate = {inclination}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                 [contact]\noffset = {offset:?}\n[patch]\nload = 1e5\n"
            );
            let run = computed(&text).expect("a contact");
            let places: Vec<f64> =
                run.parts.iter().map(|part| part.site.contact.placement.wheel().point().station.x).collect();
            for (i, a) in places.iter().enumerate() {
                nearest = nearest.min((a + 26.0).abs());
                // Contacts of one wheel are on different curves of it: nearer ones are one patch twice.
                assert!(
                    places[..i].iter().all(|b| (a - b).abs() > 5.0),
                    "{inclination} {offset}: {places:?}"
                );
            }
        }
    }
    assert!(nearest < 0.05, "no contact near the joint: {nearest}");
}
