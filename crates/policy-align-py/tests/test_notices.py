"""Licences of the crates in the library."""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

import pytest
from conftest import ROOT

from policy_align import _native

NOTICES = ROOT / "crates/policy-align-py/LICENSE-THIRD-PARTY"


@pytest.fixture(scope="module")
def notices() -> str:
    if not NOTICES.exists():
        pytest.skip(f"{NOTICES} is not written: cargo xtask notices")
    return NOTICES.read_text()


def test_every_crate_that_the_library_names_has_its_licence(notices: str) -> None:
    """The library contains source paths for its panic messages; their folders name crates with versions."""
    places = rb"registry/src/[^/\0]+/([\w+.-]+-\d+\.\d+\.\d+[\w+.-]*)/"
    folders = {name.decode() for name in re.findall(places, Path(_native.__file__).read_bytes())}
    titles = {re.sub(r"-(\d+\.\d+\.\d+.*)$", r" \1", folder) for folder in folders}
    assert len(titles) > 20
    assert {title for title in titles if f"\n{title}: " not in notices} == set()


def test_an_installed_package_holds_them() -> None:
    try:
        files = metadata.files("policy-align") or []
    except metadata.PackageNotFoundError:
        pytest.skip("the package is not installed, only on the path")
    held = [file for file in files if file.name == NOTICES.name]
    assert len(held) == 1, "call `cargo xtask notices`, then build the wheel again"
    assert held[0].read_text() == NOTICES.read_text()


def test_every_crate_has_a_text(notices: str) -> None:
    listed, *texts = re.split(r"\n={80}\n", notices)
    titles = re.findall(r"^(\S+ \d+\.\S+): ", listed, re.MULTILINE)
    of = [text.partition("\n") for text in texts]
    named = [title for names, _, terms in of if len(terms.split()) > 80 for title in names.split(", ")]
    assert len(titles) > 100 and titles == sorted(titles)
    assert set(titles) == set(named)
