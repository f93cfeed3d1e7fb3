"""The command line and Python compute the same bits."""

import csv
import os
import subprocess
from pathlib import Path

import numpy as np

import wheelrail as wr
from conftest import ROOT, absent

SCENES = ROOT / "examples/scenes"


def run(folder: Path, *arguments: str) -> None:
    """Run the program of the command line in a folder; scripts/test-python says where the program is."""
    program = os.environ.get("WHEELRAIL_PROGRAM") or absent("WHEELRAIL_PROGRAM names no program")
    subprocess.run([program, *arguments], cwd=folder, check=True, capture_output=True)


def test_grids_are_those_of_a_run(tmp_path: Path) -> None:
    scene = SCENES / "60e1_s1002.toml"
    run(tmp_path, "run", str(scene), "--out", "run")
    case = wr.Case(scene)
    xi, eta, written = (np.load(tmp_path / f"run/{name}.npy") for name in ("xi", "eta", "separation"))
    grid = case.contacts[0].separation(xi, eta, tolerance=case.scene["grid"]["tolerance"])
    assert grid.size > 40_000
    assert grid.tobytes() == written.tobytes()


def test_a_sweep_by_the_wheelset_of_a_scene_is_that_of_the_program(tmp_path: Path) -> None:
    scene = SCENES / "wheelset.toml"
    run(tmp_path, "sweep", str(scene), "--lateral", "-8:8:0.1", "--out", "sweep.csv")
    with (tmp_path / "sweep.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    case = wr.Case(scene)
    rail, wheel = case.contacts[0].profiles
    track, wheelset, patch = case.scene["track"], case.scene["wheelset"], case.scene["patch"]
    system = wr.Wheelset(
        wr.Pair(rail, wheel, case.scene["wheel"]["radius"]),
        gauge=track["gauge"],
        gauge_height=track.get("gauge_height"),
        back_to_back=wheelset["back_to_back"],
        flange_back_x=wheelset["flange_back_x"],
    )
    table = system.sweep(
        np.arange(-80, 81) / 10, wheelset["yaw"], wheelset["roll"],
        within=wheelset.get("within", 0.0), load=patch.get("load"), approach=patch.get("approach"),
    )
    assert table.rows == len(rows) > 300
    for name in rows[0]:
        column, written = table[name], [row[name] for row in rows]
        if name in ("side", "contact", "kink", "doubt"):
            assert [str(int(value)) if name == "kink" else str(value) for value in column] == written, name
        else:
            cells = np.array([float(cell or "nan") for cell in written])
            assert cells.tobytes() == np.where(np.isnan(column), np.nan, column).tobytes(), name
