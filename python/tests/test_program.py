"""The program: found, started, or missing with a remedy."""

import re

import pytest

import impactid


def test_the_version_is_one():
    assert re.fullmatch(r"\d+\.\d+\.\d+", impactid.version())


def test_a_missing_program_is_named_with_the_remedy(monkeypatch, tmp_path):
    monkeypatch.setenv("IMPACTID_PROGRAM", str(tmp_path / "nothing"))
    with pytest.raises(impactid.ProgramMissing, match="cargo install --path"):
        impactid.version()


def test_a_program_for_another_platform_is_a_clear_message(monkeypatch, tmp_path):
    other = tmp_path / "impactid"
    # the head of a 64-bit ELF file for a machine that nobody has (e_machine 0x1234)
    other.write_bytes(b"\x7fELF\x02\x01\x01" + bytes(9) + b"\x02\x00\x34\x12\x01\x00\x00\x00" + bytes(64))
    other.chmod(0o755)
    monkeypatch.setenv("IMPACTID_PROGRAM", str(other))
    with pytest.raises(impactid.ProgramMissing, match="another platform"):
        impactid.version()
