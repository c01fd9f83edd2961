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
