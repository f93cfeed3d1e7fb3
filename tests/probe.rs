mod common;
use wheelrail::separation::{
    axis::EtaAxis,
    grid::{Choice, Method},
    plan,
};
#[test]
fn speed() {
    for r in common::references("reference") {
        let p = r.placement().unwrap();
        for n in [200usize, 2000] {
            let (a, b) = (
                r.scene.xi.iter().fold(f64::MAX, |a, &b| a.min(b)),
                r.scene.xi.iter().fold(f64::MIN, |a, &b| a.max(b)),
            );
            let e = r.scene.eta.iter().fold(0.0f64, |a, &b| a.max(b));
            let xi: Vec<f64> = (0..n).map(|i| a + (b - a) * i as f64 / (n - 1) as f64).collect();
            let eta: Vec<f64> =
                (0..n).map(|i| e * (2.0 * i as f64 - (n - 1) as f64) / (n - 1) as f64).collect();
            let axis = EtaAxis::new(&eta);
            let mut out = vec![0.0; n * n];
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let mut line = format!("{:24} {n}", r.name);
            let mut t = |f: &mut dyn FnMut(&mut [f64])| {
                let mut best = f64::MAX;
                for _ in 0..(if n > 1000 { 3 } else { 30 }) {
                    let s = std::time::Instant::now();
                    f(&mut out);
                    best = best.min(s.elapsed().as_secs_f64());
                }
                (n * n) as f64 / best / 1e6
            };
            let store = t(&mut |o| {
                let v = std::hint::black_box(1.5);
                for x in o.iter_mut() {
                    *x = v;
                }
                std::hint::black_box(o);
            });
            line += &format!(" store {store:.0}");
            for m in [Method::Spectral, Method::Parabolic, Method::Pointwise, Method::ReportNewton] {
                if n > 1000 && m == Method::Pointwise {
                    continue;
                }
                let plan = plan::plan(&p, &xi, &axis, 1e-12, Some(m));
                let c: Choice = plan.choice;
                let rate = pool.install(|| t(&mut |o| c.fill(&p, &xi, &axis, o)));
                line += &format!("  {}({}) {rate:.0}", m.name(), c.coefficients);
            }
            println!("{line}");
        }
    }
}
