"""Undefined cells of a run are NaN in arrays and hidden in pictures, and never a number: FOLDER."""

import sys

import numpy as np
from folder import Checks, Folder

folder = Folder(sys.argv[1])
checks = Checks("NumPy")
undefined = np.isnan(folder.s)
checks("some cells are undefined, some not", 0 < undefined.sum() < undefined.size, f"{undefined.sum()} undefined")
checks("no sentinel", bool(np.abs(folder.s[~undefined]).max() < 1e3), f"largest {np.nanmax(np.abs(folder.s)):.6g} mm")
checks("the summary counts them", folder.summary["grid"]["undefined_points"] == undefined.sum())
checks.done()
