#!/bin/sh
# unpack.sh PACKAGE...: unpacks Debian packages, and what they need that is not installed, below $CROSS/debian. Nothing is
# installed: an emulator or a second compiler of Debian's may stand in the way of what the machine has.
set -eu
cross=${CROSS:-target/cross}
root=$cross/debian
mkdir -p "$root"
downloads=$(mktemp -d "$cross/downloads.XXXXXX")
trap 'rm -rf "$downloads"' EXIT
if [ "$(id -u)" = 0 ]; then as_root= sandbox="-o APT::Sandbox::User=root"
else as_root="sudo -n" sandbox=
fi
# The packages asked for, and all that installing them would bring.
download() {
    packages=$( (apt-get install -s --no-install-recommends "$@" | awk '/^Inst /{print $2}' && printf '%s\n' "$@") | sort -u)
    # shellcheck disable=SC2086
    (cd "$downloads" && apt-get -qq $sandbox download $packages)
}
echo "fetching $*" >&2
# A bare machine knows no packages, and a list may be older than what is offered.
if ! download "$@" >/dev/null 2>&1; then
    (flock 7 && $as_root apt-get update -qq) 7>"$cross/lock.update"
    download "$@" >&2
fi
for package in "$downloads"/*.deb; do
    # Of the sources of Rust the library is needed.
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$root" --no-wildcards-match-slash \
        --exclude=./usr/share/doc --exclude=./usr/share/man --exclude="./usr/src/rustc-*/src" --exclude="./usr/src/rustc-*/compiler"
done
