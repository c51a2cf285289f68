"""The policy: a model file of policy-align, stored as a tensor of bytes."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
import torch
from lerobot.configs.types import PolicyFeature
from lerobot.policies.pretrained import PreTrainedPolicy
from lerobot.utils.constants import ACTION, OBS_ENV_STATE, OBS_STATE
from policy_align import PolicyAlignError, PolicyAlignWarning, load
from safetensors import SafetensorError
from torch import Tensor

from .configuration_align import CLOSED_FORM, AlignConfig

#: The hint if the model is missing or damaged.
EXPORTED = "a folder that `policy-align export MODEL --to lerobot` has written, whole"


class AlignPolicy(PreTrainedPolicy):
    """Actions (B, n) at states ``observation.state`` (B, n), with a context also at ``observation.environment_state`` (B, p).

    States are converted to double precision, and the actions are rounded to the states' precision: they equal those of
    the model's ``act`` bit for bit. Each action depends on the present observation alone.
    """

    config_class = AlignConfig
    name = "align"
    model: Tensor

    def __init__(self, config: AlignConfig, **_others: Any) -> None:
        super().__init__(config)
        config.validate_features()
        self.config: AlignConfig = config
        self.register_buffer("model", torch.empty(0, dtype=torch.uint8))
        self._learner: Any = None

    def select_action(self, batch: dict[str, Tensor], **_others: Any) -> Tensor:
        """The action at each state, (B, n)."""
        states, contexts = self._inputs(batch)
        return self._as_tensor(self._actions(states, contexts)[0], batch)

    def predict_action_chunk(self, batch: dict[str, Tensor], **_others: Any) -> Tensor:
        """The actions of a chunk, (B, chunk_size, n): the policy is followed in steps of ``time_step`` without constraints."""
        states, contexts = self._inputs(batch)
        chunk = []
        for _ in range(self.config.chunk_size):
            actions, states = self._actions(states, contexts)
            chunk.append(actions)
        return self._as_tensor(np.stack(chunk, axis=1), batch)

    def reset(self) -> None:
        """Does nothing: the policy keeps no state between observations."""

    def forward(self, batch: dict[str, Tensor]) -> tuple[Tensor, dict[str, Any] | None]:
        raise NotImplementedError(CLOSED_FORM)

    def get_optim_params(self) -> dict[str, Any]:
        raise NotImplementedError(CLOSED_FORM)

    def _actions(self, states: np.ndarray, contexts: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Actions and the states after a time step, (B, n) each."""
        velocities = np.empty_like(states)
        if contexts is None:
            velocities[:] = self._learner.predict(states, outside=self.config.outside)
        else:
            different, which = np.unique(contexts, axis=0, return_inverse=True)
            for number, context in enumerate(different):
                rows = which.reshape(-1) == number
                velocities[rows] = self._learner.predict(states[rows], context=context, outside=self.config.outside)
        time_step = self.config.time_step or self._learner.time_step_
        after = states + time_step * velocities
        return (after if self.config.action == "position" else velocities), after

    def _inputs(self, batch: dict[str, Tensor]) -> tuple[np.ndarray, np.ndarray | None]:
        if self._learner is None:
            raise PolicyAlignError("the policy has no model", "AlignPolicy", f"from_pretrained with {EXPORTED}")
        channels, context = list(self._learner.feature_names_in_), self._learner.context_names_
        states = _array(batch, OBS_STATE, channels)
        if not context:
            return states, None
        contexts = _array(batch, OBS_ENV_STATE, context)
        if len(contexts) != len(states):
            what = f"{OBS_ENV_STATE} has {len(contexts)} rows, {OBS_STATE} has {len(states)}"
            raise PolicyAlignError(what, "batch", "a row of both for each observation")
        return states, contexts

    def _as_tensor(self, actions: np.ndarray, batch: dict[str, Tensor]) -> Tensor:
        state = batch[OBS_STATE]
        return torch.from_numpy(actions).to(device=state.device, dtype=state.dtype if state.is_floating_point() else torch.float32)

    @classmethod
    def _load_as_safetensor(cls, model: AlignPolicy, model_file: str, map_location: str, strict: bool) -> AlignPolicy:
        try:
            return super()._load_as_safetensor(model, model_file, map_location, strict)
        except SafetensorError as error:
            raise PolicyAlignError(f"damaged or cut off: {error}", model_file, EXPORTED) from error
        except PolicyAlignError as error:
            raise PolicyAlignError(error.what, model_file, error.hint) from error

    def _load_from_state_dict(self, state_dict: dict[str, Tensor], prefix: str, *others: Any) -> None:
        tensor = state_dict.get(f"{prefix}model")
        if tensor is None or tensor.dtype != torch.uint8 or tensor.ndim != 1:
            raise PolicyAlignError("there is no tensor 'model' of bytes", "state_dict", EXPORTED)
        self._learner = load(io.BytesIO(tensor.cpu().numpy().tobytes()))
        self._check_dimensions()
        trust = self._learner.trust_
        if trust.verdict != "good":
            verdict = trust.verdict.replace("_", " ")
            warnings.warn(f"{verdict}: {trust.findings[0]}", PolicyAlignWarning, stacklevel=2)
        # The tensor may have any length: the call below fills it.
        self.model = torch.empty_like(tensor, device=self.model.device)
        super()._load_from_state_dict(state_dict, prefix, *others)

    def _check_dimensions(self) -> None:
        config, channels, context = self.config, list(self._learner.feature_names_in_), self._learner.context_names_
        expected: list[tuple[str, PolicyFeature | None, list[str]]] = [
            (OBS_STATE, config.robot_state_feature, channels),
            (ACTION, config.action_feature, channels),
        ]
        if context:
            expected.append((OBS_ENV_STATE, config.env_state_feature, context))
        for key, feature, names in expected:
            shape = None if feature is None else tuple(feature.shape)
            if shape != (len(names),):
                what = f"{key!r} has the shape {shape}, the model has {len(names)}: {', '.join(names)}"
                raise PolicyAlignError(what, "config.json", "the features that the model was learnt from, in their order")


def _array(batch: dict[str, Tensor], key: str, names: list[str]) -> np.ndarray:
    """Rows of a tensor in double precision, (B, n)."""
    if key not in batch:
        raise PolicyAlignError(f"there is no {key!r}", "batch", f"a tensor (B, {len(names)}) of {', '.join(names)}")
    tensor = batch[key]
    if tensor.ndim != 2 or tensor.shape[1] != len(names):
        hint = f"a tensor (B, {len(names)}) of {', '.join(names)}"
        raise PolicyAlignError(f"{key!r} has the shape {tuple(tensor.shape)}", "batch", hint)
    return tensor.detach().cpu().to(torch.float64).numpy()
