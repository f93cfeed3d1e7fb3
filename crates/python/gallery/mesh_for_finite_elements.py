# %% [markdown]
# # A mesh for finite elements
# The patch as graded triangles with the overlap on its nodes, the bodies around it, and the file that Gmsh opens.

# %%
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation

import wheelrail as wr

pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
contact = track.touch(lateral=3.0, yaw=0.002).right[0]
patch = contact.patch(load=60e3)
mesh = patch.mesh(size=0.5)
corners = mesh.points[mesh.cells]
areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
print(f"{mesh}, {areas.sum():.2f} mm² of {patch.area:.2f}")
assert abs(areas.sum() / patch.area - 1.0) < 0.01

# %% [markdown]
# The overlap is largest inside and 0 along the boundary. `mesh.to_meshio().write("patch.vtu")` and `mesh.to_pyvista().plot()` take it on.

# %%
overlap = mesh.point_data["overlap"]
print(f"overlap up to {overlap.max() * 1e3:.1f} µm")
rail, wheel = contact.surfaces((-10.0, 10.0), (-15.0, 15.0), approach=patch.approach)
print(f"rail {rail}, wheel {wheel}; patch.msh has {len(patch.files('gmsh')['patch.msh'])} bytes")
assert overlap.min() > -1e-9 and np.isclose(overlap.max(), patch.approach, rtol=0.2)

# %%
picture, axes = plt.subplots(figsize=(6, 6), layout="constrained")
triangles = Triangulation(mesh.points[:, 0], mesh.points[:, 1], mesh.cells)
drawn = axes.tripcolor(triangles, 1e3 * overlap, edgecolors="white", linewidth=0.3)
axes.set(xlabel="ξ across the rail, mm", ylabel="η along the rail, mm", aspect="equal")
picture.colorbar(drawn, label="overlap δ − s, µm")
picture
