//! The files of a grid over the rail's surface.

use super::conformal::Conformal;
use super::formats::OutputFormat;
use super::input::Outputs;
use super::site::{Site, cut_by, ends};
use crate::conformal::NormalGap;
use crate::error::{Error, Result};
use crate::export::{CurvedFields, GridFields};

/// What the files of a grid over the rail's surface are written from.
pub(super) struct OnRail<'a> {
    site: &'a Site,
    conformal: &'a Conformal,
    /// σ \[mm\].
    sigma: Vec<f64>,
    height: Vec<f64>,
    normal: Vec<[f64; 2]>,
    wheel_normal: Vec<[f64; 3]>,
}

impl<'a> OnRail<'a> {
    /// Takes the rail's surface from the conformal gap, and computes the wheel's normals at every point.
    pub fn new(site: &'a Site, conformal: &'a Conformal) -> Self {
        let (gap, eta) = (NormalGap::new(&site.contact.placement), &site.grid.eta);
        let normal_at = |sigma: f64, eta: f64| {
            let normal = gap.point(sigma, eta).and_then(|point| point.wheel_normal);
            normal.map_or([f64::NAN; 3], |normal| [normal.x, normal.y, normal.z])
        };
        let rail = &conformal.rail;
        Self {
            site,
            conformal,
            sigma: rail.iter().map(|at| at.sigma).collect(),
            height: rail.iter().map(|at| at.zeta).collect(),
            normal: rail.iter().map(|at| [-at.sin, at.cos]).collect(),
            wheel_normal: rail
                .iter()
                .flat_map(|at| eta.iter().map(move |&eta| normal_at(at.sigma, eta)))
                .collect(),
        }
    }

    /// Gives the fields as writers take them.
    ///
    /// # Errors
    /// A grid without points.
    pub fn fields(&self) -> Result<CurvedFields<'_>> {
        let grid = &self.site.grid;
        let fields = GridFields::new(&grid.xi, &grid.eta, &self.conformal.gap, &self.height, &self.normal)?;
        CurvedFields::new(&self.sigma, fields, &self.wheel_normal)
    }

    /// Gives the rows \[σ, ξ, η_min, η_max\] of INTERPEN's table over the rail's surface, each with whether its ends lie at the window's.
    pub fn intervals(&self) -> Vec<([f64; 4], [bool; 2])> {
        let Some(patch) = &self.conformal.patch else { return Vec::new() };
        let window = ends(&self.site.grid.eta);
        let rows = self.sigma.iter().zip(&self.site.grid.xi).flat_map(|(&sigma, &xi)| {
            let slices = patch.slices(sigma).into_iter();
            slices.map(move |(_, slice)| ([sigma, xi, slice.eta[0], slice.eta[1]], cut_by(window, slice.eta)))
        });
        rows.collect()
    }

    /// Refuses formats that have no form over the rail's surface: an error where they are required, and a remark elsewhere.
    ///
    /// # Errors
    /// The first such format that the scene names.
    pub fn refuse(outputs: &Outputs, skipped: &mut Vec<String>) -> Result<()> {
        for (format, file) in
            OutputFormat::ALL.iter().filter_map(|format| Some((format, format.plane_only()?)))
        {
            if !outputs.formats.contains(format) {
                continue;
            }
            if outputs.required {
                let found = format!("\"{}\" with grid.reference = \"rail\"", format.name());
                let expected = "formats other than netcdf, text and countact";
                let advice = format!("{file} needs equal steps of xi: leave it out, or take the plane");
                return Err(Error::new("output: formats", found, expected, advice));
            }
            skipped.push(format!("{file}: it has no form over the rail's surface"));
        }
        Ok(())
    }
}
