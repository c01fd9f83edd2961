# Fetching piglit and building what the tests need of it. To be sourced after the scripts/lib files
# common.sh, packages.sh and source.sh.
# shellcheck shell=bash

piglit_version=0.0~git20250409.af62c0dea
piglit_sha256=a9863a5f136e3bb9c4fae43421585f5b39fe93c573963a7e1fa3871804472852
piglit_commit=af62c0dea
piglit_suite=trixie
piglit=$build/piglit
piglit_tarball=$build/download/piglit_$piglit_version.orig.tar.xz

piglit_from_distribution() { # FOLDER
    source_file "$1" "$piglit_suite" piglit "$(basename "$piglit_tarball")" &&
        mv "$source_file" "$1/piglit.tar.xz"
}

# The tarball, verified, in build/download.
fetch_piglit() {
    local folder
    if [ -f "$piglit_tarball" ]; then
        [ "$(sha256_of "$piglit_tarball")" != "$piglit_sha256" ] || return 0
        warn "$piglit_tarball has a wrong checksum: fetching it again"
    fi
    say "Fetching the source of piglit ($piglit_commit) from Debian $piglit_suite"
    make_temporary folder
    if ! piglit_from_distribution "$folder" ||
        [ "$(sha256_of "$folder/piglit.tar.xz")" != "$piglit_sha256" ]; then
        die "the source of piglit cannot be fetched" \
            "Check the network and run $command_name again, or put $(basename "$piglit_tarball")" \
            "(SHA-256 $piglit_sha256) into build/download yourself."
    fi
    mkdir -p "$build/download"
    mv "$folder/piglit.tar.xz" "$piglit_tarball"
}

# Only the framework's libraries and shader_runner: the tests of piglit itself stay unbuilt. Its
# tests check in assert(), so not a release build.
build_piglit() {
    local folder
    if [ "$(cat "$piglit/src/.complete" 2>/dev/null)" != "$piglit_sha256" ]; then
        fetch_piglit
        make_temporary folder
        tar -C "$folder" --strip-components=1 -xf "$piglit_tarball"
        echo "$piglit_sha256" >"$folder/.complete"
        rm -rf "$piglit/src" "$piglit/build"
        mkdir -p "$piglit"
        mv "$folder" "$piglit/src"
    fi
    if [ ! -f "$piglit/build/.configured" ]; then
        say "Configuring piglit"
        rm -rf "$piglit/build"
        logged "configuring piglit" piglit-configure.log \
            cmake -S "$piglit/src" -B "$piglit/build" -G Ninja -Wno-dev \
            -DPYTHON_EXECUTABLE="$python" -DCMAKE_BUILD_TYPE=Debug \
            -DCMAKE_C_FLAGS_DEBUG="-O1 -g1" -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
            -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
            -DPIGLIT_USE_GBM=OFF -DPIGLIT_USE_WAYLAND=OFF -DPIGLIT_BUILD_DMA_BUF_TESTS=OFF \
            -DPIGLIT_BUILD_VK_TESTS=OFF -DPIGLIT_BUILD_GLES1_TESTS=OFF -DPIGLIT_BUILD_CL_TESTS=OFF
        touch "$piglit/build/.configured"
    fi
    run_ninja "piglit" piglit-build.log "$piglit/build" shader_runner
}

# Our tests, in $piglit/tests, and their profile
build_tests() { # PREFIX [PROFILE [LAUNCHER...]]
    local tests=$root/piglit-tests prefix=$1 profile=${2:-kbuffer}
    shift $(($# > 1 ? 2 : 1))
    logged "configuring the tests" piglit-tests-configure.log \
        cmake -S "$tests" -B "$piglit/tests" -G Ninja -DPIGLIT_SRC="$piglit/src" \
        -DPIGLIT_BUILD="$piglit/build" -DKBUFFER_INCLUDE="$prefix/include" \
        -DOSMESA="$(find "$prefix/" -name libOSMesa.so -print -quit)" \
        -DCMAKE_C_COMPILER_LAUNCHER=ccache
    run_ninja "the tests" piglit-tests-build.log "$piglit/tests"
    "$python" "$tests/mkprofile.py" "$tests" "$piglit/tests" \
        "$piglit/build/bin/shader_runner" "$piglit/tests/$profile.xml.gz" "$@"
}
