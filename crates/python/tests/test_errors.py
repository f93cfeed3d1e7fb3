"""Every error says where, what was found, what was expected and what to do."""

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import wheelrail as wr


def test_an_error_has_four_parts_and_survives_pickling() -> None:
    with pytest.raises(wr.InputError) as caught:
        wr.rail("60e1")
    error = caught.value
    assert isinstance(error, ValueError) and isinstance(error, wr.Error)
    assert (error.place, error.found) == ("profile", '"60e1"')
    assert "60E1" in error.expected and error.advice
    assert str(error) == f"profile: found {error.found}; expected {error.expected}; {error.advice}"
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_what_is_wrong_is_named(pair: wr.Pair, track: wr.Wheelset, tmp_path: Path) -> None:
    contact = track.touch().right[0]
    axis = np.linspace(-1, 1, 5)
    (tmp_path / "wheel.csv").write_text("x,z\n0,0\n1,0\n")
    cases: list[tuple[type[wr.Error], str, Callable[[], object]]] = [
        (wr.InputError, "radius", lambda: wr.Pair(pair.rail, pair.wheel, radius=-1.0)),
        (wr.InputError, "gauge", lambda: wr.Wheelset(pair, gauge=1435.0, rail_spacing=1500.0, wheel_spacing=1500.0)),
        (wr.InputError, "none of `back_to_back`", lambda: wr.Wheelset(pair, gauge=1435.0)),
        (wr.InputError, "yaw", lambda: track.touch(yaw=0.6)),
        (wr.InputError, "lateral", lambda: track.touch(float("nan"))),
        (wr.InputError, "roll", lambda: track.touch(roll="solved")),  # type: ignore[arg-type]
        (wr.GeometryError, "no contact", lambda: track.touch(300.0)),
        (wr.GeometryError, "no contact", lambda: pair.touch(300.0)),
        (wr.InputError, "xi: found 1 after 2", lambda: contact.separation([0.0, 2.0, 1.0], axis)),
        (wr.InputError, "eta: found no values", lambda: contact.separation(axis, [])),
        (wr.InputError, "xi: found nan", lambda: contact.separation([0.0, np.nan], axis)),
        (wr.InputError, "perhaps `spectral`", lambda: contact.separation(axis, axis, method="spectrall")),  # type: ignore[arg-type]
        (wr.InputError, "tolerance", lambda: contact.separation(axis, axis, tolerance=0.0)),
        (wr.InputError, "exactly one of", lambda: contact.hertz()),
        (wr.InputError, "exactly one of", lambda: contact.patch(load=1.0, approach=1.0)),
        (wr.InputError, "modulus", lambda: contact.hertz(load=1.0, modulus=-1.0)),
        (wr.InputError, "empty patch", lambda: contact.patch(approach=0.0).axes()),
        (wr.InputError, "yaw: found 3 values beside 2", lambda: track.sweep([0.0, 1.0], [0.0, 0.0, 0.0])),
        (wr.InputError, "position 2: lateral", lambda: track.sweep([0.0, np.nan], conicity=False)),
        (wr.InputError, "rotated", lambda: pair.rail.rotated("1:0")),
        (wr.InputError, "`flip_z=True`", lambda: wr.Profile.from_points(*pair.wheel.points(0.5).T, side="rail")),
        (wr.InputError, "no side", lambda: wr.read_profile(tmp_path / "wheel.csv")),
        (wr.InputError, "cutof_wavelength", lambda: wr.read_profile(tmp_path / "wheel.csv", cutof_wavelength=1)),  # type: ignore[call-arg]
        (wr.FileError, "no such file", lambda: wr.read_profile(tmp_path / "none.whl")),
        (wr.FileError, "no such file", lambda: wr.Case(tmp_path / "none.toml")),
    ]
    for kind, message, fail in cases:
        with pytest.raises(kind) as caught:
            fail()
        assert message.lower() in str(caught.value).lower(), f"{message}: {caught.value}"
        assert caught.value.advice, message
