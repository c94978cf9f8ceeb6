"""Run the command line, as ``dembound`` or ``python -m dembound``.

Ctrl-C ends it with exit code 130 at any time, also while packages are imported.
"""

import sys


def main() -> None:
    """Import and run the command line."""
    try:
        from dembound.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
