# shellcheck shell=bash
# What the README shows is right: its programs draw, and its commands run.

# code_of LANGUAGE NUMBER: of the README's blocks of code in that language
code_of() {
    awk -v fence="\`\`\`$1" -v number="$2" '
        /^```/ && inside { inside = 0; next }
        $0 == fence { inside = 1; found++; next }
        inside && found == number' "$source_root/README.md"
}

# A program about a snippet: its surroundings, in a context without a window, whose first viewport is
# empty; ten quads, the farthest first; and what must come of it.
write_program() { # FILE NUMBER CHECK
    {
        cat <<'END'
#define GL_GLEXT_PROTOTYPES 1
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <stdio.h>
#include <stdlib.h>

enum { width = 33, height = 17 };
static int composed;

static void draw_everything(void)
{
   for (int i = 10; i > 0; i--) {
      const float z = i / 10.0f - 0.05f;
      glColor4f(i / 10.0f, 0, 0, 1);
      glBegin(GL_TRIANGLE_STRIP);
      for (int corner = 0; corner < 4; corner++)
         glVertex3f(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, 2 * z - 1);
      glEnd();
   }
}
#define draw_everything_in_any_order draw_everything

static void compose_layers(GLuint color) { composed += color != 0; }

static float *read_texture(GLenum target, GLuint texture, GLenum format, int layers)
{
   float *values = malloc(layers * width * height * 4 * sizeof *values);
   glBindTexture(target, texture);
   glGetTexImage(target, 0, format, GL_FLOAT, values);
   return values;
}

static int near(float a, float b) { return a > b - 0.01f && a < b + 0.01f; }

END
        code_of c "$2" | grep '^#include'
        cat <<'END'
int main(void)
{
   EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
   eglInitialize(display, NULL, NULL);
   eglBindAPI(EGL_OPENGL_API);
   EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, NULL);
   if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return puts("no context"), 1;
END
        code_of c "$2" | grep -v '^#include'
        printf '%s\n' "$3" '   return glGetError() != GL_NO_ERROR;' '}'
    } >"$1"
}

in_readmes_folder() {
    prefix=$source_root/build/prefix
    [ -f "$prefix/.complete" ] || skip "needs scripts/build"
    command -v c++ >/dev/null || skip "needs a compiler"
    mkdir "$work/here"
    cd "$work/here" || exit
    ln -s "$source_root"/{build,samples,scripts} .
    export PKG_CONFIG_PATH
    PKG_CONFIG_PATH=$(echo "$prefix"/lib/*/pkgconfig)
}

# build_and_run: by the README's own commands
build_and_run() {
    output=$(bash -euc "$(code_of sh 5)" 2>&1) || {
        printf '%s\n' "$output"
        exit 1
    }
}

test_readme_peeling_program_peels_all_layers() {
    in_readmes_folder
    local last='
   float *depths = read_texture(GL_TEXTURE_2D_ARRAY, depth, GL_DEPTH_COMPONENT, k);
   if (composed != 2 || !near(depths[width * height - 1], 0.85f))
      return printf("%d passes, depth %g\n", composed, depths[width * height - 1]), 1;'
    write_program program.c 1 "$last"
    build_and_run
}

test_readme_kbuffer_program_keeps_the_two_nearest() {
    in_readmes_folder
    local last='
   for (int i = 0; i < 2; i++) {
      const float *at =
         read_texture(GL_TEXTURE_2D, entries[i], GL_RGBA, 1) + 4 * (width * height - 1);
      if (!near(at[0], 0.1f * (i + 1)) || !near(at[3], 0.1f * (i + 1) - 0.05f))
         return printf("entry %d: red %g, depth %g\n", i, at[0], at[3]), 1;
   }'
    write_program program.c 2 "$last"
    build_and_run
}

test_readme_builds_a_program_with_osmesa() {
    in_readmes_folder
    local run_here
    run_here=$(code_of sh 4)
    [[ $run_here == *"pkg-config --cflags --libs osmesa"* ]]
    output=$(bash -euc "$run_here")
    [[ $output == "expected "* ]]
}

# All names of functions in the snippets that are not of OpenGL 3.2 are in the table of functions.
test_readme_names_the_functions_that_loaders_lack() {
    local name
    for name in glGenProgramsARB glBindProgramARB glProgramStringARB glTexStorage2D glTexStorage3D \
        glFramebufferParameteri glGetFramebufferParameteriv glFramebufferTexture; do
        grep -q "^| .*\`$name\`" "$source_root/README.md"
        { code_of c 1 && code_of c 2; } | grep "$name(" >/dev/null
    done
}

# The recipe for Debian: but for what needs its packages, it is tried with a source package that has
# the files that it changes.
test_readme_recipe_for_debian() {
    local recipe
    recipe=$(code_of sh 6 | grep -E '^(cp|echo) ')
    [ "$(wc -l <<<"$recipe")" -eq 2 ]
    mkdir -p "$work/mesa/debian/patches" "$work/kbuffer"
    echo other.patch >"$work/mesa/debian/patches/series"
    echo usr/include/GL/internal/dri_interface.h >"$work/mesa/debian/mesa-common-dev.install"
    echo 1.patch >"$work/kbuffer/series"
    touch "$work/kbuffer/1.patch"
    (cd "$work/mesa" && bash -euc "${recipe//\/tmp\/kbuffer/$work\/kbuffer}")
    [ "$(cat "$work/mesa/debian/patches/series")" = $'other.patch\n1.patch' ]
    [ -f "$work/mesa/debian/patches/1.patch" ]
    grep -qx usr/include/GL/mesa_kbuffer.h "$work/mesa/debian/mesa-common-dev.install"
    [ -f "$source_root/mesa-patches/overlay/include/GL/mesa_kbuffer.h" ]
}
