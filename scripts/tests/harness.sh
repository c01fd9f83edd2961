# A small harness for tests of the commands. Each test is a function test_*, run in a shell of its
# own with a copy of the project in $project, a small stand-in for the Mesa release, and an empty
# build/. To be sourced.
# shellcheck shell=bash

set -euo pipefail
source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
passed=0 failed=0 skipped=0

# Neither apt nor curl nor npm reaches anything.
offline=(http_proxy=http://127.0.0.1:9 https_proxy=http://127.0.0.1:9
    KBUFFER_NPM_REGISTRY=http://127.0.0.1:9/ npm_config_registry=http://127.0.0.1:9/
    npm_config_fetch_retries=0)

# A release of three files, whose checksum the copy of the project names as Mesa's
make_release() { # FOLDER
    mkdir -p "$1/mesa-0/src"
    echo "project('mesa', 'c')" >"$1/mesa-0/meson.build"
    printf 'one\ntwo\nthree\nfour\nfive\nsix\nseven\n' >"$1/mesa-0/src/a.c"
    echo 'b' >"$1/mesa-0/src/b.c"
    tar -C "$1" -cJf "$1/release.tar.xz" mesa-0
}

make_project() {
    mkdir -p "$project"
    cp -r "$source_root/scripts" "$source_root/mesa-patches" "$project/"
    rm -rf "$project"/mesa-patches/{overlay,hooks}
    make_release "$work"
    cat >"$project/mesa-patches/upstream.json" <<END
{"name": "mesa", "version": "0", "debian_suite": "trixie", "url": "http://127.0.0.1:9/none",
 "sha256": "$(sha256sum <"$work/release.tar.xz" | cut -d' ' -f1)"}
END
    printf 'Acquire::http::Proxy "http://127.0.0.1:9";\nAcquire::https::Proxy "http://127.0.0.1:9";\n' \
        >"$work/apt.conf"
    export KBUFFER_MESA_TARBALL=$work/release.tar.xz KBUFFER_SKIP_PACKAGES=1 KBUFFER_NEED_GB=0
    unset KBUFFER_DATA_DIR
}

# run STATUS COMMAND...: runs it in the copy; what it prints is in $output
run() {
    local expected=$1 status=0
    shift
    output=$(cd "$project" && "$@" 2>&1 </dev/null) || status=$?
    if [ $status -ne "$expected" ]; then
        printf 'exit status %s instead of %s: %s\n%s\n' "$status" "$expected" "$*" "$output"
        exit 1
    fi
}

prints() { # TEXT
    [[ $output == *"$1"* ]] || {
        printf 'this does not say "%s":\n%s\n' "$1" "$output"
        exit 1
    }
}

lines() { # NUMBER
    [ "$(wc -l <<<"$output")" -eq "$1" ] || {
        printf 'not %s lines:\n%s\n' "$1" "$output"
        exit 1
    }
}

absent() { # FILE...
    local file
    for file in "$@"; do
        [ ! -e "$project/$file" ] || {
            printf '%s is there: %s\n' "$file" "$(ls "$project/$file")"
            exit 1
        }
    done
}

no_temporaries() {
    [ -z "$(find "$project/build" -maxdepth 1 -name 'tmp.*')" ] || {
        echo "temporary folders are left: $(ls -d "$project"/build/tmp.*)"
        exit 1
    }
}

skip() {
    echo "skipped: $1"
    exit 77
}

need_mounts() {
    [ "$EUID" -eq 0 ] || skip "needs root"
    unshare --mount true 2>/dev/null || skip "needs root that may mount"
}

run_test() { # NAME
    local work project status=0 text
    work=$(mktemp -d)
    # Also for tests that run as another user
    chmod 755 "$work"
    project=$work/project
    # Not in a condition, where a shell would not stop at the first command that fails.
    set +e
    text=$(
        set -eE
        exec 2>&1
        trap 'echo "line $LINENO of ${BASH_SOURCE[0]##*/} failed: $BASH_COMMAND"' ERR
        make_project
        "$1"
    )
    status=$?
    set -e
    case $status in
    0)
        passed=$((passed + 1))
        echo "ok ${1#test_}"
        ;;
    77)
        skipped=$((skipped + 1))
        echo "ok ${1#test_} # ${text##*$'\n'}"
        ;;
    *)
        failed=$((failed + 1))
        echo "not ok ${1#test_}"
        printf '%s\n' "${text//$'\n'/$'\n'    }" | sed 's/^/    /'
        ;;
    esac
    rm -rf "$work"
}
