# %% [markdown]
# # Two sides
# A worn wheel on the left, a new one on the right, and a left rail that lies 2 mm too far inside: what each contact carries when the
# axle's load is shared.

# %%
import matplotlib.pyplot as plt
import numpy as np

import wheelrail as wr

wheel = wr.wheel("S1002")
x, z = wheel.points(step=0.2).T
worn = wr.Profile.from_points(x, z + np.exp(-((x / 20.0) ** 2)), side="wheel", name="worn", cutoff_wavelength=5.0)
case = wr.Case.from_dict(
    {
        "title": "A worn wheel on a narrow track",
        "rail": {"profile": wr.rail("60E1"), "rotate": "1:40"},
        "wheel": {"profile": wheel, "radius": 460.0},
        "left": {"wheel": {"profile": worn}, "deviation": {"lateral": 2.0}},
        "track": {"gauge": 1435.0},
        "wheelset": {"back_to_back": 1360.0, "flange_back_x": -70.0, "lateral": 2.0, "load": 120e3, "roll": "load"},
    }
)
for contact in case.contacts:
    force = contact.normal_load
    assert force is not None
    print(f"{contact.name}: {force * np.cos(contact.contact_angle) / 1e3:.1f} kN, {contact.patch().area:.0f} mm² of overlap")
assert {contact.side for contact in case.contacts} == {"left", "right"}

# %% [markdown]
# The page of all contacts, as `wheelrail run` writes it.

# %%
case

# %%
picture, axes = plt.subplots(figsize=(7, 5), layout="constrained")
for contact in case.contacts:
    for number, loop in enumerate(contact.patch().loops):
        axes.fill(*loop.T, alpha=0.4, label=contact.name if number == 0 else None)
axes.set(xlabel="ξ across the rail, mm", ylabel="η along the rail, mm", aspect="equal")
axes.legend()
picture
