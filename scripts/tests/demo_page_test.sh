# shellcheck shell=bash
# The demo's page: it says what the samples' JSON says, and no key is missed in silence.

# write_demo [PYTHON]: a folder of what the samples wrote; PYTHON may change `mesh`, `volume` and
# `points`
write_demo() {
    rm -rf "$project/demo"
    mkdir -p "$project/demo/layers"
    touch "$project/demo/layers"/layer-0{1,0}{,-depth}.{png,pfm}
    /usr/bin/python3 - "$project/demo" "${1:-}" <<'PYTHON'
import json, sys
mesh = {"size": [640, 480], "ms": [9, 7.125, 100], "passes": 3, "triangles": 871414}
volume = {"size": [640, 480], "ms": [4, 2], "passes": 1, "triangles": 5000, "triangles_drawn": 1234}
points = {"size": [640, 480], "ms": [1.5], "passes": 1, "primitive": "points", "primitives": 1000}
exec(sys.argv[2])
for name, document in (("mesh", mesh), ("volume", volume), ("a <b> & c", points)):
    json.dump(document, open(f"{sys.argv[1]}/{name}.json", "w"))
PYTHON
}

answer='driver: llvmpipe <LLVM & Co>
version: 4.5 (Mesa)
library: /nowhere'
demo_page=(/usr/bin/python3 -B scripts/lib/report demo)
demo_pictures=("mesh=a mesh, k = 8" "volume=<script> & \"more\"" "a <b> & c=points")

shown() { # TEXT...: on the page
    local text
    for text in "$@"; do
        tr '\n' ' ' <"$project/demo/index.html" | grep -qF -- "$text" || {
            echo "the page lacks: $text"
            exit 1
        }
    done
}

# hidden PATTERN: nothing on the page matches it
hidden() {
    if grep -nE "$1" "$project/demo/index.html"; then
        echo "the page has: $1"
        exit 1
    fi
}

test_demo_page_shows_what_the_samples_tell() {
    write_demo
    run 0 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
    lines 3
    # Medians of three, of two and of one frame
    prints "demo/mesh.png                               9.00 ms   3 passes  a mesh, k = 8"
    prints "demo/volume.png                             3.00 ms   1 pass    <script> & \"more\""
    shown "9.00 ms, 3 geometry passes, 871,414 triangles" \
        "3.00 ms, 1 geometry pass, 1,234 of 5,000 faces" \
        "1.50 ms, 1 geometry pass, 1,000 points" \
        "640x480 pixels; the times are medians of 3 frames" \
        'src="mesh.png"' 'href="mesh.json"' "<p>a mesh, k = 8</p>"
    # Not one character of what is shown is taken for HTML.
    shown "llvmpipe &lt;LLVM &amp; Co&gt;, OpenGL 4.5 (Mesa)" \
        "<p>&lt;script&gt; &amp; &#34;more&#34;</p>" 'src="a%20%3Cb%3E%20%26%20c.png"'
    hidden '<script|<b>|http-equiv'
    shown 'src="layers/layer-00-depth.png" alt=""> <img src="layers/layer-00.png" alt=""> <img'
    [ "$(grep -c 'src="layers/' "$project/demo/index.html")" -eq 4 ]
}

test_demo_page_loads_itself_anew_while_more_is_drawn() {
    write_demo
    rm -r "$project/demo/layers"
    run 0 "${demo_page[@]}" --drawing --driver "$answer" demo "${demo_pictures[0]}"
    lines 1
    shown '<meta http-equiv="refresh" content="10">' "More is being built and drawn."
    hidden 'The layers|src="layers|volume.png'
}

test_demo_page_names_the_key_that_is_missing() {
    local key
    for key in ms passes size triangles; do
        write_demo "del mesh[\"$key\"]"
        run 1 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
        prints "demo/mesh.json: there is no \"$key\""
        lines 1
        absent demo/index.html
    done
    write_demo 'del points["primitives"]'
    run 1 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
    prints 'demo/a <b> & c.json: there is no "primitives"'
    write_demo 'mesh["ms"] = []'
    run 1 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
    prints 'demo/mesh.json: "ms" has no times'
    write_demo
    run 1 "${demo_page[@]}" --driver "driver: llvmpipe" demo "${demo_pictures[@]}"
    prints 'no line "version: ..."'
    echo '{"ms": ' >"$project/demo/mesh.json"
    run 1 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
    prints "demo/mesh.json: this is no JSON"
    rm "$project/demo/mesh.json"
    run 1 "${demo_page[@]}" --driver "$answer" demo "${demo_pictures[@]}"
    prints "demo/mesh.json: No such file"
    lines 1
    absent demo/index.html
}

# Templates say what they miss, too: nothing is left empty.
test_templates_name_the_key_that_is_missing() {
    cat >"$project/check.py" <<'PYTHON'
import sys
sys.path.insert(0, "scripts/lib")
from report import documents, render
try:
    render.page("demo", driver="d", processors=2, drawing=False, layers=[])
except documents.Malformed as error:
    assert "'pictures'" in str(error), error
else:
    sys.exit("a page without pictures was made")
PYTHON
    run 0 /usr/bin/python3 -B check.py
}
