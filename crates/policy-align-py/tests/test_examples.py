"""The example files in the package."""

from __future__ import annotations

import tomllib

import pytest
from conftest import ROOT

from policy_align import Demonstrations, PolicyAlignError, SlopeGp, example

NAMES = ["goals", "notebook", "rails", "toy", "wall"]


@pytest.mark.parametrize("name", NAMES)
def test_an_example_is_the_file_of_the_documentation(name: str) -> None:
    path = example(name)
    assert path.is_file()
    assert path.read_bytes() == (ROOT / "docs/examples" / path.name).read_bytes()


@pytest.mark.parametrize(("name", "movements"), [("toy", 40), ("rails", 12), ("goals", 32)])
def test_examples_are_read(name: str, movements: int) -> None:
    assert len(Demonstrations.read(example(name))) == movements


def test_the_wall_holds(slope: SlopeGp) -> None:
    path = slope.rollout([1.5, 1.0], constraint=example("wall"))
    assert abs(path.states[:, 0] - 1.5).max() == 0.0


@pytest.mark.parametrize("name", ["tyo", "", "toy.csv", "../toy", None, 3])
def test_other_names_are_errors_that_list_the_names(name: object) -> None:
    with pytest.raises(PolicyAlignError) as raised:
        example(name)  # type: ignore[arg-type]
    assert repr(name) in raised.value.what
    assert all(f'"{known}"' in raised.value.hint for known in NAMES)


def test_the_package_has_the_urls_of_the_workspace() -> None:
    project = tomllib.loads((ROOT / "crates/policy-align-py/pyproject.toml").read_text())["project"]
    repository = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["repository"]
    assert project["urls"]["Repository"] == repository
    for url in project["urls"].values():
        assert url.startswith(repository)
        _, is_file, file = url.partition("/blob/HEAD/")
        assert not is_file or (ROOT / file).is_file()
