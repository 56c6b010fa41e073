#!/bin/sh
# The commit that the bench writes is that of the tree as it is built: looked up anew, never stale, `unknown` without git.
# SPDX-License-Identifier: MIT
# usage: commit.sh CMAKE SOURCE
cmake=$1
script=$2/bench/commit.cmake
. "$(dirname "$0")/check.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
GIT_CEILING_DIRECTORIES=$work
export GIT_CEILING_DIRECTORIES

mkdir plain tree
told() { "$cmake" -DSOURCE="$work/$1" -DOUT="$work/commit.h" -P "$script" && cat "$work/commit.h"; }
expect 'no git tree' 0 '^#define PORTCULLIS_COMMIT "unknown"$' told plain
if command -v git >/dev/null; then
  in_tree() { git -C tree -c user.name=test -c user.email=test@example.org -c commit.gpgsign=false "$@" >/dev/null 2>&1; }
  in_tree init
  : > tree/file
  mkdir tree/inner
  in_tree add file
  in_tree commit -m one
  first=$(git -C tree rev-parse --short=12 HEAD)
  expect 'a commit' 0 "^#define PORTCULLIS_COMMIT \"$first\"\$" told tree
  touch -d '2001-02-03' commit.h
  told tree >/dev/null
  holds 'the same commit leaves the header alone' test plain -nt commit.h
  echo change > tree/file
  expect 'a changed tree' 0 "\"$first-dirty\"" told tree
  in_tree commit -am two
  second=$(git -C tree rev-parse --short=12 HEAD)
  holds 'another commit' test "$first" != "$second"
  expect 'the next commit' 0 "\"$second\"" told tree
  expect 'a folder inside of another tree' 0 '"unknown"' told tree/inner
else
  printf 'SKIPPED commits: no git here\n' >&2
fi
no_git() { PATH=$work/plain "$cmake" -DSOURCE="$work/tree" -DOUT="$work/commit.h" -P "$script" && cat "$work/commit.h"; }
expect 'git is missing' 0 '"unknown"' no_git
finish
