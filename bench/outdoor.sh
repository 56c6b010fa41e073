#!/bin/sh
# What occlusion draws, misses and costs outdoors and indoors: the long tier of tests/claims/outdoor.sh, kept in bench/results/outdoor.txt.
# usage: outdoor.sh PORTCULLIS SCENES [city|terrain|delft|flagship|maps|cheap|last...] > bench/results/outdoor.txt
# SPDX-License-Identifier: MIT
portcullis=$1
export PORTCULLIS_SCENES="$2" PORTCULLIS_LONG=1
shift 2
exec sh "$(dirname "$0")/../tests/claims/outdoor.sh" "$portcullis" "$@"
