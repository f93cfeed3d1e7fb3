"""Shows the folder it lies in with ParaView: rail, wheel seen through, separation, patch and its boundary.

    paraview --script=view.py
    pvbatch view.py picture.png            (without a display: xvfb-run -a pvbatch view.py picture.png)
    pvbatch view.py picture.png arrows     (with arrows from the rail to the wheel)

Contact frame in mm: x = xi (along the common tangent), y = eta (along the rail), z = zeta (from rail to wheel).
Separation s > 0 apart, s < 0 overlapping, before any approach; colours show s from 0 to 3 delta, clipped. Of a run over the
rail's surface they show the normal gap t instead, with the conformal patch t < delta cos(alpha).
"""

import json
import math
import os
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__ if "__file__" in globals() else sys.argv[0]))
with open(os.path.join(here, "summary.json"), encoding="utf-8") as file:
    summary = json.load(file)
picture = next((word for word in sys.argv[1:] if word.endswith(".png")), None)
INK = [0.15, 0.15, 0.15]
# What colours the rail: the gap along its own normal where the run has it, else that along the tangent plane's.
GAPS = {"conformal.vts": "normal_gap", "separation.vts": "separation"}


def loaded(name):
    """Opens a file of the folder; None where it was not written or is empty."""
    path = os.path.join(here, name)
    if not os.path.exists(path):
        return None
    source = OpenDataFile(path)
    return source if points(source) else None


def points(source):
    """Counts the points of a source."""
    source.UpdatePipeline()
    return source.GetDataInformation().GetNumberOfPoints()


def shown(source, colour=None, opacity=1.0):
    """Shows a source in one colour; None without one."""
    if source is None:
        return None
    display = Show(source, view)
    # Not ColorBy: ParaView 5.11 refuses it for a file without arrays.
    display.ColorArrayName = ["POINTS", ""]
    if colour:
        display.AmbientColor = display.DiffuseColor = colour
    display.Opacity = opacity
    return display


def conformal_patch(grid):
    """Cuts the conformal patch out of the rail's surface: its area and its outline; None where it is empty."""
    beyond = Calculator(Input=grid, ResultArrayName="beyond", Function=f"normal_gap - {delta!r} * cos(angle)")
    area = Clip(Input=beyond, ClipType="Scalar", Scalars=["POINTS", "beyond"], Value=0.0, Invert=1)
    line = Contour(Input=beyond, ContourBy=["POINTS", "beyond"], Isosurfaces=[0.0])
    return [source if delta > 0 and points(source) else None for source in (area, line)]


view = GetActiveViewOrCreate("RenderView")
if hasattr(view, "UseColorPaletteForBackground"):
    view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesLabelColor = INK

# Bodies, brought from the axes of the track into the contact frame: the transform's rotation is orthogonal.
place = summary["contact_to_track"]
columns = [[row[k] for row in place[:3]] for k in range(4)]
back = [[*columns[k], -sum(a * b for a, b in zip(columns[k], columns[3]))] for k in range(3)] + [[0, 0, 0, 1]]
for name, colour, opacity in [("rails.vtp", [0.70, 0.73, 0.76], 1.0), ("wheels.vtp", [0.35, 0.50, 0.70], 0.15)]:
    display = shown(loaded(os.path.join(summary["wheelset_files"], name)), colour, opacity)
    if display:
        display.UserTransform = [number for row in back for number in row]

# The gap on the rail, from 0 to 3 delta; without a delta over its whole range.
delta = summary["approach_mm"] or 0.0
conformal = os.path.exists(os.path.join(here, "conformal.vts"))
name = "conformal.vts" if conformal else "separation.vts"
grid, gap = loaded(name), GAPS[name]
surface = shown(grid)
low, high = grid.PointData[gap].GetRange()
end = 3 * delta if delta > 0 else high
ColorBy(surface, ("POINTS", gap))
colours = GetColorTransferFunction(gap)
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(0.0, end if end > 0 else 1.0)
colours.NanOpacity = 0.0
bar = GetScalarBar(colours, view)
letter = "t" if conformal else "s"
bar.Title = f"{letter}, mm, 0 to 3 delta, clipped" if delta > 0 else f"{letter}, mm"
bar.ComponentTitle = ""
bar.TitleColor = bar.LabelColor = INK
bar.TitleFontSize, bar.LabelFontSize = 14, 12
bar.WindowLocation = "Lower Right Corner"
surface.SetScalarBarVisibility(view, True)

# The patch, filled and outlined. What lies on the rail is lifted so that it is seen, by less than a line is wide.
area, line = conformal_patch(grid) if conformal else (loaded("patch.vtu"), loaded("boundary.vtp"))
patch = shown(area, [0.93, 0.45, 0.13], 0.5)
line = shown(line, [0.75, 0.05, 0.05])
if line:
    line.LineWidth = 3
bounds = grid.GetDataInformation().GetBounds()
size = max(bounds[1] - bounds[0], bounds[3] - bounds[2])
for step, display in enumerate((surface, patch, line), start=1):
    if display:
        display.Position = [0, 0, 0.003 * step * size]

found = summary["found"]
words = [summary["title"]]
if found:
    side = "" if found["side"] == "single" else f"{found['side']} side, "
    words.append(f"{side}contact {found['contact']}")
angle = math.degrees(summary["rail"]["contact_angle_rad"])
words.append(f"contact angle {angle:.2f} deg, rolling radius {summary['rolling_radius_mm']:.2f} mm")
words.append(f"delta = {delta:.4g} mm" if delta > 0 else "no approach, no patch")
if summary["normal_load_n"]:
    words[-1] += f", normal force {summary['normal_load_n'] / 1e3:.4g} kN"
overlap, kind = summary["patch"], "patch"
if conformal:
    overlap, kind = summary["conformal"]["patch"], "conformal patch t < delta cos(alpha)"
if overlap and overlap["components"]:
    words.append(f"{kind} {overlap['area_mm2']:.4g} mm2")
elif delta > 0:
    words.append(f"the {kind} is empty")

if "arrows" in sys.argv[1:]:
    # About 400 arrows, stretched by a round factor so that the longest is about a tenth of the grid.
    longest = max(abs(low), abs(high))
    stretch = 10 ** math.floor(math.log10(0.1 * (bounds[3] - bounds[2] or 1) / longest) + 0.5) if longest > 0 else 1
    arrows = Glyph(Input=grid, GlyphType="Arrow")
    arrows.OrientationArray = arrows.ScaleArray = ["POINTS", "gap_vector"]
    arrows.ScaleFactor = stretch
    arrows.GlyphMode = "Uniform Spatial Distribution (Bounds Based)"
    arrows.MaximumNumberOfSamplePoints = 400
    glyphs = Show(arrows, view)
    glyphs.ColorArrayName = ["POINTS", ""]
    glyphs.AmbientColor = glyphs.DiffuseColor = INK
    words.append(f"arrows: gap x {stretch:g}")

note = Show(Text(Text="\n".join(words)), view)
note.Color, note.FontSize = INK, 14
note.WindowLocation, note.Justification = "Upper Left Corner", "Left"

axes = surface.DataAxesGrid
axes.GridAxesVisibility = 1
axes.XTitle, axes.YTitle, axes.ZTitle = "xi, mm", "eta, mm", "zeta, mm"
for name in ("XTitleColor", "YTitleColor", "ZTitleColor", "XLabelColor", "YLabelColor", "ZLabelColor", "GridColor"):
    setattr(axes, name, INK)

# Obliquely from the gauge side, at what the grid covers.
if picture:
    view.ViewSize = [1600, 1000]
# The first rendering would move the camera.
Render(view)
direction = [-0.55, -0.85, 1.1]
view.CameraFocalPoint = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
view.CameraPosition = [c + 2.0 * size * d for c, d in zip(view.CameraFocalPoint, direction)]
view.CameraViewUp = [0, 0, 1]
view.CenterOfRotation = view.CameraFocalPoint
Render(view)
if picture:
    SaveScreenshot(picture, view)
