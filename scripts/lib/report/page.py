# SPDX-License-Identifier: MIT
"""The page: a summary, then plots and a table for each scene, and what to make of them."""

from html import escape

import plots
from parts import document, table

GUIDE = """
<h2>How to read this</h2>
<ul>
<li><b>Time</b> is that of whole frames: clearing, the passes over the geometry and the resolve
into a picture of 8 bits a channel, from glFinish to glFinish. Setting up, compiling shaders and
reading back are not in it. Methods take turns frame by frame, and a <b>ratio</b> is that of a
frame to the opaque one, z-buffered by stock Mesa, that was drawn right before it: what slows the
machine down slows both. Medians, with the 5th and 95th percentiles of the rounds in the tables and as bars in
the plots.</li>
<li><b>Absolute milliseconds</b> are this machine's on that day. Ratios carry over better, though
not to another number of processors or another processor for certain.</li>
<li><b>err_max</b> and <b>err_share</b> compare with the exact picture of the same k, made on the
CPU in double precision from every fragment of the scene, captured on stock Mesa by a pass that no
method has a part in. err_share is the part of the pixels in which a channel is off by more than
1/255: above 0 a layer is wrong or missing. Colors are kept in 8 bits a channel, which alone makes
err_max up to 1/255 = 0.0039. Methods are called exact here if their err_share is 0.</li>
<li><b>RMS error against all fragments</b> is what is seen of leaving all but k fragments out,
plus the rounding of colors, which is where the curves end. The opaque z-buffered picture is shown
for scale: it is another picture.</li>
<li><b>Bytes per pixel</b> is what a method stores beside the final picture. Of lists of all
fragments it depends on the scene.</li>
<li>Forms: <b>no-culling</b> is the method without early rejection of fragments that cannot be
kept. <b>unlocked</b> leaves out a lock that GL's memory model asks for: right on a driver that
runs each tile's fragments one after the other in order, undefined in GL. It is shown, but it is
no rival in the summary.</li>
<li><b>Not measured</b>: GPUs, other sizes of picture, multisampling, scenes that change between
frames, and the time it takes to write each method.</li>
</ul>
"""


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
    return table("Every row measured; methods of the patched Mesa in bold. “Faster” is how many "
                 "times as fast, with the same k.", head, lines)


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
    return table("Time as a multiple of an opaque z-buffered pass; “times as fast” is against the "
                 "fastest exact method of stock Mesa with the same k.", head, lines)


def _figure(svg, text):
    picture = svg.replace("<svg ", f'<svg role="img" aria-label="{escape(text)}" ', 1)
    return f"<figure>{picture}<figcaption>{escape(text)}</figcaption></figure>\n"


def _scene(study, scene, look):
    rows = study.of(scene)
    about = study.machine.get("scenes", {}).get(scene, {})
    facts = f"{rows[0].triangles:,} triangles, {rows[0].fragments:,} fragments"
    if "depth_complexity" in about:
        facts += f", up to {about['depth_complexity']:,} of a pixel"
    if "covered_pixels" in about:
        facts += f", {about['covered_pixels']:,} pixels covered"
    note = f"<p><strong>{escape(about['note'])}</strong></p>\n" if about.get("note") else ""
    text = f'<h2 id="{escape(scene)}">{escape(scene)}</h2>\n<p>{facts}.</p>\n{note}'
    text += '<div class="figures">\n'
    text += _figure(plots.error_against_time(rows, look),
                    f"{scene}: error against time; further left is faster, further down is nearer "
                    "to the picture of all fragments")
    if any(row.k > 0 for row in rows):
        text += _figure(plots.time_against_k(rows, look), f"{scene}: time against k")
        text += _figure(plots.bytes_against_k(rows, look), f"{scene}: memory against k")
    return text + "</div>\n" + _scene_table(study, scene)


def _machine(machine):
    names = {"date": "date", "commit": "commit", "processor": "processor",
             "processors": "processors", "memory_mib": "memory, MiB", "system": "system",
             "driver_stock": "stock Mesa", "driver_ours": "patched Mesa",
             "load_at_start": "load at the start", "lp_num_threads": "LP_NUM_THREADS",
             "rounds": "rounds"}
    items = ""
    for key, name in names.items():
        value = machine.get(key)
        if value not in (None, ""):
            items += f"<dt>{name}</dt><dd>{escape(str(value))}</dd>\n"
    if "width" in machine and "height" in machine:
        items += f"<dt>picture</dt><dd>{machine['width']}×{machine['height']} pixels</dd>\n"
    return f"<h2>Machine</h2>\n<dl>\n{items}</dl>\n"


def make(study, data):
    """The page as text, with all that it needs in it; `data` is the way from it to the raw data."""
    look = plots.Look(study.rows)
    scenes = "".join(_scene(study, scene, look) for scene in study.scenes)
    return document("Transparency without a GPU: time, error and memory", f"""
<p>Methods of transparency side by side on llvmpipe: those that stock Mesa can do, and those of the
patched one. The raw data is in <a href="{escape(data)}">{escape(data)}</a>. What must stay
numerically stable is in <a href="hard-cases.html">hard-cases.html</a>, which
<code>scripts/test --only hard-cases</code> makes; volumes are in <a href="volume.html">volume.html</a>.</p>
{_summary(study)}
{scenes}{GUIDE}{_machine(study.machine)}""")
