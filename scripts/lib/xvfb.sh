# An X server without a screen. To be sourced after common.sh.
# shellcheck shell=bash

# start_xvfb LOG: an X server of its own for all that is started from here on; it ends with the
# command.
start_xvfb() {
    local display
    # Xvfb writes the number of the display that it has found free. If it were reset when its last
    # client leaves, the next one could not connect.
    exec 8< <(exec Xvfb -displayfd 1 -screen 0 1280x1024x24 -nolisten tcp -noreset 2>"$1")
    xvfb=$!
    trap 'kill "$xvfb" 2>/dev/null; cleanup' EXIT
    read -r -t 30 -u 8 display || die "Xvfb does not start" "See $1"
    export DISPLAY=:$display
}
