"""`python -m impactid` is the command `impactid`."""

import subprocess
import sys

from ._program import program


def main() -> int:
    return subprocess.call([str(program()), *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
