"""Opens the folder it lies in with ParaView: separation coloured, boundary overlaid, gap vectors.

    paraview --script=view.py
    pvbatch view.py picture.png          (without a display: xvfb-run -a pvbatch view.py picture.png)

Contact frame in mm: x = xi (along the common tangent), y = eta (rolling direction), z = zeta (from rail to wheel).
Separation s > 0 apart, s < 0 overlapping; the boundary is s = delta.
"""

import os
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__ if "__file__" in globals() else sys.argv[0]))


def open_file(name):
    return OpenDataFile(os.path.join(here, name))


view = GetActiveViewOrCreate("RenderView")
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
shown.SetScalarBarVisibility(view, True)

boundary = open_file("boundary.vtp")
boundary.UpdatePipeline()
if boundary.GetDataInformation().GetNumberOfPoints() > 0:
    line = Show(boundary, view)
    ColorBy(line, None)
    line.AmbientColor = line.DiffuseColor = [0.8, 0, 0]
    line.LineWidth = 3

# About 400 arrows, true to scale: each ends on the wheel's surface.
arrows = Glyph(Input=grid, GlyphType="Arrow")
arrows.OrientationArray = ["POINTS", "gap_vector"]
arrows.ScaleArray = ["POINTS", "gap_vector"]
arrows.ScaleFactor = 1.0
arrows.GlyphMode = "Uniform Spatial Distribution (Bounds Based)"
arrows.MaximumNumberOfSamplePoints = 400
glyphs = Show(arrows, view)
ColorBy(glyphs, None)
glyphs.AmbientColor = glyphs.DiffuseColor = [0.3, 0.3, 0.3]

# The wheel, seen through, to be switched on by a click.
wheel = open_file("wheel.vts")
surface = Show(wheel, view)
ColorBy(surface, None)
surface.Opacity = 0.3
Hide(wheel, view)

view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-1, -2, 2], [0, 0, 0], [0, 0, 1]
ResetCamera(view)
Render(view)
if len(sys.argv) > 1 and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1600, 1000])
