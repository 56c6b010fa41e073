#!/bin/sh
# The camera paths that are kept here, as they were made. City N is a part of every larger one, so its paths serve all of them.
# usage: make.sh PORTCULLIS SCENES; SCENES: the folder of real scenes, with city/delft.obj
# SPDX-License-Identifier: MIT
set -e
portcullis=$1 scenes=$2 here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
made() { "$portcullis" generate views --scene "$1" --views "$2" -o "$here/$3.views"; } # SCENE VIEWS NAME

"$portcullis" generate city --size 1000 -o "$work/city.boxes"
made "$work/city.boxes" auto:street:100 city-street # 2.4 m a view
made "$work/city.boxes" auto:roofs:100 city-roofs   # 2.4 m a view, 3 m over the roofs
made "$work/city.boxes" auto:walk:400 city-smooth   # 0.3 m a view
made "$work/city.boxes" auto:turn:100 city-turn     # the same, 15 degrees a view
made "$scenes/city/delft.obj" auto:street:100 delft-street
made "$scenes/city/delft.obj" auto:roofs:100 delft-roofs
made "$scenes/city/delft.obj" auto:turn:100 delft-turn
