"""The table of evidence: all numbers of the validation that have a target, with their results (evidence.json, made by
scripts/evidence.py)."""

import json
from pathlib import Path

from .errors import DataError

__all__ = ["load_evidence"]

FILE = Path(__file__).resolve().with_name("evidence.json")


def load_evidence() -> dict:
    """Returns "commit", "rows" and "flows". Throws DataError if the package has no table."""
    try:
        return json.loads(FILE.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(f"{FILE}: cannot be read ({error})") from error
