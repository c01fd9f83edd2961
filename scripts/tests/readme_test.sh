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

# The recipe for Debian, in a shell that stops at the first failure. Programs that need Debian's
# packages are stand-ins: apt-get has no source package without `deb-src`, dch asks who it is for,
# and debi installs what a build has left in the folder above.
test_readme_recipe_for_debian() {
    local recipe program
    recipe=$(code_of sh 6)
    mkdir -p "$work/bin" "$work/kbuffer" "$work/here/scripts" "$work/package/debian/patches"
    echo other.patch >"$work/package/debian/patches/series"
    echo usr/include/GL/internal/dri_interface.h >"$work/package/debian/mesa-common-dev.install"
    printf 'Types: deb\nSuites: trixie\n' >"$work/debian.sources"
    cat >"$work/here/scripts/patch" <<'END'
[ "$1 $2" = "export --debian" ] && echo 1.patch >"$3/series" && touch "$3/1.patch"
END
    cat >"$work/bin/apt-get" <<'END'
case $1 in
source | build-dep) grep -qx 'Types: deb deb-src' "$work/debian.sources" && [ -f "$work/updated" ] ;;
update) touch "$work/updated" ;;
esac || exit
[ "$1" != source ] || cp -r "$work/package" mesa-25.0.7
END
    cat >"$work/bin/sudo" <<'END'
exec "$@"
END
    cat >"$work/bin/dch" <<'END'
[ -n "$DEBFULLNAME" ] && [ -n "$DEBEMAIL" ] && touch "$work/named"
END
    cat >"$work/bin/dpkg-buildpackage" <<'END'
[ -f "$work/named" ] && touch ../mesa.changes
END
    cat >"$work/bin/debi" <<'END'
[ -f ../mesa.changes ] && touch "$work/installed"
END
    for program in "$work"/bin/* "$work/here/scripts/patch"; do
        sed -i '1i #!/bin/sh' "$program"
        chmod +x "$program"
    done
    recipe=${recipe//\/tmp\/kbuffer/$work\/kbuffer}
    recipe=${recipe//\/etc\/apt\/sources.list.d/$work}
    (cd "$work/here" && env -u DEBFULLNAME -u DEBEMAIL work="$work" PATH="$work/bin:$PATH" \
        bash -euc "$recipe")
    [ -f "$work/installed" ]
    local debian=$work/here/mesa-25.0.7/debian
    [ "$(cat "$debian/patches/series")" = $'other.patch\n1.patch' ]
    [ -f "$debian/patches/1.patch" ]
    grep -qx usr/include/GL/mesa_kbuffer.h "$debian/mesa-common-dev.install"
    [ -f "$source_root/mesa-patches/overlay/include/GL/mesa_kbuffer.h" ]
}
