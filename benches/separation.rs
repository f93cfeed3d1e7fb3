//! The kernels against a plain store of the same array: `cargo bench`. The report measures the same with errors beside.

#![allow(missing_docs, clippy::expect_used, reason = "a benchmark")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use wheelrail::placement::Placement;
use wheelrail::separation::{EtaAxis, Method, Values, plan};
use wheelrail_report::reference::references;

/// A tread, a standard pair with joints, a flange root.
const SCENES: [&str; 3] = ["hollow_tread", "UIC60_EN15302A_root", "throat"];
const SIDES: [usize; 2] = [200, 2000];

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(divan::main);
}

/// n × n points over the window of a reference scene.
struct Grid {
    placement: Placement,
    xi: Vec<f64>,
    axis: EtaAxis,
    out: Values,
}

fn grid(scene: &str, n: usize) -> Grid {
    let all = references().expect("embedded reference scenes");
    let reference = all.into_iter().find(|r| r.name == scene).expect("a reference scene");
    let [xi, eta] = reference.scene.axes();
    let (first, last) = (xi[0], xi[xi.len() - 1]);
    let reach = eta.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let steps = |a: f64, b: f64| (0..n).map(|k| a + (b - a) * k as f64 / (n - 1) as f64).collect::<Vec<_>>();
    let mut eta = steps(-reach, reach);
    for k in 0..n / 2 {
        eta[k] = -eta[n - 1 - k];
    }
    let placement = reference.placement().expect("a placed pair");
    Grid { placement, xi: steps(first, last), axis: EtaAxis::new(&eta), out: touched(n * n) }
}

/// Memory whose pages are there.
fn touched(count: usize) -> Values {
    let mut out = Values::new(count);
    out.fill(1.0);
    out
}

fn fill(bencher: Bencher<'_, '_>, scene: &str, n: usize, method: Method) {
    let Grid { placement, xi, axis, mut out } = grid(scene, n);
    let choice = plan(&placement, &xi, &axis, 1e-12, Some(method)).choice;
    bencher.counter(ItemsCount::new(n * n)).bench_local(|| {
        choice.fill(&placement, &xi, &axis, &mut out);
        black_box(&mut *out);
    });
}

#[divan::bench(args = SCENES, consts = SIDES, max_time = 1)]
fn spectral<const N: usize>(bencher: Bencher<'_, '_>, scene: &str) {
    fill(bencher, scene, N, Method::Spectral);
}

#[divan::bench(args = SCENES, consts = SIDES, max_time = 1)]
fn pointwise<const N: usize>(bencher: Bencher<'_, '_>, scene: &str) {
    fill(bencher, scene, N, Method::Pointwise);
}

#[divan::bench(args = SCENES, consts = SIDES, max_time = 1)]
fn report_newton<const N: usize>(bencher: Bencher<'_, '_>, scene: &str) {
    fill(bencher, scene, N, Method::ReportNewton);
}

/// A plan to full precision and the fill by it, which has the plan's strips: what a caller waits for.
#[divan::bench(args = SCENES, consts = SIDES, max_time = 1)]
fn planned<const N: usize>(bencher: Bencher<'_, '_>, scene: &str) {
    let Grid { placement, xi, axis, mut out } = grid(scene, N);
    bencher.counter(ItemsCount::new(N * N)).bench_local(|| {
        plan(&placement, &xi, &axis, 1e-12, None).fill(&placement, &xi, &axis, &mut out);
        black_box(&mut *out);
    });
}

/// The plan alone.
#[divan::bench(args = SCENES, consts = SIDES, max_time = 1)]
fn plans<const N: usize>(bencher: Bencher<'_, '_>, scene: &str) {
    let Grid { placement, xi, axis, .. } = grid(scene, N);
    bencher.bench_local(|| plan(&placement, &xi, &axis, 1e-12, None));
}

#[divan::bench(consts = SIDES, max_time = 1)]
fn store<const N: usize>(bencher: Bencher<'_, '_>) {
    let mut out = touched(N * N);
    let value = black_box(0.1);
    bencher.counter(ItemsCount::new(N * N)).bench_local(|| {
        out.fill(value);
        black_box(&mut *out);
    });
}
