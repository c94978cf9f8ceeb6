"""Run the command line, as ``dembound`` or ``python -m dembound``.

Ctrl-C ends it with exit code 130 at any time, also while packages are imported, SIGTERM and SIGHUP with 143 and 129.
"""

import sys

from dembound.results.interrupts import end_at_signals, exit_code_of


def main() -> None:
    """Import and run the command line."""
    try:
        end_at_signals()
        from dembound.cli import main as run

        run()
    except KeyboardInterrupt as stop:
        print("dembound: stopped", file=sys.stderr)
        sys.exit(exit_code_of(stop))


if __name__ == "__main__":
    main()
