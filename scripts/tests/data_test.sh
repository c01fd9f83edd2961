# shellcheck shell=bash
# scripts/fetch-data with a small model

make_model() {
    mkdir "$work/models"
    echo model >"$work/models/small.ply"
    cat >"$project/scripts/data.json" <<END
{"small": {"file": "small.ply", "what": "a small model", "size": 6, "origin": "a test",
 "licence": "none", "sha256": "$(sha256sum <"$work/models/small.ply" | cut -d' ' -f1)",
 "npm": {"package": "no-such-package-of-ours", "version": "0.0.0", "member": "package/small.ply.gz"},
 "archive": {"url": "http://127.0.0.1:9/small.tar.gz", "member": "small.ply"}}}
END
}

test_data_from_a_folder() {
    make_model
    run 0 env "${offline[@]}" KBUFFER_DATA_DIR="$work/models" scripts/fetch-data small
    cmp "$work/models/small.ply" "$project/build/data/small.ply"
    run 0 env "${offline[@]}" scripts/fetch-data
    [ -z "$output" ]
}

test_data_with_a_wrong_checksum() {
    make_model
    echo other >"$work/models/small.ply"
    run 1 env "${offline[@]}" KBUFFER_DATA_DIR="$work/models" scripts/fetch-data
    prints "wrong checksum"
    absent build/data/small.ply
    no_temporaries
}

test_data_without_network() {
    make_model
    run 1 env "${offline[@]}" scripts/fetch-data
    prints "cannot be fetched"
    prints "KBUFFER_DATA_DIR"
    absent build/data/small.ply
}

test_damaged_data_is_fetched_again() {
    make_model
    mkdir -p "$project/build/data"
    echo damaged >"$project/build/data/small.ply"
    run 0 env "${offline[@]}" KBUFFER_DATA_DIR="$work/models" scripts/fetch-data
    cmp "$work/models/small.ply" "$project/build/data/small.ply"
}

test_unknown_model() {
    run 2 scripts/fetch-data elephant
    prints dragon
    lines 1
}

test_data_list() {
    run 0 scripts/fetch-data --list
    prints "871,414 triangles"
    prints "licence"
    absent build
}
