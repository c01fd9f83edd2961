# shellcheck shell=bash
# build/mesa and mesa-patches: patching, editing, going back and forth

tree_commands='. scripts/lib/common.sh; . scripts/lib/packages.sh; . scripts/lib/source.sh
    . scripts/lib/tree.sh; prepare_tree'

prepare() { # STATUS
    run "$1" bash -c "$tree_commands" scripts/build
}

in_tree() { git -C "$project/build/mesa" -c user.name=a -c user.email=a@localhost "$@"; }

# A hook that changes the word `three` of src/a.c, and an overlay file
make_patches() {
    prepare 0
    sed -i 's/three/drei/' "$project/build/mesa/src/a.c"
    in_tree commit -qam 'a: count in German'
    mkdir -p "$project/mesa-patches/overlay/src/new"
    echo new >"$project/mesa-patches/overlay/src/new/n.c"
    run 0 scripts/patch refresh
    [ -f "$project/mesa-patches/hooks/0001-a-count-in-German.patch" ]
}

test_patched_tree() {
    make_patches
    rm -rf "$project/build"
    prepare 0
    grep -q drei "$project/build/mesa/src/a.c"
    [ "$(readlink "$project/build/mesa/src/new/n.c")" = ../../../../mesa-patches/overlay/src/new/n.c ]
    [ -z "$(in_tree status --porcelain)" ]
    no_temporaries
}

# Hooks keep their folder, and a new one comes to that of the hook before it.
test_hooks_in_folders() {
    make_patches
    local hooks=$project/mesa-patches/hooks
    mkdir "$hooks/first"
    mv "$hooks"/0001-*.patch "$hooks/first"
    sed -i 's/two/zwei/' "$project/build/mesa/src/a.c"
    in_tree commit -qam 'a: count on in German'
    run 0 scripts/patch refresh
    [ -f "$hooks/first/0002-a-count-on-in-German.patch" ]
    mkdir "$hooks/later"
    mv "$hooks"/first/0002-*.patch "$hooks/later"
    sed -i 's/b/c/' "$project/build/mesa/src/b.c"
    in_tree commit -qam 'b: go on'
    run 0 scripts/patch refresh
    [ "$(cd "$hooks" && find . -type f | LC_ALL=C sort)" = "./first/0001-a-count-in-German.patch
./later/0002-a-count-on-in-German.patch
./later/0003-b-go-on.patch" ]
    rm -rf "$project/build"
    prepare 0
    [ "$(in_tree log --format=%s upstream..HEAD)" = "b: go on
a: count on in German
a: count in German" ]
}

test_only_changed_files_are_touched() {
    make_patches
    touch -d '2001-01-01' "$project"/build/mesa/src/*.c
    sed -i 's/^+drei/+troi/' "$project"/mesa-patches/hooks/0001-*.patch
    prepare 0
    grep -q troi "$project/build/mesa/src/a.c"
    [ "$(date -r "$project/build/mesa/src/b.c" +%Y)" = 2001 ]
}

test_overlay_files_come_and_go() {
    make_patches
    mkdir -p "$project/mesa-patches/overlay/src/new"
    mv "$project/mesa-patches/overlay/src/new/n.c" "$project/mesa-patches/overlay/src/new/m.c"
    prepare 0
    [ -e "$project/build/mesa/src/new/m.c" ]
    absent build/mesa/src/new/n.c
    [ ! -L "$project/build/mesa/src/new/n.c" ]
    [ -z "$(in_tree status --porcelain)" ]
}

test_hook_that_does_not_apply() {
    make_patches
    sed -i 's/^-three/-tree/' "$project"/mesa-patches/hooks/0001-*.patch
    prepare 1
    prints "does not apply"
    grep -q drei "$project/build/mesa/src/a.c"
    no_temporaries
}

test_context_must_match_exactly() {
    make_patches
    sed -i 's/^ two/ zwei/' "$project"/mesa-patches/hooks/0001-*.patch
    prepare 1
    prints "does not apply"
}

test_edits_are_not_lost() {
    make_patches
    echo edited >>"$project/build/mesa/src/b.c"
    echo other >"$project/mesa-patches/overlay/src/new/other.c"
    prepare 1
    prints "scripts/patch refresh"
    grep -q edited "$project/build/mesa/src/b.c"
    in_tree commit -qam 'b: edit'
    prepare 1
    prints "commits of your own"
    run 0 scripts/patch refresh
    prepare 0
    grep -q edited "$project/build/mesa/src/b.c"
}

test_refresh_wants_commits() {
    make_patches
    echo edited >>"$project/build/mesa/src/b.c"
    run 1 scripts/patch refresh
    prints "not committed"
}

test_refresh_keeps_new_files_out_of_hooks() {
    make_patches
    echo c >"$project/build/mesa/src/c.c"
    in_tree add src/c.c
    in_tree commit -qm 'c: add'
    run 1 scripts/patch refresh
    prints "src/c.c"
    in_tree reset -q HEAD~
    run 0 scripts/patch refresh
    [ -f "$project/mesa-patches/overlay/src/c.c" ] && [ -L "$project/build/mesa/src/c.c" ]
}

# An editor that writes a new file and renames it replaces the link.
test_replaced_links_are_copied_back() {
    make_patches
    echo better >"$work/n.c"
    mv -f "$work/n.c" "$project/build/mesa/src/new/n.c"
    run 0 scripts/patch refresh
    grep -q better "$project/mesa-patches/overlay/src/new/n.c"
    [ -L "$project/build/mesa/src/new/n.c" ]
}

test_refresh_is_stable() {
    make_patches
    cp -r "$project/mesa-patches" "$work/before"
    run 0 scripts/patch refresh
    diff -r "$work/before" "$project/mesa-patches"
    rm -rf "$project/build"
    prepare 0
    run 0 scripts/patch refresh
    diff -r "$work/before" "$project/mesa-patches"
}

test_export_applies_to_the_release() {
    make_patches
    run 0 scripts/patch export "$work/series"
    run 0 scripts/patch export "$work/series"
    [ "$(ls "$work/series")" = "0001-mesa-add-what-else-the-k-buffer-extensions-need.patch
0002-a-count-in-German.patch
series" ]
    git init -q "$work/mesa-0"
    git -C "$work/mesa-0" add -A
    git -C "$work/mesa-0" -c user.name=a -c user.email=a@localhost commit -qm release
    git -C "$work/mesa-0" -c user.name=a -c user.email=a@localhost am -q "$work"/series/*.patch
    grep -q drei "$work/mesa-0/src/a.c"
    grep -q new "$work/mesa-0/src/new/n.c"
    [ ! -L "$work/mesa-0/src/new/n.c" ]
}

test_export_leaves_other_files_alone() {
    mkdir "$work/series"
    echo mine >"$work/series/notes.txt"
    run 1 scripts/patch export "$work/series"
    prints "notes.txt"
    grep -q mine "$work/series/notes.txt"
}

# A patch of that form is as much somebody's work as any other file, and so is an edit of ours.
test_export_has_the_specifications() {
    make_patches
    mkdir "$project/ext-spec"
    echo contract >"$project/ext-spec/MESA_a.txt"
    run 0 scripts/patch export "$work/series"
    grep -qx '+contract' "$work/series/0001-docs-add-the-specifications-of-the-k-buffer-extensio.patch"
    tar -C "$work" -xJf "$work/release.tar.xz"
    git -C "$work/mesa-0" init -q
    git -C "$work/mesa-0" apply "$work"/series/*.patch
    [ "$(cat "$work/mesa-0/docs/_extra/specs/MESA_a.txt")" = contract ]
}

test_export_replaces_only_what_it_wrote() {
    make_patches
    mkdir "$work/series"
    echo mine >"$work/series/0007-mine.patch"
    run 1 scripts/patch export "$work/series"
    prints "0007-mine.patch"
    grep -q mine "$work/series/0007-mine.patch"
    rm "$work/series/0007-mine.patch"
    run 0 scripts/patch export "$work/series"
    rm -r "$project/mesa-patches/overlay"
    run 0 scripts/patch export "$work/series"
    [ "$(ls "$work/series")" = "0001-a-count-in-German.patch
series" ]
    echo more >>"$work/series/0001-a-count-in-German.patch"
    run 1 scripts/patch export "$work/series"
    prints "0001-a-count-in-German.patch"
    grep -q more "$work/series/0001-a-count-in-German.patch"
}

test_export_names_an_author() {
    make_patches
    run 0 scripts/patch export "$work/series"
    [ "$(grep -h ^From: "$work"/series/*.patch | sort -u)" = \
        "From: The mesa-kbuffer authors <authors@mesa-kbuffer.example>" ]
    run 0 scripts/patch export --author 'Ann Other <ann@example.org>' "$work/series"
    [ "$(grep -h ^From: "$work"/series/*.patch | sort -u)" = "From: Ann Other <ann@example.org>" ]
    run 2 scripts/patch export --author ann "$work/series"
    lines 1
}

# One author line may be folded; the export has the other one alone.
test_export_replaces_a_folded_author() {
    make_patches
    sed -i 's/^From: .*/From: A name that is so long that it takes another line of the head\n <a@localhost>/' \
        "$project"/mesa-patches/hooks/0001-*.patch
    run 0 scripts/patch export "$work/series"
    ! grep -r localhost "$work/series"
}

test_export_for_debian_has_its_fields() {
    make_patches
    run 0 scripts/patch export --debian "$work/series"
    local patch=$work/series/0002-a-count-in-German.patch field
    [ "$(head -n 1 "$patch")" = "Description: a: count in German" ]
    for field in 'Author: The mesa-kbuffer authors <.*>' 'Origin: other, .*' 'Forwarded: no' \
        'Last-Update: 20[0-9]{2}-[0-9]{2}-[0-9]{2}'; do
        grep -qxE "$field" "$patch"
    done
    [ "$(cat "$work/series/series")" = "0001-mesa-add-what-else-the-k-buffer-extensions-need.patch
0002-a-count-in-German.patch" ]
    while read -r patch; do
        patch -s -d "$work/mesa-0" -p1 --fuzz=0 <"$work/series/$patch"
    done <"$work/series/series"
    grep -q drei "$work/mesa-0/src/a.c"
    grep -q new "$work/mesa-0/src/new/n.c"
}

test_export_cuts_the_overlay_by_part() {
    make_patches
    local file
    for file in include/GL/h.h src/mesa/main/m.c src/mesa/state_tracker/s.c \
        src/gallium/drivers/softpipe/sp.c src/gallium/drivers/llvmpipe/lp_bld_kbuf.c \
        src/gallium/drivers/llvmpipe/lp_peel.c; do
        mkdir -p "$(dirname "$project/mesa-patches/overlay/$file")"
        echo "$file" >"$project/mesa-patches/overlay/$file"
    done
    run 0 scripts/patch export "$work/series"
    [ "$(cat "$work/series/series")" = "0001-gallium-add-the-interface-of-the-k-buffer-stage.patch
0002-mesa-add-the-files-of-the-k-buffer-extensions.patch
0003-st-mesa-add-the-files-of-the-k-buffer-extensions.patch
0004-softpipe-add-the-files-of-the-k-buffer-stage.patch
0005-llvmpipe-add-the-files-of-k-buffer-programs.patch
0006-llvmpipe-add-the-files-of-depth-peeling.patch
0007-mesa-add-what-else-the-k-buffer-extensions-need.patch
0008-a-count-in-German.patch" ]
    [ "$(grep -lr lp_peel "$work/series" --include '*.patch')" = "$work/series/0006-llvmpipe-add-the-files-of-depth-peeling.patch" ]
}
