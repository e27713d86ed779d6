"""Writing and reading back, and reading what nobody would write."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import ScoreError
from enpointe.notation import Score, format_score, load_score, parse_score, shipped_scores

from .strategies import scores

SCRAPS = st.sampled_from(
    [
        "beat 1:",
        "arms:",
        "1/0",
        "9" * 30,
        "1e999",
        "nan",
        ":",
        ",",
        "#",
        '"',
        "\\",
        "\n",
        "left",
        "fifth",
        "à",
        "\ufeff",
        "\u2028",
        "((",
        "+",
        "-",
        "leads",
        "erect",
        "turn",
        "\0",
        "²",
        "٣",
    ]
)


def refusal(text: str) -> ScoreError | None:
    """The error of a text that is no score."""
    try:
        parse_score(text)
    except ScoreError as error:
        return error
    return None


@given(scores())
def test_text_reads_back_as_the_same_score(score: Score) -> None:
    """Nothing is lost or changed on the way to text and back, and the text is settled."""
    text = format_score(score)
    assert parse_score(text) == score
    assert parse_score(text.encode()) == score
    assert format_score(parse_score(text)) == text


@pytest.mark.parametrize("name", shipped_scores())
def test_shipped_scores_read_back(name: str) -> None:
    """The shipped files survive being written anew."""
    score = load_score(name)
    assert parse_score(format_score(score)) == score


@given(scores(max_frames=3), st.data())
def test_mutated_text_is_read_or_refused(score: Score, data: st.DataObject) -> None:
    """Whatever is done to a score, it is a score or a ScoreError whose place is in the text."""
    text = format_score(score)
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        stop = data.draw(st.integers(start, min(len(text), start + 12)))
        text = text[:start] + data.draw(SCRAPS | st.text(max_size=4)) + text[stop:]
    error = refusal(text)
    if error is not None:
        lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
        assert 1 <= error.line <= len(lines)
        assert 1 <= error.column <= len(lines[error.line - 1]) + 1
        assert "\n" not in str(error)


@given(st.text() | st.binary())
def test_noise_is_refused(noise: str | bytes) -> None:
    """Noise is never a score and never another exception."""
    with pytest.raises(ScoreError):
        parse_score(noise)


@given(st.sampled_from(shipped_scores()), st.data())
def test_mutated_bytes_are_read_or_refused(name: str, data: st.DataObject) -> None:
    """Flipped bytes in a shipped score are no other exception either."""
    raw = bytearray(format_score(load_score(name)).encode())
    for _ in range(data.draw(st.integers(1, 6))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(ScoreError):
        parse_score(bytes(raw))
