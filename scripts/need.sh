#!/bin/sh
# need.sh FILE PACKAGE [WHY]: makes sure that FILE (a path, or a command's name) is there, from Debian's PACKAGE.
# Without root it only looks: what is missing is named, never skipped.
set -eu
file=$1 package=$2 why=${3:-}
have() {
    case $file in
    /*) [ -e "$file" ] ;;
    *) command -v "$file" >/dev/null 2>&1 ;;
    esac
}
have && exit 0
if [ "$(id -u)" = 0 ]; then as_root=
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then as_root="sudo -n"
else
    echo "$file is missing${why:+ ($why)}: ask for Debian's package $package to be installed" >&2
    exit 1
fi
if ! command -v apt-get >/dev/null 2>&1; then
    echo "$file is missing${why:+ ($why)}, and there is no apt-get here to install $package with" >&2
    exit 1
fi
echo "installing $package${why:+ ($why)}" >&2
$as_root apt-get update -qq
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-remove --no-install-recommends "$package" >/dev/null
have || { echo "$package was installed but $file is still missing" >&2; exit 1; }
