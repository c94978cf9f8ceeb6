"""Run the command line, as ``dembound`` or ``python -m dembound``.

Ctrl-C ends it with exit code 130 at any time, also while packages are imported, SIGTERM and SIGHUP with 143 and 129.
Within a limit of addresses that the libraries do not fit into it ends with 3.
"""

import sys

from dembound.errors import RunError
from dembound.interrupts import end_while_loading, exit_code_of, whole_process
from dembound.machine import FEW_ADDRESSES, LEAST_ADDRESSES, address_limit, one_thread_for_matrices


def main() -> None:
    """Import and run the command line."""
    if (limit := address_limit()) is not None:
        if limit < LEAST_ADDRESSES:
            needed = f"{LEAST_ADDRESSES / 1e6:.0f} MB are needed"
            said = f"the address space is limited to {limit / 1e6:.0f} MB (ulimit -v), {needed}"
            print(f"dembound: {said}", file=sys.stderr)
            sys.exit(RunError.exit_code)
        if limit < FEW_ADDRESSES:
            one_thread_for_matrices()
        end_while_loading()
    try:
        with whole_process():
            from dembound.cli import main as run

            run()
    except KeyboardInterrupt as stop:
        print("dembound: stopped", file=sys.stderr)
        sys.exit(exit_code_of(stop))


if __name__ == "__main__":
    main()
