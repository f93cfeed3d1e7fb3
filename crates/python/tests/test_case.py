"""Scenes: what the command line runs, with and without files."""

import json
import pickle
import warnings
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import wheelrail as wr

SCENE = ROOT / "examples/scenes/wheelset.toml"

# Both sides of a wheelset, with profiles as they are in memory.
TWO_SIDES: dict[str, Any] = {
    "rail": {"profile": wr.rail("60E1"), "rotate": "1:40"},
    "wheel": {"profile": wr.wheel("S1002"), "radius": 460.0},
    "left": {"wheel": {"profile": wr.wheel("S1002").shifted(x=0.5)}, "deviation": {"lateral": -1.0}},
    "track": {"gauge": 1435.0},
    "wheelset": {"back_to_back": 1360.0, "flange_back_x": -70.0, "lateral": 3.0, "load": 120e3, "roll": "load"},
    "grid": {"spacing": 0.5},
}


def test_a_case_has_its_contacts_and_runs(tmp_path: Path) -> None:
    case = wr.Case(SCENE)
    names = [contact.name for contact in case.contacts]
    assert names[0] == "right side, contact 1" and any("left" in name for name in names)
    assert case.scene["track"] and case.path == SCENE
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = case.run(tmp_path / "folder")
    assert any("conformal solver" in str(warning.message) for warning in caught)
    assert run.folder.is_dir() and not run.refusals
    summary = run.summaries[0]
    folder = run.parts[0]
    xi, eta = (np.load(folder / f"{axis}.npy") for axis in ("xi", "eta"))
    contact = case.contacts[0]
    # Of a region of two places the frame is the weighted one.
    assert summary["rail"]["contact_x_mm"] == contact.rail_point[0]
    assert (contact.side, contact.number, contact.approach) == ("right", 1, summary["approach_mm"])
    assert contact.normal_load == pytest.approx(summary["normal_load_n"])
    tolerance = case.scene["grid"]["tolerance"]
    grid = contact.separation(xi, eta, tolerance=tolerance)
    assert grid.tobytes() == np.load(folder / "separation.npy").tobytes()
    # What a file has, memory has, but for lists of files, times and paths between them.
    in_memory = case.summaries()[0]
    for key in set(summary) - {"files", "files_skipped", "timings", "scene_file", "triangle_mesh", "surface_quality"}:
        assert in_memory[key] == summary[key], key
    for name in ("separation.npy", "separation.vts", "patch.vtu", "contact.inp"):
        files = {**case.files("npy"), **case.files("vtk"), **case.files("contact")}
        assert files[name] == (folder / name).read_bytes(), name
    assert case.files()["boundary.csv"] == (folder / "boundary.csv").read_bytes()
    assert case.view().encode() == (folder / "view.html").read_bytes()
    assert case._repr_html_().startswith("<iframe srcdoc=")


@pytest.mark.filterwarnings("ignore::wheelrail.Doubt")
def test_run_is_the_same_in_one_call(tmp_path: Path) -> None:
    run = wr.run(str(SCENE), out=str(tmp_path / "folder"))
    assert (run.folder / "summary.json").exists()


def test_a_dict_a_text_and_a_file_give_the_same(tmp_path: Path) -> None:
    text = SCENE.read_text("utf-8")
    from_file, from_text = wr.Case(SCENE), wr.Case.from_toml(text)
    from_dict = wr.Case.from_dict(from_file.scene)
    again = wr.Case.from_toml(from_dict.to_toml())
    first = from_file.contacts[0].patch()
    for case in (from_text, from_dict, again):
        assert case.scene == from_file.scene and case.path is None
        patch = case.contacts[0].patch()
        assert (patch.approach, patch.area) == (first.approach, first.area)
    assert from_dict == from_text != from_file


def test_two_sides_of_given_profiles_share_the_load_of_an_axle() -> None:
    case = wr.Case.from_dict(TWO_SIDES)
    contacts = case.contacts
    assert {contact.side for contact in contacts} == {"left", "right"}
    vertical = [contact.normal_load * np.cos(contact.contact_angle) for contact in contacts if contact.normal_load]
    assert sum(vertical) == pytest.approx(120e3, rel=2e-3)
    assert case.scene["left"]["wheel"]["profile"] == TWO_SIDES["left"]["wheel"]["profile"]
    assert wr.Case.from_dict(case.scene) == case
    assert np.isfinite(case.sweep([3.0])["hertz_xi_mm"]).all()
    written = wr.Case.from_toml(case.to_toml()).contacts
    assert written[0].rail_point == pytest.approx(contacts[0].rail_point, abs=1e-9)
    npy = case.files("npy")
    folders = {name.rpartition("/")[0] for name in npy}
    assert len(folders) == len(case.summaries()) and np.load(BytesIO(npy["xi.npy"])).ndim == 1


def test_measured_profiles_of_a_dict_keep_their_bits(measured: wr.Profile) -> None:
    scene = {**TWO_SIDES, "wheel": {"profile": measured, "radius": 460.0}, "left": None, "patch": None}
    case = wr.Case.from_dict(scene)
    track = wr.Wheelset(
        wr.Pair(wr.rail("60E1").rotated("1:40"), measured, 460.0), gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0
    )
    lateral = np.arange(-3, 4)
    assert case.sweep(lateral, conicity=False)["rail_x_mm"].tobytes() == track.sweep(lateral, conicity=False)["rail_x_mm"].tobytes()
    with pytest.raises(wr.InputError, match="parametric spline"):
        case.to_toml()
    text = '[rail]\nprofile = "60E1"\n[wheel]\nprofile = "worn"\nradius = 460.0\n[contact]\noffset = 0.0\n'
    assert wr.Case.from_toml(text, profiles={"worn": measured}).contacts[0].profiles[1] == measured


def test_what_is_wrong_with_a_scene_is_said_by_its_key() -> None:
    wrong: dict[str, dict[str, Any]] = {
        "scene: wheel: radius": {"wheel": {"profile": "S1002", "radius": "460"}},
        "scene: grid: xi: values": {"grid": {"xi": {"values": [0.0, np.nan]}}},
        "scene: track: gauge": {"track": {"gauge": 1.435}},
        "scene: wheel: profile: found \"60E1 #": {"wheel": {"profile": wr.rail("60E1"), "radius": 460.0}},
    }
    for key, change in wrong.items():
        with pytest.raises(wr.InputError) as caught:
            wr.Case.from_dict({**TWO_SIDES, **change})
        assert str(caught.value).removeprefix("scene: ").startswith(key.removeprefix("scene: ")), caught.value
    with pytest.raises(wr.InputError, match="line 2"):
        wr.Case.from_toml("[wheel]\nradius = 460,5")


def test_cases_are_pickled_with_their_profiles() -> None:
    case = wr.Case.from_dict(TWO_SIDES, title="two sides")
    again = pickle.loads(pickle.dumps(case))
    assert again == case and again.title == "two sides"
    contact = case.contacts[1]
    assert pickle.loads(pickle.dumps(contact)) == contact != case.contacts[0]
    assert pickle.loads(pickle.dumps(wr.Case(SCENE))) == wr.Case(SCENE)


def test_the_schema_is_that_of_the_command_line() -> None:
    assert {"rail", "wheel", "grid"} <= wr.schema()["properties"].keys()
    assert json.dumps(wr.schema())


def test_contacts_are_checked_and_sweeps_have_pages() -> None:
    case = wr.Case.from_dict(TWO_SIDES)
    checks = case.check()
    assert [check.name for check in checks] == [contact.name for contact in case.contacts]
    assert all(check.agrees for check in checks)
    assert str(checks[0]) == checks[0].text and "parry3d" in checks[0].text
    assert checks[0].values["plane"]["counts"] and checks[0].values["rail"] is None
    assert pickle.loads(pickle.dumps(checks[0])) == checks[0]
    table = case.sweep(np.linspace(-4.0, 4.0, 9))
    page = case.sweep_page(table)
    assert page.startswith("<!") and case.scene["track"] and "</html>" in page
    with pytest.raises(wr.InputError):
        case.sweep_page(case.sweep([1.0, 0.0]))
    single = wr.Case.from_dict({**{key: TWO_SIDES[key] for key in ("rail", "wheel")}, "contact": {"offset": 2.0}})
    with pytest.raises(wr.InputError, match="track"):
        single.sweep_page(table)
