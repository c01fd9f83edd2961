# SPDX-License-Identifier: MIT
"""The page about volumes, of what scripts/lib/volume_study.py measured."""

import base64
import os
import sys

from . import documents, render
from .documents import Malformed


def _number(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def _steps(value):
    """An error in steps of 1/255."""
    return f"{value * 255:.2f}" if value * 255 >= 0.01 else f"{value * 255:.4f}"


def _percent(value):
    return "0" if value == 0 else f"{value * 100:.2f} %" if value >= 1e-4 else "< 0.01 %"


def _name(row):
    k = f"k = {row['k']}" if row["k"] else ""
    return ", ".join(filter(None, (row["method"], row["form"], k)))


def _fastest_rival(rows):
    return min((row for row in rows if row["driver"] == "stock"),
               key=lambda row: row["ms_median"], default=None)


def _comparison(rows):
    head = [("method", "text"), ("ms", ""), ("5 to 95 %", "range"), ("of it sorting", ""),
            ("passes", ""), ("RMS error", ""), ("largest error", ""), ("pixels off by > 1", ""),
            ("times as fast as the fastest of VTK", ""), ("its RMS error / ours", "")]
    rival = _fastest_rival(rows)
    lines = []
    for row in rows:
        against = ["–", "–"]
        if rival and row["driver"] == "ours":
            against = [_number(rival["ms_median"] / row["ms_median"]),
                       _number(rival["err_rmse"] / max(row["err_rmse"], 1e-9))]
        lines.append((row["driver"], [
            _name(row), _number(row["ms_median"]),
            f"{_number(row['ms_p5'])} to {_number(row['ms_p95'])}",
            _number(row["sort_ms"]) if row["sort_ms"] is not None else "–", str(row["passes"]),
            _steps(row["err_rmse"]), _steps(row["err_max"]), _percent(row["err_share"]),
            *against]))
    return render.table("Errors in steps of 1/255; methods of the patched Mesa in bold.", head,
                        lines)


def _tolerances(rows):
    head = [("tolerance", "text"), ("in steps of 1/255", ""), ("clusters of cells", ""),
            ("faces between them", ""), ("drawn", ""), ("RMS error", ""), ("largest error", ""),
            ("pixels off by > 1", ""), ("ms", ""), ("ms to join cells, once", "")]
    lines = []
    for row in rows:
        every = row["tolerance"] is None
        lines.append(("", ["all faces" if every else f"{row['tolerance']:g}",
                           "–" if every else _number(row["tolerance"] * 255),
                           "–" if every else f"{row['clusters']:,}", f"{row['triangles']:,}",
                           f"{row['triangles_drawn']:,}", _steps(row["err_rmse"]),
                           _steps(row["err_max"]), _percent(row["err_share"]),
                           _number(row["ms_median"]),
                           "–" if every else _number(row["ms_clusters"])]))
    return render.table("What accuracy costs: faces are left out as long as no color can be off by "
                        "more than the tolerance (k = 12, by centroids).", head, lines)


def _accuracy(rows):
    head = [("order", "text"), ("k", ""), ("budget", ""), ("triangles", ""), ("displacement", ""),
            ("pixels out of order", ""), ("RMS error", ""), ("largest error", ""), ("ms", ""),
            ("of it sorting", "")]
    lines = [("", [row["order"], str(row["k"]), f"{row['budget']:g}×", f"{row['triangles']:,}",
                   str(row["displacement"]), _percent(row["share_wrong"]), _steps(row["err_rmse"]),
                   _steps(row["err_max"]), _number(row["ms_median"]), _number(row["sort_ms"])])
             for row in rows]
    return render.table("What order costs: the faces are subdivided up to a budget of triangles, "
                        "those first that have the longest edges. Displacement is how many places "
                        "a fragment comes too late in the sequence of its pixel, the largest of "
                        "the picture; with more than k the order is wrong there.", head, lines)


def _pictures(folder, scene, rows):
    """The integrator's picture and the errors of the others, those that are in the folder: pairs of
    a PNG file in base 64 and a caption."""
    shown = [("integrator", "the integrator's picture")]
    shown += [(f"{_name(row).replace(', k =', '').replace(',', '')} error",
               f"{_name(row)}: its error, times 20") for row in rows]
    pictures = []
    for name, caption in shown:
        path = os.path.join(folder, f"{scene} {name}.png")
        if os.path.exists(path):
            with open(path, "rb") as file:
                pictures.append((base64.b64encode(file.read()).decode(), caption))
    return pictures


def _scene(study, folder, scene):
    rows, tolerances, accuracy = ([row for row in study[part] if row["scene"] == scene]
                                  for part in ("results", "tolerances", "accuracy"))
    tables = [_comparison(rows)]
    if tolerances:
        tables.append(_tolerances(tolerances))
    if accuracy:
        tables.append(_accuracy(accuracy))
    return {"name": scene, "about": study["scenes"][scene], "tables": tables,
            "pictures": _pictures(folder, scene, rows)}


def _machine(study):
    """What is known of the machine, and of what ran on it, as pairs of a name and a value."""
    pairs = list(study["machine"].items())
    pairs += [(row["method"], row["what"]) for row in study["results"] if row["what"]]
    drivers = sorted({row["runs_on"] for row in study["results"] if row["runs_on"]})
    return pairs + [("VTK runs on", driver) for driver in drivers]


def _load(path):
    study = documents.read(path)
    if not isinstance(study, dict) or not study.get("results") or not study.get("scenes"):
        raise Malformed('there are no rows in "results" or no "scenes"')
    return study


def write(source, target):
    """Makes the page of what the study wrote; the pictures are in the folder of the JSON's name."""
    try:
        study, folder = _load(source), os.path.splitext(source)[0]
        text = render.page("volume", data=os.path.basename(source), machine=_machine(study),
                           scenes=[_scene(study, folder, scene) for scene in study["scenes"]])
    except KeyError as error:
        sys.exit(f"{source}: a row has no {error}")
    except (OSError, Malformed) as error:
        sys.exit(f"{source}: {documents.reason(error)}")
    render.write_whole(target, text)
