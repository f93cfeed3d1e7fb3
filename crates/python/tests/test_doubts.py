"""What the command line doubts, Python warns of."""

import pickle
import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import wheelrail as wr


def doubts(call: Callable[[], object]) -> dict[str, str]:
    """Return the doubts of a call by their kinds; each must name this file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    found = [warning for warning in caught if issubclass(warning.category, wr.Doubt)]
    assert all(warning.filename == __file__ for warning in found), [warning.filename for warning in found]
    return {warning.message.kind: str(warning.message) for warning in found}  # type: ignore[union-attr]


def test_what_is_usual_is_not_doubted(track: wr.Wheelset) -> None:
    def usual() -> None:
        contact = track.touch(3.0, yaw=0.01).right[0]
        contact.patch(load=60e3)
        contact.patch(approach=0.05)
        contact.hertz(load=60e3, modulus=1.15e5)
        track.sweep(np.arange(-5, 6))
        wr.rail("60E1").rotated("1:20")

    assert doubts(usual) == {}


def test_slips_are_doubted_by_their_kind_with_their_number(pair: wr.Pair, track: wr.Wheelset) -> None:
    rail, wheel = pair.rail, pair.wheel
    contact = track.touch().right[0]
    distances: dict[str, Any] = {"gauge": 1435.0, "back_to_back": 1360.0, "flange_back_x": -70.0}

    def wheelset(**other: float) -> wr.Wheelset:
        keywords: dict[str, Any] = {**distances, **other}
        return wr.Wheelset(pair, **keywords)

    cases: list[tuple[str, str, Callable[[], object]]] = [
        ("load", "load: 60 N is the weight of 6.1 kg", lambda: contact.patch(load=60)),
        ("load", "load: 60 N", lambda: contact.hertz(load=60)),
        ("load", "load: 60 N", lambda: track.sweep([0.0], load=60)),
        ("approach", "an approach of 5.0000 mm", lambda: contact.patch(approach=5)),
        ("approach", "which would be 0.05 mm if it were in m", lambda: contact.patch(approach=5e-5)),
        ("approach", "an approach of 5.0000 mm", lambda: contact.hertz(approach=5)),
        ("modulus", "modulus: 1.15e2 N/mm² is no metal's", lambda: contact.hertz(load=60e3, modulus=115)),
        ("modulus", "modulus: 1.15e2", lambda: contact.patch(load=60e3, modulus=115)),
        ("modulus", "rail: 2.1e2 N/mm²", lambda: wr.effective_modulus(rail=(210.0, 0.28))),
        ("inclination", "rotated: 40 rad is 2291.8 degrees", lambda: rail.rotated(40)),
        ("inclination", "rotated:", lambda: rail.rotated("40:1")),
        ("outwards", "rotated: -0.0250 rad inclines the rail away", lambda: wr.rail("60E1").rotated("-1:40")),
        ("radius", "radius: 46 mm is no railway wheel's, 584.2 mm as a diameter in inches, 460.0 mm in cm", lambda: wr.Pair(rail, wheel, 46)),
        ("radius", "radius: 920 mm is no railway wheel's, 460.0 mm as a diameter", lambda: wr.Pair(rail, wheel, 920)),
        ("flange-side", "wheel: the tip of its flange is at x = 5", lambda: wr.Pair(rail, wheel.mirrored(), 460)),
        ("gauge", "gauge: 1524 mm is 164 mm more than back_to_back", lambda: wheelset(gauge=1524.0)),
        ("gauge", "is -65 mm more", lambda: wheelset(back_to_back=1500.0)),
        ("gauge-height", "gauge_height: 0.014 mm", lambda: wheelset(gauge_height=0.014)),
        ("flange-back-x", "the back of wheel is at x = -70.0 mm", lambda: wheelset(flange_back_x=0.0)),
        ("angle", "yaw: 0.2 rad is 11.5 degrees", lambda: track.touch(yaw=0.2)),
        ("angle", "yaw: 0.2 rad", lambda: pair.touch(yaw=0.2)),
        ("angle", "skew: 0.3 rad", lambda: pair.placed(0.0, 0.0, skew=0.3)),
        ("tilt", "the tangents at rail_x and wheel_x differ by", lambda: pair.placed(-25.0, 0.0)),
        ("lifted", "right side: the wheel's tread is", lambda: track.touch(10.0)),
        ("flange-tip", "the wheel stands on the tip of its flange", lambda: pair.touch(60.0)),
        ("rolling-radius", "differs by -19.27 mm from radius", lambda: wr.Pair(rail, wheel.shifted(z=20.0), 460).touch()),
        ("contacts", "doubts at 3 of 4 positions, in the column doubt", lambda: track.sweep([0.0, 10.0, 20.0, 30.0], conicity=False)),
        ("kink", "segments 1 and 2 meet at x = 0.000 mm", lambda: wr.Profile.from_segments(
            [{"line": {"from": [-40, -8], "to": [0, 0]}}, {"line": {"from": [0, 0], "to": [40, -2]}}])),
    ]
    for kind, text, call in cases:
        found = doubts(call)
        assert text in found.get(kind, ""), f"{text}: {found}"
        theirs = re.compile(r"^(wheelset|track|patch|wheel|contact): |\[contact\]|mirror =|--|wheelrail schema")
        assert not any(theirs.search(message) for message in found.values() if kind != "flange-side"), found


def test_doubts_may_be_errors_and_are_pickled(track: wr.Wheelset) -> None:
    contact = track.touch().right[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error", wr.Doubt)
        with pytest.raises(wr.Doubt, match="60 N") as caught:
            contact.patch(load=60)
        assert contact.patch(load=60e3).area > 0.0
    assert isinstance(caught.value, UserWarning) and caught.value.advice == "loads are in N, not in kN"
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_a_scene_is_doubted_as_by_the_command_line() -> None:
    scene = {
        "rail": {"profile": "60E1"}, "wheel": {"profile": "S1002", "radius": 460.0},
        "contact": {"offset": 0.0}, "patch": {"load": 80.0}, "material": {"rail_youngs_modulus": 210.0},
    }
    cases: list[wr.Case] = []
    found = doubts(lambda: cases.append(wr.Case.from_dict(scene)))
    assert found.keys() == {"load", "modulus"}
    assert sorted(found.values()) == sorted(cases[0].warnings)


def test_a_sweep_and_a_table_say_where_the_roll_ends() -> None:
    scene = ROOT / "tests/defects/table-fold-of-roll.toml"
    case = wr.Case(scene)
    calls: list[Callable[[], object]] = [lambda: case.sweep(np.arange(4.6, 4.7, 0.01)), lambda: wr.table(scene, (4.6, 4.7))]
    for call in calls:
        assert re.search(r"the roll jumps by -3\.0\d\d mrad at 4\.6776\d\d mm", doubts(call)["roll"])
    assert "roll" not in doubts(lambda: case.sweep(np.arange(4.6, 4.67, 0.01)))
