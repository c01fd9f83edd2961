# SPDX-License-Identifier: MIT
"""Reads legacy VTK files. VTK's own reader goes on with uninitialised values where a number cannot be
read ("nan" or a decimal comma, say), and crashes on lists of cells in the wrong byte order."""

import urllib.parse

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_POLYHEDRON,
    vtkCellArray,
    vtkImageData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)

# What each type is in a binary file, but for the order of its bytes. Bits are eight in a byte.
TYPES = {
    b"bit": "u1", b"char": "i1", b"signed_char": "i1", b"unsigned_char": "u1", b"short": "i2",
    b"unsigned_short": "u2", b"int": "i4", b"unsigned_int": "u4", b"long": "i8",
    b"unsigned_long": "u8", b"vtktypeint32": "i4", b"vtktypeint64": "i8", b"vtktypeuint64": "u8",
    b"vtkidtype": "i4", b"float": "f4", b"double": "f8",
}
TEXT_TYPES = (b"string", b"utf8_string", b"variant")
WORDS_AS_NUMBERS = {b"1.#inf": "inf", b"-1.#inf": "-inf"}  # As Windows used to print them.


class BadFile(Exception):
    """What is wrong with a file, in one line."""


def quoted(word):
    return "'" + "".join(chr(c) if 32 <= c < 127 else "?" for c in word[:40]) + "'"


def to_number(word):
    lower = word.lower()
    if b".#" in lower:
        return float(WORDS_AS_NUMBERS.get(lower, "nan"))
    try:
        return float(word)
    except ValueError:
        comma = ": numbers have a point, no comma" if b"," in word else ""
        raise BadFile(f"{quoted(word)} is no number of its type{comma}") from None


class Content:
    """Words, lines and blocks of numbers, from front to back."""

    def __init__(self, data, order):
        self.data = data
        self.order = order  # Of binary numbers: ">" or "<".
        self.at = 0
        self.is_binary = False

    def line(self):
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        taken = self.data[self.at:end]
        self.at = min(end + 1, len(self.data))
        return taken

    def word(self):
        """Empty at the end."""
        at, data = self.at, self.data
        while at < len(data) and data[at:at + 1].isspace():
            at += 1
        end = at
        while end < len(data) and not data[end:end + 1].isspace():
            end += 1
        self.at = end
        return data[at:end]

    def rest_of_line(self):
        end = self.data.find(b"\n", self.at)
        return self.data[self.at:len(self.data) if end < 0 else end].split()

    def next_line_begin(self):
        at = self.at
        self.line()
        words = self.rest_of_line()
        self.at = at
        return words[0].lower() if words else b""

    def count(self, what):
        word = self.word()
        if not word.isdigit():
            raise BadFile(f"the number of {what} is {quoted(word)}" if word else "it ends early")
        return int(word)

    def values(self, count):
        """Single numbers in the header, which are text in any case."""
        return [to_number(self.word() or b"?") for _ in range(count)]

    def numbers(self, kind, count, integers=False):
        kind = kind.lower()
        if kind not in TYPES:
            raise BadFile(f"it has numbers of type {quoted(kind)}" if kind else "it ends early")
        if integers and TYPES[kind][0] == "f":
            raise BadFile(f"it has numbers of type {quoted(kind)}")
        if self.is_binary:
            return self.binary(kind, count)
        if count > len(self.data):
            raise BadFile("it ends early")
        words = self.data[self.at:].split(None, count)
        rest = words.pop() if len(words) > count else b""
        if len(words) < count:
            raise BadFile("it ends early")
        self.at = len(self.data) - len(rest)
        try:
            return np.array(words, dtype=bytes).astype(np.int64 if integers else float)
        except ValueError:
            numbers = np.array([to_number(word) for word in words])
            if integers:
                wrong = next(word for word in words if not word.lstrip(b"-+").isdigit())
                raise BadFile(f"{quoted(wrong)} is no number of its type") from None
            return numbers

    def binary(self, kind, count):
        self.line()  # The block begins after the end of the line that announces it.
        form = np.dtype(self.order + TYPES[kind])
        items = (count + 7) // 8 if kind == b"bit" else count
        size = items * form.itemsize
        if size > len(self.data) - self.at:
            raise BadFile(f"a block of {count} binary numbers is cut off")
        numbers = np.frombuffer(self.data, form, items, self.at)
        self.at += size
        return np.unpackbits(numbers)[:count] if kind == b"bit" else numbers

    def skip_texts(self, kind, count):
        self.line()
        for _ in range(count):
            if self.at >= len(self.data):
                raise BadFile("it ends early")
            if not self.is_binary or kind.lower() == b"variant":
                self.line()
                continue
            # The two highest bits of the first byte say how many bytes have the size.
            bytes_of_size = 1 << (3 - (self.data[self.at] >> 6))
            size = int.from_bytes(self.data[self.at:self.at + bytes_of_size], "big")
            size &= (1 << (8 * bytes_of_size - 2)) - 1
            self.at += bytes_of_size + size
            if self.at > len(self.data):
                raise BadFile("it ends early")


class Reader:
    """The sections of a file, one after the other. Each begins with a keyword."""

    def __init__(self, data, order):
        self.content = Content(data, order)
        self.kind = b""
        self.points = np.zeros((0, 3))
        self.offsets = self.connectivity = self.types = np.zeros(0, int)
        self.header = {}  # dimensions, origin, spacing, x_coordinates...
        self.arrays = {"point": {}, "cell": {}}
        self.where, self.items = None, 0  # The values that follow.

    def read(self):
        content = self.content
        identifier = content.line()
        self.is_version_5 = identifier.split()[-1:] >= [b"5"]
        content.line()  # The title.
        form = content.word()
        content.is_binary = form.lower() == b"binary"
        if form.lower() not in (b"binary", b"ascii"):
            raise BadFile(f"it is {quoted(form)}, not ASCII or BINARY")
        if content.word().lower() != b"dataset":
            raise BadFile("its header names no DATASET")
        self.kind = content.word().lower()
        if self.kind not in BUILDERS:
            raise BadFile(f"its data set is {quoted(self.kind)}: it has no cells with a volume")
        while keyword := content.word().lower():
            self.read_section(keyword)
        return self

    def read_section(self, keyword):
        content = self.content
        if keyword == b"points":
            count = content.count("points")
            self.points = content.numbers(content.word(), 3 * count).reshape(-1, 3)
        elif keyword == b"cells":
            self.read_cells()
        elif keyword == b"cell_types":
            count = content.count("cell types")
            self.types = content.numbers(b"int", count, integers=True)
        elif keyword in (b"dimensions", b"origin", b"spacing", b"aspect_ratio"):
            self.header[keyword] = content.values(3)
        elif keyword in (b"x_coordinates", b"y_coordinates", b"z_coordinates"):
            count = content.count("coordinates")
            self.header[keyword] = content.numbers(content.word(), count)
        elif keyword in (b"point_data", b"cell_data"):
            self.where = keyword[:-5].decode()
            self.items = content.count("values")
        elif keyword == b"field":
            self.read_field()
        elif keyword == b"metadata":
            self.skip_metadata()
        else:
            self.read_attribute(keyword)

    def skip_metadata(self):
        self.content.line()  # It ends with an empty line.
        while self.content.at < len(self.content.data) and self.content.line().strip():
            pass

    def read_cells(self):
        content = self.content
        first, second = content.count("cells"), content.count("numbers in the list of cells")
        if self.is_version_5:
            blocks = []
            for keyword, count in ((b"offsets", first), (b"connectivity", second)):
                found = content.word()
                if found.lower() != keyword:
                    raise BadFile(f"{quoted(found)} stands where {keyword.decode().upper()} should")
                blocks.append(content.numbers(content.word(), count, integers=True))
            self.offsets, self.connectivity = (block.astype(np.int64) for block in blocks)
            return
        # The number of points before the points of each.
        lists = content.numbers(b"int", second, integers=True).astype(np.int64)
        starts, at = [], 0
        while at < len(lists):
            size = int(lists[at])
            if size < 0 or size > len(lists) - at - 1:
                raise BadFile(f"cell {len(starts)} has {size} points, but {len(lists) - at - 1}"
                              " numbers are left")
            starts.append(at)
            at += size + 1
        if len(starts) != first:
            raise BadFile(f"it says {first} cells, but has {len(starts)}")
        is_size = np.zeros(len(lists), bool)
        is_size[starts] = True
        self.connectivity = lists[~is_size]
        self.offsets = np.append(0, np.cumsum(lists[is_size]))

    def read_field(self):
        content = self.content
        content.word()  # The name of them all.
        for _ in range(content.count("arrays")):
            name = content.word()
            if name.lower() == b"metadata":  # Of the array before.
                self.skip_metadata()
                name = content.word()
            components, items = content.count("components"), content.count("values")
            self.read_array(name, content.word(), items, components)

    def read_attribute(self, keyword):
        content = self.content
        fixed = {b"vectors": 3, b"normals": 3, b"tensors": 9, b"tensors6": 6, b"global_ids": 1,
                 b"pedigree_ids": 1}
        name = content.word()
        if keyword == b"scalars":
            kind, components = content.word(), 1
            if content.rest_of_line():
                components = content.count("components")
            if content.next_line_begin() == b"lookup_table":  # Its name may be missing.
                content.word()
                content.word()
            self.read_array(name, kind, self.items, components)
        elif keyword in fixed:
            keep = keyword in (b"vectors", b"normals")
            self.read_array(name, content.word(), self.items, fixed[keyword], keep)
        elif keyword == b"texture_coordinates":
            components = content.count("texture coordinates")
            self.read_array(name, content.word(), self.items, components, False)
        elif keyword in (b"color_scalars", b"lookup_table"):
            count = content.count("colors")
            kind = b"unsigned_char" if content.is_binary else b"float"
            items, components = (count, 4) if keyword == b"lookup_table" else (self.items, count)
            self.read_array(name, kind, items, components, False)
        else:
            raise BadFile(f"{quoted(keyword)} stands where a section should begin")

    def read_array(self, name, kind, items, components, keep=True):
        if kind.lower() in TEXT_TYPES:
            self.content.skip_texts(kind, items * components)
            return
        values = self.content.numbers(kind, items * components)
        if keep and self.where and components:
            decoded = urllib.parse.unquote(name.decode(errors="replace"))
            self.arrays[self.where][decoded] = (
                values if components == 1 else values.reshape(-1, components)
            )

    def absurd(self):
        """Coordinates that nobody measures: one in five are so if the bytes are in wrong order."""
        sizes = abs(self.points.astype(float))
        return (((sizes <= 1e-30) & (sizes != 0)) | ~(sizes < 1e30)).sum()

    def build(self):
        data = BUILDERS[self.kind](self)
        for where, attributes, wanted in (
            ("point", data.GetPointData(), data.GetNumberOfPoints()),
            ("cell", data.GetCellData(), data.GetNumberOfCells()),
        ):
            for name, values in self.arrays[where].items():
                if len(values) != wanted:
                    raise BadFile(f"the field '{name}' has {len(values)} values, but there are"
                                  f" {wanted} {where}s")
                kind = np.uint8 if name == "vtkGhostType" else float
                array = numpy_to_vtk(np.ascontiguousarray(values, dtype=kind), deep=True)
                array.SetName(name)
                attributes.AddArray(array)
        return data

    def dimensions(self):
        sides = [int(side) for side in self.header.get(b"dimensions", [0, 0, 0])]
        if min(sides) < 1:
            raise BadFile("it has no DIMENSIONS")
        return sides

    def vtk_points(self):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(self.points, dtype=float), deep=True))
        return points

    def structured_grid(self):
        sides = self.dimensions()
        if np.prod(sides) != len(self.points):
            raise BadFile(f"it has {len(self.points)} points, but DIMENSIONS of {sides}")
        data = vtkStructuredGrid()
        data.SetDimensions(*sides)
        data.SetPoints(self.vtk_points())
        return data

    def structured_points(self):
        data = vtkImageData()
        data.SetDimensions(*self.dimensions())
        data.SetOrigin(*self.header.get(b"origin", [0, 0, 0]))
        data.SetSpacing(*self.header.get(b"spacing", self.header.get(b"aspect_ratio", [1, 1, 1])))
        return data

    def rectilinear_grid(self):
        data = vtkRectilinearGrid()
        sides = self.dimensions()
        data.SetDimensions(*sides)
        for axis, side, take in zip("xyz", sides, (data.SetXCoordinates, data.SetYCoordinates,
                                                   data.SetZCoordinates)):
            values = self.header.get(f"{axis}_coordinates".encode(), [])
            if len(values) != side:
                raise BadFile(f"it has {len(values)} {axis.upper()}_COORDINATES, but {side} are"
                              " in its DIMENSIONS")
            take(numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True))
        return data

    def unstructured_grid(self):
        offsets, connectivity = self.offsets, self.connectivity
        if len(self.types) != max(len(offsets) - 1, 0):
            raise BadFile(f"there are {max(len(offsets) - 1, 0)} cells, but {len(self.types)} cell"
                          " types")
        if len(offsets) and (offsets[0] != 0 or offsets[-1] != len(connectivity)
                             or (np.diff(offsets) < 0).any()):
            raise BadFile("the offsets of its cells do not ascend from 0 to the end of the list")
        if not ((self.types >= 0) & (self.types < 256)).all():
            raise BadFile("its cell types are no numbers from 0 to 255")
        data = vtkUnstructuredGrid()
        data.SetPoints(self.vtk_points())
        if (self.types == VTK_POLYHEDRON).any():
            self.insert_cells(data)
        else:
            cells = vtkCellArray()
            cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                          numpy_to_vtkIdTypeArray(connectivity, deep=True))
            data.SetCells(numpy_to_vtk(self.types.astype(np.uint8), deep=True), cells)
        return data

    def insert_cells(self, data):
        """One by one: of a polyhedron the list has the faces, each with its number of points."""
        for i, kind in enumerate(self.types):
            numbers = self.connectivity[self.offsets[i]:self.offsets[i + 1]]
            if kind == VTK_POLYHEDRON:
                check_polyhedron(i, numbers, len(self.points))
            ids = vtkIdList()
            for number in numbers:
                ids.InsertNextId(int(number))
            data.InsertNextCell(int(kind), ids)


def check_polyhedron(cell, numbers, points):
    at = 1
    for _ in range(int(numbers[0]) if len(numbers) else -1):
        size = int(numbers[at]) if at < len(numbers) else -1
        face = numbers[at + 1:at + 1 + size]
        if size < 3 or len(face) != size or (face < 0).any() or (face >= points).any():
            at = -1
            break
        at += size + 1
    if at != len(numbers):
        raise BadFile(f"the faces of cell {cell}, a polyhedron, are not right")


BUILDERS = {
    b"unstructured_grid": Reader.unstructured_grid,
    b"structured_grid": Reader.structured_grid,
    b"structured_points": Reader.structured_points,
    b"rectilinear_grid": Reader.rectilinear_grid,
}


def read(path):
    """A VTK data set, and a note for people about what is unusual in the file, or nothing."""
    with open(path, "rb") as file:
        data = file.read().removeprefix(b"\xef\xbb\xbf")

    def attempt(order):
        reader = Reader(data, order)
        try:
            return reader, reader.read().build(), None
        except BadFile as error:
            return reader, None, error

    reader, built, error = attempt(">")
    if reader.content.is_binary and (error or reader.absurd()):
        other, other_built, other_error = attempt("<")
        if not other_error and (error or other.absurd() < reader.absurd()):
            return other_built, "its binary numbers are little-endian, against the format"
    if error:
        raise error
    return built, ""
