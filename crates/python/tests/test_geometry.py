"""Profiles, contacts, separation and patches."""

import copy
import io
import pickle
import sys
from typing import Any

import numpy as np
import pytest
from conftest import need

import wheelrail as wr


def test_the_notebook_that_users_want(track: wr.Wheelset) -> None:
    touch = track.touch(lateral=6.2, yaw=0.01)
    contact = touch.right[0]
    assert 0.0 < contact.contact_angle < 1.3
    assert len(contact.rail_point) == 2 and contact.rail_point[0] < 0.0
    assert 500.0 < contact.hertz(load=60e3).max_pressure < 5000.0
    xi, eta = np.linspace(-12, 12, 201), np.linspace(-10, 10, 151)
    grid = contact.separation(xi=xi, eta=eta)
    assert grid.dtype == np.float64 and grid.shape == (201, 151) and grid.flags.c_contiguous and grid.flags.owndata
    patch = contact.patch(load=60e3)
    assert patch.area > 10.0 and patch.loops[0].shape[1] == 2 and patch.loops[0].dtype == np.float64


def test_separation_is_zero_at_c_and_the_same_from_every_method(track: wr.Wheelset) -> None:
    contact = track.touch(lateral=3.0).right[0]
    xi, eta = np.linspace(-3, 3, 31), np.linspace(-5, 5, 41)
    exact = contact.separation(xi, eta, method="pointwise")
    assert abs(exact[15, 20]) < 1e-14
    for method in ("auto", "spectral"):
        assert np.nanmax(np.abs(contact.separation(xi, eta, method=method) - exact)) < 2e-12
    assert np.array_equal(exact, contact.separation(xi.tolist(), eta[::-1][::-1], method="pointwise"))
    assert np.allclose(contact.separation(xi.astype(np.float32), eta), exact, atol=1e-6)
    # Arrays out of messages and files begin at any byte.
    unaligned = np.frombuffer(b"0" + xi.tobytes(), dtype=np.uint8)[1:].view(np.float64)
    assert not unaligned.flags.aligned
    assert np.array_equal(exact, contact.separation(unaligned, eta, method="pointwise"))


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_a_large_grid_filled_in_parts_has_the_bits_of_the_whole(track: wr.Wheelset, yaw: float) -> None:
    contact = track.touch(lateral=3.0, yaw=yaw).right[0]
    xi, eta = np.linspace(-8, 8, 1401), np.linspace(-8, 8, 1001)
    method = "spectral" if yaw else "pointwise"
    large = contact.separation(xi, eta, tolerance=1e-9, method=method)  # type: ignore[arg-type]
    for rows in (slice(0, 64), slice(1048, 1112), slice(1337, 1401)):
        part = contact.separation(xi[rows], eta, tolerance=1e-9, method="pointwise")
        assert np.nanmax(np.abs(large[rows] - part)) <= (1e-9 if yaw else 0.0)


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_the_normal_gap_follows_the_rail_and_tends_to_the_separation(track: wr.Wheelset, yaw: float) -> None:
    contact = track.touch(lateral=5.5, yaw=yaw).right[0]
    sigma, eta = np.linspace(-4, 4, 33), np.linspace(-6, 6, 41)
    t, (xi, zeta, alpha) = contact.normal_gap(sigma, eta), contact.rail_surface(sigma)
    assert t.shape == (33, 41) and t.dtype == np.float64 and xi.shape == zeta.shape == alpha.shape == sigma.shape
    assert t[16, 20] == xi[16] == zeta[16] == 0.0 and np.ptp(alpha) > 0.2
    # Steps of the points are chords of the arc, along its tangent.
    run, rise = np.diff(xi), np.diff(zeta)
    assert np.all(np.hypot(run, rise) <= 0.25) and np.allclose(np.hypot(run, rise), 0.25, rtol=1e-3)
    assert np.allclose(np.arctan2(rise, run), 0.5 * (alpha[1:] + alpha[:-1]), atol=1e-2)
    # Near C the two gaps are the same to first order.
    near = np.abs(sigma) < 0.6
    s = contact.separation(xi[near], eta)
    assert np.all(np.abs(t[near] - s) <= 0.06 * np.abs(s) + 1e-15)
    assert np.isnan(contact.normal_gap([1e4], [0.0])).all() and np.isnan(contact.rail_surface([1e4])[2]).all()
    with pytest.raises(wr.InputError, match="sigma"):
        contact.normal_gap([1.0, 0.0], eta)
    with pytest.raises(wr.InputError, match="tolerance"):
        contact.normal_gap(sigma, eta, tolerance=0.0)


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_grids_go_to_xarray_with_their_coordinates(track: wr.Wheelset, yaw: float) -> None:
    need("xarray")
    contact = track.touch(lateral=5.5, yaw=yaw).right[0]
    xi, eta = np.linspace(-80, 80, 33), np.linspace(-6, 6, 41)
    grid = wr.Grid.of_separation(contact, xi, eta, tolerance=1e-9, method="pointwise")
    flat: Any = grid.to_xarray()
    expected = contact.separation(xi, eta, tolerance=1e-9, method="pointwise")
    assert flat.values.tobytes() == grid.values.tobytes() == expected.tobytes() and np.shares_memory(flat.values, grid.values)
    assert flat.dims == ("xi", "eta") and np.isnan(flat.values).any() and float(flat.sel(xi=0.0, eta=0.0)) == 0.0
    assert np.array_equal(flat["xi"], xi) and np.array_equal(flat["eta"], eta)
    assert {name: flat[name].attrs["units"] for name in flat.coords} == {"xi": "mm", "eta": "mm"} and flat.attrs["units"] == "mm"
    bent: Any = wr.Grid.of_normal_gap(contact, xi, eta).to_xarray()
    assert bent.name == "normal_gap" and bent.dims == ("sigma", "eta") and bent["xi"].dims == ("sigma",)
    assert np.array_equal(bent, contact.normal_gap(xi, eta), equal_nan=True)
    for name, values in zip(("xi", "zeta", "alpha"), contact.rail_surface(xi)):
        assert np.array_equal(bent[name], values, equal_nan=True)
    assert bent["alpha"].attrs["units"] == "rad" and all(bent[name].attrs["long_name"] for name in bent.coords)
    # The caller's array is not the grid's.
    xi[:] = 0.0
    assert grid.axes["xi"][0] == -80.0 and repr(grid) == "Grid(separation over 33 xi x 41 eta)"
    with pytest.raises(wr.InputError, match="sigma"):
        wr.Grid.of_normal_gap(contact, [1.0, 0.0], eta)


def test_what_xarray_needs_is_said(track: wr.Wheelset, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    grid = wr.Grid.of_separation(track.touch().right[0], [-1.0, 0.0, 1.0], range(3))
    with pytest.raises(ImportError, match="pip install xarray"):
        grid.to_xarray()


def test_pressures_carry_the_load(track: wr.Wheelset) -> None:
    contact = track.touch(lateral=3.0).right[0]
    patch = contact.patch(load=60e3)
    pressure = patch.pressure()
    force = 60e3 / np.cos(contact.contact_angle)
    assert pressure.load == pytest.approx(force, rel=3e-3)
    assert pressure.values.shape == (len(pressure.xi), len(pressure.eta)) and pressure.values.min() == 0.0
    assert pressure.values.max() == pytest.approx(pressure.largest, rel=0.02)
    assert 0.3 * patch.area < pressure.contact_area < 0.7 * patch.area
    fine = patch.pressure(0.1)
    assert max(fine.cell) <= 0.1 and abs(fine.largest - pressure.largest) < pressure.largest_error
    (edge,) = fine.outline
    x, y = edge.T
    assert 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) == pytest.approx(fine.contact_area, rel=0.01)
    assert pressure == patch.pressure() and pressure != fine


def test_pressures_are_files_of_a_case() -> None:
    scene = {
        "rail": {"profile": "60E1", "rotate": "1:40"},
        "wheel": {"profile": "S1002", "radius": 460.0},
        "contact": {"offset": 3.0},
        "patch": {"load": 60e3, "pressure": True},
    }
    case = wr.Case.from_dict(scene)
    values = np.load(io.BytesIO(case.files("npy")["pressure.npy"]))
    (summary,) = case.summaries()
    assert values.max() == pytest.approx(summary["pressure"]["largest_n_per_mm2"], rel=0.02)
    assert "pressure" not in wr.Case.from_dict({**scene, "patch": {"approach": 0.05}}).files("npy")


def test_patches(track: wr.Wheelset) -> None:
    contact = track.touch().right[0]
    patch = contact.patch(approach=0.05)
    loop = patch.loops[0]
    x, y = loop.T
    shoelace = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    assert shoelace == pytest.approx(patch.area, rel=1e-3)
    on_boundary = [contact.separation([x], [y])[0, 0] for x, y in loop[::40]]
    assert np.allclose(on_boundary, 0.05, atol=1e-11)
    assert patch.load is None and patch.estimate is None and patch.approach == 0.05
    assert sum(c.area for c in patch.components) == patch.area
    xi, eta = patch.axes()
    assert 0.0 in np.abs(xi) and np.array_equal(eta, -eta[::-1])
    assert contact.patch(load=60e3).estimate == "half-space"
    assert contact.patch(approach=0.0).extent is None


def test_both_sides_of_a_centred_wheelset_are_alike(track: wr.Wheelset) -> None:
    touch = track.touch()
    assert touch.roll == 0.0 and touch.delta_r == 0.0
    assert touch.left[0].rail_point == touch.right[0].rail_point
    neglected, given = track.touch(4.0, roll="neglect"), track.touch(4.0, roll=0.0)
    assert neglected.roll == 0.0 and neglected.z == given.z and neglected.z[0] != neglected.z[1]


def test_a_single_wheel_and_chosen_points(pair: wr.Pair) -> None:
    touch = pair.touch(offset=1.0)
    found = touch.contacts[0]
    chosen = pair.placed(found.rail_point[0], found.wheel_point[0])
    assert chosen.side is None and found.side == "single"
    assert chosen.contact_angle == pytest.approx(found.contact_angle, abs=1e-9)
    assert found.feasibility() and found.feasibility().least_separation > -1e-10


def test_measured_profiles(measured: wr.Profile) -> None:
    assert measured.record is not None and measured.record["format"] == "simpack"
    assert wr.rail("60E1").record is None
    assert measured.points(0.2).shape[1] == 2


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_pickles_give_the_same_bits(track: wr.Wheelset, measured: wr.Profile, protocol: int) -> None:
    again = pickle.loads(pickle.dumps(track, protocol))
    assert again == track and again.touch(5.0).roll == track.touch(5.0).roll
    for profile in (measured, wr.rail("60E1").rotated("1:40"), wr.wheel("S1002").mirrored().shifted(1.0, 2.0)):
        assert pickle.loads(pickle.dumps(profile, protocol)) == profile
        assert np.array_equal(copy.deepcopy(profile).points(), profile.points())
    pair = wr.Pair(wr.rail("60E1"), measured, 460.0)
    assert pickle.loads(pickle.dumps(pair, protocol)) == pair != track.pair and pair.wheel.record == measured.record
    with pytest.raises(wr.InputError, match="pickled profile"):
        wr._wheelrail.profile_from_bytes(b"\x03abc")


def test_everything_prints_itself(track: wr.Wheelset) -> None:
    touch = track.touch(6.2)
    contact = touch.right[0]
    patch = contact.patch(load=60e3)
    for value in (track.pair.rail, track.pair, track, touch, contact, patch, contact.hertz(load=1e4), patch.components[0]):
        assert repr(value).startswith(type(value).__name__ + "(")
    assert repr(track) == (
        "Wheelset(Pair(\"60E1\", \"S1002\", radius=460.0), gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)"
    )
    for value in (track.pair.rail, patch):
        svg = value._repr_svg_()
        assert svg is not None and svg.lstrip().startswith("<svg")
    assert touch._repr_html_().count("<tr>") == 1 + len(touch.left) + len(touch.right)


def test_every_public_name_has_a_docstring() -> None:
    for name in wr.__all__:
        thing = getattr(wr, name)
        if name == "__version__":
            continue
        assert thing.__doc__, name
        for attribute, value in vars(thing).items() if isinstance(thing, type) else ():
            if not attribute.startswith("_"):
                assert value.__doc__, f"{name}.{attribute}"
