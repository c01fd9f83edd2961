# The patched Mesa for 64-bit ARM: a folder of Debian's packages for it, Mesa and programs compiled
# against them here, and running those by QEMU. To be sourced after common.sh, for building after
# mesa.sh.
# shellcheck shell=bash

arm64=$build/arm64
arm64_triplet=aarch64-linux-gnu
arm64_sysroot=$arm64/sysroot
arm64_prefix=$build/arm64-prefix
arm64_libdir=lib/$arm64_triplet

# Debian 12 has it in two packages, under two names.
arm64_emulator() {
    command -v qemu-aarch64 || command -v qemu-aarch64-static || die "there is no QEMU for arm64"
}

# arm64_packages VERSION_OF_LLVM: two lists of what Mesa and piglit need. The second is taken
# without what its packages depend on, which nothing uses here.
arm64_packages() {
    echo libc6-dev libegl-dev libgl-dev "libllvm$1" libpng-dev libstdc++6 libwaffle-dev \
        libzstd-dev zlib1g-dev
    echo "llvm-$1" "llvm-$1-dev"
}

# unpack_arm64 FOLDER PACKAGE...: into a folder with the links that Debian's installer makes
unpack_arm64() {
    local folder=$1 package link
    shift
    mkdir -p "$folder/usr/lib"
    ln -s usr/lib "$folder/lib"
    for package in "$@"; do
        # Mesa is linked with LLVM's shared library; the static ones are larger than all the rest.
        dpkg-deb --fsys-tarfile "$package" | tar -C "$folder" -x --keep-directory-symlink \
            --exclude='lib[LP]*.a' --exclude=./usr/share/doc --exclude=./usr/share/man || return
    done
    # Links that begin at the root would lead to the machine's own files.
    find "$folder" -type l -lname '/*' | while read -r link; do
        ln -sfn "$(realpath -sm --relative-to="$(dirname "$link")" "$folder$(readlink "$link")")" \
            "$link"
    done
}

# build/arm64/sysroot: the libraries and headers of the machine's own Debian for arm64, and its
# llvm-config of the version that is taken for this machine. Nothing is installed, and dpkg does not
# come to know another architecture.
prepare_arm64_sysroot() {
    local folder llvm packages stamp
    llvm=$("$(newest_llvm)" --version)
    mapfile -t packages < <(arm64_packages "${llvm%%.*}")
    stamp="Debian $distribution_suite: ${packages[*]}"
    [ "$(cat "$arm64_sysroot/.complete" 2>/dev/null)" != "$stamp" ] || return 0
    say "Fetching the packages of $distribution_suite for arm64 into build/arm64"
    make_temporary folder
    keep_telling "fetching"
    # shellcheck disable=SC2086 # lists
    {
        use_suite "$folder" deb "$distribution_suite" arm64 &&
            apt-get "${apt_options[@]}" -y -q --no-install-recommends --download-only install \
                ${packages[0]} &&
            (cd "$folder/cache/archives" && apt-get "${apt_options[@]}" -q download ${packages[1]})
    } >"$folder/fetch.log" 2>&1 ||
        die "the packages for arm64 cannot be fetched" \
            "$(grep -hE '^E:' "$folder"/*.log | tail -n 1 || true)" \
            "Check the network and run $command_name again."
    unpack_arm64 "$folder/sysroot" "$folder"/cache/archives/*.deb
    stop_telling
    echo "$stamp" >"$folder/sysroot/.complete"
    mkdir -p "$arm64"
    rm -rf "$arm64_sysroot"
    mv "$folder/sysroot" "$arm64_sysroot"
    note "$(du -sh "$arm64_sysroot" | cut -f1)"
}

# write_if_changed FILE: the standard input; what is configured by a file that is as it was stays
write_if_changed() {
    cat >"$1.new"
    cmp -s "$1.new" "$1" || mv "$1.new" "$1"
    rm -f "$1.new"
}

# Sets cross to the description for Meson, and writes the one for CMake, arm64.cmake. LLVM is asked
# for by its own program for arm64, which names the paths where it lies itself.
write_arm64_files() {
    local emulator llvm usr=$arm64_sysroot/usr
    emulator=$(arm64_emulator)
    llvm=$(find "$usr"/lib/llvm-*/bin/llvm-config)
    cross=$arm64/meson.ini
    write_if_changed "$arm64/llvm-config" <<END
#!/bin/sh
exec '$emulator' -L '$arm64_sysroot' '$llvm' "\$@"
END
    chmod +x "$arm64/llvm-config"
    write_if_changed "$cross" <<END
[binaries]
c = ['ccache', '$arm64_triplet-gcc', '--sysroot=$arm64_sysroot']
cpp = ['ccache', '$arm64_triplet-g++', '--sysroot=$arm64_sysroot']
ar = '$arm64_triplet-gcc-ar'
strip = '$arm64_triplet-strip'
pkg-config = 'pkg-config'
python3 = '$python'
llvm-config = '$arm64/llvm-config'
exe_wrapper = ['$emulator', '-L', '$arm64_sysroot']

[properties]
sys_root = '$arm64_sysroot'
pkg_config_libdir = '$usr/$arm64_libdir/pkgconfig'

[host_machine]
system = 'linux'
cpu_family = 'aarch64'
cpu = 'aarch64'
endian = 'little'
END
    # What is looked for is in the folder of packages, or was built.
    write_if_changed "$arm64/arm64.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_SYSROOT "$arm64_sysroot")
set(CMAKE_C_COMPILER $arm64_triplet-gcc)
set(CMAKE_CXX_COMPILER $arm64_triplet-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR "$emulator;-L;$arm64_sysroot")
set(CMAKE_FIND_ROOT_PATH "$build")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} "$usr/$arm64_libdir/pkgconfig:$usr/share/pkgconfig")
set(ENV{PKG_CONFIG_SYSROOT_DIR} "$arm64_sysroot")
END
}

# The patched Mesa in build/arm64-prefix. OSMesa is all that it has: both drivers, but no library of
# a window system, of which each would need its own for arm64.
build_arm64_mesa() {
    local cross libdir=$arm64_libdir
    prepare_arm64_sysroot
    write_arm64_files
    build_mesa "patched Mesa for arm64" "$tree" "$tree/build-arm64" "$arm64_prefix" \
        "${release_options[@]}" -Dplatforms= -Dglx=disabled -Degl=disabled -Dgbm=disabled \
        -Dglvnd=disabled -Dgles2=disabled -Dexpat=disabled -Dxmlconfig=disabled \
        -Dbuild-tests=false
}

# compile_arm64 PROGRAM SOURCE: a C++ program that draws by OSMesa, into build/arm64
compile_arm64() {
    local libraries=$arm64_prefix/$arm64_libdir
    logged "compiling $1 for arm64" "arm64-$1.log" \
        ccache "$arm64_triplet-g++" --sysroot="$arm64_sysroot" -std=c++20 -O2 \
        -I "$arm64_prefix/include" -o "$arm64/$1" "$2" -L "$libraries" -lOSMesa
}

# Sets run_arm64 to the command that runs a program of arm64 on the Mesa in PREFIX, and with the
# libraries in FOLDER rather than others. QEMU is told of them: in the environment they would be for
# itself, too. The processor is of the oldest kind that Debian is for, whose vectors are never
# longer than 128 bits; QEMU's own choice is another one with each release.
use_arm64() { # PREFIX [FOLDER]
    run_arm64=("$(arm64_emulator)" -cpu cortex-a57 -L "$arm64_sysroot"
        -E "LD_LIBRARY_PATH=${2:+$2:}$1/$arm64_libdir")
}
