"""What the command line takes; the texts here are its manual."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, UseAppendAction, arg

Folder = Annotated[str, arg(metavar="DIR")]
Assignments = Annotated[UseAppendAction[tuple[tuple[str, ...], ...]], arg(metavar="KEY=VALUE ...")]


def assignments(groups: tuple[tuple[str, ...], ...]) -> list[str]:
    """All overrides, whether they followed one --set or several."""
    return [text for group in groups for text in group]


@dataclass(frozen=True, kw_only=True)
class Run:
    """Run a scenario and write run.mcap, summary.json and figures/ to a folder.

    Exit codes: 0 done, 1 the plant failed, 2 bad input, 130 interrupted (what ran until then
    is kept).
    """

    scenario: Positional[Annotated[str, arg(metavar="SCENARIO")]]
    """the scenario's TOML file"""
    out: Folder
    """folder for the results; that of an earlier run is overwritten"""
    set: Assignments = ()
    """change fields of the scenario, such as mpc.horizon=8 path.max_steps=100"""


@dataclass(frozen=True, kw_only=True)
class Check:
    """Say whether a robot, mesh, scenario, path or recording is good, and if not what to change.

    With --target: whether the robot of a scenario gets there from its start, and what stops it.
    Exit codes: 0 good (or reached), 1 the target is not reached, 2 bad input.
    """

    file: Positional[Annotated[str, arg(metavar="FILE")]]
    """a robot or scenario (.toml), mesh (.stl, .obj, .ply), path (.csv) or recording (.mcap);
    a robot may be the name of a preset"""
    unit: Annotated[str | None, arg(metavar="{m,cm,mm}")] = None
    """of the numbers in a mesh file"""
    target: Annotated[str | None, arg(metavar="X,Y,Z")] = None
    """a place for the tip in the mesh's frame, in millimetres"""
    set: Assignments = ()
    """change fields of a scenario first"""


@dataclass(frozen=True, kw_only=True)
class Compare:
    """Lay two runs side by side: a table, and comparison.png in a folder."""

    first: Positional[Annotated[str, arg(metavar="RUN")]]
    """the folder of a run, or its run.mcap"""
    second: Positional[Annotated[str, arg(metavar="RUN")]]
    """another one"""
    out: Folder
    """folder for the figure"""
