# SPDX-License-Identifier: MIT
"""Builds the wheels (PEP 517) with what the standard library has, cmake and ninja.

--config-settings=parts=full (the default) is the package `corral`, parts=grouping the package `corral_grouping`."""

import base64
import hashlib
import io
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ROOMS = ["kernel", "grouping", "refine", "io", "apps/pair", "apps/runtime", "apps/python"]
FILES = {"tables.py": "tables.py", "_corral.pyi": "_corral.pyi", "py.typed": "py.typed"}
PARTS = {
    "full": {"name": "corral", "license": "GPL-3.0-or-later",  # links CGAL
             "summary": "3D correspondence grouping: match two surfaces, group, refine, score",
             "files": {**FILES, "__init__.py": "__init__.py", "surfaces.py": "surfaces.py"}},
    "grouping": {"name": "corral_grouping", "license": "MIT",
                 "summary": "3D correspondence grouping: the groupers of Corral alone",
                 "files": {**FILES, "__init__.py": "grouping_init.py"}},
}


def part_of(config_settings):
    """The name of the part to build."""
    settings = dict(config_settings or {})
    part = settings.pop("parts", "full")
    if settings or part not in PARTS:
        found = next(iter(settings), None) or f"parts={part}"
        raise SystemExit(f"corral: found the setting {found}, expected parts=full or parts=grouping")
    return part


def version():
    return re.search(r"project\(corral VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def tag():
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[^a-z0-9_]", "_", sysconfig.get_platform())
    return f"{interpreter}-{interpreter}{sys.abiflags}-{platform}"


def metadata(part):
    lines = ["Metadata-Version: 2.1", f"Name: {PARTS[part]['name'].replace('_', '-')}", f"Version: {version()}",
             f"Summary: {PARTS[part]['summary']}", f"License: {PARTS[part]['license']}", "Requires-Python: >=3.9",
             "Requires-Dist: numpy", "Description-Content-Type: text/markdown", "", (HERE / "README.md").read_text()]
    return "\n".join(lines).encode()


def wheel_facts():
    return f"Wheel-Version: 1.0\nGenerator: corral\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode()


def dist_info(part):
    """The files of the .dist-info folder, without the RECORD."""
    folder = f"{PARTS[part]['name']}-{version()}.dist-info"
    return folder, {"METADATA": metadata(part), "WHEEL": wheel_facts(), "LICENSE": (ROOT / "LICENSE").read_bytes()}


def run(*command):
    if subprocess.run(command, stdout=sys.stderr).returncode != 0:
        raise SystemExit(f"corral: {command[0]} failed (see above); apps/python/README.md lists the packages that the build needs")


def build_extension(part):
    """Compiles the extension module; returns its file. The folder stays, so that the next build compiles what has changed."""
    for tool in ("cmake", "ninja"):
        if not shutil.which(tool):
            raise SystemExit(f"corral: {tool} is not installed; apps/python/README.md lists the packages that the build needs")
    folder = ROOT / "build" / f"python-{part}"
    launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={shutil.which('ccache')}"] if shutil.which("ccache") else []
    run("cmake", "-S", str(HERE), "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        f"-DPython_EXECUTABLE={sys.executable}", f"-DCORRAL_FULL={'ON' if part == 'full' else 'OFF'}", *launcher)
    run("cmake", "--build", str(folder), "--target", "corral_python")
    return folder / f"_corral{sysconfig.get_config_var('EXT_SUFFIX')}"


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def write_wheel(path, files, record):
    """A zip file with these contents; every entry has the same date, so that the same contents give the same bytes."""
    lines = [record_line(name, content) for name, content in files.items()]
    files = {**files, record: "".join([*lines, f"{record},,\n"]).encode()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o100755 if name.endswith(".so") else 0o100644) << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    part = part_of(config_settings)
    package = PARTS[part]["name"]
    extension = build_extension(part)
    files = {f"{package}/{name}": (HERE / "package" / source).read_bytes()
             for name, source in PARTS[part]["files"].items()}
    files[f"{package}/{extension.name}"] = extension.read_bytes()
    folder, facts = dist_info(part)
    files.update({f"{folder}/{name}": content for name, content in facts.items()})
    name = f"{package}-{version()}-{tag()}.whl"
    write_wheel(os.path.join(wheel_directory, name), files, f"{folder}/RECORD")
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder, facts = dist_info(part_of(config_settings))
    target = Path(metadata_directory) / folder
    target.mkdir()
    for name, content in facts.items():
        (target / name).write_bytes(content)
    return folder


def build_sdist(sdist_directory, config_settings=None):
    """The rooms that the packages are built from, in their places below a pyproject.toml that points to this file."""
    part = part_of(config_settings)
    top = f"{PARTS[part]['name']}-{version()}"
    name = f"{top}.tar.gz"
    settings = (HERE / "pyproject.toml").read_text().replace('["."]', '["apps/python"]')
    with tarfile.open(os.path.join(sdist_directory, name), "w:gz") as archive:
        def add(place, content):
            entry = tarfile.TarInfo(f"{top}/{place}")
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
        add("pyproject.toml", settings.encode())
        add("PKG-INFO", metadata(part))
        for file in ["CMakeLists.txt", "LICENSE", "apps/embed.cmake", "paper/confidence.toml"]:
            add(file, (ROOT / file).read_bytes())
        for room in ROOMS:
            for path in sorted((ROOT / room).rglob("*")):
                if path.is_file() and "__pycache__" not in path.parts:
                    add(path.relative_to(ROOT).as_posix(), path.read_bytes())
    return name


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []
