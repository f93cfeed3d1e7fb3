"""The Python of the first page runs, and ends in numbers."""

import contextlib
import io
import re

from conftest import ROOT


def test_the_readmes_lines_run() -> None:
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    programs = re.findall(r"^```python\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert programs
    for program in programs:
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(program, {})
        assert re.search(r"\d\.\d", said.getvalue()), program
