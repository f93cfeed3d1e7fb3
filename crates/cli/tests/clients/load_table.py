"""Solves regions of contact with Tamaas: load_table.py FOLDER E*. Prints the name of every subfolder and δ [mm]."""

import pathlib
import sys

import numpy as np
from solve import solved_by_tamaas

folder, modulus = pathlib.Path(sys.argv[1]), float(sys.argv[2])
for region in sorted(path for path in folder.iterdir() if path.is_dir()):
    *steps, load = map(float, (region / "numbers.txt").read_text().split())
    _, approach = solved_by_tamaas(np.load(region / "separation.npy"), steps, modulus, load)
    print(region.name, repr(float(approach)))
