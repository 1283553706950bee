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

    Arguments:
        grid: spacing of the spline [m]
    """
    spline = Spline.fit(scene.zone, spacing=grid, unit=unit(scene.robot))
    command = compiler() if machine_code else None
    if command is None:
        return make_problem(scene, Wall.interpreted(spline), horizon)
    problem = make_problem(scene, Wall.local(spline), horizon)
    return problem.with_functions(compiled(problem.functions, command))
