"""The compiled Fortran reader's view of separation.wrp, conform.wrp and countact.wrp."""

import subprocess
import tempfile

import numpy as np


def read_wrp(path, reader):
    """Runs the reader and returns what it has read."""
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run([reader, path, out.name], check=True)
        data = out.read()
    at = 0

    def take(count, kind):
        nonlocal at
        values = np.frombuffer(data, kind, count, at)
        at += values.nbytes
        return values

    n_xi, n_eta, n_points, n_cells = take(4, "<i4")
    read = {"approach": take(1, "<f8")[0], "frame": take(12, "<f8").reshape(4, 3)}
    read |= {"xi": take(n_xi, "<f8"), "eta": take(n_eta, "<f8")}
    read["mask"] = take(n_xi * n_eta, "<i4").reshape(n_xi, n_eta)
    read["s"] = take(n_xi * n_eta, "<f8").reshape(n_xi, n_eta)
    if path.name == "conform.wrp":
        magic = open(path, "rb").read(8)
    if path.name == "conform.wrp" and magic == b"CONFCURV":
        read["station"] = take(5 * n_xi, "<f8").reshape(n_xi, 5)
        read["wheel"] = take(3 * n_xi * n_eta, "<f8").reshape(n_xi, n_eta, 3)
    elif path.name == "conform.wrp":
        read["normal"] = take(2 * n_xi * n_eta, "<f8").reshape(n_xi, n_eta, 2)
    read["points"] = take(3 * n_points, "<f8").reshape(-1, 3)
    read["cells"] = take(5 * n_cells, "<i4").reshape(-1, 5)
    read["area"] = take(n_cells, "<f8")
    assert at == len(data)
    return read
