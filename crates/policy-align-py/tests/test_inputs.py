"""Arrays of any layout and type yield the same bits as a C-ordered copy, or an error with the reason."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import DT, on_rails

from policy_align import Demonstrations, PolicyAlignError, SlopeGp

SAME = {
    "fortran": np.asfortranarray,
    "strided": lambda x: np.repeat(x, 2, axis=0)[::2],
    "strided columns": lambda x: np.repeat(x, 3, axis=1)[:, ::3],
    "negative strides": lambda x: x[::-1].copy()[::-1],
    "negative columns": lambda x: x[:, ::-1].copy()[:, ::-1],
    "object": lambda x: x.astype(object),
    "list": lambda x: x.tolist(),
    "tuples": lambda x: tuple(map(tuple, x)),
    "data frame": lambda x: pytest.importorskip("pandas").DataFrame(x, columns=["x", "y"]),
    "big endian": lambda x: x.astype(">f8"),
    "unaligned": lambda x: _unaligned(x),
}
#: Types with fewer digits.
ROUNDED = {"float32": np.float32, "float16": np.float16, "int64": np.int64, "uint8": np.uint8}


def _unaligned(x: np.ndarray) -> np.ndarray:
    place = np.zeros(x.nbytes + 1, dtype=np.uint8)[1:].view(np.float64).reshape(x.shape)
    place[:] = x
    return place


def _read_only(x: np.ndarray) -> np.ndarray:
    x = x.copy()
    x.flags.writeable = False
    return x


def states() -> np.ndarray:
    return np.random.default_rng(3).uniform(-1, 1, (7, 2))


@pytest.mark.parametrize("name", [*SAME, "read only"])
def test_predictions_have_the_same_bits(name: str, slope: SlopeGp) -> None:
    x = states()
    other = {**SAME, "read only": _read_only}[name](x)
    for of in (slope.predict, slope.potential, slope.support, slope.supports):
        assert np.array_equal(of(other), of(x))
    for one, another in zip(slope.predict(other, return_std=True), slope.predict(x, return_std=True), strict=True):
        assert np.array_equal(one, another)
    assert np.array_equal(x, states())


@pytest.mark.parametrize("name", ROUNDED)
def test_shorter_numbers_are_taken_as_they_are(name: str, slope: SlopeGp) -> None:
    x = (4 * states()).astype(ROUNDED[name])
    assert np.array_equal(slope.predict(x), slope.predict(x.astype(np.float64)))


@pytest.mark.parametrize("name", [*SAME, "read only"])
def test_fits_have_the_same_bits(name: str, rails: tuple[list[np.ndarray], list[np.ndarray]]) -> None:
    convert = {**SAME, "read only": _read_only}[name]
    learner = SlopeGp(max_rows=60)
    usual = learner.fit(rails[0], dt=DT, velocities=rails[1]).predict(states())
    found = learner.fit([convert(x) for x in rails[0]], dt=DT, velocities=[convert(u) for u in rails[1]])
    assert np.array_equal(found.predict(states()), usual)


def test_movements_come_in_four_forms(rails: tuple[list[np.ndarray], list[np.ndarray]]) -> None:
    learner = SlopeGp(max_rows=60)
    usual = learner.fit(rails[0], dt=DT).predict(states())
    stacked, flat, lengths = np.stack(rails[0]), np.concatenate(rails[0]), [len(x) for x in rails[0]]
    assert np.array_equal(learner.fit(stacked, dt=DT).predict(states()), usual)
    assert np.array_equal(learner.fit(flat, lengths=lengths, dt=DT).predict(states()), usual)
    times = [DT * np.arange(len(x)) for x in rails[0]]
    assert np.array_equal(learner.fit(rails[0], times=times).predict(states()), usual)


def test_no_row_no_action(slope: SlopeGp) -> None:
    none = np.empty((0, 2))
    assert slope.predict(none).shape == (0, 2)
    assert slope.predict(none, return_std=True)[1].shape == (0, 2)
    assert slope.potential(none).shape == slope.support(none).shape == (0,)
    assert slope.supports(none).dtype == np.bool_


def test_states_of_another_shape_are_refused(slope: SlopeGp) -> None:
    with pytest.raises(PolicyAlignError, match="Expected 2D array, got 1D array instead") as error:
        slope.predict([0.1, 0.2])
    assert "reshape(1, -1)" in str(error.value)
    with pytest.raises(PolicyAlignError, match="X has 3 features, but SlopeGp is expecting 2 features as input"):
        slope.predict(np.zeros((4, 3)))
    with pytest.raises(PolicyAlignError, match="Expected 2D array, got 3D"):
        slope.predict(np.zeros((4, 3, 2)))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_states_that_are_not_finite_are_refused(value: float, slope: SlopeGp) -> None:
    x = states()
    x[4, 1] = value
    for of in (slope.predict, slope.potential, slope.support, slope.supports, lambda x: slope.predict(x, True)):
        with pytest.raises(PolicyAlignError, match="sample 4 is not finite in channel 'y'") as error:
            of(x)
        assert (error.value.sample, error.value.column) == (4, 1)


@pytest.mark.parametrize(
    "x", [[["a", "b"]], np.array([[1j, 0]]), [[None, 1.0]], [[1.0], [1.0, 2.0]], np.array([["1", "2"]]), {"x": 1}]
)
def test_what_is_no_number_is_a_type_error(x: object, slope: SlopeGp) -> None:
    with pytest.raises((TypeError, ValueError)) as error:
        slope.predict(x)
    assert isinstance(error.value, (TypeError, PolicyAlignError)), error.value


def test_movements_that_cannot_be_learnt_from_are_refused() -> None:
    positions, velocities = on_rails()
    learner = SlopeGp(max_rows=60)

    def said(*given: object, **more: object) -> PolicyAlignError:
        with pytest.raises(PolicyAlignError) as error:
            learner.fit(*given, **{"dt": DT, **more})
        return error.value

    broken = [x.copy() for x in positions]
    broken[3][5, 1] = np.nan
    error = said(broken)
    assert "episode '3': states, sample 5, dimension 1: NaN is not a finite number" in error.what
    assert (error.trajectory, error.sample, error.column) == (3, 5, 1)
    assert error.hint == "drop or interpolate the sample"
    broken = [u.copy() for u in velocities]
    broken[2][0, 0] = np.inf
    error = said(positions, velocities=broken)
    assert "velocities, sample 0, dimension 0" in error.what and error.trajectory == 2
    assert "at least 2 are needed" in said([*positions, positions[0][:1]]).what
    assert "at least 2 are needed" in said([*positions, positions[0][:0]]).what
    assert "13 dimensions" not in said([*positions, np.zeros((9, 3))]).what
    assert said([*positions, np.zeros((9, 3))]).trajectory == len(positions)
    assert "velocities have shape" in said(positions, velocities=[u[:-2] for u in velocities]).what
    some = [u[:-1] if k else u for k, u in enumerate(velocities)]
    assert "velocities have shape" in said(positions, velocities=some).what
    assert "11 velocities for 12" in said(positions, velocities=velocities[1:]).what
    assert said([]).what == "there is no episode"
    assert "time step 0 s" in said(positions, dt=0.0).what
    assert said(positions, dt=-1.0).hint == "dt=0.02, in seconds"
    with pytest.raises(TypeError, match="a number of seconds"):
        SlopeGp().fit(positions, dt="a")  # type: ignore[arg-type]
    assert "time step NaN s" in said(positions, dt=np.nan).what
    assert said(positions, dt=None).code == "NoTime"
    assert "40 samples" in said(positions, times=[[0.0, 1.0]] * 12).what
    backwards = [DT * np.arange(40)[::-1]] * 12
    assert said(positions, times=backwards).sample == 1
    assert "no channel changes" in said([np.ones((9, 2))] * 3).what or "left out" in said([np.ones((9, 2))] * 3).what
    assert "lengths add up to 79" in said(np.concatenate(positions[:2]), lengths=[40, 39]).what
    assert "Expected movements, got 2D array" in said(positions[0]).what
    assert "Expected 2D array, got 1D" in said([np.arange(9.0)]).what
    assert said([np.zeros((5, 40))] * 3).what.startswith("the state has 40 dimensions")
    for given in ("toy.csv", 3, None):
        with pytest.raises(TypeError):
            learner.fit(given, dt=DT)


def test_the_state_after_the_last_action_is_left_out(rails) -> None:
    positions, velocities = rails
    stamps = [DT * np.arange(len(x)) for x in positions]
    fewer = [u[:-1] for u in velocities]
    labels = [["a"] * (len(x) - 5) + ["b"] * 5 for x in positions]
    given = Demonstrations(positions, times=stamps, velocities=fewer, constraints=labels)
    cut = Demonstrations([x[:-1] for x in positions], times=[t[:-1] for t in stamps], velocities=fewer)
    assert all(np.array_equal(a, b) for a, b in zip(given, cut, strict=True))
    assert all(np.array_equal(a, b) for a, b in zip(given.times, cut.times, strict=True))
    assert len(given[0]) == len(positions[0]) - 1
    assert given.constraints[0] == labels[0][:-1]
