"""The interface that scikit-learn expects of an estimator, without scikit-learn."""

from __future__ import annotations

import inspect
from typing import Any, Self


class Estimator:
    """``get_params``, ``set_params``, ``repr`` and tags: ``clone``, ``GridSearchCV`` and ``Pipeline`` work with these.

    ``__init__`` stores every parameter untouched under its name, and does nothing else; ``fit`` checks them.
    """

    def _store(self, given: dict[str, Any]) -> None:
        """Stores the parameters; every ``__init__`` ends with ``self._store(locals())``."""
        for name in self._parameters():
            setattr(self, name, given[name])

    @classmethod
    def _parameters(cls) -> dict[str, inspect.Parameter]:
        found = inspect.signature(cls.__init__).parameters
        return {name: parameter for name, parameter in found.items() if name != "self"}

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """Parameters by name. None of them holds an estimator, so ``deep`` changes nothing."""
        return {name: getattr(self, name) for name in self._parameters()}

    def set_params(self, **params: Any) -> Self:
        """Changes parameters; the learnt policy stays until the next ``fit``."""
        known = self._parameters()
        for name, value in params.items():
            if name not in known:
                raise ValueError(
                    f"Invalid parameter {name!r} for estimator {self!r}. Valid parameters are: {list(known)!r}."
                )
            setattr(self, name, value)
        return self

    def __repr__(self) -> str:
        changed = (
            f"{name}={getattr(self, name)!r}"
            for name, parameter in self._parameters().items()
            if repr(getattr(self, name)) != repr(parameter.default)
        )
        return f"{type(self).__name__}({', '.join(changed)})"

    def __sklearn_tags__(self) -> Any:
        from sklearn.utils import InputTags, Tags, TargetTags

        target, samples = TargetTags(required=False), InputTags(two_d_array=False)
        return Tags(estimator_type=None, target_tags=target, input_tags=samples)
