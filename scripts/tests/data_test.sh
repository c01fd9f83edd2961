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

# apt-get stands in for a mirror with one package, as those of real mirrors are signed.
test_data_from_a_debian_package() {
    make_model
    local member=usr/share/small/small.ply
    mkdir -p "$work/package/DEBIAN" "$work/package/usr/share/small" "$work/bin"
    cp "$work/models/small.ply" "$work/package/$member"
    printf 'Package: small\nVersion: 1\nArchitecture: all\nMaintainer: x\nDescription: x\n' \
        >"$work/package/DEBIAN/control"
    dpkg-deb --build "$work/package" "$work/small_1_all.deb" >/dev/null
    cat >"$work/bin/apt-get" <<END
#!/bin/sh
case "\$*" in
*indextargets*) echo 'bookworm http://127.0.0.1:9/' ;;
*update) ;;
*download\ small) cp $work/small_1_all.deb . ;;
*) exit 1 ;;
esac
END
    chmod +x "$work/bin/apt-get"
    sed -i "s|^export PATH=|export PATH=$work/bin:|" "$project/scripts/lib/common.sh"
    sed -i 's|"npm": {.*},|"debian": {"suite": "bookworm", "package": "small", "member": "'"$member"'"},|' \
        "$project/scripts/data.json"
    run 0 env "${offline[@]}" scripts/fetch-data
    prints "from the package small of Debian bookworm"
    cmp "$work/models/small.ply" "$project/build/data/small.ply"
    no_temporaries
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
    run 2 scripts/fetch-data --list dragon
    prints "--list takes no names, not 'dragon'"
    absent build
}
