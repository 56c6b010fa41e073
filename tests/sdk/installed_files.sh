#!/bin/sh
# What is installed: components, nothing that holds a path of the build, versions that are asked for.
# SPDX-License-Identifier: MIT
# usage: installed_files.sh CMAKE BUILD SOURCE
set -u # expect and holds look at exit codes
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$here/install.sh"
. "$here/../app/check.sh"
cmake=$1
install_moved "$1" "$2"

no_paths() { # text files, and the run paths of binaries
    ! grep -rlFI -e "$1" -e "$2" -e /nowhere/at/all "$sdk" && ! find "$sdk" -type f -name '*.so*' -exec readelf -d {} + | grep -E 'R(UN)?PATH'
}
holds 'no path of source, build or prefix' no_paths "$2" "$3"
no_run_path() { ! readelf -d "$portcullis" | grep -E 'R(UN)?PATH'; }
holds 'nor in the executable' no_run_path
library=$(find "$sdk" -name 'libportcullis.so.*.*.*')
version=${library##*.so.}
expect 'the library has a name with the major version' 0 "SONAME.*\[libportcullis\.so\.${version%%.*}\]" readelf -d "$library"

mkdir "$work/ask" || exit 1
ask() { # CODE VERSION COMPONENTS...
    code=$1 asked=$2
    shift 2
    printf '%s\n' 'cmake_minimum_required(VERSION 3.20)' 'project(ask LANGUAGES C)' \
        "find_package(Portcullis $asked REQUIRED COMPONENTS $*)" >"$work/ask/CMakeLists.txt"
    rm -rf "$work/ask/made"
    expect "asked for $asked with $*" "$code" '' "$cmake" -S "$work/ask" -B "$work/ask/made" -DCMAKE_PREFIX_PATH="$sdk"
}
ask 0 "$version" plugin host tool
ask 1 99 plugin
ask 1 "$version" engine
rm "$portcullis" "$library"
ask 0 "$version" plugin
ask 1 "$version" plugin host

parts() { # COMPONENT: lists what it installs
    DESTDIR=$work/$1 "$cmake" --install "$build" --prefix /p --component "$1" >"$work/log" && (cd "$work/$1/p" && find . ! -type d)
}
build=$2
expect 'runtime has the executable' 0 '^\./bin/portcullis$' parts runtime
expect 'and plugins' 0 '/portcullis/octree\.culler\.so$' parts runtime
expect 'and the library' 0 '/libportcullis\.so\.[0-9]+$' parts runtime
expect 'development has the headers' 0 '^\./include/portcullis/culler\.h$' parts development
expect 'and the package' 0 'PortcullisConfig\.cmake$' parts development
expect 'and the link name' 0 '/libportcullis\.so$' parts development
only_runtime() { ! parts runtime | grep -E '\.(h|pc|cmake|map)$'; }
holds 'runtime has no file of development' only_runtime
only_development() { ! parts development | grep -E 'bin/|culler\.so$|\.so\.'; }
holds 'development none of runtime' only_development
finish
