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
    stop_telling
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
    stop_telling
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
    local what=$1 log=$logs/$2 status=0
    shift 2
    mkdir -p "$logs"
    keep_telling "$what"
    "$@" >"$log" 2>&1 9>&- || status=$?
    stop_telling
    [ "$status" -eq 0 ] || die_with_log "$what" "$log"
}

# What takes long shows that it goes on: on a terminal by one line that moves, else by a line now
# and then, so that nobody waits for 15 seconds without one and a log stays readable.
telling_interval=10
[ ! -t 1 ] || telling_interval=1

# tell TEXT: the line
tell() {
    local width
    if [ -t 1 ]; then
        width=$(tput cols 2>/dev/null || echo 80)
        printf '\r\033[K    %s' "${1:0:$((width - 5))}"
    else
        note "$1"
    fi
}

# Takes the moving line away again.
end_telling() { [ ! -t 1 ] || printf '\r\033[K'; }

# keep_telling WHAT: until stop_telling, or until the command ends
keep_telling() {
    local start=$SECONDS
    stop_telling
    # The sleep may outlive the loop, but must not hold the output open.
    while sleep "$telling_interval" >/dev/null 2>&1; do
        tell "$1: $((SECONDS - start)) s"
    done 9>&- &
    teller=$!
}

teller=''
stop_telling() {
    [ -n "$teller" ] || return 0
    kill "$teller" 2>/dev/null || true
    wait "$teller" 2>/dev/null || true
    teller=''
    end_telling
}

# next_line: reads into `line`, as `read` does; waits for at most a second, then leaves it empty
next_line() {
    local status=0
    IFS= read -r -t 1 line || status=$?
    line=$unfinished_line$line unfinished_line=''
    if [ "$status" -gt 128 ]; then
        unfinished_line=$line line=''
        return 0
    fi
    [ "$status" -eq 0 ] || [ -n "$line" ]
}
unfinished_line=''

# Reads ninja's output, and tells of it at each tenth of the way, but not twice within five seconds.
show_progress() { # WHAT
    local line text='' step=0 total=0 shown=0 start=$SECONDS last=$SECONDS
    while next_line; do
        if [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\ (.*) ]]; then
            step=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]} text=${BASH_REMATCH[3]}
        fi
        if [ -t 1 ]; then
            [ "$total" -eq 0 ] || tell "$1: $step/$total, $((SECONDS - start)) s  $text"
        elif [ $((SECONDS - last)) -ge "$telling_interval" ] ||
            { [ "$total" -gt 0 ] && [ $((step * 10 / total)) -gt $shown ] &&
                { [ $((SECONDS - last)) -ge 5 ] || [ "$step" -eq "$total" ]; }; }; then
            [ "$total" -eq 0 ] || shown=$((step * 10 / total))
            last=$SECONDS
            tell "$1: $([ "$total" -eq 0 ] || echo "$step/$total, ")$((SECONDS - start)) s"
        fi
    done
    end_telling
}

# Reads the output of tests: its last line moves on a terminal, else it is shown now and then; what is
# not as it should be is shown always.
show_lines() {
    local line text='' start=$SECONDS last=$SECONDS
    while next_line; do
        if [[ $line =~ (not ok|FAIL|[Ff]ailed|error|skip) && ! $line =~ \ passed,\ 0\ failed ]]; then
            end_telling
            note "$line"
            last=$SECONDS
        elif [ -n "$line" ]; then
            text=$line
            [ ! -t 1 ] || tell "$text"
        fi
        if [ ! -t 1 ] && [ $((SECONDS - last)) -ge "$telling_interval" ]; then
            tell "$((SECONDS - start)) s${text:+: $text}"
            last=$SECONDS
        fi
    done
    end_telling
}

run_ninja() { # WHAT LOG BUILD_DIR [TARGET...]
    local what=$1 log=$logs/$2 dir=$3
    shift 3
    mkdir -p "$logs"
    NINJA_STATUS='[%f/%t] ' ninja -C "$dir" -j "$jobs" "$@" 2>&1 9>&- | tee "$log" |
        show_progress "$what" || die_with_log "$what" "$log"
}
