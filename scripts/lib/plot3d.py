# SPDX-License-Identifier: MIT
"""PLOT3D grids and solutions, in whatever of its forms: ASCII or binary of either byte order, with
or without Fortran's record marks, of one or two words a number, of one block or several, with or
without blanking. (VTK's reader ends the process at files that are none.)

No file tells its form, but the form has to explain every byte of a grid, which one alone does.
"""

import itertools
import math

import numpy as np

INTEGER, REAL = "i", "f"


class Mismatch(Exception):
    """The file has not this form."""


class BinaryForm:
    def __init__(self, content, order, has_marks, precision):
        self.content = content
        self.types = {
            INTEGER: np.dtype(f"{order}i4"),
            REAL: np.dtype(f"{order}f{precision}"),
        }
        self.has_marks = has_marks
        self.at = 0

    def take(self, count, kind):
        size = count * self.types[kind].itemsize
        if size > len(self.content) - self.at:
            raise Mismatch
        taken = np.frombuffer(self.content, self.types[kind], count, self.at)
        self.at += size
        return taken

    def record(self, *parts):
        """The parts, (count, kind) each, of one Fortran record."""
        size = sum(count * self.types[kind].itemsize for count, kind in parts)
        if self.has_marks and self.take(1, INTEGER)[0] != size:
            raise Mismatch
        taken = [self.take(*part) for part in parts]
        if self.has_marks and self.take(1, INTEGER)[0] != size:
            raise Mismatch
        return taken


class TextForm:
    def __init__(self, numbers):
        self.content = numbers
        self.at = 0

    def record(self, *parts):
        taken = []
        for count, kind in parts:
            if count > len(self.content) - self.at:
                raise Mismatch
            part = self.content[self.at : self.at + count]
            self.at += count
            if kind == INTEGER:
                if not (np.isfinite(part) & (part == np.rint(part)) & (abs(part) < 2**31)).all():
                    raise Mismatch
                part = part.astype(np.int64)
            taken.append(part)
        return taken


def forms(content):
    """A file's text or bytes, as each form would read it."""
    if all(byte in b"0123456789+-.eEdDnaNAifIF, \t\r\n" for byte in content[:4096]):
        words = content.translate(bytes.maketrans(b"dD,", b"ee ")).split()
        try:
            yield TextForm(np.array([float(word) for word in words]))
        except ValueError:
            pass
        return
    for order, has_marks, precision in itertools.product("><", (False, True), (4, 8)):
        yield BinaryForm(content, order, has_marks, precision)


def read_shapes(form, has_block_count):
    count = int(form.record((1, INTEGER))[0][0]) if has_block_count else 1
    if not 1 <= count <= 100000:
        raise Mismatch
    shapes = form.record((3 * count, INTEGER))[0].reshape(-1, 3)
    if (shapes < 1).any():
        raise Mismatch
    return [tuple(int(n) for n in shape) for shape in shapes]


def read_grid_blocks(form, has_block_count, is_blanked):
    blocks = []
    for shape in read_shapes(form, has_block_count):
        count = math.prod(shape)
        blanking = [(count, INTEGER)] if is_blanked else []
        coordinates, *blanks = form.record((3 * count, REAL), *blanking)
        shown = blanks[0] != 0 if blanks else np.ones(count, bool)
        blocks.append((shape, coordinates.reshape(3, -1).T, shown))
    return blocks


def read_solution_blocks(form, has_block_count, shapes):
    if read_shapes(form, has_block_count) != shapes:
        raise Mismatch
    blocks = []
    for shape in shapes:
        form.record((4, REAL))  # Mach number, angle of attack, Reynolds number, time
        q = form.record((5 * math.prod(shape), REAL))[0].reshape(5, -1)
        blocks.append({"Density": q[0], "Momentum": q[1:4].T, "StagnationEnergy": q[4]})
    return blocks


def readings(path, reader, *ways):
    """What the reader makes of the file in each form and way that the file can have, and how many
    bytes (or words) are left then."""
    with open(path, "rb") as file:
        content = file.read()
    for way in itertools.product((False, True), *ways):
        for form in forms(content):
            try:
                blocks = reader(form, *way)
            except Mismatch:
                continue
            yield len(form.content) - form.at, blocks


def read_grid(path):
    """Each block's (nx, ny, nz), points (x fastest), and which of them are not blanked; or None."""
    whole = (blocks for left, blocks in readings(path, read_grid_blocks, (False, True)) if not left)
    return next(whole, None)


def read_solution(path, shapes):
    """Each block's arrays by name, for a grid of blocks of these shapes; or None. The shapes tell
    the form, so that bytes may be left at the end: there are files with some."""
    found = list(readings(path, read_solution_blocks, (shapes,)))
    return min(found, key=lambda reading: reading[0])[1] if found else None
