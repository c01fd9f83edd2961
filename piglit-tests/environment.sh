# Running programs on the Mesa of a prefix. To be sourced after scripts/lib/common.sh.
# shellcheck shell=bash

# shellcheck source=scripts/lib/xvfb.sh
. "$root/scripts/lib/xvfb.sh"

# use_prefix PREFIX: GL programs started from here on use its Mesa, through libglvnd or not.
use_prefix() {
    local lib
    lib=$(dirname "$(find "$1/" -name 'libEGL_mesa.so.0' -print -quit)")
    [ -e "$lib/libEGL_mesa.so.0" ] || die "no Mesa with EGL in $1"
    export LD_LIBRARY_PATH=$lib
    export __GLX_VENDOR_LIBRARY_NAME=mesa
    export __EGL_VENDOR_LIBRARY_FILENAMES=$1/share/glvnd/egl_vendor.d/50_mesa.json
    clean_environment piglit
}

# clean_environment CACHE: without what a user's variables would change
clean_environment() {
    # The shader cache is on, as users have it, in a folder that is not the user's.
    export MESA_SHADER_CACHE_DIR=$build/shader-cache/$1
    unset MESA_SHADER_CACHE_DISABLE WAYLAND_DISPLAY PIGLIT_PLATFORM MESA_EXTENSION_OVERRIDE LIBGL_ALWAYS_SOFTWARE \
        MESA_LOADER_DRIVER_OVERRIDE
}

# check_renderer DRIVER [PLATFORM]: the driver that answers in a surfaceless context, or one of
# another of waffle's platforms, is the one that is wanted.
check_renderer() {
    local renderer
    renderer=$(GALLIUM_DRIVER=$1 LD_PRELOAD=${sanitizer_runtime:-} wflinfo -p "${2:-surfaceless_egl}" -a gl 2>&1 |
        sed -n 's/^OpenGL renderer string: //p') || true
    case $renderer in
    "$1"*) ;;
    *) die "asked for $1, but '$renderer' answers" "Is LD_LIBRARY_PATH's Mesa whole?" ;;
    esac
}
