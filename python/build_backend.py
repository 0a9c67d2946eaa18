"""What `pip install ./python` calls (PEP 517): CMake builds the package, and a wheel is made of it.

It needs nothing but Python, so that pip fetches nothing. The build folder stays below build/, so
that the next time only what has changed is compiled. CMAKE_ARGS in the environment goes to CMake.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from typing import Any, NoReturn

_SOURCE = pathlib.Path(__file__).resolve().parent.parent
_OPTIONS = ("CMAKE_BUILD_TYPE=Release", "SPILLWAY_PYTHON=ON", "SPILLWAY_COMMAND=OFF")


def build_wheel(
    wheel_directory: str,
    config_settings: dict[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Builds the package for this interpreter. Returns the name of the wheel."""
    tag = _interpreter_tag()
    build = _SOURCE / "build" / f"wheel-{tag}"
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    definitions = [f"-D{option}" for option in (*_OPTIONS, f"Python_EXECUTABLE={sys.executable}")]
    more = shlex.split(os.environ.get("CMAKE_ARGS", ""))
    _cmake("-S", _SOURCE, "-B", build, *generator, *definitions, *more)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
    _cmake("--build", build, "--parallel", jobs, "--target", "_spillway")
    version = _cached(build, "CMAKE_PROJECT_VERSION")
    name = f"spillway-{version}-{tag}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        _cmake("--install", build, "--strip", "--component", "python", "--prefix", prefix)
        (packages,) = pathlib.Path(prefix).glob("lib/python3*/*-packages")
        _add_information(packages / f"spillway-{version}.dist-info", tag)
        _pack(packages, pathlib.Path(wheel_directory) / name)
    return name


def build_sdist(sdist_directory: str, config_settings: dict[str, Any] | None = None) -> NoReturn:
    """There is none: raises SystemExit."""
    sys.exit("Spillway has no source archive for pip; use pip wheel or pip install in a checkout.")


def _interpreter_tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def _cmake(*arguments: str | pathlib.Path) -> None:
    try:
        subprocess.run(["cmake", *arguments], check=True)
    except FileNotFoundError:
        sys.exit("cmake was not found. On Debian tools/install_packages.sh build installs it.")
    except subprocess.CalledProcessError as fault:
        sys.exit(f"cmake failed with exit code {fault.returncode}; see its messages above.")


def _cached(build: pathlib.Path, variable: str) -> str:
    """The value of a variable in CMake's cache."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    found = re.search(f"^{variable}:[A-Z]+=(.*)$", cache, re.MULTILINE)
    assert found, f"CMake sets {variable} for every project that has it"
    return found[1]


def _add_information(folder: pathlib.Path, tag: str) -> None:
    """What a wheel holds besides the metadata that CMake installs."""
    (folder / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: spillway\nRoot-Is-Purelib: false\nTag: {tag}\n",
        encoding="utf-8",
    )
    shutil.copy(_SOURCE / "LICENSE", folder)


def _pack(packages: pathlib.Path, wheel: pathlib.Path) -> None:
    """Makes a wheel of all files, with a record of their digests."""
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(packages.rglob("*")):
            if not file.is_file():
                continue
            content = file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
            name = file.relative_to(packages).as_posix()
            record.append(f"{name},sha256={digest.decode()},{len(content)}\n")
            archive.write(file, name)
        (information,) = packages.glob("*.dist-info")
        name = f"{information.name}/RECORD"
        archive.writestr(name, "".join([*record, f"{name},,\n"]))
