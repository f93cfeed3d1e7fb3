"""Scenes as dicts, with profiles in them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, MutableMapping, Sequence
from hashlib import sha256
from os import PathLike, fspath
from pickle import dumps
from typing import Any, cast

import numpy as np

from ._errors import InputError
from ._wheelrail import Case, Contact, Profile


def to_json(value: object, profiles: MutableMapping[str, Profile] | None) -> str:
    """Write values as JSON, a key a line. Profiles get names and go into `profiles`, or without it their segments are written."""
    return json.dumps(_plain(value, (), profiles), indent=1)


def with_profiles(scene: Any, profiles: Mapping[str, Profile]) -> Any:
    """Return a scene with profiles in place of their names."""
    if isinstance(scene, dict):
        table = cast("dict[str, Any]", scene)
        named = {key: profiles.get(value, value) for key, value in table.items() if key == "profile"}
        return {key: named[key] if key in named else with_profiles(value, profiles) for key, value in table.items()}
    if isinstance(scene, list):
        return [with_profiles(value, profiles) for value in cast("list[object]", scene)]
    return scene


def _plain(value: Any, place: tuple[str, ...], profiles: MutableMapping[str, Profile] | None) -> Any:
    """Return dicts, lists, numbers and words alone."""
    if isinstance(value, Profile):
        return _plain({"profile": value}, place, profiles)
    if isinstance(value, Mapping):
        return _table(cast("Mapping[object, Any]", value), place, profiles)
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist(), place, profiles)
    if isinstance(value, PathLike):
        return fspath(cast("PathLike[str]", value))
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [_plain(each, place, profiles) for each in cast("Sequence[object]", value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(": ".join(place), str(value), "a finite number", "correct it")
    if value is None or isinstance(value, str | int | float):
        return value
    found, expected = f"a {type(value).__name__}", "numbers, words, and lists, arrays and dicts of them"
    raise InputError(": ".join(place), found, expected, "convert it")


def _table(table: Mapping[object, Any], place: tuple[str, ...], profiles: MutableMapping[str, Profile] | None) -> dict[str, Any]:
    """Return a dict with names or segments in place of a profile; keys that are None are left out."""
    out: dict[str, Any] = {}
    for key, value in table.items():
        if key == "profile" and isinstance(value, Profile):
            if profiles is None:
                out["segments"] = value.segments()
            else:
                name = f"{value.name} #{sha256(dumps(value)).hexdigest()[:16]}"
                profiles[name], out["profile"] = value, name
        elif value is not None:
            out[str(key)] = _plain(value, (*place, str(key)), profiles)
    return out


def contact_of(case: Case, number: int) -> Contact:
    """Return a case's contact by its number, from 0."""
    return case.contacts[number]


def case_of(scene: dict[str, Any], folder: str, title: str) -> Case:
    """Return the case of a scene."""
    return Case.from_dict(scene, folder=folder, title=title)
