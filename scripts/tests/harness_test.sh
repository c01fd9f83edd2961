# shellcheck shell=bash
# The harness of these tests

test_each_check_counts() {
    # shellcheck disable=SC2016 # expanded by the inner shell
    run 0 bash -c '. scripts/tests/harness.sh
        test_first_fails() {
            [ 1 = 2 ]
            true
        }
        run_test test_first_fails
        echo "$passed passed, $failed failed"'
    prints "not ok first_fails"
    prints "failed: [ 1 = 2 ]"
    prints "0 passed, 1 failed"
}
