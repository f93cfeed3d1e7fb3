"""Contact tables."""

import copy
import os
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import wheelrail as wr

SCENE = ROOT / "examples/scenes/wheelset.toml"
NAMES = ("z_mm", "rail_x_mm", "wheel_x_mm", "y_mm", "contact_angle_rad", "rolling_radius_mm", "skew_rad", "hertz_xi_mm", "hertz_eta_mm")


@pytest.mark.parametrize("yaws", [None, (-0.02, 0.02)])
def test_no_look_up_errs_by_more_than_the_table_states(tmp_path: Path, yaws: tuple[float, float] | None) -> None:
    made = wr.table(SCENE, (-9.0, 9.0), yaw=yaws, hertz=True, out=tmp_path / "t")
    table = wr.ContactTable(tmp_path / "t/table.wrp")
    assert table.yaw == (yaws or (0.002, 0.002)) and table.errors == made.errors
    assert table.hops(0.002) == made.hops(0.002) and len(table.joints(0.002)) > 0
    points = int(os.environ.get("WHEELRAIL_TABLE_POINTS", "2000"))
    random = np.random.default_rng(3)
    lateral, yaw = random.uniform(-9.0, 9.0, points), random.uniform(*table.yaw, points)
    found = table(lateral, yaw)
    rows = wr.Case(SCENE).sweep(lateral, yaw, conicity=False)
    lowest = np.asarray(rows["contact"]) == 1
    for side in ("left", "right"):
        chosen = lowest & (np.asarray(rows["side"]) == side)
        for name in NAMES:
            error = np.abs(found[side][name] - np.asarray(rows[name])[chosen])
            assert np.nanmax(error) <= table.errors[side][name] <= table.tolerances[side][name], (side, name)
    both = found["right"]["rolling_radius_mm"]
    assert np.array_equal(made(lateral, yaw, quantities=["rolling_radius_mm"])["right"]["rolling_radius_mm"], both)
    assert np.isnan(table([10.0], 0.002)["roll_rad"]).all()
    assert table(lateral[:1], float(yaw[0]))["roll_rad"][0] == found["roll_rad"][0]


@pytest.mark.parametrize("yaws", [None, (-0.01, 0.01)])
def test_tables_are_pickled_and_copied(yaws: tuple[float, float] | None) -> None:
    table = wr.table(SCENE, (-2.0, 6.5), yaw=yaws, tolerance=1e-2)
    lateral, yaw = np.linspace(-2.0, 6.5, 200), 0.002
    expected = table(lateral, yaw)
    for again in (pickle.loads(pickle.dumps(table)), copy.copy(table), copy.deepcopy(table)):
        found = again(lateral, yaw)
        for side in ("left", "right"):
            for name, values in expected[side].items():
                assert np.array_equal(found[side][name], values, equal_nan=True), (side, name)
        assert np.array_equal(found["roll_rad"], expected["roll_rad"])
        assert (again.errors, again.tolerances, again.lateral, again.yaw) == (
            table.errors, table.tolerances, table.lateral, table.yaw
        )
        assert again.beside_curves == table.beside_curves and repr(again) == repr(table)
        assert again.hops(yaw) == table.hops(yaw) and again.joints(yaw) == table.joints(yaw)


def test_a_table_says_where_a_wheel_is_off_its_rail(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'rail = { profile = "60E1" }\nwheel = { profile = "cone-1:20", radius = 460.0 }\n'
        "track = { spacing = 1500.0 }\nwheelset = { spacing = 1500.0 }\n"
    )
    table = wr.table(scene, (50.0, 140.0))
    [(start, end)] = table.off_rail()
    assert 50.0 < start < 139.0 and end == 140.0
    found = table([0.5 * (50.0 + start), 0.5 * (start + end)])
    for values in (found["roll_rad"], found["left"]["rail_x_mm"], found["right"]["rolling_radius_mm"]):
        assert np.isnan(values).tolist() == [False, True]
    assert wr.table(SCENE, (0.0, 1.0)).off_rail() == []
    scene.write_text(SCENE.read_text().replace('"solve"', '"load"'))
    with pytest.raises(wr.InputError, match='roll: found "load"; expected "solve"'):
        wr.table(scene, (0.0, 1.0))


def test_wrong_calls_are_named(tmp_path: Path) -> None:
    table = wr.table(SCENE, (0.0, 1.0), tolerance=1e-2)
    assert (table.lateral, table.yaw) == ((0.0, 1.0), (0.002, 0.002))
    with pytest.raises(wr.InputError, match="yaw: found 0; expected 0.002 rad"):
        table([0.5], 0.0)
    over_yaw = wr.table(SCENE, (0.0, 0.1), yaw=(0.0, 0.001), tolerance=1e-2)
    with pytest.raises(wr.InputError, match="yaw: found none; expected a yaw in rad"):
        over_yaw([0.05])
    with pytest.raises(wr.InputError, match="yaw: found 2 values; expected one, or 3 as of lateral"):
        over_yaw([0.0, 0.05, 0.1], [0.0, 0.001])
    with pytest.raises(wr.InputError, match="table: yaw: found 0.1:0"):
        wr.table(SCENE, (0.0, 1.0), yaw=(0.1, 0.0))
    with pytest.raises(wr.InputError, match='quantities: found "radius"'):
        table([0.5], quantities=["radius"])
    (tmp_path / "cut.wrp").write_text("WRTABLE    1 mm\n")
    with pytest.raises(wr.InputError, match="line 2: found the end of the file"):
        wr.ContactTable(tmp_path / "cut.wrp")
    with pytest.raises(wr.InputError, match="FROM < TO"):
        wr.table(SCENE, (1.0, 0.0))
