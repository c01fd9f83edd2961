#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes a tetrahedral grid of whatever VTK or meshio reads: the work of scripts/convert-grid.

All cells become tetrahedra of positive orientation, in a legacy VTK file (binary).
"""

import argparse
import contextlib
import io
import itertools
import os
import sys
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    vtkLogger,
    vtkObject,
    vtkOutputWindow,
    vtkPoints,
    vtkStringOutputWindow,
)
from vtkmodules.vtkCommonDataModel import (
    VTK_POLYHEDRON,
    VTK_TETRA,
    vtkCellArray,
    vtkDataSet,
    vtkDataSetAttributes,
    vtkGenericCell,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkCellDataToPointData
from vtkmodules.vtkFiltersGeneral import vtkDataSetTriangleFilter
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

import legacy_vtk
import output_file
import plot3d

# A hexahedron of a structured grid in five tetrahedra, for hexahedra with an even and an odd sum of
# indices: the diagonals of faces that two share are the same. Bit 0 of a corner is its place along
# i, bit 1 along j, bit 2 along k.
FIVE_TETRAHEDRA = (
    np.array([[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 7, 4, 2], [1, 2, 4, 7]]),
    np.array([[1, 0, 5, 3], [2, 3, 6, 0], [4, 5, 0, 6], [7, 6, 3, 5], [0, 3, 6, 5]]),
)
OWN_DATA = ("medit:", "gmsh:", "cell_tags", "point_tags")
HIDDEN_POINT = vtkDataSetAttributes.HIDDENPOINT


class BadGrid(Exception):
    """Why there is no grid, in one line."""


def floats_lose(numbers):
    """Whether rounding the numbers to floats as they are loses more than rounding what is left
    without an offset (as to_floats of samples/lib has it)."""
    numbers = numbers[np.isfinite(numbers)].astype(float)
    if not len(numbers):
        return False
    loss = abs(numbers - numbers.astype(np.float32)).max()
    return loss > (numbers.max() - numbers.min()) * 2.0**-24


def narrowed(values):
    """As floats if these are precise enough, else as doubles."""
    columns = values.reshape(len(values), -1).T
    return values.astype(float if any(map(floats_lose, columns)) else np.float32)


class Grid:
    """Points, tetrahedra, and arrays with one value or vector a point."""

    def __init__(self, points, cells, arrays):
        self.points = points.astype(float)
        self.cells = cells.astype(np.int64)
        self.arrays = arrays
        self.notes = []

    def points_as_read(self):
        """As the samples will have them: floats, of large coordinates without an offset."""
        read = [axis - axis.min() if floats_lose(axis) else axis for axis in self.points.T]
        return np.stack(read, axis=1).astype(np.float32)

    def volumes(self):
        """Those of the cells, negative if inverted; zero if within the rounding of the computation
        (as signed_volume of samples/lib has it)."""
        origin, *others = self.points_as_read().astype(float)[self.cells].transpose(1, 0, 2)
        a, b, c = (other - origin for other in others)
        terms = [a[:, i] * b[:, j] * c[:, k] for i, j, k in itertools.permutations(range(3))]
        signs = [1, -1, -1, 1, 1, -1]
        determinants = sum(sign * term for sign, term in zip(signs, terms))
        rounding = 8 * np.finfo(float).eps / 2 * sum(abs(term) for term in terms)
        return np.where(abs(determinants) <= rounding, 0, determinants / 6)

    def select_points(self, points):
        """Keeps the points of these indices, and renumbers the cells."""
        new_index = np.full(len(self.points), -1)
        new_index[points] = np.arange(len(points))
        self.points = self.points[points]
        self.cells = new_index[self.cells]
        self.arrays = {name: values[points] for name, values in self.arrays.items()}

    def check(self):
        if not len(self.cells):
            raise BadGrid("it has no cells with a volume")
        used = np.zeros(len(self.points), bool)
        used[self.cells] = True
        wrong = used & ~np.isfinite(self.points).all(axis=1)
        if wrong.any():
            raise BadGrid(f"point {first(wrong)} is not finite")
        faults = {}
        for name, values in self.arrays.items():
            finite = np.isfinite(values.reshape(len(values), -1).astype(np.float32)).all(axis=1)
            if (used & ~finite).any():
                place = first(used & ~finite)
                faults[name] = f"the value of '{name}' at point {place} is not finite"
        if faults and len(faults) == len(self.arrays):
            raise BadGrid(next(iter(faults.values())))
        for name, fault in faults.items():
            del self.arrays[name]
            self.notes.append(f"'{name}' is left out, as {fault}")

    def collapse_edges(self):
        """Joins the ends of edges without length, as where a structured grid is folded to a line:
        what was on two sides of a flat cell are neighbors then. The values are averaged."""
        ends = np.concatenate([self.cells[:, [i, j]] for i in range(4) for j in range(i)])
        points = self.points_as_read()
        same = (points[ends[:, 0]] == points[ends[:, 1]]).all(axis=1)
        joined = np.unique(ends[same])
        _, first_of, place = np.unique(
            points[joined], axis=0, return_index=True, return_inverse=True
        )
        place = place.ravel()
        for values in self.arrays.values():
            sums = np.zeros((len(first_of), *values.shape[1:]))
            np.add.at(sums, place, values[joined])
            counts = np.bincount(place).reshape(-1, *[1] * (values.ndim - 1))
            values[joined] = (sums / counts)[place]
        new_index = np.arange(len(self.points))
        new_index[joined] = joined[first_of][place]
        self.cells = new_index[self.cells]
        return len(joined) - len(first_of)

    def orient(self):
        """Turns inverted cells, leaves out those without volume, and the points that no cell has.
        What is left may be read with another offset, so that others are flat."""
        all_turned = all_flat = 0
        while True:
            self.select_points(np.unique(self.cells))
            volumes = self.volumes()
            turned, flat = volumes < 0, volumes == 0
            self.cells[turned] = self.cells[turned][:, [0, 2, 1, 3]]
            self.cells = self.cells[~flat]
            all_turned, all_flat = all_turned + turned.sum(), all_flat + flat.sum()
            if not flat.any():
                return all_turned, all_flat


def first(condition):
    return int(np.argmax(condition))


def as_doubles(arrays):
    return {name: values.astype(float) for name, values in arrays.items()}


def point_arrays(data):
    """The numeric arrays of a VTK data set's points; those of its cells if it has no other."""
    def numeric(attributes):
        found = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
        return [a for a in found if a is not None and a.GetName() != "vtkGhostType"]

    if not numeric(data.GetPointData()) and numeric(data.GetCellData()):
        average = vtkCellDataToPointData()
        average.SetInputData(data)
        average.Update()
        data = average.GetOutput()
    found = numeric(data.GetPointData())
    return as_doubles({a.GetName() or f"array{i}": vtk_to_numpy(a) for i, a in enumerate(found)})


def split_structured(points, shape, shown, arrays):
    """Five tetrahedra for each cell of a structured grid whose points are all shown; in the one of
    the two ways that inverts fewer of them."""
    nx, ny, nz = shape
    if min(shape) < 2:
        raise BadGrid(f"a structured grid of {nx} x {ny} x {nz} points has no volume")
    k, j, i = (axis.ravel() for axis in np.indices((nz - 1, ny - 1, nx - 1)))
    corners = np.stack(
        [i + (c & 1) + nx * (j + (c >> 1 & 1) + ny * (k + (c >> 2))) for c in range(8)], axis=1
    )
    odd = (i + j + k) % 2 == 1
    whole = shown[corners].all(axis=1)
    corners, odd = corners[whole], odd[whole]

    grids = []
    for even_way, odd_way in (FIVE_TETRAHEDRA, FIVE_TETRAHEDRA[::-1]):
        cells = np.where(odd[:, None, None], corners[:, odd_way], corners[:, even_way])
        grid = Grid(points, cells.reshape(-1, 4), arrays)
        # A left-handed grid inverts all alike.
        inverted = (grid.volumes() < 0).sum()
        grids.append((min(inverted, len(grid.cells) - inverted), grid))
    return min(grids, key=lambda pair: pair[0])[1]


def split_structured_vtk(data):
    points = vtk_to_numpy(data.GetPoints().GetData())
    shown = np.ones(len(points), bool)
    if (ghosts := data.GetPointGhostArray()) is not None:
        shown = vtk_to_numpy(ghosts) & HIDDEN_POINT == 0
    dimensions = [0, 0, 0]
    data.GetDimensions(dimensions)  # The form that VTK 9.1 and 9.3 have in common.
    return split_structured(points, dimensions, shown, point_arrays(data))


def check_cells(data):
    """What VTK believes without looking: how many points a cell of each type has, and which."""
    types = vtk_to_numpy(data.GetCellTypesArray())
    offsets = vtk_to_numpy(data.GetCells().GetOffsetsArray())
    points = vtk_to_numpy(data.GetCells().GetConnectivityArray())
    sizes = np.diff(offsets)
    if (sizes < 0).any() or offsets[0] != 0 or offsets[-1] != len(points):
        raise BadGrid("the offsets of its cells do not ascend from 0 to the end of the list")
    beyond = (points < 0) | (points >= data.GetNumberOfPoints())
    if beyond.any():
        place = first(beyond)
        raise BadGrid(f"cell {np.searchsorted(offsets, place, 'right') - 1} has point"
                      f" {points[place]}, but there are {data.GetNumberOfPoints()} points")
    cell = vtkGenericCell()
    for kind in np.unique(types):
        cell.SetCellType(int(kind))
        if cell.GetCellType() != kind:
            raise BadGrid(f"cell {first(types == kind)} has the type {kind}, which VTK has not")
        wanted = cell.GetNumberOfPoints()
        wrong = (types == kind) & (sizes != wanted)
        if wanted and wrong.any():
            raise BadGrid(f"cell {first(wrong)} has {sizes[first(wrong)]} points, but its type"
                          f" {kind} has {wanted}")


def cells_without_dimension(data):
    """A note about the cells that are no solids, which the split leaves out; or nothing."""
    types, counts = np.unique(vtk_to_numpy(data.GetCellTypesArray()), return_counts=True)
    cell, flat = vtkGenericCell(), 0
    for kind, count in zip(types, counts):
        cell.SetCellType(int(kind))
        flat += count if cell.GetCellDimension() < 3 else 0
    return f"{flat:,} cells that are points, lines or faces are left out" if flat else ""


def share_points(data):
    """Lets cells share those points that are in one place and have the same values, as finite
    element codes give each cell its own: only cells that share points are cut alike."""
    types = vtk_to_numpy(data.GetCellTypesArray())
    columns = [vtk_to_numpy(data.GetPoints().GetData())]
    attributes = data.GetPointData()
    columns += [vtk_to_numpy(attributes.GetArray(i)) for i in range(attributes.GetNumberOfArrays())
                if attributes.GetArray(i) is not None]
    rows = np.column_stack([column.astype(float) for column in columns]) + 0.0  # No zero is -0.
    keys = np.ascontiguousarray(rows).view(np.dtype((np.void, rows.shape[1] * 8))).ravel()
    _, first_of, place = np.unique(keys, return_index=True, return_inverse=True)
    if len(first_of) == len(rows) or (types == VTK_POLYHEDRON).any():
        return data
    cells = vtkCellArray()
    old = vtk_to_numpy(data.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(data.GetCells().GetOffsetsArray())
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(first_of[place.ravel()][old].astype(np.int64), deep=True))
    shared = vtkUnstructuredGrid()
    shared.ShallowCopy(data)
    shared.SetCells(numpy_to_vtk(types, deep=True), cells)
    return shared


def split(data):
    note = ""
    if isinstance(data, vtkStructuredGrid) and data.GetPoints():
        return split_structured_vtk(data)
    if isinstance(data, vtkUnstructuredGrid) and data.GetNumberOfCells():
        check_cells(data)
        note = cells_without_dimension(data)
        data = share_points(data)
    triangulate = vtkDataSetTriangleFilter()
    triangulate.TetrahedraOnlyOn()
    arrays = point_arrays(data)
    triangulate.SetInputData(data)
    triangulate.Update()
    result = triangulate.GetOutput()
    if not result.GetNumberOfCells():
        raise BadGrid("it has no cells with a volume")
    cells = vtk_to_numpy(result.GetCells().GetConnectivityArray()).reshape(-1, 4)
    points = vtk_to_numpy(result.GetPoints().GetData())
    if any(len(values) != len(points) for values in arrays.values()):
        arrays = point_arrays(result)
    grid = Grid(points, cells, arrays)
    grid.notes += [note] if note else []
    return grid


def read_plot3d(path, solution, block):
    blocks = plot3d.read_grid(path)
    if blocks is None:
        raise BadGrid("it is no PLOT3D grid with three coordinates, or it is cut off")
    if block is None and len(blocks) > 1:
        raise BadGrid(f"it has {len(blocks)} blocks: choose one by --block")
    if block is not None and block >= len(blocks):
        raise BadGrid(f"it has no block {block}, but {len(blocks)}, the first being 0")
    shape, points, shown = blocks[block or 0]
    arrays = {}
    if solution:
        solutions = plot3d.read_solution(solution, [shape for shape, _, _ in blocks])
        if solutions is None:
            raise BadGrid(f"{solution} is no PLOT3D solution on its points, or it is cut off")
        arrays = solutions[block or 0]
    return split_structured(points, shape, shown, as_doubles(arrays))


@contextlib.contextmanager
def errors_of_vtk():
    """What VTK complains about is an error: it goes on with whatever it has."""
    said, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(said)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkObject.GlobalWarningDisplayOn()
    try:
        yield
    finally:
        vtkObject.GlobalWarningDisplayOff()
        vtkOutputWindow.SetInstance(before)
    if "ERROR" in said.GetOutput():
        # "ERROR: In file, line 1 / vtkThing (0x1234): what is wrong / empty lines"
        message = said.GetOutput().split("ERROR", 1)[1].split("): ", 1)[-1]
        raise BadGrid("VTK says " + " ".join(message.split("\n\n")[0].split()))


def read_vtk(path):
    """A data set, and a note about the file or nothing."""
    with open(path, "rb") as file:
        is_legacy = b"# vtk" in file.read(8)
    if is_legacy:
        data, note = legacy_vtk.read(path)
    else:
        reader = vtkXMLGenericDataObjectReader()
        reader.SetFileName(path)
        with errors_of_vtk():
            reader.Update()
        data, note = reader.GetOutput(), ""
    if not isinstance(data, vtkDataSet) or not data.GetNumberOfPoints():
        raise BadGrid("VTK finds no grid in it")
    return data, note


def read_by_meshio(path):
    import meshio  # Here, as it takes long and most files are not its.

    with tempfile.TemporaryDirectory() as folder:
        said = io.StringIO()
        try:
            # What it prints, and that it ends the program, is no part of its interface.
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                mesh = meshio.read(path)
                # What its formats keep for themselves is no field.
                for data in (mesh.point_data, mesh.cell_data):
                    for name in [n for n in data if n.startswith(OWN_DATA)]:
                        del data[name]
                mesh.point_sets, mesh.cell_sets = {}, {}
                meshio.write(os.path.join(folder, "grid.vtu"), mesh)
        except (Exception, SystemExit) as error:  # Its readers raise whatever meets them.
            reason = (said.getvalue().split() or str(error).split() or [type(error).__name__])
            raise BadGrid("meshio says " + " ".join(reason)) from error
        return read_vtk(os.path.join(folder, "grid.vtu"))[0]


def write(grid, path):
    data = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(narrowed(grid.points)), deep=True))
    data.SetPoints(points)
    cells = vtkCellArray()
    sized = np.column_stack([np.full(len(grid.cells), 4), grid.cells])
    cells.SetCells(len(grid.cells), numpy_to_vtkIdTypeArray(sized.ravel(), deep=True))
    data.SetCells(VTK_TETRA, cells)
    for name, values in grid.arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(narrowed(values)), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    with output_file.written(path) as made:
        writer = vtkUnstructuredGridWriter()
        writer.SetFileTypeToBinary()
        writer.SetHeader("tetrahedral grid")
        writer.SetFileName(made)
        writer.SetInputData(data)
        if not writer.Write() or not os.path.exists(made):
            raise OSError("VTK cannot write it")


VTK_ENDINGS = (".vtk", ".vtu", ".vts", ".vti", ".vtr")
PLOT3D_ENDINGS = (".xyz", ".x", ".g", ".p3d", ".bin", ".xyzb")


def convert(options):
    ending = os.path.splitext(options.input)[1].lower()
    if options.solution or ending in PLOT3D_ENDINGS:
        grid = read_plot3d(options.input, options.solution, options.block)
    elif ending in VTK_ENDINGS:
        data, note = read_vtk(options.input)
        grid = split(data)
        grid.notes += [note] if note else []
    else:
        grid = split(read_by_meshio(options.input))
    count = len(grid.cells)
    grid.check()
    source = ""
    if not grid.arrays:
        source = " (coordinates, as it has no values)"
        grid.arrays = dict(zip("xyz", grid.points.T.copy()))
    joined = grid.collapse_edges()
    turned, left_out = grid.orient()
    grid.check()
    write(grid, options.output)
    print(f"    {len(grid.points):,} points, {len(grid.cells):,} of {count:,} tetrahedra:"
          f" {left_out:,} without volume left out, {turned:,} turned,"
          f" {joined:,} points joined; fields: {', '.join(grid.arrays)}{source}"
          + "".join(f"; {note}" for note in grid.notes),
          file=sys.stderr if output_file.is_standard_output(options.output) else sys.stdout)


def main():
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--solution")
    parser.add_argument("--block", type=int)
    options = parser.parse_args()
    vtkObject.GlobalWarningDisplayOff()
    np.seterr(all="ignore")  # Grid.check finds what comes of it.
    try:
        for path in filter(None, (options.input, options.solution)):
            if not os.path.isfile(path):
                raise BadGrid(f"there is no file {path}")
        convert(options)
    except (BadGrid, legacy_vtk.BadFile) as error:
        print(f"scripts/convert-grid: cannot convert {options.input}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"scripts/convert-grid: cannot write {options.output}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
