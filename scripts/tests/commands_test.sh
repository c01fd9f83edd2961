# shellcheck shell=bash
# Command lines: help, bad options, no half done work after them.

commands=(bench build check-fresh convert-grid demo fetch-data fuzz patch run test)

test_every_command_has_help() {
    local command
    for command in "${commands[@]}"; do
        run 0 "scripts/$command" --help
        prints "Usage: scripts/$command"
    done
    absent build
}

test_unknown_options_are_one_line() {
    local command
    for command in "${commands[@]}"; do
        run 2 "scripts/$command" --no-such-option
        prints "no-such-option"
        lines 1
    done
    absent build
}

test_jobs_must_be_a_number() {
    local value
    for value in 0 -1 two 99999 ''; do
        run 2 scripts/build --jobs "$value"
        lines 1
    done
}

test_build_takes_known_samples() {
    local names
    for names in elephant transparency,,peeling , ''; do
        run 2 scripts/build --samples "$names"
        prints "transparency peeling volume isosurface"
        lines 1
    done
    absent build
}

# told_of LINE...: what `show_progress` or `show_lines` makes of them, told of after two seconds
# without a word
told_of() {
    local reader=$1
    shift
    run 0 bash -c '. scripts/lib/common.sh; telling_interval=2
        reader=$1; shift; { printf "%s\n" "$@"; sleep 3; } | $reader' scripts/build "$reader" "$@"
}

test_long_work_is_told_of_in_silence() {
    told_of "show_progress Mesa" "[1/9] Compiling"
    prints "Mesa: 1/9, "
    told_of "show_lines" "ok 1"
    prints "s: ok 1"
    run 0 bash -c '. scripts/lib/common.sh; telling_interval=1
        keep_telling unpacking; sleep 3; stop_telling; sleep 3; echo end' scripts/build
    prints "unpacking: "
    [ "$(tail -n 1 <<<"$output")" = end ] && [ "$(wc -l <<<"$output")" -le 4 ]
}

test_progress_is_no_line_for_each_step() {
    local steps=()
    mapfile -t steps < <(seq -f '[%.0f/300] Compiling' 300)
    told_of "show_progress Mesa" "${steps[@]}"
    prints "Mesa: 300/300, "
    [ "$(wc -l <<<"$output")" -le 3 ]
    mapfile -t steps < <(seq -f 'ok %.0f' 300)
    told_of show_lines "${steps[@]:0:150}" "not ok 0" "${steps[@]:150}"
    prints "not ok 0"
    [ "$(wc -l <<<"$output")" -le 3 ]
}

# What was started stops telling when the command ends in the middle of it, and holds no output open.
test_a_failure_ends_what_was_told() {
    run 1 bash -c '. scripts/lib/common.sh; telling_interval=60
        keep_telling unpacking; die "no space"' scripts/build
    prints "no space"
    lines 1
}

test_unknown_suites() {
    run 2 scripts/test --only none
    run 2 scripts/check-fresh woody
    prints bookworm
}

test_unknown_studies() {
    local studies
    for studies in none transparency,none '' ,; do
        run 2 scripts/bench --studies "$studies"
        prints "--studies takes transparency, volume or both"
        lines 1
    done
    absent build
}

test_bench_writes_its_report_beside_a_file() {
    local out
    for out in '' - /dev/stdout results.png; do
        run 2 scripts/bench --out "$out"
        prints "--out takes a .json file"
        lines 1
    done
    absent build
}

test_fuzz_takes_known_targets_and_drivers() {
    run 2 scripts/fuzz textures
    prints textures
    run 2 scripts/fuzz draws --driver zink
    run 2 scripts/fuzz draws --seconds soon
    run 2 scripts/fuzz --print
    absent build
}

test_patch_needs_an_action() {
    run 2 scripts/patch
    run 2 scripts/patch export
    run 2 scripts/patch refresh now
}

test_run_needs_a_command() {
    run 2 scripts/run
}

test_run_without_a_build() {
    run 1 scripts/run true
    prints "scripts/build"
    run 1 scripts/run --stock true
    prints "scripts/build --stock"
}

# A prefix in which there is no Mesa: if any driver answers, it is another one.
test_run_refuses_another_driver() {
    mkdir -p "$project/build/prefix/lib/x"
    touch "$project/build/prefix/.complete" "$project/build/prefix/lib/x/libOSMesa.so"
    run 1 scripts/run touch "$work/started"
    prints "driver"
    [ ! -e "$work/started" ]
}

test_check_fresh_needs_root() {
    [ "$EUID" -eq 0 ] || skip "is run as root to become another user"
    run 1 setpriv --reuid=65534 --regid=65534 --clear-groups scripts/check-fresh bookworm
    prints "needs root"
}
