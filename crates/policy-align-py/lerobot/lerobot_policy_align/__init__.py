"""Policies of policy-align in LeRobot: ``--policy.path`` with a folder of ``policy-align export MODEL --to lerobot``."""

from .configuration_align import AlignConfig
from .modeling_align import AlignPolicy
from .processor_align import make_align_pre_post_processors

__all__ = ["AlignConfig", "AlignPolicy", "make_align_pre_post_processors"]
