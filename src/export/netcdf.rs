//! Writes `separation.nc` and `table.nc` in NetCDF-3 classic. It is the one format that tells sizes, units and mask to
//! SurfaceTopography and ContactMechanics.
//!
//! `separation.nc`: dimensions x (= ξ) and y (= η); variables `x`, `y` \[mm\] (cell centres), `heights(x, y)` = −s \[mm\] and, if a
//! body has no surface somewhere, `mask(x, y)` (1 = undefined); `pressure(x, y)` \[N/mm²\] where it was solved. The sign of −s is
//! right because those programs press a rigid flat down onto `heights`. The writer is our own: the format is small, and the
//! crates for it write only to paths.

use super::block::{Block, put_f64_be};
use super::model::{GridFields, Header};
use crate::error::Result;
use crate::table::{About, COEFFICIENTS, Cell, ContactTable, Lacks};
use serde_json::json;
use std::io::{self, Write};

const DIMENSION: u32 = 10;
const VARIABLE: u32 = 11;
const ATTRIBUTE: u32 = 12;

const BYTE: u32 = 1;
const CHAR: u32 = 2;
const INT: u32 = 4;
const DOUBLE: u32 = 6;

/// Length of the longest file whose offsets fit the first version's signed 32 bits; longer files have 64-bit
/// offsets.
const CLASSIC_LIMIT: u64 = (1 << 31) - 1;

/// One variable: its entry in the header, and the length of its data.
struct Variable {
    name: &'static str,
    /// Numbers of the variable's dimensions.
    dimensions: &'static [u32],
    attributes: Vec<u8>,
    attribute_count: u32,
    kind: u32,
    /// Bytes of the data, before padding to four.
    size: u64,
}

/// A file ready to be written: everything but the large arrays.
pub struct NetCdf<'a> {
    grid: &'a GridFields<'a>,
    head: Vec<u8>,
    masked: bool,
}

impl<'a> NetCdf<'a> {
    /// Prepares the file.
    ///
    /// # Errors
    /// A grid of unequal steps, or of one row or column, because the readers take the size of the grid, not the places of its points.
    pub fn new(header: &Header, grid: &'a GridFields<'a>) -> Result<Self> {
        let steps = grid.steps("netcdf")?;
        let masked = grid.separation().iter().any(|s| s.is_nan());
        Ok(Self { grid, head: head(header, grid, steps, masked), masked })
    }

    /// Writes the file.
    ///
    /// # Errors
    /// The errors of the sink.
    pub fn write(&self, sink: &mut dyn Write) -> io::Result<()> {
        let mut block = Block::new(sink);
        block.bytes(&self.head)?;
        let (xi, eta) = (self.grid.xi(), self.grid.eta());
        for axis in [xi, eta] {
            put_f64_be(block.room(8 * axis.len())?, axis.iter().copied());
        }
        for i in 0..xi.len() {
            put_f64_be(block.room(8 * eta.len())?, self.grid.column(i).iter().map(|s| -s));
        }
        if let Some(pressure) = self.grid.pressure() {
            for column in pressure.chunks_exact(eta.len()) {
                put_f64_be(block.room(8 * eta.len())?, column.iter().copied());
            }
        }
        if self.masked {
            for i in 0..xi.len() {
                let room = block.room(eta.len())?;
                room.iter_mut().zip(self.grid.column(i)).for_each(|(m, s)| *m = u8::from(s.is_nan()));
            }
            block.bytes(&[0; 3][..padding(self.grid.separation().len() as u64) as usize])?;
        }
        block.finish()
    }
}

fn padding(size: u64) -> u64 {
    size.wrapping_neg() % 4
}

fn head(header: &Header, grid: &GridFields, steps: [f64; 2], masked: bool) -> Vec<u8> {
    let variables = variables(grid, steps, masked);
    let total: u64 = variables.iter().map(|v| v.size + padding(v.size)).sum();
    let mut bytes = first_part(header, grid);
    let entries = |wide: bool, begin: u64| entries(&variables, wide, begin);
    // The width of the offsets decides the length of the header, and the length of the header decides the offsets.
    let narrow = bytes.len() as u64 + entries(false, 0).len() as u64;
    let wide = narrow + total > CLASSIC_LIMIT;
    let begin = bytes.len() as u64 + entries(wide, 0).len() as u64;
    bytes[3] = if wide { 2 } else { 1 };
    bytes.extend(entries(wide, begin));
    bytes
}

/// Returns magic, record count, dimensions and global attributes.
fn first_part(header: &Header, grid: &GridFields) -> Vec<u8> {
    let mut bytes = b"CDF\x01".to_vec();
    put(&mut bytes, 0);
    put(&mut bytes, DIMENSION);
    put(&mut bytes, 2);
    for (name, axis) in [("x", grid.xi()), ("y", grid.eta())] {
        put_name(&mut bytes, name);
        put(&mut bytes, axis.len() as u32);
    }
    put(&mut bytes, ATTRIBUTE);
    put(&mut bytes, 1);
    put_text(&mut bytes, "json", &information(header));
    bytes
}

/// Returns the statements for which the format has no field, as the readers' `info` dictionary.
fn information(header: &Header) -> String {
    let frame = &header.frame;
    json!({
        "title": header.title,
        "program": format!("wheelrail {}", header.version),
        "scene": header.scene_hash,
        "approach_mm": header.approach,
        "frame": {
            "origin_mm": frame.origin.coords.as_slice(),
            "xi": frame.xi.as_slice(),
            "eta": frame.eta.as_slice(),
            "zeta": frame.zeta.as_slice(),
        },
        "heights": "minus the separation s; x = xi, y = eta",
        "statements": header.statements(),
    })
    .to_string()
}

fn variables(grid: &GridFields, steps: [f64; 2], masked: bool) -> Vec<Variable> {
    let axis = |name, dimensions, values: &[f64], step: f64| {
        let mut attributes = Vec::new();
        // The size is that of a grid of cells, not the distance of its outer points.
        put_double(&mut attributes, "length", values.len() as f64 * step);
        put_text(&mut attributes, "unit", "mm");
        put_int(&mut attributes, "periodic", 0);
        let size = 8 * values.len() as u64;
        Variable { name, dimensions, attributes, attribute_count: 3, kind: DOUBLE, size }
    };
    let points = grid.separation().len() as u64;
    let unit = |name| {
        let mut unit = Vec::new();
        put_text(&mut unit, "unit", name);
        unit
    };
    let plane = |name, attributes, attribute_count, kind, size| Variable {
        name,
        dimensions: &[0, 1],
        attributes,
        attribute_count,
        kind,
        size,
    };
    let mut variables = vec![
        axis("x", &[0], grid.xi(), steps[0]),
        axis("y", &[1], grid.eta(), steps[1]),
        plane("heights", unit("mm"), 1, DOUBLE, 8 * points),
    ];
    if grid.pressure().is_some() {
        variables.push(plane("pressure", unit("N/mm2"), 1, DOUBLE, 8 * points));
    }
    if masked {
        variables.push(plane("mask", Vec::new(), 0, BYTE, points));
    }
    variables
}

/// Returns the list of variables. The data of the first variable are at offset `begin`.
fn entries(variables: &[Variable], wide: bool, mut begin: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    put(&mut bytes, VARIABLE);
    put(&mut bytes, variables.len() as u32);
    for variable in variables {
        put_name(&mut bytes, variable.name);
        put(&mut bytes, variable.dimensions.len() as u32);
        variable.dimensions.iter().for_each(|&dimension| put(&mut bytes, dimension));
        put(&mut bytes, if variable.attribute_count == 0 { 0 } else { ATTRIBUTE });
        put(&mut bytes, variable.attribute_count);
        bytes.extend(&variable.attributes);
        put(&mut bytes, variable.kind);
        let padded = variable.size + padding(variable.size);
        // The format's own value for "too long for this field": readers then use the dimensions.
        put(&mut bytes, u32::try_from(padded).unwrap_or(u32::MAX));
        if wide {
            bytes.extend(begin.to_be_bytes());
        } else {
            put(&mut bytes, begin as u32);
        }
        begin += padded;
    }
    bytes
}

/// Length of the texts of a table: names and sides.
const NAME: usize = 24;

/// Writes `table.nc`, a contact table.
///
/// Dimensions cell, quantity, power, side (left, right), end and name. Variables `lateral(cell, end)` \[mm\], `begins(cell)`,
/// `touches(cell)` and `lacks(cell, side)` with the codes of the text table; `quantity_name(quantity, name)`,
/// `quantity_side(quantity, name)`, `needs(quantity)`, `tolerance(quantity)` and `error(quantity)` in each quantity's unit;
/// `coefficients(cell, quantity, power)` of 1, t, … t⁸, NaN where a quantity does not exist.
///
/// Over yaw there is also the dimension yaw_power: `lateral(cell, end, yaw_power)` and `coefficients(cell, quantity, yaw_power, power)`
/// have the coefficients of u^j and u^j tᵏ, with u from −1 to 1 over the yaws of the cell, `yaw(cell, end)` \[rad\].
pub fn table_nc(table: &ContactTable, title: &str) -> Vec<u8> {
    let about = table.about();
    let all =
        [table.cells().len(), table.quantities().len(), COEFFICIENTS, 2, 2, NAME, about.yaw_coefficients()];
    let sizes = &all[..6 + usize::from(about.over_yaw())];
    let mut bytes = b"CDF\x01".to_vec();
    put(&mut bytes, 0);
    put(&mut bytes, DIMENSION);
    put(&mut bytes, sizes.len() as u32);
    let names = ["cell", "quantity", "power", "side", "end", "name", "yaw_power"];
    for (name, size) in names.into_iter().zip(sizes) {
        put_name(&mut bytes, name);
        put(&mut bytes, *size as u32);
    }
    put_about(&mut bytes, about, title);
    let variable = |name, dimensions: &'static [u32], kind| {
        let count: usize = dimensions.iter().map(|&dimension| sizes[dimension as usize]).product();
        let size = (count * if kind == DOUBLE { 8 } else { 1 }) as u64;
        Variable { name, dimensions, attributes: Vec::new(), attribute_count: 0, kind, size }
    };
    let [lateral, coefficients]: [&[u32]; 2] =
        if about.over_yaw() { [&[0, 4, 6], &[0, 1, 6, 2]] } else { [&[0, 4], &[0, 1, 2]] };
    let mut variables = vec![
        variable("lateral", lateral, DOUBLE),
        variable("begins", &[0], BYTE),
        variable("touches", &[0], BYTE),
        variable("lacks", &[0, 3], BYTE),
        variable("quantity_name", &[1, 5], CHAR),
        variable("quantity_side", &[1, 5], CHAR),
        variable("needs", &[1], BYTE),
        variable("tolerance", &[1], DOUBLE),
        variable("error", &[1], DOUBLE),
        variable("coefficients", coefficients, DOUBLE),
    ];
    if about.over_yaw() {
        variables.push(variable("yaw", &[0, 4], DOUBLE));
    }
    let begin = (bytes.len() + entries(&variables, false, 0).len()) as u64;
    bytes.extend(entries(&variables, false, begin));
    put_table(&mut bytes, table);
    bytes
}

/// Appends the attributes of a table.
fn put_about(bytes: &mut Vec<u8>, about: About, title: &str) {
    let [first, last] = about.yaw.ends();
    let yaws: &[_] = if about.over_yaw() {
        &[("yaw_from_rad", first), ("yaw_to_rad", last)]
    } else {
        &[("yaw_rad", first)]
    };
    put(bytes, ATTRIBUTE);
    put(bytes, 5 + yaws.len() as u32);
    put_text(bytes, "title", title);
    put_text(bytes, "program", concat!("wheelrail ", env!("CARGO_PKG_VERSION")));
    yaws.iter().for_each(|(name, yaw)| put_double(bytes, name, *yaw));
    put_double(bytes, "nominal_radius_mm", about.radius);
    put_double(bytes, "tolerance_mm", about.tolerance);
    put_double(bytes, "beside_curves_mm", about.beside_curves());
}

/// Appends the data of a table, in the order of its variables.
fn put_table(bytes: &mut Vec<u8>, table: &ContactTable) {
    let (cells, quantities) = (table.cells(), table.quantities());
    let (curves, powers) = (table.curves(), table.about().yaw_coefficients());
    let text = |text: &str| {
        let mut name = [0; NAME];
        name.iter_mut().zip(text.bytes()).for_each(|(place, byte)| *place = byte);
        name
    };
    let ends = |cell: &Cell| cell.curves.map(|curve| curves[curve].over(cell.yaw));
    put_doubles(bytes, cells.iter().flat_map(ends).flat_map(|end| end.into_iter().take(powers)));
    put_codes(bytes, (0..cells.len()).map(|cell| table.begins(cell).code()));
    put_codes(bytes, cells.iter().map(|cell| u8::from(cell.touches)));
    put_codes(bytes, cells.iter().flat_map(|cell| cell.lacks.map(Lacks::code)));
    put_codes(bytes, quantities.iter().flat_map(|quantity| text(quantity.name)));
    put_codes(bytes, quantities.iter().flat_map(|quantity| text(quantity.side())));
    put_codes(bytes, quantities.iter().map(|quantity| quantity.needs.code()));
    put_doubles(bytes, quantities.iter().map(|quantity| quantity.tolerance));
    put_doubles(bytes, quantities.iter().map(|quantity| quantity.error));
    let row = |cell, quantity| (0..powers).flat_map(move |j| table.coefficients(cell, quantity, j));
    let of = |cell| (0..quantities.len()).flat_map(move |quantity| row(cell, quantity));
    put_doubles(bytes, (0..cells.len()).flat_map(of));
    if table.about().over_yaw() {
        put_doubles(bytes, cells.iter().flat_map(|cell| cell.yaw.ends()));
    }
}

fn put_doubles(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = f64>) {
    numbers.for_each(|number| bytes.extend(number.to_be_bytes()));
}

/// Appends bytes, with zeros up to a multiple of four.
fn put_codes(bytes: &mut Vec<u8>, codes: impl Iterator<Item = u8>) {
    bytes.extend(codes);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

fn put(bytes: &mut Vec<u8>, value: u32) {
    bytes.extend(value.to_be_bytes());
}

fn put_name(bytes: &mut Vec<u8>, name: &str) {
    put(bytes, name.len() as u32);
    bytes.extend(name.as_bytes());
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

fn put_text(bytes: &mut Vec<u8>, name: &str, text: &str) {
    put_name(bytes, name);
    put(bytes, CHAR);
    put_name(bytes, text);
}

fn put_double(bytes: &mut Vec<u8>, name: &str, value: f64) {
    put_name(bytes, name);
    put(bytes, DOUBLE);
    put(bytes, 1);
    bytes.extend(value.to_be_bytes());
}

fn put_int(bytes: &mut Vec<u8>, name: &str, value: i32) {
    put_name(bytes, name);
    put(bytes, INT);
    put(bytes, 1);
    bytes.extend(value.to_be_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header};

    #[test]
    fn data_lie_where_the_head_says() {
        let sample = Sample::new(3, 3);
        let grid = sample.fields();
        let file = NetCdf::new(&header(), &grid).unwrap();
        let mut bytes = Vec::new();
        file.write(&mut bytes).unwrap();
        assert_eq!(&bytes[..4], b"CDF\x01");
        let begin = file.head.len();
        assert_eq!(begin % 4, 0);
        let value = |at: usize| f64::from_be_bytes(bytes[at..at + 8].try_into().unwrap());
        assert_eq!(value(begin), sample.xi[0]);
        assert_eq!(value(begin + 48 + 8), -sample.separation[1]);
        // The offset of the last variable is at the end of the header.
        let mask = u32::from_be_bytes(bytes[begin - 4..begin].try_into().unwrap()) as usize;
        assert_eq!(mask, begin + 48 + 72);
        assert_eq!(&bytes[mask..], [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn uneven_grids_are_refused() {
        let mut sample = Sample::new(3, 3);
        sample.xi[1] += 0.01;
        assert!(NetCdf::new(&header(), &sample.fields()).is_err());
    }
}
