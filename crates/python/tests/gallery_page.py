"""Makes the gallery's page: python tests/gallery_page.py [FOLDER], with wheelrail and matplotlib installed.

Runs every notebook of `gallery/` and writes `src/docs/gallery.md` and `output/pictures/gallery/` of the repository, or of another
folder: title, first words, printed lines, and what the notebook's `picture` shows.
"""

import contextlib
import io
import os
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
ORDER = (
    "first_contact",
    "worn_against_new",
    "two_point_contact",
    "pressure_with_tamaas",
    "conicity_of_a_fleet",
    "two_sides",
    "mesh_for_finite_elements",
    "conformal_flange_root",
)
NOTEBOOKS = [PACKAGE / "gallery" / f"{name}.py" for name in ORDER]
HEAD = """# Gallery of studies

*After this page you can begin a study of your own from one of eight that run.*

Eight studies from Python, each a notebook as a program, which Jupyter opens by jupytext. `python crates/python/tests/gallery_page.py`
makes this page; the tests run the studies and compare what they print.
"""


def run(notebook: Path) -> tuple[str, object]:
    """Return what a notebook prints, and its picture."""
    names: dict[str, object] = {"__name__": "__main__"}
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(notebook.read_text(encoding="utf-8"), notebook, "exec"), names)
    return printed.getvalue(), names["picture"]


def save(picture: object, path: Path) -> str:
    """Write a picture and return its file's name: SVG where it draws itself, PNG of a figure."""
    draw = getattr(picture, "_repr_svg_", None)
    if draw is not None:
        path = path.with_suffix(".svg")
        path.write_text(draw(), encoding="utf-8")
    else:
        path = path.with_suffix(".png")
        getattr(picture, "savefig")(path, dpi=100)
    return path.name


def section(notebook: Path, pictures: Path) -> str:
    """Run a notebook, save its picture, and return its part of the page."""
    printed, picture = run(notebook)
    words = notebook.read_text(encoding="utf-8").split("# %%")[1].splitlines()[1:]
    title, *text = [line.removeprefix("# ") for line in words if line.strip()]
    name = save(picture, pictures / notebook.stem)
    link = f"[{notebook.name}](../../crates/python/gallery/{notebook.name})"
    shown = f"![{title.removeprefix('# ')}](../../output/pictures/gallery/{name})"
    return "\n".join([f"\n#{title}\n", *text, "", f"{link} prints", "", "```text", printed.rstrip(), "```", "", shown, ""])


def make(root: Path) -> str:
    """Write page and pictures under a folder; return the page."""
    # Without a screen.
    os.environ["MPLBACKEND"] = "Agg"
    pictures, page = root / "output/pictures/gallery", root / "src/docs/gallery.md"
    for folder in (pictures, page.parent):
        folder.mkdir(parents=True, exist_ok=True)
    text = HEAD + "".join(section(notebook, pictures) for notebook in NOTEBOOKS)
    page.write_text(text, encoding="utf-8")
    return text


if __name__ == "__main__":
    make(Path(sys.argv[1]) if len(sys.argv) > 1 else PACKAGE.parents[1])
