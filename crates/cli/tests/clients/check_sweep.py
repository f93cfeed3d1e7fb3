"""The collection of `wheelrail sweep --patches`, played by PyVista: FOLDER RUN TIME, the folder of the run at one time."""

import json
import pathlib
import sys

import numpy
import pyvista
from folder import Checks

folder, run, time = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
checks = Checks("surface.pvd")
positions = json.loads((folder / "summary.json").read_text())["positions"]
touching = [position for position in positions if position["folders"]]
reader = pyvista.get_reader(folder / "surface.pvd")
expected = [position["lateral_mm"] for position in touching]
checks("one time for every position with contact", list(reader.time_values) == expected, str(expected))
for position in touching:
    reader.set_active_time_value(position["lateral_mm"])
    parts = reader.read()
    checks(f"{position['lateral_mm']} mm: a part for every folder", len(parts) == len(position["folders"]))
    for name, part in zip(position["folders"], parts):
        values = numpy.load(folder / name / "separation.npy")
        found = numpy.asarray(part.point_data["separation"]).reshape(values.shape)
        checks(f"{name}: the array's separation", numpy.array_equal(found, values, equal_nan=True))
there = next(position for position in touching if position["lateral_mm"] == time)
for name, part in zip(there["folders"], ["", "left"]):
    swept, own = ((root / "separation.npy").read_bytes() for root in (folder / name, run / part))
    checks(f"{name}: the bytes of the run at {time} mm", swept == own)
checks.done()
