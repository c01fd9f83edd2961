# shellcheck shell=bash
# scripts/run: which program it starts, on which driver, in which environment. Most of it needs a
# built Mesa, which is taken from the project itself.
# shellcheck disable=SC2016 # scripts that are written, not run

need_mesa() {
    [ -f "$source_root/build/prefix/.complete" ] || skip "needs scripts/build"
    unset GALLIUM_DRIVER MESA_EXTENSION_OVERRIDE
}

on_mesa() { # STATUS ARGUMENT...
    local status=$1
    shift
    run "$status" "$source_root/scripts/run" "$@"
}

test_commands_work_through_symbolic_links() {
    local command
    for command in "${commands[@]}"; do
        ln -s "$project/scripts/$command" "$work/linked-$command"
        run 0 "$work/linked-$command" --help
        prints "Usage: scripts/$command"
        run 2 "$work/linked-$command" --no-such-option
        prints "scripts/$command: unknown option"
    done
    absent build
}

# A name in PATH, as people link scripts/run there
test_run_works_through_a_symbolic_link() {
    need_mesa
    mkdir "$work/bin"
    ln -s "$source_root/scripts/run" "$work/bin/kb"
    ln -s kb "$work/bin/kbuffer"
    run 0 env PATH="$work/bin:$PATH" kbuffer --which
    prints "$source_root/build/prefix/"
}

# Whatever of the command's own is missing, the program does not start.
test_run_ends_when_it_fails_before_the_program() {
    local missing
    mkdir -p "$project/build/prefix/lib/x"
    touch "$project/build/prefix/.complete" "$project/build/prefix/lib/x/libOSMesa.so"
    for missing in lib/probe.py lib/prefix.sh lib/common.sh lib; do
        rm -r "$project/scripts/$missing"
        output=$(cd "$project" && scripts/run touch "$work/started" 2>&1) && exit 1
        [ ! -e "$work/started" ]
    done
}

test_run_starts_what_the_users_path_has() {
    need_mesa
    mkdir "$work/venv"
    printf '#!/bin/sh\necho "the user has $0 $PATH"\n' >"$work/venv/python3"
    chmod +x "$work/venv/python3"
    local path=$work/venv::/usr/bin:$work/none/:/bin
    run 0 env PATH="$path" "$source_root/scripts/run" python3
    [ "$output" = "the user has $work/venv/python3 $path" ]
}

# All that scripts/run itself is in need of is its own business.
test_run_hands_the_environment_on() {
    need_mesa
    local name
    for name in PYTHONHOME PYTHONPATH GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE; do
        run 0 env "$name=/some where" "$source_root/scripts/run" printenv "$name"
        [ "$output" = "/some where" ]
    done
    run 1 env -u PYTHONHOME "$source_root/scripts/run" printenv PYTHONHOME
}

test_run_knows_where_its_options_end() {
    need_mesa
    printf '#!/bin/sh\necho "$1"\n' >"$work/--odd"
    chmod +x "$work/--odd"
    run 0 env PATH="$work:$PATH" "$source_root/scripts/run" -- --odd --which
    [ "$output" = --which ]
    on_mesa 0 -- echo hello
    [ "$output" = hello ]
    run 2 scripts/run --
    prints "a command is missing"
}

test_run_names_a_program_that_cannot_be_started() {
    need_mesa
    on_mesa 127 no-such-program
    prints "there is no program 'no-such-program'"
    lines 1
    on_mesa 127 "$work/no such program"
    prints "there is no program '$work/no such program'"
    on_mesa 126 "$work"
    prints "is a folder"
    on_mesa 126 "$source_root/README.md"
    prints "no program that can be executed"
}

test_which_tells_what_overrides_leave() {
    need_mesa
    on_mesa 0 --which
    prints "GL_MESA_kbuffer_program: yes"
    prints "GL_MESA_depth_peeling: yes"
    run 0 env MESA_EXTENSION_OVERRIDE=-GL_MESA_depth_peeling "$source_root/scripts/run" --which
    prints "GL_MESA_kbuffer_program: yes"
    prints "GL_MESA_depth_peeling: no"
    run 0 env MESA_EXTENSION_OVERRIDE=-GL_MESA_kbuffer_program "$source_root/scripts/run" --which
    prints "GL_MESA_kbuffer_program: no"
    prints "GL_MESA_depth_peeling: yes"
    run 2 "$source_root/scripts/run" --which touch "$work/started"
    prints "--which takes no command, not 'touch'"
    [ ! -e "$work/started" ]
}

test_run_names_what_is_wrong_with_the_environment() {
    need_mesa
    run 2 env GALLIUM_DRIVER=swr "$source_root/scripts/run" touch "$work/started"
    prints "GALLIUM_DRIVER is 'swr'"
    prints "llvmpipe and softpipe"
    run 2 env MESA_LOADER_DRIVER_OVERRIDE=zink EGL_LOG_LEVEL=fatal "$source_root/scripts/run" \
        touch "$work/started"
    prints "MESA_LOADER_DRIVER_OVERRIDE=zink"
    [[ $output != *EGL_LOG_LEVEL* ]]
    [ ! -e "$work/started" ]
    run 0 env PYTHONHOME=/somewhere GALLIUM_DRIVER=softpipe "$source_root/scripts/run" --which
    prints "driver: softpipe"
}

# An EGL program that prints which driver answers it, and is linked as conda's programs are: an RPATH,
# which the loader obeys before LD_LIBRARY_PATH, leads to a folder of libraries.
make_program_with_rpath() {
    need_mesa
    mkdir "$work/libraries"
    cat >"$work/who.c" <<'END'
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <stdio.h>

int main(void)
{
   const unsigned char *(*get_string)(unsigned);
   EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
   EGLContext context;
   if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API))
      return 1;
   context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, NULL);
   if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return 1;
   get_string = (const unsigned char *(*)(unsigned))eglGetProcAddress("glGetString");
   puts((const char *)get_string(0x1F03));
   return 0;
}
END
    cc -o "$work/who" "$work/who.c" "-Wl,--disable-new-dtags,-rpath,$work/libraries" -lEGL ||
        skip "needs a compiler and libEGL"
}

test_run_is_found_by_a_program_that_has_another_libegl_mesa() {
    make_program_with_rpath
    local other
    other=$(ldconfig -p | sed -n 's/.*libEGL_mesa.so.0.* => //p' | head -n 1)
    [ -n "$other" ] || skip "needs a Mesa of the distribution's"
    ln -s "$other" "$work/libraries/libEGL_mesa.so.0"
    on_mesa 0 "$work/who"
    prints GL_MESA_kbuffer_program
}

test_run_refuses_a_program_that_has_another_driver() {
    make_program_with_rpath
    local name
    for name in libGLX_mesa.so.0 libOSMesa.so.8 libgallium-25.0.7.so; do
        # Any library will do: it is not loaded.
        cp "$(ldconfig -p | sed -n 's/.*libEGL.so.1 .* => //p' | head -n 1)" "$work/libraries/$name"
        on_mesa 1 "$work/who"
        prints "$name is $work/libraries/$name"
        rm "$work/libraries/$name"
    done
    printf '#!/usr/bin/env -S %s\n' "$work/who" >"$work/script"
    chmod +x "$work/script"
    on_mesa 0 "$work/script"
    touch "$work/libraries/libGLX_mesa.so.0"
    on_mesa 0 "$work/script"
    cp "$source_root"/build/prefix/lib/*/libGLX_mesa.so.0 "$work/libraries"
    on_mesa 1 "$work/script"
    prints "libGLX_mesa.so.0 is"
}
