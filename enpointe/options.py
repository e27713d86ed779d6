"""The options that verbs of the command line share, each bundle a dataclass."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, is_dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from enpointe.console import Console
from enpointe.errors import EnpointeError

if TYPE_CHECKING:
    from enpointe.models import Anthropometry, Style

__all__ = [
    "BAD_INPUT",
    "DONE",
    "NO",
    "CaptureOptions",
    "ControllerName",
    "ConversionOptions",
    "DancerOptions",
    "Effort",
    "FileOptions",
    "Json",
    "OutputOptions",
    "Quiet",
    "RigOptions",
    "Score",
    "Seed",
    "SeededOutputOptions",
    "SpeechOptions",
    "StyledDancerOptions",
    "Tempo",
    "Video",
    "find_metre",
    "unbundled",
]


DONE, NO, BAD_INPUT = 0, 1, 2
"""Exit codes: the job is done; the answer is no; the input is bad."""


class ControllerName(StrEnum):
    KINEMATIC = "kinematic"
    PD = "pd"
    WHOLEBODY = "wholebody"


class SexName(StrEnum):
    FEMALE = "female"
    MALE = "male"


class DancerName(StrEnum):
    PERFECT = "perfect"
    REAL = "real"


Score = Annotated[str, typer.Argument(help="A shipped score's name, or a .bmn file.")]
Effort = Annotated[
    str | None,
    typer.Option(
        help="natural, happy, sad, angry or afraid, each with its tempo; or numbers:"
        " time=-3.5,weight=.41,space=1. Natural at the score's tempo if left out."
    ),
]
Tempo = Annotated[
    float | None, typer.Option(help="Beats a minute; the effort's or the score's if left out.")
]
Video = Annotated[bool, typer.Option(help="Film the dance (the slowest part).")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Seed = Annotated[int, typer.Option(help="Seed of what is random; in this verb nothing is.")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print nothing but errors.")]


@dataclass(frozen=True)
class DancerOptions:
    """Who dances."""

    height: Annotated[float, typer.Option(help="The dancer's height, m.")] = 1.68
    mass: Annotated[float, typer.Option(help="The dancer's mass, kg.")] = 54.0
    sex: Annotated[SexName, typer.Option(help="Whose proportions the dancer has.")] = SexName.FEMALE

    def anthropometry(self) -> Anthropometry:
        """The measures of the body."""
        from enpointe.models.anthropometry import Anthropometry, Sex

        return Anthropometry(self.height, self.mass, Sex(self.sex.value))


@dataclass(frozen=True)
class StyledDancerOptions(DancerOptions):
    """Who dances, how turned out, and whether with the range of a real hip."""

    turnout: Annotated[float, typer.Option(help="Turnout of each leg, degrees.")] = 66.0
    dancer: Annotated[
        DancerName,
        typer.Option(
            help="perfect keeps her hips square; real has a real hip's range, and says how she"
            " cheats."
        ),
    ] = DancerName.PERFECT

    def style(self) -> Style:
        """The amounts of the method."""
        from enpointe.models.style import Style

        return Style(turnout_deg=self.turnout, real=self.dancer is DancerName.REAL)


@dataclass(frozen=True)
class ConversionOptions:
    """How a motion file is read, and how another is written."""

    to: Annotated[
        str | None, typer.Option(metavar="FORMAT", help="The format of OUT, whatever its ending.")
    ] = None
    rate: Annotated[
        float | None, typer.Option(help="Frames a second to write; those of IN if left out.")
    ] = None
    source_rate: Annotated[
        float | None, typer.Option(help="Frames a second of IN, where its file does not say.")
    ] = None
    skeleton: Annotated[
        Path | None, typer.Option(help="The ASF file of an AMC file, where it lies elsewhere.")
    ] = None
    unit: Annotated[str | None, typer.Option(help="Of the lengths in OUT: m, cm, mm or in.")] = None
    names: Annotated[
        Path | None, typer.Option(help="An MNM file with other names for joints or markers.")
    ] = None
    on_dancer: Annotated[
        bool, typer.Option("--on-dancer", help="Put a captured movement on our dancer first.")
    ] = False
    mapping: Annotated[
        Path | None,
        typer.Option("--map", help="A file of which joints or markers are which of hers."),
    ] = None


@dataclass(frozen=True)
class CaptureOptions:
    """How a captured file is read."""

    mapping: Annotated[
        Path | None,
        typer.Option("--map", help="Of a motion file: which joints are which, as a TOML file."),
    ] = None
    skeleton: Annotated[
        Path | None, typer.Option(help="Of an AMC file: its ASF file, where it lies elsewhere.")
    ] = None


@dataclass(frozen=True)
class FileOptions(CaptureOptions):
    """What of a motion file is danced, and how it is read."""

    span: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="START END",
            help="Of a motion file: the seconds of it to dance; all if left out.",
        ),
    ] = None
    speed: Annotated[
        float | None, typer.Option(help="Of a motion file: how much faster than it; 1 if left out.")
    ] = None

    @property
    def rate(self) -> float:
        """How much faster than the file."""
        return 1.0 if self.speed is None else self.speed

    def refuse(self, source: str, why: str = "is a score") -> None:
        """Refuse these options for what is no motion file, or is not danced as one.

        Raises:
            EnpointeError: One is given.
        """
        given = {"span": self.span, "speed": self.speed, "map": self.mapping}
        given["skeleton"] = self.skeleton
        for name, value in given.items():
            if value is not None:
                raise EnpointeError(f"{source} {why}: --{name} is for motion files")

    @staticmethod
    def refuse_for_scores(source: str, **given: object) -> None:
        """Refuse, for a motion file, what is asked of scores.

        Raises:
            EnpointeError: One is given.
        """
        for name, value in given.items():
            if value is not None:
                raise EnpointeError(
                    f"{source} is a motion file: --{name} is for scores; use --speed or --span"
                )


@dataclass(frozen=True)
class RigOptions:
    """Which rig of servos is set beside the dancer, and where it dances."""

    rig: Annotated[
        str | None,
        typer.Option(
            help="Set a rig of servos beside the dancer: puppet, op3, or a TOML file of yours."
        ),
    ] = None
    port: Annotated[
        str | None,
        typer.Option(help="Of the rig, as for servo; simulated if left out."),
    ] = None
    stand: Annotated[
        bool | None,
        typer.Option(
            "--stand/--free", help="The simulated rig hangs on a stand, or must balance; it hangs."
        ),
    ] = None
    as_written: Annotated[
        bool, typer.Option("--as-written", help="Don't slow down what servos can't follow.")
    ] = False
    backlash: Annotated[
        float, typer.Option(help="Play in a simulated rig's gears, degrees; none if left out.")
    ] = 0.0
    recording: Annotated[
        Path | None,
        typer.Option(help="What the rig did before (recording.npz of servo); nothing is danced."),
    ] = None

    @property
    def where(self) -> str:
        """The rig's port."""
        from enpointe.servoing import SIMULATED

        return SIMULATED if self.port is None else self.port

    def refuse_without(self) -> None:
        """Refuse what is for a rig where there is none, and for a dance where none is danced.

        Raises:
            EnpointeError: Such an option is given.
        """
        danced = {
            "--port": self.port is not None,
            "--stand and --free": self.stand is not None,
            "--as-written": self.as_written,
            "--backlash": self.backlash != 0.0,
        }
        for name, given in {**danced, "--recording": self.recording is not None}.items():
            if given and self.rig is None:
                raise EnpointeError(f"{name} is for a rig: name it with --rig")
        for name, given in danced.items():
            if given and self.recording is not None:
                raise EnpointeError(f"{name} is for a dance, and --recording is one already danced")


@dataclass(frozen=True)
class SpeechOptions:
    """How a verb speaks."""

    json: Json = False
    quiet: Quiet = False
    seed: Seed = 0

    def console(self) -> Console:
        """Where the verb speaks."""
        return Console(json=self.json, quiet=self.quiet)


@dataclass(frozen=True)
class OutputOptions(SpeechOptions):
    """What is written where."""

    out: Annotated[
        Path | None, typer.Option(help="Folder to write to; named after the input if left out.")
    ] = None

    def folder(self, source: str) -> Path:
        """The folder asked for, or the one named after the input."""
        if self.out is not None:
            return self.out
        return Path(Path(source).stem.strip().replace(" ", "-") or "out")


@dataclass(frozen=True)
class SeededOutputOptions(OutputOptions):
    """What is written where, of a verb that draws at random."""

    seed: Annotated[int, typer.Option(help="Seed of all that is drawn.")] = 0


def find_metre(text: str) -> tuple[int, int]:
    """Beats in a bar and their note value, from words such as 3/4.

    Raises:
        EnpointeError: No metre.
    """
    pulses, _, value = text.partition("/")
    if not (pulses.isdecimal() and value.isdecimal() and 1 <= int(pulses) <= 32):
        raise EnpointeError(f"{text!r} is no metre; write it as 3/4")
    if int(value) not in (1, 2, 4, 8, 16):
        raise EnpointeError(f"{text!r} is no metre; its notes are 1, 2, 4, 8 or 16")
    return int(pulses), int(value)


def unbundled(verb: Callable[..., int]) -> Callable[..., int]:
    """The verb as Typer reads it: the fields of each bundle stand among its own options.

    Args:
        verb: Its bundles are keyword-only parameters without a default.
    """
    signature = inspect.signature(verb, eval_str=True)
    bundles: dict[str, type] = {}
    flat: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if is_dataclass(bundle := parameter.annotation):
            assert isinstance(bundle, type)
            bundles[parameter.name] = bundle
            flat += inspect.signature(bundle, eval_str=True).parameters.values()
        else:
            flat.append(parameter)

    def command(**given: object) -> int:
        for name, bundle in bundles.items():
            own = {field: given.pop(field) for field in inspect.signature(bundle).parameters}
            given[name] = bundle(**own)
        return verb(**given)

    keywords = [each.replace(kind=inspect.Parameter.KEYWORD_ONLY) for each in flat]
    command.__name__, command.__doc__ = verb.__name__, verb.__doc__
    command.__annotations__ = {each.name: each.annotation for each in keywords}
    vars(command)["__signature__"] = signature.replace(parameters=keywords)
    return command
