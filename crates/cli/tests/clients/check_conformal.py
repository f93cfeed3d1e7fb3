"""The files over the rail's surface, read by the compiled Fortran reader, a reader of CONTACT's grammar, VTK and readers of pictures: FOLDER READ_WRP."""

import csv
import sys
from xml.etree import ElementTree

import numpy as np
import pyvista
import vtk
from contact_deck import read_contact
from folder import Checks, Folder, colours
from vtk.util.numpy_support import vtk_to_numpy
from wrp import read_wrp

folder = Folder(sys.argv[1])
sigma, alpha, t = (np.load(folder / f"{name}.npy") for name in ("sigma", "angle", "normal_gap"))
delta = folder.summary["approach_mm"]
defined = ~np.isnan(t)
filled = np.where(defined, t, 10 * np.nanmax(np.abs(t)))
checks = Checks("npy")
checks("shapes", t.shape == folder.s.shape and sigma.shape == alpha.shape == folder.xi.shape)
checks("sigma and xi ascend", np.all(np.diff(sigma) > 0) and np.all(np.diff(folder.xi) > 0))
# The rail is convex: between two points its angle lies between theirs, also over a joint.
ends = np.stack([alpha[1:], alpha[:-1]])
steepest, flattest = np.abs(ends).max(axis=0), np.where(np.sign(ends).prod(axis=0) < 0, 0, np.abs(ends).min(axis=0))
along, slack = np.diff(folder.xi) / np.diff(sigma), 1e-12
checks("xi changes by sigma times the cosine of an angle between",
       np.all(along >= np.cos(steepest) - slack) and np.all(along <= np.cos(flattest) + slack))

checks.client = "gfortran"
text = open(folder / "conform.wrp", "rb").read()
checks("conform.wrp ASCII, under 80 columns, with its end",
       text.isascii() and max(map(len, text.split(b"\n"))) < 80 and text.endswith(b"\nEND\n"))
read = read_wrp(folder / "conform.wrp", sys.argv[2])
for key, expected in (("xi", sigma), ("eta", folder.eta), ("mask", defined.astype("i4")), ("s", filled)):
    checks.same(f"conform.wrp {key}", read[key], expected)
checks.same("conform.wrp xi of the points", read["station"][:, 0], folder.xi)
checks.same("conform.wrp alpha", read["station"][:, 2], alpha)
checks("conform.wrp approach", read["approach"] == delta, f"{delta:.6g} mm")
normals = np.stack([-np.sin(alpha), np.cos(alpha)], axis=-1)
checks("conform.wrp normals of the rail are at alpha", np.allclose(read["station"][:, 3:], normals, atol=1e-15, rtol=0))
facing = read["wheel"][..., 0] * normals[:, :1] + read["wheel"][..., 2] * normals[:, 1:]
checks("conform.wrp normals of the wheel are unit vectors that face the rail",
       np.allclose(np.linalg.norm(read["wheel"][defined], axis=-1), 1, atol=1e-14, rtol=0) and np.all(facing[defined] < 0))

checks.client = "CONTACT grammar"
deck = read_contact(folder / "contact.inp")
step = [(v[-1] - v[0]) / (len(v) - 1) for v in (folder.eta, sigma)]
checks("contact.inp grid", deck["n"] == t.shape[::-1] and deck["first"] == [folder.eta[0], sigma[0]] and deck["step"] == step)
closed = delta * read["station"][:, 4:5]
checks.same("contact.inp distances, less what the approach closes", deck["h"], np.where(defined, t - closed, filled))
checks("contact.inp has no approach besides", deck["normal"] == 0 and not deck["force"])
checks.same("contact.inp inclinations", deck["inclination"], np.stack([sigma, -alpha], axis=-1))

creepages = folder.summary["creepages"]
checks("contact.inp has slips of its elements exactly where there is a motion", (creepages is not None) == ("extra_slip" in deck))
if creepages:
    # A wheel that only rolls: its velocity at a point of the rail is forward, plus the pitch about the axle.
    speed, r, turn = 1000 * folder.summary["scene"]["motion"]["speed"], folder.summary["rolling_radius_mm"], creepages["pitch_rad_per_s"]
    theta = folder.summary["wheel"]["contact_angle_rad"]
    axle, up = np.array([np.cos(theta), 0, -np.sin(theta)]), np.array([np.sin(theta), 0, np.cos(theta)])
    zeta = read["station"][:, 1]
    points = np.stack(np.broadcast_arrays(folder.xi[:, None], folder.eta, zeta[:, None]), axis=-1)
    velocity = np.array([0, speed, 0]) + np.cross(turn * axle, points - r * up)
    at_c = np.array([0, speed, 0]) + np.cross(turn * axle, -r * up)
    velocity -= np.array([0, 0, at_c[2]])
    tangent = np.stack([np.cos(alpha), 0 * alpha, np.sin(alpha)], axis=-1)
    exact = -np.stack([velocity[..., 1], (velocity * tangent[:, None]).sum(axis=-1)], axis=-1) / creepages["rolling_speed_mm_per_s"]
    ksi, eta, phi = deck["creepages"]
    shift = step[0] / 6
    linear = np.stack(np.broadcast_arrays(ksi - phi * sigma[:, None], eta + phi * (folder.eta + shift)), axis=-1)
    off = np.abs(linear + deck["extra_slip"] - exact).max()
    checks("contact.inp: creepages and extra slips are the slip of a rigid wheel", off < 1e-12, f"{off:.1e}")
    checks("contact.inp: extra slips matter", np.abs(deck["extra_slip"]).max() > 1e-5, f"{np.abs(deck['extra_slip']).max():.1e}")

checks.client = "vtk"
reader = vtk.vtkXMLStructuredGridReader()
reader.SetFileName(str(folder / "conformal.vts"))
reader.Update()
grid = reader.GetOutput()
arrays = {grid.GetPointData().GetArrayName(k): vtk_to_numpy(grid.GetPointData().GetArray(k))
          for k in range(grid.GetPointData().GetNumberOfArrays())}
points = vtk_to_numpy(grid.GetPoints().GetData()).reshape(*t.shape, 3)
checks.same("conformal.vts normal_gap", arrays["normal_gap"].reshape(t.shape), t)
checks.same("conformal.vts angle", arrays["angle"].reshape(t.shape)[:, 0], alpha)
checks.same("conformal.vts points lie at xi", points[:, 0, 0], folder.xi)
checks.same("conformal.vts points lie on the rail", points[:, 0, 2], read["station"][:, 1])
checks.same("conformal.vts wheel_normal", arrays["wheel_normal"].reshape(*t.shape, 3)[defined], read["wheel"][defined])

checks.client = "pictures"
svg = ElementTree.parse(folder / "conformal.svg").getroot()
words = [text.strip() for text in svg.itertext()]
ends = [f"α = {np.degrees(angle):.1f}°".replace("-", "−") for angle in (alpha[0], alpha[-1])]
named = {"t [mm]", "σ [mm]", "α [°]", "boundary t = δ cos α", *ends, folder.summary["title"][:80]}
checks("conformal.svg is XML and names what it shows", svg.tag.endswith("svg") and named <= set(words),
       ", ".join(sorted(named - set(words))) or f"{len(named)} names")
image = pyvista.read(folder / "conformal.png")
shades = colours(image)
checks("conformal.png is a picture", min(image.dimensions[:2]) >= 1000 and shades > 50, f"{image.dimensions}, {shades} colours")

checks.client = "csv"
rows = [tuple(map(float, row.values())) for row in csv.DictReader(open(folder / "interpen_sigma.csv"))]
inside = t < delta * np.cos(alpha)[:, None]
# At a tip rounding decides.
clear = np.abs(t - delta * np.cos(alpha)[:, None]) > 1e-12
# A column of the grid may miss a patch that is narrower than its step.
known = {row[0]: row[2:] for row in rows}
nowhere = (np.inf, -np.inf)
between = np.array([(known.get(s, nowhere)[0] < folder.eta) & (folder.eta < known.get(s, nowhere)[1]) for s in sigma])
agree = np.array_equal(inside[clear], between[clear])
checks("interpen_sigma.csv holds the points with t < delta cos(alpha)", agree, f"{len(rows)} rows")
patch = folder.summary["conformal"]["patch"]
cells = inside.sum() * step[0] * step[1]
checks("the conformal area is that of its cells to a few per cent", abs(cells / patch["area_mm2"] - 1) < 0.05,
       f"{patch['area_mm2']:.6g} mm2, {cells:.6g} by cells")
checks("the normal turns by what alpha says",
       all(np.ptp(alpha[(part["sigma_extent_mm"][0] <= sigma) & (sigma <= part["sigma_extent_mm"][1])])
           <= part["turn_rad"] for part in patch["components"]))
checks.done()
