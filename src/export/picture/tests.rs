use super::*;
use crate::export::sample::{Sample, header};

fn ellipse(delta: f64) -> Loop {
    let half = [(600.0 * delta).sqrt(), (920.0 * delta).sqrt()];
    let point = |k: i32| {
        let angle = f64::from(k).to_radians();
        [half[0] * angle.cos(), half[1] * angle.sin(), 0.0]
    };
    Loop { component: 0, points: (0..360).map(point).collect() }
}

fn profiles() -> [Vec<[f64; 2]>; 2] {
    let arc = |from: i32, to: i32, f: fn(f64) -> f64| (from..to).map(f64::from).map(|x| [x, f(x)]).collect();
    [arc(-36, 37, |x| -x * x / 600.0), arc(-60, 70, |x| x * x / 2000.0)]
}

#[test]
fn pictures_of_good_and_of_odd_data_are_drawn() {
    let [rail, wheel] = profiles();
    let header = Header { title: "a <b> & c".into(), ..header() };
    for n in [[1, 1], [1, 5], [2, 2], [130, 170], [401, 301]] {
        let sample = Sample::new(n[0], n[1]);
        let grid = sample.fields();
        for loops in [vec![], vec![ellipse(0.05)]] {
            let picture = Picture { header: &header, grid: &grid, loops: &loops, rail: &rail, wheel: &wheel };
            let svg = picture.svg();
            assert!(svg.contains("a &lt;b&gt; &amp; c") && svg.ends_with("</svg>\n"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{n:?}");
            let bare = Picture { rail: &[], wheel: &[], ..picture }.svg();
            assert!(!bare.contains("NaN") && !bare.contains("inf"));
        }
    }
}

#[test]
fn the_png_is_one() {
    let [rail, wheel] = profiles();
    let (header, sample, loops) = (header(), Sample::new(61, 81), [ellipse(0.005)]);
    let grid = sample.fields();
    let picture = Picture { header: &header, grid: &grid, loops: &loops, rail: &rail, wheel: &wheel };
    let png = picture.png().unwrap();
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
}
