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

# build/piglit/src
unpack_piglit() {
    local folder
    [ "$(cat "$piglit/src/.complete" 2>/dev/null)" != "$piglit_sha256" ] || return 0
    fetch_piglit
    make_temporary folder
    tar -C "$folder" --strip-components=1 -xf "$piglit_tarball"
    echo "$piglit_sha256" >"$folder/.complete"
    rm -rf "$piglit/src" "$piglit/build"
    mkdir -p "$piglit"
    mv "$folder" "$piglit/src"
}

# configure_piglit BUILD_DIR [OPTION...]: its tests check in assert(), so not a release build
configure_piglit() {
    local dir=$1
    shift
    [ ! -f "$dir/.configured" ] || return 0
    say "Configuring piglit"
    rm -rf "$dir"
    logged "configuring piglit" "piglit-$(basename "$dir")-configure.log" \
        cmake -S "$piglit/src" -B "$dir" -G Ninja -Wno-dev \
        -DPYTHON_EXECUTABLE="$python" -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_C_FLAGS_DEBUG="-O1 -g1" -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
        -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
        -DPIGLIT_USE_GBM=OFF -DPIGLIT_USE_WAYLAND=OFF -DPIGLIT_BUILD_DMA_BUF_TESTS=OFF \
        -DPIGLIT_BUILD_VK_TESTS=OFF -DPIGLIT_BUILD_GLES1_TESTS=OFF -DPIGLIT_BUILD_CL_TESTS=OFF "$@"
    touch "$dir/.configured"
}

# Only the framework's libraries and shader_runner: the tests of piglit itself stay unbuilt.
build_piglit() {
    unpack_piglit
    configure_piglit "$piglit/build"
    run_ninja "piglit" piglit-build.log "$piglit/build" shader_runner
}

# build_test_programs BUILD_DIR PIGLIT_BUILD PREFIX [OPTION...]: our tests, on the Mesa in PREFIX
build_test_programs() {
    local dir=$1 piglit_build=$2 prefix=$3
    shift 3
    logged "configuring the tests" "piglit-$(basename "$dir")-configure.log" \
        cmake -S "$root/piglit-tests" -B "$dir" -G Ninja -DPIGLIT_SRC="$piglit/src" \
        -DPIGLIT_BUILD="$piglit_build" -DKBUFFER_INCLUDE="$prefix/include" \
        -DOSMESA="$(find "$prefix/" -name libOSMesa.so -print -quit)" \
        -DCMAKE_C_COMPILER_LAUNCHER=ccache "$@"
    run_ninja "the tests" "piglit-$(basename "$dir")-build.log" "$dir"
}

# write_profile BUILD_DIR PROFILE [LAUNCHER...]: of our tests there, LAUNCHER in front of each
write_profile() {
    local dir=$1 profile=$2
    shift 2
    "$python" "$root/piglit-tests/mkprofile.py" "$root/piglit-tests" "$dir" \
        "$piglit/build/bin/shader_runner" "$profile" "$@"
}

# Our tests, in $piglit/tests, and their profile
build_tests() { # PREFIX PROFILE [LAUNCHER...]
    build_piglit
    build_test_programs "$piglit/tests" "$piglit/build" "$1"
    write_profile "$piglit/tests" "${@:2}"
}

# They for arm64, in $piglit/tests-arm64, after scripts/lib/arm64.sh; of piglit only their library
build_arm64_tests() { # PREFIX PROFILE LAUNCHER...
    local options=(-DCMAKE_TOOLCHAIN_FILE="$arm64/arm64.cmake")
    unpack_piglit
    configure_piglit "$piglit/build-arm64" "${options[@]}"
    run_ninja "piglit for arm64" piglit-build-arm64.log "$piglit/build-arm64" piglitutil_gl
    build_test_programs "$piglit/tests-arm64" "$piglit/build-arm64" "$1" "${options[@]}"
    write_profile "$piglit/tests-arm64" "${@:2}"
}
