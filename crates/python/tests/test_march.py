"""Marches along rails that vary."""

from pathlib import Path

import numpy as np
import pytest

import wheelrail as wr

EXAMPLES = Path(__file__).parents[3] / "examples"
CROSSING = EXAMPLES / "crossing" / "crossing.toml"
FLAT = EXAMPLES / "wheel_flat" / "wheel_flat.toml"

SWEPT = """
rail = { profile = "60E1" }
wheel = { profile = "S1002", radius = 460.0 }
track = { spacing = 1500.0 }
wheelset = { spacing = 1500.0 }
"""


def test_a_march_gives_rows_and_events() -> None:
    along = np.arange(-100.0, 301.0, 10.0)
    seen: list[tuple[int, int]] = []
    rows, events = wr.march(CROSSING, along, progress=lambda done, most: seen.append((done, most)))
    assert seen[-1] == (41, 41)
    lowest = rows["contact"] == 1
    assert np.array_equal(rows["along_mm"][lowest & rows["right"]], along)
    # Both wheels touch: the roll is solved.
    right, left = rows["z_mm"][lowest & rows["right"]], rows["z_mm"][lowest & ~rows["right"]]
    assert np.allclose(right, left, atol=1e-9)
    assert np.array_equal(rows["along_mm"][rows["position"] == 3], rows["along_mm"][rows["along_mm"] == -70.0])
    jumps = enumerate(events["radius_jump_mm"])
    (k,) = [k for k, jump in jumps if jump > 1.0 and events["event"][k] == "transfer"]
    assert events["side"][k] == "right"
    assert events["rail_x_before_mm"][k] > 40.0 and events["rail_x_after_mm"][k] < -20.0
    # The columns of a sweep under its names, with their words.
    sweep = wr.Case.from_toml(SWEPT).sweep([0.0], conicity=False)
    assert list(rows)[: len(sweep)] == list(sweep)
    assert np.array_equal(rows["side"] == "right", rows["right"]) and set(rows["side"]) == {"left", "right"}
    assert rows["doubt"].dtype.kind == "U" and len(rows["doubt"]) == len(rows["z_mm"])
    nose = lowest & rows["right"] & (rows["along_mm"] == 140.0)
    assert rows["contact_pitch_rad"][nose][0] == pytest.approx(np.arctan(0.05), abs=3e-3)


def test_a_march_of_no_place_is_empty() -> None:
    rows, events = wr.march(CROSSING, [])
    assert rows["along_mm"].size == 0 and events["event"] == []


@pytest.mark.parametrize(
    ("along", "message"),
    [
        ([0.0, 400.0], "found 400 mm; expected a place from -150 to 350 mm"),
        ([10.0, 0.0], "found 0 mm after 10 mm"),
        ([float("nan")], "found NaN mm"),
    ],
)
def test_places_that_cannot_be_marched_to_are_named(along: list[float], message: str) -> None:
    with pytest.raises(wr.InputError, match=message):
        wr.march(CROSSING, along)


def test_a_scene_without_slices_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(
        '[rail]\nprofile = "60E1"\n[wheel]\nprofile = "S1002"\nradius = 460.0\n'
        "[track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\n"
    )
    with pytest.raises(wr.InputError, match="rails of one profile each"):
        wr.march(tmp_path / "scene.toml", [0.0])


def test_a_wheel_with_a_flat_comes_down_on_it_and_goes_over() -> None:
    angle = np.linspace(-0.1, 0.1, 21)
    rows, events = wr.march(FLAT, angle=angle)
    lowest = (rows["contact"] == 1) & rows["right"]
    assert np.array_equal(rows["angle_rad"][lowest], angle)
    z = rows["z_mm"][lowest]
    depth = 460.0 - np.sqrt(460.0**2 - 30.0**2)
    assert z[10] - z[0] == pytest.approx(-depth, abs=0.02) and np.allclose(z, z[::-1], atol=1e-9)
    (over,) = [k for k, side in enumerate(events["side"]) if side == "right" and events["event"][k] == "transfer"]
    assert events["angle_rad"][over] == pytest.approx(0.0, abs=0.01 / 460.0)
    assert events["y_before_mm"][over] > 25.0 and events["y_after_mm"][over] < -25.0
    assert events["impact_angle_rad"][over] > 0.1


def test_a_march_goes_along_or_around() -> None:
    with pytest.raises(wr.InputError, match="neither `along` nor `angle`"):
        wr.march(FLAT)
    with pytest.raises(wr.InputError, match="`along` and `angle`"):
        wr.march(FLAT, [0.0], angle=[0.0])
    with pytest.raises(wr.InputError, match="rails of one profile each"):
        wr.march(FLAT, [0.0])
    with pytest.raises(wr.InputError, match="rails that vary along the track"):
        wr.march(CROSSING, angle=[0.0])
