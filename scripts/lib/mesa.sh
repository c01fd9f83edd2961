# Configuring, building and installing Mesa and the project. To be sourced after tree.sh.
# shellcheck shell=bash

libdir=lib/$(gcc -print-multiarch 2>/dev/null || true)

newest_llvm() {
    local version
    for version in 19 18 17 16 15; do
        if [ -x /usr/lib/llvm-$version/bin/llvm-config ] && [ -d /usr/lib/llvm-$version/include ]; then
            echo "/usr/lib/llvm-$version/bin/llvm-config"
            return
        fi
    done
    command -v llvm-config || die "no LLVM of 15 or newer" "Install its development package."
}

# Paths below build/ are made relative in what ccache compares, and all trees lie and are built at
# the same depth, so trees of one clone and clones anywhere share results. The cache is the user's.
# What a file includes is taken from the compiler's own list after it has compiled the file (-MD),
# which saves a run of the preprocessor for each file that the cache does not have.
export CCACHE_BASEDIR=$build CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1

# write_native_file [NAME COMMAND...]: the compilers of what is configured from here on: GCC through
# ccache, else what the command makes of gcc and g++
write_native_file() {
    local name=${1:-} command
    shift $(($# > 0))
    printf -v command "'%s', " "${@:-ccache}"
    native=$build/native${name:+-$name}.ini
    mkdir -p "$build"
    cat >"$native.new" <<END
[binaries]
c = [${command}'gcc']
cpp = [${command}'g++']
python3 = '$python'
llvm-config = '$(newest_llvm)'
END
    cmp -s "$native.new" "$native" || mv "$native.new" "$native"
    rm -f "$native.new"
}

mesa_options=(-Dgallium-drivers=swrast -Dvulkan-drivers= -Dosmesa=true -Dglx=dri -Degl=enabled
    -Dgbm=enabled -Dplatforms=x11 -Dllvm=enabled -Dshared-llvm=enabled -Dglvnd=enabled
    -Dgles1=disabled -Dgles2=enabled -Dvideo-codecs= -Dgallium-va=disabled -Dgallium-vdpau=disabled
    -Dvalgrind=disabled -Dlibunwind=disabled -Dlmsensors=disabled -Dbuild-tests=true)
# As distributions compile it: -O3 of Meson's release takes a third longer.
release_options=(--buildtype=release -Doptimization=2 -Db_ndebug=true)
debug_options=(--buildtype=debugoptimized -Db_ndebug=false)

# A sanitized Mesa is the release but for the files that matter: what a report names is ours then,
# and what ccache has of the others counts. The runtime comes with the program that loads the library
# (b_lundef), which may be a fuzzer.
instrumented_options=("${release_options[@]}" -Db_lundef=false)
traceable='-O1 -g1 -fno-omit-frame-pointer -Wno-unknown-warning-option'
sanitizers='-fsanitize=address,undefined -fno-sanitize=vptr'

# instrument NAME OPTIONS FILE...: what is configured from here on has these files compiled by Clang
# with OPTIONS
instrument() {
    local name=$1 options=$2 list=$build/instrumented-$1.txt
    shift 2
    printf '%s\n' "$@" | LC_ALL=C sort -u >"$list"
    write_native_file "$name" "$root/scripts/lib/instrumenting-compiler" "$list" \
        "$traceable $options"
}

# Our files, with the coverage that libFuzzer needs, which costs little elsewhere
build_sanitized_mesa() {
    local files
    mapfile -t files < <(
        overlay_files
        hook_files | xargs -r sed -n 's|^diff --git a/\(.*\) b/.*|\1|p'
    )
    instrument sanitize "$sanitizers -fsanitize=fuzzer-no-link" "${files[@]}" \
        src/mesa/program/{lex.yy,program_parse.tab}.c
    build_mesa "sanitized Mesa" "$tree" "$tree/build-sanitize" "$build/sanitize-prefix" \
        "${instrumented_options[@]}"
}

# What of llvmpipe the threads share: scenes, fences, tiles, and what depth peeling keeps
build_thread_mesa() {
    local name files=(src/mesa/state_tracker/st_{kbuffer,peel}.c)
    for name in clear context draw_arrays fence flush kbuf kbuf_rast kbuf_tile peel peel_parts \
        peel_rast peel_tile query rast rast_linear rast_rect rast_tri scene scene_queue setup \
        setup_rect setup_tri setup_vbuf state_derived texture tile_pixels; do
        files+=("src/gallium/drivers/llvmpipe/lp_$name.c")
    done
    instrument thread -fsanitize=thread "${files[@]}"
    build_mesa "Mesa with ThreadSanitizer" "$tree" "$tree/build-thread" "$build/thread-prefix" \
        "${instrumented_options[@]}"
}

# A file of Meson that describes another machine, for which what is configured is compiled then
cross=''

# configure WHAT SOURCE BUILD_DIR OPTION...: only when the options are not those of the last time.
# The stamp is written last, so a half-configured folder is made anew.
configure() {
    local what=$1 source=$2 dir=$3 stamp
    shift 3
    set -- ${cross:+--cross-file "$cross"} "$@"
    stamp=$(printf '%s\n' "${meson[*]}" "$(cat "$native" ${cross:+"$cross"})" "$@")
    [ "$(cat "$dir/.kbuffer-options" 2>/dev/null)" != "$stamp" ] || return 0
    say "Configuring $what"
    rm -rf "$dir"
    logged "configuring $what" "$(basename "$dir")-configure.log" \
        "${meson[@]}" setup --native-file "$native" "$@" "$dir" "$source"
    printf '%s\n' "$stamp" >"$dir/.kbuffer-options"
}

# write_package_file PREFIX: for programs that use EGL or GLX, whose libraries are the vendor-neutral
# ones of the distribution; only the header is the prefix's
write_package_file() {
    [ -f "$1/include/GL/mesa_kbuffer.h" ] || return 0
    cat >"$1/$libdir/pkgconfig/mesa-kbuffer.pc" <<END
prefix=$1
includedir=\${prefix}/include

Name: mesa-kbuffer
Description: GL_MESA_kbuffer_program and GL_MESA_depth_peeling in EGL and GLX contexts
Version: $mesa_version
Requires: egl gl
Cflags: -I\${includedir}
END
}

# install_mesa BUILD_DIR PREFIX: a prefix is whole when it holds the stamp
install_mesa() {
    local vendor=$2/share/glvnd/egl_vendor.d/50_mesa.json
    rm -f "$2/.complete"
    logged "installing into $2" "$(basename "$2")-install.log" \
        "${meson[@]}" install -C "$1" --no-rebuild --only-changed
    # With its folder the library is found by programs, too, that look for others in one of theirs.
    if [ -f "$vendor" ]; then
        sed -i -E "s|(\"library_path\" *: *\").*(libEGL_mesa)|\1$2/$libdir/\2|" "$vendor"
        write_package_file "$2"
    fi
    date >"$2/.complete"
}

# wanted_targets BUILD_DIR [FOLDERS]: sets wanted_targets to what ninja has to make of Mesa, which
# is what is installed, and the programs (tests) below src/FOLDERS, a pattern. All the rest of Mesa
# serves neither.
wanted_targets() {
    mapfile -t wanted_targets < <("${meson[@]}" introspect --targets "$1" | "$python" -c '
import json, os, re, sys
build, folders = sys.argv[1:]
for target in json.load(sys.stdin):
    if target["installed"] or (folders and target["type"] == "executable" and
                               re.search(f"/src/({folders})/", target["defined_in"])):
        print(os.path.relpath(target["filename"][0], build))' "$1" "${2:-}")
}

# build_mesa WHAT TREE BUILD_DIR PREFIX OPTION...
build_mesa() {
    local what=$1 source=$2 dir=$3 prefix=$4 start=$SECONDS
    shift 4
    configure "$what" "$source" "$dir" --prefix="$prefix" --libdir="$libdir" \
        "${mesa_options[@]}" "$@"
    say "Building $what"
    wanted_targets "$dir"
    run_ninja "$what" "$(basename "$prefix")-ninja.log" "$dir" "${wanted_targets[@]}"
    install_mesa "$dir" "$prefix"
    note "$what is in ${prefix#"$root"/} ($((SECONDS - start)) s)"
}

# The folders of Mesa with parts that hooks change, whose programs are their tests
tested_folders='mesa|mapi|gallium/drivers'

# Mesa's own unit tests of these folders. The compiler's (NIR, GLSL) would take longer than all else.
test_mesa() {
    local results=$tree/build/meson-logs/testlog.junit.xml
    wanted_targets "$tree/build" "$tested_folders"
    run_ninja "Mesa's unit tests" mesa-tests-ninja.log "$tree/build" "${wanted_targets[@]}"
    rm -f "$results"
    "${meson[@]}" test -C "$tree/build" --no-rebuild --print-errorlogs --timeout-multiplier 4 \
        --num-processes "$jobs" --suite=mesa:{mesa,st_mesa,mapi,llvmpipe} || true
    "$python" "$root/scripts/lib/junit.py" "$results"
}

# What ninja makes of the project; nothing named is all of it.
project_targets=()

# The samples, tools and unit tests, against build/prefix
build_project() {
    build_project_in project prefix --buildtype=release
}

# The same against the sanitized Mesa, sanitized as a whole
build_sanitized_project() {
    write_native_file project-sanitize "$root/scripts/lib/instrumenting-compiler" - \
        "$traceable $sanitizers"
    build_project_in project-sanitize sanitize-prefix --buildtype=plain \
        -Db_sanitize=address,undefined -Db_lundef=false
}

build_project_in() { # NAME PREFIX_NAME OPTION...
    local name=$1 prefix=$build/$2 start=$SECONDS
    shift 2
    [ -f "$root/meson.build" ] || return 0
    export PKG_CONFIG_PATH=$prefix/$libdir/pkgconfig
    configure "the $name" "$root" "$build/$name" -Dprefix="$prefix" --libdir="$libdir" "$@"
    say "Building the $name"
    run_ninja "the $name" "$name-ninja.log" "$build/$name" \
        ${project_targets[@]+"${project_targets[@]}"}
    note "the $name is in build/$name ($((SECONDS - start)) s)"
}
