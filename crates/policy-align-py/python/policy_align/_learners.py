"""The learners, with their parameters."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, BinaryIO

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
    bandwidth: str | float
    init_d: str | float
    folds: int

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
        context: str | Sequence[str] = "auto",
        folds: int = 5,
        max_rows: int = 400,
        inducing: int = 500,
        random_state: Any = 1,
        n_jobs: int | None = None,
    ) -> None:
        self._store(locals())

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


class SlopeGp(Learner):
    __doc__ = f"""A Gaussian process on uᵀπ = uᵀu, for constraints that project π orthogonally onto their null space.

    It holds for orthogonal projections onto convex cones as well. Constraints may push (A u = b) while A and b stay
    constant for some twenty samples.

    {Learner.__init__.__doc__}"""
    _learner = "slope"


class DirectGp(Learner):
    __doc__ = f"""A Gaussian process on the velocities as they are: right where nothing was constrained.

    {Learner.__init__.__doc__}"""
    _learner = "direct"


class AutoGp(Learner):
    """SlopeGp or DirectGp, as the data say: the program's default.

    ``reading``: "free" or "constrained" if you know, else None. Other parameters as of SlopeGp.
    """

    _learner = "auto"
    reading: str | None

    def __init__(
        self,
        *,
        reading: str | None = None,
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        context: str | Sequence[str] = "auto",
        max_rows: int = 400,
        inducing: int = 500,
        robot: str | os.PathLike[str] | None = None,
        random_state: Any = 1,
        n_jobs: int | None = None,
    ) -> None:
        self._store(locals())


def load(path: str | os.PathLike[str] | BinaryIO) -> PolicyAlign | SlopeGp | DirectGp | AutoGp:
    """Reads any model file, of this package or of the program, as the estimator that learns such models.

    ``path`` may also be a file that is open for reading bytes, as ``io.BytesIO``.
    """
    known: dict[str, Any] = {one._learner: one for one in (PolicyAlign, SlopeGp, DirectGp, AutoGp)}
    if isinstance(path, str | os.PathLike):
        fitted = _native.Fitted.load(path)
    else:
        fitted = _native.Fitted.from_json(path.read(), str(getattr(path, "name", "the open file")))
    loaded: PolicyAlign | SlopeGp | DirectGp | AutoGp = known[fitted.learner]._of(fitted)
    return loaded
