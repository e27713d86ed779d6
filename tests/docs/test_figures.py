"""Every field that is printed is described, and the README's figures are those of the dance."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import enpointe
from enpointe.notation import Score, parse_score
from enpointe.sim.balance_table import COLUMNS

from .pages import ROOT, TWO_FRAMES


def table(mark: str) -> str:
    """The table of figures.md after `<!-- fields: mark -->`."""
    text = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    return text.split(f"<!-- fields: {mark} -->\n\n", 1)[1].split("\n\n", 1)[0]


def fields(mark: str) -> set[str]:
    """The names in the first column of that table."""
    return set(re.findall(r"^\| `(\w+)` \|", table(mark), flags=re.MULTILINE))


@pytest.fixture(scope="module")
def phrase() -> Score:
    return parse_score(TWO_FRAMES)


def test_fields_of_a_kinematic_performance(phrase: Score) -> None:
    dance = enpointe.perform(phrase, controller="kinematic")
    assert set(dance.summary()) == fields("kinematic")


def test_fields_of_a_performance_of_a_file(phrase: Score, tmp_path: Path) -> None:
    drawn = enpointe.perform(phrase, controller="kinematic").save(tmp_path)["motion"]
    figures = enpointe.perform_file(drawn, controller="kinematic").summary()
    assert set(figures) == fields("kinematic") | fields("file")


def test_fields_of_a_check(phrase: Score) -> None:
    assert set(enpointe.check(phrase).summary()) == fields("check")


def test_fields_of_a_conversion(tmp_path: Path) -> None:
    source = tmp_path / "a.csv"
    source.write_text("time [s],a.x [m],a.y [m],a.z [m]\n0,0,0,1\n0.1,0,0,1\n")
    assert set(enpointe.convert(source, tmp_path / "a.trc").summary()) == fields("conversion")


def test_fields_of_a_sweep() -> None:
    from enpointe.models import dancer_model
    from enpointe.sim.disturbance import Disturbances, Factors
    from enpointe.sim.trial import Outcome

    model = dancer_model(flesh=False)
    factors = Factors().figures(model, model.qpos0)
    fallen = Outcome(0, factors, False, 1.0, "fell", 0.0, None, None, None, None, None)
    swept = enpointe.Sweep("T", 1.0, "pd", Disturbances.parse(None), 0, (fallen,), 1, 1.0)
    figures = swept.summary()
    assert set(figures) == fields("sweep")
    assert set(figures["failures"][0]["factors"]) == fields("factors")


@pytest.mark.slow
def test_fields_of_a_physical_performance_and_a_comparison(phrase: Score) -> None:
    comparison = enpointe.compare(phrase)
    figures = comparison.summary()
    physical = comparison.performances["physical"].summary()
    assert set(physical) == fields("kinematic") | fields("physical")
    assert fields("wholebody") == {"qp_failures"}
    assert set(figures) == {"variants", "differences"}
    for difference in figures["differences"]:
        assert set(difference) == fields("difference")


def test_columns_of_the_balance_table() -> None:
    assert fields("balance") == set(COLUMNS)


def test_fields_of_poses(phrase: Score) -> None:
    (row,) = re.findall(r"^\| `rules` \|.*$", table("pose"), flags=re.MULTILINE)
    for pose in enpointe.pose(phrase).summary()["poses"]:
        assert set(pose) == fields("pose")
        for rule in pose["rules"]:
            assert set(rule) == set(re.findall(r"`(\w+)`", row)) - {"rules", "mm", "deg"}
    json.dumps(enpointe.pose(phrase).summary())


@pytest.mark.slow
def test_the_readmes_figures_are_those_of_the_dance() -> None:
    """Rounded as the README rounds them."""
    figures = enpointe.perform("third-port-de-bras", effort="happy").summary()
    margin, fit = figures["support_margin_min"], figures["logistic"]
    assert margin is not None
    assert fit is not None
    said = dict(
        re.findall(
            r"^\| ([^|]*?) \| ([^|]*?) \|",
            (ROOT / "README.md").read_text(encoding="utf-8"),
            flags=re.MULTILINE,
        )
    )
    assert {
        "joints behind the score, rms": f"{figures['tracking_rms_deg']:.2f}°",
        "centre of mass inside the support, at least": f"{1000 * margin:.0f} mm",
        "feet slip, at most": f"{1000 * figures['slip_max']:.1f} mm",
        "force on the root from anything but gravity and floor": f"{figures['root_force_max']:g} N",
        "strength used, at most": f"{100 * figures['torque_limit_fraction_max']:.0f} %",
        "timing asked, and danced under gravity": (
            f"$b$ −2.42, −{-fit['b']:.2f}; $x_0$ 0.60, {fit['x0']:.2f}"
        ),
    }.items() <= said.items()
