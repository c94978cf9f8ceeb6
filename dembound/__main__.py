"""Run the command line as ``python -m dembound``."""

from dembound.cli import main

if __name__ == "__main__":
    main()
