"""The .ply files against the .vtp files of the same surfaces, by three readers: FOLDER."""

import sys

import meshio
import numpy as np
import pyvista
from folder import Checks, Folder

folder = Folder(sys.argv[1])
kinds = {"double": "<f8", "float": "<f4", "int": "<i4", "uchar": "u1"}


def read(path):
    """Reads points and faces as viewers of meshes do: by the types that the header declares."""
    with open(path, "rb") as file:
        assert file.readline() == b"ply\n" and file.readline() == b"format binary_little_endian 1.0\n"
        elements = []
        while (line := file.readline().decode("ascii").split()) != ["end_header"]:
            if line[0] == "element":
                elements.append((line[1], int(line[2]), []))
            elif line[:2] == ["property", "list"]:
                elements[-1][2].extend([("count", kinds[line[2]]), (line[4], kinds[line[3]], 3)])
            elif line[0] == "property":
                elements[-1][2].append((line[2], kinds[line[1]]))
        arrays = {name: np.fromfile(file, np.dtype(fields), count) for name, count, fields in elements}
        assert not file.read(), "bytes after the last face"
    return arrays


for name in ("patch", "rail", "wheel"):
    if not folder.has(f"{name}.ply"):
        continue
    expected, path = pyvista.read(folder / f"{name}.vtp"), folder / f"{name}.ply"
    triangles = expected.faces.reshape(-1, 4)[:, 1:]
    checks = Checks("PLY by its header")
    arrays = read(path)
    vertex, face = arrays["vertex"], arrays["face"]
    checks(f"{name}.ply has triangles", bool(np.all(face["count"] == 3)), f"{len(face)} faces")
    checks.same(f"{name}.ply faces", face["vertex_indices"], triangles.astype("i4"))
    checks.same(f"{name}.ply points", np.column_stack([vertex[axis] for axis in "xyz"]), np.asarray(expected.points))
    checks.same(f"{name}.ply normals", np.column_stack([vertex[f"n{axis}"] for axis in "xyz"]), np.asarray(expected["normal"]))
    checks.same(f"{name}.ply separation", vertex["separation"].astype("f8"), np.asarray(expected["separation"]))
    failed = checks.failed
    checks = Checks(f"meshio {meshio.__version__}")
    mesh = meshio.read(path)
    checks.same(f"{name}.ply points", mesh.points.astype("f8"), np.asarray(expected.points))
    checks.same(f"{name}.ply cells", mesh.cells[0].data.astype("i4"), triangles.astype("i4"))
    checks.same(f"{name}.ply separation", mesh.point_data["separation"].astype("f8"), np.asarray(expected["separation"]))
    failed += checks.failed
    # VTK reads points in single precision, and no separation.
    checks = Checks("VTK")
    surface = pyvista.read(path)
    checks("points", np.allclose(surface.points, expected.points, rtol=1e-6, atol=1e-6) and surface.n_cells == len(triangles))
    checks.failed += failed
    if checks.failed:
        checks.done()
