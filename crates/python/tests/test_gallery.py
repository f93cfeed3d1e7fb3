"""The gallery: every notebook runs, as the program that it is."""

# jupytext has no types.
# pyright: reportUnknownMemberType=false

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import need

GALLERY = Path(__file__).resolve().parents[1] / "gallery"
NOTEBOOKS = sorted(GALLERY.glob("*.py"))
NEEDS = {"pressure_with_tamaas": ["tamaas"], "conicity_of_a_fleet": ["distributed", "pyarrow"]}


def test_the_gallery_is_there() -> None:
    assert len(NOTEBOOKS) == 8


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_is_one(notebook: Path, tmp_path: Path) -> None:
    need("jupytext", *NEEDS.get(notebook.stem, []))
    import jupytext

    kinds = [cell.cell_type for cell in jupytext.read(notebook).cells]
    assert kinds[0] == "markdown" and kinds.count("code") >= 1
    run = subprocess.run([sys.executable, str(notebook)], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
