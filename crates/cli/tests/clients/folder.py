"""What all client checks share: the folder's arrays, one line per check, the exit code."""

import csv
import json
import pathlib
import sys

import numpy as np


class Folder:
    """An output folder of `wheelrail run`, its .npy arrays as the reference for all other files."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.xi, self.eta, self.s = (np.load(self.path / f"{n}.npy") for n in ("xi", "eta", "separation"))
        assert self.s.shape == (len(self.xi), len(self.eta)) and self.s.dtype == np.float64
        self.summary = json.loads((self.path / "summary.json").read_text())

    def __truediv__(self, name):
        return self.path / name

    @property
    def pressure(self):
        """p over the cells, as a run that is asked for it writes it; else None."""
        return np.load(self / "pressure.npy") if self.has("pressure.npy") else None

    def has(self, name):
        return (self.path / name).exists()

    @property
    def steps(self):
        return [(v[-1] - v[0]) / (len(v) - 1) for v in (self.xi, self.eta)]

    @property
    def fill(self):
        return 10 * np.nanmax(np.abs(self.s))

    @property
    def approach(self):
        """δ as said by the text deck, where it stands after the comments, the sizes, first cell and steps."""
        with open(self / "separation.wrp") as file:
            file.readline()
            lines = [file.readline() for _ in range(int(file.readline()) + 4)]
        return float(lines[-1])

    def boundary(self):
        """The loops of boundary.csv as (component, points), each without its repeated first point."""
        loops, points = [], []
        with open(self / "boundary.csv") as file:
            for row in csv.DictReader(file):
                point = (float(row["xi"]), float(row["eta"]))
                if points and point == points[0]:
                    loops.append((int(row["component"]), np.array(points)))
                    points = []
                else:
                    points.append(point)
        assert not points, "the last loop of boundary.csv is not closed"
        return loops


class Checks:
    """Prints one line per check and remembers failures."""

    def __init__(self, client):
        self.client, self.failed = client, 0

    def __call__(self, what, passed, detail=""):
        self.failed += not passed
        print(f"{'ok  ' if passed else 'FAIL'} {self.client}: {what}{f' ({detail})' if detail else ''}", flush=True)

    def same(self, what, found, expected):
        """Equal bit for bit, NaN included."""
        found, expected = np.asarray(found), np.asarray(expected)
        if found.shape != expected.shape:
            return self(what, False, f"shape {found.shape}, expected {expected.shape}")
        if expected.dtype == np.float64:
            if found.dtype != np.float64:
                return self(what, False, f"type {found.dtype}")
            equal = (found == expected) | (np.isnan(found) & np.isnan(expected))
        else:
            equal = found == expected
        return self(what, bool(np.all(equal)), f"{equal.size} values" if np.all(equal) else f"{np.sum(~equal)} differ")

    def near(self, what, found, expected, within):
        """Equal to a relative `within`."""
        off = abs(found / expected - 1)
        self(what, off <= within, f"{found:.7g}, off by {100 * off:.4f} % of {expected:.7g}")

    def done(self):
        sys.exit(1 if self.failed else 0)


def depth(s, approach):
    """Interpenetration, NaN where s is."""
    return np.where(s > approach, 0.0, approach - s)


def colours(image):
    """The number of colours of a picture that VTK has read."""
    channels = np.asarray(image.active_scalars)
    return len(np.unique(channels @ 256 ** np.arange(channels.shape[1])))
