# SPDX-License-Identifier: MIT
"""The page of the study of transparency: a summary, then plots and a table for each scene."""

import os
import sys

from . import documents, plots, render, results


def _number(value):
    """Three digits that count."""
    if value == 0:
        return "0"
    if value >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def _small(value):
    return "0" if value == 0 else f"{value:.5f}" if value >= 1e-5 else f"{value:.0e}"


def _speed_up(base, row):
    """How many times as fast as another method with this k."""
    return _number(base.ratio_median / row.ratio_median) if base and base is not row else "–"


def _scene_table(study, scene):
    head = [("method", "text"), ("form", "text"), ("k", ""), ("passes", ""), ("ms", ""),
            ("5 to 95 %", "range"), ("× z-buffer", ""), ("5 to 95 %", "range"),
            ("faster than classic-peeling", ""), ("faster than fbfetch", ""),
            ("bytes per pixel", ""), ("err_max", ""), ("err_share", ""), ("RMS error, all", "")]
    lines = []
    for row in study.of(scene):
        lines.append((row.driver, [
            row.method, row.variant, str(row.k or "–"), str(row.passes),
            _number(row.ms_median), f"{_number(row.ms_p5)} to {_number(row.ms_p95)}",
            _number(row.ratio_median), f"{_number(row.ratio_p5)} to {_number(row.ratio_p95)}",
            _speed_up(study.find(scene, "classic-peeling", row.k), row),
            _speed_up(study.find(scene, "fbfetch", row.k), row),
            f"{row.bytes_per_pixel:,}", _small(row.err_max), _small(row.err_share),
            _small(row.err_all_rmse)]))
    return render.table("Every row measured; methods of the patched Mesa in bold. “Faster” is how "
                        "many times as fast, with the same k.", head, lines)


def _best_of_stock(study, scene, k):
    rivals = [row for row in study.of(scene) if row.driver == "stock" and row.k == k and row.exact]
    return min(rivals, key=lambda row: row.ratio_median, default=None)


def _summary(study):
    ours = list(dict.fromkeys(row.method for row in study.rows
                              if row.driver == "ours" and not row.variant))
    head = [("scene", "text"), ("k", ""), ("fastest exact of stock Mesa", "text"),
            ("× z-buffer", "")]
    for method in ours:
        head += [(f"{method} × z-buffer", ""), ("times as fast", "")]
    lines = []
    for scene in study.scenes:
        for k in sorted({row.k for row in study.of(scene) if row.k > 0}):
            best = _best_of_stock(study, scene, k)
            cells = [scene, str(k), plots.name_of(best.series) if best else "–",
                     _number(best.ratio_median) if best else "–"]
            for method in ours:
                row = study.find(scene, method, k)
                cells += [_number(row.ratio_median) if row else "–",
                          _speed_up(best, row) if row else "–"]
            lines.append(("summary", cells))
    return render.table("Time as a multiple of an opaque z-buffered pass; “times as fast” is "
                        "against the fastest exact method of stock Mesa with the same k.", head,
                        lines)


def _facts(study, scene):
    """What was drawn, in words."""
    rows = study.of(scene)
    about = study.about(scene)
    facts = f"{rows[0].triangles:,} triangles, {rows[0].fragments:,} fragments"
    if "depth_complexity" in about:
        facts += f", up to {about['depth_complexity']:,} of a pixel"
    if "covered_pixels" in about:
        facts += f", {about['covered_pixels']:,} pixels covered"
    return facts


def _figures(rows, look):
    """The plots of a scene, each with its caption."""
    scene = rows[0].scene
    figures = [(plots.error_against_time(rows, look),
                f"{scene}: error against time; further left is faster, further down is nearer to "
                "the picture of all fragments")]
    if any(row.k > 0 for row in rows):
        figures += [(plots.time_against_k(rows, look), f"{scene}: time against k"),
                    (plots.bytes_against_k(rows, look), f"{scene}: memory against k")]
    return figures


def _scene(study, scene, look):
    return {"name": scene, "facts": _facts(study, scene), "note": study.about(scene).get("note"),
            "figures": _figures(study.of(scene), look), "table": _scene_table(study, scene)}


def _machine(machine):
    """Of what is known of the machine that which the page shows, as pairs of a name and a value."""
    names = {"date": "date", "commit": "commit", "processor": "processor",
             "processors": "processors", "memory_mib": "memory, MiB", "system": "system",
             "driver_stock": "stock Mesa", "driver_ours": "patched Mesa",
             "load_at_start": "load at the start", "lp_num_threads": "LP_NUM_THREADS",
             "rounds": "rounds"}
    pairs = [(name, machine[key]) for key, name in names.items()
             if machine.get(key) not in (None, "")]
    if "width" in machine and "height" in machine:
        pairs.append(("picture", f"{machine['width']}×{machine['height']} pixels"))
    return pairs


def _make(study, data):
    """The page as text, with all that it needs in it; `data` is the way from it to the raw data."""
    look = plots.Look(study.rows)
    return render.page("transparency", data=data, summary=_summary(study),
                       scenes=[_scene(study, scene, look) for scene in study.scenes],
                       machine=_machine(study.machine))


def write(source, target):
    """Makes the page of the results that kbuffer-bench wrote."""
    folder = os.path.dirname(os.path.abspath(target))
    try:
        text = _make(results.load(source), os.path.relpath(source, folder))
    except (OSError, documents.Malformed) as error:
        sys.exit(f"{source}: {documents.reason(error)}")
    render.write_whole(target, text)
