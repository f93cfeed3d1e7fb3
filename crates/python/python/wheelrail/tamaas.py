"""From a contact to a pressure distribution, with Tamaas (pip install wheelrail[tamaas]).

Tamaas solves the normal contact of elastic half-spaces on the grid of the separation: heights are -s, the modulus is E*.
"""

# tamaas has no types.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._wheelrail import effective_modulus

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._wheelrail import Contact

# Cells without a surface are as far away as this many times the largest separation: solvers err on larger numbers.
_FAR = 10.0

# Share of the load to which Tamaas solves.
_TOLERANCE = 1e-10


@dataclass(frozen=True)
class Problem:
    """A normal contact problem: its grid, its model and its solver."""

    xi: NDArray[np.float64]
    """Cell centres in xi, mm, (n_xi,)."""
    eta: NDArray[np.float64]
    """Cell centres in eta, mm, (n_eta,)."""
    separation: NDArray[np.float64]
    """s at the centres, mm, (n_xi, n_eta)."""
    load: float
    """Normal load, N."""
    model: Any
    """The `tamaas.Model`."""
    solver: Any
    """The `tamaas.PolonskyKeerRey` solver."""

    @property
    def cell(self) -> float:
        """Area of a cell, mm2."""
        return float((self.xi[1] - self.xi[0]) * (self.eta[1] - self.eta[0]))

    def solve(self) -> NDArray[np.float64]:
        """Solve, and return the pressure in N/mm2, (n_xi, n_eta).

        Raises RuntimeError where the solver does not converge, and where the grid cuts the contact: pressures would be far
        too high, and no solver complains.
        """
        error = self.solver.solve(self.load / (self.cell * self.separation.size))
        pressure: NDArray[np.float64] = np.array(self.model.traction)
        if not error < _TOLERANCE:
            raise RuntimeError(f"Tamaas stopped at a residual of {error:g}; expected below {_TOLERANCE:g}")
        if pressure[[0, -1]].any() or pressure[:, [0, -1]].any():
            raise RuntimeError("the grid cuts the contact; give a larger one, `xi` and `eta`")
        return pressure


def problem(
    contact: Contact,
    load: float,
    *,
    modulus: float | None = None,
    spacing: float | tuple[float, float] | None = None,
    xi: ArrayLike | None = None,
    eta: ArrayLike | None = None,
) -> Problem:
    """Make the problem of a contact that carries a vertical load in N alone; its normal force is load/cos(contact_angle).

    `modulus` is E* in N/mm2, steel on steel if None. The grid covers the patch that the load is estimated to cause, with
    cells of `spacing` in mm, by default 16 over its shorter side; or it is that of the evenly spaced `xi` and `eta` in mm.
    """
    import tamaas

    modulus = effective_modulus() if modulus is None else modulus
    if xi is None or eta is None:
        xi, eta = contact.patch(load=load, modulus=modulus).axes(spacing)
    xi, eta = np.asarray(xi, dtype=np.float64), np.asarray(eta, dtype=np.float64)
    separation = contact.separation(xi, eta)
    heights = np.where(np.isnan(separation), -_FAR * np.nanmax(separation), -separation)
    size = [float(len(axis) * (axis[1] - axis[0])) for axis in (xi, eta)]
    model = tamaas.Model(tamaas.model_type.basic_2d, size, list(separation.shape))
    model.E, model.nu = modulus, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tamaas.PolonskyKeerRey(model, np.ascontiguousarray(heights), _TOLERANCE)
    solver.setIntegralOperator("dcfft")
    return Problem(xi, eta, separation, load / np.cos(contact.contact_angle), model, solver)
