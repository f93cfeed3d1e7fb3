//! Writes `patch.msh`: the triangle mesh of the patch in the text format 4.1 of Gmsh.
//!
//! Every loop of the boundary is a curve with its nodes and edges, every component a surface with its inner nodes and
//! triangles. Physical groups are `boundary_1`, … and `component_1`, …; s at the nodes is node data.

use std::fmt::Write as _;

use nalgebra::Point3;

use super::model::{Header, PatchMesh};
use crate::error::Result;
use crate::mesh::BoundaryChain;

/// Gmsh's number of an edge of two nodes.
const EDGE: u8 = 1;

/// Gmsh's number of a triangle of three nodes.
const TRIANGLE: u8 = 2;

/// A curve or surface of Gmsh with its own nodes and elements. Tags begin with 1, as Gmsh's do; indices of nodes begin with 0.
struct Entity {
    dimension: u8,
    tag: usize,
    physical: usize,
    /// Curves around a surface.
    curves: Vec<usize>,
    /// Indices of the nodes that belong to it and to no curve around it.
    nodes: Vec<usize>,
    /// Indices of the nodes of each element.
    elements: Vec<Vec<usize>>,
}

/// Writes `patch.msh`.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn patch_msh(header: &Header, patch: &PatchMesh) -> Result<Vec<u8>> {
    patch.validate()?;
    let entities = entities(patch);
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n");
    for line in header.statements() {
        let _ = writeln!(text, "{line}");
    }
    for (k, area) in patch.areas.iter().enumerate() {
        let _ = writeln!(text, "component_{}: exact area {area:?} mm2", k + 1);
    }
    text += "$EndComments\n";
    names(&mut text, patch.areas.len());
    outlines(&mut text, patch, &entities);
    nodes(&mut text, patch, &entities);
    elements(&mut text, &entities);
    separation(&mut text, patch);
    Ok(text.into_bytes())
}

/// Returns the curves, then the surfaces.
fn entities(patch: &PatchMesh) -> Vec<Entity> {
    let mesh = &patch.mesh;
    let edges = |chain: &BoundaryChain| {
        let n = chain.nodes.len();
        (0..n).map(|k| vec![chain.nodes[k], chain.nodes[(k + 1) % n]]).collect()
    };
    let curves = mesh.boundary.iter().enumerate().map(|(k, chain)| Entity {
        dimension: 1,
        tag: k + 1,
        physical: chain.component + 1,
        curves: Vec::new(),
        nodes: chain.nodes.clone(),
        elements: edges(chain),
    });
    let boundary = patch.boundary_nodes();
    let surfaces = (0..patch.areas.len()).map(|component| {
        let own = mesh.triangles.iter().zip(&mesh.component).filter(|(_, own)| **own == component);
        let elements: Vec<Vec<usize>> = own.map(|(triangle, _)| triangle.to_vec()).collect();
        let mut nodes: Vec<usize> = elements.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|node| boundary.binary_search(node).is_err());
        let around = (0..mesh.boundary.len()).filter(|&k| mesh.boundary[k].component == component);
        let curves = around.map(|k| k + 1).collect();
        Entity { dimension: 2, tag: component + 1, physical: component + 1, curves, nodes, elements }
    });
    curves.chain(surfaces).collect()
}

fn names(text: &mut String, components: usize) {
    let _ = writeln!(text, "$PhysicalNames\n{}", 2 * components);
    for (dimension, word) in [(1, "boundary"), (2, "component")] {
        for k in 1..=components {
            let _ = writeln!(text, "{dimension} {k} \"{word}_{k}\"");
        }
    }
    *text += "$EndPhysicalNames\n";
}

fn outlines(text: &mut String, patch: &PatchMesh, entities: &[Entity]) {
    let count = |dimension: u8| entities.iter().filter(|entity| entity.dimension == dimension).count();
    let _ = writeln!(text, "$Entities\n0 {} {} 0", count(1), count(2));
    for entity in entities {
        let points = entity.elements.iter().flatten().map(|&node| patch.mesh.points[node]);
        let (mut low, mut high) = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
        points.for_each(|point| (low, high) = (low.inf(&point), high.sup(&point)));
        let _ =
            write!(text, "{} {} {} 1 {}", entity.tag, coordinates(&low), coordinates(&high), entity.physical);
        let _ = write!(text, " {}", entity.curves.len());
        entity.curves.iter().for_each(|curve| {
            let _ = write!(text, " {curve}");
        });
        *text += "\n";
    }
    *text += "$EndEntities\n";
}

fn nodes(text: &mut String, patch: &PatchMesh, entities: &[Entity]) {
    let count = patch.mesh.points.len();
    let _ = writeln!(text, "$Nodes\n{} {count} 1 {count}", entities.len());
    for Entity { dimension, tag, nodes, .. } in entities {
        let _ = writeln!(text, "{dimension} {tag} 0 {}", nodes.len());
        for node in nodes {
            let _ = writeln!(text, "{}", node + 1);
        }
        for &node in nodes {
            let _ = writeln!(text, "{}", coordinates(&patch.mesh.points[node]));
        }
    }
    *text += "$EndNodes\n";
}

fn elements(text: &mut String, entities: &[Entity]) {
    let count: usize = entities.iter().map(|entity| entity.elements.len()).sum();
    let _ = writeln!(text, "$Elements\n{} {count} 1 {count}", entities.len());
    let mut number = 0;
    for Entity { dimension, tag, elements, .. } in entities {
        let kind = if *dimension == 1 { EDGE } else { TRIANGLE };
        let _ = writeln!(text, "{dimension} {tag} {kind} {}", elements.len());
        for element in elements {
            number += 1;
            let _ = write!(text, "{number}");
            element.iter().for_each(|node| {
                let _ = write!(text, " {}", node + 1);
            });
            *text += "\n";
        }
    }
    *text += "$EndElements\n";
}

/// Writes s of all nodes at which it is defined.
fn separation(text: &mut String, patch: &PatchMesh) {
    let known = || patch.separation.iter().enumerate().filter(|(_, s)| !s.is_nan());
    let _ = writeln!(text, "$NodeData\n1\n\"separation\"\n1\n0.0\n3\n0\n1\n{}", known().count());
    for (node, s) in known() {
        let _ = writeln!(text, "{} {s:?}", node + 1);
    }
    *text += "$EndNodeData\n";
}

fn coordinates(point: &Point3<f64>) -> String {
    format!("{:?} {:?} {:?}", point.x, point.y, point.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, patch_mesh};

    #[test]
    fn every_node_and_element_stands_in_one_block() {
        let text = String::from_utf8(patch_msh(&header(), &patch_mesh()).unwrap()).unwrap();
        // Eight nodes on the curve and one inside; eight edges and eight triangles.
        assert!(
            text.contains("$Nodes\n2 9 1 9\n1 1 0 8\n") && text.contains("\n2 1 0 1\n5\n0.0 0.0 0.0\n"),
            "{text}"
        );
        assert!(
            text.contains("$Elements\n2 16 1 16\n1 1 1 8\n1 1 4\n") && text.contains("2 1 2 8\n9 1 4 5\n"),
            "{text}"
        );
        assert!(text.contains("approach delta = 0.05 mm") && text.contains("exact area 7.0 mm2"), "{text}");
        let sections = text.lines().filter(|line| line.starts_with('$')).collect::<Vec<_>>();
        assert!(sections.chunks(2).all(|pair| pair[1] == format!("$End{}", &pair[0][1..])), "{sections:?}");
    }
}
