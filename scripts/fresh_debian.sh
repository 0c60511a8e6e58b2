#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs commands on the committed files in a bare Debian 12, made by debootstrap in a folder of its own:
# by default the two of README.
#
# Usage: scripts/fresh_debian.sh [--keep] [--carry FOLDER] [--bring FOLDER] [COMMAND...]
#
#   --keep   leaves the system where it is, and says where
#   --carry  takes this folder of the checkout along, which git need not know
#   --bring  afterwards copies what is in this folder of the clone to that of the checkout
#   COMMAND  run by bash, in order, at the top of a clone of HEAD; the first that fails ends it
#
# Says how many sources were compiled, and fails if one was compiled twice: what has flags of its own
# unsets CCACHE_STATSLOG.
#
# Of this machine it takes the package sources and pip's settings, and what those name (certificates,
# folders of packages); nothing else. Needs root, and the right to mount. What it made is gone when it
# ends, however it ends; processes that the commands left running end with it.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly suite=bookworm
keep=false carry='' bring='' commands=()
while (($# > 0)); do
  case $1 in
    --keep) keep=true ;;
    --carry) carry=$2 && shift ;;
    --bring) bring=$2 && shift ;;
    -h | --help) usage && exit ;;
    -*) unknown_option "$1" ;;
    *) commands+=("$1") ;;
  esac
  shift
done
if ((${#commands[@]} == 0)); then commands=("bash scripts/demo.sh" "bash scripts/test.sh"); fi

((EUID == 0)) || die "debootstrap and chroot need root"
if ! command -v debootstrap >/dev/null || ! command -v git >/dev/null; then
  quietly "updating the package lists" apt-get update
  quietly "installing debootstrap" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends debootstrap git
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/iksel-debian.XXXXXX")
system=$work/system
# The checkout's name in there.
readonly home=/srv/iksel
# What ccache did, in there.
readonly ccache_log=/var/log/ccache
inside=
# Processes run in namespaces of their own, which end with `inside`, and all mounts with them: none stands
# where rm goes.
cleanup() {
  trap '' INT TERM HUP
  if [[ -n $inside ]]; then
    kill -KILL "$inside" 2>/dev/null || true
    wait "$inside" 2>/dev/null || true
  fi
  if $keep; then
    echo "kept: $system"
    return
  fi
  # The last of them may still be on its way out.
  rm -rf --one-file-system "$work" 2>/dev/null || { sleep 2 && rm -rf --one-file-system "$work"; }
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# Runs a command in the background and waits, so that a signal is heard at once.
isolated() { # COMMAND...
  unshare --mount --pid --fork --kill-child=KILL --mount-proc "$@" &
  inside=$!
  local status=0
  wait "$inside" || status=$?
  inside=
  return "$status"
}

host_is_alike() { grep -qx "VERSION_CODENAME=$suite" /etc/os-release; }

# The first source of the suite, or nothing: debootstrap then takes Debian's own.
mirror() {
  host_is_alike || return 0
  # shellcheck disable=SC2016  # apt's own variables
  apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' 2>/dev/null |
    awk -v suite="$suite" '$2 == suite { print $1; exit }'
}

copy_in() { # FILE...: to the same place, if there
  local file
  for file in "$@"; do
    if [[ -e $file ]]; then
      mkdir -p "$system$(dirname "$file")"
      cp -rLT "$file" "$system$file"
    fi
  done
}

copy_package_sources() {
  copy_in /etc/resolv.conf /etc/hosts
  apt-config dump Acquire >"$system/etc/apt/apt.conf.d/99host"
  host_is_alike || return 0
  rm -f "$system/etc/apt/sources.list"
  copy_in /etc/apt/sources.list /etc/apt/sources.list.d /etc/apt/trusted.gpg.d /etc/apt/keyrings
  # The keys that those files name.
  local key
  while read -r key; do copy_in "$key"; done < <(
    cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null |
      grep -oiE 'signed-by[:=] ?/[^] ]+' | grep -oE '/.*' | sort -u)
}

# Variables and files, with the certificates and folders of packages that they name.
copy_pip_settings() {
  copy_in /etc/pip.conf "$HOME/.config/pip" "$HOME/.pip"
  env | grep -E '^(PIP_|SSL_CERT_FILE|REQUESTS_CA_BUNDLE|(https?|no)_proxy|(HTTPS?|NO)_PROXY)' \
    >"$work/environment" || true
  : >"$work/folders"
  local path settings=("$work/environment")
  mapfile -t -O 1 settings < <(find "$system/etc/pip.conf" "$system$HOME/.config/pip" \
    "$system$HOME/.pip" -type f 2>/dev/null)
  while read -r path; do
    if [[ -f $path ]]; then
      # Under another name: Debian's package of certificates writes its own to the usual place.
      copy_in "$path"
      mkdir -p "$system/opt/host"
      mv "$system$path" "$system/opt/host/$(basename "$path")"
      sed -i "s,$path,/opt/host/$(basename "$path"),g" "${settings[@]}"
    elif [[ -d $path ]]; then
      # An index in a folder has its packages beside its pages.
      echo "${path%/simple}" >>"$work/folders"
    fi
  done < <(cat "${settings[@]}" | grep -oE "/[^ '\"]+" | sed -E 's,^/+,/,; s,/$,,' | sort -u)
}

enter() { # COMMAND
  # shellcheck disable=SC2016  # expanded inside
  isolated bash -euc '
    system=$1 home=$2 command=$3 ccache_log=$4
    mount -t proc proc "$system/proc"
    mount -t tmpfs tmpfs "$system/tmp"
    mount -t tmpfs tmpfs "$system/dev/shm"
    while read -r folder; do
      mkdir -p "$system$folder" && mount --bind -o ro "$folder" "$system$folder"
    done <"$system/../folders"
    mapfile -t environment <"$system/../environment"
    exec chroot "$system" env -i HOME="$HOME" TERM=dumb LANG=C.UTF-8 \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      IKSEL_WARNINGS_AS_ERRORS="$IKSEL_WARNINGS_AS_ERRORS" CCACHE_STATSLOG="$ccache_log" \
      "${environment[@]}" bash -ec "cd $home && $command"
  ' bash "$system" "$home" "$1" "$ccache_log" </dev/null
}

debootstrap_here() {
  local from
  from=$(mirror)
  mkdir -p build
  printf 'making a bare %s ...\n' "$suite"
  isolated debootstrap --variant=minbase "$suite" "$system" ${from:+"$from"} \
    >build/fresh_debian.log 2>&1 || { cat build/fresh_debian.log >&2 && die "debootstrap failed"; }
}

debootstrap_here
copy_package_sources
copy_pip_settings
mkdir -p "$system$HOME"
git clone --quiet --no-hardlinks "$root" "$system$home"
git -C "$system$home" remote remove origin
if [[ -n $carry ]]; then cp -rT "$carry" "$system$home/$carry"; fi

for command in "${commands[@]}"; do
  step "bare $suite: $command"
  SECONDS=0
  status=0
  enter "$command" || status=$?
  printf '== %s s, exit status %s: %s\n' "$SECONDS" "$status" "$command"
  ((status == 0)) || exit "$status"
  if [[ -f $system$ccache_log ]]; then scripts/compiled.sh "$system$ccache_log"; fi
done
if [[ -n $bring ]]; then cp -rT "$system$home/$bring" "$bring"; fi
