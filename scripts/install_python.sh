#!/usr/bin/env bash
# Makes `import snare` work in a Python: scripts/install_python.sh [PYTHON]
# PYTHON: the active virtual environment's interpreter or, without one, /usr/bin/python3. Builds the module from the objects of
# the command and writes one file, snare.pth, which names its folder, into the environment or the user's site-packages. pip is
# not involved, so that it also works in an externally managed environment.
set -u
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

python=${1:-${VIRTUAL_ENV:+$VIRTUAL_ENV/bin/python}}
python=${python:-/usr/bin/python3}
snare_packages+=("$snare_root/scripts/debian-packages-python.txt")

suffix_of() { "$1" -c 'import sysconfig; print(sysconfig.get_config_var("EXT_SUFFIX"))' 2>/dev/null; }

snare_build release || exit 1
if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 9))' 2>/dev/null; then
  snare_say "$python: not a Python of version 3.9 or later. Usage: scripts/install_python.sh [PYTHON]"
  exit 1
fi
if ! "$python" -c 'import numpy' 2>/dev/null; then
  snare_say "$python has no NumPy, which snare needs: $python -m pip install numpy"
  exit 1
fi
# The module of Debian's Python fits every interpreter that asks for the same file name.
builder=/usr/bin/python3
if [[ $(suffix_of "$python") != "$(suffix_of $builder)" ]]; then builder=$python; fi
configured=$(sed -n 's/^Python_EXECUTABLE:[A-Z]*=//p' "$snare_root/build/release/CMakeCache.txt")
if [[ $configured != "$builder" ]]; then
  log="$snare_root/build/configure.log"
  cmake "$snare_root/build/release" -DPython_EXECUTABLE="$builder" -DSNARE_BUILD_PYTHON=ON >"$log" 2>&1 || {
    cat "$log" >&2
    exit 1
  }
fi
snare_build release snare_python || exit 1

"$python" - "$snare_root/build/release/python" <<'PYTHON'
import pathlib
import site
import subprocess
import sys
import sysconfig

in_environment = sys.prefix != sys.base_prefix
of_user = site.ENABLE_USER_SITE and not in_environment
folder = pathlib.Path(site.getusersitepackages() if of_user else sysconfig.get_path("purelib"))
folder.mkdir(parents=True, exist_ok=True)
link = folder / "snare.pth"
link.write_text(sys.argv[1] + "\n")
test = "import snare; print(snare.__file__)"
run = subprocess.run([sys.executable, "-c", test], cwd="/", capture_output=True, text=True)
if run.returncode != 0:
    sys.exit(f"{sys.executable} cannot import snare:\n{run.stderr}")
print(f"import snare works in {sys.executable}; to undo it: rm {link}")
PYTHON
