# Running programs on the Mesa of scripts/build --sanitize. To be sourced after common.sh.
# shellcheck shell=bash

# use_sanitizers: every report ends the program, and so does what it has not freed when it ends.
# Programs that are not themselves sanitized need LD_PRELOAD=$sanitizer_runtime.
use_sanitizers() {
    local suppressions=$root/scripts/lib/sanitize-suppressions symbolizer
    sanitizer_runtime=$(clang -print-file-name="libclang_rt.asan-$(uname -m).so")
    [ -f "$sanitizer_runtime" ] || die "Clang has no runtime of AddressSanitizer" \
        "Install its package (libclang-rt-dev)."
    symbolizer=$(find /usr/lib/llvm-*/bin /usr/bin -name llvm-symbolizer -print -quit 2>/dev/null)
    export ASAN_SYMBOLIZER_PATH=$symbolizer UBSAN_SYMBOLIZER_PATH=$symbolizer
    export ASAN_OPTIONS=abort_on_error=1:detect_leaks=1
    export LSAN_OPTIONS=suppressions=$suppressions/leaks.txt:print_suppressions=0
    export UBSAN_OPTIONS=abort_on_error=1:halt_on_error=1:print_stacktrace=1
    UBSAN_OPTIONS+=:suppressions=$suppressions/undefined.txt
    export TSAN_OPTIONS=halt_on_error=0:suppressions=$suppressions/races.txt
    TSAN_OPTIONS+=:external_symbolizer_path=$symbolizer
}
