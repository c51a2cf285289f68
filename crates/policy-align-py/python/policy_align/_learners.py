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
    """Alignment of local potentials, and LWPR: the method of Howard et al.

    ``bandwidth``: "auto" (selected on held-out movements), "narrow", "medium", "wide" or σ². ``init_d``: "auto", or one
    over the squared width of receptive fields. ``folds``: number of parts that cross-validation leaves out in turn.
    ``max_rows``: number of samples for the Gaussian process that judges the policy. Other parameters as for SlopeGp.
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
        """Indices of the movements in the aligned group, among those learnt from."""
        return np.array(self._about["kept"], dtype=np.intp)

    @property
    def sigma_squared_(self) -> float | None:
        """σ² of the responsibilities, in units of the scaled state squared; None if the model file has none."""
        found: float | None = self._about["trust"]["numbers"]["aligned"].get("sigma_squared")
        return found

    @property
    def discarded_(self) -> npt.NDArray[np.intp]:
        """Indices of all other movements."""
        return np.setdiff1d(np.arange(self._about["data"]["episodes"]), self.kept_)


class SlopeGp(Learner):
    __doc__ = f"""A Gaussian process on uᵀπ = uᵀu, for constraints that project π orthogonally onto their null space.

    It holds for orthogonal projections onto convex cones as well. Constraints may push (A u = b) while A and b stay
    constant for some twenty samples.

    {Learner.__init__.__doc__}"""
    _learner = "slope"


class DirectGp(Learner):
    __doc__ = f"""A Gaussian process on the velocities as recorded: correct if nothing was constrained.

    {Learner.__init__.__doc__}"""
    _learner = "direct"


class AutoGp(Learner):
    """SlopeGp or DirectGp, selected by the data: the program's default.

    ``reading``: "free" or "constrained" if known, else None. Other parameters as for SlopeGp.
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
    """Reads any model file of this package or the program as the estimator that learns such models.

    ``path`` may also be a file opened in binary mode, such as ``io.BytesIO``.
    """
    known: dict[str, Any] = {one._learner: one for one in (PolicyAlign, SlopeGp, DirectGp, AutoGp)}
    if isinstance(path, str | os.PathLike):
        fitted = _native.Fitted.load(path)
    else:
        fitted = _native.Fitted.from_json(path.read(), str(getattr(path, "name", "the open file")))
    loaded: PolicyAlign | SlopeGp | DirectGp | AutoGp = known[fitted.learner]._of(fitted)
    return loaded
