"""Verdict, findings and decisions."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

_WORDS = {
    "good": "good: all checks passed",
    "doubtful": "doubtful: read the findings before using it",
    "do_not_use": "do not use",
}


@dataclass(frozen=True)
class Decision:
    """A decision that was made for the user, who can override it."""

    what: str
    value: str
    why: str

    def __str__(self) -> str:
        return f"{self.what}: {self.value} ({self.why})"


@dataclass(frozen=True)
class Finding:
    """One reason for doubt: ``verdict`` is "good" (a remark), "doubtful" or "do_not_use"."""

    verdict: str
    what: str
    next: str

    def __str__(self) -> str:
        return f"{self.what}; {self.next}"


@dataclass(frozen=True)
class Trust:
    """The verdict on a policy, found without knowing the true policy.

    ``verdict``: the worst of the ``findings``, "good" without any. ``numbers``: the numbers behind it, named as in the
    model file (docs/model-file.md).
    """

    verdict: str
    findings: tuple[Finding, ...]
    numbers: dict[str, Any]

    def __str__(self) -> str:
        return "\n".join([_WORDS[self.verdict], *(f"- {finding}" for finding in self.findings)])

    def _repr_html_(self) -> str:
        rows = "".join(f"<li>{escape(str(finding))}</li>" for finding in self.findings)
        numbers = ("held_out_error", "held_out_error_direct", "expected_error", "direction_coverage")
        cells = "".join(f"<tr><td>{name}</td><td>{self.numbers[name]:.3g}</td></tr>" for name in numbers)
        return f"<b>{escape(_WORDS[self.verdict])}</b><ul>{rows}</ul><table>{cells}</table>"


def decisions(found: list[dict[str, str]]) -> tuple[Decision, ...]:
    """Converts the decisions of the native half's document."""
    return tuple(Decision(entry["what"], entry["value"], entry["why"]) for entry in found)


def findings(found: list[dict[str, str]]) -> tuple[Finding, ...]:
    """Converts the findings of the native half's document."""
    return tuple(Finding(entry["verdict"], entry["what"], entry["next"]) for entry in found)
