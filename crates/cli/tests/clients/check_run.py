"""What only `wheelrail run` writes, against the arrays and the other files of its folder: FOLDER READ_WRP."""

import csv
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pyvista
from folder import Checks, Folder, colours
from wrp import read_wrp

# Facets keep within this share of the approach, and these shares of the window's longer side.
FACET_SHARE, FACET_LIMITS = 0.01, (1e-6, 1e-4)
# s is known to this absolutely [mm]: nearer to δ a point may count as inside or as outside.
ROUNDING = 2e-12

folder = Folder(sys.argv[1])
patch = folder.summary["patch"]
approach = folder.summary["approach_mm"]
checks = Checks("csv")
with open(folder / "interpen.csv") as file:
    rows = [[float(row[key]) for key in ("xi", "eta_min", "eta_max")] for row in csv.DictReader(file)]
inside = np.zeros(folder.s.shape, bool)
for xi, low, high in rows:
    inside[folder.xi == xi] |= (low <= folder.eta) & (folder.eta <= high)
clear = np.abs(folder.s - approach) > ROUNDING
checks.same("interpen.csv holds the points with s < delta", inside[clear], (folder.s < approach)[clear])

checks.client = "NumPy"
table = np.loadtxt(folder / "midsep.txt", skiprows=1 + next(
    number for number, line in enumerate(open(folder / "midsep.txt")) if line.startswith("#") and "zeta_rail" in line))
checks.same("midsep.txt xi", table[:, 0], folder.xi)
known = ~np.isnan(table[:, 1])
rail = np.asarray(pyvista.read(folder / "rail.vts").points)[:: len(folder.eta), 2]
checks.same("midsep.txt rail", table[known, 1], rail[known])
middle = np.flatnonzero(folder.eta == 0)
if middle.size and folder.summary["skew_rad"] == 0:
    error = np.nanmax(np.abs(table[:, 3] - folder.s[:, middle[0]]))
    checks("midsep.txt separation is that of the grid", error <= 2e-12, f"off by {error:.1e} mm")

checks.client = "VTK"
cells = pyvista.read(folder / "strips.vtu")
deck = read_wrp(folder / "countact.wrp", sys.argv[2])
# strips.vtu holds the same cells, triangles after quads.
order = np.argsort([len(set(row)) == 3 for row in deck["cells"][:, 1:]], kind="stable")
checks.same("strips.vtu and countact.wrp have the same nodes", np.asarray(cells.points), deck["points"])
checks.same("strips.vtu and countact.wrp have the same areas", np.asarray(cells.cell_data["area"]), deck["area"][order])
checks.same("strips.vtu and countact.wrp have the same components", np.asarray(cells.cell_data["component"]), deck["cells"][order, 0])
nodes = [set(cells.get_cell(number).point_ids) for number in range(cells.n_cells)]
checks("strips.vtu and countact.wrp have the same cells", nodes == [set(row) for row in deck["cells"][order, 1:] - 1], f"{len(nodes)} cells")
checks.near("areas of the cells sum up to the patch", deck["area"].sum(), patch["area_mm2"], 1e-10)
ends = {xi for component in patch["components"] for xi in component["xi_extent_mm"]}
checks("ends of the patch are nodes", ends <= set(deck["points"][:, 0]))

# Surfaces are probed from above, inside the patch, where neither body overhangs.
side = max(folder.xi[-1] - folder.xi[0], folder.eta[-1] - folder.eta[0])
tolerance = np.clip(FACET_SHARE * approach, *(share * side for share in FACET_LIMITS))
low, high = patch["xi_extent_mm"]
within = np.repeat((low <= folder.xi) & (folder.xi <= high), len(folder.eta)) & ~np.isnan(folder.s.ravel())
grid = pyvista.read(folder / "separation.vts")
upright = np.asarray(grid["rail_normal"])[within, 2].min()
for name in ("rail", "wheel"):
    body = pyvista.read(folder / f"{name}.vtu")
    checks(f"{name}.vtu holds triangles", set(body.celltypes) == {5}, f"{body.n_cells} triangles")
    origin = np.abs(body.points).max(axis=1).min()
    # In a weighted frame the wheel does not touch at the origin.
    touches = name == "rail" or folder.summary["curvatures"]["a_per_mm"] is not None
    checks(f"{name}.vtu has C for a point", origin <= 1e-12 or not touches, f"off by {origin:.1e} mm")
    facing = (1 if name == "rail" else -1) * body.extract_surface(algorithm="geometry").face_normals[:, 2]
    at_origin = np.argmin(np.linalg.norm(body.cell_centers().points, axis=1))
    checks(f"{name}.vtu faces the other body at C", bool(np.isfinite(body.points).all() and facing[at_origin] > 0))
    body["zeta"] = body.points[:, 2]
    expected = np.asarray(pyvista.read(folder / f"{name}.vts").points)[within]
    body.points[:, 2] = 0
    probe = pyvista.PolyData(np.column_stack([expected[:, :2], np.zeros(len(expected))])).sample(body)
    found = np.asarray(probe["vtkValidPointMask"], bool)
    checks(f"{name}.vtu covers the patch", bool(found.all()), f"{found.size} points, {(~found).sum()} beside it")
    error = np.abs(np.asarray(probe["zeta"]) - expected[:, 2])[found].max()
    checks(f"{name}.vtu lies on {name}.vts", error <= tolerance / upright, f"off by {error:.1e} of {tolerance / upright:.1e} mm")

checks.client = "pictures"
svg = ElementTree.parse(folder / "patch.svg").getroot()
words = "".join(svg.itertext())
checks("patch.svg is XML and names what it shows", svg.tag.endswith("svg") and "[mm]" in words and folder.summary["title"][:20] in words)
image = pyvista.read(folder / "patch.png")
shades = colours(image)
checks("patch.png is a picture", min(image.dimensions[:2]) >= 1000 and shades > 50, f"{image.dimensions}, {shades} colours")
checks.done()
