# The Mesa trees in build/: git repositories of the release, ours with the hooks as commits and the
# overlay as links. To be sourced after source.sh.
# shellcheck shell=bash

patches=$root/mesa-patches
overlay=$patches/overlay
tree=$build/mesa

# The committer of what the scripts commit; with fixed dates the commits of a given series have the
# same names everywhere. The version string of the built driver shows the last one's.
committed_by_script() {
    env GIT_COMMITTER_NAME=mesa-kbuffer GIT_COMMITTER_EMAIL=mesa-kbuffer@localhost \
        GIT_AUTHOR_NAME=mesa-kbuffer GIT_AUTHOR_EMAIL=mesa-kbuffer@localhost \
        GIT_AUTHOR_DATE='2025-01-01T00:00:00Z' GIT_COMMITTER_DATE='2025-01-01T00:00:00Z' \
        GIT_CONFIG_GLOBAL=/dev/null "$@"
}

overlay_files() {
    [ ! -d "$overlay" ] || (cd "$overlay" && find . -type f ! -name '*~' -printf '%P\n' | LC_ALL=C sort)
}

# The hooks, in the order of their numbers, which run through all folders
hook_files() {
    [ ! -d "$patches/hooks" ] || find "$patches/hooks" -name '[0-9]*.patch' -printf '%f\t%p\n' |
        LC_ALL=C sort | cut -f2
}

# What a tree is made of; the contents of the overlay are not in it, because they are links.
series_hash() {
    local hook
    {
        echo "$mesa_sha256"
        while read -r hook; do sha256sum <"$hook"; done < <(hook_files)
        overlay_files
    } | sha256sum | cut -d' ' -f1
}

# unpack_tree TREE: the release as a git repository, its commit tagged `upstream`
unpack_tree() {
    local folder
    fetch_mesa
    say "Unpacking Mesa $mesa_version into ${1#"$root"/}"
    make_temporary folder
    keep_telling "unpacking"
    tar -C "$folder" --strip-components=1 -xf "$mesa_tarball" 2>"$folder/.tar.log" ||
        die "Mesa cannot be unpacked: $(head -n 1 "$folder/.tar.log")" \
            "If the disk is full, free some space, then run $command_name again."
    rm "$folder/.tar.log"
    git -C "$folder" -c init.defaultBranch=kbuffer init -q
    git -C "$folder" config core.autocrlf false
    git -C "$folder" config gc.auto 0
    git -C "$folder" add --force --all
    committed_by_script git -C "$folder" commit -q --no-gpg-sign -m "Mesa $mesa_version"
    git -C "$folder" tag upstream
    printf '/build*/\n' >"$folder/.git/info/exclude"
    stop_telling
    rm -rf "$1"
    mv "$folder" "$1"
}

# second_tree VARIABLE: a temporary work tree of build/mesa, at the release, in which only the files
# lie that hooks change (11,000 files would take longer than all else)
second_tree() {
    local -n second=$1
    local parent
    make_temporary parent
    second=$parent/tree
    git -C "$tree" worktree prune
    git -C "$tree" worktree add -q --no-checkout --detach "$second" upstream
    {
        echo /meson.build
        hook_files | xargs -r sed -n 's|^diff --git a/\(.*\) b/.*|/\1|p'
    } | git -C "$second" sparse-checkout set --no-cone --stdin
    git -C "$second" checkout -q
}

# commit_hooks TREE: each hook as a commit, exactly as it is written: no fuzz, no three-way merge
commit_hooks() {
    local hook
    while read -r hook; do
        committed_by_script git -C "$1" am -q --no-3way --keep-cr --whitespace=nowarn \
            --no-gpg-sign --committer-date-is-author-date "$hook" >"$1.log" 2>&1 ||
            die "$(basename "$hook") does not apply to Mesa $mesa_version" \
                "$(grep -m 3 '^error:' "$1.log")" "${tree#"$root"/} is as it was before."
    done < <(hook_files)
}

# The new commits are made in a second work tree, so that a patch that fails leaves the tree as it
# was, and so that only files that do change are touched and compiled again.
apply_hooks() {
    local made
    second_tree made
    commit_hooks "$made"
    git -C "$tree" reset -q --hard "$(git -C "$made" rev-parse HEAD)"
}

# format_patches RANGE FOLDER: the same bytes for the same commits, whoever makes them
format_patches() {
    GIT_CONFIG_GLOBAL=/dev/null git -C "$tree" format-patch -q --no-numbered --zero-commit \
        --no-signature --abbrev=12 -o "$2" "$1"
}

# A link that an editor has replaced by a file of its own
edited_links() {
    local file
    while read -r file; do
        if [ -f "$tree/$file" ] && [ ! -L "$tree/$file" ] && ! cmp -s "$tree/$file" "$overlay/$file"; then
            echo "$file"
        fi
    done < <(overlay_files)
}

link_overlay() {
    local file target
    git -C "$tree" ls-files --others --ignored --exclude-from=.git/info/exclude 2>/dev/null |
        { grep -v '^build' || true; } | while read -r file; do
        [ ! -L "$tree/$file" ] || [ -e "$overlay/$file" ] || rm -f "$tree/$file"
    done
    printf '/build*/\n' >"$tree/.git/info/exclude.new"
    while read -r file; do
        mkdir -p "$(dirname "$tree/$file")"
        target=$(realpath -s --relative-to="$(dirname "$tree/$file")" "$overlay/$file")
        [ "$(readlink "$tree/$file" || true)" = "$target" ] || ln -sfn "$target" "$tree/$file"
        echo "/$file"
    done < <(overlay_files) >>"$tree/.git/info/exclude.new"
    mv "$tree/.git/info/exclude.new" "$tree/.git/info/exclude"
}

refuse_to_lose_edits() {
    local edits
    edits=$(
        git -C "$tree" status --porcelain
        edited_links
        [ "$(git -C "$tree" rev-parse HEAD)" = "$(cat "$tree/.git/kbuffer-tip" 2>/dev/null ||
            git -C "$tree" rev-parse upstream)" ] || echo "commits of your own"
    )
    [ -z "$edits" ] ||
        die "mesa-patches has changed, and ${tree#"$root"/} has edits that are not in it" \
            "$(head -n 5 <<<"$edits")" \
            "Take them over with scripts/patch refresh, or drop them:" \
            "git -C ${tree#"$root"/} reset --hard \$(cat ${tree#"$root"/}/.git/kbuffer-tip)"
}

# The stamp is written last: an interrupted run does the whole again.
stamp_tree() {
    git -C "$tree" rev-parse HEAD >"$tree/.git/kbuffer-tip"
    series_hash >"$tree/.git/kbuffer-series"
}

# build/mesa as mesa-patches says
prepare_tree() {
    [ -d "$tree/.git" ] || unpack_tree "$tree"
    [ "$(cat "$tree/.git/kbuffer-series" 2>/dev/null)" != "$(series_hash)" ] || return 0
    refuse_to_lose_edits
    say "Patching: $(hook_files | wc -l) hooks, $(overlay_files | wc -l) overlay files"
    apply_hooks
    link_overlay
    stamp_tree
}

# build/stock-mesa: the release as it is
prepare_stock_tree() {
    [ -d "$build/stock-mesa/.git" ] || unpack_tree "$build/stock-mesa"
}
