"""Forked children, as those of multiprocessing before Python 3.14, share no threads with their parent."""

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

# What the library shares among threads, each with a result that does not depend on their number.
SHARED = {
    "sweep": "track.sweep(np.linspace(-5, 5, 500), conicity=False).rows",
    "separation": "track.touch(3.0).right[0].separation(np.linspace(-9, 9, 500), np.linspace(-9, 9, 500)).sum()",
    "normal gap": "track.touch(3.0).right[0].normal_gap(np.linspace(-4, 4, 500), np.linspace(-9, 9, 500)).sum()",
    "pressure": "track.touch(3.0).right[0].patch(load=6e4).pressure().largest",
    "files": "sorted(track.touch(3.0).right[0].patch(load=6e4).files('vtk'))",
    "picture": "len(track.touch(3.0).right[0].patch(load=6e4).svg())",
    "conicity": "wr.conicity(track, roll='neglect')['key_figures']['conicity_3mm']",
    "measure": "wr.measure_profile(wr.wheel('S1002'), wr.wheel('S1002'), noise=0.01, samples=40)['flange_height_mm']",
    "run": "len(wr.Case(EXAMPLES + '/scenes/wheelset.toml').summaries())",
    "march": "wr.march(EXAMPLES + '/crossing/crossing.toml', np.linspace(0.0, 40.0, 4))[0]['z_mm'].sum()",
    "table": "wr.table(EXAMPLES + '/scenes/wheelset.toml', (0.0, 1.0), tolerance=1e-2)(np.linspace(0, 1, 50_000))['roll_rad'].sum()",
    "touch": "track.touch(1.0).roll",
}

PROGRAM = """
import multiprocessing as mp, sys, numpy as np, wheelrail as wr
EXAMPLES = sys.argv[1]
pair = wr.Pair(wr.rail('60E1').rotated('1:40'), wr.wheel('S1002'), 460.0)
track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)

def found(_):
    return CALL

expected = found(None)
with mp.get_context('fork').Pool(2) as pool:
    # A child that hangs never answers.
    answers = pool.map_async(found, range(2)).get(timeout=500)
assert answers == [expected] * 2, (answers, expected)
print('children answer')
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
@pytest.mark.parametrize("call", SHARED)
def test_forked_children_answer(call: str, tmp_path: Path) -> None:
    program = PROGRAM.replace("CALL", SHARED[call])
    run = subprocess.run([sys.executable, "-c", program, str(ROOT / "examples")], cwd=tmp_path, capture_output=True, text=True)
    assert run.stdout == "children answer\n", run.stderr
