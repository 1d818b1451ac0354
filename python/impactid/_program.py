"""Where the program is, and how it is started."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Sequence

_NAME = "impactid.exe" if os.name == "nt" else "impactid"


class ProgramMissing(RuntimeError):
    """The program is not installed, or not for this machine."""


class ProgramError(RuntimeError):
    """The program refused its input; the message is the program's."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


def _candidates() -> list[Path]:
    """Where the program may be, the likeliest first."""
    named = os.environ.get("IMPACTID_PROGRAM")
    if named:
        return [Path(named)]
    here = Path(__file__).resolve()
    folders = [sysconfig.get_path("scripts"), sysconfig.get_path("scripts", f"{os.name}_user")]
    # installed with --target DIR: DIR/bin beside DIR/impactid
    folders.append(str(here.parent.parent / "bin"))
    found = [Path(folder) / _NAME for folder in folders if folder]
    on_path = shutil.which("impactid")
    if on_path:
        found.append(Path(on_path))
    return found


def program() -> Path:
    """The program that belongs to this module.

    The environment variable IMPACTID_PROGRAM names another one.

    Raises:
        ProgramMissing: with the remedy, where there is none.
    """
    looked = _candidates()
    for path in looked:
        if path.is_file():
            return path
    places = ", ".join(str(path) for path in looked)
    raise ProgramMissing(
        f"the program impactid is not installed (looked for {places}). "
        "Install a wheel for this platform, or build the program with `cargo install --path .` and "
        "name it in the environment variable IMPACTID_PROGRAM"
    )


def start(arguments: Sequence[str], *, accept: Sequence[int] = (0,)) -> str:
    """Run the program; gives its standard output.

    Raises:
        ProgramMissing: where it is not installed or not made for this machine.
        ProgramError: where its exit code is not among those that are accepted.
    """
    path = program()
    environment = {**os.environ, "NO_COLOR": "1"}
    try:
        done = subprocess.run(
            [str(path), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            env=environment,
            check=False,
        )
    except OSError as error:
        raise ProgramMissing(
            f"{path} cannot be started on this machine ({platform.system()} {platform.machine()}, Python "
            f"{sys.version_info.major}.{sys.version_info.minor}): {error}. The wheel holds a program for "
            "another platform: install one for this platform, or build the program with "
            "`cargo install --path .` and name it in the environment variable IMPACTID_PROGRAM"
        ) from error
    if done.returncode not in accept:
        raise ProgramError(done.stderr.strip() or done.stdout.strip(), done.returncode)
    return done.stdout


def version() -> str:
    """Version of the program."""
    return start(["--version"]).split()[-1]
