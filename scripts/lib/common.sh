# What every command shares: places, messages, logged steps, progress. To be sourced.
# shellcheck shell=bash

set -Eeuo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$root/build
logs=$build/log
command_name=scripts/$(basename "$(readlink -f "$0")")

# The distribution's tools, not what a user's environment put before them: the distribution's
# Python is the one that has the modules of the packages that packages.txt lists. A program of the
# user's gets back what is changed here.
declare -A users_environment=()
for variable in PATH GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE PYTHONHOME PYTHONPATH; do
    [ -z "${!variable+set}" ] || users_environment[$variable]=${!variable}
done
unset variable GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE PYTHONHOME PYTHONPATH
export PATH=/usr/bin:/bin:/usr/sbin:/sbin:$PATH
python=/usr/bin/python3

restore_users_environment() {
    local name
    for name in "${!users_environment[@]}"; do
        export "$name=${users_environment[$name]}"
    done
}

# A variable of the user, so that a shared machine can be spared.
jobs=${KBUFFER_JOBS:-$(nproc)}

say() { printf '==> %s\n' "$*"; }
note() { printf '    %s\n' "$*"; }
warn() { printf '%s: warning: %s\n' "$command_name" "$*" >&2; }

# The one clear message: what went wrong in the first line, what to do about it in the others.
complain() {
    printf '%s: error: %s\n' "$command_name" "$1" >&2
    shift
    [ $# -eq 0 ] || printf '    %s\n' "$@" >&2
}

die() {
    complain "$@"
    exit 1
}

usage_error() {
    printf '%s: %s (see %s --help)\n' "$command_name" "$1" "$command_name" >&2
    exit 2
}

# print_help: the comment at the head of the command is its help.
print_help() {
    awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
}

positive_number() { # OPTION VALUE
    [[ $2 =~ ^[1-9][0-9]{0,3}$ ]] || usage_error "$1 takes a number from 1 to 9999, not '$2'"
}

on_unexpected_error() {
    printf '%s: error: stopped at line %s of %s: %s\n' \
        "$command_name" "$1" "${2#"$root"/}" "$3" >&2
}
trap 'on_unexpected_error "$LINENO" "${BASH_SOURCE[0]}" "$BASH_COMMAND"' ERR

# Everything temporary is made in build/ (the same file system as what it is renamed to), and goes
# when the command ends in whatever way.
temporaries=()
cleanup() {
    local t
    for t in ${temporaries[@]+"${temporaries[@]}"}; do rm -rf "$t"; done
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

make_temporary() { # VARIABLE: a new folder
    local -n made=$1
    mkdir -p "$build"
    made=$(mktemp -d "$build/tmp.XXXXXX")
    chmod 755 "$made"
    temporaries+=("$made")
}

# json FILE KEY...: one value of a JSON file
json() {
    "$python" - "$@" <<'END'
import json, sys
value = json.load(open(sys.argv[1]))
for key in sys.argv[2:]:
    value = value[key]
print(value)
END
}

sha256_of() { sha256sum "$1" | cut -d' ' -f1; }

# Held until the command ends: two commands never write into build/ at the same time.
lock_build() {
    mkdir -p "$build"
    exec 9>"$build/.lock"
    if ! flock -n 9; then
        say "Another command is building here: waiting for it to end"
        flock 9
    fi
}

need_space() { # GB WHAT
    local need=${KBUFFER_NEED_GB:-$1} free
    mkdir -p "$build"
    free=$(df --output=avail -B1M "$build" | tail -n 1)
    [ "$free" -ge $((need * 1024)) ] ||
        die "not enough disk space: $2 needs $need GB, $((free / 1024)) GB are free in $build" \
            "Free some space, or clone the project onto a larger disk, and run $command_name again."
}

die_with_log() { # WHAT LOG
    if grep -q 'No space left on device' "$2"; then
        die "$1 failed: the disk is full" \
            "Free some space and run $command_name again: it goes on where it stopped."
    fi
    printf '%s\n' '---' >&2
    if grep -q '^FAILED:' "$2"; then
        grep -B 15 -A 30 -m 1 '^FAILED:' "$2" >&2
    else
        tail -n 30 "$2" >&2
    fi
    printf '%s\n' '---' >&2
    die "$1 failed" "The whole output is in $2"
}

logged() { # WHAT LOG COMMAND...: quiet unless it fails
    local what=$1 log=$logs/$2
    shift 2
    mkdir -p "$logs"
    "$@" >"$log" 2>&1 9>&- || die_with_log "$what" "$log"
}

# Reads ninja's output: one line that moves on a terminal, else a line every tenth of the way, but
# not within two seconds of the last, and after each half minute: a log stays readable and still
# shows that something happens.
show_progress() { # WHAT
    local line step total shown=-1 start=$SECONDS last=$SECONDS width terminal=
    [ -t 1 ] && terminal=yes
    width=$(tput cols 2>/dev/null || echo 80)
    while IFS= read -r line; do
        [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\ (.*) ]] || continue
        step=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
        if [ -n "$terminal" ]; then
            line="    $1: $step/$total, $((SECONDS - start)) s  ${BASH_REMATCH[3]}"
            printf '\r\033[K%s' "${line:0:$((width - 1))}"
        elif { [ $((step * 10 / total)) -gt $shown ] && [ $((SECONDS - last)) -ge 2 ]; } ||
            [ $((SECONDS - last)) -ge 30 ] || [ "$step" -eq "$total" ]; then
            shown=$((step * 10 / total)) last=$SECONDS
            note "$1: $step/$total, $((SECONDS - start)) s"
        fi
    done
    [ -z "$terminal" ] || printf '\r\033[K'
}

run_ninja() { # WHAT LOG BUILD_DIR [TARGET...]
    local what=$1 log=$logs/$2 dir=$3
    shift 3
    mkdir -p "$logs"
    NINJA_STATUS='[%f/%t] ' ninja -C "$dir" -j "$jobs" "$@" 2>&1 9>&- | tee "$log" |
        show_progress "$what" || die_with_log "$what" "$log"
}
