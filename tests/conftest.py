"""What every test may ask for."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parents[1]
SHARED = Path(os.environ.get("GROUNDPLAN_SHARED") or ROOT.parent / "shared")

# The same examples on every machine, however slow it is; `--hypothesis-profile=default` looks for new ones.
settings.register_profile("steady", derandomize=True, deadline=None)
settings.load_profile("steady")


@pytest.fixture(scope="session")
def shared() -> Path:
    """Directory of the real maps, which are not ours to ship: a test that needs them is skipped without."""
    if not SHARED.is_dir():
        pytest.skip(f"needs the real maps: no directory {SHARED} (set GROUNDPLAN_SHARED to where they are)")
    return SHARED
