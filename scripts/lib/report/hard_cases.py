# SPDX-License-Identifier: MIT
"""The table of the hard cases, of the rows that the program hard-cases wrote into a folder:
llvmpipe.json and softpipe.json with the extensions, stock.json without, lost-layer.json and
swapped-layers.json with one sample of each case spoiled, and same-*.json, whose layers are compared
with those of same-usual.json. All rows go beside the page, too. What is not as promised is printed,
and last "N passed, N failed, N skipped"."""

import json
import os
import sys

from . import documents, render

DRIVERS = ("llvmpipe", "softpipe")
METHODS = ("depth-peeling", "kbuffer-program")
FLAWS = {"lost-layer": "the nearest layer of one sample lost",
         "swapped-layers": "the two nearest layers of one sample swapped"}
# Where a method of stock Mesa must come out wrong: else a case does not see what it is about.
WRONG_RIVALS = {(number, "classic peeling, strict") for number in (1, 2, 3, 4, 24)}
WRONG_RIVALS |= {(6, "dual peeling, epsilon 1e-7"), (13, "blending in 8 bits")}

# (file, name, promise, form) of what must not change a bit. The first is a test of the test.
ENVIRONMENTS = (
    ("same-threads-0", "thread count", "0 to 16 rasterizer threads: the same bits", "0 threads"),
    ("same-threads-1", "thread count", "0 to 16 rasterizer threads: the same bits", "1 thread"),
    ("same-threads-16", "thread count", "0 to 16 rasterizer threads: the same bits", "16 threads"),
    ("same-width-128", "vector width", "Vectors of 128 and 256 bits: the same bits", "128 bits"),
    ("same-width-256", "vector width", "Vectors of 128 and 256 bits: the same bits", "256 bits"),
    ("same-no-culling", "culling", "With and without early rejection: the same bits", "without"),
    ("same-no-cache", "shader cache", "Shaders compiled or from the cache: the same bits", "off"),
    ("same-cold-cache", "shader cache", "Shaders compiled or from the cache: the same bits",
     "cold"),
    ("same-warm-cache", "shader cache", "Shaders compiled or from the cache: the same bits",
     "warm"),
)

def _number(value):
    return f"{value:.9g}"


def _title(number, name):
    """Invariances have no number."""
    return f"{number}. {name}" if number else name


def _mark(right):
    return "right" if right else "wrong"


class Cases:
    """All rows by driver, and what is wrong with them."""

    def __init__(self, documents):
        self.drivers = {name: documents[name]["driver"] for name in (*DRIVERS, "stock")}
        self.rows = {name: documents[name]["rows"] for name in (*DRIVERS, "stock", *FLAWS)}
        self.passed = 0
        self.failed = 0
        self.complaints = []
        self._append_environments(documents)
        for driver in DRIVERS:
            for row in self._measured(driver):
                self._judge(row["right"], driver, row, "is wrong")
        for flaw, what in FLAWS.items():
            for row in self._measured(flaw):
                self._judge(not row["right"], "softpipe", row, f"does not notice {what}")
        for number, rival in sorted(WRONG_RIVALS):
            found = [row for row in self.rows["stock"]
                     if row["row"] == number and row["method"] == rival]
            self._judge(len(found) == 1 and not found[0]["right"], "stock",
                        {"row": number, "name": "", "form": "", "method": rival, "quantities": []},
                        "is not seen to be wrong")

    def _append_environments(self, documents):
        """Rows of what is compared by the digests of all layers."""
        usual = documents["same-usual"]["digests"]
        for file, name, promise, form in ENVIRONMENTS:
            for method in METHODS:
                other = documents[file]["digests"][method] != usual[method]
                self.rows["llvmpipe"].append({
                    "row": 0, "name": name, "promise": promise, "form": form, "method": method,
                    "why_not": "", "right": not other,
                    "quantities": [{"what": "digest of all layers of case 25 differs",
                                    "expected": 0, "measured": int(other), "tolerance": 0,
                                    "right": not other}]})
        spoiled = documents["same-lost-layer"]["digests"]
        for method in METHODS:
            self._judge(spoiled[method] != usual[method], "llvmpipe",
                        {"row": 25, "name": "digest of all layers", "form": "", "method": method,
                         "quantities": []}, f"does not notice {FLAWS['lost-layer']}")

    def _measured(self, source):
        return [row for row in self.rows[source] if row["quantities"]]

    def _judge(self, good, driver, row, complaint):
        if good:
            self.passed += 1
            return
        self.failed += 1
        text = " ".join(filter(None, (_title(row["row"], row["name"]), row["form"])))
        self.complaints.append(f"not ok: {text}, {row['method']} on {driver}: {complaint}")
        for quantity in row["quantities"]:
            if not quantity["right"]:
                self.complaints.append(
                    f"    {quantity['what']}: {_number(quantity['measured'])}, expected "
                    f"{_number(quantity['expected'])} within {_number(quantity['tolerance'])}")

    def names(self):
        """(number, name, promise) in the order of the rows."""
        return list(dict.fromkeys((row["row"], row["name"], row["promise"])
                                  for row in self.rows[DRIVERS[0]]))

    def of(self, source, name, method=None):
        return [row for row in self.rows[source]
                if row["name"] == name and method in (None, row["method"])]


def _summary_cell(rows):
    measured = [row for row in rows if row["quantities"]]
    if not measured:
        return "see below" if rows else "–"
    right = sum(row["right"] for row in measured)
    forms = "" if len(measured) == 1 else f" ({right} of {len(measured)} forms right)"
    first = measured[0]["quantities"][0]
    return (_number(first["measured"]) + forms, "" if right == len(measured) else "wrong")


def _rivals_text(rows):
    parts = []
    for row in rows:
        if not row["quantities"]:
            continue
        first = row["quantities"][0]
        worst = max(row["quantities"], key=lambda q: (not q["right"], abs(q["measured"])))
        number = first if not first["right"] else worst
        parts.append(f"{row['method']}: " + ("right" if row["right"] else
                     f"wrong ({number['what']} {number['measured']:.4g}, "
                     f"not {number['expected']:.4g})"))
    return "; ".join(parts) or "–"


def _summary(cases):
    head = [("#", ""), ("case", "text"), ("expected", "prose"), ("first number", "prose")]
    head += [(f"{method}, {driver}", "") for method in METHODS for driver in DRIVERS]
    head += [("stock rivals", "prose"), ("verdict", "text")]
    lines = []
    for number, name, promise in cases.names():
        first = next((row["quantities"][0] for row in cases.of(DRIVERS[0], name)
                      if row["quantities"]), None)
        cells = [str(number or ""), name, promise,
                 f"{first['what']}: {_number(first['expected'])}" if first else "–"]
        right = True
        for method in METHODS:
            for driver in DRIVERS:
                rows = cases.of(driver, name, method)
                cells.append(_summary_cell(rows))
                right = right and all(row["right"] for row in rows if row["quantities"])
        rivals = [row for row in cases.rows["stock"] if row["name"] == name]
        cells += [_rivals_text(rivals), (_mark(right), "" if right else "wrong")]
        lines.append(("", cells))
    return render.table("Measured on both drivers; verdicts are those of all forms and numbers.",
                        head, lines)


def _quantity_line(row, i, form, columns):
    """One number of a form: `columns` has the row of each method and driver, or None."""
    quantity = row["quantities"][i]
    cells = [form, quantity["what"], _number(quantity["expected"]), _number(quantity["tolerance"])]
    right = True
    for other in columns:
        own = next((q for q in other["quantities"] if q["what"] == quantity["what"]),
                   None) if other else None
        if own is None:
            cells.append("–")
            continue
        right = right and own["right"]
        cells.append((_number(own["measured"]), "" if own["right"] else "wrong"))
    return cells + [(_mark(right), "" if right else "wrong")]


def _case(cases, number, name, promise):
    head = [("form", "text"), ("number", "text"), ("expected", ""), ("tolerance", "")]
    head += [(f"{method}, {driver}", "") for method in METHODS for driver in DRIVERS]
    head += [("verdict", "text")]
    lines, reasons = [], []
    for form in dict.fromkeys(row["form"] for row in cases.of(DRIVERS[0], name)):
        columns = []
        for method in METHODS:
            for driver in DRIVERS:
                row = next((row for row in cases.of(driver, name, method)
                            if row["form"] == form), None)
                columns.append(row)
                if row and row["why_not"]:
                    reasons.append(f"{method} on {driver}, {form or 'any form'}: {row['why_not']}")
        # Methods can have numbers of their own: those of all, in order.
        shown = set()
        for row in filter(None, columns):
            for i, quantity in enumerate(row["quantities"]):
                if quantity["what"] not in shown:
                    lines.append(("", _quantity_line(row, i, "" if shown else form, columns)))
                    shown.add(quantity["what"])
    rivals = [row for row in cases.rows["stock"] if row["name"] == name]
    reasons += [f"{row['method']}: {row['why_not']}" for row in rivals if row["why_not"]]
    return {"title": _title(number, name), "promise": promise,
            "numbers": render.table("", head, lines), "rivals": _rivals(rivals),
            "reasons": list(dict.fromkeys(reasons))}


def _rivals(rows):
    """Every number of the methods of stock Mesa in a case; None if there are no such methods."""
    if not rows:
        return None
    head = [("method", "text"), ("number", "text"), ("expected", ""), ("tolerance", ""),
            ("measured", ""), ("verdict", "text")]
    lines = [("", [row["method"], q["what"], _number(q["expected"]), _number(q["tolerance"]),
                   (_number(q["measured"]), "" if q["right"] else "wrong"), _mark(q["right"])])
             for row in rows for q in row["quantities"]]
    return render.table("Stock rivals, on llvmpipe:", head, lines)


def _make(cases, data):
    return render.page("hard_cases", data=data, summary=_summary(cases),
                       drivers=list(cases.drivers.items()),
                       cases=[_case(cases, *names) for names in cases.names()])


def _read(folder):
    found = {}
    for name in (*DRIVERS, "stock", *FLAWS, "same-usual", "same-lost-layer",
                 *(file for file, *_ in ENVIRONMENTS)):
        path = os.path.join(folder, name + ".json")
        try:
            found[name] = documents.read(path)
        except (OSError, documents.Malformed) as error:
            sys.exit(f"{path}: {documents.reason(error)}")
    return found


def write(folder, target):
    """Writes the page and, beside it, all rows as JSON; prints what is not as promised."""
    data = os.path.splitext(target)[0] + ".json"
    try:
        cases = Cases(_read(folder))
        text = _make(cases, os.path.basename(data))
    except KeyError as error:
        sys.exit(f"{folder}: a row has no {error}")
    except documents.Malformed as error:
        sys.exit(f"{folder}: {error}")
    rows = json.dumps({"drivers": cases.drivers, "rows": cases.rows}, indent=1)
    render.write_whole(data, rows + "\n")
    render.write_whole(target, text)
    for complaint in cases.complaints:
        print(complaint)
    print(f"Table: {target}")
    print(f"{cases.passed} passed, {cases.failed} failed, 0 skipped")
