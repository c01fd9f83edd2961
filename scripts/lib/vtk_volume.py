# SPDX-License-Identifier: MIT
"""Draws the volume of a scene that the sample `volume` wrote (--json) by one of VTK's mappers, and
times it. Needs an X server; draws on whatever OpenGL driver answers there.

VTK means the same by its opacity: all its mappers for unstructured grids take opacity / unit
distance as the extinction per unit length. Opacity here is the extinction divided by its largest
value, since the projected tetrahedra keep it in eight bits, and the unit distance is the inverse of
that value. scripts/tests/vtk_volume_check.py proves it on one cell."""

import argparse
import json
import sys
import time

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import output_file

# What it is, the mapper, its ray integrator or None for VTK's default
METHODS = {
    "vtk-projected-tetrahedra": (
        "vtkProjectedTetrahedraMapper, sorted by the cells' centers",
        vtk.vtkProjectedTetrahedraMapper, None),
    "vtk-bunyk": (
        "vtkUnstructuredGridVolumeRayCastMapper with Bunyk's function, pre-integration",
        vtk.vtkUnstructuredGridVolumeRayCastMapper, None),
    "vtk-bunyk-partial": (
        "the same, partial pre-integration",
        vtk.vtkUnstructuredGridVolumeRayCastMapper, vtk.vtkUnstructuredGridPartialPreIntegration),
    "vtk-zsweep": (
        "vtkUnstructuredGridVolumeZSweepMapper, pre-integration",
        vtk.vtkUnstructuredGridVolumeZSweepMapper, None),
}


def load_grid(scene):
    """The grid of the scene, fitted to the unit sphere as the sample does it."""
    reader = vtk.vtkUnstructuredGridReader()
    reader.SetFileName(scene["grid"])
    reader.ReadAllScalarsOn()
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        sys.exit(f"{scene['grid']}: VTK finds no cells in it")
    if not grid.GetPointData().HasArray(scene["field"]):
        sys.exit(f"{scene['grid']}: VTK finds no field '{scene['field']}' in it")
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(numpy.float64)
    points = (points - numpy.array(scene["center"])) / scene["radius"]
    fitted = vtk.vtkPoints()
    fitted.SetData(numpy_to_vtk(points.astype(numpy.float32), deep=True))
    grid.SetPoints(fitted)
    grid.GetPointData().SetActiveScalars(scene["field"])
    return grid


def make_property(scene):
    """The transfer function: points of value, r, g, b and extinction, linear in between."""
    largest = max(max(point[4] for point in scene["transfer"]), 1e-30)
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.SetColorSpaceToRGB()
    color.AllowDuplicateScalarsOn()
    opacity.AllowDuplicateScalarsOn()
    for value, red, green, blue, extinction in scene["transfer"]:
        color.AddRGBPoint(value, red, green, blue)
        opacity.AddPoint(value, extinction / largest)
    volume_property = vtk.vtkVolumeProperty()
    volume_property.SetColor(color)
    volume_property.SetScalarOpacity(opacity)
    volume_property.SetScalarOpacityUnitDistance(1.0 / largest)
    volume_property.SetInterpolationTypeToLinear()
    volume_property.ShadeOff()
    return volume_property


def place_camera(camera, scene):
    """OrbitCamera of samples/lib/scene/camera.cpp."""
    view = scene["camera"]
    azimuth, elevation = numpy.radians(view["azimuth"]), numpy.radians(view["elevation"])
    toward = numpy.array([numpy.cos(elevation) * numpy.sin(azimuth), numpy.sin(elevation),
                          numpy.cos(elevation) * numpy.cos(azimuth)])
    up = numpy.array([-numpy.sin(elevation) * numpy.sin(azimuth), numpy.cos(elevation),
                      -numpy.sin(elevation) * numpy.cos(azimuth)])
    distance = view["distance"]
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*(distance * toward))
    camera.SetViewUp(*up)
    camera.SetUseHorizontalViewAngle(scene["size"][0] < scene["size"][1])
    camera.SetViewAngle(view["field_of_view"])
    camera.SetClippingRange(max(distance - 1.01, 0.01), distance + 1.01)


class Picture:
    """A window without a screen's place in which one volume is drawn."""

    def __init__(self, scene, method):
        _, make_mapper, make_integrator = METHODS[method]
        self.scene = scene
        mapper = make_mapper()
        mapper.SetInputData(load_grid(scene))
        if not isinstance(mapper, vtk.vtkProjectedTetrahedraMapper):
            # Else the ray casters draw fewer rays when they are slow.
            mapper.AutoAdjustSampleDistancesOff()
            mapper.SetImageSampleDistance(1)
        if make_integrator:
            mapper.SetRayIntegrator(make_integrator())
        volume = vtk.vtkVolume()
        volume.SetMapper(mapper)
        volume.SetProperty(make_property(scene))
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(*scene["background"])
        self.renderer.SetBackgroundAlpha(0)
        self.renderer.AddVolume(volume)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetAlphaBitPlanes(1)
        self.window.SetSize(*scene["size"])
        self.window.AddRenderer(self.renderer)
        place_camera(self.renderer.GetActiveCamera(), scene)
        if isinstance(mapper, vtk.vtkUnstructuredGridVolumeRayCastMapper):
            # Its rays go through the lower left corners of pixels: through their centers then.
            width, height = scene["size"]
            self.renderer.GetActiveCamera().SetWindowCenter(1 / width, 1 / height)

        if isinstance(mapper, vtk.vtkProjectedTetrahedraMapper):
            self.window.Render()  # VTK 9.1 draws no tetrahedra in the first frame.

    def draw(self):
        """One frame; its milliseconds."""
        start = time.perf_counter()
        self.window.Render()
        self.window.WaitForCompletion()
        return (time.perf_counter() - start) * 1000

    def pixels(self):
        """Floats: height, width, RGBA, the lowest row first. VTK keeps eight bits of each."""
        width, height = self.scene["size"]
        data = vtk.vtkFloatArray()
        self.window.GetRGBAPixelData(0, 0, width - 1, height - 1, 0, data)
        return vtk_to_numpy(data).reshape(height, width, 4)

    def driver(self):
        lines = self.window.ReportCapabilities().splitlines()
        return ", ".join(line.split(":", 1)[1].strip() for line in lines
                         if line.startswith(("OpenGL renderer string", "OpenGL version string")))


def write_pfm(path, pixels):
    """The color channels, as samples/lib/io/image_file.cpp writes them."""
    height, width, _ = pixels.shape
    with output_file.written(path) as made, open(made, "wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode())
        file.write(numpy.ascontiguousarray(pixels[:, :, :3], dtype="<f4").tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", help="what `volume --json` wrote")
    parser.add_argument("method", choices=METHODS)
    parser.add_argument("--frames", type=int, default=5, help="timed, after one that is not (5)")
    parser.add_argument("--seconds", type=float, default=20,
                        help="where the first frame takes longer, it is the only one (20)")
    parser.add_argument("--out", help="the picture, a portable float map")
    options = parser.parse_args()
    with open(options.scene, encoding="utf-8") as file:
        scene = json.load(file)

    picture = Picture(scene, options.method)
    first = picture.draw()
    if options.out:
        write_pfm(options.out, picture.pixels())
    frames = [first] if first > options.seconds * 1000 else []
    while len(frames) < options.frames and first <= options.seconds * 1000:
        # A view that changes a little, lest anything be kept from the frame before.
        picture.renderer.GetActiveCamera().Azimuth(0.01)
        frames.append(picture.draw())
    print(json.dumps({
        "method": options.method, "what": METHODS[options.method][0],
        "version": vtk.vtkVersion.GetVTKVersion(), "driver": picture.driver(),
        "ms": frames}))


if __name__ == "__main__":
    main()
