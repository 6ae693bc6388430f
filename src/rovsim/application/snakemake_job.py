"""What surrounds the script of a rule: a log file, and errors told in one message."""

import logging
import sys
import traceback
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterator

from rovsim.core.errors import RovsimError
from rovsim.dynamics.catalogue import Catalogue, load_catalogue


@contextmanager
def job(snakemake: Any) -> Iterator[Catalogue]:
    """Log to the rule's log; an expected error becomes one message and exit code 2.

    Gives the catalogue, with the user's effect files in it.
    """
    path = snakemake.log[0]
    logging.basicConfig(filename=path, level=logging.INFO, format="%(asctime)s %(message)s")
    logging.info("rule %s %s", snakemake.rule, dict(snakemake.wildcards))
    try:
        yield load_catalogue([Path(name) for name in snakemake.config.get("effects_file", [])])
    except RovsimError as error:
        logging.error("%s", error)
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)
    except Exception:
        logging.error("%s", traceback.format_exc())
        raise
    logging.info("done")
