"""The program to be tested and a small campaign with its results.

IMPACTID_PROGRAM names the program; without it the one that is installed is tested.
"""

import os
from pathlib import Path

import pytest

import impactid
from impactid._program import start

# plots are drawn without a screen
os.environ.setdefault("MPLBACKEND", "Agg")


@pytest.fixture(scope="session")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("campaign")
    start(["-q", "simulate", "campaign", "--records", "40", "--seed", "4", "--out", str(folder)])
    return folder / "campaign.toml"


@pytest.fixture(scope="session")
def results(campaign: Path, tmp_path_factory: pytest.TempPathFactory) -> impactid.Results:
    out = tmp_path_factory.mktemp("results")
    return impactid.run(campaign, out, formats=["html"])
