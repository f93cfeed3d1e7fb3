"""The types, as pyright reads them; cargo's tests ask mypy."""

import json
import subprocess
import sys
from pathlib import Path

from conftest import ROOT, need

PACKAGE = ROOT / "crates/python"


def test_pyright_finds_no_fault_in_strict_mode() -> None:
    need("basedpyright", "dask", "jupytext", "matplotlib", "meshio", "pandas", "polars", "pyarrow", "pyvista", "tamaas", "tqdm", "xarray")
    command = [sys.executable, "-m", "basedpyright", "--project", "pyproject.toml", "--pythonpath", sys.executable, "--outputjson"]
    run = subprocess.run(command, cwd=PACKAGE, capture_output=True, text=True)
    found = json.loads(run.stdout)
    faults = [f"{Path(each['file']).name}:{each['range']['start']['line'] + 1}: {each['message']}" for each in found["generalDiagnostics"]]
    assert not faults, "\n".join(faults)
    folders = ("python/wheelrail", "tests", "benches", "gallery")
    files = [file for folder in folders for file in (PACKAGE / folder).iterdir() if file.suffix in (".py", ".pyi")]
    assert run.returncode == 0 and found["summary"]["filesAnalyzed"] == len(files), found["summary"]
