# shellcheck shell=bash
# The report of the study: every row is shown, and results that are not right are refused.

# write_results [PYTHON]: results.json of two scenes; PYTHON may change `document` and `rows`
write_results() {
    "$python" - "$work/results.json" "${1:-}" <<'PYTHON'
import json, sys
rows = []
for scene in "quads", "a <b>":
    for i, (method, variant, k) in enumerate([
            ("zbuffer", "", 0), ("fbfetch", "", 4), ("fbfetch", "", 16), ("new-method", "", 4),
            ("depth-peeling", "", 4), ("depth-peeling", "no-culling", 4)]):
        ms = 2.5 * (i + 1)
        rows.append({"scene": scene, "method": method, "variant": variant, "k": k, "passes": 1,
                     "driver": "ours" if method == "depth-peeling" else "stock",
                     "triangles": 256, "fragments": 1234567, "bytes_per_pixel": 8 * k + 4,
                     "ms_median": ms, "ms_p5": ms - 1, "ms_p95": ms + 1, "ratio_median": ms / 2.5,
                     "ratio_p5": ms / 3, "ratio_p95": ms / 2, "err_max": 0.001 * i,
                     "err_rmse": 0, "err_share": 0, "err_all_max": 0.5, "err_all_share": 0.5,
                     "err_all_rmse": 0 if i == 5 else 0.01 * (i + 1)})
document = {"machine": {"processor": "Test & Co", "scenes": {"quads": {"note": "see <here>"}}},
            "results": rows}
exec(sys.argv[2])
json.dump(document, open(sys.argv[1], "w"))
PYTHON
}

python=/usr/bin/python3
report=("$python" -B scripts/lib/report transparency "results.json" "index.html")

need_matplotlib() {
    "$python" -c 'import matplotlib' 2>/dev/null || skip "needs Matplotlib"
}

test_report_shows_every_row() {
    need_matplotlib
    write_results
    cp "$work/results.json" "$project"
    run 0 "${report[@]}"
    "$python" - "$project/results.json" "$project/index.html" <<'PYTHON'
import json, sys
from html.parser import HTMLParser

class Page(HTMLParser):
    """The tables' rows as lists of texts; counts the pictures."""
    def __init__(self):
        super().__init__()
        self.rows, self.pictures, self.text, self.cell = [], 0, "", False
    def handle_starttag(self, tag, attributes):
        if tag == "tr":
            self.rows.append([])
        self.cell = tag == "td"
        if self.cell:
            self.rows[-1].append("")
        self.pictures += tag == "svg"
        for name, value in attributes:
            assert name not in ("src", "srcset") and not (name == "href" and "//" in value), value
    def handle_data(self, data):
        self.text += data
        if self.cell:
            self.rows[-1][-1] += data

page = Page()
page.feed(open(sys.argv[2]).read())
shown = [row for row in page.rows if len(row) > 10]
wanted = json.load(open(sys.argv[1]))["results"]
assert len(shown) == len(wanted), (len(shown), len(wanted))
for row, cells in zip(wanted, shown):
    for field in "method", "variant":
        assert row[field] in cells, (row, cells)
    for text in (str(row["k"] or "–"), f"{row['ms_median']:.4g}", f"{row['bytes_per_pixel']}"):
        assert any(text in cell for cell in cells), (text, cells)
assert page.pictures == 6, page.pictures
assert "<here>" not in open(sys.argv[2]).read()
for text in "Test & Co", "see <here>", "a <b>: error against time", "1,234,567 fragments":
    assert text in page.text, text
PYTHON
}

# refused CHANGE TEXT: with this change the report is refused, and TEXT is in the one line about it
refused() {
    write_results "$1"
    cp "$work/results.json" "$project"
    run 1 "${report[@]}"
    prints "results.json: "
    prints "$2"
    lines 1
    absent index.html index.html.new
}

test_report_refuses_malformed_results() {
    refused 'document = []' '"machine"'
    refused 'del document["machine"]' '"machine"'
    refused 'document["results"] = []' '"results"'
    refused 'rows[2] = 7' 'row 3 is no object'
    refused 'del rows[3]["ms_p95"]' 'row 4 has no ms_p95'
    refused 'rows[3]["k"] = "4"' 'row 4: k is no number'
    refused 'rows[3]["k"] = 4.5' 'row 4: k is no whole number'
    refused 'rows[3]["method"] = None' 'row 4: method is no text'
    refused 'rows[3]["ms_median"] = float("nan")' 'row 4: ms_median is no number'
    refused 'rows[3]["ms_median"] = 0' 'row 4: ms_median is 0'
    refused 'rows[3]["err_max"] = -1' 'row 4: err_max is -1'
    refused 'del rows[0]' 'quads has no row of zbuffer'
    refused 'rows[5]["variant"] = ""' 'two rows are quads, depth-peeling'
}

test_report_refuses_what_is_no_json() {
    echo '{"machine": {}, ' >"$project/results.json"
    run 1 "${report[@]}"
    prints "results.json: this is no JSON"
    lines 1
    rm "$project/results.json"
    run 1 "${report[@]}"
    prints "results.json: No such file"
    absent index.html
}

# write_rows: a folder of what the program hard-cases writes, one number of it wrong
write_rows() {
    mkdir -p "$project/rows"
    "$python" - "$project/rows" <<'PYTHON'
import json, sys

def row(number, name, method, measured, form="", expected=0.75):
    right = measured == expected
    return {"row": number, "name": name, "promise": f"promise of {name}", "form": form,
            "method": method, "why_not": "", "right": right,
            "quantities": [{"what": "alpha <x>", "expected": expected, "measured": measured,
                            "tolerance": 0, "right": right}]}

methods = ("depth-peeling", "kbuffer-program")
good = [row(1, "coplanar", method, 0.75, form) for method in methods for form in ("", "4 samples")]
broken = [row(1, "coplanar", method, 0.25) for method in methods]
missing = dict(row(2, "other", "kbuffer-program", 0.5), quantities=[], why_not="no such entry",
               right=False)
rivals = [row(number, "coplanar", "classic peeling, strict", 0.5) for number in (1, 2, 3, 4, 24)]
rivals += [row(6, "close", "dual peeling, epsilon 1e-7", 0.5),
           row(13, "thin", "blending in 8 bits", 0.749)]
softpipe = good[:3] + [row(1, "coplanar", "kbuffer-program", 0.625, "4 samples")]
same = {method: "5eed" for method in methods}
other = {method: "0ddd" for method in methods}
documents = {"llvmpipe": good + [row(2, "other", "depth-peeling", 0.5, "", 0.5), missing],
             "softpipe": softpipe, "stock": rivals, "lost-layer": broken, "swapped-layers": broken}
for name, rows in documents.items():
    json.dump({"driver": f"driver {name}", "rows": rows}, open(f"{sys.argv[1]}/{name}.json", "w"))
for name in ("usual", "lost-layer", "threads-0", "threads-1", "threads-16", "width-128",
             "width-256", "no-culling", "no-cache", "cold-cache", "warm-cache"):
    digests = other if name == "lost-layer" else same
    json.dump({"digests": digests}, open(f"{sys.argv[1]}/same-{name}.json", "w"))
PYTHON
}

test_hard_cases_are_counted_and_shown() {
    local table=("$python" -B scripts/lib/report hard-cases rows hard-cases.html) text
    write_rows
    run 0 "${table[@]}"
    prints "not ok: 1. coplanar 4 samples, kbuffer-program on softpipe: is wrong"
    prints "alpha <x>: 0.625, expected 0.75 within 0"
    # 4 + 1 and 3 rows, 4 spoiled, 7 rivals, 18 of environments and 2 spoiled ones
    prints "39 passed, 1 failed, 0 skipped"
    for text in "1. coplanar" "alpha &lt;x&gt;" '<td class="wrong">0.625</td>' "no such entry" \
        "driver stock" "thread count"; do
        grep -qF "$text" "$project/hard-cases.html" || {
            echo "the page lacks: $text"
            exit 1
        }
    done
    # A case that a spoiled sample does not make wrong is none.
    cp "$project/rows/llvmpipe.json" "$project/rows/lost-layer.json"
    cp "$project/rows/same-usual.json" "$project/rows/same-lost-layer.json"
    run 0 "${table[@]}"
    prints "does not notice the nearest layer of one sample lost"
    prints "not ok: 25. digest of all layers, depth-peeling"
    # A key that is missing is named, and the page that was there stays as it was.
    sed -i 's/"promise"/"premise"/g' "$project/rows/llvmpipe.json"
    cp "$project/hard-cases.html" "$work/before.html"
    run 1 "${table[@]}"
    prints "rows: a row has no 'promise'"
    lines 1
    cmp "$project/hard-cases.html" "$work/before.html"
    rm "$project/rows/stock.json"
    run 1 "${table[@]}"
    prints "rows/stock.json: No such file"
    lines 1
}
