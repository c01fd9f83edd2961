# Configuring, building and installing Mesa and the project. To be sourced after tree.sh.
# shellcheck shell=bash

libdir=lib/$(gcc -print-multiarch 2>/dev/null || true)
native=$build/native.ini

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

write_native_file() {
    mkdir -p "$build"
    cat >"$native.new" <<END
[binaries]
c = ['ccache', 'gcc']
cpp = ['ccache', 'g++']
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
    local start=$SECONDS
    [ -f "$root/meson.build" ] || return 0
    export PKG_CONFIG_PATH=$build/prefix/$libdir/pkgconfig
    configure "the project" "$root" "$build/project" --buildtype=release \
        -Dprefix="$build/prefix" --libdir="$libdir"
    say "Building the project"
    run_ninja "the project" project-ninja.log "$build/project"
    note "the project is in build/project ($((SECONDS - start)) s)"
}
