"""One row of the table of estimated against solved approaches: FOLDER NAME and what `clients_runs.rs` passes."""

import sys

from folder import Folder
from solve import tamaas_solution

path, name, *numbers, angle, chosen = sys.argv[1:]
load, modulus, hertz_approach, hertz_peak, virtual_approach, virtual_peak = map(float, numbers)
peak, approach = tamaas_solution(Folder(path), modulus, load)


def against(estimate, solved, digits):
    return f"{estimate:.{digits}f} ({round(100 * (estimate / solved - 1), 1) + 0.0:+.1f} %)"


letter = {"Hertz": "H", "VirtualInterpenetration": "V"}[chosen]
print(f"| {name} | {angle}° | {load / 1e3:g} | {approach:.4f} | {against(hertz_approach, approach, 4)} "
      f"| {against(virtual_approach, approach, 4)} | {letter} | {peak:.0f} | {against(hertz_peak, peak, 0)} "
      f"| {against(virtual_peak, peak, 0)} |")
