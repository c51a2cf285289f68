"""Learn movement policies from demonstrations made under unknown constraints.

>>> from policy_align import SlopeGp                                   # doctest: +SKIP
>>> model = SlopeGp().fit(trajectories, dt=0.05)                       # doctest: +SKIP
>>> u, std = model.predict(X, return_std=True)                         # doctest: +SKIP

The learners are ``PolicyAlign``, ``SlopeGp``, ``DirectGp`` and ``AutoGp``, which selects the Gaussian process that
the data support. ``Demonstrations`` holds recordings from files or memory. ``load`` reads any model file. Rows are
samples everywhere.
"""

from ._constraints import ConstraintStretch
from ._demonstrations import Check, Demonstrations
from ._errors import NotFittedError, PolicyAlignError, PolicyAlignWarning
from ._examples import example
from ._learners import AutoGp, DirectGp, PolicyAlign, SlopeGp, load
from ._native import __version__
from ._rollout import Path
from ._trust import Decision, Finding, Trust

__all__ = [
    "AutoGp",
    "Check",
    "ConstraintStretch",
    "Decision",
    "Demonstrations",
    "DirectGp",
    "Finding",
    "NotFittedError",
    "Path",
    "PolicyAlign",
    "PolicyAlignError",
    "PolicyAlignWarning",
    "SlopeGp",
    "Trust",
    "__version__",
    "example",
    "load",
]
