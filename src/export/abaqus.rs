//! Writes `patch.inp`: the triangle mesh of the patch as input of Abaqus.
//!
//! Node sets are `PATCH`, with all nodes, and `BOUNDARY_1`, … of each component; element sets are `COMPONENT_1`, …. δ is the
//! parameter `delta`. Elements are shells of three nodes (S3): they are changed to another kind in one place.

use std::fmt::Write as _;

use super::model::{Header, PatchMesh};
use crate::error::Result;

/// Most numbers on a line of a set.
const PER_LINE: usize = 16;

/// Writes `patch.inp`. Numbers of nodes and elements begin with 1.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn patch_inp(header: &Header, patch: &PatchMesh) -> Result<Vec<u8>> {
    patch.validate()?;
    let mesh = &patch.mesh;
    let mut text = String::from("*HEADING\npatch of wheel and rail\n");
    for line in header.statements() {
        let _ = writeln!(text, "** {line}");
    }
    for (k, area) in patch.areas.iter().enumerate() {
        let _ = writeln!(text, "** COMPONENT_{}: exact area {area:?} mm2", k + 1);
    }
    let _ = writeln!(text, "*PARAMETER\ndelta = {:?}", header.approach);
    text += "*NODE, NSET=PATCH\n";
    for (node, point) in mesh.points.iter().enumerate() {
        let _ = writeln!(text, "{}, {:?}, {:?}, {:?}", node + 1, point.x, point.y, point.z);
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
        let _ = writeln!(text, "*NSET, NSET=BOUNDARY_{}", component + 1);
        let chains = mesh.boundary.iter().filter(|chain| chain.component == component);
        let nodes: Vec<String> =
            chains.flat_map(|chain| &chain.nodes).map(|node| (node + 1).to_string()).collect();
        for line in nodes.chunks(PER_LINE) {
            let _ = writeln!(text, "{}", line.join(", "));
        }
    }
    Ok(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, patch_mesh};

    #[test]
    fn sets_and_the_approach_are_there() {
        let text = String::from_utf8(patch_inp(&header(), &patch_mesh()).unwrap()).unwrap();
        for part in [
            "*PARAMETER\ndelta = 0.05\n*NODE, NSET=PATCH\n1, -1.0, -1.0, 0.0\n",
            "*ELEMENT, TYPE=S3, ELSET=COMPONENT_1\n1, 1, 4, 5\n",
            "*NSET, NSET=BOUNDARY_1\n1, 4, 7, 8, 9, 6, 3, 2\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }
}
