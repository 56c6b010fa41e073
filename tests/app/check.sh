# Shared by the tests of the command line: runs a command, compares exit code and words, counts.
# SPDX-License-Identifier: MIT
failed=0
passed=0

# expect NAME CODE PATTERN COMMAND...: exit code CODE, and output (both streams) matching the extended PATTERN.
expect() {
  name=$1 code=$2 pattern=$3
  shift 3
  output=$("$@" 2>&1 </dev/null)
  got=$?
  if [ "$got" -ne "$code" ]; then
    printf 'FAILED %s: exit code %s, not %s\n%s\n' "$name" "$got" "$code" "$output"
    failed=$((failed + 1))
  elif ! printf '%s\n' "$output" | grep -Eq -- "$pattern"; then
    printf 'FAILED %s: output does not match %s\n%s\n' "$name" "$pattern" "$output"
    failed=$((failed + 1))
  else
    passed=$((passed + 1))
  fi
}

# holds NAME COMMAND...: the command succeeds.
holds() {
  name=$1
  shift
  if "$@" >/dev/null 2>&1; then passed=$((passed + 1)); else
    printf 'FAILED %s\n' "$name"
    failed=$((failed + 1))
  fi
}

finish() {
  printf '%s passed, %s failed\n' "$passed" "$failed"
  [ "$failed" -eq 0 ]
}
