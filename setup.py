"""Builds the Python package by CMake: pip install .

Needs the Debian packages of scripts/debian-packages.txt and libsundials-dev, and from the network only the build tools of
pyproject.toml; with those of Debian nothing: pip install --no-build-isolation .
"""

import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).parent.resolve()


def version() -> str:
    found = re.search(r"project\(snare VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))
    if found is None:
        raise RuntimeError("CMakeLists.txt: has no version")
    return found.group(1)


class CMakeBuild(build_ext):
    """The extension as the target snare_core makes it, for the Python that runs this."""

    def build_extension(self, extension: Extension) -> None:
        build = SOURCE / "build" / f"pip-{sys.implementation.cache_tag}"
        generator = ["-G", "Ninja"] if subprocess.run(["ninja", "--version"], capture_output=True).returncode == 0 else []
        arguments = [f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG",
                     "-DSNARE_BUILD_PYTHON=ON", "-DSNARE_BUILD_TESTS=OFF", "-DCMAKE_UNITY_BUILD=ON", *self.pybind11()]
        subprocess.run(["cmake", "-S", str(SOURCE), "-B", str(build), *generator, *arguments], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "snare_core", "--parallel"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(next((build / "python/snare").glob("_core*.so"))), str(target))

    @staticmethod
    def pybind11() -> list:
        """Where the pybind11 of the build environment is, if it has one."""
        try:
            import pybind11
        except ImportError:
            return []
        return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


setup(version=version(), packages=["snare"], package_dir={"snare": "python/snare"},
      package_data={"snare": ["py.typed", "*.pyi"]}, ext_modules=[Extension("snare._core", sources=[])],
      cmdclass={"build_ext": CMakeBuild}, zip_safe=False)
