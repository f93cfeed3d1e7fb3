"""The .vtu files, as far as they are there, and separation.vtk, read by meshio: FOLDER."""

import sys

import meshio
import numpy as np
from folder import Checks, Folder

folder = Folder(sys.argv[1])
checks = Checks(f"meshio {meshio.__version__}")
if folder.has("patch.vtu") and folder.boundary():
    patch = meshio.read(folder / "patch.vtu")
    cells = sum(len(block.data) for block in patch.cells)
    areas = patch.cell_data["area"]
    checks("patch.vtu", sum(map(len, areas)) == cells, f"{cells} cells, {sum(a.sum() for a in areas):.6g} mm2")
    checks("patch.vtu has whole numbers of nodes", all(block.data.dtype.kind == "i" for block in patch.cells))
    checks("patch.vtu holds triangles and quads", {block.type for block in patch.cells} <= {"triangle", "quad"})
elif folder.has("patch.vtu"):
    checks("patch.vtu is empty, which meshio cannot read from any program", True)
for name in filter(folder.has, ("rail.vtu", "wheel.vtu")):
    surface = meshio.read(folder / name)
    cells = sum(len(block.data) for block in surface.cells)
    checks(f"{name} holds triangles", {block.type for block in surface.cells} == {"triangle"}, f"{cells} cells")
if folder.has("separation.vtk"):
    grid = meshio.read(folder / "separation.vtk")
    checks.same("separation.vtk xi", grid.points[:: len(folder.eta), 0].astype("f8"), folder.xi)
    checks.same("separation.vtk eta", grid.points[: len(folder.eta), 1].astype("f8"), folder.eta)
    checks.same("separation.vtk mask", grid.point_data["mask"].reshape(folder.s.shape) == 1, ~np.isnan(folder.s))
    checks.same("separation.vtk separation", grid.point_data["separation"].astype("f8").reshape(folder.s.shape), folder.s)
checks.done()
