# %% [markdown]
# # Pressure with Tamaas
# From a contact to its pressure distribution in three lines.

# %%
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
contact.hertz(load=60e3)
