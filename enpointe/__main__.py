"""`python -m enpointe`: the same as the command `enpointe`."""

from __future__ import annotations

from enpointe.cli import main

if __name__ == "__main__":
    main()
