"""Compares what Python computes with the files of the library and of the command line, bit by bit.

same_bits.py SCENE.toml FOLDER, a folder with grid.f64, run/ and sweep.csv
"""

import csv
import sys
from pathlib import Path

import numpy as np

import wheelrail as wr


def main() -> None:
    scene, folder = Path(sys.argv[1]), Path(sys.argv[2])
    case = wr.Case(scene)
    contact = case.contacts[0]
    steps = np.arange(-100, 101)
    grid = contact.separation(12.0 * steps / 100.0, 10.0 * steps / 100.0)
    assert grid.tobytes() == (folder / "grid.f64").read_bytes(), "the library's grid differs"
    xi, eta, written = (np.load(folder / f"run/{name}.npy") for name in ("xi", "eta", "separation"))
    of_run = contact.separation(xi, eta, tolerance=case.scene["grid"]["tolerance"])
    assert of_run.tobytes() == written.tobytes(), "the command line's grid differs"
    compared = grid.size + of_run.size + sweep(case, folder / "sweep.csv")
    print(f"same bits: {compared} numbers")


def sweep(case: wr.Case, file: Path) -> int:
    """Compare a sweep by the wheelset that the scene describes; return how many numbers."""
    with file.open() as lines:
        rows = list(csv.DictReader(lines))
    rail, wheel = case.contacts[0].profiles
    track, wheelset = case.scene["track"], case.scene["wheelset"]
    pair = wr.Pair(rail, wheel, case.scene["wheel"]["radius"])
    system = wr.Wheelset(
        pair,
        gauge=track["gauge"],
        gauge_height=track.get("gauge_height"),
        back_to_back=wheelset["back_to_back"],
        flange_back_x=wheelset["flange_back_x"],
    )
    patch = case.scene["patch"]
    table = system.sweep(
        np.arange(-80, 81) / 10, wheelset["yaw"], wheelset["roll"],
        within=wheelset.get("within", 0.0), load=patch.get("load"), approach=patch.get("approach"),
    )
    assert table.rows == len(rows) > 300
    for name in rows[0]:
        if name in ("side", "contact", "kink", "doubt"):
            assert [str(value) for value in table[name].astype(int if name == "kink" else table[name].dtype)] == [
                row[name] for row in rows
            ], name
            continue
        cells = np.array([float(row[name] or "nan") for row in rows])
        assert cells.tobytes() == np.where(np.isnan(table[name]), np.nan, table[name]).tobytes(), name
    return len(rows) * len(rows[0])


if __name__ == "__main__":
    main()
