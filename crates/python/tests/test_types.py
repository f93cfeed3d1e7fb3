"""The types, as pyright and mypy read them."""

import json
import subprocess
import sys
from pathlib import Path

from conftest import ROOT, need

PACKAGE = ROOT / "crates/python"

# What has types, and the modules that it asks for somewhere.
FOLDERS = ("python/wheelrail", "tests", "benches", "gallery")
MODULES = ("dask", "jupytext", "matplotlib", "meshio", "pandas", "polars", "pyarrow", "pyvista", "tamaas", "tqdm", "xarray")


def test_pyright_finds_no_fault_in_strict_mode() -> None:
    need("basedpyright", *MODULES)
    command = [sys.executable, "-m", "basedpyright", "--project", "pyproject.toml", "--pythonpath", sys.executable, "--outputjson"]
    run = subprocess.run(command, cwd=PACKAGE, capture_output=True, text=True)
    found = json.loads(run.stdout)
    faults = [f"{Path(each['file']).name}:{each['range']['start']['line'] + 1}: {each['message']}" for each in found["generalDiagnostics"]]
    assert not faults, "\n".join(faults)
    files = [file for folder in FOLDERS for file in (PACKAGE / folder).iterdir() if file.suffix in (".py", ".pyi")]
    assert run.returncode == 0 and found["summary"]["filesAnalyzed"] == len(files), found["summary"]


def test_mypy_finds_no_fault_in_strict_mode(tmp_path: Path) -> None:
    need("mypy", *MODULES)
    plain = [sys.executable, "-m", "mypy", "--strict", "--config-file", "pyproject.toml", "--cache-dir", str(tmp_path)]
    run = subprocess.run([*plain, *FOLDERS], cwd=PACKAGE, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
