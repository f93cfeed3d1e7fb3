"""Solves the normal contact problem from our files with Tamaas and ContactMechanics.

    solve.py FOLDER --modulus E* --load N [--within 0.005] [--peak MPa --approach mm]

E* in N/mm². Fails when the two peak pressures or approaches differ by more than `within`, or, with --peak and
--approach, when either differs from those by more than `within`.
"""

import argparse
import sys

import numpy as np
import SurfaceTopography
import tamaas
from ContactMechanics import FreeFFTElasticHalfSpace, Systems
from folder import Checks, Folder


def fast(count):
    """The least number ≥ count whose only prime factors are 2, 3 and 5: others take the transforms up to seven times as long."""
    rest = count
    for factor in (2, 3, 5):
        while rest % factor == 0:
            rest //= factor
    return count if rest == 1 else fast(count + 1)


def traction(gap, steps, modulus, load, within=1e-10):
    """Pressure [MPa] on the cells of a gap [mm] on these steps [mm] under a load [N], and the rigid approach [mm].

    The gap is NaN where a body has no surface. `within` is the solver's tolerance.
    """
    cells, far = tuple(slice(n) for n in gap.shape), 10 * np.nanmax(np.abs(gap))
    gap = np.where(np.isnan(gap), far, gap)
    more = [(0, fast(n) - n) for n in gap.shape]
    padded = np.pad(gap, more, constant_values=far)
    size = [n * d for n, d in zip(padded.shape, steps)]
    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.Model(tamaas.model_type.basic_2d, size, list(padded.shape))
    model.E, model.nu = modulus, 0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tamaas.PolonskyKeerRey(model, np.ascontiguousarray(-padded), within)
    solver.setIntegralOperator("dcfft")
    error = solver.solve(load / np.prod(size))
    assert error < within, error
    pressure = np.array(model.traction)
    # The solver leaves the displacement up to a constant. Where the bodies touch, gap + u is the approach.
    displacement = np.zeros_like(pressure)
    model.operators["dcfft"](pressure, displacement)
    pressure, displacement = pressure[cells], displacement[cells]
    # No solver complains of a patch that the grid cuts, and its pressures are far too high.
    edges = np.concatenate([pressure[[0, -1]].ravel(), pressure[:, [0, -1]].ravel()])
    assert not edges.any(), "the grid cuts the patch"
    touching = pressure > 0.1 * pressure.max()
    return pressure, np.mean((gap + displacement)[touching])


def solved_by_tamaas(s, steps, modulus, load):
    """Peak pressure [MPa] and approach [mm] of a separation [mm] on these steps [mm]."""
    pressure, approach = traction(s, steps, modulus, load)
    return pressure.max(), approach


def tamaas_solution(folder, modulus, load):
    """Peak pressure [MPa] and approach [mm] from separation.npy."""
    return solved_by_tamaas(folder.s, folder.steps, modulus, load)


def contact_mechanics_solution(folder, modulus, load):
    """Peak pressure [MPa] and approach [mm] from separation.nc."""
    topography = SurfaceTopography.read_topography(str(folder / "separation.nc"))
    substrate = FreeFFTElasticHalfSpace(topography.nb_grid_pts, modulus, topography.physical_sizes)
    system = Systems.NonSmoothContactSystem(substrate, topography)
    result = system.minimize_proxy(external_force=load, pentol=1e-8, maxiter=1000)
    assert result.success, result.message
    force = -np.asarray(substrate.force)[tuple(slice(n) for n in topography.nb_grid_pts)]
    cell = np.prod(topography.physical_sizes) / np.prod(topography.nb_grid_pts)
    return np.max(np.abs(force)) / cell, abs(float(system.offset))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    for name in ("--modulus", "--load", "--peak", "--approach"):
        parser.add_argument(name, type=float, required=name in ("--modulus", "--load"))
    parser.add_argument("--within", type=float, default=0.005)
    args = parser.parse_args()
    folder, checks = Folder(args.folder), Checks("solvers")
    solved = {
        "Tamaas": tamaas_solution(folder, args.modulus, args.load),
        "ContactMechanics": contact_mechanics_solution(folder, args.modulus, args.load),
    }
    for k, (what, unit, expected) in enumerate((("peak pressure", "MPa", args.peak), ("approach", "mm", args.approach))):
        values = {name: solution[k] for name, solution in solved.items()}
        text = ", ".join(f"{name} {value:.7g} {unit}" for name, value in values.items())
        a, b = values.values()
        checks(f"{what} agrees", abs(a - b) <= args.within * abs(b), text)
        if expected:
            worst = max(abs(value / expected - 1) for value in values.values())
            checks(f"{what} {expected} {unit}", worst <= args.within, f"off by {100 * worst:.4f} %")
    checks.done()


if __name__ == "__main__":
    sys.exit(main())
