#!/bin/sh
# ./run on a bare Debian 12 with git and nothing else, in a root made by debootstrap: builds, runs the demo, and a second
# call installs nothing and works without a network. Minutes and 1.5 GB: the long tier. usage: bare_debian.sh ROOT [worktree]
# SPDX-License-Identifier: MIT
# shellcheck disable=SC2016 # formats of apt-get and dpkg-query look like variables
set -eu
root=$1
what=${2:-HEAD} # HEAD: a fresh clone; worktree: the files as they are, for trying a change
LC_ALL=C
export LC_ALL

skip() {
    echo "skipped: $*"
    exit 77
}
[ "${PORTCULLIS_LONG:-0}" = 1 ] || skip "takes minutes and a network; ./run test --long"
[ "$(id -u)" = 0 ] || skip "needs root for chroot"
command -v debootstrap >/dev/null 2>&1 || skip "no debootstrap"
command -v git >/dev/null 2>&1 || skip "no git"

mirror() { # the first Debian 12 archive among this machine's apt sources
    if command -v apt-get >/dev/null 2>&1; then
        apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Created-By: Packages' 2>/dev/null | sed -n 's/^bookworm \([^ ]*\)$/\1/p' |
            head -n 1
    fi
}
archive=$(mirror)
[ -n "$archive" ] || skip "no Debian 12 archive among this machine's apt sources (after apt-get update)"

work=$(mktemp -d)
bare=$work/bare
clean_up() {
    umount "$bare/proc" 2>/dev/null || :
    rm -rf --one-file-system "$work"
}
trap clean_up EXIT
trap 'exit 1' INT TERM

within() { chroot "$bare" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/var "$@"; }
fail() {
    echo "failed: $*"
    exit 1
}

echo "making a bare Debian 12"
debootstrap --variant=minbase bookworm "$bare" "$archive" >"$work/debootstrap.log" 2>&1 || { tail -n 20 "$work/debootstrap.log"; fail "debootstrap"; }
mount -t proc proc "$bare/proc" 2>/dev/null || echo "no /proc inside"
for file in /etc/resolv.conf /etc/hosts; do [ ! -f $file ] || cp -L $file "$bare$file"; done
apt-config dump 2>/dev/null | grep -E '^Acquire::(http|https)::Proxy' >"$bare/etc/apt/apt.conf.d/proxy" || :
within apt-get -q update >"$work/apt.log" 2>&1 || { cat "$work/apt.log"; fail "apt-get update inside"; }
within DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends git >"$work/apt.log" 2>&1 ||
    { cat "$work/apt.log"; fail "git inside"; }
for tool in make cc gcc clang cmake ninja sudo python3; do
    ! within sh -c "command -v $tool" >/dev/null || fail "the root is not bare: it has $tool"
done

if [ "$what" = HEAD ]; then
    git -c safe.directory='*' clone -q --no-hardlinks "$root" "$bare/srv/portcullis"
else
    mkdir -p "$bare/srv/portcullis"
    (cd "$root" && git ls-files -co --exclude-standard -z | tar --null -T - -cf -) | tar -xf - -C "$bare/srv/portcullis"
fi
installed() { within dpkg-query -W -f='${Package} ${Version}\n'; }

echo "not root and no sudo: says what to do"
if chroot --userspec=nobody "$bare" sh -c 'cd /srv/portcullis && ./run build' >"$work/out" 2>&1; then fail "it built as nobody"; fi
grep -q 'apt-get install --no-install-recommends' "$work/out" || { cat "$work/out"; fail "no word about apt-get install"; }

echo "./run build"
within sh -c 'cd /srv/portcullis && ./run build' >"$work/out" 2>"$work/err" || { tail -n 60 "$work/err"; fail "./run build"; }
portcullis=$(tail -n 1 "$work/out")
[ -x "$bare$portcullis" ] || fail "its last line is no executable: $portcullis"
installed >"$work/before"
echo "$(wc -l <"$work/before") packages, $(du -smx "$bare" | cut -f 1) MB"

offline() { # nothing can be fetched where there is no network
    if unshare -n true 2>/dev/null; then unshare -n chroot "$bare" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/var "$@"; else within "$@"; fi
}
echo "./run build again, and ./run demo, offline"
offline sh -c 'cd /srv/portcullis && ./run build' >"$work/out" 2>"$work/err" || { tail -n 60 "$work/err"; fail "the second ./run build"; }
if grep -q 'installing' "$work/err"; then fail "the second ./run build installs"; fi
[ "$(tail -n 1 "$work/out")" = "$portcullis" ] || fail "the second ./run build ends in another line"
offline sh -c 'cd /srv/portcullis && ./run demo' >"$work/out" 2>"$work/err" || { tail -n 60 "$work/err"; fail "./run demo"; }
for file in table.txt bench.json demo.png demo.obj demo.views flagship_table.txt flagship.json flagship_60.png; do
    [ -s "$bare/srv/portcullis/out/demo/$file" ] || fail "./run demo wrote no $file"
done
grep -q frustum "$work/out" || fail "the demo's table has no frustum"
installed >"$work/after"
cmp "$work/before" "$work/after" || fail "a second call changed the packages"
cat "$work/out"
echo "a bare Debian 12 builds and runs it"
