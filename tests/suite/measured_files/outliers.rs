//! Rows that a scanner wrote where it saw nothing, and the order of noisy points, on random profiles whose truth is known.

use super::*;
use crate::campaign::{scenes, seeds};
use wheelrail::measured::of_points;

const NAMES: [(&str, Side); 8] = [
    ("60E1", Side::Rail),
    ("54E1", Side::Rail),
    ("49E1", Side::Rail),
    ("UIC60", Side::Rail),
    ("S1002", Side::Wheel),
    ("EN15302-B", Side::Wheel),
    ("APTA-120", Side::Wheel),
    ("cone-1:20", Side::Wheel),
];

/// A built-in profile as a dense polygon.
struct Truth {
    side: Side,
    at: Vec<[f64; 2]>,
}

/// How a profile is sampled.
struct Scan {
    /// Distance of the points, mm: along x or along the path.
    spacing: f64,
    /// Share of the spacing by which it varies.
    jitter: f64,
    along_x: bool,
    /// Deviation of the noise of x and z, mm.
    noise: [f64; 2],
}

impl Truth {
    fn random(random: &mut Random) -> Self {
        let &(name, side) = random.pick(&NAMES);
        let profile = if side == Side::Rail { standards::rail(name) } else { standards::wheel(name) };
        Self { side, at: write::sample(&profile.expect(name), 0.02).expect(name) }
    }

    /// The distance of a point from the surface, mm.
    fn distance(&self, [x, z]: [f64; 2]) -> f64 {
        let from = |pair: &[[f64; 2]]| {
            let ([a, b], [c, d]) = (pair[0], pair[1]);
            let (u, w) = (c - a, d - b);
            let share = (((x - a) * u + (z - b) * w) / (u * u + w * w).max(1e-30)).clamp(0.0, 1.0);
            (x - a - share * u).hypot(z - b - share * w)
        };
        self.at.windows(2).map(from).fold(f64::INFINITY, f64::min)
    }

    /// The points of a scan; along x the first ones of the surface in order of x.
    fn scanned(&self, scan: &Scan, random: &mut Random) -> Vec<[f64; 2]> {
        let mut out = Vec::new();
        let (mut next, mut place) = (0.0, 0.0);
        let mut reached = self.at[0][0];
        for pair in self.at.windows(2) {
            let ([a, b], [c, d]) = (pair[0], pair[1]);
            let length = if scan.along_x { (c - reached).max(0.0) } else { (c - a).hypot(d - b) };
            while length > 0.0 && place + length >= next {
                let whole = if scan.along_x { c - a } else { length };
                let from = if scan.along_x { reached - a } else { 0.0 };
                let share = (from + next - place) / whole;
                let at = [a + share * (c - a), b + share * (d - b)];
                let noisy = [0, 1].map(|k| at[k] + scan.noise[k] * random.normal());
                out.push(noisy.map(|value| (value * 1e4).round() / 1e4));
                next += scan.spacing * (1.0 + scan.jitter * random.between(-1.0, 1.0));
            }
            place += length;
            reached = reached.max(c);
        }
        out
    }
}

fn options(repair: &[Repair]) -> Options {
    Options { mirror: Some(false), flip_z: Some(false), repair: repair.to_vec(), ..Options::default() }
}

/// The place and the text of what is said of points off the curve: of the error, or of the findings.
fn said(read: &Result<Measured>) -> String {
    match read {
        Err(error) => error.to_string(),
        Ok(read) => {
            let spikes = read.record.warnings.iter().filter(|finding| finding.check == Check::Spike);
            spikes.map(|finding| format!("{} {}; ", finding.place, finding.found)).collect()
        }
    }
}

/// Puts runs of bad rows among points, at least 6 rows apart; returns which rows are bad.
fn drop_out(points: &mut [[f64; 2]], random: &mut Random) -> Vec<bool> {
    let mut bad = vec![false; points.len()];
    for _ in 0..=random.below(3) {
        let many = 1 + random.below(10);
        let from = 4 + random.below(points.len() - many - 8);
        let around = from.saturating_sub(6)..(from + many + 6).min(points.len());
        if bad[around].iter().any(|bad| *bad) {
            continue;
        }
        let step = random.between(0.5, 10.0) * if random.below(2) == 0 { 1.0 } else { -1.0 };
        let kind = random.below(4);
        for row in from..from + many {
            bad[row] = true;
            points[row] = match kind {
                0 => [points[row][0], 0.0],
                1 => [points[row][0], -9999.0],
                2 => [0.0, 0.0],
                _ => [points[row][0], points[row][1] + step],
            };
        }
    }
    bad
}

/// Takes the minus away from one or two runs of rows: from z, or from x; returns which rows were changed.
fn lose_minus(points: &mut [[f64; 2]], random: &mut Random) -> Vec<bool> {
    let whole = points.to_vec();
    for _ in 0..=random.below(2) {
        let many = 2 + random.below(39);
        let from = 4 + random.below(points.len() - many - 8);
        let axis = usize::from(random.below(3) > 0);
        points[from..from + many].iter_mut().for_each(|at| at[axis] = at[axis].abs());
    }
    points.iter().zip(&whole).map(|(at, was)| at != was).collect()
}

/// A profile with runs of bad rows.
struct BadScan {
    truth: Truth,
    scan: Scan,
    points: Vec<[f64; 2]>,
    /// Which rows are off the surface.
    off: Vec<bool>,
}

/// Spoils rows of points and returns which ones.
type Fault = fn(&mut [[f64; 2]], &mut Random) -> Vec<bool>;

impl BadScan {
    /// The case of a number; `None` if all its bad rows lie on the surface.
    fn random(case: u64) -> Option<Self> {
        Self::with(drop_out, 651, case)
    }

    /// The case of a number under a seed, with rows that a fault spoils; `None` if they all lie on the surface.
    fn with(fault: Fault, seed: u64, case: u64) -> Option<Self> {
        let mut random = Random::stream(seed, case);
        let truth = Truth::random(&mut random);
        let noise = if random.below(3) == 0 { 0.0 } else { random.between(0.0, 0.01) };
        let along_x = random.below(5) < 2;
        let scan = Scan {
            spacing: 0.05 * 10f64.powf(random.uniform()),
            jitter: if random.below(2) == 0 { 0.0 } else { random.between(0.0, 0.6) },
            along_x,
            noise: [if along_x { 0.0 } else { noise }, noise],
        };
        let mut points = truth.scanned(&scan, &mut random);
        let bad = fault(&mut points, &mut random);
        // Zeros may lie on the surface.
        let off = |row: usize| bad[row] && truth.distance(points[row]) > 0.1f64.max(12.0 * noise);
        let off: Vec<bool> = (0..points.len()).map(off).collect();
        off.contains(&true).then_some(Self { truth, scan, points, off })
    }

    fn read(&self, repair: &[Repair]) -> Result<Measured> {
        of_points("scan", &self.points, self.truth.side, &options(repair))
    }

    /// The repairs that its error names.
    fn named(&self) -> Vec<Repair> {
        let said = self.read(&[]).err().map(|error| error.to_string()).unwrap_or_default();
        let all = [Repair::DropDuplicates, Repair::Sort, Repair::RemoveSpikes, Repair::CutLoops];
        all.into_iter().filter(|repair| said.contains(&format!("\"{}\"", repair.name()))).collect()
    }
}

/// Counts of profiles with bad rows.
#[derive(Debug, Default)]
struct BadScans {
    cases: u64,
    silent: u64,
    wrong: u64,
    refused: u64,
}

impl BadScans {
    /// Reads a profile as it is, and with the repair that is named.
    fn add(&mut self, case: u64, bad: &BadScan) {
        self.cases += 1;
        let is_silent = said(&bad.read(&[])).is_empty();
        self.silent += u64::from(is_silent);
        let keeps_bad = |read: &Measured| read.points.iter().any(|point| bad.off[point.number - 1]);
        let named = bad.named();
        let (what, was) = match bad.read(&[Repair::RemoveSpikes]) {
            Err(_) if bad.read(&named).is_ok_and(|read| keeps_bad(&read)) => {
                (format!("wrong after {named:?}"), &mut self.wrong)
            }
            Err(error) => (error.to_string(), &mut self.refused),
            Ok(read) if keeps_bad(&read) => ("wrong after the repair".to_owned(), &mut self.wrong),
            Ok(_) if is_silent => ("silent".to_owned(), &mut 0),
            Ok(_) => return,
        };
        *was += 1;
        let off: Vec<usize> = (0..bad.off.len()).filter(|row| bad.off[*row]).collect();
        let far = off.iter().map(|row| bad.truth.distance(bad.points[*row])).fold(0.0, f64::max);
        let rows = (off.first().map(|row| row + 1), off.last().map(|row| row + 1), off.len());
        println!(
            "case {case}, {} points every {} mm, {rows:?} off by up to {far:.2}: {what}",
            bad.points.len(),
            bad.scan.spacing
        );
    }

    /// Checks that of so many profiles at most one is silent, one wrong after the repair, and one refused after it.
    fn check(&self, [one_silent, one_wrong, one_refused]: [u64; 3]) {
        println!("{self:?}");
        let Self { cases, silent, wrong, refused } = *self;
        assert!(2 * cases > seeds().count() as u64, "{cases} with bad rows");
        let few =
            silent * one_silent <= cases && wrong * one_wrong <= cases && refused * one_refused <= cases;
        assert!(few, "{self:?}");
    }
}

#[test]
fn runs_of_bad_rows_are_named_or_repaired_and_never_taken_for_surface() {
    let mut counts = BadScans::default();
    // Of 739 a run on a steep face has a low step before its first one.
    for case in seeds().chain([739]) {
        BadScan::random(case).iter().for_each(|bad| counts.add(case, bad));
    }
    counts.check([500, 200, 15]);
}

/// The shares are what is reached, not what is wanted: of 682 profiles 3 are silent, 8 wrong after the repair and 5 refused. Most have two
/// runs that make one of more than 40 rows, or end in one another. Of the first 20 one is refused, which needs `sort`, too.
#[test]
fn rows_without_their_minus_are_named_or_repaired_and_never_taken_for_surface() {
    let mut counts = BadScans::default();
    for case in seeds() {
        BadScan::with(lose_minus, 655, case).iter().for_each(|bad| counts.add(case, bad));
    }
    counts.check([200, 80, 12]);
}

#[test]
fn a_path_that_steps_back_without_its_bad_runs_is_refused() {
    // Rows of a steep face a step too low or too high lie beside it: of 322 a run is found in part, of the others none.
    for case in [322, 352, 473, 674, 723, 1267] {
        let bad = BadScan::random(case).expect("bad rows");
        assert!(bad.read(&bad.named()).is_err(), "{case}");
        let read = bad.read(&[Repair::RemoveSpikes]);
        let said = read.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(said.contains("beside itself"), "{case}: {said}");
    }
}

#[test]
fn each_run_is_named_with_its_first_and_its_last_row() {
    let mut random = Random::new(652);
    let rail = Truth {
        side: Side::Rail,
        at: write::sample(&standards::rail("60E1").expect("60E1"), 0.02).expect("60E1"),
    };
    let scan = Scan { spacing: 0.25, jitter: 0.0, along_x: true, noise: [0.0, 0.002] };
    for (from, many, value) in [(30, 2, -9999.0), (40, 7, 0.0), (200, 3, -9.0), (120, 10, 4.0)] {
        let mut points = rail.scanned(&scan, &mut random);
        points[from..from + many].iter_mut().for_each(|point| point[1] = value);
        let said = said(&of_points("scan", &points, Side::Rail, &options(&[])));
        let named = format!("{many} points in a row, point {} to point {}, up to ", from + 1, from + many);
        assert!(said.contains(&named) && said.contains("remove-spikes"), "{value}: {said}");
        let read =
            of_points("scan", &points, Side::Rail, &options(&[Repair::RemoveSpikes])).expect("repaired");
        assert_eq!(read.record.repairs[0].points, many);
    }
}

#[test]
fn worn_profiles_are_not_called_bad() {
    let (cases, mut called) = (scenes(), 0);
    for case in 0..cases {
        let mut random = Random::stream(653, case);
        let mut truth = Truth::random(&mut random);
        let noise = random.between(0.0, 0.01);
        let scan = Scan {
            spacing: 0.05 * 10f64.powf(random.uniform()),
            jitter: random.between(0.0, 0.5),
            along_x: false,
            noise: [noise; 2],
        };
        // Grooves and ridges, round or with edges, across the surface.
        let n = truth.at.len();
        let wear: Vec<_> = (0..1 + random.below(4))
            .map(|_| {
                (
                    random.below(n),
                    random.between(1.0, 8.0).max(5.0 * scan.spacing),
                    random.between(-1.0, 0.4),
                    random.below(2),
                )
            })
            .collect();
        let height = |k: usize| -> f64 {
            let of = |&(at, width, depth, kind): &(usize, f64, f64, usize)| {
                let off = 0.02 * (k as f64 - at as f64).abs() / width;
                depth
                    * 0.4
                    * width.min(3.0)
                    * if kind == 0 { (-2.0 * off * off).exp() } else { (1.0 - off).max(0.0) }
            };
            wear.iter().map(of).sum()
        };
        let worn = |k: usize| {
            let ([a, b], [c, d]) = (truth.at[k - 1], truth.at[k + 1]);
            let length = (c - a).hypot(d - b);
            let [x, z] = truth.at[k];
            [x - height(k) * (d - b) / length, z + height(k) * (c - a) / length]
        };
        truth.at = (1..n - 1).map(worn).collect();
        let points = truth.scanned(&scan, &mut random);
        let said = said(&of_points("worn", &points, truth.side, &options(&[])));
        called += u64::from(!said.is_empty());
    }
    println!("worn profiles: {cases}, called bad: {called}");
    assert!(called * 50 <= cases, "{called}");
}

#[test]
fn noisy_scans_are_read_at_any_spacing() {
    let (cases, mut refused) = (scenes(), 0);
    for case in 0..cases {
        let mut random = Random::stream(654, case);
        let truth = Truth::random(&mut random);
        let noise = random.between(0.0, 0.05);
        let scan = Scan {
            spacing: 0.002 * 250f64.powf(random.uniform()),
            jitter: if random.below(2) == 0 { 0.0 } else { 0.5 },
            along_x: random.below(2) == 0,
            noise: [if random.below(2) == 0 { 0.0 } else { noise }, noise],
        };
        let mut points = truth.scanned(&scan, &mut random);
        // Two scanners: the second one's points come after those of the first, or among them by x.
        if random.below(3) == 0 {
            let middle = 0.5 * (points[0][0] + points[points.len() - 1][0]);
            let (over, offset) = (random.between(2.0, 12.0), noise * random.normal());
            let second = truth.scanned(&scan, &mut random);
            points.retain(|point| point[0] < middle + over);
            points.extend(
                second.into_iter().filter(|point| point[0] > middle - over).map(|[x, z]| [x, z + offset]),
            );
            if scan.along_x && random.below(2) == 0 {
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            }
        }
        // Points 2 µm apart come to lie at one place by the file's last digit.
        match of_points("scan", &points, truth.side, &options(&[Repair::DropDuplicates])) {
            Err(error) => {
                refused += 1;
                println!(
                    "case {case}: {} points every {} mm, noise {noise} mm: {error}",
                    points.len(),
                    scan.spacing
                );
            }
            Ok(read) => {
                let twice = read.record.repairs.iter().filter(|done| done.repair == Repair::DropDuplicates);
                let dropped: usize = twice.map(|done| done.points).sum();
                assert_eq!(read.points.len() + dropped, points.len(), "{case}");
            }
        }
    }
    println!("noisy scans: {cases}, refused: {refused}");
    assert!(refused * 20 <= cases, "{refused}");
}

#[test]
fn two_scanners_and_a_notch_are_read() -> Result<()> {
    let read = |name: &str, repair: &[Repair]| {
        let bytes = std::fs::read(repository("tests/defects").join(name)).expect(name);
        profile(name, &bytes, Side::Rail, &options(repair))
    };
    let sorted = read("two-scanners-appended.txt", &[])?;
    assert!(matches!(&sorted.record.repairs[..], [only] if only.repair == Repair::Sort && only.points > 100));
    assert!(sorted.points.windows(2).all(|pair| pair[0].x <= pair[1].x), "sorted by x");
    assert_eq!(sorted.points.len(), 840);
    let notch = read("c17_d_vnotch.txt", &[])?;
    assert!(
        notch.record.warnings.iter().all(|finding| finding.check != Check::Spike),
        "{:?}",
        notch.record.warnings
    );
    assert!(notch.profile.segments().len() > 100);
    Ok(())
}

#[test]
fn no_real_file_is_said_to_have_bad_rows() -> Result<()> {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let folder = std::path::Path::new(&contact).join("testbank/profiles");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).expect("profiles") {
        let path = entry.expect("a file").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let extension = name.rsplit('.').next().unwrap_or_default().to_lowercase();
        let side = match extension.as_str() {
            "whl" | "prw" => Side::Wheel,
            "ban" | "mpt" | "prr" => Side::Rail,
            _ => continue,
        };
        let bytes = wheelrail::files::read_bytes(&path, wheelrail::measured::LARGEST_FILE)?;
        let repair = [Repair::DropDuplicates, Repair::Sort, Repair::CutLoops];
        let orientation = Options { repair: repair.to_vec(), mirror: Some(false), ..Options::default() };
        let error = profile(&name, &bytes, side, &orientation)
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        assert!(!error.contains("of their neighbours") && !error.contains("of its neighbours"), "{error}");
        read += 1;
    }
    assert!(read > 20, "{read}");
    Ok(())
}
