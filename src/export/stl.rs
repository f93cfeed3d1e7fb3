//! Writes triangulated surfaces as STL, in text: the binary form holds numbers of seven digits, which would merge the nodes of a
//! small patch.

use std::fmt::Write as _;

use nalgebra::{Point3, Vector3};

use super::model::{Header, SurfaceMesh};
use crate::error::Result;

/// Writes a surface under its name. The format has no place for the header.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn surface_stl(_: &Header, mesh: &SurfaceMesh) -> Result<Vec<u8>> {
    mesh.validate()?;
    let name = mesh.name;
    let mut text = format!("solid {name}\n");
    for triangle in &mesh.triangles {
        let corners @ [a, b, c] = triangle.map(|node| mesh.points[node]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let _ = writeln!(text, "facet normal {}\nouter loop", numbers(&Point3::from(normal)));
        for corner in &corners {
            let _ = writeln!(text, "vertex {}", numbers(corner));
        }
        text += "endloop\nendfacet\n";
    }
    let _ = writeln!(text, "endsolid {name}");
    Ok(text.into_bytes())
}

fn numbers(point: &Point3<f64>) -> String {
    format!("{:e} {:e} {:e}", point.x, point.y, point.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, patch_mesh};

    #[test]
    fn facets_point_outwards() {
        let text = String::from_utf8(surface_stl(&header(), &patch_mesh().surface()).unwrap()).unwrap();
        assert!(text.starts_with("solid patch\n") && text.ends_with("endsolid patch\n"), "{text}");
        assert_eq!(text.matches("facet normal 0e0 0e0 1e0\n").count(), 8, "{text}");
        assert_eq!(text.matches("vertex ").count(), 24, "{text}");
    }
}
