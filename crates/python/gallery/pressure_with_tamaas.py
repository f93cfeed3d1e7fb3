# %% [markdown]
# # Pressure with Tamaas
# From a contact to its pressure distribution in three lines.

# %%
import matplotlib.pyplot as plt
import numpy as np

import wheelrail as wr

pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
contact = track.touch(lateral=0.0).right[0]
problem = contact.to_tamaas(load=60e3)
pressure = problem.solve()
carried = pressure.sum() * problem.cell * np.cos(contact.contact_angle)  # the vertical part
print(f"{pressure.max():.0f} N/mm² over {np.count_nonzero(pressure) * problem.cell:.1f} mm², {carried:.0f} N")
assert abs(carried - 60e3) < 1.0

# %% [markdown]
# Hertz takes the curvatures at the contact point for those of the whole contact.

# %%
hertz = contact.hertz(load=60e3)
hertz

# %%
picture, axes = plt.subplots(figsize=(6, 6), layout="constrained")
drawn = axes.pcolormesh(problem.xi, problem.eta, pressure.T, shading="nearest")
angle = np.linspace(0.0, 2.0 * np.pi, 200)
axes.plot(hertz.semi_axes[0] * np.cos(angle), hertz.semi_axes[1] * np.sin(angle), "w--", label="Hertz's ellipse")
axes.set(xlabel="ξ across the rail, mm", ylabel="η along the rail, mm", aspect="equal")
axes.legend()
picture.colorbar(drawn, label="pressure, N/mm²")
picture
