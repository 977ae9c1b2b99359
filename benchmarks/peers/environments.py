"""Virtual environments with pinned packages for the compared programs."""

import json
import os
import pathlib
import shutil
import subprocess

# By environment: packages, and the versions of Python that have wheels of all of them.
ENVIRONMENTS = {
    "rods": (["numpy==2.5.5", "scipy==1.18.1", "mujoco==4.0.0", "exudyn==1.13.6", "pyelastica==1.0.0", "numba==0.68.1"], ("3.12", "3.13", "3.11")),
    "newton": (["numpy==2.5.5", "scipy==1.18.1", "newton==1.8.0", "warp-lang==1.19.0"], ("3.12", "3.13", "3.11")),
    "dismech": (["numpy==2.5.5", "scipy==1.18.1", "dismech-newton==0.1.0.post4", "newton==1.6.1", "warp-lang==1.18.0"], ("3.12", "3.13", "3.11")),
    "cosserat": (["numpy==2.5.5", "scipy==1.18.1", "cosseratbench==0.3.0", "mujoco==3.17.0", "pyelastica==1.0.0"], ("3.12", "3.13", "3.11")),
}


def interpreter(versions):
    """An interpreter of the first version that is on PATH or below the folder of pyenv."""
    pyenv = pathlib.Path(os.environ.get("PYENV_ROOT", pathlib.Path.home() / ".pyenv")) / "versions"
    for version in versions:
        found = [str(p) for p in sorted(pyenv.glob(f"{version}.*/bin/python"))] + [shutil.which(f"python{version}")]
        for python in filter(None, found):
            if subprocess.run([python, "-c", ""], capture_output=True).returncode == 0:
                return python
    return None


def environment(folder, name):
    """Python of the environment, made where it is missing; or None and the reason."""
    packages, versions = ENVIRONMENTS[name]
    python = pathlib.Path(folder) / name / "bin/python"
    done = pathlib.Path(folder) / name / "packages.json"
    if done.is_file() and json.loads(done.read_text()) == packages:
        return str(python), None
    base = interpreter(versions)
    if base is None:
        return None, f"no Python of {', '.join(versions)} here"
    made = subprocess.run([base, "-m", "venv", str(python.parents[1])], capture_output=True, text=True)
    if made.returncode == 0:
        made = subprocess.run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages], capture_output=True, text=True)
    if made.returncode:
        return None, (made.stderr.strip().splitlines() or ["pip failed"])[-1]
    done.write_text(json.dumps(packages))
    return str(python), None
