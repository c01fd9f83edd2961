# shellcheck shell=bash
# The study of volumes: VTK draws the same scene as the sample.

test_vtk_draws_the_same_volume() {
    /usr/bin/python3 -c 'import vtk' 2>/dev/null || skip "needs python3-vtk9"
    command -v Xvfb >/dev/null || skip "needs Xvfb"
    # Whatever Mesa there is: the built one, else the machine's
    mkdir -p "$project/build"
    ln -s "$source_root"/build/*prefix "$project/build/"
    run 0 bash -c '
        . scripts/lib/common.sh
        . scripts/lib/xvfb.sh
        . scripts/lib/prefix.sh
        if [ -e build/stock-prefix/.complete ]; then use_prefix stock-prefix; fi
        start_xvfb build/xvfb.log
        "$python" -B scripts/tests/vtk_volume_check.py build'
    prints "vtk-zsweep: "
}

# write_study [PYTHON]: volume.json of two scenes; PYTHON may change `document` and `rows`
write_study() {
    /usr/bin/python3 - "$project/volume.json" "${1:-}" <<'PYTHON'
import json, sys
rows = [{"scene": scene, "method": method, "form": "cells" if k else "", "driver": driver, "k": k,
         "passes": 1, "triangles": 12, "what": "what <it> is", "frames": 9,
         "sort_ms": 3.25 if k else None, "runs_on": "llvmpipe & Co",
         "ms_median": ms, "ms_p5": ms - 1, "ms_p95": ms + 1, "err_max": 0.25, "err_rmse": rmse,
         "err_share": 0.125}
        for scene in ("fin, haze", "a <b>")
        for method, driver, k, ms, rmse in (("kbuffer-program", "ours", 6, 40, 0.001),
                                            ("vtk-slow", "stock", 0, 900, 0.0005),
                                            ("vtk-fast", "stock", 0, 120, 0.008))]
document = {"machine": {"processor": "Test & Co"}, "results": rows,
            "scenes": {name: {"field": "Density", "triangles": 1234567, "transfer": [],
                              "camera": {"azimuth": 20, "elevation": 30, "distance": 2.7}}
                       for name in ("fin, haze", "a <b>")},
            "tolerances": [{"scene": "a <b>", "tolerance": tolerance, "clusters": 2345,
                            "triangles": 4567, "triangles_drawn": 3456, "ms_clusters": 67.25,
                            "ms_median": 33, "ms_p5": 32, "ms_p95": 34, "frames": 3,
                            "err_max": 0.02, "err_rmse": 0.002, "err_share": 0}
                           for tolerance in (None, 0.1)],
            "accuracy": [{"scene": "a <b>", "k": 6, "order": "nearest", "budget": 1.5,
                          "triangles": 7654321, "displacement": 17, "share_wrong": 0.0625, "sort_ms": 2, "ms_median": 44,
                          "ms_p5": 43, "ms_p95": 45, "frames": 3, "err_max": 0.1, "err_rmse": 0.01,
                          "err_share": 0}]}
exec(sys.argv[2])
json.dump(document, open(sys.argv[1], "w"))
PYTHON
}

volume_page=(/usr/bin/python3 -B scripts/lib/report volume volume.json volume.html)

test_volume_page_shows_every_row() {
    local text
    write_study
    run 0 "${volume_page[@]}"
    # 120 ms against 40 ms; an error of 0.008 against 0.001; errors in steps of 1/255
    for text in "fin, haze" "a &lt;b&gt;" "kbuffer-program, cells, k = 6" "<td>3.00</td><td>8.00</td>" \
        "<td>63.75</td><td>12.50 %</td>" "<td>7,654,321</td><td>17</td><td>6.25 %</td>" \
        "<td>25.5</td><td>2,345</td><td>4,567</td><td>3,456</td>" \
        "all faces</td><td>–</td><td>–</td><td>4,567</td>" "1,234,567 faces" "llvmpipe &amp; Co" "what &lt;it&gt; is" "Test &amp; Co"; do
        grep -qF "$text" "$project/volume.html" || {
            echo "the page lacks: $text"
            exit 1
        }
    done
    [ "$(grep -c '<td class="text">vtk-slow' "$project/volume.html")" -eq 2 ]
}

test_volume_page_refuses_malformed_results() {
    local change
    for change in 'document = []' 'document["results"] = []' 'del document["scenes"]' \
        'del rows[1]["err_rmse"]' 'del document["accuracy"]' 'del document["tolerances"]'; do
        write_study "$change"
        run 1 "${volume_page[@]}"
        prints "volume.json: "
        lines 1
        absent volume.html volume.html.new
    done
    # Whether the page's program misses a key or its template does, the key is named.
    write_study 'del rows[1]["err_rmse"]'
    run 1 "${volume_page[@]}"
    prints "'err_rmse'"
    write_study 'del document["scenes"]["a <b>"]["camera"]["elevation"]'
    run 1 "${volume_page[@]}"
    prints "'elevation'"
    absent volume.html volume.html.new
    rm "$project/volume.json"
    run 1 "${volume_page[@]}"
    prints "volume.json: No such file"
    lines 1
}

test_volume_errors_are_those_of_the_pictures() {
    /usr/bin/python3 -c 'import matplotlib' 2>/dev/null || skip "needs Matplotlib"
    cat >"$project/check.py" <<'PYTHON'
import struct, sys
sys.path.insert(0, "scripts/lib")
import volume_study
# Two rows of two pixels, the lowest first: (0, 0) at the top is the third of the file.
pixels = [(0, 0, 0), (.25, 0, 0), (1, .5, .25), (0, 0, .5)]
with open("a.pfm", "wb") as file:
    file.write(b"PF\n2 2\n-1.0\n" + b"".join(struct.pack("<3f", *pixel) for pixel in pixels))
picture = volume_study.read_pfm("a.pfm")
assert picture.shape == (2, 2, 3) and list(picture[0, 0]) == [1, .5, .25], picture
changed = picture.copy()
changed[0, 1, 2] += .3
changed[1, 0, 0] += 1 / 300
found = volume_study.errors(changed, picture)
assert abs(found["err_max"] - .3) < 1e-12, found
assert abs(found["err_rmse"] - ((.3 ** 2 + 300 ** -2) / 12) ** .5) < 1e-12, found
assert found["err_share"] == .25, found
PYTHON
    run 0 /usr/bin/python3 -B check.py
}
