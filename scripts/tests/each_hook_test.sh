# shellcheck shell=bash
# mesa-patches/build-each: a hook that needs a later one, or that brings a warning, fails

# A release that compiles, and that knows the options which Mesa is configured with
make_buildable_release() {
    local release=$work/mesa-0
    if [ -d "$source_root/build/tools" ]; then
        mkdir -p "$project/build"
        ln -s "$source_root/build/tools" "$project/build/tools"
    fi
    cat >"$release/meson.build" <<'END'
project('mesa', 'c', default_options: ['warning_level=2'])
executable('a', 'src/a.c', install: true)
END
    grep -oE -- '-D[a-z0-9-]+=' "$source_root/scripts/lib/mesa.sh" | sort -u |
        grep -vE 'prefix|optimization' | sed -E "s/-D(.*)=/option('\1', type: 'string', value: '')/" \
        >"$release/meson_options.txt"
    printf '%s\n' 'int' 'main(void)' '{' '   return 0;' '}' >"$release/src/a.c"
    tar -C "$work" -cJf "$work/release.tar.xz" mesa-0
    sed -i -E "s/\"sha256\": \"[0-9a-f]+\"/\"sha256\": \"$(sha256sum <"$work/release.tar.xz" |
        cut -d' ' -f1)\"/" "$project/mesa-patches/upstream.json"
    prepare 0
}

add_hook() { # SUBJECT SED_EXPRESSION
    sed -i "$2" "$project/build/mesa/src/a.c"
    in_tree commit -qam "$1"
    run 0 scripts/patch refresh
}

test_each_hook_builds() {
    make_buildable_release
    mkdir -p "$project/mesa-patches/overlay/src"
    echo 'enum { NEW = 2 };' >"$project/mesa-patches/overlay/src/n.h"
    add_hook 'a: include it' '1i #include "n.h"'
    add_hook 'a: use it' 's/return 0/return NEW/'
    run 0 mesa-patches/build-each
    prints "2 passed, 0 failed, 0 skipped"
    rm "$project"/build/log/each-hook-*
    run 0 mesa-patches/build-each
    prints "2 passed, 0 failed, 0 skipped"
    # What has not changed is not built again.
    absent build/log/each-hook-1.log
}

test_hook_that_needs_a_later_one() {
    make_buildable_release
    add_hook 'a: use it' 's/return 0/return NEW/'
    add_hook 'a: define it' '1i enum { NEW = 2 };'
    run 1 mesa-patches/build-each
    prints "not ok a: use it: does not build"
    prints "NEW"
    prints "ok a: define it"
    prints "1 passed, 1 failed, 0 skipped"
    run 0 mesa-patches/build-each --from 2
    prints "1 passed, 0 failed, 1 skipped"
}

test_hook_that_brings_a_warning() {
    make_buildable_release
    add_hook 'a: warn' 's/return 0/int unused; return 0/'
    run 1 mesa-patches/build-each
    prints "not ok a: warn: warns"
    prints "unused"
}
