"""What the documents show has to be true: their files load, their code runs."""

import re
import tomllib
from pathlib import Path

import pytest

from sinuous.files import build
from sinuous.robots.jointed_tables import JointedTable
from sinuous.robots.pcc_tables import PccTable
from sinuous.scenario.tables import ScenarioTable

ROOT = Path(__file__).parents[1]


def blocks(document: str, language: str) -> list[str]:
    """Code blocks of a language in a document."""
    text = (ROOT / document).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


def test_the_files_shown_are_valid() -> None:
    scenario, segments, modules = blocks("docs/files.md", "toml")
    build(ScenarioTable, tomllib.loads(scenario), file="docs/files.md")
    build(PccTable, tomllib.loads(segments), file="docs/files.md")
    build(JointedTable, tomllib.loads(modules), file="docs/files.md")


def test_the_shortest_example_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (example,) = blocks("README.md", "python")
    monkeypatch.chdir(ROOT)
    exec(compile(example.replace("range(300)", "range(3)"), "README.md", "exec"), {})
    assert "mm" in capsys.readouterr().out


def test_every_linked_file_exists() -> None:
    for document in ("README.md", *map(str, (ROOT / "docs").glob("*.md"))):
        path = ROOT / document
        links = re.findall(r"\]\((?!http)([^)#]+)", path.read_text(encoding="utf-8"))
        for link in links:
            assert (path.parent / link).exists(), f"{document}: {link}"
