# shellcheck shell=bash
# The comparison of piglit's results on stock Mesa and on ours, with made-up results.

compare=(/usr/bin/python3 -B "$source_root/piglit-tests/regression/compare.py")

# results FOLDER TEST[#SUBTEST]=STATUS...: what piglit would write
results() {
    /usr/bin/python3 - "$@" <<'PYTHON'
import json, os, sys
tests = {}
for word in sys.argv[2:]:
    name, status = word.split("=")
    test, _, subtest = name.partition("#")
    made = tests.setdefault(test, {"result": "pass", "subtests": {"__type__": "Subtests"}})
    if subtest:
        made["subtests"][subtest] = status
    else:
        made["result"] = status
os.makedirs(sys.argv[1], exist_ok=True)
json.dump({"tests": tests}, open(sys.argv[1] + "/results.json", "w"))
PYTHON
}

profile() { # TEST...
    local test
    {
        echo '<PiglitTestList>'
        for test in "$@"; do echo "<Test type=\"gl\" name=\"$test\"/>"; done
        echo '</PiglitTestList>'
    } | gzip >"$project/all.xml.gz"
}

# judged STATUS FOLDER...: exit status; the output is in $output
judged() {
    : >>"$project/flakes.txt"
    run "$1" "${compare[@]}" judge a all.xml.gz flakes.txt out.json "${@:2}"
}

# compared STOCK OURS STATUS: one more test, that passes on both, beside
compared() {
    profile other test
    results "$project/stock" other=pass "test=$1"
    results "$project/ours" other=pass "test=$2"
    judged "$3" stock ours
}

test_regression_what_passes_on_stock_must_pass_on_ours() {
    local status
    for status in warn skip fail timeout crash incomplete notrun; do
        compared pass $status 1
        prints "a: regression: test: stock pass, ours"
        prints "a: 1 passed, 1 failed, 0 skipped"
    done
    results "$project/ours" other=pass
    judged 1 stock ours
    prints "a: regression: test: stock pass, ours missing"
    compared pass pass 0
    prints "a: 2 passed, 0 failed, 0 skipped"
    lines 3
}

test_regression_what_fails_on_stock_must_not_crash() {
    compared fail fail 0
    prints "a: 1 passed, 0 failed, 0 skipped"
    compared fail skip 0
    compared crash fail 0
    prints "a: better: test: stock crash, ours fail"
    compared fail pass 0
    compared skip skip 0
    compared fail crash 1
    compared fail timeout 1
    compared skip fail 1
}

test_regression_subtests_count_each() {
    profile test
    results "$project/stock" test=fail test#one=pass "test#two words=pass" test#three=fail
    results "$project/ours" test=fail test#one=fail "test#two words=pass" test#three=pass
    judged 1 stock ours
    prints "a: regression: test#one: stock pass, ours fail"
    prints "a: better: test#three: stock fail, ours pass"
    prints "a: 1 passed, 1 failed, 0 skipped"
    # A subtest that is gone, the test being as it was
    results "$project/ours" test=fail "test#two words=pass" test#three=fail
    judged 1 stock ours
    prints "a: regression: test#one: stock pass, ours missing"
    # The subtests behind a crash are not told one by one.
    results "$project/ours" test=crash test#one=pass
    judged 1 stock ours
    prints "a: regression: test: stock fail, ours crash"
    prints "a: 1 passed, 1 failed, 0 skipped"
    # But they do not vanish in a test that got better.
    results "$project/ours" test=pass test#one=pass test#three=pass
    judged 1 stock ours
    prints "a: regression: test#two words: stock pass, ours missing"
    # The test is not counted beside its subtests.
    results "$project/stock" test=pass test#one=pass test#two=pass
    judged 0 stock stock
    prints "a: 2 passed, 0 failed, 0 skipped"
}

test_regression_runs_again_tell_flakes() {
    profile other test
    results "$project/good" other=pass test=pass
    results "$project/bad" other=pass test=fail
    # Never again, or on stock, too: a flake
    judged 0 good bad good good good good
    prints "a: flake: test: stock pass pass pass, ours fail pass pass"
    judged 0 good bad good bad bad good
    prints "a: flake: test: stock pass pass fail, ours fail fail pass"
    # Again once is enough, as stock never fails.
    judged 1 good bad good good good bad
    prints "a: regression: test: stock pass pass pass, ours fail pass fail"
    # Stock fails now and then, and ours crashes.
    results "$project/worst" other=pass test=crash
    judged 1 good bad bad worst
    # A run again of stock that did not get to the test excuses nothing.
    results "$project/none" other=pass
    judged 1 good bad none bad
}

test_regression_listed_flakes_are_shown_and_not_counted() {
    echo 'test#with words  # varies on stock' >"$project/flakes.txt"
    profile test
    results "$project/stock" test=fail "test#with words=pass" test#one=pass
    results "$project/ours" test=fail "test#with words=fail" test#one=pass
    judged 0 stock ours
    prints "a: listed flake: test#with words: stock pass, ours fail"
    echo 'test' >"$project/flakes.txt"
    judged 1 stock ours
    prints "flakes.txt: no reason: test"
    lines 1
}

test_regression_silence_is_no_success() {
    profile other test
    results "$project/stock" other=pass
    results "$project/ours" other=pass test=fail
    judged 1 stock ours
    prints "a: no result on stock: test"
    judged 1 stock stock
    prints "a: no result: test"
    compared skip skip 0
    results "$project/stock" other=skip test=fail
    judged 1 stock stock
    prints "a: nothing passed"
}

test_regression_malformed_results_are_one_line() {
    compared pass pass 0
    echo '{"tests": {"test": 7}}' >"$project/ours/results.json"
    judged 1 stock ours
    prints "ours/results.json: no results of piglit"
    lines 1
    results "$project/ours" other=pass test=splendid
    judged 1 stock ours
    prints "unknown result 'splendid'"
    lines 1
    rm "$project/ours/results.json"
    judged 1 stock ours
    lines 1
    echo >"$project/all.xml.gz"
    judged 1 stock stock
    lines 1
}

test_regression_only_what_is_worse_runs_again() {
    profile one two three
    results "$project/stock" one=pass two=fail three=pass
    results "$project/ours" one=fail two=pass three=pass
    run 0 "${compare[@]}" worse all.xml.gz stock ours
    prints 1
    run 0 zcat all-again.xml.gz
    prints 'name="one"'
    [[ $output != *two* && $output != *three* ]]
}

test_regression_page_shows_what_was_judged() {
    local table=$source_root/piglit-tests/regression/table.py text
    local page=(/usr/bin/python3 -B "$table" page.html "A <page>")
    cat >"$project/judgement.json" <<'JSON'
{"driver": "llvm<pipe", "tests": 12, "passed": 10, "failed": 1, "stock": {"pass": 11, "fail": 1},
 "ours": {"pass": 10, "fail": 2}, "rows": [{"verdict": "regression", "name": "spec@a & b",
 "stock": ["pass"], "ours": ["fail", "crash"]}]}
JSON
    run 0 "${page[@]}" judgement.json
    for text in "<h1>A &lt;page&gt;</h1>" "llvm&lt;pipe: 10 pass on both, 1 are worse on ours." \
        "<td class=\"text\">stock</td><td>12</td><td>11</td><td>0</td><td>0</td><td>1</td>" \
        "<tr class=\"failure\"><td class=\"text\">llvm&lt;pipe</td>" "spec@a &amp; b" "fail crash"; do
        grep -qF "$text" "$project/page.html" || {
            echo "the page lacks: $text"
            exit 1
        }
    done
    rm "$project/page.html"
    sed -i 's/"passed"/"past"/' "$project/judgement.json"
    run 1 "${page[@]}" judgement.json
    prints "judgement.json: a key is missing: "
    prints "'passed'"
    lines 1
    absent page.html
}
