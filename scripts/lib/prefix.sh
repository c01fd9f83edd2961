# Running programs on a Mesa in build/. To be sourced after common.sh.
# shellcheck shell=bash

# use_prefix NAME: lets every program that is started from here use the Mesa in build/NAME, be it
# linked with the vendor-neutral libraries or with libOSMesa.
use_prefix() {
    local prefix=$build/$1 option='' file
    case $1 in
    stock-prefix | debug-prefix | sanitize-prefix) option=" --${1%-prefix}" ;;
    thread-prefix) option=" --sanitize=thread" ;;
    esac
    [ -f "$prefix/.complete" ] ||
        die "there is no built Mesa in build/$1" "Make it: scripts/build$option"
    prefix_libdir=$(dirname "$(echo "$prefix"/lib/*/libOSMesa.so)")
    # By these names others look for them.
    prefix_names=(libGLX_mesa.so.0 libOSMesa.so.8)
    for file in "$prefix_libdir"/libgallium-*.so; do prefix_names+=("${file##*/}"); done
    export LD_LIBRARY_PATH=$prefix_libdir${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    export __GLX_VENDOR_LIBRARY_NAME=mesa
    export __EGL_VENDOR_LIBRARY_FILENAMES=$prefix/share/glvnd/egl_vendor.d/50_mesa.json
    # Libraries that are named with their folder are found wherever a program looks for others.
    grep -q "\"$prefix_libdir/" "$__EGL_VENDOR_LIBRARY_FILENAMES" || prefix_names+=(libEGL_mesa.so.0)
    # Where there is a GPU, its driver would be looked for in the prefix, in vain.
    export LIBGL_ALWAYS_SOFTWARE=${LIBGL_ALWAYS_SOFTWARE:-true}
}

# The driver that answers now: lines of "name: value" (see probe.py). With an argument, what the
# user's overrides say of its version and extensions is left out of account.
probe_driver() { # [as-built]
    env ${1:+-u MESA_EXTENSION_OVERRIDE -u MESA_GL_VERSION_OVERRIDE} "$python" \
        "$root/scripts/lib/probe.py"
}
