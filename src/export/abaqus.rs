//! Writes `patch.inp`: the triangle mesh of the patch as input of Abaqus and CalculiX.
//!
//! Node sets are `PATCH`, with all nodes, `BOUNDARY`, and `BOUNDARY_1`, … of each component; element sets are `PATCH`, with all
//! elements, and `COMPONENT_1`, …. The surface `CONTACT` is the side of all elements that faces the wheel. Elements are shells of
//! three nodes (S3); the `*ELEMENT` line of each component names their type. Material, thickness and supports are the user's: a job
//! includes this file and adds them.

use std::fmt::Write as _;

use super::model::{Header, PatchMesh};
use crate::error::Result;

/// Most numbers on a line of a set.
const PER_LINE: usize = 16;

/// Writes `patch.inp`. Numbers of nodes and elements begin with 1.
///
/// Coordinates have 12 significant digits in at most 19 characters: CalculiX ends the reading of nodes at a field of more than
/// 20, and Abaqus cuts it.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn patch_inp(header: &Header, patch: &PatchMesh) -> Result<Vec<u8>> {
    patch.validate()?;
    let mesh = &patch.mesh;
    let mut text = String::from("*HEADING\nwheel/rail patch\n");
    for line in header.statements() {
        let _ = writeln!(text, "** {line}");
    }
    for (k, area) in patch.areas.iter().enumerate() {
        let _ = writeln!(text, "** COMPONENT_{}: exact area {area:?} mm2", k + 1);
    }
    text += "*NODE, NSET=PATCH\n";
    for (node, point) in mesh.points.iter().enumerate() {
        let _ = writeln!(text, "{}, {:.11e}, {:.11e}, {:.11e}", node + 1, point.x, point.y, point.z);
    }
    for component in 0..patch.areas.len() {
        let _ = writeln!(text, "*ELEMENT, TYPE=S3, ELSET=COMPONENT_{}", component + 1);
        for (k, [a, b, c]) in
            mesh.triangles.iter().enumerate().filter(|(k, _)| mesh.component[*k] == component)
        {
            let _ = writeln!(text, "{}, {}, {}, {}", k + 1, a + 1, b + 1, c + 1);
        }
    }
    for component in 0..patch.areas.len() {
        let chains = mesh.boundary.iter().filter(|chain| chain.component == component);
        let nodes = chains.flat_map(|chain| &chain.nodes).copied();
        node_set(&mut text, &format!("BOUNDARY_{}", component + 1), nodes);
    }
    if !mesh.triangles.is_empty() {
        node_set(&mut text, "BOUNDARY", patch.boundary_nodes().into_iter());
        let _ = writeln!(text, "*ELSET, ELSET=PATCH, GENERATE\n1, {}, 1", mesh.triangles.len());
        text += "*SURFACE, NAME=CONTACT, TYPE=ELEMENT\nPATCH, SPOS\n";
    }
    Ok(text.into_bytes())
}

fn node_set(text: &mut String, name: &str, nodes: impl Iterator<Item = usize>) {
    let _ = writeln!(text, "*NSET, NSET={name}");
    let nodes: Vec<String> = nodes.map(|node| (node + 1).to_string()).collect();
    for line in nodes.chunks(PER_LINE) {
        let _ = writeln!(text, "{}", line.join(", "));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, patch_mesh};

    fn written(patch: &PatchMesh) -> String {
        String::from_utf8(patch_inp(&header(), patch).unwrap()).unwrap()
    }

    #[test]
    fn sets_and_the_surface_are_there() {
        let text = written(&patch_mesh());
        for part in [
            "** approach delta = 0.05 mm",
            "*NODE, NSET=PATCH\n1, -1.00000000000e0, -1.00000000000e0, 0.00000000000e0\n",
            "*ELEMENT, TYPE=S3, ELSET=COMPONENT_1\n1, 1, 4, 5\n",
            "*NSET, NSET=BOUNDARY_1\n1, 4, 7, 8, 9, 6, 3, 2\n*NSET, NSET=BOUNDARY\n1, 2, 3, 4, 6, 7, 8, 9\n",
            "*ELSET, ELSET=PATCH, GENERATE\n1, 8, 1\n*SURFACE, NAME=CONTACT, TYPE=ELEMENT\nPATCH, SPOS\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("*PARAMETER"), "no card of CalculiX");
    }

    #[test]
    fn every_field_fits_and_keeps_twelve_digits() {
        let numbers = [-1.234_567_890_123_456_7e-123, f64::MAX, -f64::MIN_POSITIVE, 7.154_957_638_509_771];
        for number in numbers {
            let mut patch = patch_mesh();
            patch.mesh.points[0].x = number;
            let text = written(&patch);
            let node = text.lines().skip_while(|line| !line.starts_with("*NODE")).nth(1).unwrap();
            let field = node.split(", ").nth(1).unwrap();
            assert!(field.len() <= 20, "{field}");
            assert!((field.parse::<f64>().unwrap() / number - 1.0).abs() <= 5e-12, "{field}");
        }
    }
}
