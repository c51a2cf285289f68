"""The learners, with their parameters."""

from __future__ import annotations

import json
import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._learner import Learner


class PolicyAlign(Learner):
    """Local potentials brought to one level, and LWPR: the method of Howard et al.

    ``bandwidth``: "auto" (by held-out movements), "narrow", "medium", "wide" or σ². ``init_d``: "auto", or one over the
    squared width of receptive fields. ``folds``: parts of the movements that are left out in turn. ``max_rows``: samples
    that the Gaussian process learns from which judges the policy. Others as of SlopeGp.
    """

    _learner = "policy_align"

    def __init__(
        self,
        bandwidth: str | float = "auto",
        *,
        init_d: str | float = "auto",
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        folds: int = 5,
        max_rows: int = 400,
        random_state: int = 1,
        n_jobs: int | None = None,
    ) -> None:
        self.bandwidth = bandwidth
        self.init_d = init_d
        self.integration = integration
        self.scale = scale
        self.smooth = smooth
        self.jumps = jumps
        self.wraps = wraps
        self.folds = folds
        self.max_rows = max_rows
        self.random_state = random_state
        self.n_jobs = n_jobs

    @property
    def kept_(self) -> npt.NDArray[np.intp]:
        """Numbers of the movements that hang together, of those learnt from."""
        return np.array(self._about["kept"], dtype=np.intp)

    @property
    def sigma_squared_(self) -> float | None:
        """σ² of the responsibilities, in units of the scaled state squared; None in model files that do not tell."""
        found: float | None = self._about["trust"]["numbers"]["aligned"].get("sigma_squared")
        return found

    @property
    def discarded_(self) -> npt.NDArray[np.intp]:
        """Numbers of all others."""
        return np.setdiff1d(np.arange(self._about["data"]["episodes"]), self.kept_)


class _GaussianProcess(Learner):
    """``integration``: "auto", "velocity" (recorded ones are believed) or "displacement" (they are ignored). ``scale``:
    factors of channels' units. ``smooth``, of positions: "auto", "off", a window of samples (9) or of seconds ("0.2s").
    ``jumps``: "auto" cuts movements where one step is far too long, "keep" does not. ``wraps``: with "auto" angles that
    jump by a whole turn go on instead, with "keep" they jump. ``max_rows``: samples learnt from, at most.
    ``random_state``: the seed, a whole number. ``n_jobs``: threads, None or -1 for all; results do not depend on it.
    """

    def __init__(
        self,
        *,
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        max_rows: int = 400,
        random_state: int = 1,
        n_jobs: int | None = None,
    ) -> None:
        self.integration = integration
        self.scale = scale
        self.smooth = smooth
        self.jumps = jumps
        self.wraps = wraps
        self.max_rows = max_rows
        self.random_state = random_state
        self.n_jobs = n_jobs


class SlopeGp(_GaussianProcess):
    __doc__ = f"""A Gaussian process on uᵀπ = uᵀu, which holds under any constraint.

    {_GaussianProcess.__doc__}"""
    _learner = "slope"


class DirectGp(_GaussianProcess):
    __doc__ = f"""A Gaussian process on the velocities as they are: right where nothing was constrained.

    {_GaussianProcess.__doc__}"""
    _learner = "direct"


class AutoGp(Learner):
    """SlopeGp or DirectGp, as the data say: the program's default.

    ``reading``: "free" or "constrained" if you know, else None. Other parameters as of SlopeGp.
    """

    _learner = "auto"

    def __init__(
        self,
        *,
        reading: str | None = None,
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        max_rows: int = 400,
        random_state: int = 1,
        n_jobs: int | None = None,
    ) -> None:
        self.reading = reading
        self.integration = integration
        self.scale = scale
        self.smooth = smooth
        self.jumps = jumps
        self.wraps = wraps
        self.max_rows = max_rows
        self.random_state = random_state
        self.n_jobs = n_jobs


def load(path: str | os.PathLike[str]) -> PolicyAlign | SlopeGp | DirectGp | AutoGp:
    """Reads any model file, of this package or of the program, as the estimator that learns such models."""
    fitted = _native.Fitted.load(path)
    learner: Any = json.loads(fitted.about())["learner"]
    known: list[type[PolicyAlign] | type[SlopeGp] | type[DirectGp] | type[AutoGp]]
    known = [PolicyAlign, SlopeGp, DirectGp, AutoGp]
    return next(one for one in known if one._learner == learner)._of(fitted)
