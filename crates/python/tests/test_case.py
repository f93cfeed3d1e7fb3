"""Scenes: what the command line runs."""

from pathlib import Path

import numpy as np
from conftest import ROOT

import wheelrail as wr

SCENE = ROOT / "examples/scenes/wheelset.toml"


def test_a_case_has_its_contacts_and_runs(tmp_path: Path) -> None:
    case = wr.Case(SCENE)
    names = [contact.name for contact in case.contacts]
    assert names[0] == "right side, contact 1" and any("left" in name for name in names)
    assert case.scene["track"] and case.path == SCENE
    run = case.run(tmp_path / "folder")
    assert run.folder.is_dir() and not run.refusals
    summary = run.summaries[0]
    folder = run.parts[0]
    xi, eta = (np.load(folder / f"{axis}.npy") for axis in ("xi", "eta"))
    contact = case.contacts[0]
    assert summary["found"]["place"]["rail_x_mm"] == contact.rail_point[0]
    tolerance = case.scene["grid"]["tolerance"]
    grid = contact.separation(xi, eta, tolerance=tolerance)
    assert grid.tobytes() == np.load(folder / "separation.npy").tobytes()


def test_run_is_the_same_in_one_call(tmp_path: Path) -> None:
    run = wr.run(str(SCENE), out=str(tmp_path / "folder"))
    assert (run.folder / "summary.json").exists()
