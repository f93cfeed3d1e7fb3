"""view.py without ParaView: it compiles, and VTK finds every file and array that it names: FOLDER."""

import ast
import sys

import pyvista
from folder import Checks, Folder

folder = Folder(sys.argv[1])
checks = Checks("view.py")
script = (folder / "view.py").read_text()
compile(script, "view.py", "exec")
tree = ast.parse(script)
strings = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
files = [text for text in strings if text.endswith((".vts", ".vtp", ".vtu"))]
checks("names files", len(files) > 3, ", ".join(files))
# The script does without these: a folder without a patch has no mesh of it, the bodies lie with the first contact, and a run
# over the tangent plane has no normal gap.
perhaps = {"patch.vtu", "rails.vtp", "wheels.vtp", "conformal.vts"}
read = {}
for name in files:
    there = (folder / name).exists()
    checks(f"{name} is written", there or name in perhaps)
    read[name] = pyvista.read(folder / name) if there else None
    checks(f"{name} is read by VTK", not there or read[name] is not None)
# The array that colours each grid, and the angle that the conformal patch depends on.
colours = next(ast.literal_eval(node.value) for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "GAPS")
checks("colours each grid", set(colours) == {"conformal.vts", "separation.vts"})
there = [name for name in colours if read[name] is not None]
for name, array in [*colours.items(), ("conformal.vts", "angle")]:
    if name in there:
        checks(f"{name} has {array}", array in read[name].point_data)
arrays = [node.elts[1].value for node in ast.walk(tree) if isinstance(node, (ast.List, ast.Tuple))
          and len(node.elts) == 2 and all(isinstance(part, ast.Constant) for part in node.elts) and node.elts[0].value == "POINTS"]
# The script computes this one.
arrays = set(arrays) - {"", "beyond"}
checks("names arrays", len(arrays) > 0)
for name in sorted(arrays):
    for grid in there:
        checks(f"array {name} is in {grid}", name in read[grid].point_data)
checks.done()
