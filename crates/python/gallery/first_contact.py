# %% [markdown]
# # First contact
# Where does a wheelset touch its rails, and how far apart are the bodies around that point?

# %%
import numpy as np

import wheelrail as wr

rail = wr.rail("60E1").rotated("1:40")
pair = wr.Pair(rail, wr.wheel("S1002"), radius=460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
touch = track.touch(lateral=3.0, yaw=0.002)
touch

# %% [markdown]
# The separation around the first contact of the right wheel, before any approach: zero at the contact point, positive around it.

# %%
contact = touch.right[0]
grid = contact.separation(xi=np.linspace(-12, 12, 201), eta=np.linspace(-10, 10, 201))
assert abs(grid[100, 100]) < 1e-14 and np.nanmin(grid) > -1e-9

# %% [markdown]
# The patch under 60 kN, and Hertz's estimate of the pressure.

# %%
patch = contact.patch(load=60e3)
print(f"{patch.area:.1f} mm² of overlap, {contact.hertz(load=60e3).max_pressure:.0f} N/mm² by Hertz")
picture = patch
picture
