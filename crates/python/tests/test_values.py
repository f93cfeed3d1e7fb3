"""Meshes, normals, files of a patch; what is pickled, copied and compared; and the examples of all docstrings."""

# meshio has no types.
# pyright: reportUnknownMemberType=false

import copy
import doctest
import pickle
import warnings
from typing import Any, Literal

import numpy as np
import pytest
from conftest import need

import wheelrail as wr


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_meshes_lie_on_the_rail_and_cover_the_patch(track: wr.Wheelset, yaw: float) -> None:
    patch = track.touch(3.0, yaw=yaw).right[0].patch(load=60e3)
    for mesh in (patch.mesh(), patch.mesh(size=0.5), patch.strips()):
        corners = mesh.points[mesh.cells][..., :2]
        x, y = np.moveaxis(corners, -1, 0)
        area = 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1))
        assert area == pytest.approx(patch.area, rel=2e-2)
        assert mesh.cells.min() == 0 and mesh.cells.max() == len(mesh.points) - 1
        assert all(len(field) == len(mesh.points) for field in mesh.point_data.values())
        assert all(len(field) == len(mesh.cells) for field in mesh.cell_data.values())
    triangles = patch.mesh()
    assert np.array_equal(triangles.point_data["overlap"], patch.approach - triangles.point_data["separation"])
    assert patch.strips().cell_data["area"].sum() == pytest.approx(patch.area, rel=1e-9)


def test_meshes_go_to_meshio_and_pyvista(track: wr.Wheelset) -> None:
    need("meshio", "pyvista")
    patch = track.touch().right[0].patch(approach=0.05)
    for mesh in (patch.mesh(), patch.strips(), *patch.contact.surfaces((-5.0, 5.0), (-8.0, 8.0), approach=0.05)):
        theirs = mesh.to_meshio()
        assert theirs.cells[0].type == mesh.kind and np.array_equal(theirs.points, mesh.points)
        assert set(theirs.point_data) == set(mesh.point_data)
    import pyvista

    shown = patch.mesh().to_pyvista()
    assert isinstance(shown, pyvista.PolyData) and shown.area == pytest.approx(patch.area, rel=2e-2)
    assert shown.n_points == len(patch.mesh().points) and "overlap" in shown.point_data


def test_normals_are_unit_vectors_of_the_surfaces(track: wr.Wheelset) -> None:
    contact = track.touch(3.0, yaw=0.01).right[0]
    xi, eta = np.linspace(-3, 3, 7), np.linspace(-4, 4, 9)
    rail, wheel = contact.normals(xi, eta)
    assert rail.shape == wheel.shape == (7, 9, 3)
    assert np.allclose(np.linalg.norm(rail, axis=2), 1.0) and np.allclose(np.linalg.norm(wheel, axis=2), 1.0)
    assert np.allclose(rail[3, 4], (0, 0, 1), atol=1e-12) and np.allclose(wheel[3, 4], (0, 0, -1), atol=1e-12)
    # The rail is straight along eta, and its normal is that of its surface.
    assert np.all(rail[..., 1] == 0.0)
    step = 1e-5
    height = contact.separation(xi, [0.0], method="pointwise")
    slope = (contact.separation(xi + step, [0.0], method="pointwise") - height)[:, 0] / step
    difference = rail[:, 4, 0] / rail[:, 4, 2] - wheel[:, 4, 0] / wheel[:, 4, 2]
    assert np.allclose(slope, difference, atol=1e-5)


def test_every_format_is_written_from_a_patch(track: wr.Wheelset) -> None:
    patch = track.touch(3.0, yaw=0.002).right[0].patch(load=60e3)
    formats = wr.schema()["$defs"]["OutputFormat"]
    names = [each["const"] for each in formats["oneOf"]] if "oneOf" in formats else formats["enum"]
    assert len(names) >= 14
    for name in names:
        if name == "png":
            continue
        files = patch.files(name)
        assert files and all(isinstance(content, bytes) and content for content in files.values()), name
    assert set(patch.files()) >= {"boundary.csv", "patch.svg", "midsep.txt"}


def test_a_track_of_two_pairs_and_a_roller(pair: wr.Pair, track: wr.Wheelset) -> None:
    distances: dict[str, Any] = {"gauge": 1435.0, "back_to_back": 1360.0, "flange_back_x": -70.0}
    same = wr.Wheelset(pair, left=pair, **distances)
    assert same.touch(3.0).left[0].rail_point == pytest.approx(track.touch(3.0).left[0].rail_point, abs=1e-9)
    worn = wr.Pair(pair.rail, pair.wheel.shifted(x=1.0), 460.0)
    other = wr.Wheelset(pair, left=worn, **distances)
    assert other.left == worn and other != track and pickle.loads(pickle.dumps(other)) == other
    assert other.touch(0.0).delta_r != 0.0 and other.touch(0.0).left[0].profiles[1] == worn.wheel
    roller = wr.Pair(pair.rail, pair.wheel, 460.0, roller=350.0)
    assert roller.roller == 350.0 and pickle.loads(pickle.dumps(roller)) == roller != pair
    on_roller, on_rail = (each.touch().contacts[0].patch(approach=0.05).area for each in (roller, pair))
    assert on_roller < on_rail


def test_conicity_is_that_of_the_sweep(track: wr.Wheelset) -> None:
    for amplitude in (1.0, 3.0, 5.0):
        rolls: tuple[Literal["solve", "neglect"], ...] = ("solve", "neglect")
        for roll in rolls:
            swept = track.sweep([amplitude], roll=roll)["conicity"][0]
            assert track.conicity(amplitude, roll=roll) == pytest.approx(swept, rel=1e-3)


def test_all_values_are_pickled_copied_and_compared(pair: wr.Pair, track: wr.Wheelset) -> None:
    touch, flange = track.touch(3.0, yaw=0.002), track.touch(6.2, within=0.1)
    contact = touch.right[0]
    patch = contact.patch(load=60e3)
    chosen = pair.placed(1.0, 1.0)
    values = [
        pair, track, touch, flange, contact, chosen, chosen.patch(approach=0.05), patch, patch.components[0], patch.mesh(), patch.strips(),
        contact.hertz(load=60e3), contact.feasibility(), wr.Grid.of_separation(contact, [0.0, 1.0], [0.0, 1.0]), wr.Grid.of_normal_gap(contact, [0.0, 1.0], [0.0, 1.0]), pair.touch(), track.sweep([0.0, 1.0, 2.0]), wr.rail("60E1"),
    ]
    for value in values:
        for again in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value)):
            assert again == value and type(again) is type(value), value
        assert all(value != other for other in values if other is not value), value
    again = pickle.loads(pickle.dumps(patch))
    assert again.area == patch.area and all(map(np.array_equal, again.loops, patch.loops))
    kink = track.touch(6.2).right[0]
    assert pickle.loads(pickle.dumps(kink)).rail_point == kink.rail_point


def test_every_public_item_has_an_example_and_it_runs(pair: wr.Pair, track: wr.Wheelset) -> None:
    contact = track.touch(3.0).right[0]
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    for name in sorted(set(wr.__all__) - {"__version__"}):
        thing = getattr(wr, name)
        if isinstance(thing, type) and issubclass(thing, Exception):
            continue
        globals_ = {"wr": wr, "np": np, "pair": pair, "track": track, "contact": contact}
        test = parser.get_doctest(thing.__doc__ or "", globals_, name, None, None)
        assert test.examples, f"{name} has no example"
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            runner.run(test)
    assert runner.failures == 0
    assert "What there is" in (wr.__doc__ or "")
