//! Texts as people write them: read to the digits written, or refused with advice that makes them read.

use std::fmt::Write as _;
use std::path::Path;

use super::*;
use crate::campaign::scenes;
use wheelrail::measured::{Column, SliceList, of_points};

/// Returns the options of an error's advice, in the words of a scene: those for which it gives a value.
fn advised(message: &str) -> Vec<(String, String)> {
    let mut out: Vec<(String, String)> = Vec::new();
    let parts: Vec<&str> = message.split('`').collect();
    for (k, part) in parts.iter().enumerate().skip(1).step_by(2) {
        let value = part.split_once(" = ").map(|(key, value)| (key.to_owned(), value.to_owned()));
        // "the right `unit`: "m" or …".
        let listed = || {
            parts.get(k + 1).and_then(|rest| rest.strip_prefix(": ")?.split(' ').next()).map(str::to_owned)
        };
        let Some((key, value)) = value.or_else(|| Some(((*part).to_owned(), listed()?))) else { continue };
        assert!(value != "[m, n]", "{message}");
        if Options::KEYS.contains(&key.as_str()) && !out.iter().any(|(own, _)| *own == key) {
            out.push((key, value));
        }
    }
    out
}

/// Reads a profile as its messages advise, from these options on; returns also the messages.
fn followed(
    read: &dyn Fn(&Options) -> Result<Measured>,
    options: &str,
    known: &[(&str, &str)],
) -> (Result<Measured>, Vec<String>) {
    let mut table: std::collections::BTreeMap<String, String> = options
        .lines()
        .filter_map(|line| line.split_once(" = ").map(|(key, value)| (key.to_owned(), value.to_owned())))
        .collect();
    let mut messages = Vec::new();
    loop {
        let text: String = table.iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
        let given: Options = toml::from_str(&text).expect(&text);
        let error = match read(&given) {
            Err(error) => error,
            read => return (read, messages),
        };
        messages.push(error.to_string());
        let before = table.clone();
        for (key, value) in advised(&error.to_string()) {
            let truth = known.iter().find(|(own, _)| *own == key);
            table.insert(key, truth.map_or(value, |(_, truth)| (*truth).to_owned()));
        }
        if table == before || messages.len() > 3 {
            return (Err(error), messages);
        }
    }
}

fn defect(name: &str) -> Vec<u8> {
    std::fs::read(repository("tests/defects/texts").join(name)).expect(name)
}

#[test]
fn the_texts_of_practice_are_read_or_say_at_once_what_to_give() -> Result<()> {
    for (name, points, asked) in [
        ("03_latin1_header.csv", 289, ""),
        ("04_de_header.csv", 289, ""),
        ("10_km_blocks.csv", 289, "columns, section"),
        ("12_blankline_blocks.txt", 289, "section"),
        ("15_nan.csv", 282, "mirror"),
        ("18_thousand_sep.csv", 289, "mirror"),
        ("19_unit_in_2nd_row.csv", 289, ""),
        ("21_comma_sep_comma_dec.csv", 289, ""),
    ] {
        let bytes = defect(name);
        let read = |options: &Options| profile(name, &bytes, Side::Rail, options);
        let (read, messages) = followed(&read, "curve = 'interpolation'", &[]);
        let read = read.map_err(|error| error.within(format!("{messages:?}")))?;
        assert_eq!(read.points.len(), points, "{name}");
        match messages.as_slice() {
            [] => assert_eq!(asked, "", "{name}"),
            [one] => assert!(one.contains(&format!("{name}: {asked}: found")), "{name}: {one}"),
            more => panic!("{name}: {more:?}"),
        }
    }
    let mirrored = Options { mirror: Some(false), ..Options::default() };
    let gap = profile("15_nan.csv", &defect("15_nan.csv"), Side::Rail, &mirrored)?;
    let found =
        gap.record.warnings.iter().map(|f| f.found.as_str()).find(|found| found.starts_with("no value"));
    assert_eq!(found, Some("no value in lines 263 to 269: no point over 2.47 mm up to point 262 (line 270)"));
    Ok(())
}

#[test]
fn files_of_other_programs_are_formats() -> Result<()> {
    let option = |text: &str| -> Options { toml::from_str(text).expect(text) };
    let interpolated = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
    let wheel = profile("vampire.whe", &defect("vampire.whe"), Side::Wheel, &interpolated)?.profile;
    for (name, options) in [("virail.wpr", ""), ("simpack-mm-without-unit.prw", "unit = 'mm'")] {
        let options = Options { curve: Some(CurveKind::Interpolation), ..option(options) };
        let read = profile(name, &defect(name), Side::Wheel, &options)?;
        // The same wheel in points 0.5 and 1 mm apart.
        let worst = difference(&read.profile, &wheel, Side::Wheel, [-60.0, 55.0]);
        assert!(worst < 0.05, "{name}: {worst}");
    }
    let bytes = defect("simpack-mm-without-unit.prw");
    let error = profile("w.prw", &bytes, Side::Wheel, &Options::default()).map(drop).unwrap_err().to_string();
    assert!(error.contains("give the right `unit`: \"mm\" would do"), "{error}");
    // The datum of the wheel is 70 mm from its flange back; the gauge point of the rail lies 16 mm below its top.
    let read = profile("vampire.whe", &defect("vampire.whe"), Side::Wheel, &Options::default())?;
    assert_eq!(read.points[0].xz(), [-70.0, -6.6192]);
    let read = profile("vampire.rai", &defect("vampire.rai"), Side::Rail, &Options::default())?;
    let gauge = &read.points[1];
    assert!(gauge.xz()[0].abs() < 0.51 && (gauge.z + 16.0728).abs() < 0.1, "{gauge:?}");
    let top = read.points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    assert!(top.abs() < 1e-12, "{top}");
    assert_eq!(body("vampire.whe", &[], &Options::default())?, Some(Side::Wheel));
    Ok(())
}

#[test]
fn lists_of_positions_and_files_are_read_once_their_unit_is_there() -> Result<()> {
    let list = String::from_utf8(defect("mileage.slcs")).expect("UTF-8");
    let error = SliceList::read(list.as_bytes(), Side::Rail).map(drop).unwrap_err().to_string();
    assert!(
        error.contains("line 1") && error.contains("put `m`, `mm` or `km` on a line of its own before"),
        "{error}"
    );
    let expected = SliceList::read(&defect("fixed.slcs"), Side::Rail)?;
    for (from, to, head) in [
        ("", "", "m"),
        ("", "", "Position [m];Datei"),
        (" nose", ";nose", "m"),
        (" nose", "\tnose", "! m"),
        (" nose", " 'nose", "m"),
        ("153.", "153,", "m"),
        ("153.", "0.153", "km"),
    ] {
        let mut text = format!("{head}\n{list}");
        if !from.is_empty() {
            text = text.replace(from, to);
        }
        if to.ends_with("'nose") {
            text = text.replace(".prr", ".prr' remark");
        }
        let read = SliceList::read(text.as_bytes(), Side::Rail).map_err(|error| error.within(&text))?;
        assert_eq!(read.slices.len(), 5);
        for (own, slice) in read.slices.iter().zip(&expected.slices) {
            assert!((own.at - slice.at).abs() < 1e-6 && own.file == slice.file, "{own:?} {slice:?}");
        }
    }
    let turned = "deg\nflat-1.whl 0\nflat-2.whl 10\n";
    let read = SliceList::read(turned.as_bytes(), Side::Wheel)?;
    assert!((read.slices[1].at - 10f64.to_radians()).abs() < 1e-15 && read.slices[1].file == "flat-2.whl");
    let error = profile("mileage.txt", &defect("mileage.txt"), Side::Rail, &Options::default())
        .map(drop)
        .unwrap_err();
    assert!(error.to_string().contains(".slcs") && error.advice.contains("unit of the positions"), "{error}");
    Ok(())
}

/// Returns the outline of a built-in head with a web and a foot \[mm\], clockwise from the middle of the foot, at most 1 mm apart; the
/// point at the end is not there.
fn outline(name: &str, random: &mut Random) -> Result<Vec<[f64; 2]>> {
    let head = write::sample(&standards::rail(name)?, 0.7)?;
    let (low, web, foot) =
        (random.between(-170.0, -130.0), random.between(6.0, 9.0), random.between(62.0, 75.0));
    let side = [[0.0, low], [foot, low], [foot, low + 10.0], [web, low + 30.0], [web, -45.0]];
    let mirrored = |[x, z]: [f64; 2]| [-x, z];
    let corners: Vec<[f64; 2]> =
        side.into_iter().map(mirrored).chain(head).chain(side.into_iter().rev()).collect();
    let mut out = Vec::new();
    for pair in corners.windows(2) {
        let steps = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]).ceil().max(1.0);
        let at = |k: f64| [0, 1].map(|c| pair[0][c] + (pair[1][c] - pair[0][c]) * k / steps);
        out.extend((0..steps as usize).map(|k| at(k as f64)));
    }
    Ok(out)
}

#[test]
fn closed_outlines_begin_at_the_foot_wherever_their_file_begins() -> Result<()> {
    let text = String::from_utf8(defect("closed-outline-from-crown.txt")).expect("UTF-8");
    let number = |word: &str| word.parse::<f64>().expect(word);
    let row = |line: &str| line.split_once(' ').map(|(x, z)| [number(x), number(z)]);
    let mut own: Vec<[f64; 2]> = text.lines().filter_map(row).collect();
    own.pop();
    let names: Vec<&str> = standards::rail_names().collect();
    for seed in 0..scenes() {
        let mut random = Random::new(9000 + seed);
        let truth =
            if seed == 0 { own.clone() } else { outline(names[random.below(names.len())], &mut random)? };
        let mut file = truth.clone();
        file.rotate_left(random.below(truth.len()));
        let [back, again, down] = [0, 1, 2].map(|_| random.below(2) == 1);
        if back {
            file.reverse();
        }
        if again {
            file.push(file[0]);
        }
        let sign = if down { -1.0 } else { 1.0 };
        let file: String = file.iter().map(|[x, z]| format!("{x} {}\n", sign * z)).collect();
        let options = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
        let read = profile("closed.txt", file.as_bytes(), Side::Rail, &options)
            .map_err(|error| error.within(format!("seed {seed}")))?;
        let points: Vec<[f64; 2]> = read.points.iter().map(|p| p.xz()).collect();
        // From the middle of the foot to the left, over the head to the right, and back; a symmetric rail may be mirrored.
        let lowest = truth.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        assert!(points[0][0].abs() < 5.0 && points[0][1] < lowest + 1e-6, "seed {seed}: {:?}", points[0]);
        let head = |side: f64| points.iter().position(|p| side * p[0] > 20.0 && p[1] > lowest + 125.0);
        assert!(head(-1.0) < head(1.0), "seed {seed}: from left to right");
        let sorted = |mut points: Vec<[f64; 2]>| {
            points.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
            points
        };
        assert_eq!(sorted(points), sorted(truth), "seed {seed}");
    }
    Ok(())
}

#[test]
fn a_question_whose_answers_give_the_same_profile_is_not_asked() -> Result<()> {
    let options = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
    for name in standards::rail_names() {
        let points = write::sample(&standards::rail(name)?, 0.5)?;
        let read = of_points(name, &points, Side::Rail, &options);
        // Heads without side faces and a plain crown leave open where their foot is.
        if let Err(error) = &read {
            assert!(!error.place.contains("mirror") || error.place.contains("flip_z"), "{error}");
        }
        let worn: Vec<[f64; 2]> =
            points.iter().map(|&[x, z]| [x, z - 0.02 * (-(x + 20.0).powi(2) / 50.0).exp()]).collect();
        let error = of_points(name, &worn, Side::Rail, &options).map(drop).unwrap_err();
        assert!(error.place.contains("mirror"), "{error}");
    }
    Ok(())
}

/// How a text of the campaign is written.
#[derive(Debug, Clone)]
struct Writing {
    separator: &'static str,
    decimal: char,
    thousands: &'static str,
    minus: &'static str,
    quoted: bool,
    digits: usize,
    /// Name of the unit and its length in mm.
    unit: (&'static str, f64),
    /// 0: no head that states it; 1: in the titles; 2: in a row of its own.
    unit_in: usize,
    head: Vec<&'static str>,
    missing: &'static str,
    line_end: &'static str,
    /// How several profiles are separated: 0 blank line, 1 comment, 2 repeated titles, 3 a column of numbers, 4 a number of the profile.
    between: usize,
    encoding: usize,
}

impl Writing {
    fn random(random: &mut Random) -> Self {
        fn one<T: Copy>(random: &mut Random, of: &[T]) -> T {
            of[random.below(of.len())]
        }
        let separator = one(random, &[";", "\t", ",", " ", "  "]);
        let quoted = random.below(4) == 0;
        let comma = separator == ";" || separator == "\t" || separator.trim().is_empty() || quoted;
        let decimal = if comma { one(random, &['.', ',']) } else { '.' };
        let other = if decimal == ',' { "." } else { "," };
        let thousands = match separator {
            ";" | "\t" => one(random, &["", "", other, " ", "'"]),
            "," if !quoted => one(random, &["", "'"]),
            _ => "",
        };
        let latin = random.below(5) == 0;
        let unit = one(random, &[("mm", 1.0), ("mm", 1.0), ("m", 1e3), ("cm", 10.0), ("in", 25.4)]);
        let lines = [
            "Messung Gleis 3 - rechts",
            "Querprofil: H\u{f6}he",
            "Date;12.03.2024",
            "Operator",
            "# made by hand",
            "no 17",
        ];
        let head = (0..random.below(4)).map(|_| one(random, &lines)).collect();
        Self {
            separator,
            decimal,
            thousands,
            minus: if latin { "-" } else { one(random, &["-", "-", "\u{2212}"]) },
            quoted,
            digits: 3 + random.below(3) + if unit.1 > 10.0 { 3 } else { 0 },
            unit,
            unit_in: random.below(3),
            head,
            missing: one(random, &["NaN", "nan", "n/a", "1.#QNAN", "#N/A", "null"]),
            line_end: one(random, &["\n", "\n", "\r\n", "\r"]),
            between: random.below(5),
            encoding: if latin { 3 } else { one(random, &[0, 0, 1, 2]) },
        }
    }

    fn number(&self, value: f64) -> String {
        let plain = format!("{:.*}", self.digits, value.abs());
        let (whole, fraction) = plain.split_once('.').unwrap_or((&plain, ""));
        let grouped = match whole.len().checked_sub(3) {
            Some(at) if at > 0 && !self.thousands.is_empty() => {
                format!("{}{}{}", &whole[..at], self.thousands, &whole[at..])
            }
            _ => whole.to_owned(),
        };
        let sign = if value < 0.0 { self.minus } else { "" };
        let text = format!("{sign}{grouped}{}{fraction}", self.decimal);
        if self.quoted { format!("\"{text}\"") } else { text }
    }

    fn text(&self, profiles: &[Vec<[Option<f64>; 2]>]) -> Vec<u8> {
        let s = self.separator;
        let numbered = profiles.len() > 1 && self.between == 3;
        let mut lines: Vec<String> = self.head.iter().map(|line| (*line).to_owned()).collect();
        let titles = match self.unit_in {
            1 => format!("y [{0}]{s}z [{0}]", self.unit.0)
                .replace(" [", if s.trim().is_empty() { "[" } else { " [" }),
            _ => format!("y{s}z"),
        };
        let titles = if numbered { format!("km{s}{titles}") } else { titles };
        lines.push(titles.clone());
        if self.unit_in == 2 {
            lines.push(if numbered {
                format!("km{s}{0}{s}{0}", self.unit.0)
            } else {
                format!("{0}{s}{0}", self.unit.0)
            });
        }
        for (k, profile) in profiles.iter().enumerate() {
            if k > 0 {
                match self.between {
                    0 => lines.push(String::new()),
                    1 => lines.push(format!("# profile {k}")),
                    2 => lines.push(titles.clone()),
                    4 => lines.push(format!("Profil{s}{k}")),
                    _ => {}
                }
            }
            for point in profile {
                let field = |value: &Option<f64>| {
                    value.map_or_else(|| self.missing.to_owned(), |value| self.number(value / self.unit.1))
                };
                let [x, z] = [0, 1].map(|at| field(&point[at]));
                lines.push(if numbered { format!("{}{s}{x}{s}{z}", k + 1) } else { format!("{x}{s}{z}") });
            }
        }
        let text: String = lines.join(self.line_end) + self.line_end;
        match self.encoding {
            1 => [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            2 => "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect(),
            3 => text.chars().map(|c| u8::try_from(c).expect("Latin-1")).collect(),
            _ => text.into_bytes(),
        }
    }
}

#[test]
fn random_texts_are_read_to_their_digits_or_their_advice_makes_them_read() -> Result<()> {
    let (mut at_once, mut by_advice, mut by_marks) = (0, 0, 0);
    for seed in 0..scenes() {
        let mut random = Random::new(6500 + seed);
        let mut writing = Writing::random(&mut random);
        let side = if random.below(3) == 0 { Side::Wheel } else { Side::Rail };
        let shift = if random.below(3) == 0 { 1507.5 } else { 0.0 };
        let drawn = if side == Side::Rail { standards::rail("60E1")? } else { standards::wheel("S1002")? };
        let base = write::sample(&drawn, random.between(0.3, 0.8))?;
        let several = [1, 1, 1, 2, 3][random.below(5)];
        let profiles: Vec<Vec<[Option<f64>; 2]>> = (0..several)
            .map(|k| {
                let wear = 0.4 + 0.1 * f64::from(k);
                let gap = random.below(base.len());
                let gap = if random.below(3) == 0 { gap..gap + 1 + random.below(6) } else { 0..0 };
                let point = |(k, [x, z]): (usize, &[f64; 2])| {
                    let z = z + if side == Side::Rail { -wear } else { wear }
                        * (-(x + 20.0).powi(2) / 60.0).exp();
                    [Some(x + shift), Some(z).filter(|_| !gap.contains(&k))]
                };
                base.iter().enumerate().map(point).collect()
            })
            .collect();
        let known = [
            ("mirror", "false"),
            ("flip_z", "false"),
            ("unit", &*format!("'{}'", writing.unit.0)),
            ("section", "1"),
        ];
        let axes = if random.below(2) == 0 { "\nmirror = false\nflip_z = false" } else { "" };
        let options = &*format!("curve = 'interpolation'{axes}");
        let name = if writing.separator.trim().is_empty() { "a.txt" } else { "a.csv" };
        let mut outcome = None;
        // A text whose marks may mean either is written anew with decimal points, as its message says.
        for round in 0..2 {
            let bytes = writing.text(&profiles);
            let (read, messages) = followed(&|options| profile(name, &bytes, side, options), options, &known);
            match read {
                Ok(read) => {
                    match (round, messages.len()) {
                        (0, 0) => at_once += 1,
                        (0, _) => by_advice += 1,
                        _ => by_marks += 1,
                    }
                    assert!(messages.len() <= 1, "seed {seed}: {messages:?} {writing:?}");
                    outcome = Some(read);
                    break;
                }
                Err(error) => {
                    let rewritten = error.advice.contains("with decimal points");
                    assert!(
                        round == 0 && rewritten,
                        "seed {seed}: {messages:?}\n{writing:?}\n{}",
                        String::from_utf8_lossy(&bytes).lines().take(12).collect::<Vec<_>>().join("\n")
                    );
                    writing = Writing { decimal: '.', thousands: "", quoted: false, ..writing };
                }
            }
        }
        let Some(read) = outcome else { panic!("seed {seed}: not read") };
        let expected: Vec<[f64; 2]> = profiles[0].iter().filter_map(|[x, z]| Some([(*x)?, (*z)?])).collect();
        let digit = 0.5001 * writing.unit.1 * 10f64.powi(-i32::try_from(writing.digits).expect("few digits"));
        assert_eq!(read.points.len(), expected.len(), "seed {seed}: {writing:?}");
        for (p, q) in read.points.iter().zip(&expected) {
            assert!(
                (p.x - q[0]).abs() <= digit && (p.z - q[1]).abs() <= digit,
                "seed {seed}: {p:?} {q:?} {writing:?}"
            );
        }
        let inner =
            profiles[0].iter().skip_while(|p| p[1].is_none()).map(|p| p[1].is_none()).collect::<Vec<_>>();
        let gap = inner
            .iter()
            .position(|missing| *missing)
            .is_some_and(|at| inner[at..].iter().any(|missing| !missing));
        let told = read.record.warnings.iter().any(|finding| finding.found.starts_with("no value"));
        assert_eq!(told, gap, "seed {seed}: {:?}", read.record.warnings);
    }
    println!("{at_once} read at once, {by_advice} by advice, {by_marks} with decimal points");
    Ok(())
}

/// Each profile of CONTACT's repository reads, or what its message advises makes it read.
#[test]
fn every_profile_of_contact_reads_or_its_message_followed_makes_it_read() {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return };
    let mut folders = vec![Path::new(&contact).to_path_buf()];
    let (mut read, mut bad) = (0, String::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.display().to_string();
            let extension = name.rsplit('.').next().unwrap_or_default().to_lowercase();
            let list = ["slcs", "slcw"].contains(&extension.as_str());
            if !list && !["ban", "whl", "mpt", "prr", "prw", "csv"].contains(&extension.as_str()) {
                continue;
            }
            let side = Format::body_of_file(&name).unwrap_or(Side::Rail);
            let place = match (list, side) {
                (false, _) => "",
                (true, Side::Rail) => "along = 0.0",
                (true, Side::Wheel) => "angle = 0.0",
            };
            let reading =
                |options: &Options| match wheelrail::scene::read_profile(&path, Some(side), options)? {
                    wheelrail::scene::ProfileSource::Measured(measured) => Ok(*measured),
                    wheelrail::scene::ProfileSource::Drawn(_) => {
                        Err(Error::new(&name, "drawn", "measured", ""))
                    }
                };
            let (outcome, messages) = followed(&reading, place, &[]);
            read += 1;
            if let Err(error) = outcome {
                let _ = writeln!(bad, "{messages:#?} {error}");
            } else if messages.len() > 1 {
                let _ = writeln!(bad, "several messages: {messages:#?}");
            }
        }
    }
    assert!(bad.is_empty() && read > 100, "{read} files: {bad}");
}

#[test]
fn columns_by_their_titles_with_units_are_found() -> Result<()> {
    let text = "km;y [mm];z [mm]\n1;-20;-1\n1;0;0\n1;10;-1\n1;20;-3\n1;30;-14\n";
    let columns = [Column::Name("y".into()), Column::Name("z".into())];
    let options =
        Options { columns: Some(columns), mirror: Some(false), flip_z: Some(false), ..Options::default() };
    assert_eq!(profile("a.csv", text.as_bytes(), Side::Rail, &options)?.points.len(), 5);
    Ok(())
}
