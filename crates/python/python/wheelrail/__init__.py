"""Wheel/rail contact geometry: contact points, separation, contact patches and sweeps.

Rail = extruded profile, wheel = revolved profile. Lengths are in mm, angles in rad, forces in N, pressures in N/mm2. x is
lateral, towards the field side of its wheel; y is forward along the rail; z is up. The contact frame has its origin at the
contact point, xi along the common tangent, eta along the rail, zeta along the common normal from rail to wheel.

    >>> import wheelrail as wr
    >>> rail = wr.rail("60E1").rotated("1:40")
    >>> pair = wr.Pair(rail, wr.wheel("S1002"), radius=460.0)
    >>> track = wr.Wheelset(pair, gauge=1435.0, back_to_back=1360.0, flange_back_x=-70.0)
    >>> contact = track.touch(lateral=6.2, yaw=0.01).right[0]
    >>> round(contact.contact_angle, 4)
    0.5125

Errors in the input are `InputError`, bodies that do not lie as the input supposes `GeometryError`, the disk `FileError`,
too much of something `LimitError`; all are `Error`.
"""

from ._errors import Error, FileError, GeometryError, InputError, LimitError
from ._table import Table
from ._wheelrail import (
    Case,
    Component,
    Contact,
    Feasibility,
    Hertz,
    Pair,
    Patch,
    Profile,
    Run,
    Touch,
    Wheelset,
    WheelTouch,
    __version__,
    effective_modulus,
    rail,
    rail_names,
    read_profile,
    run,
    wheel,
    wheel_names,
)

__all__ = [
    "Case",
    "Component",
    "Contact",
    "Error",
    "Feasibility",
    "FileError",
    "GeometryError",
    "Hertz",
    "InputError",
    "LimitError",
    "Pair",
    "Patch",
    "Profile",
    "Run",
    "Table",
    "Touch",
    "WheelTouch",
    "Wheelset",
    "__version__",
    "effective_modulus",
    "rail",
    "rail_names",
    "read_profile",
    "run",
    "wheel",
    "wheel_names",
]
