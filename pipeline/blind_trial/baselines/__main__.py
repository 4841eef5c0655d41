"""``python -m pipeline.blind_trial.baselines NAME``: answer the case of this folder, into products/diagnosis.json."""

import json
import sys
from pathlib import Path

from pipeline.blind_trial.baselines import load
from pipeline.contract.errors import BrakechainError


def main():
    """Answer, or say why not, as the command line does."""
    here = Path.cwd()
    try:
        answer = load(sys.argv[1])(here)
    except BrakechainError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(error.exit_code)
    (here / "products").mkdir()
    (here / "products" / "diagnosis.json").write_text(json.dumps(answer), encoding="utf-8")


if __name__ == "__main__":
    main()
