"""The program of a scene, ready to be solved."""

from sinuous.bench.peers.compile import compiled, compiler
from sinuous.bench.peers.kinematics import unit
from sinuous.bench.peers.problem import Problem, make_problem
from sinuous.bench.peers.spline import Spline, Wall
from sinuous.bench.scene import Scene

GRID = 0.002  # of the spline [m]


def nlp_for(
    scene: Scene, horizon: int, *, grid: float = GRID, machine_code: bool = True
) -> Problem:
    """The program, in machine code where there is a C compiler and it is wanted.

    A zone without walls leaves out the clearance, and what follows from it.

    Arguments:
        grid: spacing of the spline [m]
    """
    command = compiler() if machine_code else None
    wall = None
    if scene.zone.surfaces:
        spline = Spline.fit(scene.zone, spacing=grid, unit=unit(scene.robot))
        wall = Wall.interpreted(spline) if command is None else Wall.local(spline)
    problem = make_problem(scene, wall, horizon)
    if command is None:
        return problem
    return problem.with_functions(compiled(problem.functions, command))
