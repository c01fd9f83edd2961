# shellcheck shell=bash
# Missing packages and unsupported machines

test_without_root_the_command_is_told() {
    unset KBUFFER_SKIP_PACKAGES
    echo 'build no-such-package-of-ours' >"$project/scripts/packages.txt"
    mkdir "$project/build"
    chmod 777 "$project/build"
    local as_nobody=()
    [ "$EUID" -ne 0 ] || as_nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
    run 1 "${as_nobody[@]}" scripts/build
    prints "needs root"
    prints "apt-get install -y --no-install-recommends no-such-package-of-ours"
    absent build/mesa build/download
}

test_another_distribution() {
    need_mounts
    unset KBUFFER_SKIP_PACKAGES
    echo 'build no-such-package-of-ours' >"$project/scripts/packages.txt"
    run 1 unshare --mount sh -c 'mount --bind /dev/null /usr/bin/dpkg-query && scripts/build'
    prints "is not supported: Debian 12 and 13 are"
    prints "no-such-package-of-ours"
}

test_suites_choose_packages() {
    printf 'build all\nbuild old bookworm\nbuild new !bookworm\ntest more\n' \
        >"$project/scripts/packages.txt"
    local lines='. scripts/lib/common.sh; . scripts/lib/packages.sh;'
    run 0 bash -c "$lines distribution_suite=bookworm; package_lines build | tr '\n' ' '"
    prints "all old "
    run 0 bash -c "$lines distribution_suite=trixie; package_lines build test | tr '\n' ' '"
    prints "all new more "
}
