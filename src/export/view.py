"""Opens the folder it lies in with ParaView: separation coloured, boundary overlaid, gap vectors.

    paraview --script=view.py
    pvbatch view.py picture.png          (without a display: xvfb-run -a pvbatch view.py picture.png)

Contact frame in mm: x = xi (along the common tangent), y = eta (rolling direction), z = zeta (from rail to wheel).
Separation s > 0 apart, s < 0 overlapping; the boundary is s = delta.
"""

import math
import os
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__ if "__file__" in globals() else sys.argv[0]))


def open_file(name):
    return OpenDataFile(os.path.join(here, name))


view = GetActiveViewOrCreate("RenderView")
if hasattr(view, "UseColorPaletteForBackground"):
    view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesLabelColor = [0, 0, 0]

grid = open_file("separation.vts")
shown = Show(grid, view)
ColorBy(shown, ("POINTS", "separation"))
shown.RescaleTransferFunctionToDataRange(True)
colours = GetColorTransferFunction("separation")
colours.ApplyPreset("Viridis (matplotlib)", True)
bar = GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "separation s [mm]", ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.TitleFontSize = bar.LabelFontSize = 14
bar.WindowLocation = "Lower Right Corner"
shown.SetScalarBarVisibility(view, True)

boundary = open_file("boundary.vtp")
boundary.UpdatePipeline()
if boundary.GetDataInformation().GetNumberOfPoints() > 0:
    line = Show(boundary, view)
    ColorBy(line, None)
    line.AmbientColor = line.DiffuseColor = [0.8, 0, 0]
    line.LineWidth = 3

# About 400 arrows from the rail towards the wheel, stretched by a round factor so that the longest is
# about a tenth of the grid.
grid.UpdatePipeline()
bounds = grid.GetDataInformation().GetBounds()
low, high = grid.PointData["separation"].GetRange()
longest = max(abs(low), abs(high))
stretch = 1
if 0 < longest < float("inf"):
    stretch = 10 ** math.floor(math.log10(0.1 * (bounds[3] - bounds[2] or 1) / longest) + 0.5)
arrows = Glyph(Input=grid, GlyphType="Arrow")
arrows.OrientationArray = ["POINTS", "gap_vector"]
arrows.ScaleArray = ["POINTS", "gap_vector"]
arrows.ScaleFactor = stretch
arrows.GlyphMode = "Uniform Spatial Distribution (Bounds Based)"
arrows.MaximumNumberOfSamplePoints = 400
glyphs = Show(arrows, view)
ColorBy(glyphs, None)
glyphs.AmbientColor = glyphs.DiffuseColor = [0.3, 0.3, 0.3]
note = Show(Text(Text=f"mm; red: boundary s = delta; arrows: gap x {stretch:g}"), view)
note.Color, note.FontSize = [0, 0, 0], 14

# The wheel, seen through, to be switched on by a click.
wheel = open_file("wheel.vts")
surface = Show(wheel, view)
ColorBy(surface, None)
surface.Opacity = 0.3
Hide(wheel, view)

picture = sys.argv[-1] if sys.argv[-1].endswith(".png") else None
if picture:
    view.ViewSize = [1600, 1000]
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-1, -2, 1.6], [0, 0, 0], [0, 0, 1]
ResetCamera(view)
Render(view)
if picture:
    SaveScreenshot(picture, view)
