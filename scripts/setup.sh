# shellcheck shell=bash
# Shared by ./run, ./test and scripts/install_python.sh (sourced by bash): installs missing packages, configures and builds a
# preset. A call that finds everything in place asks dpkg and ninja, and does nothing.
# Messages go to standard error, and progress where that is a terminal; standard output belongs to the command.
#
# snare_packages lists the files of Debian packages that the caller needs; snare_worked is 1 once something was installed or
# built.

snare_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
snare_packages=("$snare_root/scripts/debian-packages.txt")
snare_debian="$snare_root/build/debian"  # cmake/SnareDependencies.cmake looks there too
snare_worked=0
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

snare_say() { printf '%s\n' "$*" >&2; }

# A line that the next one overwrites; the last call, without text, removes it.
snare_progress() {
  local text=$*
  if [[ -t 2 ]]; then printf '\r\033[K%s' "${text:0:79}" >&2; fi
}

# Names of the packages that are not installed; one query of 20 ms, so every call asks again.
snare_missing_packages() {
  local wanted
  mapfile -t wanted < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "${snare_packages[@]}")
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
           <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
             sed -n 's/^installed //p' | sort -u)
}

# Says what apt-get would install: "160 packages, 141 MB to download, 727 MB on disk". Status 1: apt-get cannot install it.
snare_installation_size() {
  LC_ALL=C "${snare_as_root[@]}" apt-get install --print-uris -y --no-install-recommends "$@" 2>&1 </dev/null | awk '
    /newly installed/      { packages = $1 + $3 }
    /^Need to get /        { download = $0; sub(/^Need to get /, "", download); sub(/(\/.*)? of archives.*/, "", download) }
    /disk space will be/   { disk = $4 " " $5 }
    END { if (!packages) exit 1; printf "%d packages, %s to download, %s on disk", packages, download, disk }'
}

# snare_apt_get WHAT ARGUMENTS...: with progress on a terminal; the words of apt-get are kept for a failure.
snare_apt_get() {
  local what=$1 log="$snare_root/build/install.log" kind item percent
  shift
  "${snare_as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o APT::Status-Fd=1 "$@" 2>&1 </dev/null | tee "$log" |
    while IFS=: read -r kind item percent _; do
      case $kind in
        dlstatus) snare_progress "$what: downloaded ${percent%.*} %" ;;
        pmstatus) snare_progress "$what: installed ${percent%.*} %" ;;
      esac
    done
  local status=${PIPESTATUS[0]}
  snare_progress
  return "$status"
}

snare_install_packages() {
  local missing size
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    snare_say "This script sets up Debian 12; apt-get and dpkg-query were not found here." \
              "On another system install what ${snare_packages[*]} list, and SUNDIALS 6.4, then: cmake --preset release"
    return 1
  fi
  mapfile -t missing < <(snare_missing_packages)
  ((${#missing[@]} > 0)) || return 0

  snare_as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
      snare_say "These Debian packages are missing: ${missing[*]}"
      snare_say "Installing them needs root, or sudo without a password. As root:"
      snare_say "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
      return 1
    fi
    snare_as_root=(sudo -n)
  fi

  snare_worked=1
  # The package lists may be absent (a fresh image) or too old for the mirror: then update them, once.
  if ! size=$(snare_installation_size "${missing[@]}"); then
    snare_apt_get "Package lists" update && size=$(snare_installation_size "${missing[@]}")
  fi
  snare_say "Installing the Debian packages ${missing[*]}"
  snare_say "  and their dependencies: ${size:-size unknown}; a minute or two."
  local install=(install -y --no-install-recommends "${missing[@]}")
  snare_apt_get "Packages" "${install[@]}" ||
    { snare_apt_get "Package lists" update && snare_apt_get "Packages" "${install[@]}"; } || {
      tail -n 20 "$snare_root/build/install.log" >&2
      snare_say "apt-get could not install: ${missing[*]}"
      return 1
    }
  # What was configured without these packages may do more with them.
  rm -f "$snare_root"/build/*/configured.stamp
}

# Debian's package of SUNDIALS depends on PETSc, hypre and Open MPI, 170 packages that its serial solvers do not use. Where it
# is not installed, its headers and static libraries are unpacked below build/.
snare_unpack_sundials() {
  local idas=usr/include/idas/idas.h package=libsundials-dev
  [[ -f /$idas || -f $snare_debian/$idas ]] && return 0
  snare_worked=1
  snare_say "Unpacking $package (1 MB) in build/debian"
  (mkdir -p "$snare_debian" && cd "$snare_debian" || exit 1
   download=(apt-get -q download "$package")
   "${download[@]}" || { ((EUID == 0)) && apt-get -q update && "${download[@]}"; } || exit 1
   dpkg-deb -x "$package"_*.deb . && rm "$package"_*.deb) >"$snare_root/build/install.log" 2>&1 || {
    tail -n 20 "$snare_root/build/install.log" >&2
    snare_say "$package could not be downloaded and unpacked. Where the package lists are missing, as root: apt-get update"
    return 1
  }
}

# Configures a preset when it never was, when the presets have changed, when packages were installed, or when the folder has
# moved.
snare_configure() {
  local preset=$1 stamp="$snare_root/build/$1/configured.stamp"
  [[ -f $snare_root/build/$preset/build.ninja && $stamp -nt $snare_root/CMakePresets.json &&
     $(<"$stamp") == "$snare_root" ]] && return 0
  # A first build joins sources, which takes half the time; a build configured by hand keeps its choice. A build that began
  # without ccache keeps doing without: a change of the compiler launcher would compile everything again.
  local options=(-DCMAKE_UNITY_BUILD:BOOL=ON)
  local cache="$snare_root/build/$preset/CMakeCache.txt" log="$snare_root/build/configure.log"
  if [[ -f $cache ]]; then
    if ! grep -q '^CMAKE_UNITY_BUILD:BOOL=ON' "$cache"; then options=(-DCMAKE_UNITY_BUILD:BOOL=OFF); fi
    if ! grep -q '^SNARE_CCACHE:FILEPATH=/' "$cache"; then options+=(-DSNARE_CCACHE:FILEPATH=OFF); fi
  fi
  snare_progress "Configuring build/$preset"
  (cd "$snare_root" && cmake --fresh --preset "$preset" "${options[@]}") >"$log" 2>&1 || {
    snare_progress
    cat "$log" >&2
    snare_say "Configuring the preset '$preset' failed; see above."
    return 1
  }
  snare_progress
  printf '%s\n' "$snare_root" >"$stamp"
}

# Reads the output of ninja: shows steps as progress, drops CMake's report and the two lines of a build that has nothing to do,
# prints all others.
snare_build_output() {
  local preset=$1 line
  while IFS= read -r line; do
    case $line in
      'ninja: no work to do.' | *'Re-checking globbed directories'* | '-- '*) ;;
      \[*/*\]*) snare_progress "Building build/$preset: step ${line%%]*}]" ;;
      *) snare_progress; printf '%s\n' "$line" >&2 ;;
    esac
  done
  snare_progress
}

# Says how long a build takes of which much is not there yet.
snare_say_time() {
  local preset=$1 steps
  shift
  steps=$(ninja -C "$snare_root/build/$preset" -t commands "$@" 2>/dev/null | grep -o -- '-o [^ ]*\.o ' |
    (cd "$snare_root/build/$preset" && while read -r _ object; do [[ -f $object ]] || echo; done | wc -l))
  ((steps >= 10)) || return 0
  snare_say "Building $snare_root/build/$preset: $steps compilations by $CMAKE_BUILD_PARALLEL_LEVEL processors," \
    "some $(((steps * snare_seconds_a_step / CMAKE_BUILD_PARALLEL_LEVEL + 59) / 60)) minutes."
}
snare_seconds_a_step=20  # processor seconds, the mean of the command's build; docs/results/speed.md

# snare_build PRESET [TARGET...]: everything up to date, or status 1 with the compiler's messages above, or 2 where the set-up
# failed.
snare_build() {
  local lock
  mkdir -p "$snare_root/build" || return 1
  exec {lock}>"$snare_root/build/lock"
  flock "$lock"
  snare_build_locked "$@"
  local status=$?
  exec {lock}>&-
  return $status
}

snare_build_locked() {
  local preset=$1
  shift
  snare_install_packages && snare_unpack_sundials && snare_configure "$preset" || return 2
  local before after
  before=$(stat -c %Y "$snare_root/build/$preset/.ninja_log" 2>/dev/null)
  snare_say_time "$preset" "$@"
  cmake --build "$snare_root/build/$preset" ${1:+--target "$@"} 2>&1 | snare_build_output "$preset"
  if ((PIPESTATUS[0] != 0)); then
    snare_say "Building the preset '$preset' failed; see above."
    return 1
  fi
  after=$(stat -c %Y "$snare_root/build/$preset/.ninja_log" 2>/dev/null)
  if [[ $before != "$after" ]]; then snare_worked=1; fi
}
