# shellcheck shell=bash
# The folder of packages for 64-bit ARM.

arm64_commands='. scripts/lib/common.sh; . scripts/lib/packages.sh; . scripts/lib/source.sh
    . scripts/lib/tree.sh; . scripts/lib/mesa.sh; . scripts/lib/arm64.sh'

# make_package: a package for another architecture, with a link that begins at the root, in $work
make_package() {
    mkdir -p "$work/package/DEBIAN" "$work/package"/{lib/a,usr/lib/b,usr/share/doc/c}
    printf '%s\n' 'Package: c' 'Version: 1' 'Architecture: arm64' 'Maintainer: nobody <n@localhost>' \
        'Description: none' >"$work/package/DEBIAN/control"
    echo library >"$work/package/lib/a/library"
    ln -s /lib/a/library "$work/package/usr/lib/b/link"
    echo text >"$work/package/usr/share/doc/c/copyright"
    dpkg-deb -b "$work/package" "$work/c.deb" >/dev/null
}

test_arm64_links_stay_in_the_folder() {
    make_package
    run 0 bash -c "$arm64_commands; unpack_arm64 build/sysroot '$work/c.deb'
        readlink build/sysroot/usr/lib/b/link; cat build/sysroot/usr/lib/b/link" scripts/build
    prints "../../../lib/a/library"
    prints $'\nlibrary'
    absent build/sysroot/usr/share/doc
}

test_arm64_packages_cannot_be_fetched() {
    run 1 env "${offline[@]}" APT_CONFIG="$work/apt.conf" bash -c "$arm64_commands
        newest_llvm() { command -v version; }; version() { echo 19.1; }
        prepare_arm64_sysroot" scripts/build
    prints "the packages for arm64 cannot be fetched"
    prints "E: "
    lines 4
    absent build/arm64
    no_temporaries
}
