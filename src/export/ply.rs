//! Writes triangulated surfaces as PLY: binary, little-endian, in double precision, for viewers of meshes and of points.

use super::model::{Header, SurfaceMesh};
use crate::error::{Error, Result};

/// Writes a surface with s \[mm\] (`separation`, NaN where undefined) and the outward unit normal (`nx`, `ny`, `nz`) at its points.
/// The header's statements are comments.
///
/// # Errors
/// A mesh that contradicts itself; more than 2³¹ − 1 points, the most that the numbers of a face hold.
pub fn surface_ply(header: &Header, mesh: &SurfaceMesh) -> Result<Vec<u8>> {
    mesh.validate()?;
    let index = |node: &usize| {
        i32::try_from(*node).map_err(|_| {
            let (found, expected) = (format!("{} points", mesh.points.len()), "at most 2147483647");
            Error::new("PLY file", found, expected, "take a larger mesh.size")
        })
    };
    let comments: String = header.statements().iter().map(|line| format!("comment {line}\n")).collect();
    let properties: String = ["x", "y", "z", "nx", "ny", "nz", "separation"]
        .iter()
        .map(|name| format!("property double {name}\n"))
        .collect();
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\n{comments}element vertex {}\n{properties}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        mesh.points.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for ((point, normal), s) in mesh.points.iter().zip(&mesh.normals).zip(&mesh.separation) {
        let values = point.coords.iter().chain(normal.iter()).chain([s]);
        values.for_each(|value| file.extend(value.to_le_bytes()));
    }
    for triangle in &mesh.triangles {
        file.push(3);
        for node in triangle {
            file.extend(index(node)?.to_le_bytes());
        }
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, patch_mesh};

    #[test]
    fn points_and_faces_follow_the_header_bit_for_bit() {
        let surface = patch_mesh().surface();
        let file = surface_ply(&header(), &surface).unwrap();
        let end = b"end_header\n";
        let begin = file.windows(end.len()).position(|bytes| bytes == end).unwrap() + end.len();
        let text = std::str::from_utf8(&file[..begin]).unwrap();
        assert!(text.starts_with("ply\nformat binary_little_endian 1.0\ncomment title: a test\n"), "{text}");
        assert!(text.contains("element vertex 9\n") && text.contains("element face 8\n"), "{text}");
        let (points, faces) = file[begin..].split_at(9 * 7 * 8);
        let numbers: Vec<f64> =
            points.chunks(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
        assert_eq!(numbers[7..14], [-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.05]);
        assert_eq!(faces.len(), 8 * 13);
        assert_eq!(faces[..13], [3, 0, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0]);
        let broken = SurfaceMesh { normals: Vec::new(), ..surface };
        assert!(surface_ply(&header(), &broken).is_err());
    }
}
