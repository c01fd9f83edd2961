# The distribution's packages: which are missing, and their installation. To be sourced after common.sh.
# shellcheck shell=bash

# What apt, dpkg and git say is read here; and ccache keeps the results of each language apart.
export LANG=C.UTF-8
unset LANGUAGE "${!LC_@}"

distribution_id=unknown
distribution_suite=unknown
distribution_name=unknown
if [ -r /etc/os-release ]; then
    distribution_id=$(. /etc/os-release && echo "${ID:-unknown}")
    distribution_suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
    distribution_name=$(. /etc/os-release && echo "${PRETTY_NAME:-$ID}")
fi

# package_lines SET...: the lines of packages.txt that count here, "PACKAGE|PACKAGE"
package_lines() {
    awk -v sets=" $* " -v suite="$distribution_suite" '
        /^[[:space:]]*(#|$)/ || !index(sets, " " $1 " ") { next }
        { wanted = NF == 2
          for (i = 3; i <= NF; i++)
              if ($i == suite || (sub(/^!/, "", $i) && $i != suite)) wanted = 1
          if (wanted) print $2 }' "$root/scripts/packages.txt"
}

# missing_packages SET...: of each line that has none of its packages installed, the first one that
# the distribution offers
missing_packages() {
    local line package choice
    local -A installed=()
    while read -r package; do
        installed[$package]=1
    done < <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
    while read -r line; do
        choice=
        for package in ${line//|/ }; do
            [ -z "${installed[$package]:-}" ] || continue 2
            if [ -z "$choice" ] && apt-cache show "$package" >/dev/null 2>&1; then
                choice=$package
            fi
        done
        echo "${choice:-${line%%|*}}"
    done < <(package_lines "$@")
}

# apt's machine-readable progress (Status-Fd), in the form of ninja's
apt_progress() {
    sed -nu -E 's/^(dl|pm)status:[^:]*:([0-9]+)[^:]*:(.*)/[\2\/100] \3/p' | show_progress "$1"
}

apt_install() { # as root, or through sudo
    local sudo=() log=$logs/packages.log folder wanted reader
    [ "$EUID" -eq 0 ] || sudo=(sudo)
    mkdir -p "$logs"
    # Lists that cannot be renewed are no error yet: the packages may be had all the same.
    "${sudo[@]}" apt-get -q update >"$log" 2>&1 || warn "apt-get update failed: $(tail -n 1 "$log")"
    mapfile -t wanted < <(missing_packages "$@")
    # An interrupted installation is resumed by this.
    "${sudo[@]}" dpkg --configure -a >>"$log" 2>&1 || true
    # The progress needs a pipe of its own (apt makes it non-blocking, which breaks programs that
    # print to it) with a name (sudo closes all other files).
    make_temporary folder
    mkfifo "$folder/progress"
    apt_progress "packages" <"$folder/progress" 9>&- &
    reader=$!
    # shellcheck disable=SC2016 # expanded by the inner shell
    "${sudo[@]}" sh -c 'DEBIAN_FRONTEND=noninteractive exec apt-get install -y -q \
        --no-install-recommends -o APT::Status-Fd=3 -o Dpkg::Use-Pty=0 \
        -o DPkg::Lock::Timeout=300 "$@" 3>"$0"' \
        "$folder/progress" "${wanted[@]}" >>"$log" 2>&1 9>&- </dev/null || true
    wait "$reader" || true
}

may_become_root() {
    [ "$EUID" -eq 0 ] && return 0
    command -v sudo >/dev/null || return 1
    [ -t 0 ] || sudo -n true 2>/dev/null
}

# need_packages SET...: installs what is missing of these sets of packages.txt
need_packages() {
    [ -z "${KBUFFER_SKIP_PACKAGES:-}" ] || return 0
    local missing answer
    if [ ! -x /usr/bin/dpkg-query ] || [ ! -x /usr/bin/apt-get ]; then
        die "$distribution_name is not supported: Debian 12 and 13 are" \
            "Install what these Debian packages hold, then set KBUFFER_SKIP_PACKAGES=1:" \
            "$(package_lines "$@" | tr '\n' ' ')"
    fi
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -gt 0 ] || return 0
    local by_hand="apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    case $distribution_suite in
    bookworm | trixie) ;;
    *) warn "$distribution_name is not tested: Debian 12 and 13 are; trying with their package names" ;;
    esac
    may_become_root ||
        die "${#missing[@]} packages are missing, and installing them needs root" \
            "Run this as root, then $command_name again:" "$by_hand"
    say "Installing ${#missing[@]} packages that are missing, by apt-get:"
    printf '%s\n' "${missing[*]}" | fold -s -w 90 | sed 's/^/    /'
    if [ -t 0 ] && [ -t 1 ]; then
        read -r -p "    Go on? [Y/n] " answer
        [[ $answer =~ ^([Yy].*)?$ ]] || die "nothing was installed" "By hand, as root: $by_hand"
    fi
    apt_install "$@"
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -eq 0 ] || package_failure "${missing[@]}"
}

package_failure() { # PACKAGE...
    local log=$logs/packages.log package unknown=()
    for package in "$@"; do
        apt-cache show "$package" >/dev/null 2>&1 || unknown+=("$package")
    done
    grep -E '^(E|W|Err)[:[]' "$log" | sort -u | head -n 8 >&2 || true
    if grep -qiE 'No space left on device|not have enough free space' "$log"; then
        die "the disk is full: $# packages were not installed" \
            "Free some space and run $command_name again."
    elif grep -qE 'Temporary failure resolving|Could not (resolve|connect)|Failed to fetch|Unable to connect' "$log"; then
        die "the distribution's mirror cannot be reached: $# packages were not installed" \
            "Check the network (and apt's proxy settings), then run $command_name again." \
            "The whole output is in $log"
    elif [ ${#unknown[@]} -gt 0 ]; then
        die "$distribution_name has no package ${unknown[*]}" \
            "Debian 12 and 13 are supported. Install what these Debian packages hold by other" \
            "means, then set KBUFFER_SKIP_PACKAGES=1."
    fi
    die "$# packages were not installed: $*" "The whole output is in $log"
}
