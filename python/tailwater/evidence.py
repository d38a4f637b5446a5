"""The table of evidence: every number of the validation that has a target, with its result (evidence.json, which
scripts/evidence.py makes)."""

import json
from pathlib import Path

from .errors import DataError

__all__ = ["load_evidence"]

FILE = Path(__file__).resolve().with_name("evidence.json")


def load_evidence() -> dict:
    """"commit", "rows" and "flows". Throws DataError if the package has no table."""
    try:
        return json.loads(FILE.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(f"{FILE}: cannot be read ({error})") from error
