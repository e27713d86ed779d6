"""The beginning that scores of the tests share, as text."""

from __future__ import annotations

HEAD = "benesh 1\ntitle: T\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"
START = HEAD + "beat 0:\n  feet: first\n  arms: first\n"
FIFTH = "beat 0:\nfeet: fifth right front\narms: fifth en bas\n"
IN_FIFTH = HEAD + FIFTH


def frame(lines: str) -> str:
    """A good score, then beat 1 on line 9 and these lines from line 10."""
    return f"{START}beat 1:\n{lines}\n"


def headed(lines: str) -> str:
    """A good score with these lines between its header, to line 5, and its beat 0."""
    return START.replace("beat 0", f"{lines}\nbeat 0")
