#!/bin/sh
# ./run on machines that are not as it likes: wrong words, no apt, no root, missing packages, broken apt. Nothing is
# installed here: dpkg-query, apt-get, id and cmake are stand-ins. usage: run_script.sh ROOT
# SPDX-License-Identifier: MIT
# shellcheck disable=SC2016,SC2317 # stand-ins expand when they run; conditions are called by check
set -eu
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
bin=$work/bin

tool() { # NAME BODY: a stand-in
    printf '#!/bin/sh\n%s\n' "$2" >"$bin/$1"
    chmod +x "$bin/$1"
}
fresh() {
    rm -rf "$work/tree" "$bin"
    mkdir -p "$work/tree/packaging" "$bin"
    cp "$root/run" "$work/tree/run"
    printf '# a list\nalpha  # needed\n\nbeta # too\n' >"$work/tree/packaging/apt.txt"
    for name in sh sed cat dirname awk printf env rm mkdir; do ln -s "$(command -v $name)" "$bin/$name"; done
    tool id 'echo 0'
    tool dpkg-query 'for last; do :; done; case $last in alpha) echo "ii " ;; *) exit 1 ;; esac'
    tool apt-get 'echo "apt-get $*" >>"$LOG"; echo apt speaks'
    tool cmake 'echo "cmake $*" >>"$LOG"; echo cmake speaks'
}
go() { # ./run with the stand-ins only; sets status
    : >"$work/log"
    status=0
    env -i LOG="$work/log" PATH="$bin" "$bin/sh" "$work/tree/run" "$@" >"$work/out" 2>"$work/err" </dev/null || status=$?
}
check() { # WHAT CONDITION...
    what=$1
    shift
    if ! "$@"; then
        echo "failed: $what (status $status)"
        sed 's/^/    err: /' "$work/err"
        sed 's/^/    out: /' "$work/out"
        sed 's/^/    log: /' "$work/log"
        failed=1
    fi
}
says() { grep -q -e "$1" "$work/err"; }
logs() { grep -q -e "$1" "$work/log"; }
not() { ! "$@"; }

fresh
go --help
check "--help is good and names the commands" grep -q '^  test  ' "$work/out"
check "--help ends well" [ $status = 0 ]
go
check "no command is bad usage" [ $status = 2 ]
go frobnicate
check "an unknown word is bad usage" [ $status = 2 ]
check "an unknown word is named" says frobnicate
go build demo
check "two commands are bad usage" [ $status = 2 ]
go build --long
check "--long belongs to test" [ $status = 2 ]

fresh
go build
check "what is missing is installed" logs 'install.*--no-install-recommends beta$'
check "what is there is not" not logs alpha
check "lists are updated before" logs 'update'
check "it ends well" [ $status = 0 ]
check "the last line on stdout is the executable" [ "$(tail -n 1 "$work/out")" = "$work/tree/build/release/bin/portcullis" ]
check "nothing else is on stdout" [ "$(wc -l <"$work/out")" = 1 ]

tool dpkg-query 'echo "ii "'
go build
check "a second call asks apt for nothing" not logs apt-get
tool dpkg-query 'echo "hi "'
go build
check "a package on hold is there" not logs apt-get
tool dpkg-query 'echo "rc "'
go build
check "a removed package is missing" logs 'install.*alpha beta'

fresh
go build --no-install
check "--no-install asks apt for nothing" not logs apt-get
check "--no-install names what is missing" says beta
check "--no-install goes on" logs 'cmake --build'

fresh
tool apt-get 'echo "apt-get $*" >>"$LOG"; exit 100'
go build
check "a failing apt is told" says 'apt-get could not install'
check "a failing apt is exit 2" [ $status = 2 ]
check "a failing apt builds nothing" not logs cmake

fresh
tool id 'echo 1000'
go build
check "without root and sudo the command to say is told" says 'apt-get install --no-install-recommends beta'
check "without root and sudo is exit 2" [ $status = 2 ]
tool sudo 'echo "sudo $*" >>"$LOG"; "$@"'
go build
check "without root sudo is used" logs 'sudo env DEBIAN_FRONTEND=noninteractive apt-get.*install'

fresh
rm "$bin/apt-get" "$bin/dpkg-query"
go build
check "no apt is told" says 'packaging/apt.txt'
check "no apt is exit 2" [ $status = 2 ]
go build --no-install
check "no apt and --no-install goes on" [ $status = 0 ]

fresh
tool cmake 'exit 1'
go build
check "a failing configure is exit 2" [ $status = 2 ]
check "a failing configure leaves stdout empty" [ ! -s "$work/out" ]
exit $failed
