# Fetching: the Mesa source and, where the distribution's is too old, Meson. To be sourced after
# packages.sh.
# shellcheck shell=bash

upstream=$root/mesa-patches/upstream.json
mesa_version=$(json "$upstream" version)
mesa_sha256=$(json "$upstream" sha256)
mesa_tarball=$build/download/mesa-$mesa_version.tar.xz
debian_suite=$(json "$upstream" debian_suite)
meson_needed=1.4

# The address of the machine's own Debian mirror, as apt itself understands its sources.
debian_mirror() {
    # shellcheck disable=SC2016 # apt-get's own variables
    apt-get indextargets --no-release-info --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
        awk '$1 !~ /-/ { print $2; exit }'
}

# use_suite FOLDER LINE_TYPE SUITE [ARCHITECTURE]: lets apt-get with "${apt_options[@]}" see one
# suite of the machine's mirror with lists of its own: the machine's sources and lists stay as they
# are. With an architecture it sees that one's packages, as on a machine that has none installed.
use_suite() {
    local mirror
    mirror=$(debian_mirror)
    [ "$distribution_id" = debian ] && [ -n "$mirror" ] || return 1
    mkdir -p "$1/lists/partial" "$1/cache/archives/partial"
    echo "$2 [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $3 main" \
        >"$1/sources.list"
    # The sandbox user of apt could not write into a user's folder.
    apt_options=(-o "Dir::Etc::SourceList=$1/sources.list" -o Dir::Etc::SourceParts=/dev/null
        -o "Dir::State::Lists=$1/lists" -o "Dir::Cache=$1/cache" -o APT::Sandbox::User=root
        -o APT::Update::Error-Mode=any -o Acquire::Retries=1)
    if [ -n "${4:-}" ]; then
        : >"$1/status"
        apt_options+=(-o "APT::Architecture=$4" -o "APT::Architectures::=$4"
            -o "Dir::State::status=$1/status")
    fi
    apt-get "${apt_options[@]}" -qq update >"$1/update.log" 2>&1
}

# source_file FOLDER SUITE PACKAGE PATTERN: fetches the file of a source package of Debian whose name
# is PATTERN (an expression), checks it against the suite's signed index, and sets source_file to it.
source_file() {
    local uri file hash
    use_suite "$1" deb-src "$2" || return 1
    # A line reads: 'URI' FILE SIZE SHA256:HASH
    read -r uri file _ hash < <(
        apt-get "${apt_options[@]}" source --print-uris -qq "$3" 2>/dev/null |
            awk -v name="^$4\$" '$2 ~ name { gsub("\047", ""); print }'
    ) || return 1
    note "from the source package of Debian $2: $file"
    source_file=$1/$file
    /usr/lib/apt/apt-helper "${apt_options[@]}" download-file "$uri" "$source_file" "$hash" \
        >"$1/fetch.log" 2>&1
}

# unpack_package FOLDER SUITE PACKAGE: into FOLDER/unpacked; nothing is installed.
unpack_package() {
    use_suite "$1" deb "$2" || return 1
    (cd "$1" && apt-get "${apt_options[@]}" -qq download "$3") >"$1/fetch.log" 2>&1 || return 1
    dpkg-deb -x "$1/$3"_*.deb "$1/unpacked"
}

mesa_from_distribution() { # FOLDER
    source_file "$1" "$debian_suite" mesa "mesa_${mesa_version}[.]orig[.]tar[.]xz" &&
        mv "$source_file" "$1/mesa.tar.xz"
}

# Sets debian_patches to the archive, in build/download, of what Debian adds to this release.
fetch_debian_patches() {
    local folder
    debian_patches=$(find "$(dirname "$mesa_tarball")/" -name "mesa_$mesa_version-*.debian.tar.*" |
        sort -V | tail -n 1)
    [ -z "$debian_patches" ] || return 0
    make_temporary folder
    source_file "$folder" "$debian_suite" mesa "mesa_$mesa_version-[^_]*[.]debian[.]tar[.].*" || return 1
    debian_patches=$(dirname "$mesa_tarball")/$(basename "$source_file")
    mv "$source_file" "$debian_patches"
}

mesa_from_upstream() { # FOLDER
    local url
    url=$(json "$upstream" url)
    note "from $url"
    curl -fsSL --retry 2 --connect-timeout 20 -o "$1/mesa.tar.xz" "$url" 2>"$1/fetch.log"
}

mesa_from_file() { # FOLDER
    note "from $KBUFFER_MESA_TARBALL"
    cp "$KBUFFER_MESA_TARBALL" "$1/mesa.tar.xz" 2>"$1/fetch.log"
}

# The tarball, verified, in build/download.
fetch_mesa() {
    local folder origin origins="mesa_from_distribution mesa_from_upstream" fetched wrong='' sum
    if [ -f "$mesa_tarball" ]; then
        [ "$(sha256_of "$mesa_tarball")" != "$mesa_sha256" ] || return 0
        warn "$mesa_tarball has a wrong checksum: fetching it again"
    fi
    say "Fetching the source of Mesa $mesa_version"
    [ -z "${KBUFFER_MESA_TARBALL:-}" ] || origins=mesa_from_file
    for origin in $origins; do
        make_temporary folder
        fetched=yes
        keep_telling "fetching"
        "$origin" "$folder" || fetched=''
        stop_telling
        [ -n "$fetched" ] || continue
        sum=$(sha256_of "$folder/mesa.tar.xz")
        if [ "$sum" = "$mesa_sha256" ]; then
            mkdir -p "$(dirname "$mesa_tarball")"
            mv "$folder/mesa.tar.xz" "$mesa_tarball"
            return 0
        fi
        wrong="$sum"
        note "this file's SHA-256 is $sum: refused"
    done
    [ -z "$wrong" ] ||
        die "the source of Mesa $mesa_version has a wrong checksum" \
            "expected $mesa_sha256" "found    $wrong" \
            "Set KBUFFER_MESA_TARBALL=FILE to a copy of mesa-$mesa_version.tar.xz that is sound."
    die "the source of Mesa $mesa_version cannot be fetched" \
        "Check the network and run $command_name again, or set KBUFFER_MESA_TARBALL=FILE to a" \
        "copy of mesa-$mesa_version.tar.xz that you have."
}

version_at_least() { # VERSION NEEDED
    printf '%s\n%s\n' "$2" "$1" | sort -V -C
}

# Sets meson=(COMMAND...). One that is installed if it is new enough, else the one of the
# distribution's backports, unpacked into build/tools: nothing is installed for it.
need_meson() {
    local candidate folder tool=$build/tools/meson
    while read -r candidate; do
        if version_at_least "$("$candidate" --version 2>/dev/null || echo 0)" "$meson_needed"; then
            meson=("$candidate")
            return 0
        fi
    done < <(type -ap meson || true)
    meson=("$python" "$tool/meson.py")
    [ ! -f "$tool/meson.py" ] || return 0
    say "Fetching Meson of $distribution_suite-backports into build/tools ($meson_needed is needed)"
    make_temporary folder
    unpack_package "$folder" "$distribution_suite-backports" meson ||
        die "Meson $meson_needed or newer is needed, and backports do not give it" \
            "Check the network and run $command_name again, or install Meson yourself."
    # A meson.py finds its modules beside it: no environment variable has to lead to them, not even
    # when a later `ninja` by hand runs it again.
    mkdir -p "$folder/meson" "$build/tools"
    mv "$folder/unpacked/usr/bin/meson" "$folder/meson/meson.py"
    mv "$folder/unpacked/usr/lib/python3/dist-packages/mesonbuild" "$folder/meson/"
    "$python" "$folder/meson/meson.py" --version >/dev/null
    rm -rf "$tool"
    mv "$folder/meson" "$tool"
}
