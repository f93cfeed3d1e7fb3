"""separation.nc, read by netCDF4, SciPy and SurfaceTopography: FOLDER."""

import json
import sys

import netCDF4
import numpy as np
import scipy.io
import SurfaceTopography
from folder import Checks, Folder

folder = Folder(sys.argv[1])
undefined = np.isnan(folder.s)
path = str(folder / "separation.nc")
sizes = [len(v) * d for v, d in zip((folder.xi, folder.eta), folder.steps)]

checks = Checks("netCDF4")
with netCDF4.Dataset(path) as file:
    file.set_auto_mask(False)
    checks.same("x", file["x"][:].astype("f8"), folder.xi)
    checks.same("y", file["y"][:].astype("f8"), folder.eta)
    checks.same("heights", file["heights"][:].astype("f8"), -folder.s)
    checks("sizes and units", [file["x"].length, file["y"].length] == sizes and file["x"].unit == "mm")
    info = json.loads(file.json)
    checks("approach", info["approach_mm"] == folder.approach)
    if undefined.any():
        checks.same("mask", file["mask"][:].astype(bool), undefined)
    checks("pressure where it was asked for", ("pressure" in file.variables) == (folder.pressure is not None))
    if folder.pressure is not None:
        checks.same("pressure", file["pressure"][:].astype("f8"), folder.pressure)

checks.client = "SciPy"
with scipy.io.netcdf_file(path, mmap=False) as file:
    checks.same("heights", file.variables["heights"][:].astype("f8"), -folder.s)

checks.client = "SurfaceTopography"
topography = SurfaceTopography.read_topography(path)
checks("sizes, unit, boundary", list(topography.physical_sizes) == sizes and topography.unit == "mm"
       and not topography.is_periodic, f"{topography.physical_sizes} {topography.unit}")
heights = topography.heights()
checks("undefined points", topography.has_undefined_data == undefined.any(), f"{undefined.sum()}")
checks.same("heights", np.ma.filled(heights, np.nan).astype("f8"), -folder.s)
checks.done()
