"""The rod that `sinuous bench rod` is told of."""

from typing import TYPE_CHECKING

from sinuous.cli.arguments import Bench
from sinuous.errors import InputError

if TYPE_CHECKING:
    from sinuous.bench.rod import RodTask

UNITS = {"length": "m", "radius": "m", "youngs": "Pa", "poisson": "1", "density": "kg/m^3"}


def rod_task(arguments: Bench) -> "RodTask":
    """What to compare.

    Raises:
        InputError: if something is missing or no rod
    """
    from sinuous.bench.rod import RodTask
    from sinuous.robots.rod_mechanics import RoundRod

    if arguments.file is None:
        raise InputError(
            file="bench rod",
            expected="a file of shapes",
            found="nothing",
            remedy="Name it: sinuous bench rod FILE.csv --length 0.6 ...",
        )
    length = _given("length", arguments.length)
    if not 0.0 < length < float("inf"):
        raise _no_rod("--length", f"a positive length, not {length:g}")
    try:
        rod = RoundRod(
            radius=_given("radius", arguments.radius),
            youngs_modulus=_given("youngs", arguments.youngs),
            poisson=_given("poisson", arguments.poisson),
            density=_given("density", arguments.density),
        )
    except ValueError as error:
        raise _no_rod("bench rod", str(error)) from None
    return RodTask(path=arguments.file, rod=rod, length=length)


def refuse_rod(arguments: Bench) -> None:
    """Refuse what only `bench rod` takes.

    Raises:
        InputError: if something of it is given
    """
    given = [f"--{name}" for name in UNITS if getattr(arguments, name) is not None]
    if arguments.file is not None:
        given.insert(0, arguments.file)
    if given:
        raise InputError(
            file=f"bench {arguments.what}",
            expected="no file and no rod",
            found=" ".join(given),
            remedy="Leave them out: only bench rod takes them.",
        )


def _given(name: str, value: float | None) -> float:
    if value is None:
        raise InputError(
            file="bench rod",
            field=f"--{name}",
            expected=f"a number [{UNITS[name]}]",
            found="nothing",
            remedy=f"Add --{name}, in SI units.",
        )
    return value


def _no_rod(where: str, why: str) -> InputError:
    return InputError(
        file=where, expected="a rod", found=why, remedy="Correct it; all numbers are in SI units."
    )
