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
export CCACHE_BASEDIR=$build CCACHE_NOHASHDIR=1

# write_native_file [C CXX]: the compilers of what is configured from here on; GCC's, else
write_native_file() {
    native=$build/native${1:+-$1}.ini
    mkdir -p "$build"
    cat >"$native.new" <<END
[binaries]
c = ['ccache', '${1:-gcc}']
cpp = ['ccache', '${2:-g++}']
python3 = '$python'
llvm-config = '$(newest_llvm)'
END
    cmp -s "$native.new" "$native" || mv "$native.new" "$native"
    rm -f "$native.new"
}

mesa_options=(-Dgallium-drivers=swrast -Dvulkan-drivers= -Dosmesa=true -Dglx=dri -Degl=enabled
    -Dgbm=enabled -Dplatforms=x11 -Dllvm=enabled -Dshared-llvm=enabled -Dglvnd=enabled
    -Dgles1=disabled -Dgles2=enabled -Dvideo-codecs= -Dgallium-va=disabled -Dgallium-vdpau=disabled
    -Dvalgrind=disabled -Dlibunwind=disabled -Dlmsensors=disabled)
release_options=(--buildtype=release -Db_ndebug=true)
debug_options=(--buildtype=debugoptimized -Db_ndebug=false)

# Instrumented by Clang. The runtime comes with the program that loads the library (b_lundef), which
# may be a fuzzer: its coverage is in the same build, and costs little where nobody asks for it.
# vptr needs type information, which LLVM and what is derived from its classes are compiled without.
instrumented=(--buildtype=plain -Doptimization=1 -Db_ndebug=false -Db_lundef=false)
traceable='-g1 -fno-omit-frame-pointer'
sanitize_options=("${instrumented[@]}" '-Db_sanitize=address,undefined')
sanitize_args="$traceable -fno-sanitize=vptr"
fuzz_args="$traceable -fsanitize=fuzzer-no-link -fno-sanitize=vptr"
# Threads are the same whatever the window system.
thread_options=("${instrumented[@]}" -Db_sanitize=thread "-Dc_args=$traceable"
    "-Dcpp_args=$traceable" -Dglx=disabled -Degl=disabled -Dgbm=disabled -Dplatforms=
    -Dglvnd=disabled -Dgles2=disabled)

# configure WHAT SOURCE BUILD_DIR OPTION...: only when the options are not those of the last time.
# The stamp is written last, so a half-configured folder is made anew.
configure() {
    local what=$1 source=$2 dir=$3 stamp
    shift 3
    stamp=$(printf '%s\n' "${meson[*]}" "$(cat "$native")" "$@")
    [ "$(cat "$dir/.kbuffer-options" 2>/dev/null)" != "$stamp" ] || return 0
    say "Configuring $what"
    rm -rf "$dir"
    logged "configuring $what" "$(basename "$dir")-configure.log" \
        "${meson[@]}" setup --native-file "$native" "$@" "$dir" "$source"
    printf '%s\n' "$stamp" >"$dir/.kbuffer-options"
}

# install_mesa BUILD_DIR PREFIX: a prefix is whole when it holds the stamp
install_mesa() {
    rm -f "$2/.complete"
    logged "installing into $2" "$(basename "$2")-install.log" \
        "${meson[@]}" install -C "$1" --no-rebuild --only-changed
    date >"$2/.complete"
}

# build_mesa WHAT TREE BUILD_DIR PREFIX OPTION...
build_mesa() {
    local what=$1 source=$2 dir=$3 prefix=$4 start=$SECONDS
    shift 4
    configure "$what" "$source" "$dir" --prefix="$prefix" --libdir="$libdir" \
        "${mesa_options[@]}" "$@"
    say "Building $what"
    run_ninja "$what" "$(basename "$prefix")-ninja.log" "$dir"
    install_mesa "$dir" "$prefix"
    note "$what is in ${prefix#"$root"/} ($((SECONDS - start)) s)"
}

# The samples, tools and unit tests, against build/prefix
build_project() {
    build_project_in project prefix --buildtype=release
}

# The same against the sanitized Mesa, sanitized
build_sanitized_project() {
    build_project_in project-sanitize sanitize-prefix "${sanitize_options[@]}" \
        "-Dcpp_args=$sanitize_args"
}

build_project_in() { # NAME PREFIX_NAME OPTION...
    local name=$1 prefix=$build/$2 start=$SECONDS
    shift 2
    [ -f "$root/meson.build" ] || return 0
    export PKG_CONFIG_PATH=$prefix/$libdir/pkgconfig
    configure "the $name" "$root" "$build/$name" -Dprefix="$prefix" --libdir="$libdir" "$@"
    say "Building the $name"
    run_ninja "the $name" "$name-ninja.log" "$build/$name"
    note "the $name is in build/$name ($((SECONDS - start)) s)"
}
