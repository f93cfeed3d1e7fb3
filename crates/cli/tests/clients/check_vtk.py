"""The VTK files, read by VTK through pyvista, and a picture of them rendered off-screen: FOLDER."""

import sys

import numpy as np
import pyvista
from folder import Checks, Folder, depth

pyvista.OFF_SCREEN = True
folder = Folder(sys.argv[1])
n_xi, n_eta = folder.s.shape
checks = Checks(f"VTK {pyvista.vtk_version_info.major}.{pyvista.vtk_version_info.minor}")


def on_grid(array):
    """An array of a structured grid in our order."""
    return np.asarray(array).reshape((n_xi, n_eta) + np.asarray(array).shape[1:])


undefined = np.isnan(folder.s)
meshes = {}
for name in ("separation", "rail", "wheel"):
    mesh = meshes[name] = pyvista.read(folder / f"{name}.vts")
    checks(f"{name}.vts dimensions", tuple(mesh.dimensions) == (n_eta, n_xi, 1), f"{mesh.dimensions}")
    points = on_grid(mesh.points)
    checks.same(f"{name}.vts xi", points[:, :, 0], np.repeat(folder.xi[:, None], n_eta, 1))
    checks.same(f"{name}.vts eta", points[:, :, 1], np.repeat(folder.eta[None], n_xi, 0))
    checks(f"{name}.vts points finite", bool(np.isfinite(points).all()))
    checks.same(f"{name}.vts separation", on_grid(mesh["separation"]), folder.s)
    checks(f"{name}.vts approach", mesh.field_data["approach_mm"][0] == folder.approach)
rail, wheel = (on_grid(meshes[name].points)[:, :, 2] for name in ("rail", "wheel"))
checks.same("wheel.vts is rail.vts plus separation", wheel[~undefined], (rail + folder.s)[~undefined])
grid = meshes["separation"]
checks.same("interpenetration", on_grid(grid["interpenetration"]), depth(folder.s, folder.approach))
checks.same("mask", on_grid(grid["mask"]), (~undefined).astype("u1"))
checks("pressure where it was asked for", ("pressure" in grid.array_names) == (folder.pressure is not None))
if folder.pressure is not None:
    checks.same("pressure", on_grid(grid["pressure"]), folder.pressure)
gap = np.zeros(folder.s.shape + (3,))
gap[:, :, 2] = np.where(undefined, 0, folder.s)
checks.same("gap_vector", on_grid(grid["gap_vector"]), gap)
known = ~np.isnan(grid["rail_normal"]).any(axis=1)
checks("rail_normal has length one", np.allclose(np.linalg.norm(grid["rail_normal"][known], axis=1), 1, atol=1e-15, rtol=0))
shown = grid.extract_surface(algorithm="geometry").n_cells
quads = ~(undefined[1:, 1:] | undefined[:-1, 1:] | undefined[1:, :-1] | undefined[:-1, :-1])
checks("cells without a surface are hidden", shown == quads.sum(), f"{shown} shown")

boundary = pyvista.read(folder / "boundary.vtp")
loops = folder.boundary()
checks("boundary.vtp loops", boundary.n_cells == len(loops), f"{boundary.n_cells}")
if loops:
    checks.same("boundary.vtp component", boundary.cell_data["component"], np.array([c for c, _ in loops]))
    for number, (_, points) in enumerate(loops):
        cell = boundary.get_cell(number)
        checks.same(f"boundary.vtp loop {number}", cell.points[:-1, :2], points)
        checks(f"boundary.vtp loop {number} is closed", cell.point_ids[0] == cell.point_ids[-1])
if folder.has("strips.vtu"):
    strips = pyvista.read(folder / "strips.vtu")
    checks("strips.vtu", strips.n_cells == 0 or set(strips.celltypes) <= {5, 9}, f"{strips.n_cells} cells")
    if strips.n_cells:
        strips.points[:, 2] = 0
        polygons = strips.compute_cell_sizes()["Area"].sum()
        area = strips.cell_data["area"].sum()
        checks.near("strips.vtu areas are near those of its polygons", area, polygons, 0.05)
if folder.has("patch.vtu"):
    patch = pyvista.read(folder / "patch.vtu")
    checks("patch.vtu", set(patch.celltypes) <= {5}, f"{patch.n_cells} cells")
    if patch.n_cells:
        exact = patch.field_data["component_areas_mm2"]
        checks.same("patch.vtu has the exact areas", patch.cell_data["component_area"], exact[patch.cell_data["component"]])
        inside = patch.point_data["separation"][patch.point_data["boundary"] == 0]
        checks("patch.vtu has s < delta inside", inside.max() < patch.field_data["approach_mm"][0])
        patch.points[:, 2] = 0
        sized = patch.compute_cell_sizes()["Area"]
        for number, area in enumerate(exact):
            polygons = sized[patch.cell_data["component"] == number].sum()
            checks.near(f"patch.vtu component {number} has its area but for chords", polygons, area, 0.02)
for name in filter(folder.has, ("patch.vtp", "rail.vtp", "wheel.vtp")):
    surface, grid_form = pyvista.read(folder / name), pyvista.read(folder / name.replace("vtp", "vtu"))
    checks.same(f"{name} has the points of the .vtu", np.asarray(surface.points), np.asarray(grid_form.points))
    checks(f"{name} has the triangles of the .vtu", surface.n_cells == grid_form.n_cells, f"{surface.n_cells} cells")
    checks.same(f"{name} has the separations of the .vtu", surface["separation"], grid_form["separation"])
if folder.has("separation.vtk"):
    legacy = pyvista.read(folder / "separation.vtk")
    checks.same("separation.vtk", on_grid(legacy["separation"]), folder.s)
    checks.same("separation.vtk mask", on_grid(legacy["mask"]), (~undefined).astype("u1"))
    checks.same("separation.vtk points", np.asarray(legacy.points), np.asarray(grid.points))
if folder.has("surface.pvd"):
    steps = pyvista.get_reader(folder / "surface.pvd")
    for time in steps.time_values:
        steps.set_active_time_value(time)
        checks(f"surface.pvd at {time:g}", steps.read().combine().n_points > 0)
    checks("surface.pvd has steps in ascending order", sorted(set(steps.time_values)) == list(steps.time_values) != [])

plotter = pyvista.Plotter(window_size=(640, 480))
plotter.add_mesh(grid, scalars="separation", nan_opacity=0)
if loops:
    plotter.add_mesh(boundary, color="black", line_width=3)
plotter.view_xy()
image = plotter.screenshot(sys.argv[2] if len(sys.argv) > 2 else None, return_img=True)
checks("picture is not blank", len(np.unique(image.reshape(-1, 3), axis=0)) > 50)
checks.done()
