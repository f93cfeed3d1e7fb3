"""The gallery: every notebook runs, as the program that it is, and the page says what it prints."""

# jupytext has no types.
# pyright: reportUnknownMemberType=false

import subprocess
import sys
from pathlib import Path

from conftest import need

PACKAGE = Path(__file__).resolve().parents[1]


def test_each_program_is_a_notebook() -> None:
    need("jupytext")
    import jupytext

    notebooks = list((PACKAGE / "gallery").glob("*.py"))
    assert len(notebooks) == 8
    for notebook in notebooks:
        kinds = [cell.cell_type for cell in jupytext.read(notebook).cells]
        assert kinds[0] == "markdown" and kinds.count("code") >= 1


def test_the_page_says_what_the_notebooks_print(tmp_path: Path) -> None:
    need("distributed", "matplotlib", "pyarrow", "tamaas")
    command = [sys.executable, str(PACKAGE / "tests/gallery_page.py"), str(tmp_path)]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    page = Path("src/docs/gallery.md")
    assert (tmp_path / page).read_text(encoding="utf-8") == (PACKAGE.parents[1] / page).read_text(encoding="utf-8")
    assert len(list((tmp_path / "output/pictures/gallery").iterdir())) == 8
