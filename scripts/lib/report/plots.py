# SPDX-License-Identifier: MIT
"""The plots of a scene, as SVG to be set into a page."""

import io
import math

import markupsafe
import matplotlib

matplotlib.use("svg")
# pylint: disable=wrong-import-position
from matplotlib import pyplot
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .results import BASE

# Colors of Okabe and Ito, which the color-blind tell apart, and a marker of its own each.
STYLES = {
    "zbuffer": ("#555555", "*"),
    "classic-peeling": ("#0072B2", "s"),
    "dual-peeling": ("#56B4E9", "v"),
    "linked-list": ("#CC79A7", "P"),
    "k-plus": ("#D55E00", "X"),
    "fbfetch": ("#E69F00", "^"),
    "kbuffer-program": ("#009E73", "D"),
    "depth-peeling": ("#000000", "o"),
}
OTHERS = [("#882255", "<"), ("#999933", ">"), ("#332288", "h"), ("#117733", "p")]
DASHES = [(0, (4, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2))]

pyplot.rcParams.update({
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "lines.linewidth": 1.5,
    "lines.markersize": 6.5,
    "svg.fonttype": "path",  # the same on every machine
})


def name_of(series):
    method, variant = series
    return f"{method}, {variant}" if variant else method


class Look:
    """A color and a marker for each method of a study, a dash for each further form of it."""

    def __init__(self, rows):
        unknown = [m for m in dict.fromkeys(row.method for row in rows) if m not in STYLES]
        self._methods = dict(STYLES)
        for i, method in enumerate(unknown):
            self._methods[method] = OTHERS[i % len(OTHERS)]
        self._forms = {}
        for method, variant in dict.fromkeys(row.series for row in rows):
            self._forms.setdefault(method, [""])
            if variant:
                self._forms[method].append(variant)

    def of(self, series):
        method, variant = series
        color, marker = self._methods[method]
        look = {"color": color, "marker": marker, "linestyle": "-", "markerfacecolor": color}
        if variant:
            form = self._forms[method].index(variant) - 1
            look["linestyle"] = DASHES[form % len(DASHES)]
            look["markerfacecolor"] = "white"
        return look


def _svg(figure, title):
    """The figure as an element for a page, which does not escape it; its ids are its own."""
    text = io.StringIO()
    with pyplot.rc_context({"svg.hashsalt": title}):
        figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)
    return markupsafe.Markup(text.getvalue()[text.getvalue().index("<svg"):])


def _axes():
    """So small that letters stay legible at the width of a phone."""
    return pyplot.subplots(figsize=(4.7, 3.5))


def _legend(axes, look, all_series):
    handles = [Line2D([], [], label=name_of(series), **look.of(series)) for series in all_series]
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.46, -0.18), ncol=2,
                frameon=False, fontsize=9, columnspacing=1.2, handlelength=2.6)


def _plain_numbers(axis):
    axis.set_major_locator(LogLocator(base=10, subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def _series(rows):
    return list(dict.fromkeys(row.series for row in rows))


def _points(rows, series):
    return sorted((row for row in rows if row.series == series), key=lambda row: row.k)


def _error(row):
    """Of an error of nothing, which has no place on a logarithmic axis, the least to be seen."""
    return max(row.err_all_rmse, 1e-6)


def _spread(points):
    """Error bars from the median to both percentiles."""
    return ([max(0, p.ratio_median - p.ratio_p5) for p in points],
            [max(0, p.ratio_p95 - p.ratio_median) for p in points])


def _label_errors(axes, rows):
    """The k of each height at the right edge; heights that are close share a label."""
    low, high = (math.log(y) for y in axes.get_ylim())
    heights = sorted({(_error(row), row.k) for row in rows if row.exact})
    groups = []
    for error, k in heights:
        if groups and (math.log(error) - math.log(groups[-1][0])) / (high - low) < 0.045:
            groups[-1][1].add(k)
        else:
            groups.append((error, {k}))
    for error, ks in groups:
        axes.annotate("k = " + ", ".join(map(str, sorted(ks))), (1, error), (4, 0),
                      xycoords=("axes fraction", "data"), textcoords="offset points",
                      va="center", fontsize=9.5, color="#333333")


def error_against_time(rows, look):
    """How far each method is from the picture of all fragments, and what it takes to get there."""
    figure, axes = _axes()
    axes.set_xscale("log")
    axes.set_yscale("log")
    for series in _series(rows):
        points = _points(rows, series)
        axes.errorbar([p.ratio_median for p in points], [_error(p) for p in points],
                      xerr=_spread(points), elinewidth=0.8, **look.of(series))
    _plain_numbers(axes.xaxis)
    _plain_numbers(axes.yaxis)
    axes.set_xlabel("time / opaque z-buffered pass")
    axes.set_ylabel("RMS error against all fragments")
    base = next(row.ms_median for row in rows if row.method == BASE)
    top = axes.secondary_xaxis("top", functions=(lambda x: x * base, lambda x: x / base))
    top.set_xlabel("milliseconds", fontsize=9)
    _plain_numbers(top.xaxis)
    _label_errors(axes, rows)
    _legend(axes, look, _series(rows))
    return _svg(figure, f"error {rows[0].scene}")


def _dodged(ks, i, count):
    """Points of equal k stand beside each other instead of upon each other."""
    return [k * 2 ** (0.045 * (i - (count - 1) / 2)) for k in ks]


def _against_k(rows, look, value, label, spread=None):
    rows = [row for row in rows if row.k > 0]
    figure, axes = _axes()
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    all_series = _series(rows)
    for i, series in enumerate(all_series):
        points = _points(rows, series)
        axes.errorbar(_dodged([p.k for p in points], i, len(all_series)),
                      [value(p) for p in points], yerr=spread(points) if spread else None,
                      elinewidth=0.8, **look.of(series))
    _plain_numbers(axes.yaxis)
    ks = sorted({row.k for row in rows})
    axes.set_xlim(ks[0] / 1.35, ks[-1] * 1.35)
    axes.set_xticks(ks)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda k, _: f"{k:g}"))
    axes.grid(axis="x", visible=False)
    axes.set_xlabel("k, the fragments kept of a pixel")
    axes.set_ylabel(label)
    _legend(axes, look, all_series)
    return figure


def time_against_k(rows, look):
    figure = _against_k(rows, look, lambda p: p.ratio_median,
                        "time / opaque z-buffered pass", _spread)
    return _svg(figure, f"time {rows[0].scene}")


def bytes_against_k(rows, look):
    """Forms that store as much as the method itself are left out."""
    usual = {(row.method, row.k): row.bytes_per_pixel for row in rows if not row.variant}
    kept = [row for row in rows
            if not row.variant or row.bytes_per_pixel != usual.get((row.method, row.k))]
    figure = _against_k(kept, look, lambda p: p.bytes_per_pixel, "bytes per pixel")
    return _svg(figure, f"bytes {rows[0].scene}")
