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

What there is:

    rail, wheel, read_profile, Profile.from_points, Profile.from_segments   profiles
    measure_profile           flange height and thickness, wear against a nominal profile, with intervals
    measure_repeats           what repeated measurements of one profile tell
    average_profiles          a representative profile of many, with its spread
    Pair, Wheelset            bodies placed: touch, placed, sweep, conicity
    conicity                  contact geometry by EN 15302: key figures, functions, map, uncertainty
    Contact                   a place of contact: separation, normals, normal_gap, hertz, surfaces
    Patch, Component, Mesh    the patch: loops, areas, meshes, pressures, files of every format
    Case                      a scene with all it can say, from a file, a dict or TOML: contacts, files, view, sweep, check, run
    Grid                      the separation or the normal gap with its coordinates, for xarray
    Table                     the rows of a sweep, for pandas, polars and Arrow
    table, ContactTable       contact over the lateral displacement as polynomials with a stated error
    fleet                     every wheelset of a fleet on every rail section: a table and pages
    wheelrail.dask            studies past one machine
    wheelrail.tamaas          pressures

Errors in the input are `InputError`, bodies that do not lie as the input supposes `GeometryError`, the disk `FileError`,
too much of something `LimitError`; all are `Error`. What is allowed but seldom meant is warned of as `Doubt`.
"""

from ._errors import Doubt, Error, FileError, GeometryError, InputError, LimitError
from ._table import Table
from ._values import Check, Component, Feasibility, Grid, Hertz, Mesh, Pressure, Run, Touch, WheelTouch
from ._wheelrail import (
    Case,
    Contact,
    ContactTable,
    Pair,
    Patch,
    Profile,
    Wheelset,
    __version__,
    conicity,
    average_profiles,
    effective_modulus,
    fleet,
    march,
    measure_profile,
    measure_repeats,
    rail,
    rail_names,
    read_profile,
    run,
    schema,
    table,
    wheel,
    wheel_names,
)

__all__ = [
    "Case",
    "Check",
    "Component",
    "Contact",
    "ContactTable",
    "Doubt",
    "Error",
    "Feasibility",
    "FileError",
    "GeometryError",
    "Grid",
    "Hertz",
    "InputError",
    "LimitError",
    "Mesh",
    "Pair",
    "Patch",
    "Pressure",
    "Profile",
    "Run",
    "Table",
    "Touch",
    "WheelTouch",
    "Wheelset",
    "__version__",
    "conicity",
    "average_profiles",
    "effective_modulus",
    "fleet",
    "march",
    "measure_profile",
    "measure_repeats",
    "rail",
    "rail_names",
    "read_profile",
    "run",
    "schema",
    "table",
    "wheel",
    "wheel_names",
]
