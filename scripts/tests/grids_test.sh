# shellcheck shell=bash
# scripts/convert-grid, and scripts/fetch-data with a small grid

grids=$source_root/scripts/tests/grids.py

make_grids() {
    /usr/bin/python3 -c 'import meshio, vtk' 2>/dev/null || skip "needs python3-vtk9 and python3-meshio"
    mkdir "$work/grids"
    /usr/bin/python3 "$grids" make "$work/grids" >/dev/null
    cd "$work/grids" || exit
}

# converted TETRAHEDRA FIELDS [--block N] FILE...: what is made of the files is the unit cube, its
# cells share their faces, and the field is right
converted() {
    local cells=$1 fields=$2 measured
    local expected="$cells tetrahedra, volume 1.000000, all positive, 0 faces unshared, field right: $fields"
    shift 2
    run 0 scripts/convert-grid "$@" "$work/made.vtk"
    lines 1
    measured=$(/usr/bin/python3 "$grids" measure "$work/made.vtk")
    [ "$measured" = "$expected" ] || {
        printf '%s: %s\ninstead of: %s\n' "$*" "$measured" "$expected"
        exit 1
    }
}

# not_converted TEXT FILE...: one line, exit status 2, nothing written
not_converted() {
    local text=$1
    shift
    run 2 scripts/convert-grid "$@" "$work/refused.vtk"
    lines 1
    prints "$text"
    [ ! -e "$work/refused.vtk" ] || exit 1
}

test_convert_plot3d() {
    make_grids
    local fields="Density Momentum StagnationEnergy"
    local form
    for form in plot3d little marks double text; do
        converted 320 "$fields" "$PWD/$form.xyz" "$PWD/$form.q"
    done
    converted 320 "x y z" "$PWD/plot3d.xyz"
    echo "more than the solution" >>double.q
    converted 320 "$fields" "$PWD/double.xyz" "$PWD/double.q"
    converted 320 "$fields" "$PWD/left.xyz" "$PWD/left.q"
    prints "320 turned"
    mv plot3d.xyz plot3d.bin
    converted 320 "$fields" "$PWD/plot3d.bin" "$PWD/plot3d.q"
}

test_convert_plot3d_with_blocks_and_blanks() {
    make_grids
    not_converted "it has 2 blocks: choose one by --block" "$PWD/blocks.xyz" "$PWD/blocks.q"
    not_converted "it has no block 2" --block 2 "$PWD/blocks.xyz" "$PWD/blocks.q"
    run 0 scripts/convert-grid --block 1 "$PWD/blocks.xyz" "$PWD/blocks.q" "$work/made.vtk"
    measured=$(/usr/bin/python3 "$grids" measure "$work/made.vtk")
    [[ $measured == "320 tetrahedra, volume 0.500000, all positive, "*", field right: "* ]]
    # A quarter of the cells have a blanked point.
    run 0 scripts/convert-grid "$PWD/blanked.xyz" "$PWD/blanked.q" "$work/made.vtk"
    measured=$(/usr/bin/python3 "$grids" measure "$work/made.vtk")
    [[ $measured == "240 tetrahedra, volume 0.750000, all positive, "*", field right: "* ]]
}

test_convert_a_folded_grid() {
    # The 4 x 2 cells at the fold are wedges: of the 5 tetrahedra of each, some are flat.
    make_grids
    run 0 scripts/convert-grid "$PWD/folded.xyz" "$PWD/folded.q" "$work/made.vtk"
    [[ $output =~ \ ([0-9]+)\ of\ 160\ tetrahedra:\ ([0-9]+)\ without\ volume.*12\ points\ joined ]]
    [ "${BASH_REMATCH[2]}" -gt 0 ]
    converted "${BASH_REMATCH[1]}" "Density Momentum StagnationEnergy" \
        "$PWD/folded.xyz" "$PWD/folded.q"
}

test_convert_files_of_vtk() {
    make_grids
    converted 320 f "$PWD/structured.vts"
    run 0 scripts/convert-grid "$PWD/hexahedra.vtu" "$work/made.vtk"
    # VTK cuts a hexahedron into five or six.
    [[ $output =~ \ ([0-9]+)\ of ]]
    converted "${BASH_REMATCH[1]}" f "$PWD/hexahedra.vtu"
    converted "${BASH_REMATCH[1]}" f "$PWD/hexahedra.vtk"
    converted "${BASH_REMATCH[1]}" c "$PWD/cells.vtu"
}

test_convert_files_of_meshio() {
    make_grids
    converted 384 f "$PWD/gmsh.msh"
    prints "192 turned"
    converted 384 "x y z" "$PWD/medit.mesh"
    prints "coordinates"
}

test_converted_grids_are_converted_to_themselves() {
    make_grids
    run 0 scripts/convert-grid "$PWD/plot3d.xyz" "$PWD/plot3d.q" "$work/made.vtk"
    run 0 scripts/convert-grid "$work/made.vtk" "$work/again.vtk"
    cmp "$work/made.vtk" "$work/again.vtk"
}

test_grids_that_cannot_be_converted() {
    make_grids
    local ending
    not_converted "there is no file" "$PWD/absent.vtu"
    for ending in vtu vtk msh mesh xyz; do
        not_converted "nothing.$ending" "$PWD/nothing.$ending"
    done
    not_converted "no cells with a volume" "$PWD/surface.vtu"
    not_converted "the value of 'f' at point 9 is not finite" "$PWD/nan.vtu"
    head -c 300 plot3d.xyz >cut.xyz
    not_converted "cut.xyz" "$PWD/cut.xyz" "$PWD/plot3d.q"
    head -c 300 plot3d.q >cut.q
    not_converted "cut.q" "$PWD/plot3d.xyz" "$PWD/cut.q"
    not_converted "folded.q is no PLOT3D solution on its points" "$PWD/plot3d.xyz" "$PWD/folded.q"
    run 2 scripts/convert-grid "$PWD/plot3d.xyz" "$work/no/such/folder/made.vtk"
    lines 1
}

test_convert_grid_needs_names() {
    run 2 scripts/convert-grid
    run 2 scripts/convert-grid a.vtu
    run 2 scripts/convert-grid a.vtu b.vtu
    prints "'b.vtu'"
    run 2 scripts/convert-grid a b c d.vtk
    run 2 scripts/convert-grid --block two a.xyz b.vtk
    absent build
}

test_grid_from_a_folder() {
    make_grids
    local file
    for file in plot3d.xyz plot3d.q; do
        sums+=("\"file\": \"$file\", \"url\": \"http://127.0.0.1:9/$file\", \"size\": 1,
            \"sha256\": \"$(sha256sum <"$file" | cut -d' ' -f1)\"")
    done
    echo "{\"cube\": {\"file\": \"cube.vtk\", \"what\": \"a cube\", \"origin\": \"a test\",
        \"licence\": \"none\", \"plot3d\": {\"grid\": {${sums[0]}}, \"solution\": {${sums[1]}}}}}" \
        >"$project/scripts/data.json"
    run 1 env "${offline[@]}" scripts/fetch-data
    prints "cannot be fetched"
    absent build/data/cube.vtk
    run 0 env "${offline[@]}" KBUFFER_DATA_DIR="$PWD" scripts/fetch-data
    prints "320 of 320 tetrahedra"
    run 0 env "${offline[@]}" scripts/fetch-data
    [ -z "$output" ]
    # It is made again when what it is made of changes.
    touch "$project/build/data/plot3d.q"
    run 0 env "${offline[@]}" scripts/fetch-data
    prints "Making tetrahedra"
    run 0 scripts/fetch-data --list
    prints "2 bytes, build/data/cube.vtk"
    no_temporaries
}
