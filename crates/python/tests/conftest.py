"""The wheelset that most tests stand on."""

import os
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn

import pytest

import wheelrail as wr

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def pair() -> wr.Pair:
    return wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)


@pytest.fixture(scope="session")
def track(pair: wr.Pair) -> wr.Wheelset:
    return wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)


@pytest.fixture(scope="session")
def measured() -> wr.Profile:
    return wr.read_profile(ROOT / "examples/profiles/S1002.prw", cutoff_wavelength=5.0)


def need(*modules: str) -> None:
    """Skip a test without these modules, or fail it where every client must run."""
    if missing := [module for module in modules if find_spec(module) is None]:
        absent(f"missing: {missing}")


def absent(what: str) -> NoReturn:
    """Skip a test for want of something, or fail it where every client must run."""
    if os.environ.get("WHEELRAIL_REQUIRE_CLIENTS") == "1":
        pytest.fail(what)
    pytest.skip(what)
