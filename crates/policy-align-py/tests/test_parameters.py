"""Parameters, and errors in Python's terms."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
from conftest import DT, TOY, on_rails

from policy_align import (
    AutoGp,
    Demonstrations,
    DirectGp,
    NotFittedError,
    PolicyAlign,
    PolicyAlignError,
    PolicyAlignWarning,
    SlopeGp,
    load,
)

LEARNERS = [PolicyAlign, SlopeGp, DirectGp, AutoGp]


@pytest.mark.parametrize(
    ("learner", "what", "hint"),
    [
        (PolicyAlign("wider"), "'wider' is not a positive number", 'bandwidth="auto"'),
        (PolicyAlign(-1.0), "'-1' is not a positive number", 'bandwidth="auto"'),
        (PolicyAlign(float("nan")), "'NaN' is not a positive number", 'bandwidth="auto"'),
        (PolicyAlign(init_d=0.0), "'0' is not a positive number", 'init_d="auto"'),
        (PolicyAlign(folds=1), "folds is 1: it must be at least 2", None),
        (SlopeGp(max_rows=3), "max_rows is 3: it must be at least 50", None),
        (SlopeGp(integration="euler"), "'euler' is none of the choices", '"auto", "velocity" or "displacement"'),
        (SlopeGp(smooth="hard"), "'hard' is not a window", 'smooth="auto", "off", 9 (samples) or "0.2s"'),
        (SlopeGp(smooth=9.0), "'9.0' is not a window", None),
        (SlopeGp(smooth=4), "smooth: a window of 4 samples, 0.05 s apart", None),
        (SlopeGp(jumps="cut"), "'cut' is none of the choices", '"auto" or "keep"'),
        (SlopeGp(wraps=""), "'' is none of the choices", '"auto" or "keep"'),
        (SlopeGp(scale={"z": 2.0}), "scale names 'z', but the state has x0, x1", "use one of these names"),
        (SlopeGp(scale={"x0": -2.0}), "scale x0=-2: a scale must be positive and finite", "scale={'x0': 10.0}"),
        (AutoGp(reading="maybe"), "'maybe' is none of the choices", 'None, "free" or "constrained"'),
        (SlopeGp(n_jobs=0), "n_jobs is 0: it must be None, -1 or at least 1", "n_jobs=None"),
    ],
)
def test_parameters_are_looked_at_in_fit(learner: SlopeGp, what: str, hint: str | None) -> None:
    positions, velocities = on_rails()
    with pytest.raises(PolicyAlignError) as error:
        learner.fit(positions, dt=DT, velocities=velocities)
    assert error.value.what == what
    assert hint is None or error.value.hint == hint
    assert isinstance(error.value, ValueError)


def test_a_window_is_given_in_samples_or_seconds() -> None:
    positions, velocities = on_rails()

    def smoothing(smooth: str | int) -> list[str]:
        model = SlopeGp(smooth=smooth, max_rows=60).fit(positions, dt=DT, velocities=velocities)
        return [one.value for one in model.decisions_ if one.what == "smoothing"]

    assert smoothing(9) == smoothing("9") == smoothing("0.45s") == ["positions, window of 9 samples"]
    assert smoothing("off") == ["none: positions as recorded"]
    with pytest.raises(PolicyAlignError) as error:
        smoothing(6)
    assert error.value.hint == 'an odd number of at least 5, as in smooth=9, or seconds, as in smooth="0.45s"'


@pytest.mark.parametrize("learner", [PolicyAlign(folds=2.5), SlopeGp(random_state="one"), SlopeGp(max_rows=-1)])
def test_parameters_of_another_type_are_refused(learner: SlopeGp) -> None:
    positions, _ = on_rails()
    with pytest.raises((TypeError, OverflowError)):
        learner.fit(positions, dt=DT)


@pytest.mark.parametrize(
    ("learner", "what"),
    [
        (PolicyAlign(folds="five"), "folds is a whole number of at least 0, not 'five'"),  # type: ignore[arg-type]
        (AutoGp(max_rows=2.5), "max_rows is a whole number of at least 0, not 2.5"),  # type: ignore[arg-type]
        (AutoGp(inducing=-1), "inducing is a whole number of at least 0, not -1"),
        (AutoGp(scale=2.0), "scale is a factor for each channel by its name, not 2.0"),  # type: ignore[arg-type]
    ],
)
def test_wrong_types_are_named(learner: AutoGp, what: str) -> None:
    positions, _ = on_rails()
    with pytest.raises(TypeError, match=what):
        learner.fit(positions, dt=DT)


@pytest.mark.parametrize("learner", LEARNERS)
def test_nothing_is_said_before_fit(learner: type[SlopeGp]) -> None:
    model = learner()
    for ask in (
        lambda: model.predict([[0.0, 0.0]]),
        lambda: model.potential([[0.0, 0.0]]),
        lambda: model.rollout([0.0, 0.0]),
        lambda: model.score([]),
        lambda: model.save("never.json"),
        lambda: model.trust_,
        lambda: model.decisions_,
        lambda: model.n_features_in_,
    ):
        with pytest.raises(NotFittedError, match=f"This {learner.__name__} instance is not fitted yet"):
            ask()
    assert not hasattr(model, "n_features_in_")
    assert issubclass(NotFittedError, (ValueError, AttributeError))


def test_errors_survive_pickling() -> None:
    error = PolicyAlignError("what", "where", "hint", "NoTime", 1, 2, 3)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.code, again.trajectory, again.sample, again.column) == (
        "what\n  in:  where\n  try: hint",
        "NoTime",
        1,
        2,
        3,
    )


def test_hints_name_arguments(tmp_path) -> None:
    def hint(text: str, **options: object) -> str:
        path = tmp_path / "demo.csv"
        path.write_text(text)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with pytest.raises(PolicyAlignError) as error:
                Demonstrations.read(path, **options)
        assert "--" not in str(error.value), error.value
        return error.value.hint

    assert hint("t,x\n0,1\n0.1,nan\n0.2,3\n") == (
        'nan="drop" (leaves the sample out) or nan="fill" (interpolates gaps of up to 3 samples)'
    )
    assert hint("x,y\n1,2\n2,3\n").startswith("dt=SECONDS (the time between samples), or time= with")
    assert hint("t,x\n0,1\n0.2,2\n0.1,3\n").startswith("sort= (puts samples in the order of their stamps), or split_gap=1 if a new movement")
    headless = "0,1,5\n0.1,2,4\n0.2,4,2\n0.3,3,1\n"
    assert hint(headless).startswith('state="1-2", time="0" (columns count from 0')
    (tmp_path / "demo.csv").write_text(headless)
    assert Demonstrations.read(tmp_path / "demo.csv", state="1-2", time="0").trajectories[0].shape == (4, 2)
    with pytest.raises(PolicyAlignError, match="unknown field `speed`"):
        Demonstrations.read(TOY, speed="x")


def test_findings_and_decisions_name_arguments() -> None:
    seconds = DT * np.arange(80)
    angles = [start + 4.0 * (1.0 - np.exp(-seconds)) for start in np.linspace(-3.0, 3.0, 13)]
    wrapped = [np.column_stack([np.angle(np.exp(1j * angle)), 2.0 * np.exp(-seconds)]) for angle in angles]
    recordings = Demonstrations(wrapped, dt=DT, channels=["angle", "x"])
    check = recordings.check()
    advice = next(finding.next for finding in check.findings if "whole turn" in finding.what)
    assert 'choose the angles yourself (wraps="keep", unwrap=NAMES)' in advice
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = SlopeGp(max_rows=60).fit(recordings)
    assert advice in [finding.next for finding in model.trust_.findings]
    texts = [str(check), str(model.trust_), *map(str, model.decisions_), *map(str, model.left_out_)]
    assert not [text for text in texts if "--" in text]


def test_files_that_do_not_exist_are_reported(tmp_path) -> None:
    with pytest.raises(PolicyAlignError) as error:
        Demonstrations.read(tmp_path / "none.csv")
    assert error.value.code in ("MissingFile", "Unreadable")
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.json")
    (tmp_path / "half.json").write_text("{")
    with pytest.raises(PolicyAlignError, match="not JSON"):
        load(tmp_path / "half.json")


def test_missing_files_are_named_as_given(aligned: PolicyAlign, tmp_path) -> None:
    nowhere = str(tmp_path / "none" / "file")
    for use in (
        lambda: aligned.rollout([0.5, 0.5], constraint=nowhere),
        lambda: aligned.rollout([0.5, 0.5], limits=nowhere),
        lambda: aligned.save(nowhere),
        lambda: load(nowhere),
    ):
        with pytest.raises(FileNotFoundError) as error:
            use()
        assert error.value.filename == nowhere
    with pytest.raises(PolicyAlignError) as error:
        Demonstrations.read(nowhere)
    assert nowhere in str(error.value)


def test_doubts_are_warned_of_once_and_stay() -> None:
    positions, velocities = on_rails()
    with pytest.warns(PolicyAlignWarning) as warned:
        model = DirectGp(max_rows=60).fit(positions, dt=DT, velocities=velocities)
    assert len(warned) == 1 and warned[0].filename == __file__
    assert model.trust_.verdict != "good"
    assert model.trust_.findings[0].what in str(warned[0].message)
    assert "<b>" in model.trust_._repr_html_()


def test_a_policy_without_potential_or_deviation_says_so(rails, aligned: PolicyAlign) -> None:
    direct = DirectGp(max_rows=60).fit(rails[0], dt=DT, velocities=rails[1])
    assert direct.predict([[0.0, 0.0]], return_std=True)[1].shape == (1, 2)
    with pytest.raises(PolicyAlignError, match="has no potential"):
        direct.potential([[0.0, 0.0]])
    for states in ([[0.0, 0.0]], np.empty((0, 2))):
        with pytest.raises(PolicyAlignError, match="estimates no standard deviation"):
            aligned.predict(states, return_std=True)
