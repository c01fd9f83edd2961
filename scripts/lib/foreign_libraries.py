"""foreign_libraries.py FOLDER PROGRAM [NAME...]

Asks the dynamic loader where PROGRAM would find the libraries of the driver, which are NAME... and
lie in FOLDER, and prints a line "NAME is FILE" for each that it would find elsewhere: an RPATH in a
program counts for more than LD_LIBRARY_PATH. The same for libEGL and libGL that are no vendor-neutral
ones, as those are a driver of their own. Of a script the interpreter is asked.

What cannot be asked, as it has no dynamic loader, is not judged. Nothing of PROGRAM is executed."""

import os
import re
import shutil
import struct
import subprocess
import sys

PT_INTERP = 3
NEUTRAL = ("libEGL.so.1", "libGL.so.1", "libGLX.so.0", "libOpenGL.so.0")
DISPATCHER = b"libGLdispatch.so.0"  # What every vendor-neutral library is linked with.


def interpreter(path):
    """The program that a script names in its first line, else None."""
    with open(path, "rb") as file:
        line = file.readline(1024)
    if not line.startswith(b"#!"):
        return None
    words = line[2:].decode(errors="replace").split()
    if words and os.path.basename(words[0]) == "env":
        # env's options and assignments come before the name.
        words = [word for word in words[1:] if not word.startswith("-") and "=" not in word]
    return shutil.which(words[0]) if words else None


def loader(path):
    """The dynamic loader that an ELF file names, else None."""
    with open(path, "rb") as file:
        data = file.read(1 << 16)
    if data[:4] != b"\x7fELF":
        return None
    wide, order = data[4] == 2, "<" if data[5] == 1 else ">"
    start, = struct.unpack_from(order + ("Q" if wide else "I"), data, 32 if wide else 28)
    size, count = struct.unpack_from(order + "HH", data, 54 if wide else 42)
    for header in range(start, start + size * count, size):
        kind, = struct.unpack_from(order + "I", data, header)
        if kind == PT_INTERP:
            offset, = struct.unpack_from(order + ("Q" if wide else "I"), data,
                                         header + (8 if wide else 4))
            return data[offset:data.index(b"\0", offset)].decode()
    return None


def loader_of_program(program):
    """The file that is started in the end, and its dynamic loader or None."""
    path = os.path.realpath(program)
    for _ in range(4):  # The kernel follows no more.
        script = interpreter(path)
        if script is None:
            break
        path = os.path.realpath(script)
    return path, loader(path)


def found(path, linker, names):
    """What the program would be linked with if NAMES were among it: pairs of a name and a file."""
    asked = subprocess.run([linker, "--preload", " ".join(names), "--list", path],
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    files = re.findall(r"^\s*(?:\S+ => )?(/.*) \(0x", asked.stdout.decode(errors="replace"),
                       re.MULTILINE)
    return [(os.path.basename(file), file) for file in files]


def is_neutral(file):
    with open(file, "rb") as library:
        return DISPATCHER in library.read()


def main(folder, program, *names):
    try:
        path, linker = loader_of_program(program)
    except (OSError, ValueError, struct.error):  # It cannot be read, or is cut off.
        return
    if linker is None or not os.access(linker, os.X_OK):
        return
    for name, file in found(path, linker, names + NEUTRAL):
        if name in names and os.path.dirname(file) != folder or (
                name in NEUTRAL and not is_neutral(file)):
            print(f"{name} is {file}")


main(*sys.argv[1:])
