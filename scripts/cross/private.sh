#!/bin/sh
# private.sh COMMAND PACKAGE...: the path of a command that Debian's packages have, from the machine or unpacked.
set -eu
here=$(dirname "$0")
cross=${CROSS:-target/cross}
command=$1
shift
if command -v "$command"; then exit; fi
mkdir -p "$cross/bin"
cross=$(cd "$cross" && pwd)
place=$cross/bin/$command
exec 9>"$cross/lock.private"
flock 9
if [ ! -x "$place" ]; then
    CROSS=$cross "$here/unpack.sh" "$@"
    root=$cross/debian
    system=$(gcc -print-multiarch)
    # Emulators look for their firmware where they would be installed.
    case $command in qemu-system-*) more="-L $root/usr/share/qemu" ;; *) more= ;; esac
    printf '#!/bin/sh\nLD_LIBRARY_PATH=%s exec %s %s "$@"\n' "$root/usr/lib/$system:$root/lib/$system" \
        "$root/usr/bin/$command" "$more" >"$place.new"
    chmod +x "$place.new"
    mv "$place.new" "$place"
fi
echo "$place"
