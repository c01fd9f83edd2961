# shellcheck shell=bash
# mesa-patches/check: what it proves of a sound series, and that it sees each fault

# A sound hook, an overlay file, and a patch of Debian's to another file
make_series() {
    local debian=$work/debian
    prepare 0
    sed -i 's/three/drei/' "$project/build/mesa/src/a.c"
    in_tree commit -qam 'a: count in German' -m $'For readers there.\n\nUpstream-Status: Pending'
    mkdir -p "$project/mesa-patches/overlay/src/new" "$debian/patches"
    echo new >"$project/mesa-patches/overlay/src/new/n.c"
    run 0 scripts/patch refresh
    hook=$project/mesa-patches/hooks/0001-a-count-in-German.patch
    echo fix.diff >"$debian/patches/series"
    printf '%s\n' '--- a/src/b.c' '+++ b/src/b.c' '@@ -1 +1 @@' '-b' '+c' >"$debian/patches/fix.diff"
    pack_debian
}

pack_debian() { tar -C "$work" -cJf "$project/build/download/mesa_0-1.debian.tar.xz" debian; }

# is_red TEXT: the check fails, and says TEXT
is_red() {
    run 1 mesa-patches/check
    prints "$1"
}

test_check_passes_a_sound_series() {
    make_series
    run 0 mesa-patches/check
    prints "12 passed, 0 failed, 0 skipped"
    no_temporaries
}

test_check_skips_debian_without_network() {
    make_series
    rm "$project"/build/download/*.debian.tar.xz
    run 0 env "${offline[@]}" APT_CONFIG="$work/apt.conf" mesa-patches/check
    prints "it cannot be fetched"
    prints "8 passed, 0 failed, 4 skipped"
}

# `patch` would apply it with fuzz; git does not.
test_check_sees_fuzz() {
    make_series
    sed -i 's/^ one$/ eins/' "$hook"
    run 1 mesa-patches/check
    prints "does not apply"
}

# git finds lines that have moved without a word.
test_check_sees_offsets() {
    make_series
    sed -i 's/^@@ -1,6 +1,6 @@/@@ -2,6 +2,6 @@/' "$hook"
    is_red "not ok hooks apply to the release exactly"
    prints "offset"
}

test_check_sees_a_conflict_with_debian() {
    make_series
    printf '%s\n' '--- a/src/a.c' '+++ b/src/a.c' '@@ -1,4 +1,4 @@' ' one' '-two' '+zwei' ' three' ' four' \
        >"$work/debian/patches/fix.diff"
    pack_debian
    is_red "not ok hooks apply on top of Debian's patches"
}

test_check_wants_a_body() {
    make_series
    sed -i '/^For readers/d' "$hook"
    is_red "says nothing of why it is there"
}

test_check_wants_the_state_upstream() {
    make_series
    sed -i 's/^Upstream-Status: Pending/Upstream-Status: Inappropriate/' "$hook"
    is_red "does not end with its state upstream"
    sed -i 's/^Upstream-Status: .*/Upstream-Status: Inappropriate [a test]/' "$hook"
    run 0 mesa-patches/check
}

test_check_wants_a_module() {
    make_series
    sed -i 's/^Subject: .*/Subject: [PATCH] Count in German/' "$hook"
    is_red "subject is not of the form"
    sed -i 's/^Subject: .*/Subject: [PATCH] nir: count in German/' "$hook"
    is_red "changes nothing of nir"
}

test_check_sees_white_space() {
    make_series
    sed -i 's/^+drei$/+drei /' "$hook"
    is_red "white space error"
    sed -i 's/^+drei $/+ three/' "$hook"
    is_red "changes nothing but white space"
}

test_check_sees_overlay_files_of_mesa() {
    make_series
    echo other >"$project/mesa-patches/overlay/src/b.c"
    is_red "the release has src/b.c"
}

test_check_sees_hooks_that_add_files() {
    make_series
    printf '%s\n' 'diff --git a/src/c.c b/src/c.c' 'new file mode 100644' '--- /dev/null' '+++ b/src/c.c' \
        '@@ -0,0 +1 @@' '+c' >>"$hook"
    is_red "adds, removes, renames"
}
