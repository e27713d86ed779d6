"""Reads the JSON form of a score; json_form.py says what it is."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, NoReturn, TypeVar

from enpointe.errors import ScoreError
from enpointe.notation.check import faults
from enpointe.notation.header import MAX_TEXT, is_plain, metre_of
from enpointe.notation.json_frame import read_frame
from enpointe.notation.json_values import Node
from enpointe.notation.parser import MAX_FRAMES, VERSION
from enpointe.notation.plain_text import MAX_BYTES
from enpointe.notation.score import TEMPO_RANGE, Score
from enpointe.notation.tempo import is_tempo_word
