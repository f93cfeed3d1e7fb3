"""Wrong calls: types, shapes, units, signs, exchanged, empty, NaN, huge. Each ends in an exception with a name, or in a doubt."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import wheelrail as wr

NAN, INF = float("nan"), float("inf")

# Names that every wrong call may use.
RAIL, WHEEL = wr.rail("60E1").rotated("1:40"), wr.wheel("S1002")
PAIR = wr.Pair(RAIL, WHEEL, 460.0)
DISTANCES: dict[str, Any] = {"gauge": 1435.0, "back_to_back": 1360.0, "flange_back_x": -70.0}
TRACK = wr.Wheelset(PAIR, **DISTANCES)
CONTACT = TRACK.touch(3.0).right[0]
PATCH = CONTACT.patch(approach=0.05)
AXIS = np.linspace(-2.0, 2.0, 5)
X, Z = WHEEL.points(0.5).T
ARC: dict[str, Any] = {"center": [0.0, -300.0], "radius": 300.0, "half": "upper", "x": [-30.0, 30.0]}
SCENE: dict[str, Any] = {
    "rail": {"profile": RAIL},
    "wheel": {"profile": WHEEL, "radius": 460.0},
    "track": {"gauge": 1435.0},
    "wheelset": {"back_to_back": 1360.0, "flange_back_x": -70.0},
    "patch": {"approach": 0.05},
}
CASE = wr.Case.from_dict(SCENE)


def scene(table: str, **keys: Any) -> dict[str, Any]:
    """Return the scene with other keys in one table."""
    return {**SCENE, table: {**SCENE.get(table, {}), **keys}}


def calls_of_each(name: str, call: Callable[[Any], object], *values: Any) -> list[tuple[str, Callable[[], object]]]:
    """Return the call with each of the values, with names."""
    return [(f"{name}: {value!r}"[:60], lambda value=value: call(value)) for value in values]  # type: ignore[misc]


any_: Any = wr
CALLS = [
    *calls_of_each("rail", any_.rail, "S1002", "60e1", "", None, 60, b"60E1", ["60E1"]),
    *calls_of_each("wheel", any_.wheel, "60E1", "s1002", "", None, 1.0),
    *calls_of_each("rotated", any_.rail("60E1").rotated, 40, NAN, INF, "1:0", "40", "1:x", "", None, "40:1", "-1:40", [0.025]),
    *calls_of_each("shifted", lambda x: RAIL.shifted(x=x), NAN, INF, "1", None, [1.0]),
    *calls_of_each("points", RAIL.points, 0.0, -1.0, NAN, 1e-9, "0.5", None),
    *calls_of_each("curvature", RAIL.curvature, 0.0, NAN),
    *calls_of_each("read_profile", any_.read_profile, "none.whl", "", None, 3, "none.toml", "."),
    *calls_of_each("from_points x", lambda x: any_.Profile.from_points(x, Z, side="wheel"), X[:-1], [], 3.0, None, "x", X * NAN, X[:, None], X / 1e3, X * 0.0, X[::-1] * 1e9),
    *calls_of_each("from_points side", lambda side: any_.Profile.from_points(X, Z, side=side), "rail", "Wheel", "left", None, 1),
    *calls_of_each("from_points option", lambda options: any_.Profile.from_points(X, Z, side="wheel", **options),
                   {"unit": "furlong"}, {"cutoff_wavelength": -5.0}, {"cutoff_wavelength": NAN}, {"curve": "spline"}, {"cutof": 5.0}, {"format": "csv"},
                   {"columns": [1, 2]}, {"section": 1}, {"along": 1.0}, {"already_inclined": True}, {"gauge_height": 14.0}, {"repair": "sort"}, {"unit": "m"},
                   {"arc_tolerance": 0.01}, {"mirror": "yes"}),
    *calls_of_each("from_segments", any_.Profile.from_segments, [], {}, None, "arc", [1], [{}], [{"arc": {**ARC, "radius": -300.0}}], [{"arc": {**ARC, "radius": NAN}}],
                   [{"arc": {**ARC, "x": [30.0, -30.0]}}], [{"arc": {**ARC, "half": "lower"}}, {"arc": ARC}], [{"arc": {**ARC, "x": [-400.0, 30.0]}}], [{"arc": ARC, "line": {}}],
                   [{"arc": ARC}, {"arc": ARC}], [{"line": {"from": [0, 0]}}], [{"arc": {**ARC, "center": [0.0]}}], [{"arc": {**ARC, "radius": object()}}]),
    *calls_of_each("to_file", any_.wheel("S1002").to_file, "", "w.xyz", "no/such/folder/w.csv", ".", None),
    *calls_of_each("to_text", any_.wheel("S1002").to_text, "", "xyz", None, 1, "CSV"),
    *calls_of_each("Pair radius", lambda radius: any_.Pair(RAIL, WHEEL, radius), 0.0, -460.0, NAN, INF, 1e300, 0.46, 46.0, 920.0, 18.0, "460", None),
    *calls_of_each("Pair roller", lambda roller: any_.Pair(RAIL, WHEEL, 460.0, roller=roller), 0.0, -350.0, NAN, 10.0, 1e300, "350"),
    *calls_of_each("Pair bodies", lambda bodies: any_.Pair(*bodies, 460.0), (WHEEL, RAIL), (WHEEL, WHEEL), (RAIL, RAIL), (RAIL, WHEEL.mirrored()), (RAIL, None), ("60E1", "S1002"), (RAIL,)),
    *calls_of_each("Wheelset", lambda distances: any_.Wheelset(PAIR, **distances), {}, {"gauge": 1435.0}, {"rail_spacing": 1500.0}, {**DISTANCES, "rail_spacing": 1500.0},
                   {**DISTANCES, "wheel_spacing": 1500.0}, {**DISTANCES, "gauge": 1.435}, {**DISTANCES, "gauge": 143.5}, {**DISTANCES, "gauge": 56.5}, {**DISTANCES, "gauge": -1435.0},
                   {**DISTANCES, "gauge": NAN}, {**DISTANCES, "gauge": 1360.0}, {**DISTANCES, "gauge": 1668.0}, {**DISTANCES, "back_to_back": 1500.0}, {**DISTANCES, "back_to_back": 1.36},
                   {**DISTANCES, "back_to_back": INF}, {**DISTANCES, "flange_back_x": 70.0}, {**DISTANCES, "flange_back_x": 0.0}, {**DISTANCES, "flange_back_x": NAN},
                   {**DISTANCES, "flange_back_x": -0.07}, {**DISTANCES, "gauge_height": -14.0}, {**DISTANCES, "gauge_height": 0.014}, {**DISTANCES, "gauge_height": 500.0},
                   {**DISTANCES, "gauge_height": NAN}, {**DISTANCES, "gauge": "1435"}, {**DISTANCES, "left": RAIL}, {"rail_spacing": 1.5, "wheel_spacing": 1500.0},
                   {"rail_spacing": 1500.0, "wheel_spacing": 0.0}, {"gage": 1435.0}),
    *calls_of_each("touch lateral", TRACK.touch, 300.0, -1e9, NAN, INF, 15.0, "3", None, [3.0]),
    *calls_of_each("touch yaw", lambda yaw: TRACK.touch(yaw=yaw), 0.6, 0.2, NAN, "0.1"),
    *calls_of_each("touch roll", lambda roll: TRACK.touch(roll=roll), "solved", "load", NAN, 0.3, 1.0, None, [0.0]),
    *calls_of_each("touch within", lambda within: TRACK.touch(within=within), -1.0, NAN, INF, "0.1"),
    *calls_of_each("pair.touch", PAIR.touch, 300.0, 60.0, NAN, INF, "0"),
    *calls_of_each("pair.touch angle", lambda angle: PAIR.touch(yaw=angle), 0.6, 0.2, NAN),
    *calls_of_each("placed", lambda points: PAIR.placed(*points), (1e3, 0.0), (0.0, 1e3), (NAN, 0.0), (-30.0, 0.0), (0.0,), ("0", 0.0), (0.0, -60.0)),
    *calls_of_each("placed skew", lambda skew: PAIR.placed(0.0, 0.0, skew=skew), NAN, INF, 0.3, "0"),
    *calls_of_each("conicity", TRACK.conicity, 0.0, -3.0, NAN, 1e3, "3", None),
    *calls_of_each("conicity roll", lambda roll: any_.Wheelset.conicity(TRACK, 3.0, roll=roll), 0.0, "load"),
    *calls_of_each("sweep", lambda lateral: TRACK.sweep(lateral, conicity=False), [0.0, NAN], [[0.0, 1.0]], "0", None, [0.0, "x"], [1e9, 0.0, INF], np.zeros((2, 2)), {"a": 1}, np.zeros(20_000_000), [0.0, 30.0]),
    *calls_of_each("sweep option", lambda options: TRACK.sweep([0.0, 1.0], **options), {"yaw": [0.0]}, {"yaw": [0.0, 0.6]}, {"roll": [0.0] * 3}, {"roll": "load"}, {"within": -1.0}, {"load": 60.0},
                   {"load": 0.0}, {"load": -1.0}, {"approach": 5.0}, {"approach": NAN}, {"load": 6e4, "approach": 0.05}, {"modulus": 115.0}, {"modulus": 0.0, "load": 6e4}, {"progress": 3}),
    *calls_of_each("separation xi", lambda xi: CONTACT.separation(xi, AXIS), [], AXIS[::-1], AXIS * NAN, np.zeros(3), 0.0, None, "xi", np.meshgrid(AXIS, AXIS)[0], AXIS[:, None], [1j], [INF], ["a"]),
    *calls_of_each("separation huge", lambda n: CONTACT.separation(np.linspace(-1, 1, n), np.linspace(-1, 1, n)), 200_000),
    *calls_of_each("separation option", lambda options: CONTACT.separation(AXIS, AXIS, **options), {"tolerance": 0.0}, {"tolerance": NAN}, {"tolerance": -1.0}, {"tolerance": "1e-12"}, {"method": "spectrall"},
                   {"method": None}, {"method": 3}, {"method": ""}),
    *calls_of_each("normal_gap", lambda sigma: CONTACT.normal_gap(sigma, AXIS), [], AXIS[::-1], [NAN], np.eye(3), None),
    *calls_of_each("rail_surface", CONTACT.rail_surface, np.eye(3), "sigma", None),
    *calls_of_each("normals", lambda xi: CONTACT.normals(xi, AXIS), [], AXIS[::-1], [NAN], np.eye(3)),
    *calls_of_each("surfaces", lambda xi: CONTACT.surfaces(xi, (-5.0, 5.0)), (5.0, -5.0), (NAN, 1.0), 3.0, (0.0, 1.0, 2.0)),
    *calls_of_each("hertz", lambda options: CONTACT.hertz(**options), {}, {"load": 60.0}, {"load": -6e4}, {"load": NAN}, {"load": "6e4"}, {"approach": 5.0}, {"approach": -0.05},
                   {"load": 6e4, "modulus": 115.0}, {"load": 6e4, "modulus": NAN}, {"load": 6e4, "approach": 0.05}, {"load": INF}),
    *calls_of_each("patch", lambda options: CONTACT.patch(**options), {}, {"load": 60.0}, {"load": 0.0}, {"load": -6e4}, {"load": NAN}, {"load": 1e12}, {"approach": 5.0}, {"approach": 8e-5},
                   {"approach": -0.05}, {"approach": NAN}, {"approach": INF}, {"approach": 1e300}, {"load": 6e4, "modulus": 115.0}, {"load": 6e4, "modulus": -1.0}, {"load": 1, "approach": 1}, {"force": 6e4}),
    *calls_of_each("axes", PATCH.axes, 0.0, -1.0, NAN, 1e-9, "1", (1.0, 2.0, 3.0), (0.1, 0.0)),
    *calls_of_each("mesh", PATCH.mesh, 0.0, -1.0, NAN, 1e-9, "1"),
    *calls_of_each("files", PATCH.files, "vtkk", "", "png", 3, "VTK"),
    *calls_of_each("pressure", lambda options: PATCH.pressure(**options), {"cell": 0.0}, {"cell": -1.0}, {"cell": NAN}, {"cell": 1e-9}, {"cell": "fine"}, {"spacing": 0.0}),
    ("axes of an empty patch", lambda: CONTACT.patch(approach=0.0).axes()),
    ("pressure of an empty patch", lambda: CONTACT.patch(approach=0.0).pressure()),
    ("svg of an empty patch", lambda: CONTACT.patch(approach=0.0).svg()),
    ("files of an empty patch", lambda: CONTACT.patch(approach=0.0).files("gmsh")),
    *calls_of_each("effective_modulus", lambda rail: any_.effective_modulus(rail=rail), (210.0, 0.28), (0.0, 0.28), (2.1e5, 0.6), (NAN, 0.3), (2.1e5,), 2.1e5, (2.1e11, 0.28)),
    *calls_of_each("Case", any_.Case, "none.toml", "", None, {"rail": {}}, 3, "."),
    *calls_of_each("from_toml", any_.Case.from_toml, "", "rail = 3", "[rail", None, "[rail]\nprofile = 60E1", "[rial]"),
    *calls_of_each("from_dict", any_.Case.from_dict, {}, None, [], "scene", 3, {"rail": RAIL}, scene("rail", profile=WHEEL), scene("wheel", profile=RAIL), scene("wheel", radius=NAN),
                   scene("wheel", radius=46.0), scene("wheel", radius="460"), scene("track", gauge=1.435), scene("track", gauge=1360.0), scene("track", gage=1435.0), scene("wheelset", lateral=INF),
                   scene("wheelset", roll="load"), scene("wheelset", roll=True), scene("patch", load=60e3), scene("patch", approach=-1.0), scene("grid", xi=AXIS), scene("grid", xi={"values": AXIS[::-1]}),
                   scene("grid", tolerance=0.0), scene("output", formats=["vtkk"]), scene("rail", rotate=40.0), scene("rail", profile=object()), scene("left", deviation={"roll": 3.0}), scene("roller", radius=-1.0),
                   scene("motion", speed=300.0), scene("material", rail_youngs_modulus=210.0), scene("wheelset", yaw=0.3), scene("rail", profile=None)),
    *calls_of_each("case.files", CASE.files, "vtkk", "png", "", 3),
    *calls_of_each("case.sweep", CASE.sweep, [0.0, NAN], "x", None, [[1.0]]),
    ("contacts off the track", lambda: wr.Case.from_dict(scene("wheelset", lateral=300.0)).contacts),
    ("sweep of a single wheel", lambda: wr.Case.from_dict({**{key: SCENE[key] for key in ("rail", "wheel")}, "contact": {"offset": 0.0}}).sweep([0.0])),
    ("summaries without an approach", lambda: wr.Case.from_dict({key: SCENE[key] for key in ("rail", "wheel", "track", "wheelset")}).summaries()),
    *calls_of_each("lowest", TRACK.sweep([0.0], conicity=False).lowest, "Left", "", None),
    *calls_of_each("column", TRACK.sweep([0.0], conicity=False).__getitem__, "angle", None, 0),
]


def test_there_are_two_hundred_and_more() -> None:
    assert len(CALLS) >= 200


@pytest.mark.parametrize(("name", "call"), CALLS, ids=[name for name, _ in CALLS])
def test_a_wrong_call_ends_in_a_named_exception_or_a_doubt(name: str, call: Callable[[], object]) -> None:
    named = (wr.Error, TypeError, ValueError, KeyError, MemoryError)
    with warnings.catch_warnings():
        warnings.simplefilter("error", wr.Doubt)
        with pytest.raises((*named, wr.Doubt)) as caught:
            call()
    message = str(caught.value)
    assert message and "panic" not in message and "fault of wheelrail" not in message
    if isinstance(caught.value, wr.Error):
        assert caught.value.found and caught.value.expected and caught.value.advice
