"""The .vtu files, as far as they are there, and separation.vtk, read by meshio: FOLDER."""

import sys

import meshio
import numpy as np
from folder import Checks, Folder

folder = Folder(sys.argv[1])
checks = Checks(f"meshio {meshio.__version__}")
for name, kinds in (("patch.vtu", ["triangle"]), ("strips.vtu", ["quad", "triangle"])):
    if folder.has(name) and not folder.boundary():
        checks(f"{name} is empty, which meshio cannot read from any program", True)
    elif folder.has(name):
        patch = meshio.read(folder / name)
        blocks = [block.type for block in patch.cells]
        cells = sum(len(block.data) for block in patch.cells)
        checks(f"{name} has one block of each kind", blocks in (kinds, kinds[:1]), f"{cells} cells, {blocks}")
        checks(f"{name} has whole numbers of nodes", all(block.data.dtype.kind == "i" for block in patch.cells))
        components = patch.cell_data["component"]
        checks(f"{name} has a component for each cell", sum(map(len, components)) == cells)
for name in filter(folder.has, ("rail.vtu", "wheel.vtu")):
    surface = meshio.read(folder / name)
    cells = sum(len(block.data) for block in surface.cells)
    checks(f"{name} holds triangles", [block.type for block in surface.cells] == ["triangle"], f"{cells} cells")
    lengths = np.linalg.norm(surface.point_data["normal"], axis=1)
    checks(f"{name} has unit normals", np.abs(lengths - 1).max() < 1e-14)
    checks(f"{name} has separations", np.isfinite(surface.point_data["separation"]).mean() > 0.3)
if folder.has("separation.vtk"):
    grid = meshio.read(folder / "separation.vtk")
    checks.same("separation.vtk xi", grid.points[:: len(folder.eta), 0].astype("f8"), folder.xi)
    checks.same("separation.vtk eta", grid.points[: len(folder.eta), 1].astype("f8"), folder.eta)
    checks.same("separation.vtk mask", grid.point_data["mask"].reshape(folder.s.shape) == 1, ~np.isnan(folder.s))
    checks.same("separation.vtk separation", grid.point_data["separation"].astype("f8").reshape(folder.s.shape), folder.s)
checks.done()
