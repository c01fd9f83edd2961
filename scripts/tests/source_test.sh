# shellcheck shell=bash
# The source of Mesa: fetching, checksums, full disks, interrupted work. `scripts/patch export`
# needs the source and nothing else.

test_source_from_a_file() {
    run 0 scripts/patch export "$work/series"
    [ -f "$project/build/mesa/src/a.c" ]
    no_temporaries
}

test_wrong_checksum() {
    echo more >>"$work/release.tar.xz"
    run 1 scripts/patch export "$work/series"
    prints "wrong checksum"
    prints "$(sha256sum <"$work/release.tar.xz" | cut -d' ' -f1)"
    absent build/mesa build/download
    no_temporaries
}

test_damaged_download_is_fetched_again() {
    mkdir -p "$project/build/download"
    echo damaged >"$project/build/download/mesa-0.tar.xz"
    run 0 scripts/patch export "$work/series"
    prints "fetching it again"
}

test_no_network() {
    unset KBUFFER_MESA_TARBALL
    run 1 env "${offline[@]}" APT_CONFIG="$work/apt.conf" scripts/patch export "$work/series"
    prints "cannot be fetched"
    prints "KBUFFER_MESA_TARBALL"
    absent build/mesa
    no_temporaries
}

test_too_little_space() {
    run 1 env KBUFFER_NEED_GB=1000000 scripts/build
    prints "not enough disk space"
    absent build/mesa
}

test_full_disk() {
    need_mounts
    # Large enough for the tarball, too small for what is in it
    head -c 3000000 /dev/zero >"$work/mesa-0/src/large.c"
    tar -C "$work" -cJf "$work/release.tar.xz" mesa-0
    sed -i "s/\"sha256\": \".*\"/\"sha256\": \"$(sha256sum <"$work/release.tar.xz" | cut -d' ' -f1)\"/" \
        "$project/mesa-patches/upstream.json"
    mkdir "$project/build"
    run 1 unshare --mount sh -c "mount -t tmpfs -o size=2m none build && scripts/patch export '$work/s';
        status=\$?; ls -d build/mesa && echo half-built; exit \$status"
    prints "disk is full"
    [[ $output != *half-built* ]]
}

test_interrupted_unpacking_is_resumed() {
    # git is the step after tar: stop there
    mkdir "$work/bin"
    printf '#!/bin/sh\ntouch %q\nsleep 60\n' "$work/stopped" >"$work/bin/git"
    chmod +x "$work/bin/git"
    sed "s|^export PATH=|export PATH=$work/bin:|" "$project/scripts/lib/common.sh" >"$work/common.sh"
    cp "$project/scripts/lib/common.sh" "$work/sound.sh"
    cp "$work/common.sh" "$project/scripts/lib/common.sh"
    (cd "$project" && exec setsid scripts/patch export "$work/series" >/dev/null 2>&1) &
    local group=$! turn
    for turn in $(seq 100); do
        [ ! -e "$work/stopped" ] || break
        sleep 0.1
    done
    [ -e "$work/stopped" ]
    kill -TERM -- -$group
    wait $group || true
    absent build/mesa
    no_temporaries
    cp "$work/sound.sh" "$project/scripts/lib/common.sh"
    run 0 scripts/patch export "$work/series"
}

# Where Meson is too old and cannot be fetched, that is the one error.
test_no_meson() {
    run 1 env "${offline[@]}" APT_CONFIG="$work/apt.conf" bash -c '. scripts/lib/common.sh
        . scripts/lib/packages.sh; . scripts/lib/source.sh; meson_needed=99; need_meson' scripts/build
    prints "Meson 99 or newer is needed"
    [[ $output != *"stopped at line"* ]]
}
