# %% [markdown]
# # Two-point contact
# A wheelset at its flange: a second place comes near while the first one still carries.

# %%
import numpy as np

import wheelrail as wr

pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
lateral = np.linspace(4.0, 9.0, 501)
table = track.sweep(lateral, within=0.05, conicity=False)
right = table["side"] == "right"
second = table["lateral_mm"][right & (table["contact"] == 2)]
print(f"a second place within 0.05 mm at {len(np.unique(second))} of {len(lateral)} displacements")

# %% [markdown]
# Where the contact jumps, both places touch at once. Each has its own patch; each is drawn in its own contact frame.

# %%
at = float(second[len(second) // 2]) if len(second) else 6.0
contacts = track.touch(at, within=0.05).right
for contact in contacts:
    print(f"{contact.name}: x = {contact.rail_point[0]:.2f} mm, {np.degrees(contact.contact_angle):.2f}°, gap {contact.gap:.4f} mm")
assert len(contacts) >= 2

# %%
picture = contacts[0].patch(approach=0.05)
picture
