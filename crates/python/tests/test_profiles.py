"""Profiles from arrays, segments and files, and back."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import wheelrail as wr


def test_points_become_what_a_file_of_them_becomes(tmp_path: Path) -> None:
    x, z = wr.wheel("S1002").points(0.2).T
    z = z + 0.4 * np.exp(-((x / 20.0) ** 2))
    np.savetxt(tmp_path / "worn.txt", np.column_stack([x, z]), fmt="%.17g")
    several: list[dict[str, Any]] = [{"cutoff_wavelength": 5.0}, {"curve": "interpolation"}, {"curve": "arcs", "mirror": False}]
    for options in several:
        made = wr.Profile.from_points(x, z, side="wheel", name="worn", **options)
        read = wr.read_profile(tmp_path / "worn.txt", "wheel", **options)
        assert np.array_equal(made.points(), read.points()) and (made.name, made.side) == ("worn", "wheel")
        assert made.record is not None and made.record["points_used"] == len(x)
    inches = wr.Profile.from_points(x / 25.4, z / 25.4, side="wheel", unit="in", cutoff_wavelength=5.0)
    assert np.allclose(inches.points(), wr.Profile.from_points(x, z, side="wheel", cutoff_wavelength=5.0).points(), atol=1e-9)


def test_what_lies_in_a_gap_has_no_value() -> None:
    points = wr.wheel("S1002").points(0.2)
    kept = points[(np.abs(points[:, 0] + 56.0) > 11.0) | (points[:, 1] > -14.0)]
    for curve in ("interpolation", "smoothing"):
        options: dict[str, Any] = {"curve": curve, "mirror": False}
        wheel = wr.Profile.from_points(kept[:, 0], kept[:, 1], side="wheel", **options)
        for own in (wheel, copy.deepcopy(wheel), wheel.shifted(0.0, 1.0)):
            found = wr.measure_profile(own, wr.wheel("S1002"))
            assert found["flange_height_mm"] is None and found["qr_mm"] is None
            assert "gap" in found["finding"]


def test_segments_go_both_ways() -> None:
    for profile in (wr.rail("60E1"), wr.wheel("S1002")):
        segments = profile.segments()
        again = wr.Profile.from_segments(segments, side=profile.side, name=profile.name)
        assert len(again) == len(profile) and again.side == profile.side
        assert np.allclose(again.points(), profile.points(), atol=1e-12)
    with pytest.raises(wr.InputError, match="radius"):
        wr.Profile.from_segments([{"arc": {"center": [0, 0], "radius": "big", "half": "upper", "x": [0, 1]}}])
    with pytest.raises(wr.InputError, match="perhaps `line` is meant"):
        wr.Profile.from_segments([{"lin": {}}])


@pytest.mark.parametrize("name", ["w.whl", "w.prw", "w.wheel", "w.txt", "w.csv", "w.toml"])
def test_files_are_read_back(name: str, tmp_path: Path, measured: wr.Profile) -> None:
    wheel = wr.wheel("S1002")
    wheel.to_file(tmp_path / name, step=0.1)
    options: dict[str, Any] = {} if name.endswith("toml") else {"curve": "interpolation"}
    again = wr.read_profile(tmp_path / name, "wheel", **options)
    x, z = again.points(0.5)[5:-5].T
    at, height = wheel.points(0.01).T
    assert np.abs(z - cast("Any", np.interp(x, at, height))).max() < 0.02
    if not name.endswith("toml"):
        measured.to_file(tmp_path / name)
        (tmp_path / name).unlink()
    unknown = wr.Profile.from_segments(wheel.segments())
    if name.endswith(("prw", "whl")):
        with pytest.raises(wr.InputError, match="side: found none"):
            unknown.to_file(tmp_path / name)
        unknown.to_file(tmp_path / name, side="wheel")


@pytest.mark.parametrize("format", ["miniprof", "simpack", "gensys", "text", "csv", "toml"])
def test_texts_are_those_of_files(format: Any, tmp_path: Path, measured: wr.Profile) -> None:
    for profile in (wr.wheel("S1002"), measured) if format != "toml" else (wr.wheel("S1002"),):
        profile.to_file(tmp_path / "any", format=format, step=0.3)
        assert profile.to_text(format, step=0.3) == (tmp_path / "any").read_text("utf-8")


def test_curvature_is_that_of_the_drawing() -> None:
    s, kappa = wr.rail("60E1").curvature(0.1)
    assert s[0] == 0.0 and np.all(np.diff(s) >= 0.0)
    # The crown is in the middle of the rail.
    assert kappa[np.argmin(np.abs(s - s[-1] / 2))] == pytest.approx(-1 / 300, rel=1e-9)
    assert max(abs(joint["gap"]) for joint in wr.rail("60E1").joints) < 1e-9


def test_pictures_show_measured_points(measured: wr.Profile) -> None:
    assert measured.svg().count("residual") > 0 and "residual" not in wr.wheel("S1002").svg()
    moved = measured.shifted(3.0, 1.0).rotated(0.01)
    assert moved.svg().count("residual") > 0 and pickle.loads(pickle.dumps(moved)).svg() == moved.svg()


def test_profiles_hash_as_they_compare(measured: wr.Profile) -> None:
    profiles = [wr.rail("60E1"), wr.wheel("S1002"), measured, wr.wheel("S1002").mirrored()]
    assert len(set(profiles)) == 4
    assert {profile: k for k, profile in enumerate(profiles)}[copy.deepcopy(measured)] == 2
    assert hash(pickle.loads(pickle.dumps(measured))) == hash(measured)


def test_messages_name_keywords_and_former_names_are_known() -> None:
    x, z = wr.rail("60E1").points(0.5).T
    # The mirror image of a symmetric head is the same head; that of a worn one is asked for.
    assert len(wr.Profile.from_points(x, z, side="rail", curve="interpolation")) > 0
    worn = z - 0.4 * np.exp(-((x + 20.0) ** 2) / 60.0)
    with pytest.raises(wr.InputError, match="`mirror=True`"):
        wr.Profile.from_points(x, worn, side="rail")
    worn[50], worn[51] = worn[51], worn[50]
    x[50], x[51] = x[51], x[50]
    with pytest.raises(wr.InputError, match=r'`mirror=True`.*`repair=\["sort"\]`'):
        wr.Profile.from_points(x, worn, side="rail")
    assert np.array_equal(wr.rail("UIC54").points(), wr.rail("54E1").points())


def test_measures_are_those_of_the_command_line_and_say_what_is_missing() -> None:
    nominal = wr.wheel("S1002")
    x, z = nominal.points(0.1).T
    worn = z + 1.5 * np.exp(-((x / 15.0) ** 4))
    wheel = wr.Profile.from_points(x, worn, side="wheel", curve="interpolation")
    found = wr.measure_profile(wheel, nominal, align="back-and-tread")
    assert list(found)[:5] == ["file", "kind", "flange_height_mm", "flange_thickness_mm", "qr_mm"]
    assert list(found)[-1] == "finding" and found["finding"] is None
    assert abs(found["tread_wear_mm"] - 1.5) < 0.01 and found["alignment_residual_mm"] < 0.01
    assert found["w1_mm"] is None and 0.0 < found["flange_height_mm_if_off"] < 0.2
    flange = x < -20.0
    cut = wr.Profile.from_points(x[flange], z[flange], side="wheel", curve="interpolation", flip_z=False, mirror=False)
    found = wr.measure_profile(cut)
    assert found["flange_height_mm"] is None and "no tread at X = 70 mm" in found["finding"]
    wrong: list[tuple[str, Callable[[], object]]] = [
        ("side", lambda: wr.measure_profile(wr.Profile.from_segments(nominal.segments()))),
        ("nominal", lambda: wr.measure_profile(wheel, wr.rail("60E1"))),
        ("align", lambda: wr.measure_profile(wheel, align="web", side="wheel")),
        ("tread_at", lambda: wr.measure_profile(wheel, tread_at=-70.0)),
        ("treadat", lambda: cast(Any, wr.measure_profile)(wheel, treadat=70.0)),
    ]
    for match, call in wrong:
        with pytest.raises(wr.InputError, match=match):
            call()


def test_noise_and_repeats_give_intervals_that_agree() -> None:
    noise = np.random.default_rng(1)
    x, z = wr.wheel("S1002").points(0.2).T
    # Not the points beside joints, which noise would put out of order.
    apart = np.hypot(np.diff(x), np.diff(z)) > 0.15
    x, z = x[np.append(apart, True)], z[np.append(apart, True)]
    dx, dz = np.gradient(x), np.gradient(z)

    def once() -> wr.Profile:
        off = 0.02 * noise.standard_normal(len(z)) / np.hypot(dx, dz)
        return wr.Profile.from_points(
            x - off * dz, z + off * dx, side="wheel", curve="smoothing", flip_z=False, mirror=False
        )

    repeats = wr.measure_repeats([once() for _ in range(20)])
    found = wr.measure_profile(once(), noise=0.02, samples=100, seed=3)
    assert repeats["finding"] is None and repeats["flange_height_mm_samples"] == 20
    for key in ("flange_height_mm", "flange_thickness_mm", "qr_mm"):
        ratio = found[f"{key}_deviation"] / repeats[f"{key}_deviation"]
        # Four standard errors of the deviation of twenty.
        assert abs(ratio - 1.0) < 0.65, (key, ratio)
        assert repeats[f"{key}_low"] < found[key] < repeats[f"{key}_high"]
        assert 0.0 < found[f"{key}_low_error"] < found[f"{key}_high"] - found[f"{key}_low"] < 0.1
    assert found["w1_mm_low"] is None
    assert "qr_mm_low" not in wr.measure_profile(once())
    wrong: list[tuple[str, Callable[[], object]]] = [
        ("noise", lambda: wr.measure_profile(once(), noise=-0.02)),
        ("samples", lambda: wr.measure_profile(once(), noise=0.02, samples=3)),
        ("repeats", lambda: wr.measure_repeats([once()])),
        ("profiles", lambda: wr.measure_repeats([once(), wr.rail("60E1")])),
    ]
    for match, call in wrong:
        with pytest.raises(wr.InputError, match=match):
            call()


def test_an_average_has_the_spread_of_its_profiles() -> None:
    wheel = wr.wheel("S1002")
    average = wr.average_profiles([wheel.shifted(0.0, z) for z in (-0.1, 0.0, 0.1)])
    # X = 0 is the flange back: the running circle is at 70.
    at = int(np.argmin(np.abs(average["x_mm"] - 70.0)))
    assert abs(average["z_mm"][at]) < 1e-2
    assert abs(average["spread_mm"][at] - 0.1) < 1e-3 and abs(average["largest_mm"][at] - 0.1) < 1e-3
    assert average["profiles"][at] == 3 and average["finding"] == []
    assert average["profile"].side == "wheel"
    for profiles in ([wheel], [wheel, wr.rail("60E1")]):
        with pytest.raises(wr.InputError, match="profiles"):
            wr.average_profiles(profiles)
