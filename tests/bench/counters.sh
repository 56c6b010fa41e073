# Shared by the tests that read the bench's JSON.
# SPDX-License-Identifier: MIT
passed=0
failed=0

# counter FILE NAME: the values of that counter, one strategy a line, in order.
counter() { sed -n "s/^ *\"$2\": \\(.*[^,]\\),\\{0,1\\}\$/\\1/p" "$1"; }

# same FILE NAME: all strategies have one value of it; prints that.
same() { counter "$1" "$2" | sort -u; }

# is NAME HAVE WANTED
is() {
  if [ "$2" = "$3" ]; then passed=$((passed + 1)); else
    printf 'FAILED %s: %s, not %s\n' "$1" "$2" "$3"
    failed=$((failed + 1))
  fi
}

# true_that NAME AWK_CONDITION
true_that() {
  if awk "BEGIN { exit !($2) }"; then passed=$((passed + 1)); else
    printf 'FAILED %s: %s\n' "$1" "$2"
    failed=$((failed + 1))
  fi
}

finish() {
  printf '%s passed, %s failed\n' "$passed" "$failed"
  [ "$failed" -eq 0 ]
}

skip() {
  echo "SKIPPED: $1"
  exit 77
}
