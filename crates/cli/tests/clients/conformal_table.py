"""Solves conforming pairs with Tamaas: conformal_table.py FOLDER E*.

Every subfolder has the gaps t, s and s cos alpha [mm] over a grid of the rail's unrolled surface, and cos alpha of its rows.
Prints its name and, gap by gap, peak pressure [MPa], approach [mm] and area in contact [mm2].
"""

import pathlib
import sys

import numpy as np
from solve import traction

# Share of load and approach to which both are met.
TOLERANCE = 1e-6
# Tolerance of Tamaas in the first and in the last step. Between them it is a hundredth of what the step before has missed.
COARSE, SOLVED = 1e-4, 1e-8
STEPS = 40


def solved(gap, closing, cosine, steps, modulus, load, guess):
    """Pressures act along the normal, whose cosine to the load is given by row; an approach closes `closing` times itself."""
    cell = np.prod(steps)
    approach, total, within = guess, load / cosine.mean(), COARSE
    for _ in range(STEPS):
        pressure, rest = traction(gap - approach * closing[:, None], steps, modulus, total, within)
        carried = (pressure * cosine[:, None]).sum() * cell
        # By how much the bodies would still have to approach: 0 when the closure is all of it.
        rest /= (pressure * closing[:, None]).sum() / pressure.sum()
        miss = max(abs(rest) / approach, abs(carried / load - 1))
        if miss < TOLERANCE and within == SOLVED:
            return pressure.max(), approach, np.count_nonzero(pressure) * cell
        within = float(np.clip(0.01 * miss, SOLVED, COARSE))
        approach, total = approach + rest, total * load / carried
    raise RuntimeError(f"not settled: {rest} mm, {carried} N")


folder, modulus = pathlib.Path(sys.argv[1]), float(sys.argv[2])
for pair in sorted(path for path in folder.iterdir() if path.is_dir()):
    *steps, load, guess = map(float, (pair / "numbers.txt").read_text().split())
    gaps, cosine = np.load(pair / "gaps.npy"), np.load(pair / "cosine.npy")
    numbers = []
    for gap, closing in zip(gaps, (cosine, np.ones_like(cosine), cosine)):
        numbers += solved(gap, closing, cosine, steps, modulus, load, guess)
    print(pair.name, *(repr(float(number)) for number in numbers))
