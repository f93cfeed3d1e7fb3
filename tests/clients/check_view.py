"""view.py without ParaView: it compiles, and every file and array that it names is written: FOLDER."""

import ast
import sys

import pyvista
from folder import Checks, Folder

folder = Folder(sys.argv[1])
checks = Checks("view.py")
tree = ast.parse((folder / "view.py").read_text())
strings = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
files = [text for text in strings if text.endswith((".vts", ".vtp", ".vtu"))]
checks("names files", len(files) > 0, ", ".join(files))
for name in files:
    checks(f"{name} is written", folder.has(name))
arrays = [node.elts[1].value for node in ast.walk(tree) if isinstance(node, (ast.List, ast.Tuple))
          and len(node.elts) == 2 and isinstance(node.elts[0], ast.Constant) and node.elts[0].value == "POINTS"]
arrays += [node.slice.value for node in ast.walk(tree) if isinstance(node, ast.Subscript)
           and isinstance(node.value, ast.Attribute) and node.value.attr == "PointData"]
written = pyvista.read(folder / "separation.vts").point_data
checks("names arrays", len(arrays) > 0)
for name in sorted(set(arrays)):
    checks(f"array {name} is written", name in written)
checks.done()
