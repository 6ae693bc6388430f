"""What surrounds the script of a rule: a log file, and errors told in one message."""

import logging
import sys
import traceback
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterator

from rovsim.core.errors import RovsimError
from rovsim.dynamics.effects import use_effect_files


@contextmanager
def job(snakemake: Any) -> Iterator[None]:
    """Log to the rule's log; an expected error becomes one message and exit code 2."""
    path = snakemake.log[0]
    logging.basicConfig(filename=path, level=logging.INFO, format="%(asctime)s %(message)s")
    logging.info("rule %s %s", snakemake.rule, dict(snakemake.wildcards))
    try:
        use_effect_files([Path(name) for name in snakemake.config.get("effects_file", [])])
        yield
    except RovsimError as error:
        logging.error("%s", error)
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
    except Exception:
        logging.error("%s", traceback.format_exc())
        raise
    logging.info("done")
