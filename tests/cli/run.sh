#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs one test script in an empty folder: run.sh SCRIPT PROGRAM FOLDER. Scripts source nothing; these are their words.
set -u
script=$(realpath "$1")
tsuya=$(realpath "$2")
rm -rf "$3"
mkdir -p "$3"
cd "$3" || exit 1
export TSUYA_CACHE=$PWD/cache
export NO_COLOR=1
failures=0

fail() { echo "FAIL: $*" >&2; failures=$((failures + 1)); }
# skip WHY: what was run so far holds, the rest cannot be run here.
skip() { echo "skipped: $*" >&2; [ "$failures" -eq 0 ] && exit 77; exit 1; }
# expect STATUS command...: runs it, output in out.txt and err.txt.
expect() {
    local want=$1
    shift
    "$@" >out.txt 2>err.txt
    local got=$?
    [ "$got" -eq "$want" ] || { fail "status $got, expected $want: $*"; sed 's/^/    /' err.txt >&2; }
}
# says TEXT: the last command's standard error holds it.
says() { grep -qF -- "$1" err.txt || { fail "no '$1' in the messages:"; sed 's/^/    /' err.txt >&2; }; }
prints() { grep -qF -- "$1" out.txt || { fail "no '$1' in the output:"; sed 's/^/    /' out.txt >&2; }; }
absent() { [ ! -e "$1" ] || fail "$1 should not exist"; }
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }

source "$script"
leftovers=$(find . -name '*.tmp-*' -o -name '.*tmp*' -type f | head -n 5)
[ -z "$leftovers" ] || fail "temporaries left: $leftovers"
[ "$failures" -eq 0 ]
