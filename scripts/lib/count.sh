# Adding up what several runs of tests count. To be sourced after common.sh.
# shellcheck shell=bash

passed=0 failed=0 skipped=0

# count LOG COMMAND...: run it, and add to the totals what it says last:
# `[...: ]N passed, N failed, N skipped`
count() {
    local log=$1 last
    shift
    "$@" 2>"$log.err" | tee "$log" || true
    last=$(tail -n 1 "$log")
    [[ $last =~ ([0-9]+)\ passed,\ ([0-9]+)\ failed,\ ([0-9]+)\ skipped$ ]] ||
        die "'$*' does not say how it went" "See $log and $log.err"
    passed=$((passed + BASH_REMATCH[1])) failed=$((failed + BASH_REMATCH[2]))
    skipped=$((skipped + BASH_REMATCH[3]))
}

# Prints the totals, which is what a suite says last; fails if something failed.
print_totals() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ]
}
