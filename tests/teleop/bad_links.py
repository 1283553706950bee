"""Random connections of every kind, for tests that must hold on all of them."""

from hypothesis import strategies as st

from sinuous.teleop.delays import NormalJitter, Steady, UniformJitter, Varying
from sinuous.teleop.impaired import Effect, ImpairedLink
from sinuous.teleop.losses import BurstLoss, Duplication, Outages, RandomLoss, RandomOutages

# Short, so that a run of some hundred ticks sees all that there is.
_TIMES = st.floats(0.0, 0.4)
_DELAYS = st.floats(0.0, 0.06)

_EFFECTS: st.SearchStrategy[Effect] = st.one_of(
    st.builds(UniformJitter, st.floats(0.0, 0.05)),
    st.builds(NormalJitter, st.floats(0.0, 0.03), cut=st.floats(0.5, 3.0)),
    st.builds(
        lambda points: Varying(tuple(sorted(points))),
        st.lists(st.tuples(_TIMES, _DELAYS), min_size=1, max_size=4),
    ),
    st.builds(RandomLoss, st.floats(0.0, 0.6)),
    st.builds(
        BurstLoss,
        worsening=st.floats(0.0, 0.2),
        recovery=st.floats(0.02, 1.0),
        lost_when_good=st.floats(0.0, 0.1),
        lost_when_bad=st.floats(0.5, 1.0),
    ),
    st.builds(Duplication, share=st.floats(0.0, 1.0), after=st.floats(0.0, 0.05)),
    st.builds(
        lambda begin, length: Outages(((begin, begin + length),)), _TIMES, st.floats(0.01, 0.2)
    ),
    st.builds(RandomOutages, rate=st.floats(0.0, 10.0), length=st.floats(0.005, 0.1)),
)


@st.composite
def links(draw: st.DrawFn) -> ImpairedLink:
    """A delay with up to four things on top."""
    effects = draw(st.lists(_EFFECTS, max_size=4))
    return ImpairedLink(
        effects=(Steady(draw(_DELAYS)), *effects),
        seed=draw(st.integers(0, 2**16)),
        in_order=draw(st.booleans()),
    )
