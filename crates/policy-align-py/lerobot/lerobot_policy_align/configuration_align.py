"""Contents of ``config.json`` for a policy of the type "align"."""

from __future__ import annotations

from dataclasses import dataclass, field

from lerobot.configs.policies import PreTrainedConfig
from lerobot.configs.types import NormalizationMode
from lerobot.utils.constants import ACTION, OBS_STATE
from policy_align import PolicyAlignError

#: The reason why this plug-in does not train.
CLOSED_FORM = "policies of the type 'align' are learnt in closed form: `policy-align fit`, then `policy-align export --to lerobot`"


@PreTrainedConfig.register_subclass("align")
@dataclass
class AlignConfig(PreTrainedConfig):
    """``action``: "position", the state after one ``time_step``, like the targets in LeRobot's robots and data sets, or
    "velocity", in units of the state per second. ``time_step``: seconds between two actions; that of the recordings if None.
    ``outside``: outside the data, the velocity is "zero" or "nan", "error" raises an error, and "extrapolate" uses the learner's
    prediction; positions follow from the velocity. ``chunk_size``: number of actions of ``predict_action_chunk``, one
    time step apart.
    """

    action: str = "position"
    outside: str = "zero"
    time_step: float | None = None
    chunk_size: int = 1
    # The model has its own units: nothing is normalised.
    normalization_mapping: dict[str, NormalizationMode] = field(default_factory=dict)

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, known in {"action": ("position", "velocity"), "outside": ("zero", "nan", "error", "extrapolate")}.items():
            if getattr(self, name) not in known:
                raise PolicyAlignError(f"{getattr(self, name)!r} is none of the choices", name, f"one of {', '.join(known)}")
        if self.time_step is not None and not 0 < self.time_step < float("inf"):
            raise PolicyAlignError(f"{self.time_step} is not a positive time", "time_step", "seconds between two actions")
        if self.chunk_size < 1:
            raise PolicyAlignError(f"{self.chunk_size} actions are no chunk", "chunk_size", "a whole number from 1 on")

    @property
    def observation_delta_indices(self) -> None:
        return None

    @property
    def action_delta_indices(self) -> None:
        return None

    @property
    def reward_delta_indices(self) -> None:
        return None

    def get_optimizer_preset(self) -> None:  # type: ignore[override]
        raise NotImplementedError(CLOSED_FORM)

    def get_scheduler_preset(self) -> None:
        return None

    def validate_features(self) -> None:
        """Checks that there are a state and an action. Reading the model compares their dimensions with its own."""
        for key, feature in {OBS_STATE: self.robot_state_feature, ACTION: self.action_feature}.items():
            if feature is None:
                raise PolicyAlignError(f"there is no {key!r} among the features", "config.json", "a policy as it was exported")
