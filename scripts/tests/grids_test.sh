# shellcheck shell=bash
# scripts/convert-grid, and scripts/fetch-data with a small grid

grids=$source_root/scripts/tests/grids.py

make_grids() {
    /usr/bin/python3 -c 'import meshio, vtkmodules' 2>/dev/null ||
        skip "needs python3-vtk9 and python3-meshio"
    mkdir "$work/grids" "$work/made"
    /usr/bin/python3 "$grids" make "$work/grids" >/dev/null
    cd "$work/grids" || exit
}

# convert NAME FILE...: to $work/made/NAME.vtk
convert() {
    local name=$1
    shift
    run 0 scripts/convert-grid "$@" "$work/made/$name.vtk"
    lines 1
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

# What is made of each file is the unit cube, its cells share their faces, and the field is right.
test_convert_grid_makes_tetrahedra() {
    make_grids
    local form expected measured folded hexahedra
    for form in plot3d little marks double text; do
        [ $form != double ] || echo "more than the solution" >>double.q
        convert $form "$PWD/$form.xyz" "$PWD/$form.q"
    done
    convert points "$PWD/plot3d.xyz"
    prints "coordinates"
    convert left "$PWD/left.xyz" "$PWD/left.q"
    prints "320 turned"
    convert structured "$PWD/structured.vts"
    convert gmsh "$PWD/gmsh.msh"
    prints "192 turned"
    convert medit "$PWD/medit.mesh"
    # VTK cuts a hexahedron into five or six.
    convert hexahedra "$PWD/hexahedra.vtu"
    [[ $output =~ \ ([0-9]+)\ of ]]
    hexahedra=${BASH_REMATCH[1]}
    convert legacy "$PWD/hexahedra.vtk"
    convert cells "$PWD/cells.vtu"
    # The 4 x 2 cells at the fold are wedges: of the 5 tetrahedra of each, some are flat.
    convert folded "$PWD/folded.xyz" "$PWD/folded.q"
    [[ $output =~ \ ([0-9]+)\ of\ 160\ tetrahedra:\ ([0-9]+)\ without\ volume.*12\ points\ joined ]]
    folded=${BASH_REMATCH[1]}
    [ "${BASH_REMATCH[2]}" -gt 0 ]

    expected=$(
        while read -r name cells fields; do
            echo "$name.vtk: $cells tetrahedra, volume 1.000000, all positive," \
                "0 faces unshared, field right: $fields"
        done <<END
cells $hexahedra c
double 320 Density Momentum StagnationEnergy
folded $folded Density Momentum StagnationEnergy
gmsh 384 f
hexahedra $hexahedra f
left 320 Density Momentum StagnationEnergy
legacy $hexahedra f
little 320 Density Momentum StagnationEnergy
marks 320 Density Momentum StagnationEnergy
medit 384 x y z
plot3d 320 Density Momentum StagnationEnergy
points 320 x y z
structured 320 f
text 320 Density Momentum StagnationEnergy
END
    )
    measured=$(/usr/bin/python3 "$grids" measure "$work"/made/*.vtk)
    diff <(echo "$expected") <(echo "$measured") || exit

    # One block is half of the cube; of another grid a quarter of the cells have a blanked point.
    convert block --block 1 "$PWD/blocks.xyz" "$PWD/blocks.q"
    convert blanked "$PWD/blanked.xyz" "$PWD/blanked.q"
    convert again "$work/made/plot3d.vtk"
    cmp "$work/made/plot3d.vtk" "$work/made/again.vtk"
    measured=$(/usr/bin/python3 "$grids" measure "$work"/made/bl*.vtk)
    [[ $measured == *"320 tetrahedra, volume 0.500000, all positive, "*", field right: "* ]]
    [[ $measured == *"240 tetrahedra, volume 0.750000, all positive, "*", field right: "* ]]
}

# What users' files have besides a grid does not keep it from being converted.
test_convert_grid_takes_files_as_users_have_them() {
    make_grids
    local form tetrahedra
    convert big "$PWD/legacy-big.vtk"
    [[ $output =~ \ ([0-9]+)\ of ]]
    tetrahedra=${BASH_REMATCH[1]}
    convert arrays "$PWD/legacy-arrays.vtk"
    prints "'lost' is left out, as the value of 'lost' at point 0 is not finite"
    convert little "$PWD/legacy-little.vtk"
    prints "its binary numbers are little-endian, against the format"
    convert flat "$PWD/legacy-flat.vtk"
    prints "2 cells that are points, lines or faces are left out"
    run 0 scripts/convert-grid -- "$PWD/legacy-far.vtk" "$work/made/far.vtk"
    convert own "$PWD/legacy-own.vtk"
    prints "125 points"
    diff <(for form in "arrays mask f" "big f" "far f p" "flat f" "little f" "own f"; do
        echo "${form%% *}.vtk: $tetrahedra tetrahedra, volume 1.000000, all positive," \
            "0 faces unshared, field right: ${form#* }"
    done) <(/usr/bin/python3 "$grids" measure "$work"/made/*.vtk) || exit
}

test_grids_that_cannot_be_converted() {
    make_grids
    local ending
    not_converted "it ends early" "$PWD/legacy-cut.vtk"
    not_converted "the value of 'f' at point 9 is not finite" "$PWD/legacy-nan.vtk"
    not_converted "'1,5' is no number of its type: numbers have a point" "$PWD/legacy-comma.vtk"
    not_converted "has point 125, but there are 125 points" "$PWD/legacy-wrong.vtk"
    not_converted "cell 0 has 8 points, but its type 10 has 4" "$PWD/legacy-type.vtk"
    not_converted "cell 0 has point 999999, but there are 125 points" "$PWD/beyond.vtu"
    not_converted "VTK says Error parsing XML" "$PWD/cut.vtu"
    not_converted "it has 2 blocks: choose one by --block" "$PWD/blocks.xyz" "$PWD/blocks.q"
    not_converted "it has no block 2" --block 2 "$PWD/blocks.xyz" "$PWD/blocks.q"
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
        \"licence\": \"none\", \"converted\": {\"grid\": {${sums[0]}}, \"solution\": {${sums[1]}}}}}" \
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

test_convert_grid_writes_where_the_name_leads() {
    make_grids
    convert plain "$PWD/hexahedra.vtk"
    run 2 scripts/convert-grid "$PWD/hexahedra.vtk" /dev/full
    prints "No space left on device"
    lines 1
    [ -c /dev/full ]
    "$project/scripts/convert-grid" "$PWD/hexahedra.vtk" - >"$work/printed.vtk" 2>"$work/said"
    cmp "$work/printed.vtk" "$work/made/plain.vtk"
    grep -q tetrahedra "$work/said"
    echo old >"$work/target.vtk"
    chmod 604 "$work/target.vtk"
    ln -s target.vtk "$work/link.vtk"
    run 0 scripts/convert-grid "$PWD/hexahedra.vtk" "$work/link.vtk"
    [ -L "$work/link.vtk" ]
    [ "$(stat -c %a "$work/target.vtk")" = 604 ]
    cmp "$work/target.vtk" "$work/made/plain.vtk"
}
