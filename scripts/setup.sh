# shellcheck shell=bash
# Shared by ./run and ./test (sourced by bash): installs what is missing, configures and builds a preset.
# A call that finds everything in place asks dpkg and ninja, and does nothing.
# What it has to say goes to standard error; standard output belongs to the command.

snare_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
snare_packages="$snare_root/scripts/debian-packages.txt"
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

snare_say() { printf '%s\n' "$*" >&2; }

# Names of the packages that are not installed; one query of 20 ms, so every call asks afresh.
snare_missing_packages() {
  local wanted
  mapfile -t wanted < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$snare_packages")
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort) \
           <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
             sed -n 's/^installed //p' | sort)
}

snare_install_packages() {
  local as_root=() missing
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    snare_say "This script sets up Debian 12; apt-get and dpkg-query were not found here." \
              "On another system install what $snare_packages lists, then: cmake --preset release"
    return 1
  fi
  mapfile -t missing < <(snare_missing_packages)
  ((${#missing[@]} > 0)) || return 0

  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
      snare_say "These Debian packages are missing: ${missing[*]}"
      snare_say "Installing them needs root, or sudo without a password. As root:"
      snare_say "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
      return 1
    fi
    as_root=(sudo -n)
  fi

  snare_say "Installing Debian packages: ${missing[*]}"
  local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
                 apt-get install -y --no-install-recommends "${missing[@]}")
  # The package lists may be absent (a fresh image) or too old for the mirror: then update them, once.
  if ! apt-get install --simulate --no-install-recommends "${missing[@]}" >/dev/null 2>&1 ||
     ! "${install[@]}" >&2; then
    { "${as_root[@]}" apt-get update && "${install[@]}"; } >&2 || {
      snare_say "apt-get could not install: ${missing[*]}"
      return 1
    }
  fi
}

# Configures a preset when it never was, when the presets have changed, or when the folder has moved.
snare_configure() {
  local preset=$1 stamp="$snare_root/build/$1/configured.stamp"
  [[ -f $snare_root/build/$preset/build.ninja && $stamp -nt $snare_root/CMakePresets.json &&
     $(<"$stamp") == "$snare_root" ]] && return 0
  # A first build joins sources, which takes half the time; who has configured by hand keeps what he chose.
  local joined=ON cache="$snare_root/build/$preset/CMakeCache.txt"
  if [[ -f $cache ]] && ! grep -q '^CMAKE_UNITY_BUILD:BOOL=ON' "$cache"; then joined=OFF; fi
  (cd "$snare_root" && cmake --fresh --preset "$preset" -DCMAKE_UNITY_BUILD:BOOL=$joined) >&2 || {
    snare_say "Configuring the preset '$preset' failed; see above."
    return 1
  }
  printf '%s\n' "$snare_root" >"$stamp"
}

# snare_build PRESET [TARGET...]: everything up to date, or status 1 with the compiler's words above.
snare_build() {
  local preset=$1 lock
  shift
  mkdir -p "$snare_root/build" || return 1
  exec {lock}>"$snare_root/build/lock"
  flock "$lock"
  snare_build_locked "$preset" "$@"
  local status=$?
  exec {lock}>&-
  return $status
}

snare_build_locked() {
  local preset=$1
  shift
  snare_install_packages || return 1
  snare_configure "$preset" || return 1
  # The two lines of a build that has nothing to do are left out.
  if ! (
    set -o pipefail
    cmake --build "$snare_root/build/$preset" ${1:+--target "$@"} 2>&1 |
      sed -u -e '/^ninja: no work to do\.$/d' -e '/Re-checking globbed directories/d' >&2
  ); then
    snare_say "Building the preset '$preset' failed; see above."
    return 1
  fi
}
