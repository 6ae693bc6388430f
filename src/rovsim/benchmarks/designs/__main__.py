"""Run cases: python -m rovsim.benchmarks.designs development|reporting OUT [CASE…]."""

import sys
from pathlib import Path
from typing import Sequence, cast

from rovsim.benchmarks.blind.case import Range
from rovsim.benchmarks.designs.cases import list_cases
from rovsim.benchmarks.designs.run import run_case
from rovsim.benchmarks.designs.table import tabulate
from rovsim.results.design_benchmark import FlownCase


def main(seeds: Range, out: Path, cases: Sequence[str]) -> None:
    """Run what is missing of these cases (all if none is named), and print the table after each."""
    results = []
    for case in cases or list_cases():
        file = out / seeds / f"{case}.json"
        if not file.exists():
            run_case(case, seeds, out / seeds / case).write(file)
        results.append(FlownCase.read(file))
        print(tabulate(results), flush=True)


if __name__ == "__main__":
    main(cast(Range, sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
