# %% [markdown]
# # Worn against new
# A worn wheel beside the drawn one: contact positions over the lateral displacement, and equivalent conicity. The worn one
# is made here of points, hollow by 1 mm at the middle of its tread; `wr.read_profile` takes an instrument's file likewise.

# %%
import matplotlib.pyplot as plt
import numpy as np

import wheelrail as wr

rail = wr.rail("60E1").rotated("1:40")
x, z = wr.wheel("S1002").points(step=0.2).T
hollow = np.exp(-((x / 20.0) ** 2))                        # mm: the surface of a worn wheel lies higher
worn = wr.Profile.from_points(x, z + hollow, side="wheel", name="worn", cutoff_wavelength=5.0)
worn

# %%
def on_track(wheel: wr.Profile) -> wr.Wheelset:
    """Put a wheel on the track."""
    pair = wr.Pair(rail, wheel, radius=460.0)
    return wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)


lateral = np.arange(-70, 71) / 10
tables = {name: on_track(wheel).sweep(lateral) for name, wheel in {"new": wr.wheel("S1002"), "worn": worn}.items()}
for name, table in tables.items():
    right = table.lowest("right")
    at = right["lateral_mm"] == 3.0
    print(f"{name}: conicity {right['conicity'][at][0]:.4f} at 3 mm")

# %%
assert tables["worn"].rows == tables["new"].rows
picture, axes = plt.subplots(figsize=(8, 4), layout="constrained")
for name, table in tables.items():
    right = table.lowest("right")
    axes.plot(right["lateral_mm"], right["wheel_x_mm"], ".", label=name)
axes.set(xlabel="lateral displacement y, mm", ylabel="contact on the right wheel x, mm")
axes.legend()
picture
