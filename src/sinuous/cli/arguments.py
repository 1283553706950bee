"""What the command line takes; the texts here are its manual."""

from dataclasses import dataclass
from typing import Annotated, Literal

from tyro.conf import Positional, UseAppendAction, arg

Folder = Annotated[str, arg(metavar="DIR")]
Paper = Literal["qin2020", "hachen2025"]
What = Literal["mpc", "scaling", "tails", "rate", "qp", "ik", "link", "rod", "startup"]
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
class Export:
    """Write a robot as a model for another program: MuJoCo, whose viewer opens it.

    The model is straight and taut, and its inputs are changes of cable lengths in metres.
    """

    robot: Positional[Annotated[str, arg(metavar="ROBOT")]]
    """a preset, or the path of a robot file"""
    mjcf: Annotated[str, arg(metavar="FILE")]
    """file for MuJoCo's XML"""


@dataclass(frozen=True, kw_only=True)
class Compare:
    """Lay two runs side by side: a table, and comparison.png in a folder."""

    first: Positional[Annotated[str, arg(metavar="RUN")]]
    """the folder of a run, or its run.mcap"""
    second: Positional[Annotated[str, arg(metavar="RUN")]]
    """another one"""
    out: Folder
    """folder for the figure"""


@dataclass(frozen=True, kw_only=True)
class Reproduce:
    """Run a paper's experiments: figures, the data behind them, and claims.json, which lays what
    the paper says beside what is measured here.

    hachen2025: shape-constrained control of an extensible tendon-driven robot.

    qin2020: a robot of rigid modules, steered by hand over a delay.
    """

    paper: Positional[Annotated[Paper, arg(metavar="{qin2020,hachen2025}")]]
    """which paper"""
    out: Folder
    """folder for the results; files of an earlier run are overwritten"""
    quick: Annotated[bool, arg()] = False
    """only show that it works: short runs, and figures that say so"""
    only: Annotated[tuple[str, ...], arg(metavar="NAME ...")] = ()
    """run these experiments only"""
    processes: Annotated[int | None, arg(metavar="N")] = None
    """how many processes to use; by default one for each core"""


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Measure what the controller costs, in one thread.

    mpc: one step beside CasADi's solvers and acados, on a stress scene with 30 and 9 disks.

    scaling: one step against disks, guarded points, segments, horizon and vertices of the mesh,
    and the time to load meshes.

    tails: very many steps in random passages, with and without a budget of 0.3 ms, and why the
    slowest were slow.

    rate: steps of 1 ms beside steps of 1/30 s on the same path.

    qp: the solver of the controller's quadratic programs beside DAQP and PIQP.

    ik: the geometric inverse kinematics of the jointed robot beside damped least squares, Newton's
    method, cyclic coordinate descent and FABRIK.

    link: every scheme of teleoperation on good and bad connections, with and without passivity
    control, in relaxed, stiff and worst-case hands; on all cores, a quarter of an hour.

    rod: shapes at rest of a bare rod, built of links as the rod robot is, beside those in a file;
    needs the file and the rod.

    startup: help, imports and the first control step of a new process.
    """

    what: Positional[
        Annotated[What, arg(metavar="{mpc,scaling,tails,rate,qp,ik,link,rod,startup}")]
    ]
    """what to measure"""
    file: Positional[Annotated[str | None, arg(metavar="CSV")]] = None
    """rod: the shapes at rest"""
    length: Annotated[float | None, arg(metavar="M")] = None
    """rod: its length [m]"""
    radius: Annotated[float | None, arg(metavar="M")] = None
    """rod: radius of its section [m]"""
    youngs: Annotated[float | None, arg(metavar="PA")] = None
    """rod: Young's modulus [Pa]"""
    poisson: Annotated[float | None, arg(metavar="NU")] = None
    """rod: Poisson's ratio"""
    density: Annotated[float | None, arg(metavar="KG/M3")] = None
    """rod: density [kg/m^3]"""
    json: Annotated[str | None, arg(metavar="FILE")] = None
    """file for all numbers, settings, versions and solver logs"""
    out: Folder = "out/bench"
    """folder for the figures"""
    quick: Annotated[bool, arg()] = False
    """only show that it works: few steps of the smallest setting"""
