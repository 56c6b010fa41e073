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

# check NAME VALUE COMPARED LIMIT: a line that says whether it holds, with the figure; none doesn't.
check() { # NAME VALUE COMPARED LIMIT
  if [ -n "$2" ] && [ "$2" != null ] && awk "BEGIN { exit !($2 $3 $4) }"; then
    passed=$((passed + 1)) word=PASS
  else
    failed=$((failed + 1)) word=FAIL
  fi
  printf '%s %s: %s %s %s\n' "$word" "$1" "${2:-none}" "$3" "$4"
}

finish() {
  printf '%s passed, %s failed\n' "$passed" "$failed"
  [ "$failed" -eq 0 ]
}

skip() {
  echo "SKIPPED: $1"
  exit 77
}
