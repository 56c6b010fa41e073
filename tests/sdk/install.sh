# Shared by the tests of the SDK: an install of the build tree, moved after installing, so that no path in it may hold.
# SPDX-License-Identifier: MIT
# install_moved CMAKE BUILD: sets work and sdk; a folder of its own, removed at the end
install_moved() {
    work=$(mktemp -d) || exit 1
    trap 'rm -rf "$work"' EXIT
    unset PORTCULLIS_PLUGIN_PATH DESTDIR PKG_CONFIG_PATH
    if ! command -v make >/dev/null 2>&1; then # what CMake takes where nobody says
        CMAKE_GENERATOR=Ninja
        export CMAKE_GENERATOR
    fi
    XDG_DATA_HOME=$work/data
    export XDG_DATA_HOME
    DESTDIR=$work/stage "$1" --install "$2" --prefix /nowhere/at/all >"$work/log" || { cat "$work/log"; exit 1; }
    mv "$work/stage/nowhere/at/all" "$work/sdk"
    sdk=$work/sdk
    portcullis=$sdk/bin/portcullis
    packages=$(dirname "$(find "$sdk" -name portcullis-plugin.pc)")
}
