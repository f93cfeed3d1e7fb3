//! Reading of the 60-digit reference files, shared by the integration tests.
#![allow(dead_code, reason = "each integration test uses its own part")]

use std::path::{Path, PathBuf};

use serde::Deserialize;
use wheelrail::Result;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape};

/// One file of `tests/reference`.
#[derive(Debug, Clone, Deserialize)]
pub struct Reference {
    pub scene: ReferenceScene,
    pub separation: Vec<(f64, f64, Option<String>)>,
    pub boundary: Vec<(f64, f64, Option<String>)>,
    #[serde(skip)]
    pub name: String,
}

#[derive(Debug, Clone, Deserialize)]
pub struct ReferenceScene {
    pub rail: Vec<ReferenceSegment>,
    pub wheel: Vec<ReferenceSegment>,
    pub wheel_radius: f64,
    pub contact_rail_x: f64,
    pub contact_wheel_x: f64,
    #[serde(default)]
    pub chi: f64,
    pub xi: Vec<f64>,
    pub eta: Vec<f64>,
    pub delta: Vec<f64>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ReferenceSegment {
    Line { x0: f64, z0: f64, x1: f64, z1: f64 },
    Arc { x0: f64, x1: f64, a: f64, b: f64, r: f64, sigma: f64 },
    Poly { x0: f64, x1: f64, c: Vec<f64> },
    Spline { t1: f64, cx: Vec<f64>, cz: Vec<f64> },
}

impl ReferenceSegment {
    pub fn segment(&self) -> Result<Segment> {
        let shape = match self {
            Self::Line { x0, z0, x1, z1 } => Shape::Arc(Arc::line([*x0, *z0], [*x1, *z1])?),
            Self::Arc { x0, x1, a, b, r, sigma } => {
                let half = if *sigma > 0.0 { Half::Upper } else { Half::Lower };
                Shape::Arc(Arc::about([*a, *b], *r, half, [*x0, *x1])?)
            }
            Self::Spline { t1, cx, cz } => Shape::Polynomial(Polynomial::span(cx, cz, [0.0, *t1])?),
            Self::Poly { x0, x1, c } => Shape::Polynomial(Polynomial::graph(c, [*x0, *x1])?),
        };
        Ok(Segment { label: String::new(), shape })
    }
}

pub fn chain(name: &str, segments: &[ReferenceSegment]) -> Result<Profile> {
    Profile::new(name, "reference", segments.iter().map(ReferenceSegment::segment).collect::<Result<_>>()?)
}

impl Reference {
    pub fn placement(&self) -> Result<Placement> {
        let (rail, wheel) = (chain("rail", &self.scene.rail)?, chain("wheel", &self.scene.wheel)?);
        let pair = Pair::new(rail, wheel, self.scene.wheel_radius)?;
        pair.placed(self.scene.contact_rail_x, self.scene.contact_wheel_x, self.scene.chi)
    }

    /// Largest radius of either body \[mm\], R included: the scale of absolute bounds.
    pub fn largest_radius(&self) -> f64 {
        let radius = |segment: &ReferenceSegment| match segment {
            ReferenceSegment::Arc { r, .. } => *r,
            _ => 0.0,
        };
        self.scene.rail.iter().chain(&self.scene.wheel).map(radius).fold(0.0, f64::max)
    }
}

pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

/// All reference files of a folder below `tests`, in order of their names; at least one.
pub fn references(name: &str) -> Vec<Reference> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder(name))
        .expect("the folder of reference values")
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no reference values in tests/{name}");
    files
        .into_iter()
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a readable reference file");
            let mut reference: Reference = serde_json::from_str(&text).expect("a reference file");
            reference.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            reference
        })
        .collect()
}
