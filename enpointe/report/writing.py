"""Writing a report: everything is drawn first, and the files are put in place when all is well."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from enpointe.comparing import Comparison
from enpointe.comparing_bodies import BodyComparison
from enpointe.comparing_file import FileComparison
from enpointe.files import atomic_path, write_bytes
from enpointe.models import KeyPose
from enpointe.notation import Score
from enpointe.notation.stave import stave_svg
from enpointe.performing import Performance
from enpointe.performing_file import FilePerformance
from enpointe.posing import Poses
from enpointe.preparing import Progress, silent
from enpointe.report import words
from enpointe.report.blocks import Page
from enpointe.report.bodies import draw_bodies
from enpointe.report.file_page import draw_file
from enpointe.report.films import FilmFile, film_of
from enpointe.report.page import render
from enpointe.report.pages import Material, comparison_page, performance_page, poses_page
from enpointe.report.pictures import contact_sheet, fitted_view, stills
from enpointe.sim.camera import View

__all__ = ["ReportFiles", "write_report"]

Reported = Performance | Comparison | Poses | FilePerformance | FileComparison | BodyComparison


class ReportFiles(dict[str, Path]):
    """The files of a report by what they are: report, stave, key_poses, and video if there is one.

    Attributes:
        warning: One line for the user where the pictures are not what they could be, or None.
    """

    def __init__(self, files: dict[str, Path], warning: str | None) -> None:
        super().__init__(files)
        self.warning = warning


def write_report(
    dance: Reported,
    out: Path,
    *,
    video: bool = True,
    progress: Progress = silent,
) -> ReportFiles:
    """Write a report of a dance into a folder.

    `report.html` holds everything in itself; beside it stand `stave.svg`, `key-poses.png` and the
    film (`dance.mp4`, or `dance.gif` without the video extra). Of a motion file there is no stave,
    and `moments.png` instead of key poses; of several bodies there is the film alone.

    Args:
        dance: What `perform`, `perform_file`, `compare`, `compare_file`, `compare_bodies` or
            `pose` returned.
        out: The folder; made if it isn't there.
        video: Whether to paint a film; poses have none.
        progress: Told how far it is.

    Returns:
        The files by name, with `warning` for the user.

    Raises:
        EnpointeError: The folder can't be written to; nothing is left behind.

    Example:
        >>> import enpointe, pathlib
        >>> dance = enpointe.perform("first-port-de-bras")
        >>> files = enpointe.write_report(dance, pathlib.Path("out"))
        >>> files["report"].name
        'report.html'
    """
    out = Path(out)
    made = [folder for folder in (out, *out.parents) if not folder.exists()]
    try:
        # The first file is opened before anything is drawn: a folder that can't be written to is
        # to be known now, not after the film.
        with atomic_path(out / "report.html") as beside:
            beside.touch()
            parts, page, warning = _draw(dance, video, progress)
            html = render(page)
            files = {name: write_bytes(out / file, data) for name, (file, data) in parts.items()}
            beside.write_text(html, encoding="utf-8")
    except BaseException:
        for folder in made:
            with suppress(OSError):
                folder.rmdir()
        raise
    return ReportFiles({"report": out / "report.html", **files}, warning)


def _draw(
    dance: Reported, video: bool, progress: Progress
) -> tuple[dict[str, tuple[str, bytes]], Page, str | None]:
    """The files beside the page by name, the page, and the warning."""
    if isinstance(dance, FilePerformance | FileComparison):
        return draw_file(dance, video, progress)
    if isinstance(dance, BodyComparison):
        return draw_bodies(dance, video, progress)
    if isinstance(dance, Poses):
        score, poses = dance.score, dance.key_poses
        model = dance.model
        views = {
            "from the front": View.audience(),
            "from the side": View.wings(),
            "in three-quarter view": View.three_quarter(),
        }
        performances = {}
    else:
        performances = dict(dance.performances) if isinstance(dance, Comparison) else {"": dance}
        first = next(iter(performances.values()))
        score, poses = first.score, first.choreography.key_poses
        model = first.motion.model
        views = {"from the front": View(elevation=-9.0)}
    configurations = [pose.qpos for pose in poses]
    aimed = [fitted_view(model, configurations, view, follow=True) for view in views.values()]
    progress("pictures", 0, 1)
    pictures, warning = stills(model, configurations, aimed)
    progress("pictures", 1, 1)
    film = film_of(performances, progress) if video and performances else None
    stave = stave_svg(score)
    material = Material(stave, pictures, tuple(views), film, warning)
    page: Page
    if isinstance(dance, Poses):
        page = poses_page(dance, material, model)
    elif isinstance(dance, Comparison):
        page = comparison_page(dance, material)
    else:
        page = performance_page(dance, material)
    return _parts(score, poses, material), page, warning


def _parts(
    score: Score, poses: tuple[KeyPose, ...], material: Material
) -> dict[str, tuple[str, bytes]]:
    sheet = contact_sheet(
        material.pictures,
        [pose.name for pose in poses],
        [(words.pose_verdict(pose), not pose.held) for pose in poses],
    )
    parts = {
        "stave": ("stave.svg", material.stave.encode("utf-8")),
        "key_poses": ("key-poses.png", sheet),
    }
    film: FilmFile | None = material.film
    if film is not None:
        parts["video"] = (film.name, film.data)
    return parts
