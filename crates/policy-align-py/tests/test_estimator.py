"""The estimator interface: scikit-learn's tools, and its conventions tested by hand."""

from __future__ import annotations

import copy
import io
import pickle
import subprocess
import sys
import warnings

import numpy as np
import pytest
from conftest import DT, on_rails

from policy_align import AutoGp, DirectGp, PolicyAlign, PolicyAlignError, PolicyAlignWarning, SlopeGp, load

LEARNERS = [PolicyAlign, SlopeGp, DirectGp, AutoGp]
STATES = np.random.default_rng(5).uniform(-1, 1, (30, 2))


@pytest.mark.parametrize("learner", LEARNERS)
def test_parameters_are_stored_untouched(learner: type[SlopeGp]) -> None:
    scale = {"x0": 2.0}
    model = learner(scale=scale, random_state=7)
    assert model.get_params()["scale"] is scale
    assert model.set_params(max_rows=99) is model
    assert model.get_params() == learner(scale=scale, random_state=7, max_rows=99).get_params()
    assert repr(model) == f"{learner.__name__}(scale={{'x0': 2.0}}, max_rows=99, random_state=7)"
    assert repr(learner()) == f"{learner.__name__}()"
    with pytest.raises(ValueError, match="Invalid parameter 'depth'"):
        model.set_params(depth=3)


@pytest.mark.parametrize("learner", LEARNERS)
def test_copies_have_the_same_bits(learner: type[SlopeGp], rails, tmp_path) -> None:
    model = learner(max_rows=60).fit(rails[0], dt=DT, velocities=rails[1])
    model.save(tmp_path / "model.json")
    for again in (
        pickle.loads(pickle.dumps(model)),
        copy.deepcopy(model),
        learner.load(tmp_path / "model.json"),
        load(tmp_path / "model.json"),
        load(io.BytesIO((tmp_path / "model.json").read_bytes())),
    ):
        assert type(again) is learner
        assert np.array_equal(again.predict(STATES), model.predict(STATES))
        assert np.array_equal(again.support(STATES), model.support(STATES))
        assert again._fitted.to_json() == model._fitted.to_json()
        assert again.trust_ == model.trust_
    unfitted = pickle.loads(pickle.dumps(learner(max_rows=77)))
    assert unfitted.max_rows == 77 and not unfitted.__sklearn_is_fitted__()
    other = next(one for one in LEARNERS if one is not learner)
    with pytest.raises(PolicyAlignError, match="a model of the learner"):
        other.load(tmp_path / "model.json")
    with (tmp_path / "model.json").open("rb") as file, pytest.raises(PolicyAlignError, match="no JSON object") as error:
        file.seek(1)
        load(file)
    assert error.value.place == str(tmp_path / "model.json")


def test_joblib_keeps_the_same_bits(slope: SlopeGp, tmp_path) -> None:
    joblib = pytest.importorskip("joblib")
    joblib.dump(slope, tmp_path / "model.joblib")
    assert np.array_equal(joblib.load(tmp_path / "model.joblib").predict(STATES), slope.predict(STATES))


def test_recordings_can_be_pickled(toy) -> None:
    again = pickle.loads(pickle.dumps(toy))
    for one, another in zip((*toy, *toy.velocities, *toy.times), (*again, *again.velocities, *again.times), strict=True):
        assert np.array_equal(one, another)
    assert (again.names, again.channels, again.constraints) == (toy.names, toy.channels, toy.constraints)
    usual, found = (SlopeGp(max_rows=60).fit(one)._fitted.about() for one in (toy, again))
    assert found.split('"time"')[0] == usual.split('"time"')[0]
    assert '"name":"toy.csv"' in found


def test_pickled_arrays_may_lie_at_any_byte(toy) -> None:
    buffers: list[pickle.PickleBuffer] = []
    text = pickle.dumps(toy, protocol=5, buffer_callback=buffers.append)
    shifted = [memoryview(b"?" + buffer.raw().tobytes())[1:] for buffer in buffers]
    again = pickle.loads(text, buffers=shifted)
    assert len(buffers) == 3 * len(toy)
    for one, another in zip((*toy, *toy.velocities, *toy.times), (*again, *again.velocities, *again.times), strict=True):
        assert np.array_equal(one, another)


def test_fitting_again_forgets(rails) -> None:
    model = SlopeGp(max_rows=60)
    first = model.fit(rails[0], dt=DT).predict(STATES)
    wide, speeds = on_rails(dim=3)
    assert model.fit(wide, dt=DT, velocities=speeds).n_features_in_ == 3
    assert model.fit(rails[0], dt=DT).n_features_in_ == 2
    assert np.array_equal(model.predict(STATES), first)
    assert np.array_equal(SlopeGp(max_rows=60, n_jobs=1).fit(rails[0], dt=DT).predict(STATES), first)


def test_what_was_learnt_has_names(toy, aligned: PolicyAlign) -> None:
    assert aligned.n_features_in_ == 2
    assert aligned.feature_names_in_.tolist() == ["x", "y"]
    assert aligned.time_step_ == toy.dt == DT
    assert sorted([*aligned.kept_, *aligned.discarded_]) == list(range(len(toy)))
    assert f"σ² {aligned.sigma_squared_:.3e}"[:7] in next(str(one) for one in aligned.decisions_ if one.what == "bandwidth")
    assert len(aligned.kept_) == aligned.trust_.numbers["aligned"]["kept"]
    assert {decision.what for decision in aligned.decisions_} >= {"learner", "bandwidth", "init_d", "integration"}
    assert aligned.left_out_ == ()


def test_scores_follow_errors(toy, slope: SlopeGp) -> None:
    assert slope.score(toy) > 0.999
    assert slope.score(list(toy), velocities=toy.velocities) == pytest.approx(slope.score(toy), abs=1e-6)
    backwards = [x[::-1] for x in toy]
    assert slope.score(backwards) < 0


def test_scikit_learn_takes_it() -> None:
    sklearn = pytest.importorskip("sklearn")
    from sklearn.model_selection import GridSearchCV
    from sklearn.pipeline import Pipeline
    from sklearn.utils.validation import check_is_fitted

    positions, velocities = on_rails()
    unequal = [x[: 25 + k] for k, x in enumerate(positions)]
    for given in (positions, unequal):
        grid = GridSearchCV(
            PolicyAlign(init_d=10.0, folds=2, max_rows=60),
            {"bandwidth": ["narrow", "medium"]},
            scoring=lambda model, X, y=None: model.score(X),
            cv=3,
            error_score="raise",
        )
        grid.fit(given, dt=DT)
        assert grid.best_params_["bandwidth"] in ("narrow", "medium")
        assert grid.best_score_ > 0
        check_is_fitted(grid.best_estimator_)
    model = sklearn.base.clone(SlopeGp(max_rows=60))
    pipeline = Pipeline([("learn", model)]).fit(positions, learn__dt=DT, learn__velocities=velocities)
    assert np.array_equal(pipeline.predict(STATES), pipeline["learn"].predict(STATES))
    with pytest.raises(sklearn.exceptions.NotFittedError):
        check_is_fitted(SlopeGp())


def test_a_scaler_before_it_is_warned_of() -> None:
    pytest.importorskip("sklearn")
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import MinMaxScaler, StandardScaler

    positions = on_rails()[0]
    flat, lengths = np.concatenate(positions), [len(x) for x in positions]
    for scaler, said in (
        (StandardScaler(), "the mean 0 and the deviation 1"),
        (MinMaxScaler(), "values from 0 to 1"),
        (MinMaxScaler((-1, 1)), "values from -1 to 1"),
    ):
        pipeline = make_pipeline(scaler, SlopeGp(max_rows=60))
        with pytest.warns(PolicyAlignWarning, match=f"every channel has {said}, as from a scaler.*leave the scaler out"):
            pipeline.fit(flat, slopegp__dt=DT, slopegp__lengths=lengths)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        SlopeGp(max_rows=60).fit(flat, dt=DT, lengths=lengths)
    assert not [warning for warning in caught if "scaler" in str(warning.message)]


def test_scikit_learn_is_not_needed() -> None:
    script = (
        "import sys; sys.modules.update(sklearn=None, pandas=None, scipy=None); import policy_align, numpy as np;"
        "x = np.random.default_rng(0).normal(size=(8, 20, 2)).cumsum(axis=1);"
        "import warnings; warnings.simplefilter('ignore');"
        "print(policy_align.SlopeGp(max_rows=60).fit(x, dt=0.1).predict(x[0]).shape)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "(20, 2)\n"
