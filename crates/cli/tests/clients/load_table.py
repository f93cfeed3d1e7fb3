"""Solves regions of contact with Tamaas: load_table.py FOLDER E*. Prints the name of every subfolder, δ [mm], the largest
pressure [N/mm²] and the contact area [mm²]."""

import pathlib
import sys

import numpy as np
from solve import traction


def contact_area(pressed, steps):
    """Area of the pressed cells [mm²], less what those on the edge count too much (Yastrebov, Anciaux, Molinari 2017)."""
    borders = [np.count_nonzero(np.diff(pressed, axis=axis)) * steps[1 - axis] for axis in (0, 1)]
    too_much = (np.pi - 1 + np.log(2)) / 24 * sum(border * step for border, step in zip(borders, steps))
    return float(np.count_nonzero(pressed) * np.prod(steps) - too_much)


folder, modulus = pathlib.Path(sys.argv[1]), float(sys.argv[2])
for region in sorted(path for path in folder.iterdir() if path.is_dir()):
    *steps, load = map(float, (region / "numbers.txt").read_text().split())
    pressure, approach = traction(np.load(region / "separation.npy"), steps, modulus, load, 1e-7)
    print(region.name, repr(float(approach)), repr(float(pressure.max())), repr(contact_area(pressure > 0, steps)))
