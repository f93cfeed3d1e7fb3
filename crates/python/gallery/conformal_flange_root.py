# %% [markdown]
# # Conformal contact in a flange root
# Where the patch bends around the gauge corner, the gap along a fixed normal and the one along the rail's own normal differ.

# %%
import matplotlib.pyplot as plt
import numpy as np

import wheelrail as wr

pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
root = track.touch(lateral=6.0).right[0]
sigma, eta = np.linspace(-3.0, 3.0, 61), np.linspace(-8.0, 8.0, 81)
xi, zeta, alpha = root.rail_surface(sigma)
t, s = root.normal_gap(sigma, eta), root.separation(xi, eta)
print(f"the rail's normal turns by {np.degrees(np.ptp(alpha)):.1f}° over {sigma[-1] - sigma[0]:.0f} mm")

# %% [markdown]
# The overlap under one approach: the rail's own normal closes only its part of it.

# %%
approach = 0.05
fixed, turning = s < approach, t < approach * np.cos(alpha)[:, None]
print(f"{fixed.sum()} points overlap along the fixed normal, {turning.sum()} along the turning one")
assert turning[30, 40] and fixed[30, 40] and abs(int(fixed.sum()) - int(turning.sum())) < fixed.sum()

# %%
picture, axes = plt.subplots(figsize=(6, 7), layout="constrained")
drawn = axes.pcolormesh(sigma, eta, 1e3 * (t / np.cos(alpha)[:, None] - s).T)
axes.contour(sigma, eta, s.T, levels=[approach], colors="black")
axes.set(xlabel="σ along the rail's profile, mm", ylabel="η along the rail, mm", title="Around the patch s < δ")
picture.colorbar(drawn, label="t / cos α − s, µm")
picture
