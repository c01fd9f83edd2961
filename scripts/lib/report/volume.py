# SPDX-License-Identifier: MIT
"""Usage: python3 volume.py VOLUME.JSON OUT.HTML

Makes the page about volumes from what scripts/lib/volume_study.py measured, with the pictures in
the folder of the JSON's name. Exit status 1 if it is malformed, with nothing written."""

import base64
import json
import os
import sys
from html import escape

from parts import document, table, write_whole

GUIDE = """
<h2>How to read this</h2>
<ul>
<li><b>The error</b> is that of the picture against the integrator's, over all pixels and channels,
in steps of 1/255: the root of the mean square, the largest, and the part of the pixels in which a
channel is off by more than one step. The integrator walks the cells along each ray on the CPU, in
double precision; it has no code in common with what is measured. VTK's pictures have 8 bits a
channel, which alone makes 0.29 of root mean square error; ours are floats.</li>
<li><b>Time</b> is that of a whole frame: sorting, drawing, what follows it, to glFinish. Setting
up, compiling and reading back are not in it. Each program runs in turn, several frames each, and
medians are of all. “Times as fast” is against the fastest of VTK's mappers, whatever its error,
which the last column compares.</li>
<li><b>VTK</b> is the distribution's, on stock Mesa's llvmpipe of the same version and build. Its
opacity divided by its unit distance is the extinction, and it emits extinction × color as we do: a
test proves it on one cell. Bunyk's rays go through the corners of pixels; its camera is moved by
half a pixel for that. Image sample distances are 1: a ray a pixel.</li>
<li><b>vtk-projected-tetrahedra</b> takes colors at vertices, in 8 bits, and the thickness of a cell
from a table that ends at 1/45 of the longest edge: thinner cells are not there. That is the error
that its pictures show.</li>
<li><b>vtk-zsweep</b> is drawn once.</li>
<li><b>centroid</b>, <b>nearest</b>, <b>cells</b>: faces are drawn in the order of their centroids,
of their nearest vertices, or of the cells between them, which takes longer to find and needs the
smallest k.</li>
<li><b>Tolerance</b>: cells in which the scalar is nearly one linear function are joined, and the
faces between them are not drawn, as long as no color can be off by more than that, if all that is
off were off to the same side. What is seen is the error beside it.</li>
</ul>
"""


class Malformed(Exception):
    pass


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
    return table("Errors in steps of 1/255; methods of the patched Mesa in bold.", head, lines)


def _tolerances(rows):
    if not rows:
        return ""
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
    return table("What accuracy costs: faces are left out as long as no color can be off by more "
                 "than the tolerance (k = 12, by centroids).", head, lines)


def _accuracy(rows):
    if not rows:
        return ""
    head = [("order", "text"), ("k", ""), ("budget", ""), ("triangles", ""), ("displacement", ""),
            ("pixels out of order", ""), ("RMS error", ""), ("largest error", ""), ("ms", ""),
            ("of it sorting", "")]
    lines = [("", [row["order"], str(row["k"]), f"{row['budget']:g}×", f"{row['triangles']:,}",
                   str(row["displacement"]), _percent(row["share_wrong"]), _steps(row["err_rmse"]),
                   _steps(row["err_max"]), _number(row["ms_median"]), _number(row["sort_ms"])])
             for row in rows]
    return table("What order costs: the faces are subdivided up to a budget of triangles, those "
                 "first that have the longest edges. Displacement is how many places a "
                 "fragment comes too late in the sequence of its pixel, the largest of the "
                 "picture; with more than k the order is wrong there.", head, lines)


def _pictures(folder, scene, rows):
    """The integrator's picture and the errors of the others, as parts of the page."""
    text = ""
    shown = [("integrator", "the integrator's picture")]
    shown += [(f"{_name(row).replace(', k =', '').replace(',', '')} error",
               f"{_name(row)}: its error, times 20") for row in rows]
    for name, caption in shown:
        path = os.path.join(folder, f"{scene} {name}.png")
        if os.path.exists(path):
            with open(path, "rb") as file:
                data = base64.b64encode(file.read()).decode()
            text += (f'<figure><img alt="" width="256" src="data:image/png;base64,{data}">'
                     f"<figcaption>{escape(caption)}</figcaption></figure>\n")
    return f'<div class="figures">\n{text}</div>\n' if text else ""


def _scene(study, folder, scene):
    about = study["scenes"][scene]
    camera = about["camera"]
    rows = [row for row in study["results"] if row["scene"] == scene]
    return (f"<h2>{escape(scene)}</h2>\n<p>Field {escape(about['field'])}, "
            f"{about['triangles']:,} faces, seen from azimuth {camera['azimuth']:g}°, elevation "
            f"{camera['elevation']:g}°, distance {camera['distance']:g}.</p>\n"
            + _comparison(rows)
            + _tolerances([row for row in study["tolerances"] if row["scene"] == scene])
            + _accuracy([row for row in study["accuracy"] if row["scene"] == scene])
            + _pictures(folder, scene, rows))


def _machine(study):
    items = "".join(f"<dt>{escape(key)}</dt><dd>{escape(str(value))}</dd>\n"
                    for key, value in study["machine"].items())
    for row in study["results"]:
        if row["what"]:
            items += f"<dt>{escape(row['method'])}</dt><dd>{escape(row['what'])}</dd>\n"
    drivers = sorted({row["runs_on"] for row in study["results"] if row["runs_on"]})
    items += "".join(f"<dt>VTK runs on</dt><dd>{escape(driver)}</dd>\n" for driver in drivers)
    return f"<h2>Machine</h2>\n<dl>\n{items}</dl>\n"


def make(study, folder, data):
    scenes = "".join(_scene(study, folder, scene) for scene in study["scenes"])
    return document("Volumes of tetrahedra: time and error", f"""
<p>Direct volume rendering of unstructured grids: the sample <code>volume</code>, which draws the
faces once through a k-buffer program, beside what VTK has for it. The raw data is in
<a href="{escape(data)}">{escape(data)}</a>.</p>
{scenes}{GUIDE}{_machine(study)}""")


def load(path):
    with open(path, encoding="utf-8") as file:
        try:
            study = json.load(file)
        except ValueError as error:
            raise Malformed(f"this is no JSON: {error}") from error
    if not isinstance(study, dict) or not study.get("results") or not study.get("scenes"):
        raise Malformed('there are no rows in "results" or no "scenes"')
    return study


def main(source, target):
    try:
        text = make(load(source), os.path.splitext(source)[0], os.path.basename(source))
    except KeyError as error:
        sys.exit(f"{source}: a row has no {error}")
    except (OSError, Malformed) as error:
        sys.exit(f"{source}: {getattr(error, 'strerror', None) or error}")
    write_whole(target, text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
