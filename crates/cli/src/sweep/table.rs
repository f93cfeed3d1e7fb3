//! Computes the table of a sweep block by block.

use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::super::progress::Progress;
use wheelrail::case::ApproachBy;
use wheelrail::error::Result;
use wheelrail::load::curvatures_at;
use wheelrail::search::{
    Conicity, Contact, Position, Selection, Sweep, SweepRow, TrackSide, WheelsetOnTrack,
};

/// Columns of the table.
const HEADER: &str = "lateral_mm,yaw_rad,roll_rad,side,contact,z_mm,rail_x_mm,wheel_x_mm,y_mm,contact_angle_rad,\
                      rolling_radius_mm,delta_r_mm,conicity,gap_mm,skew_rad,rail_curvature_per_mm,\
                      wheel_curvature_per_mm,kink,hertz_xi_mm,hertz_eta_mm\n";

/// Number of positions of one block: enough work for all threads, in little memory.
const BLOCK: usize = 8192;

/// Number of positions that one thread takes at a time.
const CHUNK: usize = 256;

/// The table of a sweep, ready to be computed.
pub(super) struct SweepTable<'a> {
    pub system: &'a Arc<WheelsetOnTrack>,
    pub conicity: Option<Conicity>,
    pub selection: Selection,
    pub positions: Vec<Position>,
    /// Approach or load, and E*, for the contact ellipses; `None` without them.
    pub ellipses: Option<(ApproachBy, f64)>,
}

impl SweepTable<'_> {
    /// Passes the table's text to `sink`, block by block, until the sink wants no more.
    pub(super) fn blocks(
        &self,
        progress: &Progress,
        mut sink: impl FnMut(&str) -> Result<bool>,
    ) -> Result<()> {
        let (start, all) = (Instant::now(), self.positions.len());
        let mut done = 0;
        progress.at(format!("0 of {all} positions"));
        let mut wanted = sink(HEADER)?;
        for block in self.positions.chunks(BLOCK) {
            if !wanted {
                break;
            }
            let texts = block.par_chunks(CHUNK).enumerate();
            let texts =
                texts.map(|(k, chunk)| self.rows(done + k * CHUNK, chunk)).collect::<Result<Vec<_>>>()?;
            done += block.len();
            wanted = sink(&texts.concat())?;
            let rate = done as f64 / start.elapsed().as_secs_f64();
            progress.at(format!("{done} of {all} positions, {rate:.0} a second"));
        }
        Ok(())
    }

    /// Returns the rows of some positions as text. `before` is the number of earlier positions.
    fn rows(&self, before: usize, positions: &[Position]) -> Result<String> {
        let mut sweep = Sweep::new(self.system, self.selection, self.conicity.as_ref());
        let (mut rows, mut text) = (Vec::new(), String::new());
        for (k, position) in positions.iter().enumerate() {
            rows.clear();
            sweep
                .position(position, &mut rows)
                .map_err(|error| error.within(format!("position {}", before + k + 1)))?;
            for row in &rows {
                append(&mut text, row, self.ellipses);
            }
        }
        Ok(text)
    }
}

/// Appends a row as text.
fn append(out: &mut String, row: &SweepRow, ellipses: Option<(ApproachBy, f64)>) {
    let c = &row.contact;
    let side = match row.side {
        TrackSide::Left => "left",
        TrackSide::Right => "right",
    };
    let conicity = row.conicity.map_or(String::new(), |found| found.conicity.to_string());
    let _ = writeln!(
        out,
        "{},{},{},{side},{},{},{},{},{},{},{},{},{conicity},{},{},{},{},{},{}",
        row.lateral,
        row.yaw,
        row.roll,
        row.number + 1,
        row.z,
        c.rail_x,
        c.wheel_x,
        c.y,
        c.contact_angle,
        c.rolling_radius,
        row.delta_r,
        c.gap,
        c.skew,
        c.rail_curvature,
        c.wheel_curvature,
        u8::from(c.kink()),
        semi_axes(c, ellipses)
    );
}

/// Returns the two last cells: the semi-axes of the contact ellipse \[mm\]. They are empty without approach or load, at kinks, and
/// where s is not convex. The load of a wheel counts as if this contact carried all of it; each wheel of an axle carries half.
fn semi_axes(contact: &Contact, ellipses: Option<(ApproachBy, f64)>) -> String {
    let ellipse = |(by, modulus)| {
        let curvatures = curvatures_at(contact);
        let ellipse = match by {
            ApproachBy::Given(approach) => curvatures.under_approach(approach, modulus),
            ApproachBy::WheelLoad(load) => curvatures.under_load(load / contact.contact_angle.cos(), modulus),
            ApproachBy::AxleLoad(load) => {
                curvatures.under_load(load / 2.0 / contact.contact_angle.cos(), modulus)
            }
        };
        let [xi, eta] = curvatures.along(&ellipse?);
        Some(format!("{xi},{eta}"))
    };
    ellipses.and_then(ellipse).unwrap_or_else(|| ",".into())
}
