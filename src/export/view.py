"""Shows the folder it lies in with ParaView: the rail, the wheel cut open behind the patch, and the gap between them in colours.

    paraview --script=view.py
    pvbatch view.py picture.png            (without a display: xvfb-run -a pvbatch view.py picture.png)
    pvbatch view.py picture.png arrows     (with arrows from the rail to the wheel)

Contact frame in mm: x = xi (along the common tangent), y = eta (along the rail), z = zeta (from rail to wheel).
Separation s > 0 apart, s < 0 overlapping, before any approach; colours show s from 0 to 3 delta, and nothing beyond. Of a run
over the rail's surface they show the normal gap t instead, with the conformal patch t < delta cos(alpha).
"""

import json
import math
import os
import sys
import textwrap

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


def cut(kind, source, origin, normal, **options):
    """Clips or slices a source by a plane."""
    made = kind(Input=source, **options)
    cutter = made.ClipType if kind is Clip else made.SliceType
    cutter.Origin, cutter.Normal = origin, normal
    return made


def body(source, begin, end_at, upwards):
    """The skin of a body between two eta, and its section at the first, from the profile to where the body ends, up or down."""
    across = [[columns[3][k] + eta * columns[1][k] for k in range(3)] for eta in (begin, end_at)]
    behind = cut(Clip, source, across[0], columns[1], ClipType="Plane", Invert=0)
    skin = cut(Clip, behind, across[1], columns[1], ClipType="Plane", Invert=1)
    line = cut(Slice, source, across[0], columns[1], SliceType="Plane")
    thick = LinearExtrusion(Input=line, ScaleFactor=150.0, Vector=[0, 0, upwards])
    line.UpdatePipeline()
    ends = line.GetDataInformation().GetBounds()[4:]
    end = [across[0][0], across[0][1], max(ends) if upwards > 0 else min(ends)]
    section = cut(Clip, thick, end, [0, 0, upwards], ClipType="Plane", Invert=1)
    return [(part, part is skin) for part in (skin, section) if points(part)]


view = GetActiveViewOrCreate("RenderView")
if hasattr(view, "UseColorPaletteForBackground"):
    view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
# Its axes would be called X, Y, Z.
view.OrientationAxesVisibility = 0

# The gap on the rail, from 0 to 3 delta; without a delta over its whole range.
delta = summary["approach_mm"] or 0.0
conformal = os.path.exists(os.path.join(here, "conformal.vts"))
name = "conformal.vts" if conformal else "separation.vts"
grid, gap = loaded(name), GAPS[name]
low, high = grid.PointData[gap].GetRange()
end = 3 * delta if delta > 0 else high
end = end if end > 0 else 1.0
# What is farther apart than the colours say is left as the bare rail.
near = Clip(Input=grid, ClipType="Scalar", Scalars=["POINTS", gap], Value=end, Invert=1)
surface = shown(near)
ColorBy(surface, ("POINTS", gap))
surface.Ambient, surface.Diffuse, surface.Specular = 0.65, 0.45, 0.0
colours = GetColorTransferFunction(gap)
colours.ApplyPreset("Inferno (matplotlib)", True)
colours.InvertTransferFunction()
colours.RescaleTransferFunction(0.0, end)
colours.NanOpacity = 0.0
# Arrows have values beyond the end.
colours.AutomaticRescaleRangeMode = "Never"
bar = GetScalarBar(colours, view)
bar.Title = "normal gap t, mm" if conformal else "separation s, mm"
bar.ComponentTitle = ""
bar.TitleColor = bar.LabelColor = INK
bar.TitleFontSize, bar.LabelFontSize = 18, 16
bar.WindowLocation, bar.ScalarBarLength = "Lower Right Corner", 0.4
bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.3g", "%.3g"
surface.SetScalarBarVisibility(view, True)

# The boundary of the patch. What lies on the rail is lifted so that it is seen, by less than a line is wide.
area, line = conformal_patch(grid) if conformal else (loaded("patch.vtu"), loaded("boundary.vtp"))
outline = shown(line, [1.0, 1.0, 1.0])
if outline:
    outline.LineWidth = 4
bounds = grid.GetDataInformation().GetBounds()
size = max(bounds[1] - bounds[0], bounds[3] - bounds[2])
for step, display in enumerate((surface, outline), start=1):
    if display:
        display.Position = [0, 0, 0.003 * step * size]

# Bodies, brought from the axes of the track into the contact frame: the transform's rotation is orthogonal. The rail ends in front
# of the grid, and the wheel is cut open behind the patch, so that both their sections and the whole patch are seen.
place = summary["contact_to_track"]
columns = [[row[k] for row in place[:3]] for k in range(4)]
back = [[*columns[k], -sum(a * b for a, b in zip(columns[k], columns[3]))] for k in range(3)] + [[0, 0, 0, 1]]
behind = (area or grid).GetDataInformation().GetBounds()[3] + 0.1 * size
SKINS = {"rails.vtp": [0.70, 0.73, 0.76], "wheels.vtp": [0.45, 0.60, 0.80]}
SECTIONS = {"rails.vtp": [0.56, 0.59, 0.62], "wheels.vtp": [0.30, 0.44, 0.63]}
for name, begin, upwards in [("rails.vtp", bounds[2] - 0.3 * size, -1), ("wheels.vtp", behind, 1)]:
    source = loaded(os.path.join(summary["wheelset_files"], name))
    for part, is_skin in body(source, begin, behind + 60.0, upwards) if source else []:
        display = shown(part, (SKINS if is_skin else SECTIONS)[name])
        display.UserTransform = [number for row in back for number in row]
        display.Ambient = 0.25 if is_skin else 0.5

# The axes of the contact frame, at C. That of eta ends before the wheel, where its name is beside it.
lift = 0.012 * size
for name, tip, beside in [
    ("xi", [0.62 * size, 0, lift], [0.08 * size, 0, 0]),
    ("eta", [0, 0.95 * behind, lift], [-0.2 * size, -0.05 * behind, 0.12 * size]),
    ("zeta", [0, 0, 0.62 * size], [0, 0, 0.06 * size]),
]:
    shown(Line(Point1=[0, 0, lift], Point2=tip), INK).LineWidth = 3
    label = Show(Text(Text=name), view)
    label.TextPropMode = "Billboard 3D Text"
    label.BillboardPosition = [a + b for a, b in zip(tip, beside)]
    label.Color, label.FontSize, label.Bold, label.Justification = INK, 20, 1, "Center"

found = summary["found"]
words = textwrap.wrap(summary["title"], 44)
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
    words.append(f"white line: the {kind}, {overlap['area_mm2']:.4g} mm2" + ("" if conformal else ", s < delta"))
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
note.Color, note.FontSize = INK, 18
note.WindowLocation, note.Justification = "Lower Left Corner", "Left"

# Upright, whatever the contact angle: from before the cut and above the rail, a little from the gauge side; as wide as a wheel.
if picture:
    view.ViewSize = [1600, 900]
# The first rendering would move the camera.
Render(view)
up = place[2][:3]
across = [(1.0 if k == 0 else 0.0) - up[0] * up[k] for k in range(3)]
along = [(1.0 if k == 1 else 0.0) - up[1] * up[k] for k in range(3)]
direction = [-0.33 * across[k] - 0.82 * along[k] + 0.44 * up[k] for k in range(3)]
middle = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
view.CameraFocalPoint = [middle[k] + 0.4 * (bounds[2] - middle[1]) * along[k] + 10.0 * up[k] for k in range(3)]
view.CameraPosition = [c + max(7.0 * size, 195.0) * d for c, d in zip(view.CameraFocalPoint, direction)]
view.CameraViewUp = up
view.CenterOfRotation = view.CameraFocalPoint
Render(view)
if picture:
    SaveScreenshot(picture, view)
