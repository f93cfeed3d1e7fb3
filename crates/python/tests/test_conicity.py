"""Contact geometry by EN 15302."""

import numpy as np
import pytest

import wheelrail as wr


def test_figures_and_functions_agree(track: wr.Wheelset) -> None:
    found = wr.conicity(track, roll="neglect", gauges=[0.0, 2.0])
    functions, figures = found["functions"], found["key_figures"]
    assert set(figures) | set(functions) == set(found["definitions"])
    at = int(np.argmin(np.abs(functions["lateral_mm"] - 3.0)))
    assert functions["conicity"][at] == figures["conicity_3mm"]
    assert figures["conicity_3mm"] == pytest.approx(track.conicity(3.0, roll="neglect"), rel=2e-4)
    assert np.allclose(functions["delta_r_mm"], -functions["delta_r_mm"][::-1], equal_nan=True)
    assert found["map"]["conicity"].shape == (2, found["map"]["amplitude_mm"].size)
    assert found["uncertainty"] is None


def test_noise_has_an_interval(track: wr.Wheelset) -> None:
    noise = {"gauge": 0.5, "radius": 0.1}
    noisy = wr.conicity(track, amplitude=4.0, gauges=[0.0], noise=noise, samples=50)["uncertainty"]
    spread = noisy["spreads"]["conicity_3mm"]
    assert spread["samples"] == 50 and spread["low"] < spread["mean"] < spread["high"]


def test_wheels_that_differ_swing_far_from_the_middle() -> None:
    rail, wheel = wr.rail("60E1").rotated("1:20"), wr.wheel("S1002")
    left = wr.Pair(rail, wheel, radius=459.8)
    unequal = wr.Wheelset(wr.Pair(rail, wheel, radius=460.0), left=left, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
    assert unequal.conicity(8.0, roll="neglect") == pytest.approx(0.65005, rel=2e-4)
    alone = unequal.sweep([-3.0, 3.0], roll="neglect")["conicity"]
    assert alone == pytest.approx(unequal.conicity(3.0, roll="neglect"), rel=2e-4)


def test_flange_tips_are_doubted(pair: wr.Pair) -> None:
    on_tips = wr.Wheelset(pair, gauge=1315.0, back_to_back=1360.0, flange_back_x=-70.0)
    report = wr.conicity(on_tips, roll="neglect", gauges=[0.0])
    swept = on_tips.sweep(report["functions"]["lateral_mm"], roll="neglect", conicity=False)
    assert "flange-tip" in " ".join(report["functions"]["doubt"]) and swept["doubt"].any()
    assert any("in the column doubt; flange-tip at" in finding for finding in report["findings"])


def test_wrong_options_are_refused(track: wr.Wheelset) -> None:
    with pytest.raises(wr.InputError, match="noise"):
        wr.conicity(track, noise={"points": 0.0})
    with pytest.raises(wr.InputError, match="pints"):
        wr.conicity(track, noise={"pints": 1.0})
    with pytest.raises(wr.InputError, match="amplitude"):
        wr.conicity(track, amplitude=-1.0)
    with pytest.raises(TypeError):
        wr.conicity(3.0)  # type: ignore[arg-type]
