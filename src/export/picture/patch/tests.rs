use super::*;
use crate::export::Header;
use crate::export::sample::{Sample, header};
use nalgebra::Point3;

fn ellipse(delta: f64) -> Loop {
    let half = [(600.0 * delta).sqrt(), (920.0 * delta).sqrt()];
    let point = |k: i32| {
        let angle = f64::from(k).to_radians();
        Point3::new(half[0] * angle.cos(), half[1] * angle.sin(), 0.0)
    };
    Loop { component: 0, points: (0..360).map(point).collect() }
}

fn profiles() -> [Vec<[f64; 2]>; 2] {
    let arc = |from: i32, to: i32, f: fn(f64) -> f64| (from..to).map(f64::from).map(|x| [x, f(x)]).collect();
    [arc(-36, 37, |x| -x * x / 600.0), arc(-60, 70, |x| x * x / 2000.0)]
}

/// Makes a picture of a sample, with its own points for the contours.
fn picture<'a>(
    sample: &'a Sample,
    header: &'a Header,
    loops: &'a [Loop],
    midplane: &'a [[f64; 2]],
    profiles: &'a [Vec<[f64; 2]>; 2],
) -> PatchPicture<'a> {
    let [rail, wheel] = profiles;
    let name = "left side, mirrored · contact 2";
    PatchPicture {
        contact: PicturedContact { header, name, refusals: &[], rail, wheel },
        cells: [&sample.xi, &sample.eta],
        separation: Nodes { xi: &sample.xi, eta: &sample.eta, values: &sample.separation },
        midplane,
        loops,
        pressed: None,
    }
}

fn midplane(sample: &Sample) -> Vec<[f64; 2]> {
    sample.xi.iter().map(|x| [*x, x * x / 600.0]).collect()
}

#[test]
fn pictures_of_good_and_of_odd_data_are_drawn() {
    let (profiles, none) = (profiles(), [Vec::new(), Vec::new()]);
    for approach in [0.05, 0.0] {
        let header = Header { title: "a <b> & c".into(), approach, ..header() };
        for n in [[1, 1], [1, 5], [2, 2], [130, 170]] {
            let sample = Sample::new(n[0], n[1]);
            for loops in [vec![], vec![ellipse(0.05)]] {
                for (profiles, midplane) in
                    [(&profiles, midplane(&sample)), (&none, vec![[0.0, f64::NAN]; 3])]
                {
                    let svg = picture(&sample, &header, &loops, &midplane, profiles).svg();
                    assert!(svg.contains("a &lt;b&gt; &amp; c") && svg.ends_with("</svg>\n"));
                    // Readers of SVG show several blanks as one.
                    assert!(svg.contains("left side, mirrored · contact 2 · ") && !svg.contains("    "));
                    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{n:?}");
                }
            }
        }
    }
}

/// Returns the numbers in a picture's text elements of the size of contour labels.
fn labels(svg: &str) -> Vec<String> {
    let marked = svg.lines().filter(|line| line.contains("font-size=\"9.5\""));
    marked.map(|line| line.split(['>', '<']).nth(2).unwrap().to_owned()).collect()
}

#[test]
fn levels_follow_the_approach_and_have_their_numbers_on_the_lines() {
    let (sample, profiles) = (Sample::new(121, 161), profiles());
    let drawn = |approach: f64| {
        let header = Header { approach, ..header() };
        labels(&picture(&sample, &header, &[ellipse(approach)], &midplane(&sample), &profiles).svg())
    };
    // s reaches 0.13 mm at the corners.
    assert!(drawn(0.05).iter().any(|label| label == "0.04"), "{:?}", drawn(0.05));
    let fine = drawn(0.005);
    assert!(fine.iter().all(|label| label.parse::<f64>().unwrap() <= 0.025), "{fine:?}");
    assert!(!fine.is_empty());
}

#[test]
fn the_axes_at_c_stay_below_the_heading() {
    // The rail falls off to both sides of C and the wheel is no higher: C is at the top.
    let line = |slope: f64| (0..20).map(|k| [f64::from(k), -slope * f64::from(k)]).collect::<Vec<_>>();
    let (header, sample, profiles) = (header(), Sample::new(21, 21), [line(1.0), line(0.9)]);
    let svg = picture(&sample, &header, &[], &midplane(&sample), &profiles).svg();
    let height = |wanted: &str| -> f64 {
        let line = svg.lines().find(|line| line.contains(wanted)).unwrap();
        line.split("y=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap().parse().unwrap()
    };
    let (letter, heading) = (height(">ζ<"), height(">Profiles in"));
    assert!(letter > heading + 12.0, "{letter} {heading}");
}
