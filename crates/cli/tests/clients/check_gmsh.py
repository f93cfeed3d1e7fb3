"""The triangle mesh of a run in .msh, .inp and .stl, read by Gmsh and meshio, and Gmsh's own mesh of the same boundary: FOLDER."""

import collections
import sys

import gmsh
import meshio
import numpy as np
import pyvista
from folder import Checks, Folder

# Smallest angle of a good mesh, degrees.
GOOD = 30
# Largest number of cells as a multiple of Gmsh's.
CELLS = 1.5


def angles(points, triangles):
    """The angles at the three corners of each triangle, degrees."""
    corners = points[triangles]
    on = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    cross = np.cross(on, back)
    return np.degrees(np.arctan2(np.linalg.norm(cross, axis=2), (on * back).sum(axis=2)))


def area(points, triangles):
    a, b, c = points[triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def read_by_gmsh(path):
    """Points and triangles of a file."""
    gmsh.clear()
    gmsh.open(str(path))
    return mesh_of_gmsh()


def mesh_of_gmsh():
    tags, points, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=int)
    index[tags.astype(int)] = np.arange(len(tags))
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    assert list(kinds) == [2], kinds
    return points.reshape(-1, 3), index[nodes[0].astype(int)].reshape(-1, 3)


def remeshed(points, chains, size):
    """Gmsh's mesh inside chains of nodes, whose edges stay, with edges of this size inside."""
    gmsh.clear()
    loops = []
    for chain in chains:
        # In units of the size, because Gmsh merges points by an absolute tolerance.
        corners = [gmsh.model.geo.addPoint(*(points[node, :2] / size), 0) for node in chain]
        lines = [gmsh.model.geo.addLine(*pair) for pair in zip(corners, corners[1:] + corners[:1])]
        loops.append(gmsh.model.geo.addCurveLoop(lines))
    gmsh.model.geo.addPlaneSurface(loops)
    gmsh.model.geo.synchronize()
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, 2)
    gmsh.model.mesh.generate(2)
    return mesh_of_gmsh()


def chains_of(edges):
    """Closed chains of nodes from directed edges."""
    following = dict(edges)
    chains = []
    while following:
        node = next(iter(following))
        chain = []
        while node in following:
            chain.append(node)
            node = following.pop(node)
        chains.append(chain)
    return chains


folder = Folder(sys.argv[1])
described = folder.summary["triangle_mesh"]
cells, components = described["quality"]["cells"], described["components"]
checks = Checks(f"Gmsh {gmsh.__version__}")
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
for name, value in (("MeshSizeMin", 1), ("MeshSizeMax", 1), ("MeshSizeExtendFromBoundary", 0)):
    gmsh.option.setNumber(f"Mesh.{name}", value)

ours = pyvista.read(folder / "patch.vtu")
points, triangles = np.asarray(ours.points), ours.cells.reshape(-1, 4)[:, 1:]
expected = area(points, triangles)
for name in ("patch.msh", "patch.stl"):
    found = read_by_gmsh(folder / name)
    checks(f"{name} has all cells", len(found[1]) == cells == len(triangles), f"{len(found[1])}")
    checks(f"{name} has all nodes", len(found[0]) == len(points), f"{len(found[0])}")
    checks.near(f"{name} has the area", area(*found), expected, 1e-12)
gmsh.clear()
gmsh.open(str(folder / "patch.msh"))
groups = collections.Counter(gmsh.model.getPhysicalName(*group).split("_")[0] for group in gmsh.model.getPhysicalGroups())
checks("patch.msh has groups of both kinds", groups == {"boundary": len(components), "component": len(components)}, str(groups))

boundary = ours.point_data["boundary"] == 1
edges = {(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1])}
outer = [(a, b) for a, b in sorted(edges) if (b, a) not in edges]
for number, component in enumerate(components):
    own = triangles[ours.cell_data["component"] == number]
    nodes = set(own.ravel().tolist())
    found = remeshed(points, chains_of([edge for edge in outer if edge[0] in nodes]), component["size_mm"])
    flat = points * [1, 1, 0]
    mine, theirs = angles(flat, own), angles(*found)
    what = f"component {number}: {len(own)} cells from {mine.min():.1f}°, Gmsh's {len(found[1])} from {theirs.min():.1f}°"
    checks(f"smallest angle of {what}", mine.min() >= min(theirs.min() - 1e-6, GOOD))
    checks(f"cells of {what}", len(own) <= CELLS * len(found[1]) and len(found[1]) <= CELLS * len(own))
gmsh.finalize()

checks.client = f"meshio {meshio.__version__}"
for name in ("patch.msh", "patch.inp", "patch.stl"):
    found = meshio.read(folder / name)
    blocks = [block.data for block in found.cells if block.type in ("triangle", "triangle3")]
    corners = np.concatenate(blocks)
    checks(f"{name} has all cells", len(corners) == cells, f"{len(corners)}")
    # patch.inp has 12 digits.
    checks.near(f"{name} has the area", area(found.points, corners), expected, 1e-9 if name == "patch.inp" else 1e-12)
    if name != "patch.stl":
        checks(f"{name} has all nodes", len(found.points) == len(points), f"{len(found.points)}")
    if name == "patch.inp":
        sets = {**found.point_sets, **found.cell_sets}
        wanted = {f"{word}_{k + 1}" for word in ("BOUNDARY", "COMPONENT") for k in range(len(components))} | {"PATCH", "BOUNDARY"}
        checks(f"{name} has the sets", wanted <= set(sets), ", ".join(sorted(sets)))
        on_boundary = sum(len(found.point_sets[f"BOUNDARY_{k + 1}"]) for k in range(len(components)))
        checks(f"{name} has the nodes of the boundary", on_boundary == boundary.sum(), f"{on_boundary}")
        checks(f"{name} names delta", f"approach delta = {folder.approach!r} mm" in (folder / name).read_text())
for name in ("rail.stl", "wheel.stl"):
    solid, surface = meshio.read(folder / name), pyvista.read(folder / name.replace("stl", "vtu"))
    checks(f"{name} has all facets", len(solid.cells[0].data) == surface.n_cells, f"{surface.n_cells}")
checks.done()
