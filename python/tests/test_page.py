"""The programs of docs/python.md run as they stand."""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = re.findall(r"## (.*?)\n.*?```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), re.DOTALL)


@pytest.mark.parametrize(("title", "program"), PROGRAMS, ids=[title for title, _ in PROGRAMS])
def test_program(title: str, program: str, tmp_path: pathlib.Path) -> None:
    """In a folder with the models and an empty `out`."""
    data = pathlib.Path("/usr/share/mricron/templates")
    if str(data) in program and not data.exists():
        pytest.skip("needs Debian's mricron-data")
    (tmp_path / "models").symlink_to(ROOT / "models")
    (tmp_path / "out").mkdir()
    result = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    for name in re.findall(r'"out/(.*?)"', program):
        assert (tmp_path / "out" / name).stat().st_size > 0


def test_there_are_eleven() -> None:
    assert len(PROGRAMS) == 11
