#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Grids for the tests of scripts/convert-grid, all of them the unit cube with the field f = x + 2 y,
and the measure of what was made of them.

Usage: grids.py make FOLDER
       grids.py measure FILE...
"""

import itertools
import os
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkStructuredGrid
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
from vtkmodules.vtkIOXML import vtkXMLStructuredGridWriter

POINTS = 5  # along each edge


def field(points):
    return points[:, 0] + 2 * points[:, 1]


def cube_points(shape=(POINTS, POINTS, POINTS)):
    """x changes fastest."""
    axes = [np.linspace(0, 1, n) for n in shape]
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def hexahedra():
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    return np.array([
        [(z + c[2]) * POINTS**2 + (y + c[1]) * POINTS + x + c[0] for c in corners]
        for z, y, x in itertools.product(range(POINTS - 1), repeat=3)
    ])


def tetrahedra():
    """Six along the diagonal of each cube, some of them inverted."""
    ways = list(itertools.permutations([1, POINTS, POINTS**2]))
    first = hexahedra()[:, 0]
    return np.concatenate([
        np.stack([first, first + a, first + a + b, first + a + b + c], axis=1) for a, b, c in ways
    ])


def structured(points, shape):
    grid = vtkStructuredGrid()
    grid.SetDimensions(*shape)
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float32), deep=True))
    grid.SetPoints(coordinates)
    values = numpy_to_vtk(field(points).astype(np.float32), deep=True)
    values.SetName("f")
    grid.GetPointData().AddArray(values)
    return grid


def write_plot3d(name, blocks, order=">", marks=False, real="f4", blanks=None, text=False):
    """A grid of blocks (points, shape), and the solution with the field as density."""
    def record(*parts):
        content = b"".join(np.ravel(part).astype(order + kind).tobytes() for part, kind in parts)
        if text:
            return " ".join(str(value) for part, _ in parts for value in np.ravel(part)).encode()
        mark = np.array([len(content)], order + "i4").tobytes() if marks else b""
        return mark + content + mark

    shapes = [shape for _, shape in blocks]
    head = [record(([len(blocks)], "i4"))] if len(blocks) > 1 else []
    head.append(record((shapes, "i4")))
    grid, solution = head.copy(), head.copy()
    for points, _ in blocks:
        grid.append(record((points.T, real), *([] if blanks is None else [(blanks, "i4")])))
        values = np.ones((5, len(points)))
        values[0] = field(points)
        solution += [record(([0.5, 0, 1e6, 1], real)), record((values, real))]
    for ending, records in ((".xyz", grid), (".q", solution)):
        with open(name + ending, "wb") as file:
            file.write((b"\n" if text else b"").join(records))


def write_legacy(name, points, cells, kinds, arrays, order=None):
    """A legacy VTK file by hand, as what reads it has its own idea of what is wrong: arrays are
    (declaration, words or numbers) or lines; binary if an order of bytes is given."""
    def block(values, form):
        if order is None:
            return "\n".join(str(value) for value in values).encode() + b"\n"
        return np.asarray(values).astype(order + form).tobytes() + b"\n"

    sized = [number for cell in cells for number in (len(cell), *cell)]
    parts = [
        b"# vtk DataFile Version 3.0\na title\n" + (b"\nASCII" if order is None else b"BINARY"),
        f"\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} double\n".encode(),
        block(np.ravel(points), "f8"),
        f"CELLS {len(cells)} {len(sized)}\n".encode(), block(sized, "i4"),
        f"CELL_TYPES {len(cells)}\n".encode(), block(np.broadcast_to(kinds, len(cells)), "i4"),
        f"POINT_DATA {len(points)}\n".encode(),
    ]
    for head, values in arrays:
        parts += [head.encode() + b"\n", block(values, "f8")]
    with open(name, "wb") as file:
        file.write(b"".join(parts))


def make_legacy():
    points, cells = cube_points(), hexahedra()
    head = "SCALARS f double 1\nLOOKUP_TABLE default"
    values = [float(value) for value in field(points)]

    def write(name, words):
        write_legacy(name, points, cells, 12, [(head, words)])

    write("legacy-cut.vtk", values[:100])
    write("legacy-nan.vtk", values[:9] + ["nan"] + values[10:])
    write("legacy-comma.vtk", values[:9] + ["1,5"] + values[10:])
    write_legacy("legacy-wrong.vtk", points, np.where(cells == 3, 125, cells), 12, [(head, values)])
    write_legacy("legacy-type.vtk", points, cells, 10, [(head, values)])
    write_legacy("legacy-little.vtk", points, cells, 12, [(head, values)], order="<")
    write_legacy("legacy-big.vtk", points, cells, 12, [(head, values)], order=">")
    write_legacy("legacy-flat.vtk", points, [*cells, [0, 1, 6], [3]], [*[12] * len(cells), 5, 1],
                 [(head, values)])
    # Arrays that are no fields, and one that is no number at a point.
    count = len(points)
    write_legacy("legacy-arrays.vtk", points, cells, 12, [
        (f"FIELD FieldData 3\nlabel 1 {count} string", ["", "a%20b", *["f"] * (count - 2)]),
        (f"mask 1 {count} bit", [1] * count), (f"lost 1 {count} float", ["nan", *values[1:]]),
        (head, values)])
    # Each cell has its own points; one more point is nobody's, far away and without a number.
    own = np.append(points[cells.ravel()], [[1e9, 0, np.nan]], axis=0)
    write_legacy("legacy-own.vtk", own, np.arange(len(own) - 1).reshape(-1, 8), 12,
                 [(head, [*field(own[:-1]), "nan"])])
    # On a map, and with a field that floats are too coarse for.
    write_legacy("legacy-far.vtk", points + FAR, cells, 12,
                 [(head, values), ("SCALARS p double 1\nLOOKUP_TABLE default", pressure(points))])


FAR = np.array([615850, 5846925, 758])


def pressure(points):
    return 101325 + 0.04 * points[:, 0]


def folded_points(shape):
    """A cube whose cells next to the edge x = y = 0 are wedges: there, i = 0 is one line."""
    i, j, z = cube_points(shape).T
    # (i, j) to polar coordinates on the quarter of a square.
    angle = j * np.pi / 2
    reach = 1 / np.maximum(np.cos(angle), np.sin(angle))
    points = np.stack([i * reach * np.cos(angle), i * reach * np.sin(angle), z], axis=1)
    points[i == 0, :2] = 0
    return points.round(12)  # so that what is on a side of the cube is exactly there


def make(folder):
    import meshio  # Here, as it takes long to load.

    os.chdir(folder)
    points = cube_points()
    shape = (POINTS,) * 3

    writer = vtkXMLStructuredGridWriter()
    writer.SetFileName("structured.vts")
    writer.SetInputData(structured(points, shape))
    writer.Write()
    write_plot3d("plot3d", [(points, shape)])
    write_plot3d("little", [(points, shape)], order="<")
    write_plot3d("marks", [(points, shape)], marks=True)
    write_plot3d("double", [(points, shape)], real="f8", marks=True, order="<")
    write_plot3d("text", [(points, shape)], text=True)
    write_plot3d("blanked", [(points, shape)], blanks=np.where(points[:, 0] > 0.8, 0, 1))
    write_plot3d("left", [(points * [-1, 1, 1] + [1, 0, 0], shape)])
    half = points * [0.5, 1, 1]
    write_plot3d("blocks", [(half, shape), (half + [0.5, 0, 0], shape)])
    write_plot3d("folded", [(folded_points((5, 5, 3)), (5, 5, 3))])

    at_points = {"f": field(points)}
    meshio.Mesh(points, [("hexahedron", hexahedra())], at_points).write("hexahedra.vtu")
    meshio.Mesh(points, [("hexahedron", hexahedra())], at_points).write("hexahedra.vtk")
    make_legacy()
    meshio.vtu.write("text.vtu", meshio.Mesh(points, [("hexahedron", hexahedra())], at_points),
                     binary=False)
    with open("text.vtu", encoding="ascii") as file:
        text = file.read()
    with open("beyond.vtu", "w", encoding="ascii") as file:
        file.write(text.replace("\n0\n1\n6\n", "\n0\n999999\n6\n"))
    with open("cut.vtu", "w", encoding="ascii") as file:
        file.write(text[:len(text) // 2])
    triangles = tetrahedra()[:3, :3]
    meshio.Mesh(points, [("triangle", triangles), ("tetra", tetrahedra())], at_points).write(
        "gmsh.msh", file_format="gmsh22"
    )
    meshio.Mesh(points, [("tetra", tetrahedra())]).write("medit.mesh")
    meshio.Mesh(
        points, [("hexahedron", hexahedra())], cell_data={"c": [np.full(len(hexahedra()), 7.0)]}
    ).write("cells.vtu")

    meshio.Mesh(points, [("triangle", triangles)], at_points).write("surface.vtu")
    not_finite = {"f": np.where(np.arange(len(points)) == 9, np.nan, 1.0)}
    meshio.Mesh(points, [("tetra", tetrahedra())], not_finite).write("nan.vtu")
    for name in ("nothing.vtu", "nothing.vtk", "nothing.msh", "nothing.mesh", "nothing.xyz"):
        with open(name, "w", encoding="ascii") as file:
            file.write("this is no grid\n")


def measure(path):
    """Tetrahedra, their volume, the smallest of them, faces inside the cube that two do not share,
    and the largest error of the field."""
    reader = vtkUnstructuredGridReader()
    reader.ReadAllFieldsOn()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    if points.min(axis=0)[0] > 1000:
        points -= FAR
    assert set(vtk_to_numpy(grid.GetCellTypesArray())) == {VTK_TETRA}
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    a, b, c, d = points[cells].transpose(1, 0, 2)
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    faces = np.sort(np.concatenate([np.delete(cells, i, axis=1) for i in range(4)]), axis=1)
    faces, counts = np.unique(faces, axis=0, return_counts=True)
    at = points[faces]
    outer = ((at == at[:, :1]) & ((at == 0) | (at == 1))).all(axis=1).any(axis=1)
    unshared = (counts != np.where(outer, 1, 2)).sum()
    arrays = grid.GetPointData()
    names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
    error = 0.0
    for name in ("f", "Density"):
        if name in names:
            error = np.abs(vtk_to_numpy(arrays.GetArray(name)) - field(points)).max()
    if "p" in names:
        error = max(error, np.abs(vtk_to_numpy(arrays.GetArray("p")) - pressure(points)).max())
    print(f"{os.path.basename(path)}: {len(cells)} tetrahedra, volume {volumes.sum():.6f},"
          f" {'all' if volumes.min() > 0 else 'not all'} positive, {unshared} faces unshared,"
          f" field {'right' if error < 1e-6 else 'wrong'}: {' '.join(names)}")


if __name__ == "__main__":
    for argument in sys.argv[2:]:
        {"make": make, "measure": measure}[sys.argv[1]](argument)
