"""What Python adds to the library: python benches/cost.py [WHEEL], with the release build installed.

Compares a grid and a sweep with the same in Rust (examples/cost.rs), times the import, and weighs the wheel. Fails where
a limit is exceeded.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

import numpy as np

import wheelrail as wr

# A grid may take so many microseconds more, a sweep this share; import in ms, wheel in MB.
LIMITS = {"grid": 10.0, "sweep": 0.05, "import": 5.0, "wheel": 5.5}


def in_rust() -> tuple[float, float]:
    """Return microseconds of the grid and seconds of the sweep."""
    command = ["cargo", "run", "--release", "--quiet", "--package", "wheelrail-python", "--example", "cost"]
    environment = {**os.environ, "PYO3_BUILD_EXTENSION_MODULE": "1"}
    here = Path(__file__).resolve().parent
    output = subprocess.run(command, cwd=here, env=environment, check=True, capture_output=True, text=True).stdout
    times = json.loads(output)
    return times["grid_us"], times["sweep_s"]


def grid(pair: wr.Pair) -> float:
    """Return the microseconds of a grid of 200 x 200 points."""
    contact = pair.placed(0.0, 0.0)
    xi, eta = (half * (np.arange(200) / 99.5 - 1.0) for half in (12.0, 10.0))
    times: list[float] = []
    for _ in range(501):
        start = time.perf_counter()
        contact.separation(xi, eta)
        times.append(1e6 * (time.perf_counter() - start))
    return median(times)


def sweep(pair: wr.Pair) -> float:
    """Return the seconds of a sweep over 10**6 positions."""
    track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
    times: list[float] = []
    for _ in range(3):
        start = time.perf_counter()
        track.sweep(np.linspace(-8.0, 8.0, 1_000_000), conicity=False)
        times.append(time.perf_counter() - start)
    return min(times)


def importing() -> float:
    """Return the milliseconds of `import wheelrail` once NumPy is there."""
    program = "import numpy, time; t = time.perf_counter(); import wheelrail; print(1e3 * (time.perf_counter() - t))"
    run = [float(subprocess.check_output([sys.executable, "-c", program])) for _ in range(5)]
    return median(run)


def main() -> None:
    pair = wr.Pair(wr.rail("60E1").rotated("1:40"), wr.wheel("S1002"), radius=460.0)
    grid_rust, sweep_rust = in_rust()
    grid_here, sweep_here = grid(pair), sweep(pair)
    found = {"grid": grid_here - grid_rust, "sweep": sweep_here / sweep_rust - 1.0, "import": importing()}
    print(f"grid of 200 x 200: {grid_rust:.1f} us in Rust, {grid_here:.1f} us in Python, {found['grid']:+.1f} us")
    print(f"sweep of 10^6 positions: {sweep_rust:.2f} s in Rust, {sweep_here:.2f} s in Python, {found['sweep']:+.1%}")
    print(f"import: {found['import']:.1f} ms after NumPy's")
    if len(sys.argv) > 1:
        found["wheel"] = Path(sys.argv[1]).stat().st_size / 1e6
        print(f"wheel: {found['wheel']:.2f} MB")
    beyond = [name for name, value in found.items() if value > LIMITS[name]]
    sys.exit(f"beyond the limit: {', '.join(beyond)}" if beyond else 0)


if __name__ == "__main__":
    main()
