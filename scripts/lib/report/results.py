# SPDX-License-Identifier: MIT
"""Reads the study's results.json, and says what is wrong with one that is not right."""

import dataclasses
import math

from . import documents
from .documents import Malformed

BASE = "zbuffer"
# Forms whose result GL does not define, whatever a driver makes of them.
UNDEFINED = {"unlocked"}


@dataclasses.dataclass(frozen=True)
class Row:
    scene: str
    method: str
    variant: str
    driver: str
    k: int
    passes: int
    triangles: int
    fragments: int
    bytes_per_pixel: int
    ms_median: float
    ms_p5: float
    ms_p95: float
    ratio_median: float
    ratio_p5: float
    ratio_p95: float
    err_max: float
    err_rmse: float
    err_share: float
    err_all_max: float
    err_all_rmse: float
    err_all_share: float

    @property
    def series(self):
        """What the points of one line have in common."""
        return (self.method, self.variant)

    @property
    def exact(self):
        return self.k > 0 and self.err_share == 0 and self.variant not in UNDEFINED


@dataclasses.dataclass(frozen=True)
class Study:
    machine: dict
    rows: list

    @property
    def scenes(self):
        return list(dict.fromkeys(row.scene for row in self.rows))

    def of(self, scene):
        return [row for row in self.rows if row.scene == scene]

    def about(self, scene):
        """What is known of a scene besides its rows."""
        return self.machine.get("scenes", {}).get(scene, {})

    def find(self, scene, method, k, variant=""):
        for row in self.of(scene):
            if (row.method, row.variant, row.k) == (method, variant, k):
                return row
        return None


def _value(row, field, where):
    if field.name not in row:
        raise Malformed(f"{where} has no {field.name}")
    value = row[field.name]
    if field.type is str:
        if not isinstance(value, str):
            raise Malformed(f"{where}: {field.name} is no text")
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise Malformed(f"{where}: {field.name} is no number")
    if field.type is int and value != int(value):
        raise Malformed(f"{where}: {field.name} is no whole number")
    if value < 0 or (value == 0 and field.name.startswith(("ms_", "ratio_"))):
        raise Malformed(f"{where}: {field.name} is {value}")
    return field.type(value)


def _row(row, where):
    if not isinstance(row, dict):
        raise Malformed(f"{where} is no object")
    return Row(**{field.name: _value(row, field, where) for field in dataclasses.fields(Row)})


def load(path):
    """The study in the file. Raises Malformed, or OSError when it cannot be read."""
    document = documents.read(path)
    if not isinstance(document, dict) or not isinstance(document.get("machine"), dict):
        raise Malformed('there is no object "machine"')
    if not isinstance(document.get("results"), list) or not document["results"]:
        raise Malformed('there are no rows in "results"')
    rows = [_row(row, f"row {i + 1}") for i, row in enumerate(document["results"])]
    study = Study(document["machine"], rows)

    seen = set()
    for row in rows:
        key = (row.scene, row.method, row.variant, row.k)
        if key in seen:
            raise Malformed(f"two rows are {row.scene}, {row.method} {row.variant} k = {row.k}")
        seen.add(key)
    for scene in study.scenes:
        if study.find(scene, BASE, 0) is None:
            raise Malformed(f"scene {scene} has no row of {BASE}, the base of the ratios")
    return study
