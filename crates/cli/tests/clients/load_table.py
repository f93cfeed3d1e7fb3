"""One row of the table of estimated against solved approaches: FOLDER NAME and what `clients_runs.rs` passes."""

import sys

from folder import Folder
from solve import tamaas_solution

path, name, *numbers, angle, chosen = sys.argv[1:]
load, modulus, hertz_peak, *estimates = map(float, numbers)
peak, approach = tamaas_solution(Folder(path), modulus, load)


def against(estimate, solved, digits):
    return f"{estimate:.{digits}f} ({round(100 * (estimate / solved - 1), 1) + 0.0:+.1f} %)"


letter = {"Hertz": "H", "VirtualInterpenetration": "V"}[chosen]
columns = [name, f"{angle}°", f"{load / 1e3:g}", f"{approach:.4f}", *(against(e, approach, 4) for e in estimates), letter]
print("|", " | ".join([*columns, f"{peak:.0f}", against(hertz_peak, peak, 0)]), "|")
