"""Builds the native part by CMake, in BATTEN_BUILD where that is a build folder with BATTEN_BUILD_PYTHON, else in one of
its own: python3 -m build --wheel python, on Debian with --no-isolation."""

import os
import pathlib
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class CMakeBuild(build_ext):
    def build_extension(self, ext: Extension) -> None:
        build = pathlib.Path(os.environ.get("BATTEN_BUILD", self.build_temp)).resolve()
        if not (build / "CMakeCache.txt").exists():
            source = pathlib.Path(__file__).resolve().parent.parent
            on = [f"-DBATTEN_{part}=ON" for part in ("BUILD_PYTHON", "MERGE_ROOMS", "PRECOMPILE")]
            off = [f"-DBATTEN_{part}=OFF" for part in ("BUILD_TESTS", "BUILD_CLI", "WITH_RENDER", "INSTALL")]
            python = f"-DPython_EXECUTABLE={sys.executable}"
            subprocess.run(["cmake", "-S", source, "-B", build, "-G", "Ninja", python, *on, *off], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "batten_native"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        # Beside _native, where the build folder has it, what reads files of volumes.
        for built in (build / "python" / "batten").glob("_*.so"):
            self.copy_file(str(built), str(target.parent / built.name))


setup(ext_modules=[Extension("batten._native", sources=[])], cmdclass={"build_ext": CMakeBuild})
