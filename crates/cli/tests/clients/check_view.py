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
# The script does without these: a folder without a patch has no mesh of it, and the bodies lie with the first contact.
perhaps = {"patch.vtu", "rails.vtp", "wheels.vtp"}
for name in files:
    there = (folder / name).exists()
    checks(f"{name} is written", there or name in perhaps)
    checks(f"{name} is read by VTK", not there or pyvista.read(folder / name) is not None)
arrays = [node.elts[1].value for node in ast.walk(tree) if isinstance(node, (ast.List, ast.Tuple))
          and len(node.elts) == 2 and isinstance(node.elts[0], ast.Constant) and node.elts[0].value == "POINTS"]
arrays += [node.slice.value for node in ast.walk(tree) if isinstance(node, ast.Subscript)
           and isinstance(node.value, ast.Attribute) and node.value.attr == "PointData"]
written = pyvista.read(folder / "separation.vts").point_data
checks("names arrays", len(arrays) > 0)
for name in sorted(set(arrays) - {""}):
    checks(f"array {name} is written", name in written)
checks.done()
