# A bare Debian 12 in a directory, and commands that root runs in it. A script sources this file in place of dev_lib.sh.
# shellcheck shell=bash
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/dev_lib.sh"

# The cache of the compiler that a root directory shares, if any.
shared_cache=

debian_sources() { compgen -G '/etc/apt/sources.list.d/debian.sources' || echo /etc/apt/sources.list; }

# Makes a bare Debian 12 from this machine's own package sources: a directory or, by the name, a tar file.
make_debian() {
  local target=$1
  shift
  mmdebstrap --quiet --variant=minbase "$@" bookworm "$target" "$(debian_sources)"
}

# Runs a line of shell in a root directory, in mount and process namespaces of its own: nothing stays mounted and no
# process is left when it ends. The third argument names a compiler cache that the commands share, if any; what the
# cache holds depends on the language of messages.
in_root() {
  # shellcheck disable=SC2016  # The inner shell expands these.
  unshare --mount --pid --fork --kill-child sh -ec '
    mount -t proc proc "$0/proc"
    mkdir -p "$0/root/.cache/ccache"
    [ -z "$2" ] || mount --bind "$2" "$0/root/.cache/ccache"
    exec chroot "$0" env -i HOME=/root TERM=dumb ${LANG:+LANG=$LANG} \
      PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=/root/ricochet sh -ec "$1"' "$1" "$2" "${3-}"
}

# Makes a bare Debian 12 with a clone of this repository in $temporary/root and runs a line of shell in it, at the top
# of the clone; further arguments are mmdebstrap's.
run_in_fresh_debian() {
  local line=$1
  shift
  install_missing mmdebstrap git
  temporary=$(mktemp -d /var/tmp/ricochet-fresh.XXXXXX)
  local root=$temporary/root
  say "A bare Debian 12 in $root, with a clone of $(git rev-parse --short HEAD)"
  make_debian "$root" "$@"
  # The installer of Debian writes this on every machine.
  printf '127.0.0.1 localhost\n::1 localhost\n' >"$root/etc/hosts"
  git clone --quiet --no-hardlinks . "$root/root/ricochet"
  in_root "$root" "cd /root/ricochet; $line" "$shared_cache"
}
