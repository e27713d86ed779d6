"""A report holds everything in itself, says honestly what was danced, and its figures are true."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from PIL import Image

from enpointe.comparing import Comparison
from enpointe.models.certificate import Certificate
from enpointe.performing import Performance
from enpointe.posing import Poses
from enpointe.report import ReportFiles, write_report

from .pages import HOSTILE, read, words_of

KINDS = ("physical", "kinematic", "fallen", "comparison", "poses")


def section_names(page: ElementTree.Element) -> list[str]:
    return [section.attrib["id"] for section in page.iter("section")]


def figures(page: ElementTree.Element) -> dict[str, list[tuple[float, str]]]:
    """Values and texts of the rows that are figures of the summary."""
    return {
        row.attrib["data-figure"]: [
            (float(data.attrib["value"]), words_of(data)) for data in row.iter("data")
        ]
        for row in page.iter("tr")
        if "data-figure" in row.attrib
    }


@pytest.mark.parametrize("kind", KINDS)
class TestEveryKind:
    def test_the_files_exist_and_are_what_they_say(
        self, reports: dict[str, ReportFiles], kind: str
    ) -> None:
        files = reports[kind]
        assert set(files) == {"report", "stave", "key_poses"}
        assert files["report"].name == "report.html"
        assert ElementTree.parse(files["stave"]).getroot().tag.endswith("svg")
        with Image.open(files["key_poses"]) as sheet:
            assert sheet.format == "PNG"
        written = {path.name for path in files["report"].parent.iterdir()}
        assert written == {path.name for path in files.values()}

    def test_nothing_is_asked_from_anywhere(
        self, reports: dict[str, ReportFiles], kind: str
    ) -> None:
        page = read(reports[kind]["report"])
        for element in page.iter():
            assert element.tag not in ("link", "iframe", "object", "embed", "base")
            for name, value in element.attrib.items():
                if name.rpartition("}")[2] in ("src", "href", "srcset", "poster", "action"):
                    assert value.startswith(("#", "data:")), (element.tag, name, value[:80])
        text = reports[kind]["report"].read_text(encoding="utf-8")
        assert all(target.startswith("#") for target in re.findall(r"url\(['\"]?([^)]*)", text))
        assert "@import" not in text
        namespaces = {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}
        assert set(re.findall(r"https?://[^\s\"'<>]+", text)) <= namespaces

    def test_ids_differ_and_references_lead_somewhere(
        self, reports: dict[str, ReportFiles], kind: str
    ) -> None:
        page = read(reports[kind]["report"])
        ids = [e.attrib["id"] for e in page.iter() if "id" in e.attrib]
        assert len(ids) == len(set(ids))
        text = reports[kind]["report"].read_text(encoding="utf-8")
        wanted = set(re.findall(r"url\(#([^)]+)\)", text))
        wanted |= set(re.findall(r'href="#([^"]+)"', text))
        assert wanted <= set(ids)

    def test_pictures_and_tables_can_be_read_aloud(
        self, reports: dict[str, ReportFiles], kind: str
    ) -> None:
        page = read(reports[kind]["report"])
        assert all(image.attrib.get("alt") for image in page.iter("img"))
        for drawing in page.iter("svg"):
            named = drawing.attrib.get("aria-label") or drawing.findtext("title")
            assert drawing.attrib.get("role") == "img"
            assert named
        for table in page.iter("table"):
            assert words_of(table.findall("caption")[0])
            widths = {len(list(row)) for row in table.iter("tr")}
            assert len(widths) == 1
            assert all("scope" in head.attrib for head in table.iter("th"))

    def test_charts_style_nothing_but_themselves(
        self, reports: dict[str, ReportFiles], kind: str
    ) -> None:
        page = read(reports[kind]["report"])
        for drawing in page.iter("svg"):
            assert not list(drawing.iter("style"))
            assert not list(drawing.iter("metadata"))


def test_sections_of_a_physical_performance(reports: dict[str, ReportFiles]) -> None:
    assert section_names(read(reports["physical"]["report"])) == [
        "figures",
        "stave",
        "poses",
        "wrists",
        "effort",
        "promises",
        "balance",
        "joints",
        "rules",
        "certificates",
    ]


def test_a_kinematic_performance_has_no_physics_in_it(reports: dict[str, ReportFiles]) -> None:
    page = read(reports["kinematic"]["report"])
    assert section_names(page) == [
        "figures",
        "stave",
        "poses",
        "wrists",
        "effort",
        "rules",
        "certificates",
    ]
    assert "No physics" in words_of(verdict(page))
    assert set(figures(page)) == {"duration", "tempo", "b", "x0", "space", "rms"}


def test_sections_of_a_comparison(reports: dict[str, ReportFiles], comparison: Comparison) -> None:
    page = read(reports["comparison"]["report"])
    assert section_names(page) == [
        "variants",
        "stave",
        "wrists",
        "fits",
        "figures",
        "differences",
        "poses",
        "certificates",
    ]
    for variant in comparison.performances:
        assert variant in words_of(page)


def test_sections_and_pictures_of_poses(reports: dict[str, ReportFiles], poses: Poses) -> None:
    page = read(reports["poses"]["report"])
    assert section_names(page) == ["stave", "poses", "certificates"]
    assert len(list(page.iter("img"))) == 3 * len(poses.key_poses)


def verdict(page: ElementTree.Element) -> ElementTree.Element:
    return next(e for e in page.iter() if e.attrib.get("id") == "verdict")


def test_the_verdict_comes_first_and_is_honest(
    reports: dict[str, ReportFiles], fallen: Performance
) -> None:
    for kind in KINDS:
        page = read(reports[kind]["report"])
        first = next(e for e in page.iter("main"))[0][0]
        assert first is verdict(page)
    assert "completed" in words_of(verdict(read(reports["physical"]["report"])))
    assert "root was 0 N" in words_of(verdict(read(reports["physical"]["report"])))
    said = words_of(verdict(read(reports["fallen"]["report"])))
    assert "not completed" in said
    assert fallen.measures is not None
    assert fallen.recording is not None
    assert f"left her feet at {fallen.measures.fell_at:.2f} s" in said
    assert f"down at {fallen.recording.time[-1]:.2f} s" in said


def measured(dance: Performance, **figures: Any) -> Performance:
    """The same dance, had its figures been others."""
    assert dance.physics is not None
    measures = dataclasses.replace(dance.physics.measures, **figures)
    return dataclasses.replace(dance, physics=dataclasses.replace(dance.physics, measures=measures))


def test_who_topples_at_the_end_has_not_completed(physical: Performance, tmp_path: Path) -> None:
    """No fault stopped the dance, but its figures say that she no longer stood."""
    toppling = measured(physical, fell_at=1.25)
    page = read(write_report(toppling, tmp_path, video=False)["report"])
    said = words_of(verdict(page))
    assert "not completed" in said
    assert "falling at the end; her weight left her feet at 1.25 s" in said
    assert verdict(page).attrib["class"] == "bad"


def test_help_on_the_root_is_told(physical: Performance, tmp_path: Path) -> None:
    helped = measured(physical, root_force_max=12.5)
    page = read(write_report(helped, tmp_path, video=False)["report"])
    assert "not an honest dance" in words_of(verdict(page))
    assert "12.5 N" in words_of(verdict(page))
    assert verdict(page).attrib["class"] == "bad"


SHOWN_PER_UNIT = {
    "duration": ("s", 1.0),
    "tempo": ("a minute", 1.0),
    "fell_at": ("s", 1.0),
    "root_force_max": ("N", 1.0),
    "other_contact_max": ("N", 1.0),
    "support_margin_min": ("mm", 1e3),
    "slip_max": ("mm", 1e3),
    "tracking_rms_deg": ("°", 1.0),
    "torque_limit_fraction_max": ("%", 100.0),
    "realtime_factor": ("× real time", 1.0),
}


@pytest.mark.parametrize("kind", ["physical", "fallen"])
def test_figures_are_those_of_the_summary(
    reports: dict[str, ReportFiles], physical: Performance, fallen: Performance, kind: str
) -> None:
    performance = {"physical": physical, "fallen": fallen}[kind]
    page = read(reports[kind]["report"])
    section = next(s for s in page.iter("section") if s.attrib["id"] == "figures")
    summary = performance.summary()
    numbers = {
        name: value
        for name, value in summary.items()
        if name in SHOWN_PER_UNIT and value is not None
    }
    shown = figures(section)
    assert set(shown) == set(numbers)
    for name, value in numbers.items():
        unit, scale = SHOWN_PER_UNIT[name]
        assert isinstance(value, float | int)
        [(exact, text)] = shown[name]
        assert exact == float(value)
        number, _, after = text.replace("°", " °").partition(" ")
        assert after == unit
        digits = len(number.partition(".")[2])
        assert float(number) == pytest.approx(scale * value, abs=0.51 * 10.0**-digits, rel=5e-3)


def test_effort_that_came_out_is_the_fit(
    reports: dict[str, ReportFiles], physical: Performance
) -> None:
    page = read(reports["physical"]["report"])
    section = next(s for s in page.iter("section") if s.attrib["id"] == "effort")
    shown = figures(section)
    asked, danced = physical.asked_fit(), physical.danced_fit()
    assert asked is not None
    assert danced is not None
    assert [v for v, _ in shown["b"]] == [physical.effort.time, asked.time, danced.time]
    assert [v for v, _ in shown["x0"]] == [physical.effort.weight, asked.weight, danced.weight]
    assert [v for v, _ in shown["rms"]] == [asked.rms, danced.rms]


def test_differences_are_those_of_the_comparison(
    reports: dict[str, ReportFiles], comparison: Comparison
) -> None:
    shown = figures(read(reports["comparison"]["report"]))
    for d in comparison.differences:
        values = [value for value, _ in shown[f"difference-{d.first}-{d.second}"]]
        assert values == [*d.wrist_path_rms.values(), d.joint_rms_deg]
    margins = [value for value, _ in shown["support_margin_min"]]
    measures = comparison.performances["physical"].measures
    assert measures is not None
    assert margins == [measures.support_margin_min]


def test_broken_rules_stand_out(poses: Poses, tmp_path: Path) -> None:
    first, *others = poses.key_poses
    results = list(first.certificate.results)
    results[0] = dataclasses.replace(results[0], value=9.5, held=False)
    broken = dataclasses.replace(first, certificate=Certificate(tuple(results)))
    page = read(
        write_report(
            dataclasses.replace(poses, key_poses=(broken, *others)), tmp_path, video=False
        )["report"]
    )
    assert broken.name in words_of(verdict(page))
    marked = [words_of(e) for e in page.iter() if e.attrib.get("class") == "broken"]
    assert any("9.5" in text and results[0].rule in text for text in marked)
    assert "9.5 broken" in marked


@pytest.mark.parametrize("kind", ["kinematic", "poses"])
def test_hostile_titles_are_words_and_nothing_else(
    reports: dict[str, ReportFiles], kind: str
) -> None:
    page = read(reports[kind]["report"])
    assert page.findtext("head/title") == HOSTILE.replace("\x08", "\ufffd")
    text = reports[kind]["report"].read_text(encoding="utf-8")
    assert "<script>alert" not in text
    assert len(list(page.iter("script"))) == 1
