"""The plug-in for LeRobot: an exported policy acts like the model, bit for bit."""

from __future__ import annotations

import json
import os
import shutil
import struct
import subprocess
import sys
import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, TOY

from policy_align import Demonstrations, PolicyAlignError, PolicyAlignWarning, SlopeGp, __version__

PLUGIN = ROOT / "crates/policy-align-py/lerobot"
GOALS = ROOT / "docs/examples/goals.csv"

sys.path.append(str(PLUGIN))
# Reads folders only, never the hub.
os.environ["HF_HUB_OFFLINE"] = "1"
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    pytest.importorskip("lerobot", reason="LeRobot is not installed: pip install 'lerobot>=0.4.4' (some 6 GB with torch)")
    import gymnasium
    import torch
    from lerobot.configs.policies import PreTrainedConfig
    from lerobot.configs.types import FeatureType, PolicyFeature
    from lerobot.policies.factory import make_policy, make_pre_post_processors
    from lerobot_policy_align import AlignConfig, AlignPolicy

pytestmark = pytest.mark.filterwarnings("default")

Export = Callable[[Path], Path]


@pytest.fixture(scope="module")
def export(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Export:
    def run(model: Path) -> Path:
        folder = tmp_path_factory.mktemp("exported") / "policy"
        subprocess.run([program, "export", model, "--to", "lerobot", "-o", folder], check=True, capture_output=True)
        return folder

    return run


@pytest.fixture(scope="module")
def model(slope: SlopeGp, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("models") / "toy.json"
    slope.save(path)
    return path


@pytest.fixture
def folder(model: Path, export: Export, tmp_path: Path) -> Path:
    """An exported policy that a test may damage."""
    shutil.copytree(export(model), tmp_path / "policy")
    return tmp_path / "policy"


@pytest.fixture(scope="module")
def states() -> np.ndarray:
    """States inside and outside the data."""
    return np.random.default_rng(3).uniform(-4, 4, (300, 2))


def observed(states: np.ndarray, dtype: torch.dtype = torch.float64) -> dict[str, torch.Tensor]:
    return {"observation.state": torch.from_numpy(states).to(dtype)}


def configured(folder: Path, **settings: Any) -> AlignPolicy:
    """Reads a policy whose actions are velocities, like the model's, unless ``settings`` differ."""
    settings = {"action": "velocity", **settings}
    config = PreTrainedConfig.from_pretrained(folder, cli_overrides=[f"--{key}={value}" for key, value in settings.items()])
    return AlignPolicy.from_pretrained(folder, config=config)


def test_actions_are_the_models_to_the_bit(folder: Path, slope: SlopeGp, states: np.ndarray) -> None:
    policy = configured(folder)
    known = slope.supports(states)
    assert 30 < known.sum() < 270
    actions = policy.select_action(observed(states)).numpy()
    assert np.array_equal(actions, np.stack([slope.act(x) for x in states]))
    assert not actions[~known].any() and actions[known].any(axis=1).all()
    rounded = policy.select_action(observed(states, torch.float32))
    assert rounded.dtype == torch.float32 and rounded.shape == (300, 2)
    of_rounded = slope.predict(states.astype(np.float32).astype(np.float64)).astype(np.float32)
    assert np.array_equal(rounded.numpy(), of_rounded)
    # A batch and its rows, before and after a reset.
    policy.reset()
    one_by_one = [policy.select_action(observed(x[None])).numpy()[0] for x in states]
    assert np.array_equal(np.stack(one_by_one), actions)


def test_the_model_file_travels_through_save_pretrained(
    model: Path, folder: Path, states: np.ndarray, tmp_path: Path
) -> None:
    policy = AlignPolicy.from_pretrained(folder)
    assert policy.model.numpy().tobytes() == model.read_bytes()
    policy.save_pretrained(tmp_path / "again")
    again = AlignPolicy.from_pretrained(tmp_path / "again")
    assert again.model.numpy().tobytes() == model.read_bytes()
    assert torch.equal(again.select_action(observed(states)), policy.select_action(observed(states)))
    # Another policy receives the state dictionary.
    third = AlignPolicy(policy.config)
    third.load_state_dict(policy.state_dict())
    assert torch.equal(third.select_action(observed(states)), policy.select_action(observed(states)))


def test_the_package_writes_what_the_program_writes(slope: SlopeGp, folder: Path, tmp_path: Path) -> None:
    slope.save_lerobot(tmp_path / "made" / "anew")
    names = sorted(file.name for file in folder.iterdir())
    assert len(names) == 4
    for name in names:
        assert (tmp_path / "made" / "anew" / name).read_bytes() == (folder / name).read_bytes()
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        slope.save_lerobot(tmp_path / "file")


def test_settings(folder: Path, slope: SlopeGp, states: np.ndarray) -> None:
    inside = states[slope.supports(states)]
    actions = slope.predict(inside)
    targets = configured(folder, action="position", time_step=0.01).select_action(observed(inside)).numpy()
    assert np.array_equal(targets, inside + 0.01 * actions)
    usual = AlignPolicy.from_pretrained(folder).select_action(observed(inside)).numpy()
    assert np.array_equal(usual, inside + slope.time_step_ * actions)
    beyond = np.array([[9.0, -9.0]])
    assert np.array_equal(AlignPolicy.from_pretrained(folder).select_action(observed(beyond)).numpy(), beyond), "it stays"
    for outside in ("nan", "extrapolate"):
        found = configured(folder, outside=outside).select_action(observed(states)).numpy()
        assert np.array_equal(found, slope.predict(states, outside=outside), equal_nan=True)
    with pytest.raises(PolicyAlignError, match="outside the data"):
        configured(folder, outside="error").select_action(observed(states))
    for wrong in ({"action": "torque"}, {"outside": "clip"}, {"time_step": 0.0}, {"chunk_size": 0}):
        with pytest.raises(PolicyAlignError):
            AlignConfig(**wrong)


def test_a_chunk_follows_the_policy(folder: Path, slope: SlopeGp) -> None:
    policy, state = configured(folder, chunk_size=4, time_step=0.1), np.array([[1.0, 0.5], [-0.5, 1.0]])
    chunk = policy.predict_action_chunk(observed(state)).numpy()
    assert chunk.shape == (2, 4, 2)
    for k in range(4):
        action = slope.predict(state)
        assert np.array_equal(chunk[:, k], action)
        state = state + 0.1 * action
    # The next action belongs to the next observation.
    assert np.array_equal(policy.select_action(observed(state)).numpy(), slope.predict(state))


def test_a_context_is_the_environments_state(export: Export, tmp_path: Path) -> None:
    goals = SlopeGp(max_rows=150).fit(Demonstrations.read(GOALS))
    assert goals.context_names_ == ["goal_x", "goal_y"]
    goals.save(tmp_path / "goals.json")
    policy = configured(export(tmp_path / "goals.json"))
    about = json.loads((tmp_path / "goals.json").read_text())
    contexts = np.array([[channel["median"] for channel in about["context"]]] * 4)
    contexts[1:3] += 0.05
    states = np.array([[channel["median"] for channel in about["state"]]] * 4) + np.arange(4)[:, None] * 0.1
    batch = {**observed(states), "observation.environment_state": torch.from_numpy(contexts)}
    expected = np.stack([goals.act(x, context=c) for x, c in zip(states, contexts, strict=True)])
    assert expected.any() and np.array_equal(policy.select_action(batch).numpy(), expected)
    with pytest.raises(PolicyAlignError, match="no 'observation.environment_state'"):
        policy.select_action(observed(states))
    with pytest.raises(PolicyAlignError, match="has 3 rows"):
        policy.select_action({**batch, "observation.environment_state": torch.from_numpy(contexts[:3])})


def test_wrong_observations(folder: Path) -> None:
    policy = AlignPolicy.from_pretrained(folder)
    for batch, said in [
        (observed(np.zeros((4, 3))), r"has the shape \(4, 3\)"),
        (observed(np.zeros(2)), r"has the shape \(2,\)"),
        ({}, "no 'observation.state'"),
    ]:
        with pytest.raises(PolicyAlignError, match=said) as error:
            policy.select_action(batch)
        assert "a tensor (B, 2) of x, y" in str(error.value)
    with pytest.raises(PolicyAlignError, match="has no model"):
        AlignPolicy(policy.config).select_action(observed(np.zeros((1, 2))))
    for untaught in (policy.get_optim_params, policy.config.get_optimizer_preset, lambda: policy.forward({})):
        with pytest.raises(NotImplementedError, match="policy-align fit"):
            untaught()


def test_damaged_files(folder: Path, model: Path) -> None:
    file = folder / "model.safetensors"
    whole = file.read_bytes()
    (length,) = struct.unpack("<Q", whole[:8])

    def with_tensor(name: str, dtype: str, shape: list[int], data: bytes) -> bytes:
        header = json.dumps({name: {"dtype": dtype, "shape": shape, "data_offsets": [0, len(data)]}}).encode()
        return struct.pack("<Q", len(header)) + header + data

    changed = bytearray(whole)
    changed[8 + length + 2000] ^= 1
    other = b'{"format": "another"}'
    for contents, said in [
        (whole[: len(whole) // 2], "damaged or cut off"),
        (whole[:4], "damaged or cut off"),
        (bytes(changed), "damaged|checksum"),
        (with_tensor("weights", "U8", [8], bytes(8)), "no tensor 'model'"),
        (with_tensor("model", "F32", [2], bytes(8)), "no tensor 'model'"),
        (with_tensor("model", "U8", [len(other)], other), "not a policy-align model"),
    ]:
        file.write_bytes(contents)
        with pytest.raises(PolicyAlignError, match=said) as error:
            AlignPolicy.from_pretrained(folder)
        assert error.value.place == str(file) and error.value.hint
    file.write_bytes(whole)
    config = json.loads((folder / "config.json").read_text())
    config["output_features"]["action"]["shape"] = [7]
    (folder / "config.json").write_text(json.dumps(config))
    with pytest.raises(PolicyAlignError, match=r"'action' has the shape \(7,\), the model has 2: x, y"):
        AlignPolicy.from_pretrained(folder)
    del config["input_features"]["observation.state"]
    (folder / "config.json").write_text(json.dumps(config))
    with pytest.raises(PolicyAlignError, match="no 'observation.state'"):
        AlignPolicy.from_pretrained(folder)


def test_doubts_are_warned_of(export: Export, tmp_path: Path) -> None:
    toy = Demonstrations.read(TOY)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        doubtful = SlopeGp(max_rows=60).fit(toy[:6])
    assert doubtful.trust_.verdict != "good"
    doubtful.save(tmp_path / "few.json")
    with pytest.warns(PolicyAlignWarning):
        AlignPolicy.from_pretrained(export(tmp_path / "few.json"))


@pytest.mark.filterwarnings("ignore")
def test_from_a_data_set_of_lerobot_to_its_policy(tmp_path: Path) -> None:
    """Positions on varying rails at 10 Hz, in a data set written by LeRobot: the learnt π = goal − x runs in LeRobot."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    feature = {"dtype": "float32", "shape": (2,), "names": ["x", "y"]}
    features = {"observation.state": feature, "action": feature}
    data = LeRobotDataset.create("local/rails", fps=10, features=features, root=tmp_path / "rails", use_videos=False)
    numbers, goal = np.random.default_rng(6), np.array([0.3, -0.2])
    for _ in range(25):
        x, rail = numbers.uniform(-1.5, 1.5, 2), numbers.normal(size=2)
        rail /= np.linalg.norm(rail)
        along = rail * (rail @ (goal - x))
        for k in range(30):
            here, there = (x + along * (1 - np.exp(-0.1 * step)) for step in (k, k + 1))
            data.add_frame({"observation.state": np.float32(here), "action": np.float32(there), "task": "roll"})
        data.save_episode()
    if hasattr(data, "finalize"):
        data.finalize()
    SlopeGp(max_rows=200).fit(Demonstrations.read(tmp_path / "rails")).save_lerobot(tmp_path / "policy")
    inside = numbers.uniform(-1, 1, (50, 2))
    actions = configured(tmp_path / "policy").select_action(observed(inside, torch.float32)).numpy()
    assert np.abs(actions - (goal - inside)).max() < 0.02
    targets = configured(tmp_path / "policy", action="position").select_action(observed(inside)).numpy()
    assert np.abs(targets - inside - 0.1 * (goal - inside)).max() < 0.002


class Bowl(gymnasium.Env):
    """The action is the next position, as for the robots of LeRobot; done within 0.1 of (0, 0)."""

    observation_space = gymnasium.spaces.Dict({"agent_pos": gymnasium.spaces.Box(-9, 9, (2,), np.float32)})
    action_space = gymnasium.spaces.Box(-99, 99, (2,), np.float32)
    _max_episode_steps = 100
    task_description = task = "roll"

    def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
        super().reset(seed=seed)
        self.x = self.np_random.uniform(0.5, 1.0, 2)
        return {"agent_pos": self.x.astype(np.float32)}, {}

    def step(self, action: np.ndarray) -> Any:
        self.x = np.array(action, dtype=np.float64)
        there = bool(np.linalg.norm(self.x) < 0.1)
        return {"agent_pos": self.x.astype(np.float32)}, float(there), there, False, {"is_success": there}


@pytest.mark.filterwarnings("ignore")
def test_lerobots_own_evaluation_runs_it(folder: Path) -> None:
    """make_policy, the stored processors with the overrides of lerobot-eval, and its rollout."""
    from lerobot.envs.configs import EnvConfig
    from lerobot.processor import PolicyProcessorPipeline
    from lerobot.scripts.lerobot_eval import rollout

    class BowlConfig(EnvConfig):
        type = "bowl"
        gym_kwargs: dict[str, Any] = {}

        def __init__(self) -> None:
            self.features = {
                "observation.state": PolicyFeature(FeatureType.STATE, (2,)),
                "action": PolicyFeature(FeatureType.ACTION, (2,)),
            }
            self.features_map = {"observation.state": "observation.state", "action": "action"}

    config = PreTrainedConfig.from_pretrained(folder)
    config.pretrained_path = folder
    policy = make_policy(config, env_cfg=BowlConfig())
    before, after = make_pre_post_processors(
        config,
        pretrained_path=str(folder),
        preprocessor_overrides={
            "device_processor": {"device": "cpu"},
            "rename_observations_processor": {"rename_map": {}},
        },
    )
    same = PolicyProcessorPipeline(steps=[])
    envs = gymnasium.vector.SyncVectorEnv([Bowl] * 3, autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP)
    run = rollout(envs, policy, same, same, before, after, seeds=[1, 2, 3])
    assert run["success"].any(dim=1).all()
    # Newly created processors have the same steps.
    made, _ = make_pre_post_processors(config)
    assert [type(step) for step in made.steps] == [type(step) for step in before.steps]


def test_lerobot_finds_the_plug_in(tmp_path: Path) -> None:
    """LeRobot finds it by the name of the installed distribution."""
    pytest.importorskip("setuptools")
    # Builds in a copy, because the build writes files.
    shutil.copytree(PLUGIN, tmp_path / "source", ignore=shutil.ignore_patterns("__pycache__"))
    install = "-m pip install --quiet --no-deps --no-build-isolation --no-index --no-compile --target".split()
    subprocess.run([sys.executable, *install, tmp_path / "site", tmp_path / "source"], check=True, capture_output=True)
    asks = (
        "from lerobot.utils.import_utils import register_third_party_plugins as register\n"
        "register()\n"
        "from lerobot.policies.factory import get_policy_class, make_policy_config\n"
        "print(get_policy_class('align').__module__, make_policy_config('align').type)"
    )
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site")}
    assert tomllib.loads((PLUGIN / "pyproject.toml").read_text())["project"]["version"] == __version__
    done = subprocess.run([sys.executable, "-c", asks], capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert done.stdout == "lerobot_policy_align.modeling_align align\n", done.stderr
