"""Run the command line, as ``dembound`` or ``python -m dembound``.

Ctrl-C ends it with exit code 130 at any time, also while packages are imported, SIGTERM and SIGHUP with 143 and 129.
"""

import sys

from dembound.interrupts import exit_code_of, whole_process


def main() -> None:
    """Import and run the command line."""
    try:
        with whole_process():
            from dembound.cli import main as run

            run()
    except KeyboardInterrupt as stop:
        print("dembound: stopped", file=sys.stderr)
        sys.exit(exit_code_of(stop))


if __name__ == "__main__":
    main()
