# SPDX-License-Identifier: MIT
"""The demo's page, build/demo/index.html: each picture with what it shows and what it cost."""

import dataclasses
import os
import statistics
import sys

from . import documents, render
from .documents import Malformed

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


@dataclasses.dataclass(frozen=True)
class Picture:
    """A picture, as the sample that drew it tells of it."""

    name: str
    what: str
    size: tuple
    frames: int
    ms: float
    passes: int
    primitives: str

    @property
    def passes_text(self):
        return "1 geometry pass" if self.passes == 1 else f"{self.passes} geometry passes"


def _value(document, key):
    if not isinstance(document, dict) or key not in document:
        raise Malformed(f'there is no "{key}"')
    return document[key]


def _primitives(document):
    """What was drawn, in words. isosurface draws triangles or points, and says which; volume
    leaves faces out that cannot be seen; the samples that draw meshes draw all triangles."""
    if "primitive" in document:
        return f"{_value(document, 'primitives'):,} {document['primitive']}"
    if "triangles_drawn" in document:
        return f"{document['triangles_drawn']:,} of {_value(document, 'triangles'):,} faces"
    return f"{_value(document, 'triangles'):,} triangles"


def _picture(document, name, what):
    times = _value(document, "ms")
    if not times:
        raise Malformed('"ms" has no times')
    return Picture(name, what, tuple(_value(document, "size")), len(times),
                   statistics.median(times), _value(document, "passes"), _primitives(document))


def _driver(answer):
    """The driver's name and version, from the lines "name: value" of scripts/run --which."""
    known = dict(line.split(": ", 1) for line in answer.splitlines() if ": " in line)
    for name in ("driver", "version"):
        if name not in known:
            raise Malformed(f'the driver\'s answer has no line "{name}: ..."')
    return f"{known['driver']}, OpenGL {known['version']}"


def _layers(folder):
    """The pictures of single layers, nearest first, that the demo wrote beside its page."""
    layers = os.path.join(folder, "layers")
    if not os.path.isdir(layers):
        return []
    return sorted(name for name in os.listdir(layers)
                  if name.startswith("layer-") and name.endswith(".png"))


def _line(folder, picture):
    """What the terminal shows of a picture."""
    path = os.path.relpath(os.path.join(folder, picture.name + ".png"), ROOT)
    passes = "pass  " if picture.passes == 1 else "passes"
    return f"{path:<38} {picture.ms:9.2f} ms  {picture.passes:2} {passes}  {picture.what}"


def write(folder, driver, descriptions, drawing):
    """Writes the page and prints a line for each picture. `descriptions` are texts NAME=WHAT;
    `drawing` says that there are more pictures to come."""
    pictures = []
    for description in descriptions:
        name, _, what = description.partition("=")
        source = os.path.join(folder, name + ".json")
        try:
            pictures.append(_picture(documents.read(source), name, what))
        except (OSError, Malformed) as error:
            sys.exit(f"{source}: {documents.reason(error)}")
    target = os.path.join(folder, "index.html")
    try:
        text = render.page("demo", driver=_driver(driver), pictures=pictures, drawing=drawing,
                           processors=len(os.sched_getaffinity(0)), layers=_layers(folder))
    except Malformed as error:
        sys.exit(f"{target}: {error}")
    render.write_whole(target, text)
    for picture in pictures:
        print(_line(folder, picture))
