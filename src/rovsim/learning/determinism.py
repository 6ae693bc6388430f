"""Make PyTorch give the same numbers for the same seed, without lasting changes of its state."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

# The order of sums depends on the number of threads: fixed here, not taken from the machine. With
# one, trainings that a workflow runs side by side do not fight over cores (two save a third alone).
TRAINING_THREADS = 1


@contextmanager
def seeded_torch(seed: int) -> Iterator[None]:
    """Compute in float64 with a seeded random stream, one thread and exact Cholesky factors.

    All settings of PyTorch and GPyTorch are restored at the end of the context.
    """
    import torch

    with warnings.catch_warnings():
        # GPyTorch 1.15 compiles a few functions on import in a way torch 2.13 calls deprecated
        warnings.simplefilter("ignore", DeprecationWarning)
        from gpytorch import settings

    threads, dtype = torch.get_num_threads(), torch.get_default_dtype()
    exact = settings.fast_computations(covar_root_decomposition=False, log_prob=False, solves=False)
    with torch.random.fork_rng(devices=[]), exact, settings.max_cholesky_size(10**6):
        torch.manual_seed(seed)
        torch.set_num_threads(TRAINING_THREADS)
        torch.set_default_dtype(torch.float64)
        try:
            yield
        finally:
            torch.set_num_threads(threads)
            torch.set_default_dtype(dtype)
