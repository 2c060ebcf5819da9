"""Takes the package that CMake builds (host/python) into a wheel.

The build is that of the preset "release", build/release, which is made or brought up to date; STICTION_BUILD names a
finished one, which is taken as it is.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parent
MADE = pathlib.Path("build/pip")  # below it all that setuptools writes


def built():
    """The folder of a build that has the package."""
    given = os.environ.get("STICTION_BUILD")
    if given:
        if not list(pathlib.Path(given).glob("python/stiction/_core.*.so")):
            sys.exit(f"STICTION_BUILD: found no python/stiction/_core.*.so in {given}; expected a finished build with "
                     "-DSTICTION_PYTHON=ON")
        return pathlib.Path(given)
    folder = ROOT / "build/release"
    join = [] if (folder / "CMakeCache.txt").exists() else ["-DSTICTION_JOIN=ON"]
    subprocess.run(["cmake", "--preset", "release", "-DSTICTION_PYTHON=ON", *join], cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", "stiction_python"], cwd=ROOT, check=True)
    return folder


class BuildPackage(build_py):
    def run(self):
        super().run()
        folder, target = built(), pathlib.Path(self.build_lib) / "stiction"
        shutil.copytree(folder / "python/stiction", target, dirs_exist_ok=True,
                        ignore=shutil.ignore_patterns("__pycache__"))
        # The module finds machines in share/ beside itself (host/requests/library_folder.hpp).
        shutil.copytree(ROOT / "firmware/machine/shipped", target / "share/stiction/machines", dirs_exist_ok=True,
                        ignore=lambda _, names: [name for name in names if not name.endswith(".toml")])


class Compiled(Distribution):
    def has_ext_modules(self):
        return True  # a wheel for this processor and this Python


MADE.mkdir(parents=True, exist_ok=True)
version = re.search(r"^project\(stiction VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
setup(version=version, packages=["stiction"], package_dir={"stiction": "host/python/stiction"},
      package_data={"stiction": ["*.pyi", "py.typed"]}, distclass=Compiled, cmdclass={"build_py": BuildPackage},
      options={"build": {"build_base": str(MADE)}, "egg_info": {"egg_base": str(MADE)},
               "bdist_wheel": {"dist_dir": str(MADE)}})
