"""`patch.inp` in a job of CalculiX that adds material, thickness, supports and a pressure: FOLDER CCX."""

import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import pyvista
from folder import Checks, Folder

# The pressure on the surface, N/mm².
PRESSURE = 2.0

# The thickness lies below the surface of the mesh.
JOB = f"""*INCLUDE, INPUT=patch.inp
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.28
*SHELL SECTION, ELSET=PATCH, MATERIAL=STEEL, OFFSET=0.5
0.5
*BOUNDARY
BOUNDARY, 1, 3
*STEP
*STATIC
*DSLOAD
CONTACT, P, {PRESSURE}
*NODE PRINT, NSET=PATCH
U
*SECTION PRINT, SURFACE=CONTACT, NAME=WHOLE
SOAREA
*END STEP
"""


def after(title, text):
    """The numbers of the lines after one with this title, up to an empty one."""
    found = re.search(rf"{title}[^\n]*\n\s*\n((?:[ \t]*[-+\d][^\n]*\n)+)", text)
    return np.array([line.split() for line in found.group(1).splitlines()], dtype=float) if found else None


folder = Folder(sys.argv[1])
checks = Checks("CalculiX")
text = (folder / "patch.inp").read_text()
cards = re.findall(r"^\*[^*\n]*", text, re.MULTILINE)
fields = [field.strip() for line in text.splitlines() if not line.startswith("*") for field in line.split(",")]
checks("patch.inp has no field of more than 20 characters", max(map(len, fields)) <= 20, f"{max(map(len, fields))}")
checks("patch.inp has no *PARAMETER", not any(card.startswith("*PARAMETER") for card in cards))
with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    (scratch / "patch.inp").write_text(text)
    (scratch / "job.inp").write_text(JOB)
    run = subprocess.run([sys.argv[2], "job"], cwd=scratch, capture_output=True, text=True, check=False)
    said = run.stdout + run.stderr
    checks("reads the job without an error or a warning", "*ERROR" not in said and "*WARNING" not in said,
           " ".join(re.findall(r"\*(?:ERROR|WARNING).*", said)[:3]))
    checks("the job converges", run.returncode == 0 and "Job finished" in said)
    printed = (scratch / "job.dat").read_text() if (scratch / "job.dat").exists() else ""

ours = pyvista.read(folder / "patch.vtu")
points, triangles = np.asarray(ours.points), ours.cells.reshape(-1, 4)[:, 1:]
a, b, c = points[triangles].transpose(1, 0, 2)
area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
moves, centre, section = (after(title, printed) for title in ("displacements", "center of gravity", "area, normal force"))
if moves is None or centre is None or section is None:
    checks("displacements, normal and area are printed", False, printed[-500:])
else:
    boundary = np.asarray(ours.point_data["boundary"]) == 1
    checks("every node has its displacement", len(moves) == len(points), f"{len(moves)}")
    checks("the boundary is held, and nothing else", np.array_equal(np.all(moves[:, 1:] == 0, axis=1), boundary))
    checks("the pressure acts towards the rail", moves[:, 3].sum() < 0, f"{moves[:, 3].min():.3g} mm")
    checks("the surface faces the wheel", centre[0, 5] > 0.5, f"{centre[0, 5]:.6f}")
    checks.near("the surface is the whole patch", section[0, 0], area, 1e-5)
checks.done()
